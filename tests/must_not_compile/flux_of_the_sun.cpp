// refused: no matching function for call to 'flux
// A light infinitely far away has no flux that could be counted; it has an illuminance.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return illuminance(nits(1.6e9), DistantShape{.diameter_rad = 0.0093}).ok();
#else
  return flux(nits(1.6e9), DistantShape{.diameter_rad = 0.0093}).ok();
#endif
}
