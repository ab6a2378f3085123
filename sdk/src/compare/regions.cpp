#include "regions.h"

#include "statistics.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace etendue::compare_detail {
namespace {

// A pixel whose variance is this many times that of its surroundings is an outlier. Under normal noise, 5 seeds, it happens to 1 pixel in
// 1e18.
constexpr double outlier_ratio = 25;

void accumulate(const Evidence& e, std::size_t pixel, ChannelSums& sums) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = 3 * pixel + c;
    const double v = e.variance[i], ours = std::abs(e.ours[i]);
    // E[(mean - truth) s^2/K] is the third cumulant of the mean: no third moments of the seeds are needed.
    const double third = -e.difference(i) * v;
    Sums& s = sums[c];
    s.pixels += 1;
    s.ours += e.ours[i];
    s.reference += e.reference[i];
    (v > outlier_ratio * e.around[i] ? s.tail_variance : s.variance) += v;
    (v > outlier_ratio * e.around[i] ? s.tail_third : s.third) += third;
    s.squared_variances += v * v;
    s.ours2 += ours * ours;
    s.ours3 += ours * ours * ours;
  }
}

void add(ChannelSums& to, const ChannelSums& from) {
  for (std::size_t c = 0; c < 3; ++c) to[c] += from[c];
}

std::string span_text(int first, int last) { return first == last ? std::to_string(first + 1) : fmt::format("{}-{}", first + 1, last + 1); }

std::size_t at(int x, int y, int side) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
}

// Blocks of 2 x 2 of the level below, until two a side are left; each region learns its parent.
void add_blocks(std::vector<Region>& regions, std::vector<int> level, int side, int tiles) {
  int reach = 1;  // tiles a region of this level spans
  while (side > 2) {
    const int coarse = (side + 1) / 2;
    std::vector<int> next(static_cast<std::size_t>(coarse) * static_cast<std::size_t>(coarse), -1);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const int child = level[at(x, y, side)];
        int& parent = next[at(x / 2, y / 2, coarse)];
        if (parent < 0) {
          parent = static_cast<int>(regions.size());
          const int x0 = x * reach, y0 = y * reach, last = 2 * reach - 1;
          regions.push_back(
              {fmt::format("tiles {},{}", span_text(x0, std::min(x0 + last, tiles - 1)), span_text(y0, std::min(y0 + last, tiles - 1))),
               RegionKind::block,
               {},
               0});
        }
        add(regions[static_cast<std::size_t>(parent)].sums, regions[static_cast<std::size_t>(child)].sums);
        regions[static_cast<std::size_t>(child)].parent = parent;
      }
    }
    level = std::move(next);
    side = coarse;
    reach *= 2;
  }
}

}  // namespace

Sums& Sums::operator+=(const Sums& o) {
  pixels += o.pixels;
  ours += o.ours;
  reference += o.reference;
  variance += o.variance;
  tail_variance += o.tail_variance;
  third += o.third;
  tail_third += o.tail_third;
  squared_variances += o.squared_variances;
  ours2 += o.ours2;
  ours3 += o.ours3;
  return *this;
}

std::vector<Region> divide(const Evidence& e, int tiles, const std::vector<std::string>& object_names) {
  std::vector<Region> regions(1);
  regions[0].name = "all";
  tiles = std::clamp(tiles, 1, static_cast<int>(std::min({e.width, e.height, std::uint32_t{256}})));
  std::vector<int> level;
  for (int y = 0; y < tiles; ++y) {
    for (int x = 0; x < tiles; ++x) {
      level.push_back(static_cast<int>(regions.size()));
      regions.push_back({fmt::format("tile {},{}", x + 1, y + 1), RegionKind::tile, {}, 0});
    }
  }
  std::map<int, Region> objects;
  Region emitters{"visible emitters", RegionKind::emitters, {}, -1};
  for (std::uint32_t y = 0; y < e.height; ++y) {
    for (std::uint32_t x = 0; x < e.width; ++x) {
      const std::size_t pixel = std::size_t{y} * e.width + x;
      if (e.emitter[pixel]) {
        accumulate(e, pixel, emitters.sums);
        continue;
      }
      const auto side = static_cast<std::uint64_t>(tiles);
      const std::size_t tile = y * side / e.height * side + x * side / e.width;
      accumulate(e, pixel, regions[1 + tile].sums);
      if (e.object[pixel] > 0) accumulate(e, pixel, objects[e.object[pixel]].sums);
    }
  }
  for (int t : level) add(regions[0].sums, regions[static_cast<std::size_t>(t)].sums);
  if (tiles == 1) regions.resize(1);
  if (tiles > 1) add_blocks(regions, level, tiles, tiles);
  for (auto& [index, region] : objects) {
    const auto i = static_cast<std::size_t>(index - 1);
    region.name = "object " + (i < object_names.size() ? object_names[i] : std::to_string(index));
    region.kind = RegionKind::object;
    region.parent = 0;
    regions.push_back(std::move(region));
  }
  if (emitters.sums[0].pixels > 0) regions.push_back(std::move(emitters));
  return regions;
}

std::array<TailRate, 3> tail_rates(const Region& all) {
  std::array<TailRate, 3> rates;
  for (std::size_t c = 0; c < 3; ++c) {
    const Sums& s = all.sums[c];
    if (s.ours2 > 0) rates[c].variance = s.tail_variance / s.ours2;
    if (s.ours3 > 0) rates[c].third = std::max(0.0, s.tail_third) / s.ours3;
  }
  return rates;
}

Estimate estimate(const Sums& s, const TailRate& tail, double max_difference) {
  Estimate result;
  if (s.pixels == 0) return result;
  const double difference = s.ours - s.reference;
  // A reference of zero has no relative difference: ours then stands for the scale, and the difference is the whole of it.
  const double scale = s.reference > 0 ? s.reference : std::abs(s.ours);
  if (!(scale > 0)) return result;
  // Two pictures without any noise (one of them black) are told apart down to the rounding of the sums.
  constexpr double rounding = 1e-12;
  const double variance = std::max(s.variance + std::max(s.tail_variance, tail.variance * s.ours2), rounding * rounding * scale * scale);
  result.difference = difference / scale;
  result.standard_error = std::sqrt(variance) / scale;

  const double third = s.third + std::max(s.tail_third, tail.third * s.ours3);
  const double skewness = third / (variance * std::sqrt(variance));
  // The relative variance of the summed variances is at most sum v^2 / (sum v)^2; chi-squared with nu degrees of freedom has 2/nu.
  const double own = s.variance + s.tail_variance;
  const double nu = std::max(2.0, 2 * own * own / std::max(s.squared_variances, 1e-300));
  const auto deviate = [&](double shift) {
    const double t = -(difference - shift) / std::sqrt(variance);  // reference - ours: the side whose noise is skewed
    const double corrected = without_skewness(t, skewness);
    const double weaker = corrected * t < 0 ? 0 : std::copysign(std::min(std::abs(t), std::abs(corrected)), t);
    return -normal_from_t(weaker, nu);
  };
  result.z = deviate(0);
  if (std::abs(difference) > max_difference * scale) {
    result.z_beyond = std::abs(deviate(std::copysign(max_difference * scale, difference)));
  }
  return result;
}

}  // namespace etendue::compare_detail
