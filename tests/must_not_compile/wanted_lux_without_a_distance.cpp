// refused: no matching function for call to 'illuminance
// Nor do lux that are wanted.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return illuminance(lumens(800), PointShape{}, metres(2)).ok();
#else
  return illuminance(lumens(800), PointShape{}).ok();
#endif
}
