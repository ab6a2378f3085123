// Reads every photometric file that standard input names, a line each, and prints what its reading took from the heap at most as a line of
// JSON: for the script `photometry`.
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "counted_heap.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"

int main() {
  using namespace etendue;
  for (std::string name; std::getline(std::cin, name);) {
    const Result<std::vector<std::byte>> bytes = read_file(name, std::size_t{1} << 30);
    if (!bytes) {
      std::cerr << bytes.error().text << '\n';
      return 1;
    }
    std::string code;  // of the error
    const std::size_t heap = test::peak_heap_of([&] {
      const Result<PhotometricFile> file = name.ends_with(".ldt") ? read_eulumdat(*bytes, name) : read_ies(*bytes, name);
      if (!file) code = file.error().code;
    });
    const nlohmann::json line = {{"file", name}, {"bytes", bytes->size()}, {"heap", heap}, {"error", code}};
    std::cout << line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) << '\n';
  }
}
