// refused: (convert|conversion)
// A distance is in metres or in feet, and says so.
#include "etendue/arithmetic.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return intensity(lux(15000) | at(metres(2)), PointShape{}).ok();
#else
  return intensity(lux(15000) | at(2.0), PointShape{}).ok();
#endif
}
