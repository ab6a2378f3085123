#include "node_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue::gltf {

bool is_finite(const Transform& t) {
  const auto finite = [](const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  return std::all_of(t.columns.begin(), t.columns.end(), finite) && finite(t.translation);
}

double spread(const Transform& t) {
  const double volume = length(t.columns[0]) * length(t.columns[1]) * length(t.columns[2]);
  return volume > 0 ? std::abs(t.determinant()) / volume : 0;
}

std::string node_pointer(int node) { return fmt::format("/nodes/{}", node); }

bool NodeTree::is_forest() {
  const auto& nodes = asset_.model().nodes;
  parents_.assign(nodes.size(), -1);
  bool good = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes[i].children.size(); ++k) {
      const int child = nodes[i].children[k];
      const std::string pointer = fmt::format("/nodes/{}/children/{}", i, k);
      if (child < 0 || static_cast<std::size_t>(child) >= nodes.size()) {
        good = false;  // reported by the schema's check
      } else if (int& known = parents_[static_cast<std::size_t>(child)]; known >= 0) {
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
      if (parents_[at] < 0) break;
      at = static_cast<std::size_t>(parents_[at]);
    }
    if (state[at] == 1 && parents_[at] >= 0) {
      asset_.error("NODE_LOOP", fmt::format("node {} is its own ancestor", at), node_pointer(static_cast<int>(at)));
      good = false;
    }
    for (const std::size_t node : way) state[node] = 2;
  }
  return good;
}

int NodeTree::scene() const {
  const tinygltf::Model& model = asset_.model();
  if (model.scenes.empty()) return -1;
  return model.defaultScene < 0 ? 0 : model.defaultScene;
}

std::vector<int> NodeTree::roots() const {
  const tinygltf::Model& model = asset_.model();
  const int chosen = scene();
  std::vector<int> roots;
  if (chosen < 0) {
    for (std::size_t i = 0; i < parents_.size(); ++i)
      if (parents_[i] < 0) roots.push_back(static_cast<int>(i));
    return roots;
  }
  if (static_cast<std::size_t>(chosen) >= model.scenes.size()) return {};  // reported by the schema's check
  for (const int node : model.scenes[static_cast<std::size_t>(chosen)].nodes)
    if (node >= 0 && static_cast<std::size_t>(node) < model.nodes.size()) roots.push_back(node);
  return roots;
}

std::optional<Transform> NodeTree::local(int node) {
  if (const auto found = locals_.find(node); found != locals_.end()) return found->second;
  return locals_.emplace(node, read_local(node)).first->second;
}

std::optional<Transform> NodeTree::read_local(int index) {
  const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(index)];
  const std::string pointer = node_pointer(index);
  if (node.matrix.size() == 16) {
    const nlohmann::json& source = asset_.json()["nodes"][static_cast<std::size_t>(index)];
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
      if (!asset_.options().tolerant || !(norm > 0)) return std::nullopt;
    }
    rotation = {rotation.x / norm, rotation.y / norm, rotation.z / norm, rotation.w / norm};
  }
  return Transform::from_trs(translation, rotation, scale);
}

std::optional<Transform> NodeTree::world(int node) {
  std::vector<int> way;
  std::optional<Transform> above = Transform{};
  for (int at = node; at >= 0; at = parents_[static_cast<std::size_t>(at)]) {
    if (const auto known = worlds_.find(at); known != worlds_.end()) {
      above = known->second;
      break;
    }
    way.push_back(at);
  }
  std::reverse(way.begin(), way.end());
  for (const int at : way) {
    const auto here = local(at);
    above = above && here ? std::optional(*above * *here) : std::nullopt;
    if (above && !is_finite(*above)) {
      asset_.error("NODE_TRANSFORM_INVALID", "the product of the transforms down to this node is not finite", node_pointer(at));
      above.reset();
    }
    worlds_.emplace(at, above);
  }
  return above;
}

}  // namespace etendue::gltf
