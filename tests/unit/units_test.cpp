#include "etendue/units.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <string>

namespace etendue {
namespace {

struct Case {
  const char* text;
  Dimension dimension;
  double si;
};

// Every spelling of the command's manual once, and every prefix at least once. Decimal submultiples are exact: what the same decimal
// number in SI units reads as.
TEST(ParseQuantity, KnowsEverySpelling) {
  const Case cases[] = {
      {"1500 lm", Dimension::luminous_flux, 1500},
      {"1500lm", Dimension::luminous_flux, 1500},
      {"  1.5e3 lm ", Dimension::luminous_flux, 1500},
      {"+1.5 klm", Dimension::luminous_flux, 1500},
      {"70 mlm", Dimension::luminous_flux, 0.07},
      {"2.5 Mcd", Dimension::luminous_intensity, 2.5e6},
      {".5 cd", Dimension::luminous_intensity, 0.5},
      {"20 knit", Dimension::luminance, 20000},
      {"1.6 Gnit", Dimension::luminance, 1.6e9},
      {"7 kcd/m2", Dimension::luminance, 7000},
      {"12 klx", Dimension::illuminance, 12000},
      {"12 klux", Dimension::illuminance, 12000},
      {"3 lm/m2", Dimension::luminous_exitance, 3},
      {"18 W", Dimension::radiant_flux, 18},
      {"3 mW", Dimension::radiant_flux, 0.003},
      {"3 MW", Dimension::radiant_flux, 3e6},
      {"5 W/sr", Dimension::radiant_intensity, 5},
      {"5 W/m2/sr", Dimension::radiance, 5},
      {"5 W/m2", Dimension::irradiance, 5},
      {"90 lm/W", Dimension::efficacy, 90},
      {"2.4 m", Dimension::length, 2.4},
      {"70 cm", Dimension::length, 0.7},
      {"3 mm", Dimension::length, 0.003},
      {"5 um", Dimension::length, 5e-6},
      {"1 km", Dimension::length, 1000},
      {"1 in", Dimension::length, 0.0254},
      {"1 ft", Dimension::length, 0.3048},
      {"180 deg", Dimension::angle, pi},
      {"1 mrad", Dimension::angle, 0.001},
      {"2 sr", Dimension::solid_angle, 2},
      {"3000 K", Dimension::temperature, 3000},
      {"200 mired", Dimension::temperature, 5000},
      {"8 ms", Dimension::duration, 0.008},
      {"-3 EV", Dimension::exposure_value, -3},
      {"12 EV_S", Dimension::exposure_value_s, 12},
      {"-0.5 stop", Dimension::stop, -0.5},
  };
  for (const Case& c : cases) {
    const Result<AnyQuantity> q = parse_quantity(c.text);
    ASSERT_TRUE(q.ok()) << c.text << ": " << q.error().text;
    EXPECT_EQ(q->dimension, c.dimension) << c.text;
    EXPECT_EQ(q->si, c.si) << c.text;
  }
}

// A foot-candle is a lumen a square foot; a foot-lambert is 1/pi candela a square foot: a perfect white under 1 fc shows 1 fL.
TEST(ParseQuantity, KnowsTheFootUnits) {
  EXPECT_NEAR(parse_quantity("1 fc")->si, 10.7639104167097, 1e-12);
  EXPECT_NEAR(parse_quantity("1 fL")->si, 3.42625909963539, 1e-13);
  EXPECT_NEAR(parse_quantity("1 fc")->si / parse_quantity("1 fL")->si, pi, 1e-15);
}

TEST(ParseQuantity, RefusesWithACode) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "NUMBER_INVALID"},         {"lm", "NUMBER_INVALID"},         {"inf lm", "NUMBER_INVALID"},  {"nan lm", "NUMBER_INVALID"},
      {"--3 lm", "NUMBER_INVALID"},   {"1.200,5 lm", "NUMBER_INVALID"}, {"1,5 lm", "NUMBER_INVALID"},  {"1 200 lm", "NUMBER_INVALID"},
      {"1e999 lm", "NUMBER_INVALID"}, {"1e308 klm", "NUMBER_INVALID"},  {"0 mired", "NUMBER_INVALID"}, {"1'500 lm", "NUMBER_INVALID"},
      {"-", "NUMBER_INVALID"},        {". lm", "NUMBER_INVALID"},       {"1..5 lm", "NUMBER_INVALID"}, {"1500", "UNIT_MISSING"},
      {"1500  ", "UNIT_MISSING"},     {"5 Lm", "UNIT_UNKNOWN"},         {"5 min", "UNIT_UNKNOWN"},     {"5 kK", "UNIT_UNKNOWN"},
      {"5 kdeg", "UNIT_UNKNOWN"},     {"5 cd/m^2", "UNIT_UNKNOWN"},     {"5 mEV", "UNIT_UNKNOWN"},     {"0x10 lm", "UNIT_UNKNOWN"},
      {"5 lm lm", "UNIT_UNKNOWN"},    {"5 lumen", "UNIT_UNKNOWN"},
  };
  for (const auto& [text, code] : cases) {
    const Result<AnyQuantity> q = parse_quantity(text);
    ASSERT_FALSE(q.ok()) << text;
    EXPECT_EQ(q.error().code, code) << text;
  }
}

TEST(ParseQuantity, SuggestsTheNearestUnits) {
  const auto hint_of = [](const char* text) { return parse_quantity(text).error().hint; };
  EXPECT_NE(hint_of("5 nt").find("nit"), std::string::npos) << hint_of("5 nt");
  EXPECT_NE(hint_of("5 lumenz").find("lm"), std::string::npos) << hint_of("5 lumenz");
  EXPECT_NE(hint_of("5 Lux").find("lux"), std::string::npos) << hint_of("5 Lux");
  EXPECT_NE(hint_of("5 degrees").find("deg"), std::string::npos) << hint_of("5 degrees");
  EXPECT_NE(hint_of("5 cd/m^2").find("cd/m2"), std::string::npos) << hint_of("5 cd/m^2");
}

TEST(ParseSi, NamesBothDimensions) {
  EXPECT_EQ(*parse_si("60 cm", Dimension::length), 0.6);
  const Result<double> wrong = parse_si("60 cm", Dimension::luminous_flux);
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().code, "DIMENSION_MISMATCH");
  EXPECT_NE(wrong.error().text.find("luminous flux"), std::string::npos);
  EXPECT_NE(wrong.error().text.find("length"), std::string::npos);
}

TEST(ToString, ReadsBackAsTheSameDouble) {
  EXPECT_EQ(to_string({Dimension::luminous_flux, 1500}), "1500 lm");
  for (int d = 0; d <= static_cast<int>(Dimension::stop); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    for (const double si : {0.1, 1.0 / 3, 1e-7, 6.02e23, 123456789.125, 5e-324, std::numeric_limits<double>::max(), -2.5, 0.0}) {
      const std::string text = to_string({dimension, si});
      const Result<AnyQuantity> back = parse_quantity(text);
      ASSERT_TRUE(back.ok()) << text;
      EXPECT_EQ(back->dimension, dimension) << text;
      EXPECT_EQ(back->si, si) << text;
    }
  }
}

// A decimal comma in the process' locale changes neither reading nor writing.
TEST(ToString, IgnoresTheLocale) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
  EXPECT_EQ(parse_quantity("1.5 lm")->si, 1.5);
  EXPECT_EQ(to_string({Dimension::length, 1.5}), "1.5 m");
  std::setlocale(LC_ALL, "C");
}

TEST(Units, MakeAndReadTheSameNumber) {
  EXPECT_EQ(lumens.of(lumens(800)), 800);
  EXPECT_DOUBLE_EQ(degrees(180).si, pi);
  EXPECT_LT(metres(1), metres(2));
}

// EV100 3 is 1 cd/m2 with K = 12.5; one EV is a factor of two.
TEST(Ev, MeterAndExposure) {
  EXPECT_EQ(luminance_of_ev100(3), 1);
  EXPECT_EQ(luminance_of_ev100(15), 4096);
  EXPECT_EQ(ev100_of_luminance(4096), 15);
  for (const double ev : {-20.0, -3.3, 0.0, 0.1, 9.7, 15.0, 29.9}) EXPECT_NEAR(ev100_of_luminance(luminance_of_ev100(ev)), ev, 1e-13);
  // Sunny 16: f/16, 1/125 s, ISO 100 is EV100 14.966; the meter's luminance lands at .125/1.2 = 10.4 % of saturation.
  const double sunny16 = std::log2(16.0 * 16.0 * 125.0);
  EXPECT_NEAR(sunny16, 14.966, 5e-4);
  EXPECT_NEAR(luminance_of_ev100(sunny16) * exposure_of_ev100(sunny16), 0.125 / 1.2, 1e-15);
}

TEST(Ev, NeverGivesInfinityOrNan) {
  for (const double x : {0.0, -1.0, 1e300, -1e300, std::numeric_limits<double>::max()}) {
    EXPECT_TRUE(std::isfinite(ev100_of_luminance(x))) << x;
    EXPECT_TRUE(std::isfinite(luminance_of_ev100(x))) << x;
    EXPECT_TRUE(std::isfinite(exposure_of_ev100(x))) << x;
  }
}

}  // namespace
}  // namespace etendue
