// Text and numbers as they stand in the page.
#pragma once

#include <string>
#include <string_view>

namespace etendue::report_detail {

// For element content and quoted attributes; control characters become blanks.
std::string escaped(std::string_view text);

// ".2 %" with the digits that matter, a true minus sign and a narrow no-break space; `sign`: a plus too.
std::string percent(double ratio, bool sign = false);

}  // namespace etendue::report_detail
