#include "gltf.h"

#include <exception>

#include "materials.h"
#include "package.h"

namespace etendue {
namespace {

class GltfExporter final : public Exporter {
 public:
  FormatInfo describe() const override {
    return {"gltf",
            "glTF 2.0",
            {".gltf", ".glb"},
            "Khronos' scene format, JSON or binary: documents read from it, with their materials in either model."};
  }

  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions&) const override {
    const SharedBytes& carried = scene.carried.document;
    if (!carried)
      return Error{"FORMAT_UNSUPPORTED",
                   "only a scene that was read from glTF with all that it carries can be written as glTF",
                   {scene.file, 0, 0, {}},
                   {},
                   {}};
    try {
      std::string_view text(reinterpret_cast<const char*>(carried.data()), carried.size());
      if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
      gltf::Document document{scene, text, gltf::Json::parse(text), {}, {}, {}, {}};
      document.now = document.before;
      gltf::write_changed_materials(document);
      const bool binary = file.extension() == ".glb" || file.extension() == ".GLB";
      auto files = binary ? gltf::write_binary_file(document, file) : gltf::write_text_file(document, file);
      if (!files) return files.error();
      return Exported{std::move(*files), std::move(document.losses), {}};
    } catch (const std::exception& e) {  // memory, and what the JSON library throws
      return Error{"WRITE_FAILED", std::string("the file cannot be written: ") + e.what(), {file.string(), 0, 0, {}}, {}, {}};
    }
  }
};

}  // namespace

std::unique_ptr<Exporter> make_gltf_exporter() { return std::make_unique<GltfExporter>(); }

}  // namespace etendue
