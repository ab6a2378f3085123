// What each pixel shows, before any light is computed: one smooth surface, or regions.
#pragma once

#include "regions.h"
#include "rows.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace etendue::rendering {

struct SurveyOptions {
  std::uint32_t width = 0, height = 0;
  double area_tolerance = 1e-3;
  std::uint64_t seed = 1;
};

class Survey {
 public:
  Survey(const Stage& stage, const PinholeCamera& camera, const SurveyOptions& options);

  static constexpr std::size_t passes = 2;
  // False: cancelled.
  bool run(RowRunner& rows);

  // Null: one thing fills the pixel, and nothing discontinuous was found in it.
  const Regions* regions(std::size_t pixel) const { return split_[pixel] ? regions_[pixel].get() : nullptr; }
  // Equal for smooth pixels that show the same part of the same thing with the same punctual lights on it.
  std::uint64_t key(std::size_t pixel) const { return keys_[pixel]; }
  // The pixel or one beside it does: where a sliver between the probes may have been missed.
  bool touches_emitter(std::size_t pixel) const;
  // How far a surface turns between two places of the pixel, as a part of the width of what it reflects; infinite where a texture changes
  // that width or the normal, and where one changes the colour of a region that is not matt.
  double unevenness(std::size_t pixel) const { return static_cast<double>(unevenness_[pixel]); }

 private:
  void look_first(std::uint32_t row, RayCounts& counts);
  void look_again(std::uint32_t row, RayCounts& counts);
  bool any_around(const std::vector<std::uint8_t>& flags, std::uint32_t x, std::uint32_t y) const;  // in 3 x 3 pixels
  bool is_emitter(const Probe& probe) const;
  bool is_coloured(const Probe& probe) const;
  double uneven_between(const Probe& a, const Probe& b) const;

  const Stage& stage_;
  Prober prober_;
  SurveyOptions options_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint8_t> suspected_, split_, emitter_, coloured_;
  std::vector<float> unevenness_;
  std::vector<std::unique_ptr<Regions>> regions_;
  bool environment_;  // fills what nothing else does
};

}  // namespace etendue::rendering
