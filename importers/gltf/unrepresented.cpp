#include "unrepresented.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue::gltf {
namespace {

using Json = nlohmann::json;

// Read by this importer. Quantised meshes need nothing more than accessors of any component type.
constexpr const char* supported[] = {"KHR_lights_punctual",
                                     "EXT_lights_area",
                                     "KHR_materials_emissive_strength",
                                     "KHR_materials_ior",
                                     "KHR_texture_transform",
                                     "KHR_mesh_quantization",
                                     "KHR_materials_pbrSpecularGlossiness",
                                     "KHR_materials_unlit",
                                     "KHR_materials_clearcoat",
                                     "KHR_materials_sheen",
                                     "KHR_materials_transmission",
                                     "KHR_materials_diffuse_transmission",
                                     "KHR_materials_volume",
                                     "KHR_materials_dispersion",
                                     "KHR_materials_specular",
                                     "KHR_materials_iridescence",
                                     "KHR_materials_anisotropy"};

struct Known {
  const char* name;
  Severity severity;
  const char* loss;
};
constexpr Known known[] = {
    {"KHR_materials_variants", Severity::warning, "the variants are lost: the default material of each primitive is used"},
    {"KHR_draco_mesh_compression", Severity::warning,
     "compressed meshes are not decoded: the uncompressed fallback is read where there is one"},
    {"EXT_meshopt_compression", Severity::warning,
     "compressed buffers are not decoded: the uncompressed fallback is read where there is one"},
    {"EXT_mesh_gpu_instancing", Severity::warning, "the instances are lost: the mesh stands once, where its node is"},
    {"KHR_node_visibility", Severity::warning, "hidden nodes are shown"},
    {"KHR_texture_basisu", Severity::warning, "the KTX2 picture is lost: the fallback image is used where there is one"},
    {"EXT_texture_webp", Severity::warning, "the WebP picture is lost: the fallback image is used where there is one"},
    {"EXT_texture_avif", Severity::warning, "the AVIF picture is lost: the fallback image is used where there is one"},
    {"EXT_lights_ies", Severity::warning, "the photometric light is lost"},
    {"EXT_lights_image_based", Severity::warning, "the environment's light is lost"},
    {"KHR_animation_pointer", Severity::warning, "the animation is lost: values stand as the file gives them"},
    {"KHR_xmp_json_ld", Severity::note, "metadata is not carried"},
};

void name_extensions(Asset& asset) {
  std::map<std::string, std::vector<std::string>> places;
  for (const ExtensionUse& use : asset.extensions()) places[use.name].push_back(use.pointer);
  for (const auto& [name, pointers] : places) {
    if (std::find(std::begin(supported), std::end(supported), name) != std::end(supported)) continue;
    const auto found = std::find_if(std::begin(known), std::end(known), [&n = name](const Known& k) { return n == k.name; });
    const bool is_known = found != std::end(known);
    std::string text = fmt::format("{}: {}", name, is_known ? found->loss : "an extension that is not read; what it says is lost");
    if (pointers.size() > 1) text += fmt::format(" ({} places, the first is shown)", pointers.size());
    asset.add({is_known ? found->severity : Severity::warning, "NOT_REPRESENTED", std::move(text), asset.at(pointers.front()), {}});
  }
}

void check_required(Asset& asset) {
  const auto required = asset.json().find("extensionsRequired");
  if (required == asset.json().end() || !required->is_array()) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    if (!(*required)[i].is_string()) continue;
    const auto name = (*required)[i].get<std::string>();
    if (std::find(std::begin(supported), std::end(supported), name) == std::end(supported))
      asset.error("UNSUPPORTED_REQUIRED_EXTENSION",
                  fmt::format("the file cannot be read as it is meant without {}, which is not supported", name),
                  fmt::format("/extensionsRequired/{}", i));
  }
}

void name_all(Asset& asset, const char* array, const char* text) {
  const auto found = asset.json().find(array);
  if (found == asset.json().end() || !found->is_array() || found->empty()) return;
  asset.warning("NOT_REPRESENTED", fmt::format("{} {}", found->size(), text), fmt::format("/{}/0", array));
}

}  // namespace

void name_unrepresented(Asset& asset) {
  check_required(asset);
  name_extensions(asset);
  name_all(asset, "animations", "animation(s): lost, everything stands as the file gives it");
  name_all(asset, "skins", "skin(s): lost, meshes are not deformed");
}

}  // namespace etendue::gltf
