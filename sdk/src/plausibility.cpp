#include "etendue/plausibility.h"

#include "etendue/material_parameters.h"

#include <algorithm>
#include <complex>

namespace etendue {
namespace {

double brightest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

// Reflectance at normal incidence from air: |(n - 1) / (n + 1)|^2.
double normal_reflectance(double eta, double k) {
  const std::complex<double> n{eta, k};
  return std::norm((n - 1.0) / (n + 1.0));
}

SurfaceColours mixed(const Rgb& base, double metal, double dielectric_f0) {
  const double rest = 1 - metal;
  return {{base * rest, Rgb{1, 1, 1} * (dielectric_f0 * rest) + base * metal}, metal};
}

struct Describe {
  SurfaceColours operator()(const Lambert& m) const { return {{m.base_colour, {0, 0, 0}}, 0.0, false}; }
  // F0 of Mitsuba's dielectric part is .08 specular.
  SurfaceColours operator()(const Principled& m) const { return mixed(m.base_colour, m.metallic, 0.08 * m.specular); }
  SurfaceColours operator()(const Standard& m) const { return {colour_pair_of({m.base_colour, m.metal, m.reflectance}), m.metal}; }
  SurfaceColours operator()(const Conductor& m) const {
    Rgb f0;
    for (int c = 0; c < 3; ++c) f0[c] = normal_reflectance(m.eta[c], m.k[c]);
    return {{{0, 0, 0}, f0}, 1.0};
  }
  SurfaceColours operator()(const MetalRough& m) const { return mixed(m.base_colour, m.metallic, f0_of_ior(m.ior)); }
  SurfaceColours operator()(const SpecularGlossiness& m) const {
    const TwoColour two = two_colour_of(m);
    return {{two.diffuse, two.f0}, std::nullopt};
  }
};

enum class Kind { dielectric, metal, between };

Kind kind_of(const SurfaceColours& colours, const PlausibleRanges& ranges) {
  double low = colours.metal.value_or(0), high = low;
  if (!colours.metal) {
    const DisneyFit fit = fit_disney(colours.pair);
    low = fit.metal_low, high = fit.metal_high;
  }
  if (low <= ranges.dielectric_mask) return Kind::dielectric;
  return high >= ranges.metal_mask ? Kind::metal : Kind::between;
}

}  // namespace

SurfaceColours described(const SurfaceModel& model) { return std::visit(Describe{}, model); }

const DoubtInfo& info_of(Doubt doubt) {
  static constexpr std::array<DoubtInfo, all_doubts.size()> infos{{
      {"gains_energy", "albedo and f0 sum up to more than 1", {1, 0, 1}},
      {"bright_albedo", "a dielectric brighter than fresh snow", {1, 0.05, 0}},
      {"dark_albedo", "a dielectric darker than coal", {0, 0.1, 1}},
      {"dim_metal", "a metal darker than any bare one", {1, 0.4, 0}},
      {"high_f0", "a dielectric that mirrors more than diamond", {1, 1, 0}},
      {"half_metal", "neither metal nor dielectric", {0, 0.8, 0.8}},
      {"low_f0", "a dielectric that mirrors less than water, which stands for occlusion", {0.35, 0.2, 0.8}},
  }};
  return infos[static_cast<std::size_t>(doubt)];
}

std::optional<Doubt> Doubts::worst() const {
  const auto found = std::find_if(all_doubts.begin(), all_doubts.end(), [this](Doubt d) { return has(d); });
  return found == all_doubts.end() ? std::nullopt : std::optional(*found);
}

Doubts doubts_of(const SurfaceColours& colours, const PlausibleRanges& ranges) {
  Doubts doubts;
  const auto& [diffuse, f0] = colours.pair;
  // A sum of 1 whose parts were stored in 8 bits.
  if (brightest(diffuse + f0) > 1 + 2 * half_8_bit_step) doubts.add(Doubt::gains_energy);
  switch (kind_of(colours, ranges)) {
    case Kind::dielectric:
      if (brightest(diffuse) > ranges.albedo_greatest) doubts.add(Doubt::bright_albedo);
      if (brightest(diffuse) < ranges.albedo_least) doubts.add(Doubt::dark_albedo);
      if (brightest(f0) > ranges.f0_greatest) doubts.add(Doubt::high_f0);
      if (colours.mirrors && brightest(f0) < ranges.f0_least) doubts.add(Doubt::low_f0);
      break;
    case Kind::metal:
      if (brightest(f0) < ranges.metal_f0_least) doubts.add(Doubt::dim_metal);
      break;
    case Kind::between:
      doubts.add(Doubt::half_metal);
      break;
  }
  return doubts;
}

}  // namespace etendue
