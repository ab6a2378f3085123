#include "materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "uri.h"

namespace etendue::gltf {
namespace {

constexpr const char* spec_gloss = "KHR_materials_pbrSpecularGlossiness";
constexpr const char* specular = "KHR_materials_specular";
constexpr const char* ior = "KHR_materials_ior";

const Json* extension(const Json& material, const char* name) {
  const auto extensions = material.find("extensions");
  if (extensions == material.end()) return nullptr;
  const auto found = extensions->find(name);
  return found == extensions->end() ? nullptr : &*found;
}

void erase_extension(Json& material, const char* name) {
  const auto extensions = material.find("extensions");
  if (extensions == material.end()) return;
  extensions->erase(name);
  if (extensions->empty()) material.erase("extensions");
}

Json numbers(const Rgb& c) { return Json::array({c.x, c.y, c.z}); }

class MaterialWriter {
 public:
  explicit MaterialWriter(Document& document) : document_(document) {}

  void write(const Material& material, Json& json) {
    const bool has_gloss = extension(json, spec_gloss) != nullptr;
    if (const auto* gloss = std::get_if<SpecularGlossiness>(&material.model); gloss != nullptr && !has_gloss) {
      write_spec_gloss(material, *gloss, json);
      report_pointers(material);
    } else if (const auto* metal = std::get_if<MetalRough>(&material.model); metal != nullptr && has_gloss) {
      write_metal_rough(material, *metal, json);
      report_pointers(material);
    }
    follow_colours(material, json);
  }

  // Names of extensions, and textures that nobody refers to any more.
  void finish() {
    if (!changed_) return;
    for (const char* name : {spec_gloss, specular, ior}) {
      bool used = false;
      for (const Json& material : document_.now["materials"]) used = used || extension(material, name) != nullptr;
      if (used)
        use_extension(document_.now, name);
      else
        drop_extension(document_.now, name);
    }
    remove_unused(document_, replaced_);
  }

 private:
  // Colours whose pictures the scene has anew (convert_colour_textures()).
  void follow_colours(const Material& material, Json& json) {
    const bool two_colours = std::holds_alternative<SpecularGlossiness>(material.model);
    const auto follow_in = [&](Json& owner, const char* name, const char* key, const std::optional<Texture>& texture) {
      if (const auto found = owner.find(name); found != owner.end()) follow(*found, key, texture);
    };
    follow(json, "emissiveTexture", material.emissive_texture);
    if (!two_colours || material.fallback)
      follow_in(json, "pbrMetallicRoughness", "baseColorTexture",
                two_colours ? material.fallback->base_colour_texture : material.base_colour_texture);
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) return;
    if (two_colours) {
      follow_in(*extensions, spec_gloss, "diffuseTexture", material.base_colour_texture);
      follow_in(*extensions, spec_gloss, "specularGlossinessTexture", material.specular_gloss_texture);
    }
    const Lobes& lobes = material.lobes;
    if (lobes.specular) follow_in(*extensions, specular, "specularColorTexture", lobes.specular->colour_texture);
    if (lobes.sheen) follow_in(*extensions, "KHR_materials_sheen", "sheenColorTexture", lobes.sheen->colour_texture);
    if (lobes.diffuse_transmission)
      follow_in(*extensions, "KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture",
                lobes.diffuse_transmission->colour_texture);
  }
  void follow(Json& model, const char* key, const std::optional<Texture>& texture) {
    const auto info = model.find(key);
    if (info == model.end() || !texture || place_before(document_.scene.images[texture->image])) return;
    lookup_ = *info;
    if (const Json* index = index_in(*info, "index")) replaced_.insert(index->get<std::size_t>());
    (*info)["index"] = texture_of(texture->image);
    changed_ = true;
  }

  // What the lookups are taken from, and the textures that may fall out of use.
  void replace(const Json& model, const char* first, const char* second) {
    changed_ = true;
    lookup_ = nullptr;
    for (const char* key : {second, first}) {
      const auto info = model.find(key);
      if (info == model.end()) continue;
      lookup_ = *info;
      if (const Json* index = index_in(*info, "index")) replaced_.insert(index->get<std::size_t>());
    }
  }

  void write_metal_rough(const Material& material, const MetalRough& model, Json& json) {
    const Json old = *extension(json, spec_gloss);
    Json core = Json::object();
    if (const auto found = json.find("pbrMetallicRoughness"); found != json.end()) {
      replace(*found, "baseColorTexture", "metallicRoughnessTexture");
      for (const auto& [key, value] : found->items())
        if (key == "extras" || key == "extensions") core[key] = value;
    }
    replace(old, "diffuseTexture", "specularGlossinessTexture");
    put_colour(core, "baseColorFactor", model.base_colour, material.base_alpha);
    put_texture(core, "baseColorTexture", material.base_colour_texture);
    put_number(core, "metallicFactor", model.metallic, 1);
    put_number(core, "roughnessFactor", model.roughness, 1);
    put_texture(core, "metallicRoughnessTexture", material.metal_rough_texture);
    json["pbrMetallicRoughness"] = std::move(core);

    Json& extensions = json["extensions"];
    extensions.erase(spec_gloss);
    if (const auto& lobe = material.lobes.specular) {
      Json out = Json::object();
      put_number(out, "specularFactor", lobe->factor, 1);
      if (!(lobe->colour == Rgb{1, 1, 1})) out["specularColorFactor"] = numbers(lobe->colour);
      put_texture(out, "specularColorTexture", lobe->colour_texture);
      extensions[specular] = std::move(out);
    }
    if (model.ior != 1.5) extensions[ior] = {{"ior", model.ior}};
    if (extensions.empty()) json.erase("extensions");
  }

  void write_spec_gloss(const Material& material, const SpecularGlossiness& model, Json& json) {
    lookup_ = nullptr;
    const auto core = json.find("pbrMetallicRoughness");
    if (core != json.end()) replace(*core, "baseColorTexture", "metallicRoughnessTexture");
    changed_ = true;
    if (const Json* lobe = extension(json, specular)) {
      const Json lookup = lookup_;
      replace(*lobe, "specularColorTexture", "specularTexture");
      if (!lookup.is_null()) lookup_ = lookup;
    }
    erase_extension(json, specular);
    erase_extension(json, ior);
    Json out = Json::object();
    put_colour(out, "diffuseFactor", model.diffuse, material.base_alpha);
    put_texture(out, "diffuseTexture", material.base_colour_texture);
    if (!(model.specular == Rgb{1, 1, 1})) out["specularFactor"] = numbers(model.specular);
    put_number(out, "glossinessFactor", model.glossiness, 1);
    put_texture(out, "specularGlossinessTexture", material.specular_gloss_texture);
    json["extensions"][spec_gloss] = std::move(out);
  }

  static void put_number(Json& object, const char* key, double value, double otherwise) {
    if (value != otherwise) object[key] = value;
  }
  static void put_colour(Json& object, const char* key, const Rgb& colour, double alpha) {
    if (colour == Rgb{1, 1, 1} && alpha == 1) return;
    object[key] = numbers(colour);
    object[key].push_back(alpha);
  }

  void put_texture(Json& object, const char* key, const std::optional<Texture>& texture) {
    if (!texture) return;
    Json info = lookup_.is_null() ? Json::object() : lookup_;
    info["index"] = texture_of(texture->image);
    object[key] = std::move(info);
  }

  // The document's texture with this image and the sampler of the lookup.
  std::size_t texture_of(std::uint32_t image) {
    Json& textures = document_.now["textures"];
    Json like = Json::object();
    if (const Json* old = lookup_.is_null() ? nullptr : index_in(lookup_, "index")) {
      const auto sampler = textures[old->get<std::size_t>()].find("sampler");
      if (sampler != textures[old->get<std::size_t>()].end()) like["sampler"] = *sampler;
    }
    like["source"] = image_of(image);
    for (std::size_t i = 0; i < textures.size(); ++i) {
      const auto same = [&](const char* key) { return textures[i].value(key, Json()) == like.value(key, Json()); };
      if (same("sampler") && same("source")) return i;
    }
    textures.push_back(std::move(like));
    return textures.size() - 1;
  }

  std::size_t image_of(std::uint32_t index) {
    const ImageRef& image = document_.scene.images[index];
    if (const auto place = place_before(image)) return *place;
    const auto known = images_.find(index);
    if (known != images_.end()) return known->second;
    Json& images = document_.now["images"];
    Json out = Json::object();
    if (!image.name.empty()) out["name"] = image.name;
    images.push_back(std::move(out));
    document_.new_images.emplace(images.size() - 1, &image);
    return images_[index] = images.size() - 1;
  }

  // Where the document that was read has an image.
  std::optional<std::size_t> place_before(const ImageRef& image) const {
    for (std::size_t i = 0; document_.before.contains("images") && i < document_.before["images"].size(); ++i)
      if (is_image(document_.before["images"][i], image)) return i;
    return std::nullopt;
  }

  // Whether the document's image is where this one was read from.
  bool is_image(const Json& json, const ImageRef& image) const {
    const auto uri = json.find("uri");
    if (uri != json.end() && is_data_uri(uri->get<std::string>())) {
      const auto data = decode_data_uri(uri->get<std::string>());
      return image.embedded && data && std::equal(data->begin(), data->end(), image.embedded.begin(), image.embedded.end());
    }
    if (uri != json.end()) {
      const auto file = file_inside(std::filesystem::path(document_.scene.file).parent_path(), uri->get<std::string>());
      return !image.embedded && file && file->string() == image.file;
    }
    const Json* index = index_in(json, "bufferView");
    if (index == nullptr || !image.embedded) return false;
    const Json& view = document_.before["bufferViews"][index->get<std::size_t>()];
    const auto buffer = view.value("buffer", std::size_t{0}), begin = view.value("byteOffset", std::size_t{0});
    const auto size = view.value("byteLength", std::size_t{0});
    if (size != image.embedded.size() || buffer >= document_.scene.carried.buffers.size()) return false;
    const SharedBytes& bytes = document_.scene.carried.buffers[buffer];
    if (bytes) return bytes.data() + begin == image.embedded.data();
    const auto data = decode_data_uri(document_.before["buffers"][buffer].value("uri", ""));
    return data && data->size() >= begin + size &&
           std::equal(image.embedded.begin(), image.embedded.end(), data->begin() + static_cast<std::ptrdiff_t>(begin));
  }

  // KHR_animation_pointer: what pointed into the old model moves nothing any more.
  void report_pointers(const Material& material) {
    const auto animations = document_.now.find("animations");
    if (animations == document_.now.end()) return;
    std::size_t count = 0;
    for_each_object(*animations, [&](Json& object) {
      const auto pointer = object.find("pointer");
      if (pointer == object.end() || !pointer->is_string()) return;
      const auto text = pointer->get<std::string>();
      count += text.starts_with(material.source + "/pbrMetallicRoughness/") || text.starts_with(material.source + "/extensions/");
    });
    if (count > 0)
      document_.losses.add(fmt::format("material '{}': {} animation(s) of its parameters", material.name, count),
                           "kept as they stand, for the model that the material had");
  }

  Document& document_;
  Json lookup_;  // the textureInfo that new textures are looked up by; null: none
  std::set<std::size_t> replaced_;
  std::map<std::uint32_t, std::size_t> images_;
  bool changed_ = false;
};

}  // namespace

void write_changed_materials(Document& document) {
  MaterialWriter writer(document);
  constexpr std::string_view place = "/materials/";
  for (const Material& material : document.scene.materials) {
    if (!material.source.starts_with(place)) continue;
    writer.write(material, document.now["materials"][std::stoul(material.source.substr(place.size()))]);
  }
  writer.finish();
}

}  // namespace etendue::gltf
