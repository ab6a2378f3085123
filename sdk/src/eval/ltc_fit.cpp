// The fit of linearly transformed cosines to height-correlated GGX.
#include "etendue/ltc.h"
#include "quadrature.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace etendue::eval {
namespace {

// Directions above the horizon on one side of the plane of incidence with what they stand for: a sum over `solid_angle` is an integral over
// both sides. Visible normals (Heitz 2018) by Gauss's nodes in t, sin^2 t the first number of the sample, and by equal steps of its angle
// over the half of a turn that the plane of incidence does not mirror.
struct Direction {
  Vec3d light;
  double solid_angle, lobe, fresnel_weight;
};
std::vector<Direction> directions(double alpha, double cosine, int panels) {
  // Not quite along the normal, where the sample's angle would be counted from another axis.
  const Vec3d view{std::sqrt(std::max((1 - cosine) * (1 + cosine), 1e-18)), 0, cosine};
  const Brdf white = GgxLobe{alpha, {1, 1, 1}, 1, Masking::correlated}, grazing = GgxLobe{alpha, {0, 0, 0}, 1, Masking::correlated};
  const int turns = 24 * panels;
  std::vector<Direction> all;
  all.reserve(static_cast<std::size_t>(turns) * static_cast<std::size_t>(turns));
  for (int panel = 0; panel < panels; ++panel) {
    for (const GaussNode& node : gauss24()) {
      const double t = 0.25 * pi / panels * (2 * panel + 1 + node.x), u = std::sin(t) * std::sin(t);
      const double weight = 0.25 * pi / panels * node.weight * std::sin(2 * t) / turns;
      for (int i = 0; i < turns; ++i) {
        const double turn = 0.75 + 0.5 * (i + 0.5) / turns;
        const DirectionSample sample = sample_brdf(white, view, {u, turn - std::floor(turn)});
        if (!(sample.pdf > 0)) continue;
        const double lobe = brdf_cos(white, view, sample.direction).x;
        if (!(lobe > 0)) continue;
        all.push_back({sample.direction, weight / sample.pdf, lobe, brdf_cos(grazing, view, sample.direction).x / lobe});
      }
    }
  }
  return all;
}
double albedo(std::span<const Direction> all) {
  return std::accumulate(all.begin(), all.end(), 0.0, [](double sum, const Direction& d) { return sum + d.solid_angle * d.lobe; });
}

// The matrix is M R U: U = (s, 0, k; 0, t, 0; 0, 0, 1) widens the cosine by s within the plane of incidence and t across it, and slants it
// by k; R turns its axis by `angle` from the mirror direction, M puts that in its place. Lengths are counted in alphas.
struct Parameters {
  double angle = 0, log_s = std::log(2.0), log_t = std::log(2.0), slant = 0;
  double& operator[](int i) { return i == 0 ? angle : i == 1 ? log_s : i == 2 ? log_t : slant; }
};
constexpr int unknowns = 4;

// Of (R U)^-1 = (1 / s, 0, -k / s; 0, 1 / t, 0; 0, 0, 1) R^-1 what a node holds.
std::array<double, 5> terms_of(const Parameters& p, double alpha) {
  const double s = std::exp(p.log_s), c = std::cos(alpha * p.angle), n = std::sin(alpha * p.angle), k = alpha * p.slant;
  return {(c + k * n) / s, (n - k * c) / s, std::exp(p.log_t), -n, c};
}

class Fit {
 public:
  // `all`: with whatever lobe is to be fitted.
  Fit(double alpha, double cosine, std::vector<Direction> all)
      : alpha_(alpha), cosine_(cosine), directions_(std::move(all)), albedo_(albedo(directions_)) {}

  // Levenberg's and Marquardt's: the curvature of the residuals' squares, its diagonal raised until a step goes down.
  double improve(Parameters& p) const {
    std::vector<double> r = residuals(p);
    double best = square(r), damping = 1e-3;
    for (int round = 0; round < 200 && damping < 1e8; ++round) {
      std::array<std::vector<double>, unknowns> slope;
      std::array<std::array<double, unknowns + 1>, unknowns> normal{};
      for (int i = 0; i < unknowns; ++i) {
        constexpr double step = 1e-6;
        Parameters there = p;
        there[i] += step;
        slope[i] = residuals(there);
        for (std::size_t k = 0; k < r.size(); ++k) slope[i][k] = (slope[i][k] - r[k]) / step;
      }
      for (int i = 0; i < unknowns; ++i) {
        for (int j = 0; j < unknowns; ++j) normal[i][j] = std::inner_product(slope[i].begin(), slope[i].end(), slope[j].begin(), 0.0);
        normal[i][unknowns] = -std::inner_product(slope[i].begin(), slope[i].end(), r.begin(), 0.0);
      }
      bool done = true;
      while (damping < 1e8) {
        const Parameters next = stepped(p, normal, damping);
        std::vector<double> there = residuals(next);
        const double value = square(there);
        if (!(value < best)) {
          damping *= 10;
          continue;
        }
        done = best - value < 1e-10 * best;
        p = next, r = std::move(there), best = value, damping *= 0.1;
        break;
      }
      if (done) break;
    }
    return best;
  }

 private:
  std::vector<double> residuals(const Parameters& p) const {
    const TransformedCosine cosine = transformed_cosine(terms_of(p, alpha_), alpha_, cosine_);
    const double share = cosine.share_above();
    std::vector<double> r;
    r.reserve(directions_.size() + 1);
    for (const Direction& d : directions_) {
      const double a = d.lobe / albedo_, b = cosine.density(d.light) / share;
      r.push_back((a - b) * std::sqrt(d.solid_angle / (a + b)));
    }
    r.push_back(steadiness * alpha_ * p.slant);
    return r;
  }
  // A narrow lobe looks the same turned one way and slanted the other: what little weight the slant has decides, so that neighbours agree.
  static constexpr double steadiness = 0.01;
  static double square(const std::vector<double>& r) { return std::inner_product(r.begin(), r.end(), r.begin(), 0.0); }

  // Gauss's elimination; the matrix is positive definite.
  static Parameters stepped(Parameters p, std::array<std::array<double, unknowns + 1>, unknowns> m, double damping) {
    for (int i = 0; i < unknowns; ++i) m[i][i] += damping * m[i][i] + 1e-12;
    for (int i = 0; i < unknowns; ++i) {
      for (int j = i + 1; j < unknowns; ++j) {
        const double factor = m[j][i] / m[i][i];
        for (int k = i; k <= unknowns; ++k) m[j][k] -= factor * m[i][k];
      }
    }
    std::array<double, unknowns> x{};
    for (int i = unknowns - 1; i >= 0; --i) {
      x[i] = m[i][unknowns];
      for (int k = i + 1; k < unknowns; ++k) x[i] -= m[i][k] * x[k];
      x[i] /= m[i][i];
      p[i] += x[i];
    }
    return p;
  }

  double alpha_, cosine_;
  std::vector<Direction> directions_;
  double albedo_;
};

// The parts of the lobe that Fresnel's term weighs with f0 and with f90.
std::vector<Direction> steep_part(std::vector<Direction> all) {
  for (Direction& d : all) d.lobe *= 1 - d.fresnel_weight;
  return all;
}
std::vector<Direction> grazing_part(std::vector<Direction> all) {
  for (Direction& d : all) d.lobe *= d.fresnel_weight;
  return all;
}

struct NodeFit {
  Parameters whole, steep, grazing;
};
NodeFit improved(double alpha, double cosine, std::span<const NodeFit> starts) {
  const std::vector<Direction> all = directions(alpha, cosine, 2);
  NodeFit best;
  const auto improve = [&](const std::vector<Direction>& lobe, Parameters NodeFit::*part) {
    const Fit fit(alpha, cosine, lobe);
    double least = HUGE_VAL;
    for (const NodeFit& start : starts) {
      Parameters p = start.*part;
      if (const double error = fit.improve(p); error < least) least = error, best.*part = p;
    }
  };
  improve(all, &NodeFit::whole);
  improve(steep_part(all), &NodeFit::steep);
  improve(grazing_part(all), &NodeFit::grazing);
  return best;
}

LtcTable::Node node_of(const NodeFit& fit, double alpha, double cosine) {
  LtcTable::Node node;
  const auto store = [](double x) { return static_cast<float>(x); };
  const auto store_terms = [&](const Parameters& p, std::size_t first) {
    const std::array<double, 5> terms = terms_of(p, alpha);
    std::transform(terms.begin(), terms.end(), node.begin() + static_cast<std::ptrdiff_t>(first), store);
  };
  const std::vector<Direction> all = directions(alpha, cosine, 4);
  const double all_of = albedo(all), f90 = albedo(grazing_part(all));
  store_terms(fit.whole, 0);
  // A part that has hardly anything of the lobe lies along its rim, and its fit is a sliver: there it goes with the other part. At grazing
  // views on smooth surfaces that is at most 3 % of the light, seen steeply at most .6 % at f0 = .04.
  store_terms(all_of - f90 < 0.03 * all_of ? fit.grazing : fit.steep, LtcTable::steep);
  store_terms(f90 < 2.5e-4 * all_of ? fit.steep : fit.grazing, LtcTable::grazing);
  node[LtcTable::albedo] = store(all_of - f90), node[LtcTable::albedo + 1] = store(f90);
  return node;
}

}  // namespace

// Each node starts as a narrow lobe would be, from its neighbour towards the normal, and from the one of the smaller alpha: what ends
// lowest is it.
std::optional<LtcTable> fit_ltc(std::uint32_t size, const std::function<bool(double)>& progress) {
  const LtcTable axes(size, {});
  std::vector<LtcTable::Node> nodes(static_cast<std::size_t>(size) * size);
  std::vector<NodeFit> row_below(size);
  for (std::uint32_t row = 0; row < size; ++row) {
    const double alpha = axes.alpha_of(row);
    NodeFit neighbour;
    for (std::uint32_t column = size; column-- > 0;) {
      const double cosine = axes.cosine_of(column);
      Parameters narrow;
      narrow.log_t += std::log(std::max(cosine, alpha));
      neighbour = improved(alpha, cosine, std::array<NodeFit, 3>{NodeFit{narrow, narrow, narrow}, neighbour, row_below[column]});
      row_below[column] = neighbour;
      nodes[static_cast<std::size_t>(row) * size + column] = node_of(neighbour, alpha, cosine);
    }
    if (progress && !progress((row + 1.0) / size)) return std::nullopt;
  }
  return LtcTable(size, std::move(nodes));
}

// Both sum to 1: half of |p - q| is what p has more, which the lobe's own directions see wherever the cosine is.
double misplaced_share(const TransformedCosine& whole, double alpha, double view_cosine) {
  const std::vector<Direction> all = directions(alpha, view_cosine, 2);
  const double sum = albedo(all), share = whole.share_above();
  double more = 0;
  for (const Direction& d : all) more += d.solid_angle * std::max(d.lobe / sum - whole.density(d.light) / share, 0.0);
  return more;
}

}  // namespace etendue::eval
