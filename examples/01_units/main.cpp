// What a lamp's lumens mean: its candela, its nits, the exposure that meters it, and the lux on a table below.
//   example_units "806 lm" "6 cm" "2700 K"      (flux, diameter of the globe, colour temperature)
#include "etendue/light.h"
#include "etendue/units.h"

#include <cstdio>

namespace {

int fail(const etendue::Error& error) {
  std::fprintf(stderr, "%s\n", to_string(etendue::to_diagnostic(error)).c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace etendue;
  // A 60 W incandescent lamp, or the LED that replaces it.
  const char* flux_text = argc > 1 ? argv[1] : "806 lm";
  const char* diameter_text = argc > 2 ? argv[2] : "6 cm";
  const char* temperature_text = argc > 3 ? argv[3] : "2700 K";
  const Result<double> flux = parse_si(flux_text, Dimension::luminous_flux);
  if (!flux) return fail(flux.error());
  const Result<double> diameter = parse_si(diameter_text, Dimension::length);
  if (!diameter) return fail(diameter.error());
  const Result<double> temperature = parse_si(temperature_text, Dimension::temperature);
  if (!temperature) return fail(temperature.error());

  Light lamp;
  lamp.shape = SphereShape{*diameter / 2};
  lamp.emission.given = Emission::Given::flux;
  lamp.emission.value = *flux;
  lamp.colour = TemperatureColour{*temperature};
  const Result<Resolved> globe = resolve(lamp);
  if (!globe) return fail(globe.error());

  // Seen from afar it is a point: the same flux, as an intensity.
  lamp.shape = PointShape{};
  const Result<Resolved> point = resolve(lamp);
  if (!point) return fail(point.error());

  const double luminance = luminance_of(globe->rgb), intensity = luminance_of(point->rgb);
  const double table_m = 2;
  std::printf("%s, %s across, %s\n", flux_text, diameter_text, temperature_text);
  std::printf("intensity    %10.2f cd\n", intensity);
  std::printf("luminance    %10.1f cd/m2   (linear Rec.709 %.1f %.1f %.1f)\n", luminance, globe->rgb.x, globe->rgb.y, globe->rgb.z);
  std::printf("EV100        %10.2f         (of its surface, K = 12.5)\n", ev100_of_luminance(luminance));
  std::printf("illuminance  %10.2f lx      (facing it, %.0f m away)\n", intensity / (table_m * table_m), table_m);
  return 0;
}
