// refused: operator<
// Which is more, 5 cd or 6 lm, has no answer.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return candelas(5) < candelas(6);
#else
  return candelas(5) < lumens(6);
#endif
}
