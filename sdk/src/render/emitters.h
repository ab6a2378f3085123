// Lights of a scene as emitters, with what only the scene has: meshes, textures, environments.
#pragma once

#include "etendue/eval.h"
#include "etendue/picture.h"
#include "etendue/scene.h"

#include <functional>
#include <memory>

namespace etendue::rendering {

using TextureSource = std::function<Result<std::shared_ptr<const DecodedImage>>(const Texture&)>;
Result<eval::Emitter> emitter_in(const Scene& scene, const Light& light, const TextureSource& texture);

}  // namespace etendue::rendering
