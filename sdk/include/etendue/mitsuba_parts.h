// What Mitsuba renders with, and what becomes of a material there. With our plugins windows of lights stay as well.
#pragma once

#include "etendue/material.h"

namespace etendue {

enum class MitsubaParts { built_in, with_plugins };  // its own plugins alone, or ours too

// With built-ins mitsuba_twin() of material.h; with plugins every model stays as it is.
Material mitsuba_twin(const Material& material, MitsubaParts parts);

}  // namespace etendue
