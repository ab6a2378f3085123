// Float pictures of several layers, read from and written to OpenEXR; textures decoded through OpenImageIO.
#pragma once

#include "etendue/image.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

// Interleaved float32, row 0 at the top. The layer "" holds R, G, B; others are "name.R" ... or "name" (one channel) in the file.
struct Layer {
  std::string name;
  int channels = 3;  // 1 or 3
  std::vector<float> pixels;
};

// Layers that the SDK writes and reads by name:
//   ""                       the picture, cd/m2, linear Rec.709
//   "variance"               variance of each pixel's value (of the mean over seeds, for a reference)
//   "variance_bound"         the part of "variance" that bounds an error instead of measuring noise (ours alone; sdk/docs/comparison.md)
//   "light.NAME"             one light's part;  "light_variance.NAME" its variance, "light_variance_bound.NAME" likewise
//   "object"                 1 + index of the object at the pixel's centre, 0 for none, -1 - index for a light
//   "emitter"                1 where the pixel or one beside it touches a visible emitter or the environment, else 0
//   "depth" "normal" "albedo"  at the centre: distance along the ray in metres (0: none), shading normal, base colour
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<Layer> layers;
  // OpenEXR's standard attributes where there are any: "whiteLuminance", "expTime", "aperture", "isoSpeed"; ours start with "etendue:".
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;

  Layer* find(std::string_view name);
  const Layer* find(std::string_view name) const;
  Layer& add(std::string name, int channels);  // zeroed; references to the other layers end here
};

// A light's name as it may stand in a channel name: dots and control characters become '_'.
std::string layer_safe(std::string_view name);

Status write_exr(const Picture& picture, const std::filesystem::path& file);
// Any OpenEXR file with R, G, B (or Y) channels; half becomes float. A file that declares more than `max_pixels`, or more than its length
// can stand for, is refused before memory is taken for it. Errors: FILE_UNREADABLE, FILE_TOO_LARGE, PICTURE_UNSUITABLE.
Result<Picture> read_exr(const std::filesystem::path& file, std::uint64_t max_pixels = std::uint64_t{1} << 27);

// A decoded texture: linear values (sRGB decoded if the encoding says so), 4 channels, alpha 1 where the file has none.
struct DecodedImage {
  std::uint32_t width = 0, height = 0;
  std::vector<float> rgba;
};
Result<DecodedImage> decode(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels = std::uint64_t{1} << 28);

// The same numbers row by row from the top, of which no more than 64 rows or a row of tiles are in memory.
struct ImageRow {
  std::uint32_t width, height, y;
  std::span<const float> rgba;
};
Status decode_rows(const ImageRef& image, Encoding encoding, const std::function<void(const ImageRow&)>& use,
                   std::uint64_t max_pixels = std::uint64_t{1} << 32);

// Bilinear (or nearest) lookup with the texture's wrap modes and uv transform. No mip maps, as in Mitsuba.
struct Rgba {
  double r = 0, g = 0, b = 0, a = 1;
};
Rgba sample(const DecodedImage& image, const Texture& texture, Vec2d uv);

// The grid that the Mitsuba exporter cuts holes on: cells along a texel's side. 1 where the lookup is nearest or the picture is large.
std::uint32_t cut_out_cells(const DecodedImage& image, const Texture& texture);
// sample() at the middle of uv's cell.
Rgba sample_cell(const DecodedImage& image, const Texture& texture, Vec2d uv);

}  // namespace etendue
