#include "etendue/temperature.h"

#include "etendue/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

TEST(Temperature, TheRangeIsThatOfPlanckianRadiators) {
  for (const double kelvin : {coldest_K, 500.0, 5772.0, hottest_K}) {
    EXPECT_EQ(*checked_temperature(kelvin), kelvin);
    EXPECT_TRUE(planckian(kelvin).ok());
    EXPECT_FALSE(clamped_temperature(kelvin)->clamped);
  }
  for (const double none : {std::nextafter(coldest_K, 0), std::nextafter(hottest_K, inf), 0.0, -100.0, nan, -inf}) {
    EXPECT_EQ(checked_temperature(none).error().code, "TEMPERATURE_OUT_OF_RANGE") << none;
    EXPECT_EQ(planckian(none).error().code, "TEMPERATURE_OUT_OF_RANGE") << none;
    EXPECT_EQ(planckian(none).error().where.pointer, "/kelvin");
  }
}

TEST(Temperature, ClampsWhatIsATemperature) {
  EXPECT_EQ(clamped_temperature(1e-300)->kelvin, coldest_K);
  EXPECT_EQ(clamped_temperature(inf)->kelvin, hottest_K);
  EXPECT_EQ(clamped_temperature(200000)->kelvin, hottest_K);
  EXPECT_TRUE(clamped_temperature(200000)->clamped);
  for (const double none : {0.0, -100.0, nan}) EXPECT_EQ(clamped_temperature(none).error().code, "TEMPERATURE_OUT_OF_RANGE") << none;
}

}  // namespace
}  // namespace etendue
