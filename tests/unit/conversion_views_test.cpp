// Where a converted material has changed most.
#include "etendue/conversion_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "etendue/material_conversion.h"
#include "gltf_builder.h"
#include "picture/png_rows.h"

namespace etendue {
namespace {

using test::Folder;

// 512 x 256 texels of black plastic with f0 .04, which both readers can have, and one square of a bright dielectric of another f0.
constexpr std::uint32_t width = 512, height = 256, spot_x = 320, spot_y = 64, spot_side = 64;

std::string write(const Folder& folder, const char* name, const std::function<std::uint16_t(bool in_spot, int channel)>& code) {
  const auto file = folder.path() / name;
  auto png = PngRows::open(file, width, height, 4, 8);
  EXPECT_TRUE(png);
  std::vector<std::uint16_t> codes;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) codes.push_back(code(x >= spot_x && x < spot_x + spot_side && y >= spot_y && y < spot_y + spot_side, c));
  EXPECT_TRUE(png->write(height, codes));
  EXPECT_TRUE(png->close());
  return file.string();
}

Scene with_a_spot(const Folder& folder) {
  Scene scene;
  scene.images.push_back({write(folder, "d.png", [](bool, int c) { return static_cast<std::uint16_t>(c == 0 ? 120 : 30); }), {}, "", "d"});
  scene.images.push_back({write(folder, "s.png", [](bool spot, int) { return static_cast<std::uint16_t>(spot ? 125 : 56); }), {}, "", "s"});
  Material material;
  material.name = "thing";
  material.model = SpecularGlossiness{{1, 1, 1}, {1, 1, 1}, 1};
  material.base_colour_texture = Texture{0, Encoding::srgb};
  material.specular_gloss_texture = Texture{1, Encoding::srgb};
  scene.materials.push_back(material);
  return scene;
}

TEST(ConversionView, FindsTheSpotThatACoreOnlyReaderHasOtherwise) {
  const Folder folder;
  Scene scene = with_a_spot(folder);
  const Scene before = scene;
  const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
  ASSERT_TRUE(done);
  const auto view = conversion_view(before, before.materials[0], scene, scene.materials[0]);
  ASSERT_TRUE(view) << view.error().text;
  EXPECT_EQ(view->width, width);
  EXPECT_EQ(view->height, height);
  ASSERT_EQ(view->regions.size(), 2u);
  const WorstRegion& core = view->regions[0];
  EXPECT_STREQ(core.reader, "core");
  EXPECT_TRUE(core.x <= spot_x && core.x + core.width >= spot_x + spot_side) << core.x;
  EXPECT_TRUE(core.y <= spot_y && core.y + core.height >= spot_y + spot_side) << core.y;
  // The report's rms over the whole is that of the spot's error over all texels, but for what the others are off by: a step of 8 bits.
  const double share = static_cast<double>(core.width) * core.height / (static_cast<double>(width) * height);
  const auto& said = done->changes[0].core;
  const double whole = std::sqrt((said.diffuse.rms * said.diffuse.rms + said.f0.rms * said.f0.rms) / 2);
  EXPECT_NEAR(core.rms * std::sqrt(share), whole, 5e-4);
  EXPECT_LT(view->regions[1].rms, 1.5 * full_reader_limit(8) / std::sqrt(share));
  // The last panel of the first row: pale where the spot is, dark where it is not.
  const Layer& layer = view->picture.layers[0];
  const auto brightness = [&](std::uint32_t x, std::uint32_t y) {
    const std::uint32_t column = 4 * 264 + 2 * (x - core.x), row = 2 * (y - core.y);
    const float* pixel = &layer.pixels[3 * (std::size_t{row} * view->picture.width + column)];
    return pixel[0] + pixel[1] + pixel[2];
  };
  EXPECT_GT(brightness(spot_x + spot_side / 2, spot_y + spot_side / 2), 1.5F);
  EXPECT_LT(brightness(core.x > spot_x - 8 ? spot_x + spot_side + 8 : core.x + 2, spot_y + 4), 0.5F);
}

TEST(ConversionView, OtherModelsAreRefused) {
  Scene scene;
  scene.materials.emplace_back().model = Lambert{};
  const auto view = conversion_view(scene, scene.materials[0], scene, scene.materials[0]);
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().code, "MODEL_UNSUITABLE");
}

}  // namespace
}  // namespace etendue
