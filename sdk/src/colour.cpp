#include "etendue/colour.h"

#include "etendue/colour_space.h"
#include "etendue/temperature.h"
#include "parameter_error.h"
#include "planck_locus.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

constexpr Matrix3 from_rec709 = rgb_to_xyz(rec709), to_rec709 = xyz_to_rgb(rec709);

Error out_of_range(const char* what, double temperature_K, double low, double high) {
  return parameter_error("kelvin", "TEMPERATURE_OUT_OF_RANGE",
                         fmt::format("expected a temperature of {} between {} K and {} K, found {} K", what, low, high, temperature_K));
}

}  // namespace

Result<Chromaticity> planckian(double temperature_K) {
  const bool infinite = std::isinf(temperature_K) && temperature_K > 0;
  if (!infinite)
    if (const Result<double> checked = checked_temperature(temperature_K); !checked) return checked.error();
  // Planck's law without its constant factor, which chromaticity does not see: 1 / (lambda^5 (exp(c2 / (lambda T)) - 1)). Wavelengths are
  // in micrometres, and exp stays below e^400 at 100 K. With T exp(x) - 1 tends to x = c2 / (lambda T), and the spectrum to a multiple of
  // lambda^-4.
  Vec3d xyz;
  for (int nm = first_nm; nm < first_nm + wavelength_count; ++nm) {
    const double micrometres = nm * 1e-3;
    const double fourth_power = micrometres * micrometres * micrometres * micrometres;
    const double falling = infinite ? 1 : micrometres * std::expm1(c2_m_K * 1e6 / (micrometres * temperature_K));
    xyz += colour_matching(nm) / (fourth_power * falling);
  }
  const double sum = xyz.x + xyz.y + xyz.z;
  return Chromaticity{xyz.x / sum, xyz.y / sum};
}

// CIE 015:2018, eq 4.3 to 4.5.
Result<Chromaticity> daylight(double temperature_K) {
  constexpr double low = 4000, high = 25000;
  if (!(temperature_K >= low && temperature_K <= high)) return out_of_range("CIE daylight", temperature_K, low, high);
  const double m = 1e3 / temperature_K;
  const double x =
      temperature_K <= 7000 ? ((-4.6070 * m + 2.9678) * m + 0.09911) * m + 0.244063 : ((-2.0064 * m + 1.9018) * m + 0.24748) * m + 0.237040;
  return Chromaticity{x, (-3.000 * x + 2.870) * x - 0.275};
}

// Below 4000 K: the Planckian chromaticity and, in (u, v), the step to daylight at 4000 K faded out by a smooth ramp over mired.
Result<Chromaticity> daylight_or_planckian(double temperature_K) {
  constexpr double join_K = 4000, reached_K = 2500;
  if (!(temperature_K >= 100 && temperature_K <= 25000))
    return out_of_range("CIE daylight or below it a Planckian radiator", temperature_K, 100, 25000);
  if (temperature_K >= join_K) return daylight(temperature_K);
  const Chromaticity radiator = *planckian(temperature_K);
  if (temperature_K <= reached_K) return radiator;
  const double t = (1 / temperature_K - 1 / reached_K) / (1 / join_K - 1 / reached_K);
  const double weight = t * t * (3 - 2 * t);
  const Uv from = to_uv1960(*planckian(join_K)), to = to_uv1960(*daylight(join_K)), here = to_uv1960(radiator);
  return from_uv1960({here.u + weight * (to.u - from.u), here.v + weight * (to.v - from.v)});
}

Rgb to_rgb(const Chromaticity& xy) {
  // Any multiple of XYZ will do: it is scaled to luminance_of = 1 afterwards. The scale differs from the matrix' own middle row
  // (.212639, .715169, .072192) by less than 1e-4 for lights near white.
  const Rgb rgb = to_rec709 * Vec3d{xy.x, xy.y, 1 - xy.x - xy.y};
  const double luminance = luminance_of(rgb);
  return xy.y > 0 && luminance > 0 ? rgb / luminance : Rgb{0, 0, 0};
}

Chromaticity to_chromaticity(const Rgb& rgb) {
  const Vec3d xyz = from_rec709 * rgb;
  const double sum = xyz.x + xyz.y + xyz.z;
  return sum != 0 ? Chromaticity{xyz.x / sum, xyz.y / sum} : Chromaticity{0, 0};
}

Rgb clipped_keeping_luminance(const Rgb& rgb) {
  const double luminance = luminance_of(rgb);
  if (!(luminance > 0)) return {0, 0, 0};
  const Rgb clipped{std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
  return clipped * (luminance / luminance_of(clipped));
}

}  // namespace etendue
