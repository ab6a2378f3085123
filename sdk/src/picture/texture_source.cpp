#include "texture_source.h"

#include "lookup.h"

#include <OpenImageIO/imagecache.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace etendue {
namespace {

// A window may begin again at the top of the file for what repeats, each time at the price of reading it once more.
constexpr double most_repeats = 3;
constexpr int tile_side = 64;
constexpr float cache_megabytes = 128;

bool is_identity(const double (&m)[2][3]) {
  return m[0][0] == 1 && m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][1] == 1 && m[1][2] == 0;
}

// Whether rows of the common picture from the top down meet rows of the file in their order.
bool goes_down(const Texture& texture, std::uint32_t height) {
  const auto& m = texture.uv_transform;
  if (m[1][0] != 0 || !(m[1][1] > 0)) return false;
  const double begin = m[1][2], end = m[1][2] + m[1][1], margin = 1.0 / height;
  if (!(std::abs(begin) < 512 && std::abs(end) < 512)) return false;
  switch (texture.wrap_v) {
    case Wrap::clamp:
      return begin > -1 && end < 2;  // where nothing is tamed
    case Wrap::mirror:
      return begin >= -margin / 4 && end <= 1 + margin / 4;
    case Wrap::repeat:
      break;
  }
  return std::floor(end) - std::floor(begin) <= most_repeats;
}

}  // namespace

struct TextureSource::Tiles {
  Tiles(const std::filesystem::path& path, std::size_t texel_bytes)
      : file(path), bytes(texel_bytes), cache(OIIO::ImageCache::create(false)) {
    cache->attribute("max_memory_MB", cache_megabytes);
    cache->attribute("unassociatedalpha", 1);
  }
  Tiles(const Tiles&) = delete;
  Tiles& operator=(const Tiles&) = delete;
  ~Tiles() { OIIO::ImageCache::destroy(cache); }

  ScratchFile file;
  std::size_t bytes;
  OIIO::ImageCache* cache;
};

Result<TextureSource> TextureSource::open(const ImageRef& image, const Texture& texture, const Settings& settings) {
  TextureSource out;
  out.image_ = &image;
  out.texture_ = texture;
  out.settings_ = settings;
  Result<ImageRows> rows = ImageRows::open(image, texture.encoding, settings.max_pixels);
  if (!rows) return rows.error();
  out.rows_ = std::move(*rows);
  out.width_ = out.rows_->width();
  out.height_ = out.rows_->height();
  out.has_alpha_ = out.rows_->has_alpha();
  if (out.rows_->bytes() <= settings.kept_bytes) out.rows_->keep();
  return out;
}

bool TextureSource::as_it_is() const { return width_ == common_width_ && height_ == common_height_ && is_identity(texture_.uv_transform); }

Status TextureSource::reopen() {
  if (rows_->rewind()) return Done{};
  Result<ImageRows> rows = ImageRows::open(*image_, texture_.encoding, settings_.max_pixels);
  if (!rows) return rows.error();
  rows_ = std::move(*rows);
  return Done{};
}

Status TextureSource::start(std::uint32_t width, std::uint32_t height, std::uint32_t band_rows, std::size_t slots) {
  common_width_ = width;
  common_height_ = height;
  if (!is_there()) {
    ones_.assign(std::size_t{width} * 4, 1.0f);
    return Done{};
  }
  bands_.resize(slots);
  for (std::vector<float>& band : bands_) band.resize(std::size_t{width} * 4 * band_rows);
  direct_ = as_it_is();
  if (direct_) return reopen();
  find_columns();
  if (std::uint64_t{width_} * height_ <= settings_.held_texels) {
    keeping_ = Keeping::held;
    return held_.empty() ? hold() : Status(Done{});
  }
  if (!goes_down(texture_, height_)) {
    keeping_ = Keeping::tiles;
    return tiles_ ? Status(Done{}) : cut_into_tiles();
  }
  keeping_ = Keeping::window;
  windows_.assign(slots, {});
  return reopen();
}

Status TextureSource::hold() {
  if (Status opened = reopen(); !opened) return opened;
  held_.resize(std::size_t{width_} * height_ * 4);
  return rows_->read(height_, held_);
}

Status TextureSource::cut_into_tiles() {
  if (Status opened = reopen(); !opened) return opened;
  std::error_code failure;
  std::filesystem::create_directories(settings_.scratch, failure);
  static std::atomic<unsigned> number = 0;
  const auto path = settings_.scratch / ("scratch" + std::to_string(number++) + ".tif");
  const auto unwritable = [&](const std::string& reason) {
    return Error{"FILE_UNWRITABLE", "cannot write the scratch file: " + reason, {path.string(), 0, 0, {}}, {}, {}};
  };
  const OIIO::TypeDesc type = rows_->code_type();
  const auto channels = static_cast<int>(rows_->channels());
  tiles_ = std::make_shared<Tiles>(path, static_cast<std::size_t>(channels) * type.size());
  const auto output = OIIO::ImageOutput::create("tif");
  OIIO::ImageSpec spec(static_cast<int>(width_), static_cast<int>(height_), channels, type);
  spec.tile_width = spec.tile_height = tile_side;
  spec["compression"] = "none";
  spec["tiff:bigtiff"] = 1;
  spec["oiio:UnassociatedAlpha"] = 1;
  if (!output || !output->open(path.string(), spec)) return unwritable(output ? output->geterror() : OIIO::geterror());
  std::vector<std::uint8_t> codes;
  for (std::uint32_t y = 0; y < height_; y += tile_side) {
    const std::uint32_t rows = std::min<std::uint32_t>(tile_side, height_ - y);
    if (Status read = rows_->read_codes(rows, codes); !read) return read;
    const auto begin = static_cast<int>(y);
    if (!output->write_tiles(0, spec.width, begin, begin + static_cast<int>(rows), 0, 1, type, codes.data()))
      return unwritable(output->geterror());
  }
  if (!output->close()) return unwritable(output->geterror());
  return Done{};
}

Between TextureSource::row_of(std::uint32_t y) const {
  return between(place(texture_, {0.5, (y + 0.5) / common_height_}).y, height_, texture_.nearest);
}

void TextureSource::find_columns() {
  const auto& m = texture_.uv_transform;
  columns_.clear();
  if (m[0][1] != 0 || m[1][0] != 0) return;
  for (std::uint32_t x = 0; x < common_width_; ++x) {
    const Between across = between(place(texture_, {(x + 0.5) / common_width_, 0.5}).x, width_, texture_.nearest);
    const auto texel = [this](std::int64_t column) { return static_cast<std::size_t>(wrapped(column, width_, texture_.wrap_u)); };
    columns_.push_back({texel(across.low), texel(across.low + 1), across.share});
  }
}

// Of the endless picture.
const float* TextureSource::file_row(std::int64_t y, std::size_t slot) const {
  const std::size_t values = std::size_t{width_} * 4;
  if (keeping_ == Keeping::held) return held_.data() + static_cast<std::size_t>(wrapped(y, height_, texture_.wrap_v)) * values;
  return windows_[slot].rows.data() + static_cast<std::size_t>(y - windows_[slot].first) * values;
}

// Rows `first` to `last` of the endless picture, those that the window holds already kept.
Status TextureSource::fill(Window& window, std::int64_t first, std::int64_t last) {
  const std::size_t values = std::size_t{width_} * 4;
  window.first = first;
  window.rows.resize(static_cast<std::size_t>(last - first + 1) * values);
  last_row_.resize(values);
  for (std::int64_t row = first; row <= last; ++row) {
    const auto wanted = static_cast<std::uint32_t>(wrapped(row, height_, texture_.wrap_v));
    const std::span<float> out = std::span(window.rows).subspan(static_cast<std::size_t>(row - first) * values, values);
    if (rows_->next() > wanted + 1)
      if (Status opened = reopen(); !opened) return opened;
    while (rows_->next() <= wanted)
      if (Status read = rows_->read(1, last_row_); !read) return read;
    std::copy(last_row_.begin(), last_row_.end(), out.begin());
  }
  return Done{};
}

Status TextureSource::read_band(std::uint32_t begin, std::uint32_t rows, std::size_t slot) {
  if (!is_there()) return Done{};
  if (direct_) return rows_->read(rows, bands_[slot]);
  if (keeping_ != Keeping::window) return Done{};
  const std::int64_t first = row_of(begin).low, last = row_of(begin + rows - 1).low + (texture_.nearest ? 0 : 1);
  // Its first rows are often the last of the band before, which the file has left behind.
  Window& window = windows_[slot];
  Window& before = windows_[(slot + windows_.size() - 1) % windows_.size()];
  const std::size_t values = std::size_t{width_} * 4;
  const auto end = before.first + static_cast<std::int64_t>(before.rows.size() / values);
  if (&window == &before || begin == 0 || first < before.first || first >= end) return fill(window, first, last);
  const std::vector<float> shared(
      before.rows.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first - before.first) * values), before.rows.end());
  if (last >= end)
    if (Status filled = fill(window, end, last); !filled) return filled;
  if (last < end) window.rows.clear();
  window.rows.insert(window.rows.begin(), shared.begin(), shared.end());
  window.first = first;
  return Done{};
}

template <class Texel>
void TextureSource::look_up_row(std::uint32_t y, std::span<float> out, Texel texel) const {
  for (std::uint32_t x = 0; x < common_width_; ++x) {
    const Vec2d at = place(texture_, {(x + 0.5) / common_width_, (y + 0.5) / common_height_});
    const auto rgba = mixed(between(at.x, width_, texture_.nearest), between(at.y, height_, texture_.nearest), texture_.nearest, texel);
    for (std::size_t c = 0; c < 4; ++c) out[std::size_t{x} * 4 + c] = static_cast<float>(rgba[c]);
  }
}

void TextureSource::look_up_straight(std::uint32_t y, std::size_t slot, std::span<float> out) const {
  const Between down = row_of(y);
  const float* const above = file_row(down.low, slot);
  if (texture_.nearest) {
    for (std::size_t x = 0; x < columns_.size(); ++x) std::copy_n(above + 4 * columns_[x].low, 4, out.data() + 4 * x);
    return;
  }
  const float* const below = file_row(down.low + 1, slot);
  for (std::size_t x = 0; x < columns_.size(); ++x) {
    const std::size_t low = 4 * columns_[x].low, high = 4 * columns_[x].high;
    const auto rgba = mean_of(above + low, above + high, below + low, below + high, columns_[x].share, down.share);
    for (std::size_t c = 0; c < 4; ++c) out[4 * x + c] = static_cast<float>(rgba[c]);
  }
}

Status TextureSource::look_up(std::uint32_t y, std::uint32_t in_band, std::size_t slot) {
  if (!is_there() || direct_) return Done{};
  const std::size_t values = std::size_t{common_width_} * 4;
  const std::span<float> out = std::span(bands_[slot]).subspan(in_band * values, values);
  const auto column = [this](std::int64_t x) { return static_cast<std::size_t>(wrapped(x, width_, texture_.wrap_u)); };
  if (keeping_ != Keeping::tiles && !columns_.empty()) {
    look_up_straight(y, slot, out);
  } else if (keeping_ != Keeping::tiles) {
    look_up_row(y, out, [&](std::int64_t tx, std::int64_t ty) { return file_row(ty, slot) + column(tx) * 4; });
  } else {
    OIIO::ImageCache& cache = *tiles_->cache;
    OIIO::ImageCache::Perthread* const own = cache.get_perthread_info();
    OIIO::ImageCache::ImageHandle* const file = cache.get_image_handle(OIIO::ustring(tiles_->file.path().string()), own);
    OIIO::ImageCache::Tile* tile = nullptr;
    const std::uint8_t* texels = nullptr;
    std::size_t tile_x = 0, tile_y = 0;
    bool failed = false;
    look_up_row(y, out, [&](std::int64_t tx, std::int64_t ty) {
      std::array<float, 4> rgba{};
      if (failed) return rgba;
      const std::size_t across = column(tx), down = static_cast<std::size_t>(wrapped(ty, height_, texture_.wrap_v));
      if (tile == nullptr || across / tile_side != tile_x || down / tile_side != tile_y) {
        if (tile != nullptr) cache.release_tile(tile);
        tile_x = across / tile_side, tile_y = down / tile_side;
        tile = cache.get_tile(file, own, 0, 0, static_cast<int>(across), static_cast<int>(down), 0);
        OIIO::TypeDesc type;
        texels = tile == nullptr ? nullptr : static_cast<const std::uint8_t*>(cache.tile_pixels(tile, type));
        failed = texels == nullptr || type != rows_->code_type();
        if (failed) return rgba;
      }
      const std::size_t place = (down % tile_side) * tile_side + across % tile_side;
      rows_->to_linear({texels + place * tiles_->bytes, tiles_->bytes}, rgba);
      return rgba;
    });
    if (tile != nullptr) cache.release_tile(tile);
    if (failed) return unreadable(*image_, "its scratch file: " + cache.geterror());
  }
  return Done{};
}

std::span<const float> TextureSource::row(std::uint32_t in_band, std::size_t slot) const {
  const std::size_t values = std::size_t{common_width_} * 4;
  return is_there() ? std::span(bands_[slot]).subspan(in_band * values, values) : std::span<const float>(ones_);
}

}  // namespace etendue
