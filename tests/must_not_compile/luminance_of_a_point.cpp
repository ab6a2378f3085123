// refused: no matching function for call to 'luminance
// A point has no surface, and so no luminance; a sphere has.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return luminance(lumens(1500), SphereShape{.radius = 0.15}).ok();
#else
  return luminance(lumens(1500), PointShape{}).ok();
#endif
}
