// refused: operator\+
// Their sum has no meaning.
#include "etendue/arithmetic.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return (lumens(5) + lumens(6)).si > 0;
#else
  return (candelas(5) + lumens(6)).si > 0;
#endif
}
