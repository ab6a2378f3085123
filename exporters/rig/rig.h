// Writes a scene as a rig file (.rig.json).
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
std::unique_ptr<Exporter> make_rig_exporter();
}
