#include "nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lights.h"

namespace etendue::gltf {
namespace {

bool is_finite(const Transform& t) {
  const auto finite = [](const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  return std::all_of(t.columns.begin(), t.columns.end(), finite) && finite(t.translation);
}

// Relative to the axes' lengths: 0 where the image of space is a plane, a line or a point, 1 for orthogonal axes.
double spread(const Transform& t) {
  const double volume = length(t.columns[0]) * length(t.columns[1]) * length(t.columns[2]);
  return volume > 0 ? std::abs(t.determinant()) / volume : 0;
}
constexpr double flat = 1e-9;

std::string pointer_of(int node) { return fmt::format("/nodes/{}", node); }

}  // namespace

Nodes::Nodes(Asset& asset, Scene& scene)
    : asset_(asset), scene_(scene), materials_(asset, scene), meshes_(asset, scene, has(asset.options().need, Need::meshes)) {}

void Nodes::read_default_scene() {
  if (!is_forest()) return;
  for (const int root : roots()) visit(root, Transform{}, 1);
}

// A node has one parent at most, and following parents ends at a root (3.5.2). Without it the walk might not end.
bool Nodes::is_forest() {
  const auto& nodes = asset_.model().nodes;
  std::vector<int> parent(nodes.size(), -1);
  bool good = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
      const int child = nodes[i].children[k];
      const std::string pointer = fmt::format("/nodes/{}/children/{}", i, k);
      if (child < 0 || static_cast<std::size_t>(child) >= nodes.size()) {
        good = false;  // reported by the schema's check
      } else if (int& known = parent[static_cast<std::size_t>(child)]; known >= 0) {
        asset_.error("NODE_PARENT_OVERRIDE", fmt::format("node {} is a child of node {} already", child, known), pointer);
        good = false;
      } else {
        known = static_cast<int>(i);
      }
    }
  }
  // 0: not looked at, 1: on the way up that is being followed, 2: ends at a root.
  std::vector<char> state(nodes.size(), 0);
  for (std::size_t start = 0; start < nodes.size(); ++start) {
    std::vector<std::size_t> way;
    std::size_t at = start;
    while (state[at] == 0) {
      state[at] = 1;
      way.push_back(at);
      if (parent[at] < 0) break;
      at = static_cast<std::size_t>(parent[at]);
    }
    if (state[at] == 1 && parent[at] >= 0) {
      asset_.error("NODE_LOOP", fmt::format("node {} is its own ancestor", at), pointer_of(static_cast<int>(at)));
      good = false;
    }
    for (const std::size_t node : way) state[node] = 2;
  }
  return good;
}

std::vector<int> Nodes::roots() {
  const tinygltf::Model& model = asset_.model();
  if (model.scenes.empty()) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
      for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
  }
  int chosen = model.defaultScene;
  if (chosen < 0) {
    chosen = 0;
    asset_.note("NO_DEFAULT_SCENE", "the file names no default scene; the first one is read", "/scenes/0");
  }
  if (static_cast<std::size_t>(chosen) >= model.scenes.size()) return {};  // reported by the schema's check
  for (std::size_t i = 0; i < model.scenes.size(); ++i)
    if (i != static_cast<std::size_t>(chosen))
      asset_.warning("NOT_REPRESENTED", "another scene than the default one is not read", fmt::format("/scenes/{}", i));
  std::vector<int> roots;
  for (const int node : model.scenes[static_cast<std::size_t>(chosen)].nodes)
    if (node >= 0 && static_cast<std::size_t>(node) < model.nodes.size()) roots.push_back(node);
  return roots;
}

void Nodes::visit(int node, const Transform& parent_to_world, int depth) {
  if (depth > asset_.options().max_depth) {
    asset_.error("LIMIT_EXCEEDED", fmt::format("nodes nested more than {} deep", asset_.options().max_depth), pointer_of(node));
    return;
  }
  const auto local = local_transform(node);
  if (!local) return;
  const Transform to_world = parent_to_world * *local;
  if (!is_finite(to_world)) {
    asset_.error("NODE_TRANSFORM_INVALID", "the product of the transforms down to this node is not finite", pointer_of(node));
    return;
  }
  add_camera(node, to_world);
  add_lights(node, to_world);
  add_mesh(node, to_world);
  for (const int child : asset_.model().nodes[static_cast<std::size_t>(node)].children) visit(child, to_world, depth + 1);
}

// None where the node and all below it have to be left out.
std::optional<Transform> Nodes::local_transform(int index) {
  const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(index)];
  const std::string pointer = pointer_of(index);
  if (node.matrix.size() == 16) {
    const nlohmann::json& source = asset_.json().at(nlohmann::json::json_pointer(pointer));
    if (source.contains("translation") || source.contains("rotation") || source.contains("scale"))
      asset_.error("NODE_MATRIX_TRS", "expected either matrix or translation, rotation and scale, found both", pointer);
    std::array<double, 16> m{};
    std::copy(node.matrix.begin(), node.matrix.end(), m.begin());
    const Transform transform = Transform::from_column_major(m);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1 || !(spread(transform) > flat)) {
      asset_.error("NODE_MATRIX_NON_TRS", "expected an invertible affine matrix with the last row 0 0 0 1", pointer + "/matrix");
      return std::nullopt;
    }
    return transform;
  }
  Vec3d translation, scale{1, 1, 1};
  Quat rotation;
  if (node.translation.size() == 3) translation = {node.translation[0], node.translation[1], node.translation[2]};
  if (node.scale.size() == 3) scale = {node.scale[0], node.scale[1], node.scale[2]};
  if (node.rotation.size() == 4) {
    rotation = {node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]};
    const double norm = std::sqrt(rotation.x * rotation.x + rotation.y * rotation.y + rotation.z * rotation.z + rotation.w * rotation.w);
    // The validator's threshold: what normalised 8-bit numbers can miss by.
    if (!(std::abs(norm - 1) <= 0.00769)) {
      asset_.error("ROTATION_NON_UNIT", fmt::format("expected a quaternion of length 1, found {}", norm), pointer + "/rotation");
      return std::nullopt;
    }
    rotation = {rotation.x / norm, rotation.y / norm, rotation.z / norm, rotation.w / norm};
  }
  return Transform::from_trs(translation, rotation, scale);
}

std::string Nodes::name_of(int node) const { return asset_.model().nodes[static_cast<std::size_t>(node)].name; }

bool Nodes::has_orientation(const Transform& to_world, const char* what, const std::string& pointer) {
  if (spread(to_world) > flat) return true;
  asset_.error("NODE_TRANSFORM_INVALID", fmt::format("a {} has no direction under a transform that flattens space", what), pointer);
  return false;
}

void Nodes::add_camera(int index, const Transform& to_world) {
  const tinygltf::Model& model = asset_.model();
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  if (!has(asset_.options().need, Need::cameras) || node.camera < 0 || static_cast<std::size_t>(node.camera) >= model.cameras.size())
    return;
  const tinygltf::Camera& source = model.cameras[static_cast<std::size_t>(node.camera)];
  const std::string pointer = fmt::format("/cameras/{}", node.camera);
  if (source.type != "perspective") {
    asset_.warning("NOT_REPRESENTED", "an orthographic camera is left out", pointer);
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
  if (!has_orientation(to_world, "camera", pointer_of(index))) return;
  Camera camera;
  camera.name = !source.name.empty() ? source.name : !node.name.empty() ? node.name : fmt::format("camera {}", node.camera);
  camera.transform = to_world.rigid();
  camera.vfov_rad = lens.yfov;
  camera.aspect = lens.aspectRatio;
  camera.source = pointer;
  scene_.cameras.push_back(std::move(camera));
}

void Nodes::add_lights(int index, const Transform& to_world) {
  if (!has(asset_.options().need, Need::lights)) return;
  const std::string pointer = pointer_of(index);
  for (const char* name : {"KHR_lights_punctual", "EXT_lights_area"}) {
    const nlohmann::json* extension = asset_.extension(pointer, name);
    if (extension == nullptr || !has_orientation(to_world, "light", pointer)) continue;
    const int light = static_cast<int>(number_or(*extension, "light", -1));
    auto read = std::string_view(name) == "EXT_lights_area" ? area_light(asset_, light, to_world) : punctual_light(asset_, light, to_world);
    if (read) add_light(std::move(*read), name_of(index));
  }
}

// The file's name for it, else the node's; made unique, since lights are chosen by name.
void Nodes::add_light(Light light, const std::string& node_name) {
  if (light.name.empty()) light.name = node_name.empty() ? fmt::format("light {}", scene_.lights.size()) : node_name;
  const std::string stem = light.name;
  for (int n = 2; !light_names_.insert(light.name).second; ++n) light.name = fmt::format("{} {}", stem, n);
  scene_.lights.push_back(std::move(light));
}

void Nodes::add_mesh(int index, const Transform& to_world) {
  const tinygltf::Model& model = asset_.model();
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  const bool wants_meshes = has(asset_.options().need, Need::meshes), wants_lights = has(asset_.options().need, Need::lights);
  if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model.meshes.size() || !(wants_meshes || wants_lights)) return;
  if (!(spread(to_world) > flat)) {
    asset_.warning("NODE_EMPTY_SCALE", "a transform flattens the mesh to nothing; it is left out", pointer_of(index));
    return;
  }
  if (node.skin >= 0)
    asset_.warning("NOT_REPRESENTED", "skinning is lost: the mesh stands where its node is, in the shape that the file gives it",
                   pointer_of(index) + "/skin");
  const tinygltf::Mesh& source = model.meshes[static_cast<std::size_t>(node.mesh)];
  for (std::size_t p = 0; p < source.primitives.size(); ++p) {
    const Materials::Entry& material = materials_.at(source.primitives[p].material);
    const bool emits = wants_lights && luminance_of(material.material.emissive) > 0;
    if (!wants_meshes && !emits) {
      ++asset_.stats.skipped_meshes;
      continue;
    }
    const auto mesh = meshes_.at(node.mesh, p, material);
    if (!mesh) continue;
    std::string name = node.name.empty() ? scene_.meshes[*mesh].name : node.name;
    if (!node.name.empty() && source.primitives.size() > 1) name += fmt::format("/{}", p);
    if (emits) {
      Light light = emissive_surface(scene_, *mesh, material, to_world);
      light.source = pointer_of(index);
      add_light(std::move(light), name);
    } else {
      scene_.objects.push_back({std::move(name), MeshGeometry{*mesh}, material.index, to_world, pointer_of(index)});
    }
  }
}

}  // namespace etendue::gltf
