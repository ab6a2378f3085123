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
// No more than a hemisphere's pi however close.
template <class Flat>
Rgb flat_part(const Flat& light, const LobeView& lobe) {
  const double d2 = dot(light.centre, light.centre);
  return covered_lobe(lobe, light.centre, light.area() * light.height() / (std::sqrt(d2) * (d2 + light.area() / pi)));
}
Rgb round_part(const SphereView& sphere, const LobeView& lobe) {
  return covered_lobe(lobe, sphere.centre, pi * sphere.radius * sphere.radius / dot(sphere.centre, sphere.centre));
}
// The solid angle across the axis, whatever the tilt.
Rgb tube_part(const TubeView& tube, const LobeView& lobe) {
  const Vec3d centre = (tube.a + tube.b) * 0.5;
  return covered_lobe(lobe, centre, intensity_across(tube) / dot(centre, centre));
}
// The same of a tube as a strip about its axis, straight in the plane of slopes. With s along the strip, w half its width and beta its
// distance from the lobe's middle, where it is closest to it, the lobe's share across it and along it, as if they were independent, are
//     (x / sqrt(alpha^2 + x^2) from beta - w to beta + w) / 2,
//     (s a / (a^2 + s^2) + atan(s / a) between its ends) / pi,   a^2 = alpha^2 + beta^2.
// The strip covers as much as the tube's solid angle is there: w = R / distance times |v + l|^2 / (2 (v + l).z^3), over how much longer it
// is in slopes than in directions.
Rgb covered_strip(const TubeView& tube, const LobeView& lobe) {
  const Vec3d v = lobe.frame.vector(lobe.view);
  Vec3d a = lobe.frame.vector(tube.a), b = lobe.frame.vector(tube.b);
  // As far as something is above the horizon, and its middle there.
  const double low_a = a.z + tube.radius, low_b = b.z + tube.radius;
  if (!(low_a > 0 || low_b > 0)) return {};
  const Vec3d crossing = a + (b - a) * (low_a / (low_a - low_b));
  if (low_a < 0) a = crossing;
  if (low_b < 0) b = crossing;
  a.z = std::max(a.z, 0.5 * (a.z + tube.radius)), b.z = std::max(b.z, 0.5 * (b.z + tube.radius));
  const double over_a = 1 / length(a), over_b = 1 / length(b), alpha2 = lobe.alpha() * lobe.alpha();
  const Vec3d to_a = a * over_a, to_b = b * over_b, sum_a = v + to_a, sum_b = v + to_b, span = to_b - to_a;
  const Vec2d from{sum_a.x / sum_a.z, sum_a.y / sum_a.z}, to{sum_b.x / sum_b.z, sum_b.y / sum_b.z}, step{to.x - from.x, to.y - from.y};
  const double length2 = std::max(step.x * step.x + step.y * step.y, 1e-12), over_length = 1 / std::sqrt(length2);
  const double begin = (from.x * step.x + from.y * step.y) * over_length, end = begin + length2 * over_length;
  // Beside the strip's line, and where on it the lobe's middle is, as shares of the strip and of the directions' sums.
  const double aside = (from.x * step.y - from.y * step.x) * over_length, a2 = alpha2 + aside * aside, a1 = std::sqrt(a2);
  const double over_begin = 1 / (a2 + begin * begin), over_end = 1 / (a2 + end * end);
  const double below = a1 * (end * over_end - begin * over_begin) + std::atan2(a1 * (end - begin), a2 + begin * end);
  const double mean = a1 * a2 * (over_begin - over_end) / std::max(below, 1e-12);
  const double close = std::clamp((mean - begin) * over_length, 0.0, 1.0);
  const double share = close * sum_a.z / (close * sum_a.z + (1 - close) * sum_b.z);
  const Vec3d chord = to_a + span * share;
  const double over_chord = 1 / length(chord), over_distance = (over_a + (over_b - over_a) * share) * over_chord;
  const Vec3d l = chord * over_chord, sum = v + l;
  if (!(l.z > 0 && dot(lobe.surface_normal, lobe.frame.to_world(l)) > 0)) return {};
  const double total = dot(sum, sum);
  const double beta = std::abs((sum.x * step.y - sum.y * step.x) * over_length / sum.z);
  const double narrower = std::sqrt(std::max(dot(span, span), 1e-12)) * over_length;
  const double w = std::min(tube.radius * over_distance, l.z) * total / (2 * sum.z * sum.z * sum.z) * narrower;
  const auto across = [&](double x) { return x / std::sqrt(alpha2 + x * x); };
  const double wider2 = alpha2 + beta * beta, wider = std::sqrt(wider2), s0 = begin - 0.25 * pi * w, s1 = end + 0.25 * pi * w;
  const double lengthwise =
      (wider * (s1 / (wider2 + s1 * s1) - s0 / (wider2 + s0 * s0)) + std::atan2(wider * (s1 - s0), wider2 + s0 * s1)) / pi;
  const HalfAngle h = half_angle(v, l);
  const double slow = 4 * h.v_dot_h / std::sqrt(h.cos2) * l.z * GgxView(lobe.alpha(), lobe.lobe.masking, v).masked(l.z);
  return fresnel_reflectance(lobe.lobe, h.v_dot_h) *
         (0.5 * (across(beta + w) - across(beta - w)) * std::max(lengthwise, 0.0) * std::min(slow, 1.0));
}
constexpr SpecularRules strip_rules{.tube = covered_strip};
constexpr SpecularRules covered_rules{
    .rect = flat_part<RectView>, .disk = flat_part<DiskView>, .sphere = round_part, .tube = tube_part, .sun = round_part};
constexpr SpecularMethod ours[] = {
    {"covered-lobe", "Etendue",
     "The share of the lobe that the light covers, as a disk of half vectors about its centre, in closed form; all that is slow in the "
     "lobe is "
     "taken at the centre. Dark once the centre has set.",
     published<covered_rules>},
    {"covered-strip", "Etendue", "The same of a tube as a straight strip of half vectors about its axis, cut at the horizon.",
     published<strip_rules>},
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
