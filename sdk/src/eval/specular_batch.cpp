// Specular light at many points: the rules by name, and lights as they take them.
#include "specular_batch.h"

#include "batch_error.h"
#include "etendue/ltc.h"
#include "etendue/specular_methods.h"
#include "specular_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace etendue::eval {
namespace {

constexpr std::pair<std::string_view, SpecularRule> rules[] = {{"ltc", SpecularRule::ltc},
                                                               {"ltc-one-cosine", SpecularRule::ltc_one_cosine},
                                                               {"ltc-two-lobes", SpecularRule::ltc_two_lobes},
                                                               {"ltc-two-cosines", SpecularRule::ltc_two_cosines},
                                                               {"ltc-two-caps", SpecularRule::ltc_two_caps},
                                                               {"moments", SpecularRule::moments}};

std::string_view name_of(SpecularRule rule) {
  return std::find_if(std::begin(rules), std::end(rules), [&](const auto& r) { return r.second == rule; })->first;
}

}  // namespace

std::optional<SpecularRule> SpecularBatch::rule_named(std::string_view method) {
  const auto* found = std::find_if(std::begin(rules), std::end(rules), [&](const auto& r) { return r.first == method; });
  return found == std::end(rules) ? std::nullopt : std::optional(found->second);
}

Result<SpecularBatch> SpecularBatch::of(SpecularRule rule, const Emitter& emitter) {
  Emitter white = emitter;
  white.radiance = {1, 1, 1};
  if (auto* sun = std::get_if<DistantEmitter>(&white.shape)) {
    const double sine = std::sin(sun->radius_rad);
    sun->illuminance = Rgb{1, 1, 1} * (pi * sine * sine);
  }
  std::shared_ptr<const Light> light;
  if (!white.pattern && !is_window(white.window)) {
    light = specular_rect(rule, white);
    if (!light) light = specular_round_moments(rule, white);
    if (!light) light = specular_round(rule, white);
    if (!light) light = specular_tube(rule, white);
  }
  if (!light) return Error{"METHOD_SHAPE", std::string(name_of(rule)) + " has no vectors for this light", {}, {}, {}};
  return SpecularBatch(rule, std::move(light), luminance_of(emitter));
}

BatchOutcome SpecularBatch::shares(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float where_none) const {
  const PointBatch& s = points.surface;
  for (const std::span<const float>& in : {s.px, s.py, s.pz, s.nx, s.ny, s.nz, points.vx, points.vy, points.vz, points.alpha})
    if (in.size() != of_f0.size()) return batch_sizes_differ(in.size(), of_f0.size());
  if (of_f90.size() != of_f0.size()) return batch_sizes_differ(of_f0.size(), of_f90.size());
  return light_->over(rule_, points, of_f0, of_f90, where_none);
}

SchlickShares in_double(SpecularRule rule, const Emitter& white, const SpecularPoints& points, std::size_t index) {
  const PointBatch& s = points.surface;
  const auto at = [&](std::span<const float> x, std::span<const float> y, std::span<const float> z) {
    return Vec3d{x[index], y[index], z[index]};
  };
  const Vec3d normal = normalised(at(s.nx, s.ny, s.nz));
  const SpecularMethod& method = *find_specular_method(name_of(rule));
  const auto of = [&](double f0, double f90) {
    const ShadingPoint point{at(s.px, s.py, s.pz) + s.origin, normal, normal, normalised(at(points.vx, points.vy, points.vz)),
                             GgxLobe{points.alpha[index], {f0, f0, f0}, f90}};
    return static_cast<float>(method.luminance(white, point).value_or(Rgb{}).x);
  };
  return {of(1, 0), of(0, 1)};
}

namespace {

// A cache line a node for the two cosines, half of one for the one; of the two the weights are told for each.
struct PaddedNodes {
  explicit PaddedNodes(const LtcTable& table) : whole(table.nodes().size()), one(whole), pair(whole.size()) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const LtcTable::Node& node = table.nodes()[i];
      std::copy_n(node.begin(), LtcTable::first, whole[i].numbers.begin());
      one[i] = whole[i];
      std::copy_n(node.begin() + LtcTable::one, LtcTable::albedo, one[i].numbers.begin());
      std::copy_n(node.begin() + LtcTable::first, 10, pair[i].numbers.begin());
      for (std::size_t part = 0; part < 2; ++part) {
        const float of_first = node[LtcTable::of_first + part];
        pair[i].numbers[10 + part] = of_first, pair[i].numbers[12 + part] = node[LtcTable::albedo + part] - of_first;
      }
    }
  }
  struct alignas(32) Whole {
    std::array<float, LtcNodes::of_whole> numbers{};
  };
  struct alignas(64) Pair {
    std::array<float, LtcNodes::of_pair> numbers{};
  };
  std::vector<Whole> whole, one;
  std::vector<Pair> pair;
};

}  // namespace

LtcNodes ltc_nodes() {
  static const PaddedNodes nodes(ltc_table());
  return {nodes.whole.data()->numbers.data(), nodes.one.data()->numbers.data(), nodes.pair.data()->numbers.data(), ltc_table().size()};
}

}  // namespace etendue::eval
