// Textures: which image, how it is looked up, and the extensions that say either.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "json_values.h"
#include "materials.h"

namespace etendue::gltf {
namespace {

Wrap wrap_of(int mode) {
  return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
         : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                         : Wrap::repeat;
}

void apply_transform(const Json& transform, Texture& out) {
  // uv' = T R S uv. The rotation is counter-clockwise as one sees the image, v down: (c, s; -s, c). So the extension's text, its example
  // (a quarter turn about (0, 1)) and its implementations; its GLSL lines, read column by column, would turn the other way.
  const double angle = number_or(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  const double scale_u = number_or(transform, "scale", 0, 1), scale_v = number_or(transform, "scale", 1, 1);
  const double matrix[2][3] = {{c * scale_u, s * scale_v, number_or(transform, "offset", 0, 0)},
                               {-s * scale_u, c * scale_v, number_or(transform, "offset", 1, 0)}};
  for (int row = 0; row < 2; ++row) std::copy(matrix[row], matrix[row] + 3, out.uv_transform[row]);
  out.uv_set = int_index_of(transform, "texCoord", out.uv_set);
}

}  // namespace

const Json* member(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_object() ? &*found : nullptr;
}

// The core's image, which everybody can decode, before an extension's; of those WebP, which OpenImageIO reads where it was built with it.
std::optional<std::uint32_t> Materials::image_of(int texture) {
  const std::string pointer = fmt::format("/textures/{}", texture);
  const int core = asset_.model().textures[static_cast<std::size_t>(texture)].source;
  std::optional<std::uint32_t> webp;
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"}) {
    const Json* extension = asset_.extension(pointer, name);
    if (extension == nullptr) continue;
    const auto kept = image(int_index_of(*extension, "source"));
    if (std::string_view(name) == "EXT_texture_webp") webp = kept;
    if (core < 0 && !webp)
      asset_.warning("NOT_REPRESENTED",
                     fmt::format("{}: the picture is kept, but nothing here decodes it: surfaces have their plain factors", name),
                     pointer + "/extensions/" + name);
  }
  if (core >= 0) return image(core);
  if (webp) return webp;
  asset_.warning("NOT_REPRESENTED", "the texture has no image that can be read; the surface has its plain factor", pointer);
  return std::nullopt;
}

std::optional<Texture> Materials::texture(const Json& object, const std::string& pointer, const char* key, Encoding encoding) {
  const Json* info = member(object, key);
  if (info == nullptr) return std::nullopt;
  const tinygltf::Model& model = asset_.model();
  const double index = number_or(*info, "index", -1);
  if (!(index >= 0 && index < static_cast<double>(model.textures.size()))) return std::nullopt;
  asset_.take(fmt::format("/textures/{}", static_cast<int>(index)));
  const auto image_index = image_of(static_cast<int>(index));
  if (!image_index) return std::nullopt;

  Texture out;
  out.image = *image_index;
  out.encoding = encoding;
  out.uv_set = int_index_of(*info, "texCoord", 0);
  const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(index)];
  if (source.sampler >= 0 && static_cast<std::size_t>(source.sampler) < model.samplers.size()) {
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
    out.wrap_u = wrap_of(sampler.wrapS);
    out.wrap_v = wrap_of(sampler.wrapT);
    out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  if (const Json* transform = asset_.extension(pointer_to(pointer, key), "KHR_texture_transform")) apply_transform(*transform, out);
  return out;
}

std::optional<NormalMap> Materials::normal_map(const Json& object, const std::string& pointer, const char* key) {
  const auto map = texture(object, pointer, key, Encoding::linear);
  if (!map) return std::nullopt;
  return NormalMap{*map, number_or(*member(object, key), "scale", 1)};
}

}  // namespace etendue::gltf
