#include "etendue/unshown.h"

#include "textures.h"
#include "writer.h"

#include <algorithm>
#include <set>
#include <string>

namespace etendue::mitsuba {
namespace {

// Materials that a light or an object shows, in order.
std::set<std::uint32_t> used_materials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const Object& object : scene.objects) used.insert(object.material);
  for (const Light& light : scene.lights) {
    if (light.surface_material) used.insert(*light.surface_material);
  }
  used.erase(no_index);
  return used;
}

std::string name_for_losses(const Material& material) { return "material '" + material.name + "'"; }

Rgb clamped(Writer& writer, const Material& material, const Rgb& colour) {
  const Rgb inside{std::clamp(colour.x, 0.0, 1.0), std::clamp(colour.y, 0.0, 1.0), std::clamp(colour.z, 0.0, 1.0)};
  if (!(inside == colour)) {
    writer.losses.add(name_for_losses(material) + ": reflectance outside 0..1", "clamped, which Mitsuba asks for");
  }
  return inside;
}

Status add_base_colour(Writer& writer, pugi::xml_node bsdf, const char* name, const Material& material, const Rgb& factor) {
  if (material.base_colour_texture) {
    return add_colour_texture(writer, bsdf, name, *material.base_colour_texture, factor, name_for_losses(material));
  }
  add_rgb(bsdf, name, clamped(writer, material, factor));
  return Done{};
}

Status add_scalar(Writer& writer, pugi::xml_node bsdf, const char* name, const Material& material, int channel, double factor) {
  if (material.metal_rough_texture && factor != 0) {
    return add_grey_texture(writer, bsdf, name, *material.metal_rough_texture, channel, factor, name_for_losses(material));
  }
  add_float(bsdf, name, factor);
  return Done{};
}

Status add_principled(Writer& writer, pugi::xml_node bsdf, const Material& material, const Principled& model) {
  if (Status s = add_base_colour(writer, bsdf, "base_color", material, model.base_colour); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "metallic", material, 2, model.metallic); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "roughness", material, 1, model.roughness); !s) return s;
  // Mitsuba evaluates the specular lobe of a metal only where the dielectric one is positive: specular = 0 would render metals black.
  // 1e-6 is an F0 of 8e-8.
  add_float(bsdf, "specular", std::max(model.specular, 1e-6));
  return Done{};
}

// surface_bsdfs.py says what the parameters of the three mean.
Status add_standard(Writer& writer, pugi::xml_node bsdf, const Material& material, const Standard& model) {
  if (Status s = add_base_colour(writer, bsdf, "base_colour", material, model.base_colour); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "metal", material, 2, model.metal); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "roughness", material, 1, model.roughness); !s) return s;
  add_float(bsdf, "reflectance", model.reflectance);
  return Done{};
}

Status add_metal_rough(Writer& writer, pugi::xml_node bsdf, const Material& material, const MetalRough& model) {
  if (Status s = add_base_colour(writer, bsdf, "base_colour", material, model.base_colour); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "metallic", material, 2, model.metallic); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "roughness", material, 1, model.roughness); !s) return s;
  add_float(bsdf, "ior", model.ior);
  return Done{};
}

Status add_specular_glossiness(Writer& writer, pugi::xml_node bsdf, const Material& material, const SpecularGlossiness& model) {
  if (Status s = add_base_colour(writer, bsdf, "diffuse", material, model.diffuse); !s) return s;
  if (!material.specular_gloss_texture) {
    add_rgb(bsdf, "specular", clamped(writer, material, model.specular));
    add_float(bsdf, "glossiness", model.glossiness);
    return Done{};
  }
  const Texture& texture = *material.specular_gloss_texture;
  if (Status s = add_colour_texture(writer, bsdf, "specular", texture, model.specular, name_for_losses(material)); !s) return s;
  return add_grey_texture(writer, bsdf, "glossiness", texture, 3, model.glossiness, name_for_losses(material));
}

void add_conductor(Writer& writer, pugi::xml_node bsdf, const Material& material, const Conductor& model) {
  add_rgb(bsdf, "eta", model.eta);
  add_rgb(bsdf, "k", model.k);
  add_string(bsdf, "distribution", "ggx");
  add_float(bsdf, "alpha", model.alpha);
  if (model.masking == Masking::correlated) {
    writer.losses.add(
        name_for_losses(material) + ": height-correlated masking",
        "Smith's separable form: darker at grazing angles, up to a factor of 2 at alpha 1, under 1 % at alpha .1 and 60 degrees");
  } else if (model.masking != Masking::separable) {
    writer.losses.add(name_for_losses(material) + ": masking in Schlick's form",
                      model.masking == Masking::schlick_image
                          ? "Smith's separable form: brighter by up to 25 % a side, most where the cosine is 3/4 alpha"
                          : "Smith's separable form: brighter at grazing angles, the more the smaller alpha is");
  }
  if (material.base_colour_texture || material.metal_rough_texture) {
    writer.losses.add(name_for_losses(material) + ": textures of a conductor", "left out");
  }
}

Status add_model(Writer& writer, pugi::xml_node parent, const Material& material) {
  if (const auto* lambert = std::get_if<Lambert>(&material.model)) {
    return add_base_colour(writer, add_plugin(parent, "bsdf", "diffuse"), "reflectance", material, lambert->base_colour);
  }
  if (const auto* principled = std::get_if<Principled>(&material.model)) {
    return add_principled(writer, add_plugin(parent, "bsdf", "principled"), material, *principled);
  }
  if (const auto* standard = std::get_if<Standard>(&material.model)) {
    return add_standard(writer, add_plugin(parent, "bsdf", "etendue_standard"), material, *standard);
  }
  if (const auto* metal_rough = std::get_if<MetalRough>(&material.model)) {
    return add_metal_rough(writer, add_plugin(parent, "bsdf", "etendue_metal_rough"), material, *metal_rough);
  }
  if (const auto* specular = std::get_if<SpecularGlossiness>(&material.model)) {
    return add_specular_glossiness(writer, add_plugin(parent, "bsdf", "etendue_specular_glossiness"), material, *specular);
  }
  if (const auto* conductor = std::get_if<Conductor>(&material.model)) {
    add_conductor(writer, add_plugin(parent, "bsdf", "roughconductor"), material, *conductor);
    return Done{};
  }
  return unsupported("material '" + material.name + "' has no twin in Mitsuba", material.source);
}

// What the built-ins make of a model that plugins show as it is.
void report_twin(Writer& writer, const Material& material) {
  const auto lost = [&](const char* model, const char* effect) {
    writer.losses.add(name_for_losses(material) + model, std::string(effect) + exact_with_plugins);
  };
  if (std::holds_alternative<Standard>(material.model)) {
    lost(": Frostbite's standard model",
         "`principled`: dielectrics brighter by a factor of 1.11 (roughness .25) to 1.50 (roughness 1) in albedo; metals within .1 % "
         "at roughness .3, up to 35 % darker at roughness 1 and grazing angles");
  } else if (std::holds_alternative<MetalRough>(material.model)) {
    lost(": glTF's metallic-roughness model", "`principled`: brighter by a factor of 1.03 to 1.29 in albedo");
  } else if (std::holds_alternative<SpecularGlossiness>(material.model)) {
    const char* effect =
        material.fallback ? "the file's metallic-roughness fallback instead, as `principled`"
        : material.specular_gloss_texture
            ? "`principled`, a dielectric of F0 .04 and roughness .5: the texture of specular colour and glossiness is left out"
            : "the nearest `principled`: coloured reflections of dielectrics turn grey or metallic";
    lost(": glTF's specular-glossiness model", effect);
  }
}

void report_model(Writer& writer, const Material& material) {
  if (writer.parts == MitsubaParts::built_in) report_twin(writer, material);
  for (const Loss& loss : unshown_losses(material)) writer.losses.add(name_for_losses(material) + ": " + loss.what, loss.effect);
}

Status add_shaded(Writer& writer, pugi::xml_node parent, const Material& material) {
  pugi::xml_node inner = parent;
  if (material.normal_map) {
    inner = add_plugin(parent, "bsdf", "normalmap");
    add_boolean(inner, "use_shadowing_function", false);
    add_boolean(inner, "flip_invalid_normals", false);
    const NormalMap& map = *material.normal_map;
    if (Status s = add_normal_texture(writer, inner, "normalmap", map.texture, map.scale, name_for_losses(material)); !s) return s;
  }
  return add_model(writer, inner, material);
}

// mask(twosided(normalmap(model))), each only where it is needed. The outermost element carries the id.
Status add_material(Writer& writer, const Material& authored, const std::string& id) {
  const Material material = mitsuba_twin(authored, writer.parts);
  pugi::xml_node inner = writer.root;
  const std::size_t before = static_cast<std::size_t>(std::distance(inner.begin(), inner.end()));
  if (has_holes(material, writer.parts)) {
    inner = add_plugin(inner, "bsdf", "mask");
    if (Status s = add_cutout_texture(writer, inner, "opacity", *material.base_colour_texture, material.base_alpha, *material.alpha_cutoff,
                                      name_for_losses(material));
        !s) {
      return s;
    }
  }
  if (material.double_sided) inner = add_plugin(inner, "bsdf", "twosided");
  if (Status s = add_shaded(writer, inner, material); !s) return s;
  pugi::xml_node outermost = *std::next(writer.root.begin(), static_cast<std::ptrdiff_t>(before));
  outermost.append_attribute("id") = id.c_str();
  return Done{};
}

}  // namespace

std::string material_id(const Scene& scene, std::uint32_t material) {
  if (material == no_index) return "material_default";
  return "material_" + std::to_string(material) + "_" + id_safe(scene.materials[material].name);
}

bool has_textures(const Material& authored, MitsubaParts parts) {
  const Material material = mitsuba_twin(authored, parts);
  return material.base_colour_texture || material.metal_rough_texture || material.specular_gloss_texture || material.normal_map;
}

bool has_holes(const Material& material, MitsubaParts parts) {
  return material.alpha_cutoff && mitsuba_twin(material, parts).base_colour_texture;
}

Status write_materials(Writer& writer) {
  const auto uses_default = [](const Object& object) { return object.material == no_index; };
  if (std::any_of(writer.scene.objects.begin(), writer.scene.objects.end(), uses_default)) {
    Material grey;
    grey.model = Lambert{};
    if (Status s = add_material(writer, grey, material_id(writer.scene, no_index)); !s) return s;
  }
  for (const std::uint32_t index : used_materials(writer.scene)) {
    const Material& material = writer.scene.materials[index];
    report_model(writer, material);
    if (Status s = add_material(writer, material, material_id(writer.scene, index)); !s) return s;
  }
  return Done{};
}

}  // namespace etendue::mitsuba
