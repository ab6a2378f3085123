// The pictures as the page's data.
#pragma once

#include "etendue/report.h"

#include <string>

namespace etendue::report_detail {

// JSON, safe inside a script element: {"tabs": [{"name", "description", "width", "height", "verdict", "ours", "difference", "sigma",
// "authored"}], "ev100"}.
std::string picture_data(const Report& report, const Picture& ours, const Picture& reference);

}  // namespace etendue::report_detail
