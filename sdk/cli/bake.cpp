// etendue bake: layers of materials as one set of textures, with a glTF square that shows them.
#include "bake.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "comparison_text.h"
#include "layer_stack.h"
#include "limits.h"

namespace etendue::cli {
namespace {

struct Options {
  std::string layers, out, size = "1024x1024";
  int bits = 8;
  unsigned threads = 0;
  bool force = false;
  ImportOptions import;
};

// A square of 1 m in the XY plane, seen from +Z, uv (0, 0) at its upper left: something to show the material on. Of each corner the place,
// normal, tangent with the sign of its bitangent (+Y is up in a normal map), uv.
constexpr std::array<float, 48> square{-0.5f, 0.5f,  0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0.5f, 0.5f,  0, 0, 0, 1, 1, 0, 0, 1, 1, 0,
                                       -0.5f, -0.5f, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0.5f, -0.5f, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1};
constexpr std::array<std::uint16_t, 6> square_triangles{0, 2, 1, 1, 2, 3};

std::vector<std::byte> square_bytes() {
  const auto vertices = std::as_bytes(std::span(square));
  const auto triangles = std::as_bytes(std::span(square_triangles));
  std::vector<std::byte> bytes(vertices.begin(), vertices.end());
  bytes.insert(bytes.end(), triangles.begin(), triangles.end());
  return bytes;
}

// What a document says of it, buffers and the views of them.
constexpr const char* square_document = R"({
  "scene": 0,
  "scenes": [{"nodes": [0]}],
  "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3}, "indices": 4, "material": 0}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0]},
    {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 24, "componentType": 5126, "count": 4, "type": "VEC4"},
    {"bufferView": 0, "byteOffset": 40, "componentType": 5126, "count": 4, "type": "VEC2"},
    {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
  "bufferViews": [
    {"buffer": 0, "byteLength": 192, "byteStride": 48, "target": 34962},
    {"buffer": 0, "byteOffset": 192, "byteLength": 12, "target": 34963}],
  "buffers": [{"uri": "square.bin", "byteLength": 204}]})";
static_assert(sizeof(square) == 192 && sizeof(square_triangles) == 12);

Json gltf_of(const BakedMaterial& baked) {
  const Material& m = baked.material;
  const auto& model = std::get<MetalRough>(m.model);
  Json images = Json::array(), textures = Json::array(), extensions = Json::object(), used = Json::array();
  for (std::size_t i = 0; i < baked.images.size(); ++i) {
    images.push_back({{"uri", std::filesystem::path(baked.images[i].file).filename().string()}});
    textures.push_back({{"source", i}});
  }
  const auto reference = [](const Texture& texture) { return Json{{"index", texture.image}}; };
  Json material{
      {"name", m.name},
      {"pbrMetallicRoughness",
       {{"baseColorTexture", reference(*m.base_colour_texture)}, {"metallicRoughnessTexture", reference(*m.metal_rough_texture)}}}};
  if (m.normal_map) material["normalTexture"] = reference(m.normal_map->texture);
  if (m.occlusion) material["occlusionTexture"] = reference(m.occlusion->texture);
  if (m.double_sided) material["doubleSided"] = true;
  const auto extend = [&](const char* name, Json value) {
    extensions[name] = std::move(value);
    used.push_back(name);
  };
  if (m.emissive_texture) {
    material["emissiveTexture"] = reference(*m.emissive_texture);
    material["emissiveFactor"] = {1, 1, 1};
    extend("KHR_materials_emissive_strength", {{"emissiveStrength", m.emissive.x}});
  }
  if (model.ior != MetalRough{}.ior) extend("KHR_materials_ior", {{"ior", model.ior}});
  if (m.lobes.specular) extend("KHR_materials_specular", {{"specularColorTexture", reference(*m.lobes.specular->colour_texture)}});
  if (!used.empty()) material["extensions"] = std::move(extensions);
  Json document{{"asset", {{"version", "2.0"}, {"generator", "etendue " ETENDUE_VERSION}}}};
  if (!used.empty()) document["extensionsUsed"] = std::move(used);
  document["images"] = std::move(images);
  document["textures"] = std::move(textures);
  document["materials"] = Json::array({std::move(material)});
  document.update(Json::parse(square_document));
  return document;
}

int run_bake(const Common& common, const Options& options) {
  Session session("bake", common);
  const std::filesystem::path folder = options.out;
  if (!options.force && std::filesystem::exists(folder))
    return session.fail({"USAGE", fmt::format("{} is there already", options.out), {}, "--force writes into it", {}});
  const Result<Size> size = parse_size(options.size);
  if (!size) return session.fail(size.error());
  const auto stack = read_layer_stack(session, options.layers, options.import);
  if (!stack) return session.finish(exit_bad_input);
  std::error_code made;
  std::filesystem::create_directories(folder, made);
  if (made)
    return session.fail({"FILE_UNWRITABLE", fmt::format("cannot make the folder: {}", made.message()), {options.out, 0, 0, {}}, {}, {}});
  Bar bar(session);
  const auto baked = bake_layers(stack->material, stack->images, {size->width, size->height, folder, options.bits, options.threads, &bar});
  if (!baked) return session.fail(baked.error());
  if (const Status written = write_file(folder / "square.bin", square_bytes()); !written) return session.fail(written.error());
  const std::filesystem::path gltf = folder / "material.gltf";
  const std::string text = gltf_of(*baked).dump(2) + "\n";
  if (const Status written = write_file(gltf, std::as_bytes(std::span(text))); !written) return session.fail(written.error());

  session.print(fmt::format("{}: {} layers, {} x {} texels of {} x {} samples", gltf.string(), stack->material.layers.size(), size->width,
                            size->height, baked->samples, baked->samples));
  session.result = {{"file", gltf.string()},  {"textures", Json::array()}, {"width", size->width},
                    {"height", size->height}, {"samples", baked->samples}, {"losses", Json::array()}};
  for (const ImageRef& image : baked->images) {
    session.print(fmt::format("  {}", image.file));
    session.result["textures"].push_back(image.file);
  }
  for (const Loss& loss : baked->losses.losses) session.result["losses"].push_back({{"what", loss.what}, {"effect", loss.effect}});
  for (const std::string& line : grouped(baked->losses.losses)) session.print(fmt::format("  lost: {}", line));
  session.stats.update(Json{{"images_decoded", baked->images_decoded}, {"texels", std::uint64_t{size->width} * size->height}});
  return session.finish(exit_done);
}

}  // namespace

void add_bake(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("bake", "Layers of materials as one set of textures");
  auto options = std::make_shared<Options>();
  verb->add_option("LAYERS", options->layers, "A file of layers (below)")->required();
  verb->add_option("OUT", options->out, "Folder for the textures (PNG) and material.gltf, a square with the material")->required();
  verb->add_option("--size", options->size, "Of the textures")->capture_default_str();
  verb->add_option("--bits", options->bits, "Of the textures")->capture_default_str()->check(CLI::IsMember({8, 16}));
  verb->add_option("--jobs", options->threads, "Threads; 0: as many as the machine has")->capture_default_str()->check(CLI::Range(0, 1024));
  verb->add_flag("--force", options->force, "Write into a folder that is there");
  add_limits(*verb, options->import);
  verb->footer(
      "\nExamples:\n  etendue bake rusty.layers.json rusty\n  etendue bake rusty.layers.json rusty --size 4096x4096 --bits 16\n"
      "  etendue bake rusty.layers.json rusty --force --json\n"
      "\nA file of layers, the lowest first:\n"
      "  { \"etendue_layers\": 1, \"name\": \"rusty steel\", \"normals\": \"reoriented\", \"blend\": \"parameters\",\n"
      "    \"layers\": [ {\"asset\": \"steel.glb\", \"material\": \"Steel\", \"uv_scale\": 4},\n"
      "                {\"asset\": \"rust.rig.json\", \"mask\": \"rust_mask.png\", \"opacity\": 0.9} ] }\n"
      "Assets and masks are found from its folder. A layer covers those below it by its mask (red, linear) times its opacity; uv_scale\n"
      "repeats its textures. normals: replace, slopes (added up) or reoriented; blend: parameters, or colours (diffuse and f0).\n"
      "sdk/docs/materials.md says what either is worth.");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_bake(common, *options); }; });
}

}  // namespace etendue::cli
