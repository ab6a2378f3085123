#include "silhouette.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

// All tangents from the point to a sphere make the angle asin(R / d) with the centre's direction.
Contour sphere_silhouette(const Vec3d& centre, double radius) {
  const double d = length(centre);
  if (!(d > radius) || !(radius > 0)) return {};
  return {cap_circle(centre / d, std::sqrt((d - radius) * (d + radius)) / d, radius / d)};
}

Contour disk_silhouette(const Vec3d& centre, const Vec3d& normal, double radius, bool two_sided) {
  const double height = -dot(centre, normal);  // of the point above the emitting side
  if (!(radius > 0) || !(height > 0 || (two_sided && height < 0))) return {};
  // Counter-clockwise as seen from the point is clockwise about the side that faces it.
  const Basis b = basis_around(height > 0 ? -normal : normal);
  return {Arc{centre, b.tangent * radius, b.bitangent * radius, 0, 2 * pi, false}};
}

Contour polygon_silhouette(std::span<const Vec3d> vertices, const Vec3d& normal, bool two_sided) {
  if (vertices.size() < 3) return {};
  const double height = -dot(vertices[0], normal);
  if (!(height > 0 || (two_sided && height < 0))) return {};
  Contour contour;
  contour.reserve(vertices.size());
  const std::size_t n = vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = height > 0 ? n - 1 - i : i, to = height > 0 ? (from + n - 1) % n : (i + 1) % n;
    if (const auto arc = great_circle(vertices[from], vertices[to])) contour.push_back(*arc);
  }
  return contour;
}

// A plane through the point with the outward unit normal m touches the side if m.axis = 0 and m.a = -R. With a' the part of `a` across
// the axis, D its length and w = axis x a' / D:  m = -(R / D) a' / D +- sqrt(1 - R^2 / D^2) w.
TubeTangents tube_tangents(const Vec3d& a, const Vec3d& b, double radius) {
  const Vec3d axis = normalised(b - a);
  const Vec3d across = a - axis * dot(axis, a);
  const double distance = length(across);
  if (!(distance > radius)) return {};
  const Vec3d towards = across / distance, side = cross(axis, towards);
  const double sine = radius / distance, cosine = std::sqrt((distance - radius) * (distance + radius)) / distance;
  return {true, {side * cosine - towards * sine, -side * cosine - towards * sine}};
}

bool inside_tube(const Vec3d& a, const Vec3d& b, double radius, Caps caps) {
  const Vec3d span = b - a;
  const double l2 = dot(span, span);
  if (!(l2 > 0)) return caps == Caps::round && dot(a, a) <= radius * radius;
  const double along = -dot(a, span) / l2;
  if (caps != Caps::round && (along < 0 || along > 1)) return false;
  const Vec3d nearest = a + span * std::clamp(along, 0.0, 1.0);
  return dot(nearest, nearest) <= radius * radius;
}

namespace {

// Part of a circle (c, u, v as in Arc, u and v of length 1 up to `size`) from one touching point to the other. u points along the
// middle of the wanted part; `touch` is a vector in the plane of u and v towards one end, the other end is its mirror image.
Arc symmetric_arc(const Vec3d& centre, const Vec3d& u, const Vec3d& v, double size, const Vec3d& touch, bool unit) {
  const double half = std::abs(std::atan2(dot(touch, v), dot(touch, u)));
  return {centre, u * size, v * size, -half, half, unit};
}

// The outline of the cap at `end` between both tangent planes, counter-clockwise; `outward` is the axis pointing out of the tube there.
Arc round_cap(const Vec3d& end, const Vec3d& outward, double radius, const Vec3d& tangent_normal) {
  const double d = length(end);
  const Vec3d axis = end / d;
  // The circle of tangency seen as directions; u points outwards, v completes a right-handed frame about the axis.
  const Vec3d u = normalised(outward - axis * dot(axis, outward)), v = cross(axis, u);
  const double sine = radius / d, cosine = std::sqrt((d - radius) * (d + radius)) / d;
  return symmetric_arc(axis * cosine, u, v, sine, end + tangent_normal * radius, true);
}

Arc flat_cap(const Vec3d& end, const Vec3d& outward, double radius, const Vec3d& tangent_normal, bool far_half) {
  const Vec3d across = end - outward * dot(outward, end);
  const Vec3d u = normalised(far_half ? across : -across);
  // The far half bounds the face that is seen, counter-clockwise about it, which is clockwise about `outward`. The near half bounds the
  // side, which lies on its other side.
  const Vec3d v = far_half ? cross(u, outward) : cross(outward, u);
  return symmetric_arc(end, u, v, radius, tangent_normal, false);
}

}  // namespace

Contour tube_silhouette(const Vec3d& a, const Vec3d& b, double radius, Caps caps) {
  const Vec3d span = b - a;
  if (!(radius > 0) || inside_tube(a, b, radius, caps)) return {};
  if (!(dot(span, span) > 0)) return caps == Caps::round ? sphere_silhouette(a, radius) : Contour{};
  const Vec3d axis = normalised(span);
  const TubeTangents tangents = tube_tangents(a, b, radius);
  if (!tangents.exist) {
    // Beyond an end and within the infinite cylinder: the nearer cap hides everything else.
    const bool a_is_nearer = dot(a, axis) > 0;
    const Vec3d& nearer = a_is_nearer ? a : b;
    if (caps == Caps::round) return sphere_silhouette(nearer, radius);
    if (caps == Caps::flat) return disk_silhouette(nearer, a_is_nearer ? -axis : axis, radius, false);
    return {};
  }
  // A cap's flat face is seen from beyond its plane.
  const bool face_a = dot(a, axis) > 0, face_b = dot(b, axis) < 0;
  const auto cap = [&](const Vec3d& end, const Vec3d& outward, bool face_seen) {
    return caps == Caps::round ? round_cap(end, outward, radius, tangents.normal[0])
                               : flat_cap(end, outward, radius, tangents.normal[0], face_seen && caps == Caps::flat);
  };
  Contour contour{cap(a, -axis, face_a)};
  const Arc cap_b = cap(b, axis, face_b);
  const Vec3d from_a = contour[0].at(contour[0].end), to_a = contour[0].at(contour[0].begin);
  if (const auto side = great_circle(from_a, cap_b.at(cap_b.begin))) contour.push_back(*side);
  contour.push_back(cap_b);
  if (const auto side = great_circle(cap_b.at(cap_b.end), to_a)) contour.push_back(*side);
  return contour;
}

}  // namespace etendue::eval
