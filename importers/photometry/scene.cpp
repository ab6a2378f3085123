#include "scene.h"

#include <algorithm>

namespace etendue::photometric {

namespace fs = std::filesystem;

PhotometricOptions with_neighbours(PhotometricOptions options, const fs::path& file, std::uint64_t max_bytes) {
  options.tilt_file = [folder = file.parent_path(), max_bytes](const std::string& name) -> Result<std::vector<std::byte>> {
    const bool plain = std::none_of(name.begin(), name.end(), [](char c) { return c == '/' || c == '\\' || c == ':'; });
    if (!plain || name == "." || name == "..")
      return Error{"PATH_REFUSED", "expected the name of a file in the same folder, found a path", {name, 0, 0, {}}, {}, {}};
    return read_file(folder / name, max_bytes);
  };
  return options;
}

Result<Imported> read_scene(const fs::path& file, const ImportOptions& options, const char* format, ReadPhotometric* read) {
  const Result<std::vector<std::byte>> bytes = read_file(file, options.max_bytes);
  if (!bytes) return bytes.error();
  Result<PhotometricFile> read_in = read(*bytes, file.string(), with_neighbours({}, file, options.max_bytes));
  if (!read_in) return read_in.error();
  Imported imported;
  imported.scene.file = file.string();
  imported.scene.format = format;
  Light light;
  light.name = file.stem().string();
  light.shape =
      PhotometricShape{file.generic_string(), {}, std::make_shared<const IntensityDistribution>(std::move(read_in->distribution))};
  imported.scene.lights.push_back(std::move(light));
  imported.diagnostics = std::move(read_in->diagnostics);
  imported.stats.bytes_read = bytes->size();
  return imported;
}

}  // namespace etendue::photometric
