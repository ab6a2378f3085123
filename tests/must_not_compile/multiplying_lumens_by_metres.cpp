// refused: operator\*
// A product is there where it has a meaning.
#include "etendue/arithmetic.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return (candelas(5) * steradians(6)).si > 0;
#else
  return (lumens(5) * metres(6)).si > 0;
#endif
}
