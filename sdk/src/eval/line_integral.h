// Adaptive integral over an interval with one peak.
#pragma once

#include "etendue/eval.h"
#include "quadrature.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue::eval {

// Integral of f from begin to end. A peak of the given width at `peak` (within the interval or at its end) is taken out by
// x = peak + width sinh(w). Gauss 7 and Kronrod 15, halving where the error is; the difference of both rules is the error, which
// overestimates that of the better one.
template <class Function>
Estimate integrate_peaked(const Function& f, double begin, double end, double peak, double width, const Tolerance& tolerance) {
  struct Part {
    double w0, w1;
    Rgb value, error;
    double priority;
  };
  Estimate total;
  const KronrodRule& rule = kronrod15();
  const auto evaluate = [&](double w0, double w1) {
    Part part{w0, w1, {}, {}, 0};
    Rgb coarse;
    const double half = 0.5 * (w1 - w0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(rule.count); ++i) {
      const double w = 0.5 * (w0 + w1) + half * rule.nodes[i].x;
      const Rgb value = f(std::clamp(peak + width * std::sinh(w), begin, end)) * (width * std::cosh(w) * half);
      part.value += value * rule.nodes[i].weight;
      coarse += value * rule.nodes[i].gauss;
    }
    total.evaluations += static_cast<std::uint64_t>(rule.count);
    for (int c = 0; c < 3; ++c) part.error[c] = std::abs(part.value[c] - coarse[c]) + 1e-15 * std::abs(part.value[c]);
    part.priority = std::max({part.error.x, part.error.y, part.error.z});
    return part;
  };
  const auto less = [](const Part& a, const Part& b) { return a.priority < b.priority; };
  const double w0 = std::asinh((begin - peak) / width), w1 = std::asinh((end - peak) / width);
  std::vector<Part> parts{evaluate(w0, 0.5 * (w0 + w1)), evaluate(0.5 * (w0 + w1), w1)};
  constexpr std::size_t most = 2000;
  while (parts.size() < most) {
    Rgb value, error;
    for (const Part& p : parts) value += p.value, error += p.error;
    const auto too_large = [&](double e, double v) { return e > std::max({tolerance.relative * std::abs(v), tolerance.absolute, 1e-300}); };
    if (!too_large(error.x, value.x) && !too_large(error.y, value.y) && !too_large(error.z, value.z)) break;
    const auto worst = std::max_element(parts.begin(), parts.end(), less);
    const Part parent = *worst;
    const double middle = 0.5 * (parent.w0 + parent.w1);
    if (!(middle > parent.w0 && middle < parent.w1)) break;
    *worst = evaluate(parent.w0, middle);
    parts.push_back(evaluate(middle, parent.w1));
  }
  for (const Part& p : parts) {
    total.value += p.value;
    total.error += p.error;
  }
  return total;
}

}  // namespace etendue::eval
