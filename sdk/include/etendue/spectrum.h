// Spectra against the CIE 1931 2 degree observer, 360 nm to 830 nm summed at 1 nm: what they look like, how much light they are.
//   double lm_per_W = *blackbody_efficacy(2856, whole_spectrum);      // 16.4: of all that a bulb's filament radiates
//   double in_band = *efficacy(my_lamp, visible_band);                // of a measured spectrum
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

#include <limits>
#include <vector>

namespace etendue {

// Luminous efficacy of radiation at 540 THz, which defines the candela, and the factor of sums over V(lambda). V is tabulated over
// wavelengths in air and is 1 at 555 nm, while 540 THz are 555.0173 nm there: 683 / V(555.0173) = 683.002. 2.9e-6 apart.
inline constexpr double k_cd_lm_W = 683, k_m_lm_W = 683.002;
// First radiation constant for radiance 2 h c^2 (W m2/sr), second h c / k (m K), Stefan-Boltzmann's (W m-2 K-4): SI 2019.
inline constexpr double c1l_W_m2_sr = 1.191042972e-16, c2_m_K = 1.438776877e-2, sigma_W_m2_K4 = 5.670374419e-8;

// A quantity per nanometre at equal steps; between them it is linear, outside it is zero.
struct Spectrum {
  double first_nm = 360, step_nm = 1;
  std::vector<double> values;
};
// All of these: SPECTRUM_INVALID unless there are two values or more, finite, none negative, at positive steps within 0 nm to 1 mm.
// K_m times the sums over the colour-matching functions: Y is the photometric twin of the spectrum's quantity (cd/m2 of W/m2/sr/nm).
Result<Vec3d> tristimulus(const Spectrum& spectrum);

// Which radiation an efficacy counts: light by radiation within these wavelengths. Others' figures rarely say; a white LED has next to
// nothing outside of 380 nm to 780 nm, a filament has nine tenths there.
struct Band {
  double first_nm = 380, last_nm = 780;
};
inline constexpr Band visible_band{};
inline constexpr Band whole_spectrum{0, std::numeric_limits<double>::infinity()};
// lm/W. Sums at 1 nm within the band; of the whole spectrum what there is in the table. EFFICACY_UNDEFINED for darkness; BAND_INVALID.
Result<double> efficacy(const Spectrum& spectrum, const Band& band);

// Planck's law, W/(m2 sr m): c1L / (lambda^5 (exp(c2 / (lambda T)) - 1)). 0 for what is no positive wavelength or temperature.
double planck_radiance(double wavelength_m, double temperature_K);
// Of Planckian radiators, 100 K to 100000 K; TEMPERATURE_OUT_OF_RANGE. Luminance in cd/m2; radiance sigma T^4 / pi in W/m2/sr.
Result<double> blackbody_luminance(double temperature_K);
Result<double> blackbody_radiance(double temperature_K);
// At most 95.43 lm/W of the whole spectrum (6628 K). Bands within 100 nm to 10 um are summed at 1 nm.
Result<double> blackbody_efficacy(double temperature_K, const Band& band);

}  // namespace etendue
