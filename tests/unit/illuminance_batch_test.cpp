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
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) return d->centre;
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return (t->a + t->b) * 0.5;
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
    for (const Kind kind : {Kind::sphere, Kind::rect, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
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

// A ball of triangles, wound outwards.
MeshEmitter ball_of_triangles(const Vec3d& centre, double radius, int rows) {
  MeshEmitter mesh;
  const auto at = [&](int row, int column) {
    const double theta = pi * row / rows, phi = pi * (2 * column + row) / rows;
    return centre + Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} * radius;
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < rows; ++column) {
      mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row, column + 1)});
      mesh.triangles.push_back({at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)});
    }
  }
  return mesh;
}

// The bound of a mesh is that of all its triangles together; what a closed convex one shows is its solid angle.
TEST(IlluminanceBatch, MeshesAreTheSumOfTheirTriangles) {
  on_each_instruction_set([] {
    Random random(12);
    for (const double distance : {0.0, 0.05, 3.0, 1000.0}) {
      Points points;
      points.origin = {2e3, -1e3, 5e2};
      const Vec3d centre = points.origin + random.direction();
      Emitter light = protocol::white(ball_of_triangles(centre, 0.7, 8));
      light.two_sided = distance == 0;  // from inside
      for (int i = 0; i < 300; ++i) points.add(centre + random.direction() * (distance == 0 ? 0.5 : 0.7 + distance), random.direction());
      points.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 1});
      std::vector<float> sr(points.size());
      const BatchOutcome done = LightBatch::of(light)->projected_solid_angles(points.batch(), sr, -1);
      ASSERT_TRUE(done.ok());
      EXPECT_EQ(*done, 1u);
      EXPECT_EQ(sr.back(), -1);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Vec3d p = points.position(i);
        const double expected = protocol::lux_at(light, p, points.normal(i)), facing = protocol::lux_at(light, p, normalised(centre - p));
        if (distance == 0) {
          EXPECT_NEAR(sr[i], pi, 1e-5);
        }
        ASSERT_NEAR(sr[i], expected, 1e-5 * expected + 2e-6 * facing) << distance << ' ' << i;
      }
    }
    // Without a surface: dark.
    Points points;
    points.add({0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(evaluated(protocol::white(MeshEmitter{{{Vec3d{0, 0, 1}, Vec3d{1, 0, 1}, Vec3d{2, 0, 1}}}}), points)[0], 0);
  });
}

// Distances from 1e-5 to 1e6 of the size, sizes from a millimetre to a kilometre, far from the world's origin.
TEST(IlluminanceBatch, HoldsAtEveryScale) {
  on_each_instruction_set([] {
    for (const Kind kind : {Kind::sphere, Kind::rect, Kind::disk, Kind::capsule}) {
      Random random(7);
      Worst worst;
      for (int i = 0; i < 4000; ++i) {
        const double size = random.log_uniform(1e-3, 1e3), distance = size * random.log_uniform(1e-5, 1e6);
        const Vec3d towards = random.direction();
        const Basis b = basis_around(random.direction());
        Points points;
        points.origin = random.direction() * random.uniform(0, 1e6);
        points.add(points.origin, random.direction());
        Emitter light;
        if (kind == Kind::sphere) {
          light = protocol::white(SphereEmitter{points.origin + towards * (size + distance), size});
        } else if (kind == Kind::rect) {
          light = protocol::white(
              protocol::rectangle(points.origin + towards * distance, b.tangent, b.bitangent, size, size * random.uniform(0.1, 1)));
        } else if (kind == Kind::capsule) {
          // From a ball to a thin rod, the point anywhere beside it or beyond its ends.
          const Vec3d half = b.normal * (0.5 * size * random.log_uniform(0.1, 100));
          const double along = random.uniform(-1, 1), beyond = along < 0 ? 0 : random.uniform(0, 1);
          const Vec3d out = normalised(b.tangent * (1 - beyond) + b.normal * beyond) * (size + distance);
          const Vec3d middle = points.origin + half * (beyond > 0 ? -1 : along) - out;
          light = protocol::white(TubeEmitter{middle - half, middle + half, size, Caps::round});
        } else {
          // Half of them close to the rim.
          const Vec3d to_rim = b.tangent * (i % 2 == 0 ? size : 0);
          light = protocol::white(DiskEmitter{points.origin + towards * distance + to_rim, b.normal, b.tangent, size});
        }
        light.two_sided = kind != Kind::sphere;
        worst.judge(light, points, evaluated(light, points));
      }
      EXPECT_LE(worst.ratio, 1) << static_cast<int>(kind);
    }
  });
}

// Of lights without area the bound is relative to what the intensity on their axis gives a surface facing them, without a window.
class WorstPunctual {
 public:
  void judge(const Emitter& light, const Points& points) {
    const std::vector<float> found = evaluated(light, points);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Vec3d p = points.position(i);
      double most = 1;
      if (const auto* e = std::get_if<PunctualEmitter>(&light.shape)) most = 1 / dot(e->position - p, e->position - p);
      if (const auto* e = std::get_if<LineEmitter>(&light.shape)) {
        const Vec3d a = e->a - p, span = e->b - e->a, nearest = a + span * std::clamp(-dot(a, span) / dot(span, span), 0.0, 1.0);
        most = 1 / dot(nearest, nearest);
      }
      const double expected = protocol::lux_at(light, p, points.normal(i));
      ASSERT_TRUE(std::isfinite(found[i])) << i;
      ratio = std::max(ratio, std::abs(static_cast<double>(found[i]) - expected) / (1e-5 * expected + 2e-6 * most));
      lit += expected > 0 ? 1 : 0;
    }
  }
  double ratio = 0;
  int lit = 0;
};

// Cones and frusta from a degree to the half space, with hard edges and soft ones, windows near their range.
TEST(IlluminanceBatch, PunctualAndDistantLightsHoldTheirBound) {
  on_each_instruction_set([] {
    Random random(9);
    WorstPunctual worst;
    for (int i = 0; i < 600; ++i) {
      Emitter light;
      const double size = random.log_uniform(1e-3, 1e3), outer = random.log_uniform(0.01, pi / 2);
      const Basis b = basis_around(random.direction());
      Points points;
      points.origin = random.direction() * random.uniform(0, 1e6);
      PunctualEmitter lamp{points.origin + random.direction() * size, {{b.tangent, b.bitangent, b.normal}, {}}, {1, 1, 1}, PointShape{}};
      if (i % 4 == 1) lamp.shape = SpotShape{outer * (i % 8 == 1 ? 1 : random.uniform(0, 1)), outer};
      if (i % 4 == 2) lamp.shape = FrustumShape{1.9 * outer, random.uniform(0.01, 3)};
      light.shape = lamp;
      if (i % 3 != 0) light.window = protocol::random_window(random, 3 * size);
      if (i % 4 == 3) light.shape = DistantEmitter{random.direction(), {1, 1, 1}, i % 8 == 3 ? 0 : 0.9 * outer};
      const double width = i % 4 == 0 ? pi : 1.2 * outer;
      for (int k = 0; k < 37; ++k) {
        const double turn = random.uniform(0, 2 * pi), off = random.uniform(0, width), far = random.log_uniform(1e-2, 10);
        const Vec3d along = -b.normal * std::cos(off) + (b.tangent * std::cos(turn) + b.bitangent * std::sin(turn)) * std::sin(off);
        points.add(lamp.position + along * (size * std::min(far, k % 3 == 0 ? 3 - 1e-3 * far : 10)), random.direction());
      }
      worst.judge(light, points);
    }
    EXPECT_LE(worst.ratio, 1);
    EXPECT_GT(worst.lit, 3000);
  });
}

// Lines at every distance, on their continuation and almost touched.
TEST(IlluminanceBatch, LinesHoldTheirBound) {
  on_each_instruction_set([] {
    Random random(10);
    WorstPunctual worst;
    double sum = 0;
    int bright = 0;
    for (int i = 0; i < 400; ++i) {
      const double length = random.log_uniform(1e-3, 1e3);
      const Basis b = basis_around(random.direction());
      Points points;
      points.origin = random.direction() * random.uniform(0, 1e6);
      Emitter light;
      light.shape = LineEmitter{points.origin, points.origin + b.normal * length, {1, 1, 1}};
      for (int k = 0; k < 37; ++k) {
        const double along = random.uniform(-1, 2), off = k % 4 == 0 ? 0 : random.log_uniform(1e-5, 1e6), away = k % 3 == 0 ? off : 1;
        const Vec3d out = (b.tangent * std::cos(k) + b.bitangent * std::sin(k)) * off + b.normal * (along * away);
        points.add(points.origin + out * length, random.direction());
      }
      worst.judge(light, points);
      const protocol::Placement p = protocol::place(Kind::capsule, random, i % 2 == 0);
      const auto& tube = std::get<TubeEmitter>(p.emitter.shape);
      light.shape = LineEmitter{tube.a, tube.b, {1, 1, 1}};
      points = {};
      points.add(p.position, p.normal);
      const double expected = protocol::lux_at(light, points.position(0), points.normal(0));
      if (expected >= 1e-3) sum += std::abs(static_cast<double>(evaluated(light, points)[0]) - expected) / expected, ++bright;
    }
    EXPECT_LE(worst.ratio, 1);
    EXPECT_GT(worst.lit, 3000);
    EXPECT_LE(sum / bright, 4e-6);
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
    // A disk: straight above, in its plane, turned away, of no size; half of it above the horizon, seen from over its middle.
    EXPECT_NEAR(at(protocol::white(DiskEmitter{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, 1})), pi / 2, 1e-6);
    EXPECT_EQ(at(protocol::white(DiskEmitter{{0.5, 0, 0}, {0, 0, -1}, {1, 0, 0}, 1})), 0);
    EXPECT_EQ(at(protocol::white(DiskEmitter{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, 1})), 0);
    EXPECT_EQ(at(protocol::white(DiskEmitter{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, 0})), 0);
    const Emitter upright = protocol::white(DiskEmitter{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 1});
    EXPECT_NEAR(at(upright), protocol::lux_at(upright, {}, {0, 0, 1}), 1e-6);
    // A capsule: inside, dark or bright all around; on its axis beyond its end, a sphere; without length too; cut lengthwise, half.
    Emitter pill = protocol::white(TubeEmitter{{-1, 0, 0.1}, {1, 0, 0.1}, 0.5, Caps::round});
    EXPECT_EQ(at(pill), 0);
    pill.two_sided = true;
    EXPECT_NEAR(at(pill), pi, 1e-6);
    const double ball_above = pi * 0.25 / 4;
    EXPECT_NEAR(at(protocol::white(TubeEmitter{{0, 0, 2}, {0, 0, 5}, 0.5, Caps::round})), ball_above, 1e-6);
    EXPECT_NEAR(at(protocol::white(TubeEmitter{{0, 0, 2}, {0, 0, 2}, 0.5, Caps::round})), ball_above, 1e-6);
    EXPECT_EQ(at(protocol::white(TubeEmitter{{0, 0, 2}, {0, 0, 5}, 0, Caps::round})), 0);
    // With flat ends or open: inside the same, also beside an end; on the axis the end alone, or nothing.
    for (const Caps caps : {Caps::flat, Caps::none}) {
      Emitter drum = protocol::white(TubeEmitter{{-1, 0, 0.1}, {1, 0, 0.1}, 0.5, caps});
      EXPECT_EQ(at(drum), 0);
      drum.two_sided = true;
      EXPECT_NEAR(at(drum), pi, 1e-6);
      EXPECT_EQ(at(protocol::white(TubeEmitter{{0, 0, -3}, {0, 0, 0}, 0.5, caps})), 0);
      const Emitter ahead = protocol::white(TubeEmitter{{0, 0, 2}, {0, 0, 5}, 0.5, caps});
      EXPECT_NEAR(at(ahead), caps == Caps::flat ? pi * 0.25 / 4.25 : 0, 1e-6);
      const Emitter beside = protocol::white(TubeEmitter{{-0.3, 0.6, 0}, {1, 0.6, 0}, 0.5, caps});
      EXPECT_NEAR(at(beside), protocol::lux_at(beside, {}, {0, 0, 1}), 1e-5);
    }
    const Emitter lying = protocol::white(TubeEmitter{{1, -1, 0}, {1, 1, 0}, 0.25, Caps::round});
    EXPECT_NEAR(at(lying), protocol::lux_at(lying, {}, {0, 0, 1}), 1e-6);
    const Emitter ahead = protocol::white(TubeEmitter{{1, 0, 0}, {3, 0, 0}, 0.25, Caps::round});
    EXPECT_NEAR(at(ahead), protocol::lux_at(ahead, {}, {0, 0, 1}), 1e-6);
  });
}

TEST(IlluminanceBatch, OtherShapesOneByOneAndWhatIsNoNumberCounted) {
  Random random(8);
  const protocol::Placement tube = protocol::place(Kind::flat_tube, random, true);
  Points points;
  points.add(tube.position, tube.normal);
  points.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 1});
  points.add({0, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0});
  std::vector<float> sr(3);
  Emitter ending = tube.emitter;
  ending.window = {Falloff::frostbite, 10};
  for (const Emitter& light : {ending, tube.emitter, protocol::white(SphereEmitter{{0, 0, 3}, 1})}) {
    const BatchOutcome done = LightBatch::of(light)->projected_solid_angles(points.batch(), sr, -1);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 2u);
    EXPECT_NEAR(sr[0], protocol::lux_at(light, points.position(0), points.normal(0)), 1e-5 * static_cast<double>(sr[0]));
    EXPECT_EQ(sr[1], -1);
    EXPECT_EQ(sr[2], -1);
  }
  std::vector<float> few(2);
  EXPECT_EQ(LightBatch::of(tube.emitter)->projected_solid_angles(points.batch(), few, 0).error().code, "BATCH_SIZES_DIFFER");
  Emitter picture;
  picture.shape = DiskEmitter{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, 1};
  picture.pattern = [](Vec2d) { return Rgb{1, 1, 1}; };
  EXPECT_EQ(LightBatch::of(picture).error().code, "EVALUATION_UNSUPPORTED");
}

// Above, across and beyond the range.
TEST(IlluminanceBatch, AreaLightsAndLinesWithAWindow) {
  Random random(9);
  Worst worst;
  for (const Kind kind : {Kind::sphere, Kind::rect, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
    for (int i = 0; i < 20; ++i) {
      Emitter light = protocol::place(kind, random, true).emitter;
      light.window = protocol::random_window(random, random.uniform(0.5, 4));
      Points points;
      for (int k = 0; k < 37; ++k) points.add(centre_of(light.shape) + random.direction() * random.uniform(0, 5), random.direction());
      worst.judge(light, points, evaluated(light, points));
    }
  }
  EXPECT_LE(worst.ratio, 1);
}

// Polygons of any outline, wholly within the range, cut by it and beyond, above the horizon and across it.
TEST(IlluminanceBatch, FlatLightsWithAWindowInVectors) {
  on_each_instruction_set([] {
    Random random(12);
    Worst worst;
    for (int i = 0; i < 200; ++i) {
      Emitter light = i % 2 == 0 ? protocol::place(Kind::rect, random, i % 4 == 0).emitter : protocol::white(star(random, 3 + i % 7));
      light.two_sided = i % 5 == 0;
      light.window = {i % 3 == 0 ? Falloff::gltf : Falloff::frostbite, random.log_uniform(0.5, 30)};
      Points points;
      for (int k = 0; k < 67; ++k)
        points.add(centre_of(light.shape) + random.direction() * (light.window.range_m * random.uniform(0, 1.2)), random.direction());
      worst.judge(light, points, evaluated(light, points));
    }
    EXPECT_LE(worst.ratio, 1);
    EXPECT_LE(worst.mean(), 4e-6);
  });
}

TEST(IlluminanceBatch, ScaleTimesValueIsIlluminance) {
  const Rgb colour{3, 2, 1};
  const auto punctual = [&](const auto& shape) {
    Emitter e;
    e.shape = PunctualEmitter{{0, 0, 2}, {}, colour, shape};
    e.window = {Falloff::frostbite, 5};
    return e;
  };
  const auto shining = [&](const EmitterShape& shape) {
    Emitter e = protocol::white(shape);
    e.radiance = colour;
    return e;
  };
  const auto ending = [](Emitter e) {
    e.window = {Falloff::gltf, 2.5};
    return e;
  };
  Points points;
  points.add({0.2, -0.3, 0.1}, normalised(Vec3d{0.1, 0.2, 1}));
  for (const Emitter& light :
       {punctual(PointShape{}), punctual(SpotShape{0.1, 0.5}), punctual(FrustumShape{1, 1}), shining(DistantEmitter{{0, 0, 1}, colour}),
        shining(DistantEmitter{{0, 0, 1}, colour, 0.3}), shining(LineEmitter{{0, 0, 1}, {1, 0, 1}, colour}),
        ending(shining(LineEmitter{{0, 0, 1}, {1, 0, 1}, colour})), ending(shining(SphereEmitter{{0, 0, 3}, 1})),
        shining(SphereEmitter{{0, 0, 3}, 1}), shining(TubeEmitter{{0, 0, 1}, {1, 0, 1}, 0.2, Caps::flat}), shining(EnvironmentEmitter{})}) {
    const Result<LightBatch> batch = LightBatch::of(light);
    ASSERT_TRUE(batch.ok());
    std::vector<float> value(1);
    ASSERT_TRUE(batch->projected_solid_angles(points.batch(), value, -1).ok());
    const Rgb expected = illuminance(light, points.position(0), points.normal(0)), found = batch->scale() * static_cast<double>(value[0]);
    EXPECT_GT(expected.x, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5 * expected[c]) << light.shape.index();
  }
  // Closer to a point light than floats can say: the largest of them.
  Points close;
  close.add({0, 0, 0}, {0, 0, 1});
  std::vector<float> value(1);
  Emitter lamp = punctual(PointShape{});
  std::get<PunctualEmitter>(lamp.shape).position = {0, 0, 1e-30};
  ASSERT_TRUE(LightBatch::of(lamp)->projected_solid_angles(close.batch(), value, -1).ok());
  EXPECT_EQ(value[0], std::numeric_limits<float>::max());
}

}  // namespace
