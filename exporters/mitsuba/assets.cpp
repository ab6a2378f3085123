#include "assets.h"

#include "digest.h"
#include "etendue/io.h"
#include "ply.h"

#include <algorithm>
#include <system_error>

namespace etendue::mitsuba {
namespace {

constexpr std::size_t digest_digits = 40;

Error unwritable(const std::filesystem::path& path, const std::string& why) {
  return {"FILE_UNWRITABLE", "cannot write: " + why, {path.string(), 0, 0, {}}, {}, {}};
}

// KIND_DIGEST.EXTENSION, as add_file() makes it.
bool is_our_name(const std::string& name) {
  const std::size_t underscore = name.find('_');
  const std::size_t dot = name.rfind('.');
  if (underscore == std::string::npos || dot == std::string::npos || dot != underscore + 1 + digest_digits) return false;
  return name.find_first_not_of("0123456789abcdef", underscore + 1) == dot;
}

Status check_replaceable(const std::filesystem::path& folder) {
  std::error_code ec;
  if (!std::filesystem::exists(folder, ec)) return Done{};
  for (std::filesystem::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    if (!is_our_name(it->path().filename().string())) {
      return Error{"FOLDER_NOT_OURS",
                   "expected a folder that an earlier export wrote, found '" + it->path().filename().string() + "' in it",
                   {folder.string(), 0, 0, {}},
                   "move it away or give the scene file another name",
                   {}};
    }
  }
  if (ec) return unwritable(folder, ec.message());
  return Done{};
}

}  // namespace

AssetFolder::AssetFolder(const std::filesystem::path& scene_file)
    : folder_(scene_file.parent_path() / (scene_file.stem().string() + "_files")), staging_(folder_.string() + ".part") {}

AssetFolder::~AssetFolder() {
  std::error_code ec;
  std::filesystem::remove_all(staging_, ec);
}

Status AssetFolder::prepare() {
  std::error_code ec;
  if (names_.empty()) std::filesystem::remove_all(staging_, ec);
  std::filesystem::create_directories(staging_, ec);
  if (ec) return unwritable(staging_, ec.message());
  return Done{};
}

Result<std::string> AssetFolder::add_file(std::string_view kind, std::string_view extension, std::span<const std::byte> bytes) {
  const std::string name = std::string(kind) + '_' + digest_of(bytes) + std::string(extension);
  std::string reference = folder_.filename().string() + '/' + name;
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) return reference;
  if (Status ready = prepare(); !ready) return ready.error();
  if (Status written = write_file(staging_ / name, bytes); !written) return written.error();
  names_.push_back(name);
  return reference;
}

Result<std::string> AssetFolder::add_mesh(const Mesh& mesh) { return add_file("mesh", ".ply", to_ply(mesh)); }

Result<std::string> AssetFolder::add_picture(std::uint32_t width, std::uint32_t height, std::vector<float> rgb) {
  const std::string size = std::to_string(width) + 'x' + std::to_string(height);
  const std::string name = "picture_" + digest_of(digest_of(std::as_bytes(std::span(rgb))) + size) + ".exr";
  std::string reference = folder_.filename().string() + '/' + name;
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) return reference;
  if (Status ready = prepare(); !ready) return ready.error();
  Picture picture{width, height, {{"", 3, std::move(rgb)}}, {}, {}};
  if (Status written = write_exr(picture, staging_ / name); !written) return written.error();
  names_.push_back(name);
  return reference;
}

Result<std::string> AssetFolder::once(const std::string& recipe, const std::function<Result<std::string>()>& make) {
  if (const auto known = made_.find(recipe); known != made_.end()) return known->second;
  Result<std::string> reference = make();
  if (reference) made_.emplace(recipe, *reference);
  return reference;
}

Status AssetFolder::commit() {
  if (Status ours = check_replaceable(folder_); !ours) return ours;
  const std::filesystem::path older = folder_.string() + ".old";
  std::error_code ec;
  std::filesystem::remove_all(older, ec);
  const bool replaces = std::filesystem::exists(folder_, ec);
  if (replaces) std::filesystem::rename(folder_, older, ec);
  if (ec) return unwritable(folder_, ec.message());
  if (!names_.empty()) std::filesystem::rename(staging_, folder_, ec);
  if (ec) {
    std::error_code ignored;
    if (replaces) std::filesystem::rename(older, folder_, ignored);
    return unwritable(folder_, ec.message());
  }
  std::filesystem::remove_all(older, ec);
  return Done{};
}

std::vector<std::filesystem::path> AssetFolder::files() const {
  std::vector<std::filesystem::path> paths;
  paths.reserve(names_.size());
  for (const std::string& name : names_) paths.push_back(folder_ / name);
  return paths;
}

}  // namespace etendue::mitsuba
