#include "etendue/spectrum.h"

#include "parameter_error.h"
#include "planck_locus.h"

#include "etendue/temperature.h"
#include "etendue/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

constexpr double nm = 1e-9;
constexpr int last_nm = first_nm + wavelength_count - 1;

double end_of(const Spectrum& spectrum) { return spectrum.first_nm + spectrum.step_nm * (static_cast<double>(spectrum.values.size()) - 1); }

Status valid(const Spectrum& spectrum) {
  constexpr double longest_nm = 1e6;
  const bool good = spectrum.first_nm >= 0 && spectrum.step_nm > 0 && end_of(spectrum) <= longest_nm && spectrum.values.size() >= 2 &&
                    std::all_of(spectrum.values.begin(), spectrum.values.end(), [](double v) { return v >= 0 && std::isfinite(v); });
  if (good) return Done{};
  return parameter_error(
      "spectrum", "SPECTRUM_INVALID",
      fmt::format("expected two values or more, finite and from 0 upwards, at positive steps between 0 nm and 1 mm, found {} from {} nm at "
                  "steps of {} nm",
                  spectrum.values.size(), spectrum.first_nm, spectrum.step_nm));
}

Status valid(const Band& band) {
  if (band.first_nm >= 0 && band.first_nm < band.last_nm) return Done{};
  return parameter_error(
      "band", "BAND_INVALID",
      fmt::format("expected a band from 0 nm upwards, its end after its beginning, found {} nm to {} nm", band.first_nm, band.last_nm));
}

Result<double> of_temperature(double temperature_K, double value) {
  const Result<double> checked = checked_temperature(temperature_K);
  return checked ? Result<double>(value) : checked;
}

double at(const Spectrum& spectrum, double wavelength_nm) {
  const double place = (wavelength_nm - spectrum.first_nm) / spectrum.step_nm;
  const double last = static_cast<double>(spectrum.values.size() - 1);
  if (!(place >= 0 && place <= last)) return 0;
  const auto i = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
  const double t = place - static_cast<double>(i);
  return spectrum.values[i] * (1 - t) + spectrum.values[i + 1] * t;
}

// Sum of f over whole nanometres of the band.
template <class F>
double summed(double low_nm, double high_nm, F f) {
  double sum = 0;
  if (!(low_nm <= high_nm)) return sum;
  const auto last = static_cast<int>(std::floor(high_nm));
  for (auto wavelength_nm = static_cast<int>(std::ceil(low_nm)); wavelength_nm <= last; ++wavelength_nm) sum += f(wavelength_nm);
  return sum;
}
double v_lambda(double wavelength_nm) {
  const int whole = static_cast<int>(wavelength_nm);
  return whole >= first_nm && whole <= last_nm ? colour_matching(whole).y : 0;
}

}  // namespace

Result<Vec3d> tristimulus(const Spectrum& spectrum) {
  if (const Status checked = valid(spectrum); !checked) return checked.error();
  Vec3d xyz;
  for (int i = first_nm; i <= last_nm; ++i) xyz += colour_matching(i) * at(spectrum, i);
  return xyz * k_m_lm_W;
}

Result<double> efficacy(const Spectrum& spectrum, const Band& band) {
  if (const Status checked = valid(spectrum); !checked) return checked.error();
  if (const Status checked = valid(band); !checked) return checked.error();
  const double low = std::max(band.first_nm, spectrum.first_nm), high = std::min(band.last_nm, end_of(spectrum));
  const double radiant = summed(low, high, [&](double l) { return at(spectrum, l); });
  if (!(radiant > 0))
    return parameter_error("spectrum", "EFFICACY_UNDEFINED", "expected a spectrum with radiation within the band, found none");
  return k_m_lm_W * summed(low, high, [&](double l) { return v_lambda(l) * at(spectrum, l); }) / radiant;
}

double planck_radiance(double wavelength_m, double temperature_K) {
  if (!(wavelength_m > 0 && temperature_K > 0)) return 0;
  const double fourth_power = wavelength_m * wavelength_m * wavelength_m * wavelength_m;
  const double exponent = c2_m_K / (wavelength_m * temperature_K);
  // exp(709) is the largest double's; above it the radiance is below 1e-300 of anything.
  return exponent > 700 ? 0 : c1l_W_m2_sr / (fourth_power * wavelength_m * std::expm1(exponent));
}

Result<double> blackbody_luminance(double temperature_K) {
  return of_temperature(temperature_K, k_m_lm_W * nm * summed(first_nm, last_nm, [&](double l) {
                                         return v_lambda(l) * planck_radiance(l * nm, temperature_K);
                                       }));
}

Result<double> blackbody_radiance(double temperature_K) {
  return of_temperature(temperature_K, sigma_W_m2_K4 * std::pow(temperature_K, 4) / pi);
}

Result<double> blackbody_efficacy(double temperature_K, const Band& band) {
  if (const Status checked = valid(band); !checked) return checked.error();
  constexpr double shortest_nm = 100, longest_nm = 10000;
  const bool whole = band.first_nm < shortest_nm && band.last_nm > longest_nm;
  const double low = std::max(band.first_nm, shortest_nm), high = std::min(band.last_nm, longest_nm);
  const double light = k_m_lm_W * nm * summed(std::max<double>(low, first_nm), std::min<double>(high, last_nm), [&](double l) {
                         return v_lambda(l) * planck_radiance(l * nm, temperature_K);
                       });
  const double radiance = whole ? sigma_W_m2_K4 * std::pow(temperature_K, 4) / pi
                                : nm * summed(low, high, [&](double l) { return planck_radiance(l * nm, temperature_K); });
  if (const Result<double> in_range = of_temperature(temperature_K, radiance); !in_range) return in_range.error();
  if (!(radiance > 0)) return parameter_error("band", "EFFICACY_UNDEFINED", "expected a band with radiation, found none");
  return light / radiance;
}

}  // namespace etendue
