// Lights of a scene as emitters, with what light_within.h wants of their pictures.
#pragma once

#include "etendue/picture_light.h"
#include "etendue/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

struct PicturedEmitter {
  eval::Emitter emitter;
  // Null: none, or not on a rectangle without a window, or looked up nearest or with a transform.
  std::shared_ptr<const eval::PictureMoments> picture;
};
// As emitters_of of render.h.
Result<std::vector<PicturedEmitter>> pictured_emitters_of(const Scene& scene, std::span<const std::uint32_t> lights);

}  // namespace etendue
