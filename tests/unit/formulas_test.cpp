#include "etendue/formulas.h"

#include "calculator.h"

#include <gtest/gtest.h>

#include <set>

namespace etendue {
namespace {

using D = Dimension;
constexpr Dimension quantities[] = {D::luminous_flux, D::luminous_intensity, D::luminance, D::illuminance, D::luminous_exitance,
                                    D::radiant_flux,  D::radiant_intensity,  D::radiance,  D::irradiance,  D::exposure_value};

// What the explanation's formula gives with its own symbols.
double evaluated(const Explanation& e) {
  std::map<std::string, double> symbols;
  for (const Symbol& s : e.symbols) symbols[s.name] = s.value;
  const std::string right = e.formula.substr(e.formula.find(" = ") + 3);
  try {
    return tests::Calculator(right, symbols).value();
  } catch (const std::exception& wrong) {
    ADD_FAILURE() << e.formula << ": " << wrong.what();
    return std::nan("");
  }
}

struct Case {
  LightSetup light;
  const char* what;
};
std::vector<Case> every_case() {
  std::vector<Case> all{{{}, "no shape"}};
  const auto add = [&](Shape shape, const char* what, Conventions conventions = {}) {
    LightSetup light;
    light.shape = std::move(shape);
    light.conventions = conventions;
    all.push_back({light, what});
  };
  add(PointShape{}, "point");
  for (const auto convention : {FluxConvention::falloff, FluxConvention::cone, FluxConvention::frostbite_pi, FluxConvention::isotropic})
    for (const auto falloff : {SpotFalloff::hard, SpotFalloff::squared, SpotFalloff::smoothstep})
      add(SpotShape{0.2, 0.6}, "spot", {false, convention, falloff});
  add(FrustumShape{0.5, 1.7}, "frustum");
  add(SphereShape{0.3}, "sphere");
  add(DiskShape{0.3}, "disk");
  add(DiskShape{0.3}, "two-sided disk", {.two_sided = true});
  add(RectShape{0.3, 0.8}, "rect", {.two_sided = true});
  add(PolygonShape{{{0, 0}, {1, 0}, {0.2, 1}}}, "polygon", {.two_sided = true});
  for (const Caps caps : {Caps::round, Caps::flat, Caps::none}) add(TubeShape{1.2, 0.1, caps}, "tube");
  add(LineShape{1.5}, "line");
  add(MeshShape{}, "mesh", {.two_sided = true});
  add(PhotometricShape{}, "photometric");
  add(DistantShape{0.01}, "distant");
  add(EnvironmentShape{}, "environment");
  for (Case& s : all) {
    s.light.given_distance_m = 2.5;
    s.light.wanted_distance_m = 4;
    s.light.efficacy_lm_W = 90;
    s.light.mesh_area_m2 = 0.7;
    s.light.photometric_sr = 1.3;
    s.light.meter_k = 14;
    s.light.meter_c = 330;
  }
  return all;
}

// Every conversion there is has its explanation, whose formula, evaluated with the symbols that it names, gives the result.
TEST(Explain, FormulaGivesTheResult) {
  int explained = 0;
  for (const Case& s : every_case())
    for (const Dimension from : quantities)
      for (const Dimension to : quantities) {
        const AnyQuantity given{from, 7.3};
        const Result<double> result = convert(given, to, s.light);
        const Result<Explanation> why = explain(given, to, s.light);
        ASSERT_EQ(result.ok(), why.ok()) << s.what;
        if (!result) continue;
        ++explained;
        EXPECT_NEAR(evaluated(*why) / *result, 1, 1e-13) << s.what << ": " << why->formula;
        EXPECT_NE(why->formula, "");
      }
  EXPECT_GT(explained, 1000);
}

// Every row is met by some light, and says what one unit of the light's own quantity amounts to.
TEST(Formulas, EveryRowIsAConversion) {
  std::set<const Formula*> met;
  for (const Case& s : every_case()) {
    if (!s.light.shape) continue;
    const Dimension own = own_quantity_of(name_of(*s.light.shape)) == "intensity" ? D::luminous_intensity : D::luminance;
    for (const Dimension to : {D::luminous_flux, D::luminous_intensity, D::luminance, D::illuminance, D::luminous_exitance}) {
      const Formula* const row = find_formula(*s.light.shape, s.light.conventions, to);
      const Result<double> ratio = convert({own, 1}, to, s.light);
      ASSERT_EQ(ratio.ok() && to != own, row != nullptr) << s.what << ' ' << name_of(to);
      if (row == nullptr) continue;
      met.insert(row);
      EXPECT_EQ(row->shape, name_of(*s.light.shape));
      std::map<std::string, double> symbols;
      const Explanation explained = *explain({own, 1}, to, s.light);
      for (const Symbol& symbol : explained.symbols) symbols[symbol.name] = symbol.value;
      EXPECT_NEAR(tests::Calculator(std::string(row->factor), symbols).value() / *ratio, 1, 1e-13) << s.what << ' ' << row->factor;
    }
  }
  EXPECT_EQ(met.size(), formulas().size());
  for (const Formula& f : formulas()) {
    EXPECT_FALSE(f.source.empty()) << f.factor;
    EXPECT_FALSE(f.why.empty()) << f.factor;
  }
}

TEST(Explain, NamesConstantsConventionAndSource) {
  LightSetup bulb;
  bulb.shape = SphereShape{0.15};
  const Explanation e = *explain({D::luminous_flux, 1500}, D::luminance, bulb);
  EXPECT_EQ(e.formula, "luminance = flux/(4*pi^2*radius^2)");
  const std::string text = to_string(e);
  for (const char* const part : {"flux = 1500 lm", "radius = 0.15 m", "table 12"}) EXPECT_NE(text.find(part), std::string::npos) << text;
  bulb.efficacy_lm_W = 15;
  const Explanation ev = *explain({D::radiant_flux, 60}, D::exposure_value, bulb);
  EXPECT_EQ(ev.formula, "ev = log2(100*(radiant_flux*efficacy/(4*pi^2*radius^2))/K)");
  for (const char* const part : {"efficacy = 15 lm/W", "K = 12.5 cd s/m2", "ISO 2720"})
    EXPECT_NE(to_string(ev).find(part), std::string::npos) << to_string(ev);
  EXPECT_EQ(explain({D::luminous_flux, 1}, D::luminance, {}).error().code, "SHAPE_MISSING");
}

TEST(Explain, Cameras) {
  CameraSettings camera;
  camera.f_number = 16;
  camera.shutter_s = 1.0 / 125;
  camera.iso = 200;
  EXPECT_NEAR(evaluated(*explain(camera)), *ev100(camera), 1e-13);
  camera.iso.reset();
  EXPECT_NEAR(evaluated(*explain(camera)), *ev_s(camera), 1e-13);
  CameraSettings film;
  film.t_stop = 2.8;
  film.shutter_angle_rad = pi;
  film.frames_per_s = 24;
  film.iso = 800;
  EXPECT_NEAR(evaluated(*explain(film)), *ev100(film), 1e-13);
  film.t_stop.reset();
  EXPECT_EQ(explain(film).error().code, "CAMERA_SETTING_MISSING");
}

}  // namespace
}  // namespace etendue
