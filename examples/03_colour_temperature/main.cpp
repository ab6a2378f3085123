// Lamps by their colour temperature: chromaticity and linear Rec.709, and back from what a meter shows; a filter in front of them.
#include "etendue/colour.h"

#include <cstdio>

int main() {
  using namespace etendue;
  std::printf("%8s %8s %8s %8s %8s %8s\n", "K", "x", "y", "R", "G", "B");
  for (const double kelvin : {2000, 2700, 3200, 4000, 5600, 6500, 10000}) {
    const Chromaticity xy = *planckian(kelvin);
    const Rgb rgb = to_rgb(xy);
    std::printf("%8.0f %8.5f %8.5f %8.4f %8.4f %8.4f\n", kelvin, xy.x, xy.y, rgb.x, rgb.y, rgb.z);
  }

  // D65 is no black body: it lies above the locus, at a correlated temperature of its own.
  const ColourTemperature d65 = *to_colour_temperature(Chromaticity{0.3127, 0.3290});
  std::printf("D65: %.2f K, Duv %.5f\n", d65.kelvin, d65.duv);

  // A full CTO brings daylight to tungsten: +159 mired.
  std::printf("5600 K behind +159 mired: %.0f K\n", *shifted_by_mired(5600, 159));

  const Result<ColourTemperature> green = to_colour_temperature(Chromaticity{0.3, 0.6});
  std::printf("x .3, y .6: %s\n", green.error().code.c_str());
}
