// A material's textures in the other model, texel by texel.
#pragma once

#include "deviations.h"
#include "etendue/material_conversion.h"

#include <optional>

#include <string>
#include <vector>

namespace etendue {

// KHR_materials_specular and _ior of a metallic-roughness material: min(((n - 1) / (n + 1))^2 colour, 1) factor.
Rgb dielectric_f0_of(const Material& material, const MetalRough& model);

// Converts what has textures; materials with the same textures and factors get the same new ones.
class TextureConversion {
 public:
  TextureConversion(Scene& scene, const ConversionOptions& options, MaterialConversion& out);

  // The material's model and textures become the other ones. Error TEXTURES_UNRELATED: it stays as it is.
  Result<MaterialChange> to_metal_rough(Material& material);
  Result<MaterialChange> to_spec_gloss(Material& material);

 private:
  struct Converted {
    Material before, after;
    MaterialChange change;
  };
  const Converted* known(const Material& material) const;
  std::optional<Texture> new_texture(const Texture& like, const std::filesystem::path& file, const std::string& name, Encoding encoding);
  Status make_folder() const;

  Scene& scene_;
  const ConversionOptions& options_;
  MaterialConversion& out_;
  unsigned threads_;
  std::size_t files_ = 0;
  std::vector<Converted> done_;
};

}  // namespace etendue
