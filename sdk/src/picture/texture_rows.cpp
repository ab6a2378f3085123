#include "texture_rows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <vector>

namespace etendue {
namespace {

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

Status TextureRows::relate(std::size_t index, const ImageRef& image, const Texture& texture, const Texture& first, bool is_first,
                           const TextureSource::Settings& settings) {
  if (texture.uv_set != first.uv_set)
    return unrelated("expected textures with the same set of coordinates, found TEXCOORD_" + std::to_string(first.uv_set) +
                     " and TEXCOORD_" + std::to_string(texture.uv_set));
  if (!std::all_of(&texture.uv_transform[0][0], &texture.uv_transform[0][0] + 6, [](double x) { return std::isfinite(x); }))
    return unrelated("expected a transform of finite numbers");
  Affine relation = {{1, 0, 0}, {0, 1, 0}};
  if (!is_first && !same_transform(first.uv_transform, texture.uv_transform) &&
      !etendue::relate(first.uv_transform, texture.uv_transform, relation))
    return unrelated("expected a transform of the first texture that can be undone");
  Texture looked_up = texture;
  std::copy(&relation[0][0], &relation[0][0] + 6, &looked_up.uv_transform[0][0]);
  Result<TextureSource> source = TextureSource::open(image, looked_up, settings);
  if (!source) return source.error();
  const auto extent = [](std::uint32_t texels, double a, double b) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(texels * std::hypot(a, b) - 1e-9), 1.0, double{max_side}));
  };
  width_ = std::max(width_, extent(source->width(), relation[0][0], relation[1][0]));
  height_ = std::max(height_, extent(source->height(), relation[0][1], relation[1][1]));
  const auto whole = [](double x) { return x == std::round(x); };
  const bool tiles = whole(relation[0][0]) && whole(relation[0][1]) && whole(relation[1][0]) && whole(relation[1][1]) &&
                     texture.wrap_u == Wrap::repeat && texture.wrap_v == Wrap::repeat && first.wrap_u == Wrap::repeat &&
                     first.wrap_v == Wrap::repeat;
  const bool follows = is_identity(relation) && texture.wrap_u == first.wrap_u && texture.wrap_v == first.wrap_v;
  repeats_ = repeats_ && (tiles || follows);
  sources_[index] = std::move(*source);
  return Done{};
}

Result<TextureRows> TextureRows::open(const Scene& scene, const Textures& textures, const TextureSource::Settings& settings) {
  TextureRows out;
  const Texture* first = nullptr;
  for (std::size_t i = 0; i < most; ++i) {
    if (textures[i] == nullptr) continue;
    if (first == nullptr) first = textures[i];
    if (Status related = out.relate(i, scene.images[textures[i]->image], *textures[i], *first, first == textures[i], settings); !related)
      return related.error();
    ++out.images_;
  }
  return out;
}

// The bands go down a line of stages, each one band behind the other, the rows two behind their survey: in one step reading is at band t,
// the survey at t - 1, the rows at t - 3 (without a survey t - 1), and writing one behind these. What one step has to do its threads take
// from one list, reading and writing first: each is a chain of its own, and the rows fill the gaps.
Status TextureRows::for_each(unsigned threads, Progress* progress, std::string_view what, const Work& work) {
  const bool surveys = static_cast<bool>(work.survey);
  const std::uint32_t bands = (height_ + band_rows - 1) / band_rows;
  const std::uint32_t behind = surveys ? 3 : 1, slots = behind + 1, last = bands + behind + 1;
  for (TextureSource& source : sources_)
    if (Status started = source.start(width_, height_, band_rows, slots); !started) return started;

  std::mutex failing;
  Status failure{Done{}};
  std::atomic<bool> failed = false;
  const auto check = [&](const Status& status) {
    if (status) return;
    const std::scoped_lock lock(failing);
    if (!failed.exchange(true)) failure = status;
  };
  for (std::uint32_t t = 0; t < last && !failed; ++t) {
    struct Band {
      std::uint32_t begin = 0, rows = 0;
      std::size_t slot = 0;
    };
    const auto band_at = [&](std::uint32_t lag) {
      if (t < lag || t - lag >= bands) return Band{};
      const std::uint32_t index = t - lag, begin = index * band_rows;
      return Band{begin, std::min(band_rows, height_ - begin), index % slots};
    };
    const Band read = band_at(0), surveyed = band_at(1), done = band_at(behind), written = band_at(behind + 1);
    const auto row_at = [&](const Band& band, std::uint32_t in_band, unsigned thread) {
      Row row{thread, band.begin + in_band, {}};
      for (std::size_t i = 0; i < most; ++i) row.rgba[i] = sources_[i].row(in_band, band.slot);
      return row;
    };
    // The list: writers, readers, rows that are looked up (and surveyed), rows.
    const auto writers = static_cast<std::uint32_t>(written.rows > 0 ? work.writers : 0);
    const std::uint32_t readers = read.rows > 0 ? most : 0, own_rows = surveys ? done.rows : 0;
    std::atomic<std::uint32_t> next = 0;
    const auto take = [&](unsigned thread) {
      const std::uint32_t count = writers + readers + surveyed.rows + own_rows;
      for (std::uint32_t job = next++; job < count && !failed; job = next++) {
        std::uint32_t i = job;
        if (i < writers) {
          check(work.write(i, written.begin, written.rows));
        } else if (i -= writers; i < readers) {
          check(sources_[i].read_band(read.begin, read.rows, read.slot));
        } else if (i -= readers; i < surveyed.rows) {
          for (TextureSource& source : sources_) check(source.look_up(surveyed.begin + i, i, surveyed.slot));
          (surveys ? work.survey : work.row)(row_at(surveyed, i, thread));
        } else {
          work.row(row_at(done, i - surveyed.rows, thread));
        }
      }
    };
    std::vector<std::thread> others;
    for (unsigned thread = 1; thread < threads; ++thread) others.emplace_back(take, thread);
    take(0);
    for (std::thread& other : others) other.join();
    if (progress != nullptr && !failed && !progress->report(what, static_cast<double>(t + 1) / last))
      return Error{"CANCELLED", "cancelled", {}, "", {}};
  }
  return failure;
}

}  // namespace etendue
