// One texture of a surface as rows of a common picture, whatever its own size, transform and wrapping.
#pragma once

#include "etendue/scene.h"
#include "image_rows.h"
#include "lookup.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

// How the file's texels are kept while rows are made of them: as a window of rows that goes down the file, where the lookup does too; else
// all of them in memory, or if they are many in tiles of a scratch file, of which a bounded number is in memory.
enum class Keeping { window, held, tiles };

// A file that goes when its owner does.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path) : path_(std::move(path)) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class TextureSource {
 public:
  struct Settings {
    std::filesystem::path scratch;                       // folder of scratch files, made if need be
    std::uint64_t held_texels = std::uint64_t{1} << 20;  // more are not held whole
    std::uint64_t kept_bytes = 0;                        // of a file that is read again: fewer are kept as the file has them
    std::uint64_t max_pixels = std::uint64_t{1} << 32;
  };
  // Null image: 1 everywhere. The texture's transform takes coordinates of the common picture.
  TextureSource() = default;
  static Result<TextureSource> open(const ImageRef& image, const Texture& texture, const Settings& settings);

  bool is_there() const { return image_ != nullptr; }
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  bool has_alpha() const { return has_alpha_; }
  const Texture& texture() const { return texture_; }

  // Before the first row, and again for another pass. `slots` bands may be open at a time.
  Status start(std::uint32_t width, std::uint32_t height, std::uint32_t band_rows, std::size_t slots);
  // What the rows of the next band need, into slot `slot`: one call after the other.
  Status read_band(std::uint32_t begin, std::uint32_t rows, std::size_t slot);
  // A row of the band in `slot`, any thread, each once: looked up now.
  Status look_up(std::uint32_t y, std::uint32_t in_band, std::size_t slot);
  // 4 channels a texel.
  std::span<const float> row(std::uint32_t in_band, std::size_t slot) const;
  Keeping keeping() const { return keeping_; }

 private:
  struct Tiles;
  struct Window {
    std::int64_t first = 0;  // row of the endless picture
    std::vector<float> rows;
  };
  bool as_it_is() const;
  Between row_of(std::uint32_t y) const;
  void find_columns();
  const float* file_row(std::int64_t y, std::size_t slot) const;
  void look_up_straight(std::uint32_t y, std::size_t slot, std::span<float> out) const;
  Status hold();
  Status cut_into_tiles();
  Status fill(Window& window, std::int64_t first, std::int64_t last);
  Status reopen();
  template <class Texel>
  void look_up_row(std::uint32_t y, std::span<float> out, Texel texel) const;

  const ImageRef* image_ = nullptr;
  Texture texture_;
  Settings settings_;
  std::uint32_t width_ = 1, height_ = 1, common_width_ = 1, common_height_ = 1;
  bool has_alpha_ = false, direct_ = true;
  Keeping keeping_ = Keeping::window;
  std::optional<ImageRows> rows_;
  std::vector<float> last_row_;  // of the file that was read
  std::vector<float> held_;
  // Of the common picture, where each row of it is one of the file: the two texels of a file's row that one is between, and the share of
  // the second.
  struct Column {
    std::size_t low, high;
    double share;
  };
  std::vector<Column> columns_;
  std::shared_ptr<Tiles> tiles_;
  std::vector<Window> windows_;            // one a slot
  std::vector<std::vector<float>> bands_;  // one a slot
  std::vector<float> ones_;
};

}  // namespace etendue
