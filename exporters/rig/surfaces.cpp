#include "writer.h"

#include "etendue/unshown.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue::rig {
namespace {

// Above this many triangles a text of numbers is the wrong place (about 200 MB of it): glTF is the right one.
constexpr std::size_t most_triangles = 1'000'000;

// Rows of "x, y, z" as one flat array.
template <class Vector, class Write>
void write_flat(JsonWriter& json, std::string_view key, const std::vector<Vector>& vectors, Write write) {
  if (vectors.empty()) return;
  json.key(key);
  json.begin_array();
  for (const Vector& v : vectors) write(v);
  json.end_array();
}

const char* name_of(Masking masking) {
  switch (masking) {
    case Masking::correlated:
      return "correlated";
    case Masking::separable:
      return "separable";
    case Masking::schlick_direct:
      return "schlick-direct";
    default:
      return "schlick-image";
  }
}

void write_mesh(JsonWriter& json, const Mesh& mesh) {
  const auto three = [&json](const Vec3f& v) {
    for (int i = 0; i < 3; ++i) json.value(v[i]);
  };
  const auto two = [&json](const Vec2f& v) {
    json.value(v.x);
    json.value(v.y);
  };
  json.begin_object(JsonWriter::Style::one_item_a_line);
  if (!mesh.name.empty()) json.member("name", mesh.name);
  write_flat(json, "positions", mesh.positions, three);
  write_flat(json, "normals", mesh.normals, three);
  write_flat(json, "uvs", mesh.uvs, two);
  write_flat(json, "indices", mesh.indices, [&json](std::uint32_t i) { json.value(i); });
  json.end_object();
}

// What lights and objects use, in the scene's order.
template <class T>
std::vector<bool> used_meshes(const std::vector<T>& things, std::vector<bool> used) {
  for (const T& thing : things) {
    if constexpr (std::is_same_v<T, Light>) {
      if (const auto* shape = std::get_if<MeshShape>(&thing.shape)) used[shape->mesh] = true;
    } else {
      if (const auto* geometry = std::get_if<MeshGeometry>(&thing.geometry)) used[geometry->mesh] = true;
    }
  }
  return used;
}

struct WriteModel {
  JsonWriter& json;

  void operator()(const Lambert& m) const {
    json.member("model", "lambert");
    colour("base_colour", m.base_colour);
  }
  void operator()(const Principled& m) const {
    json.member("model", "principled");
    colour("base_colour", m.base_colour);
    json.member("metallic", m.metallic);
    json.member("roughness", m.roughness);
    json.member("specular", m.specular);
  }
  void operator()(const Standard& m) const {
    json.member("model", "standard");
    colour("base_colour", m.base_colour);
    json.member("metal", m.metal);
    json.member("roughness", m.roughness);
    json.member("reflectance", m.reflectance);
  }
  void operator()(const Conductor& m) const {
    json.member("model", "conductor");
    colour("eta", m.eta);
    colour("k", m.k);
    json.member("alpha", m.alpha);
    if (m.masking != Conductor{}.masking) json.member("masking", name_of(m.masking));
  }
  void operator()(const MetalRough& m) const {
    json.member("model", "metal_rough");
    colour("base_colour", m.base_colour);
    json.member("metallic", m.metallic);
    json.member("roughness", m.roughness);
    if (m.ior != MetalRough{}.ior) json.member("ior", m.ior);
  }
  void operator()(const SpecularGlossiness& m) const {
    json.member("model", "specular_glossiness");
    colour("diffuse", m.diffuse);
    colour("specular", m.specular);
    json.member("glossiness", m.glossiness);
  }

 private:
  void colour(const char* key, const Rgb& rgb) const {
    json.key(key);
    write_vec3(json, rgb);
  }
};

void report_losses(Writer& writer, const Material& m) {
  const auto lose = [&](const char* what, const char* effect) {
    writer.losses.add(fmt::format("material \"{}\": {}", m.name, what), effect);
  };
  if (m.base_colour_texture) lose("the texture of its base colour", "the factor alone colours the surface");
  if (m.metal_rough_texture) lose("the texture of metal and roughness", "the factors alone say how it reflects");
  if (m.specular_gloss_texture) lose("the texture of specular colour and glossiness", "the factors alone say how it reflects");
  if (m.fallback) lose("its metallic-roughness fallback", "left out");
  if (m.occlusion) lose("its occlusion texture", "left out: it dims indirect light only");
  for (const Loss& loss : unshown_losses(m)) lose(loss.what.c_str(), loss.effect.c_str());
  if (m.normal_map) lose("its normal map", "the surface is smooth");
  if (m.alpha_cutoff) lose("its alpha cutoff", "the surface has no holes");
  if (m.base_alpha != 1) lose("the alpha of its base colour", "the surface is opaque");
  const bool emits = !(m.emissive == Rgb{0, 0, 0});
  if (emits || m.emissive_texture) lose("its emission", "only the mesh lights made of it emit");
}

}  // namespace

void choose_meshes(Writer& writer) {
  const Scene& scene = writer.scene;
  const std::vector<bool> used = used_meshes(scene.objects, used_meshes(scene.lights, std::vector<bool>(scene.meshes.size(), false)));
  writer.mesh_index.assign(scene.meshes.size(), std::nullopt);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const std::size_t triangles = scene.meshes[i].indices.size() / 3;
    if (used[i] && triangles > 0 && triangles <= most_triangles) writer.mesh_index[i] = next++;
  }
}

void write_meshes(Writer& writer) {
  if (std::none_of(writer.mesh_index.begin(), writer.mesh_index.end(), [](const auto& index) { return index.has_value(); })) return;
  writer.json.key("meshes");
  writer.json.begin_array(JsonWriter::Style::one_item_a_line);
  for (std::size_t i = 0; i < writer.scene.meshes.size(); ++i)
    if (writer.mesh_index[i]) write_mesh(writer.json, writer.scene.meshes[i]);
  writer.json.end_array();
}

void count_material_names(Writer& writer) {
  for (const Material& material : writer.scene.materials) ++writer.material_names[material.name];
}

void write_material_reference(Writer& writer, std::string_view key, std::uint32_t material) {
  const std::string& name = writer.scene.materials[material].name;
  if (!name.empty() && writer.material_names[name] == 1) {
    writer.json.member(key, name);
  } else {
    writer.json.member(key, material);
  }
}

void write_materials(Writer& writer) {
  const std::vector<Material>& materials = writer.scene.materials;
  if (materials.empty()) return;
  JsonWriter& json = writer.json;
  json.key("materials");
  json.begin_array(JsonWriter::Style::one_item_a_line);
  for (const Material& material : materials) {
    json.begin_object();
    if (!material.name.empty()) json.member("name", material.name);
    std::visit(WriteModel{json}, material.model);
    if (!material.double_sided) json.member("double_sided", false);
    json.end_object();
    report_losses(writer, material);
  }
  json.end_array();
}

void write_objects(Writer& writer) {
  if (writer.scene.objects.empty()) return;
  JsonWriter& json = writer.json;
  json.key("objects");
  json.begin_array(JsonWriter::Style::one_item_a_line);
  for (const Object& object : writer.scene.objects) {
    const auto* mesh = std::get_if<MeshGeometry>(&object.geometry);
    if (mesh && !writer.mesh_index[mesh->mesh]) {
      writer.losses.add(fmt::format("object \"{}\"", object.name), "left out: a rig file does not hold its mesh");
      continue;
    }
    json.begin_object();
    if (!object.name.empty()) json.member("name", object.name);
    json.key("shape");
    json.begin_object();
    if (mesh) {
      json.member("type", "mesh");
      json.member("mesh", *writer.mesh_index[mesh->mesh]);
    } else if (const auto* plane = std::get_if<PlaneGeometry>(&object.geometry)) {
      json.member("type", "plane");
      json.member("size", length_text(plane->size));
    } else if (const auto* box = std::get_if<BoxGeometry>(&object.geometry)) {
      json.member("type", "box");
      json.key("size");
      write_vec3(json, box->size);
    } else {
      json.member("type", "sphere");
      json.member("radius", length_text(std::get<SphereGeometry>(object.geometry).radius));
    }
    json.end_object();
    if (object.material != no_index) write_material_reference(writer, "material", object.material);
    write_transform(json, object.transform, true);
    json.end_object();
  }
  json.end_array();
}

}  // namespace etendue::rig
