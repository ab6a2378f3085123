#include "etendue/colour_config.h"
#include "etendue/camera.h"
#include "etendue/srgb.h"
#include "folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace etendue {
namespace {

const ColourConfig& config() {
  static const ColourConfig made = *ColourConfig::built_in();
  return made;
}
double largest_of(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// OpenColorIO's matrices, float, against ours, double: columns are what red, green and blue become.
TEST(ColourConfig, MatricesAreTheDoubleOnes) {
  const std::pair<const char*, ColourSpace> spaces[] = {
      {"linear Rec.709", rec709}, {"ACEScg", acescg}, {"linear Rec.2020", rec2020}, {"linear P3", p3_d65}};
  for (const auto& [from, source] : spaces)
    for (const auto& [to, target] : spaces) {
      std::vector<Vec3f> columns = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      config().conversion(from, to)->apply(columns);
      const Matrix3 exact = *conversion(source, target, ChromaticAdaptation::bradford);
      EXPECT_LE(largest_of(vec_cast<double>(columns[0]) - exact.a), 1e-6) << from << " to " << to;
      EXPECT_LE(largest_of(vec_cast<double>(columns[1]) - exact.b), 1e-6) << from << " to " << to;
      EXPECT_LE(largest_of(vec_cast<double>(columns[2]) - exact.c), 1e-6) << from << " to " << to;
    }
}

TEST(ColourConfig, HasWhatItSays) {
  const std::vector<std::string> spaces = config().spaces();
  for (const char* name : {"linear Rec.709", "sRGB texture", "ACEScg", "linear Rec.2020", "linear P3", "raw"})
    EXPECT_NE(std::find(spaces.begin(), spaces.end(), name), spaces.end()) << name;
  EXPECT_EQ(config().displays(), (std::vector<std::string>{"sRGB", "Display P3", "Rec.709"}));
  for (const std::string& display : config().displays()) EXPECT_EQ(config().views(display), (std::vector<std::string>{"Standard", "Raw"}));
  std::vector<Vec3f> pixels = {{0.5F, -0.25F, 3}};
  config().conversion("raw", "ACEScg")->apply(pixels);
  EXPECT_EQ(pixels[0], (Vec3f{0.5F, -0.25F, 3}));
}

// OpenColorIO's curve is smooth where the standard's is rounded: 2.5e-4 of values in the straight part, 1e-5 at most. Why textures are not
// decoded by it (decision 0010).
TEST(ColourConfig, SrgbCurveIsNotQuiteTheStandards) {
  std::vector<Vec3f> codes(256);
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i].x = static_cast<float>(i) / 255;
  std::vector<Vec3f> linear = codes;
  config().conversion("sRGB texture", "linear Rec.709")->apply(linear);
  double worst = 0, worst_relative = 0;
  for (std::size_t i = 1; i < codes.size(); ++i) {
    const double exact = srgb_to_linear(static_cast<double>(codes[i].x));
    worst = std::max(worst, std::abs(linear[i].x - exact));
    worst_relative = std::max(worst_relative, std::abs(linear[i].x / exact - 1));
  }
  EXPECT_LE(worst, 1e-5);
  EXPECT_LE(worst_relative, 3e-4);
  EXPECT_GE(worst_relative, 2e-4);
}

// Colours from black to three stops over white, in the display's codes. With a warm scene made white, colours beyond the gamut are among
// them: their negative channels are black on the sRGB display; for another gamut the table has lost them at its entrance, so there without.
TEST(ColourConfig, TableFollowsTheDirectChain) {
  const Calibration frostbite = *calibration("frostbite");
  const double saturation = saturation_of_ev100(6, frostbite);
  const auto value = [&](int i) { return i == 0 ? 0.0F : static_cast<float>(saturation * std::exp2((i - 22) * 0.4 + 0.123)); };
  std::vector<Vec3f> lights;
  for (int r = 0; r <= 30; ++r)
    for (int g = 0; g <= 30; ++g)
      for (int b = 0; b <= 30; ++b) lights.push_back({value(r), value(g), value(b)});
  const Matrix3 warm = *white_balance(*planckian(3000), rec709, ChromaticAdaptation::cat02), same = ViewSettings{}.white_balance;
  struct Row {
    const char* display;
    Matrix3 balance;
    int grid;
    double bound;
  };
  for (const Row& row : {Row{"sRGB", warm, 65, 0.0015},
                         {"sRGB", warm, 33, 0.006},
                         {"Display P3", same, 65, 0.0015},
                         {"Display P3", same, 33, 0.006},
                         {"Rec.709", same, 65, 0.0015},
                         {"Rec.709", same, 33, 0.006}}) {
    const ViewSettings settings{
        .exposure = exposure_of_ev100(6, frostbite), .white_balance = row.balance, .display = row.display, .view = "Standard"};
    std::vector<Vec3f> exact = lights, table = lights;
    config().view(settings)->apply(exact);
    config().baked(settings, {.grid = row.grid})->apply(table);
    double worst = 0;
    for (std::size_t i = 0; i < lights.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, static_cast<double>(std::abs(std::clamp(exact[i][c], 0.0F, 1.0F) - std::clamp(table[i][c], 0.0F, 1.0F))));
    EXPECT_LE(worst, row.bound) << row.display << " " << row.grid;
    EXPECT_GE(worst, row.bound / 4) << row.display << " " << row.grid;  // no bound that says nothing
  }
}

// The meter's luminance of a view without white balance: .125/1.2 in linear light.
TEST(ColourConfig, ViewExposes) {
  const Calibration frostbite = *calibration("frostbite");
  const float metered = static_cast<float>(luminance_of_ev100(9, frostbite));
  std::vector<Vec3f> pixels = {{metered, metered, metered}};
  config().view({.exposure = exposure_of_ev100(9, frostbite), .display = "sRGB", .view = "Standard"})->apply(pixels);
  EXPECT_NEAR(pixels[0].y, linear_to_srgb(0.125 / 1.2), 1e-5);
  pixels = {{metered, metered, metered}};
  config().view({.exposure = 2, .display = "sRGB", .view = "Raw"})->apply(pixels);
  EXPECT_EQ(pixels[0].y, 2 * metered);
}

TEST(ColourConfig, TablesAreWritten) {
  const test::Folder folder;
  const ColourStep step = *config().baked({.display = "sRGB", .view = "Standard"}, {.grid = 5});
  ASSERT_TRUE(step.write(folder.path() / "colour_config.clf").ok());
  std::ifstream written(folder.path() / "colour_config.clf");
  const std::string text((std::istreambuf_iterator<char>(written)), {});
  EXPECT_NE(text.find("<ProcessList"), std::string::npos);
  EXPECT_NE(text.find("<LUT3D"), std::string::npos);
  EXPECT_EQ(step.write(folder.path() / "colour_config.txt").error().code, "COLOUR_STEP_UNWRITABLE");
  EXPECT_EQ(step.write("/nowhere/at/all.clf").error().code, "COLOUR_STEP_UNWRITABLE");
}

// A configuration that knows no name of ours, by the role that studios' configurations have.
TEST(ColourConfig, OtherConfigurationsMeetByAces) {
  const test::Folder folder;
  const std::string spaces = R"(
displays: {d: [!<View> {name: v, colorspace: ap0}]}
colorspaces:
  - !<ColorSpace> {name: ap0}
  - !<ColorSpace> {name: doubled, to_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}}
)";
  const auto with = [&](const std::string& roles) {
    return *ColourConfig::from_file(folder.write("config.ocio", "ocio_profile_version: 2\nroles: {default: ap0" + roles + "}" + spaces));
  };
  const ColourConfig aces = with(", aces_interchange: ap0");
  std::vector<Vec3f> pixels = {{2, 2, 2}, {0.36F, 0.36F, 0.36F}}, green = {{0, 2, 0}};
  const ColourStep step = *aces.to_linear_rec709("doubled");
  step.apply(pixels);
  EXPECT_LE(largest_of(vec_cast<double>(pixels[0]) - Vec3d{1, 1, 1}), 1e-6);
  EXPECT_LE(largest_of(vec_cast<double>(pixels[1]) - Vec3d{0.18, 0.18, 0.18}), 1e-6);
  // AP0 to linear Rec.709 with Bradford: the second column as the ACES configurations of OpenColorIO have it.
  step.apply(green);
  EXPECT_LE(largest_of(vec_cast<double>(green[0]) - Vec3d{-1.13413, 1.37272, -0.15298}), 1e-3);
  EXPECT_EQ(aces.to_linear_rec709("tripled").error().code, "COLOUR_NAME_UNKNOWN");
  EXPECT_EQ(with("").to_linear_rec709("doubled").error().code, "COLOUR_CONFIG_INVALID");
  // The built-in one goes the same way, which is its own.
  std::vector<Vec3f> there = {{0.2F, 0.5F, 0.7F}}, direct = there;
  config().to_linear_rec709("ACEScg")->apply(there);
  config().conversion("ACEScg", "linear Rec.709")->apply(direct);
  EXPECT_LE(largest_of(vec_cast<double>(there[0]) - vec_cast<double>(direct[0])), 1e-6);
}

TEST(ColourConfig, BadInput) {
  EXPECT_EQ(config().conversion("linear Rec.907", "raw").error().code, "COLOUR_NAME_UNKNOWN");
  EXPECT_NE(config().conversion("linear Rec.907", "raw").error().hint.find("linear Rec.709"), std::string::npos);
  EXPECT_EQ(config().view({.display = "sRGB", .view = "Filmic"}).error().code, "COLOUR_NAME_UNKNOWN");
  EXPECT_EQ(config().view({.display = "CRT", .view = "Standard"}).error().code, "COLOUR_NAME_UNKNOWN");
  EXPECT_EQ(config().view({.exposure = HUGE_VAL, .display = "sRGB", .view = "Raw"}).error().code, "VIEW_INVALID");
  const ViewSettings good{.display = "sRGB", .view = "Standard"};
  for (const TableSettings& bad :
       {TableSettings{.grid = 2}, {.grid = 1000}, {.least_stop = 3, .greatest_stop = 3}, {.least_stop = std::nan("")}})
    EXPECT_EQ(config().baked(good, bad).error().code, "TABLE_INVALID");
  EXPECT_EQ(ColourConfig::from_file("/nowhere/config.ocio").error().code, "COLOUR_CONFIG_INVALID");
  const test::Folder folder;
  EXPECT_EQ(ColourConfig::from_file(folder.write("broken.ocio", "ocio_profile_version: 2\nroles: [")).error().code,
            "COLOUR_CONFIG_INVALID");
}

TEST(ColourConfig, TheEnvironmentOnlyWhenAsked) {
  setenv("OCIO", "/nowhere/config.ocio", 1);
  EXPECT_TRUE(ColourConfig::built_in().ok());
  EXPECT_EQ(ColourConfig::from_environment().error().code, "COLOUR_CONFIG_INVALID");
  unsetenv("OCIO");
  EXPECT_TRUE(ColourConfig::from_environment().ok());
}

}  // namespace
}  // namespace etendue
