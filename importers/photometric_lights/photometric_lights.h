// The distributions of a scene's photometric lights, whatever format the scene came from: a rig names files, glTF embeds them.
#pragma once

#include "etendue/io.h"

namespace etendue {

// Reads every photometric light's file or embedded bytes into PhotometricShape::distribution. What cannot be read is an error with the
// place in the photometric file, and a note that names the light; repairs are warnings. A file that several lights name is read once.
Diagnostics read_photometric_lights(Scene& scene, std::uint64_t max_bytes = std::uint64_t{1} << 30);

}  // namespace etendue
