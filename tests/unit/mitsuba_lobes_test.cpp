// glTF's lobes in Mitsuba's scene files, without Mitsuba: the fits against what they are defined by, and what is written and lost.
#include "exporters/mitsuba/lobe_fits.h"
#include "exporters/mitsuba/lobes.h"
#include "exporters/mitsuba/mitsuba.h"

#include "etendue/units.h"
#include "etendue/unshown.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace etendue {
namespace {

namespace fs = std::filesystem;
using mitsuba::ShownLobes;

Material dielectric() {
  Material m;
  m.name = "tried";
  m.model = MetalRough{{0.8, 0.5, 0.2}, 0, 0.5, 1.5};
  return m;
}

const Loss* loss_named(const std::vector<Loss>& losses, const std::string& what) {
  for (const Loss& loss : losses)
    if (loss.what == what) return &loss;
  return nullptr;
}

// The peak is that of GGX as long as the width is inside the range, which ends at alpha .0037 and .216.
TEST(MitsubaLobes, CoatIsAsHighAsGgx) {
  for (const double alpha : {0.005, 0.01, 0.05, 0.1, 0.2}) {
    const double width = mitsuba::coat_width(alpha);
    EXPECT_NEAR(mitsuba::coat_peak(width) * alpha * alpha, 1, 1e-9) << alpha;
    EXPECT_GT(width, 0.001);
    EXPECT_LT(width, 0.1);
  }
  EXPECT_NEAR(mitsuba::coat_width(0), 0.001, 1e-12);
  EXPECT_NEAR(mitsuba::coat_width(1), 0.1, 1e-12);
}

// Where the coat is a mirror only F cos^2 G1^2 of the mirror's direction counts: the mean over a white sky, 2 integral of that times c dc.
TEST(MitsubaLobes, NarrowCoatIsAMirrorTimesTheCosineSquared) {
  double mirror = 0;
  for (int i = 0; i < 1000; ++i) {
    const double c = (i + 0.5) / 1000, g = 2 / (1 + std::sqrt(1 + 0.0625 * (1 / (c * c) - 1)));
    mirror += 2 * c * c * c * g * g * (0.04 + 0.96 * std::pow(1 - c, 5)) / 1000;
  }
  // Disney's lobe has long tails: at a width of 1e-60 .2 % of it is still elsewhere.
  EXPECT_NEAR(mitsuba::principled_coat_albedo(1e-60) / mirror, 1, 0.004);
  EXPECT_LT(mitsuba::principled_coat_albedo(0.1), mitsuba::principled_coat_albedo(0.001));
}

// Energy: no cloth reflects more than it gets, rough cloth more than smooth. Schlick's weight is below that of the mean angle's bound.
TEST(MitsubaLobes, SheenAlbedos) {
  double last = 0;
  for (const double roughness : {0.1, 0.3, 0.5, 0.7, 1.0}) {
    const double albedo = mitsuba::cloth_albedo(roughness);
    EXPECT_GT(albedo, last);
    EXPECT_LT(albedo, 1);
    last = albedo;
  }
  EXPECT_GT(mitsuba::principled_sheen_albedo(), 0);
  EXPECT_LT(mitsuba::principled_sheen_albedo(), 1 / 21.0);
}

TEST(MitsubaLobes, AnisotropyKeepsBothWidths) {
  for (const double strength : {0.1, 0.5, 0.9}) {
    for (const int quarter_turns : {0, 1, 2, -1}) {
      Material m = dielectric();
      m.lobes.anisotropy = Anisotropy{strength, quarter_turns * pi / 2, {}};
      const ShownLobes shown = mitsuba::shown_lobes(m, 2);
      EXPECT_TRUE(shown.losses.empty());
      const double alpha = 0.25, along = alpha + 0.75 * strength * strength;
      const double aspect = std::sqrt(1 - 0.9 * shown.anisotropic), r2 = *shown.roughness * *shown.roughness;
      const bool across = quarter_turns % 2 != 0;
      EXPECT_NEAR(r2 / aspect, across ? alpha : along, 1e-12);
      EXPECT_NEAR(r2 * aspect, across ? along : alpha, 1e-12);
    }
  }
  Material m = dielectric();
  m.lobes.anisotropy = Anisotropy{0.5, pi / 6, {}};
  const ShownLobes shown = mitsuba::shown_lobes(m, 2);
  ASSERT_EQ(shown.losses.size(), 1u);
  EXPECT_EQ(shown.losses[0].effect, "the direction is 30 degrees off: a multiple of 90 is shown");
}

// What the surface is made of adds up to the extensions' shares, and to 1.
TEST(MitsubaLobes, SharesOfTransmission) {
  for (const double metal : {0.0, 0.3}) {
    for (const double t : {0.0, 0.4, 1.0}) {
      for (const double f : {0.0, 0.6, 1.0}) {
        Material m = dielectric();
        std::get<MetalRough>(m.model).metallic = metal;
        m.lobes.transmission = Transmission{t, {}};
        m.lobes.diffuse_transmission = DiffuseTransmission{f, {1, 1, 1}, {}, {}};
        const ShownLobes shown = mitsuba::shown_lobes(m, 5);
        const double passed = shown.passed, diffused = (1 - passed) * shown.diffused, reflecting = (1 - passed) * (1 - shown.diffused);
        EXPECT_NEAR(passed, (1 - metal) * t, 1e-12);
        EXPECT_NEAR(diffused, (1 - metal) * (1 - t) * f, 1e-12);
        EXPECT_NEAR(reflecting * shown.metallic.value_or(metal), metal, 1e-12);
        EXPECT_NEAR(reflecting * (1 - shown.metallic.value_or(metal)), (1 - metal) * (1 - t) * (1 - f), 1e-12);
      }
    }
  }
}

TEST(MitsubaLobes, AbsorptionIsBeersLaw) {
  Material m = dielectric();
  m.lobes.transmission = Transmission{1, {}};
  m.lobes.volume = Volume{0.01, 0.02, {0.5, 1, 0.1}, {}};
  const auto absorption = mitsuba::absorption_of(m);
  ASSERT_TRUE(absorption);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::exp(-(*absorption)[c] * 0.02), m.lobes.volume->attenuation_colour[c], 1e-12);
  m.lobes.volume->thickness_m = 0;
  EXPECT_FALSE(mitsuba::absorption_of(m)) << "a thin wall absorbs nothing";
  m.lobes.volume->thickness_m = 0.01;
  m.lobes.transmission.reset();
  EXPECT_FALSE(mitsuba::absorption_of(m)) << "nothing gets in";
}

// Each lobe on its own: shown exactly, shown with a rest that has a number, or lost as in our pictures.
TEST(MitsubaLobes, EachIsShownOrLost) {
  const auto rest_of = [](const Material& m) { return mitsuba::shown_lobes(m, -1).losses; };
  Material m = dielectric();
  m.blended = true;
  EXPECT_TRUE(rest_of(m).empty());

  m = dielectric();
  m.lobes.specular = Specular{1, {0.5, 0.5, 0.5}, {}, {}};
  EXPECT_TRUE(rest_of(m).empty());
  EXPECT_NEAR(0.08 * *mitsuba::shown_lobes(m, -1).specular, 0.02, 1e-15);
  m.lobes.specular->colour = {1, 0.5, 0.25};
  ASSERT_EQ(rest_of(m).size(), 1u);
  EXPECT_NE(rest_of(m)[0].effect.find("instead of (0.04, 0.02, 0.01)"), std::string::npos) << rest_of(m)[0].effect;

  m = dielectric();
  m.lobes.clearcoat = Clearcoat{};
  m.lobes.clearcoat->factor = 0.5;
  m.lobes.clearcoat->roughness = 0.9;  // wider than any of Mitsuba's
  ASSERT_EQ(rest_of(m).size(), 1u);
  EXPECT_NE(rest_of(m)[0].effect.find("instead of 0.0429"), std::string::npos) << rest_of(m)[0].effect;  // .5 (.04 + .96 / 21)
  EXPECT_NE(rest_of(m)[0].effect.find("times as high"), std::string::npos);

  m = dielectric();
  m.lobes.iridescence = Iridescence{1, 1.3, 100, 400, {}, {}};
  m.lobes.dispersion = Dispersion{1};
  m.lobes.unlit = true;
  const std::vector<Loss> lost = rest_of(m), ours = unshown_losses(m);
  ASSERT_EQ(lost.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(lost[i].effect, ours[i].effect);

  // A texture that has no place leaves the lobe out.
  m = dielectric();
  m.lobes.sheen = Sheen{{0.2, 0.2, 0.2}, 0.5, {}, {}};
  EXPECT_GT(mitsuba::shown_lobes(m, -1).sheen, 0);
  m.lobes.sheen->colour_texture = Texture{};
  EXPECT_EQ(mitsuba::shown_lobes(m, -1).sheen, 0);
  ASSERT_EQ(rest_of(m).size(), 1u);
  EXPECT_EQ(rest_of(m)[0].effect, unshown_losses(m)[0].effect);
}

// A mesh has one set of coordinates: a lobe with a texture on another one is left out.
TEST(MitsubaLobes, OneSetOfCoordinates) {
  Material m = dielectric();
  m.lobes.transmission = Transmission{1, Texture{}};
  EXPECT_EQ(mitsuba::shown_lobes(m, -1).passed, 1);
  m.lobes.transmission->factor_texture->uv_set = 1;
  EXPECT_EQ(mitsuba::shown_lobes(m, -1).passed, 1) << "nothing else has a texture";
  m.base_colour_texture = Texture{};
  const ShownLobes shown = mitsuba::shown_lobes(m, -1);
  EXPECT_EQ(shown.passed, 0);
  ASSERT_EQ(shown.losses.size(), 1u);
  EXPECT_EQ(shown.losses[0].effect, unshown_losses(m)[0].effect);
}

// What `validate` compares with has no lobes, what `convert` writes has.
TEST(MitsubaLobes, OnlyWhereAskedFor) {
  const fs::path folder = fs::temp_directory_path() / ("etendue-lobes-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  Scene scene;
  Material m = dielectric();
  m.lobes.clearcoat = Clearcoat{};
  m.lobes.clearcoat->factor = 1;
  m.lobes.transmission = Transmission{0.5, {}};
  scene.materials.push_back(m);
  Object box;
  box.geometry = BoxGeometry{{1, 1, 1}};
  box.material = 0;
  scene.objects.push_back(box);
  const auto text_of = [&](MitsubaLobes lobes) {
    const auto written = make_mitsuba_exporter(MitsubaParts::built_in, lobes)->write(scene, folder / "scene.xml", {});
    EXPECT_TRUE(written.ok());
    if (!written.ok()) return std::string();
    EXPECT_NE(loss_named(written->losses.losses, "material 'tried': clearcoat"), nullptr);
    std::ifstream in(folder / "scene.xml");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string ours = text_of(MitsubaLobes::as_ours), shown = text_of(MitsubaLobes::as_far_as_can_be);
  for (const char* part : {"clearcoat", "blendbsdf", "principledthin"}) {
    EXPECT_EQ(ours.find(part), std::string::npos) << part;
    EXPECT_NE(shown.find(part), std::string::npos) << part;
  }
  // `twosided` refuses what transmits: it is inside the blend.
  EXPECT_LT(shown.find("blendbsdf"), shown.find("twosided"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace etendue
