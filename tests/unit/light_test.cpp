#include "etendue/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace etendue {
namespace {

using Given = Emission::Given;
using Kind = Resolved::Kind;

Light light_of(Shape shape, Given given, double value) {
  Light light;
  light.name = "test";
  light.shape = std::move(shape);
  light.emission.given = given;
  light.emission.value = value;
  return light;
}
double value_of(const Light& light, double mesh_area = 0) {
  const Result<Resolved> r = resolve(light, mesh_area);
  EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().text);
  return r.ok() ? luminance_of(r->rgb) : -1;
}
std::string code_of(const Light& light, double mesh_area = 0) {
  const Result<Resolved> r = resolve(light, mesh_area);
  return r.ok() ? "ok" : r.error().code;
}
// Midpoint rule: error O(n^-2) for the integrands here.
double integral(const std::function<double(double)>& f, double from, double to, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f(from + (to - from) * (i + 0.5) / n);
  return sum * (to - from) / n;
}

// ---- Known facts ----

TEST(Resolve, SphereOf1500Lumens) {
  const Result<Resolved> r = resolve(light_of(SphereShape{0.15}, Given::flux, 1500));
  ASSERT_TRUE(r.ok());
  EXPECT_EQ(r->kind, Kind::luminance);
  EXPECT_NEAR(luminance_of(r->rgb), 1688.686, 5e-4);
  EXPECT_NEAR(r->flux_lm, 1500, 1e-11);
  EXPECT_NEAR(r->area_m2, 4 * pi * 0.15 * 0.15, 1e-16);
}

// Fluorescent tube T8-like: capsule of 13 mm radius, 1.2 m between the centres of the caps, 1000 lm.
TEST(Resolve, TubeOf1000Lumens) {
  EXPECT_NEAR(value_of(light_of(TubeShape{1.2, 0.013, Caps::round}, Given::flux, 1000)), 3178.6, 0.05);
  EXPECT_NEAR(*emitting_area(light_of(TubeShape{1.2, 0.013, Caps::round}, Given::flux, 0)), 0.100142, 1e-6);
}

TEST(Resolve, SpotOf1000LumensByConvention) {
  const double half = 30 * pi / 180;
  const auto intensity = [&](double inner, FluxConvention convention) {
    Light light = light_of(SpotShape{inner, half}, Given::flux, 1000);
    light.flux_convention = convention;
    return value_of(light);
  };
  EXPECT_NEAR(intensity(0, FluxConvention::isotropic), 79.6, 0.05);
  EXPECT_NEAR(intensity(0, FluxConvention::frostbite_pi), 318.3, 0.05);
  EXPECT_NEAR(intensity(0, FluxConvention::cone), 1188, 0.5);
  EXPECT_NEAR(intensity(0, FluxConvention::falloff), 3564, 0.5);
  EXPECT_NEAR(intensity(half, FluxConvention::falloff), intensity(half, FluxConvention::cone), 1e-10) << "hard edge: the cone";
}

TEST(Resolve, SunFromItsIlluminance) {
  const double diameter = 2 * 0.2666 * pi / 180;
  const Result<Resolved> disk = resolve(light_of(DistantShape{diameter}, Given::illuminance, 125400));
  ASSERT_TRUE(disk.ok());
  EXPECT_EQ(disk->kind, Kind::luminance);
  EXPECT_NEAR(luminance_of(disk->rgb), 1.844e9, 2e6) << "a 5772 K black body";
  const Result<Resolved> direction = resolve(light_of(DistantShape{0}, Given::illuminance, 125400));
  EXPECT_EQ(direction->kind, Kind::illuminance);
  EXPECT_NEAR(luminance_of(direction->rgb), 125400, 1e-9);
  EXPECT_EQ(code_of(light_of(DistantShape{0}, Given::luminance, 1e9)), "SIZE_MISSING");
  EXPECT_NEAR(value_of(light_of(DistantShape{diameter}, Given::luminance, 1.6e9)), 1.6e9, 1e-3);
}

// ---- Closed forms against integrals ----

TEST(SolidAngle, SpotFluxIsTheIntegralOverItsFalloff) {
  for (const auto& [inner, outer] : {std::pair{0.0, 0.5}, {0.3, 0.5}, {0.5, 0.5000001}, {0.0, pi / 2}, {1.0, pi / 2}}) {
    const double ci = std::cos(inner), co = std::cos(outer);
    const auto ring = [&](double t) {
      const double s = std::clamp((std::cos(t) - co) / (ci - co), 0.0, 1.0);
      return 2 * pi * std::sin(t) * s * s;
    };
    const double numeric = integral(ring, 0, inner, 20000) + integral(ring, inner, outer, 20000);
    EXPECT_NEAR(solid_angle_of(SpotShape{inner, outer}, FluxConvention::falloff) / numeric, 1, 1e-8) << inner << ' ' << outer;
  }
}

// pi a^2 [1/2 (i/a)^2 + ...]: for small angles 2 pi (i^2/2 + (o^2 - i^2)/6), also where 1 - cos has lost every digit.
TEST(SolidAngle, KeepsItsDigitsForNarrowBeams) {
  for (const double o : {1e-3, 1e-6, 1e-9}) {
    const double i = o / 2;
    EXPECT_NEAR(solid_angle_of(SpotShape{i, o}, FluxConvention::falloff) / (2 * pi * (i * i / 2 + (o * o - i * i) / 6)), 1, o * o + 1e-15);
    EXPECT_NEAR(solid_angle_of(SpotShape{i, o}, FluxConvention::cone) / (pi * o * o), 1, o * o + 1e-15);
  }
  EXPECT_NEAR(solid_angle_of(SpotShape{0, pi / 2}, FluxConvention::cone), 2 * pi, 4e-15);
}

// A frustum cuts the rectangle +-tan(a/2), +-tan(b/2) out of the plane at distance 1: integral of dx dy / (1 + x^2 + y^2)^(3/2).
TEST(SolidAngle, FrustumIsTheIntegralOverItsWindow) {
  for (const auto& [a, b] : {std::pair{0.2, 0.2}, {1.0, 0.4}, {2.6, 1.7}}) {
    const double x1 = std::tan(a / 2), y1 = std::tan(b / 2);
    const auto row = [&](double y) { return integral([&](double x) { return std::pow(1 + x * x + y * y, -1.5); }, -x1, x1, 600); };
    EXPECT_NEAR(solid_angle_of(FrustumShape{a, b}) / integral(row, -y1, y1, 600), 1, 2e-5) << a << ' ' << b;
  }
  EXPECT_NEAR(solid_angle_of(FrustumShape{pi, pi}), 2 * pi, 1e-15);
  EXPECT_NEAR(solid_angle_of(FrustumShape{pi / 2, pi / 2}), 4 * pi / 6, 1e-15) << "a face of the cube";
}

// A light of 1 cd/m2, or 1 cd for lines: its facing illuminance at `d` over its surface, sum of cos cos / s^2 dA of what faces the point.
struct Patch {
  Vec3d position, normal;
  double area;
};
double illuminance_from(const std::vector<Patch>& patches, double d) {
  const Vec3d point{0, 0, -d};
  double sum = 0;
  for (const Patch& p : patches) {
    const Vec3d to_patch = p.position - point;
    const double s2 = dot(to_patch, to_patch);
    sum += std::max(0.0, -dot(to_patch, p.normal)) * std::max(0.0, to_patch.z) / (s2 * s2) * p.area;
  }
  return sum;
}
void add_sphere(std::vector<Patch>& patches, double x, double radius, int n, bool right, bool left) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double c = -1 + 2 * (i + 0.5) / n, s = std::sqrt(1 - c * c), f = 2 * pi * (j + 0.5) / (2 * n);
      const Vec3d normal{c, s * std::cos(f), s * std::sin(f)};
      if ((c > 0 && right) || (c < 0 && left))
        patches.push_back({Vec3d{x, 0, 0} + normal * radius, normal, 2 * pi * radius * radius / (n * n)});
    }
}
std::vector<Patch> patches_of(const TubeShape& tube, int n) {
  std::vector<Patch> patches;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double f = 2 * pi * (j + 0.5) / n;
      const Vec3d normal{0, std::cos(f), std::sin(f)};
      patches.push_back(
          {Vec3d{tube.length * ((i + 0.5) / n - 0.5), 0, 0} + normal * tube.radius, normal, 2 * pi * tube.radius * tube.length / (n * n)});
    }
  if (tube.caps == Caps::round) {
    add_sphere(patches, tube.length / 2, tube.radius, n, true, false);
    add_sphere(patches, -tube.length / 2, tube.radius, n, false, true);
  }
  return patches;
}
// Illuminance of a light of luminance 1, from the luminance that an illuminance of 1 lx needs.
double facing_illuminance(Shape shape, double d) {
  Light light = light_of(std::move(shape), Given::illuminance, 1);
  light.emission.distance_m = d;
  return 1 / value_of(light);
}

TEST(Illuminance, OfSpheresTubesAndDisksIsTheIntegralOverTheirSurface) {
  std::vector<Patch> sphere;
  add_sphere(sphere, 0, 0.5, 600, true, true);
  for (const double d : {0.8, 2.0, 10.0}) EXPECT_NEAR(facing_illuminance(SphereShape{0.5}, d) / illuminance_from(sphere, d), 1, 2e-4) << d;
  for (const Caps caps : {Caps::round, Caps::flat, Caps::none})
    for (const double length : {0.3, 2.0}) {
      const TubeShape tube{length, 0.2, caps};
      const std::vector<Patch> patches = patches_of(tube, 600);
      for (const double d : {0.3, 1.0, 5.0})
        EXPECT_NEAR(facing_illuminance(tube, d) / illuminance_from(patches, d), 1, 2e-4)
            << length << ' ' << d << ' ' << static_cast<int>(caps);
    }
  // A disk on its axis: rings of radius a at distance sqrt(a^2 + d^2), both cosines d / that.
  for (const double d : {0.1, 1.0, 10.0}) {
    const auto ring = [&](double a) { return 2 * pi * a * d * d / ((a * a + d * d) * (a * a + d * d)); };
    EXPECT_NEAR(facing_illuminance(DiskShape{0.5}, d) / integral(ring, 0, 0.5, 20000), 1, 1e-6) << d;
  }
}

TEST(Illuminance, OfRectanglesAndPolygonsIsTheIntegralOverTheirSurface) {
  const auto patch = [](double x0, double x1, double y0, double y1, double d) {
    const auto row = [&](double y) { return integral([&](double x) { return d * d / std::pow(x * x + y * y + d * d, 2); }, x0, x1, 800); };
    return integral(row, y0, y1, 800);
  };
  for (const double d : {0.2, 1.0, 6.0}) {
    EXPECT_NEAR(facing_illuminance(RectShape{1.2, 0.6}, d) / patch(-0.6, 0.6, -0.3, 0.3, d), 1, 1e-5) << d;
    // An L beside the axis, in both windings.
    std::vector<Vec2d> ell{{0.1, 0}, {1.1, 0}, {1.1, 0.4}, {0.5, 0.4}, {0.5, 1}, {0.1, 1}};
    const double expected = patch(0.1, 1.1, 0, 0.4, d) + patch(0.1, 0.5, 0.4, 1, d);
    EXPECT_NEAR(facing_illuminance(PolygonShape{ell}, d) / expected, 1, 1e-5) << d;
    std::reverse(ell.begin(), ell.end());
    EXPECT_NEAR(facing_illuminance(PolygonShape{ell}, d) / expected, 1, 1e-5) << d;
  }
}

TEST(Illuminance, OfALineIsTheIntegralAlongIt) {
  for (const double d : {0.1, 1.0, 20.0}) {
    const double length = 1.5;
    const auto element = [&](double x) { return d * d / ((d * d + x * x) * (d * d + x * x)) / length; };
    EXPECT_NEAR(facing_illuminance(LineShape{length}, d) / integral(element, -length / 2, length / 2, 20000), 1, 1e-6) << d;
  }
}

// ---- Properties ----

// From far away every shape is a point: E d^2 is the intensity that the same light is given by. The surface of a tube is up to r nearer
// than its middle: r/d = 1e-5.
TEST(Resolve, FarAwayIlluminanceIsIntensityOverDistanceSquared) {
  const double d = 1e4;
  const Shape shapes[] = {PointShape{},
                          SpotShape{0.1, 0.4},
                          FrustumShape{0.5, 0.7},
                          SphereShape{0.3},
                          DiskShape{0.3},
                          RectShape{0.3, 0.4},
                          LineShape{1.5},
                          PolygonShape{{{0, 0}, {1, 0}, {0, 1}}},
                          TubeShape{1, 0.1, Caps::round},
                          TubeShape{1, 0.1, Caps::flat}};
  for (const Shape& shape : shapes) {
    Light by_illuminance = light_of(shape, Given::illuminance, 5);
    by_illuminance.emission.distance_m = d;
    const Light by_intensity = light_of(shape, Given::intensity, 5 * d * d);
    EXPECT_NEAR(value_of(by_illuminance) / value_of(by_intensity), 1, 1e-5) << name_of(shape);
  }
}

TEST(Resolve, TwoSidedSharesTheFluxBetweenBothSides) {
  Light light = light_of(RectShape{2, 3}, Given::flux, 600);
  const double one_sided = value_of(light);
  EXPECT_NEAR(one_sided, 600 / (pi * 6), 1e-12);
  light.two_sided = true;
  EXPECT_NEAR(value_of(light), one_sided / 2, 1e-12);
  EXPECT_NEAR(resolve(light)->area_m2, 12, 1e-12);
  EXPECT_NEAR(resolve(light)->flux_lm, 600, 1e-9);
  Light ball = light_of(SphereShape{1}, Given::flux, 600);
  const double closed = value_of(ball);
  ball.two_sided = true;
  EXPECT_EQ(value_of(ball), closed) << "the inside is never seen";
}

TEST(Resolve, FluxOfPointFrustumAndLine) {
  EXPECT_NEAR(value_of(light_of(PointShape{}, Given::flux, 4 * pi)), 1, 1e-15);
  EXPECT_NEAR(resolve(light_of(FrustumShape{0.5, 0.7}, Given::flux, 100))->flux_lm, 100, 1e-12);
  // I sin(theta) over the sphere is the flux.
  const double intensity = value_of(light_of(LineShape{2}, Given::flux, 100));
  const double back = integral([&](double t) { return 2 * pi * intensity * std::sin(t) * std::sin(t); }, 0, pi, 1000);
  EXPECT_NEAR(back, 100, 1e-9);
  EXPECT_EQ(resolve(light_of(LineShape{2}, Given::flux, 100))->kind, Kind::line);
}

TEST(Resolve, MeshLightsTakeTheirAreaFromTheCaller) {
  EXPECT_NEAR(value_of(light_of(MeshShape{}, Given::flux, 100), 2), 100 / (2 * pi), 1e-12);
  EXPECT_EQ(code_of(light_of(MeshShape{}, Given::flux, 100)), "SIZE_MISSING");
  EXPECT_EQ(code_of(light_of(MeshShape{}, Given::luminance, 100)), "ok");
  EXPECT_EQ(code_of(light_of(MeshShape{}, Given::intensity, 100), 2), "UNIT_UNSUITABLE");
}

TEST(Resolve, EvIsALuminance) { EXPECT_NEAR(value_of(light_of(DiskShape{1}, Given::ev, 15)), 4096, 1e-9); }

TEST(Resolve, RadiantTwinsNeedAnEfficacy) {
  Light light = light_of(PointShape{}, Given::flux, 10);
  light.emission.radiant = true;
  EXPECT_EQ(code_of(light), "EFFICACY_MISSING");
  light.emission.efficacy_lm_W = 90;
  EXPECT_NEAR(value_of(light), 900 / (4 * pi), 1e-12);
  light.emission.efficacy_lm_W = 0;
  EXPECT_EQ(code_of(light), "NUMBER_INVALID");
}

TEST(Resolve, EnvironmentsAreLuminances) {
  EXPECT_NEAR(value_of(light_of(EnvironmentShape{}, Given::illuminance, pi)), 1, 1e-15) << "E = pi L under a uniform sky";
  EXPECT_NEAR(value_of(light_of(EnvironmentShape{0}, Given::as_file, 0)), 1, 1e-15);
  EXPECT_EQ(code_of(light_of(EnvironmentShape{}, Given::as_file, 0)), "EMISSION_MISSING");
  EXPECT_EQ(code_of(light_of(EnvironmentShape{}, Given::flux, 1)), "UNIT_UNSUITABLE");
}

TEST(Resolve, ColourChangesNoPhotometricValueButTheFilterDoes) {
  Light light = light_of(SphereShape{0.15}, Given::flux, 1500);
  light.colour = TemperatureColour{3000};
  const Result<Resolved> warm = resolve(light);
  ASSERT_TRUE(warm.ok());
  EXPECT_NEAR(luminance_of(warm->rgb), 1688.686, 5e-4);
  EXPECT_GT(warm->rgb.x, warm->rgb.z);
  light.colour = RgbColour{{0.001, 0.001, 0.001}};
  EXPECT_NEAR(value_of(light), 1688.686, 5e-4);
  light.filter = {0, 1, 0};
  const Result<Resolved> green = resolve(light);
  EXPECT_NEAR(green->rgb.y, 1688.686, 5e-4);
  EXPECT_EQ(green->rgb.x, 0);
  EXPECT_NEAR(green->flux_lm, 1500 * 0.7152, 1e-9);
}

// ---- What is missing or unsuitable ----

TEST(Resolve, NamesWhatIsMissing) {
  EXPECT_EQ(code_of(light_of(PointShape{}, Given::luminance, 1)), "UNIT_UNSUITABLE");
  EXPECT_EQ(code_of(light_of(SpotShape{}, Given::ev, 1)), "UNIT_UNSUITABLE");
  EXPECT_EQ(code_of(light_of(LineShape{1}, Given::luminance, 1)), "UNIT_UNSUITABLE");
  EXPECT_EQ(code_of(light_of(DistantShape{}, Given::flux, 1)), "UNIT_UNSUITABLE");
  EXPECT_EQ(code_of(light_of(SphereShape{0}, Given::flux, 1)), "SIZE_MISSING");
  EXPECT_EQ(code_of(light_of(RectShape{1, 0}, Given::luminance, 1)), "SIZE_MISSING");
  EXPECT_EQ(code_of(light_of(SpotShape{0, 0}, Given::flux, 1)), "SIZE_MISSING");
  EXPECT_EQ(code_of(light_of(PointShape{}, Given::illuminance, 1)), "DISTANCE_MISSING");
  EXPECT_EQ(code_of(light_of(TubeShape{1, 0.1}, Given::illuminance, 1)), "DISTANCE_MISSING");
  EXPECT_EQ(code_of(light_of(PointShape{}, Given::as_file, 1)), "EMISSION_MISSING");
  EXPECT_EQ(code_of(light_of(SphereShape{1}, Given::as_file, 1)), "EMISSION_MISSING");
  EXPECT_EQ(code_of(light_of(PointShape{}, Given::flux, -1)), "NUMBER_INVALID");
  EXPECT_EQ(code_of(light_of(PointShape{}, Given::flux, std::nan(""))), "NUMBER_INVALID");
  EXPECT_EQ(code_of(light_of(SphereShape{1e-160}, Given::flux, 1e10)), "NUMBER_INVALID") << "beyond a double";

  Light inside = light_of(SphereShape{1}, Given::illuminance, 1);
  inside.emission.distance_m = 0.5;
  EXPECT_EQ(code_of(inside), "NUMBER_INVALID");
  Light black = light_of(PointShape{}, Given::flux, 1);
  black.colour = RgbColour{{0, 0, 0}};
  EXPECT_EQ(code_of(black), "COLOUR_INVALID");
  black.colour = TemperatureColour{-5};
  EXPECT_EQ(code_of(black), "TEMPERATURE_OUT_OF_RANGE");
  Light filtered = light_of(PointShape{}, Given::flux, 1);
  filtered.filter = {1, -1, 1};
  EXPECT_EQ(code_of(filtered), "COLOUR_INVALID");
}

TEST(Resolve, ErrorsNameTheLightAndItsSource) {
  Light light = light_of(PointShape{}, Given::luminance, 1);
  light.name = "key";
  light.source = "/lights/3";
  const Error error = resolve(light).error();
  EXPECT_NE(error.text.find("\"key\""), std::string::npos);
  EXPECT_EQ(error.where.pointer, "/lights/3");
}

TEST(Shapes, HaveTheNamesOfTheRigFile) {
  EXPECT_STREQ(name_of(Shape{PointShape{}}), "point");
  EXPECT_STREQ(name_of(Shape{PolygonShape{}}), "polygon");
  EXPECT_STREQ(name_of(Shape{EnvironmentShape{}}), "environment");
}

TEST(Area, OfEveryShape) {
  const auto area = [](Shape shape) { return *emitting_area(light_of(std::move(shape), Given::flux, 0)); };
  EXPECT_NEAR(area(DiskShape{2}), 4 * pi, 1e-14);
  EXPECT_NEAR(area(PolygonShape{{{0, 0}, {0, 3}, {4, 0}}}), 6, 1e-14) << "clockwise";
  EXPECT_NEAR(area(TubeShape{2, 1, Caps::none}), 4 * pi, 1e-14);
  EXPECT_NEAR(area(TubeShape{2, 1, Caps::flat}), 6 * pi, 1e-14);
  EXPECT_NEAR(area(TubeShape{2, 1, Caps::round}), 8 * pi, 1e-14);
  EXPECT_EQ(emitting_area(light_of(PointShape{}, Given::flux, 0)).error().code, "UNIT_UNSUITABLE");
}

}  // namespace
}  // namespace etendue
