// Photometric files written: bit-exact within a format, a few units in the last place across.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "etendue/photometric_transform.h"
#include "exporters/eulumdat/eulumdat.h"
#include "exporters/ies/ies.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "photometry_builder.h"
#include "source_dir.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using test::distribution_of;
using test::steps;

IntensityDistribution read_back(const PhotometricText& text, bool ies) {
  const auto bytes = std::as_bytes(std::span(text.text));
  const auto file = ies ? read_ies(bytes, "again.ies") : read_eulumdat(bytes, "again.ldt");
  EXPECT_TRUE(file) << file.error().text << to_string(file.error().where);
  return file ? file->distribution : IntensityDistribution{};
}

// Values as different as a double can hold.
double wild(const Vec3d& u) { return 1000 / 3.0 * (1.5 + std::sin(7 * u.x + 2 * u.z) * std::cos(3 * u.y)) * std::exp(3 * u.z); }

IntensityDistribution eulumdat_of(const IntensityGrid& grid, int symmetry) {
  IntensityDistribution d;
  EulumdatRecord r;
  r.company = "maker";
  r.symmetry = symmetry;
  r.lamp_sets = {{1, "LED", 1234.5, "840", "80", 11}, {2, "LED", 777, "830", "90", 9}};
  r.opening_length_mm = 1200;
  r.opening_width_mm = 100;
  r.direct_ratios = std::array<double, 10>{.1, .2, .3};
  const auto full = unfolded(grid);
  r.c_deg.assign(full->horizontal_deg.begin(), full->horizontal_deg.end() - 1);
  d.grid = grid;
  d.record = r;
  return d;
}

TEST(PhotometryExport, IesComesBackToTheLastBitInEveryVersion) {
  for (const IesVersion version :
       {IesVersion::lm_63_1986, IesVersion::lm_63_1991, IesVersion::lm_63_1995, IesVersion::lm_63_2002, IesVersion::lm_63_2019}) {
    for (const WebType type : {WebType::a, WebType::b, WebType::c}) {
      IntensityDistribution d = type == WebType::c
                                    ? distribution_of(type, WebSymmetry::none, steps(0, 180, 7.5), steps(0, 360, 22.5), wild)
                                    : distribution_of(type, WebSymmetry::lateral, steps(-90, 90, 7.5), steps(0, 90, 0.1 * 9), wild);
      if (type == WebType::c)  // the last plane repeats the first
        for (std::size_t i = 0; i < d.grid.vertical_deg.size(); ++i)
          d.grid.values[d.grid.values.size() - d.grid.vertical_deg.size() + i] = d.grid.values[i];
      if (type != WebType::c) d.grid.horizontal_deg.back() = 90;
      auto& ies = std::get<IesRecord>(d.record);
      ies.version = version;
      ies.multiplier = 1 / 3.0;
      ies.ballast_factor = 0.95;
      ies.lumens_per_lamp = 1234.56789;
      ies.watts = 0.1 + 0.2;
      ies.width = -0.3048;
      ies.feet = true;
      ies.keywords = {{version == IesVersion::lm_63_1986 ? "" : "TEST", "some test"}};
      ies.tilt = LampTilt{"", 2, {0, 45, 90}, {1, 0.9, 1 / 1.3}};
      PhotometricWriteOptions options;
      options.version = version;
      const auto text = write_ies(d, options);
      ASSERT_TRUE(text) << text.error().text;
      const IntensityDistribution again = read_back(*text, true);
      EXPECT_EQ(again.grid.values, d.grid.values);
      EXPECT_EQ(again.grid.vertical_deg, d.grid.vertical_deg);
      EXPECT_EQ(again.grid.horizontal_deg, d.grid.horizontal_deg);
      EXPECT_EQ(again.grid.type, type);
      const auto& r = std::get<IesRecord>(again.record);
      EXPECT_EQ(r.version, version);
      EXPECT_EQ(r.multiplier, ies.multiplier);
      EXPECT_EQ(r.lumens_per_lamp, ies.lumens_per_lamp);
      EXPECT_EQ(r.watts, ies.watts);
      EXPECT_EQ(r.width, ies.width);
      EXPECT_EQ(r.keywords, ies.keywords);
      EXPECT_EQ(r.tilt->factors, ies.tilt->factors);
    }
  }
}

TEST(PhotometryExport, AFirstLabelOf1986IsNotTakenForItsVersion) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const std::string& label :
       {std::string("IESNA:LM-63-1995"), std::string(" ies of a lamp"), mark + "IESNA:LM-63-1995", mark + "lamp"}) {
    IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 90, 15), {0}, wild);
    auto& ies = std::get<IesRecord>(d.record);
    ies.version = IesVersion::lm_63_1986;
    ies.third_factor = 5;  // multiplies in 1986 and 1991 alone
    ies.keywords = {{"", label}};
    PhotometricWriteOptions options;
    options.version = ies.version;
    const auto text = write_ies(d, options);
    ASSERT_TRUE(text);
    const IntensityDistribution again = read_back(*text, true);
    EXPECT_EQ(std::get<IesRecord>(again.record).version, IesVersion::lm_63_1986) << label;
    EXPECT_EQ(std::get<IesRecord>(again.record).keywords.back().text, label.substr(label.find_first_not_of(' ')));
    EXPECT_EQ(candelas_per_value(again), candelas_per_value(d)) << label;
  }
}

TEST(PhotometryExport, EulumdatComesBackToTheLastBit) {
  const struct {
    int code;
    WebSymmetry symmetry;
    std::vector<double> planes;
  } cases[] = {{0, WebSymmetry::none, steps(0, 345, 15)},
               {1, WebSymmetry::rotational, {0}},
               {2, WebSymmetry::about_0_180, steps(0, 180, 15)},
               {3, WebSymmetry::about_90_270, steps(-90, 90, 15)},
               {4, WebSymmetry::quadrant, steps(0, 90, 15)}};
  for (const auto& [code, symmetry, planes] : cases) {
    const IntensityDistribution d = eulumdat_of(distribution_of(WebType::c, symmetry, steps(0, 180, 5), planes, wild).grid, code);
    const auto text = write_eulumdat(d);
    ASSERT_TRUE(text);
    EXPECT_TRUE(text->losses.losses.empty());
    const IntensityDistribution again = read_back(*text, false);
    EXPECT_EQ(again.grid.values, d.grid.values) << code;
    EXPECT_EQ(again.grid.horizontal_deg, d.grid.horizontal_deg) << code;
    EXPECT_EQ(again.grid.symmetry, symmetry);
    const auto &a = std::get<EulumdatRecord>(again.record), &b = std::get<EulumdatRecord>(d.record);
    EXPECT_EQ(a.c_deg, b.c_deg);
    EXPECT_EQ(a.lamp_sets[0].flux_lm, b.lamp_sets[0].flux_lm);
    EXPECT_EQ(a.lamp_sets[1].type, b.lamp_sets[1].type);
    EXPECT_EQ(a.direct_ratios, b.direct_ratios);
  }
}

// Across formats a plane keeps its light; its C angle turns by 90 degrees from one convention to the other.
void expect_same_light(const IntensityDistribution& from, const IntensityDistribution& to, double turn_deg, const char* what) {
  const IntensityWeb before = test::web_of(from), after = test::web_of(to);
  EXPECT_NEAR(after.flux_lm() / before.flux_lm(), 1, 1e-14) << what;
  for (double c = 0; c < 360; c += 7.5)
    for (double gamma = 0; gamma <= 180; gamma += 2.5)
      EXPECT_NEAR(after.at(c + turn_deg, gamma), before.at(c, gamma), 1e-12 * before.max_cd()) << what << " C " << c << " gamma " << gamma;
}

TEST(PhotometryExport, AcrossFormatsTheLightStays) {
  const struct {
    WebSymmetry symmetry;
    std::vector<double> planes;
    int code;
  } cases[] = {{WebSymmetry::none, steps(0, 345, 15), 0},
               {WebSymmetry::rotational, {0}, 1},
               {WebSymmetry::about_0_180, {0, 10, 50, 180}, 2},
               {WebSymmetry::about_90_270, {-90, -20, 30, 90}, 3},
               {WebSymmetry::quadrant, {0, 10, 70, 90}, 4}};
  for (const auto& [symmetry, planes, code] : cases) {
    IntensityDistribution ies = distribution_of(WebType::c, symmetry, steps(0, 180, 5), planes, wild);
    auto& record = std::get<IesRecord>(ies.record);
    record.multiplier = 1.7;
    record.lumens_per_lamp = 950;
    record.version = symmetry == WebSymmetry::about_90_270 ? IesVersion::lm_63_1995 : IesVersion::lm_63_2002;
    for (const bool turn : {true, false}) {
      PhotometricWriteOptions options;
      options.turn = turn;
      const auto as_ldt = write_eulumdat(ies, options);
      ASSERT_TRUE(as_ldt) << as_ldt.error().text;
      expect_same_light(ies, read_back(*as_ldt, false), turn ? 90 : 0, "ies to ldt");
      const IntensityDistribution ldt = eulumdat_of(ies.grid, code);
      for (const IesVersion version : {IesVersion::lm_63_1995, IesVersion::lm_63_2002}) {
        options.version = version;
        const auto as_ies = write_ies(ldt, options);
        ASSERT_TRUE(as_ies);
        expect_same_light(ldt, read_back(*as_ies, true), turn ? -90 : 0, "ldt to ies");
      }
    }
  }
}

TEST(PhotometryExport, ValuesAcrossFormatsAreWithinFourUlp) {
  IntensityDistribution ies = distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 180, 1), {0}, wild);
  std::get<IesRecord>(ies.record).multiplier = 1.1;
  std::get<IesRecord>(ies.record).lumens_per_lamp = 937;
  const IntensityDistribution ldt = read_back(*write_eulumdat(ies), false);
  const double before = candelas_per_value(ies), after = candelas_per_value(ldt);
  for (std::size_t i = 0; i < ies.grid.values.size(); ++i) {
    const double expected = ies.grid.values[i] * before, ulp = std::nextafter(expected, HUGE_VAL) - expected;
    EXPECT_LE(std::abs(ldt.grid.values[i] * after - expected), 4 * ulp);
  }
}

TEST(PhotometryExport, StatedFluxSharesAreThoseOfTheLight) {
  IntensityDistribution ies = distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 180, 5), {0}, [](const Vec3d&) { return 100; });
  std::get<IesRecord>(ies.record).lumens_per_lamp = 500 * pi;
  const IntensityDistribution again = read_back(*write_eulumdat(ies), false);
  const auto& ldt = std::get<EulumdatRecord>(again.record);
  EXPECT_NEAR(ldt.lorl_percent, 80, 1e-12);  // 400 pi of 500 pi
  EXPECT_NEAR(ldt.dff_percent, 50, 1e-12);
}

TEST(PhotometryTransform, FoldingKeepsTheLightWithinItsError) {
  // Symmetric to one part in 1e4.
  const auto nearly = [](const Vec3d& u) { return 100 + 30 * u.x * u.x + 20 * u.z + 5e-3 * u.y + 2e-3 * u.x; };
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 10), steps(0, 350, 10), nearly);
  const double peak = test::web_of(d).max_cd();
  const FoldedGrid exact = folded(d.grid, 0), close = folded(d.grid, 1e-3);
  EXPECT_EQ(exact.grid.symmetry, WebSymmetry::none);
  ASSERT_EQ(close.grid.symmetry, WebSymmetry::quadrant);
  EXPECT_LE(close.error, 1e-3 * peak);
  IntensityDistribution small = d;
  small.grid = close.grid;
  const IntensityWeb before = test::web_of(d), after = test::web_of(small);
  for (double c = 0; c < 360; c += 10)
    for (double gamma = 0; gamma <= 180; gamma += 10)
      EXPECT_LE(std::abs(after.at(c, gamma) - before.at(c, gamma)), close.error * (1 + 1e-9));
}

TEST(PhotometryTransform, ScalingReachesTheFlux) {
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 180, 10), {0}, wild);
  const auto scaled = scaled_to_flux(d, 1500);
  ASSERT_TRUE(scaled);
  EXPECT_NEAR(test::web_of(*scaled).flux_lm(), 1500, 1e-11);
  EXPECT_FALSE(scaled_to_flux(d, -1));
}

// Every file of the corpus, written in its own format and version and read again.
TEST(PhotometryExport, TheCorpusComesBackToTheLastBit) {
  const fs::path corpus = source_dir() / "../shared/corpus/photometry";
  if (!fs::exists(corpus)) GTEST_SKIP() << "needs ../shared/corpus/photometry";
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(corpus)) {
    const bool ies = entry.path().extension() == ".ies";
    if (!ies && entry.path().extension() != ".ldt") continue;
    const auto bytes = read_file(entry.path(), 1u << 28);
    const auto file = ies ? read_ies(*bytes, "a") : read_eulumdat(*bytes, "a");
    if (!file) continue;
    const IntensityDistribution& d = file->distribution;
    PhotometricWriteOptions options;
    if (ies) options.version = std::get<IesRecord>(d.record).version;
    const auto text = ies ? write_ies(d, options) : write_eulumdat(d, options);
    ASSERT_TRUE(text);
    const IntensityDistribution again = read_back(*text, ies);
    EXPECT_EQ(again.grid.values, d.grid.values) << entry.path();
    EXPECT_EQ(again.grid.vertical_deg, d.grid.vertical_deg);
    EXPECT_EQ(again.grid.horizontal_deg, d.grid.horizontal_deg);
    EXPECT_EQ(candelas_per_value(again), candelas_per_value(d));
    EXPECT_EQ(opening_of(again).shape, opening_of(d).shape);
    ++files;
  }
  EXPECT_EQ(files, 167u);
}

}  // namespace
}  // namespace etendue
