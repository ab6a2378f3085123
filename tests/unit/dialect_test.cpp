#include "etendue/dialect.h"

#include "etendue/colour.h"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <fmt/format.h>

namespace etendue {
namespace {

StatedLight stated(Shape shape, double amount, std::string unit) {
  StatedLight s;
  s.shape = std::move(shape);
  s.amount = amount;
  s.form.unit = std::move(unit);
  return s;
}
// Green of the resolved light: white lights have their value in every channel.
double value_of(Dialect dialect, const StatedLight& s) {
  const Result<FromDialect> read = from_dialect(dialect, s);
  EXPECT_TRUE(read.ok()) << read.error().text;
  return read.ok() ? resolve(read->light)->rgb.y : std::nan("");
}
std::string error_of(Dialect dialect, const StatedLight& s) {
  const Result<FromDialect> read = from_dialect(dialect, s);
  return read.ok() ? "" : read.error().code;
}

const SpotShape sixty{0, 30 * pi / 180};

TEST(Blender, WattsAreRadiant) {
  StatedLight lamp = stated(PointShape{}, 1000, "W");
  EXPECT_EQ(error_of(Dialect::blender, lamp), "EFFICACY_MISSING");
  lamp.form.efficacy_lm_W = 200;
  EXPECT_NEAR(value_of(Dialect::blender, lamp), 1000 * 200 / (4 * pi), 1e-9);
  // An area light of P watts sends out pi/4 P (Cycles: L = P / (4 A)).
  StatedLight panel = stated(RectShape{2, 0.5}, 100, "W");
  panel.form.efficacy_lm_W = 1;
  EXPECT_NEAR(resolve(from_dialect(Dialect::blender, panel)->light)->flux_lm, 100 * pi / 4, 1e-10);
  // A point light with a radius keeps its intensity.
  StatedLight ball = stated(SphereShape{0.1}, 1000, "W");
  ball.form.efficacy_lm_W = 1;
  EXPECT_NEAR(value_of(Dialect::blender, ball) * pi * 0.01, 1000 / (4 * pi), 1e-9);
}

// Blender's default lamp of 1000 W through its exporter: 54351.41 cd, 79.577 and 1000 are the same light.
TEST(Gltf, SpecCompatAndRawAreTheSameLamp) {
  const double spec = value_of(Dialect::gltf_spec, stated(PointShape{}, 54351.41306588226, "cd"));
  EXPECT_NEAR(value_of(Dialect::gltf_compat, stated(PointShape{}, 79.57747154594767, "W/sr")) / spec, 1, 1e-12);
  EXPECT_NEAR(value_of(Dialect::gltf_raw, stated(PointShape{}, 1000, "W")) / spec, 1, 1e-12);
  StatedLight watts = stated(PointShape{}, 1000, "W");
  watts.form.efficacy_lm_W = 683;
  EXPECT_NEAR(value_of(Dialect::blender, watts) / spec, 1, 1e-12);
  EXPECT_NEAR(value_of(Dialect::gltf_spec, stated(DistantShape{}, 683, "lx")),
              value_of(Dialect::gltf_raw, stated(DistantShape{}, 1, "W/m2")), 1e-9);
  EXPECT_EQ(error_of(Dialect::gltf_spec, stated(RectShape{1, 1}, 1, "")), "DIALECT_HAS_NO_SUCH_LIGHT");
}

TEST(Usd, NormalizeAndStageUnits) {
  // The default DistantLight: 50000 nits over .53 degrees are 3.36 lx, with normalize 50000 lx.
  StatedLight sun = stated(DistantShape{0.53 * pi / 180}, 50000, "nit");
  EXPECT_NEAR(resolve(from_dialect(Dialect::usd, sun)->light)->rgb.y * pi * std::pow(std::sin(0.265 * pi / 180), 2), 3.36, 5e-3);
  sun.form.normalize = true;
  EXPECT_NEAR(from_dialect(Dialect::usd, sun)->light.emission.value, 50000, 1e-9);
  // With normalize an area light sends out pi x intensity lumens, where a unit is a metre.
  StatedLight panel = stated(RectShape{2, 3}, 1000, "nit");
  EXPECT_EQ(error_of(Dialect::usd, panel), "METRES_PER_UNIT_MISSING");
  panel.form.metres_per_unit = 1;
  EXPECT_NEAR(value_of(Dialect::usd, panel), 1000, 1e-10);
  panel.form.normalize = true;
  EXPECT_NEAR(resolve(from_dialect(Dialect::usd, panel)->light)->flux_lm, 1000 * pi, 1e-9);
  panel.form.exposure_stop = 3;
  EXPECT_NEAR(resolve(from_dialect(Dialect::usd, panel)->light)->flux_lm, 8000 * pi, 1e-8);
  panel.form.exposure_stop = 0;
  // The same numbers in centimetres: an area of 6e4, so 1e4 times less light.
  panel.shape = RectShape{200, 300};
  panel.form.metres_per_unit = 0.01;
  EXPECT_NEAR(resolve(from_dialect(Dialect::usd, panel)->light)->flux_lm, 1000 * pi / 1e4, 1e-10);
  panel.form.metres_per_unit = 0;
  EXPECT_EQ(error_of(Dialect::usd, panel), "NUMBER_INVALID");
  // treatAsPoint is a sphere of any radius: I = pi r^2 intensity / (4 pi r^2).
  StatedLight point = stated(PointShape{}, 100, "nit");
  point.form.metres_per_unit = 1;
  EXPECT_EQ(error_of(Dialect::usd, point), "SIZE_MISSING");
  point.form.normalize = true;
  EXPECT_NEAR(value_of(Dialect::usd, point), 25, 1e-12);
  StatedLight ball = stated(SphereShape{0.3}, 100, "nit");
  ball.form = point.form;
  EXPECT_NEAR(value_of(Dialect::usd, ball) * pi * 0.09, 25, 1e-12);
}

TEST(Hdrp, UnitsOfItsLights) {
  EXPECT_NEAR(value_of(Dialect::hdrp, stated(sixty, 1000, "lm")), 79.577, 1e-3);
  StatedLight reflector = stated(sixty, 1000, "lm");
  reflector.form.reflector = true;
  EXPECT_NEAR(value_of(Dialect::hdrp, reflector), 1187.949, 1e-3);
  EXPECT_NEAR(value_of(Dialect::hdrp, stated(RectShape{1, 1}, 10, "EV")), 128, 1e-10);
  EXPECT_NEAR(value_of(Dialect::hdrp, stated(DiskShape{1}, 100, "lm")), 100 / (pi * pi), 1e-12);
  // A tube of 1.2 m and 1000 lm: 66.3 "nits", which are cd for each metre of it.
  EXPECT_NEAR(value_of(Dialect::hdrp, stated(LineShape{1.2}, 1000, "lm")) / 1.2, 66.3, 0.05);
  EXPECT_NEAR(value_of(Dialect::hdrp, stated(LineShape{1.2}, 66.3145596, "nit")), 1000 / (4 * pi), 1e-6);
  EXPECT_EQ(error_of(Dialect::hdrp, stated(PointShape{}, 1, "nit")), "UNIT_UNSUITABLE");
}

TEST(Engines, KnownFacts) {
  // Frostbite's tables 9 and 12: a point over 4 pi, a spot over pi, a sphere of 15 cm and 1500 lm.
  EXPECT_NEAR(value_of(Dialect::frostbite, stated(PointShape{}, 1500, "lm")), 119.366, 1e-3);
  EXPECT_NEAR(value_of(Dialect::frostbite, stated(sixty, 1000, "lm")), 318.31, 1e-2);
  EXPECT_NEAR(value_of(Dialect::frostbite, stated(SphereShape{0.15}, 1500, "lm")), 1688.69, 5e-3);
  EXPECT_NEAR(value_of(Dialect::frostbite, stated(TubeShape{1.2, 0.013}, 1000, "lm")), 3178.6, 0.05);
  // Unreal: 625 unitless are a candela; sizes in centimetres.
  EXPECT_NEAR(value_of(Dialect::unreal, stated(PointShape{}, 625, "unitless")), 1, 1e-12);
  EXPECT_NEAR(value_of(Dialect::unreal, stated(sixty, 1000, "lm")), 1187.949, 1e-3);
  EXPECT_NEAR(value_of(Dialect::unreal, stated(RectShape{100, 200}, 100, "lm")), 100 / (2 * pi), 1e-10);
  StatedLight focused = stated(sixty, 1000, "lm");
  EXPECT_NEAR(value_of(Dialect::filament, focused), 318.31, 1e-2);
  focused.form.reflector = true;
  EXPECT_NEAR(value_of(Dialect::filament, focused), 1187.949, 1e-3);
  EXPECT_NEAR(value_of(Dialect::godot, stated(sixty, 1000, "lm")), 318.31, 1e-2);
  // three.js: RectAreaLight.power = intensity width height pi.
  EXPECT_NEAR(value_of(Dialect::threejs, stated(RectShape{2, 0.5}, 100, "lm")), 100 / pi, 1e-12);
  // pbrt: power over both sides if twosided; illuminance of an even sky.
  StatedLight panel = stated(RectShape{1, 1}, 100, "lm");
  EXPECT_NEAR(value_of(Dialect::pbrt, panel), 100 / pi, 1e-12);
  panel.two_sided = true;
  EXPECT_NEAR(value_of(Dialect::pbrt, panel), 50 / pi, 1e-12);
  EXPECT_NEAR(value_of(Dialect::pbrt, stated(EnvironmentShape{}, 10000, "lx")), 10000 / pi, 1e-9);
  // V-Ray: 683 lm/W, hue of the colour alone.
  StatedLight vray = stated(RectShape{1, 1}, 1, "W");
  vray.colour = {0.2, 0.1, 0.05};
  EXPECT_NEAR(luminance_of(resolve(from_dialect(Dialect::vray, vray)->light)->rgb), 683 / pi, 1e-9);
}

// The facts page's spread of one number, 1000 lm in a spot of 60 degrees: 45 times, 5.5 stops.
TEST(Spread, OneLampInTenPrograms) {
  const std::vector<SpreadRow> rows = *interoperability_spread(1000, sixty);
  ASSERT_EQ(rows.size(), 11U);
  const double expected[] = {79.6, 79.6, 318.3, 318.3, 318.3, 318.3, 1188, 1188, 1188, 1398, 3564};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i].candela, expected[i], expected[i] * 5e-4) << rows[i].program;
  EXPECT_NEAR(rows.back().candela / rows.front().candela, 45, 0.5);
  EXPECT_NEAR(std::log2(rows.back().candela / rows.front().candela), 5.5, 0.05);
  // The documentation's table is made of these rows.
  std::ifstream file(source_dir() / "sdk/docs/dialects.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const SpreadRow& row : rows) {
    const std::string line = fmt::format("| {} | {} | {} | {:.4g} |", row.program, row.stated, row.divides_by, row.candela);
    EXPECT_NE(text.str().find(line), std::string::npos) << line;
  }
}

std::vector<Shape> every_shape() {
  return {PointShape{},   SpotShape{0.3, 0.7}, FrustumShape{0.5, 0.8},          DistantShape{}, DistantShape{0.01}, SphereShape{0.2},
          DiskShape{0.3}, RectShape{1.2, 0.4}, TubeShape{1, 0.02, Caps::round}, LineShape{2},   EnvironmentShape{}};
}
double largest_difference(const Rgb& a, const Rgb& b) {
  const double scale = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) / scale;
}

// Every light of every program in every of its units: from it, back, and from it again. The goal is 1e-6.
TEST(RoundTrip, KeepsTheLight) {
  int tried = 0;
  double worst = 0;
  for (const DialectInfo& info : dialects())
    for (const Shape& shape : every_shape())
      for (const std::string_view unit : units_of(info.dialect, shape))
        for (const bool flag : {false, true}) {
          StatedLight s = stated(shape, unit == "EV" ? 9.3 : 123.456, std::string(unit));
          s.colour = {1, 0.6, 0.25};
          s.form.normalize = flag;
          s.form.reflector = flag;
          s.form.exposure_stop = info.dialect == Dialect::usd ? 1.5 : 0;
          s.form.metres_per_unit = flag ? 0.01 : 1;
          s.form.efficacy_lm_W = 179;
          s.two_sided = flag && info.dialect == Dialect::pbrt;
          const Result<FromDialect> read = from_dialect(info.dialect, s);
          const bool needs_normalize = info.dialect == Dialect::usd && !flag &&
                                       (std::holds_alternative<PointShape>(shape) || shape.index() == Shape(DistantShape{}).index());
          if (!read.ok() && needs_normalize) continue;
          ASSERT_TRUE(read.ok()) << info.name << " " << name_of(shape) << ": " << read.error().text;
          const Result<ToDialect> written = to_dialect(info.dialect, read->light, s.form);
          ASSERT_TRUE(written.ok()) << info.name << " " << name_of(shape) << ": " << written.error().text;
          const Result<FromDialect> again = from_dialect(info.dialect, written->stated);
          ASSERT_TRUE(again.ok()) << again.error().text;
          worst = std::max(worst, largest_difference(resolve(read->light)->rgb, resolve(again->light)->rgb));
          // The brightest channel was 1 already: the number itself comes back. V-Ray's is of its hue.
          EXPECT_NEAR(written->stated.amount / s.amount, 1, 1e-12) << info.name << " " << name_of(shape) << " " << unit;
          ++tried;
        }
  EXPECT_GT(tried, 120);
  EXPECT_LE(worst, 1e-12);
}

// Ours, given in any way, coloured by temperature, filtered: what a program writes reads as the same light.
TEST(RoundTrip, OfOurLights) {
  double worst = 0;
  for (const DialectInfo& info : dialects())
    for (const Shape& shape : every_shape()) {
      if (units_of(info.dialect, shape).empty()) continue;
      Light light;
      light.name = "key";
      light.shape = shape;
      const bool far = std::holds_alternative<DistantShape>(shape) || std::holds_alternative<EnvironmentShape>(shape);
      light.emission.given = far ? Emission::Given::illuminance : Emission::Given::flux;
      light.emission.value = 800;
      light.colour = TemperatureColour{3000};
      light.filter = {0.9, 0.5, 0.7};
      DialectForm form;
      form.metres_per_unit = 0.01;
      form.normalize = true;
      form.efficacy_lm_W = 300;
      const Result<ToDialect> written = to_dialect(info.dialect, light, form);
      ASSERT_TRUE(written.ok()) << info.name << " " << name_of(shape) << ": " << written.error().text;
      const Light back = from_dialect(info.dialect, written->stated)->light;
      worst = std::max(worst, largest_difference(resolve(light)->rgb, resolve(back)->rgb));
      EXPECT_EQ(std::max({written->stated.colour.x, written->stated.colour.y, written->stated.colour.z}), 1);
      EXPECT_FALSE(written->losses.losses.empty());  // the temperature at least
    }
  EXPECT_LE(worst, 1e-12);
}

bool tells(const LossReport& report, const std::string& text) {
  return std::any_of(report.losses.begin(), report.losses.end(),
                     [&](const Loss& l) { return (l.what + ": " + l.effect).find(text) != std::string::npos; });
}
TEST(Losses, AreNamed) {
  Light light;
  light.name = "key";
  light.shape = SpotShape{0, pi / 6};
  light.emission = {.given = Emission::Given::intensity, .value = 100};
  light.range_m = 8;
  light.falloff = Falloff::frostbite;
  EXPECT_TRUE(tells(to_dialect(Dialect::pbrt, light)->losses, "range 8 m"));
  EXPECT_TRUE(tells(to_dialect(Dialect::pbrt, light)->losses, "+50.0 % of flux"));  // 1/2 for 1/3, no inner cone
  EXPECT_TRUE(tells(to_dialect(Dialect::gltf_spec, light)->losses, "1 - (d/r)^4"));
  EXPECT_FALSE(tells(to_dialect(Dialect::unreal, light)->losses, "range"));
  EXPECT_TRUE(tells(to_dialect(Dialect::frostbite, light)->losses, "1 cm"));
  light.shape = RectShape{1, 1};
  light.two_sided = true;
  EXPECT_TRUE(tells(to_dialect(Dialect::threejs, light)->losses, "back stays dark"));
  EXPECT_FALSE(tells(to_dialect(Dialect::pbrt, light)->losses, "back stays dark"));
  light.colour = TemperatureColour{1500};  // blue is negative
  const ToDialect clipped = *to_dialect(Dialect::threejs, light);
  EXPECT_TRUE(tells(clipped.losses, "gamut"));
  EXPECT_NEAR(luminance_of(clipped.stated.colour) * clipped.stated.amount, luminance_of(resolve(light)->rgb), 1e-9);
  light.shape = TubeShape{1, 0.1, Caps::flat};
  light.two_sided = false;
  light.colour = RgbColour{};
  EXPECT_TRUE(tells(to_dialect(Dialect::usd, light, {.metres_per_unit = 1})->losses, "stay dark"));
}

TEST(BadInput, IsNamed) {
  const double not_a_number = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {-1.0, not_a_number, infinity})
    EXPECT_EQ(error_of(Dialect::threejs, stated(PointShape{}, bad, "cd")), "NUMBER_INVALID");
  EXPECT_EQ(error_of(Dialect::hdrp, stated(RectShape{1, 1}, not_a_number, "EV")), "NUMBER_INVALID");
  EXPECT_EQ(error_of(Dialect::frostbite, stated(SphereShape{0}, 100, "lm")), "SIZE_MISSING");
  EXPECT_EQ(error_of(Dialect::unreal, stated(SpotShape{0, 0}, 100, "lm")), "SIZE_MISSING");
  StatedLight coloured = stated(PointShape{}, 1, "cd");
  coloured.colour = {-1, 0, 0};
  EXPECT_EQ(error_of(Dialect::threejs, coloured), "COLOUR_INVALID");
  EXPECT_EQ(dialect_named("blendr").error().code, "DIALECT_UNKNOWN");
  EXPECT_NE(dialect_named("blendr").error().hint.find("blender"), std::string::npos);
  for (const DialectInfo& info : dialects()) EXPECT_EQ(dialect_named(info.name)->dialect, info.dialect);
  Light off;
  off.shape = RectShape{1, 1};
  off.emission = {.given = Emission::Given::luminance, .value = 0};
  EXPECT_EQ(to_dialect(Dialect::hdrp, off, {.unit = "EV"}).error().code, "NUMBER_INVALID");
  EXPECT_EQ(to_dialect(Dialect::hdrp, off, {.unit = "nit"})->stated.amount, 0);
}

std::vector<Light> punctual(double candela, double lux = 0) {
  Light point, sun;
  point.shape = PointShape{};
  point.emission = {.given = Emission::Given::intensity, .value = candela};
  sun.shape = DistantShape{};
  sun.emission = {.given = Emission::Given::illuminance, .value = lux};
  return {point, sun};
}
// "glTF intensity 54 from COMPAT file": the exporter's name and the magnitude together.
TEST(Compat, IsSuspected) {
  const std::string blender = "Khronos glTF Blender I/O v4.0.44";
  const auto warning = suspected_compat_lights(blender, punctual(54));
  ASSERT_TRUE(warning.has_value());
  EXPECT_EQ(warning->code, "LIGHTS_LOOK_UNITLESS");
  EXPECT_EQ(warning->severity, Severity::warning);
  EXPECT_NE(warning->text.find("683"), std::string::npos);
  EXPECT_TRUE(suspected_compat_lights(blender, punctual(79.577, 1)).has_value());
  EXPECT_TRUE(suspected_compat_lights(blender, punctual(0, 5)).has_value());  // a sun of 5 lx
  EXPECT_FALSE(suspected_compat_lights(blender, punctual(54351.4)).has_value());
  EXPECT_FALSE(suspected_compat_lights(blender, punctual(54, 683)).has_value());  // a lamp of 1 W beside a believable sun
  EXPECT_FALSE(suspected_compat_lights("Khronos Blender-free exporter", {}).has_value());
  EXPECT_FALSE(suspected_compat_lights("COLLADA2GLTF", punctual(54)).has_value());
  EXPECT_FALSE(suspected_compat_lights(blender, punctual(0)).has_value());
}

}  // namespace
}  // namespace etendue
