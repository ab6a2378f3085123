// Any bytes as a quantity, a camera or a colour. What is read must be written as a text that reads as the same.
#include "etendue/quantity_text.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace etendue;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<Written> written = parse(text);
  if (!written) {
    const Error& error = written.error();
    if (error.code.empty() || error.where.column < 1 || error.where.column > static_cast<int>(size) + 1) std::abort();
    return 0;
  }
  const std::string printed = to_string(*written);
  const Result<Written> again = parse(printed);
  if (!again || to_string(*again) != printed) {
    std::fprintf(stderr, "written as \"%s\", read back %s\n", printed.c_str(),
                 again ? to_string(*again).c_str() : again.error().text.c_str());
    std::abort();
  }
  return 0;
}
