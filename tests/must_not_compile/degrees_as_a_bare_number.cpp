// refused: solid_angle_of_cone
// 30 of what? Angles are degrees or radians, and say so.
#include "etendue/light_units.h"

using namespace etendue;

int main() {
#ifdef RIGHT
  return solid_angle_of_cone(degrees(30)).ok();
#else
  return solid_angle_of_cone(30.0).ok();
#endif
}
