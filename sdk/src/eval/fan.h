// Adaptive integration over what a contour encloses: the measure of definition behind eval::reference.
//
// Directions are polar about a centre c inside the outline (or on it): for a point b(s) of the outline at the angle Theta(s) from c,
//   p(s, q) = ((1 - q^2) c + 2 q e) / (1 + q^2),  e = unit part of b across c,  0 <= q <= Q = tan(Theta / 2),
//   d omega = det(c, b, b') / |c x b|^2  4 q / (1 + q^2)^2  ds dq,
// which is signed, so that outlines that are not convex need no care. Two substitutions take the peaks out:
//   q = a sinh(U tau), U = asinh(Q / a), with a the width of the lobe along e,
//   s = s* + k sinh(w), s* the outline's closest approach to c and k its distance there (or the lobe's width, if larger).
// Cells in (w, tau) carry a Gauss-Kronrod product rule and are halved where the error is, along the worse of both directions.
#pragma once

#include "contour.h"
#include "etendue/eval.h"
#include "quadrature.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace etendue::eval {

// Where a fan stands and how its integrand is shaped.
struct Fan {
  Contour contour;
  Vec3d centre;
  double lobe = 1;             // half angle of the lobe where it is widest (the plane of incidence), as tan(angle / 2)
  double lobe_across = 1;      // across that plane
  Vec3d in_plane;              // unit, across the centre: the direction of that plane there
  double ridge = 1;            // the lobe is a ridge along that plane, this wide in azimuth; 1: it is none
  double layer = 0;            // the integrand bends within this height above the horizon (masking: alpha or n.v); 0: nowhere
  int adjacent[2] = {-1, -1};  // arcs through the centre that are great circles: they enclose nothing with it
  std::size_t index = 0;       // of the outline (each_outline)
};

// A piece of an arc of a fan in its own variable w: s = pivot + scale sinh(w).
class FanArc {
 public:
  FanArc(const Fan& fan, const Arc& arc, double pivot, double scale) : fan_(&fan), arc_(arc), pivot_(pivot), scale_(scale) {}

  const Fan& fan() const { return *fan_; }
  // Borders of the first cells in w, and in tau for a cell whose middle is at w.
  std::vector<double> borders_w(double longest_w, double longest_s) const;
  std::vector<double> borders_tau(double w, double longest_u) const;

  // All that a row of nodes at one w has in common.
  struct Row {
    Vec3d e;        // unit, across the centre, towards the outline
    double weight;  // det(c, b, b') / |c x b|^2 ds/dw
    double a, u;    // lobe scale and asinh(Q / a)
  };
  Row row(double w) const;
  Vec3d direction(const Row& row, double tau) const;

 private:
  double w_of(double s) const { return std::asinh((s - pivot_) / scale_); }

  const Fan* fan_;
  Arc arc_;
  double pivot_, scale_;
};

// The pieces of all arcs: graded towards the closest approach to the centre and, on a ridge, towards its plane.
std::vector<FanArc> pieces_of(const Fan& fan);

// sinh and cosh without loss of digits near 0.
inline void sinh_cosh(double x, double& sinh_x, double& cosh_x) {
  if (std::abs(x) < 0.1) {
    const double x2 = x * x;
    sinh_x = x * (1 + x2 / 6 * (1 + x2 / 20 * (1 + x2 / 42 * (1 + x2 / 72))));
    cosh_x = std::sqrt(1 + sinh_x * sinh_x);
  } else {
    const double e = std::exp(x), inverse = 1 / e;
    sinh_x = 0.5 * (e - inverse);
    cosh_x = 0.5 * (e + inverse);
  }
}

// What a tolerance asks for: the rule, and the largest cells to begin with.
struct FanRule {
  const KronrodRule* rule;
  double longest_w, longest_s, longest_u;
  double error_scale;  // of error_of()
};
FanRule fan_rule_for(double relative);

// From what a rule sees of the highest degrees to a bound on its error: `even` is the difference to the embedded Gauss rule n, which is
// exact to degree 2 n - 1, `odd` the part of degree 2 n - 1 (quadrature.h), r the integral of the absolute value. Kronrod's rule is exact
// to degree 3 n + 1. Where the coefficients of a resolved integrand fall like rho^-k, even / r is rho^-2n, odd / r is rho^(1 - 2n) and
// the error about rho^-(3 n + 2): the powers 3/2 (as in QUADPACK, Piessens et al. 1983) and 2 lie above it. Two sums of different parity
// do not vanish by the same accident.
inline double error_of(double even, double odd, double r, double scale) {
  if (!(r > 0)) return even;
  const double x = even / r, y = odd / r;
  return r * std::min(std::max(x, y), scale * std::max(x * std::sqrt(x), y * y));
}

struct FanCell {
  std::uint32_t arc = 0;
  double w0 = 0, w1 = 0, t0 = 0, t1 = 1;
  Rgb value, error;
  bool split_w = false;
  double priority = 0;
};

inline constexpr std::size_t max_fan_cells = 20000;

// Integrand: Rgb f(direction, outline index), called only for directions of the fans.
template <class Integrand>
class FanIntegrator {
 public:
  // `bends`: the integrand is not smooth within the fans, and the rules' powers say nothing of its error.
  FanIntegrator(const Integrand& integrand, const Tolerance& tolerance, bool bends = false)
      : f_(integrand), tolerance_(tolerance), rule_(fan_rule_for(tolerance.relative)) {
    if (bends) rule_.error_scale = std::numeric_limits<double>::max();
  }

  Estimate integrate(const std::vector<Fan>& fans) {
    for (const Fan& fan : fans) {
      const std::vector<FanArc> pieces = pieces_of(fan);
      arcs_.insert(arcs_.end(), pieces.begin(), pieces.end());
    }
    std::vector<FanCell> cells;
    for (std::uint32_t i = 0; i < arcs_.size(); ++i) {
      const std::vector<double> w = arcs_[i].borders_w(rule_.longest_w, rule_.longest_s);
      for (std::size_t j = 0; j + 1 < w.size(); ++j) {
        const std::vector<double> tau = arcs_[i].borders_tau(0.5 * (w[j] + w[j + 1]), rule_.longest_u);
        for (std::size_t k = 0; k + 1 < tau.size(); ++k) {
          FanCell cell;
          cell.arc = i;
          cell.w0 = w[j];
          cell.w1 = w[j + 1];
          cell.t0 = tau[k];
          cell.t1 = tau[k + 1];
          evaluate(cell);
          cells.push_back(cell);
        }
      }
    }
    refine(cells);
    Estimate estimate;
    for (const FanCell& cell : cells) {
      estimate.value += cell.value;
      estimate.error += cell.error;
    }
    // What rounding leaves: the nodes are exact to a few ulp, the weights to the condition of det(c, b, b').
    const auto magnitude = [](const Rgb& c) { return Rgb{std::abs(c.x), std::abs(c.y), std::abs(c.z)}; };
    estimate.error += magnitude(estimate.value) * 1e-13;
    estimate.evaluations = evaluations_;
    return estimate;
  }

 private:
  // Error that is still too large, in units of what is aimed at, on the worst channel.
  static double excess(const Rgb& error, const Rgb& aim) {
    const auto part = [](double e, double a) { return e > 0 ? e / std::max(a, 1e-300) : 0; };
    return std::max({part(error.x, aim.x), part(error.y, aim.y), part(error.z, aim.z)});
  }

  void refine(std::vector<FanCell>& cells) {
    Rgb value, error;
    for (const FanCell& c : cells) {
      value += c.value;
      error += c.error;
    }
    const auto aim = [&] {
      const double floor = 1e-15 * std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)});
      const auto one = [&](double v) { return std::max({tolerance_.relative * std::abs(v), tolerance_.absolute, floor}); };
      return Rgb{one(value.x), one(value.y), one(value.z)};
    };
    Rgb goal = aim();
    if (excess(error, goal) <= 1) return;
    for (FanCell& c : cells) c.priority = excess(c.error, goal);
    const auto less = [](const FanCell& a, const FanCell& b) { return a.priority < b.priority; };
    std::make_heap(cells.begin(), cells.end(), less);
    while (excess(error, goal) > 1 && cells.size() < max_fan_cells) {
      std::pop_heap(cells.begin(), cells.end(), less);
      const FanCell parent = cells.back();
      if (!(parent.priority > 0)) break;
      cells.pop_back();
      FanCell halves[2] = {parent, parent};
      if (parent.split_w) {
        halves[0].w1 = halves[1].w0 = 0.5 * (parent.w0 + parent.w1);
      } else {
        halves[0].t1 = halves[1].t0 = 0.5 * (parent.t0 + parent.t1);
      }
      evaluate(halves[0]);
      evaluate(halves[1]);
      distrust(parent, halves);
      value -= parent.value;
      error -= parent.error;
      for (FanCell& half : halves) {
        value += half.value;
        error += half.error;
        half.priority = excess(half.error, goal);
        cells.push_back(half);
        std::push_heap(cells.begin(), cells.end(), less);
      }
      goal = aim();
    }
  }

  // The halves know how wrong their parent was. If that is more than it had admitted, they share the blame.
  static void distrust(const FanCell& parent, FanCell (&halves)[2]) {
    for (int c = 0; c < 3; ++c) {
      const double wrong = std::abs(halves[0].value[c] + halves[1].value[c] - parent.value[c]);
      if (wrong <= parent.error[c]) continue;
      const double factor = std::min(wrong / std::max(parent.error[c], 1e-300), 100.0);
      for (FanCell& half : halves) half.error[c] = std::min(half.error[c] * factor, std::max(half.error[c], wrong));
    }
  }

  void evaluate(FanCell& cell) {
    const FanArc& arc = arcs_[cell.arc];
    const Fan& fan = arc.fan();
    const KronrodRule& rule = *rule_.rule;
    const auto n = static_cast<std::size_t>(rule.count);
    const double w_half = 0.5 * (cell.w1 - cell.w0), w_mid = 0.5 * (cell.w1 + cell.w0);
    const double t_half = 0.5 * (cell.t1 - cell.t0), t_mid = 0.5 * (cell.t1 + cell.t0);
    // Kronrod both ways, Gauss along w, Gauss along tau, odd parts, integral of the absolute value.
    Rgb fine, coarse_w, coarse_t, odd_w, odd_t, size;
    for (std::size_t i = 0; i < n; ++i) {
      const FanArc::Row row = arc.row(w_mid + w_half * rule.nodes[i].x);
      if (row.weight == 0) continue;
      Rgb row_fine, row_coarse, row_odd, row_size;
      for (std::size_t j = 0; j < n; ++j) {
        double sh, ch;
        sinh_cosh(row.u * (t_mid + t_half * rule.nodes[j].x), sh, ch);
        const double q = row.a * sh, inverse = 1 / (1 + q * q);
        const Vec3d p = (fan.centre * (1 - q * q) + row.e * (2 * q)) * inverse;
        const Rgb value = f_(p, fan.index) * (4 * q * inverse * inverse * ch);
        row_fine += value * rule.nodes[j].weight;
        if (rule.nodes[j].gauss > 0) row_coarse += value * rule.nodes[j].gauss;
        row_odd += value * rule.nodes[j].odd;
        row_size += Rgb{std::abs(value.x), std::abs(value.y), std::abs(value.z)} * rule.nodes[j].weight;
      }
      evaluations_ += n;
      const double scale = row.weight * row.a * row.u;
      fine += row_fine * (scale * rule.nodes[i].weight);
      coarse_t += row_coarse * (scale * rule.nodes[i].weight);
      odd_t += row_odd * (scale * rule.nodes[i].weight);
      odd_w += row_fine * (scale * rule.nodes[i].odd);
      if (rule.nodes[i].gauss > 0) coarse_w += row_fine * (scale * rule.nodes[i].gauss);
      size += row_size * (std::abs(scale) * rule.nodes[i].weight);
    }
    const double jacobian = w_half * t_half;
    double worst_w = 0, worst_t = 0;
    for (int c = 0; c < 3; ++c) {
      const double d_w = std::abs(fine[c] - coarse_w[c]), d_t = std::abs(fine[c] - coarse_t[c]);
      cell.value[c] = fine[c] * jacobian;
      const double along_w = error_of(d_w, std::abs(odd_w[c]), size[c], rule_.error_scale);
      const double along_t = error_of(d_t, std::abs(odd_t[c]), size[c], rule_.error_scale);
      cell.error[c] = (along_w + along_t) * jacobian;
      worst_w = std::max(worst_w, along_w);
      worst_t = std::max(worst_t, along_t);
    }
    cell.split_w = worst_w > worst_t;
  }

  const Integrand& f_;
  Tolerance tolerance_;
  FanRule rule_;
  std::vector<FanArc> arcs_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace etendue::eval
