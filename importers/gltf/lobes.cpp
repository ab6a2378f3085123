// KHR_materials_* as our optional lobes. Names and defaults are those of the extensions' property tables.
#include <nlohmann/json.hpp>

#include "materials.h"

namespace etendue::gltf {

using Json = nlohmann::json;

Rgb colour_or(const Json& object, const char* key, double otherwise) {
  return {number_or(object, key, 0, otherwise), number_or(object, key, 1, otherwise), number_or(object, key, 2, otherwise)};
}

Lobes Materials::read_lobes(const std::string& material) {
  Lobes lobes;
  const Json* json = nullptr;
  std::string pointer;
  const auto open = [&](const char* name) {
    json = asset_.extension(material, name);
    pointer = material + "/extensions/" + name;
    return json != nullptr;
  };
  const auto number = [&](const char* key, double otherwise) { return number_or(*json, key, otherwise); };
  const auto colour = [&](const char* key, double otherwise) { return colour_or(*json, key, otherwise); };
  const auto linear = [&](const char* key) { return texture(*json, pointer, key, Encoding::linear); };
  const auto srgb = [&](const char* key) { return texture(*json, pointer, key, Encoding::srgb); };

  if (open("KHR_materials_clearcoat"))
    lobes.clearcoat = Clearcoat{number("clearcoatFactor", 0), number("clearcoatRoughnessFactor", 0), linear("clearcoatTexture"),
                                linear("clearcoatRoughnessTexture"), normal_map(*json, pointer, "clearcoatNormalTexture")};
  if (open("KHR_materials_sheen"))
    lobes.sheen =
        Sheen{colour("sheenColorFactor", 0), number("sheenRoughnessFactor", 0), srgb("sheenColorTexture"), linear("sheenRoughnessTexture")};
  if (open("KHR_materials_transmission")) lobes.transmission = Transmission{number("transmissionFactor", 0), linear("transmissionTexture")};
  if (open("KHR_materials_diffuse_transmission"))
    lobes.diffuse_transmission = DiffuseTransmission{number("diffuseTransmissionFactor", 0), colour("diffuseTransmissionColorFactor", 1),
                                                     linear("diffuseTransmissionTexture"), srgb("diffuseTransmissionColorTexture")};
  if (open("KHR_materials_volume"))
    lobes.volume = Volume{number("thicknessFactor", 0), number("attenuationDistance", Volume{}.attenuation_distance_m),
                          colour("attenuationColor", 1), linear("thicknessTexture")};
  if (open("KHR_materials_dispersion")) lobes.dispersion = Dispersion{number("dispersion", 0)};
  if (open("KHR_materials_specular"))
    lobes.specular =
        Specular{number("specularFactor", 1), colour("specularColorFactor", 1), linear("specularTexture"), srgb("specularColorTexture")};
  if (open("KHR_materials_iridescence"))
    lobes.iridescence = Iridescence{number("iridescenceFactor", 0),
                                    number("iridescenceIor", 1.3),
                                    number("iridescenceThicknessMinimum", 100),
                                    number("iridescenceThicknessMaximum", 400),
                                    linear("iridescenceTexture"),
                                    linear("iridescenceThicknessTexture")};
  if (open("KHR_materials_anisotropy"))
    lobes.anisotropy = Anisotropy{number("anisotropyStrength", 0), number("anisotropyRotation", 0), linear("anisotropyTexture")};
  lobes.unlit = open("KHR_materials_unlit");
  return lobes;
}

}  // namespace etendue::gltf
