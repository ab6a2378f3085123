// Regions of the picture, their differences, and which of them can be judged at the precision asked for.
#pragma once

#include "evidence.h"

#include <array>
#include <string>
#include <vector>

namespace etendue::compare_detail {

// What a region's judgement needs of one channel; sums of disjoint regions add.
struct Sums {
  double pixels = 0, ours = 0, reference = 0;
  double variance = 0, tail_variance = 0;  // of pixels in the bulk, and of outliers (fireflies)
  double third = 0, tail_third = 0;        // third cumulant of reference - ours
  double squared_variances = 0;
  double ours2 = 0, ours3 = 0;  // sums of ours^2 and |ours|^3

  Sums& operator+=(const Sums& other);
};
using ChannelSums = std::array<Sums, 3>;

enum class RegionKind { all, tile, block, object, emitters };
struct Region {
  std::string name;
  RegionKind kind = RegionKind::all;
  ChannelSums sums;
  int parent = -1;  // the region that stands for this one where this one is too noisy
};

// "all" first; then tiles, blocks of tiles up to the half of the picture, objects, the visible emitters. All but the last without emitter
// pixels.
std::vector<Region> divide(const Evidence& evidence, int tiles, const std::vector<std::string>& object_names);

// How often an outlier may be expected anywhere, learnt from the whole picture, so that a region in which none happened to fall is not
// mistaken for a quiet one. Relative: variance per ours^2, third cumulant per |ours|^3.
struct TailRate {
  double variance = 0, third = 0;
};
std::array<TailRate, 3> tail_rates(const Region& all);

struct Estimate {
  double difference = 0, standard_error = 0;  // relative to the reference's mean
  double z = 0;                               // of the difference from zero
  double z_beyond = 0;                        // of |difference| beyond the size asked about; 0 where it is within
};
Estimate estimate(const Sums& sums, const TailRate& tail, double max_difference);

}  // namespace etendue::compare_detail
