// SHA-1 of bytes as lower-case hexadecimal digits: names for files with equal content, keys of the picture cache.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace etendue::mitsuba {

std::string digest_of(std::span<const std::byte> bytes);
std::string digest_of(std::string_view text);

}  // namespace etendue::mitsuba
