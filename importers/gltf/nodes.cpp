#include "nodes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coincident.h"
#include "json_values.h"
#include "lights.h"

namespace etendue::gltf {

Nodes::Nodes(Asset& asset, Scene& scene)
    : asset_(asset),
      scene_(scene),
      tree_(asset),
      poses_(asset, tree_),
      materials_(asset, scene),
      meshes_(asset, scene, has(asset.options().need, Need::meshes)) {}

void Nodes::read_default_scene() {
  if (!tree_.is_forest()) return;
  const auto& scenes = asset_.model().scenes;
  const int chosen = tree_.scene();
  if (chosen >= 0) {
    asset_.take(fmt::format("/scenes/{}", chosen));
    if (asset_.model().defaultScene < 0)
      asset_.note("NO_DEFAULT_SCENE", "the file names no default scene; the first one is read", "/scenes/0");
    for (std::size_t i = 0; i < scenes.size(); ++i)
      if (i != static_cast<std::size_t>(chosen))
        asset_.warning("NOT_REPRESENTED", "another scene than the default one: carried, and not read", fmt::format("/scenes/{}", i));
  }
  for (const int root : tree_.roots()) visit(root, Transform{}, 1);
  if (wants(Need::lights)) add_environment();
  if (wants(Need::lights) && wants(Need::meshes)) count_lamps_once(asset_, scene_);
}

void Nodes::read_every_material() {
  for (std::size_t i = 0; i < asset_.model().materials.size(); ++i) materials_.at(static_cast<int>(i));
}

void Nodes::visit(int node, const Transform& parent_to_world, int depth) {
  if (depth > asset_.options().max_depth) {
    const auto limit = static_cast<std::uint64_t>(std::max(asset_.options().max_depth, 0));
    asset_.error(asset_.over_limit("the depth of this node", "max_depth", limit, node_pointer(node)));
    return;
  }
  if (is_hidden(node)) return;
  const auto local = tree_.local(node);
  if (!local) return;
  const Transform to_world = parent_to_world * *local;
  if (!is_finite(to_world)) {
    asset_.error("NODE_TRANSFORM_INVALID", "the product of the transforms down to this node is not finite", node_pointer(node));
    return;
  }
  asset_.take(node_pointer(node));
  add_camera(node, to_world);
  add_lights(node, to_world);
  add_mesh(node, to_world);
  for (const int child : asset_.model().nodes[static_cast<std::size_t>(node)].children) visit(child, to_world, depth + 1);
}

// KHR_node_visibility: a hidden node hides all below it.
bool Nodes::is_hidden(int node) const {
  const nlohmann::json* extension = asset_.extension(node_pointer(node), "KHR_node_visibility");
  return extension != nullptr && extension->contains("visible") && (*extension)["visible"] == false;
}

bool Nodes::has_orientation(const Transform& to_world, const char* what, const std::string& pointer) {
  if (spread(to_world) > flat) return true;
  asset_.error("NODE_TRANSFORM_INVALID", fmt::format("a {} has no direction under a transform that flattens space", what), pointer);
  return false;
}

void Nodes::add_camera(int index, const Transform& to_world) {
  const tinygltf::Model& model = asset_.model();
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  if (!wants(Need::cameras) || node.camera < 0 || static_cast<std::size_t>(node.camera) >= model.cameras.size()) return;
  const tinygltf::Camera& source = model.cameras[static_cast<std::size_t>(node.camera)];
  const std::string pointer = fmt::format("/cameras/{}", node.camera);
  if (source.type != "perspective") {
    asset_.warning("NOT_REPRESENTED", "an orthographic camera: carried, and no picture can be taken with it", pointer);
    return;
  }
  const tinygltf::PerspectiveCamera& lens = source.perspective;
  if (!(lens.yfov > 0 && lens.yfov < pi)) {
    asset_.error("VALUE_NOT_IN_RANGE", fmt::format("expected a yfov between 0 and pi, found {}", lens.yfov), pointer + "/perspective/yfov");
    return;
  }
  if (lens.zfar > 0 && lens.zfar <= lens.znear)
    asset_.error("CAMERA_ZFAR_LEQUAL_ZNEAR", fmt::format("expected zfar above znear, found {} and {}", lens.zfar, lens.znear),
                 pointer + "/perspective");
  if (!has_orientation(to_world, "camera", node_pointer(index))) return;
  asset_.take(pointer);
  Camera camera;
  camera.name = !source.name.empty() ? source.name : !node.name.empty() ? node.name : fmt::format("camera {}", node.camera);
  camera.transform = to_world.rigid();
  camera.vfov_rad = lens.yfov;
  camera.aspect = lens.aspectRatio;
  if (lens.znear > 0) camera.near_m = lens.znear;
  if (lens.zfar > 0) camera.far_m = lens.zfar;
  camera.source = pointer;
  scene_.cameras.push_back(std::move(camera));
}

void Nodes::add_lights(int index, const Transform& to_world) {
  if (!wants(Need::lights)) return;
  const std::string pointer = node_pointer(index);
  using Read = std::optional<Light> (*)(Asset&, const nlohmann::json&, const Transform&);
  constexpr std::pair<const char*, Read> kinds[] = {
      {"KHR_lights_punctual", punctual_light}, {"EXT_lights_area", area_light}, {"EXT_lights_ies", ies_light}};
  for (const auto& [name, read] : kinds) {
    const nlohmann::json* extension = asset_.extension(pointer, name);
    if (extension == nullptr || !has_orientation(to_world, "light", pointer)) continue;
    if (auto light = read(asset_, *extension, to_world))
      add_light(std::move(*light), asset_.model().nodes[static_cast<std::size_t>(index)].name);
  }
}

void Nodes::add_environment() {
  const nlohmann::json* extension = asset_.extension(fmt::format("/scenes/{}", tree_.scene()), "EXT_lights_image_based");
  if (extension == nullptr) return;
  const int index = int_index_of(*extension, "light");
  const auto cube = image_based_cube(asset_, index);
  std::vector<std::uint32_t> faces;
  for (const int image : cube)
    if (const auto face = materials_.image(image)) faces.push_back(*face);
  if (faces.size() != 6) return;
  add_light(image_based_light(asset_, index, std::move(faces)), "");
}

// The file's name for it, else the node's; made unique, since lights are chosen by name.
void Nodes::add_light(Light light, const std::string& node_name) {
  asset_.take(light.source);
  if (light.name.empty()) light.name = node_name.empty() ? fmt::format("light {}", scene_.lights.size()) : node_name;
  const std::string stem = light.name;
  for (int n = 2; !light_names_.insert(light.name).second; ++n) light.name = fmt::format("{} {}", stem, n);
  scene_.lights.push_back(std::move(light));
}

void Nodes::add_mesh(int index, const Transform& to_world) {
  const tinygltf::Model& model = asset_.model();
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  // Materials and their pictures are those that the scene's primitives use.
  const bool wanted = wants(Need::meshes) || wants(Need::lights) || wants(Need::materials) || wants(Need::images);
  if (!wanted || node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size()) return;
  const Pose pose = wants(Need::meshes) ? poses_.of(index) : Pose{};
  // A skinned mesh stands where its joints are; its node's own transform does not move it (3.7.3.3).
  const Transform mesh_to_world = pose.joints.empty() ? to_world : Transform{};
  if (!(spread(mesh_to_world) > flat)) {
    asset_.warning("NODE_EMPTY_SCALE", "a transform flattens the mesh to nothing; it is left out", node_pointer(index));
    return;
  }
  asset_.take(fmt::format("/meshes/{}", node.mesh));
  for (std::size_t p = 0; p < model.meshes[static_cast<std::size_t>(node.mesh)].primitives.size(); ++p)
    add_primitive(index, p, pose, mesh_to_world);
}

void Nodes::add_primitive(int index, std::size_t p, const Pose& pose, const Transform& to_world) {
  const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(index)];
  const auto& primitives = asset_.model().meshes[static_cast<std::size_t>(node.mesh)].primitives;
  const Materials::Entry& material = materials_.at(primitives[p].material);
  const bool emits = wants(Need::lights) && luminance_of(material.material.emissive) > 0;
  if (!wants(Need::meshes) && !emits) {
    ++asset_.stats.skipped_meshes;
    return;
  }
  const auto mesh = meshes_.at(node.mesh, p, material, pose);
  if (!mesh) return;
  std::string name = node.name.empty() ? scene_.meshes[*mesh].name : node.name;
  if (!node.name.empty() && primitives.size() > 1) name += fmt::format("/{}", p);
  if (emits) {
    Light light = emissive_surface(scene_, *mesh, material, to_world);
    light.source = node_pointer(index);
    add_light(std::move(light), name);
  } else {
    scene_.objects.push_back({std::move(name), MeshGeometry{*mesh}, material.index, to_world, node_pointer(index)});
  }
}

}  // namespace etendue::gltf
