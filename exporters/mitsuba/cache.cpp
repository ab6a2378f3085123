#include "cache.h"

#include "digest.h"
#include "driver.h"
#include "etendue/io.h"

#include <pugixml.hpp>
#include <sstream>

namespace etendue::mitsuba {
namespace {

constexpr std::uint64_t largest_file = std::uint64_t{1} << 32;

// Replaces the names of files below `node` by digests of their content.
Status name_by_content(pugi::xml_node node, const std::filesystem::path& folder, Digests& known) {
  for (pugi::xml_node child : node.children()) {
    if (std::string_view(child.name()) == "string" && std::string_view(child.attribute("name").value()) == "filename") {
      const std::filesystem::path file = folder / child.attribute("value").value();
      auto digest = known.find(file);
      if (digest == known.end()) {
        Result<std::vector<std::byte>> bytes = read_file(file, largest_file);
        if (!bytes) return bytes.error();
        digest = known.emplace(file, digest_of(*bytes)).first;
      }
      child.attribute("value") = digest->second.c_str();
    }
    if (Status s = name_by_content(child, folder, known); !s) return s;
  }
  return Done{};
}

}  // namespace

Result<std::string> content_of(const std::filesystem::path& scene, Digests& known) {
  Result<std::vector<std::byte>> bytes = read_file(scene, largest_file);
  if (!bytes) return bytes.error();
  pugi::xml_document document;
  if (const pugi::xml_parse_result parsed = document.load_buffer(bytes->data(), bytes->size()); !parsed) {
    return Error{"MITSUBA_FAILED", std::string("expected an XML file: ") + parsed.description(), {scene.string(), 0, 0, {}}, {}, {}};
  }
  if (Status s = name_by_content(document, scene.parent_path(), known); !s) return s.error();
  std::ostringstream text;
  document.save(text);
  return digest_of(text.str());
}

std::string key_of(const Mitsuba& mitsuba, const MitsubaJob& job, const std::string& content) {
  static const std::string driver = digest_of(driver_script());
  std::ostringstream text;
  text << driver << ' ' << content << ' ' << job.samples << ' ' << job.seeds << ' ' << job.first_seed << ' ' << mitsuba.variant << ' '
       << mitsuba.version;
  return digest_of(text.str());
}

std::optional<Picture> PictureCache::find(const std::string& key) const {
  if (!folder_) return std::nullopt;
  const std::filesystem::path file = *folder_ / (key + ".exr");
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) return std::nullopt;
  Result<Picture> picture = read_exr(file);
  if (!picture || !picture->find("variance")) return std::nullopt;
  return std::move(*picture);
}

Status PictureCache::keep(const std::string& key, const Picture& picture) const {
  if (!folder_) return Done{};
  std::error_code ec;
  std::filesystem::create_directories(*folder_, ec);
  if (ec) return Error{"FILE_UNWRITABLE", "cannot make the cache: " + ec.message(), {folder_->string(), 0, 0, {}}, {}, {}};
  return write_exr(picture, *folder_ / (key + ".exr"));
}

}  // namespace etendue::mitsuba
