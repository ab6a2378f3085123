// What the packed formats of pixel.h can hold, measured by sending grey through them: Frostbite's table 14 made anew.
#pragma once

#include "etendue/colour.h"
#include "etendue/pixel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace etendue {

struct PixelFormat {
  std::string name, bits;
  std::function<double(double)> round_trip;  // of one channel of a grey pixel
  bool floating;                             // equal relative error from some number upwards
};

inline std::vector<PixelFormat> pixel_formats() {
  static PackCounts counts;
  constexpr double range = 8;  // of RGBM and RGBD: their largest value, nothing else depends on it
  return {
      {"float", "1 + 23 + 8", [](double x) -> double { return x > 3.5e38 ? std::numeric_limits<float>::max() : static_cast<float>(x); },
       true},
      {"half", "1 + 10 + 5", [](double x) { return unpack_half(pack_half(x, counts)); }, true},
      {"R11 G11", "6 + 5",
       [](double x) {
         return unpack_r11g11b10f(pack_r11g11b10f({x, x, x}, counts)).x;
       },
       true},
      {"B10", "5 + 5",
       [](double x) {
         return unpack_r11g11b10f(pack_r11g11b10f({x, x, x}, counts)).z;
       },
       true},
      {"RGB9E5", "9, shared 5",
       [](double x) {
         return unpack_rgb9e5(pack_rgb9e5({x, x, x}, counts)).x;
       },
       true},
      {"RGBE", "8, shared 8",
       [](double x) {
         return unpack_rgbe(pack_rgbe({x, x, x}, counts)).x;
       },
       true},
      {"LogLuv (luminance)", "1 + 15",
       [](double x) {
         return luminance_of(unpack_logluv(pack_logluv({x, x, x}, counts)));
       },
       true},
      {"RGBM 8", "8, shared 8",
       [](double x) {
         return unpack_rgbm(pack_rgbm({x, x, x}, range, counts), range).x;
       },
       false},
      {"RGBD 8", "8, shared 8",
       [](double x) {
         return unpack_rgbd(pack_rgbd({x, x, x}, range, counts), range).x;
       },
       false},
      {"10-10-10-2", "10",
       [](double x) {
         return unpack_rgb10a2(pack_rgb10a2({x, x, x}, 1, counts)).x;
       },
       false},
  };
}

struct PixelLimits {
  double largest = 0, smallest = 0;   // smallest above 0
  double least_precise = 0;           // from here upwards the relative error is what it is at the top; 0 if it is never
  double relative_error = 0;          // largest, from there upwards; of the others: in the brightest stop
  double digits = 0;                  // -log10 of it: 7.22 for float
  std::array<int, 4> steps_a_stop{};  // in the stops that begin 0, 4, 8 and 16 stops below the largest number
  double stops() const { return std::log2(largest / smallest); }
};

// The largest |stored / x - 1| over a fine ramp of one stop below `top`, and how many steps the stored ramp has.
struct Stop {
  double relative_error = 0;
  int steps = 0;
};
inline Stop measured_stop(const PixelFormat& format, double top, int samples = 1 << 17) {
  Stop stop;
  double before = format.round_trip(top / 2);
  for (int i = 0; i < samples; ++i) {
    const double x = top * std::exp2(-static_cast<double>(samples - i) / samples), stored = format.round_trip(x);
    stop.relative_error = std::max(stop.relative_error, std::abs(stored / x - 1));
    stop.steps += stored != before ? 1 : 0;
    before = stored;
  }
  return stop;
}

inline PixelLimits measured_limits(const PixelFormat& format) {
  PixelLimits limits;
  limits.largest = format.round_trip(std::numeric_limits<double>::infinity());
  double zero = 0, stored = limits.largest;  // bisect between a number that is stored as 0 and one that is not
  while (std::nextafter(zero, stored) < stored) {
    const double middle = zero > 0 ? std::sqrt(zero) * std::sqrt(stored) : stored * 0x1p-200;
    if (middle <= zero || middle >= stored) break;
    (format.round_trip(middle) > 0 ? stored : zero) = middle;
    if (zero == 0 && stored < 1e-200) break;
  }
  limits.smallest = format.round_trip(stored);
  const Stop brightest = measured_stop(format, limits.largest);
  limits.relative_error = brightest.relative_error;
  if (format.floating) {
    // Down, stop by stop, while the error stays; powers of two are where the precision of all of these ends.
    double top = std::exp2(std::ceil(std::log2(limits.largest)));
    while (top / 2 >= limits.smallest) {
      const double error = measured_stop(format, top / 2, 1 << 12).relative_error;
      if (error > brightest.relative_error * 1.01) break;
      limits.relative_error = std::max(limits.relative_error, error);
      top /= 2;
    }
    limits.least_precise = top / 2;
  }
  limits.digits = -std::log10(limits.relative_error);
  const int below[] = {0, 4, 8, 16};
  for (std::size_t i = 0; i < std::size(below); ++i)
    limits.steps_a_stop[i] = measured_stop(format, limits.largest * std::exp2(-below[i])).steps;
  return limits;
}

// Grey through R11G11B10F: the largest difference of blue from red, relative.
inline double largest_tint_of_r11g11b10f() {
  double largest = 0;
  PackCounts counts;
  for (int i = 0; i < 1 << 16; ++i) {
    const double x = std::exp2(i / 65536.0);
    const Rgb stored = unpack_r11g11b10f(pack_r11g11b10f({x, x, x}, counts));
    largest = std::max(largest, std::abs(stored.z / stored.x - 1));
  }
  return largest;
}

}  // namespace etendue
