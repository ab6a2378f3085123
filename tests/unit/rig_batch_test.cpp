#include "etendue/rig_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "counted_heap.h"
#include "eval/light_bound.h"
#include "eval_protocol.h"
#include "float_points.h"
#include "instruction_sets.h"
#include "street_rig.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using protocol::Random;
using Points = FloatPoints;

Transform turned(Random& random, const Vec3d& at) {
  const Basis b = basis_around(random.direction());
  Transform t;
  t.columns = {b.tangent, b.bitangent, b.normal};
  t.translation = at;
  return t;
}

// One of every shape, somewhere in a box of the given half edges.
Emitter any_light(int shape, Random& random, const Vec3d& half) {
  const Vec3d at{random.uniform(-half.x, half.x), random.uniform(-half.y, half.y), random.uniform(-half.z, half.z)};
  const double size = random.log_uniform(0.02, 1);
  const Transform frame = turned(random, at);
  Emitter e;
  e.radiance = Rgb{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)} * random.log_uniform(1, 1e4);
  const Rgb intensity = e.radiance * 0.1;
  e.two_sided = random.uniform(0, 1) < 0.2;
  switch (shape % 12) {
    case 0:
      e.shape = protocol::rectangle(at, frame.columns[0], frame.columns[1], size, size * random.uniform(0.1, 1));
      break;
    case 1:
      e.shape = SphereEmitter{at, size};
      break;
    case 2:
      e.shape = DiskEmitter{at, frame.columns[2], frame.columns[0], size};
      break;
    case 3:
      e.shape = TubeEmitter{at, at + frame.columns[0] * (3 * size), 0.3 * size, Caps::round};
      break;
    case 4:
      e.shape = TubeEmitter{at, at + frame.columns[0] * (3 * size), 0.3 * size, Caps::flat};
      break;
    case 5:
      e.shape = LineEmitter{at, at + frame.columns[0] * size, intensity};
      break;
    case 6:
      e.shape = PunctualEmitter{at, frame, intensity, PointShape{}};
      break;
    case 7:
      e.shape = PunctualEmitter{at, frame, intensity, SpotShape{0.3, random.uniform(0.4, 1.5)}};
      break;
    case 8:
      e.shape = PunctualEmitter{at, frame, intensity, FrustumShape{1, 0.7}};
      break;
    case 9: {
      e.shape = PunctualEmitter{at, frame, intensity, PointShape{}};
      e.window = protocol::random_window(random, random.uniform(1, 6));
      break;
    }
    case 10: {
      const Vec3d a = at, b = at + frame.columns[0] * size, c = at + frame.columns[1] * size, d = at + frame.columns[2] * size;
      e.shape = MeshEmitter{{{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}};
      break;
    }
    default:
      e.shape = TubeEmitter{at, at + frame.columns[0] * (3 * size), 0.3 * size, Caps::none}, e.two_sided = false;
      break;
  }
  if (shape % 5 == 0 && !is_window(e.window)) e.window = protocol::random_window(random, random.uniform(1, 6));
  return e;
}

Rgb all_of(const std::vector<Emitter>& rig, const Vec3d& position, const Vec3d& normal) {
  Rgb sum;
  for (const Emitter& e : rig) sum += illuminance(e, position, normal);
  return sum;
}
double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

struct Answer {
  std::vector<Vec3f> lux;
  std::vector<float> bound;
  RigCounts counts;
};
Answer answer(const RigBatch& rig, const Points& points, const Tolerance& tolerance) {
  RigBatch::Workspace workspace;
  Answer a{std::vector<Vec3f>(points.size()), std::vector<float>(points.size()), {}};
  const Result<RigCounts> counts = rig.illuminance(points.batch(), tolerance, a.lux, a.bound, {-1, -1, -1}, workspace);
  EXPECT_TRUE(counts.ok());
  if (counts) a.counts = *counts;
  EXPECT_EQ(a.counts.evaluated + a.counts.skipped_unseen + a.counts.skipped_small,
            rig.emitters().size() * (points.size() - a.counts.without));
  return a;
}

// The bound at every point, and that it is no more than what was allowed.
void expect_within(const RigBatch& rig, const Points& points, const Tolerance& tolerance, const Answer& a) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Rgb exact = all_of(rig.emitters(), points.position(i), points.normal(i)), found = vec_cast<double>(a.lux[i]);
    const Rgb apart = found - exact;
    const double error = std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}), bound = static_cast<double>(a.bound[i]);
    ASSERT_LE(error, bound * (1 + 1e-6)) << i << " of " << points.size();
    ASSERT_LE(bound, (1 + 1e-5) * std::max({tolerance.absolute, tolerance.relative * largest(exact), 1e-7 * largest(exact)})) << i;
  }
}

Points cloud(Random& random, std::size_t count, const Vec3d& half) {
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.add({random.uniform(-half.x, half.x), random.uniform(-half.y, half.y), random.uniform(-half.z, half.z)}, random.direction());
  return points;
}

TEST(RigBatch, KeepsItsBoundAtEveryPointForEveryShape) {
  on_each_instruction_set([] {
    Random random(31);
    for (const Vec3d& half : {Vec3d{10, 10, 10}, Vec3d{60, 60, 2}}) {
      std::vector<Emitter> lights;
      lights.reserve(98);
      for (int i = 0; i < 96; ++i) lights.push_back(any_light(i, random, half));
      lights.push_back(protocol::white(DistantEmitter{random.direction(), {3, 2, 1}}));
      lights.push_back(protocol::white(DistantEmitter{random.direction(), {3, 2, 1}, 0.1}));
      const RigBatch rig(lights);
      const Points points = cloud(random, 400, half);
      for (const Tolerance& tolerance : {Tolerance{1e-2, 0}, Tolerance{1e-3, 1e-2}, Tolerance{0, 1}, Tolerance{1e-5, 0}, Tolerance{0, 0}})
        expect_within(rig, points, tolerance, answer(rig, points, tolerance));
    }
  });
}

// Every light is between its bounds, in boxes near and far, small and large.
TEST(RigBatch, EveryLightIsWithinItsBounds) {
  Random random(32);
  std::size_t lit = 0, sure = 0, unseen = 0;
  for (int i = 0; i < 6000; ++i) {
    const Emitter light = any_light(i, random, {1, 1, 1});
    const std::optional<LightBound> bound = light_bound(light);
    ASSERT_TRUE(bound);
    const Vec3d middle = random.direction() * random.log_uniform(0.05, 100), axis = random.direction();
    const double edge = random.log_uniform(1e-3, 10), spread = random.log_uniform(1e-3, 1);
    Box positions, normals;
    std::vector<std::pair<Vec3d, Vec3d>> points;
    for (int k = 0; k < 6; ++k) {
      points.emplace_back(middle + random.direction() * (edge * random.uniform(0, 1)), normalised(axis + random.direction() * spread));
      positions.add(points.back().first);
      normals.add(points.back().second);
    }
    const Bound all = bound_at(*bound, {Around::positions(positions), Around::directions(normals)});
    (all.most > 0 ? lit : unseen) += 1;
    sure += all.least > 0 ? 1 : 0;
    for (const auto& [p, n] : points) {
      const Rgb lux = illuminance(light, p, n);
      ASSERT_LE(largest(lux), all.most * (1 + 1e-12)) << i;
      Box here, facing;
      here.add(p), facing.add(n);
      const Bound one = bound_at(*bound, {Around::positions(here), Around::directions(facing)});
      ASSERT_LE(one.most, all.most * (1 + 1e-12)) << i;
      ASSERT_LE(largest(lux), one.most * (1 + 1e-12)) << i;
      ASSERT_GE(largest(lux), one.least * (1 - 1e-12)) << i;
      ASSERT_GE(one.least, all.least * (1 - 1e-12)) << i;
    }
  }
  EXPECT_GT(lit, 1000u);
  EXPECT_GT(unseen, 500u);
  EXPECT_GT(sure, 400u);
}

// A small light far away gets almost its bound: it is no guess.
TEST(RigBatch, BoundsAreCloseFarAway) {
  const Surroundings here{{{0, 0, 0}, {}}, {{0, 0, 1}, {}}};
  const Vec3d at{30, 40, 50};
  const Basis basis = basis_around(normalised(Vec3d{-1, -2, -2}));
  std::vector<Emitter> lights{protocol::white(SphereEmitter{at, 0.1}), protocol::white(DiskEmitter{at, basis.normal, basis.tangent, 0.1}),
                              protocol::white(protocol::rectangle(at, basis.tangent, basis.bitangent, 0.2, 0.1))};
  Emitter spot;
  spot.shape = PunctualEmitter{at, Transform{}, {5, 4, 3}, SpotShape{1.2, 1.3}};
  lights.push_back(spot);
  for (const Emitter& light : lights) {
    const double lux = largest(illuminance(light, {0, 0, 0}, {0, 0, 1}));
    const Bound b = bound_at(*light_bound(light), here);
    EXPECT_NEAR(b.most / lux, 1, 0.02) << light.shape.index();
    if (&light != &lights.back()) {
      EXPECT_NEAR(b.least / lux, 1, 0.02) << light.shape.index();
    }
  }
}

TEST(RigBatch, UnseenLightsCostNoEvaluation) {
  Random random(33);
  std::vector<Emitter> lights;
  for (int i = 0; i < 300; ++i) {
    // Below the floor, or above it and turned away.
    if (i % 2 == 0)
      lights.push_back(protocol::white(SphereEmitter{{random.uniform(-20, 20), random.uniform(-20, 20), -1}, 0.5}));
    else
      lights.push_back(protocol::white(DiskEmitter{{random.uniform(-20, 20), random.uniform(-20, 20), 3}, {0, 0, 1}, {1, 0, 0}, 0.5}));
  }
  lights.push_back(protocol::white(DistantEmitter{{0, 0.6, -0.8}, {1, 1, 1}, 0.01}));
  const RigBatch rig(lights);
  Points points;
  for (int i = 0; i < 5000; ++i) points.add({random.uniform(-20, 20), random.uniform(-20, 20), 0}, {0, 0, 1});
  const Answer a = answer(rig, points, {0, 0});
  EXPECT_EQ(a.counts.evaluated, 0u);
  EXPECT_EQ(a.counts.skipped_small, 0u);
  for (const Vec3f& lux : a.lux) ASSERT_EQ(lux, (Vec3f{}));
}

// Of 100 lamps about 15 matter at a point; no more than twice as many are evaluated.
TEST(RigBatch, AStreetEvaluatesFewLightsAPoint) {
  Random random(34);
  const RigBatch rig(street::lamps(10, 10, random));
  const Points points = street::points(10, 10, 100000, random);
  const Tolerance tolerance{0, 0.1};
  const Answer a = answer(rig, points, tolerance);
  Points some;
  Answer of_some;
  std::vector<std::size_t> which;
  double matter = 0;
  for (std::size_t i = 0; i < points.size(); i += 200) {
    some.add(points.position(i), points.normal(i));
    of_some.lux.push_back(a.lux[i]), of_some.bound.push_back(a.bound[i]);
    matter +=
        static_cast<double>(street::lights_that_matter(rig.emitters(), points.position(i), points.normal(i), tolerance.absolute, which));
  }
  matter /= static_cast<double>(some.size());
  expect_within(rig, some, tolerance, of_some);
  EXPECT_GT(matter, 10);
  EXPECT_LT(static_cast<double>(a.counts.evaluated), 2 * matter * static_cast<double>(points.size()));
  EXPECT_GT(a.counts.skipped_small, a.counts.evaluated);
}

TEST(RigBatch, AKeptWorkspaceIsNotAllocatedAgain) {
  Random random(37);
  const RigBatch rig(street::lamps(10, 10, random));
  const Points town = street::points(10, 10, 20000, random);
  std::vector<Vec3f> lux(town.size());
  std::vector<float> bound(town.size());
  RigBatch::Workspace workspace;
  const auto call = [&] { EXPECT_TRUE(rig.illuminance(town.batch(), {0.02, 0.02}, lux, bound, {}, workspace).ok()); };
  // 64 bytes a point, and what the lights take.
  EXPECT_LT(test::peak_heap_of(call), 80 * town.size());
  EXPECT_EQ(test::peak_heap_of(call), 0u);
}

TEST(RigBatch, AnyOrderAndAnyOriginAndAnyScale) {
  Random random(35);
  std::vector<Emitter> lights = street::lamps(6, 6, random);
  Points points;
  // Clusters of all sizes, points that coincide, one far away, a world far from its origin.
  const Vec3d world{4e5, -2e5, 1e5};
  points.origin = world;
  for (int i = 0; i < 6000; ++i) {
    const Vec3d middle{random.uniform(0, 150), random.uniform(0, 2), random.uniform(0, 150)};
    points.add(world + (i % 3 == 0   ? Vec3d{75, 1, 75}
                        : i % 3 == 1 ? Vec3d{75, 1, 75} + random.direction() * random.log_uniform(1e-6, 100)
                                     : middle),
               i % 2 == 0 ? Vec3d{0, 1, 0} : random.direction());
  }
  points.add(world + Vec3d{1e9, 0, 0}, {-1, 0, 0});
  for (Emitter& e : lights) {
    if (auto* s = std::get_if<SphereEmitter>(&e.shape)) s->centre += world;
    if (auto* d = std::get_if<DiskEmitter>(&e.shape)) d->centre += world;
    if (auto* t = std::get_if<TubeEmitter>(&e.shape)) t->a += world, t->b += world;
    if (auto* p = std::get_if<PolygonEmitter>(&e.shape))
      for (Vec3d& v : p->vertices) v += world;
  }
  const RigBatch rig(lights);
  const Tolerance tolerance{1e-2, 1e-2};
  const Answer a = answer(rig, points, tolerance);
  expect_within(rig, points, tolerance, a);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Points shuffled;
  shuffled.origin = world;
  for (const std::size_t i : order) shuffled.add(points.position(i), points.normal(i));
  const Answer b = answer(rig, shuffled, tolerance);
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_LE(std::abs(a.lux[order[i]].x - b.lux[i].x), (a.bound[order[i]] + b.bound[i]) * 1.0001f + 1e-30f);
}

// A light out of gamut, one much too bright for floats, no light, no point, and points that are none.
TEST(RigBatch, Edges) {
  Random random(36);
  std::vector<Emitter> lights;
  for (int i = 0; i < 40; ++i) {
    lights.push_back(any_light(i, random, {3, 3, 3}));
    lights.back().radiance.x *= -0.3;
  }
  const Points points = cloud(random, 300, {3, 3, 3});
  for (const Tolerance& tolerance : {Tolerance{1e-2, 0}, Tolerance{1e-4, 1e-2}}) {
    const RigBatch rig(lights);
    const Answer a = answer(rig, points, tolerance);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Rgb apart = vec_cast<double>(a.lux[i]) - all_of(lights, points.position(i), points.normal(i));
      ASSERT_LE(std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}), static_cast<double>(a.bound[i]) * (1 + 1e-6));
    }
  }
  const Answer bright = answer(RigBatch({protocol::white(SphereEmitter{{}, 1}, 1e300)}), points, {1e-2, 0});
  for (const Vec3f& lux : bright.lux) ASSERT_TRUE(std::isfinite(lux.x));
  const Answer dark = answer(RigBatch({}), points, {1e-2, 0});
  for (const Vec3f& lux : dark.lux) ASSERT_EQ(lux, (Vec3f{}));
  EXPECT_EQ(answer(RigBatch(lights), {}, {1e-2, 0}).counts.bounds, 0u);

  Points odd = points;
  odd.px[7] = std::numeric_limits<float>::quiet_NaN(), odd.nz[9] = std::numeric_limits<float>::infinity();
  odd.px[8] = std::numeric_limits<float>::max(), odd.py[8] = -std::numeric_limits<float>::max();
  const Answer without = answer(RigBatch(lights), odd, {1e-2, 0});
  EXPECT_EQ(without.counts.without, 2u);
  EXPECT_EQ(without.lux[7], (Vec3f{-1, -1, -1}));
  EXPECT_EQ(without.lux[9], (Vec3f{-1, -1, -1}));
  for (const Vec3f& lux : without.lux) ASSERT_TRUE(std::isfinite(lux.x) && std::isfinite(lux.y) && std::isfinite(lux.z));

  std::vector<Vec3f> few(2);
  RigBatch::Workspace workspace;
  EXPECT_EQ(RigBatch(lights).illuminance(points.batch(), {}, few, {}, {}, workspace).error().code, "BATCH_SIZES_DIFFER");
}

}  // namespace
