#include "etendue/unshown.h"

#include "lobes.h"
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

// lobes.h says what they are.
Status add_reflecting_lobes(Writer& writer, pugi::xml_node bsdf, const Material& material, const ShownLobes& lobes) {
  if (lobes.anisotropic != 0) add_float(bsdf, "anisotropic", lobes.anisotropic);
  if (lobes.sheen > 0) {
    add_float(bsdf, "sheen", lobes.sheen);
    add_float(bsdf, "sheen_tint", lobes.sheen_tint);
  }
  if (!(lobes.clearcoat > 0)) return Done{};
  add_float(bsdf, "clearcoat_gloss", lobes.clearcoat_gloss);
  if (lobes.clearcoat_texture)
    return add_grey_texture(writer, bsdf, "clearcoat", *lobes.clearcoat_texture, 0, lobes.clearcoat, name_for_losses(material));
  add_float(bsdf, "clearcoat", lobes.clearcoat);
  return Done{};
}

// <bsdf type="blendbsdf"> with the weight of its second part, bsdf_1.
Result<pugi::xml_node> add_blend(Writer& writer, pugi::xml_node parent, const char* name, double weight,
                                 const std::optional<Texture>& texture, int channel, const Material& material) {
  pugi::xml_node blend = add_plugin(parent, "bsdf", "blendbsdf", {}, name);
  if (!texture) {
    add_float(blend, "weight", weight);
  } else if (Status s = add_grey_texture(writer, blend, "weight", *texture, channel, weight, name_for_losses(material)); !s) {
    return s.error();
  }
  return blend;
}

// What lets light pass in a direction: the base colour's tint, the twin's roughness.
Status add_passing(Writer& writer, pugi::xml_node blend, const Material& material, const Principled& model, const ShownLobes& lobes) {
  pugi::xml_node bsdf = add_plugin(blend, "bsdf", lobes.solid ? "principled" : "principledthin", {}, "bsdf_1");
  if (Status s = add_base_colour(writer, bsdf, "base_color", material, model.base_colour); !s) return s;
  if (Status s = add_scalar(writer, bsdf, "roughness", material, 1, model.roughness); !s) return s;
  if (lobes.anisotropic != 0) add_float(bsdf, "anisotropic", lobes.anisotropic);
  add_float(bsdf, "spec_trans", 1);
  // Mitsuba refuses an index of 1.
  add_float(bsdf, "eta", std::max(lobes.ior, 1.0001));
  return Done{};
}

Status add_diffused(Writer& writer, pugi::xml_node blend, const Material& material, const ShownLobes& lobes) {
  pugi::xml_node bsdf = add_plugin(blend, "bsdf", "principledthin", {}, "bsdf_1");
  add_float(bsdf, "diff_trans", 2);
  if (lobes.diffused_colour_texture)
    return add_colour_texture(writer, bsdf, "base_color", *lobes.diffused_colour_texture, lobes.diffused_colour, name_for_losses(material));
  add_rgb(bsdf, "base_color", clamped(writer, material, lobes.diffused_colour));
  return Done{};
}

// twosided(principled), the second only where it is needed: Mitsuba's `twosided` takes nothing that transmits.
Status add_reflecting(Writer& writer, pugi::xml_node parent, const char* name, const Material& material, Principled model,
                      const ShownLobes& lobes) {
  model.metallic = lobes.metallic.value_or(model.metallic);
  if (lobes.transmits() && material.double_sided) parent = add_plugin(parent, "bsdf", "twosided", {}, name), name = "";
  pugi::xml_node bsdf = add_plugin(parent, "bsdf", "principled", {}, name);
  if (Status s = add_principled(writer, bsdf, material, model); !s) return s;
  return add_reflecting_lobes(writer, bsdf, material, lobes);
}

// blend(blend(what reflects, what is diffused to the other side), what passes). The order of the parts in the file is theirs in the blend.
Status add_principled_with_lobes(Writer& writer, pugi::xml_node parent, const Material& material, Principled model,
                                 const ShownLobes& lobes) {
  model.specular = lobes.specular.value_or(model.specular);
  model.roughness = lobes.roughness.value_or(model.roughness);
  pugi::xml_node passing, diffusing, inner = parent;
  const char* name = "";
  if (lobes.passed > 0) {
    Result<pugi::xml_node> blend = add_blend(writer, inner, name, lobes.passed, lobes.passed_texture, 0, material);
    if (!blend) return blend.error();
    inner = passing = *blend, name = "bsdf_0";
  }
  if (lobes.diffused > 0) {
    Result<pugi::xml_node> blend = add_blend(writer, inner, name, lobes.diffused, lobes.diffused_texture, 3, material);
    if (!blend) return blend.error();
    inner = diffusing = *blend, name = "bsdf_0";
  }
  if (Status s = add_reflecting(writer, inner, name, material, model, lobes); !s) return s;
  if (diffusing) {
    if (Status s = add_diffused(writer, diffusing, material, lobes); !s) return s;
  }
  return passing ? add_passing(writer, passing, material, model, lobes) : Status(Done{});
}

ShownLobes lobes_of(const Writer& writer, const Material& material) {
  if (writer.lobes == MitsubaLobes::as_far_as_can_be) return shown_lobes(material, writer.options.max_depth);
  ShownLobes none;
  none.losses = unshown_losses(material);
  return none;
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

Status add_model(Writer& writer, pugi::xml_node parent, const Material& material, const ShownLobes& lobes) {
  if (const auto* lambert = std::get_if<Lambert>(&material.model)) {
    return add_base_colour(writer, add_plugin(parent, "bsdf", "diffuse"), "reflectance", material, lambert->base_colour);
  }
  if (const auto* principled = std::get_if<Principled>(&material.model)) {
    return add_principled_with_lobes(writer, parent, material, *principled, lobes);
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
  for (const Loss& loss : lobes_of(writer, material).losses) writer.losses.add(name_for_losses(material) + ": " + loss.what, loss.effect);
}

Status add_shaded(Writer& writer, pugi::xml_node parent, const Material& material, const ShownLobes& lobes) {
  pugi::xml_node inner = parent;
  if (material.normal_map) {
    inner = add_plugin(parent, "bsdf", "normalmap");
    add_boolean(inner, "use_shadowing_function", false);
    add_boolean(inner, "flip_invalid_normals", false);
    const NormalMap& map = *material.normal_map;
    if (Status s = add_normal_texture(writer, inner, "normalmap", map.texture, map.scale, name_for_losses(material)); !s) return s;
  }
  return add_model(writer, inner, material, lobes);
}

std::string medium_id(const Scene& scene, std::uint32_t material) { return "medium_" + material_id(scene, material); }

// Absorption alone: nothing is scattered. Mitsuba refuses colours above 1, so the largest is its scale; and it chooses distances by one
// channel's absorption, which must not be 0: 1e-5 of the largest.
void add_medium(Writer& writer, const std::string& id, const Rgb& absorption_per_m) {
  const double scale = std::max({absorption_per_m.x, absorption_per_m.y, absorption_per_m.z, 1e-12});
  pugi::xml_node medium = add_plugin(writer.root, "medium", "homogeneous", id);
  Rgb relative = absorption_per_m / scale;
  for (int c = 0; c < 3; ++c) relative[c] = std::max(relative[c], 1e-5);
  add_rgb(medium, "sigma_t", relative);
  add_float(medium, "scale", scale);
  add_rgb(medium, "albedo", {0, 0, 0});
}

Status add_coverage(Writer& writer, pugi::xml_node mask, const Material& material) {
  if (material.base_colour_texture)
    return add_grey_texture(writer, mask, "opacity", *material.base_colour_texture, 3, material.base_alpha, name_for_losses(material));
  add_float(mask, "opacity", std::clamp(material.base_alpha, 0.0, 1.0));
  return Done{};
}

// mask(twosided(normalmap(model))), each only where it is needed. The outermost element carries the id.
Status add_material(Writer& writer, const Material& authored, const std::string& id) {
  const Material material = mitsuba_twin(authored, writer.parts);
  const ShownLobes lobes = lobes_of(writer, authored);
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
  if (lobes.blended) {
    inner = add_plugin(inner, "bsdf", "mask");
    if (Status s = add_coverage(writer, inner, material); !s) return s;
  }
  if (material.double_sided && !lobes.transmits()) inner = add_plugin(inner, "bsdf", "twosided");
  if (Status s = add_shaded(writer, inner, material, lobes); !s) return s;
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

bool is_passed(const Writer& writer, const Material& material) {
  if (has_holes(material, writer.parts)) return true;
  return writer.lobes == MitsubaLobes::as_far_as_can_be && (material.blended || absorption_of(material));
}

void add_surface(const Writer& writer, pugi::xml_node shape, std::uint32_t material) {
  add_reference(shape, material_id(writer.scene, material));
  if (writer.lobes == MitsubaLobes::as_ours || material == no_index || !absorption_of(writer.scene.materials[material])) return;
  pugi::xml_node medium = shape.append_child("ref");
  medium.append_attribute("id") = medium_id(writer.scene, material).c_str();
  medium.append_attribute("name") = "interior";
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
    if (const auto absorption = lobes_of(writer, material).absorption_per_m)
      add_medium(writer, medium_id(writer.scene, index), *absorption);
  }
  return Done{};
}

}  // namespace etendue::mitsuba
