// refused: (convert|conversion)
// Candelas are no lumens, however often a spot is sold by them.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  const Flux flux = lumens(64);
  return flux == lumens(64);
#else
  const Flux flux = candelas(64);
  return flux == lumens(64);
#endif
}
