// A scene's materials, texel by texel, against what real surfaces have (plausibility.h), with a view of where they do not.
#pragma once

#include "etendue/picture.h"
#include "etendue/plausibility.h"
#include "etendue/scene.h"

#include <array>
#include <cstdint>

namespace etendue {

struct MaterialCheck {
  std::uint32_t width = 1, height = 1;                               // of the largest of its textures, whose texels are judged
  std::array<std::uint64_t, all_doubts.size()> texels{};             // that have each doubt
  std::uint64_t doubtful = 0;                                        // that have one or more
  Rgb albedo_least{}, albedo_greatest{}, f0_least{}, f0_greatest{};  // channel by channel
  // Layer "", linear: the colour of the worst doubt (DoubtInfo); sound texels dimmed and grey.
  Picture view;
  std::uint64_t images_decoded = 0;
  bool same_places = true;  // false: its textures have transforms of their own, which are left out here

  double share(Doubt doubt) const {
    return static_cast<double>(texels[static_cast<std::size_t>(doubt)]) / (static_cast<double>(width) * height);
  }
  double doubtful_share() const { return static_cast<double>(doubtful) / (static_cast<double>(width) * height); }
};
// Textures are taken over [0, 1]^2 of their own coordinates, the smaller ones looked up at the texels of the largest; vertex colours have
// no part in it. Errors: those of decode().
Result<MaterialCheck> check_material(const Scene& scene, const Material& material, const PlausibleRanges& ranges = {},
                                     std::uint64_t max_pixels = std::uint64_t{1} << 26);

}  // namespace etendue
