// refused: (convert|conversion)
// A unit reads back its own dimension alone.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return candelas.of(candelas(64)) > 0;
#else
  return candelas.of(lumens(64)) > 0;
#endif
}
