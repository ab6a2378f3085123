// Binary PLY as Mitsuba reads it.
#pragma once

#include "etendue/scene.h"

#include <cstddef>
#include <vector>

namespace etendue::mitsuba {

std::vector<std::byte> to_ply(const Mesh& mesh);

}  // namespace etendue::mitsuba
