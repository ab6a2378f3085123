// Several textures of one surface as pictures of one size, band by band.
#pragma once

#include "etendue/io.h"
#include "etendue/scene.h"
#include "texture_source.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

// The common picture is looked up as the first texture is. It is as wide and as high as the largest of them, each at the scale at which its
// own transform shows it. A texture of that size with the same transform and wrapping is read as it is, every other one is looked up
// bilinearly and with its own wrapping at the middle of each texel (TextureSource). Null: 1 everywhere.
class TextureRows {
 public:
  static constexpr std::size_t most = 4;
  using Textures = std::array<const Texture*, most>;

  // Errors: those of decoding; TEXTURES_UNRELATED: they are looked up with different sets of coordinates.
  static Result<TextureRows> open(const Scene& scene, const Textures& textures, const TextureSource::Settings& settings);

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  bool has_alpha(std::size_t texture) const { return sources_[texture].has_alpha(); }
  // Whether a lookup outside 0..1 meets what the textures show there: else the common picture is right within 0..1 of the first one alone.
  bool repeats() const { return repeats_; }
  std::uint64_t images_decoded() const { return images_; }

  struct Row {
    unsigned thread;
    std::uint32_t y;
    std::array<std::span<const float>, most> rgba;
  };
  // What is done, from `threads` threads at a time, each with a number of its own.
  struct Work {
    // Every row once. May be empty.
    std::function<void(const Row&)> survey;
    // Every row once, after the survey of its band and of the next one.
    std::function<void(const Row&)> row;
    // So many calls for each band of rows that are done, from the top down; of two calls with different numbers any may come first.
    std::size_t writers = 0;
    std::function<Status(std::size_t writer, std::uint32_t begin, std::uint32_t rows)> write;
  };
  // Reading, both kinds of rows and writing of different bands go on at the same time.
  Status for_each(unsigned threads, Progress* progress, std::string_view what, const Work& work);
  static constexpr std::uint32_t band_rows = 32;
  static constexpr std::uint32_t written_bands = 2;  // that row() and write() are busy with at a time

 private:
  Status relate(std::size_t index, const ImageRef& image, const Texture& texture, const Texture& first, bool is_first,
                const TextureSource::Settings& settings);

  std::array<TextureSource, most> sources_;
  std::uint32_t width_ = 1, height_ = 1;
  bool repeats_ = true;
  std::uint64_t images_ = 0;
};

}  // namespace etendue
