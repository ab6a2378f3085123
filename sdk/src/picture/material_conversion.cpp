#include "etendue/material_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "deviations.h"
#include "reader_weight.h"
#include "texture_conversion.h"

namespace etendue {
namespace {

std::string owner(const Material& material) { return fmt::format("material '{}'", material.name); }

std::string percent_text(const Deviation& linear, const Deviation& steps) {
  return fmt::format("rms {:.2e}, at most {:.2e} (rms {:.2f}, at most {:.1f} steps of 8 bits)", linear.rms, linear.max, steps.rms,
                     steps.max);
}

void report(MaterialConversion& out, const Scene& scene, const MaterialChange& change, MaterialModel to) {
  const auto text = [](const ReaderDeviation& d) {
    return fmt::format("diffuse {}; f0 {}", percent_text(d.diffuse, d.diffuse_steps), percent_text(d.f0, d.f0_steps));
  };
  const std::string name = owner(scene.materials[change.material]);
  if (to == MaterialModel::metal_rough) {
    out.losses.add(name + ": specular-glossiness as metallic-roughness, to a reader of the core alone", text(change.core));
    out.losses.add(name + ": specular-glossiness as metallic-roughness, to a reader of KHR_materials_specular", text(change.full));
    if (change.metal_variation_of_best > 0)
      out.losses.add(name + ": the metal mask's variation between neighbouring texels",
                     fmt::format("{:.2e} on average, {:.2e} if each texel had its own best one", change.metal_variation,
                                 change.metal_variation_of_best));
  } else {
    out.losses.add(name + ": metallic-roughness as specular-glossiness", text(change.full));
  }
}

// For one pair of numbers that are stored as they are.
MetalRoughColours colours_for(const ColourPair& pair, Readers readers) {
  if (readers == Readers::core) return metal_rough_of(pair, weight_for_core);
  const auto full_rms = [&](double weight) {
    DeviationSums sums;
    sums.add(in_full_reader(metal_rough_of(pair, weight)), pair);
    return rms_of(sums.deviation());
  };
  return metal_rough_of(pair, least_weight(full_reader_limit(16), full_rms));
}

MaterialChange to_metal_rough(Material& material, Readers readers) {
  const auto model = std::get<SpecularGlossiness>(material.model);
  const TwoColour wanted = two_colour_of(model);
  const ColourPair pair{wanted.diffuse, wanted.f0};
  const MetalRoughColours colours = colours_for(pair, readers);
  MaterialChange change;
  DeviationSums core, full;
  core.add(in_core_reader(colours), pair);
  full.add(in_full_reader(colours), pair);
  change.core = core.deviation();
  change.full = full.deviation();

  constexpr double core_f0 = 0.04;
  const MetalRough core_model;
  material.model = MetalRough{colours.base, colours.metal, wanted.roughness, core_model.ior};
  if (!(colours.dielectric_f0 == Rgb{core_f0, core_f0, core_f0}) && colours.metal < 1)
    material.lobes.specular = Specular{1, colours.dielectric_f0 * (1 / core_f0), {}, {}};
  material.fallback.reset();
  return change;
}

MaterialChange to_spec_gloss(Material& material) {
  const auto model = std::get<MetalRough>(material.model);
  const ColourPair pair = in_full_reader({model.base_colour, model.metallic, dielectric_f0_of(material, model)});
  const SpecularGlossiness gloss = specular_glossiness_of({pair.diffuse, pair.f0, model.roughness});
  const TwoColour read = two_colour_of(gloss);
  DeviationSums sums;
  sums.add({read.diffuse, read.f0}, pair);
  MaterialChange change;
  change.core = change.full = sums.deviation();
  material.fallback = Fallback{model, material.base_colour_texture, material.metal_rough_texture};
  material.model = gloss;
  material.lobes.specular.reset();
  return change;
}

void report_factor(MaterialConversion& out, const Material& material) {
  const auto& specular = material.lobes.specular;
  if (specular && (specular->factor != 1 || specular->factor_texture))
    out.losses.add(owner(material) + ": KHR_materials_specular's factor", "f0 has it, but reflection at grazing angles rises to 1");
}

bool has_model_textures(const Material& m) {
  return m.base_colour_texture || m.metal_rough_texture || m.specular_gloss_texture ||
         (m.lobes.specular && (m.lobes.specular->colour_texture || m.lobes.specular->factor_texture));
}

}  // namespace

Result<MaterialConversion> convert_materials(Scene& scene, const ConversionOptions& options) {
  MaterialConversion out;
  TextureConversion textures(scene, options, out);
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    Material& material = scene.materials[i];
    const bool is_gloss = std::holds_alternative<SpecularGlossiness>(material.model);
    const bool is_metal = std::holds_alternative<MetalRough>(material.model);
    if (options.to == MaterialModel::metal_rough ? !is_gloss : !is_metal) continue;
    if (material.lobes.unlit) {
      out.losses.add(owner(material) + ": KHR_materials_unlit", "the material keeps its model: its colour is shown without light");
      continue;
    }
    const bool textured = has_model_textures(material);
    if (is_metal) report_factor(out, material);
    Result<MaterialChange> change = !textured  ? (is_gloss ? to_metal_rough(material, options.readers) : to_spec_gloss(material))
                                    : is_gloss ? textures.to_metal_rough(material)
                                               : textures.to_spec_gloss(material);
    if (!change && change.error().code == "TEXTURES_UNRELATED") {
      out.losses.add(owner(material) + ": its textures cannot be put together", "the material keeps its model: " + change.error().text);
      continue;
    }
    if (!change) {
      if (change.error().where.pointer.empty()) change.error().where.pointer = material.source;
      return change.error();
    }
    change->material = i;
    report(out, scene, *change, options.to);
    out.changes.push_back(*change);
  }
  return out;
}

}  // namespace etendue
