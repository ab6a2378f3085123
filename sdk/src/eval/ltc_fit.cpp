// The fit of linearly transformed cosines to height-correlated GGX.
#include "ltc_fit.h"

#include "least_squares.h"
#include "quadrature.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace etendue::eval {

SampledLobe::SampledLobe(double its_alpha, double its_cosine, int panels) : alpha(its_alpha), cosine(its_cosine) {
  // Not quite along the normal, where the sample's angle would be counted from another axis.
  const Vec3d view{std::sqrt(std::max((1 - cosine) * (1 + cosine), 1e-18)), 0, cosine};
  const Brdf white = GgxLobe{alpha, {1, 1, 1}, 1, Masking::correlated}, grazing = GgxLobe{alpha, {0, 0, 0}, 1, Masking::correlated};
  const int turns = 24 * panels;
  directions.reserve(static_cast<std::size_t>(turns) * static_cast<std::size_t>(turns));
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
        directions.push_back({sample.direction, weight / sample.pdf, lobe, brdf_cos(grazing, view, sample.direction).x / lobe});
      }
    }
  }
  for (const LobeDirection& d : directions) {
    f0_part += d.solid_angle * d.lobe * (1 - d.fresnel_weight);
    f90_part += d.solid_angle * d.lobe * d.fresnel_weight;
  }
}

namespace {

enum class Part { whole, steep, grazing };
double of_part(const LobeDirection& d, Part part) {
  return part == Part::whole ? d.lobe : d.lobe * (part == Part::steep ? 1 - d.fresnel_weight : d.fresnel_weight);
}

// One cosine for the lobe or for one of the parts that Fresnel's term weighs with f0 and with f90.
class Fit {
 public:
  Fit(const SampledLobe& lobe, Part part)
      : lobe_(lobe),
        part_(part),
        sum_(part == Part::whole   ? lobe.albedo()
             : part == Part::steep ? lobe.f0_part
                                   : lobe.f90_part) {}
  double improve(CosineShape& p) const {
    return descend(
        p, [&](const CosineShape& there) { return residuals(there); }, 200, 1e-10);
  }

 private:
  std::vector<double> residuals(const CosineShape& p) const {
    const TransformedCosine cosine = transformed_cosine(terms_of(p, lobe_.alpha), lobe_.alpha, lobe_.cosine);
    const double share = cosine.share_above();
    std::vector<double> r;
    r.reserve(lobe_.directions.size() + 1);
    for (const LobeDirection& d : lobe_.directions) {
      const double a = of_part(d, part_) / sum_, b = cosine.density(d.light) / share;
      r.push_back((a - b) * std::sqrt(d.solid_angle / (a + b)));
    }
    r.push_back(steadiness * lobe_.alpha * p[CosineUnknowns::slant]);
    return r;
  }
  // A narrow lobe looks the same turned one way and slanted the other: what little weight the slant has decides, so that neighbours agree.
  static constexpr double steadiness = 0.01;

  const SampledLobe& lobe_;
  Part part_;
  double sum_;
};

struct NodeFit {
  CosineShape whole, steep, grazing;
};
NodeFit improved(const SampledLobe& lobe, std::span<const NodeFit> starts) {
  NodeFit best;
  const auto improve = [&](Part part, CosineShape NodeFit::*shape) {
    const Fit fit(lobe, part);
    double least = HUGE_VAL;
    for (const NodeFit& start : starts) {
      CosineShape p = start.*shape;
      if (const double error = fit.improve(p); error < least) least = error, best.*shape = p;
    }
  };
  improve(Part::whole, &NodeFit::whole);
  improve(Part::steep, &NodeFit::steep);
  improve(Part::grazing, &NodeFit::grazing);
  return best;
}

// Where both parts start. One that has hardly anything of the lobe lies along its rim, and its fit is a sliver: there it goes with the
// other part.
CosinePair start_of(const NodeFit& fit, const SampledLobe& lobe) {
  return {lobe.f0_part < 0.03 * lobe.albedo() ? fit.grazing : fit.steep, lobe.f90_part < 2.5e-4 * lobe.albedo() ? fit.steep : fit.grazing};
}

LtcTable::Node node_of(const SampledLobe& lobe, const CosineShape& whole, const CosineShape& one, const CosinePair& pair) {
  LtcTable::Node node;
  const auto store = [](double x) { return static_cast<float>(x); };
  const auto store_terms = [&](const CosineShape& p, std::size_t first) {
    const std::array<double, 5> terms = terms_of(p, lobe.alpha);
    std::transform(terms.begin(), terms.end(), node.begin() + static_cast<std::ptrdiff_t>(first), store);
  };
  store_terms(whole, 0);
  store_terms(pair.first, LtcTable::first);
  store_terms(pair.second, LtcTable::second);
  store_terms(one, LtcTable::one);
  node[LtcTable::albedo] = store(lobe.f0_part), node[LtcTable::albedo + 1] = store(lobe.f90_part);
  node[LtcTable::of_first] = store(lobe.f0_part * pair.of_f0), node[LtcTable::of_first + 1] = store(lobe.f90_part * pair.of_f90);
  return node;
}

}  // namespace

// Each node starts as a narrow lobe would be, from its neighbour towards the normal, and from the one of the smaller alpha: what ends
// lowest is it.
std::optional<LtcTable> fit_ltc(std::uint32_t size, const std::function<bool(double)>& progress) {
  const LtcTable axes(size, {});
  const std::size_t count = static_cast<std::size_t>(size) * size;
  std::vector<CosineShape> whole(count);
  std::vector<CosinePair> pairs(count);
  std::vector<NodeFit> row_below(size);
  constexpr double alone = 0.4, of_one = 0.7;  // what is done after each step
  for (std::uint32_t row = 0; row < size; ++row) {
    const double alpha = axes.alpha_of(row);
    NodeFit neighbour;
    for (std::uint32_t column = size; column-- > 0;) {
      const double cosine = axes.cosine_of(column);
      const CosineShape narrow = narrow_cosine(alpha, cosine);
      const NodeFit start{narrow, narrow, narrow};
      const SampledLobe lobe(alpha, cosine, 2);
      neighbour = improved(lobe, std::array<NodeFit, 3>{start, column + 1 < size ? neighbour : start, row > 0 ? row_below[column] : start});
      row_below[column] = neighbour;
      const std::size_t at = static_cast<std::size_t>(row) * size + column;
      whole[at] = neighbour.whole, pairs[at] = start_of(neighbour, lobe);
    }
    if (progress && !progress(alone * (row + 1.0) / size)) return std::nullopt;
  }
  std::vector<CosinePair> starts;
  std::transform(whole.begin(), whole.end(), std::back_inserter(starts), [](const CosineShape& shape) {
    return CosinePair{shape, shape, 1, 1};
  });
  const auto fitted = [&](const std::vector<CosinePair>& from, Cosines cosines, double begin, double end) {
    return fit_between(axes, from, cosines, [&](double done) { return !progress || progress(begin + (end - begin) * done); });
  };
  const auto one = fitted(starts, Cosines::one, alone, of_one);
  if (!one) return std::nullopt;
  const auto two = fitted(pairs, Cosines::two, of_one, 1);
  if (!two) return std::nullopt;
  std::vector<LtcTable::Node> nodes;
  nodes.reserve(count);
  for (std::size_t at = 0; at < count; ++at) {
    const SampledLobe lobe(axes.alpha_of(static_cast<std::uint32_t>(at / size)), axes.cosine_of(static_cast<std::uint32_t>(at % size)), 4);
    nodes.push_back(node_of(lobe, whole[at], (*one)[at].first, (*two)[at]));
  }
  return LtcTable(size, std::move(nodes));
}

// Both sum to 1: half of |p - q| is what p has more, which the lobe's own directions see wherever the cosine is.
double misplaced_share(const TransformedCosine& whole, double alpha, double view_cosine) {
  const SampledLobe lobe(alpha, view_cosine, 2);
  const double sum = lobe.albedo(), share = whole.share_above();
  double more = 0;
  for (const LobeDirection& d : lobe.directions) more += d.solid_angle * std::max(d.lobe / sum - whole.density(d.light) / share, 0.0);
  return more;
}

}  // namespace etendue::eval
