// A material's textures in the other model, texel by texel.
#pragma once

#include "code_table.h"
#include "deviations.h"
#include "etendue/material_conversion.h"
#include "texel_cache.h"
#include "texture_output.h"
#include "texture_rows.h"

#include <optional>
#include <string>
#include <vector>

namespace etendue {

// KHR_materials_specular and _ior of a metallic-roughness material: min(((n - 1) / (n + 1))^2 colour, 1) factor.
Rgb dielectric_f0_of(const Material& material, const MetalRough& model);

inline Rgb product(const Rgb& a, const Rgb& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Rgb rgb_at(const TexelKey& key, std::size_t first) {
  return {number_at(key, first), number_at(key, first + 1), number_at(key, first + 2)};
}
inline const Texture* pointer_to(const std::optional<Texture>& texture) { return texture ? &*texture : nullptr; }

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
  // `again`: they are read more than once.
  Result<TextureRows> open_rows(const TextureRows::Textures& textures, bool again);
  Status make_folder() const;
  Status open_all(std::vector<TextureOutput>& outputs, const TextureRows& rows) const;
  static Status close_all(std::vector<TextureOutput>& outputs);
  static Rgb constant_colour(const TextureOutput& output, const CodeTable& table);
  void report_repeats(const Material& material, const TextureRows& rows);

  Scene& scene_;
  const ConversionOptions& options_;
  MaterialConversion& out_;
  unsigned threads_;
  std::size_t files_ = 0;
  std::vector<Converted> done_;
};

}  // namespace etendue
