#include "light_shapes.h"

#include <algorithm>
#include <cmath>

#include "exporters/mitsuba/light_meshes.h"

namespace etendue::gltf {
namespace {

// Texture coordinates of a rectangle around the middle of its points: light.h, Emission::texture.
void put_uvs(Mesh& mesh, const Vec2d& low, const Vec2d& high) {
  const double width = high.x - low.x, height = high.y - low.y;
  for (const Vec3f& p : mesh.positions)
    mesh.uvs.push_back({static_cast<float>(width > 0 ? (high.x - static_cast<double>(p.x)) / width : 0.5),
                        static_cast<float>(height > 0 ? (high.y - static_cast<double>(p.y)) / height : 0.5)});
}

Mesh flat(const std::vector<Vec2d>& points) {
  Mesh mesh = mitsuba::polygon_mesh({points});
  Vec2d low = points[0], high = points[0];
  for (const Vec2d& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  put_uvs(mesh, low, high);
  return mesh;
}

struct Surface {
  const std::vector<Mesh>& meshes;

  std::optional<Mesh> operator()(const RectShape& s) const {
    const double x = s.width / 2, y = s.height / 2;
    return flat({{-x, -y}, {x, -y}, {x, y}, {-x, y}});
  }
  // A polygon of the disk's area: n / 2 sin(2 pi / n) r'^2 = pi r^2.
  std::optional<Mesh> operator()(const DiskShape& s) const {
    constexpr int sides = 128;
    const double radius = s.radius * std::sqrt(2 * pi / sides / std::sin(2 * pi / sides));
    std::vector<Vec2d> points;
    points.reserve(sides);
    for (int i = 0; i < sides; ++i) points.push_back({radius * std::cos(2 * pi * i / sides), radius * std::sin(2 * pi * i / sides)});
    return flat(points);
  }
  std::optional<Mesh> operator()(const PolygonShape& s) const { return flat(s.points); }
  std::optional<Mesh> operator()(const SphereShape& s) const { return tessellated(SphereGeometry{s.radius}, meshes); }
  std::optional<Mesh> operator()(const TubeShape& s) const { return mitsuba::tube_mesh(s); }
  std::optional<Mesh> operator()(const MeshShape& s) const { return mitsuba::scaled_mesh(meshes[s.mesh], s.scale); }
  template <class Other>
  std::optional<Mesh> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<Mesh> visible_shape(const Light& light, const std::vector<Mesh>& meshes) { return std::visit(Surface{meshes}, light.shape); }

}  // namespace etendue::gltf
