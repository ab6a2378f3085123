// The list of the specular methods, source by source.
#include "etendue/specular_methods.h"

#include "karis.h"
#include "microfacet.h"
#include "specular_moments.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue::eval {
namespace {

std::optional<Rgb> moments(const Emitter& emitter, const ShadingPoint& point) {
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  if (!lobe || !is_uniform_area_light(emitter)) return std::nullopt;
  return luminance_of(emitter) * by_moments(emitter, point, *lobe);
}

// A small light at the centre; of a tube with the intensity across its axis, whatever its tilt.
Rgb at_centre(const LobeView& lobe, const Vec3d& centre, double intensity) { return lobe(centre) * (intensity / dot(centre, centre)); }
template <class Flat>
Rgb flat_point(const Flat& light, const LobeView& lobe) {
  return at_centre(lobe, light.centre, light.area() * light.height() / length(light.centre));
}
Rgb round_point(const SphereView& sphere, const LobeView& lobe) {
  return at_centre(lobe, sphere.centre, pi * sphere.radius * sphere.radius);
}
Rgb tube_point(const TubeView& tube, const LobeView& lobe) { return at_centre(lobe, (tube.a + tube.b) * 0.5, intensity_across(tube)); }
constexpr SpecularRules point_rules{.rect = flat_point<RectView>,
                                    .disk = flat_point<DiskView>,
                                    .sphere = round_point,
                                    .tube = tube_point,
                                    .sun = round_point,
                                    .lobes = Lobes::every};
constexpr SpecularMethod baseline[] = {
    {"punctual", "none", "A point of the same intensity at the light's centre: what area lights are to be better than.",
     published<point_rules>},
};

// The half vectors that mirror the light to the eye, taken for a disk about the centre's in the plane of slopes (h.x, h.y) / h.z: a solid
// angle of light is 1 / (4 v.h n.h^3) of it there. Slopes over alpha are the stereographic projection of a sphere on which the lobe's
// D n.h dh is uniform, and a disk is that of a cap: with q the slope of the centre and r the disk's radius its share is
//     (1 - t / sqrt(t^2 + 4 alpha^2 r^2)) / 2,   t = q^2 + alpha^2 - r^2.
// What else the lobe has (W of specular_moments.cpp) is slow, is taken at the centre, and is 1 at most.
Rgb covered_lobe(const LobeView& lobe, const Vec3d& centre, double solid_angle) {
  const Vec3d v = lobe.frame.vector(lobe.view), l = lobe.frame.vector(normalised(centre));
  if (!(l.z > 0 && dot(lobe.surface_normal, centre) > 0)) return {};
  const HalfAngle h = half_angle(v, l);
  const double cosine = std::sqrt(h.cos2), alpha2 = lobe.alpha() * lobe.alpha();
  const double r2 = solid_angle / (4 * pi * h.v_dot_h * h.cos2 * cosine), t = h.sin2 / h.cos2 + alpha2 - r2;
  const double root = std::sqrt(t * t + 4 * alpha2 * r2), share = t > 0 ? 2 * alpha2 * r2 / (root * (root + t)) : 0.5 * (1 - t / root);
  const double slow = 4 * h.v_dot_h / cosine * l.z * GgxView(lobe.alpha(), lobe.lobe.masking, v).masked(l.z);
  return fresnel_reflectance(lobe.lobe, h.v_dot_h) * (share * std::min(slow, 1.0));
}
template <class Flat>
Rgb flat_part(const Flat& light, const LobeView& lobe) {
  return covered_lobe(lobe, light.centre, light.area() * light.height() / std::pow(length(light.centre), 3));
}
Rgb round_part(const SphereView& sphere, const LobeView& lobe) {
  return covered_lobe(lobe, sphere.centre, pi * sphere.radius * sphere.radius / dot(sphere.centre, sphere.centre));
}
// The solid angle across the axis, whatever the tilt.
Rgb tube_part(const TubeView& tube, const LobeView& lobe) {
  const Vec3d centre = (tube.a + tube.b) * 0.5;
  return covered_lobe(lobe, centre, intensity_across(tube) / dot(centre, centre));
}
constexpr SpecularRules covered_rules{
    .rect = flat_part<RectView>, .disk = flat_part<DiskView>, .sphere = round_part, .tube = tube_part, .sun = round_part};
constexpr SpecularMethod ours[] = {
    {"covered-lobe", "Etendue",
     "The share of the lobe that the light covers, as a disk of half vectors about its centre, in closed form; all that is slow in the "
     "lobe is "
     "taken at the centre. Dark once the centre has set.",
     published<covered_rules>},
    {"moments", "Etendue",
     "Exact but for the slow factor of the lobe, which is taken at four places, and for outlines in pieces; no table.", moments},
};

}  // namespace

std::span<const SpecularMethod> specular_methods() {
  static const std::vector<SpecularMethod> all = [] {
    std::vector<SpecularMethod> methods;
    for (const std::span<const SpecularMethod> part :
         {std::span<const SpecularMethod>(baseline), frostbite_specular_methods(), drobot_specular_methods(), karis_specular_methods(),
          eden_specular_methods(), hill_heitz_specular_methods(), ltc_methods(), std::span<const SpecularMethod>(ours)})
      methods.insert(methods.end(), part.begin(), part.end());
    return methods;
  }();
  return all;
}

const SpecularMethod* find_specular_method(std::string_view name) {
  const auto all = specular_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SpecularMethod& m) { return m.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace etendue::eval
