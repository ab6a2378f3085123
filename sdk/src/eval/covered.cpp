// Ours for as little time as the cheapest published ones: the light as a disk or a strip of half vectors, whose share of the lobe has a
// closed form.
#include "etendue/directional_albedo.h"
#include "karis.h"
#include "microfacet.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// The half vectors that mirror the light to the eye, taken for a disk about the centre's in the plane of slopes (h.x, h.y) / h.z: a solid
// angle of light is 1 / (4 v.h n.h^3) of it there. Slopes over alpha are the stereographic projection of a sphere on which the lobe's
// D n.h dh is uniform, and a disk is that of a cap: with q the slope of the centre and r the disk's radius its share is
//     (1 - t / sqrt(t^2 + 4 alpha^2 r^2)) / 2,   t = q^2 + alpha^2 - r^2.
// What else the lobe has (W of specular_moments.cpp) is slow, is taken at the centre, and is 1 at most.
double disk_share(double off2, double width2, double r2) {
  const double t = off2 + width2 - r2, root = std::sqrt(t * t + 4 * width2 * r2);
  return t > 0 ? 2 * width2 * r2 / (root * (root + t)) : 0.5 * (1 - t / root);
}
Rgb covered_lobe(const LobeView& lobe, const Vec3d& centre, double solid_angle) {
  const Vec3d v = lobe.frame.vector(lobe.view), l = lobe.frame.vector(normalised(centre));
  if (!(l.z > 0 && dot(lobe.surface_normal, centre) > 0)) return {};
  const HalfAngle h = half_angle(v, l);
  const double cosine = std::sqrt(h.cos2), alpha2 = lobe.alpha() * lobe.alpha();
  const double r2 = solid_angle / (4 * pi * h.v_dot_h * h.cos2 * cosine), share = disk_share(h.sin2 / h.cos2, alpha2, r2);
  const double slow = 4 * h.v_dot_h / cosine * l.z * GgxView(lobe.alpha(), lobe.lobe.masking, v).masked(l.z);
  return fresnel_reflectance(lobe.lobe, h.v_dot_h) * (share * std::min(slow, 1.0));
}
// No more than a hemisphere's pi however close.
template <class Flat>
Rgb flat_part(const Flat& light, const LobeView& lobe) {
  const double d2 = dot(light.centre, light.centre);
  return covered_lobe(lobe, light.centre, light.area() * light.height() / (std::sqrt(d2) * (d2 + light.area() / pi)));
}
// What of a sphere is above the horizon: its middle is halfway up to the top, and of the height's share x there is x^2 (3 - 2 x) of the
// area, within .04 of a disk's.
Rgb round_part(const SphereView& sphere, const LobeView& lobe) {
  const double radius = sphere.radius, high = dot(sphere.centre, lobe.normal), low = std::max(high + radius, 0.0);
  const double part = std::min(0.5 * low / radius, 1.0);
  const Vec3d middle = sphere.centre + lobe.normal * (std::max(high, 0.5 * low) - high);
  return covered_lobe(lobe, middle, pi * radius * radius * part * part * (3 - 2 * part) / dot(middle, middle));
}
// The solid angle across the axis, whatever the tilt.
Rgb tube_part(const TubeView& tube, const LobeView& lobe) {
  const Vec3d centre = (tube.a + tube.b) * 0.5;
  return covered_lobe(lobe, centre, intensity_across(tube) / dot(centre, centre));
}
// Of the way from a to b where the mirrored view r meets their plane, or the end that is nearer: with p = r.a, q = r.b and c = a.b,
// r = ((p - c q) a + (q - c p) b) / (1 - c^2).
double mirrored_share(const Vec3d& mirror, const Vec3d& a, const Vec3d& b) {
  const double p = dot(mirror, a), q = dot(mirror, b), less = 0.5 * dot(b - a, b - a);
  return std::clamp((q - p + less * p) / std::max((p + q) * less, 1e-12), 0.0, 1.0);
}
// G2 / (4 n.v n.l) with its denominator linear in alpha, which it is not, between 4 n.v n.l at 0 and 2 (n.v + n.l) at 1 (Hammon 2017, "PBR
// Diffuse Lighting for GGX+Smith Microsurfaces"): where one place stands for all that is slow it is as near as G2.
double masked_between(double alpha, double v, double l) { return 0.5 / (2 * v * l * (1 - alpha) + (v + l) * alpha); }

// The same of a strip. With s along it, w half its width and beta its distance from the lobe's middle, both where the lobe's mean on the
// strip is, the lobe's share across it and along it, as if they were independent, are
//     (x / sqrt(alpha^2 + x^2) from beta - w to beta + w) / 2,
//     (s / sqrt((pi / 4)^2 a^2 + s^2) between its ends) / 2,   a^2 = alpha^2 + beta^2;
// the latter is within .04 of (s a / (a^2 + s^2) + atan(s / a) between its ends) / pi, and alike about s = 0 and far away.
// That mean is at the closest place of a long strip, and of a short one as far from its middle as the lobe's slope along it takes it: of
// D ~ (alpha^2 + s^2)^-2 over the length L about m it is m - L^2 m / (3 (alpha^2 + m^2)). Between both, of the strip's parameter,
//     t = (t of the closest place L^2 + 3 / 2 alpha^2) / (L^2 + 3 alpha^2).
// Directions' sums v + l, which slopes are quotients of, go with another parameter. The axis as seen from there is a curve of slopes: beta
// is the distance of its tangent, and a circle of directions about l is an ellipse, as long as the axis' step is in slopes over what it is
// in directions, and as wide as leaves its area 4 v.h n.h^3 times smaller.
//
// In the point's frame: ends in space, 1 / distance of directions between them the mean of both; half the width, at a place of that
// 1 / distance and that cosine, as an angle; and how much farther the ends go on, over that.
// `through_mirror`: they lie in the plane of the centre and the mirrored view, whose slope is 0. Such a strip goes through the lobe's
// middle (beta = 0), and its closest place is known as a direction: the mean is taken between directions.
template <class Angle>
Rgb lit_by_strip(const LobeView& lobe, const Vec3d& a, const Vec3d& b, const Angle& half_width, double caps, bool through_mirror) {
  const Vec3d v = lobe.frame.vector(lobe.view);
  const double over_a = 1 / length(a), over_b = 1 / length(b), alpha2 = lobe.alpha() * lobe.alpha();
  const Vec3d to_a = a * over_a, to_b = b * over_b, sum_a = v + to_a, sum_b = v + to_b, span = to_b - to_a;
  const Vec2d from{sum_a.x / sum_a.z, sum_a.y / sum_a.z}, to{sum_b.x / sum_b.z, sum_b.y / sum_b.z};
  // Seen end-on its direction is the slope's.
  constexpr double least = 1e-6;
  const Vec2d step{to.x - from.x + least * from.x, to.y - from.y + least * from.y};
  const double length2 = step.x * step.x + step.y * step.y + 1e-20, behind = from.x * step.x + from.y * step.y;
  const double pull = 1.5 * alpha2, closest = std::clamp(-behind, 0.0, length2);
  const double of_b = (closest + pull) * sum_a.z, of_a = (length2 - closest + pull) * sum_b.z;
  const double share = through_mirror ? (mirrored_share(lobe.frame.vector(lobe.mirror), to_a, to_b) * length2 + pull) / (length2 + 2 * pull)
                                      : of_b / (of_a + of_b);
  const Vec3d chord = to_a + span * share;
  const double over_chord = 1 / length(chord), over_distance = (over_a + (over_b - over_a) * share) * over_chord;
  const Vec3d l = chord * over_chord, sum = v + l, onwards = span - l * dot(l, span);
  if (!(l.z > 0 && dot(lobe.surface_normal, lobe.frame.to_world(l)) > 0)) return {};
  const Vec2d q{sum.x / sum.z, sum.y / sum.z}, go{onwards.x - q.x * onwards.z, onwards.y - q.y * onwards.z};
  const double gone = std::sqrt(go.x * go.x + go.y * go.y + least * least), turned = std::sqrt(dot(onwards, onwards) + least * least);
  const double beta = through_mirror ? 0 : (q.x * go.y - q.y * go.x) / gone, angle = half_width(over_distance, l.z);
  const double w = angle * dot(sum, sum) / (2 * sum.z * sum.z) * turned / gone, longer = caps * angle * gone / (turned * sum.z);
  const double begin = behind / std::sqrt(length2) - longer, end = (behind + length2) / std::sqrt(length2) + longer;
  const double wider2 = pi * pi / 16 * (alpha2 + beta * beta);
  const auto part = [](double x, double a2) { return 0.5 * x / std::sqrt(a2 + x * x); };
  const double across = part(beta + w, alpha2) - part(beta - w, alpha2), lengthwise = part(end, wider2) - part(begin, wider2);
  const HalfAngle h = half_angle(v, l);
  const double masked = through_mirror ? masked_between(lobe.alpha(), v.z, l.z) : GgxView(lobe.alpha(), lobe.lobe.masking, v).masked(l.z);
  const double slow = 4 * h.v_dot_h / std::sqrt(h.cos2) * l.z * masked;
  return fresnel_reflectance(lobe.lobe, h.v_dot_h) * (std::max(across * lengthwise, 0.0) * std::min(slow, 1.0));
}
// The ends of a tube are half a circle farther, pi / 4 of it on average. It is cut where all has set, and what is above of an end that has
// set half has its middle there.
Rgb tube_strip(const TubeView& tube, const LobeView& lobe) {
  Vec3d a = lobe.frame.vector(tube.a), b = lobe.frame.vector(tube.b);
  const double low_a = a.z + tube.radius, low_b = b.z + tube.radius;
  if (!(low_a > 0 || low_b > 0)) return {};
  const Vec3d crossing = a + (b - a) * (low_a / (low_a - low_b));
  if (low_a < 0) a = crossing;
  if (low_b < 0) b = crossing;
  a.z = std::max(a.z, 0.5 * (a.z + tube.radius)), b.z = std::max(b.z, 0.5 * (b.z + tube.radius));
  return lit_by_strip(
      lobe, a, b, [&](double over_distance, double rise) { return std::min(tube.radius * over_distance, rise); }, 0.25 * pi, false);
}
// What of a line from a to b in the point's frame is above the horizon, as a share; nothing if it is below.
double cut_at_horizon(Vec3d& a, Vec3d& b) {
  if (a.z >= 0 && b.z >= 0) return 1;
  if (a.z <= 0 && b.z <= 0) return 0;
  const double to_crossing = a.z / (a.z - b.z);
  (a.z < 0 ? a : b) = a + (b - a) * to_crossing;
  return a.z > 0 ? to_crossing : 1 - to_crossing;
}
// A sphere as its diameter in the plane of the mirrored view, pi / 4 of it wide. Cut by the horizon that is so on one side only.
Rgb round_strip(const SphereView& sphere, const LobeView& lobe) {
  const double distance = length(sphere.centre), sine = std::min(sphere.radius / distance, 1.0);
  const Vec3d l = sphere.centre * (1 / distance), mirror = lobe.mirror;
  Vec3d side = mirror - l * dot(l, mirror);
  if (dot(side, side) < 1e-10) side = basis_around(l).tangent;
  const Vec3d middle = l * std::sqrt(1 - sine * sine), half = normalised(side) * sine;
  Vec3d a = lobe.frame.vector(middle + half), b = lobe.frame.vector(middle - half);
  if (cut_at_horizon(a, b) == 0) return {};
  const double angle = 0.25 * pi * sine;
  return lit_by_strip(
      lobe, normalised(a), normalised(b), [&](double, double rise) { return 0.5 * (angle + std::min(angle, rise)); }, 0, true);
}
// A flat light as what the plane of its centre and the mirrored view cuts, so wide that it has the light's area; of its distances from the
// point's plane and from that line |a x b| / |b - a| the quotient is what is seen of the width.
template <class Flat>
Rgb strip_across(const Flat& light, const Vec3d& half, const LobeView& lobe) {
  Vec3d a = lobe.frame.vector(light.centre + half), b = lobe.frame.vector(light.centre - half);
  const double area = light.area() * cut_at_horizon(a, b), apart = length(cross(a, b));
  if (!(area > 0 && apart > 0)) return {};
  const double half_width = 0.5 * area * light.height() / apart;
  return lit_by_strip(
      lobe, a, b, [&](double over_distance, double) { return half_width * over_distance; }, 0, true);
}
// In the light's plane, from its centre to where the mirrored view meets it, or comes from: some multiple of it.
template <class Flat>
Vec3d towards_mirror(const Flat& light, const Vec3d& x, const LobeView& lobe) {
  return lobe.mirror * light.height() + light.centre * dot(lobe.mirror, light.normal) + x * (1e-6 * light.height());
}
Rgb rect_strip(const RectView& rect, const LobeView& lobe) {
  const Vec3d way = towards_mirror(rect, rect.x, lobe);
  const double over = std::max(std::abs(dot(way, rect.x)) / rect.half_x, std::abs(dot(way, rect.y)) / rect.half_y);
  return strip_across(rect, way * (1 / over), lobe);
}
Rgb disk_strip(const DiskView& disk, const LobeView& lobe) {
  return strip_across(disk, normalised(towards_mirror(disk, basis_around(disk.normal).tangent, lobe)) * disk.radius, lobe);
}
// All that the lobe mirrors, its albedo, times what the light has of the lobe about the mirrored view, whose width is 2 alpha in the plane
// of incidence and 2 alpha n.v across it: of one width for both, 2 alpha (n.v)^(1/4), the mean of the former and of both. Where the
// mirrored view r meets a rectangle's plane at the distance D it is D times that and, along a side x, sqrt(1 + (r.x / r.n)^2) times that;
// along each side there is x / sqrt(w^2 + x^2) of it between both ends, as if they were independent. Karis' billboard and cone, with the
// lobe's shape.
double footprint2(const LobeView& lobe) { return 4 * lobe.alpha() * lobe.alpha() * std::sqrt(dot(lobe.normal, lobe.view)); }
Rgb rect_footprint(const RectView& rect, const LobeView& lobe) {
  const Vec3d &r = lobe.mirror, &n = lobe.normal;
  const double falling = -dot(r, rect.normal);
  const double top = dot(n, rect.centre) + rect.half_x * std::abs(dot(n, rect.x)) + rect.half_y * std::abs(dot(n, rect.y));
  if (!(falling > 0 && top > 0)) return {};
  const double distance = rect.height() / falling;
  const Vec3d at = r * distance - rect.centre;
  const auto seen = [&](const Vec3d& side, double half) {
    const double off = dot(at, side), slant = dot(r, side) / falling, w2 = footprint2(lobe) * distance * distance * (1 + slant * slant);
    const auto part = [w2](double s) { return s / std::sqrt(s * s + w2); };
    return 0.5 * (part(off + half) - part(off - half));
  };
  const double share = seen(rect.x, rect.half_x) * seen(rect.y, rect.half_y);
  return reflectance(lobe.lobe, lobe.frame.vector(lobe.view), 1e-4).value * share;
}
// Of a sphere by chords between directions, on which disks are disks.
Rgb round_footprint(const SphereView& sphere, const LobeView& lobe) {
  const double distance = length(sphere.centre), sine = sphere.radius / distance, sine2 = std::min(sine * sine, 1.0);
  const Vec3d l = sphere.centre * (1 / distance), off = l - lobe.mirror;
  if (!(dot(l, lobe.normal) + sine > 0)) return {};
  const double share = disk_share(dot(off, off), footprint2(lobe), 2 * sine2 / (1 + std::sqrt(1 - sine2)));
  return reflectance(lobe.lobe, lobe.frame.vector(lobe.view), 1e-4).value * share;
}
constexpr SpecularRules footprint_rules{.rect = rect_footprint, .sphere = round_footprint, .sun = round_footprint};
constexpr SpecularRules strip_rules{.rect = rect_strip, .disk = disk_strip, .sphere = round_strip, .tube = tube_strip, .sun = round_strip};
constexpr SpecularRules covered_rules{
    .rect = flat_part<RectView>, .disk = flat_part<DiskView>, .sphere = round_part, .tube = tube_part, .sun = round_part};
constexpr SpecularMethod methods[] = {
    {"covered-lobe", "Etendue",
     "The share of the lobe that the light covers, as a disk of half vectors about its centre, in closed form; all that is slow in the "
     "lobe is taken at the centre. Dark once that has set; a sphere, once all of it has.",
     published<covered_rules>},
    {"covered-strip", "Etendue",
     "The same of a tube as a strip of half vectors about its axis, of other lights about what the plane of the mirrored view cuts of "
     "them; cut "
     "at the horizon.",
     published<strip_rules>},
    {"covered-footprint", "Etendue",
     "The lobe's albedo times the share of a lobe about the mirrored view that a sphere or rectangle fills, with the shape of GGX; no "
     "light "
     "on a rectangle where the mirrored view leads away.",
     published<footprint_rules>},
};

}  // namespace

std::span<const SpecularMethod> covered_specular_methods() { return methods; }

}  // namespace etendue::eval
