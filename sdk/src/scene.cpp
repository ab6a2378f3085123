#include "etendue/scene.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// A box that grows by points.
struct Growing {
  Bounds bounds;
  void add(const Vec3d& p) {
    if (bounds.empty()) {
      bounds = {p, p};
      return;
    }
    for (int i = 0; i < 3; ++i) {
      bounds.min[i] = std::min(bounds.min[i], p[i]);
      bounds.max[i] = std::max(bounds.max[i], p[i]);
    }
  }
  // All eight corners of the local box [low, high].
  void add_box(const Transform& to_world, const Vec3d& low, const Vec3d& high) {
    for (int corner = 0; corner < 8; ++corner)
      add(to_world.point({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z}));
  }
  // A unit ball under a linear map reaches the length of the map's rows along each axis.
  void add_ball(const Transform& to_world, const Vec3d& local_centre, double radius) {
    const Vec3d centre = to_world.point(local_centre);
    Vec3d reach;
    for (int i = 0; i < 3; ++i)
      reach[i] = std::fabs(radius) * std::hypot(to_world.columns[0][i], to_world.columns[1][i], to_world.columns[2][i]);
    add(centre - reach);
    add(centre + reach);
  }
  void add_mesh(const Transform& to_world, const std::vector<Mesh>& meshes, std::uint32_t index) {
    if (index >= meshes.size()) return;
    for (const Vec3f& p : meshes[index].positions) add(to_world.point(vec_cast<double>(p)));
  }
};

struct AddGeometry {
  Growing& grow;
  const Transform& to_world;
  const std::vector<Mesh>& meshes;
  void operator()(const PlaneGeometry& g) const { grow.add_box(to_world, {-g.size / 2, 0, -g.size / 2}, {g.size / 2, 0, g.size / 2}); }
  void operator()(const BoxGeometry& g) const { grow.add_box(to_world, g.size * -0.5, g.size * 0.5); }
  void operator()(const SphereGeometry& g) const { grow.add_ball(to_world, {0, 0, 0}, g.radius); }
  void operator()(const MeshGeometry& g) const { grow.add_mesh(to_world, meshes, g.mesh); }
};

struct AddShape {
  Growing& grow;
  const Transform& to_world;
  const std::vector<Mesh>& meshes;
  void operator()(const PointShape&) const { grow.add(to_world.translation); }
  void operator()(const SpotShape&) const { grow.add(to_world.translation); }
  void operator()(const FrustumShape&) const { grow.add(to_world.translation); }
  void operator()(const PhotometricShape&) const { grow.add(to_world.translation); }
  void operator()(const DistantShape&) const {}
  void operator()(const EnvironmentShape&) const {}
  void operator()(const SphereShape& s) const { grow.add_ball(to_world, {0, 0, 0}, s.radius); }
  void operator()(const DiskShape& s) const {
    Transform flat = to_world;
    flat.columns[2] = {0, 0, 0};
    grow.add_ball(flat, {0, 0, 0}, s.radius);
  }
  void operator()(const RectShape& s) const { grow.add_box(to_world, {-s.width / 2, -s.height / 2, 0}, {s.width / 2, s.height / 2, 0}); }
  void operator()(const PolygonShape& s) const {
    for (const Vec2d& p : s.points) grow.add(to_world.point({p.x, p.y, 0}));
  }
  void operator()(const TubeShape& s) const {
    if (s.caps == Caps::round) {
      grow.add_ball(to_world, {-s.length / 2, 0, 0}, s.radius);
      grow.add_ball(to_world, {s.length / 2, 0, 0}, s.radius);
      return;
    }
    Transform across = to_world;
    across.columns[0] = {0, 0, 0};
    for (const double end : {-s.length / 2, s.length / 2}) {
      across.translation = to_world.point({end, 0, 0});
      grow.add_ball(across, {0, 0, 0}, s.radius);
    }
  }
  void operator()(const LineShape& s) const {
    grow.add(to_world.point({-s.length / 2, 0, 0}));
    grow.add(to_world.point({s.length / 2, 0, 0}));
  }
  void operator()(const MeshShape& s) const { grow.add_mesh(to_world * Transform::from_trs({0, 0, 0}, {}, s.scale), meshes, s.mesh); }
};

}  // namespace

double area_of(const Mesh& mesh, const Transform& to_world) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    if (std::max({a, b, c}) >= mesh.positions.size()) continue;  // validate() reports it
    const Vec3d origin = vec_cast<double>(mesh.positions[a]);
    const Vec3d u = vec_cast<double>(mesh.positions[b]) - origin, v = vec_cast<double>(mesh.positions[c]) - origin;
    twice += length(cross(to_world.vector(u), to_world.vector(v)));
  }
  return twice / 2;
}

double mesh_area_of(const Scene& scene, const Light& light) {
  const auto* shape = std::get_if<MeshShape>(&light.shape);
  if (shape == nullptr || shape->mesh >= scene.meshes.size()) return 0;
  return area_of(scene.meshes[shape->mesh], Transform::from_trs({0, 0, 0}, {}, shape->scale));
}

Camera look_at(const Vec3d& position, const Vec3d& target, double vfov_rad) {
  const Vec3d away = position - target;
  const Vec3d z = length(away) > 0 ? normalised(away) : Vec3d{0, 0, 1};
  // Straight up or down, +Y gives no roll: then the top of the picture is -Z (looking down) or +Z (looking up).
  const Vec3d sideways = cross(Vec3d{0, 1, 0}, z);
  const bool vertical = length(sideways) < 1e-9;
  const Vec3d x = vertical ? Vec3d{1, 0, 0} : normalised(sideways);
  Camera camera;
  camera.transform = {{x, normalised(cross(z, x)), z}, position};
  camera.vfov_rad = vfov_rad;
  return camera;
}

Bounds bounds_of(const Scene& scene) {
  Growing grow;
  for (const Object& object : scene.objects) std::visit(AddGeometry{grow, object.transform, scene.meshes}, object.geometry);
  for (const Light& light : scene.lights) std::visit(AddShape{grow, light.transform, scene.meshes}, light.shape);
  return grow.bounds;
}

Camera framing_camera(const Bounds& bounds, double aspect) {
  const Bounds box = bounds.empty() ? Bounds{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}} : bounds;
  const Vec3d centre = box.min + (box.max - box.min) * 0.5;
  const Vec3d half = (box.max - box.min) * 0.5;
  const Vec3d direction = normalised(Vec3d{0, 0.3, 1});  // 17 degrees above the horizon
  Camera camera = look_at(centre + direction, centre, Camera{}.vfov_rad);
  const double tan_y = std::tan(camera.vfov_rad / 2), tan_x = tan_y * (aspect > 0 ? aspect : 1);

  // A corner q (camera axes, from the centre) is inside if |q.x| <= tan_x (distance - q.z), and so for y.
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d q{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z};
    const Vec3d in_camera{dot(q, camera.transform.columns[0]), dot(q, camera.transform.columns[1]), dot(q, camera.transform.columns[2])};
    distance = std::max(distance, in_camera.z + std::max(std::fabs(in_camera.x) / tan_x, std::fabs(in_camera.y) / tan_y));
  }
  constexpr double margin = 1.05;
  camera.transform.translation = centre + direction * (distance > 0 ? distance * margin : 1.0);
  camera.aspect = aspect > 0 ? aspect : 0;
  camera.name = "framing";
  return camera;
}

}  // namespace etendue
