// What must hold of the illuminance of any light: additivity, sides, continuity at the horizon, size, distance, degenerate inputs.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

TEST(Property, ARectangleIsTheSumOfItsParts) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Placement p = place(Kind::rect, random, i % 2 == 0);
    const PolygonEmitter whole = std::get<PolygonEmitter>(p.emitter.shape);
    const double at = random.uniform(0.1, 0.9);
    const auto& v = whole.vertices;
    const Vec3d bottom = v[0] + (v[1] - v[0]) * at, top = v[3] + (v[2] - v[3]) * at;
    PolygonEmitter left = whole, right = whole;
    left.vertices = {v[0], bottom, top, v[3]};
    right.vertices = {bottom, v[1], v[2], top};
    const double sum = lux_at(white(left), p.position, p.normal) + lux_at(white(right), p.position, p.normal);
    EXPECT_NEAR(lux_at(white(whole), p.position, p.normal), sum, 1e-12);
  }
}

// An L is a square without a quarter: concave, clipped at the horizon as well.
TEST(Property, ConcavePolygons) {
  Random random(7);
  const std::vector<Vec2d> l_shape{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int i = 0; i < 200; ++i) {
    const Vec3d n = random.direction(), p = random.direction() * random.uniform(0.3, 4);
    const auto polygon = [&](const std::vector<Vec2d>& points) {
      PolygonEmitter e;
      for (const Vec2d& q : points) e.vertices.push_back({q.x - 1, q.y - 1, 0});
      e.normal = {0, 0, 1};
      Emitter emitter = white(e);
      emitter.two_sided = true;
      return emitter;
    };
    const double square = lux_at(polygon({{0, 0}, {2, 0}, {2, 2}, {0, 2}}), p, n),
                 quarter = lux_at(polygon({{1, 1}, {2, 1}, {2, 2}, {1, 2}}), p, n);
    EXPECT_NEAR(lux_at(polygon(l_shape), p, n), square - quarter, 1e-12);
  }
}

// A closed convex mesh shines like the shape it approximates: an icosphere between its inner and outer sphere.
TEST(Property, MeshSphereLiesBetweenItsSpheres) {
  MeshEmitter mesh;
  constexpr int rings = 24, sectors = 48;
  const auto at = [](int i, int j) {
    const double theta = pi * i / rings, phi = 2 * pi * j / sectors;
    return Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const double inner = std::cos(pi / rings) * std::cos(pi / sectors);
  for (const Vec3d& p : {Vec3d{0, 0, 3}, Vec3d{1.5, 1, -1}, Vec3d{0.2, 1.2, 0.3}}) {
    const Vec3d n = normalised(-p + Vec3d{0.5, 0.2, 0});
    const double e = lux_at(white(mesh), p, n);
    EXPECT_LE(e, lux_at(white(SphereEmitter{{}, 1}), p, n) + 1e-12);
    EXPECT_GE(e, lux_at(white(SphereEmitter{{}, inner * 0.999}), p, n));
  }
}

TEST(Property, OneSidedLightsAreDarkBehindAndTwoSidedOnesAreNot) {
  Random random(8);
  for (const Kind kind : {Kind::rect, Kind::disk}) {
    for (int i = 0; i < 100; ++i) {
      Placement p = place(kind, random, true);
      const double front = lux_at(p.emitter, p.position, p.normal);
      if (auto* polygon = std::get_if<PolygonEmitter>(&p.emitter.shape)) {
        std::reverse(polygon->vertices.begin(), polygon->vertices.end());
        polygon->normal = -polygon->normal;
      } else {
        auto& disk = std::get<DiskEmitter>(p.emitter.shape);
        disk.normal = -disk.normal;
      }
      EXPECT_EQ(lux_at(p.emitter, p.position, p.normal), 0);
      p.emitter.two_sided = true;
      EXPECT_NEAR(lux_at(p.emitter, p.position, p.normal), front, 1e-12);
    }
  }
}

// Turning a light below the horizon, the illuminance falls without a step and never below 0.
TEST(Property, NoStepAtTheHorizon) {
  const std::vector<EmitterShape> lights{
      rectangle({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, 0.5, 1), DiskEmitter{{0, 0, 2}, {0, 0, -1}, {1, 0, 0}, 0.5}, SphereEmitter{{0, 0, 2}, 0.5},
      TubeEmitter{{-1, 0, 2}, {1, 0, 2}, 0.2, Caps::round}, TubeEmitter{{-1, 0, 2}, {1, 0, 2}, 0.2, Caps::flat}};
  for (const EmitterShape& shape : lights) {
    double before = lux_at(white(shape), {}, {0, 0, 1});
    for (int i = 1; i <= 20000; ++i) {
      const double angle = pi * i / 20000;
      const double now = lux_at(white(shape), {}, {std::sin(angle), 0, std::cos(angle)});
      EXPECT_GE(now, 0);
      EXPECT_LE(std::abs(now - before), 2 * pi / 20000) << shape.index() << " at " << angle;
      before = now;
    }
    EXPECT_EQ(before, 0);
  }
}

// Larger is brighter: a light contains the smaller one.
TEST(Property, GrowsWithSize) {
  for (const double tilt : {0.0, 0.7, 1.4}) {
    const Vec3d n{std::sin(tilt), 0, std::cos(tilt)};
    double disk = 0, sphere = 0, tube = 0;
    for (double r = 0.05; r < 0.95; r += 0.05) {
      const double d = lux_at(white(DiskEmitter{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, r}), {}, n);
      const double s = lux_at(white(SphereEmitter{{0, 0, 1}, r}), {}, n),
                   t = lux_at(white(TubeEmitter{{-1, 0, 1}, {0.5, 0.3, 1}, r, Caps::round}), {}, n);
      EXPECT_GT(d, disk);
      EXPECT_GT(s, sphere);
      EXPECT_GT(t, tube);
      disk = d, sphere = s, tube = t;
    }
  }
}

// Far lights keep their digits: E d^2 goes to L A cos cos.
TEST(Property, FarLightsKeepTheirDigits) {
  for (const double d : {10.0, 1e3, 1e5, 1e7}) {
    // Relative: the next term is of order (size / d)^2.
    const double limit = std::max(1e-9, 3 / (d * d));
    EXPECT_NEAR(lux_at(white(rectangle({0, 0, d}, {0, 1, 0}, {1, 0, 0}, 1, 1)), {}, {0, 0, 1}) * d * d, 1, limit) << d;
    EXPECT_NEAR(lux_at(white(DiskEmitter{{0, 0, d}, {0, 0, -1}, {1, 0, 0}, 1}), {}, {0, 0, 1}) * d * d / pi, 1, limit) << d;
    EXPECT_NEAR(lux_at(white(SphereEmitter{{0, 0, d}, 1}), {}, {0, 0, 1}) * d * d / pi, 1, limit) << d;
    // A tube's front lies up to R nearer than its axis.
    const double tube = lux_at(white(TubeEmitter{{-1, 0, d}, {1, 0, d}, 0.1, Caps::flat}), {}, {0, 0, 1}) * d * d / 0.4;
    EXPECT_NEAR(tube, 1, 0.2 / d + 1e-16 * d * d) << d;
  }
}

// Inputs without a good answer have a defined one: never NaN, never infinite, never negative.
TEST(Property, DegenerateInputsAreDefined) {
  const double zero = 0, tiny = 1e-300;
  const std::vector<EmitterShape> lights{rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, zero, 1),
                                         rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, tiny, tiny),
                                         rectangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, 1),    // contains the point
                                         rectangle({0.5, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, 1),  // the point on its edge
                                         rectangle({2, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, 1),    // coplanar
                                         DiskEmitter{{0, 0, 0}, {0, 0, -1}, {1, 0, 0}, 1},
                                         DiskEmitter{{1, 0, 0}, {0, 0, -1}, {1, 0, 0}, 1},
                                         DiskEmitter{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, zero},
                                         DiskEmitter{{0, 0, 1e-12}, {0, 0, -1}, {1, 0, 0}, 1},
                                         SphereEmitter{{0, 0, 0}, 1},
                                         SphereEmitter{{0, 0, 1}, 1},
                                         SphereEmitter{{0, 0, 0.5}, 0.6},
                                         SphereEmitter{{0, 0, 1}, zero},
                                         SphereEmitter{{0, 0, -0.49999}, 0.5},
                                         TubeEmitter{{0, 0, 0}, {1, 0, 0}, 0.1, Caps::round},
                                         TubeEmitter{{1, 0, 0}, {2, 0, 0}, 0.1, Caps::round},  // the point on its axis
                                         TubeEmitter{{1, 0, 0}, {2, 0, 0}, 0.1, Caps::flat},
                                         TubeEmitter{{1, 0, 0}, {2, 0, 0}, 0.1, Caps::none},
                                         TubeEmitter{{0, 0, 1}, {0, 0, 1}, 0.1, Caps::round},
                                         TubeEmitter{{0, 0, 1}, {0, 0, 1}, 0.1, Caps::flat},
                                         TubeEmitter{{0, 0.1, 0}, {1, 0.1, 0}, 0.1, Caps::flat},
                                         LineEmitter{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}},
                                         LineEmitter{{1, 0, 0}, {2, 0, 0}, {1, 1, 1}},
                                         LineEmitter{{0, 0, 1}, {0, 0, 1}, {1, 1, 1}},
                                         PunctualEmitter{{0, 0, 0}, Transform{}, {1, 1, 1}, PointShape{}},
                                         PunctualEmitter{{0, 0, tiny}, Transform{}, {1, 1, 1}, PointShape{}},
                                         MeshEmitter{},
                                         PolygonEmitter{}};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (const bool two_sided : {false, true}) {
      Emitter e = white(lights[i]);
      e.two_sided = two_sided;
      for (const Vec3d& n : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 0, -1}}) {
        const double x = lux_at(e, {}, n);
        EXPECT_TRUE(std::isfinite(x) && x >= 0 && x <= pi * 1.0000001) << i << " " << x;
        for (const Brdf& brdf : {Brdf{Lambert{}}, Brdf{Principled{}}, Brdf{GgxLobe{1e-4, {1, 1, 1}, 1}}, Brdf{DisneyDiffuse{}}}) {
          const Estimate estimate = reference(e, {{}, n, n, n, brdf}, {1e-3, 0});
          EXPECT_TRUE(std::isfinite(estimate.value.x) && estimate.value.x >= 0 && std::isfinite(estimate.error.x)) << i;
        }
        const LightSample s = sample_light(e, {}, {0.3, 0.6});
        EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0 && std::isfinite(s.radiance.x)) << i;
        EXPECT_TRUE(std::isfinite(light_along(e, {}, n).pdf)) << i;
      }
    }
  }
}

// From inside, a closed light is dark; if it emits on both sides it fills the sky.
TEST(Property, InsideClosedLights) {
  for (const EmitterShape& shape :
       {EmitterShape{SphereEmitter{{0, 0, 0.5}, 0.6}}, EmitterShape{TubeEmitter{{-1, 0, 0.05}, {1, 0, 0}, 0.1, Caps::round}},
        EmitterShape{TubeEmitter{{-1, 0, 0.05}, {1, 0, 0}, 0.1, Caps::flat}}}) {
    Emitter e = white(shape);
    EXPECT_EQ(lux_at(e, {}, {0, 0, 1}), 0);
    e.two_sided = true;
    EXPECT_NEAR(lux_at(e, {}, {0, 0, 1}), pi, 1e-14);
  }
}

// What passes a sphere around a light, seen from inside, is what the light emits: pi L times its emitting area. Gauss and Legendre's places
// in the cosine, on either side of the equator where flat lights go dark, and ever closer to where a tube begins to hide its side behind
// its cap, as a root; even ones in the azimuth.
TEST(Property, TheFluxThroughASurroundingSphereIsTheLights) {
  constexpr std::array<double, 12> x{0.0092196828766403, 0.0479413718147626, 0.1150486629028477, 0.2063410228566913,
                                     0.3160842505009099, 0.4373832957442655, 0.5626167042557344, 0.6839157494990901,
                                     0.7936589771433087, 0.8849513370971523, 0.9520586281852374, 0.9907803171233597};
  constexpr std::array<double, 12> w{0.0235876681932559, 0.0534696629976592, 0.0800391642716731, 0.1015837133615329,
                                     0.1167462682691774, 0.1245735229067014, 0.1245735229067014, 0.1167462682691774,
                                     0.1015837133615329, 0.0800391642716731, 0.0534696629976592, 0.0235876681932559};
  const auto flux = [&](const EmitterShape& shape, bool two_sided, const std::vector<double>& bends = {}) {
    Emitter e = white(shape);
    e.two_sided = two_sided;
    constexpr double radius = 4;
    constexpr int around = 48;
    double sum = 0;
    std::vector<double> ends{-1, 0, 1};
    for (const double bend : bends) ends.insert(ends.end(), {-bend, bend});
    std::sort(ends.begin(), ends.end());
    for (std::size_t part = 0; part + 1 < ends.size(); ++part) {
      const double width = ends[part + 1] - ends[part];
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int k = 0; k < around; ++k) {
          const double z = ends[part] + width * x[i], r = std::sqrt(1 - z * z), phi = 2 * pi * (k + 0.5) / around;
          const Vec3d d{r * std::cos(phi), r * std::sin(phi), z};
          sum += width * w[i] * lux_at(e, d * radius, -d) / around;
        }
      }
    }
    return sum * 2 * pi * radius * radius;
  };
  const auto near = [&](const char* what, double found, double area) { EXPECT_NEAR(found / (pi * area), 1, 1e-6) << what; };
  near("rectangle", flux(rectangle({}, {1, 0, 0}, {0, 1, 0}, 1, 0.7), false), 0.7);
  near("rectangle on both sides", flux(rectangle({}, {1, 0, 0}, {0, 1, 0}, 1, 0.7), true), 1.4);
  near("disk", flux(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 0.6}, false), pi * 0.36);
  near("sphere", flux(SphereEmitter{{0.1, 0.2, 0}, 0.5}, false), 4 * pi * 0.25);
  const double bend = std::sqrt(1 - 0.05 * 0.05);
  std::vector<double> bends{bend};
  for (double off = 0.5; off > 1e-7; off /= 4) {
    bends.push_back(bend - off);
    if (bend + off < 1) bends.push_back(bend + off);
  }
  near("capsule", flux(TubeEmitter{{0, 0, -0.5}, {0, 0, 0.5}, 0.2, Caps::round}, false, bends), 2 * pi * 0.2 + 4 * pi * 0.04);
}

// The midday sun's luminance: no digit depends on the unit.
TEST(Property, HugeLuminancesKeepTheirDigits) {
  Random random(12);
  for (const Kind kind : {Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
    for (int i = 0; i < 50; ++i) {
      Placement p = place(kind, random, i % 2 == 0);
      const double one = lux_at(p.emitter, p.position, p.normal);
      p.emitter.radiance = {1.6e9, 1.6e9, 1.6e9};
      EXPECT_NEAR(lux_at(p.emitter, p.position, p.normal) / (1.6e9 * one), 1, 1e-15);
    }
  }
}

}  // namespace
