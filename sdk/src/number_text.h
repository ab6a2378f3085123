// A decimal number at the front of a text, whatever the locale.
#pragma once

#include <string_view>

namespace etendue {

// Takes it off the text and returns null, or leaves the text and returns why there is none: "inf", "nan", hexadecimal, a second sign, a
// number beyond a double. One sign may lead.
const char* take_decimal(std::string_view& text, double& value);
// The same where what follows is no further number: digits that go on behind another mark ("1,5", "1'500") are told too.
const char* take_number(std::string_view& text, double& value);

// Blanks and tabs off both ends.
std::string_view trimmed(std::string_view text);

}  // namespace etendue
