// Colour textures of other spaces become sRGB and linear Rec.709.
#include "etendue/texture_space.h"

#include "etendue/picture_write.h"
#include "etendue/srgb.h"
#include "exporters/gltf/gltf.h"
#include "folder.h"
#include "gltf_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace etendue {
namespace {

using test::Folder;

ColourStep from(const std::string& space) { return *ColourConfig::built_in()->to_linear_rec709(space); }

// A PPM of `codes`, three a texel.
std::uint32_t add_image(Scene& scene, const Folder& folder, const std::string& name, int width, const std::string& codes) {
  const auto file = folder.write(name + ".ppm", "P3\n" + std::to_string(width) + " 1\n255\n" + codes + "\n");
  scene.images.push_back({file.string(), {}, {}, name});
  return static_cast<std::uint32_t>(scene.images.size() - 1);
}

Texture coloured(std::uint32_t image) {
  Texture texture;
  texture.image = image;
  texture.encoding = Encoding::srgb;
  return texture;
}

DecodedImage decoded(const Scene& scene, const Texture& texture) { return *decode(scene.images[texture.image], texture.encoding); }
Vec3d texel(const DecodedImage& image, std::size_t i) {
  return {static_cast<double>(image.rgba[4 * i]), static_cast<double>(image.rgba[4 * i + 1]), static_cast<double>(image.rgba[4 * i + 2])};
}

// Linear codes in ACEScg, against the matrix in double. Half a step of 16 bits is 1.2e-5 of linear light where sRGB's curve is steepest, at
// 1, and float's matrix is within 1e-6.
TEST(TextureSpace, WholeNumbersBecomeSrgb) {
  const Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture = coloured(add_image(scene, folder, "base", 3, "255 255 255 128 100 64 20 40 30"));
  scene.materials.push_back(material);
  const auto losses = convert_colour_textures(scene, from("ACEScg"), {folder.path() / "new"});
  ASSERT_TRUE(losses) << losses.error().text;
  EXPECT_TRUE(losses->losses.empty());
  const Texture& texture = *scene.materials[0].base_colour_texture;
  EXPECT_EQ(texture.encoding, Encoding::srgb);
  EXPECT_TRUE(scene.images[texture.image].file.ends_with(".png"));
  const DecodedImage image = decoded(scene, texture);
  const Matrix3 exact = *conversion(acescg, rec709, ChromaticAdaptation::bradford);
  const Vec3d codes[] = {{255, 255, 255}, {128, 100, 64}, {20, 40, 30}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d expected = exact * codes[i] / 255;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(texel(image, i)[c], std::min(expected[c], 1.0), 1.9e-5) << i << ' ' << c;
  }
}

// ACEScg's green is outside, by what the matrix says; its white is not.
TEST(TextureSpace, WhatSrgbDoesNotHoldIsCounted) {
  const Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture = coloured(add_image(scene, folder, "moss", 3, "255 255 255 0 255 0 0 255 0"));
  scene.materials.push_back(material);
  const auto losses = convert_colour_textures(scene, from("ACEScg"), {folder.path()});
  ASSERT_TRUE(losses);
  ASSERT_EQ(losses->losses.size(), 1u);
  EXPECT_NE(losses->losses[0].what.find("moss"), std::string::npos);
  EXPECT_TRUE(losses->losses[0].effect.starts_with("2 of 3 texels")) << losses->losses[0].effect;
  const Vec3d green = *conversion(acescg, rec709, ChromaticAdaptation::bradford) * Vec3d{0, 1, 0};
  const double most = std::max(-green.x, green.y - 1);
  EXPECT_NE(losses->losses[0].effect.find(std::to_string(most).substr(0, 4)), std::string::npos) << losses->losses[0].effect;
  const DecodedImage image = decoded(scene, *scene.materials[0].base_colour_texture);
  EXPECT_EQ(image.rgba[4], 0.0f);
  EXPECT_EQ(image.rgba[5], 1.0f);
}

// One picture for base colour and, as data, for metal and roughness; a second material with the same.
TEST(TextureSpace, DataStaysAndEachPictureIsWrittenOnce) {
  const Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  const std::uint32_t image = add_image(scene, folder, "packed", 1, "10 128 200");
  material.base_colour_texture = coloured(image);
  material.metal_rough_texture = Texture{};
  material.metal_rough_texture->image = image;
  material.lobes.specular = Specular{};
  material.lobes.specular->colour_texture = coloured(image);
  material.lobes.specular->factor_texture = material.metal_rough_texture;
  scene.materials = {material, material};
  ASSERT_TRUE(convert_colour_textures(scene, from("linear P3"), {folder.path()}));
  ASSERT_EQ(scene.images.size(), 2u);
  for (const Material& m : scene.materials) {
    EXPECT_EQ(m.base_colour_texture->image, 1u);
    EXPECT_EQ(m.lobes.specular->colour_texture->image, 1u);
    EXPECT_EQ(*m.metal_rough_texture, *material.metal_rough_texture);
    EXPECT_EQ(*m.lobes.specular->factor_texture, *material.metal_rough_texture);
  }
}

// Numbers below 0 and beyond 1 stay so in OpenEXR, which nothing decodes as sRGB.
TEST(TextureSpace, FloatsStayFloats) {
  const Folder folder;
  Scene scene;
  Picture picture;
  picture.width = 100, picture.height = 70;  // more than a band
  std::vector<float>& pixels = picture.add("", 3).pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(static_cast<int>(i * 37 % 101) - 20) / 10;
  const auto file = folder.path() / "emission.exr";
  ASSERT_TRUE(write_exr(picture, file));
  scene.images.push_back({file.string(), {}, {}, "emission"});
  Light light;
  light.emission.texture = coloured(0);
  scene.lights.push_back(light);
  const auto losses = convert_colour_textures(scene, from("ACEScg"), {folder.path() / "new"});
  ASSERT_TRUE(losses) << losses.error().text;
  EXPECT_TRUE(losses->losses.empty());
  const Texture& texture = *scene.lights[0].emission.texture;
  const DecodedImage image = decoded(scene, texture);
  ASSERT_EQ(image.rgba.size(), std::size_t{100} * 70 * 4);
  const Matrix3 exact = *conversion(acescg, rec709, ChromaticAdaptation::bradford);
  for (std::size_t i = 0; i < std::size_t{100} * 70; ++i) {
    const float* rgb = picture.layers[0].pixels.data() + 3 * i;
    const Vec3d expected = exact * Vec3d{static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
    // Three products of numbers up to 8 and coefficients up to 1.8, in float.
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(texel(image, i)[c], expected[c], 1e-5) << i;
  }
}

TEST(TextureSpace, WhatIsWrongIsSaid) {
  const Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture = coloured(0);
  scene.materials.push_back(material);
  scene.images.push_back({"/no/such/picture.png", {}, {}, {}});
  EXPECT_EQ(convert_colour_textures(scene, from("ACEScg"), {folder.path()}).error().code, "FILE_UNREADABLE");
  scene.materials[0].base_colour_texture = coloured(add_image(scene, folder, "base", 1, "1 2 3"));
  folder.write("there", "");
  EXPECT_EQ(convert_colour_textures(scene, from("ACEScg"), {folder.path() / "there"}).error().code, "FILE_UNWRITABLE");
  struct Stop : Progress {
    bool report(std::string_view, double) override { return false; }
  } stop;
  TextureSpaceOptions options{folder.path()};
  options.progress = &stop;
  EXPECT_EQ(convert_colour_textures(scene, from("ACEScg"), options).error().code, "CANCELLED");
}

// A document whose materials keep their model refers to the new pictures where the old ones were looked up; normals keep theirs.
TEST(TextureSpace, GltfDocumentsFollow) {
  const Folder folder;
  test::GltfBuilder gltf;
  gltf.triangle();
  const int uvs = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["attributes"]["TEXCOORD_0"] = uvs;
  gltf.primitive()["material"] = 0;
  for (const char* name : {"colour", "normal"}) {
    Picture picture;
    picture.width = picture.height = 1;
    picture.add("", 3).pixels = {0.2f, 0.5f, 0.4f};
    ASSERT_TRUE(write_png(picture, folder.path() / (std::string(name) + ".png")));
  }
  gltf.json["images"] = test::Json::array({{{"uri", "colour.png"}}, {{"uri", "normal.png"}}});
  gltf.json["samplers"] = test::Json::array({{{"wrapS", 33071}}});
  gltf.json["textures"] = test::Json::array({{{"source", 0}, {"sampler", 0}}, {{"source", 1}}});
  gltf.json["materials"] = test::Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                               {"emissiveFactor", {1, 1, 1}},
                                               {"emissiveTexture", {{"index", 0}}},
                                               {"normalTexture", {{"index", 1}}}}});
  const auto in = folder.write("in.gltf", gltf.text());
  auto imported = make_gltf_importer(GltfMaterials::all)->read(in, {});
  ASSERT_TRUE(imported) << imported.error().text;
  ASSERT_TRUE(convert_colour_textures(imported->scene, from("ACEScg"), {folder.path() / "new", 8}));
  ASSERT_TRUE(make_gltf_exporter()->write(imported->scene, folder.path() / "out.glb", {}));
  const auto back = make_gltf_importer(GltfMaterials::all)->read(folder.path() / "out.glb", {});
  ASSERT_TRUE(back) << back.error().text;
  ASSERT_EQ(back->scene.images.size(), 2u);
  const Material& material = back->scene.materials[0];
  EXPECT_EQ(material.base_colour_texture->wrap_u, Wrap::clamp);
  EXPECT_EQ(material.base_colour_texture->image, material.emissive_texture->image);
  const Material& before = imported->scene.materials[0];
  EXPECT_EQ(decoded(back->scene, *material.base_colour_texture).rgba, decoded(imported->scene, *before.base_colour_texture).rgba);
  EXPECT_EQ(decoded(back->scene, material.normal_map->texture).rgba, decoded(imported->scene, before.normal_map->texture).rgba);
  EXPECT_NE(decoded(back->scene, *material.base_colour_texture).rgba,
            decoded(back->scene, coloured(material.normal_map->texture.image)).rgba);
}

}  // namespace
}  // namespace etendue
