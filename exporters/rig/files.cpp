#include "writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace etendue::rig {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_copy = std::uint64_t{1} << 32;

// The importer's rule, from the other side: below the rig's folder, and nothing in the name that it refuses.
std::optional<std::string> name_inside(const fs::path& rig, const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = fs::weakly_canonical(rig.parent_path().empty() ? fs::path(".") : rig.parent_path(), ignored);
  std::string name = fs::weakly_canonical(file, ignored).lexically_relative(folder).generic_string();
  const bool outside = name.empty() || name == "." || name == ".." || name.compare(0, 3, "../") == 0;
  if (outside || name.find_first_of("\\:") != std::string::npos) return {};
  return name;
}

std::string plain(const std::string& name) {
  std::string text = name;
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return text;
}

// NAME_files of NAME.rig.json.
std::string folder_beside(const fs::path& rig) {
  std::string name = rig.filename().string();
  for (const std::string_view extension : {".json", ".rig"})
    if (name.size() > extension.size() && name.compare(name.size() - extension.size(), extension.size(), extension) == 0)
      name.erase(name.size() - extension.size());
  return plain(name) + "_files";
}

const char* extension_of(const SharedBytes& bytes) {
  const auto begins = [&](std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(), [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  };
  if (begins("\x89PNG")) return ".png";
  if (begins("\xFF\xD8")) return ".jpg";
  if (begins("\x76\x2F\x31\x01")) return ".exr";
  if (begins("#?")) return ".hdr";
  return ".image";
}

Result<std::string> put_beside(Writer& writer, const std::string& origin, const std::string& wanted, std::span<const std::byte> bytes) {
  const std::string folder = folder_beside(writer.file);
  std::string name = fmt::format("{}/{}_{}", folder, writer.files_beside.size(), plain(wanted));
  const fs::path target = writer.file.parent_path() / name;
  std::error_code failure;
  fs::create_directories(target.parent_path(), failure);
  if (failure)
    return Error{"FILE_UNWRITABLE", "cannot make the folder: " + failure.message(), {target.parent_path().string(), 0, 0, {}}, {}, {}};
  const Status written = write_file(target, bytes);
  if (!written) return written.error();
  writer.files_beside.push_back(target);
  writer.placed[origin] = name;
  return name;
}

}  // namespace

Result<std::string> place_file(Writer& writer, const std::string& file) {
  if (const std::optional<std::string> name = name_inside(writer.file, file)) return *name;
  const auto known = writer.placed.find(file);
  if (known != writer.placed.end()) return known->second;
  const Result<std::vector<std::byte>> bytes = read_file(file, largest_copy);
  if (!bytes) return bytes.error();
  return put_beside(writer, file, fs::path(file).filename().string(), *bytes);
}

Result<std::string> place_image(Writer& writer, std::uint32_t image) {
  const ImageRef& ref = writer.scene.images[image];
  if (!ref.embedded) return place_file(writer, ref.file);
  const std::string origin = fmt::format("image {}", image);
  const auto known = writer.placed.find(origin);
  if (known != writer.placed.end()) return known->second;
  return put_beside(writer, origin, (ref.name.empty() ? "image" : ref.name) + extension_of(ref.embedded), ref.embedded.bytes());
}

Result<std::string> place_photometry(Writer& writer, const PhotometricShape& shape) {
  if (!shape.embedded) return place_file(writer, shape.file);
  // Every edition of LM-63 has a line "TILT=...", EULUMDAT has none.
  const std::string_view text(reinterpret_cast<const char*>(shape.embedded.data()), shape.embedded.size());
  const std::string name = text.find("TILT=") != std::string_view::npos ? "light.ies" : "light.ldt";
  return put_beside(writer, fmt::format("photometry {}", writer.files_beside.size()), name, shape.embedded.bytes());
}

}  // namespace etendue::rig
