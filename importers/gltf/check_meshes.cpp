// Meshes: attributes and what they hold, indices, morph targets, and whether a material finds what it needs.
#include <fmt/format.h>

#include <algorithm>

#include "attributes.h"
#include "checks.h"

namespace etendue::gltf {
namespace {

constexpr const char* set_attributes[] = {"COLOR", "JOINTS", "TEXCOORD", "WEIGHTS"};

struct Sets {
  int count = 0, last = -1;
};
struct Attributes {
  std::map<std::string, Sets> sets;
  bool has_position = false, has_normal = false, has_tangent = false;
};

class PrimitiveCheck {
 public:
  PrimitiveCheck(Checks& checks, const Json& primitive, const Path& path)
      : checks_(checks),
        findings_(checks.findings),
        primitive_(primitive),
        path_(path),
        quantised_(checks.declares("KHR_mesh_quantization")) {}

  void run() {
    const Path attributes = path_ / "attributes";
    check_names(attributes);
    for (const auto& [name, value] : object_at(primitive_, "attributes").items()) check_attribute(name, value, attributes / name);
    check_indices(path_ / "indices");
    check_count();
    check_material(path_ / "material");
    check_targets();
    check_draco();
  }

 private:
  void check_names(const Path& path) {
    for (const auto& [name, value] : object_at(primitive_, "attributes").items()) {
      const auto semantic = semantic_of(name);
      if (!semantic) {
        findings_.error("MESH_PRIMITIVE_INVALID_ATTRIBUTE",
                        fmt::format("glTF has no attribute \"{}\"; one of an application begins with \"_\"", name), path / name);
        continue;
      }
      found_.has_position = found_.has_position || name == "POSITION";
      found_.has_normal = found_.has_normal || name == "NORMAL";
      found_.has_tangent = found_.has_tangent || name == "TANGENT";
      if (semantic->set < 0) continue;
      Sets& sets = found_.sets[semantic->base];
      ++sets.count;
      sets.last = std::max(sets.last, semantic->set);
    }
    if (object_at(primitive_, "attributes").empty()) return;
    if (!found_.has_position) findings_.warning("MESH_PRIMITIVE_NO_POSITION", "without POSITION there is nothing to see", path);
    if (found_.has_tangent && !found_.has_normal)
      findings_.warning("MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL", "a TANGENT means nothing without a NORMAL", path / "TANGENT");
    for (const char* base : set_attributes) {
      Sets& sets = found_.sets[base];
      if (sets.last + 1 == sets.count) continue;
      findings_.error("MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
                      fmt::format("expected {0}_0 to {0}_{1} without gaps, found {2} of them", base, sets.last, sets.count), path);
      sets.count = 0;
    }
    if (found_.sets["JOINTS"].count != found_.sets["WEIGHTS"].count)
      findings_.error(
          "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
          fmt::format("expected as many WEIGHTS as JOINTS, found {} and {}", found_.sets["WEIGHTS"].count, found_.sets["JOINTS"].count),
          path);
  }

  // What holds for attributes of the primitive and of its targets alike.
  void check_vertex_data(const std::string& name, std::int64_t index, const Accessor& accessor, Role role, const Path& path) {
    use_accessor(checks_, index, Usage::vertices, path);
    use_view(checks_, accessor.view, Usage::vertices, path);
    if (name == "POSITION" && !accessor.has_bounds)
      findings_.error("MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", fmt::format("expected min and max of accessor {}", index), path);
    const auto semantic = semantic_of(name);
    const auto* formats = semantic ? formats_of(semantic->base, role, quantised_) : nullptr;
    if (formats != nullptr && std::find(formats->begin(), formats->end(), accessor.format) == formats->end())
      findings_.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", format_expected(accessor.format, *formats), path);
    if (formats == nullptr && accessor.format.component == 5125)
      findings_.error("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT", "attributes are never UNSIGNED_INT", path);
    View* view = checks_.records.view(accessor.view);
    const bool tight = view != nullptr && view->stride == 0;
    if (accessor.offset % 4 != 0 || (tight && element_bytes(accessor.format) % 4 != 0))
      findings_.error("MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "every element of an attribute begins at a multiple of 4 bytes", path);
    if (tight && view->vertex_accessors.insert(index).second && view->vertex_accessors.size() > 1)
      findings_.error("MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
                      fmt::format("bufferView {} holds several attributes: it needs a byteStride", accessor.view), path);
  }

  void check_attribute(const std::string& name, const Json& value, const Path& path) {
    const std::int64_t index = value.is_number_integer() ? index_of(object_at(primitive_, "attributes"), name.c_str()) : -1;
    const Accessor* accessor = checks_.records.accessor(index);
    if (accessor == nullptr) return;
    check_vertex_data(name, index, *accessor, Role::vertex, path);
    if (vertices_ == 0) {
      vertices_ = accessor->count;
    } else if (vertices_ != accessor->count) {
      findings_.error("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", fmt::format("expected {} vertices, found {}", vertices_, accessor->count),
                      path);
    }
  }

  void check_indices(const Path& path) {
    const std::int64_t index = index_of(primitive_, "indices");
    const Accessor* accessor = checks_.records.accessor(index);
    count_ = vertices_;
    if (accessor == nullptr) return;
    count_ = accessor->count;
    use_accessor(checks_, index, Usage::indices, path);
    use_view(checks_, accessor->view, Usage::indices, path);
    if (const View* view = checks_.records.view(accessor->view); view != nullptr && view->stride != 0)
      findings_.error("MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", "indices lie in a view without byteStride", path);
    static const std::vector<Format> formats = {{Shape::scalar, 5121}, {Shape::scalar, 5123}, {Shape::scalar, 5125}};
    if (std::find(formats.begin(), formats.end(), accessor->format) == formats.end())
      findings_.error("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", format_expected(accessor->format, formats), path);
  }

  void check_count() {
    const std::uint64_t mode = primitive_.contains("mode") ? uint_of(primitive_, "mode").value_or(7) : 4;
    const bool bad = mode == 1                ? count_ % 2 != 0
                     : mode == 2 || mode == 3 ? count_ < 2
                     : mode == 4              ? count_ % 3 != 0
                     : mode == 5 || mode == 6 ? count_ < 3
                                              : false;
    if (count_ != 0 && bad)
      findings_.warning("MESH_PRIMITIVE_INCOMPATIBLE_MODE",
                        fmt::format("{} vertices are no whole number of primitives of mode {}", count_, mode), path_);
  }

  // Every textureInfo below an object, in extensions as well.
  void collect_texcoords(const Json& object, std::vector<std::uint64_t>& sets) const {
    for (const auto& [key, value] : object.items()) {
      if (!value.is_object() || key == "extras") continue;
      if (std::string_view(key).ends_with("Texture")) {
        sets.push_back(uint_of(value, "texCoord").value_or(0));
        const Json& transform = object_at(object_at(value, "extensions"), "KHR_texture_transform");
        if (const auto other = uint_of(transform, "texCoord")) sets.push_back(*other);
      } else if (!std::string_view(key).starts_with("KHR_") || checks_.declares(key)) {
        collect_texcoords(value, sets);
      }
    }
  }

  void check_material(const Path& path) {
    const Json& materials = array_at(checks_.root, "materials");
    const std::int64_t index = index_of(primitive_, "material");
    const Json* material =
        index >= 0 && static_cast<std::size_t>(index) < materials.size() ? &materials[static_cast<std::size_t>(index)] : nullptr;
    bool wants_tangents = false;
    if (material != nullptr && material->is_object()) {
      std::vector<std::uint64_t> sets;
      collect_texcoords(*material, sets);
      check_texcoords(sets, index, path);
      const Json& extensions = object_at(*material, "extensions");
      const bool has_normal_texture = !object_at(*material, "normalTexture").empty();
      wants_tangents = has_normal_texture ||
                       (checks_.declares("KHR_materials_anisotropy") &&
                        !object_at(object_at(extensions, "KHR_materials_anisotropy"), "anisotropyTexture").empty()) ||
                       (checks_.declares("KHR_materials_clearcoat") &&
                        !object_at(object_at(extensions, "KHR_materials_clearcoat"), "clearcoatNormalTexture").empty());
      if (wants_tangents && !(found_.has_normal && found_.has_tangent)) {
        if (has_normal_texture) {
          findings_.warning("MESH_PRIMITIVE_GENERATED_TANGENT_SPACE", "tangents are missing: programs make up different ones", path);
        } else {
          findings_.error("MESH_PRIMITIVE_NO_TANGENT_SPACE", "the material needs tangents, and nothing says which", path);
        }
      }
    }
    if (found_.has_tangent && !wants_tangents) {
      const Path attributes = path_ / "attributes";
      findings_.note("UNUSED_MESH_TANGENT", "the material does not use tangents", attributes / "TANGENT");
    }
    check_variants();
  }

  void check_texcoords(std::vector<std::uint64_t>& sets, std::int64_t material, const Path& path) {
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    for (const std::uint64_t set : sets)
      if (set >= static_cast<std::uint64_t>(found_.sets["TEXCOORD"].count))
        findings_.error("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", fmt::format("material {} needs TEXCOORD_{}", material, set), path);
  }

  // KHR_materials_variants: one material for a variant.
  void check_variants() {
    if (!checks_.declares("KHR_materials_variants")) return;
    const Path extensions = path_ / "extensions", extension = extensions / "KHR_materials_variants", path = extension / "mappings";
    const Json& materials = array_at(checks_.root, "materials");
    const Json& mappings = array_at(object_at(object_at(primitive_, "extensions"), "KHR_materials_variants"), "mappings");
    std::set<Json> seen;
    for (std::size_t i = 0; i < mappings.size(); ++i) {
      const Path mapping = path / i, variants = mapping / "variants";
      const Json& list = array_at(mappings[i], "variants");
      for (std::size_t k = 0; k < list.size(); ++k)
        if (!seen.insert(list[k]).second)
          findings_.error("KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", fmt::format("variant {} has a material already", shown(list[k])),
                          variants / k);
      const std::int64_t index = index_of(mappings[i], "material");
      if (index < 0 || static_cast<std::size_t>(index) >= materials.size()) continue;
      std::vector<std::uint64_t> sets;
      collect_texcoords(materials[static_cast<std::size_t>(index)], sets);
      check_texcoords(sets, index, mapping / "material");
    }
  }

  void check_targets() {
    const Path path = path_ / "targets";
    const Json& targets = array_at(primitive_, "targets");
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Path here = path / i;
      if (!targets[i].is_object()) continue;
      for (const auto& [name, value] : targets[i].items()) {
        const Path place = here / name;
        const auto semantic = semantic_of(name);
        if (!semantic || (!semantic->is_custom() && formats_of(semantic->base, Role::morph_target, true) == nullptr))
          findings_.error("MESH_PRIMITIVE_INVALID_ATTRIBUTE", fmt::format("\"{}\" cannot be morphed", name), place);
        const std::int64_t index = index_of(targets[i], name.c_str());
        const Accessor* accessor = checks_.records.accessor(index);
        if (accessor == nullptr) continue;
        const Accessor* base = checks_.records.accessor(index_of(object_at(primitive_, "attributes"), name.c_str()));
        if (base == nullptr) {
          findings_.error("MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", fmt::format("the primitive has no {} to morph", name), place);
        } else if (base->count != accessor->count) {
          findings_.error("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
                          fmt::format("expected {} vertices, found {}", base->count, accessor->count), place);
        }
        check_vertex_data(name, index, *accessor, Role::morph_target, place);
      }
    }
  }

  void check_draco() {
    const Path extensions = path_ / "extensions", path = extensions / "KHR_draco_mesh_compression", attributes = path / "attributes";
    const Json& draco = object_at(object_at(primitive_, "extensions"), "KHR_draco_mesh_compression");
    if (draco.empty()) return;
    use_view(checks_, index_of(draco, "bufferView"), Usage::other, path / "bufferView");
    for (const auto& [name, value] : object_at(draco, "attributes").items()) {
      if (!uint_of(object_at(draco, "attributes"), name.c_str()))
        findings_.error("TYPE_MISMATCH", fmt::format("expected an attribute's id, found {}", shown(value)), attributes / name);
      if (!object_at(primitive_, "attributes").contains(name))
        findings_.error("UNRESOLVED_REFERENCE", fmt::format("the primitive has no attribute {}", name), attributes / name);
    }
  }

  Checks& checks_;
  Findings& findings_;
  const Json& primitive_;
  const Path& path_;
  bool quantised_;
  Attributes found_;
  std::uint64_t vertices_ = 0, count_ = 0;
};

void check_mesh(Checks& checks, const Json& mesh, const Path& path) {
  const Path primitives = path / "primitives";
  const Json& list = array_at(mesh, "primitives");
  std::size_t targets = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t here = array_at(list[i], "targets").size();
    const Path primitive = primitives / i;
    if (i == 0) {
      targets = here;
    } else if (here != targets) {
      checks.findings.error("MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", fmt::format("expected {} targets, found {}", targets, here),
                            here > 0 ? primitive / "targets" : primitive);
    }
  }
  const std::size_t weights = array_at(mesh, "weights").size();
  if (weights != 0 && !list.empty() && weights != targets)
    checks.findings.error("MESH_INVALID_WEIGHTS_COUNT", fmt::format("{} weights for {} targets", weights, targets), path / "weights");
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].is_object()) {
      const Path primitive = primitives / i;
      PrimitiveCheck(checks, list[i], primitive).run();
    }
}

}  // namespace

void check_meshes(Checks& checks) {
  const Path root, path = root / "meshes";
  const Json& meshes = array_at(checks.root, "meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i) check_mesh(checks, meshes[i], path / i);
}

}  // namespace etendue::gltf
