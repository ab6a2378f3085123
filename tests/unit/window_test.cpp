// Distance windows on extended lights: the closed forms against integrals and the adaptive quadrature, and what must hold at the edge of
// the range.
#include <gtest/gtest.h>

#include <cmath>

#include "../../sdk/src/eval/window_part.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using protocol::Kind;
using protocol::Random;

// The first two are polynomials of d^4, whose loss is integrated; of the others it is what is left.
constexpr Falloff polynomials[]{Falloff::frostbite, Falloff::gltf};
constexpr Falloff all[]{Falloff::frostbite,
                        Falloff::gltf,
                        Falloff::linear,
                        {Falloff::Law::power, 20},
                        Falloff::smoothstep,
                        Falloff::scale_bias,
                        {Falloff::Law::power_squared, 2.5},
                        Falloff::karis};
constexpr int count = static_cast<int>(std::size(all));

// scale_bias has no shorter ranges than 1 m.
Window window_of(Falloff falloff, double range_m) {
  return {falloff, falloff == Falloff::scale_bias && range_m <= 1 ? range_m + 1 : range_m};
}
Emitter windowed(Emitter emitter, Falloff falloff, double range_m) {
  emitter.window = window_of(falloff, range_m);
  return emitter;
}

// The closed forms do not take a pattern.
Estimate by_quadrature(Emitter emitter, const Vec3d& position, const Vec3d& normal, const Tolerance& tolerance) {
  emitter.pattern = [](Vec2d) { return Rgb{1, 1, 1}; };
  const ShadingPoint point{position, normal, normal, normal, Lambert{{1, 1, 1}}};
  Estimate estimate = reference(emitter, point, tolerance);
  estimate.value = estimate.value * pi;
  estimate.error = estimate.error * pi;
  return estimate;
}

// No point of it is farther.
double farthest(const EmitterShape& shape, const Vec3d& p) {
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return length(s->centre - p) + s->radius;
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) return length(d->centre - p) + d->radius;
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return std::max(length(t->a - p), length(t->b - p)) + t->radius;
  double far = 0;
  for (const Vec3d& v : std::get<PolygonEmitter>(shape).vertices) far = std::max(far, length(v - p));
  return far;
}

// The quadrature is good to 1e-9 where its integrand is smooth: of flat lights wholly within the range. Where the range cuts the light it
// bends, and at the outline of a round one the distance has a root: there it is off by more than it tells, less with a closer tolerance.
TEST(Window, OfEveryShapeIsWhatTheQuadratureGives) {
  for (const Kind kind : {Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
    Random random(static_cast<std::uint64_t>(kind) + 3);
    for (int i = 0; i < 4 * count; ++i) {
      const protocol::Placement p = protocol::place(kind, random, i % 2 == 0);
      const double range = random.log_uniform(0.3, 12);
      const Emitter light = windowed(p.emitter, all[i / 2 % count], i == 2 * count - 1 ? 0 : range);
      const double open = protocol::lux_at(p.emitter, p.position, p.normal), closed = protocol::lux_at(light, p.position, p.normal);
      const double quadrature = by_quadrature(light, p.position, p.normal, {1e-9, 1e-11 * open}).value.x;
      const bool endless = light.window.range_m == 0;
      const bool smooth =
          (kind == Kind::rect || kind == Kind::disk) && (endless || farthest(light.shape, p.position) < light.window.range_m);
      EXPECT_NEAR(closed, quadrature, (smooth ? 1e-9 : 1e-6) * open) << static_cast<int>(kind) << " " << i;
      EXPECT_LE(closed, open * std::max(window_at(light.window, 0), 1.0));
    }
  }
}

// Straight above, with q the squared distance: E = pi h^2 integral of w / q^2 dq, from h^2 to the rim or the range. Each has a primitive:
// here in metres.
TEST(Window, OfADiskStraightAbove) {
  const double h = 0.7, range = 1.9;
  for (const double radius : {0.1, 1.0, 3.0}) {
    const Emitter disk = protocol::white(DiskEmitter{{0, 0, h}, {0, 0, -1}, {1, 0, 0}, radius});
    const double q0 = h * h, q1 = std::min(h * h + radius * radius, range * range), r4 = std::pow(range, 4);
    const double open = 1 / q0 - 1 / q1, gltf = open - (q1 - q0) / r4;
    const double frostbite = open - 2 * (q1 - q0) / r4 + (std::pow(q1, 3) - std::pow(q0, 3)) / (3 * r4 * r4);
    EXPECT_NEAR(protocol::lux_at(windowed(disk, Falloff::gltf, range), {}, {0, 0, 1}), pi * h * h * gltf, 1e-14);
    EXPECT_NEAR(protocol::lux_at(windowed(disk, Falloff::frostbite, range), {}, {0, 0, 1}), pi * h * h * frostbite, 1e-14);
    const auto lux = [&](Falloff falloff, double r) { return protocol::lux_at(windowed(disk, falloff, r), {}, {0, 0, 1}) / (pi * h * h); };
    const double d0 = std::sqrt(q0), d1 = std::sqrt(q1), r = range, log = std::log(q1 / q0);
    EXPECT_NEAR(lux(Falloff::linear, r), open - 2 / r * (1 / d0 - 1 / d1), 1e-13);
    EXPECT_NEAR(lux({Falloff::Law::power, 20}, r), open - (std::pow(q1, 9) - std::pow(q0, 9)) / (9 * std::pow(r, 20)), 1e-13);
    EXPECT_NEAR(lux(Falloff::smoothstep, r), open - 3 * log / (r * r) + 4 * (d1 - d0) / (r * r * r), 1e-13);
    EXPECT_NEAR(lux(Falloff::scale_bias, r), (open - log / (r * r)) / (1 - 1 / (r * r)), 1e-13);
    EXPECT_NEAR(lux({Falloff::Law::power_squared, 3}, r),
                open - 4 * (d1 - d0) / std::pow(r, 3) + (q1 * q1 - q0 * q0) / (2 * std::pow(r, 6)), 1e-13);
    const double soft = std::log((q0 + 1) / (q1 + 1)) + log, s1 = std::log((q1 + 1) / (q0 + 1));
    const double taken =
        2 * (q1 - q0 - s1) / r4 - ((q1 * q1 * q1 - q0 * q0 * q0) / 3 - (q1 * q1 - q0 * q0) / 2 + (q1 - q0) - s1) / (r4 * r4);
    EXPECT_NEAR(lux(Falloff::karis, r), soft - taken, 1e-13);
    const double rim = h * h + radius * radius;
    EXPECT_NEAR(lux(Falloff::karis, 0), std::log((q0 + 1) / (rim + 1) * rim / q0), 1e-13);
  }
}

// Karis' 1 m is far less than the range, or far more.
TEST(Window, OfKarisInEveryUnit) {
  for (const double r : {1e-4, 1e-2, 0.9, 1.1, 30.0, 1e5}) {
    const double h = 0.3 * r, radius = 0.7 * r, q0 = h * h, q1 = q0 + radius * radius;
    const Emitter disk = windowed(protocol::white(DiskEmitter{{0, 0, h}, {0, 0, -1}, {1, 0, 0}, radius}), Falloff::karis, r);
    double sum = 0;
    const int steps = 20000;  // of Simpson's rule in log q
    for (int i = 0; i <= steps; ++i) {
      const double q = q0 * std::pow(q1 / q0, static_cast<double>(i) / steps);
      sum += (i % steps == 0 ? 1 : 2 << (i % 2)) * window_at(disk.window, std::sqrt(q)) / q;
    }
    const double expected = pi * h * h * sum * std::log(q1 / q0) / (3 * steps);
    EXPECT_NEAR(protocol::lux_at(disk, {}, {0, 0, 1}) / expected, 1, 1e-11) << r;
  }
}

// Facing a sphere: E = 2 pi integral of mu w dmu, mu = (d^2 + c^2 - R^2) / (2 c d): rational in d. By Simpson's rule in d, 20000 steps.
TEST(Window, OfASphereThatIsFaced) {
  const double c = 2, radius = 0.8;
  for (const Falloff& falloff : all) {
    for (const double range : {1.3, 1.7, 4.0}) {
      const Emitter ball = windowed(protocol::white(SphereEmitter{{0, 0, c}, radius}), falloff, range);
      const double first = c - radius, last = std::min(std::sqrt(c * c - radius * radius), range);
      const auto integrand = [&](double d) {
        const double tangent2 = c * c - radius * radius, mu = (d * d + tangent2) / (2 * c * d);
        return 2 * pi * mu * window_at(ball.window, d) * (tangent2 / (d * d) - 1) / (2 * c);
      };
      const int steps = 20000;
      double sum = 0;
      for (int i = 0; i <= steps; ++i)
        sum += (i == 0 || i == steps ? 1
                : i % 2 == 1         ? 4
                                     : 2) *
               integrand(first + (last - first) * i / steps) * (last - first) / (3 * steps);
      EXPECT_NEAR(protocol::lux_at(ball, {}, {0, 0, 1}), sum, 1e-12);
    }
  }
}

// Both halves of a sphere, whatever the plane between them, take what the whole does: their integrands bend at other places.
TEST(Window, OfASphereIsThatOfItsHalves) {
  Random random(14);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const double radius = random.log_uniform(0.01, 3);
    const Vec3d centre = random.direction() * (radius * (1 + random.log_uniform(1e-3, 10))), axis = random.direction();
    const Taken taken(Window{polynomials[i % 2], 1});
    const double whole = ball_part(centre, radius, taken, {}),
                 open = protocol::lux_at(protocol::white(SphereEmitter{centre, radius}), {}, {0, 0, 1});
    worst = std::max(worst, std::abs(ball_part(centre, radius, taken, axis) + ball_part(centre, radius, taken, -axis) - whole));
    if (length(centre) - radius >= 1) worst = std::max(worst, std::abs(whole - open));
    const Kept kept(Window{all[2 + i % (count - 2)], i % 3 == 0 ? 2.0 : 1.2});
    const double left = ball_part(centre, radius, kept, {});
    worst = std::max(worst, std::abs(ball_part(centre, radius, kept, axis) + ball_part(centre, radius, kept, -axis) - left));
  }
  EXPECT_LE(worst, 1e-12);
}

// The side of a tube above the horizon as the sum over its surface: R integral of n.y (-m.y) w / |y|^4 by Simpson's rule, 400 x 400 steps.
TEST(Window, OfTheSideOfATube) {
  Random random(13);
  const double radius = 0.3, half = 0.8;
  for (int i = 0; i < 20; ++i) {
    const Vec3d axis = random.direction(), across = basis_around(axis).tangent, side = cross(axis, across);
    const double distance = random.uniform(0.5, 2), from = random.uniform(-2, 1);  // the point stands at -distance across
    const Vec3d a = across * distance + axis * from, b = a + axis * (2 * half), n = normalised(a + b);
    if (std::min(dot(n, a), dot(n, b)) < radius) continue;
    const Emitter tube = windowed(protocol::white(TubeEmitter{a, b, radius, Caps::none}), all[i % count], length(a) + length(b));
    const double last = std::acos(radius / distance);
    const int steps = 400;
    double sum = 0;
    for (int j = 0; j <= steps; ++j) {
      for (int k = 0; k <= steps; ++k) {
        const double phi = last * (2.0 * j / steps - 1), weight = (j % steps == 0 ? 1 : 2 << (j % 2)) * (k % steps == 0 ? 1 : 2 << (k % 2));
        const Vec3d m = side * std::sin(phi) - across * std::cos(phi), y = a + axis * (2 * half * k / steps) + m * radius;
        sum += weight * dot(n, y) * -dot(m, y) / std::pow(dot(y, y), 2) * window_at(tube.window, length(y));
      }
    }
    EXPECT_NEAR(protocol::lux_at(tube, {}, n), sum * radius * 2 * last * 2 * half / (9.0 * steps * steps), 1e-9) << i;
  }
}

// A rectangle cut in two, a polygon that is not convex as rectangles, a mesh as its triangles; the range cuts some of them.
TEST(Window, IsAdditive) {
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const Vec3d n = random.direction(), centre = random.direction() * random.uniform(0.2, 2), up = random.direction();
    const Basis b = basis_around(n);
    const auto at = [&](double x, double y) { return centre + b.tangent * x + b.bitangent * y; };
    const auto part = [&](std::vector<Vec3d> vertices) {
      Emitter e = protocol::white(PolygonEmitter{std::move(vertices), n, {}});
      e.two_sided = true;
      return windowed(e, all[i % count], 1.5);
    };
    // An L: [-1, 1]^2 without (0, 1]^2. Sides of some laws are integrated, each to some 1e-12 of the light.
    const Emitter whole = part({at(-1, -1), at(1, -1), at(1, 0), at(0, 0), at(0, 1), at(-1, 1)});
    const Emitter lower = part({at(-1, -1), at(1, -1), at(1, 0), at(-1, 0)}), upper = part({at(-1, 0), at(0, 0), at(0, 1), at(-1, 1)});
    const double sum = protocol::lux_at(lower, {}, up) + protocol::lux_at(upper, {}, up);
    EXPECT_NEAR(protocol::lux_at(whole, {}, up), sum, 5e-12) << i;
    Emitter mesh = whole;
    mesh.shape = MeshEmitter{{{at(-1, -1), at(1, -1), at(1, 0)},
                              {at(-1, -1), at(1, 0), at(-1, 0)},
                              {at(-1, 0), at(0, 0), at(0, 1)},
                              {at(-1, 0), at(0, 1), at(-1, 1)}}};
    EXPECT_NEAR(protocol::lux_at(mesh, {}, up), sum, 5e-12) << i;
  }
}

// A thin tube without caps is a line of the intensity 2 R l L, but for the place where the horizon cuts it.
TEST(Window, OfALineIsThatOfAThinTube) {
  Random random(12);
  const double radius = 1e-5;
  for (int i = 0; i < 50; ++i) {
    const Vec3d a = random.direction() * random.uniform(0.5, 2), b = a + random.direction() * random.uniform(0.1, 3),
                n = random.direction();
    Emitter line;
    const double cd = 2 * radius * length(b - a);
    line.shape = LineEmitter{a, b, {cd, cd, cd}};
    const Window window = window_of(all[i % count], random.uniform(0.4, 4));
    Emitter tube = protocol::white(TubeEmitter{a, b, radius, Caps::none});
    const double open = protocol::lux_at(tube, {}, n);
    line.window = tube.window = window;
    EXPECT_NEAR(protocol::lux_at(line, {}, n), protocol::lux_at(tube, {}, n), 2e-4 * open + 10 * cd * radius) << i;
  }
}

// From far away a light is a point: the window at its distance, continuously to zero at the range, nothing beyond it.
TEST(Window, OfALightFarAwayIsThatOfItsDistance) {
  for (const Kind kind : {Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
    Random random(static_cast<std::uint64_t>(kind) + 5);
    const Vec3d away = random.direction();
    const Emitter light{.shape = random_shape(kind, {}, away, random), .radiance = {1, 1, 1}, .window = {}, .pattern = {}};
    const Vec3d centre = away * (farthest(light.shape, {}) / 2), p = centre - away * 1e4;
    const double open = protocol::lux_at(light, p, away), size = farthest(light.shape, centre);
    ASSERT_GT(open, 0);
    for (const Falloff& falloff : all) {
      for (const double x : {0.1, 0.5, 0.9, 0.99}) {
        const Window window{falloff, 1e4 / x};
        const double nearer = window_at(window, 1e4 - size), farther = window_at(window, 1e4 + size);
        EXPECT_NEAR(protocol::lux_at(windowed(light, falloff, 1e4 / x), p, away) / open, window_at(window, 1e4), nearer - farther + 1e-9)
            << static_cast<int>(kind) << name_of(falloff);
      }
      const double edge = protocol::lux_at(windowed(light, falloff, 1e4 + 2 * size), p, away) / open;
      EXPECT_LE(edge, window_at({falloff, 1e4 + 2 * size}, 1e4 - size));
      EXPECT_EQ(protocol::lux_at(windowed(light, falloff, 1e4 - 2 * size), p, away), 0) << static_cast<int>(kind);
    }
  }
}

// From inside of what emits on both sides, where the distance to the surface counts: the quadrature.
TEST(Window, FromInside) {
  Emitter ball = windowed(protocol::white(SphereEmitter{{}, 1}), Falloff::gltf, 2);
  EXPECT_EQ(protocol::lux_at(ball, {}, {0, 0, 1}), 0);
  ball.two_sided = true;
  EXPECT_NEAR(protocol::lux_at(ball, {}, {0, 0, 1}), pi * (1 - 1.0 / 16), 1e-9);
}

}  // namespace
