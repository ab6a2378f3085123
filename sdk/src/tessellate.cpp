#include "etendue/scene.h"

#include <cmath>

namespace etendue {
namespace {

Vec3f to_float(const Vec3d& v) { return vec_cast<float>(v); }

// A quad from its centre, half edges u (to the right) and v (up), facing u x v. uv (0, 0) is the upper left corner, as in glTF.
void add_quad(Mesh& mesh, const Vec3d& centre, const Vec3d& u, const Vec3d& v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Vec3f normal = to_float(normalised(cross(u, v)));
  for (const Vec3d& corner : {centre - u - v, centre + u - v, centre + u + v, centre - u + v}) {
    mesh.positions.push_back(to_float(corner));
    mesh.normals.push_back(normal);
  }
  mesh.uvs.insert(mesh.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

struct Tessellate {
  const std::vector<Mesh>& meshes;

  // Seen from above, right is +X and up is -Z.
  Mesh operator()(const PlaneGeometry& g) const {
    Mesh mesh;
    add_quad(mesh, {0, 0, 0}, {g.size / 2, 0, 0}, {0, 0, -g.size / 2});
    return mesh;
  }
  Mesh operator()(const BoxGeometry& g) const {
    const Vec3d x{g.size.x / 2, 0, 0}, y{0, g.size.y / 2, 0}, z{0, 0, g.size.z / 2};
    Mesh mesh;
    add_quad(mesh, z, x, y);
    add_quad(mesh, -z, -x, y);
    add_quad(mesh, x, -z, y);
    add_quad(mesh, -x, z, y);
    add_quad(mesh, y, x, -z);
    add_quad(mesh, -y, x, z);
    return mesh;
  }
  // Longitudes and latitudes, poles at +-Y, u = 0 at +Z growing towards +X, v = 0 at +Y.
  Mesh operator()(const SphereGeometry& g) const {
    constexpr std::uint32_t columns = 128, rows = 64;
    Mesh mesh;
    for (std::uint32_t row = 0; row <= rows; ++row) {
      const double polar = pi * row / rows;
      for (std::uint32_t column = 0; column <= columns; ++column) {
        const double azimuth = 2 * pi * column / columns;
        const Vec3d n{std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
        mesh.positions.push_back(to_float(n * g.radius));
        mesh.normals.push_back(to_float(n));
        mesh.uvs.push_back({static_cast<float>(column) / columns, static_cast<float>(row) / rows});
      }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
      for (std::uint32_t column = 0; column < columns; ++column) {
        const std::uint32_t a = row * (columns + 1) + column, b = a + 1, below_a = a + columns + 1, below_b = below_a + 1;
        if (row + 1 < rows) mesh.indices.insert(mesh.indices.end(), {a, below_a, below_b});
        if (row > 0) mesh.indices.insert(mesh.indices.end(), {a, below_b, b});
      }
    }
    return mesh;
  }
  Mesh operator()(const MeshGeometry& g) const { return g.mesh < meshes.size() ? meshes[g.mesh] : Mesh{}; }
};

}  // namespace

Mesh tessellated(const Geometry& geometry, const std::vector<Mesh>& meshes) { return std::visit(Tessellate{meshes}, geometry); }

}  // namespace etendue
