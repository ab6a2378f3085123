// The published specular methods: limits that they are meant to keep, their sources' slips, and answers everywhere.
#include "etendue/specular_methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "../sdk/src/eval/cones.h"
#include "../sdk/src/eval/facets.h"
#include "../sdk/src/eval/hill_heitz.h"
#include "../sdk/src/eval/karis.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

ShadingPoint surface(const Vec3d& position, const Vec3d& normal, const Vec3d& view, const Brdf& brdf) {
  return {position, normal, normal, view, brdf};
}
GgxLobe mirror_lobe(double alpha) { return {alpha, {1, 1, 1}}; }
Vec3d view_of(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }
Vec3d mirror_of(double cosine) { return {-std::sqrt(1 - cosine * cosine), 0, cosine}; }

std::optional<double> taken(std::string_view name, const Emitter& emitter, const ShadingPoint& point) {
  const SpecularMethod* method = find_specular_method(name);
  EXPECT_NE(method, nullptr) << name;
  const auto value = method == nullptr ? std::nullopt : method->luminance(emitter, point);
  return value ? std::optional(value->x) : std::nullopt;
}
double through(std::string_view name, const Emitter& emitter, const ShadingPoint& point) {
  const std::optional<double> value = taken(name, emitter, point);
  EXPECT_TRUE(value.has_value()) << name;
  return value.value_or(-1);
}
double lobe_of(const ShadingPoint& point, const Vec3d& light) {
  const Basis b = shading_basis(point);
  const auto local = [&](const Vec3d& v) { return Vec3d{dot(b.tangent, v), dot(b.bitangent, v), dot(b.normal, v)}; };
  return brdf_cos(point.brdf, local(point.view), local(normalised(light))).x;
}

Emitter square(const Vec3d& centre, const Vec3d& normal, double side) {
  const Basis b = basis_around(normal);
  return white(rectangle(centre, b.tangent, b.bitangent, side, side));
}
Emitter disk(const Vec3d& centre, const Vec3d& normal, double radius) {
  return white(DiskEmitter{centre, normal, basis_around(normal).tangent, radius});
}
Emitter ball(const Vec3d& centre, double radius) { return white(SphereEmitter{centre, radius}); }

// ---- Limits ----

// Far enough away that 1 / (d^2 + 1) is 1 / d^2, and far smaller than its lobe is wide: what is left is the widening of alpha, up to
// size / (distance alpha), and the error of a point for a light.
TEST(PublishedSpecular, SmallLightsSeeTheBrdf) {
  constexpr double distance = 100, size = 0.05;
  Random random(41);
  for (int i = 0; i < 100; ++i) {
    const double alpha = random.uniform(0.2, 1), cosine = random.uniform(0.3, 1);
    Vec3d to = random.direction();
    to.z = std::abs(to.z) + 0.3;
    to = normalised(to);
    const ShadingPoint point = surface({}, {0, 0, 1}, view_of(cosine), mirror_lobe(alpha));
    // Where the lobe's tail falls off steeply a place that moves by the light's size matters.
    const double brdf = lobe_of(point, to), tolerance = 0.02;
    const auto near = [&](std::string_view name, const Emitter& light, double solid_angle) {
      EXPECT_NEAR(through(name, light, point) / (brdf * solid_angle), 1, tolerance) << name << " alpha " << alpha << " cosine " << cosine;
    };
    const double round = pi * size * size / (distance * distance);
    for (const std::string_view name :
         {"punctual", "frostbite-point", "karis-10", "karis-11", "karis-11-mended", "karis-14", "eden-sphere"})
      near(name, ball(to * distance, size), round);
    for (const std::string_view name : {"punctual", "frostbite-point"}) {
      near(name, disk(to * distance, -to, size), round);
      near(name, square(to * distance, -to, size), round / pi);
    }
    // Across the way to it: its length is as a sphere's diameter.
    const Vec3d half = basis_around(to).tangent * size;
    const Emitter tube = white(TubeEmitter{to * distance - half, to * distance + half, 0.1 * size, Caps::round});
    const double flat = 0.4 * size * size / (distance * distance), caps = 0.01 * round;
    for (const std::string_view name : {"punctual", "eden-tube-mended", "frostbite-point"}) near(name, tube, flat + caps);
    for (const std::string_view name : {"karis-18", "karis-19", "karis-20", "karis-20-mended"}) near(name, tube, flat);
  }
}
// Drobot's see what is within their cone alone: at the mirror direction.
TEST(PublishedSpecular, SmallLightsWithinTheConeSeeTheBrdf) {
  for (const double alpha : {0.01, 0.1, 0.5}) {
    for (const double cosine : {0.3, 0.7, 1.0}) {
      const ShadingPoint point = surface({}, {0, 0, 1}, view_of(cosine), mirror_lobe(alpha));
      const Vec3d to = mirror_of(cosine);
      const double side = 1e-3 * alpha, brdf = lobe_of(point, to);
      for (const std::string_view name : {"drobot-1-20-mended", "drobot-1-20-fitted", "drobot-elongated"})
        EXPECT_NEAR(through(name, square(to, -to, side), point), brdf * side * side, 1e-5 * brdf * side * side) << name;
      for (const std::string_view name : {"drobot-1-20-mended", "drobot-1-20-fitted"}) {
        EXPECT_NEAR(through(name, disk(to, -to, side), point), brdf * pi * side * side, 1e-5 * brdf * side * side) << name;
        EXPECT_NEAR(through(name, ball(to, side), point), brdf * pi * side * side, 1e-5 * brdf * side * side) << name;
      }
    }
  }
}
// A rough lobe does not notice Karis' widening: alpha' is 1 as alpha is.
TEST(PublishedSpecular, AtAlphaOneNothingIsWidened) {
  Random random(42);
  for (int i = 0; i < 50; ++i) {
    const Placement s = place(Kind::sphere, random, true), t = place(Kind::capsule, random, true);
    const auto at = [](const Placement& p) { return surface(p.position, p.normal, p.normal, mirror_lobe(1)); };
    EXPECT_DOUBLE_EQ(through("karis-14", s.emitter, at(s)), through("karis-11-mended", s.emitter, at(s)));
    EXPECT_DOUBLE_EQ(through("karis-10", s.emitter, at(s)), through("punctual", s.emitter, at(s)));
    EXPECT_DOUBLE_EQ(through("karis-20-mended", t.emitter, at(t)), through("karis-19", t.emitter, at(t)));
  }
}
// A cone that meets nothing but light: the albedo of the lobe. The unit of length is none of a cone's business.
TEST(PublishedSpecular, AConeFullOfLightGivesTheAlbedo) {
  for (const double alpha : {0.01, 0.2, 0.5}) {
    const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.8), GgxLobe{alpha, {0.04, 0.04, 0.04}});
    const double sky = reference(white(EnvironmentEmitter{}), point, {1e-6, 0}).value.x;
    EXPECT_NEAR(through("karis-billboard", square(mirror_of(0.8), -mirror_of(0.8), 1e4), point), sky, 1e-3 * sky);
    EXPECT_NEAR(through("karis-cone", ball(mirror_of(0.8), 0.99), point), sky, 1e-3 * sky);
  }
}
// Karis' sun: the whole of a lobe that is small beside it, normalised by (alpha / alpha')^2. A sphere of the same angle, anywhere, is it.
TEST(PublishedSpecular, SunsAreSpheres) {
  const double radius = 0.00465, lux = pi * std::sin(radius) * std::sin(radius);
  for (const double away : {0.0, 0.003, 0.02}) {
    const Vec3d to = normalised(mirror_of(0.6) + Vec3d{0, away, 0});
    const Emitter sun{DistantEmitter{to, {lux, lux, lux}, radius}, {}, false, {}, {}};
    const ShadingPoint point = surface({3, 1, -2}, {0, 0, 1}, view_of(0.6), mirror_lobe(0.002));
    for (const SpecularMethod& method : specular_methods()) {
      const auto there = method.luminance(sun, point), near = method.luminance(ball(point.position + to * 7, 7 * std::sin(radius)), point);
      if (there && near) {
        EXPECT_NEAR(there->x, near->x, 1e-9 * near->x) << method.name;
      }
    }
  }
}
// Everything turned alike is the same.
TEST(PublishedSpecular, NothingDependsOnTheAxes) {
  Random random(43);
  const Quat turn{0.3, -0.5, 0.1, std::sqrt(1 - 0.09 - 0.25 - 0.01)};
  const Transform t = Transform::from_trs({0.4, -3, 2}, turn);
  for (const Kind kind : {Kind::rect, Kind::disk, Kind::sphere, Kind::capsule}) {
    for (int i = 0; i < 20; ++i) {
      const Placement p = place(kind, random, i % 2 == 0);
      Vec3d view = random.direction();
      if (dot(view, p.normal) < 0) view = -view;
      Emitter turned = p.emitter;
      if (auto* s = std::get_if<SphereEmitter>(&turned.shape)) s->centre = t.point(s->centre);
      if (auto* d = std::get_if<DiskEmitter>(&turned.shape)) d->centre = t.point(d->centre), d->normal = t.vector(d->normal);
      if (auto* c = std::get_if<TubeEmitter>(&turned.shape)) c->a = t.point(c->a), c->b = t.point(c->b);
      if (auto* q = std::get_if<PolygonEmitter>(&turned.shape)) {
        for (Vec3d& v : q->vertices) v = t.point(v);
        q->normal = t.vector(q->normal);
      }
      const GgxLobe lobe = mirror_lobe(random.log_uniform(0.02, 1));
      for (const SpecularMethod& method : specular_methods()) {
        const auto one = method.luminance(p.emitter, surface(p.position, p.normal, view, lobe));
        const auto other = method.luminance(turned, surface(t.point(p.position), t.vector(p.normal), t.vector(view), lobe));
        ASSERT_EQ(one.has_value(), other.has_value());
        if (one && method.name != "moments") {  // whose pieces of a circle begin somewhere
          EXPECT_NEAR(one->x, other->x, 1e-6 * (1 + one->x)) << method.name;
        }
      }
    }
  }
}

// ---- Slips ----

// Karis, eq 11: where the mirrored view meets the sphere the point is on it. As printed it is twice as far away from it as the centre.
TEST(PublishedSpecular, Karis11PrintsTheWrongSign) {
  const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.7), mirror_lobe(0.02));
  const Vec3d beside = cross(mirror_of(0.7), Vec3d{0, 1, 0});
  const Vec3d centre = mirror_of(0.7) * 5 + beside * 0.4;
  const double facing = pi / dot(centre, centre);
  EXPECT_NEAR(through("karis-11-mended", ball(centre, 1), point), lobe_of(point, mirror_of(0.7)) * facing, 1e-9);
  EXPECT_NEAR(through("karis-11", ball(centre, 1), point), lobe_of(point, mirror_of(0.7) * 5 + beside * 0.8) * facing, 1e-9);
}
// Of all points of the sphere the mended one is the nearest to the ray; of all of the tube's axis, eq 19's is nearest to the line.
TEST(PublishedSpecular, PointsAreTheNearest) {
  Random random(44);
  const auto to_line = [](const Vec3d& p, const Vec3d& r) { return length(p - r * dot(p, r)); };
  for (int i = 0; i < 200; ++i) {
    const Vec3d r = random.direction(), a = random.direction() * 3, b = a + random.direction() * random.uniform(0.1, 4);
    const double found = to_line(nearest_sphere({a, b, 0.1}, r).centre, r);
    double nearest = 1e300;
    for (int k = 0; k <= 2000; ++k) nearest = std::min(nearest, to_line(a + (b - a) * (k / 2000.0), r));
    EXPECT_LE(found, nearest + 1e-12);
    EXPECT_GE(found, nearest - 2e-3);
    const Vec3d centre = random.direction() * 3;
    const double radius = random.uniform(0.1, 2), distance = to_line(centre, r);
    EXPECT_NEAR(to_line(closest_to_ray({centre, radius}, r), r), std::max(distance - radius, 0.0), 1e-12);
  }
}
// Picott's is at the smallest angle, where the axis' line has one, ahead of the view; else that is where the angle is largest, and the
// wrong end is nearer to it.
TEST(PublishedSpecular, PicottsPointIsAtTheSmallestAngle) {
  Random random(48);
  int wrong = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3d a = random.direction() * 3, b = a + random.direction() * random.uniform(0.1, 4), r = random.direction();
    if (!(dot(a, r) > 0.1 && dot(b, r) > 0.1)) continue;
    const auto cosine = [&](const Vec3d& p) { return dot(p, r) / length(p); };
    const auto largest_of = [&](double from, double to) {
      double at = from, largest = -1;
      for (int k = 0; k <= 4000; ++k) {
        const double t = from + (to - from) * k / 4000;
        if (const double c = cosine(a + (b - a) * t); c > largest) largest = c, at = t;
      }
      return std::pair{largest, at};
    };
    const double found = cosine(picott_sphere({a, b, 0.1}, r).centre), largest = largest_of(0, 1).first;
    // Sideways of the line at infinity the angle is that of its direction: the smallest one is within reach.
    const double far = largest_of(-300, 300).second;
    if (std::abs(far) < 290) {
      EXPECT_NEAR(found, largest, 1e-5);
    } else if (found < largest - 0.01) {
      ++wrong;
    }
  }
  EXPECT_GT(wrong, 10);
}
// Karis, eq 20: for an axis whose light is gathered in one point there is no alpha' in the notes; what is left out is alpha / alpha'.
TEST(PublishedSpecular, Karis20LeavesTheLengthOut) {
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.01));
  const Emitter tube = white(TubeEmitter{{-1, 0, 4}, {1, 0, 4}, 0.02, Caps::round});
  const double expected = reference(tube, point, {1e-6, 0}).value.x;
  EXPECT_GT(through("karis-20", tube, point), 10 * expected);
  EXPECT_NEAR(through("karis-20-mended", tube, point) / through("karis-20", tube, point), 0.01 / (0.01 + 2 / 12.0), 1e-9);
  EXPECT_LT(through("karis-20-mended", tube, point), 3 * expected);
}
// Drobot, eq 1.20: luminance does not change with the unit of length. As printed it goes with 1 / m2.
TEST(PublishedSpecular, Drobot20PrintsTheAreaBelow) {
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.1));
  const auto at = [](double scale) { return disk(Vec3d{0.03, 0, 1} * scale, {0, 0, -1}, 0.1 * scale); };
  for (const double scale : {0.1, 2.0}) {
    const double one = through("drobot-1-20-mended", at(1), point), other = through("drobot-1-20-mended", at(scale), point);
    EXPECT_NEAR(one, other, 1e-12 * one);
  }
  EXPECT_GT(through("drobot-1-20", at(0.1), point), 10 * through("drobot-1-20", at(1), point));
}
// Drobot, eq 1.23: of two rectangles one of which contains the other the area is the smaller one's; as printed it is 0.
TEST(PublishedSpecular, Drobot23ExchangesItsCorners) {
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.1));
  const Emitter light = square({0, 0, 1}, {0, 0, -1}, 0.01);
  EXPECT_EQ(through("drobot-1-20", light, point), 0);
  EXPECT_NEAR(through("drobot-1-20-mended", light, point), lobe_of(point, {0, 0, 1}) * 1e-4, 1e-8);
}
// Drobot, eq 1.21: a disk well inside the cone is all lit; as printed nothing is left of it.
TEST(PublishedSpecular, Drobot21LacksABracket) {
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.1));
  const Emitter light = disk({1e-6, 0, 1}, {0, 0, -1}, 0.01);
  EXPECT_EQ(through("drobot-1-20", light, point), 0);
  EXPECT_NEAR(through("drobot-1-20-mended", light, point), lobe_of(point, {0, 0, 1}) * pi * 1e-4, 1e-7);
}
// Drobot, eq 1.22: a disk that contains the cone's, on either side of it by next to nothing, gives the same. As printed the place lies on
// the one or on the other side, by half the difference of the radii.
TEST(PublishedSpecular, Drobot22JumpsWhereOneContainsTheOther) {
  const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.3), mirror_lobe(0.1));
  const Vec3d to = mirror_of(0.3), across = cross(to, Vec3d{0, 1, 0});
  const Emitter one = disk(to + across * 1e-9, -to, 0.2), other = disk(to - across * 1e-9, -to, 0.2);
  const double mended = through("drobot-1-20-mended", one, point), printed = through("drobot-1-20", one, point);
  EXPECT_NEAR(through("drobot-1-20-mended", other, point), mended, 1e-6 * mended);
  EXPECT_GT(std::abs(through("drobot-1-20", other, point) - printed), 0.01 * printed);
}
// Drobot, eq 1.21 and 1.22 (Oat 2006): all of the smaller disk, about its centre, where one contains the other; nothing where they touch.
// Between, a smooth step for the lens of two segments: up to .161 of the disk too much where both are alike.
TEST(DiskOverlap, IsTheLensToASixth) {
  for (const double second : {0.2, 0.5, 1.0}) {
    for (int i = 0; i <= 100; ++i) {
      const double apart = 0.013 * i * (1 + second);
      const DiskOverlap overlap = disk_overlap(1, second, apart);
      const double inner = 1 - second, outer = 1 + second;
      double lens = apart <= inner ? 1 : 0;
      if (apart > inner && apart < outer) {
        const double c = (apart * apart + 1 - second * second) / (2 * apart), k = (apart * apart + second * second - 1) / (2 * apart);
        lens =
            (std::acos(c) - c * std::sqrt(1 - c * c) + second * second * std::acos(k / second) - k * std::sqrt(second * second - k * k)) /
            (pi * second * second);
      }
      EXPECT_NEAR(overlap.share, lens, 0.162) << second << ' ' << apart;
      if (apart <= inner) {
        EXPECT_DOUBLE_EQ(overlap.middle, apart);
      }
      if (overlap.share > 0) {
        EXPECT_LE(overlap.middle, 1);
        EXPECT_GE(overlap.middle, 0);
      }
    }
  }
}
// Drobot, eq 1.17 and 1.18: at the edge of the cone the lobe has fallen to 1 / e: (r.l)^g, the printed r.n does not depend on the light.
TEST(Cones, AreWhereTheLobeHasFallen) {
  for (const double alpha : {0.01, 0.1, 0.3, 0.6}) {
    for (const Distribution d : {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong}) {
      const double half = 0.5 * fitted_cone(d, alpha);
      ASSERT_LT(half, 0.5 * pi);
      const Facets facets(d, alpha, alpha);
      EXPECT_NEAR(facets.density({std::sin(half), 0, std::cos(half)}) / facets.density({0, 0, 1}), std::exp(-1), 1e-9)
          << static_cast<int>(d) << " alpha " << alpha;
    }
    SpecularLobe lobe{.distribution = Distribution::phong, .alpha_x = alpha, .alpha_y = alpha, .f0 = {1, 1, 1}};
    const double edge = fitted_cone(Distribution::phong, alpha);
    const Vec3d view = view_of(0.8), r = mirror_of(0.8), light = r * std::cos(edge) + Vec3d{0, 1, 0} * std::sin(edge);
    if (!(light.z > 0)) continue;
    EXPECT_NEAR((brdf_cos(lobe, view, light).x / light.z) / (brdf_cos(lobe, view, r).x / r.z), std::exp(-1), 1e-9);
  }
  // Eq 1.18 fits it: 2 sqrt(2 / (g + 2)) is the whole angle, g Phong's exponent. To the next order in 1 / g.
  for (const double g : {50.0, 1000.0, 1e6}) {
    const double whole = 2 * std::sqrt(2 / (g + 2));
    EXPECT_NEAR(2 * fitted_cone(Distribution::phong, alpha_of_phong(g)), whole, whole / g);
  }
  for (const Distribution d : {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong, Distribution::phong}) {
    double before = 0;
    for (const double alpha : {1e-5, 1e-3, 0.2, 0.7, 0.99, 1.0, 2.0}) {
      const double cone = fitted_cone(d, alpha);
      EXPECT_GE(cone, before);
      EXPECT_LE(cone, pi);
      before = cone;
    }
  }
}
// The pyramid's section by a grid of places, each within it if it is on the inner side of its four planes.
TEST(Cones, PyramidsMeetRectangles) {
  Random random(45);
  int met = 0;
  for (int i = 0; i < 60; ++i) {
    const Placement p = place(Kind::rect, random, true);
    const auto rect = rect_view(std::get<PolygonEmitter>(p.emitter.shape), false, p.position);
    ASSERT_TRUE(rect);
    const Vec3d axis = normalised(rect->at(random.uniform(-1, 1) * rect->half_x, random.uniform(-1, 1) * rect->half_y));
    const Basis b = basis_around(axis);
    const Vec3d x = b.tangent * random.log_uniform(0.05, 5), y = b.bitangent * random.log_uniform(0.05, 5);
    const std::array<Vec3d, 4> rays{axis - x - y, axis + x - y, axis + x + y, axis - x + y};
    constexpr int n = 400;
    int within = 0;
    Vec3d sum;
    for (int s = 0; s < n; ++s) {
      for (int t = 0; t < n; ++t) {
        const Vec3d q = rect->at(((s + 0.5) / n * 2 - 1) * rect->half_x, ((t + 0.5) / n * 2 - 1) * rect->half_y);
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) inside = inside && dot(cross(rays[k], rays[(k + 1) % 4]), q) >= 0;
        if (inside) ++within, sum += q;
      }
    }
    const auto part = pyramid_on(*rect, rays);
    const double expected = rect->area() * within / (n * n);
    ASSERT_TRUE(part);
    EXPECT_NEAR(part->area, expected, 0.02 * rect->area());
    if (within > 2000) {
      ++met;
      EXPECT_LE(length(part->middle - sum / within), 0.01 * std::hypot(rect->half_x, rect->half_y));
    }
  }
  EXPECT_GT(met, 20);
}
// Eden's printed tube falls off twice: ten times as far away it is a hundredth of the mended one once more.
TEST(PublishedSpecular, EdensTubeFallsTwice) {
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.5));
  const auto share = [&](double distance) {
    const Emitter tube = white(TubeEmitter{{-0.01, 0, distance}, {0.01, 0, distance}, 0.001, Caps::round});
    return through("eden-tube", tube, point) / through("eden-tube-mended", tube, point);
  };
  EXPECT_NEAR(share(100) / share(10), 101.0 / 10001, 1e-6);
}
// The light that listing 6 gathers from all over the sun.
TEST(PublishedSpecular, Frostbite6IsNotNormalised) {
  const double radius = 0.00465, lux = pi * std::sin(radius) * std::sin(radius);
  const Emitter sun{DistantEmitter{mirror_of(0.8), {lux, lux, lux}, radius}, {}, false, {}, {}};
  const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.8), mirror_lobe(0.001));
  const double expected = reference(sun, point, {1e-6, 0}).value.x;
  // The peak of the lobe, 1 / (4 pi alpha^2 n.v), times the illuminance.
  EXPECT_NEAR(through("frostbite-6", sun, point), lux / (4 * pi * 1e-6 * 0.8), 1e-3 * lux / 1e-6);
  EXPECT_GT(through("frostbite-6", sun, point), 5 * expected);
}
// Listing 16: seen along the normal both directions are one. For rough surfaces seen from the side it is the light over the normal that
// counts, whatever the view.
TEST(PublishedSpecular, Frostbite16LeansTowardsTheNormal) {
  Random random(46);
  for (int i = 0; i < 50; ++i) {
    const Placement p = place(Kind::disk, random, true);
    const ShadingPoint above = surface(p.position, p.normal, p.normal, mirror_lobe(random.log_uniform(0.01, 1)));
    const double plain = through("frostbite-point", p.emitter, above);
    EXPECT_NEAR(through("frostbite-16", p.emitter, above), plain, 1e-9 * plain);
  }
  const Emitter overhead = ball({0, 0, 4}, 1);
  const ShadingPoint aslant = surface({}, {0, 0, 1}, view_of(0.3), mirror_lobe(1));
  EXPECT_NEAR(through("frostbite-16", overhead, aslant), lobe_of(aslant, {0, 0, 1}) * pi / 16, 1e-9);
}

// ---- Transformed cosines as others take them ----

// A thin tube is its line: against the outline through the matrix, which knows the width.
TEST(OthersLtc, ThinTubesAreLines) {
  Random random(47);
  for (int i = 0; i < 100; ++i) {
    Placement p = place(Kind::capsule, random, true);
    auto& tube = std::get<TubeEmitter>(p.emitter.shape);
    tube.radius = 1e-5 * length(tube.b - tube.a);
    Vec3d view = random.direction();
    if (dot(view, p.normal) < 0) view = -view;
    const ShadingPoint point = surface(p.position, p.normal, view, GgxLobe{random.log_uniform(0.05, 1), {1, 1, 1}});
    // Seen from far off its axis: the outline's area errs by the width, the rounding of its edges by 1e-12 sr.
    const double exact = through("ltc-unclipped", p.emitter, point);
    EXPECT_NEAR(through("ltc-line", p.emitter, point), exact, 2e-3 * exact + 1e-9) << i;
  }
}
// From the axis a short tube shows its end: a disk.
TEST(OthersLtc, FromTheAxisATubeIsItsEnd) {
  const Vec3d to = normalised(Vec3d{-0.3, 0.2, 1});
  const Emitter tube = white(TubeEmitter{to * 10, to * 10.1, 0.05, Caps::round});
  const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.8), mirror_lobe(0.3));
  const double end = through("ltc-unclipped", disk(to * 10, -to, 0.05), point);
  EXPECT_NEAR(through("ltc-line-ends", tube, point), end, 1e-3 * end);
  EXPECT_EQ(through("ltc-line", tube, point), 0);
}
// The rational fit of the edges, 1e-4, where neither polygon nor sphere is cut by the cosine's horizon.
TEST(OthersLtc, WhatNothingCutsNeedsNoSphere) {
  for (const double alpha : {0.05, 0.3, 1.0}) {
    const ShadingPoint point = surface({}, {0, 0, 1}, view_of(0.9), mirror_lobe(alpha));
    const Emitter light = square(mirror_of(0.9), -mirror_of(0.9), 0.1);
    const double exact = through("ltc-unclipped", light, point);
    EXPECT_NEAR(through("ltc-sphere", light, point), exact, 2e-4 * exact);
  }
}
// At its nodes the four-term table is ours; between them it is not.
TEST(OthersLtc, FourTermsAreOursAtTheirNodes) {
  for (const int row : {5, 20, 60}) {
    for (const int column : {0, 10, 40, 60}) {
      const double root = row / 63.0, alpha = root * root, cosine = std::cos(0.5 * pi * column / 63);
      for (const Vec3d& light : {mirror_of(cosine), Vec3d{0, 0, 1}, normalised(mirror_of(cosine) + Vec3d{0, alpha, 0})}) {
        const double ours = ltc_table().at(alpha, cosine).whole.density(light);
        EXPECT_NEAR(four_term_cosine(alpha, cosine).density(light), ours, 1e-6 * ours + 1e-12);
      }
    }
  }
  // Half way between two nodes in each direction, for a lobe narrower than a step of the view's angle.
  const double root = 4.5 / 63, alpha = root * root, cosine = std::cos(0.5 * pi * 40.5 / 63);
  const double ours = ltc_table().at(alpha, cosine).whole.density(mirror_of(cosine));
  EXPECT_GT(std::abs(four_term_cosine(alpha, cosine).density(mirror_of(cosine)) / ours - 1), 0.01);
}

// ---- Everywhere ----

TEST(PublishedSpecular, TakesWhatItSays) {
  const ShadingPoint ggx = surface({}, {0, 0, 1}, {0, 0, 1}, mirror_lobe(0.1));
  SpecularLobe lobe{.distribution = Distribution::phong};
  const ShadingPoint phong = surface({}, {0, 0, 1}, {0, 0, 1}, lobe);
  lobe = {.alpha_x = 0.1, .alpha_y = 0.2};
  const ShadingPoint stretched = surface({}, {0, 0, 1}, {0, 0, 1}, lobe);
  const Emitter light = square({0, 0, 1}, {0, 0, -1}, 1);
  EXPECT_TRUE(taken("drobot-1-20-mended", light, phong));
  EXPECT_TRUE(taken("punctual", light, phong));
  EXPECT_FALSE(taken("frostbite-point", light, phong));
  EXPECT_TRUE(taken("frostbite-point", light, surface({}, {0, 0, 1}, {0, 0, 1}, GgxLobe{.masking = Masking::schlick_direct})));
  EXPECT_FALSE(taken("karis-14", light, ggx));
  EXPECT_FALSE(taken("eden-rect", ball({0, 0, 2}, 1), ggx));
  for (const SpecularMethod& method : specular_methods()) {
    EXPECT_FALSE(method.luminance(light, stretched)) << method.name;
    EXPECT_FALSE(method.luminance(light, surface({}, {0, 0, 1}, {0, 0, 1}, Lambert{}))) << method.name;
    EXPECT_FALSE(method.luminance(white(PunctualEmitter{{0, 0, 1}, {}, {1, 1, 1}, PointShape{}}), ggx)) << method.name;
    EXPECT_FALSE(method.source.empty() || method.note.empty()) << method.name;
    const SpecularMethod* found = find_specular_method(method.name);
    EXPECT_EQ(found, &method) << method.name << ": another method has the name";
  }
}

// Inside, on edges and axes, coplanar, without size, behind, below both horizons, view along the normal and all but along the surface.
TEST(PublishedSpecular, AnswersAreFiniteEverywhere) {
  std::vector<Emitter> lights;
  for (const Vec3d& at : {Vec3d{0, 0, 1}, Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0.3, 0.2, 1e-9}, Vec3d{1e9, 0, 1e9}}) {
    for (const double size : {0.0, 1e-12, 0.5, 1.0, 1e6}) {
      lights.push_back(ball(at, size));
      for (const Vec3d& n : {Vec3d{0, 0, -1}, Vec3d{1, 0, 0}, Vec3d{0, 0.6, -0.8}}) {
        lights.push_back(square(at, n, size));
        lights.push_back(disk(at, n, size));
        lights.back().two_sided = true;
        lights.push_back(white(TubeEmitter{at - n * size, at + n * size, 0.1 * size, Caps::round}));
        lights.push_back(white(TubeEmitter{at, at + n, size, Caps::round}));
      }
    }
  }
  for (const double radius : {1e-9, 0.005, 1.5})
    for (const Vec3d& to : {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0.6, 0, -0.8}})
      lights.push_back({DistantEmitter{to, {1, 1, 1}, radius}, {}, false, {}, {}});
  for (const Emitter& light : lights) {
    for (const Vec3d& view : {Vec3d{0, 0, 1}, view_of(0.5), view_of(1e-4), view_of(-0.5)}) {
      for (const double alpha : {0.0, 1e-4, 0.3, 1.0}) {
        for (const Distribution d : {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong, Distribution::phong}) {
          const SpecularLobe lobe{.distribution = d, .alpha_x = alpha, .alpha_y = alpha};
          const ShadingPoint point = surface({}, {0, 0, 1}, view, lobe);
          for (const SpecularMethod& method : specular_methods()) {
            const auto value = method.luminance(light, point);
            if (!value) continue;
            EXPECT_TRUE(std::isfinite(value->x) && value->x >= 0) << method.name << ' ' << value->x << " alpha " << alpha;
            if (view.z < 0) {
              EXPECT_EQ(value->x, 0) << method.name;
            }
          }
        }
      }
    }
  }
}

}  // namespace
