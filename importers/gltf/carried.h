// What a document says beyond what pictures show, by name; and what a scene of ours does not hold, carried.
#pragma once

#include "asset.h"

namespace etendue::gltf {

// Extensions that are not shown, with what is missed; that the file requires one of them is an error.
void name_unshown(Asset& asset);

// After reading: the document, its buffers, and pointers to all that nothing else in the scene represents (mapping.h says what does).
void carry(Asset& asset, Scene& scene);

}  // namespace etendue::gltf
