// Lights of a scene as emitters, with what only the scene has: meshes, textures, environments.
#pragma once

#include "etendue/light_pictures.h"
#include "etendue/picture.h"

#include <functional>
#include <memory>

namespace etendue::rendering {

using TextureSource = std::function<Result<std::shared_ptr<const DecodedImage>>(const Texture&)>;
// With the moments of a picture on a rectangle if they are wanted.
Result<PicturedEmitter> emitter_in(const Scene& scene, const Light& light, const TextureSource& texture, bool with_picture);

}  // namespace etendue::rendering
