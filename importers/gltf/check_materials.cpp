// Materials: properties that mean something only beside others.
#include <fmt/format.h>

#include "checks.h"

namespace etendue::gltf {
namespace {

double number_at(const Json& object, const char* key, double otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

// Two normal-like textures share the tangents of one set of coordinates.
void check_same_texcoord(Checks& checks, const Json& material, const Json& other, const char* code, const Path& path) {
  const Json& normal = object_at(material, "normalTexture");
  if (normal.empty() || other.empty()) return;
  if (uint_of(normal, "texCoord").value_or(0) != uint_of(other, "texCoord").value_or(0))
    checks.findings.warning(code, "expected the texture coordinates of the normal texture, whose tangents it uses", path);
}

void check_volume(Checks& checks, const Json& material, const Json& extensions, const Path& path) {
  const Json& volume = object_at(extensions, "KHR_materials_volume");
  if (!extensions.contains("KHR_materials_transmission") && !extensions.contains("KHR_materials_diffuse_transmission"))
    checks.findings.warning("KHR_MATERIALS_VOLUME_NO_TRANSMISSION", "no light gets into the volume: nothing transmits it", path);
  if (is_true(material, "doubleSided") && number_at(volume, "thicknessFactor", 0) > 0)
    checks.findings.warning("KHR_MATERIALS_VOLUME_DOUBLE_SIDED", "a volume has an inside: it should not be double-sided", path);
}

void check_iridescence(Checks& checks, const Json& iridescence, const Path& path) {
  const double least = number_at(iridescence, "iridescenceThicknessMinimum", 100);
  const double most = number_at(iridescence, "iridescenceThicknessMaximum", 400);
  if (!iridescence.contains("iridescenceThicknessTexture")) {
    if (iridescence.contains("iridescenceThicknessMinimum"))
      checks.findings.note("KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_WITHOUT_TEXTURE", "without a texture the maximum alone counts",
                           path / "iridescenceThicknessMinimum");
  } else if (least == most) {
    checks.findings.note("KHR_MATERIALS_IRIDESCENCE_THICKNESS_TEXTURE_UNUSED", "a texture between equal limits says nothing",
                         path / "iridescenceThicknessTexture");
  }
}

bool is_black(const Json& factor) {
  for (const Json& channel : factor)
    if (channel != 0) return false;
  return true;
}

void check_material(Checks& checks, const Json& material, const Path& path) {
  if (!material.is_object()) return;
  const std::string* mode = text_of(material, "alphaMode");
  if (material.contains("alphaCutoff") && (mode == nullptr || *mode != "MASK"))
    checks.findings.warning("MATERIAL_ALPHA_CUTOFF_INVALID_MODE", "alphaCutoff belongs to the alphaMode MASK", path / "alphaCutoff");
  const Json& extensions = object_at(material, "extensions");
  const Path here = path / "extensions";
  const auto has = [&](const char* name) { return extensions.contains(name) && extensions[name].is_object() && checks.declares(name); };
  if (has("KHR_materials_anisotropy")) {
    const Path extension = here / "KHR_materials_anisotropy";
    check_same_texcoord(checks, material, object_at(extensions["KHR_materials_anisotropy"], "anisotropyTexture"),
                        "KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD", extension / "anisotropyTexture");
  }
  if (has("KHR_materials_clearcoat")) {
    const Path extension = here / "KHR_materials_clearcoat";
    check_same_texcoord(checks, material, object_at(extensions["KHR_materials_clearcoat"], "clearcoatNormalTexture"),
                        "KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD", extension / "clearcoatNormalTexture");
  }
  if (has("KHR_materials_dispersion") && !extensions.contains("KHR_materials_volume"))
    checks.findings.warning("KHR_MATERIALS_DISPERSION_NO_VOLUME", "light disperses on its way through a volume, which is missing",
                            here / "KHR_materials_dispersion");
  if (has("KHR_materials_emissive_strength") && is_black(array_at(material, "emissiveFactor")) &&
      number_at(extensions["KHR_materials_emissive_strength"], "emissiveStrength", 1) != 1)
    checks.findings.warning("KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR", "the strength multiplies an emissiveFactor of zero",
                            here / "KHR_materials_emissive_strength");
  if (has("KHR_materials_iridescence"))
    check_iridescence(checks, extensions["KHR_materials_iridescence"], here / "KHR_materials_iridescence");
  if (has("KHR_materials_volume")) check_volume(checks, material, extensions, here / "KHR_materials_volume");
}

}  // namespace

void check_materials(Checks& checks) {
  const Path root, path = root / "materials";
  const Json& materials = array_at(checks.root, "materials");
  for (std::size_t i = 0; i < materials.size(); ++i) check_material(checks, materials[i], path / i);
}

}  // namespace etendue::gltf
