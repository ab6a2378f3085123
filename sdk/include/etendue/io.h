// Importers and exporters as values, and the registry a program fills with them.
#pragma once

#include "etendue/result.h"
#include "etendue/scene.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

// What the caller wants to know; what is not asked for is not read.
// `carried`: what the scene has no place for (Scene::carried).
enum class Need : unsigned { lights = 1, materials = 2, cameras = 4, meshes = 8, images = 16, carried = 32, everything = 63 };
constexpr Need operator|(Need a, Need b) { return static_cast<Need>(static_cast<unsigned>(a) | static_cast<unsigned>(b)); }
constexpr bool has(Need set, Need one) { return (static_cast<unsigned>(set) & static_cast<unsigned>(one)) != 0; }

struct FormatInfo {
  std::string id;                       // "gltf"
  std::string name;                     // "glTF 2.0"
  std::vector<std::string> extensions;  // lower case, with the dot; the longest match wins: ".rig.json" before ".json"
  std::string description;              // one sentence
};

// A limit that is hit is the error LIMIT_EXCEEDED, which names the limit by its name here. The command sets it by --limit NAME=NUMBER.
struct ImportOptions {
  Need need = Need::everything;
  bool tolerant = false;                               // a defect with a harmless repair is repaired, and a warning; else an error
  std::uint64_t max_bytes = std::uint64_t{1} << 32;    // of one input file
  std::size_t max_items = 10'000'000;                  // of one array (vertices, indices, nodes); of all together 8 x
  int max_depth = 256;                                 // nesting
  std::uint64_t max_pixels = std::uint64_t{1} << 28;   // of one picture
  std::uint64_t max_decoded = std::uint64_t{1} << 32;  // bytes that compressed meshes and data URIs of one asset become
  std::uint64_t max_memory = std::uint64_t{1} << 34;   // bytes that one asset takes in all
};

// What reading did, for --stats. Files are mapped, so bytes that nobody looked at were not read: they count as skipped.
struct Stats {
  std::uint64_t bytes_read = 0;
  std::uint64_t skipped_bytes = 0;
  std::uint64_t images_decoded = 0;
  std::uint64_t skipped_meshes = 0;
  std::uint64_t skipped_images = 0;
};

// A scene may come with errors in its diagnostics: then it is what could be read of a bad file, and must not be used further.
struct Imported {
  Scene scene;
  Diagnostics diagnostics;
  Stats stats;
};

class Importer {
 public:
  virtual ~Importer() = default;
  virtual FormatInfo describe() const = 0;
  // 0 (certainly not) to 100 (certainly) from the first bytes of a file.
  virtual int sniff(std::span<const std::byte> head) const = 0;
  virtual Result<Imported> read(const std::filesystem::path& file, const ImportOptions& options) const = 0;
};

// One thing that the output does not say, or says otherwise.
struct Loss {
  std::string what;    // "light 'key': range 8 m"
  std::string effect;  // "brighter beyond 4 m, up to +100 % at 8 m"
};
struct LossReport {
  std::vector<Loss> losses;
  void add(std::string what, std::string effect) { losses.push_back({std::move(what), std::move(effect)}); }
};

struct ExportOptions {
  int max_depth = 2;                        // of Mitsuba's path integrator: 2 is direct light
  std::uint32_t width = 512, height = 512;  // of the picture
  std::uint32_t camera = 0;
  std::uint32_t samples = 1024;    // written as the default of $spp
  std::vector<std::uint32_t> lit;  // lights that emit, by index; empty: all. The others keep their shapes and are black.
};
struct Exported {
  std::vector<std::filesystem::path> files;  // the named one first
  LossReport losses;
  Diagnostics diagnostics;
};

class Exporter {
 public:
  virtual ~Exporter() = default;
  virtual FormatInfo describe() const = 0;
  // The file and whatever stands beside it appear whole or not at all.
  virtual Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options) const = 0;
};

class Registry {
 public:
  void add(std::unique_ptr<Importer> importer) { importers_.push_back(std::move(importer)); }
  void add(std::unique_ptr<Exporter> exporter) { exporters_.push_back(std::move(exporter)); }

  // By content first, then by extension. Errors: FILE_UNREADABLE, FORMAT_UNKNOWN (naming what is known).
  Result<const Importer*> importer_for(const std::filesystem::path& file) const;
  // By extension, the longest match. Error: FORMAT_UNKNOWN.
  Result<const Exporter*> exporter_for(const std::filesystem::path& file) const;

  const std::vector<std::unique_ptr<Importer>>& importers() const { return importers_; }
  const std::vector<std::unique_ptr<Exporter>>& exporters() const { return exporters_; }

 private:
  std::vector<std::unique_ptr<Importer>> importers_;
  std::vector<std::unique_ptr<Exporter>> exporters_;
};

// Long work reports here and asks whether to go on.
class Progress {
 public:
  virtual ~Progress() = default;
  // `fraction` of `what`, 0 to 1, never falling for the same `what`. Called from one thread at a time. False: stop as soon as possible.
  virtual bool report(std::string_view what, double fraction) = 0;
};

// Reads a whole file. Errors: FILE_UNREADABLE, FILE_TOO_LARGE.
Result<std::vector<std::byte>> read_file(const std::filesystem::path& file, std::uint64_t max_bytes);

// Writes beside the file and renames, so that it appears whole or not at all. Error: FILE_UNWRITABLE.
Status write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace etendue
