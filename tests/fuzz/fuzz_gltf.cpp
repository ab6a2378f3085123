// Any bytes as .gltf or .glb. What is read without an error must be valid.
#include "etendue/scene.h"
#include "importers/gltf/gltf.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace etendue;
  static const fuzz::TemporaryFile input("input.gltf");
  static const std::unique_ptr<Importer> importer = make_gltf_importer();
  ImportOptions options;
  options.max_items = 100'000;
  options.max_bytes = 1u << 20;
  const Result<Imported> imported = importer->read(input.holding(data, size), options);
  if (!imported || imported->diagnostics.has_errors()) return 0;
  const Diagnostics found = validate(imported->scene);
  if (!found.has_errors()) return 0;
  for (const Diagnostic& d : found.all()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
  std::abort();
}
