// refused: operator\*
// Twice the light is one stop more, not twice the exposure value.
#include "etendue/arithmetic.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return (ev100s(5) + Quantity<Dimension::stop>{1}).si > 0;
#else
  return (2 * ev100s(5)).si > 0;
#endif
}
