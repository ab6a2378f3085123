// The same 1500 lumens by what they come out of: candelas, nits, lux on a table 2 m away; and what has no answer.
#include "etendue/arithmetic.h"
#include "etendue/convert.h"
#include "etendue/formulas.h"

#include <cstdio>

namespace {

using namespace etendue;

// Shapes that are known while compiling: what a point does not have cannot be asked for.
void print_lamps() {
  const Flux flux = 3 * lumens(500);
  const auto globe = SphereShape{.radius = 0.15};
  const auto tube = TubeShape{.length = 1.2, .radius = 0.013};
  const auto downlight = SpotShape{.inner_rad = degrees(15).si, .outer_rad = degrees(30).si};
  const Length table = metres(2);
  std::printf("%-10s %10s %12s %10s\n", "", "cd", "cd/m2", "lx");
  std::printf("%-10s %10.2f %12s %10.3f\n", "point", candelas.of(*intensity(flux, PointShape{})), "-",
              lux.of(*illuminance(flux, PointShape{}, table)));
  std::printf("%-10s %10.2f %12s %10.3f\n", "downlight", candelas.of(*intensity(flux, downlight)), "-",
              lux.of(*illuminance(flux, downlight, table)));
  std::printf("%-10s %10.2f %12.2f %10.3f\n", "globe", candelas.of(*intensity(flux, globe)), nits.of(*luminance(flux, globe)),
              lux.of(*illuminance(flux, globe, table)));
  std::printf("%-10s %10.2f %12.2f %10.3f\n", "tube", candelas.of(*intensity(flux, tube)), nits.of(*luminance(flux, tube)),
              lux.of(*illuminance(flux, tube, table)));
}

// Shapes that are known at run time alone: an error, not a number.
void print_without_answer() {
  LightSetup setup;
  const Result<double> sizeless = convert({Dimension::luminous_flux, 1500}, Dimension::luminance, setup);
  std::printf("1500 lm in nit: %s\n", sizeless.error().code.c_str());
  const Result<double> watts = convert({Dimension::radiant_flux, 60}, Dimension::luminous_flux, setup);
  std::printf("60 W in lm: %s\n", watts.error().code.c_str());
  setup.efficacy_lm_W = 15;
  std::printf("60 W at 15 lm/W: %g lm\n", *convert({Dimension::radiant_flux, 60}, Dimension::luminous_flux, setup));
}

void print_why() {
  LightSetup setup;
  setup.shape = SphereShape{.radius = 0.15};
  std::printf("%s\n", explain({Dimension::luminous_flux, 1500}, Dimension::luminance, setup)->formula.c_str());
}

}  // namespace

int main() {
  print_lamps();
  print_without_answer();
  print_why();
}
