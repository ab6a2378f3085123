#include "surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "etendue/unshown.h"
#include "package.h"

namespace etendue::gltf {
namespace {

constexpr double core_f0 = 0.04;

Json numbers(const Rgb& c) { return Json::array({c.x, c.y, c.z}); }

Rgb held(const Rgb& c) { return {std::clamp(c.x, 0.0, 1.0), std::clamp(c.y, 0.0, 1.0), std::clamp(c.z, 0.0, 1.0)}; }

// offset, rotation and scale of KHR_texture_transform: u' = sx cos r u + sy sin r v + ox, v' = -sx sin r u + sy cos r v + oy.
Json transform_of(const Texture& texture, bool& exact) {
  const auto& m = texture.uv_transform;
  const double sx = std::hypot(m[0][0], m[1][0]), r = std::atan2(-m[1][0], m[0][0]);
  const double sy = m[0][1] * std::sin(r) + m[1][1] * std::cos(r), along = m[0][1] * std::cos(r) - m[1][1] * std::sin(r);
  exact = std::abs(along) <= 1e-9 * std::max(sx, std::abs(sy));
  Json out = Json::object();
  if (m[0][2] != 0 || m[1][2] != 0) out["offset"] = {m[0][2], m[1][2]};
  if (r != 0) out["rotation"] = r;
  if (sx != 1 || sy != 1) out["scale"] = {sx, sy};
  return out;
}

// What the format has instead: its own model, and f0 of the dielectric part.
struct Surface {
  MetalRough model;
  Rgb dielectric_f0{core_f0, core_f0, core_f0};
  double specular = 1;  // 0: no reflection at all, not at grazing angles either
  const char* loss = nullptr;
};

struct Nearest {
  Surface operator()(const Lambert& m) const {
    return {{m.base_colour, 0, 1, 1.5}, {core_f0, core_f0, core_f0}, 0, "to a reader of the core alone it reflects 4 % and more"};
  }
  Surface operator()(const Principled& m) const {
    const double f0 = 0.08 * m.specular;
    return {{m.base_colour, m.metallic, m.roughness, 1.5}, {f0, f0, f0}, 1, "Mitsuba's diffuse lobe becomes Lambert's"};
  }
  Surface operator()(const Standard& m) const {
    const double f0 = 0.16 * m.reflectance * m.reflectance;
    return {{m.base_colour, m.metal, m.roughness, 1.5}, {f0, f0, f0}, 1, "Disney's diffuse lobe becomes Lambert's"};
  }
  // ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
  Surface operator()(const Conductor& m) const {
    Rgb f0;
    for (int c = 0; c < 3; ++c) {
      const double k2 = m.k[c] * m.k[c];
      f0[c] = ((m.eta[c] - 1) * (m.eta[c] - 1) + k2) / ((m.eta[c] + 1) * (m.eta[c] + 1) + k2);
    }
    return {{f0, 1, std::sqrt(m.alpha), 1.5},
            {core_f0, core_f0, core_f0},
            1,
            "Schlick's curve towards grazing angles instead of the exact one"};
  }
  Surface operator()(const MetalRough& m) const { return {m, {core_f0, core_f0, core_f0}, 1, nullptr}; }
  Surface operator()(const SpecularGlossiness&) const { return {}; }  // has an extension of its own
};

void put_factor(Json& object, const char* key, double value, double otherwise) {
  if (value != otherwise) object[key] = value;
}

Json colour_with_alpha(const Rgb& colour, double alpha) {
  Json out = numbers(held(colour));
  out.push_back(std::clamp(alpha, 0.0, 1.0));
  return out;
}

}  // namespace

std::size_t TextureWriter::sampler_of(const Texture& texture) {
  const auto wrap = [](Wrap w) { return w == Wrap::repeat ? 10497 : w == Wrap::mirror ? 33648 : 33071; };
  Json sampler = {{"wrapS", wrap(texture.wrap_u)}, {"wrapT", wrap(texture.wrap_v)}};
  if (texture.nearest) sampler["magFilter"] = sampler["minFilter"] = 9728;
  Json& samplers = document_["samplers"];
  const auto found = std::find(samplers.begin(), samplers.end(), sampler);
  if (found != samplers.end()) return static_cast<std::size_t>(found - samplers.begin());
  samplers.push_back(std::move(sampler));
  return samplers.size() - 1;
}

bool TextureWriter::put(Json& object, const char* key, const Texture& texture, Encoding read_as, const std::string& owner) {
  const auto lose = [&](const std::string& what) { losses_.add(fmt::format("{}: {}", owner, key), what); };
  const ImageRef& image = scene_.images[texture.image];
  std::size_t place = document_.contains("images") ? document_["images"].size() : 0;
  for (const auto& [known, of] : images_)
    if (of == texture.image) place = known;
  if (!images_.contains(place)) {
    const Result<SharedBytes> bytes = bytes_of(image);
    const char* type = bytes ? mime_type_of(*bytes) : nullptr;
    if (type == nullptr || (std::string_view(type) != "image/png" && std::string_view(type) != "image/jpeg")) {
      lose(bytes ? "left out: the format takes PNG and JPEG" : "left out: " + bytes.error().text);
      return false;
    }
    Json out = Json::object();
    if (!image.name.empty()) out["name"] = image.name;
    document_["images"].push_back(std::move(out));
    images_.emplace(place, texture.image);
  }
  if (texture.encoding != read_as) lose("its numbers are read with the other encoding: sRGB for colours, linear for the rest");
  const Json made = {{"sampler", sampler_of(texture)}, {"source", place}};
  Json& textures = document_["textures"];
  const auto found = std::find(textures.begin(), textures.end(), made);
  const std::size_t index = static_cast<std::size_t>(found - textures.begin());
  if (found == textures.end()) textures.push_back(made);
  Json info = {{"index", index}};
  bool exact = true;
  if (Json transform = transform_of(texture, exact); !transform.empty()) info["extensions"]["KHR_texture_transform"] = std::move(transform);
  if (!exact) lose("the shear of its texture transform is left out");
  object[key] = std::move(info);
  return true;
}

Json surface_of(const Material& m, TextureWriter& textures, LossReport& losses) {
  const std::string owner = fmt::format("material '{}'", m.name);
  const auto put = [&](Json& object, const char* key, const std::optional<Texture>& texture, Encoding encoding) {
    return texture && textures.put(object, key, *texture, encoding, owner);
  };
  Json out = Json::object(), extensions = Json::object();
  if (!m.name.empty()) out["name"] = m.name;
  if (const auto* gloss = std::get_if<SpecularGlossiness>(&m.model)) {
    Json& e = extensions["KHR_materials_pbrSpecularGlossiness"] = Json::object();
    e["diffuseFactor"] = colour_with_alpha(gloss->diffuse, m.base_alpha);
    e["specularFactor"] = numbers(held(gloss->specular));
    e["glossinessFactor"] = gloss->glossiness;
    put(e, "diffuseTexture", m.base_colour_texture, Encoding::srgb);
    put(e, "specularGlossinessTexture", m.specular_gloss_texture, Encoding::srgb);
  } else {
    const Surface surface = std::visit(Nearest{}, m.model);
    if (surface.loss != nullptr) losses.add(owner + ": its model as metallic-roughness", surface.loss);
    Json& core = out["pbrMetallicRoughness"] = Json::object();
    core["baseColorFactor"] = colour_with_alpha(surface.model.base_colour, m.base_alpha);
    put_factor(core, "metallicFactor", surface.model.metallic, 1);
    put_factor(core, "roughnessFactor", surface.model.roughness, 1);
    put(core, "baseColorTexture", m.base_colour_texture, Encoding::srgb);
    put(core, "metallicRoughnessTexture", m.metal_rough_texture, Encoding::linear);
    if (surface.model.ior != 1.5) extensions["KHR_materials_ior"] = {{"ior", surface.model.ior}};
    Specular lobe = m.lobes.specular.value_or(Specular{surface.specular, surface.dielectric_f0 * (1 / core_f0), {}, {}});
    Json specular = Json::object();
    put_factor(specular, "specularFactor", lobe.factor, 1);
    // .08 x .5 and .16 x .5^2 are .04 but for rounding.
    const Rgb off = lobe.colour - Rgb{1, 1, 1};
    if (std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) > 1e-12) specular["specularColorFactor"] = numbers(lobe.colour);
    put(specular, "specularTexture", lobe.factor_texture, Encoding::linear);
    put(specular, "specularColorTexture", lobe.colour_texture, Encoding::srgb);
    if (!specular.empty()) extensions["KHR_materials_specular"] = std::move(specular);
  }
  if (m.normal_map && put(out, "normalTexture", m.normal_map->texture, Encoding::linear))
    put_factor(out["normalTexture"], "scale", m.normal_map->scale, 1);
  if (m.occlusion && put(out, "occlusionTexture", m.occlusion->texture, Encoding::linear))
    put_factor(out["occlusionTexture"], "strength", m.occlusion->strength, 1);
  if (m.alpha_cutoff) {
    out["alphaMode"] = "MASK";
    out["alphaCutoff"] = *m.alpha_cutoff;
  } else if (m.blended) {
    out["alphaMode"] = "BLEND";
  }
  if (m.double_sided) out["doubleSided"] = true;
  if (m.lobes.unlit) extensions["KHR_materials_unlit"] = Json::object();
  // The specular lobe is written; the others are named with what leaving them out does.
  Material others = m;
  others.lobes.specular.reset();
  others.lobes.unlit = others.blended = false;
  for (const Loss& loss : unshown_losses(others)) losses.add(fmt::format("{}: {}", owner, loss.what), loss.effect);
  if (!extensions.empty()) out["extensions"] = std::move(extensions);
  return out;
}

Json emitting_surface(const std::string& name, const Rgb& luminance, bool both_sides) {
  Json out = Json::object();
  out["name"] = name;
  out["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}};
  const double strength = std::max({luminance.x, luminance.y, luminance.z, 0.0});
  Rgb factor{0, 0, 0};
  for (int c = 0; c < 3 && strength > 0; ++c) factor[c] = std::clamp(luminance[c] / strength, 0.0, 1.0);
  out["emissiveFactor"] = numbers(factor);
  out["extensions"] = {{"KHR_materials_specular", {{"specularFactor", 0}}}};
  if (strength > 0) out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  if (both_sides) out["doubleSided"] = true;
  return out;
}

}  // namespace etendue::gltf
