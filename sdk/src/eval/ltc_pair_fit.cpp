// Transformed cosines, one for the lobe or two for both its parts, fitted to what is read between the nodes of a table.
//
// At a node the measure is that of single cosines, chi^2 = integral of (p - q)^2 / (p + |q|) over the directions above the horizon, q being
// what both cosines make of the lobe, which may be negative, taken for the lobes of f0 = 1 and of f0 = .04, each over its albedo. What a
// table gives lies between nodes: so does what is made small here, the sum over the node and the middles of the cells around it. Nodes take
// turns, each by its own ten unknowns, those that share a cell in different turns of a sweep.
#include "ltc_fit.h"

#include "least_squares.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>

namespace etendue::eval {
namespace {

constexpr std::size_t unknowns = 2 * CosineUnknowns::count + 2;
using Unknowns = std::array<double, unknowns>;

Unknowns unknowns_of(const CosinePair& pair) {
  Unknowns p{};
  std::copy(pair.first.begin(), pair.first.end(), p.begin());
  std::copy(pair.second.begin(), pair.second.end(), p.begin() + CosineUnknowns::count);
  p[unknowns - 2] = pair.of_f0, p[unknowns - 1] = pair.of_f90;
  return p;
}
CosinePair pair_of(const Unknowns& p) {
  CosinePair pair;
  std::copy_n(p.begin(), CosineUnknowns::count, pair.first.begin());
  std::copy_n(p.begin() + CosineUnknowns::count, CosineUnknowns::count, pair.second.begin());
  pair.of_f0 = p[unknowns - 2], pair.of_f90 = p[unknowns - 1];
  return pair;
}

// What a table holds of a pair, and what is read between four of them.
struct PairTerms {
  std::array<double, 5> first{}, second{};
  double first_f0 = 0, second_f0 = 0, first_f90 = 0, second_f90 = 0;

  void add(const PairTerms& other, double share) {
    for (std::size_t k = 0; k < first.size(); ++k) first[k] += share * other.first[k], second[k] += share * other.second[k];
    first_f0 += share * other.first_f0, second_f0 += share * other.second_f0;
    first_f90 += share * other.first_f90, second_f90 += share * other.second_f90;
  }
};
PairTerms pair_terms(const CosinePair& pair, const SampledLobe& lobe) {
  return {terms_of(pair.first, lobe.alpha), terms_of(pair.second, lobe.alpha), lobe.f0_part * pair.of_f0,
          lobe.f0_part * (1 - pair.of_f0),  lobe.f90_part * pair.of_f90,       lobe.f90_part * (1 - pair.of_f90)};
}

constexpr double every_f0[] = {1, 0.04};
std::span<const double> f0_of(Cosines cosines) { return std::span(every_f0).first(cosines == Cosines::one ? 1 : 2); }

void add_residuals(const SampledLobe& lobe, const PairTerms& t, std::span<const double> every, std::vector<double>& r) {
  const TransformedCosine first = transformed_cosine(t.first, lobe.alpha, lobe.cosine);
  const TransformedCosine second = transformed_cosine(t.second, lobe.alpha, lobe.cosine);
  const double over_first = 1 / first.share_above(), over_second = 1 / second.share_above();
  for (const LobeDirection& d : lobe.directions) {
    const double a = first.density(d.light) * over_first, b = second.density(d.light) * over_second;
    const double of_f0 = t.first_f0 * a + t.second_f0 * b, of_f90 = t.first_f90 * a + t.second_f90 * b;
    for (const double f0 : every) {
      const double over = 1 / (f0 * lobe.f0_part + lobe.f90_part);
      const double p = d.lobe * (f0 * (1 - d.fresnel_weight) + d.fresnel_weight) * over, q = (f0 * of_f0 + of_f90) * over;
      r.push_back((p - q) * std::sqrt(d.solid_angle / (p + std::abs(q))));
    }
  }
}
// Angles and slants count in alphas, of which a narrow lobe leaves many to choose from.
void add_distance(const Unknowns& p, const Unknowns& from, double alpha, double weight, std::vector<double>& r) {
  constexpr auto count = static_cast<std::size_t>(CosineUnknowns::count);
  for (std::size_t k = 0; k < unknowns; ++k) {
    const std::size_t which = k % count;
    const bool in_alphas = k < 2 * count && (which == CosineUnknowns::angle || which == CosineUnknowns::slant);
    r.push_back(weight * (in_alphas ? alpha : 1) * (p[k] - from[k]));
  }
}

class PairTable {
 public:
  PairTable(const LtcTable& axes, const std::vector<CosinePair>& starts, Cosines cosines) : size_(axes.size()), cosines_(cosines) {
    for (std::uint32_t row = 0; row < size_; ++row) {
      for (std::uint32_t column = 0; column < size_; ++column) {
        nodes_.emplace_back(axes.alpha_of(row), axes.cosine_of(column), panels);
        const double root = (row + 0.5) / (size_ - 1), cosine = std::min((column + 0.5) / (size_ - 1), 1.0);
        middles_.emplace_back(std::min(root * root, 1.0), cosine, panels);
      }
    }
    for (std::size_t at = 0; at < starts.size(); ++at) set(at, unknowns_of(starts[at]));
  }

  // By the node alone, near to where it starts: neighbours, whose starts are alike, end alike.
  void settle(std::size_t at) {
    constexpr double hold = 0.1;
    const Unknowns start = unknowns_[at];
    Unknowns p = start;
    descend(
        p,
        [&](const Unknowns& there) {
          std::vector<double> r;
          add_residuals(nodes_[at], pair_terms(pair_of(fit_for(at, there)), nodes_[at]), f0_of(cosines_), r);
          add_distance(there, start, nodes_[at].alpha, hold, r);
          return r;
        },
        60, 1e-7);
    set(at, p);
  }
  // By the node and the middles around it.
  void improve(std::size_t at) {
    constexpr double hold = 0.02;
    const Unknowns neighbours = mean_of_neighbours(at);
    Unknowns p = unknowns_[at];
    descend(
        p,
        [&](const Unknowns& there) {
          std::vector<double> r;
          const PairTerms own = pair_terms(pair_of(fit_for(at, there)), nodes_[at]);
          add_residuals(nodes_[at], own, f0_of(cosines_), r);
          each_cell(at, [&](std::size_t corner) {
            PairTerms middle;
            for (const std::size_t k : {corner, corner + 1, corner + size_, corner + size_ + 1})
              middle.add(k == at ? own : terms_[k], 0.25);
            add_residuals(middles_[corner], middle, f0_of(cosines_), r);
          });
          add_distance(there, neighbours, nodes_[at].alpha, hold, r);
          return r;
        },
        6, 1e-4);
    set(at, p);
  }
  std::vector<CosinePair> pairs() const {
    std::vector<CosinePair> all;
    std::transform(unknowns_.begin(), unknowns_.end(), std::back_inserter(all), pair_of);
    return all;
  }

 private:
  // 24 x 24 directions a lobe.
  static constexpr int panels = 1;

  void set(std::size_t at, const Unknowns& p) {
    unknowns_.resize(nodes_.size()), terms_.resize(nodes_.size());
    unknowns_[at] = fit_for(at, p), terms_[at] = pair_terms(pair_of(unknowns_[at]), nodes_[at]);
  }
  // Seen along the normal a lobe is the same all around. One cosine is two that are the same.
  Unknowns fit_for(std::size_t at, Unknowns p) const {
    using U = CosineUnknowns;
    if (cosines_ == Cosines::one) {
      std::copy_n(p.begin(), U::count, p.begin() + U::count);
      p[unknowns - 2] = p[unknowns - 1] = 1;
    }
    if (at % size_ + 1 < size_) return p;
    for (const std::size_t k : {std::size_t{0}, std::size_t{U::count}})
      p[k + U::angle] = p[k + U::slant] = 0, p[k + U::log_t] = p[k + U::log_s];
    return p;
  }
  // Of the cells around a node the corner with the smaller alpha and cosine.
  template <class Visit>
  void each_cell(std::size_t at, const Visit& visit) const {
    const std::size_t row = at / size_, column = at % size_;
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= row && r + 1 < size_; ++r)
      for (std::size_t c = column > 0 ? column - 1 : 0; c <= column && c + 1 < size_; ++c) visit(r * size_ + c);
  }
  Unknowns mean_of_neighbours(std::size_t at) const {
    const std::size_t row = at / size_, column = at % size_;
    Unknowns sum{};
    double count = 0;
    const auto add = [&](bool is_there, std::size_t other) {
      if (!is_there) return;
      for (std::size_t k = 0; k < unknowns; ++k) sum[k] += unknowns_[other][k];
      ++count;
    };
    add(row > 0, at - size_), add(row + 1 < size_, at + size_), add(column > 0, at - 1), add(column + 1 < size_, at + 1);
    for (double& x : sum) x /= count;
    return sum;
  }

  std::size_t size_;
  Cosines cosines_;
  std::vector<SampledLobe> nodes_, middles_;
  std::vector<Unknowns> unknowns_;
  std::vector<PairTerms> terms_;
};

}  // namespace

std::optional<std::vector<CosinePair>> fit_between(const LtcTable& axes, const std::vector<CosinePair>& starts, Cosines cosines,
                                                   const std::function<bool(double)>& progress) {
  constexpr int sweeps = 12;
  PairTable table(axes, starts, cosines);
  for (std::size_t at = 0; at < starts.size(); ++at) table.settle(at);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (const auto& [row, column] : {std::pair{0u, 0u}, {0u, 1u}, {1u, 0u}, {1u, 1u}}) {
      for (std::size_t r = row; r < axes.size(); r += 2)
        for (std::size_t c = column; c < axes.size(); c += 2) table.improve(r * axes.size() + c);
    }
    if (!progress((sweep + 1.0) / sweeps)) return std::nullopt;
  }
  return table.pairs();
}

}  // namespace etendue::eval
