// refused: operator\+
// Exposure values are logarithms: stops are added to one, not another one.
#include "etendue/arithmetic.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return (ev100s(5) + Quantity<Dimension::stop>{6}).si > 0;
#else
  return (ev100s(5) + ev100s(6)).si > 0;
#endif
}
