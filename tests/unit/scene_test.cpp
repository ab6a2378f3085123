#include "etendue/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>

namespace etendue {
namespace {

// Volume that a closed surface encloses, by the divergence theorem: positive if every triangle is counter-clockwise seen from outside.
double volume_of(const Mesh& mesh) {
  double six = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto p = [&](std::size_t k) { return vec_cast<double>(mesh.positions[mesh.indices[i + k]]); };
    six += dot(p(0), cross(p(1), p(2)));
  }
  return six / 6;
}

TEST(Tessellated, BoxHasFlatFacesTurnedOutwards) {
  const Mesh box = tessellated(BoxGeometry{{1, 2, 3}}, {});
  EXPECT_EQ(box.positions.size(), 24u);
  EXPECT_EQ(box.indices.size(), 36u);
  EXPECT_NEAR(volume_of(box), 6, 1e-6);
  EXPECT_NEAR(area_of(box, {}), 2 * (1 * 2 + 2 * 3 + 3 * 1), 1e-6);
  for (std::size_t i = 0; i < box.positions.size(); ++i)
    EXPECT_GT(dot(vec_cast<double>(box.positions[i]), vec_cast<double>(box.normals[i])), 0);
}

TEST(Tessellated, PlaneFacesUp) {
  const Mesh plane = tessellated(PlaneGeometry{4}, {});
  EXPECT_EQ(plane.indices.size(), 6u);
  EXPECT_NEAR(area_of(plane, {}), 16, 1e-6);
  for (const Vec3f& n : plane.normals) EXPECT_EQ(n, (Vec3f{0, 1, 0}));
  const auto p = [&](int k) { return vec_cast<double>(plane.positions[plane.indices[static_cast<std::size_t>(k)]]); };
  EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).y, 0);
}

// 128 x 64 quads: every vertex on the sphere (to float), the flat faces at most 6.1e-4 r below it, area and volume short by as much.
TEST(Tessellated, SphereStaysWithinItsChordError) {
  const Mesh sphere = tessellated(SphereGeometry{2}, {});
  for (const Vec3f& p : sphere.positions) EXPECT_NEAR(length(vec_cast<double>(p)), 2, 5e-7);
  double nearest = 2;
  for (std::size_t i = 0; i < sphere.indices.size(); i += 3) {
    Vec3d centre;
    for (std::size_t k = 0; k < 3; ++k) centre += vec_cast<double>(sphere.positions[sphere.indices[i + k]]) / 3.0;
    nearest = std::min(nearest, length(centre));
  }
  EXPECT_GT(nearest, 2 * (1 - 6.1e-4));
  EXPECT_LT(volume_of(sphere), 4.0 / 3 * pi * 8);
  EXPECT_GT(volume_of(sphere), 4.0 / 3 * pi * 8 * (1 - 3 * 6.1e-4));
  EXPECT_EQ(sphere.indices.size() % 3, 0u);
}

TEST(Area, FollowsTheTransform) {
  const Mesh plane = tessellated(PlaneGeometry{1}, {});
  EXPECT_NEAR(area_of(plane, Transform::from_trs({5, 5, 5}, {0, 0.6, 0, 0.8}, {2, 7, 3})), 6, 1e-6);
  Mesh broken = plane;
  broken.indices[0] = 99;
  EXPECT_NEAR(area_of(broken, {}), 0.5, 1e-7) << "a triangle that does not exist has no area";
}

TEST(LookAt, ShowsTheTargetInTheMiddleWithUpUpwards) {
  const Vec3d targets[] = {{0, 1, 0}, {5, -2, 1}, {0, 1.6, 4.0 - 9}, {0, 5, 4}, {0, -5, 4}};
  for (const Vec3d& target : targets) {
    const Camera camera = look_at({0, 1.6, 4}, target, 0.7);
    const Vec3d forward = -camera.transform.columns[2];
    EXPECT_NEAR(length(cross(forward, normalised(target - Vec3d{0, 1.6, 4}))), 0, 1e-15);
    EXPECT_GT(dot(forward, target - Vec3d{0, 1.6, 4}), 0);
    EXPECT_NEAR(camera.transform.determinant(), 1, 1e-14);
    EXPECT_GE(camera.transform.columns[1].y, -1e-15);
  }
  EXPECT_NEAR(look_at({1, 2, 3}, {1, 2, 3}, 0.7).transform.determinant(), 1, 1e-15) << "no direction is still a camera";
}

Scene small_scene() {
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back({"floor", PlaneGeometry{10}, 0, {}, "/objects/0"});
  scene.objects.push_back({"ball", SphereGeometry{0.5}, no_index, Transform::from_trs({0, 0.5, 0}, {}, {1, 1, 1}), "/objects/1"});
  Light lamp;
  lamp.name = "lamp";
  lamp.shape = SphereShape{0.1};
  lamp.emission = {Emission::Given::flux, 800, false, {}, {}, {}};
  lamp.transform.translation = {0, 3, 0};
  scene.lights.push_back(lamp);
  scene.cameras.push_back(look_at({0, 1.6, 4}, {0, 1, 0}, 0.7));
  return scene;
}

TEST(Bounds, HoldObjectsAndLightsWithAPlace) {
  EXPECT_TRUE(bounds_of({}).empty());
  Scene scene = small_scene();
  Light sun;
  sun.shape = DistantShape{};
  scene.lights.push_back(sun);
  const Bounds b = bounds_of(scene);
  EXPECT_EQ(b.min, (Vec3d{-5, 0, -5}));
  EXPECT_NEAR(b.max.y, 3.1, 1e-15);
}

// A disk turned by 30 degrees around X reaches r sin 30 along Z, r cos 30 along Y, r along X.
TEST(Bounds, OfADiskAreTight) {
  Scene scene;
  Light disk;
  disk.shape = DiskShape{2};
  disk.transform = Transform::from_trs({}, {std::sin(pi / 12), 0, 0, std::cos(pi / 12)});
  scene.lights.push_back(disk);
  const Bounds b = bounds_of(scene);
  EXPECT_NEAR(b.max.x, 2, 1e-14);
  EXPECT_NEAR(b.max.y, 2 * std::cos(pi / 6), 1e-14);
  EXPECT_NEAR(b.max.z, 1, 1e-14);
}

TEST(FramingCamera, SeesEveryCorner) {
  for (const Bounds& bounds :
       {Bounds{{-5, 0, -5}, {5, 3, 5}}, Bounds{{0, 0, 0}, {0.01, 9, 0.01}}, Bounds{{-50, 0, 0}, {50, 0, 0}}, Bounds{}}) {
    for (const double aspect : {0.5, 1.0, 16.0 / 9}) {
      const Camera camera = framing_camera(bounds, aspect);
      const double tan_y = std::tan(camera.vfov_rad / 2);
      if (bounds.empty()) continue;
      for (int i = 0; i < 8; ++i) {
        const Vec3d corner{i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y, i & 4 ? bounds.max.z : bounds.min.z};
        const Vec3d q = corner - camera.transform.translation;
        const double depth = -dot(q, camera.transform.columns[2]);
        EXPECT_GT(depth, 0);
        EXPECT_LE(std::fabs(dot(q, camera.transform.columns[1])), depth * tan_y);
        EXPECT_LE(std::fabs(dot(q, camera.transform.columns[0])), depth * tan_y * aspect);
      }
    }
  }
  EXPECT_TRUE(std::isfinite(framing_camera(Bounds{{1, 1, 1}, {1, 1, 1}}, 1).transform.translation.z)) << "a single point";
}

// ---- validate ----

TEST(Validate, AcceptsASoundScene) {
  const Diagnostics d = validate(small_scene());
  EXPECT_TRUE(d.all().empty()) << (d.all().empty() ? "" : to_string(d.all()[0]));
}

// Each fault alone in a sound scene, and the code that names it.
struct Fault {
  const char* what;
  void (*make)(Scene&);
  const char* code;
};
class OneFault : public testing::TestWithParam<Fault> {};
TEST_P(OneFault, IsTheOnlyErrorAndHasItsCode) {
  Scene scene = small_scene();
  GetParam().make(scene);
  const Diagnostics d = validate(scene);
  ASSERT_EQ(d.all().size(), 1u) << GetParam().what << (d.all().empty() ? "" : "\n" + to_string(d.all()[0]));
  EXPECT_EQ(d.all()[0].code, GetParam().code) << to_string(d.all()[0]);
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
Mesh triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  return mesh;
}
const Fault faults[] = {
    {"material index", [](Scene& s) { s.objects[0].material = 7; }, "INDEX_OUT_OF_RANGE"},
    {"mesh index", [](Scene& s) { s.objects[0].geometry = MeshGeometry{0}; }, "INDEX_OUT_OF_RANGE"},
    {"texture's image", [](Scene& s) { s.materials[0].base_colour_texture = Texture{}; }, "INDEX_OUT_OF_RANGE"},
    {"vertex index", [](Scene& s) { s.meshes.push_back(triangle()), s.meshes[0].indices[2] = 3; }, "INDEX_OUT_OF_RANGE"},
    {"index count", [](Scene& s) { s.meshes.push_back(triangle()), s.meshes[0].indices.pop_back(); }, "MESH_INVALID"},
    {"normal count", [](Scene& s) { s.meshes.push_back(triangle()), s.meshes[0].normals.resize(2); }, "MESH_INVALID"},
    {"vertex NaN", [](Scene& s) { s.meshes.push_back(triangle()), s.meshes[0].positions[1].y = static_cast<float>(nan); },
     "NUMBER_INVALID"},
    {"object NaN", [](Scene& s) { s.objects[0].transform.translation.x = nan; }, "NUMBER_INVALID"},
    {"plane size", [](Scene& s) { s.objects[0].geometry = PlaneGeometry{0}; }, "VALUE_OUT_OF_RANGE"},
    {"ellipsoid", [](Scene& s) { s.objects[1].transform.columns[0].x = 2; }, "TRANSFORM_NOT_SIMILAR"},
    {"flattened",
     [](Scene& s) {
       s.objects[0].transform.columns[0] = {0, 0, 0};
     },
     "TRANSFORM_SINGULAR"},
    {"base colour",
     [](Scene& s) {
       s.materials[0].model = Lambert{{0.5, 1.5, 0.5}};
     },
     "VALUE_OUT_OF_RANGE"},
    {"roughness NaN",
     [](Scene& s) {
       s.materials[0].model = Standard{{1, 1, 1}, 0, nan, 0.5};
     },
     "VALUE_OUT_OF_RANGE"},
    {"specular of f0 1",
     [](Scene& s) {
       s.materials[0].model = Principled{{1, 1, 1}, 0, 0.5, 12.5};
     },
     "VALUE_OUT_OF_RANGE"},
    {"alpha 0",
     [](Scene& s) {
       s.materials[0].model = Conductor{{1, 1, 1}, {0, 0, 0}, 0};
     },
     "VALUE_OUT_OF_RANGE"},
    {"ior",
     [](Scene& s) {
       s.materials[0].model = MetalRough{{1, 1, 1}, 0, 0.5, 0.9};
     },
     "VALUE_OUT_OF_RANGE"},
    {"camera scaled", [](Scene& s) { s.cameras[0].transform.columns[0] *= 2; }, "TRANSFORM_NOT_RIGID"},
    {"camera mirrored", [](Scene& s) { s.cameras[0].transform.columns[0] *= -1; }, "TRANSFORM_NOT_RIGID"},
    {"field of view", [](Scene& s) { s.cameras[0].vfov_rad = 4; }, "VALUE_OUT_OF_RANGE"},
    {"light scaled", [](Scene& s) { s.lights[0].transform.columns[1] *= 1.01; }, "TRANSFORM_NOT_RIGID"},
    {"light without size", [](Scene& s) { s.lights[0].shape = SphereShape{0}; }, "VALUE_OUT_OF_RANGE"},
    {"inner beyond outer",
     [](Scene& s) {
       s.lights[0].shape = SpotShape{0.6, 0.5};
     },
     "VALUE_OUT_OF_RANGE"},
    {"outer beyond 90 degrees",
     [](Scene& s) {
       s.lights[0].shape = SpotShape{0.1, 1.6};
     },
     "VALUE_OUT_OF_RANGE"},
    {"crossing polygon",
     [](Scene& s) {
       s.lights[0].shape = PolygonShape{{{0, 0}, {2, 2}, {2, 0}, {0, 1}}};
     },
     "POLYGON_NOT_SIMPLE"},
    {"polygon that turns back",
     [](Scene& s) {
       s.lights[0].shape = PolygonShape{{{0, 0}, {2, 0}, {1, 0}, {1, 1}}};
     },
     "POLYGON_NOT_SIMPLE"},
    {"nits on a point", [](Scene& s) { s.lights[0].shape = PointShape{}, s.lights[0].emission.given = Emission::Given::luminance; },
     "UNIT_UNSUITABLE"},
    {"range", [](Scene& s) { s.lights[0].range_m = 0; }, "VALUE_OUT_OF_RANGE"},
    {"mesh light's mesh", [](Scene& s) { s.lights[0].shape = MeshShape{5}; }, "INDEX_OUT_OF_RANGE"},
    {"environment's image", [](Scene& s) { s.lights[0].shape = EnvironmentShape{3}; }, "INDEX_OUT_OF_RANGE"},
    {"two-sided sphere", [](Scene& s) { s.lights[0].two_sided = true; }, "TWO_SIDED_UNUSED"},
    {"surface of a sphere light", [](Scene& s) { s.lights[0].surface_material = 0; }, "VALUE_UNSUITABLE"},
};
INSTANTIATE_TEST_SUITE_P(Validate, OneFault, testing::ValuesIn(faults), [](const auto& info) {
  std::string name = info.param.what;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST(Validate, NamesTheThingAndItsPlace) {
  Scene scene = small_scene();
  scene.file = "room.rig.json";
  scene.objects[1].transform.columns[0].x = 2;
  const Diagnostics d = validate(scene);
  ASSERT_EQ(d.all().size(), 1u);
  EXPECT_NE(d.all()[0].text.find("object \"ball\""), std::string::npos);
  EXPECT_EQ(d.all()[0].where.file, "room.rig.json");
  EXPECT_EQ(d.all()[0].where.pointer, "/objects/1");
}

TEST(Validate, AcceptsConcavePolygonsAndMeshLights) {
  Scene scene = small_scene();
  scene.lights[0].shape = PolygonShape{{{0.1, 0}, {1.1, 0}, {1.1, 0.4}, {0.5, 0.4}, {0.5, 1}, {0.1, 1}}};
  EXPECT_TRUE(validate(scene).all().empty());
  scene.meshes.push_back(triangle());
  scene.lights[0].shape = MeshShape{0, {2, 2, 2}};
  scene.lights[0].surface_material = 0;
  EXPECT_TRUE(validate(scene).all().empty());
  EXPECT_NEAR(mesh_area_of(scene, scene.lights[0]), 2, 1e-12);
  EXPECT_EQ(mesh_area_of(scene, Light{}), 0);
}

}  // namespace
}  // namespace etendue
