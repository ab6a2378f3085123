// Whether the bytes of a glTF asset are what its document says: files, pictures' headers, and the elements of every accessor.
#pragma once

#include "asset.h"

namespace etendue::gltf {

// Reads all buffers and the first bytes of pictures. Codes and severities are Khronos' validator's; one message for an accessor and a
// kind of fault, which counts the elements and names the first.
void check_data(Asset& asset);

}  // namespace etendue::gltf
