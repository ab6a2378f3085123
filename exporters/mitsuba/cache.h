// Pictures of Mitsuba by what they were made from.
#pragma once

#include "etendue/picture.h"
#include "run.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace etendue::mitsuba {

// Digest of a scene file with every file name in it replaced by the digest of that file: where the files lie does not matter. Errors:
// FILE_UNREADABLE, MITSUBA_FAILED where the scene file is no XML. `known`: digests of files by path, read and added to.
using Digests = std::map<std::filesystem::path, std::string>;
Result<std::string> content_of(const std::filesystem::path& scene, Digests& known);

// Of content, samples, seeds, variant and version.
std::string key_of(const Mitsuba& mitsuba, const MitsubaJob& job, const std::string& content);

class PictureCache {
 public:
  explicit PictureCache(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}
  // A file that cannot be read counts as missing.
  std::optional<Picture> find(const std::string& key) const;
  Status keep(const std::string& key, const Picture& picture) const;

 private:
  std::optional<std::filesystem::path> folder_;
};

}  // namespace etendue::mitsuba
