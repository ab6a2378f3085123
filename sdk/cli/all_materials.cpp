#include "all_materials.h"

#include <memory>

#include "importers/gltf/gltf.h"

namespace etendue::cli {

Result<Imported> read_all_materials(const std::filesystem::path& file, ImportOptions options) {
  static const std::unique_ptr<Importer> whole = make_gltf_importer(GltfMaterials::all);
  const auto importer = importers().importer_for(file);
  if (!importer) return importer.error();
  options.need = Need::materials | Need::images;
  const bool is_gltf = (*importer)->describe().id == whole->describe().id;
  return (is_gltf ? whole.get() : *importer)->read(file, options);
}

}  // namespace etendue::cli
