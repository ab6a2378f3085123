// A scene that no document carries, as a glTF document: for what was read from a rig.
#pragma once

#include "document.h"
#include "gltf.h"

namespace etendue::gltf {

struct Built {
  Scene carrier;                                // the new document's text and its buffer, and the scene's images
  std::map<std::size_t, std::uint32_t> images;  // by their place in the document: in the carrier
  LossReport losses;
};

// Errors: lights that do not resolve; SCENE_INVALID.
Result<Built> document_of(const Scene& scene, const std::vector<std::uint32_t>& lit, LightShapes shapes);

}  // namespace etendue::gltf
