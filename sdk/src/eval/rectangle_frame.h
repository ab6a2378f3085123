// Polygons that are the whole of their picture.
#pragma once

#include "etendue/eval.h"

namespace etendue::eval {

// Four corners that are those of the uv frame, in whatever order.
bool fills_its_frame(const PolygonEmitter& polygon);

}  // namespace etendue::eval
