#include "scene_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "buffer_writer.h"
#include "light_shapes.h"
#include "nearest_punctual.h"
#include "surfaces.h"

namespace etendue::gltf {
namespace {

// Columns at right angles to each other, to what single precision leaves: what a glTF matrix may be.
bool is_scaled_rotation(const Transform& t) {
  const auto& c = t.columns;
  const auto cosine = [](const Vec3d& a, const Vec3d& b) { return std::abs(dot(normalised(a), normalised(b))); };
  return std::max({cosine(c[0], c[1]), cosine(c[1], c[2]), cosine(c[2], c[0])}) < 1e-6;
}

// The mesh where a sheared transform puts it.
Mesh sheared(Mesh mesh, const Transform& to_world) {
  for (Vec3f& p : mesh.positions) p = vec_cast<float>(to_world.point(vec_cast<double>(p)));
  for (Vec3f& n : mesh.normals) n = vec_cast<float>(normalised(to_world.normal(vec_cast<double>(n))));
  mesh.tangents.clear();
  if (to_world.determinant() < 0)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

class SceneWriter {
 public:
  SceneWriter(const Scene& scene, const std::vector<std::uint32_t>& lit, LightShapes shapes, Built& built)
      : scene_(scene), lit_(lit), shapes_(shapes), built_(built), buffer_(json_), textures_(scene, json_, built.losses) {}

  Status write() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "etendue"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json::object()});
    for (const Object& object : scene_.objects) write_object(object);
    for (const Camera& camera : scene_.cameras) write_camera(camera);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      if (!lit_.empty() && std::find(lit_.begin(), lit_.end(), i) == lit_.end()) continue;
      if (Status written = write_light(scene_.lights[i]); !written) return written;
    }
    if (json_.contains("nodes"))
      for (std::size_t i = 0; i < json_["nodes"].size(); ++i) json_["scenes"][0]["nodes"].push_back(i);
    name_extensions();
    built_.images = textures_.images();
    built_.carrier.carried.buffers = {SharedBytes(buffer_.finish())};
    const std::string text = json_.dump(2) + "\n";
    built_.carrier.carried.document = SharedBytes(std::vector<std::uint8_t>(text.begin(), text.end()));
    built_.carrier.images = scene_.images;
    built_.carrier.file = scene_.file;
    return Done{};
  }

 private:
  Json& add_node(const std::string& name, const Transform& t) {
    Json node = Json::object();
    if (!name.empty()) node["name"] = name;
    if (!(t == Transform{})) {
      Json matrix = Json::array();
      for (const Vec3d& column : t.columns)
        for (const double x : {column.x, column.y, column.z, 0.0}) matrix.push_back(x);
      for (const double x : {t.translation.x, t.translation.y, t.translation.z, 1.0}) matrix.push_back(x);
      node["matrix"] = std::move(matrix);
    }
    json_["nodes"].push_back(std::move(node));
    return json_["nodes"].back();
  }

  std::size_t add_mesh(const std::string& name, Json primitive, std::size_t material) {
    primitive["material"] = material;
    Json mesh = Json::object();
    if (!name.empty()) mesh["name"] = name;
    mesh["primitives"] = Json::array({std::move(primitive)});
    json_["meshes"].push_back(std::move(mesh));
    return json_["meshes"].size() - 1;
  }

  std::size_t material_of(std::uint32_t index) {
    const auto known = materials_.find(index);
    if (known != materials_.end()) return known->second;
    Material standing_in;
    standing_in.name = "default";
    standing_in.model = Lambert{};
    // Made first: it adds textures to the document, which moves the document's members.
    Json made = surface_of(index == no_index ? standing_in : scene_.materials[index], textures_, built_.losses);
    json_["materials"].push_back(std::move(made));
    return materials_[index] = json_["materials"].size() - 1;
  }

  void write_object(const Object& object) {
    Mesh mesh = tessellated(object.geometry, scene_.meshes);
    if (mesh.indices.empty()) return;
    const std::size_t material = material_of(object.material);
    if (!is_scaled_rotation(object.transform)) {
      built_.losses.add(fmt::format("object '{}': its transform", object.name), "a node has no shear: worked into the mesh");
      add_node(object.name, {})["mesh"] = add_mesh(object.name, buffer_.primitive(sheared(std::move(mesh), object.transform)), material);
      return;
    }
    // A mesh of the scene is written once for each material that it has.
    const auto* shared = std::get_if<MeshGeometry>(&object.geometry);
    if (shared == nullptr) {
      const std::size_t made = add_mesh(object.name, buffer_.primitive(mesh), material);
      add_node(object.name, object.transform)["mesh"] = made;
      return;
    }
    if (!primitives_.contains(shared->mesh)) primitives_[shared->mesh] = buffer_.primitive(mesh);
    const auto key = std::pair(shared->mesh, material);
    if (!meshes_.contains(key)) meshes_[key] = add_mesh(mesh.name.empty() ? object.name : mesh.name, primitives_[shared->mesh], material);
    add_node(object.name, object.transform)["mesh"] = meshes_[key];
  }

  void write_camera(const Camera& camera) {
    Json perspective = Json::object();
    if (camera.aspect > 0) perspective["aspectRatio"] = camera.aspect;
    perspective["yfov"] = camera.vfov_rad;
    // Obligatory, and above 0: nothing is cut off here.
    perspective["znear"] = camera.near_m && *camera.near_m > 0 ? *camera.near_m : 0.01;
    if (camera.far_m) perspective["zfar"] = *camera.far_m;
    Json out = Json::object();
    if (!camera.name.empty()) out["name"] = camera.name;
    out["type"] = "perspective";
    out["perspective"] = std::move(perspective);
    json_["cameras"].push_back(std::move(out));
    add_node(camera.name, camera.transform)["camera"] = json_["cameras"].size() - 1;
    if (camera.ev100)
      built_.losses.add(fmt::format("camera '{}': its exposure, EV100 {:g}", camera.name, *camera.ev100), "left out: the format has none");
  }

  Status write_light(const Light& light) {
    const Result<Resolved> resolved = resolve(light, mesh_area_of(scene_, light));
    if (!resolved) return resolved.error();
    for (const Punctual& punctual : nearest_punctual(light, *resolved, scene_, built_.losses)) write_punctual(light, punctual);
    if (light.surface_material && shapes_ == LightShapes::none)
      built_.losses.add(fmt::format("light '{}': what its surface reflects", light.name), "left out; --emissive-shapes writes the surface");
    if (shapes_ == LightShapes::emissive && light.visible) write_shape(light, *resolved);
    return Done{};
  }

  // The colour is a filter within 0..1: the photometric value is intensity x Y(colour).
  void write_punctual(const Light& light, const Punctual& punctual) {
    const double intensity = std::max({punctual.rgb.x, punctual.rgb.y, punctual.rgb.z});
    Json out = Json::object();
    if (!light.name.empty()) out["name"] = light.name;
    out["type"] = punctual.type;
    if (intensity > 0 && !(punctual.rgb == Rgb{intensity, intensity, intensity}))
      out["color"] = {punctual.rgb.x / intensity, punctual.rgb.y / intensity, punctual.rgb.z / intensity};
    out["intensity"] = std::max(intensity, 0.0);
    if (punctual.range_m) out["range"] = *punctual.range_m;
    if (punctual.spot) out["spot"] = {{"innerConeAngle", punctual.spot->inner_rad}, {"outerConeAngle", punctual.spot->outer_rad}};
    Json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(out));
    add_node(light.name, punctual.transform)["extensions"]["KHR_lights_punctual"] = {{"light", lights.size() - 1}};
  }

  void write_shape(const Light& light, const Resolved& resolved) {
    if (resolved.kind != Resolved::Kind::luminance) return;
    const std::optional<Mesh> mesh = visible_shape(light, scene_.meshes);
    if (!mesh || mesh->indices.empty()) return;
    const bool both_sides = light.two_sided && emits_both_sides(light);
    Json surface = emitting_surface(light.name, resolved.rgb, both_sides);
    if (light.surface_material) {
      Json reflecting = surface_of(scene_.materials[*light.surface_material], textures_, built_.losses);
      for (const char* key : {"emissiveFactor", "doubleSided"})
        if (surface.contains(key)) reflecting[key] = surface[key];
      constexpr const char* strength = "KHR_materials_emissive_strength";
      if (surface["extensions"].contains(strength)) reflecting["extensions"][strength] = surface["extensions"][strength];
      surface = std::move(reflecting);
    }
    if (light.emission.texture && !mesh->uvs.empty())
      textures_.put(surface, "emissiveTexture", *light.emission.texture, Encoding::srgb, fmt::format("light '{}'", light.name));
    json_["materials"].push_back(std::move(surface));
    const std::size_t made = add_mesh(light.name, buffer_.primitive(*mesh), json_["materials"].size() - 1);
    add_node(light.name + " shape", light.transform)["mesh"] = made;
  }

  void name_extensions() {
    std::set<std::string> names;
    for_each_object(json_, [&](Json& object) {
      const auto extensions = object.find("extensions");
      if (extensions == object.end()) return;
      for (const auto& [name, value] : extensions->items()) names.insert(name);
    });
    for (const std::string& name : names) json_["extensionsUsed"].push_back(name);
  }

  const Scene& scene_;
  const std::vector<std::uint32_t>& lit_;
  LightShapes shapes_;
  Built& built_;
  Json json_ = Json::object();
  BufferWriter buffer_;
  TextureWriter textures_;
  std::map<std::uint32_t, std::size_t> materials_;
  std::map<std::uint32_t, Json> primitives_;
  std::map<std::pair<std::uint32_t, std::size_t>, std::size_t> meshes_;
};

}  // namespace

Result<Built> document_of(const Scene& scene, const std::vector<std::uint32_t>& lit, LightShapes shapes) {
  if (const Diagnostics found = validate(scene); found.has_errors()) {
    for (const Diagnostic& d : found.all())
      if (d.severity == Severity::error) return Error{"SCENE_INVALID", d.text, d.where, d.hint, {}};
  }
  Built built;
  if (Status written = SceneWriter(scene, lit, shapes, built).write(); !written) return written.error();
  return built;
}

}  // namespace etendue::gltf
