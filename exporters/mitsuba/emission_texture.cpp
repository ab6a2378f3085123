#include "emission_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue::mitsuba {
namespace {

constexpr double most_texels = 1 << 26;

Vec2d transformed(const double (&m)[2][3], const Vec2f& uv) {
  return {m[0][0] * uv.x + m[0][1] * uv.y + m[0][2], m[1][0] * uv.x + m[1][1] * uv.y + m[1][2]};
}

// Texel of the picture that stands at `i` of its endless repetition.
std::int64_t wrapped(std::int64_t i, std::int64_t n, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp<std::int64_t>(i, 0, n - 1);
  const std::int64_t period = wrap == Wrap::mirror ? 2 * n : n;
  const std::int64_t at = ((i % period) + period) % period;
  return at < n ? at : period - 1 - at;
}

// Whole repetitions of the picture, from `first`, `count` of them, that one axis of the coordinates reaches.
struct Tiles {
  std::int64_t first = 0, count = 1;
};
// Coordinates that touch the border of a tile do not enter the next.
Tiles tiles_of(double lowest, double highest) {
  const double first = std::floor(lowest + 1e-6), last = std::max(std::ceil(highest - 1e-6), first + 1);
  return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last - first)};
}

std::vector<float> repeated(const DecodedImage& image, const Texture& texture, const Tiles& across, const Tiles& down, const Rgb& factor) {
  const std::int64_t width = image.width, height = image.height;
  std::vector<float> rgb;
  rgb.reserve(static_cast<std::size_t>(across.count * width * down.count * height) * 3);
  for (std::int64_t y = down.first * height; y < (down.first + down.count) * height; ++y) {
    for (std::int64_t x = across.first * width; x < (across.first + across.count) * width; ++x) {
      const std::int64_t texel = wrapped(y, height, texture.wrap_v) * width + wrapped(x, width, texture.wrap_u);
      for (int c = 0; c < 3; ++c) {
        rgb.push_back(static_cast<float>(image.rgba[static_cast<std::size_t>(texel * 4 + c)] * factor[c]));
      }
    }
  }
  return rgb;
}

}  // namespace

Status add_textured_radiance(Writer& writer, pugi::xml_node parent, Mesh& mesh, const Texture& texture, const Rgb& radiance,
                             const std::string& owner) {
  constexpr double endless = std::numeric_limits<double>::max();
  Vec2d lowest{endless, endless}, highest{-endless, -endless};
  for (const Vec2f& uv : mesh.uvs) {
    const Vec2d at = transformed(texture.uv_transform, uv);
    lowest = {std::min(lowest.x, at.x), std::min(lowest.y, at.y)};
    highest = {std::max(highest.x, at.x), std::max(highest.y, at.y)};
  }
  Result<DecodedImage> image = decode(writer.scene.images[texture.image], texture.encoding);
  if (!image) return image.error();
  if (!((highest.x - lowest.x + 2) * image->width * (highest.y - lowest.y + 2) * image->height <= most_texels)) {
    return unsupported(owner + ": its texture is repeated too often for one picture", {});
  }
  const Tiles across = tiles_of(lowest.x, highest.x), down = tiles_of(lowest.y, highest.y);
  for (Vec2f& uv : mesh.uvs) {
    const Vec2d at = transformed(texture.uv_transform, uv);
    uv = {static_cast<float>((at.x - static_cast<double>(across.first)) / static_cast<double>(across.count)),
          static_cast<float>((at.y - static_cast<double>(down.first)) / static_cast<double>(down.count))};
  }
  Result<std::string> file =
      writer.assets.add_picture(static_cast<std::uint32_t>(across.count * image->width),
                                static_cast<std::uint32_t>(down.count * image->height), repeated(*image, texture, across, down, radiance));
  if (!file) return file.error();
  pugi::xml_node bitmap = add_plugin(parent, "texture", "bitmap", {}, "radiance");
  add_string(bitmap, "filename", *file);
  if (texture.nearest) add_string(bitmap, "filter_type", "nearest");
  // At the outermost half texel a mirrored picture continues as a clamped one does.
  if (texture.wrap_u != Wrap::repeat || texture.wrap_v != Wrap::repeat) add_string(bitmap, "wrap_mode", "clamp");
  return Done{};
}

void set_planar_uvs(Mesh& mesh) {
  if (mesh.positions.empty()) return;
  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
  }
  mesh.uvs.clear();
  for (const Vec3f& p : mesh.positions) mesh.uvs.push_back({(high.x - p.x) / (high.x - low.x), (high.y - p.y) / (high.y - low.y)});
}

}  // namespace etendue::mitsuba
