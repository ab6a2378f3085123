#include "hashing.h"
#include "surface.h"

#include <cmath>
#include <numeric>

namespace etendue::rendering {
namespace {

// Sets of vertices that triangles connect (union-find with path halving).
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

// The same number for triangles in the same plane, up to rounding: flat-shaded neighbours without a visible edge between them.
std::uint64_t plane_number(const Vec3d& normal, const Vec3d& point, double size) {
  const auto step = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::llround(x * 1e5))); };
  std::uint64_t h = mixed(step(normal.x));
  h = mixed(h ^ step(normal.y));
  h = mixed(h ^ step(normal.z));
  return mixed(h ^ step(dot(normal, point) / size));
}

double extent(const std::vector<Vec3d>& points) {
  double most = 0;
  for (const Vec3d& p : points) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return most > 0 ? most : 1;
}

}  // namespace

WorldMesh to_world(const Mesh& mesh, const Transform& transform, bool flat) {
  WorldMesh out;
  out.triangles.positions.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) out.triangles.positions.push_back(transform.point(vec_cast<double>(p)));
  // A mirroring transform keeps the front: the winding turns.
  const bool mirrored = transform.determinant() < 0;
  out.triangles.corners.reserve(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    out.triangles.corners.push_back(mirrored ? std::array{a, c, b} : std::array{a, b, c});
  }
  if (!flat && mesh.normals.size() == mesh.positions.size()) {
    out.normals.reserve(mesh.normals.size());
    for (const Vec3f& n : mesh.normals) out.normals.push_back(normalised(transform.normal(vec_cast<double>(n))));
  }
  if (mesh.uvs.size() == mesh.positions.size()) {
    out.uvs.reserve(mesh.uvs.size());
    for (const Vec2f& uv : mesh.uvs) out.uvs.push_back({uv.x, uv.y});
  }
  const auto& positions = out.triangles.positions;
  out.group.reserve(out.triangles.corners.size());
  if (out.normals.empty()) {
    const double size = extent(positions);
    for (const auto& [a, b, c] : out.triangles.corners) {
      const Vec3d normal = normalised(cross(positions[b] - positions[a], positions[c] - positions[a]));
      out.group.push_back(plane_number(normal, positions[a], size));
    }
    return out;
  }
  Components components(positions.size());
  for (const auto& [a, b, c] : out.triangles.corners) components.join(a, b), components.join(b, c);
  for (const auto& corner : out.triangles.corners) out.group.push_back(components.find(corner[0]));
  return out;
}

}  // namespace etendue::rendering
