#include "mapping.h"

#include <map>

#include <fmt/format.h>

#include "draco_mesh.h"
#include "meshopt.h"

namespace etendue::gltf {
namespace {

constexpr Fate represented = Fate::represented, carried = Fate::carried, unshown = Fate::unshown;

// Calls visit(name, type, taken_up) for each of a row's names.
template <class Visit>
void for_each_name(std::string_view names, Visit visit) {
  while (!names.empty()) {
    const std::size_t end = std::min(names.find(' '), names.size());
    const std::string_view word = names.substr(0, end);
    const std::size_t colon = std::min(word.find(':'), word.size());
    std::string_view type = colon < word.size() ? word.substr(colon + 1) : std::string_view{};
    const bool taken_up = type.starts_with('*');
    if (taken_up) type.remove_prefix(1);
    visit(word.substr(0, colon), type, taken_up);
    names.remove_prefix(std::min(end + 1, names.size()));
  }
}

std::string key_of(std::string_view holder, std::string_view name) { return fmt::format("{} {}", holder, name); }

const std::map<std::string, Mapped>& index() {
  static const std::map<std::string, Mapped> all = [] {
    std::map<std::string, Mapped> built;
    for (const MappingRow& row : mapping_rows())
      for_each_name(row.names, [&](std::string_view name, std::string_view type, bool taken_up) {
        built.emplace(key_of(row.holder, name), Mapped{&row, std::string(type), taken_up});
      });
    return built;
  }();
  return all;
}

}  // namespace

const char* name_of(Fate fate) { return fate == represented ? "represented" : fate == carried ? "carried" : "carried, not shown"; }

// Extensions' names have their vendor's capitals before the first underscore; no property of glTF has an underscore but attributes.
bool MappingRow::is_extension() const {
  const std::string_view text(names);
  return text.starts_with("KHR_") || text.starts_with("EXT_");
}

const std::vector<MappingRow>& mapping_rows() {
  static const std::vector<MappingRow> rows = {
      {"glTF", "asset:asset accessors:accessor bufferViews:bufferView buffers:buffer samplers:sampler", represented,
       "read where something uses them"},
      {"glTF", "nodes:*node meshes:*mesh cameras:*camera materials:*material textures:*texture images:*image", represented,
       "those that the default scene uses; the others are carried"},
      {"glTF", "scene scenes:*scene", represented, "the default scene, else the first, else all root nodes; other scenes are carried"},
      {"glTF", "extensionsUsed extensionsRequired", represented, "checked; a required one that is not shown is an error"},
      {"glTF", "animations skins", carried,
       "everything stands as the file gives it: joints where their nodes are, targets by their weights"},
      {"any", "extras", carried, ""},
      {"asset", "version minVersion", represented, "checked"},
      {"asset", "copyright generator", carried, ""},
      {"accessor", "bufferView byteOffset componentType normalized count type sparse name", represented,
       "every type, strided, interleaved, sparse, normalised"},
      {"accessor", "min max", represented, "checked"},
      {"bufferView", "buffer byteOffset byteLength byteStride target name", represented, ""},
      {"buffer", "uri byteLength name", represented, "mapped; untouched until something asks"},
      {"camera", "type perspective:camera.perspective name", represented, "`Camera`"},
      {"camera", "orthographic", unshown, "no picture can be taken with it"},
      {"camera.perspective", "yfov aspectRatio znear zfar", represented,
       "`vfov_rad`, `aspect`, `near_m`, `far_m`; nothing is cut off at them"},
      {"image", "uri bufferView mimeType name", represented, "`ImageRef`: a file, or the encoded bytes by reference; not decoded"},
      {"material", "name doubleSided alphaMode alphaCutoff emissiveFactor emissiveTexture:textureInfo", represented,
       "`Material`; an emissive surface is a light (`MeshShape`); BLEND is opaque in pictures, with a warning"},
      {"material",
       "pbrMetallicRoughness:material.pbrMetallicRoughness normalTexture:material.normalTexture occlusionTexture:material.occlusionTexture",
       represented, "`MetalRough`, `NormalMap`, `Occlusion`"},
      {"material.pbrMetallicRoughness",
       "baseColorFactor baseColorTexture:textureInfo metallicFactor roughnessFactor metallicRoughnessTexture:textureInfo", represented,
       "`MetalRough`"},
      {"textureInfo", "index texCoord", represented, "`Texture`"},
      {"material.normalTexture", "index texCoord scale", represented, "`NormalMap`"},
      {"material.occlusionTexture", "index texCoord strength", represented, "`Occlusion`: of indirect light alone"},
      {"mesh", "primitives:*mesh.primitive name weights", represented,
       "a `Mesh` for each primitive; points and lines are carried, with a warning"},
      {"mesh.primitive", "attributes:attributes indices material mode", represented, "triangles, strips and fans as indexed triangles"},
      {"mesh.primitive", "targets", carried, "applied by their weights"},
      {"attributes", "POSITION NORMAL TANGENT COLOR_0", represented,
       "`positions`, unit `normals`, `tangents`, `colours`; no picture shows the last two"},
      {"attributes", "TEXCOORD_n", represented, "`uvs`: the set that the material uses; others are carried"},
      {"attributes", "JOINTS_n WEIGHTS_n", carried, "applied with the node's skin"},
      {"attributes", "COLOR_n _CUSTOM", carried, ""},
      {"node", "name children mesh camera translation rotation scale matrix", represented, "`Object`, `Light`, `Camera` in the world"},
      {"node", "skin weights", carried, "applied"},
      {"sampler", "wrapS wrapT magFilter name", represented, "`Texture::wrap_u`, `wrap_v`, `nearest`"},
      {"sampler", "minFilter", carried, "pictures are looked up at the finest level"},
      {"scene", "nodes name", represented, ""},
      {"texture", "source sampler name", represented, ""},

      {"glTF",
       "KHR_lights_punctual:glTF.KHR_lights_punctual EXT_lights_area:glTF.EXT_lights_area EXT_lights_ies:glTF.EXT_lights_ies "
       "EXT_lights_image_based:glTF.EXT_lights_image_based",
       represented, "`Scene::lights`, where a node or the scene uses them"},
      {"glTF.KHR_lights_punctual", "lights:*punctual_light", represented, "`Light`"},
      {"punctual_light", "name type color intensity range spot:punctual_light.spot", represented,
       "`PointShape`, `SpotShape` in candela, `DistantShape` in lux; `color` is `filter`; `range` with `Falloff::gltf`"},
      {"punctual_light.spot", "innerConeAngle outerConeAngle", represented, "half angles"},
      {"glTF.EXT_lights_area", "lights:*area_light", represented, "`Light`"},
      {"area_light", "name type color intensity size rect:area_light.rect", represented,
       "`RectShape`, `DiskShape` in cd/m2 (draft of 2025)"},
      {"area_light.rect", "aspect", represented, "width / height"},
      {"glTF.EXT_lights_ies", "lights:*light_profile", represented, "`Light`"},
      {"light_profile", "name uri bufferView mimeType", represented, "`PhotometricShape`: its file, or its text by reference"},
      {"glTF.EXT_lights_image_based", "lights:*image_based_light", represented, "`Light`"},
      {"image_based_light", "name intensity rotation", represented,
       "`EnvironmentShape::cube`, from which no light comes in pictures: a warning"},
      {"image_based_light", "specularImages irradianceCoefficients specularImageSize", carried,
       "the six images of the finest level are `cube`"},
      {"node", "KHR_lights_punctual:node.light EXT_lights_area:node.light EXT_lights_ies:node.light", represented,
       "a `Light` for each node"},
      {"node.light", "light multiplier color", represented, "`filter` is color x multiplier"},
      {"scene", "EXT_lights_image_based:node.light", represented, "a `Light`"},
      {"node", "KHR_node_visibility:KHR_node_visibility", represented, "a hidden node and all below it are carried"},
      {"KHR_node_visibility", "visible", represented, ""},
      {"node", "EXT_mesh_gpu_instancing", unshown, "the mesh stands once, where its node is"},
      {"glTF", "KHR_materials_variants", carried, "each primitive has its default material"},
      {"mesh.primitive", "KHR_materials_variants", carried, "each primitive has its default material"},
      {"mesh.primitive", "KHR_draco_mesh_compression:KHR_draco_mesh_compression", represented,
       "decoded (component: libdraco), else the accessors are read", draco_is_built},
      {"KHR_draco_mesh_compression", "bufferView attributes", represented, ""},
      {"bufferView", "EXT_meshopt_compression:EXT_meshopt_compression", represented,
       "decoded (component: meshoptimizer), else the fallback is read", meshopt_is_built},
      {"buffer", "EXT_meshopt_compression:EXT_meshopt_compression", represented, "the fallback is not needed", meshopt_is_built},
      {"EXT_meshopt_compression", "buffer byteOffset byteLength byteStride count mode filter fallback", represented, ""},
      {"extensionsUsed", "KHR_mesh_quantization", represented, "accessors of any component type"},

      {"textureInfo", "KHR_texture_transform:KHR_texture_transform", represented, "`uv_transform`, `uv_set`"},
      {"material.normalTexture", "KHR_texture_transform:KHR_texture_transform", represented, "`uv_transform`, `uv_set`"},
      {"material.occlusionTexture", "KHR_texture_transform:KHR_texture_transform", represented, "`uv_transform`, `uv_set`"},
      {"KHR_texture_transform", "offset rotation scale texCoord", represented, ""},
      {"texture", "EXT_texture_webp:texture.source", represented, "the picture, where the texture has no other; else carried beside it"},
      {"texture", "KHR_texture_basisu:texture.source EXT_texture_avif:texture.source", unshown,
       "the picture is kept, and nothing here decodes it: the texture's other image, else plain factors"},
      {"texture.source", "source", represented, "an `ImageRef`"},

      {"material", "KHR_materials_emissive_strength:emissive_strength", represented, "factor x strength in cd/m2"},
      {"emissive_strength", "emissiveStrength", represented, ""},
      {"material", "KHR_materials_ior:ior", represented, "`MetalRough::ior`"},
      {"ior", "ior", represented, ""},
      {"material", "KHR_materials_pbrSpecularGlossiness:specular_glossiness", represented,
       "`SpecularGlossiness`; the core's twin is `Fallback`"},
      {"specular_glossiness",
       "diffuseFactor diffuseTexture:textureInfo specularFactor glossinessFactor specularGlossinessTexture:textureInfo", represented, ""},
      {"material", "KHR_materials_unlit:unlit", represented,
       "`Lobes::unlit`; lobes are in no picture, `unshown_of()` names what is missing"},
      {"material", "KHR_materials_clearcoat:clearcoat", represented, "`Lobes::clearcoat`"},
      {"clearcoat",
       "clearcoatFactor clearcoatTexture:textureInfo clearcoatRoughnessFactor clearcoatRoughnessTexture:textureInfo "
       "clearcoatNormalTexture:material.normalTexture",
       represented, ""},
      {"material", "KHR_materials_sheen:sheen", represented, "`Lobes::sheen`"},
      {"sheen", "sheenColorFactor sheenColorTexture:textureInfo sheenRoughnessFactor sheenRoughnessTexture:textureInfo", represented, ""},
      {"material", "KHR_materials_transmission:transmission", represented, "`Lobes::transmission`"},
      {"transmission", "transmissionFactor transmissionTexture:textureInfo", represented, ""},
      {"material", "KHR_materials_diffuse_transmission:diffuse_transmission", represented, "`Lobes::diffuse_transmission`"},
      {"diffuse_transmission",
       "diffuseTransmissionFactor diffuseTransmissionTexture:textureInfo diffuseTransmissionColorFactor "
       "diffuseTransmissionColorTexture:textureInfo",
       represented, ""},
      {"material", "KHR_materials_volume:volume", represented, "`Lobes::volume`"},
      {"volume", "thicknessFactor thicknessTexture:textureInfo attenuationDistance attenuationColor", represented, ""},
      {"material", "KHR_materials_dispersion:dispersion", represented, "`Lobes::dispersion`"},
      {"dispersion", "dispersion", represented, ""},
      {"material", "KHR_materials_specular:specular", represented, "`Lobes::specular`"},
      {"specular", "specularFactor specularTexture:textureInfo specularColorFactor specularColorTexture:textureInfo", represented, ""},
      {"material", "KHR_materials_iridescence:iridescence", represented, "`Lobes::iridescence`"},
      {"iridescence",
       "iridescenceFactor iridescenceTexture:textureInfo iridescenceIor iridescenceThicknessMinimum iridescenceThicknessMaximum "
       "iridescenceThicknessTexture:textureInfo",
       represented, ""},
      {"material", "KHR_materials_anisotropy:anisotropy", represented, "`Lobes::anisotropy`"},
      {"anisotropy", "anisotropyStrength anisotropyRotation anisotropyTexture:textureInfo", represented, ""},
      {"any", "KHR_animation_pointer", carried, "values stand as the file gives them"},
      {"any", "KHR_xmp_json_ld", carried, ""},
  };
  return rows;
}

Mapped mapped(std::string_view holder, std::string_view name) {
  for (const std::string_view type : {holder, std::string_view("any")})
    if (const auto found = index().find(key_of(type, name)); found != index().end()) return found->second;
  return {};
}

const MappingRow* row_of_extension(std::string_view wanted) {
  for (const MappingRow& row : mapping_rows()) {
    bool found = false;
    if (row.is_extension())
      for_each_name(row.names, [&](std::string_view name, std::string_view, bool) { found = found || name == wanted; });
    if (found) return &row;
  }
  return nullptr;
}

std::string mapping_table() {
  std::string table = "| in | what | fate | becomes |\n|---|---|---|---|\n";
  for (const MappingRow& row : mapping_rows()) {
    std::string names;
    for_each_name(row.names,
                  [&](std::string_view name, std::string_view, bool) { names += fmt::format("{}{}", names.empty() ? "" : " ", name); });
    table += fmt::format("| {} | {} | {} | {} |\n", row.holder, names, name_of(row.fate), row.becomes);
  }
  return table;
}

}  // namespace etendue::gltf
