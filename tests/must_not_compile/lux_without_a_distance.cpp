// refused: no matching function for call to 'intensity
// Lux of a near light mean nothing without the distance at which they are measured.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return intensity(lux(15000) | at(metres(2)), PointShape{}).ok();
#else
  return intensity(lux(15000), PointShape{}).ok();
#endif
}
