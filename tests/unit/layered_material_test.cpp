// Layers of materials baked to textures.
#include "etendue/layered_material.h"

#include "etendue/material_parameters.h"
#include "etendue/normal_filter.h"
#include "etendue/picture.h"
#include "folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace etendue {
namespace {

constexpr float half_step = 0.5f / 255;

struct Stack {
  test::Folder folder;
  LayeredMaterial material;
  std::vector<ImageRef> images;

  // A PPM of `codes`, three a texel.
  Texture picture(const std::string& name, int width, int height, const std::string& codes, Encoding encoding = Encoding::linear) {
    const auto file = folder.write(name, "P3\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + codes + "\n");
    images.push_back({file.string(), {}, {}, {}});
    Texture texture;
    texture.image = static_cast<std::uint32_t>(images.size() - 1);
    texture.encoding = encoding;
    texture.nearest = true;
    return texture;
  }
  MaterialLayer& add(const SurfaceModel& model) {
    material.layers.emplace_back();
    material.layers.back().material.model = model;
    return material.layers.back();
  }
  Result<BakedMaterial> bake(std::uint32_t width, std::uint32_t height, unsigned threads = 1, int bits = 8) const {
    return bake_layers(material, images, {width, height, folder.path(), bits, threads});
  }
};

DecodedImage decoded(const BakedMaterial& baked, const Texture& texture) { return *decode(baked.images[texture.image], texture.encoding); }
Rgb texel(const DecodedImage& image, std::size_t i) { return {image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]}; }

// Left steel, right rust, in the middle half of both.
TEST(LayeredMaterial, MasksChooseBetweenLayers) {
  Stack stack;
  const Standard steel{{0.5, 0.6, 0.7}, 1, 0.2, 0.5}, rust{{0.25, 0.09, 0.04}, 0, 0.8, 0.5};
  stack.add(steel);
  stack.add(rust).mask = stack.picture("mask.ppm", 3, 1, "0 9 9 128 9 9 255 9 9");
  const auto baked = stack.bake(3, 1);
  ASSERT_TRUE(baked) << baked.error().text;
  EXPECT_EQ(baked->samples, 1);
  EXPECT_FALSE(baked->material.normal_map);
  EXPECT_FALSE(baked->material.lobes.specular);
  EXPECT_NEAR(std::get<MetalRough>(baked->material.model).ior, 1.5, 1e-12);
  const DecodedImage base = decoded(*baked, *baked->material.base_colour_texture);
  const DecodedImage surface = decoded(*baked, *baked->material.metal_rough_texture);
  const double shares[] = {0, 128 / 255.0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    const Rgb expected = steel.base_colour * (1 - shares[i]) + rust.base_colour * shares[i];
    // sRGB steps are widest at 1: 2.4 / 1.055 / 255.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(texel(base, i)[c], expected[c], 0.5 * 2.28 / 255) << i;
    EXPECT_NEAR(texel(surface, i).x, 1, half_step);
    EXPECT_NEAR(texel(surface, i).y, 0.2 + 0.6 * shares[i], half_step + 1e-6);
    EXPECT_NEAR(texel(surface, i).z, 1 - shares[i], half_step + 1e-6);
  }
}

TEST(LayeredMaterial, TexturesRepeatByTheirScale) {
  Stack stack;
  MaterialLayer& tiles = stack.add(MetalRough{{1, 1, 1}, 0, 0.5, 1.5});
  tiles.material.base_colour_texture = stack.picture("tiles.ppm", 2, 1, "200 0 0 0 100 0", Encoding::srgb);
  tiles.uv_scale = 2;
  const auto baked = stack.bake(4, 2);
  ASSERT_TRUE(baked) << baked.error().text;
  const DecodedImage base = decoded(*baked, *baked->material.base_colour_texture);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(texel(base, i).x, i % 2 == 0 ? texel(base, 0).x : 0, 1e-6);
    EXPECT_NEAR(texel(base, i).y, i % 2 == 1 ? texel(base, 1).y : 0, 1e-6);
  }
  EXPECT_GT(texel(base, 0).x, 0.5);
}

// Two texels of opposite slopes under one: level again, and rougher, as the filter has it.
TEST(LayeredMaterial, NormalsTooFineBecomeRoughness) {
  Stack stack;
  MaterialLayer& rough = stack.add(Standard{{0.5, 0.5, 0.5}, 0, 0.3, 0.5});
  rough.material.normal_map = NormalMap{stack.picture("normals.ppm", 2, 2, "179 128 230 76 128 230 179 128 230 76 128 230"), 1};
  const auto baked = stack.bake(1, 1, 1, 16);
  ASSERT_TRUE(baked) << baked.error().text;
  EXPECT_EQ(baked->samples, 2);
  const Vec3d slope = normalised(Vec3d{2 * 179 / 255.0 - 1, 2 * 128 / 255.0 - 1, 2 * 230 / 255.0 - 1});
  const double spread = std::hypot(slope.y, slope.z);
  const double expected = std::sqrt(filtered_lobe(0.09, spread).alpha);
  EXPECT_GT(expected, 0.4);
  // 76 is a quarter of a code from the mirror image of 179.
  EXPECT_NEAR(texel(decoded(*baked, *baked->material.metal_rough_texture), 0).y, expected, 2e-3);
  EXPECT_NEAR(texel(decoded(*baked, baked->material.normal_map->texture), 0).x, 0.5, 2e-3);
}

TEST(LayeredMaterial, ReflectancesEmissionAndOcclusion) {
  Stack stack;
  stack.add(Standard{{0.2, 0.2, 0.2}, 0, 0.3, 1});
  MaterialLayer& glow = stack.add(Standard{{0.2, 0.2, 0.2}, 0, 0.3, 0.5});
  glow.opacity = 0.5;
  glow.material.emissive = {100, 50, 0};
  glow.material.occlusion = Occlusion{stack.picture("occlusion.ppm", 1, 1, "51 0 0"), 0.5};
  glow.material.lobes.clearcoat = Clearcoat{};
  glow.material.lobes.clearcoat->factor = 1;
  const auto baked = stack.bake(1, 1, 1, 16);
  ASSERT_TRUE(baked) << baked.error().text;
  const Material& m = baked->material;
  ASSERT_TRUE(m.lobes.specular && m.lobes.specular->colour_texture && m.emissive_texture && m.occlusion);
  const double f0 = f0_of_ior(std::get<MetalRough>(m.model).ior) * texel(decoded(*baked, *m.lobes.specular->colour_texture), 0).x;
  EXPECT_NEAR(f0, 0.16 * 0.75 * 0.75, 1e-5);  // the mean reflectance
  const Rgb emitted = m.emissive * texel(decoded(*baked, *m.emissive_texture), 0);
  EXPECT_NEAR(emitted.x, 50, 0.01);
  EXPECT_NEAR(emitted.y, 25, 0.01);
  EXPECT_NEAR(texel(decoded(*baked, m.occlusion->texture), 0).x, 0.8, 1e-4);  // half of (1 + half of .2 - 1)
  ASSERT_EQ(baked->losses.losses.size(), 1u);
  EXPECT_NE(baked->losses.losses[0].what.find("clearcoat"), std::string::npos);
}

TEST(LayeredMaterial, ThreadsDoNotMatter) {
  Stack stack;
  stack.add(Standard{{0.5, 0.6, 0.7}, 1, 0.2, 0.5});
  stack.add(Standard{{0.25, 0.09, 0.04}, 0, 0.8, 0.5}).mask = stack.picture("mask.ppm", 2, 2, "0 0 0 90 0 0 200 0 0 255 0 0");
  stack.material.layers[1].mask->nearest = false;
  const auto bytes = [](const BakedMaterial& baked) {
    std::ifstream in(baked.images[1].file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto one = stack.bake(70, 90, 1);
  ASSERT_TRUE(one);
  const std::string expected = bytes(*one);
  const auto three = stack.bake(70, 90, 3);
  ASSERT_TRUE(three);
  EXPECT_EQ(bytes(*three), expected);
}

TEST(LayeredMaterial, WhatIsWrongIsSaid) {
  Stack none;
  EXPECT_EQ(none.bake(1, 1).error().code, "LAYERS_INVALID");
  Stack stack;
  stack.add(Standard{}).uv_scale = 0;
  EXPECT_EQ(stack.bake(1, 1).error().code, "LAYERS_INVALID");
  stack.material.layers[0].uv_scale = 1;
  EXPECT_EQ(stack.bake(0, 1).error().code, "LAYERS_INVALID");
  EXPECT_EQ(stack.bake(1, 1, 1, 12).error().code, "LAYERS_INVALID");
  stack.material.layers[0].mask = Texture{};
  EXPECT_EQ(stack.bake(1, 1).error().code, "LAYERS_INVALID");  // of no image
  stack.images.push_back({"/no/such/picture.png", {}, {}, {}});
  EXPECT_EQ(stack.bake(1, 1).error().code, "FILE_UNREADABLE");

  Picture picture;
  picture.width = 2, picture.height = 1;
  picture.add("", 3).pixels = {1, 1, 1, 1, std::nanf(""), 1};
  const auto file = stack.folder.path() / "nan.exr";
  ASSERT_TRUE(write_exr(picture, file));
  stack.images[0].file = file.string();
  const Error error = stack.bake(1, 1).error();
  EXPECT_EQ(error.code, "PICTURE_UNSUITABLE");
  EXPECT_NE(error.text.find("(1, 0)"), std::string::npos);

  struct Stop : Progress {
    bool report(std::string_view, double fraction) override { return fraction == 0; }
  } stop;
  Stack big;
  big.add(Standard{});
  const test::Folder empty;
  BakeOptions options{8, 200, empty.path()};
  options.progress = &stop;
  EXPECT_EQ(bake_layers(big.material, {}, options).error().code, "CANCELLED");
  EXPECT_TRUE(std::filesystem::is_empty(options.folder));
}

}  // namespace
}  // namespace etendue
