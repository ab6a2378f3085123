#include "layer_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

#include "all_materials.h"
#include "importers/rig/fields.h"
#include "json_text.h"

namespace etendue::cli {
namespace {

namespace fs = std::filesystem;

class StackReader {
 public:
  StackReader(Session& session, const fs::path& file, const ImportOptions& options)
      : session_(session), folder_(file.parent_path()), options_(options) {}

  LayerStack read(JsonValue root) {
    Diagnostics& d = session_.diagnostics;
    rig::Fields fields(root, d);
    const JsonValue version = fields.require("etendue_layers");
    if (version && !(version.is(JsonKind::number) && version.number() == 1))
      rig::fail(d, version, "VERSION_UNKNOWN", "expected \"etendue_layers\": 1, the only version of the format so far");
    LayeredMaterial& material = stack_.material;
    material.name = rig::read_string(fields.find("name"), d).value_or("layers");
    material.normals = rig::read_choice<NormalBlend>(
                           fields.find("normals"),
                           {{"replace", NormalBlend::replace}, {"slopes", NormalBlend::slopes}, {"reoriented", NormalBlend::reoriented}}, d)
                           .value_or(material.normals);
    material.blend =
        rig::read_choice<LayerBlend>(fields.find("blend"), {{"parameters", LayerBlend::parameters}, {"colours", LayerBlend::colours}}, d)
            .value_or(material.blend);
    const JsonValue layers = fields.require("layers");
    fields.finish();
    if (layers && rig::is_array(layers, options_.max_items, d)) {
      if (layers.size() == 0) rig::fail(d, layers, "LAYERS_INVALID", "expected a layer at least");
      for (const JsonValue layer : layers) read_layer(layer);
    }
    return std::move(stack_);
  }

 private:
  void read_layer(JsonValue value) {
    Diagnostics& d = session_.diagnostics;
    rig::Fields fields(value, d);
    const JsonValue asset = fields.require("asset"), material = fields.find("material"), mask = fields.find("mask");
    MaterialLayer layer;
    layer.uv_scale = rig::read_number(fields.find("uv_scale"), 1e-6, 1e6, d).value_or(1);
    layer.opacity = rig::read_number(fields.find("opacity"), 0, 1, d).value_or(1);
    fields.finish();
    if (const auto name = rig::read_string(mask, d)) {
      stack_.images.push_back({(folder_ / *name).string(), {}, {}, *name});
      layer.mask = Texture{};
      layer.mask->image = static_cast<std::uint32_t>(stack_.images.size() - 1);
    }
    const auto name = rig::read_string(asset, d);
    const auto wanted = rig::read_string(material, d);
    if (!name) return;
    const Asset* found = asset_of(*name, asset);
    if (found == nullptr) return;
    const std::vector<Material>& all = found->materials;
    const auto named = std::find_if(all.begin(), all.end(), [&](const Material& m) { return !wanted || m.name == *wanted; });
    if (named == all.end() || (!wanted && all.size() != 1)) {
      std::string names;
      for (const Material& m : all) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", m.name);
      rig::fail(d, wanted ? material : asset, "MATERIAL_UNKNOWN",
                fmt::format("expected one of the materials of {}, {}", *name, all.empty() ? "which has none" : names),
                wanted ? rig::nearest_hint(*wanted, names_of(all)) : "name it by \"material\"");
      return;
    }
    layer.material = *named;
    stack_.material.layers.push_back(std::move(layer));
  }

  static std::vector<std::string_view> names_of(const std::vector<Material>& materials) {
    std::vector<std::string_view> names;
    names.reserve(materials.size());
    for (const Material& m : materials) names.emplace_back(m.name);
    return names;
  }

  struct Asset {
    std::vector<Material> materials;  // their textures are of the stack's images
  };
  // Read once, or nullptr.
  const Asset* asset_of(const std::string& name, JsonValue at) {
    if (const auto known = assets_.find(name); known != assets_.end()) return &known->second;
    Result<Imported> imported = read_all_materials(folder_ / name, options_);
    if (!imported) return refuse(at, imported.error());
    session_.diagnostics.append(imported->diagnostics);
    if (imported->diagnostics.has_errors()) return nullptr;
    const auto first = static_cast<std::uint32_t>(stack_.images.size());
    for (ImageRef& image : imported->scene.images) stack_.images.push_back(std::move(image));
    for (Material& material : imported->scene.materials)
      for_each_texture(material, [first](const char*, Texture& texture) { texture.image += first; });
    return &assets_.emplace(name, Asset{std::move(imported->scene.materials)}).first->second;
  }
  const Asset* refuse(JsonValue at, const Error& error) {
    rig::fail(session_.diagnostics, at, error.code, error.text, error.hint);
    return nullptr;
  }

  Session& session_;
  fs::path folder_;
  const ImportOptions& options_;
  LayerStack stack_;
  std::map<std::string, Asset> assets_;
};

}  // namespace

std::optional<LayerStack> read_layer_stack(Session& session, const std::string& file, const ImportOptions& options) {
  const auto bytes = read_file(file, options.max_bytes);
  if (!bytes) {
    session.diagnostics.add(to_diagnostic(bytes.error()));
    return std::nullopt;
  }
  const auto document = JsonDocument::parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file);
  if (!document) {
    session.diagnostics.add(to_diagnostic(document.error()));
    return std::nullopt;
  }
  for (const JsonValue duplicate : document->duplicate_keys())
    session.diagnostics.error("KEY_DUPLICATE", fmt::format("the key \"{}\" stands here a second time", duplicate.key().substr(0, 60)),
                              duplicate.where_key());
  LayerStack stack = StackReader(session, file, options).read(document->root());
  if (session.diagnostics.has_errors()) return std::nullopt;
  return stack;
}

}  // namespace etendue::cli
