// A decoded texture that is looked up texel by texel, with what it needs beside it.
#pragma once

#include "etendue/picture.h"
#include "etendue/scene.h"

#include <cstdint>
#include <optional>
#include <utility>

namespace etendue {

struct NearestLookup {
  DecodedImage image;
  Texture texture;  // nearest, without the transform: places are the picture's own
};

// None where there is no texture. Errors: those of decode().
inline Result<std::optional<NearestLookup>> nearest_lookup_of(const Scene& scene, const std::optional<Texture>& texture,
                                                              std::uint64_t max_pixels) {
  if (!texture) return std::optional<NearestLookup>{};
  Result<DecodedImage> image = decode(scene.images[texture->image], texture->encoding, max_pixels);
  if (!image) return image.error();
  NearestLookup lookup{std::move(*image), {}};
  lookup.texture.nearest = true;
  return std::optional{std::move(lookup)};
}

}  // namespace etendue
