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
// The same of a tube as a strip about its axis. With s along the strip, w half its width and beta its distance from the lobe's middle, both
// where the lobe's mean on the strip is, the lobe's share across it and along it, as if they were independent, are
//     (x / sqrt(alpha^2 + x^2) from beta - w to beta + w) / 2,
//     (s / sqrt((pi / 4)^2 a^2 + s^2) between its ends) / 2,   a^2 = alpha^2 + beta^2;
// the latter is within .04 of (s a / (a^2 + s^2) + atan(s / a) between its ends) / pi, and alike about s = 0 and far away.
// That mean is halfway at the closest place of a long strip, and of a short one as far from its middle as the lobe's slope along it takes
// it: of D ~ (a^2 + s^2)^-2 over the length L about m it is m - L^2 m / (3 (a^2 + m^2)). Between both, of the strip's parameter,
//     t = (t of the closest place L^2 + 3 / 2 a^2) / (L^2 + 3 a^2).
// Directions' sums v + l, which slopes are quotients of, go with another parameter. The axis as seen from there is a curve of slopes: beta
// is the distance of its tangent, and a circle of the angle R / distance about l is an ellipse, as long as the axis' step is in slopes over
// what it is in directions, and as wide as leaves its area 4 v.h n.h^3 times smaller. Ends are half a circle farther, pi / 4 of it on
// average.
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
  const Vec2d from{sum_a.x / sum_a.z, sum_a.y / sum_a.z}, to{sum_b.x / sum_b.z, sum_b.y / sum_b.z};
  // Seen end-on its direction is the slope's.
  constexpr double least = 1e-6;
  const Vec2d step{to.x - from.x + least * from.x, to.y - from.y + least * from.y};
  const double length2 = step.x * step.x + step.y * step.y + 1e-20, behind = from.x * step.x + from.y * step.y;
  const double pull = 1.5 * alpha2, closest = std::clamp(-behind, 0.0, length2);
  const double of_b = (closest + pull) * sum_a.z, of_a = (length2 - closest + pull) * sum_b.z, share = of_b / (of_a + of_b);
  const Vec3d chord = to_a + span * share;
  const double over_chord = 1 / length(chord), over_distance = (over_a + (over_b - over_a) * share) * over_chord;
  const Vec3d l = chord * over_chord, sum = v + l, onwards = span - l * dot(l, span);
  if (!(l.z > 0 && dot(lobe.surface_normal, lobe.frame.to_world(l)) > 0)) return {};
  const Vec2d q{sum.x / sum.z, sum.y / sum.z}, go{onwards.x - q.x * onwards.z, onwards.y - q.y * onwards.z};
  const double gone = std::sqrt(go.x * go.x + go.y * go.y + least * least), turned = std::sqrt(dot(onwards, onwards) + least * least);
  const double beta = (q.x * go.y - q.y * go.x) / gone, angle = std::min(tube.radius * over_distance, l.z);
  const double w = angle * dot(sum, sum) / (2 * sum.z * sum.z) * turned / gone, longer = 0.25 * pi * angle * gone / (turned * sum.z);
  const double begin = behind / std::sqrt(length2) - longer, end = (behind + length2) / std::sqrt(length2) + longer;
  const double wider2 = pi * pi / 16 * (alpha2 + beta * beta);
  const auto part = [](double x, double a2) { return 0.5 * x / std::sqrt(a2 + x * x); };
  const double across = part(beta + w, alpha2) - part(beta - w, alpha2), lengthwise = part(end, wider2) - part(begin, wider2);
  const HalfAngle h = half_angle(v, l);
  const double slow = 4 * h.v_dot_h / std::sqrt(h.cos2) * l.z * GgxView(lobe.alpha(), lobe.lobe.masking, v).masked(l.z);
  return fresnel_reflectance(lobe.lobe, h.v_dot_h) * (std::max(across * lengthwise, 0.0) * std::min(slow, 1.0));
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
    {"covered-strip", "Etendue", "The same of a tube as a strip of half vectors about its axis, cut at the horizon.",
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
