// refused: no matching function for call to 'luminance
// Lumens become nits by the size of what emits them.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return luminance(lumens(1500), SurfaceOfArea{.area_m2 = 0.2}).ok();
#else
  return luminance(lumens(1500)).ok();
#endif
}
