#include "etendue/light_units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace etendue {
namespace {

constexpr long double pi_l = 3.14159265358979323846264338327950288L;

// The distance of x from the truth in units of the last place of a double near the truth.
double ulps(double x, long double truth) {
  const double near = static_cast<double>(truth);
  return static_cast<double>(std::fabs(x - truth) / (std::nextafter(std::fabs(near), HUGE_VAL) - std::fabs(near)));
}
double relative(double x, long double truth) { return static_cast<double>(std::fabs(x / truth - 1)); }

// Gauss' rule of five points on n panels: error O(panel^10) for smooth integrands.
double integral(const std::function<double(double)>& f, double from, double to, int n) {
  constexpr double node[] = {0, 0.53846931010568309104, 0.90617984593866399280};
  constexpr double weight[] = {0.56888888888888888889, 0.47862867049936646804, 0.23692688505618908751};
  double sum = 0;
  const double half = (to - from) / n / 2;
  for (int i = 0; i < n; ++i) {
    const double middle = from + (2 * i + 1) * half;
    sum += weight[0] * f(middle);
    for (int k = 1; k < 3; ++k) sum += weight[k] * (f(middle - half * node[k]) + f(middle + half * node[k]));
  }
  return sum * half;
}

// ---- Known facts ----

TEST(LightUnits, SphereOf1500Lumens) {
  EXPECT_NEAR(luminance(lumens(1500), SphereShape{.radius = 0.15})->si, 1688.69, 0.005);
  EXPECT_NEAR(exitance(lumens(1500), SphereShape{.radius = 0.15})->si, 1500 / (4 * pi * 0.15 * 0.15), 1e-11);
}

// E14: the caption of table 12 prints 1688, which cuts 1688.69 off instead of rounding it.
TEST(Errata, E14SphereIsTruncated) {
  const double ours = luminance(lumens(1500), SphereShape{.radius = 0.15})->si;
  EXPECT_EQ(std::trunc(ours), 1688);
  EXPECT_EQ(std::round(ours), 1689);
}

// Frostbite's table 10, its in-game rows: E = Phi / (4 pi d^2). It cuts off decimals (4973.59, 16441.63), hence within 1 lx.
TEST(LightUnits, BulbsOfTable10) {
  const double distance_m[] = {1, 0.5, 0.25, 0.1, 0.055};
  const std::pair<double, std::array<double, 5>> rows[] = {{625, {50, 199, 796, 4973, 16441}}, {1200, {95, 382, 1528, 9549, 31568}}};
  for (const auto& [flux_lm, printed] : rows)
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(illuminance(lumens(flux_lm), PointShape{}, metres(distance_m[i]))->si, printed[i], 1);
}

// Table 12, each row by its own formula.
TEST(LightUnits, AreaLightsOfTable12) {
  EXPECT_NEAR(luminance(lumens(800), SphereShape{0.2})->si, 800 / (4 * 0.04 * pi * pi), 1e-11);
  EXPECT_NEAR(luminance(lumens(800), DiskShape{0.2})->si, 800 / (0.04 * pi * pi), 1e-11);
  EXPECT_NEAR(luminance(lumens(800), TubeShape{1.2, 0.02})->si, 800 / ((2 * pi * 0.02 * 1.2 + 4 * pi * 0.0004) * pi), 1e-11);
  EXPECT_NEAR(luminance(lumens(800), RectShape{1.2, 0.3})->si, 800 / (0.36 * pi), 1e-11);
}

// Eq 38 and 39: with the same flux a sphere lights a surface as a point does, whatever its size, and a disk of any size far away as a small
// one. Exact for the sphere; the disk's (r/d)^2 is what eq 39 leaves out.
TEST(LightUnits, SizeDoesNotChangeTheIlluminanceOfASphere) {
  const double point = illuminance(lumens(1500), PointShape{}, metres(3))->si;
  for (const double radius : {1e-4, 0.01, 0.15, 1.0, 2.9})
    EXPECT_NEAR(illuminance(lumens(1500), SphereShape{radius}, metres(3))->si / point, 1, 1e-15) << radius;
  const double small = illuminance(lumens(1500), DiskShape{1e-6}, metres(3))->si;
  for (const double radius : {1e-4, 0.01, 0.15})
    EXPECT_NEAR(illuminance(lumens(1500), DiskShape{radius}, metres(3))->si / small, 1, radius * radius / 9 + 1e-12) << radius;
}

// A white diffuse surface under pi lux shows 1 cd/m2, and so a surface its albedo: L = albedo E / pi. The sun's disk gives back its lux as
// L pi sin^2 of its angular radius.
TEST(LightUnits, SunOfPiLuxShowsTheAlbedo) {
  const DistantShape sun{degrees(0.53).si};
  const Luminance disk = *luminance(lux(pi), sun);
  const double albedo = 0.18, reflected = albedo / pi * illuminance(disk, sun)->si;
  EXPECT_NEAR(reflected, albedo, 1e-15);
  EXPECT_NEAR(disk.si * pi * std::pow(std::sin(sun.diameter_rad / 2), 2), pi, 1e-14);
}

// The facts of a radiometer's shop: a cone of 120 degrees is pi, a hemisphere 2 pi, a face of a cube a sixth of the sphere.
TEST(SolidAngle, KnownCones) {
  EXPECT_NEAR(solid_angle_of_cone(degrees(120))->si, pi, 4e-16 * pi);
  EXPECT_NEAR(solid_angle_of_cone(degrees(180))->si, 2 * pi, 4e-16 * 2 * pi);
  EXPECT_NEAR(solid_angle_of_cone(degrees(360))->si, 4 * pi, 4e-16 * 4 * pi);
  EXPECT_NEAR(solid_angle(FrustumShape{pi / 2, pi / 2})->si, 4 * pi / 6, 4e-16 * 2);
}

// "1000 lm through 60 degrees" by everyone's convention.
TEST(SolidAngle, SpotConventions) {
  const double half = degrees(30).si;
  const auto cd = [&](FluxConvention convention) { return intensity(lumens(1000), SpotShape{0, half}, {.spot_flux = convention})->si; };
  EXPECT_NEAR(cd(FluxConvention::isotropic), 79.6, 0.05);
  EXPECT_NEAR(cd(FluxConvention::frostbite_pi), 318.3, 0.05);
  EXPECT_NEAR(cd(FluxConvention::cone), 1188, 0.5);
  EXPECT_NEAR(cd(FluxConvention::falloff), 3564, 0.5);
  EXPECT_NEAR(intensity(lumens(1000), SpotShape{0, half}, {.spot_falloff = SpotFalloff::smoothstep})->si, 2 * 1188, 1);
  // The cone alone overstates the flux of glTF's falloff with its default of 0 for the inner angle by exactly 3.
  EXPECT_NEAR(cd(FluxConvention::falloff) / cd(FluxConvention::cone), 3, 1e-15);
}

// ---- Errata of Frostbite 3.0 that are formulas of lights ----

// E6: eq 15 integrates I dtheta dphi without sin(theta): 2 pi^2 = 19.74 I as it stands, not its own result 4 pi I.
TEST(Errata, E6FluxOfAPointNeedsTheSine) {
  const double printed = integral([](double) { return 2 * pi; }, 0, pi, 4);
  const double right = integral([](double t) { return 2 * pi * std::sin(t); }, 0, pi, 16);
  EXPECT_NEAR(printed, 19.74, 5e-3);
  EXPECT_NEAR(printed / right, 1.571, 5e-4);
  EXPECT_NEAR(flux(candelas(1), PointShape{})->si, right, 1e-13);
}
// E7: eq 16 has neither the sine nor the half of its full angle in the limit: 6.58 I for 60 degrees, where its own result, the cone, is
// .842 I. And the full angle may go beyond pi, to 2 pi.
TEST(Errata, E7FluxOfASpotNeedsTheSineAndTheHalfAngle) {
  const double outer = degrees(60).si;
  const double printed = integral([](double) { return 2 * pi; }, 0, outer, 4);
  const double right = integral([](double t) { return 2 * pi * std::sin(t); }, 0, outer / 2, 16);
  EXPECT_NEAR(printed, 6.58, 5e-3);
  EXPECT_NEAR(right, 0.842, 5e-4);
  EXPECT_NEAR(flux(candelas(1), SpotShape{outer / 2, outer / 2})->si, right, 1e-15);
  EXPECT_NEAR(flux(candelas(1), SpotShape{pi, pi})->si, flux(candelas(1), PointShape{})->si, 1e-14);
}
// E8: eq 24 and 25 subtract a threshold 1/r^2 that knows nothing of I. At d = r a light of 100 cd keeps 1.0 lx of its 1.0 lx, only one of
// 1 cd reaches 0; near the light 100 cd give 101 lx at 1 m. Scaled by I it would do what the text says.
TEST(Errata, E8ThresholdOfTheWindowNeedsTheIntensity) {
  const auto printed = [](double cd, double d, double r) { return (cd / (d * d) - 1 / (r * r)) / (1 - 1 / (r * r)); };
  const auto scaled = [&](double cd, double d, double r) { return cd * printed(1, d, r); };
  EXPECT_NEAR(printed(100, 10, 10), 1.0, 1e-12);
  EXPECT_NEAR(illuminance(candelas(100), PointShape{}, metres(10))->si, 1.0, 1e-15);
  EXPECT_NEAR(printed(1, 10, 10), 0, 1e-15);
  EXPECT_NEAR(printed(100, 1, 10), 101, 1e-12);
  EXPECT_NEAR(scaled(100, 10, 10), 0, 1e-15);
  EXPECT_NEAR(scaled(100, 1, 10), 100, 1e-12);
}
// E9: eq 18 writes L_in <n.l> for the illuminance of a point light, which has no luminance: cd/m2 and lx differ by a solid angle. Here
// that does not compile; a sphere, which has one, shows that its luminance is not its illuminance: that depends on its size.
TEST(Errata, E9IlluminanceIsNotLuminance) {
  static_assert(!Knows<PointShape, Luminance> && Knows<PointShape, IlluminanceAt>);
  for (const double radius : {0.01, 0.1}) {
    const Luminance l = *luminance(lumens(1500), SphereShape{radius});
    EXPECT_NEAR(illuminance(lumens(1500), SphereShape{radius}, metres(1))->si / l.si, pi * radius * radius, 1e-17);
  }
}

// ---- Accuracy ----

// Linear conversions round once: within 1 ulp, half of what is promised. The oracle is an 80-bit long double.
TEST(Accuracy, LinearConversionsAreWithinTwoUlp) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-12, 12), size_exponent(-4, 2);
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = std::exp(exponent(random)), r = std::exp(size_exponent(random)), w = std::exp(size_exponent(random));
    const double d = r * (1 + std::exp(exponent(random)));
    const long double xl = x, rl = r, wl = w, dl = d;
    const long double tube_m2 = 2 * pi_l * rl * wl + 4 * pi_l * rl * rl;
    const std::pair<double, long double> cases[] = {
        {intensity(lumens(x), PointShape{})->si, xl / (4 * pi_l)},
        {flux(candelas(x), PointShape{})->si, xl * (4 * pi_l)},
        {illuminance(lumens(x), PointShape{}, metres(d))->si, xl / (4 * pi_l * dl * dl)},
        {luminance(lumens(x), SphereShape{r})->si, xl / (4 * pi_l * pi_l * rl * rl)},
        {flux(nits(x), SphereShape{r})->si, xl * 4 * pi_l * pi_l * rl * rl},
        {intensity(lumens(x), SphereShape{r})->si, xl / (4 * pi_l)},
        {illuminance(nits(x), SphereShape{r}, metres(d))->si, xl * pi_l * (rl / dl) * (rl / dl)},
        {luminance(lumens(x), DiskShape{r})->si, xl / (pi_l * pi_l * rl * rl)},
        {illuminance(lumens(x), DiskShape{r}, metres(d))->si, xl / pi_l / (rl * rl + dl * dl)},
        {luminance(lumens(x), RectShape{w, r})->si, xl / (pi_l * wl * rl)},
        {luminance(lumens(x), TubeShape{w, r})->si, xl / (pi_l * tube_m2)},
        {luminance(candelas(x), TubeShape{w, r})->si, xl / (2 * rl * wl + pi_l * rl * rl)},
        {luminance(lumens(x), SurfaceOfArea{w}, {.two_sided = true})->si, xl / (2 * pi_l * wl)},
        {intensity(lumens(x), LineShape{w})->si, xl / (pi_l * pi_l)},
        {exitance(nits(x), SphereShape{r})->si, xl * pi_l},
        {luminance(lux(x), EnvironmentShape{})->si, xl / pi_l},
    };
    for (const auto& [ours, truth] : cases) most = std::max(most, ulps(ours, truth));
  }
  EXPECT_LE(most, 1);
  RecordProperty("most_ulp", std::to_string(most));
}

TEST(Accuracy, RoundTripsAreWithinFourUlp) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-12, 12);
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = std::exp(exponent(random)), r = std::exp(exponent(random) / 4);
    most = std::max(most, ulps(flux(*luminance(lumens(x), SphereShape{r}), SphereShape{r})->si, x));
    most = std::max(most, ulps(flux(*intensity(lumens(x), PointShape{}), PointShape{})->si, x));
    most = std::max(most, ulps(flux(*luminance(lumens(x), TubeShape{1, r}), TubeShape{1, r})->si, x));
  }
  EXPECT_LE(most, 4);
}

// The angle is what the double says: the oracle starts from the same radians.
TEST(Accuracy, SolidAnglesAreWithin1e15) {
  double most = 0;
  for (double exponent = -6; exponent <= std::log10(360); exponent += 0.001) {
    const double full = degrees(std::pow(10, exponent)).si;
    const long double s = std::sin(static_cast<long double>(full) / 4);
    most = std::max(most, relative(solid_angle_of_cone(radians(full))->si, 4 * pi_l * s * s));
    const SpotShape spot{0.3 * full / 2, full / 2};
    const long double i = std::sin(static_cast<long double>(spot.inner_rad) / 2), o = s;
    most = std::max(most, relative(solid_angle(spot)->si, 4 * pi_l / 3 * (2 * i * i + o * o)));
    most = std::max(most, relative(solid_angle(spot, {.spot_falloff = SpotFalloff::smoothstep})->si, 2 * pi_l * (i * i + o * o)));
  }
  most = std::max(most, relative(solid_angle_of_cone(degrees(360))->si, 4 * pi_l));
  EXPECT_LE(most, 1e-15);

  // asin loses digits near 180 degrees in long double too, hence the oracle's own atan2 form; quadrature holds that one below.
  double frustum = 0;
  for (double a = 1e-6; a <= 180; a = a < 170 ? a * 1.1 : a + (180 - a) * 0.2 + 1e-7)
    for (double b = 1e-6; b <= 180; b = b < 170 ? b * 1.3 : b + (180 - b) * 0.2 + 1e-7) {
      const FrustumShape f{std::min(degrees(a).si, pi), std::min(degrees(b).si, pi)};
      const long double p = f.width_rad / 2.0L, q = f.height_rad / 2.0L;
      const long double truth = 4 * std::atan2(std::sin(p) * std::sin(q), std::hypot(std::cos(p), std::sin(p) * std::cos(q)));
      frustum = std::max(frustum, relative(solid_angle(f)->si, truth));
    }
  EXPECT_LE(frustum, 1e-15);
}

// The frustum cuts the rectangle +-tan(a/2), +-tan(b/2) out of the plane at distance 1. Over y in closed form, over x numerically.
TEST(Accuracy, FrustumIsTheIntegralOverItsWindow) {
  for (const auto& [a, b] : {std::pair{10.0, 10.0}, {60.0, 40.0}, {150.0, 100.0}}) {
    const double x1 = std::tan(degrees(a).si / 2), y1 = std::tan(degrees(b).si / 2);
    const auto column = [&](double x) { return 2 * y1 / ((1 + x * x) * std::sqrt(1 + x * x + y1 * y1)); };
    EXPECT_NEAR(solid_angle(FrustumShape{degrees(a).si, degrees(b).si})->si / (2 * integral(column, 0, x1, 400)), 1, 1e-13)
        << a << ' ' << b;
  }
}

// The closed forms of all three falloffs against quadrature over the angle, in the middle and in the ring.
TEST(Accuracy, FluxOfShapedSpotsIsTheIntegral) {
  for (const auto& spot : {SpotShape{0.0, 0.05}, {0.0, 0.5}, {0.3, 0.5}, {0.4999, 0.5}, {0.0, 1.5}, {1.0, pi}, {0.5, 0.5}}) {
    const double inner = spot.inner_rad, outer = spot.outer_rad, ci = std::cos(inner), co = std::cos(outer);
    const auto flux_of = [&](const std::function<double(double)>& falloff) {
      const auto ring = [&](double t) {
        // cos t - cos o and cos i - cos o as products of sines: the quadrature is not to lose the digits that it checks.
        const double s = inner == outer ? 1
                                        : std::sin((outer + t) / 2) * std::sin((outer - t) / 2) /
                                              (std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2));
        return 2 * pi * std::sin(t) * falloff(s);
      };
      return integral([](double t) { return 2 * pi * std::sin(t); }, 0, inner, 50) + integral(ring, inner, outer, 200);
    };
    EXPECT_NEAR(solid_angle(spot, {.spot_falloff = SpotFalloff::hard})->si / flux_of([](double) { return 1; }), 1, 1e-12)
        << ci << ' ' << co;
    EXPECT_NEAR(solid_angle(spot)->si / flux_of([](double s) { return s * s; }), 1, 1e-12) << ci << ' ' << co;
    EXPECT_NEAR(solid_angle(spot, {.spot_falloff = SpotFalloff::smoothstep})->si / flux_of([](double s) { return s * s * (3 - 2 * s); }), 1,
                1e-12)
        << ci << ' ' << co;
  }
}

// ---- What compiles ----

static_assert(Knows<SphereShape, Flux> && Knows<SphereShape, Luminance> && Knows<SphereShape, IlluminanceAt>);
static_assert(!Knows<PointShape, Luminance> && !Knows<SpotShape, Exitance> && !Knows<LineShape, Luminance>);
static_assert(!Knows<DistantShape, Flux> && !Knows<DistantShape, IlluminanceAt> && Knows<DistantShape, Illuminance>);
static_assert(!Knows<PointShape, Illuminance> && !Knows<SphereShape, Illuminance>);  // an illuminance without its distance
static_assert(!Knows<SurfaceOfArea, Intensity> && Knows<SurfaceOfArea, Flux>);
static_assert(!LightShape<MeshShape> && !LightShape<PhotometricShape>);  // say SurfaceOfArea, BeamOfSolidAngle

// ---- Properties ----

TEST(LightUnits, TwoSidedSharesTheFlux) {
  const Conventions both{.two_sided = true};
  EXPECT_EQ(luminance(lumens(100), RectShape{1, 2}, both)->si * 2, luminance(lumens(100), RectShape{1, 2})->si);
  EXPECT_EQ(luminance(lumens(100), SphereShape{1}, both)->si, luminance(lumens(100), SphereShape{1})->si) << "its inside is never seen";
}

TEST(LightUnits, BeamHasItsFluxOverAxialIntensity) {
  EXPECT_EQ(intensity(lumens(100), BeamOfSolidAngle{2})->si, 50);
  EXPECT_EQ(illuminance(lumens(100), BeamOfSolidAngle{2}, metres(5))->si, 2);
}

// "15 klx at 2 m" of a small light, and at other distances.
TEST(LightUnits, IlluminanceAtADistance) {
  EXPECT_EQ(intensity(lux(15000) | at(metres(2)), PointShape{})->si, 60000);
  EXPECT_EQ(illuminance(lux(15000) | at(metres(2)), PointShape{}, metres(4))->si, 3750);
  EXPECT_EQ(illuminance(lux(15000) | at(metres(2)), PointShape{}, metres(2))->si, 15000);
}

// A tube without length is a sphere.
TEST(LightUnits, TubesEndAsSpheres) {
  EXPECT_NEAR(luminance(lumens(5), TubeShape{0, 0.2})->si / luminance(lumens(5), SphereShape{0.2})->si, 1, 1e-15);
  EXPECT_NEAR(luminance(candelas(5), TubeShape{0, 0.2})->si / luminance(candelas(5), SphereShape{0.2})->si, 1, 1e-15);
}

TEST(RadiantTwins, AreTheEfficacyApart) {
  EXPECT_EQ(photometric(watts(60), lumens_per_watt(15))->si, 900);
  EXPECT_EQ(radiometric(lumens(900), lumens_per_watt(15))->si, 60);
  static_assert(std::same_as<decltype(photometric(watts_per_square_metre(1), lumens_per_watt(1))), Result<Illuminance>>);
  static_assert(std::same_as<decltype(radiometric(nits(1), lumens_per_watt(1))), Result<Radiance>>);
  for (const double bad : {0.0, -15.0, HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(photometric(watts(60), lumens_per_watt(bad)).error().code, "NUMBER_INVALID") << bad;
    EXPECT_EQ(radiometric(lumens(60), lumens_per_watt(bad)).error().code, "NUMBER_INVALID") << bad;
  }
}

// ---- Bad sizes, angles and quantities: an error that names the field, the value and what is legal ----

template <class Q>
void expect_error(const Result<Q>& result, const char* code, const char* names, const char* value) {
  ASSERT_FALSE(result.ok()) << names;
  EXPECT_EQ(result.error().code, code) << result.error().text;
  EXPECT_NE(result.error().text.find(names), std::string::npos) << result.error().text;
  EXPECT_NE(result.error().text.find(value), std::string::npos) << result.error().text;
}
TEST(BadLights, AreNamed) {
  const double nan = std::nan("");
  expect_error(luminance(lumens(1), SphereShape{0}), "SIZE_MISSING", "radius", "zero");
  expect_error(luminance(lumens(1), SphereShape{-1}), "NUMBER_INVALID", "radius in metres above 0", "-1");
  expect_error(luminance(lumens(1), RectShape{1, nan}), "NUMBER_INVALID", "height", "nan");
  expect_error(luminance(lumens(1), SurfaceOfArea{0}), "SIZE_MISSING", "area", "zero");
  expect_error(luminance(lumens(1), PolygonShape{{{0, 0}, {1, 1}}}), "SIZE_MISSING", "area", "zero");
  expect_error(intensity(lumens(1), SpotShape{0, 0}), "SIZE_MISSING", "opening angle", "infinite");
  expect_error(intensity(lumens(1), SpotShape{0, -0.5}), "NUMBER_INVALID", "outer half angle from 0 to 180", "-28.6");
  expect_error(intensity(lumens(1), SpotShape{0, 60}), "NUMBER_INVALID", "outer half angle", "3437.75");  // degrees taken for radians
  expect_error(intensity(lumens(1), SpotShape{0.6, 0.5}), "NUMBER_INVALID", "inner half angle", "34.3775");
  EXPECT_TRUE(intensity(lumens(1), SpotShape{0.5, 0.5}).ok()) << "a hard edge";
  expect_error(solid_angle_of_cone(degrees(361)), "NUMBER_INVALID", "outer half angle", "180.5");
  expect_error(solid_angle(FrustumShape{1, 4}), "NUMBER_INVALID", "height angle", "229.183");
  expect_error(luminance(lux(1), DistantShape{0}), "SIZE_MISSING", "angular diameter", "infinite");
  expect_error(illuminance(lumens(1), SphereShape{1}, metres(0.5)), "NUMBER_INVALID", "distance greater than 1 m", "0.5");
  expect_error(illuminance(lumens(1), PointShape{}, metres(0)), "NUMBER_INVALID", "distance greater than 0 m", "0 m");
  expect_error(intensity(lumens(-1), PointShape{}), "NUMBER_INVALID", "luminous flux", "-1 lm");
  expect_error(intensity(lumens(nan), PointShape{}), "NUMBER_INVALID", "luminous flux", "nan");
  expect_error(luminance(lumens(1e300), SphereShape{1e-100}), "NUMBER_INVALID", "luminance", "range");
  expect_error(luminance(lumens(1), SphereShape{1e-200}), "NUMBER_INVALID", "sizes", "range");
  expect_error(luminance(lumens(1), SphereShape{1e200}), "NUMBER_INVALID", "sizes", "range");
}

}  // namespace
}  // namespace etendue
