#include "etendue/material_check.h"
#include "etendue/picture_write.h"
#include "folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

namespace etendue {
namespace {

// A PPM of `codes`, three a texel, in sRGB or linear as the slot says.
std::uint32_t add_image(Scene& scene, const test::Folder& folder, const std::string& name, int width, int height,
                        const std::string& codes) {
  const auto file = folder.write(name, "P3\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + codes + "\n");
  scene.images.push_back({file.string(), {}, {}, {}});
  return static_cast<std::uint32_t>(scene.images.size() - 1);
}

// Base colour of two by two texels, metal mask of one by two: its upper half is paint, its lower one metal.
TEST(MaterialCheck, JudgesTexelsOfTexturesOfUnequalSize) {
  const test::Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture =
      Texture{add_image(scene, folder, "base.ppm", 2, 2, "128 128 128 255 255 255 230 230 230 90 90 90"), Encoding::srgb};
  material.metal_rough_texture = Texture{add_image(scene, folder, "metal.ppm", 1, 2, "0 128 0 0 128 255"), Encoding::linear};
  const auto check = check_material(scene, material);
  ASSERT_TRUE(check) << check.error().text;
  EXPECT_EQ(check->width, 2u);
  EXPECT_EQ(check->height, 2u);
  EXPECT_EQ(check->doubtful, 2u);
  EXPECT_DOUBLE_EQ(check->share(Doubt::bright_albedo), 0.25);  // upper right
  EXPECT_DOUBLE_EQ(check->share(Doubt::gains_energy), 0.25);
  EXPECT_DOUBLE_EQ(check->share(Doubt::dim_metal), 0.25);  // lower right: sRGB 90
  EXPECT_DOUBLE_EQ(check->share(Doubt::half_metal), 0);
  EXPECT_DOUBLE_EQ(check->albedo_greatest.x, 1);
  EXPECT_DOUBLE_EQ(check->albedo_least.x, 0);
  const auto pixel = [&](std::size_t i) {
    const auto& p = check->view.layers[0].pixels;
    return Rgb{p[3 * i], p[3 * i + 1], p[3 * i + 2]};
  };
  EXPECT_EQ(pixel(1), info_of(Doubt::gains_energy).colour);
  EXPECT_NEAR(pixel(3).y, info_of(Doubt::dim_metal).colour.y, 1e-7);
  EXPECT_EQ(pixel(0).x, pixel(0).y);
}

TEST(MaterialCheck, TellsOfTransforms) {
  const test::Folder folder;
  Scene scene;
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture = Texture{add_image(scene, folder, "one.ppm", 1, 1, "128 128 128"), Encoding::srgb};
  material.metal_rough_texture = Texture{add_image(scene, folder, "two.ppm", 1, 1, "0 128 0"), Encoding::linear};
  EXPECT_TRUE(check_material(scene, material)->same_places);
  material.metal_rough_texture->uv_transform[0][0] = 2;
  EXPECT_FALSE(check_material(scene, material)->same_places);
}

TEST(MaterialCheck, MissingPicture) {
  Scene scene;
  scene.images.push_back({"/no/such/picture.png", {}, {}, {}});
  Material material;
  material.model = MetalRough{};
  material.base_colour_texture = Texture{};
  const auto check = check_material(scene, material);
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().code, "FILE_UNREADABLE");
}

TEST(WritePng, ComesBackAsSrgb) {
  Picture picture;
  picture.width = 3, picture.height = 1;
  picture.add("", 3).pixels = {0, 0.5f, 1, -1, 2, std::numeric_limits<float>::quiet_NaN(), 0.0031308f, 0.2140411f, 1};
  const test::Folder folder;
  const auto file = folder.path() / "written.png";
  ASSERT_TRUE(write_png(picture, file));
  const auto back = decode({file.string(), {}, {}, {}}, Encoding::linear);
  ASSERT_TRUE(back);
  const float expected[] = {0, 188, 255, 0, 255, 0, 10, 127, 255};  // .0031308 is 10.3 codes, .2140411 is 127.5 - 2e-6
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(back->rgba[i / 3 * 4 + i % 3] * 255, expected[i], i == 7 ? 1.001 : 1e-3) << i;
  Picture none;
  EXPECT_FALSE(write_png(none, file));
}

}  // namespace
}  // namespace etendue
