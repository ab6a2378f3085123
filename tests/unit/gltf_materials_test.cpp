// Materials beyond metallic-roughness: specular-glossiness, and the lobes of the ratified extensions.
#include <cmath>

#include "gltf_builder.h"

namespace etendue::test {
namespace {

// A triangle with this material, textures 0 to 3 and their images.
GltfBuilder painted(const char* material) {
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["attributes"]["NORMAL"] = gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  gltf.primitive()["attributes"]["TANGENT"] = gltf.floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  gltf.primitive()["material"] = 0;
  gltf.json["materials"] = Json::array({Json::parse(material)});
  for (int i = 0; i < 4; ++i) {
    gltf.json["images"].push_back({{"uri", png_uri()}, {"name", "image " + std::to_string(i)}});
    gltf.json["textures"].push_back({{"source", i}});
  }
  for (const auto& [name, content] : gltf.json["materials"][0]["extensions"].items()) gltf.json["extensionsUsed"].push_back(name);
  return gltf;
}

Material read_material(const char* text, Diagnostics& diagnostics) {
  const Folder folder;
  const auto imported = read_gltf(painted(text), folder);
  if (!imported.ok() || imported->scene.materials.empty()) return {};
  diagnostics = imported->diagnostics;
  EXPECT_FALSE(validate(imported->scene).has_errors()) << all_text(validate(imported->scene));
  return imported->scene.materials[0];
}

// The mesh carries the coordinates of what pictures of ours show; of a lobe's texture where there is nothing else.
TEST(GltfMaterials, CoordinatesOfALobesTexture) {
  const char* const coat = R"("extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0, "texCoord": 1}}})";
  const std::string alone = std::string("{") + coat + "}";
  const std::string beside = std::string(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}, )") + coat + "}";
  for (const bool coloured : {false, true}) {
    GltfBuilder gltf = painted((coloured ? beside : alone).c_str());
    gltf.primitive()["attributes"]["TEXCOORD_1"] = gltf.floats({0.5, 0, 1, 0, 0, 1}, "VEC2");
    const Folder folder;
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
    ASSERT_EQ(imported->scene.meshes[0].uvs.size(), 3u);
    EXPECT_EQ(imported->scene.meshes[0].uvs[0].x, coloured ? 0.0f : 0.5f);
  }
}

TEST(GltfMaterials, SpecularGlossinessWithItsFallback) {
  Diagnostics diagnostics;
  const Material m = read_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0,
      "baseColorTexture": {"index": 2}}, "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.8, 0.6, 0.4, 0.5],
      "specularFactor": [0.25, 0.5, 0.1], "glossinessFactor": 0.75, "diffuseTexture": {"index": 0},
      "specularGlossinessTexture": {"index": 1}}}})",
                                   diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << all_text(diagnostics);
  const auto* model = std::get_if<SpecularGlossiness>(&m.model);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->diffuse, (Rgb{0.8, 0.6, 0.4}));
  EXPECT_EQ(model->specular, (Rgb{0.25, 0.5, 0.1}));
  EXPECT_EQ(model->glossiness, 0.75);
  EXPECT_EQ(m.base_alpha, 0.5);
  ASSERT_TRUE(m.base_colour_texture && m.specular_gloss_texture && m.fallback);
  EXPECT_EQ(m.base_colour_texture->encoding, Encoding::srgb);
  EXPECT_EQ(m.specular_gloss_texture->encoding, Encoding::srgb);
  EXPECT_NE(m.base_colour_texture->image, m.specular_gloss_texture->image);
  EXPECT_EQ(m.fallback->model.base_colour, (Rgb{0.5, 0.5, 0.5}));
  ASSERT_TRUE(m.fallback->base_colour_texture);

  // The extension's text: c_diff = diffuse (1 - max(specular)), F0 = specular, alpha = (1 - glossiness)^2.
  const TwoColour two = two_colour_of(*model);
  EXPECT_EQ(two.diffuse, (Rgb{0.4, 0.3, 0.2}));
  EXPECT_EQ(two.f0, model->specular);
  EXPECT_EQ(two.roughness, 0.25);
  // Mitsuba renders what the file gives for readers that do not know the extension.
  const Material twin = mitsuba_twin(m);
  ASSERT_NE(std::get_if<Principled>(&twin.model), nullptr);
  EXPECT_EQ(twin.base_colour_texture, m.fallback->base_colour_texture);
  EXPECT_FALSE(twin.specular_gloss_texture);
}

TEST(GltfMaterials, SpecularGlossinessDefaults) {
  Diagnostics diagnostics;
  const Material m = read_material(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}})", diagnostics);
  const auto* model = std::get_if<SpecularGlossiness>(&m.model);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->diffuse, (Rgb{1, 1, 1}));
  EXPECT_EQ(model->specular, (Rgb{1, 1, 1}));
  EXPECT_EQ(model->glossiness, 1);
  EXPECT_FALSE(m.fallback);
  EXPECT_EQ(two_colour_of(*model).diffuse, Rgb{}) << "what reflects everything has no diffuse part";
}

TEST(GltfMaterials, EveryLobe) {
  Diagnostics diagnostics;
  const Material m = read_material(R"({"extensions": {
      "KHR_materials_clearcoat": {"clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1, "clearcoatTexture": {"index": 0},
        "clearcoatRoughnessTexture": {"index": 1}, "clearcoatNormalTexture": {"index": 2, "scale": 0.5}},
      "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.4, "sheenColorTexture": {"index": 0},
        "sheenRoughnessTexture": {"index": 3}},
      "KHR_materials_transmission": {"transmissionFactor": 0.8, "transmissionTexture": {"index": 1}},
      "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [1, 0.9, 0.8],
        "diffuseTransmissionTexture": {"index": 1}, "diffuseTransmissionColorTexture": {"index": 2}},
      "KHR_materials_volume": {"thicknessFactor": 0.02, "attenuationDistance": 0.5, "attenuationColor": [0.9, 0.5, 0.1],
        "thicknessTexture": {"index": 3}},
      "KHR_materials_dispersion": {"dispersion": 0.33},
      "KHR_materials_specular": {"specularFactor": 0.7, "specularColorFactor": [2, 1, 0.5], "specularTexture": {"index": 1},
        "specularColorTexture": {"index": 0}},
      "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.6, "iridescenceThicknessMinimum": 200,
        "iridescenceThicknessMaximum": 600, "iridescenceTexture": {"index": 1}, "iridescenceThicknessTexture": {"index": 2}},
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 1.5, "anisotropyTexture": {"index": 3}},
      "KHR_materials_ior": {"ior": 1.4}}})",
                                   diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << all_text(diagnostics);
  const Lobes& l = m.lobes;
  ASSERT_TRUE(l.clearcoat && l.sheen && l.transmission && l.diffuse_transmission && l.volume && l.dispersion && l.specular &&
              l.iridescence && l.anisotropy);
  EXPECT_EQ(l.clearcoat->factor, 0.9);
  EXPECT_EQ(l.clearcoat->roughness, 0.1);
  ASSERT_TRUE(l.clearcoat->normal_map);
  EXPECT_EQ(l.clearcoat->normal_map->scale, 0.5);
  EXPECT_EQ(l.sheen->colour, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(l.sheen->roughness, 0.4);
  EXPECT_EQ(l.transmission->factor, 0.8);
  EXPECT_EQ(l.diffuse_transmission->factor, 0.25);
  EXPECT_EQ(l.diffuse_transmission->colour, (Rgb{1, 0.9, 0.8}));
  EXPECT_EQ(l.volume->thickness_m, 0.02);
  EXPECT_EQ(l.volume->attenuation_distance_m, 0.5);
  EXPECT_EQ(l.volume->attenuation_colour, (Rgb{0.9, 0.5, 0.1}));
  EXPECT_EQ(l.dispersion->value, 0.33);
  EXPECT_EQ(l.specular->factor, 0.7);
  EXPECT_EQ(l.specular->colour, (Rgb{2, 1, 0.5}));
  EXPECT_EQ(l.iridescence->ior, 1.6);
  EXPECT_EQ(l.iridescence->min_thickness_nm, 200);
  EXPECT_EQ(l.iridescence->max_thickness_nm, 600);
  EXPECT_EQ(l.anisotropy->strength, 0.6);
  EXPECT_EQ(l.anisotropy->rotation_rad, 1.5);

  // Colour textures are sRGB, all others linear.
  std::size_t textures = 0;
  for_each_texture(m, [&textures](const std::string& role, const Texture& texture) {
    ++textures;
    EXPECT_EQ(texture.encoding == Encoding::srgb, role.ends_with("colour")) << role;
  });
  EXPECT_EQ(textures, 14u);
}

TEST(GltfMaterials, DefaultsOfEmptyLobes) {
  Diagnostics diagnostics;
  const Material m =
      read_material(R"({"extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_volume": {}, "KHR_materials_specular": {},
      "KHR_materials_iridescence": {}, "KHR_materials_sheen": {}}})",
                    diagnostics);
  ASSERT_TRUE(m.lobes.clearcoat && m.lobes.volume && m.lobes.specular && m.lobes.iridescence && m.lobes.sheen);
  EXPECT_EQ(m.lobes.clearcoat->factor, 0);
  EXPECT_TRUE(std::isinf(m.lobes.volume->attenuation_distance_m));
  EXPECT_EQ(m.lobes.specular->factor, 1);
  EXPECT_EQ(m.lobes.iridescence->ior, 1.3);
  EXPECT_EQ(m.lobes.iridescence->min_thickness_nm, 100);
  EXPECT_EQ(m.lobes.iridescence->max_thickness_nm, 400);
  EXPECT_EQ(m.lobes.sheen->colour, Rgb{});
  EXPECT_FALSE(m.lobes.unlit);
}

// Every lobe that no picture shows is named by those who make one.
TEST(GltfMaterials, WhatNoPictureShowsHasAName) {
  Diagnostics diagnostics;
  const Material m =
      read_material(R"({"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}, "KHR_materials_sheen": {}}})", diagnostics);
  EXPECT_TRUE(m.lobes.unlit);
  std::string names;
  for (const Unshown& unshown : unshown_of(m)) names += std::string(unshown.what) + ";";
  EXPECT_EQ(names, "alpha blending;unlit;sheen;");
}

// A picture that is in WebP alone is used; beside a PNG the PNG is, and both are kept. KTX2 has no decoder here: kept and named.
TEST(GltfMaterials, PicturesOfExtensions) {
  const Folder folder;
  GltfBuilder gltf = painted(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
      "emissiveTexture": {"index": 2}, "emissiveFactor": [1, 1, 1]})");
  gltf.json["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 3}}}}}};
  gltf.json["textures"][1] = {{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 3}}}}}};
  gltf.json["textures"][2] = {{"extensions", {{"KHR_texture_basisu", {{"source", 2}}}}}};
  gltf.json["extensionsUsed"] = {"EXT_texture_webp", "KHR_texture_basisu"};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  const Scene& scene = imported->scene;
  ASSERT_EQ(scene.materials.size(), 1u);
  const Material& m = scene.materials[0];
  ASSERT_TRUE(m.base_colour_texture && m.metal_rough_texture);
  EXPECT_EQ(scene.images[m.base_colour_texture->image].name, "image 3");
  EXPECT_EQ(scene.images[m.metal_rough_texture->image].name, "image 1");
  EXPECT_FALSE(m.emissive_texture);
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/textures/2/extensions/KHR_texture_basisu"));
  EXPECT_EQ(scene.images.size(), 3u);
}

}  // namespace
}  // namespace etendue::test
