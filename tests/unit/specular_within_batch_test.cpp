// Specular light to a tolerance in vectors against specular_luminance, which is asked for a thirtieth of it.
#include "etendue/specular_within_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "etendue/far_luminance.h"
#include "etendue/specular_light.h"
#include "eval_protocol.h"
#include "float_points.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

struct Views {
  FloatPoints surface;
  std::vector<float> vx, vy, vz, alpha;

  void add(const Vec3d& position, const Vec3d& normal, const Vec3d& view, double a) {
    surface.add(position, normal);
    const Vec3f v = vec_cast<float>(view);
    vx.push_back(v.x), vy.push_back(v.y), vz.push_back(v.z), alpha.push_back(static_cast<float>(a));
  }
  std::size_t size() const { return alpha.size(); }
  SpecularPoints points() const { return {surface.batch(), vx, vy, vz, alpha}; }
  // What the floats say.
  ShadingPoint point(std::size_t i, double f0) const {
    const Vec3d n = surface.normal(i);
    return {surface.position(i), n, n, normalised(Vec3d{vx[i], vy[i], vz[i]}), GgxLobe{alpha[i], {f0, f0, f0}, 1}};
  }
};
struct Answers {
  std::vector<float> of_f0, of_f90, bound_f0, bound_f90;
  explicit Answers(std::size_t count) : of_f0(count, -1), of_f90(count, -1), bound_f0(count, -1), bound_f90(count, -1) {}
  BoundedShares to() { return {of_f0, of_f90, bound_f0, bound_f90}; }
  double value(std::size_t i, double f0) const { return f0 * static_cast<double>(of_f0[i]) + static_cast<double>(of_f90[i]); }
  double bound(std::size_t i, double f0) const { return f0 * static_cast<double>(bound_f0[i]) + static_cast<double>(bound_f90[i]); }
};

// Points around a light, some behind it and some under whose horizon it is or crosses; half of the views have the mirror direction in it,
// others are down to 1e-4 above the horizon; alpha from 1e-4 on.
Views views_around(const Emitter& light, Random& random, int count) {
  Views views;
  for (int i = 0; i < count; ++i) {
    const Vec3d position = random.direction() * random.uniform(0.5, 4), normal = random.direction();
    const Vec3d l = sample_light(light, position, random.square()).direction;
    const double z = dot(l, normal), cosine = random.log_uniform(1e-4, 1);
    const Basis b = basis_around(normal);
    const double turn = random.uniform(0, 2 * pi), sine = std::sqrt((1 - cosine) * (1 + cosine));
    const bool mirrored = i % 2 == 0 && z > 1e-4;
    const Vec3d view =
        mirrored ? normal * (2 * z) - l : normal * cosine + (b.tangent * std::cos(turn) + b.bitangent * std::sin(turn)) * sine;
    views.add(position, normal, view, random.log_uniform(1e-4, 1));
  }
  return views;
}

Emitter sun(const Vec3d& towards, double radius_rad) {
  const double sine = std::sin(radius_rad);
  Emitter light;
  light.shape = DistantEmitter{normalised(towards), Rgb{1, 1, 1} * (pi * sine * sine), radius_rad};
  return light;
}
PolygonEmitter triangle() {
  PolygonEmitter p = rectangle({0.3, -0.2, 0.1}, {0.6, 0, 0.8}, {0, 1, 0}, 1.3, 0.7);
  p.vertices.pop_back(), p.triangles = {{0, 1, 2}};
  return p;
}

void keeps_the_tolerance(const Emitter& light, double tolerance, int count) {
  Random random(5);
  const Views views = views_around(light, random, count);
  for (const double f0 : {1.0, 0.04}) {
    std::vector<Estimate> truth;
    for (std::size_t i = 0; i < views.size(); ++i) truth.push_back(*specular_luminance(light, views.point(i, f0), tolerance / 30));
    on_each_instruction_set([&] {
      Answers found(views.size());
      const auto batch = SpecularWithinBatch::of(light, tolerance);
      ASSERT_TRUE(batch);
      ASSERT_TRUE(batch->shares(views.points(), found.to(), -1));
      std::size_t broken = 0, further_off = 0;
      for (std::size_t i = 0; i < views.size(); ++i) {
        const ShadingPoint point = views.point(i, f0);
        const double floor = 1e-3 * lux_at(light, point.position, point.normal), expected = truth[i].value.x;
        const double allowed = tolerance * std::max(expected, floor);
        // A float's own rounding stands beside a tolerance of 1e-4. Of a hundred thousand views up to five are further off, by up to 4.5
        // times what is allowed: of the few hundred here one may be.
        const double rest = truth[i].error.x + 3e-7 * expected, off = std::abs(found.value(i, f0) - expected);
        EXPECT_LE(off, 5 * allowed + rest) << i << " asked " << tolerance << " alpha " << views.alpha[i] << " n.v "
                                           << dot(point.view, point.normal);
        broken += off > allowed + rest ? 1 : 0;
        further_off += off > found.bound(i, f0) + rest ? 1 : 0;
        // Linear in f0 it is up to twice what is allowed, and a quarter of that is told of the value and of the floor.
        EXPECT_LE(found.bound(i, f0), 2.3 * allowed + 1e-12) << i;
      }
      EXPECT_LE(broken, 1u);
      // What is told is no proof.
      EXPECT_LE(100 * further_off, views.size());
    });
  }
}

TEST(SpecularWithinBatch, RectanglesKeepTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    for (const bool two_sided : {false, true}) {
      Emitter light = white(rectangle({0.3, -0.2, 0.1}, {0.6, 0, 0.8}, {0, 1, 0}, 1.3, 0.7));
      light.two_sided = two_sided;
      keeps_the_tolerance(light, tolerance, 500);
    }
  }
}

// Convex ones and stars, of which the horizon leaves up to five parts: four in cells.
TEST(SpecularWithinBatch, PolygonsKeepTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    keeps_the_tolerance(white(triangle()), tolerance, 200);
    for (const std::uint32_t spikes : {3u, 5u}) {
      Emitter light = white(star({0.3, -0.2, 0.1}, {0.6, 0, 0.8}, {0, 1, 0}, 1.3, 0.9, spikes, 0.4));
      light.two_sided = spikes == 5;
      keeps_the_tolerance(light, tolerance, 200);
    }
  }
}

TEST(SpecularWithinBatch, RimsKeepTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    for (const bool two_sided : {false, true}) {
      Emitter disk =
          white(DiskEmitter{{0.3, -0.2, 0.1}, normalised(Vec3d{0.2, 0.1, 1}), basis_around(normalised(Vec3d{0.2, 0.1, 1})).tangent, 0.7});
      disk.two_sided = two_sided;
      keeps_the_tolerance(disk, tolerance, 200);
    }
    for (const Caps caps : {Caps::flat, Caps::none})
      keeps_the_tolerance(white(TubeEmitter{{-0.4, 0.1, 0}, {0.6, -0.2, 0.1}, 0.2, caps}), tolerance, 150);
  }
}

TEST(SpecularWithinBatch, RoundLightsKeepTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    keeps_the_tolerance(white(SphereEmitter{{0.3, -0.2, 0.1}, 0.45}), tolerance, 300);
    keeps_the_tolerance(white(TubeEmitter{{-0.4, 0.1, 0}, {0.6, -0.2, 0.1}, 0.12, Caps::round}), tolerance, 300);
    keeps_the_tolerance(white(TubeEmitter{{0, 0, 0}, {0.3, 0.3, 0.1}, 0.3, Caps::round}), tolerance, 150);
    keeps_the_tolerance(sun({0.3, 0.2, 0.5}, 0.05), tolerance, 150);
    keeps_the_tolerance(sun({0.3, 0.2, 0.5}, 0.0046), tolerance, 150);
  }
}

// Seen along its axis a tube is its nearer cap, a sphere.
TEST(SpecularWithinBatch, TubesAlongTheirAxisAreSpheres) {
  const Emitter tube = white(TubeEmitter{{0, 0, 1}, {0, 0, 3}, 0.4, Caps::round}), sphere = white(SphereEmitter{{0, 0, 1}, 0.4});
  Views views;
  for (int i = 0; i < 20; ++i)
    views.add({0.02 * i - 0.2, 0.1, 0}, normalised(Vec3d{0.1 * i - 1, 0, 1}), normalised(Vec3d{0.1, 0.05 * i, 1}), 0.05 + 0.04 * i);
  on_each_instruction_set([&] {
    Answers of_tube(views.size()), of_sphere(views.size());
    ASSERT_TRUE(SpecularWithinBatch::of(tube, 1e-4)->shares(views.points(), of_tube.to(), -1));
    ASSERT_TRUE(SpecularWithinBatch::of(sphere, 1e-4)->shares(views.points(), of_sphere.to(), -1));
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_GT(of_sphere.value(i, 1), 0) << i;
      EXPECT_NEAR(of_tube.value(i, 1), of_sphere.value(i, 1), of_tube.bound(i, 1) + of_sphere.bound(i, 1)) << i;
    }
  });
}

// So many sides that the lists hold the cells of a few points: a disk but for 2 pi^2 / (3 n^2) of its area, 3e-5.
TEST(SpecularWithinBatch, ManySidesAreADisk) {
  constexpr std::uint32_t half_of_corners = 240;
  const Emitter light = white(star({}, {1, 0, 0}, {0, 1, 0}, 1, 1, half_of_corners, 1));
  const Emitter disk = white(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 0.5});
  Views views;
  for (int i = 0; i < 12; ++i) {
    const Vec3d position{0.1 * i - 0.5, 0.2, 0.7};
    views.add(position, {0, 0, -1}, normalised(Vec3d{0.4, 0.1 * i - 0.6, -0.5}), 0.1 + 0.05 * i);
  }
  Answers found(views.size());
  ASSERT_TRUE(SpecularWithinBatch::of(light, 1e-3)->shares(views.points(), found.to(), -1));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double expected = specular_luminance(disk, views.point(i, 1), 1e-6)->value.x;
    EXPECT_NEAR(found.value(i, 1), expected, 1.2e-3 * expected) << i;
  }
}

// Inside a sphere there is nothing to see, unless it emits there too: then it is all of the sky.
TEST(SpecularWithinBatch, WithinASphere) {
  Emitter light = white(SphereEmitter{{0, 0, 0.1}, 1});
  Views views;
  for (const double z : {-0.5, 0.0, 0.9}) views.add({0.1, 0, z}, {0, 0, 1}, normalised(Vec3d{0.3, 0, 1}), 0.4);
  for (const bool two_sided : {false, true}) {
    light.two_sided = two_sided;
    on_each_instruction_set([&] {
      Answers found(views.size());
      ASSERT_TRUE(SpecularWithinBatch::of(light, 1e-3)->shares(views.points(), found.to(), -1));
      for (std::size_t i = 0; i < views.size(); ++i) {
        const double expected = specular_luminance(light, views.point(i, 1), 1e-5)->value.x;
        EXPECT_EQ(expected > 0, two_sided);
        EXPECT_NEAR(found.value(i, 1), expected, 1e-3 * expected) << i;
      }
    });
  }
}

// Lights as small as a digit of a float, far out of the lobe, beside the point, in its plane.
TEST(SpecularWithinBatch, ExtremesAreFinite) {
  on_each_instruction_set([] {
    for (const int which : {0, 1, 2, 3, 4, 7, 9, 11, 12, 14}) {
      const double size = std::array{1e-6, 1e-3, 1.0, 1e4}[static_cast<std::size_t>(which % 4)];
      const std::array<EmitterShape, 4> shapes{rectangle({0.3, 0, 1}, {1, 0, 0}, {0, -1, 0}, size, size),
                                               SphereEmitter{{0.3, 0, 1}, 0.5 * size},
                                               DiskEmitter{{0.3, 0, 1}, {0, 0, -1}, {1, 0, 0}, 0.5 * size},
                                               TubeEmitter{{0.3, 0, 1}, {0.3 + size, 0, 1}, 0.1 * size, Caps::flat}};
      const Emitter light = white(shapes[static_cast<std::size_t>(which / 4)]);
      Views views;
      for (const double alpha : {0.0, 1e-4, 0.03, 1.0})
        for (const double cosine : {1e-7, 1e-3, 0.5, 1.0})
          for (const Vec3d& normal : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}})
            for (const double height : {0.0, 0.999999, 1.0, -100.0}) {
              const Vec3d across = basis_around(normal).tangent;
              views.add({0, 0, height}, normal, normal * cosine + across * std::sqrt((1 - cosine) * (1 + cosine)), alpha);
            }
      Answers found(views.size());
      ASSERT_TRUE(SpecularWithinBatch::of(light, 1e-3)->shares(views.points(), found.to(), -1));
      for (std::size_t i = 0; i < views.size(); ++i) {
        EXPECT_GE(found.of_f0[i], 0) << i << " of " << which;
        EXPECT_GE(found.of_f90[i], 0) << i;
        EXPECT_LE(found.value(i, 1), 1.002) << i << " of " << which;
        EXPECT_TRUE(std::isfinite(found.bound(i, 1))) << i;
      }
    }
  });
}

TEST(SpecularWithinBatch, SaysWhatItDoesNotTake) {
  const Emitter light = white(rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, 1, 1));
  EXPECT_TRUE(SpecularWithinBatch::of(light, 1e-3));
  EXPECT_EQ(SpecularWithinBatch::of(light, 1e-5).error().code, "TOLERANCE_OUT_OF_RANGE");
  EXPECT_EQ(SpecularWithinBatch::of(light, 0.2).error().code, "TOLERANCE_OUT_OF_RANGE");
  EXPECT_EQ(SpecularWithinBatch::of(light, std::numeric_limits<double>::quiet_NaN()).error().code, "TOLERANCE_OUT_OF_RANGE");
  EXPECT_EQ(SpecularWithinBatch::of(white(LineEmitter{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), 1e-3).error().code, "METHOD_SHAPE");
  EXPECT_EQ(SpecularWithinBatch::of(sun({0, 0, 1}, 0), 1e-3).error().code, "METHOD_SHAPE");
  EXPECT_EQ(SpecularWithinBatch::of(light, 1e-3, Masking::schlick_direct).error().code, "METHOD_LOBE");
  Emitter windowed = light;
  windowed.window = {Falloff::gltf, 3};
  EXPECT_EQ(SpecularWithinBatch::of(windowed, 1e-3).error().code, "METHOD_SHAPE");
}

TEST(SpecularWithinBatch, CountsWhatIsNotFinite) {
  const Emitter light = white(rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, 1, 1));
  const auto batch = SpecularWithinBatch::of(light, 1e-3);
  Views views;
  for (int i = 0; i < 70; ++i) views.add({0.01 * i, 0, 0}, {0, 0, 1}, {0, 0, 1}, 0.3);
  views.vx[3] = std::numeric_limits<float>::infinity(), views.alpha[66] = std::numeric_limits<float>::quiet_NaN();
  Answers found(views.size());
  const auto without = batch->shares(views.points(), found.to(), -7);
  ASSERT_TRUE(without);
  EXPECT_EQ(*without, 2u);
  EXPECT_EQ(found.of_f0[3], -7);
  EXPECT_EQ(found.of_f90[66], -7);
  EXPECT_GT(found.of_f0[4], 0);
  // Bounds need not be asked for; spans have to fit.
  Answers other(views.size());
  ASSERT_TRUE(batch->shares(views.points(), {other.of_f0, other.of_f90, {}, {}}, -7));
  EXPECT_EQ(other.of_f0, found.of_f0);
  Answers small(views.size() - 1);
  EXPECT_EQ(batch->shares(views.points(), small.to(), 0).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(batch->shares(views.points(), {other.of_f0, other.of_f90, small.bound_f0, {}}, 0).error().code, "BATCH_SIZES_DIFFER");
}

// Of a light that is far a few places are taken, as far_luminance takes them: both are within their bounds, which are parts of the value.
TEST(SpecularWithinBatch, FarLightsAreAFewPlaces) {
  Random random(8);
  const Emitter light = white(rectangle({0, 0, 6}, {1, 0, 0}, {0, -1, 0}, 0.3, 0.1));
  Views views;
  for (int i = 0; i < 200; ++i) {
    const Vec3d position{random.uniform(-2, 2), random.uniform(-2, 2), 0};
    Vec3d view = random.direction();
    view.z = std::abs(view.z) + 0.05;
    views.add(position, {0, 0, 1}, normalised(view), random.log_uniform(0.2, 1));
  }
  for (const double tolerance : {1e-2, 1e-4}) {
    on_each_instruction_set([&] {
      Answers found(views.size());
      ASSERT_TRUE(SpecularWithinBatch::of(light, tolerance)->shares(views.points(), found.to(), -1));
      for (std::size_t i = 0; i < views.size(); ++i) {
        const auto few = far_luminance(light, views.point(i, 0.04), tolerance);
        ASSERT_TRUE(few) << i;
        const double value = found.value(i, 0.04);
        EXPECT_LE(found.bound(i, 0.04), tolerance * value) << i;
        // The floats that shares are written in have 1e-7.
        EXPECT_NEAR(value, few->value.x, few->error.x + found.bound(i, 0.04) + 2e-7 * value) << i;
      }
    });
  }
}

// Points in doubles, the other masking, and a floor in cd/m2 that is a part of the light here and above all of it there.
TEST(SpecularWithinBatch, TakesPlacesMaskingAndFloor) {
  Random random(6);
  Emitter light = white(rectangle({0.3, -0.2, 0.1}, {0.6, 0, 0.8}, {0, 1, 0}, 1.3, 0.7), 50);
  const Views views = views_around(light, random, 300);
  std::vector<SpecularPlace> places;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ShadingPoint p = views.point(i, 1);
    places.push_back({p.position, p.normal, p.view, static_cast<double>(views.alpha[i])});
  }
  constexpr double tolerance = 1e-3;
  for (const double least : {0.0, 2.0, 1e4}) {
    on_each_instruction_set([&] {
      Answers found(views.size());
      const auto batch = SpecularWithinBatch::of(light, tolerance, Masking::separable, least);
      ASSERT_TRUE(batch);
      ASSERT_TRUE(batch->shares(places, found.to(), -1));
      for (std::size_t i = 0; i < views.size(); ++i) {
        ShadingPoint point = views.point(i, 1);
        point.brdf = GgxLobe{static_cast<double>(views.alpha[i]), {1, 1, 1}, 1, Masking::separable};
        const Estimate truth = *specular_luminance(light, point, tolerance / 30);
        const double floor = std::max(1e-3 * lux_at(light, point.position, point.normal), least);
        EXPECT_NEAR(50 * found.value(i, 1), truth.value.x, tolerance * std::max(truth.value.x, floor) + truth.error.x) << i << " " << least;
      }
    });
  }
  Answers small(views.size() - 1);
  EXPECT_EQ(SpecularWithinBatch::of(light, tolerance)->shares(places, small.to(), 0).error().code, "BATCH_SIZES_DIFFER");
}

}  // namespace
