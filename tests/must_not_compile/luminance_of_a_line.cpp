// refused: no matching function for call to 'luminance
// A line is too thin for a luminance; a tube is not.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return luminance(lumens(1500), TubeShape{.length = 1, .radius = 0.01}).ok();
#else
  return luminance(lumens(1500), LineShape{.length = 1}).ok();
#endif
}
