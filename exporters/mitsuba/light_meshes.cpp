#include "light_meshes.h"

#include "eval/triangulate.h"

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {
namespace {

// Rings of a surface of revolution about X: position along X and distance from it.
struct Ring {
  double x, r;
};

constexpr int sides = 256;
constexpr int rings_per_cap = 64;

std::vector<Ring> profile_of(const TubeShape& tube, double radius) {
  const double half = tube.length / 2;
  std::vector<Ring> profile;
  if (tube.caps == Caps::round) {
    for (int i = 0; i < rings_per_cap; ++i) {
      const double angle = pi / 2 * i / rings_per_cap;
      profile.push_back({-half - radius * std::cos(angle), radius * std::sin(angle)});
    }
  } else if (tube.caps == Caps::flat) {
    profile.push_back({-half, 0});
  }
  profile.push_back({-half, radius});
  const std::size_t left = profile.size();
  for (std::size_t i = left; i-- > 0;) {
    if (tube.length > 0 || i + 1 < left) profile.push_back({-profile[i].x, profile[i].r});
  }
  return profile;
}

Vec3d corner(const Ring& ring, int side) {
  const double angle = 2 * pi * side / sides;
  return {ring.x, ring.r * std::cos(angle), ring.r * std::sin(angle)};
}

double triangle_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return length(cross(b - a, c - a)) / 2; }

double area_of(const std::vector<Ring>& profile) {
  double area = 0;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Vec3d a = corner(profile[i], 0), b = corner(profile[i], 1), c = corner(profile[i + 1], 1), d = corner(profile[i + 1], 0);
    area += sides * (triangle_area(a, b, c) + triangle_area(a, c, d));
  }
  return area;
}

double true_area(const TubeShape& tube) {
  const double side = 2 * pi * tube.radius * tube.length;
  switch (tube.caps) {
    case Caps::round:
      return side + 4 * pi * tube.radius * tube.radius;
    case Caps::flat:
      return side + 2 * pi * tube.radius * tube.radius;
    case Caps::none:
      break;
  }
  return side;
}

// The mean projected area of a convex body is a quarter of its surface (Cauchy), and light arrives in proportion to projected area. So the
// polyhedron with the true surface area lights right on average over directions, and its flux is right. The area grows with the radius:
// secant steps.
double equivalent_radius(const TubeShape& tube) {
  const double wanted = true_area(tube);
  double r0 = tube.radius, a0 = area_of(profile_of(tube, r0));
  double r1 = tube.radius * 1.0001;
  for (int step = 0; step < 8; ++step) {
    const double a1 = area_of(profile_of(tube, r1));
    if (std::abs(a1 - a0) <= 1e-15 * wanted) break;
    const double next = r1 + (wanted - a1) * (r1 - r0) / (a1 - a0);
    r0 = r1, a0 = a1, r1 = next;
  }
  return r1;
}

}  // namespace

Mesh polygon_mesh(const PolygonShape& polygon) {
  const bool clockwise = eval::signed_area(polygon.points) < 0;
  Mesh mesh;
  for (const auto& [a, b, c] : eval::triangulate(polygon.points)) {
    // Counter-clockwise in XY faces +Z; the light faces -Z.
    mesh.indices.insert(mesh.indices.end(), {a, clockwise ? b : c, clockwise ? c : b});
  }
  for (const Vec2d& p : polygon.points) mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), 0});
  return mesh;
}

Mesh tube_mesh(const TubeShape& tube) {
  const std::vector<Ring> profile = profile_of(tube, equivalent_radius(tube));
  Mesh mesh;
  for (const Ring& ring : profile) {
    for (int side = 0; side < sides; ++side) mesh.positions.push_back(vec_cast<float>(corner(ring, side)));
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int side = 0; side < sides; ++side) {
      const auto at = [&](std::size_t ring, int s) {
        return static_cast<std::uint32_t>(ring * sides + static_cast<std::size_t>(s % sides));
      };
      const std::uint32_t a = at(i, side), b = at(i, side + 1), c = at(i + 1, side + 1), d = at(i + 1, side);
      // Counter-clockwise seen from outside. A ring of radius 0 is a point: one of both triangles has no area.
      if (profile[i].r > 0) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (profile[i + 1].r > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
  }
  return mesh;
}

Mesh two_sided(const Mesh& mesh, double gap) {
  Mesh both;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    Vec3d p[3];
    for (std::size_t c = 0; c < 3; ++c) p[c] = vec_cast<double>(mesh.positions[mesh.indices[i + c]]);
    const Vec3d shift = normalised(cross(p[1] - p[0], p[2] - p[0])) * (gap / 2);
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    for (const Vec3d& corner : p) both.positions.push_back(vec_cast<float>(corner + shift));
    for (const Vec3d& corner : p) both.positions.push_back(vec_cast<float>(corner - shift));
    if (!mesh.uvs.empty()) {
      for (int side = 0; side < 2; ++side) {
        for (std::size_t c = 0; c < 3; ++c) both.uvs.push_back(mesh.uvs[mesh.indices[i + c]]);
      }
    }
    both.indices.insert(both.indices.end(), {first, first + 1, first + 2, first + 3, first + 5, first + 4});
  }
  return both;
}

Mesh scaled_mesh(const Mesh& mesh, const Vec3d& scale) {
  Mesh result = mesh;
  result.normals.clear();
  for (Vec3f& p : result.positions) p = vec_cast<float>(vec_cast<double>(p) * scale);
  if (scale.x * scale.y * scale.z < 0) {
    for (std::size_t i = 0; i + 2 < result.indices.size(); i += 3) std::swap(result.indices[i + 1], result.indices[i + 2]);
  }
  return result;
}

}  // namespace etendue::mitsuba
