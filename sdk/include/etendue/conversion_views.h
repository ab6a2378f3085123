// Where a converted material is furthest from what it was, as a picture.
//   const Scene before = scene;
//   convert_materials(scene, options);
//   auto view = conversion_view(before, before.materials[i], scene, scene.materials[i]);   // write_png(view->picture, "chair.png")
#pragma once

#include "etendue/picture.h"
#include "etendue/result.h"
#include "etendue/scene.h"

#include <cstdint>
#include <vector>

namespace etendue {

// The square of texels with the largest mean squared error in one reader.
struct WorstRegion {
  const char* reader = "core";  // "core" or "full"
  std::uint32_t x = 0, y = 0;   // its first texel, from the upper left corner
  std::uint32_t width = 1, height = 1;
  double rms = 0, max = 0;  // over diffuse colour and f0 of a texel, linear
};
struct ConversionView {
  std::uint32_t width = 1, height = 1;  // of the largest texture
  std::vector<WorstRegion> regions;     // of the core-only and of the full reader
  // Layer "", linear: a row for each region, with the diffuse colour before and after, f0 before and after, and a texel's rms in false
  // colours from 0 (dark blue) to the region's largest (pale). A region has up to 128 texels a side, each of whole pixels.
  Picture picture;
};
// A material before and after convert_materials(), each with the scene that its textures are in. Textures are looked up as check_material()
// does. Errors: those of decode(); MODEL_UNSUITABLE where a model is not one of glTF's two.
Result<ConversionView> conversion_view(const Scene& before, const Material& was, const Scene& after, const Material& is,
                                       std::uint64_t max_pixels = std::uint64_t{1} << 26);

}  // namespace etendue
