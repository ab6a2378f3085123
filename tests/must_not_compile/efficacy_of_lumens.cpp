// refused: no matching function for call to 'photometric
// Lumens are photometric already.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return photometric(watts(60), lumens_per_watt(15)).ok();
#else
  return photometric(lumens(900), lumens_per_watt(15)).ok();
#endif
}
