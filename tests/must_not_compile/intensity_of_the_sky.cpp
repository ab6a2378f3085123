// refused: no matching function for call to 'intensity
// A sky has no intensity: it is all around. It has a luminance.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return luminance(lux(1000), EnvironmentShape{}).ok();
#else
  return intensity(lux(1000), EnvironmentShape{}).ok();
#endif
}
