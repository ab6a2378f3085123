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
#include <vector>

namespace etendue::eval {

// Where a fan stands and how its integrand is shaped.
struct Fan {
  Contour contour;
  Vec3d centre;
  double lobe = 1;             // half angle of the lobe in the plane of incidence, as tan(angle / 2)
  double lobe_across = 1;      // across that plane
  Vec3d in_plane;              // unit, across the centre: the direction of the plane of incidence there
  bool has_plane = false;      // cells are split along that plane
  int adjacent[2] = {-1, -1};  // arcs through the centre that are great circles: they enclose nothing with it
  std::size_t index = 0;       // of the outline (each_outline)
};

// One arc of one fan in its own variable w.
class FanArc {
 public:
  FanArc(const Fan& fan, const Arc& arc);

  const Fan& fan() const { return *fan_; }
  // Cells to begin with: borders in w.
  std::vector<double> borders(double longest_w, double longest_s) const;

  // All that a row of nodes at one w has in common.
  struct Row {
    Vec3d e;        // unit, across the centre, towards the outline
    double weight;  // det(c, b, b') / |c x b|^2 ds/dw
    double a, u;    // lobe scale and asinh(Q / a)
  };
  Row row(double w) const;

 private:
  double w_of(double s) const { return std::asinh((s - nearest_) / scale_); }

  const Fan* fan_;
  Arc arc_;
  double nearest_ = 0, scale_ = 1;
};

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

// From the difference d of both rules and the cell's absolute integral r to a bound on the error of the better one. Gauss n has the
// degree 2 n - 1, its Kronrod extension 3 n + 1 or more: where the integrand is resolved, (d / r)^(3/2) lies above the error that is
// left (Piessens et al. 1983, QUADPACK, use the same power).
inline double error_of(double d, double r, double scale) {
  if (!(r > 0)) return d;
  const double x = d / r;
  return r * std::min(x, scale * x * std::sqrt(x));
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
  FanIntegrator(const Integrand& integrand, const Tolerance& tolerance)
      : f_(integrand), tolerance_(tolerance), rule_(fan_rule_for(tolerance.relative)) {}

  Estimate integrate(const std::vector<Fan>& fans) {
    for (const Fan& fan : fans) add(fan);
    std::vector<FanCell> cells;
    for (std::uint32_t i = 0; i < arcs_.size(); ++i) {
      const std::vector<double> borders = arcs_[i].borders(rule_.longest_w, rule_.longest_s);
      for (std::size_t j = 0; j + 1 < borders.size(); ++j) {
        const double u = arcs_[i].row(0.5 * (borders[j] + borders[j + 1])).u;
        const int layers = std::max(1, static_cast<int>(std::ceil(u / rule_.longest_u)));
        for (int k = 0; k < layers; ++k) {
          FanCell cell;
          cell.arc = i;
          cell.w0 = borders[j];
          cell.w1 = borders[j + 1];
          cell.t0 = static_cast<double>(k) / layers;
          cell.t1 = static_cast<double>(k + 1) / layers;
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
  void add(const Fan& fan) {
    for (int i = 0; i < static_cast<int>(fan.contour.size()); ++i) {
      if (i != fan.adjacent[0] && i != fan.adjacent[1]) arcs_.emplace_back(fan, fan.contour[static_cast<std::size_t>(i)]);
    }
  }

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
      for (int i = 0; i < 2; ++i) halves[i].error[c] = std::min(halves[i].error[c] * factor, std::max(halves[i].error[c], wrong));
    }
  }

  void evaluate(FanCell& cell) {
    const FanArc& arc = arcs_[cell.arc];
    const Fan& fan = arc.fan();
    const KronrodRule& rule = *rule_.rule;
    const auto n = static_cast<std::size_t>(rule.count);
    const double w_half = 0.5 * (cell.w1 - cell.w0), w_mid = 0.5 * (cell.w1 + cell.w0);
    const double t_half = 0.5 * (cell.t1 - cell.t0), t_mid = 0.5 * (cell.t1 + cell.t0);
    Rgb fine, coarse_w, coarse_t, size;  // Kronrod both ways, Gauss along w, Gauss along tau, integral of the absolute value
    for (std::size_t i = 0; i < n; ++i) {
      const FanArc::Row row = arc.row(w_mid + w_half * rule.nodes[i].x);
      if (row.weight == 0) continue;
      Rgb row_fine, row_coarse, row_size;
      for (std::size_t j = 0; j < n; ++j) {
        double sh, ch;
        sinh_cosh(row.u * (t_mid + t_half * rule.nodes[j].x), sh, ch);
        const double q = row.a * sh, inverse = 1 / (1 + q * q);
        const Vec3d p = (fan.centre * (1 - q * q) + row.e * (2 * q)) * inverse;
        const Rgb value = f_(p, fan.index) * (4 * q * inverse * inverse * ch);
        row_fine += value * rule.nodes[j].weight;
        if (rule.nodes[j].gauss > 0) row_coarse += value * rule.nodes[j].gauss;
        row_size += Rgb{std::abs(value.x), std::abs(value.y), std::abs(value.z)} * rule.nodes[j].weight;
      }
      evaluations_ += n;
      const double scale = row.weight * row.a * row.u;
      fine += row_fine * (scale * rule.nodes[i].weight);
      coarse_t += row_coarse * (scale * rule.nodes[i].weight);
      if (rule.nodes[i].gauss > 0) coarse_w += row_fine * (scale * rule.nodes[i].gauss);
      size += row_size * (std::abs(scale) * rule.nodes[i].weight);
    }
    const double jacobian = w_half * t_half;
    double worst_w = 0, worst_t = 0;
    for (int c = 0; c < 3; ++c) {
      const double d_w = std::abs(fine[c] - coarse_w[c]), d_t = std::abs(fine[c] - coarse_t[c]);
      cell.value[c] = fine[c] * jacobian;
      cell.error[c] = (error_of(d_w, size[c], rule_.error_scale) + error_of(d_t, size[c], rule_.error_scale)) * jacobian;
      worst_w = std::max(worst_w, d_w);
      worst_t = std::max(worst_t, d_t);
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
