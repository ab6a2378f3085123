#include "etendue/illuminance_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "eval_protocol.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using protocol::Kind;
using protocol::Random;

struct Points {
  std::vector<float> px, py, pz, nx, ny, nz;
  Vec3d origin;
  void add(const Vec3d& position, const Vec3d& normal) {
    const Vec3d p = position - origin;
    px.push_back(static_cast<float>(p.x)), py.push_back(static_cast<float>(p.y)), pz.push_back(static_cast<float>(p.z));
    nx.push_back(static_cast<float>(normal.x)), ny.push_back(static_cast<float>(normal.y)), nz.push_back(static_cast<float>(normal.z));
  }
  PointBatch batch() const { return {px, py, pz, nx, ny, nz, origin}; }
  std::size_t size() const { return px.size(); }
  // What the floats say.
  Vec3d position(std::size_t i) const { return origin + Vec3d{px[i], py[i], pz[i]}; }
  Vec3d normal(std::size_t i) const { return normalised(Vec3d{nx[i], ny[i], nz[i]}); }
};

Vec3d centre_of(const EmitterShape& shape) {
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return s->centre;
  const auto& v = std::get<PolygonEmitter>(shape).vertices;
  Vec3d sum;
  for (const Vec3d& p : v) sum += p / static_cast<double>(v.size());
  return sum;
}

// |error| over the promised bound. For the solid angle stands what a surface facing the light receives, which is less.
class Worst {
 public:
  void judge(const Emitter& light, const Points& points, std::span<const float> sr) {
    for (std::size_t i = 0; i < sr.size(); ++i) {
      const Vec3d p = points.position(i), n = points.normal(i);
      const double expected = protocol::lux_at(light, p, n), facing = protocol::lux_at(light, p, normalised(centre_of(light.shape) - p));
      ASSERT_TRUE(std::isfinite(sr[i])) << i;
      const double error = std::abs(static_cast<double>(sr[i]) - expected), bound = 1e-5 * expected + 2e-6 * std::min(1.0, facing);
      // 1e-37: below it floats have no digits.
      ratio = std::max(ratio, error / (bound + 1e-37));
      if (expected >= 1e-3) sum += error / expected, ++count;
    }
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
  double ratio = 0;

 private:
  double sum = 0;
  std::size_t count = 0;
};

std::vector<float> evaluated(const Emitter& light, const Points& points) {
  std::vector<float> sr(points.size(), -1);
  const Result<LightBatch> batch = LightBatch::of(light);
  EXPECT_TRUE(batch.ok());
  const BatchOutcome done = batch->projected_solid_angles(points.batch(), sr, -2);
  EXPECT_TRUE(done.ok()) << done.error().text;
  EXPECT_EQ(*done, 0u);
  return sr;
}

// The protocol of the facts page: one light a point.
TEST(IlluminanceBatch, IsWithinItsBoundAboveAndAcrossTheHorizon) {
  on_each_instruction_set([] {
    for (const Kind kind : {Kind::sphere, Kind::rect}) {
      for (const bool above : {true, false}) {
        Random random(5);
        Worst worst;
        for (int i = 0; i < 1000; ++i) {
          const protocol::Placement p = protocol::place(kind, random, above);
          Points points;
          points.add(p.position, p.normal);
          worst.judge(p.emitter, points, evaluated(p.emitter, points));
        }
        EXPECT_LE(worst.ratio, 1) << static_cast<int>(kind) << above;
        EXPECT_LE(worst.mean(), 4e-6) << static_cast<int>(kind) << above;
      }
    }
  });
}

// A star with points inwards and outwards, now and then convex, in a random plane.
PolygonEmitter star(Random& random, int corners) {
  const Vec3d n = random.direction(), centre = random.direction() * random.uniform(0.2, 2);
  const Basis b = basis_around(n);
  PolygonEmitter polygon;
  polygon.normal = n;
  for (int i = 0; i < corners; ++i) {
    const double phi = 2 * pi * (i + random.uniform(0, 0.7)) / corners, r = random.uniform(0.2, 1);
    polygon.vertices.push_back(centre + b.tangent * (r * std::cos(phi)) + b.bitangent * (r * std::sin(phi)));
  }
  return polygon;
}

// Many points a light, so that every vector mixes what is above, below, across, in front and behind.
TEST(IlluminanceBatch, PolygonsOfAnyShapeAtPointsAllAround) {
  on_each_instruction_set([] {
    Random random(6);
    Worst worst;
    for (int i = 0; i < 300; ++i) {
      Emitter light = protocol::white(star(random, 3 + i % 9));
      light.two_sided = i % 2 == 0;
      Points points;
      for (int k = 0; k < 37; ++k) points.add(random.direction() * random.uniform(0, 3), random.direction());
      worst.judge(light, points, evaluated(light, points));
    }
    EXPECT_LE(worst.ratio, 1);
  });
}

// Distances from 1e-5 to 1e6 of the size, sizes from a millimetre to a kilometre, far from the world's origin.
TEST(IlluminanceBatch, HoldsAtEveryScale) {
  on_each_instruction_set([] {
    for (const Kind kind : {Kind::sphere, Kind::rect}) {
      Random random(7);
      Worst worst;
      for (int i = 0; i < 4000; ++i) {
        const double size = random.log_uniform(1e-3, 1e3), distance = size * random.log_uniform(1e-5, 1e6);
        const Vec3d towards = random.direction();
        Points points;
        points.origin = random.direction() * random.uniform(0, 1e6);
        points.add(points.origin, random.direction());
        Emitter light;
        if (kind == Kind::sphere) {
          light = protocol::white(SphereEmitter{points.origin + towards * (size + distance), size});
        } else {
          const Basis b = basis_around(random.direction());
          light = protocol::white(
              protocol::rectangle(points.origin + towards * distance, b.tangent, b.bitangent, size, size * random.uniform(0.1, 1)));
          light.two_sided = true;
        }
        worst.judge(light, points, evaluated(light, points));
      }
      EXPECT_LE(worst.ratio, 1) << static_cast<int>(kind);
    }
  });
}

TEST(IlluminanceBatch, BoundariesHaveTheirAnswers) {
  on_each_instruction_set([] {
    Points points;
    points.add({0, 0, 0}, {0, 0, 1});
    const auto at = [&](const Emitter& light) { return static_cast<double>(evaluated(light, points)[0]); };
    // Inside a sphere it is dark, or bright all around.
    Emitter ball = protocol::white(SphereEmitter{{0.1, 0, 0.1}, 1});
    EXPECT_EQ(at(ball), 0);
    ball.two_sided = true;
    EXPECT_NEAR(at(ball), pi, 1e-6);
    // Its surface is part of the inside.
    EXPECT_EQ(at(protocol::white(SphereEmitter{{0, 0, 1}, 1})), 0);
    EXPECT_NEAR(at(protocol::white(SphereEmitter{{0, 0, 1 + 1e-9}, 1})), pi, 1e-5);
    // In a rectangle's own plane it is not seen, in its middle either.
    Emitter window = protocol::white(protocol::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1));
    window.two_sided = true;
    EXPECT_EQ(at(window), 0);
    // Of no size or turned away: nothing.
    EXPECT_EQ(at(protocol::white(protocol::rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0, 1))), 0);
    EXPECT_EQ(at(protocol::white(protocol::rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1, 1))), 0);
    EXPECT_EQ(at(protocol::white(SphereEmitter{{0, 0, -2}, 1})), 0);
  });
}

TEST(IlluminanceBatch, OtherShapesOneByOneAndWhatIsNoNumberCounted) {
  Random random(8);
  const protocol::Placement disk = protocol::place(Kind::disk, random, true);
  Points points;
  points.add(disk.position, disk.normal);
  points.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 1});
  points.add({0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0});
  std::vector<float> sr(3);
  for (const Emitter& light : {disk.emitter, protocol::white(SphereEmitter{{0, 0, 3}, 1})}) {
    const BatchOutcome done = LightBatch::of(light)->projected_solid_angles(points.batch(), sr, -1);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 2u);
    EXPECT_NEAR(sr[0], protocol::lux_at(light, points.position(0), points.normal(0)), 1e-5 * static_cast<double>(sr[0]));
    EXPECT_EQ(sr[1], -1);
    EXPECT_EQ(sr[2], -1);
  }
  std::vector<float> few(2);
  EXPECT_EQ(LightBatch::of(disk.emitter)->projected_solid_angles(points.batch(), few, 0).error().code, "BATCH_SIZES_DIFFER");
  Emitter line = protocol::white(LineEmitter{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}});
  EXPECT_EQ(LightBatch::of(line).error().code, "EVALUATION_UNSUPPORTED");
}

}  // namespace
