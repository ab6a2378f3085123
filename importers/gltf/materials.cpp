#include "materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue::gltf {
namespace {

Rgb rgb_of_factor(const std::vector<double>& factor, double otherwise) {
  return factor.size() >= 3 ? Rgb{factor[0], factor[1], factor[2]} : Rgb{otherwise, otherwise, otherwise};
}

}  // namespace

const Materials::Entry& Materials::at(int material) {
  if (const auto found = entries_.find(material); found != entries_.end()) return found->second;
  Entry entry = read(material);
  if (has(asset_.options().need, Need::materials)) {
    entry.index = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(entry.material);
  }
  return entries_.emplace(material, std::move(entry)).first->second;
}

Materials::Entry Materials::read(int material) {
  Entry entry;
  Material& out = entry.material;
  if (material < 0 || static_cast<std::size_t>(material) >= asset_.model().materials.size()) {
    // The default material of 3.9: white, metallic 1, roughness 1.
    out.name = "default";
    out.model = MetalRough{};
    out.double_sided = false;
    return entry;
  }
  const tinygltf::Material& source = asset_.model().materials[static_cast<std::size_t>(material)];
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const std::string pointer = fmt::format("/materials/{}", material), pbr_pointer = pointer + "/pbrMetallicRoughness";
  out.name = source.name.empty() ? fmt::format("material {}", material) : source.name;
  out.source = pointer;
  out.double_sided = source.doubleSided;

  MetalRough model{rgb_of_factor(pbr.baseColorFactor, 1), pbr.metallicFactor, pbr.roughnessFactor, 1.5};
  if (pbr.baseColorFactor.size() == 4) out.base_alpha = pbr.baseColorFactor[3];
  if (const nlohmann::json* ior = asset_.extension(pointer, "KHR_materials_ior")) {
    model.ior = number_or(*ior, "ior", 1.5);
    // 0 stands for an infinite index: F0 = ((n - 1) / (n + 1))^2 is 1 for both.
    if (model.ior != 0 && model.ior < 1)
      asset_.error("VALUE_NOT_IN_RANGE", fmt::format("expected an index of refraction of 0 or from 1 on, found {}", model.ior),
                   pointer + "/extensions/KHR_materials_ior/ior");
  }
  out.model = model;
  out.base_colour_texture =
      texture(pbr_pointer + "/baseColorTexture", pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, Encoding::srgb);
  out.metal_rough_texture = texture(pbr_pointer + "/metallicRoughnessTexture", pbr.metallicRoughnessTexture.index,
                                    pbr.metallicRoughnessTexture.texCoord, Encoding::linear);
  if (const auto normal = texture(pointer + "/normalTexture", source.normalTexture.index, source.normalTexture.texCoord, Encoding::linear))
    out.normal_map = NormalMap{*normal, source.normalTexture.scale};

  double strength = 1;
  if (const nlohmann::json* extension = asset_.extension(pointer, "KHR_materials_emissive_strength"))
    strength = number_or(*extension, "emissiveStrength", 1);
  out.emissive = rgb_of_factor(source.emissiveFactor, 0) * strength;
  if (luminance_of(out.emissive) > 0)
    out.emissive_texture =
        texture(pointer + "/emissiveTexture", source.emissiveTexture.index, source.emissiveTexture.texCoord, Encoding::srgb);

  if (source.alphaMode == "MASK") out.alpha_cutoff = source.alphaCutoff;
  name_losses(source, pointer);
  choose_uv_set(entry, pointer);
  return entry;
}

void Materials::name_losses(const tinygltf::Material& source, const std::string& pointer) {
  if (source.alphaMode == "BLEND")
    asset_.warning("NOT_REPRESENTED", "alphaMode BLEND: the surface is opaque, what is behind it is hidden", pointer + "/alphaMode");
  if (source.occlusionTexture.index >= 0)
    asset_.note("NOT_REPRESENTED", "the occlusion texture is not used: it dims indirect light only", pointer + "/occlusionTexture");
}

// A mesh carries one set of texture coordinates: the base colour's, else that of the first texture.
void Materials::choose_uv_set(Entry& entry, const std::string& pointer) {
  const Material& m = entry.material;
  entry.wants_tangents = m.normal_map.has_value();
  const Texture* textures[] = {m.base_colour_texture ? &*m.base_colour_texture : nullptr,
                               m.metal_rough_texture ? &*m.metal_rough_texture : nullptr, m.normal_map ? &m.normal_map->texture : nullptr,
                               m.emissive_texture ? &*m.emissive_texture : nullptr};
  for (const Texture* texture : textures) {
    if (texture == nullptr) continue;
    if (!entry.wants_uvs) {
      entry.wants_uvs = true;
      entry.uv_set = texture->uv_set;
    } else if (texture->uv_set != entry.uv_set) {
      asset_.warning("NOT_REPRESENTED",
                     fmt::format("the textures use several sets of coordinates: all are looked up with TEXCOORD_{}, TEXCOORD_{} is lost",
                                 entry.uv_set, texture->uv_set),
                     pointer);
      return;
    }
  }
}

std::optional<Texture> Materials::texture(const std::string& pointer, int index, int tex_coord, Encoding encoding) {
  const tinygltf::Model& model = asset_.model();
  if (index < 0 || static_cast<std::size_t>(index) >= model.textures.size()) return std::nullopt;
  const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(index)];
  const std::string texture_pointer = fmt::format("/textures/{}", index);
  if (source.source < 0) {
    asset_.warning("NOT_REPRESENTED", "the texture has no image that can be read; the surface has its plain factor", texture_pointer);
    return std::nullopt;
  }
  const auto image_index = image(source.source);
  if (!image_index) return std::nullopt;

  Texture out;
  out.image = *image_index;
  out.encoding = encoding;
  out.uv_set = tex_coord;
  if (source.sampler >= 0 && static_cast<std::size_t>(source.sampler) < model.samplers.size()) {
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(source.sampler)];
    const auto wrap = [](int mode) {
      return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
             : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                             : Wrap::repeat;
    };
    out.wrap_u = wrap(sampler.wrapS);
    out.wrap_v = wrap(sampler.wrapT);
    out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  if (const nlohmann::json* transform = asset_.extension(pointer, "KHR_texture_transform")) {
    // uv' = T R S uv. The rotation is counter-clockwise as one sees the image, v down: (c, s; -s, c). So the extension's text, its example
    // (a quarter turn about (0, 1)) and its implementations; its GLSL lines, read column by column, would turn the other way.
    const double angle = number_or(*transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const double scale_u = number_or(*transform, "scale", 0, 1), scale_v = number_or(*transform, "scale", 1, 1);
    const double matrix[2][3] = {{c * scale_u, s * scale_v, number_or(*transform, "offset", 0, 0)},
                                 {-s * scale_u, c * scale_v, number_or(*transform, "offset", 1, 0)}};
    for (int row = 0; row < 2; ++row) std::copy(matrix[row], matrix[row] + 3, out.uv_transform[row]);
    out.uv_set = static_cast<int>(number_or(*transform, "texCoord", tex_coord));
  }
  return out;
}

}  // namespace etendue::gltf
