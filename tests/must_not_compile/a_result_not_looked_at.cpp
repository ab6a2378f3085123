// refused: nodiscard
// A conversion may fail: SIZE_MISSING, NUMBER_INVALID.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return luminance(lumens(1500), SphereShape{.radius = 0.15}).ok();
#else
  luminance(lumens(1500), SphereShape{.radius = 0.15});
#endif
}
