// Materials of a scene as glTF's metallic-roughness.
#pragma once

#include "etendue/io.h"
#include "json_edit.h"

#include <cstdint>
#include <map>
#include <string>

namespace etendue::gltf {

// Textures and images of a new document, each written once.
class TextureWriter {
 public:
  TextureWriter(const Scene& scene, Json& document, LossReport& losses) : scene_(scene), document_(document), losses_(losses) {}

  // Puts a textureInfo under `key`; what a glTF cannot refer to is reported as what `owner` loses. False: nothing was put.
  bool put(Json& object, const char* key, const Texture& texture, Encoding read_as, const std::string& owner);
  // By their place in the document: in the scene.
  const std::map<std::size_t, std::uint32_t>& images() const { return images_; }

 private:
  std::size_t sampler_of(const Texture& texture);
  const Scene& scene_;
  Json& document_;
  LossReport& losses_;
  std::map<std::size_t, std::uint32_t> images_;
};

Json surface_of(const Material& material, TextureWriter& textures, LossReport& losses);

// A surface that emits so many cd/m2 and reflects nothing.
Json emitting_surface(const std::string& name, const Rgb& luminance, bool both_sides);

}  // namespace etendue::gltf
