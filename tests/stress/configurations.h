// A light and a shading point from numbers in [0, 1), so that a search can move through all of them: sizes from a millimetre to a
// kilometre, distances from 1e-5 to 1e6 times the size, every tilt, horizons that touch, outlines up to 1e4 times as long as wide, far from
// the origin.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "eval_protocol.h"

namespace etendue::stress {

enum class Kind { rect, star, sphere, disk, capsule, flat_tube, open_tube, mesh };
inline constexpr std::array<std::pair<Kind, const char*>, 8> kinds{{{Kind::rect, "rectangle"},
                                                                    {Kind::star, "polygon"},
                                                                    {Kind::sphere, "sphere"},
                                                                    {Kind::disk, "disk"},
                                                                    {Kind::capsule, "capsule"},
                                                                    {Kind::flat_tube, "tube, flat caps"},
                                                                    {Kind::open_tube, "tube, open"},
                                                                    {Kind::mesh, "mesh"}}};
using Numbers = std::array<double, 16>;

struct Configuration {
  eval::Emitter light;
  Vec3d origin;                // of the batch
  std::array<float, 6> point;  // position from the origin, normal
  Vec3d centre;
  double size = 0, distance = 0;

  Vec3d position() const { return origin + Vec3d{point[0], point[1], point[2]}; }
  Vec3d normal() const { return normalised(Vec3d{point[3], point[4], point[5]}); }
};

inline double log_between(double low, double high, double u) { return low * std::pow(high / low, u); }
inline Vec3d direction(double u, double v) {
  const double z = 2 * u - 1, r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * pi * v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
// Half of them anywhere in [-1, 1], half within 1e-6 to 1 of zero, by logarithm.
inline double often_small(double u) {
  if (u < 0.5) return 4 * u - 1;
  return (u < 0.75 ? -1 : 1) * std::pow(10, -6 * std::fmod(4 * u, 1));
}

inline Configuration configuration(Kind kind, const Numbers& u) {
  using namespace eval;
  Configuration c;
  c.size = log_between(1e-3, 1e3, u[0]);
  c.distance = c.size * log_between(1e-5, 1e6, u[1]);
  const Vec3d towards = direction(u[2], u[3]);
  const double facing = std::clamp(often_small(u[4]), -1.0, 1.0), side = std::sqrt(1 - facing * facing);
  const Basis around = basis_around(towards);
  const Vec3d n =
      around.tangent * (side * std::cos(2 * pi * u[5])) + around.bitangent * (side * std::sin(2 * pi * u[5])) - towards * facing;
  const Basis plane = basis_around(n);
  // Doubles must hold the outline and on which side of its plane the point is.
  const double shortest = std::min(c.size * std::pow(10, -4 * u[7] * u[7] * u[7]), c.distance * std::abs(facing));
  c.origin = direction(u[11], u[12]) * (u[13] < 0.5 ? 0 : std::min(1e6, 1e6 * shortest) * u[13]);
  const double roll = 2 * pi * u[6], longer = c.size, shorter = c.size * std::pow(10, -4 * u[7] * u[7] * u[7]);
  const Vec3d x = plane.tangent * std::cos(roll) + plane.bitangent * std::sin(roll), y = cross(n, x);
  c.centre = c.origin + towards * c.distance;
  EmitterShape shape;
  switch (kind) {
    case Kind::rect:
      shape = protocol::rectangle(c.centre, x, y, longer, shorter);
      break;
    case Kind::star: {
      PolygonEmitter star;
      const int corners = 3 + static_cast<int>(u[14] * 9);
      for (int i = 0; i < corners; ++i) {
        const double phi = 2 * pi * i / corners, r = 0.5 * (i % 2 == 0 ? 1 : 0.25 + 0.75 * u[15]);
        star.vertices.push_back(c.centre + x * (longer * r * std::cos(phi)) + y * (shorter * r * std::sin(phi)));
      }
      star.normal = n;
      shape = std::move(star);
      break;
    }
    case Kind::sphere:  // at that distance from its surface, or inside
      c.centre = c.origin + towards * (0.5 * c.size + (u[14] < 0.1 ? -std::min(c.distance, 0.5 * c.size) : c.distance));
      shape = SphereEmitter{c.centre, 0.5 * c.size};
      break;
    case Kind::disk:
      shape = DiskEmitter{c.centre, n, x, 0.5 * c.size};
      break;
    case Kind::mesh: {  // of a tetrahedron
      MeshEmitter mesh;
      const std::array<Vec3d, 4> p{c.centre + x * longer, c.centre - x * longer + y * longer, c.centre - x * longer - y * longer,
                                   c.centre + n * shorter};
      for (const auto& [i, j, k] : {std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{2, 0, 3}, std::array{0, 2, 1}})
        mesh.triangles.push_back({p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)], p[static_cast<std::size_t>(k)]});
      shape = std::move(mesh);
      break;
    }
    default:
      shape = TubeEmitter{c.centre - x * (0.5 * longer), c.centre + x * (0.5 * longer), 0.5 * shorter,
                          kind == Kind::capsule     ? Caps::round
                          : kind == Kind::flat_tube ? Caps::flat
                                                    : Caps::none};
  }
  c.light = protocol::white(std::move(shape));
  c.light.two_sided = kind != Kind::open_tube && u[14] > 0.5;
  // Some normals anywhere; others such that the horizon passes through the light or close to it.
  Vec3d normal = direction(u[8], u[9]);
  if (u[10] > 0.3) {
    const Vec3d through = c.centre + (x * std::cos(7 * u[10]) + y * std::sin(7 * u[10])) * (0.5 * c.size) - c.origin;
    const Basis horizon = basis_around(normalised(through));
    normal = normalised(horizon.tangent * std::cos(2 * pi * u[8]) + horizon.bitangent * std::sin(2 * pi * u[8]) +
                        normalised(through) * often_small(u[9]));
  }
  const Vec3d offset = direction(u[12], u[13]) * (u[15] < 0.5 ? 0 : 10 * c.distance * (u[15] - 0.5));
  for (std::size_t i = 0; i < 3; ++i) {
    c.point[i] = static_cast<float>(offset[static_cast<int>(i)]);
    c.point[i + 3] = static_cast<float>(normal[static_cast<int>(i)]);
  }
  c.origin -= offset;
  return c;
}

}  // namespace etendue::stress
