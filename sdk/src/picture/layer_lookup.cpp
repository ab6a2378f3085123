#include "layer_lookup.h"

#include "etendue/textured_surface.h"
#include "finite_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace etendue {
namespace {

constexpr std::uint64_t max_pixels = std::uint64_t{1} << 28;

}  // namespace

Status LayerPictures::load(const std::optional<Texture>& texture) {
  if (!texture) return Done{};
  if (texture->image >= images_.size())
    return Error{"LAYERS_INVALID", fmt::format("expected one of {} images, found {}", images_.size(), texture->image), {}, {}, {}};
  const std::pair key{texture->image, texture->encoding};
  if (decoded_.contains(key)) return Done{};
  Result<DecodedImage> image = decode_finite(images_[texture->image], texture->encoding, max_pixels);
  if (!image) return image.error();
  decoded_.emplace(key, std::move(*image));
  return Done{};
}

Rgba LayerPictures::at(const std::optional<Texture>& texture, Vec2d uv) const {
  return texture ? sample(of(*texture), *texture, uv) : Rgba{1, 1, 1, 1};
}

Rgb LayerPictures::brightest(const std::optional<Texture>& texture) const {
  if (!texture) return {1, 1, 1};
  Rgb most;
  const std::vector<float>& rgba = of(*texture).rgba;
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (const auto c = static_cast<int>(i % 4); c < 3) most[c] = std::max(most[c], static_cast<double>(rgba[i]));
  return most;
}

const Standard& SurfaceFits::of(const SpecularGlossiness& surface) {
  const auto& [d, s, glossiness] = surface;
  const Key key{d.x, d.y, d.z, s.x, s.y, s.z, glossiness};
  // Fowler, Noll and Vo's multiplication over the numbers' bits, its high half taken.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const double value : key) hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15u;
  Entry& entry = entries_[static_cast<std::size_t>(hash >> 32) & (entries_.size() - 1)];
  if (!entry.known || entry.key != key) entry = {true, key, standard_of(surface)};
  return entry.value;
}

LayerValue layer_value(const Material& material, const LayerPictures& pictures, Vec2d uv, SurfaceFits& fits) {
  const auto at = [&](const std::optional<Texture>& texture) { return pictures.at(texture, uv); };
  const Rgba base = at(material.base_colour_texture), metal_rough = at(material.metal_rough_texture);
  const Rgba specular = at(material.specular_gloss_texture), emissive = at(material.emissive_texture);
  const SurfaceModel model =
      textured(material.model, {{base.r, base.g, base.b}, metal_rough.b, metal_rough.g, {specular.r, specular.g, specular.b}, specular.a});
  LayerValue value;
  const auto* two_colours = std::get_if<SpecularGlossiness>(&model);
  value.surface = two_colours != nullptr ? fits.of(*two_colours) : standard_of(model);
  value.emissive = material.emissive * Rgb{emissive.r, emissive.g, emissive.b};
  if (material.normal_map) {
    const Rgba n = at(material.normal_map->texture);
    const double scale = material.normal_map->scale;
    const Vec3d direction{scale * (2 * n.r - 1), scale * (2 * n.g - 1), 2 * n.b - 1};
    if (dot(direction, direction) > 0) value.normal = normalised(direction);
  }
  if (material.occlusion) value.occlusion = 1 + material.occlusion->strength * (at(material.occlusion->texture).r - 1);
  return value;
}

}  // namespace etendue
