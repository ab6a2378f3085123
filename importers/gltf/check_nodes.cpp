// Nodes and scenes: transforms, what may stand together, and that the hierarchy is a forest.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "checks.h"

namespace etendue::gltf {
namespace {

// Numbers of an array of that length; nothing where the schema has found fault with it.
template <std::size_t n>
std::optional<std::array<double, n>> numbers_of(const Json& object, const char* key) {
  const Json& source = array_at(object, key);
  if (source.size() != n) return std::nullopt;
  std::array<double, n> values{};
  for (std::size_t i = 0; i < n; ++i) {
    if (!source[i].is_number()) return std::nullopt;
    values[i] = source[i].get<double>();
  }
  return values;
}

// A matrix is translation x rotation x scale if its last row is 0 0 0 1 and its columns are orthogonal and not zero. The tolerance on
// the cosines is ten times what seven digits leave.
bool is_decomposable(const std::array<double, 16>& m) {
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) return false;
  constexpr double tolerance = 1e-4;
  std::array<double, 3> lengths{};
  for (std::size_t c = 0; c < 3; ++c) lengths[c] = std::hypot(m[4 * c], m[4 * c + 1], m[4 * c + 2]);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t d = (c + 1) % 3;
    const double dot = m[4 * c] * m[4 * d] + m[4 * c + 1] * m[4 * d + 1] + m[4 * c + 2] * m[4 * d + 2];
    if (!(std::abs(dot) <= tolerance * lengths[c] * lengths[d]) || !(lengths[c] > 0)) return false;
  }
  return true;
}

void check_transform(Checks& checks, const Json& node, const Path& path) {
  if (const auto rotation = numbers_of<4>(node, "rotation")) {
    const auto& q = *rotation;
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    // The validator's threshold: what normalised 8-bit numbers can miss by.
    if (!(std::abs(norm - 1) <= 0.00769))
      checks.findings.error("ROTATION_NON_UNIT", fmt::format("expected a quaternion of length 1, found {}", norm), path / "rotation");
  }
  const auto matrix = numbers_of<16>(node, "matrix");
  if (!matrix) return;
  const Path here = path / "matrix";
  if (node.contains("translation") || node.contains("rotation") || node.contains("scale"))
    checks.findings.error("NODE_MATRIX_TRS", "expected either matrix or translation, rotation and scale, found both", here);
  constexpr std::array<double, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (*matrix == identity) {
    checks.findings.note("NODE_MATRIX_DEFAULT", "the identity need not be said", here);
  } else if (!is_decomposable(*matrix)) {
    checks.findings.error("NODE_MATRIX_NON_TRS", "expected a product of translation, rotation and scale, invertible", here);
  }
}

bool has_joints(const Json& primitive) { return object_at(primitive, "attributes").contains("JOINTS_0"); }

void check_mesh_use(Checks& checks, const Json& node, const Path& path) {
  const std::int64_t mesh = index_of(node, "mesh");
  if (mesh < 0) {
    if (index_of(node, "skin") >= 0)
      checks.findings.error("UNSATISFIED_DEPENDENCY", "expected mesh beside skin, which is missing", path / "skin");
    if (!array_at(node, "weights").empty())
      checks.findings.error("UNSATISFIED_DEPENDENCY", "expected mesh beside weights, which is missing", path / "weights");
    return;
  }
  const Json& meshes = array_at(checks.root, "meshes");
  if (static_cast<std::size_t>(mesh) >= meshes.size()) return;
  const Json& primitives = array_at(meshes[static_cast<std::size_t>(mesh)], "primitives");
  if (primitives.empty()) return;
  const std::size_t weights = array_at(node, "weights").size(), targets = array_at(primitives[0], "targets").size();
  if (weights != 0 && weights != targets)
    checks.findings.error("NODE_WEIGHTS_INVALID", fmt::format("{} weights for {} targets", weights, targets), path / "weights");
  const std::int64_t skin = index_of(node, "skin");
  const bool has_skin = skin >= 0 && static_cast<std::size_t>(skin) < array_at(checks.root, "skins").size();
  if (has_skin && std::none_of(primitives.begin(), primitives.end(), has_joints))
    checks.findings.error("NODE_SKIN_WITH_NON_SKINNED_MESH", "a skin, and a mesh without JOINTS", path);
  if (!has_skin && std::any_of(primitives.begin(), primitives.end(), has_joints))
    checks.findings.warning("NODE_SKINNED_MESH_WITHOUT_SKIN", "a mesh with JOINTS, and no skin: it is shown as it stands", path);
}

void find_parents(Checks& checks, const Json& nodes, const Path& path) {
  checks.parents.assign(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Path node = path / i, children = node / "children";
    const Json& list = array_at(nodes[i], "children");
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (!list[k].is_number_integer()) continue;
      const auto child = list[k].get<double>();
      if (!(child >= 0 && child < static_cast<double>(nodes.size()))) continue;
      std::int64_t& parent = checks.parents[static_cast<std::size_t>(child)];
      if (parent >= 0)
        checks.findings.error("NODE_PARENT_OVERRIDE", fmt::format("node {} is a child of node {} already", child, parent), children / k);
      parent = static_cast<std::int64_t>(i);
    }
  }
}

// Follows parents from every node once. 0: not looked at, 1: on the way that is being followed, 2: done.
void find_loops(Checks& checks, const Path& path) {
  const auto& parents = checks.parents;
  std::vector<char> state(parents.size(), 0);
  checks.depths.assign(parents.size(), 1);
  for (std::size_t start = 0; start < parents.size(); ++start) {
    std::vector<std::size_t> way;
    auto at = static_cast<std::int64_t>(start);
    while (at >= 0 && state[static_cast<std::size_t>(at)] == 0) {
      state[static_cast<std::size_t>(at)] = 1;
      way.push_back(static_cast<std::size_t>(at));
      at = parents[static_cast<std::size_t>(at)];
    }
    if (at >= 0 && state[static_cast<std::size_t>(at)] == 1) {
      checks.is_forest = false;
      for (auto member = std::find(way.begin(), way.end(), static_cast<std::size_t>(at)); member != way.end(); ++member)
        checks.findings.error("NODE_LOOP", fmt::format("node {} is its own ancestor", *member), path / *member);
    }
    std::reverse(way.begin(), way.end());
    for (const std::size_t node : way) {
      state[node] = 2;
      const std::int64_t parent = parents[node];
      if (parent >= 0) checks.depths[node] = checks.depths[static_cast<std::size_t>(parent)] + 1;
    }
  }
}

void check_scenes(Checks& checks) {
  const Path root, path = root / "scenes";
  const Json& scenes = array_at(checks.root, "scenes");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Path scene = path / i, nodes = scene / "nodes";
    const Json& list = array_at(scenes[i], "nodes");
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (!list[k].is_number_integer()) continue;
      const auto node = list[k].get<double>();
      if (node >= 0 && node < static_cast<double>(checks.parents.size()) && checks.parents[static_cast<std::size_t>(node)] >= 0)
        checks.findings.error("SCENE_NON_ROOT_NODE", fmt::format("node {} has a parent", node), nodes / k);
    }
  }
}

std::vector<bool> joints_of(const Checks& checks, std::size_t nodes) {
  std::vector<bool> joints(nodes, false);
  for (const Json& skin : array_at(checks.root, "skins"))
    for (const Json& joint : array_at(skin, "joints"))
      if (joint.is_number_integer() && joint.get<double>() >= 0 && joint.get<double>() < static_cast<double>(nodes))
        joints[joint.get<std::size_t>()] = true;
  return joints;
}

}  // namespace

void check_nodes(Checks& checks) {
  const Path root, path = root / "nodes";
  const Json& nodes = array_at(checks.root, "nodes");
  const std::vector<bool> is_joint = joints_of(checks, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Path node = path / i;
    if (!nodes[i].is_object()) continue;
    check_transform(checks, nodes[i], node);
    check_mesh_use(checks, nodes[i], node);
    constexpr const char* contents[] = {"children", "mesh", "camera", "extensions", "extras"};
    const auto holds = [&](const char* key) { return nodes[i].contains(key); };
    if (!is_joint[i] && std::none_of(std::begin(contents), std::end(contents), holds))
      checks.findings.note("NODE_EMPTY", "a node without anything", node);
  }
  find_parents(checks, nodes, path);
  find_loops(checks, path);
  check_scenes(checks);
}

}  // namespace etendue::gltf
