// refused: no matching function for call to 'flux
// Watts say nothing about light without an efficacy.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return photometric(watts(60), lumens_per_watt(15)).ok();
#else
  return flux(watts(60), PointShape{}).ok();
#endif
}
