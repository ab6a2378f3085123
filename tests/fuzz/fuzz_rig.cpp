// Any bytes as a rig file. What is read without an error must be valid, must be writable, and must be read again without an error.
#include "etendue/scene.h"
#include "exporters/rig/rig.h"
#include "importers/rig/rig_text.h"
#include "temporary_file.h"

namespace {

using namespace etendue;

ImportOptions small() {
  ImportOptions options;
  options.max_items = 10'000;
  options.need = Need::lights | Need::materials | Need::cameras | Need::meshes;  // pictures need not exist
  return options;
}

Result<Imported> read(std::string_view text) { return rig::read_rig_text(text, "fuzz.rig.json", "/no_such_folder", nullptr, small()); }

void stop(const char* why, const Diagnostics& diagnostics) {
  std::fprintf(stderr, "%s\n", why);
  for (const Diagnostic& d : diagnostics.all()) std::fprintf(stderr, "%s\n", to_string(d).c_str());
  std::abort();
}

bool names_files(const Scene& scene) {
  for (const Light& light : scene.lights)
    if (std::holds_alternative<PhotometricShape>(light.shape)) return true;
  return !scene.images.empty();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::TemporaryFile output("written.rig.json");
  const Result<Imported> imported = read(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!imported || imported->diagnostics.has_errors()) return 0;
  const Diagnostics found = validate(imported->scene);
  if (found.has_errors()) stop("read without an error, but not valid", found);
  if (names_files(imported->scene)) return 0;
  const std::filesystem::path& file = output.holding(data, 0);
  if (!make_rig_exporter()->write(imported->scene, file, {})) stop("valid, but not written", {});
  const Result<std::vector<std::byte>> bytes = read_file(file, std::uint64_t{1} << 32);
  if (!bytes) stop("written, but not there", {});
  const Result<Imported> again = read(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
  if (!again) stop("written, but no JSON", {});
  if (again->diagnostics.has_errors()) stop("written, but not read", again->diagnostics);
  return 0;
}
