// Camera settings in any order, as photographers write them.
#pragma once

#include "etendue/quantity_text.h"
#include "text_cursor.h"

namespace etendue {

// Takes all that is left.
Result<CameraSettings> take_camera(Cursor cursor);
std::string to_string(const CameraSettings& camera);

}  // namespace etendue
