// The schemas of extensions: ratified ones, those that the validator knows, and those that are read or named here. Keys are the type of
// the object that carries the extension, a dot, and its name.
#include "schema_properties.h"

namespace etendue::gltf {
namespace {

// RFC 6901: tokens after slashes, "~" only as ~0 and ~1.
bool is_json_pointer(std::string_view text) {
  if (!text.empty() && text.front() != '/') return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '~' && (i + 1 == text.size() || (text[i + 1] != '0' && text[i + 1] != '1'))) return false;
  return true;
}

constexpr double half_pi = 1.5707963267948966;

SchemaTable lights() {
  return {
      {"glTF.KHR_lights_punctual", {required(objects("lights", "punctual light"))}},
      {"node.KHR_lights_punctual", {required(index("light", "/extensions/KHR_lights_punctual/lights"))}},
      {"punctual light",
       {string("name"), numbers("color", 3, 0, 1), number("intensity", 0), object("spot", "punctual light.spot"),
        required(one_of("type", {"directional", "point", "spot"})), number("range", above_zero)}},
      {"punctual light.spot", {number("innerConeAngle", 0, std::nextafter(half_pi, 0)), number("outerConeAngle", above_zero, half_pi)}},

      {"glTF.EXT_lights_area", {required(objects("lights", "area light"))}},
      {"node.EXT_lights_area", {required(index("light", "/extensions/EXT_lights_area/lights"))}},
      {"area light",
       {string("name"), numbers("color", 3, 0), number("intensity", 0), number("size", above_zero), object("rect", "area light.rect"),
        required(one_of("type", {"rect", "disk"}))}},
      {"area light.rect", {number("aspect", above_zero)}},

      {"glTF.EXT_lights_ies", {required(objects("lights", "ies light"))}},
      {"node.EXT_lights_ies",
       {required(index("light", "/extensions/EXT_lights_ies/lights")), number("multiplier", 0), numbers("color", 3, 0)}},
      {"ies light", {string("name"), string("uri"), string("mimeType"), index("bufferView", "/bufferViews")}},

      {"glTF.EXT_lights_image_based", {required(objects("lights", "image-based light"))}},
      {"scene.EXT_lights_image_based", {required(index("light", "/extensions/EXT_lights_image_based/lights"))}},
      {"image-based light",
       {string("name"), numbers("rotation", 4, -1, 1), number("intensity", 0), required(any("irradianceCoefficients")),
        required(any("specularImages")), required(integer("specularImageSize", 1))}},
  };
}

SchemaTable materials() {
  SchemaTable table = {
      {"material.KHR_materials_anisotropy",
       {number("anisotropyStrength", 0, 1), number("anisotropyRotation"), object("anisotropyTexture", "textureInfo")}},
      {"material.KHR_materials_clearcoat",
       {number("clearcoatFactor", 0, 1), object("clearcoatTexture", "textureInfo"), number("clearcoatRoughnessFactor", 0, 1),
        object("clearcoatRoughnessTexture", "textureInfo"), object("clearcoatNormalTexture", "material.normalTexture")}},
      {"material.KHR_materials_diffuse_transmission",
       {number("diffuseTransmissionFactor", 0, 1), object("diffuseTransmissionTexture", "textureInfo"),
        numbers("diffuseTransmissionColorFactor", 3, 0), object("diffuseTransmissionColorTexture", "textureInfo")}},
      {"material.KHR_materials_dispersion", {number("dispersion", 0)}},
      {"material.KHR_materials_emissive_strength", {number("emissiveStrength", 0)}},
      {"material.KHR_materials_ior", {number("ior", 1)}},
      {"material.KHR_materials_iridescence",
       {number("iridescenceFactor", 0, 1), object("iridescenceTexture", "textureInfo"), number("iridescenceIor", 1),
        number("iridescenceThicknessMinimum", 0), number("iridescenceThicknessMaximum", 0),
        object("iridescenceThicknessTexture", "textureInfo")}},
      {"material.KHR_materials_pbrSpecularGlossiness",
       {numbers("diffuseFactor", 4, 0, 1), object("diffuseTexture", "textureInfo"), numbers("specularFactor", 3, 0, 1),
        number("glossinessFactor", 0, 1), object("specularGlossinessTexture", "textureInfo")}},
      {"material.KHR_materials_sheen",
       {numbers("sheenColorFactor", 3, 0, 1), object("sheenColorTexture", "textureInfo"), number("sheenRoughnessFactor", 0, 1),
        object("sheenRoughnessTexture", "textureInfo")}},
      {"material.KHR_materials_specular",
       {number("specularFactor", 0, 1), object("specularTexture", "textureInfo"), numbers("specularColorFactor", 3, 0),
        object("specularColorTexture", "textureInfo")}},
      {"material.KHR_materials_transmission", {number("transmissionFactor", 0, 1), object("transmissionTexture", "textureInfo")}},
      {"material.KHR_materials_unlit", {}},
      {"material.KHR_materials_volume",
       {numbers("attenuationColor", 3, 0, 1), number("attenuationDistance", above_zero), number("thicknessFactor", 0),
        object("thicknessTexture", "textureInfo")}},

      {"glTF.KHR_materials_variants", {required(objects("variants", "variant"))}},
      {"variant", {required(string("name"))}},
      {"mesh.primitive.KHR_materials_variants", {required(objects("mappings", "variant mapping"))}},
      {"variant mapping",
       {required(indices("variants", "/extensions/KHR_materials_variants/variants")), required(index("material", "/materials")),
        string("name")}},
  };
  table["material.KHR_materials_ior"].front().also = 0;  // stands for infinity
  return table;
}

SchemaTable others() {
  const std::vector<Property> transform = {numbers("offset", 2), number("rotation"), numbers("scale", 2), integer("texCoord")};
  const std::vector<Property> source = {index("source", "/images")};
  return {
      {"textureInfo.KHR_texture_transform", transform},
      {"material.normalTexture.KHR_texture_transform", transform},
      {"material.occlusionTexture.KHR_texture_transform", transform},
      {"texture.EXT_texture_webp", source},
      {"texture.EXT_texture_avif", source},
      {"texture.KHR_texture_basisu", source},
      {"animation.channel.target.KHR_animation_pointer", {required(matching("pointer", is_json_pointer))}},
      {"node.KHR_node_visibility", {boolean("visible")}},
      {"node.EXT_mesh_gpu_instancing", {required(named_indices("attributes", "/accessors"))}},
      {"mesh.primitive.KHR_draco_mesh_compression", {required(index("bufferView", "/bufferViews")), required(any("attributes"))}},
      {"buffer.EXT_meshopt_compression", {boolean("fallback")}},
      {"bufferView.EXT_meshopt_compression",
       {required(index("buffer", "/buffers")), integer("byteOffset"), required(integer("byteLength", 1)),
        required(integer("byteStride", 2, 256)), required(integer("count", 1)),
        required(one_of("mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"})),
        one_of("filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})}},
  };
}

}  // namespace

SchemaTable extension_schema() {
  SchemaTable all = lights();
  all.merge(materials());
  all.merge(others());
  return all;
}

bool is_known_extension(std::string_view name) {
  static const SchemaTable table = extension_schema();
  if (name == "KHR_mesh_quantization") return true;  // which has no objects
  for (const auto& [type, properties] : table)
    if (type.size() > name.size() && std::string_view(type).ends_with(name) && type[type.size() - name.size() - 1] == '.') return true;
  return false;
}

}  // namespace etendue::gltf
