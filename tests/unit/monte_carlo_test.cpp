// The reference by sampling: its points, its agreement with the adaptive one, what its errors are worth.
#include <gtest/gtest.h>

#include <cmath>

#include "etendue/published.h"
#include "eval/frostbite_reference.h"
#include "eval_protocol.h"
#include "sampled_agreement.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// ---- Points on surfaces ----

// Of n values in [0, 1) that should be uniform: chi squared of 32 bins, 31 on the mean with a deviation of sqrt(62); five of them either
// way (below it, samples would not be independent).
void expect_uniform(const std::vector<double>& values, const char* what) {
  std::array<double, 32> count{};
  for (const double v : values) ++count[std::min<std::size_t>(static_cast<std::size_t>(32 * v), 31)];
  const double expected = static_cast<double>(values.size()) / 32;
  double chi2 = 0;
  for (const double c : count) chi2 += (c - expected) * (c - expected) / expected;
  EXPECT_NEAR(chi2, 31, 5 * std::sqrt(62.0)) << what;
}

constexpr int draws = 40000;

// Archimedes: equal heights of a sphere have equal areas, and as much as the cylinder around it, so that a whole capsule's points are
// uniform along its axis.
TEST(SurfacePoints, AreUniformOverTheArea) {
  Random random(1);
  const Vec3d a{1, 2, 3}, b{2, 4, 5}, axis = normalised(b - a);
  const double radius = 0.7, l = length(b - a);
  const Surface capsule({CylinderPart{a, b, radius}, CapsPart{a, b, radius}});
  const Surface tube({CylinderPart{a, b, radius}, DiskPart{a, -axis, radius}, DiskPart{b, axis, radius}});
  EXPECT_NEAR(capsule.area(), 2 * pi * radius * (l + 2 * radius), 1e-12);
  EXPECT_NEAR(tube.area(), 2 * pi * radius * (l + radius), 1e-12);
  const SpherePart sphere{a, 2};
  const DiskPart disk{a, axis, 3};
  const ParallelogramPart parallelogram{a, {1, 2, 0}, {0, 1, 4}, normalised(cross(Vec3d{1, 2, 0}, Vec3d{0, 1, 4}))};
  const TrianglePart triangle{a, b, {0, 1, 7}};
  const Vec3d across = basis_around(axis).tangent;
  std::vector<double> along, around, height, of_disk, first, second, nearer, share;
  double faces = 0;
  for (int i = 0; i < draws; ++i) {
    const Vec3d on_capsule = capsule.at(random.square()).point.position - a;
    along.push_back((dot(on_capsule, axis) + radius) / (l + 2 * radius));
    const Vec3d out = on_capsule - axis * dot(on_capsule, axis);
    around.push_back(std::atan2(dot(cross(across, out), axis), dot(across, out)) / (2 * pi) + 0.5);
    height.push_back((sphere.at(random.square()).position.y - a.y) / 4 + 0.5);
    const Vec3d on_disk = disk.at(random.square()).position - a;
    EXPECT_NEAR(dot(on_disk, axis), 0, 1e-12);
    of_disk.push_back(dot(on_disk, on_disk) / 9);
    const Vec3d on_parallelogram = parallelogram.at(random.square()).position - a;
    first.push_back(on_parallelogram.x);
    second.push_back(on_parallelogram.z / 4);
    // Barycentric coordinates: the area nearer to a corner than a line across is the square of it, that to one side of a line from it is
    // linear.
    const Vec3d p = triangle.at(random.square()).position - a, e1 = triangle.b - a, e2 = triangle.c - a, n = cross(e1, e2);
    const double b1 = dot(cross(p, e2), n) / dot(n, n), b2 = dot(cross(e1, p), n) / dot(n, n);
    nearer.push_back((b1 + b2) * (b1 + b2));
    share.push_back(b2 / (b1 + b2));
    faces += tube.at(random.square()).part > 0;
  }
  expect_uniform(along, "capsule, along");
  expect_uniform(around, "capsule, around");
  expect_uniform(height, "sphere");
  expect_uniform(of_disk, "disk");
  expect_uniform(first, "parallelogram, first side");
  expect_uniform(second, "parallelogram, second side");
  expect_uniform(nearer, "triangle, from the corner");
  expect_uniform(share, "triangle, across");
  const double p = radius / (l + radius);
  EXPECT_NEAR(faces, draws * p, 4 * std::sqrt(draws * p * (1 - p)));
}

// Gauss: over a closed surface the normals add up to nothing and p.n to three times the volume.
TEST(SurfacePoints, OfClosedSurfacesEncloseTheirVolume) {
  Random random(2);
  const Vec3d a{0.3, 0.2, 0.1}, b{1, -1, 2}, axis = normalised(b - a);
  const double r = 0.4, l = length(b - a);
  const std::vector<std::pair<Surface, double>> closed{
      {Surface({SpherePart{a, r}}), 4.0 / 3 * pi * r * r * r},
      {Surface({CylinderPart{a, b, r}, CapsPart{a, b, r}}), pi * r * r * (l + 4.0 / 3 * r)},
      {Surface({CylinderPart{a, b, r}, DiskPart{a, -axis, r}, DiskPart{b, axis, r}}), pi * r * r * l}};
  for (const auto& [surface, volume] : closed) {
    double sum = 0, square = 0;
    Vec3d normals;
    for (int i = 0; i < draws; ++i) {
      const SurfacePoint p = surface.at(random.square()).point;
      EXPECT_NEAR(length(p.normal), 1, 1e-12);
      const double x = dot(p.position, p.normal) * surface.area() / 3;
      sum += x, square += x * x;
      normals += p.normal;
    }
    const double mean = sum / draws, deviation = std::sqrt((square / draws - mean * mean) / draws);
    EXPECT_NEAR(mean, volume, 4 * deviation);
    EXPECT_LE(length(normals) / draws, 4 / std::sqrt(static_cast<double>(draws)));
  }
}

// 1 / area per area is d^2 / (area cos) per solid angle, which is 1 over all directions from within.
TEST(SurfacePoints, DensityIntegratesToOne) {
  Random random(3);
  const Vec3d a{-1, 0.2, 0}, b{1, 0.1, 0.5};
  for (const Caps caps : {Caps::round, Caps::flat}) {
    const TubeEmitter tube{a, b, 0.6, caps};
    const Vec3d axis = normalised(b - a), inside = {0.3, 0.2, 0.1};
    const Surface surface(caps == Caps::round
                              ? std::vector<SurfacePart>{CylinderPart{a, b, 0.6}, CapsPart{a, b, 0.6}}
                              : std::vector<SurfacePart>{CylinderPart{a, b, 0.6}, DiskPart{a, -axis, 0.6}, DiskPart{b, axis, 0.6}});
    Emitter light = white(tube);
    light.two_sided = true;
    double sum = 0, square = 0;
    for (int i = 0; i < draws; ++i) {
      const Vec3d direction = random.direction();
      const double d = light_along(light, inside, direction).distance, x = dot(inside + direction * d - a, axis);
      const Vec3d p = inside + direction * d, nearest = a + axis * std::clamp(x, 0.0, length(b - a));
      const bool on_face = caps == Caps::flat && (x < 1e-9 || x > length(b - a) - 1e-9);
      const double cosine = on_face ? std::abs(dot(direction, axis)) : dot(direction, p - nearest) / 0.6;
      const double density = 4 * pi * d * d / (surface.area() * cosine);
      sum += density, square += density * density;
    }
    const double mean = sum / draws;
    EXPECT_NEAR(mean, 1, 4 * std::sqrt((square / draws - mean * mean) / draws));
  }
}

// ---- Agreement with the adaptive reference ----

// By what is in excess of the errors (`exceedances`), and by the mean of the squares over those of the standard errors, within four
// deviations in each of 16 rows: errors are neither too small nor too large. Where a lobe, or a light that has almost set, is left to few
// samples, the standard error is uncertain itself; the heaviest sample is told beside it.
TEST(BothReferences, AgreeWithinTheirErrors) {
  for (const Kind kind : every_kind) {
    for (const bool above : {true, false}) {
      const SampledAgreement a = agreement(kind, above, 5, {4096, 7});
      SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << (above ? " above" : " across"));
      EXPECT_EQ(a.not_numbers, 0u);
      EXPECT_LE(a.beyond_error, exceedances(a.count));
      EXPECT_NEAR(a.mean_square, expected_square, 4 * a.square_error);
      EXPECT_GE(a.settled, 0.8 * static_cast<double>(a.count));
    }
  }
}

// More samples: nearer, by more than independent samples would be (1 / 4).
TEST(BothReferences, SamplesConverge) {
  const Emitter light = white(rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 1, 2));
  const ShadingPoint point{{0.3, 0, 0}, {0, 0, 1}, {0, 0, 1}, normalised(Vec3d{1, 0, 1}), FrostbiteDiffuse{{1, 1, 1}, 0.5}};
  const double exact = reference(light, point, {1e-10, 0}).value.x;
  const SampledEstimate few = monte_carlo(light, point, {1024, 1}), many = monte_carlo(light, point, {16384, 1});
  EXPECT_LT(many.standard_error.x, few.standard_error.x / 5);
  EXPECT_NEAR(many.value.x, exact, many.error().x);
  EXPECT_LT(many.error().x, 1e-3 * exact);
  EXPECT_EQ(many.samples, 16384u);
}

TEST(BothReferences, LightsOfOtherKinds) {
  Emitter sun = white(DistantEmitter{normalised(Vec3d{1, 2, 3}), {1e5, 1e5, 1e5}, 0.1}), sky = white(EnvironmentEmitter{}, 50);
  Emitter inside = white(SphereEmitter{{0, 0.5, 0}, 2}), in_tube = white(TubeEmitter{{-1, 0, 0.3}, {2, 0, 0.3}, 1, Caps::round});
  inside.two_sided = in_tube.two_sided = true;
  Emitter window = white(SphereEmitter{{0, 0, 2}, 0.5});
  window.window = {Falloff::gltf, 2.5};
  Emitter pattern = white(rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 1, 2));
  pattern.pattern = [](Vec2d uv) { return Rgb{uv.x, uv.y * uv.y, 1 - uv.x * uv.y}; };
  Emitter behind = pattern;
  behind.two_sided = true;
  auto& turned = std::get<PolygonEmitter>(behind.shape);
  std::reverse(turned.vertices.begin(), turned.vertices.end());
  turned.normal = -turned.normal;
  Emitter low = white(SphereEmitter{{2, 0, 0.1}, 0.5});
  MeshEmitter triangles{{{Vec3d{0, 0, 1}, Vec3d{0, 1, 1.2}, Vec3d{1, 0, 1.1}}, {Vec3d{-1, 0, 2}, Vec3d{-1, 1, 2}, Vec3d{0, 0, 1.5}}}};
  triangles.uvs = {{Vec2d{0, 0}, Vec2d{0, 1}, Vec2d{1, 0}}, {Vec2d{1, 1}, Vec2d{0, 1}, Vec2d{1, 0}}};
  Emitter mesh = white(triangles);
  mesh.pattern = pattern.pattern;
  const std::vector<Emitter> lights{sun, sky, inside, in_tube, window, pattern, behind, low, mesh};
  const Vec3d n{0, 0, 1}, tilted = normalised(Vec3d{0.5, 0.1, 1});
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (const Brdf& brdf : every_brdf(0.6)) {
      const ShadingPoint point{{}, n, i == 7 ? tilted : n, normalised(Vec3d{0.3, 0.4, 0.6}), brdf};
      const Estimate exact = reference(lights[i], point, {1e-7, 0});
      const SampledEstimate sampled = monte_carlo(lights[i], point, {8192, 3});
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sampled.value[c], exact.value[c], sampled.error()[c] + exact.error[c] + 1e-12 * exact.value[c])
            << i << " " << brdf.index();
      EXPECT_GT(exact.value.x, 0) << i << " " << brdf.index();
    }
  }
}

// Points and true directions: nothing to sample.
TEST(BothReferences, LightsWithoutExtentAreExact) {
  const Emitter point_light = white(PunctualEmitter{{0, 0, 2}, {}, {10, 20, 30}, PointShape{}});
  const ShadingPoint point{{}, {0, 0, 1}, {0, 0, 1}, normalised(Vec3d{1, 0, 1}), Standard{{0.5, 0.2, 0.1}, 0, 0.3, 0.5}};
  const SampledEstimate e = monte_carlo(point_light, point, {});
  EXPECT_EQ(e.value, reference(point_light, point, {}).value);
  EXPECT_EQ(e.samples, 0u);
}

TEST(BothReferences, OneSeedOneAnswer) {
  const Emitter light = white(SphereEmitter{{0, 0, 2}, 1});
  const ShadingPoint point{{}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, Lambert{{1, 1, 1}}};
  ShadingPoint beside = point;
  beside.position.x = 1e-9;
  const Rgb value = monte_carlo(light, point, {1000, 5}).value;
  EXPECT_EQ(monte_carlo(light, point, {1000, 5}).value, value);
  EXPECT_NE(monte_carlo(light, point, {1000, 6}).value, value);
  EXPECT_GT(std::abs(monte_carlo(light, beside, {1000, 5}).value.x - value.x), 1e-7) << "other points of the square at another place";
}

// Lobes that a handful of the samples find, or none: the scatter knows nothing of them, the heaviest sample does.
TEST(BothReferences, RareSamplesAreToldOf) {
  Random random(11);
  int beyond = 0, beyond_three = 0, count = 0;
  for (int i = 0; i < 300; ++i) {
    const Placement p = place(i % 2 == 0 ? Kind::rect : Kind::sphere, random, true);
    const Vec3d view = p.normal * (2 * dot(p.normal, p.towards)) - p.towards;
    const ShadingPoint point{p.position, p.normal, p.normal, view,
                             GgxLobe{random.log_uniform(0.002, 0.05), {1, 1, 1}, 1, Masking::correlated}};
    const double exact = reference(p.emitter, point, {1e-5, 0}).value.x;
    const SampledEstimate e = monte_carlo(p.emitter, point, {1024, 1});
    const double wrong = std::abs(e.value.x - exact);
    beyond += wrong > e.error().x + 1e-5 * exact;
    beyond_three += wrong > 3 * e.standard_error.x + 1e-5 * exact;
    ++count;
  }
  EXPECT_LE(beyond, static_cast<int>(exceedances(static_cast<std::size_t>(count))));
  EXPECT_GT(beyond_three, beyond) << "three standard errors alone are broken more often";
}

TEST(BothReferences, NothingButNumbers) {
  const Vec3d n{0, 0, 1};
  const std::vector<EmitterShape> shapes{SphereEmitter{{0, 0, 1}, 1},  // in contact
                                         SphereEmitter{{0, 0, 1}, 0},
                                         SphereEmitter{{}, 1},
                                         DiskEmitter{{0, 0, 1e-9}, -n, {1, 0, 0}, 1},
                                         DiskEmitter{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 0},
                                         DiskEmitter{{}, -n, {1, 0, 0}, 1},
                                         TubeEmitter{{-1, 0, 1}, {-1, 0, 1}, 1, Caps::round},
                                         TubeEmitter{{-1, 0, 1}, {-1, 0, 1}, 1, Caps::flat},
                                         TubeEmitter{{-1, 0, 1}, {1, 0, 1}, 0, Caps::round},
                                         TubeEmitter{{-1, 0, 1}, {1, 0, 1}, 1e-9, Caps::round},
                                         LineEmitter{{-1, 0, 0}, {1, 0, 0}, {1, 1, 1}},
                                         LineEmitter{{-1, 0, 1}, {-1, 0, 1}, {1, 1, 1}},
                                         rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0, 1),
                                         rectangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, 1),
                                         rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2e6, 2e6),
                                         rectangle({0, 0, 1e12}, {0, 1, 0}, {1, 0, 0}, 1e-6, 1e-6),
                                         PolygonEmitter{},
                                         MeshEmitter{}};
  for (const EmitterShape& shape : shapes) {
    for (const bool two_sided : {false, true}) {
      Emitter light = white(shape, 1.6e9);
      light.two_sided = two_sided;
      for (const Brdf& brdf : every_brdf(0.1)) {
        for (const Vec3d& view : {n, normalised(Vec3d{1, 0, 1e-4}), Vec3d{1, 0, 0}}) {
          const SampledEstimate e = monte_carlo(light, {{}, n, n, view, brdf}, {64, 1});
          for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(std::isfinite(e.value[c]) && e.value[c] >= 0 && std::isfinite(e.error()[c]))
                << shape.index() << " " << brdf.index();
        }
      }
    }
  }
}

// ---- Listing A.3 ----

// Caps of less than a 512th of the area get no sample, of which the printed form takes the mean: no number, 0 by the convention of the
// methods.
TEST(Errata, ListingA3) {
  const DiffuseMethod *printed = find_diffuse_method("frostbite-a3"), *mended = find_diffuse_method("frostbite-a3-mended");
  const Vec3d n{0, 0, 1};
  for (const double l : {0.0, 1.0}) {
    const Emitter light = white(TubeEmitter{{-0.5 * l, 0, 1}, {0.5 * l, 0, 1}, l > 0 ? 1 / 1100.0 : 0.1, Caps::round});
    const double exact = lux_at(light, {}, n);
    EXPECT_EQ(printed->illuminance(light, {}, n), 0.0) << l;
    EXPECT_NEAR(*mended->illuminance(light, {}, n), exact, 0.02 * exact) << l;
  }
  const Emitter thicker = white(TubeEmitter{{-0.5, 0, 1}, {0.5, 0, 1}, 1 / 900.0, Caps::round});
  const double exact = lux_at(thicker, {}, n);
  EXPECT_NEAR(*printed->illuminance(thicker, {}, n), exact, 0.02 * exact);
}

}  // namespace
