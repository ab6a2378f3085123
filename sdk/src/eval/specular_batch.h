// Lights as etendue/specular_batch.h takes them, and what their kernels share before an instruction set is chosen.
#pragma once

#include "etendue/specular_batch.h"

#include <cstddef>
#include <span>

namespace etendue::eval {

// Of a light of 1 cd/m2: factors on f0 and f90.
struct SchlickShares {
  float of_f0 = 0, of_f90 = 0;
};

class SpecularBatch::Light {
 public:
  virtual ~Light() = default;
  // SpecularBatch::shares, sizes checked.
  virtual std::size_t over(SpecularRule rule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                           float where_none) const = 0;
};

// Of an emitter of luminance 1; null if it is no rectangle or if the rule takes none.
std::shared_ptr<const SpecularBatch::Light> specular_rect(SpecularRule rule, const Emitter& white);
// The same of spheres, disks and suns, by moments and by transformed cosines.
bool is_round(const Emitter& emitter);
std::shared_ptr<const SpecularBatch::Light> specular_round_moments(SpecularRule rule, const Emitter& white);
std::shared_ptr<const SpecularBatch::Light> specular_round(SpecularRule rule, const Emitter& white);
// The same of tubes with round caps, by moments.
std::shared_ptr<const SpecularBatch::Light> specular_tube(SpecularRule rule, const Emitter& white);

// The method in double at one point of a batch.
SchlickShares in_double(SpecularRule rule, const Emitter& white, const SpecularPoints& points, std::size_t index);

// The nodes of ltc_table(), padded. `whole`: 5 terms, the parts of the albedo that are f0's and f90's, and one number that means nothing;
// `one` the same of the cosine that is fitted between nodes.
// `pair`: 5 terms of either cosine, what of the f0 and of the f90 part the first has, what the second has, and two more.
struct LtcNodes {
  static constexpr std::size_t of_whole = 8, of_pair = 16, albedo = 5, second = 5, of_first = 10, of_second = 12;
  const float *whole, *one, *pair;
  std::size_t size;  // along each side
};
LtcNodes ltc_nodes();

}  // namespace etendue::eval
