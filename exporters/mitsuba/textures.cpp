#include "textures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

namespace etendue::mitsuba {
namespace {

const char* name_of(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return "repeat";
    case Wrap::mirror:
      return "mirror";
    case Wrap::clamp:
      break;
  }
  return "clamp";
}

// uv' = m uv as Mitsuba's 4x4 form: the offset stands in the last column.
Transform uv_matrix(const double (&m)[2][3]) {
  return {{Vec3d{m[0][0], m[1][0], 0}, Vec3d{m[0][1], m[1][1], 0}, Vec3d{0, 0, 1}}, {m[0][2], m[1][2], 0}};
}

pugi::xml_node add_bitmap(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, const std::string& file,
                          const std::string& owner) {
  pugi::xml_node node = add_plugin(parent, "texture", "bitmap", {}, name);
  add_string(node, "filename", file);
  if (texture.nearest) add_string(node, "filter_type", "nearest");
  if (texture.wrap_u != Wrap::repeat) add_string(node, "wrap_mode", name_of(texture.wrap_u));
  if (texture.wrap_u != texture.wrap_v) {
    writer.losses.add(
        owner + ": wrap mode " + name_of(texture.wrap_v) + " along v",
        std::string("v wraps as u does (") + name_of(texture.wrap_u) + "): another picture where v leaves 0..1, none elsewhere");
  }
  if (texture.uv_set != 0) {
    writer.losses.add(owner + ": uv set " + std::to_string(texture.uv_set),
                      "looked up with the first set: the picture lies elsewhere on the surface");
  }
  const Transform to_uv = uv_matrix(texture.uv_transform);
  if (!(to_uv == Transform{})) add_matrix(node, "to_uv", to_uv);
  return node;
}

Result<std::vector<std::byte>> bytes_of(const ImageRef& image) {
  if (image.embedded) {
    const auto bytes = image.embedded.bytes();
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  }
  return read_file(image.file, std::uint64_t{1} << 32);
}

// The extension of an encoding that both programs decode alike, by its first bytes; "" for others.
std::string extension_of(const std::vector<std::byte>& bytes) {
  const auto starts = [&](std::initializer_list<int> magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(), [](int m, std::byte b) { return m == std::to_integer<int>(b); });
  };
  if (starts({0x89, 'P', 'N', 'G'})) return ".png";
  if (starts({0xff, 0xd8, 0xff})) return ".jpg";
  return {};
}

using Bake = std::function<Rgb(const float* rgba)>;

// Image and encoding, and what `purpose` says of the bake.
std::string recipe_of(const Texture& texture, Encoding encoding, const std::string& purpose) {
  return "image " + std::to_string(texture.image) + (encoding == Encoding::srgb ? " srgb " : " linear ") + purpose;
}

Result<std::string> bake_now(Writer& writer, const Texture& texture, Encoding encoding, const Bake& value) {
  Result<DecodedImage> image = decode(writer.scene.images[texture.image], encoding);
  if (!image) return image.error();
  std::vector<float> rgb;
  rgb.reserve(image->rgba.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < image->rgba.size(); i += 4) {
    const Rgb baked = value(&image->rgba[i]);
    for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(baked[c]));
  }
  return writer.assets.add_picture(image->width, image->height, std::move(rgb));
}

Result<std::string> bake(Writer& writer, const Texture& texture, Encoding encoding, const std::string& purpose, const Bake& value) {
  return writer.assets.once(recipe_of(texture, encoding, purpose), [&] { return bake_now(writer, texture, encoding, value); });
}

// The cut runs through the texels where the interpolated alpha crosses the cutoff: interpolated on a grid, then cut.
Result<std::string> cut_out(Writer& writer, const Texture& texture, double factor, double cutoff) {
  Result<DecodedImage> image = decode(writer.scene.images[texture.image], Encoding::linear);
  if (!image) return image.error();
  const std::uint32_t fine = cut_out_cells(*image, texture);
  const std::uint32_t width = image->width * fine, height = image->height * fine;
  Texture plain = texture;
  plain.uv_transform[0][0] = plain.uv_transform[1][1] = 1;
  plain.uv_transform[0][1] = plain.uv_transform[0][2] = plain.uv_transform[1][0] = plain.uv_transform[1][2] = 0;
  std::vector<float> rgb;
  rgb.reserve(std::size_t{width} * height * 3);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double alpha = sample(*image, plain, {(x + 0.5) / width, (y + 0.5) / height}).a * factor;
      rgb.insert(rgb.end(), 3, alpha >= cutoff ? 1.0f : 0.0f);
    }
  }
  return writer.assets.add_picture(width, height, std::move(rgb));
}

}  // namespace

Status add_colour_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, const Rgb& factor,
                          const std::string& owner) {
  if (factor == Rgb{1, 1, 1} && texture.encoding == Encoding::srgb) {
    Result<std::vector<std::byte>> bytes = bytes_of(writer.scene.images[texture.image]);
    if (!bytes) return bytes.error();
    if (const std::string extension = extension_of(*bytes); !extension.empty()) {
      Result<std::string> file = writer.assets.add_file("image", extension, *bytes);
      if (!file) return file.error();
      add_bitmap(writer, parent, name, texture, *file, owner);
      return Done{};
    }
  }
  Result<std::string> file = bake(writer, texture, texture.encoding,
                                  "times " + text_of(factor.x) + ' ' + text_of(factor.y) + ' ' + text_of(factor.z), [&](const float* p) {
                                    return Rgb{p[0] * factor.x, p[1] * factor.y, p[2] * factor.z};
                                  });
  if (!file) return file.error();
  add_bitmap(writer, parent, name, texture, *file, owner);
  return Done{};
}

Status add_grey_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, int channel, double factor,
                        const std::string& owner) {
  const std::string purpose = "channel " + std::to_string(channel) + " times " + text_of(factor);
  Result<std::string> file = bake(writer, texture, Encoding::linear, purpose, [&](const float* p) {
    const double value = p[channel] * factor;
    return Rgb{value, value, value};
  });
  if (!file) return file.error();
  add_boolean(add_bitmap(writer, parent, name, texture, *file, owner), "raw", true);
  return Done{};
}

// Mitsuba's normal is normalise(2 t - 1). t' = (1 + s (2 t - 1)) / 2 scales a component by s, and, being linear, also between texels.
Status add_normal_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, double scale,
                          const std::string& owner) {
  Result<std::string> file = bake(writer, texture, Encoding::linear, "slopes times " + text_of(scale), [&](const float* p) {
    return Rgb{(1 + scale * (2.0 * p[0] - 1)) / 2, (1 + scale * (2.0 * p[1] - 1)) / 2, p[2]};
  });
  if (!file) return file.error();
  add_boolean(add_bitmap(writer, parent, name, texture, *file, owner), "raw", true);
  return Done{};
}

Status add_cutout_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, double factor, double cutoff,
                          const std::string& owner) {
  const std::string purpose = "alpha times " + text_of(factor) + " cut at " + text_of(cutoff) +
                              (texture.nearest ? " nearest " : " linear ") + name_of(texture.wrap_u) + ' ' + name_of(texture.wrap_v);
  Result<std::string> file =
      writer.assets.once(recipe_of(texture, Encoding::linear, purpose), [&] { return cut_out(writer, texture, factor, cutoff); });
  if (!file) return file.error();
  Texture cut = texture;
  cut.nearest = true;
  add_boolean(add_bitmap(writer, parent, name, cut, *file, owner), "raw", true);
  if (!texture.nearest)
    writer.losses.add(owner + ": edges of the cut-out", "on a grid of a quarter texel (one texel of pictures over 4 megapixels)");
  return Done{};
}

}  // namespace etendue::mitsuba
