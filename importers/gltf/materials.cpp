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
  asset_.take(fmt::format("/materials/{}", material));
  const tinygltf::Material& source = asset_.model().materials[static_cast<std::size_t>(material)];
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const std::string pointer = fmt::format("/materials/{}", material), pbr_pointer = pointer + "/pbrMetallicRoughness";
  out.name = source.name.empty() ? fmt::format("material {}", material) : source.name;
  out.source = pointer;
  out.double_sided = source.doubleSided;

  const nlohmann::json& json = asset_.json().at(nlohmann::json::json_pointer(pointer));
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
  if (const nlohmann::json* core = member(json, "pbrMetallicRoughness")) {
    out.base_colour_texture = texture(*core, pbr_pointer, "baseColorTexture", Encoding::srgb);
    out.metal_rough_texture = texture(*core, pbr_pointer, "metallicRoughnessTexture", Encoding::linear);
  }
  read_specular_glossiness(out, pointer, member(json, "pbrMetallicRoughness") != nullptr);
  out.normal_map = normal_map(json, pointer, "normalTexture");
  if (const auto occlusion = texture(json, pointer, "occlusionTexture", Encoding::linear))
    out.occlusion = Occlusion{*occlusion, source.occlusionTexture.strength};
  out.lobes = read_lobes(pointer);

  double strength = 1;
  if (const nlohmann::json* extension = asset_.extension(pointer, "KHR_materials_emissive_strength"))
    strength = number_or(*extension, "emissiveStrength", 1);
  out.emissive = rgb_of_factor(source.emissiveFactor, 0) * strength;
  if (luminance_of(out.emissive) > 0) out.emissive_texture = texture(json, pointer, "emissiveTexture", Encoding::srgb);

  if (source.alphaMode == "MASK") out.alpha_cutoff = source.alphaCutoff;
  out.blended = source.alphaMode == "BLEND";
  if (out.blended)
    asset_.warning("NOT_REPRESENTED", "alphaMode BLEND: the surface is opaque in pictures, what is behind it is hidden",
                   pointer + "/alphaMode");
  choose_uv_set(entry, pointer);
  return entry;
}

// The albedo is diffuse (1 - max(specular)), texel by texel: the authored values stay as they are, two_colour_of() applies the factor.
void Materials::read_specular_glossiness(Material& out, const std::string& material, bool has_fallback) {
  const nlohmann::json* extension = asset_.extension(material, "KHR_materials_pbrSpecularGlossiness");
  if (extension == nullptr) return;
  const std::string pointer = material + "/extensions/KHR_materials_pbrSpecularGlossiness";
  if (has_fallback) out.fallback = Fallback{std::get<MetalRough>(out.model), out.base_colour_texture, out.metal_rough_texture};
  out.model = SpecularGlossiness{colour_or(*extension, "diffuseFactor", 1), colour_or(*extension, "specularFactor", 1),
                                 number_or(*extension, "glossinessFactor", 1)};
  out.base_alpha = number_or(*extension, "diffuseFactor", 3, 1);
  out.base_colour_texture = texture(*extension, pointer, "diffuseTexture", Encoding::srgb);
  out.metal_rough_texture.reset();
  out.specular_gloss_texture = texture(*extension, pointer, "specularGlossinessTexture", Encoding::srgb);
}

// A mesh carries one set of texture coordinates: the base colour's, else that of the first texture. Those of lobes, which our pictures do
// not show, come last; an anisotropic surface has its direction from coordinates.
void Materials::choose_uv_set(Entry& entry, const std::string& pointer) {
  const Material& m = entry.material;
  entry.wants_tangents = m.normal_map.has_value();
  std::optional<int> lost;
  for_each_texture(m, [&](const std::string& role, const Texture& texture) {
    if (role == "occlusion" || (role.find('.') != std::string::npos && !role.starts_with("fallback."))) return;  // in no picture of ours
    if (!entry.wants_uvs) {
      entry.wants_uvs = true;
      entry.uv_set = texture.uv_set;
    } else if (texture.uv_set != entry.uv_set && !lost) {
      lost = texture.uv_set;
    }
  });
  for_each_texture(m, [&](const std::string& role, const Texture& texture) {
    if (entry.wants_uvs || role == "occlusion") return;
    entry.wants_uvs = true;
    entry.uv_set = texture.uv_set;
  });
  if (lost)
    asset_.warning("NOT_REPRESENTED",
                   fmt::format("the textures use several sets of coordinates: all are looked up with TEXCOORD_{}, TEXCOORD_{} is lost",
                               entry.uv_set, *lost),
                   pointer);
}

}  // namespace etendue::gltf
