// Random numbers and colours for tests.
#pragma once

#include "etendue/vec.h"

#include <random>

namespace etendue {

class Draws {
 public:
  explicit Draws(unsigned seed) : generator_(seed) {}
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Rgb rgb(double low, double high) { return {within(low, high), within(low, high), within(low, high)}; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace etendue
