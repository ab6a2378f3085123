#include "rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "reader.h"
#include "rig_text.h"

namespace etendue {
namespace rig {
namespace {

void read_top(Reader& reader, JsonValue root) {
  Diagnostics& d = reader.diagnostics;
  Fields fields(root, d);
  const JsonValue version = fields.require("etendue");
  if (version && !(version.is(JsonKind::number) && version.number() == 1)) {
    fail(d, version, "VERSION_UNKNOWN", "expected \"etendue\": 1, the only version of the format so far");
  }
  const Need need = reader.options.need;
  const JsonValue meshes = fields.find("meshes"), materials = fields.find("materials"), lights = fields.find("lights");
  const JsonValue objects = fields.find("objects"), camera = fields.find("camera"), cameras = fields.find("cameras");
  if (camera && cameras) d.error("KEYS_EXCLUSIVE", "expected \"camera\" or \"cameras\", found both", cameras.where_key());
  fields.finish();
  if (has(need, Need::meshes) || has(need, Need::lights)) {
    read_meshes(reader, meshes);
  } else {
    reader.stats.skipped_meshes += meshes.size();
  }
  if (has(need, Need::materials)) read_materials(reader, materials);
  if (has(need, Need::lights)) read_lights(reader, lights);
  read_objects(reader, objects);
  if (has(need, Need::cameras)) read_cameras(reader, camera, cameras);
}

void sort_by_place(Diagnostics& diagnostics) {
  std::vector<Diagnostic> all = diagnostics.all();
  const auto place = [](const Diagnostic& d) { return std::tie(d.where.line, d.where.column); };
  std::stable_sort(all.begin(), all.end(), [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
  diagnostics = {};
  for (Diagnostic& one : all) diagnostics.add(std::move(one));
}

}  // namespace

Result<Imported> read_rig_text(std::string_view text, const std::string& file, const std::filesystem::path& folder, const Registry* others,
                               const ImportOptions& options) {
  JsonLimits limits;
  limits.max_depth = options.max_depth;
  Result<JsonDocument> document = JsonDocument::parse(text, file, limits);
  if (!document) return document.error();

  Reader reader{folder, options, others, {}, {}, {}, {}, {}, {}, {}};
  for (const JsonValue duplicate : document->duplicate_keys()) {
    reader.diagnostics.error("KEY_DUPLICATE", fmt::format("the key \"{}\" stands here a second time", duplicate.key().substr(0, 60)),
                             duplicate.where_key());
  }
  read_top(reader, document->root());
  sort_by_place(reader.diagnostics);

  Imported imported{std::move(reader.scene), std::move(reader.diagnostics), reader.stats};
  imported.diagnostics.append(reader.foreign_diagnostics);
  imported.scene.file = file;
  imported.scene.format = "rig";
  return imported;
}

}  // namespace rig

namespace {

class RigImporter : public Importer {
 public:
  explicit RigImporter(const Registry& others) : others_(others) {}

  FormatInfo describe() const override {
    return {"rig", "Etendue rig", {".rig.json"}, "Lights in real units, a camera, materials and simple objects, as JSON."};
  }

  // A JSON object with the key "etendue" near its beginning.
  int sniff(std::span<const std::byte> head) const override {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    const std::size_t first = text.find_first_not_of(text.substr(0, 3) == "\xEF\xBB\xBF" ? "\xEF\xBB\xBF \t\r\n" : " \t\r\n");
    if (first == std::string_view::npos || text[first] != '{') return 0;
    constexpr std::string_view key = "\"etendue\"";
    const std::size_t found = text.find(key);
    if (found == std::string_view::npos) return 1;
    const std::size_t colon = text.find_first_not_of(" \t\r\n", found + key.size());
    return colon != std::string_view::npos && text[colon] == ':' ? 100 : 1;
  }

  Result<Imported> read(const std::filesystem::path& file, const ImportOptions& options) const override {
    const Result<std::vector<std::byte>> bytes = read_file(file, options.max_bytes);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    Result<Imported> imported = rig::read_rig_text(text, file.string(), file.parent_path(), &others_, options);
    if (imported) imported->stats.bytes_read += bytes->size();
    return imported;
  }

 private:
  const Registry& others_;
};

}  // namespace

std::unique_ptr<Importer> make_rig_importer(const Registry& others) { return std::make_unique<RigImporter>(others); }

}  // namespace etendue
