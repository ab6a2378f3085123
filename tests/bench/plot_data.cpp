// The numbers behind the pictures of sdk/docs, as JSON; sdk/docs/pictures/draw draws them.
#include "diffuse_curves.h"
#include "light_curves.h"
#include "lobe_curves.h"
#include "material_curves.h"
#include "peers.h"
#include "specular_curves.h"

#include "etendue/batch.h"
#include "etendue/camera.h"
#include "etendue/colour.h"
#include "etendue/colour_space.h"
#include "etendue/eval.h"
#include "etendue/normal_filter.h"
#include "etendue/spectrum.h"
#include "etendue/srgb.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace etendue::bench {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> ratios(double low, double high, int count) {
  std::vector<double> all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = std::clamp(low * std::pow(high / low, i / (count - 1.0)), low, high);
  return all;
}
Json point(double x, double y) { return Json::array({x, y}); }

// Figure 25 of Lagarde and de Rousiers: 1/d^2 and its windows for a radius.
Json falloff(double radius) {
  Json curves;
  for (const double d : ratios(1, radius * 1.2, 400)) {
    const std::pair<const char*, Falloff> windows[] = {{"1/d^2", Falloff::inverse_square},
                                                       {"window 1, n = 4 (eq 26)", Falloff::frostbite},
                                                       {"glTF", Falloff::gltf},
                                                       {"window 2, n = 20 (eq 23)", {Falloff::Law::power, 20}},
                                                       {"window 3, smoothstep", Falloff::smoothstep},
                                                       {"scale and bias (eq 25)", Falloff::scale_bias}};
    for (const auto& [name, falloff] : windows) curves[name].push_back(point(d, eval::window_at({falloff, radius}, d) / (d * d)));
  }
  return curves;
}

// Luminance that becomes a pixel value of 1, and the one that the meter aims at, over EV100.
Json exposure() {
  Json curves;
  for (int quarter = -24; quarter <= 72; ++quarter) {
    const double ev = quarter * 0.25;
    for (const char* name : {"frostbite", "unreal", "iso_sos"})
      curves[fmt::format("pixel value 1, {}", name)].push_back(point(ev, saturation_of_ev100(ev, *calibration(name))));
    curves["the meter's luminance, K = 12.5"].push_back(point(ev, luminance_of_ev100(ev, *calibration("frostbite"))));
  }
  return curves;
}

// sRGB code, 0 to 255, of a luminance at some exposures.
Json response() {
  Json curves;
  for (const int ev : {3, 6, 9, 12, 15})
    for (const double nits : ratios(1e-2, 1e5, 300))
      curves[fmt::format("EV {}", ev)].push_back(
          point(nits, 255 * std::clamp(linear_to_srgb(nits * exposure_of_ev100(ev, *calibration("frostbite"))), 0.0, 1.0)));
  return curves;
}

// Figure 75 of Lagarde and de Rousiers: the code of a linear value, and what a power of 2.2 makes of it.
Json srgb_curves() {
  Json curves;
  for (const double linear : ratios(1e-5, 1, 300)) {
    const double exact = linear_to_srgb(linear), power = std::pow(linear, 1 / 2.2);
    curves["sRGB"].push_back(point(linear, 255 * exact));
    curves["power of 1 / 2.2"].push_back(point(linear, 255 * power));
    curves["difference"].push_back(point(linear, 255 * std::abs(power - exact)));
  }
  return curves;
}

// Lobes of three alphas after their normals are spread, by kappa; and what the nearest GGX lobe then misplaces.
Json filtered_lobes() {
  Json curves;
  const std::pair<const char*, NormalFilter> filters[] = {
      {"nearest GGX", NormalFilter::ggx}, {"slopes", NormalFilter::slopes}, {"listing 32", NormalFilter::listing32}};
  for (const double kappa : ratios(1, 1e5, 200)) {
    const double r = mean_normal_length(kappa);
    constexpr double alphas[] = {0.01, 0.1, 0.3};
    for (const auto& [name, filter] : filters) {
      for (const double alpha : alphas)
        curves["alphas"][fmt::format("{}, alpha {:g}", name, alpha)].push_back(point(kappa, filtered_lobe(alpha, r, filter).alpha));
    }
    for (const double alpha : alphas)
      curves["misplaced"][fmt::format("alpha {:g}", alpha)].push_back(point(kappa, filtered_lobe(alpha, r).misplaced));
  }
  return curves;
}

Json chromaticities() {
  Json all;
  for (int nm = 380; nm <= 700; ++nm) {
    Spectrum line{nm - 1.0, 1, {0, 1, 0}};
    const Vec3d xyz = *tristimulus(line);
    const double sum = xyz.x + xyz.y + xyz.z;
    all["spectral"].push_back(point(xyz.x / sum, xyz.y / sum));
  }
  for (const ColourSpace& space : colour_spaces()) {
    Json& corners = all["spaces"][std::string(space.name)];
    for (const Chromaticity& c : {space.red, space.green, space.blue, space.white}) corners.push_back(point(c.x, c.y));
  }
  const auto add = [](Json& to, const Chromaticity& c) { to.push_back(point(c.x, c.y)); };
  for (const double kelvin : ratios(1000, 100000, 200)) add(all["planckian"], *planckian(kelvin));
  add(all["planckian"], *planckian(HUGE_VAL));
  for (const double kelvin : ratios(4000, 25000, 80)) add(all["daylight"], *daylight(kelvin));
  for (const double kelvin : {1500.0, 2000.0, 2700.0, 4000.0, 6500.0, 10000.0, 25000.0}) {
    Json& isotherm = all["isotherms"][fmt::format("{:g} K", kelvin)];
    for (const double duv : {-0.02, 0.02}) add(isotherm, *to_chromaticity(ColourTemperature{kelvin, duv}));
  }
  return all;
}

void fit(const float* x, const float* y, float* kelvin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2f xy{x[i], y[i]};
    (void)fit_colour_temperature({&xy, 1}, {kelvin + i, 1}, 0);
  }
}

// Largest error of T over |Duv| <= .02, in kelvin.
Json temperature_errors() {
  Json curves;
  using Method = void (*)(const float*, const float*, float*, std::size_t);
  const std::pair<const char*, Method> methods[] = {{"McCamy 1992", mccamy},
                                                    {"Hernandez-Andres 1999", hernandez_andres},
                                                    {"Robertson 1968", robertson},
                                                    {"etendue fit_colour_temperature()", fit}};
  for (const double kelvin : ratios(1000, 40000, 300)) {
    double exact = 0;
    std::vector<double> worst(std::size(methods));
    for (int step = -4; step <= 4; ++step) {
      const Chromaticity c = *to_chromaticity(ColourTemperature{kelvin, step * 0.005});
      ColourTemperature found;
      (void)to_colour_temperature({&c, 1}, {&found, 1}, {});
      exact = std::max(exact, std::abs(found.kelvin - kelvin));
      const auto x = static_cast<float>(c.x), y = static_cast<float>(c.y);
      for (std::size_t i = 0; i < worst.size(); ++i) {
        float guess = 0;
        methods[i].second(&x, &y, &guess, 1);
        worst[i] = std::max(worst[i], std::abs(guess - kelvin));
      }
    }
    for (std::size_t i = 0; i < worst.size(); ++i) curves[methods[i].first].push_back(point(kelvin, worst[i]));
    curves["etendue to_colour_temperature()"].push_back(point(kelvin, exact));
  }
  return curves;
}

// Distance in (u', v') of what methods make of a temperature, each in its own domain.
Json colour_errors() {
  Json curves;
  for (const double kelvin : ratios(800, 100000, 400)) {
    const auto t = static_cast<float>(kelvin);
    const Chromaticity exact = *planckian(t);
    const auto add = [&](const char* name, const Chromaticity& made) {
      curves[name].push_back(point(kelvin, difference_uv1976(made, exact)));
    };
    float a = 0, b = 0, c = 0;
    if (kelvin >= 1000 && kelvin <= 15000) krystek_xy(&t, &a, &b, 1), add("Krystek 1985", {a, b});
    if (kelvin >= 1667 && kelvin <= 25000) kang_xy(&t, &a, &b, 1), add("Kang 2002", {a, b});
    if (kelvin >= 1000 && kelvin <= 40000) {
      helland_srgb(&t, &a, &b, &c, 1);
      add("Helland 2012", to_chromaticity(Rgb{srgb_to_linear(a / 255.0), srgb_to_linear(b / 255.0), srgb_to_linear(c / 255.0)}));
    }
    Vec2f xy;
    (void)planckian({&t, 1}, {&xy, 1}, {});
    add("etendue planckian(), float", {xy.x, xy.y});
  }
  return curves;
}

}  // namespace
}  // namespace etendue::bench

int main() {
  using namespace etendue::bench;
  const Json all = {{"falloff_10", falloff(10)},
                    {"falloff_40", falloff(40)},
                    {"exposure", exposure()},
                    {"response", response()},
                    {"chromaticities", chromaticities()},
                    {"temperature_errors", temperature_errors()},
                    {"colour_errors", colour_errors()},
                    {"diffuse_reflectances", diffuse_reflectances(0.8)},
                    {"diffuse_rule_errors", diffuse_rule_errors()},
                    {"specular_albedos", specular_albedos(0.5)},
                    {"passed_on_light", passed_on_light()},
                    {"fresnel_terms", fresnel_terms()},
                    {"sphere_highlights", sphere_highlights()},
                    {"rect_method_errors", rect_method_errors()},
                    {"light_outlines", light_outlines()},
                    {"sphere_units", sphere_units()},
                    {"sphere_without_horizon", sphere_without_horizon()},
                    {"inverse_square_errors", inverse_square_errors()},
                    {"edge_fit_errors", edge_fit_errors()},
                    {"srgb_curves", srgb_curves()},
                    {"filtered_lobes", filtered_lobes()},
                    {"standard_albedos", standard_albedo_curves()},
                    {"masking_spheres", masking_spheres(96)},
                    {"diffuse_spheres", diffuse_spheres(96)},
                    {"layered_spheres", layered_spheres(96)},
                    {"smoothness_remaps", smoothness_remaps()},
                    {"specular_occlusions", specular_occlusions()}};
  fmt::print("{}\n", all.dump());
  return 0;
}
