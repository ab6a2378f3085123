#include "texture_rows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "finite_picture.h"

namespace etendue {
namespace {

constexpr std::uint64_t max_pixels = std::uint64_t{1} << 32;
constexpr std::uint32_t max_side = 1u << 16;

using Affine = double[2][3];

bool is_identity(const Affine& m) { return m[0][0] == 1 && m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][1] == 1 && m[1][2] == 0; }

// From what `from` takes coordinates to, to what `to` takes the same coordinates to: to after the inverse of from.
bool relate(const Affine& from, const Affine& to, Affine& out) {
  const double det = from[0][0] * from[1][1] - from[0][1] * from[1][0];
  if (!(std::abs(det) > 1e-12)) return false;
  const double inverse[2][2] = {{from[1][1] / det, -from[0][1] / det}, {-from[1][0] / det, from[0][0] / det}};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) out[row][column] = to[row][0] * inverse[0][column] + to[row][1] * inverse[1][column];
    out[row][2] = to[row][2] - out[row][0] * from[0][2] - out[row][1] * from[1][2];
  }
  return true;
}

bool same_transform(const Affine& a, const Affine& b) { return std::equal(&a[0][0], &a[0][0] + 6, &b[0][0]); }

Error unrelated(const std::string& text) { return {"TEXTURES_UNRELATED", text, {}, {}, {}}; }

}  // namespace

Status TextureRows::open_source(Source& source, const Texture& first, bool is_first) {
  if (source.texture.uv_set != first.uv_set)
    return unrelated("expected textures with the same set of coordinates, found TEXCOORD_" + std::to_string(first.uv_set) +
                     " and TEXCOORD_" + std::to_string(source.texture.uv_set));
  Affine relation = {{1, 0, 0}, {0, 1, 0}};
  if (!is_first && !same_transform(first.uv_transform, source.texture.uv_transform) &&
      !relate(first.uv_transform, source.texture.uv_transform, relation))
    return unrelated("expected a transform of the first texture that can be undone");
  std::copy(&relation[0][0], &relation[0][0] + 6, &source.texture.uv_transform[0][0]);
  Result<ImageRows> rows = ImageRows::open(*source.image, source.texture.encoding, max_pixels);
  if (!rows) return rows.error();
  source.has_alpha = rows->has_alpha();
  const auto extent = [](std::uint32_t texels, double a, double b) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(texels * std::hypot(a, b) - 1e-9), 1.0, double{max_side}));
  };
  width_ = std::max(width_, extent(rows->width(), relation[0][0], relation[1][0]));
  height_ = std::max(height_, extent(rows->height(), relation[0][1], relation[1][1]));
  const auto whole = [](double x) { return x == std::round(x); };
  const bool tiles = whole(relation[0][0]) && whole(relation[0][1]) && whole(relation[1][0]) && whole(relation[1][1]) &&
                     source.texture.wrap_u == Wrap::repeat && source.texture.wrap_v == Wrap::repeat && first.wrap_u == Wrap::repeat &&
                     first.wrap_v == Wrap::repeat;
  const bool follows = is_identity(relation) && source.texture.wrap_u == first.wrap_u && source.texture.wrap_v == first.wrap_v;
  repeats_ = repeats_ && (tiles || follows);
  source.rows = std::move(*rows);
  return Done{};
}

Result<TextureRows> TextureRows::open(const Scene& scene, const Textures& textures) {
  TextureRows out;
  const Texture* first = nullptr;
  for (std::size_t i = 0; i < most; ++i) {
    if (textures[i] == nullptr) continue;
    Source& source = out.sources_[i];
    source.image = &scene.images[textures[i]->image];
    source.texture = *textures[i];
    if (first == nullptr) first = textures[i];
    if (Status opened = out.open_source(source, *first, first == textures[i]); !opened) return opened.error();
    ++out.images_;
  }
  for (Source& source : out.sources_) {
    if (source.image == nullptr) continue;
    const bool as_it_is =
        source.rows->width() == out.width_ && source.rows->height() == out.height_ && is_identity(source.texture.uv_transform);
    if (as_it_is) continue;
    source.rows.reset();
    Result<DecodedImage> picture = decode_finite(*source.image, source.texture.encoding, max_pixels);
    if (!picture) return picture.error();
    source.picture = std::move(*picture);
  }
  return out;
}

std::span<const float> TextureRows::row_of(const Source& source, std::uint32_t y, std::uint32_t in_band,
                                           std::vector<float>& scratch) const {
  const std::size_t values = std::size_t{width_} * 4;
  if (source.rows) return std::span(source.band).subspan(in_band * values, values);
  scratch.assign(values, 1.0f);
  if (source.image == nullptr) return scratch;
  for (std::uint32_t x = 0; x < width_; ++x) {
    const Rgba at = sample(*source.picture, source.texture, {(x + 0.5) / width_, (y + 0.5) / height_});
    const double rgba[4] = {at.r, at.g, at.b, at.a};
    for (std::size_t c = 0; c < 4; ++c) scratch[x * 4 + c] = static_cast<float>(rgba[c]);
  }
  return scratch;
}

Status TextureRows::for_each(unsigned threads, Progress* progress, std::string_view what, const std::function<void(const Row&)>& row,
                             const std::function<Status(std::uint32_t)>& band) {
  for (Source& source : sources_) {
    if (!source.rows) continue;
    // From the top again, whoever has read it before.
    Result<ImageRows> rows = ImageRows::open(*source.image, source.texture.encoding, max_pixels);
    if (!rows) return rows.error();
    source.rows = std::move(*rows);
    source.band.resize(std::size_t{width_} * 4 * band_rows);
  }
  for (std::uint32_t begin = 0; begin < height_; begin += band_rows) {
    const std::uint32_t rows = std::min(band_rows, height_ - begin);
    std::array<Status, most> read{Status(Done{}), Status(Done{}), Status(Done{}), Status(Done{})};
    {
      std::vector<std::thread> readers;
      for (std::size_t i = 0; i < most; ++i) {
        if (!sources_[i].rows) continue;
        const auto one = [&, i] { read[i] = sources_[i].rows->read(rows, sources_[i].band); };
        if (threads > 1)
          readers.emplace_back(one);
        else
          one();
      }
      for (std::thread& reader : readers) reader.join();
    }
    for (const Status& status : read)
      if (!status) return status;
    std::atomic<std::uint32_t> next = 0;
    const auto work = [&](unsigned thread) {
      std::array<std::vector<float>, most> scratch;
      for (std::uint32_t y = next++; y < rows; y = next++) {
        Row one{thread, begin + y, y, {}};
        for (std::size_t i = 0; i < most; ++i) one.rgba[i] = row_of(sources_[i], begin + y, y, scratch[i]);
        row(one);
      }
    };
    std::vector<std::thread> workers;
    for (unsigned t = 1; t < threads; ++t) workers.emplace_back(work, t);
    work(0);
    for (std::thread& worker : workers) worker.join();
    if (Status status = band(rows); !status) return status;
    if (progress != nullptr && !progress->report(what, static_cast<double>(begin + rows) / height_))
      return Error{"CANCELLED", "cancelled", {}, "", {}};
  }
  return Done{};
}

}  // namespace etendue
