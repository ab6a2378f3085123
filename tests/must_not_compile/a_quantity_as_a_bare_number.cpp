// refused: (convert|conversion)
// A number that leaves says its unit: nits.of(q).
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  const double x = nits.of(nits(5));
  return x > 0;
#else
  const double x = nits(5);
  return x > 0;
#endif
}
