// Photometric lights of a scene: read from files and from bytes, and what Mitsuba gets of them.
#include "importers/photometric_lights/photometric_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "etendue/photometry.h"
#include "exporters/mitsuba/mitsuba.h"
#include "photometry_builder.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

const std::string text = "IESNA91\n[TEST] 1\n[MANUFAC] d\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n100 50 10\n";

Light photometric(const std::string& name, const PhotometricShape& shape) {
  Light light;
  light.name = name;
  light.shape = shape;
  return light;
}

const IntensityDistribution* distribution_of(const Light& light) { return std::get<PhotometricShape>(light.shape).distribution.get(); }

class PhotometricLights : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("photometric_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "lamp.ies") << text;
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(PhotometricLights, FilesAndEmbeddedBytesAreRead) {
  const PhotometricShape named{(folder_ / "lamp.ies").string(), {}, {}};
  const PhotometricShape embedded{"", SharedBytes(std::vector<std::uint8_t>(text.begin(), text.end())), {}};
  Scene scene;
  scene.lights = {photometric("a", named), photometric("b", named), photometric("c", embedded)};
  EXPECT_FALSE(read_photometric_lights(scene).has_errors());
  ASSERT_NE(distribution_of(scene.lights[0]), nullptr);
  EXPECT_EQ(distribution_of(scene.lights[0]), distribution_of(scene.lights[1]));  // one file, read once
  ASSERT_NE(distribution_of(scene.lights[2]), nullptr);
  EXPECT_EQ(distribution_of(scene.lights[2])->grid.values, (std::vector<double>{100, 50, 10}));
}

TEST_F(PhotometricLights, WhatCannotBeReadIsAnErrorThatNamesTheLight) {
  Scene scene;
  scene.lights = {photometric("gone", {(folder_ / "gone.ies").string(), {}, {}})};
  const Diagnostics found = read_photometric_lights(scene);
  EXPECT_TRUE(found.has_errors());
  EXPECT_TRUE(
      std::any_of(found.all().begin(), found.all().end(), [](const Diagnostic& d) { return d.text.find("'gone'") != std::string::npos; }));
  EXPECT_EQ(distribution_of(scene.lights[0]), nullptr);
}

// Five diameters of the largest side: .6 m and 3 m.
TEST_F(PhotometricLights, AnOpeningLargerThanASmallSphereIsAPointWithAWarning) {
  std::string wide = text;
  wide.replace(wide.find("2 0 0 0"), 7, "2 .3 .6 0");
  std::ofstream(folder_ / "wide.ies") << wide;
  Scene scene;
  scene.lights = {photometric("wide", {(folder_ / "wide.ies").string(), {}, {}}),
                  photometric("lamp", {(folder_ / "lamp.ies").string(), {}, {}})};
  const Diagnostics found = read_photometric_lights(scene);
  std::vector<std::string> warnings;
  for (const Diagnostic& d : found.all())
    if (d.code == "OPENING_AS_POINT") warnings.push_back(d.text);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'wide'"), std::string::npos);
  EXPECT_NE(warnings[0].find("from 3 m on"), std::string::npos) << warnings[0];
}

// A downlight of 90 degrees lights the face ahead and the four around, and leaves the sixth out.
TEST_F(PhotometricLights, MitsubaGetsAProjectorForEachLitFace) {
  Scene scene;
  scene.lights = {photometric("lamp", {(folder_ / "lamp.ies").string(), {}, {}})};
  scene.cameras.emplace_back();
  ASSERT_FALSE(read_photometric_lights(scene).has_errors());
  const auto exported = make_mitsuba_exporter()->write(scene, folder_ / "scene.xml", {});
  ASSERT_TRUE(exported) << exported.error().text;
  std::ifstream in(folder_ / "scene.xml");
  const std::string xml((std::istreambuf_iterator<char>(in)), {});
  std::size_t projectors = 0;
  for (std::size_t at = xml.find("type=\"projector\""); at != std::string::npos; at = xml.find("type=\"projector\"", at + 1)) ++projectors;
  EXPECT_EQ(projectors, 5u);
  EXPECT_NE(xml.find("sampling_weight"), std::string::npos);
  ASSERT_FALSE(exported->losses.losses.empty());
  EXPECT_NE(exported->losses.losses[0].effect.find("texels"), std::string::npos);
}

}  // namespace
}  // namespace etendue
