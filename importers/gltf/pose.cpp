#include "pose.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accessors.h"
#include "json_values.h"

namespace etendue::gltf {
namespace {

// A joint's index and its share of a vertex.
struct Influences {
  std::vector<Vec4f> joints, weights;
};

Vec3d xyz(const Vec4f& v) { return {v.x, v.y, v.z}; }

// 3.7.2.2: base + sum of weight x displacement. Tangents' signs stay.
template <class Vector>
void add(std::vector<Vector>& base, const std::vector<Vec3f>& displacement, double weight) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    base[i].x += static_cast<float>(weight * displacement[i].x);
    base[i].y += static_cast<float>(weight * displacement[i].y);
    base[i].z += static_cast<float>(weight * displacement[i].z);
  }
}

template <class Vector>
Status add_target(const PrimitiveData& data, Asset& asset, std::size_t target, const char* attribute, double weight,
                  std::vector<Vector>& base) {
  const auto& attributes = data.primitive().targets[target];
  const auto found = attributes.find(attribute);
  if (found == attributes.end() || base.empty()) return Done{};
  const auto displacement = read_vec3(asset, found->second);
  if (!displacement) return displacement.error();
  if (displacement->size() != base.size())
    return asset.failure("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
                         fmt::format("expected {} displacements, one a vertex, found {}", base.size(), displacement->size()),
                         fmt::format("{}/targets/{}/{}", data.pointer(), target, attribute));
  add(base, *displacement, weight);
  return Done{};
}

// The weighted sum of the joints' maps; weights that do not add up to 1 are scaled to, so that nothing shrinks towards the origin.
Transform blended(const Pose& pose, const std::vector<Influences>& influences, std::size_t vertex, bool& known) {
  Transform sum{{Vec3d{}, Vec3d{}, Vec3d{}}, {}};
  double total = 0;
  for (const Influences& set : influences) {
    const Vec4f &j = set.joints[vertex], &w = set.weights[vertex];
    for (const auto& [joint, weight] : {std::pair{j.x, w.x}, {j.y, w.y}, {j.z, w.z}, {j.w, w.w}}) {
      if (!(weight > 0)) continue;
      // A file with joints of a wrong type, which is reported, may have any number here.
      if (!(joint >= 0 && static_cast<double>(joint) < static_cast<double>(pose.joints.size()))) {
        known = false;
        continue;
      }
      const Transform& map = pose.joints[static_cast<std::size_t>(joint)];
      for (std::size_t c = 0; c < 3; ++c) sum.columns[c] += map.columns[c] * static_cast<double>(weight);
      sum.translation += map.translation * static_cast<double>(weight);
      total += weight;
    }
  }
  if (!(total > 0)) return Transform{};
  for (Vec3d& column : sum.columns) column = column / total;
  sum.translation = sum.translation / total;
  return sum;
}

Result<std::vector<Influences>> read_influences(const PrimitiveData& data, Asset& asset, std::size_t vertices) {
  std::vector<Influences> sets;
  for (int n = 0; data.has(fmt::format("JOINTS_{}", n)) && data.has(fmt::format("WEIGHTS_{}", n)); ++n) {
    auto joints = data.vec4(fmt::format("JOINTS_{}", n));
    if (!joints) return joints.error();
    auto weights = data.vec4(fmt::format("WEIGHTS_{}", n));
    if (!weights) return weights.error();
    if (joints->size() != vertices || weights->size() != vertices)
      return asset.failure("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", fmt::format("expected {} joints and weights, one a vertex", vertices),
                           data.pointer_of(fmt::format("JOINTS_{}", n)));
    sets.push_back({std::move(*joints), std::move(*weights)});
  }
  return sets;
}

Transform inverse_bind_matrix(const std::vector<float>& matrices, std::size_t joint) {
  if (matrices.empty()) return {};
  std::array<double, 16> m{};
  std::copy_n(matrices.begin() + static_cast<std::ptrdiff_t>(16 * joint), 16, m.begin());
  return Transform::from_column_major(m);
}

std::vector<Transform> joints_of(Asset& asset, NodeTree& tree, int skin) {
  const std::string pointer = fmt::format("/skins/{}", skin);
  const nlohmann::json::json_pointer place(pointer + "/joints");
  if (!asset.json().contains(place) || !asset.json().at(place).is_array()) return {};
  const nlohmann::json& joints = asset.json().at(place);
  std::vector<float> matrices;
  if (const int accessor = int_index_of(asset.json().at(place.parent_pointer()), "inverseBindMatrices"); accessor >= 0) {
    auto read = read_numbers(asset, accessor, 16);
    if (!read) {
      asset.error(read.error());
      return {};
    }
    matrices = std::move(*read);
    if (matrices.size() < 16 * joints.size()) {
      asset.error("INVALID_IBM_ACCESSOR_COUNT",
                  fmt::format("expected {} matrices, one a joint, found {}", joints.size(), matrices.size() / 16),
                  pointer + "/inverseBindMatrices");
      return {};
    }
  }
  std::vector<Transform> maps;
  for (const auto& joint : joints) {
    const double node = joint.is_number_integer() ? joint.get<double>() : -1;
    if (!(node >= 0 && node < static_cast<double>(asset.model().nodes.size()))) return {};  // reported by the schema's check
    const auto world = tree.world(static_cast<int>(node));
    if (!world) return {};
    maps.push_back(*world * inverse_bind_matrix(matrices, maps.size()));
  }
  return maps;
}

Status apply_targets(const PrimitiveData& data, Asset& asset, const Pose& pose, Mesh& mesh) {
  for (std::size_t t = 0; t < std::min(pose.weights.size(), data.primitive().targets.size()); ++t) {
    const double weight = pose.weights[t];
    if (weight == 0) continue;
    Status added = add_target(data, asset, t, "POSITION", weight, mesh.positions);
    if (added) added = add_target(data, asset, t, "NORMAL", weight, mesh.normals);
    if (added) added = add_target(data, asset, t, "TANGENT", weight, mesh.tangents);
    if (!added) return added;
  }
  return Done{};
}

Status apply_joints(const PrimitiveData& data, Asset& asset, const Pose& pose, Mesh& mesh) {
  if (pose.joints.empty()) return Done{};
  const auto influences = read_influences(data, asset, mesh.positions.size());
  if (!influences) return influences.error();
  if (influences->empty())
    return asset.failure("NODE_SKINNED_MESH_WITHOUT_SKIN_DATA", "expected JOINTS_0 and WEIGHTS_0 of a mesh whose node has a skin",
                         data.pointer() + "/attributes");
  bool known = true;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Transform map = blended(pose, *influences, i, known);
    mesh.positions[i] = vec_cast<float>(map.point(vec_cast<double>(mesh.positions[i])));
    if (!mesh.normals.empty()) mesh.normals[i] = vec_cast<float>(normalised(map.normal(vec_cast<double>(mesh.normals[i]))));
    if (!mesh.tangents.empty()) {
      const Vec3d turned = normalised(map.vector(xyz(mesh.tangents[i])));
      mesh.tangents[i] = {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z), mesh.tangents[i].w};
    }
  }
  if (!known)
    return asset.failure("ACCESSOR_JOINTS_INDEX_OOB", fmt::format("expected joints below {}", pose.joints.size()),
                         data.pointer_of("JOINTS_0"));
  return Done{};
}

// Vectors of floats and nothing else.
template <class Vector>
bool all_finite(const std::vector<Vector>& vectors) {
  return gltf::all_finite({reinterpret_cast<const float*>(vectors.data()), vectors.size() * sizeof(Vector) / sizeof(float)});
}

}  // namespace

Pose Poses::of(int index) {
  const tinygltf::Node& node = asset_.model().nodes[static_cast<std::size_t>(index)];
  const tinygltf::Mesh& mesh = asset_.model().meshes[static_cast<std::size_t>(node.mesh)];
  Pose pose{index, node.weights.empty() ? mesh.weights : node.weights, {}};
  if (std::all_of(pose.weights.begin(), pose.weights.end(), [](double weight) { return weight == 0; })) pose.weights.clear();
  if (node.skin < 0) return pose;
  auto known = joints_.find(node.skin);
  if (known == joints_.end()) known = joints_.emplace(node.skin, joints_of(asset_, tree_, node.skin)).first;
  pose.joints = known->second;
  return pose;
}

Status apply_pose(const PrimitiveData& data, Asset& asset, const Pose& pose, Mesh& mesh) {
  Status done = apply_targets(data, asset, pose, mesh);
  if (done) done = apply_joints(data, asset, pose, mesh);
  if (done && !(all_finite(mesh.positions) && all_finite(mesh.normals) && all_finite(mesh.tangents)))
    return asset.failure("POSE_INVALID", "weights or joints move vertices beyond what single precision can hold", data.pointer());
  return done;
}

}  // namespace etendue::gltf
