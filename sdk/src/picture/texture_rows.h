// Several textures of one surface as pictures of one size, band by band.
#pragma once

#include "etendue/io.h"
#include "etendue/picture.h"
#include "etendue/scene.h"
#include "image_rows.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

// The common picture is looked up as the first texture is. It is as wide and as high as the largest of them, each at the scale at which its
// own transform shows it. A texture of that size with the same transform and wrapping is read as it is, every other one is held in memory
// and looked up, bilinearly and with its own wrapping, at the middle of each texel. Null: 1 everywhere.
class TextureRows {
 public:
  static constexpr std::size_t most = 4;
  using Textures = std::array<const Texture*, most>;

  // Errors: those of decoding; TEXTURES_UNRELATED: they are looked up with different sets of coordinates.
  static Result<TextureRows> open(const Scene& scene, const Textures& textures);

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  bool has_alpha(std::size_t texture) const { return sources_[texture].has_alpha; }
  // Whether a lookup outside 0..1 meets what the textures show there: else the common picture is right within 0..1 of the first one alone.
  bool repeats() const { return repeats_; }
  std::uint64_t images_decoded() const { return images_; }

  // `row` is called from `threads` threads at a time, each with a number of its own, for every row once; `band` after every some rows.
  struct Row {
    unsigned thread;
    std::uint32_t y;     // in the picture
    std::uint32_t band;  // within the band
    std::array<std::span<const float>, most> rgba;
  };
  Status for_each(unsigned threads, Progress* progress, std::string_view what, const std::function<void(const Row&)>& row,
                  const std::function<Status(std::uint32_t rows)>& band);
  static constexpr std::uint32_t band_rows = 64;

 private:
  struct Source {
    const ImageRef* image = nullptr;  // null: 1 everywhere
    Texture texture;                  // its transform takes coordinates of the common picture
    bool has_alpha = false;
    std::optional<ImageRows> rows;  // read as it is
    std::optional<DecodedImage> picture;
    std::vector<float> band;
  };
  Status open_source(Source& source, const Texture& first, bool is_first);
  std::span<const float> row_of(const Source& source, std::uint32_t y, std::uint32_t in_band, std::vector<float>& scratch) const;

  std::array<Source, most> sources_;
  std::uint32_t width_ = 1, height_ = 1;
  bool repeats_ = true;
  std::uint64_t images_ = 0;
};

}  // namespace etendue
