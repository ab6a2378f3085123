#include "etendue/quantity_text.h"

#include "etendue/unit_names.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace etendue {
namespace {

template <class T>
T read(const char* text) {
  const Result<Written> written = parse(text);
  EXPECT_TRUE(written.ok()) << text << ": " << (written.ok() ? "" : written.error().text);
  if (!written || !std::holds_alternative<T>(*written)) {
    ADD_FAILURE() << text << " is something else";
    return {};
  }
  return std::get<T>(*written);
}
WrittenQuantity quantity(const char* text) { return read<WrittenQuantity>(text); }
CameraSettings camera(const char* text) { return read<CameraSettings>(text); }

TEST(Parse, QuantitiesOfLights) {
  EXPECT_EQ(quantity("1200 lm").quantity().si, 1200);
  EXPECT_EQ(quantity(" 1200lm ").quantity().dimension, Dimension::luminous_flux);
  EXPECT_EQ(quantity("-3 EV").quantity().si, -3);
  EXPECT_EQ(quantity("+1.5 stop").quantity().si, 1.5);
  EXPECT_EQ(quantity("180 deg").quantity().si, pi);
  EXPECT_EQ(quantity("8 ms").quantity().si, 0.008);
  const WrittenQuantity key = quantity("15 klx @ 2 m");
  EXPECT_EQ(key.quantity().dimension, Dimension::illuminance);
  EXPECT_EQ(key.quantity().si, 15000);
  EXPECT_EQ(key.distance_m, 2);
  EXPECT_EQ(quantity("15klx@2m").distance_m, 2);
  EXPECT_EQ(quantity("15 klx @ 60 cm").distance_m, 0.6);
  const WrittenQuantity bulb = quantity("60 W at 15 lm/W");
  EXPECT_EQ(bulb.quantity().si, 60);
  EXPECT_EQ(bulb.efficacy_lm_W, 15);
  EXPECT_EQ(quantity("3 W/m2 @ 2 m at 90 lm/W").efficacy_lm_W, 90);
}

TEST(Parse, Cameras) {
  const CameraSettings c = camera("f/2.8 1/60 s ISO 400");
  EXPECT_EQ(c.f_number, 2.8);
  EXPECT_EQ(c.shutter_s, 1.0 / 60);
  EXPECT_EQ(c.iso, 400);
  EXPECT_NEAR(*ev100(camera("f/16 1/125 ISO100")), 14.966, 5e-4) << "Sunny 16";
  EXPECT_EQ(*ev100(camera("ISO100 1/125 f/16")), *ev100(camera("f/16 1/125 s ISO 100"))) << "in any order";
  EXPECT_EQ(camera("T2.8").t_stop, 2.8);
  EXPECT_EQ(camera("ND 0.9").nd_density, 0.9);
  EXPECT_EQ(camera("ND0.3 ND0.6").nd_density, 0.3 + 0.6);
  EXPECT_EQ(camera("f/4 8 ms").shutter_s, 0.008);
  EXPECT_EQ(camera("f/4 +1.5 stop").compensation_stop, 1.5);
  EXPECT_EQ(camera("-2 stop f/4").compensation_stop, -2);
  const CameraSettings film = camera("180 deg @ 24 fps");
  EXPECT_EQ(film.shutter_angle_rad, pi);
  EXPECT_EQ(film.frames_per_s, 24);
  EXPECT_NEAR(*shutter_time(film), 1.0 / 48, 1e-17);
  EXPECT_EQ(camera("T2.8 ISO 800 180deg@24fps").frames_per_s, 24);
}

TEST(Parse, Colours) {
  const ColourTemperature warm = read<ColourTemperature>("3000 K Duv -0.003");
  EXPECT_EQ(warm.kelvin, 3000);
  EXPECT_EQ(warm.duv, -0.003);
  EXPECT_EQ(quantity("5600 K").quantity().si, 5600);
  // 1e6 / (312.5 + 137): a full CTO before a 3200 K lamp.
  EXPECT_NEAR(quantity("3200 K + 137 mired").quantity().si, 1e6 / 449.5, 1e-12 * 2224);
  EXPECT_NEAR(quantity("3200K -137mired").quantity().si, 1e6 / 175.5, 1e-12 * 5698);
  const Chromaticity d65 = read<Chromaticity>("xy .3127 .329");
  EXPECT_EQ(d65.x, 0.3127);
  EXPECT_EQ(d65.y, 0.329);
  const Rgb peach = read<Rgb>("#ffb46b");
  EXPECT_EQ(peach.x, 1);
  EXPECT_NEAR(peach.y, std::pow((180 / 255.0 + 0.055) / 1.055, 2.4), 1e-15);
  EXPECT_NEAR(read<Rgb>("#010101").x, 1 / 255.0 / 12.92, 1e-18);
  EXPECT_EQ(read<Rgb>("#FFB46B").z, peach.z);
  EXPECT_EQ(read<Rgb>("rgb 1 .5 -.02").z, -0.02);
}

// What is written reads back as the same numbers, to the bit, and is written the same.
TEST(Print, ReadsBackAsTheSame) {
  const char* texts[] = {
      "1500 lm",         "15000 lx @ 2 m",  "60 W at 15 lm/W",       "f/2.8 1/60 s ISO 400", "T2.8 3.141592653589793 rad @ 24 fps",
      "ND 0.9",          "f/5.6 +1.5 stop", "1/3 s -2 stop",         "3000 K Duv -0.003",    "xy 0.3127 0.329",
      "rgb 1 0.5 -0.02", "-3 EV",           "0.3333333333333333 cd", "2 s ISO 100"};
  for (const char* const text : texts) EXPECT_EQ(to_string(*parse(text)), text);
  EXPECT_EQ(to_string(*parse("15 klx @ 200 cm")), "15000 lx @ 2 m");
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 2000; ++i) {
    const double x = std::exp(exponent(random)), y = std::exp(exponent(random) / 20);
    CameraSettings c;
    c.f_number = x;
    c.shutter_s = y;
    c.iso = 1 / y;
    c.compensation_stop = -y;
    const CameraSettings back = std::get<CameraSettings>(*parse(to_string(Written{c})));
    EXPECT_EQ(back.f_number, x);
    EXPECT_EQ(back.shutter_s, y);
    EXPECT_EQ(back.iso, 1 / y);
    EXPECT_EQ(back.compensation_stop, -y);
    const double kelvin = 100 * std::exp(std::abs(std::log(x)) / 44);  // up to 91500 K
    const ColourTemperature t = std::get<ColourTemperature>(*parse(to_string(Written{ColourTemperature{kelvin, -y}})));
    EXPECT_EQ(t.kelvin, kelvin);
    EXPECT_EQ(t.duv, -y);
  }
}

struct Bad {
  const char *text, *code, *names;
  int column;
};
TEST(ParseErrors, SayWhatAndWhere) {
  const Bad cases[] = {
      {"", "NUMBER_INVALID", "1500 lm", 1},
      {"lm", "NUMBER_INVALID", "lm", 1},
      {"1.200,5 lm", "NUMBER_INVALID", "decimal mark is a point", 1},
      {"1,5 lm", "NUMBER_INVALID", "decimal mark is a point", 1},
      {"1 200 lm", "NUMBER_INVALID", "not grouped", 3},
      {"1500", "UNIT_MISSING", "unit", 5},
      {"5 nt", "UNIT_UNKNOWN", "nt", 3},
      {"15 klx @ 2 lm", "DIMENSION_MISMATCH", "length", 10},
      {"15 klx @ 2", "UNIT_MISSING", "unit", 11},
      {"15 lm @ 2 m", "DIMENSION_MISMATCH", "illuminance", 7},
      {"15 lm bright", "TEXT_UNEXPECTED", "bright", 7},
      {"60 W at 15 lm", "DIMENSION_MISMATCH", "efficacy", 9},
      {"f/0 1/60 s", "CAMERA_SETTING_INVALID", "f-number above 0", 3},
      {"f/-4", "CAMERA_SETTING_INVALID", "f-number above 0", 3},
      {"f/4 1/0 s", "CAMERA_SETTING_INVALID", "shutter time", 5},
      {"1/0 s", "CAMERA_SETTING_INVALID", "shutter time", 1},
      {"f/4 ISO 0", "CAMERA_SETTING_INVALID", "ISO", 9},
      {"ND -0.3", "CAMERA_SETTING_INVALID", "density", 4},
      {"f/4 f/8", "CAMERA_SETTING_AMBIGUOUS", "f-number once", 7},
      {"f/4 T4", "CAMERA_SETTING_AMBIGUOUS", "T-stop", 7},
      {"f/4 1/60 180 deg @ 24 fps", "CAMERA_SETTING_AMBIGUOUS", "shutter angle", 26},
      {"f/4 1 stop 1 stop", "CAMERA_SETTING_AMBIGUOUS", "compensation", 12},
      {"f/4 60", "UNIT_MISSING", "60", 5},
      {"f/4 3 lm", "DIMENSION_MISMATCH", "luminous flux", 5},
      {"f/4 bright", "TEXT_UNEXPECTED", "bright", 5},
      {"3000 K Duv", "NUMBER_INVALID", "number", 11},
      {"3000 K Duv .1 x", "TEXT_UNEXPECTED", "x", 15},
      {"3200 K + 137", "TEXT_UNEXPECTED", "mired", 13},
      {"3200 K - 400 mired", "TEMPERATURE_OUT_OF_RANGE", "", 10},
      {"-100 K", "TEMPERATURE_OUT_OF_RANGE", "between 100 K and 100000 K, found -100 K", 1},
      {"-100 K Duv 0", "TEMPERATURE_OUT_OF_RANGE", "between 100 K and 100000 K, found -100 K", 1},
      {"0 K", "TEMPERATURE_OUT_OF_RANGE", "found 0 K", 1},
      {"0 K Duv .01", "TEMPERATURE_OUT_OF_RANGE", "found 0 K", 1},
      {"99 K", "TEMPERATURE_OUT_OF_RANGE", "found 99 K", 1},
      {"100001 K Duv 0", "TEMPERATURE_OUT_OF_RANGE", "found 100001 K", 1},
      {"1e300 K", "TEMPERATURE_OUT_OF_RANGE", "100000 K", 1},
      {"0 mired", "TEMPERATURE_OUT_OF_RANGE", "found inf K", 1},
      {"9 mired", "TEMPERATURE_OUT_OF_RANGE", "found 111111", 1},
      {"-200 mired", "TEMPERATURE_OUT_OF_RANGE", "found -5000 K", 1},
      {"-100 K + 137 mired", "TEMPERATURE_OUT_OF_RANGE", "found -100 K", 1},
      {"50000 K - 15 mired", "TEMPERATURE_OUT_OF_RANGE", "found 200000 K", 11},
      {"xy .3127", "NUMBER_INVALID", "2 numbers", 9},
      {"xy nan .3", "NUMBER_INVALID", "xy", 1},
      {"xy 0 0", "COLOUR_INVALID", "y > 0", 4},
      {"xy .8 .3", "COLOUR_INVALID", "x + y", 4},
      {"#ffb46", "COLOUR_INVALID", "six hexadecimal", 1},
      {"#ffb46g", "COLOUR_INVALID", "six hexadecimal", 1},
      {"#+fb46b", "COLOUR_INVALID", "six hexadecimal", 1},
      {"rgb 1 2", "NUMBER_INVALID", "3 numbers", 8},
  };
  for (const Bad& bad : cases) {
    const Result<Written> written = parse(bad.text);
    ASSERT_FALSE(written.ok()) << bad.text;
    EXPECT_EQ(written.error().code, bad.code) << bad.text << ": " << written.error().text;
    EXPECT_NE(written.error().text.find(bad.names), std::string::npos) << bad.text << ": " << written.error().text;
    EXPECT_EQ(written.error().where.column, bad.column) << bad.text << ": " << written.error().text;
  }
}

TEST(ParseErrors, NameTheCameraSetting) {
  for (const auto& [text, setting] : {std::pair{"f/0 1/60 s", "/f_number"},
                                      {"f/4 1/0 s", "/shutter_s"},
                                      {"ISO -1", "/iso"},
                                      {"ND -0.3", "/nd_density"},
                                      {"0 fps", "/frames_per_s"},
                                      {"T2 T2", "/t_stop"},
                                      {"-100 K Duv 0", "/kelvin"}})
    EXPECT_EQ(parse(text).error().where.pointer, setting) << text;
}

// Opt-in: the nearest temperature and a warning with both, but never for what is no temperature.
TEST(Parse, ClampsTemperaturesForThoseWhoAsk) {
  for (const auto& [text, kelvin] :
       {std::pair{"200000 K", 100000.0}, {"99 K", 100.0}, {"5 mired", 100000.0}, {"50000 K - 15 mired", 1e5}}) {
    Diagnostics clamped;
    const Result<Written> written = parse(text, clamped);
    ASSERT_TRUE(written.ok()) << text;
    EXPECT_EQ(std::get<WrittenQuantity>(*written).quantity().si, kelvin) << text;
    ASSERT_EQ(clamped.all().size(), 1U) << text;
    EXPECT_EQ(clamped.all()[0].code, "TEMPERATURE_CLAMPED");
    EXPECT_GT(clamped.all()[0].where.column, 0);
  }
  Diagnostics clamped;
  EXPECT_EQ(std::get<ColourTemperature>(*parse("1e9 K Duv .01", clamped)).kelvin, 100000);
  EXPECT_EQ(clamped.all().size(), 1U);
  EXPECT_EQ(std::get<WrittenQuantity>(*parse("5600 K", clamped)).quantity().si, 5600);
  EXPECT_EQ(clamped.all().size(), 1U) << "5600 K is as it was";
  for (const char* const none : {"0 K", "-100 K", "-100 K Duv 0", "-1 mired"})
    EXPECT_EQ(parse(none, clamped).error().code, "TEMPERATURE_OUT_OF_RANGE") << none;
  EXPECT_EQ(clamped.all().size(), 1U);
}

TEST(ParseErrors, SuggestUnits) {
  for (const auto& [text, unit] : {std::pair{"5 nt", "nit"}, {"5 lumenz", "lm"}, {"5 lumen/m2", "lx"}, {"f/4 5 secs", "s"}}) {
    const Result<Written> written = parse(text);
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().code, "UNIT_UNKNOWN");
    EXPECT_NE(written.error().hint.find(unit), std::string::npos) << written.error().hint;
  }
}

// ---- Units by name ----

TEST(UnitNames, EverySpellingIsFoundAndNoOther) {
  std::size_t found = 0;
  for (const UnitSpelling& s : unit_spellings()) {
    const NamedUnit* const unit = find_unit(s.symbol);
    ASSERT_NE(unit, nullptr) << s.symbol;
    EXPECT_EQ(unit->dimension, s.unit.dimension);
    for (const char prefix : s.prefixes) {
      const NamedUnit* const prefixed = find_unit(prefix + std::string(s.symbol));
      ASSERT_NE(prefixed, nullptr) << prefix << s.symbol;
      // "mlm", and where a prefixed unit is another's symbol, that one.
      if (prefixed->dimension == s.unit.dimension && !s.unit.reciprocal) {
        const double factor = prefixed->to_si(1) / s.unit.to_si(1);
        const std::string_view letters = "umckMG";
        const double expected[] = {1e-6, 1e-3, 1e-2, 1e3, 1e6, 1e9};
        EXPECT_NEAR(factor / expected[letters.find(prefix)], 1, 1e-15) << prefix << s.symbol;
        ++found;
      }
    }
    for (const double x : {1.0, 3.7, 1e-5}) EXPECT_NEAR(unit->from_si(unit->to_si(x)) / x, 1, 1e-15) << s.symbol;
  }
  EXPECT_GT(found, 40U);
  for (const char* const none : {"", "x", "Lm", "lmm", "kK", "kcd/m2/sr", "cdcdcdcdc"}) EXPECT_EQ(find_unit(none), nullptr) << none;
}

}  // namespace
}  // namespace etendue
