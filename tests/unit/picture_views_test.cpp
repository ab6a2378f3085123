#include "etendue/picture_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const Calibration& frostbite() {
  static const Calibration found = *calibration("frostbite");
  return found;
}

// Four pixels: 8 cd/m2 (EV 6), 4096 cd/m2 (EV 15), black, no number; and a layer of illuminances, 2.5 lx (EV 0) to 160 klx (EV 16).
Picture scene() {
  Picture picture{4, 1, {}, {}, {}};
  picture.add("", 3).pixels = {8, 8, 8, 4096, 4096, 4096, 0, 0, 0, std::nanf(""), 1, 1};
  picture.add("illuminance", 1).pixels = {2.5F, 163840, infinity, -1};
  return picture;
}

TEST(PictureViews, MeasuresAreMeters) {
  const Picture picture = scene();
  const std::vector<float> nits = *measured(picture, "", Measure::luminance, frostbite());
  EXPECT_NEAR(nits[0], 8, 1e-6);
  const std::vector<float> ev = *measured(picture, "", Measure::ev100, frostbite());
  EXPECT_NEAR(ev[0], 6, 1e-6);
  EXPECT_NEAR(ev[1], 15, 1e-6);
  EXPECT_EQ(ev[2], -infinity);
  EXPECT_TRUE(std::isnan(ev[3]));
  const std::vector<float> incident = *measured(picture, "illuminance", Measure::ev100_of_illuminance, frostbite());
  EXPECT_NEAR(incident[0], 0, 1e-6);
  EXPECT_NEAR(incident[1], 16, 1e-6);
  EXPECT_EQ(incident[2], infinity);
  EXPECT_EQ(incident[3], -infinity);
  EXPECT_EQ((*measured(picture, "illuminance", Measure::illuminance, frostbite()))[1], 163840);
}

// A picture whose white is 100 cd/m2: log2(100) more.
TEST(PictureViews, WhiteLuminanceCounts) {
  Picture picture = scene();
  picture.numbers["whiteLuminance"] = 100;
  EXPECT_NEAR((*measured(picture, "", Measure::ev100, frostbite()))[0], 6 + std::log2(100), 1e-5);
  EXPECT_EQ((*measured(picture, "illuminance", Measure::illuminance, frostbite()))[0], 2.5F);
}

TEST(PictureViews, ColoursTellWhatIsOutside) {
  const FalseColourView view = *false_colour_view(scene(), "", Measure::ev100, frostbite(), {.least = 0, .greatest = 12});
  EXPECT_EQ(view.counts, (FalseColourCounts{1, 1, 1}));
  const std::vector<float>& pixels = view.picture.find("")->pixels;
  ASSERT_EQ(pixels.size(), 12U);
  const Rgb middle = false_colour(0.5);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pixels[static_cast<std::size_t>(c)], middle[c], 1e-6);
    EXPECT_EQ(pixels[3 + static_cast<std::size_t>(c)], static_cast<float>(false_colour_above[c]));
    EXPECT_EQ(pixels[6 + static_cast<std::size_t>(c)], static_cast<float>(false_colour_below[c]));
    EXPECT_EQ(pixels[9 + static_cast<std::size_t>(c)], static_cast<float>(false_colour_of_nan[c]));
  }
}

TEST(PictureViews, BadInput) {
  const Result<FalseColourView> none = false_colour_view(scene(), "albedo", Measure::luminance, frostbite(), {.least = 0, .greatest = 1});
  EXPECT_EQ(none.error().code, "LAYER_MISSING");
  EXPECT_NE(none.error().text.find("\"illuminance\""), std::string::npos);
  EXPECT_EQ(false_colour_view(scene(), "", Measure::luminance, frostbite(), {.least = 1, .greatest = 1}).error().code, "SCALE_INVALID");
}

}  // namespace
}  // namespace etendue
