// glTF materials, textures and images as ours, read when the first primitive uses them.
#pragma once

#include "asset.h"

#include <cstdint>
#include <map>
#include <optional>

namespace etendue::gltf {

class Materials {
 public:
  // What is used is appended to the scene's materials (if Need asks for materials) and images.
  Materials(Asset& asset, Scene& scene) : asset_(asset), scene_(scene) {}

  struct Entry {
    Material material;
    std::uint32_t index = no_index;  // in Scene::materials; no_index: glTF's default is not needed there
    int uv_set = 0;                  // TEXCOORD_n of its textures
    bool wants_uvs = false, wants_tangents = false;
  };
  // -1 is glTF's default material.
  const Entry& at(int material);
  // Index into Scene::images; none if it is broken (reported).
  std::optional<std::uint32_t> image(int image);

 private:
  Entry read(int material);
  void read_specular_glossiness(Material& out, const std::string& material, bool has_fallback);
  Lobes read_lobes(const std::string& material);
  // The textureInfo `key` of the object at `pointer`.
  std::optional<Texture> texture(const nlohmann::json& object, const std::string& pointer, const char* key, Encoding encoding);
  std::optional<NormalMap> normal_map(const nlohmann::json& object, const std::string& pointer, const char* key);
  std::optional<std::uint32_t> image_of(int texture);
  void choose_uv_set(Entry& entry, const std::string& pointer);

  Asset& asset_;
  Scene& scene_;
  std::map<int, Entry> entries_;
  std::map<int, std::optional<std::uint32_t>> images_;
};

// A member that is an object; nullptr if there is none.
const nlohmann::json* member(const nlohmann::json& object, const char* key);
// Three numbers as linear Rec.709.
Rgb colour_or(const nlohmann::json& object, const char* key, double otherwise);

}  // namespace etendue::gltf
