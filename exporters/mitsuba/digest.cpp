#include "digest.h"

#include <OpenImageIO/hash.h>

namespace etendue::mitsuba {

std::string digest_of(std::span<const std::byte> bytes) {
  std::string digits = OIIO::SHA1(bytes.data(), bytes.size()).digest();
  for (char& c : digits) {
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  }
  return digits;
}

std::string digest_of(std::string_view text) { return digest_of(std::as_bytes(std::span(text.data(), text.size()))); }

}  // namespace etendue::mitsuba
