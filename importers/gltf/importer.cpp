#include "gltf.h"

#include <algorithm>
#include <cctype>
#include <exception>
#include <string_view>

#include "etendue/dialect.h"

#include "carried.h"
#include "check_data.h"
#include "nodes.h"

namespace etendue {
namespace {

class GltfImporter final : public Importer {
 public:
  explicit GltfImporter(GltfMaterials materials) : materials_(materials) {}

  FormatInfo describe() const override {
    return {"gltf", "glTF 2.0", {".gltf", ".glb"}, "Khronos' scene format, JSON or binary, with its light extensions"};
  }

  // GLB by its magic; JSON by the member that every glTF has, which need not be near the beginning.
  int sniff(std::span<const std::byte> head) const override {
    std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    if (text.starts_with("glTF")) return 100;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // not allowed, which reading says
    const auto first = std::find_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) == 0; });
    if (first == text.end() || *first != '{') return 0;
    const auto contains = [&](std::string_view key) { return text.find(key) != std::string_view::npos; };
    if (contains("\"asset\"") && contains("\"version\"")) return 90;
    return contains("\"bufferViews\"") || contains("\"accessors\"") || contains("\"extensionsUsed\"") ? 80 : 5;
  }

  Result<Imported> read(const std::filesystem::path& file, const ImportOptions& options) const override {
    try {
      auto asset = gltf::Asset::open(file, options);
      if (!asset) return asset.error();
      Imported imported;
      imported.scene.file = file.string();
      imported.scene.format = "gltf";
      if (options.need == Need::everything) gltf::check_data(**asset);
      gltf::name_unshown(**asset);
      gltf::Nodes nodes(**asset, imported.scene);
      nodes.read_default_scene();
      if (materials_ == GltfMaterials::all) nodes.read_every_material();
      if (const auto unitless = suspected_compat_lights((*asset)->model().asset.generator, imported.scene.lights))
        (*asset)->warning(unitless->code, unitless->text + "; " + unitless->hint, unitless->where.pointer);
      gltf::carry(**asset, imported.scene);
      imported.diagnostics = (*asset)->take_diagnostics();
      (*asset)->count_skipped();
      imported.stats = (*asset)->stats;
      return imported;
    } catch (const std::exception& e) {  // memory, and what libraries throw
      return Error{"READ_FAILED", std::string("the file cannot be read: ") + e.what(), {file.string(), 0, 0, ""}, {}, {}};
    }
  }

 private:
  GltfMaterials materials_;
};

}  // namespace

std::unique_ptr<Importer> make_gltf_importer(GltfMaterials materials) { return std::make_unique<GltfImporter>(materials); }

}  // namespace etendue
