#include "etendue/spectrum.h"
#include "etendue/colour.h"
#include "etendue/light_presets.h"
#include "etendue/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

// Computed independently from the same tables, printed to four digits.
TEST(EfficacyPolicy, NumbersPresetsAndTemperatures) {
  EXPECT_EQ(efficacy_policy("15 lm/W")->lm_W, 15);
  EXPECT_EQ(efficacy_policy("15 lm/W")->source, "");
  EXPECT_EQ(efficacy_policy(" CIE D65 ")->lm_W, 204.8);
  EXPECT_FALSE(efficacy_policy("CIE D65")->source.empty());
  EXPECT_EQ(efficacy_policy("K_cd")->lm_W, 683);
  // Facts of 2856 K: 16.446 lm/W of all radiation, 155.8 of what CIE A has within 380 nm to 780 nm.
  EXPECT_NEAR(efficacy_policy("2856 K")->lm_W, 16.446, 5e-4);
  EXPECT_NEAR(efficacy_policy("2856 K visible")->lm_W, 155.8, 0.1);
  for (const auto& [text, code] : {std::pair{"incandescent", "EFFICACY_AMBIGUOUS"},
                                   {"CIE D66", "PRESET_UNKNOWN"},
                                   {"", "PRESET_UNKNOWN"},
                                   {"15 lm", "DIMENSION_MISMATCH"},
                                   {"15 lm/W visible", "DIMENSION_MISMATCH"},
                                   {"15", "UNIT_MISSING"},
                                   {"-100 K", "TEMPERATURE_OUT_OF_RANGE"}}) {
    const Result<EfficacyPolicy> refused = efficacy_policy(text);
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_EQ(refused.error().code, code) << text;
    EXPECT_EQ(refused.error().where.pointer, "/efficacy") << text;
  }
}

TEST(Blackbody, LuminanceAndEfficacyMatchTheTable) {
  struct Row {
    double kelvin, luminance, efficacy;
  };
  for (const Row& row : {Row{1000, 2.687, 0.000},
                         {1500, 7740, 0.085},
                         {2000, 4.638e5, 1.606},
                         {2700, 1.185e7, 12.356},
                         {2856, 1.975e7, 16.446},
                         {4000, 2.528e8, 54.713},
                         {5000, 9.181e8, 81.387},
                         {5772, 1.844e9, 92.029},
                         {6500, 3.073e9, 95.363},
                         {10000, 1.326e10, 73.468},
                         {20000, 6.255e10, 21.658},
                         {40000, 1.835e11, 3.971}}) {
    EXPECT_NEAR(*blackbody_luminance(row.kelvin) / row.luminance, 1, 5e-4) << row.kelvin;
    EXPECT_NEAR(*blackbody_efficacy(row.kelvin, whole_spectrum), row.efficacy, 5.1e-4) << row.kelvin;
    EXPECT_NEAR(*blackbody_luminance(row.kelvin) / *blackbody_radiance(row.kelvin), row.efficacy, 5.1e-4) << row.kelvin;
  }
}

TEST(Blackbody, MostEfficientAt6628K) {
  EXPECT_NEAR(*blackbody_efficacy(6628, whole_spectrum), 95.429, 5e-4);
  for (const double kelvin : {6500.0, 6600.0, 6660.0, 6800.0})
    EXPECT_LT(*blackbody_efficacy(kelvin, whole_spectrum), *blackbody_efficacy(6628, whole_spectrum));
  for (const auto& [kelvin, lm_W] : {std::pair{2700, 147}, {3000, 163}, {4000, 191}, {5000, 198}, {6500, 195}})
    EXPECT_NEAR(*blackbody_efficacy(kelvin, visible_band), lm_W, 0.5) << kelvin;
}

// Planck's law integrates to sigma T^4 / pi; the peak is where Wien says, 2897.772 um K. 1 nm to 1 mm in ratios of 1.001.
TEST(Planck, IntegratesToStefanBoltzmann) {
  for (const double kelvin : {300.0, 2856.0, 5772.0}) {
    double sum = 0, previous = planck_radiance(1e-9, kelvin), at_peak = 0, peak = 0;
    for (int step = 0; step < 13823; ++step) {
      const double l = 1e-9 * std::pow(1.001, step);
      const double next = planck_radiance(l * 1.001, kelvin);
      sum += (previous + next) / 2 * l * 0.001;
      if (next > at_peak) at_peak = next, peak = l * 1.001;
      previous = next;
    }
    EXPECT_NEAR(sum / *blackbody_radiance(kelvin), 1, 1e-5) << kelvin;
    EXPECT_NEAR(peak * kelvin, 2.897772e-3, 2e-6) << kelvin;
  }
  EXPECT_EQ(planck_radiance(0, 300), 0);
  EXPECT_EQ(planck_radiance(500e-9, -1), 0);
  EXPECT_EQ(planck_radiance(1e-9, 100), 0);
}

Spectrum equal_energy() { return {360, 1, std::vector<double>(471, 1.0)}; }

// Column sums of the table; equal energy has x = y = 1/3 nearly. Efficacies over three bands, computed independently.
TEST(Spectrum, EqualEnergy) {
  const Vec3d xyz = *tristimulus(equal_energy());
  EXPECT_NEAR(xyz.x / k_m_lm_W, 106.865469, 1e-6);
  EXPECT_NEAR(xyz.y / k_m_lm_W, 106.856917, 1e-6);
  EXPECT_NEAR(xyz.z / k_m_lm_W, 106.892251, 1e-6);
  EXPECT_NEAR(*efficacy(equal_energy(), visible_band), 182.0, 0.05);
  EXPECT_NEAR(*efficacy(equal_energy(), {360, 830}), 155.0, 0.05);
  EXPECT_NEAR(*efficacy(equal_energy(), {400, 700}), 242.3, 0.05);
}

// A line at 555 nm, 1 W/m2/sr in all: 683 cd/m2 by definition, but for what tables in air make of it. Steps of 5 nm halve to its sides.
TEST(Spectrum, ALineIsTheCandela) {
  Spectrum line{550, 5, {0, 1, 0}};
  const double radiant = 1 + 2 * (0.8 + 0.6 + 0.4 + 0.2);
  EXPECT_NEAR(*efficacy(line, visible_band), tristimulus(line)->y / radiant, 1e-9);
  line = {554, 1, {0, 1, 0}};
  EXPECT_NEAR(tristimulus(line)->y, 683.002, 1e-9);
  EXPECT_NEAR(k_m_lm_W / k_cd_lm_W - 1, 2.9e-6, 5e-8);
}

// The sum over a table of Planck's law is the chromaticity of planckian().
TEST(Spectrum, OfABlackbodyIsPlanckian) {
  Spectrum filament{360, 1, std::vector<double>(471)};
  const auto heat = [&](double kelvin) {
    for (int i = 0; i < 471; ++i) filament.values[static_cast<std::size_t>(i)] = planck_radiance((360 + i) * 1e-9, kelvin) * 1e-9;
  };
  for (int step = 0; step <= 50; ++step) {
    const double kelvin = 800 * std::pow(1.1, step);
    heat(kelvin);
    const Vec3d xyz = *tristimulus(filament);
    const double sum = xyz.x + xyz.y + xyz.z;
    EXPECT_NEAR(xyz.x / sum, planckian(kelvin)->x, 1e-12) << kelvin;
    EXPECT_NEAR(xyz.y / sum, planckian(kelvin)->y, 1e-12) << kelvin;
    EXPECT_NEAR(xyz.y / *blackbody_luminance(kelvin), 1, 1e-12) << kelvin;
  }
  heat(2856);
  EXPECT_NEAR(*efficacy(filament, visible_band), efficacy_preset("CIE A")->low_lm_W, 0.05);
}

TEST(Spectrum, BadInput) {
  for (const Spectrum& bad : {Spectrum{360, 0, {1, 1}},
                              {360, 1, {}},
                              {360, 1, {1}},
                              {360, 1, {1, -1}},
                              {360, 1, {1, std::nan("")}},
                              {HUGE_VAL, 1, {1, 1}},
                              {-1, 1, {1, 1}},
                              {360, 1e9, {1, 1}}}) {
    EXPECT_EQ(tristimulus(bad).error().code, "SPECTRUM_INVALID");
    EXPECT_EQ(efficacy(bad, visible_band).error().code, "SPECTRUM_INVALID");
  }
  EXPECT_EQ(efficacy({360, 1, {0, 0}}, visible_band).error().code, "EFFICACY_UNDEFINED");
  EXPECT_EQ(efficacy(equal_energy(), {900, 1000}).error().code, "EFFICACY_UNDEFINED");
  EXPECT_EQ(efficacy(equal_energy(), {1e300, 1e301}).error().code, "EFFICACY_UNDEFINED");
  EXPECT_EQ(blackbody_efficacy(3000, {1e300, 1e301}).error().code, "EFFICACY_UNDEFINED");
  EXPECT_EQ(efficacy(equal_energy(), {700, 400}).error().code, "BAND_INVALID");
  for (const double kelvin : {0.0, -100.0, 99.0, 1e6, std::nan("")}) {
    EXPECT_EQ(blackbody_luminance(kelvin).error().code, "TEMPERATURE_OUT_OF_RANGE");
    EXPECT_EQ(blackbody_radiance(kelvin).error().code, "TEMPERATURE_OUT_OF_RANGE");
    EXPECT_EQ(blackbody_efficacy(kelvin, visible_band).error().code, "TEMPERATURE_OUT_OF_RANGE");
  }
}

// Errata of Frostbite 3.0. E10: eq 8 divides by radiation within 380 nm to 780 nm. A filament of 2856 K then has 155.8 lm/W, 22.8 % of 683,
// and table 6's 2 % to 5 % for incandescent light are those of the whole spectrum: 16.4 lm/W, 2.4 %.
TEST(Errata, E10EfficacyOfTheWholeSpectrum) {
  const double printed = *blackbody_efficacy(2856, visible_band), whole = *blackbody_efficacy(2856, whole_spectrum);
  EXPECT_NEAR(printed, 155.8, 0.1);
  EXPECT_NEAR(printed / 683, 0.228, 5e-4);
  EXPECT_NEAR(whole / 683, 0.024, 5e-4);
  const EfficacyPreset incandescent = *efficacy_preset("incandescent");
  EXPECT_TRUE(whole > incandescent.low_lm_W && whole < incandescent.high_lm_W);
  EXPECT_GT(printed, 4 * incandescent.high_lm_W);
}
// E11: table 6 says 15 % to 19 % for the sun. A radiator of 5772 K has 13.5 % of the whole spectrum and 28.9 % within the band.
TEST(Errata, E11TheSunIsNeither) {
  EXPECT_NEAR(*blackbody_efficacy(5772, whole_spectrum) / 683, 0.135, 5e-4);
  EXPECT_NEAR(*blackbody_efficacy(5772, visible_band) / 683, 0.289, 5e-4);
}
// E12: footnote 29's 1.6e9 cd/m2 without atmosphere. Over discs of .263 to .2725 degrees that is 105.9 to 113.7 klx, while its own table 11
// has 123.1 klx on the ground, hence 1.81e9; a disc of 5772 K has 1.84e9, 125.4 klx.
TEST(Errata, E12TheSunIsBrighter) {
  const auto projected = [](double radius_deg) { return pi * std::pow(std::sin(radius_deg * pi / 180), 2); };
  EXPECT_NEAR(1.6e9 * projected(0.263), 105.9e3, 100);
  EXPECT_NEAR(1.6e9 * projected(0.2725), 113.7e3, 100);
  EXPECT_NEAR(123.1e3 / projected(0.2666), 1.81e9, 5e6);
  EXPECT_NEAR(*blackbody_luminance(5772), 1.844e9, 5e5);
  EXPECT_NEAR(*blackbody_luminance(5772) * projected(0.2666), 125.4e3, 100);
}

TEST(Presets, AreInOrderAndKnowTheirNames) {
  EXPECT_EQ(temperature_presets().size(), 16U);
  for (const TemperaturePreset& preset : temperature_presets()) {
    EXPECT_LE(preset.low_K, preset.high_K);
    EXPECT_TRUE(planckian(preset.low_K).ok() && planckian(preset.high_K).ok());
    EXPECT_EQ(temperature_preset(preset.name)->low_K, preset.low_K);
    EXPECT_FALSE(preset.source.empty());
  }
  EXPECT_EQ(temperature_preset("candle flame")->high_K, 1930);
  EXPECT_EQ(temperature_preset("candle flam").error().code, "PRESET_UNKNOWN");
  EXPECT_NE(temperature_preset("candle flam").error().hint.find("candle flame"), std::string::npos);
  for (const EfficacyPreset& preset : efficacy_presets()) {
    EXPECT_TRUE(preset.low_lm_W > 0 && preset.low_lm_W <= preset.high_lm_W && preset.high_lm_W <= k_cd_lm_W) << preset.name;
    EXPECT_EQ(efficacy_preset(preset.name)->low_lm_W, preset.low_lm_W);
  }
  EXPECT_EQ(efficacy_preset("").error().code, "PRESET_UNKNOWN");
  // What a bulb takes up and what of it is seen: 100 W give 1580 lm at 15.8, not the 68300 of "683 lm/W".
  EXPECT_EQ(efficacy_preset("incandescent")->watts, WattsOf::electricity);
}

}  // namespace
}  // namespace etendue
