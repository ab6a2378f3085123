// Lights relative to the shading point, in the terms of the published methods: centre and half axes instead of vertices.
#pragma once

#include "etendue/published.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <variant>

namespace etendue::eval {

struct RectView {
  Vec3d centre;
  Vec3d x, y;     // unit, along the sides; cross(x, y) is the normal
  Vec3d normal;   // the emitting side
  double half_x;  // half lengths of the sides
  double half_y;

  double height() const { return -dot(centre, normal); }  // of the point over the light's plane
  double area() const { return 4 * half_x * half_y; }
  Vec3d at(double s, double t) const { return centre + x * s + y * t; }
  // Counter-clockwise as seen from the point in front.
  std::array<Vec3d, 4> corners() const { return {at(-half_x, -half_y), at(-half_x, half_y), at(half_x, half_y), at(half_x, -half_y)}; }
  Vec3d closest(const Vec3d& p) const {
    return at(std::clamp(dot(p - centre, x), -half_x, half_x), std::clamp(dot(p - centre, y), -half_y, half_y));
  }
};

// Of a polygon of four right angles: sides that differ from a rectangle's by less than a millionth of its size are one.
std::optional<RectView> rect_view(const PolygonEmitter& polygon, bool two_sided, const Vec3d& position);

struct DiskView {
  Vec3d centre, normal;
  double radius;

  double height() const { return -dot(centre, normal); }
  double area() const { return pi * radius * radius; }
  Vec3d closest(const Vec3d& p) const {
    const Vec3d out = p - centre - normal * dot(p - centre, normal);
    const double d = length(out);
    return d > radius ? centre + out * (radius / d) : centre + out;
  }
};

struct SphereView {
  Vec3d centre;
  double radius;
};

struct TubeView {
  Vec3d a, b;  // centres of the caps
  double radius;
};

// A flat light from its emitting side (either, if it has two); a tube with round caps. Nothing for other shapes.
using LightView = std::variant<RectView, DiskView, SphereView, TubeView>;
std::optional<LightView> light_view(const Emitter& emitter, const Vec3d& position);

// What a method does with the shape: null if it does not take it.
template <class Method>
auto rule_for(const Method& method, const RectView&) {
  return method.rect;
}
template <class Method>
auto rule_for(const Method& method, const DiskView&) {
  return method.disk;
}
template <class Method>
auto rule_for(const Method& method, const SphereView&) {
  return method.sphere;
}
template <class Method>
auto rule_for(const Method& method, const TubeView&) {
  return method.tube;
}
// Whether the point is on the side that emits.
template <class View>
bool in_front(const View& view) {
  if constexpr (requires { view.height(); }) {
    return view.height() > 0;
  } else {
    return true;
  }
}

inline double saturate(double x) { return std::clamp(x, 0.0, 1.0); }
// As shaders do: the zero vector has no direction, and the result is not a number.
inline Vec3d shader_normalise(const Vec3d& v) { return v / length(v); }

// The part of a convex quadrilateral above the horizon of n: at most one vertex more, two where rounding makes it look concave.
struct ClippedQuad {
  std::array<Vec3d, 6> vertices;
  std::size_t count = 0;
  std::span<const Vec3d> polygon() const { return {vertices.data(), count}; }
};
ClippedQuad clipped(const std::array<Vec3d, 4>& quad, const Vec3d& n);

std::span<const DiffuseMethod> frostbite_methods();
std::span<const DiffuseMethod> frostbite_reference_methods();
std::span<const DiffuseMethod> drobot_methods();
std::span<const DiffuseMethod> hill_heitz_methods();
std::span<const DiffuseMethod> karis_methods();
std::span<const DiffuseMethod> eden_methods();

}  // namespace etendue::eval
