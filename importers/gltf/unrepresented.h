// What a document says beyond what a scene of ours holds, by name, with what is lost.
#pragma once

#include "asset.h"

namespace etendue::gltf {

void name_unrepresented(Asset& asset);

}  // namespace etendue::gltf
