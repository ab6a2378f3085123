// refused: no matching function for call to 'flux
// A spot is not lit in nits; a disk is.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return flux(nits(1000), DiskShape{.radius = 0.1}).ok();
#else
  return flux(nits(1000), SpotShape{}).ok();
#endif
}
