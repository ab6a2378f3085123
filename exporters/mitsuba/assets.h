// The folder NAME_files beside a scene file: every file is named after its content, so equal files are written once.
#pragma once

#include "etendue/picture.h"
#include "etendue/result.h"
#include "etendue/scene.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::mitsuba {

// Files are staged in a folder of their own; commit() puts it in place of an older one. What was not committed is removed.
class AssetFolder {
 public:
  // `scene_file`: "rig.xml" gives "rig_files".
  explicit AssetFolder(const std::filesystem::path& scene_file);
  ~AssetFolder();
  AssetFolder(const AssetFolder&) = delete;
  AssetFolder& operator=(const AssetFolder&) = delete;

  // Each returns the path that the scene file names: "rig_files/mesh_0123abcd.ply". Error: FILE_UNWRITABLE.
  Result<std::string> add_file(std::string_view kind, std::string_view extension, std::span<const std::byte> bytes);
  Result<std::string> add_mesh(const Mesh& mesh);
  // `rgb`: three numbers a pixel, row 0 at the top.
  Result<std::string> add_picture(std::uint32_t width, std::uint32_t height, std::vector<float> rgb);

  // The path that `make` gave for this recipe before, else what it gives now: what costs time to make is made once for all scene files
  // that share the folder.
  Result<std::string> once(const std::string& recipe, const std::function<Result<std::string>()>& make);

  // Errors: FILE_UNWRITABLE; FOLDER_NOT_OURS where a folder of that name holds files that this class does not write.
  Status commit();
  // The files in place after commit().
  std::vector<std::filesystem::path> files() const;

 private:
  Status prepare();

  std::filesystem::path folder_, staging_;
  std::vector<std::string> names_;
  std::map<std::string, std::string> made_;  // by recipe
};

}  // namespace etendue::mitsuba
