#include "etendue/camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

CameraSettings settings(double f_number, double shutter_s, double iso) {
  CameraSettings camera;
  camera.f_number = f_number;
  camera.shutter_s = shutter_s;
  camera.iso = iso;
  return camera;
}
const Calibration& frostbite() {
  static const Calibration found = *calibration("frostbite");
  return found;
}

TEST(Ev100, SunnySixteen) {
  EXPECT_NEAR(*ev100(settings(16, 1.0 / 125, 100)), 14.966, 5e-4);
  EXPECT_NEAR(*ev100(settings(16, 1.0 / 100, 100)), 14.644, 5e-4);
  EXPECT_EQ(*ev_s(settings(16, 1.0 / 4, 100)), 10);
  EXPECT_EQ(*ev100(settings(1, 1, 100)), 0);
  // Each row of the table lets in about a stop more light than the one before; marked f-numbers are rounded by up to .081 stop each.
  const std::span<const SunnySixteen> rows = sunny_sixteen();
  ASSERT_EQ(rows.size(), 6U);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_NEAR(2 * std::log2(rows[i - 1].f_number / rows[i].f_number), 1, 0.12);
}

// Errata of Frostbite 3.0. E1: listing 28 takes the square root of the aperture, where eq 67 and its own comment have the square. A full
// stop of aperture then moves it by a quarter.
TEST(Errata, E1ApertureIsSquared) {
  const auto printed = [](double n, double t, double s) { return std::log2(std::sqrt(n) / t * 100 / s); };
  EXPECT_NEAR(printed(16, 1.0 / 125, 100), 8.966, 5e-4);
  EXPECT_NEAR(*ev100(settings(16, 1.0 / 125, 100)) - printed(16, 1.0 / 125, 100), 1.5 * std::log2(16), 1e-12);
  const double a_stop = std::sqrt(2.0);
  EXPECT_NEAR(printed(8 * a_stop, 0.01, 100) - printed(8, 0.01, 100), 0.25, 1e-12);
  EXPECT_NEAR(*ev100(settings(8 * a_stop, 0.01, 100)) - *ev100(settings(8, 0.01, 100)), 1, 1e-12);
}
// E2: eq 69 calls log2(L S / K) an EV100; it is one for S = 100 alone.
TEST(Errata, E2MeterReadsEv100WithoutIso) {
  const auto printed = [](double luminance, double s) { return std::log2(luminance * s / 12.5); };
  EXPECT_NEAR(printed(4096, 400), 17, 1e-12);
  EXPECT_NEAR(*ev100_of_luminance(4096, frostbite()), 15, 1e-12);
  EXPECT_NEAR(printed(4096, 100), *ev100_of_luminance(4096, frostbite()), 1e-12);
}
// E3: what the meter aims at becomes 10.42 % of saturation with K = 12.5, q = .65 and 78, not 18 % / sqrt 2 = 12.73 %; that needs q near
// .8.
TEST(Errata, E3MeteredLuminanceIsTenPercent) {
  const double metered = luminance_of_ev100(7, frostbite()) * exposure_of_ev100(7, frostbite());
  EXPECT_NEAR(metered, 0.125 / 1.2, 1e-12);
  EXPECT_NEAR(metered, 0.1042, 5e-5);
  EXPECT_GT(0.18 / std::sqrt(2.0) - metered, 0.023);
  Calibration clear = frostbite();
  clear.lens_q = 0.8;
  EXPECT_NEAR(luminance_of_ev100(7, clear) * exposure_of_ev100(7, clear), 10.0 / 78, 1e-12);
}
// E4: listing 28's comment divides by the camera's S; N^2/t = 2^EV100 S/100, so the S cancels and 100 stays. An ISO 400 camera shows it.
TEST(Errata, E4SensitivityCancels) {
  const CameraSettings camera = settings(8, 1.0 / 60, 400);
  const double direct = 78 / (400 * 0.65) * (8 * 8 * 60);  // 78 / (S q) N^2 / t
  const double ev = *ev100(camera);
  EXPECT_NEAR(1 / *exposure_of(camera, frostbite()) / direct, 1, 1e-12);
  EXPECT_NEAR(78 / (100 * 0.65) * std::exp2(ev) / direct, 1, 1e-12);
  EXPECT_NEAR(78 / (400 * 0.65) * std::exp2(ev) / direct, 0.25, 1e-12);  // as the comment says
}
// E5: listing 29 with no compensation gives the meter's 10.4 % of saturation; blooming begins 3.263 stops above.
TEST(Errata, E5BloomNeedsThreeStops) {
  EXPECT_NEAR(bloom_compensation(frostbite()), 3.263, 5e-4);
  const double saturation = saturation_of_ev100(9, frostbite());
  EXPECT_NEAR(emissive_luminance(9, 0, frostbite()) / saturation, 0.1042, 5e-5);
  EXPECT_NEAR(emissive_luminance(9, bloom_compensation(frostbite()), frostbite()) / saturation, 1, 1e-12);
}

// Frostbite's table 7: EV100 -4 to 16, printed to three digits (0.0078 as 0.008).
TEST(Luminance, IsFrostbitesTable7) {
  const double printed[] = {0.008, 0.016, 0.031, 0.063, 0.125, 0.25, 0.5, 1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192};
  for (int ev = -4; ev <= 16; ++ev) {
    EXPECT_EQ(luminance_of_ev100(ev, frostbite()), std::exp2(ev - 3));
    EXPECT_NEAR(luminance_of_ev100(ev, frostbite()), printed[ev + 4], 5.0001e-4);
    EXPECT_EQ(illuminance_of_ev100(ev, frostbite()), 2.5 * std::exp2(ev));
    EXPECT_NEAR(*ev100_of_luminance(std::exp2(ev - 3), frostbite()), ev, 1e-14 * 16);
    EXPECT_NEAR(*ev100_of_illuminance(2.5 * std::exp2(ev), frostbite()), ev, 1e-14 * 16);
  }
  EXPECT_EQ(luminance_of_ev100(5, frostbite()), luminance_of_ev100(5));
  EXPECT_EQ(exposure_of_ev100(5, frostbite()), exposure_of_ev100(5));
}

TEST(Calibration, EnginesDifferByTheirLens) {
  EXPECT_NEAR(saturation_of_ev100(0, *calibration("filament")), 1.2, 1e-15);
  EXPECT_NEAR(saturation_of_ev100(0, *calibration("hdrp")), 1.2, 1e-15);
  EXPECT_NEAR(saturation_of_ev100(0, *calibration("unreal")), 1.0, 1e-15);
  EXPECT_NEAR(saturation_of_ev100(0, *calibration("usd")), 1.0, 1e-15);
  // The same EV100 in two engines: .263 stop apart.
  EXPECT_NEAR(std::log2(exposure_of_ev100(15, *calibration("unreal")) / exposure_of_ev100(15, *calibration("hdrp"))), 0.263, 5e-4);
  // Standard output sensitivity: 1.17 / 2^EV, .49 stop above saturation-based; 18 % where H = 10/S.
  const Calibration sos = *calibration("iso_sos"), sbs = *calibration("iso_sbs");
  EXPECT_NEAR(exposure_of_ev100(0, sos), 1.17, 1e-12);
  EXPECT_NEAR(std::log2(exposure_of_ev100(0, sos) / exposure_of_ev100(0, sbs)), 0.49, 5e-3);
  for (const Calibration& known : calibrations()) EXPECT_FALSE(known.source.empty()) << known.name;
}

TEST(Calibration, PbrtKnowsNoAperture) {
  const Calibration pbrt = *calibration("pbrt");
  EXPECT_NEAR(*exposure_of(settings(1.4, 1, 100), pbrt), 1, 1e-12);
  EXPECT_NEAR(*exposure_of(settings(22, 1.0 / 50, 400), pbrt), 4.0 / 50, 1e-12);
}

TEST(Calibration, MisspeltNamesAreAnswered) {
  const Result<Calibration> none = calibration("filamnt");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, "CALIBRATION_UNKNOWN");
  EXPECT_NE(none.error().hint.find("filament"), std::string::npos);
}

TEST(Shutter, AngleAndFrameRate) {
  CameraSettings camera;
  camera.t_stop = 2.8;
  camera.shutter_angle_rad = pi;
  camera.frames_per_s = 24;
  camera.iso = 800;
  EXPECT_NEAR(*shutter_time(camera), 1.0 / 48, 1e-17);
  EXPECT_NEAR(*ev100(camera), std::log2(2.8 * 2.8 * 48 / 8), 1e-13);
  camera.shutter_angle_rad = 2 * pi;
  EXPECT_NEAR(*shutter_time(camera), 1.0 / 24, 1e-17);
}

// Density .9 is 2.99 stops, as filters of .3 a stop are labelled; compensation is the other way round (eq 68).
TEST(Filters, DarkenAndCompensationBrightens) {
  CameraSettings camera = settings(4, 1.0 / 60, 100);
  const double plain = *exposure_of(camera, frostbite());
  camera.nd_density = 0.9;
  EXPECT_NEAR(*exposure_of(camera, frostbite()) / plain, std::pow(10, -0.9), 1e-14);
  EXPECT_NEAR(*effective_ev100(camera) - *ev100(camera), 2.99, 5e-3);
  camera.nd_density = 0;
  camera.compensation_stop = 1.5;
  EXPECT_NEAR(std::log2(*exposure_of(camera, frostbite()) / plain), 1.5, 1e-13);
}

// A lens of T-stop T and one of f-number T sqrt(transmission) are the same lens.
TEST(TStop, CarriesTheLensLoss) {
  CameraSettings by_t = settings(0, 1.0 / 48, 800), by_n = by_t;
  by_t.f_number.reset();
  by_t.t_stop = 2.0;
  by_n.f_number = 2.0 * std::sqrt(typical_lens.transmission);
  const double t = sensor_exposure(100, by_t, 0.65)->exposure_lx_s, n = sensor_exposure(100, by_n, 0.65)->exposure_lx_s;
  EXPECT_NEAR(t / n, 1, 1e-14);
  EXPECT_NEAR(*exposure_of(by_t, frostbite()) / *exposure_of(by_n, frostbite()), 1, 1e-14);
}

// At the saturation luminance of eq 75 the sensor has H = 78 / S (eq 72 to 74); q of the typical lens is .6516.
TEST(Sensor, SaturatesAtItsExposure) {
  EXPECT_NEAR(lens_q(typical_lens), 0.6516, 5e-5);
  EXPECT_NEAR(78 / (100 * lens_q(typical_lens)), 1.1971, 5e-5);
  for (const double iso : {100.0, 400.0, 3200.0}) {
    const CameraSettings camera = settings(5.6, 1.0 / 250, iso);
    const double saturation = 1 / *exposure_of(camera, frostbite());
    const SensorExposure at = *sensor_exposure(saturation, camera, 0.65);
    EXPECT_NEAR(at.exposure_lx_s * iso / 78, 1, 1e-13);
    EXPECT_NEAR(at.illuminance_lx * (1.0 / 250), at.exposure_lx_s, 1e-16);
  }
  // All cells together receive H times the area of the sensor.
  const Sensor sensor;
  EXPECT_NEAR(*cell_energy(0.5, sensor) * 5760 * 3240, 0.5 * 0.036 * 0.024, 1e-18);
}

// The disc of the sun, 1.6e9 cd/m2, fits half's 65504 from EV100 14.31 upwards, or 14.58 with a factor of 1.
TEST(PreExposure, SunInHalf) {
  EXPECT_NEAR(least_ev100_that_stores(1.6e9, 65504, frostbite()), 14.31, 5e-3);
  EXPECT_NEAR(least_ev100_that_stores(1.6e9, 65504, *calibration("unreal")), 14.58, 5e-3);
  const double ev = least_ev100_that_stores(1.6e9, 65504, frostbite());
  EXPECT_NEAR(1.6e9 * exposure_of_ev100(ev, frostbite()) / 65504, 1, 1e-12);
}

TEST(BadSettings, AreNamed) {
  struct Case {
    CameraSettings camera;
    const char *code, *names;
  };
  CameraSettings no_aperture = settings(4, 0.01, 100), both = no_aperture, no_rate = no_aperture, wide = no_aperture, no_iso = no_aperture,
                 filter = no_aperture, compensation = no_aperture;
  no_aperture.f_number.reset();
  both.t_stop = 4;
  no_rate.shutter_s.reset();
  no_rate.shutter_angle_rad = pi;
  wide = no_rate;
  wide.frames_per_s = 24;
  wide.shutter_angle_rad = 180;  // degrees taken for radians
  no_iso.iso.reset();
  filter.nd_density = -0.3;
  compensation.compensation_stop = HUGE_VAL;
  const Case cases[] = {
      {settings(0, 0.01, 100), "CAMERA_SETTING_INVALID", "f-number"},
      {settings(-4, 0.01, 100), "CAMERA_SETTING_INVALID", "f-number"},
      {settings(4, 0, 100), "CAMERA_SETTING_INVALID", "shutter time"},
      {settings(4, HUGE_VAL, 100), "CAMERA_SETTING_INVALID", "shutter time"},  // "1/0 s"
      {settings(4, 0.01, 0), "CAMERA_SETTING_INVALID", "ISO"},
      {settings(4, 0.01, std::nan("")), "CAMERA_SETTING_INVALID", "ISO"},
      {no_aperture, "CAMERA_SETTING_MISSING", "f-number"},
      {both, "CAMERA_SETTING_AMBIGUOUS", "T-stop"},
      {no_rate, "CAMERA_SETTING_MISSING", "frame rate"},
      {wide, "CAMERA_SETTING_INVALID", "360"},
      {no_iso, "CAMERA_SETTING_MISSING", "sensitivity"},
      {filter, "CAMERA_SETTING_INVALID", "density"},
      {compensation, "CAMERA_SETTING_INVALID", "compensation"},
  };
  for (const Case& c : cases) {
    const Result<double> exposure = exposure_of(c.camera, frostbite());
    ASSERT_FALSE(exposure.ok()) << c.names;
    EXPECT_EQ(exposure.error().code, c.code);
    EXPECT_NE(exposure.error().text.find(c.names), std::string::npos) << exposure.error().text;
  }
  for (const double bad : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(ev100_of_luminance(bad, frostbite()).error().code, "LUMINANCE_NOT_POSITIVE");
    EXPECT_EQ(ev100_of_illuminance(bad, frostbite()).error().code, "ILLUMINANCE_NOT_POSITIVE");
  }
  EXPECT_FALSE(cell_energy(1, {.width_m = 0}).ok());
  EXPECT_FALSE(sensor_exposure(-1, settings(4, 0.01, 100), 0.65).ok());
}

}  // namespace
}  // namespace etendue
