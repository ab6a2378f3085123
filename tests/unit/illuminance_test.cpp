// Closed forms of illuminance: known facts, sums over the light's area, the Nusselt analogue.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// ---- Known facts ----

// E = pi L r^2 / (r^2 + h^2) on the axis of a disk.
TEST(Fact, DiskOnItsAxis) {
  for (const double h : {1e-4, 0.05, 1.0, 30.0}) {
    const Emitter disk = white(DiskEmitter{{0, 0, h}, {0, 0, -1}, {1, 0, 0}, 0.5}, 100);
    EXPECT_NEAR(lux_at(disk, {0, 0, 0}, {0, 0, 1}), 100 * pi * 0.25 / (0.25 + h * h), 1e-12 * 100) << h;
  }
}

// E = pi L (R / d)^2 cos theta, whatever the distance, while the sphere is above the horizon.
TEST(Fact, SphereAboveTheHorizon) {
  const Emitter sphere = white(SphereEmitter{{0, 0, 2}, 0.5}, 10);
  EXPECT_NEAR(lux_at(sphere, {}, {0, 0, 1}), 10 * pi / 16, 1e-13);
  EXPECT_NEAR(lux_at(sphere, {}, normalised(Vec3d{1, 0, 1})), 10 * pi / 16 * std::sqrt(0.5), 1e-13);
}

// A sphere half below the horizon: (cot-form of Snyder 1996 at omega = pi / 2) E = L (asin(s) - s sqrt(1 - s^2)), s = R / d.
TEST(Fact, SphereHalfSet) {
  const double s = 0.3;
  const Emitter sphere = white(SphereEmitter{{1, 0, 0}, s});
  EXPECT_NEAR(lux_at(sphere, {}, {0, 0, 1}), std::asin(s) - s * std::sqrt(1 - s * s), 1e-14);
}

TEST(Fact, InfinitePlaneGivesPiL) {
  const PolygonEmitter plane = rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2e6, 2e6);
  ASSERT_LT(plane.normal.z, 0);
  // What is missing lies within 1e-6 of the horizon: pi (1 - sin^2) = pi 1e-12 at most.
  EXPECT_NEAR(lux_at(white(plane), {}, {0, 0, 1}), pi, 1e-11);
  EXPECT_NEAR(lux_at(white(EnvironmentEmitter{}), {}, {0, 0, 1}), pi, 1e-14);
}

// Two parallel unit squares at distance 1, one corner above the other: the classic configuration factor of a differential element
// (Howell's catalogue B-3): F = 1 / (2 pi) (X / sqrt(1 + X^2) atan(Y / sqrt(1 + X^2)) + Y / sqrt(1 + Y^2) atan(X / sqrt(1 + Y^2))).
TEST(Fact, RectangleOverItsCorner) {
  const double x = 0.7, y = 1.9;
  const PolygonEmitter rect = rectangle({x / 2, y / 2, 1}, {0, 1, 0}, {1, 0, 0}, y, x);
  const double factor =
      (x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) + y / std::hypot(1, y) * std::atan(x / std::hypot(1, y))) / (2 * pi);
  EXPECT_NEAR(lux_at(white(rect), {}, {0, 0, 1}), pi * factor, 1e-14);
}

// An infinitely long tube of radius R at distance d: E = pi L R / d facing it (a cylinder's configuration factor is R / d).
TEST(Fact, LongTubeFacingIt) {
  for (const Caps caps : {Caps::round, Caps::flat, Caps::none}) {
    const Emitter tube = white(TubeEmitter{{-1e5, 0, 2}, {1e5, 0, 2}, 0.5, caps});
    EXPECT_NEAR(lux_at(tube, {}, {0, 0, 1}), pi * 0.25, 1e-8);
  }
}

// I cos / d^2, and the integral of a line: per length I / l sin(theta) cos(theta) / d^2 seen from its middle at the height h,
// E = I / (l h) (psi + sin 2 psi / 2) with tan psi = l / 2 h.
TEST(Fact, PunctualAndLine) {
  Emitter point;
  point.shape = PunctualEmitter{{0, 3, 4}, Transform{}, {50, 50, 50}, PointShape{}};
  EXPECT_NEAR(lux_at(point, {}, {0, 0, 1}), 50.0 / 25 * 0.8, 1e-14);
  EXPECT_EQ(lux_at(point, {}, {0, 0, -1}), 0);
  const double l = 1.2, h = 0.7, psi = std::atan(l / (2 * h));
  Emitter line;
  line.shape = LineEmitter{{-l / 2, 0, h}, {l / 2, 0, h}, {20, 20, 20}};
  EXPECT_NEAR(lux_at(line, {}, {0, 0, 1}), 20 / (l * h) * (psi + 0.5 * std::sin(2 * psi)), 1e-13);
  // From far away it is a point with I sin(theta).
  const Vec3d away = normalised(Vec3d{1, 0, 2}) * 1e4;
  EXPECT_NEAR(lux_at(line, Vec3d{0, 0, h} + away, -normalised(away)) * 1e8, 20 * 2 / std::sqrt(5.0), 1e-5);
}

TEST(Fact, SpotAndFrustumShares) {
  Emitter spot;  // emits along -z from (0, 0, 1)
  spot.shape = PunctualEmitter{{0, 0, 1}, Transform::from_trs({0, 0, 1}, {}), {8, 8, 8}, SpotShape{20 * pi / 180, 45 * pi / 180}};
  EXPECT_NEAR(lux_at(spot, {}, {0, 0, 1}), 8, 1e-14);
  const auto at = [&](double degrees) {
    return lux_at(spot, {std::tan(degrees * pi / 180), 0, 0}, {0, 0, 1}) / std::pow(std::cos(degrees * pi / 180), 3);
  };
  EXPECT_NEAR(at(19.9), 8, 1e-12);
  EXPECT_EQ(at(45.1), 0);
  const double c = std::cos(30 * pi / 180), ci = std::cos(20 * pi / 180), co = std::cos(45 * pi / 180);
  EXPECT_NEAR(at(30), 8 * std::pow((c - co) / (ci - co), 2), 1e-12);
  Emitter frustum;
  frustum.shape = PunctualEmitter{{0, 0, 1}, Transform::from_trs({0, 0, 1}, {}), {8, 8, 8}, FrustumShape{pi / 2, pi / 3}};
  EXPECT_GT(lux_at(frustum, {0.99, 0, 0}, {0, 0, 1}), 0);
  EXPECT_EQ(lux_at(frustum, {1.01, 0, 0}, {0, 0, 1}), 0);
  EXPECT_GT(lux_at(frustum, {0, 0.57, 0}, {0, 0, 1}), 0);
  EXPECT_EQ(lux_at(frustum, {0, 0.58, 0}, {0, 0, 1}), 0);
}

TEST(Fact, WindowsOfRange) {
  EXPECT_EQ(window_at({Falloff::frostbite, 10}, 10), 0);
  EXPECT_EQ(window_at({Falloff::frostbite, 10}, 11), 0);
  EXPECT_NEAR(window_at({Falloff::frostbite, 10}, 7), std::pow(1 - std::pow(0.7, 4), 2), 1e-15);
  EXPECT_NEAR(window_at({Falloff::gltf, 10}, 7), 1 - std::pow(0.7, 4), 1e-15);
  EXPECT_EQ(window_at({Falloff::inverse_square, 10}, 7), 1);
  EXPECT_EQ(window_at({Falloff::gltf, 0}, 7), 1);
  EXPECT_EQ(window_at({Falloff::linear, 10}, 7), 1 - 0.7);
  EXPECT_NEAR(window_at({{Falloff::Law::power, 20}, 10}, 7), 1 - std::pow(0.7, 20), 1e-15);
  EXPECT_NEAR(window_at({{Falloff::Law::power_squared, 3}, 10}, 7), std::pow(1 - 0.343, 2), 1e-15);
  EXPECT_EQ(window_at({Falloff::smoothstep, 10}, 5), 0.5);
  // (1 / 49 - 1 / 100) / (1 - 1 / 100) over 1 / 49, and 1 at 1 m.
  EXPECT_NEAR(window_at({Falloff::scale_bias, 10}, 7) / 49, (1.0 / 49 - 0.01) / 0.99, 1e-15);
  EXPECT_NEAR(window_at({Falloff::scale_bias, 10}, 1), 1, 1e-15);
  EXPECT_EQ(window_at({Falloff::scale_bias, 1}, 0.5), 0);
  EXPECT_NEAR(window_at({Falloff::karis, 10}, 7) / 49, std::pow(1 - std::pow(0.7, 4), 2) / 50, 1e-15);
  EXPECT_NEAR(window_at({Falloff::karis, 0}, 1), 0.5, 1e-15);
  EXPECT_EQ(window_at({Falloff::karis, 0}, 0), 0);
  EXPECT_NEAR(window_at({Falloff::karis, 0}, 1e200), 1, 1e-15);
}

// Nothing beyond the range, and what is left there goes to nothing with it.
TEST(Fact, WindowsEndAtTheirRange) {
  for (const Falloff& falloff : {Falloff::linear, Falloff::gltf, Falloff{Falloff::Law::power, 64}, Falloff::frostbite, Falloff::smoothstep,
                                 Falloff::scale_bias, Falloff::karis}) {
    for (const double range : {1.5, 10.0, 1e6}) {
      EXPECT_EQ(window_at({falloff, range}, range), 0);
      EXPECT_EQ(window_at({falloff, range}, 2 * range), 0);
      EXPECT_LE(window_at({falloff, range}, range * (1 - 1e-9)), 64e-9 * 2);
    }
  }
}

// The sun: E on a plane facing it, E cos theta otherwise, and continuous while it sets.
TEST(Fact, SunDisk) {
  const double rho = 0.00465;
  Emitter sun;
  const auto at = [&](double elevation) {
    sun.shape = DistantEmitter{{std::cos(elevation), 0, std::sin(elevation)}, {1e5, 1e5, 1e5}, rho};
    return lux_at(sun, {}, {0, 0, 1});
  };
  EXPECT_NEAR(at(pi / 2), 1e5, 1e-6);
  EXPECT_NEAR(at(0.5), 1e5 * std::sin(0.5), 1e-6);
  EXPECT_NEAR(at(0), 1e5 * (rho - std::sin(rho) * std::cos(rho)) / (pi * std::pow(std::sin(rho), 2)), 1e-5);
  EXPECT_EQ(at(-rho - 1e-9), 0);
  EXPECT_GT(at(-0.9 * rho), 0);
}

// ---- Against sums over the light itself, which know nothing of outlines ----

struct Patch {
  Vec3d position, normal;
  double area;
};

// Gauss-Legendre 5 on [0, 1].
const double gauss_x[5] = {0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415, 0.953089922969332};
const double gauss_w[5] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454};

// Sum of max(n.l, 0) max(-m.l, 0) / d^2 over a parametrised surface, cells x cells of 5 x 5 nodes each.
double over_surface(const std::function<Patch(double, double)>& at, const Vec3d& p, const Vec3d& n, int cells) {
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      for (int a = 0; a < 5; ++a) {
        for (int b = 0; b < 5; ++b) {
          const Patch patch = at((i + gauss_x[a]) / cells, (j + gauss_x[b]) / cells);
          const Vec3d to = patch.position - p;
          const double d2 = dot(to, to);
          const double cosines = std::max(dot(n, to), 0.0) * std::max(-dot(patch.normal, to), 0.0);
          sum += gauss_w[a] * gauss_w[b] * patch.area * cosines / (d2 * d2);
        }
      }
    }
  }
  return sum / (cells * cells);
}

std::vector<std::function<Patch(double, double)>> surfaces(const EmitterShape& shape) {
  if (const auto* r = std::get_if<PolygonEmitter>(&shape)) {
    const PolygonEmitter rect = *r;
    return {[rect](double u, double v) {
      const Vec3d x = rect.vertices[1] - rect.vertices[0], y = rect.vertices[3] - rect.vertices[0];
      return Patch{rect.vertices[0] + x * u + y * v, rect.normal, length(cross(x, y))};
    }};
  }
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) {
    const DiskEmitter disk = *d;
    return {[disk](double u, double v) {
      const Basis b = basis_around(disk.normal);
      const double r = disk.radius * u, phi = 2 * pi * v;
      return Patch{disk.centre + b.tangent * (r * std::cos(phi)) + b.bitangent * (r * std::sin(phi)), disk.normal,
                   2 * pi * disk.radius * r};
    }};
  }
  const auto ball = [](const Vec3d& centre, double radius, const Vec3d& axis, double lowest) {
    return [=](double u, double v) {
      const Basis b = basis_around(axis);
      const double z = lowest + (1 - lowest) * u, s = std::sqrt(1 - z * z), phi = 2 * pi * v;
      const Vec3d m = b.tangent * (s * std::cos(phi)) + b.bitangent * (s * std::sin(phi)) + axis * z;
      return Patch{centre + m * radius, m, 2 * pi * radius * radius * (1 - lowest)};
    };
  };
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return {ball(s->centre, s->radius, {0, 0, 1}, -1)};
  const TubeEmitter t = std::get<TubeEmitter>(shape);
  const Vec3d axis = normalised(t.b - t.a);
  std::vector<std::function<Patch(double, double)>> parts{[t, axis](double u, double v) {
    const Basis b = basis_around(axis);
    const double phi = 2 * pi * v;
    const Vec3d m = b.tangent * std::cos(phi) + b.bitangent * std::sin(phi);
    return Patch{t.a + (t.b - t.a) * u + m * t.radius, m, length(t.b - t.a) * 2 * pi * t.radius};
  }};
  if (t.caps == Caps::round) {
    parts.push_back(ball(t.a, t.radius, -axis, 0));
    parts.push_back(ball(t.b, t.radius, axis, 0));
  }
  if (t.caps == Caps::flat) {
    for (const auto& [centre, normal] : {std::pair{t.a, -axis}, std::pair{t.b, axis}}) {
      parts.push_back(surfaces(DiskEmitter{centre, normal, {}, t.radius})[0]);
    }
  }
  return parts;
}

class AgainstArea : public testing::TestWithParam<Kind> {};

// Convex lights are seen without occlusion by themselves, so the sum over their front is their illuminance. The sum's own error, from the
// kinks at the terminator and at the horizon, falls as cells^-2 (to about 1e-5 here).
TEST_P(AgainstArea, AgreesWithTheSum) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 3);
  for (int i = 0; i < 12; ++i) {
    const Placement p = place(GetParam(), random, i % 2 == 0);
    double sum = 0;
    for (const auto& surface : surfaces(p.emitter.shape)) sum += over_surface(surface, p.position, p.normal, 150);
    EXPECT_NEAR(illuminance(p.emitter, p.position, p.normal).x, sum, 2e-4 * sum + 1e-5) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, AgainstArea,
                         testing::Values(Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube));

// Where nothing has a kink (planar lights wholly above the horizon, not too close) the sum converges fast: to 1e-9 and below.
TEST(AgainstArea, PlanarLightsToNineDigits) {
  Random random(12);
  for (int i = 0; i < 30; ++i) {
    const Placement p = place(i % 2 == 0 ? Kind::rect : Kind::disk, random, true);
    const double sum = over_surface(surfaces(p.emitter.shape)[0], p.position, p.normal, 40);
    EXPECT_NEAR(illuminance(p.emitter, p.position, p.normal).x, sum, 1e-9 * std::max(sum, 0.01)) << i;
  }
}

// Nusselt 1928: the illuminance is the area of the light's projection onto the unit sphere and then down onto the plane: here of
// a polygon, as the area enclosed by its edges' images, elliptic arcs, summed finely (chords err as step^2).
TEST(AgainstArea, NusseltAnalogue) {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const Placement p = place(Kind::rect, random, true);
    const auto& vertices = std::get<PolygonEmitter>(p.emitter.shape).vertices;
    const Basis b = basis_around(p.normal);
    std::vector<Vec2d> outline;
    for (std::size_t k = 0; k < 4; ++k) {
      for (int j = 0; j < 2000; ++j) {
        const Vec3d d = normalised(vertices[k] + (vertices[(k + 1) % 4] - vertices[k]) * (j / 2000.0) - p.position);
        outline.push_back({dot(d, b.tangent), dot(d, b.bitangent)});
      }
    }
    double twice = 0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2d &u = outline[k], &v = outline[(k + 1) % outline.size()];
      twice += u.x * v.y - u.y * v.x;
    }
    EXPECT_NEAR(illuminance(p.emitter, p.position, p.normal).x, std::abs(twice) / 2, 2e-6);
  }
}

}  // namespace
