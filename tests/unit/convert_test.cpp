#include "etendue/convert.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

using D = Dimension;

LightSetup of(Shape shape) {
  LightSetup setup;
  setup.shape = std::move(shape);
  return setup;
}

// The same arithmetic as the typed functions, to the bit.
TEST(Convert, IsTheTypedConversion) {
  for (const double x : {0.0, 1e-7, 1.0 / 3, 1500.0, 1.6e9}) {
    EXPECT_EQ(*convert({D::luminous_flux, x}, D::luminance, of(SphereShape{0.15})), luminance(lumens(x), SphereShape{0.15})->si);
    EXPECT_EQ(*convert({D::luminance, x}, D::luminous_flux, of(TubeShape{1.2, 0.013})), flux(nits(x), TubeShape{1.2, 0.013})->si);
    EXPECT_EQ(*convert({D::luminous_flux, x}, D::luminous_intensity, of(SpotShape{0.1, 0.5})),
              intensity(lumens(x), SpotShape{0.1, 0.5})->si);
    LightSetup bulb = of(PointShape{});
    bulb.given_distance_m = 2;
    bulb.wanted_distance_m = 3;
    EXPECT_EQ(*convert({D::illuminance, x}, D::illuminance, bulb), illuminance(lux(x) | at(metres(2)), PointShape{}, metres(3))->si);
  }
}

// Every shape's inverse undoes it, through each pair of quantities that it knows.
TEST(Convert, GoesBothWays) {
  const Shape shapes[] = {PointShape{},
                          SpotShape{0.1, 0.4},
                          FrustumShape{0.5, 0.7},
                          SphereShape{0.3},
                          DiskShape{0.3},
                          RectShape{0.3, 0.4},
                          PolygonShape{{{0, 0}, {1, 0}, {0, 1}}},
                          TubeShape{1, 0.1, Caps::round},
                          TubeShape{1, 0.1, Caps::flat},
                          TubeShape{1, 0.1, Caps::none},
                          LineShape{1.5},
                          MeshShape{},
                          PhotometricShape{},
                          DistantShape{0.01},
                          EnvironmentShape{}};
  const Dimension all[] = {D::luminous_flux, D::luminous_intensity, D::luminance, D::illuminance, D::luminous_exitance,
                           D::radiant_flux,  D::radiant_intensity,  D::radiance,  D::irradiance,  D::exposure_value};
  int pairs = 0;
  for (const Shape& shape : shapes) {
    LightSetup setup = of(shape);
    setup.given_distance_m = setup.wanted_distance_m = 2.5;
    setup.efficacy_lm_W = 90;
    setup.mesh_area_m2 = 0.7;
    setup.photometric_sr = 1.3;
    for (const Dimension from : all)
      for (const Dimension to : all) {
        const Result<double> there = convert({from, 12}, to, setup);
        const Result<double> again = there ? convert({to, *there}, from, setup) : there;
        ASSERT_EQ(there.ok(), again.ok());
        if (!again) {
          EXPECT_EQ(again.error().code, "UNIT_UNSUITABLE") << name_of(shape) << ' ' << name_of(from) << ' ' << name_of(to);
          continue;
        }
        pairs += from != to;
        EXPECT_NEAR(*again / 12, 1, 1e-14) << name_of(shape) << ' ' << name_of(from) << ' ' << name_of(to);
      }
  }
  // A shape that knows n of the ten quantities has n (n - 1) pairs: punctual and line lights 6, formed ones all, meshes 6, distant ones and
  // the sky 5. A quantity, its radiometric twin and its EV need no shape to become one another: luminances of points, intensities of
  // meshes.
  EXPECT_EQ(pairs, 5 * (6 * 5 + 3 * 2) + 7 * (10 * 9) + (6 * 5 + 2 * 2) + 2 * (5 * 4 + 2 * 2));
}

// Units whose factors are quotients of whole numbers convert a whole number as one division of whole numbers does: to the nearest double.
TEST(Convert, UnitsAreRoundedOnce) {
  const auto unit = [](const char* name) { return *unit_named(name); };
  for (const auto& group : {std::vector<const char*>{"m", "cm", "mm", "um", "km", "in", "ft"},
                            {"lx", "klx", "mlx", "fc"},
                            {"s", "ms", "us"},
                            {"W", "kW", "uW", "MW"}})
    for (const char* const from : group)
      for (const char* const to : group) {
        const NamedUnit given = unit(from), wanted = unit(to);
        const Conversion conversion = *Conversion::between(given, wanted, {});
        for (int x = 0; x < 500; ++x) {
          const double above = x * given.times * wanted.over, below = given.over * wanted.times;
          if (above > 9e15 || below > 9e15) continue;  // no longer whole numbers in a double
          EXPECT_EQ(*conversion(x), above / below) << x << " " << from << " in " << to;
        }
      }
  EXPECT_EQ(*Conversion::between(unit("ft"), unit("cm"), {})->operator()(6), 182.88);
}

TEST(Convert, TemperaturesOfLightsOnly) {
  const Conversion to_mired = *Conversion::between(*unit_named("K"), *unit_named("mired"), {});
  EXPECT_EQ(*to_mired(5000), 200);
  for (const double none : {0.0, -100.0, 99.0, 100001.0}) {
    EXPECT_EQ(to_mired(none).error().code, "TEMPERATURE_OUT_OF_RANGE") << none;
    EXPECT_EQ(to_mired(none).error().where.pointer, "/value");
    EXPECT_NE(to_mired(none).error().text.find("between 100 K and 100000 K"), std::string::npos);
  }
  const Conversion from_mired = *Conversion::between(*unit_named("mired"), *unit_named("K"), {});
  EXPECT_EQ(*from_mired(200), 5000);
  EXPECT_EQ(from_mired(0).error().code, "TEMPERATURE_OUT_OF_RANGE");
  EXPECT_EQ(convert({Dimension::temperature, -1}, Dimension::temperature, {}).error().code, "TEMPERATURE_OUT_OF_RANGE");
}

TEST(ConvertErrors, NameTheParameter) {
  const auto pointer = [](const AnyQuantity& given, Dimension wanted, const LightSetup& setup) {
    return convert(given, wanted, setup).error().where.pointer;
  };
  const AnyQuantity flux{Dimension::luminous_flux, 1};
  const auto of = [](Shape shape) {
    LightSetup setup;
    setup.shape = std::move(shape);
    return setup;
  };
  EXPECT_EQ(pointer(flux, Dimension::luminance, {}), "/shape");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(PointShape{})), "/shape");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(SphereShape{0})), "/radius");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(RectShape{1, -1})), "/height");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(TubeShape{-1, 1, Caps::round})), "/length");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(PolygonShape{})), "/points");
  EXPECT_EQ(pointer(flux, Dimension::luminance, of(MeshShape{})), "/area_m2");
  EXPECT_EQ(pointer(flux, Dimension::luminous_intensity, of(SpotShape{1, 0.5})), "/inner");
  EXPECT_EQ(pointer(flux, Dimension::luminous_intensity, of(SpotShape{0, 4})), "/outer");
  EXPECT_EQ(pointer(flux, Dimension::luminous_intensity, of(FrustumShape{4, 1})), "/width_angle");
  EXPECT_EQ(pointer(flux, Dimension::illuminance, of(PointShape{})), "/distance");
  EXPECT_EQ(pointer({Dimension::radiant_flux, 1}, Dimension::luminous_flux, {}), "/efficacy");
  EXPECT_EQ(pointer({Dimension::luminous_flux, -1}, Dimension::luminous_intensity, of(PointShape{})), "/value");
  EXPECT_EQ(pointer({Dimension::luminance, 0}, Dimension::exposure_value, {}), "/value");
}

TEST(Convert, ExposureValues) {
  const LightSetup nothing;
  EXPECT_EQ(*convert({D::exposure_value, 15}, D::luminance, nothing), 4096);
  EXPECT_EQ(*convert({D::luminance, 4096}, D::exposure_value, nothing), 15);
  EXPECT_EQ(*convert({D::exposure_value, 15}, D::illuminance, nothing), 2.5 * 32768);
  EXPECT_EQ(*convert({D::illuminance, 2.5}, D::exposure_value, nothing), 0);
  EXPECT_EQ(*convert({D::exposure_value, -3}, D::exposure_value, nothing), -3);
  EXPECT_NEAR(*convert({D::exposure_value, 15}, D::luminous_exitance, nothing), 4096 * pi, 1e-11);
  LightSetup minolta;
  minolta.meter_k = 14;
  EXPECT_EQ(*convert({D::exposure_value, 15}, D::luminance, minolta), 4096 * 14 / 12.5);
  // The same lamp as an EV of its surface.
  EXPECT_NEAR(*convert({D::luminous_flux, 1500}, D::exposure_value, of(SphereShape{0.15})), std::log2(1688.686 * 8), 1e-6);
}

TEST(Convert, WattsThroughAnEfficacy) {
  LightSetup lamp = of(SphereShape{0.03});
  lamp.efficacy_lm_W = 15;
  EXPECT_EQ(*convert({D::radiant_flux, 60}, D::luminous_flux, lamp), 900);
  EXPECT_EQ(*convert({D::luminous_flux, 900}, D::radiant_flux, lamp), 60);
  EXPECT_EQ(*convert({D::radiant_flux, 60}, D::luminance, lamp), *convert({D::luminous_flux, 900}, D::luminance, lamp));
  EXPECT_EQ(Conversion::between(D::radiant_flux, D::luminance, lamp)->efficacy_lm_W(), 15) << "the result carries it";
  EXPECT_FALSE(Conversion::between(D::luminous_flux, D::luminance, lamp)->efficacy_lm_W().has_value());
  // Watts into watts need none.
  lamp.efficacy_lm_W.reset();
  EXPECT_NEAR(*convert({D::radiant_flux, 60}, D::radiance, lamp), 60 / (4 * pi * pi * 0.03 * 0.03), 1e-11);
}

// ---- What is missing, unsuitable or out of range ----

void expect_error(const AnyQuantity& given, Dimension wanted, const LightSetup& setup, const char* code, const char* names) {
  const Result<double> result = convert(given, wanted, setup);
  ASSERT_FALSE(result.ok()) << names;
  EXPECT_EQ(result.error().code, code) << result.error().text;
  const std::string said = result.error().text + " | " + result.error().hint;
  EXPECT_NE(said.find(names), std::string::npos) << said;
}

TEST(ConvertErrors, NameWhatIsMissing) {
  const LightSetup nothing;
  expect_error({D::luminous_flux, 1}, D::luminance, nothing, "SHAPE_MISSING", "shape");
  expect_error({D::luminous_flux, 1}, D::luminance, of(SphereShape{0}), "SIZE_MISSING", "radius");
  expect_error({D::luminous_flux, 1}, D::luminance, of(MeshShape{}), "SIZE_MISSING", "area");
  expect_error({D::luminous_flux, 1}, D::luminous_intensity, of(PhotometricShape{}), "SOLID_ANGLE_MISSING", "photometric file");
  expect_error({D::illuminance, 1}, D::luminous_intensity, of(PointShape{}), "DISTANCE_MISSING", "distance");
  expect_error({D::luminous_intensity, 1}, D::illuminance, of(PointShape{}), "DISTANCE_MISSING", "distance");
  expect_error({D::illuminance, 1}, D::luminous_flux, of(RectShape{1, 1}), "DISTANCE_MISSING", "distance");
  expect_error({D::radiant_flux, 100}, D::luminous_flux, of(PointShape{}), "EFFICACY_MISSING", "electrical");
  expect_error({D::radiant_flux, 100}, D::luminous_flux, nothing, "EFFICACY_MISSING", "lm/W");
}

TEST(ConvertErrors, NameWhatAShapeDoesNotKnow) {
  expect_error({D::luminance, 1}, D::luminous_flux, of(PointShape{}), "UNIT_UNSUITABLE", "point light: it has no surface");
  expect_error({D::luminous_flux, 1}, D::luminance, of(SpotShape{0, 1}), "UNIT_UNSUITABLE", "a shape with a size");
  expect_error({D::exposure_value, 1}, D::luminous_flux, of(PointShape{}), "UNIT_UNSUITABLE", "no surface");
  expect_error({D::luminance, 1}, D::luminous_flux, of(LineShape{1}), "UNIT_UNSUITABLE", "tube");
  expect_error({D::luminous_flux, 1}, D::illuminance, of(DistantShape{0.01}), "UNIT_UNSUITABLE", "infinitely far");
  expect_error({D::luminous_flux, 1}, D::luminous_intensity, of(MeshShape{}), "UNIT_UNSUITABLE", "no one direction");
}

TEST(ConvertErrors, NameNumbersOutOfRange) {
  LightSetup lamp = of(PointShape{});
  for (const double bad : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    lamp.efficacy_lm_W = bad;
    expect_error({D::radiant_flux, 1}, D::luminous_flux, lamp, "NUMBER_INVALID", "efficacy");
  }
  LightSetup meter;
  meter.meter_k = 0;
  meter.meter_c = -250;
  expect_error({D::exposure_value, 1}, D::luminance, meter, "NUMBER_INVALID", "K above 0");
  expect_error({D::exposure_value, 1}, D::illuminance, meter, "NUMBER_INVALID", "C above 0");
  const LightSetup nothing;
  expect_error({D::luminance, 0}, D::exposure_value, nothing, "LUMINANCE_NOT_POSITIVE", "0 cd/m2");
  expect_error({D::illuminance, 0}, D::exposure_value, nothing, "ILLUMINANCE_NOT_POSITIVE", "0 lx");
  expect_error({D::luminance, -1}, D::exposure_value, nothing, "NUMBER_INVALID", "not negative");
  expect_error({D::luminance, std::nan("")}, D::luminance, nothing, "NUMBER_INVALID", "nan");
  expect_error({D::exposure_value, 5000}, D::luminance, nothing, "NUMBER_INVALID", "range of a double");
  expect_error({D::luminous_flux, 1}, D::luminous_intensity, of(SpotShape{0.6, 0.5}), "NUMBER_INVALID", "inner half angle");
}

TEST(ConvertErrors, NameWhatNoLightConnects) {
  const LightSetup nothing;
  expect_error({D::length, 1}, D::luminance, nothing, "DIMENSION_MISMATCH", "length (in m)");
  expect_error({D::luminous_flux, 1}, D::temperature, of(PointShape{}), "DIMENSION_MISMATCH", "temperature");
  expect_error({D::exposure_value_s, 1}, D::exposure_value, nothing, "DIMENSION_MISMATCH", "EV_S");
  EXPECT_EQ(*convert({D::length, -2}, D::length, nothing), -2);
}

}  // namespace
}  // namespace etendue
