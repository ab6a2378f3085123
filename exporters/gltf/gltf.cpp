#include "gltf.h"

#include <exception>

#include "materials.h"
#include "package.h"
#include "scene_document.h"

namespace etendue {
namespace {

class GltfExporter final : public Exporter {
 public:
  explicit GltfExporter(gltf::LightShapes shapes) : shapes_(shapes) {}
  FormatInfo describe() const override {
    return {"gltf",
            "glTF 2.0",
            {".gltf", ".glb"},
            "Khronos' scene format, JSON or binary: documents read from it, with their materials in either model, and light rigs."};
  }

  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options) const override {
    try {
      if (!scene.carried.document) return write_built(scene, file, options);
      std::string_view text(reinterpret_cast<const char*>(scene.carried.document.data()), scene.carried.document.size());
      if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
      gltf::Document document{scene, text, gltf::Json::parse(text), {}, {}, {}, {}};
      document.now = document.before;
      gltf::write_changed_materials(document);
      if (shapes_ == gltf::LightShapes::emissive)
        document.losses.add("visible shapes of its lights", "left out: a document that was read from glTF is written as it stands");
      return write_files(document, file);
    } catch (const std::exception& e) {  // memory, and what the JSON library throws
      return Error{"WRITE_FAILED", std::string("the file cannot be written: ") + e.what(), {file.string(), 0, 0, {}}, {}, {}};
    }
  }

 private:
  Result<Exported> write_built(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options) const {
    Result<gltf::Built> built = gltf::document_of(scene, options.lit, shapes_);
    if (!built) return built.error();
    const SharedBytes& bytes = built->carrier.carried.document;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    gltf::Document document{built->carrier, text, gltf::Json::parse(text), {}, {}, {}, std::move(built->losses)};
    document.now = document.before;
    for (const auto& [place, image] : built->images) document.new_images.emplace(place, &built->carrier.images[image]);
    return write_files(document, file);
  }

  static Result<Exported> write_files(gltf::Document& document, const std::filesystem::path& file) {
    const bool binary = file.extension() == ".glb" || file.extension() == ".GLB";
    auto files = binary ? gltf::write_binary_file(document, file) : gltf::write_text_file(document, file);
    if (!files) return files.error();
    return Exported{std::move(*files), std::move(document.losses), {}};
  }

  gltf::LightShapes shapes_;
};

}  // namespace

std::unique_ptr<Exporter> make_gltf_exporter(gltf::LightShapes shapes) { return std::make_unique<GltfExporter>(shapes); }

}  // namespace etendue
