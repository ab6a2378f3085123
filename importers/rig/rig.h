// The rig file (.rig.json): lights in real units, a camera, simple objects. Format: sdk/docs/rig.md.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
std::unique_ptr<Importer> make_rig_importer(const Registry& others);  // `others` read the files that a rig names ("gltf")
}
