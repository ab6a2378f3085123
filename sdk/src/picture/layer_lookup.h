// What a layer's material is at a place of its textures.
#pragma once

#include "etendue/layered_surface.h"
#include "etendue/material.h"
#include "etendue/picture.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

// Textures' pictures, each decoded once an encoding.
class LayerPictures {
 public:
  explicit LayerPictures(std::span<const ImageRef> images) : images_(images) {}

  // Errors: LAYERS_INVALID for a picture that is not there, those of decode(), PICTURE_UNSUITABLE where a number is not finite.
  Status load(const std::optional<Texture>& texture);
  const DecodedImage& of(const Texture& texture) const { return decoded_.at({texture.image, texture.encoding}); }
  // White where there is no texture.
  Rgba at(const std::optional<Texture>& texture, Vec2d uv) const;
  // Its largest numbers, channel by channel; 1 where there is no texture.
  Rgb brightest(const std::optional<Texture>& texture) const;
  std::uint64_t count() const { return decoded_.size(); }

 private:
  std::span<const ImageRef> images_;
  std::map<std::pair<std::uint32_t, Encoding>, DecodedImage> decoded_;
};

// Disney parameters of two colours take microseconds, and few texels differ: one place a hash, where the newer takes the older's. What is
// found is a function of the colours alone.
class SurfaceFits {
 public:
  SurfaceFits() : entries_(std::size_t{1} << 12) {}
  const Standard& of(const SpecularGlossiness& surface);

 private:
  using Key = std::array<double, 7>;
  struct Entry {
    bool known = false;
    Key key{};
    Standard value;
  };
  std::vector<Entry> entries_;
};

// Emission is the factor's where it has no texture.
LayerValue layer_value(const Material& material, const LayerPictures& pictures, Vec2d uv, SurfaceFits& fits);

}  // namespace etendue
