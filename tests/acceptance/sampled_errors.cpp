// Lines: shape, above|across, estimates by sampling, how many are further from the reference than both errors and how many may be, mean
// square of the difference over the standard error where no sample is rare, its own standard error, part of the estimates of which that is,
// mean of the error told over the value. Arguments: lights for each BRDF and roughness (20), samples (16384).
#include <fmt/core.h>

#include <cstdlib>

#include "sampled_agreement.h"

int main(int argc, char** argv) {
  using namespace etendue::eval;
  using namespace etendue::eval::protocol;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 20;
  const auto samples = static_cast<std::uint64_t>(argc > 2 ? std::atoi(argv[2]) : 16384);
  constexpr const char* names[] = {"rect", "sphere", "disk", "tube", "flat-tube", "open-tube", "polygon", "line"};
  for (const Kind kind : every_kind) {
    for (const bool above : {true, false}) {
      const SampledAgreement a = agreement(kind, above, rounds, {samples, 1});
      fmt::print("{} {} {} {} {} {:.3f} {:.3f} {:.3f} {:.2g}\n", names[static_cast<std::size_t>(kind)], above ? "above" : "across", a.count,
                 a.beyond_error + a.not_numbers, exceedances(a.count), a.mean_square, a.square_error,
                 static_cast<double>(a.settled) / static_cast<double>(a.count), a.mean_error);
    }
  }
}
