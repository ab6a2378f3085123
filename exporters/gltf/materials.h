// Materials whose model is another one than the document says, written anew.
#pragma once

#include "document.h"

namespace etendue::gltf {

// Metallic-roughness with KHR_materials_specular and _ior, or KHR_materials_pbrSpecularGlossiness beside the core's twin as it stood. What
// a material says beyond its model stays. A texture of the new model is looked up as the old model's first one was: its sampler, set of
// coordinates and transform are taken over.
void write_changed_materials(Document& document);

}  // namespace etendue::gltf
