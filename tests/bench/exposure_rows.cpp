// Linear conversions, exposure values.
#include "peers.h"
#include "units_rows.h"

#include "etendue/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue::bench {
namespace {

struct Buffers {
  std::vector<float> lumens, candelas, ev, luminance, out;
  Calibration calibration = *etendue::calibration("frostbite");
};
// Lives as long as the program: the contenders refer to it.
Buffers& buffers() {
  static Buffers all = [] {
    Buffers b;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const auto t = static_cast<float>(i) / batch_size;
      b.lumens.push_back(10 + 5000 * t);
      b.ev.push_back(-8 + 24 * t);
      b.luminance.push_back(static_cast<float>(luminance_of_ev100(b.ev.back(), b.calibration)));
    }
    b.candelas.resize(batch_size);
    b.out.resize(batch_size);
    return b;
  }();
  return all;
}

double ev_error_of(std::span<const float> luminance) {
  double worst = 0;
  const Buffers& b = buffers();
  for (std::size_t i = 0; i < batch_size; ++i)
    worst = std::max(worst, std::abs(std::log2(luminance[i] / luminance_of_ev100(static_cast<double>(b.ev[i]), b.calibration))));
  return worst;
}

}  // namespace

void exposure_rows(Bench& bench) {
  Buffers& b = buffers();

  Task& linear = bench.task("lumens to candelas of a point", batch_size);
  add_bare_multiply(linear, b.lumens, b.candelas);
  linear.contender("etendue scaled()", Kind::ours, "1 ulp", [&b] {
    (void)scaled(b.lumens, 1 / (4 * pi), b.candelas);
    keep(b.candelas.data());
  });

  Task& to_nits = bench.task("EV100 to cd/m2", batch_size);
  add_bare_multiply(to_nits, b.ev, b.out);
  (void)luminance_of_ev100(b.ev, b.calibration, b.out, 0);
  to_nits.contender("etendue luminance_of_ev100()", Kind::ours, fmt::format("{:.1e} EV", ev_error_of(b.out)), [&b] {
    (void)luminance_of_ev100(b.ev, b.calibration, b.out, 0);
    keep(b.out.data());
  });
  library_luminance(b.ev.data(), b.out.data(), batch_size);
  to_nits.contender("C library's exp2f, vectorised", Kind::peer, fmt::format("{:.1e} EV", ev_error_of(b.out)), [&b] {
    library_luminance(b.ev.data(), b.out.data(), batch_size);
    keep(b.out.data());
  });

  Task& to_ev = bench.task("cd/m2 to EV100", batch_size);
  const auto error = [&b] {
    double worst = 0;
    for (std::size_t i = 0; i < batch_size; ++i)
      worst = std::max(worst, std::abs(b.out[i] - *ev100_of_luminance(static_cast<double>(b.luminance[i]), b.calibration)));
    return fmt::format("{:.1e} EV", worst);
  };
  add_bare_multiply(to_ev, b.luminance, b.out);
  (void)ev100_of_luminance(b.luminance, b.calibration, b.out, 0);
  to_ev.contender("etendue ev100_of_luminance()", Kind::ours, error(), [&b] {
    (void)ev100_of_luminance(b.luminance, b.calibration, b.out, 0);
    keep(b.out.data());
  });
  library_ev(b.luminance.data(), b.out.data(), batch_size);
  to_ev.contender(
      "C library's log2f, vectorised", Kind::peer, error(),
      [&b] {
        library_ev(b.luminance.data(), b.out.data(), batch_size);
        keep(b.out.data());
      },
      "-ffast-math: what has no EV is not found out; ours counts it");
}

}  // namespace etendue::bench
