#include "etendue/light_within.h"

#include "etendue/specular_light.h"
#include "kernels.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

double brightest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

bool has_extent(const Emitter& emitter) {
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape)) return sun->radius_rad > 0;
  return !std::holds_alternative<PunctualEmitter>(emitter.shape);
}

}  // namespace

LightWithin light_within(const Emitter& emitter, const ShadingPoint& point, double tolerance) {
  constexpr double tightest = 1e-9;
  const double asked = std::clamp(tolerance, tightest, 1.0);
  double floor = 0;
  if (has_closed_form(emitter)) {
    floor = 1e-3 * brightest(illuminance(emitter, point.position, point.normal));
    if (!(floor > 0)) return {{}, "unseen"};
  }
  const auto by_reference = [&](const ShadingPoint& p, double part) { return reference(emitter, p, {asked * part, asked * part * floor}); };
  if (std::holds_alternative<Lambert>(point.brdf) || !has_extent(emitter))
    return {by_reference(point, 1), has_closed_form(emitter) ? "exact" : "reference"};
  if (const auto light = specular_luminance(emitter, point, asked)) return {*light, "adaptive"};
  const auto* standard = std::get_if<Standard>(&point.brdf);
  if (standard == nullptr || !is_uniform_area_light(emitter)) return {by_reference(point, 1), "reference"};
  const StandardLobes lobes = lobes_of(*standard);
  ShadingPoint lobe = point;
  lobe.brdf = lobes.specular;
  const Estimate specular = specular_luminance(emitter, lobe, 0.5 * asked).value_or(Estimate{});
  lobe.brdf = lobes.diffuse;
  const Estimate diffuse = by_reference(lobe, 0.5);
  return {{specular.value + diffuse.value, specular.error + diffuse.error, specular.evaluations + diffuse.evaluations}, "two lobes"};
}

}  // namespace etendue::eval
