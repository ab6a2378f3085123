// Joints and weights of skinned meshes: joints that the skin has, once a vertex, and weights that sum to one.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "data_checks.h"

namespace etendue::gltf {
namespace {

// Half a step of a normalised byte for each pair of weights beyond the first two, as the validator has it.
constexpr double step = 1.0 / 255;

struct Fault {
  std::size_t count = 0, first = 0;
  void add(std::size_t vertex) {
    if (count++ == 0) first = vertex;
  }
};
struct Faults {
  Fault joint_beyond, joint_twice, weight_negative, sum, joint_without_weight;
};

std::vector<double> all_values(const Elements& elements) {
  std::vector<double> values(elements.count * 4);
  with_type(elements.format.component, [&](auto type) {
    for (std::size_t i = 0; i < elements.count; ++i)
      for (std::size_t c = 0; c < 4; ++c) values[4 * i + c] = value_at<decltype(type)>(elements, i, c);
  });
  return values;
}

class InfluenceCheck {
 public:
  InfluenceCheck(DataChecks& checks, const Json& attributes, std::string pointer, std::size_t joints)
      : checks_(checks), attributes_(attributes), pointer_(std::move(pointer)), joint_count_(joints) {}

  void run() {
    for (std::size_t set = 0; load(set); ++set) {
    }
    if (joints_.empty()) return;
    const std::size_t vertices = joints_.front().size() / 4;
    Faults faults;
    for (std::size_t v = 0; v < vertices; ++v) check_vertex(v, faults);
    report(faults);
  }

 private:
  // One of JOINTS_n and WEIGHTS_n; false where there are no more, or not as many as of the first.
  bool load(std::size_t set) {
    const std::int64_t joints = index_of(attributes_, fmt::format("JOINTS_{}", set).c_str());
    const std::int64_t weights = index_of(attributes_, fmt::format("WEIGHTS_{}", set).c_str());
    if (joints < 0 || weights < 0) return false;
    const auto joint_elements = checks_.elements(joints), weight_elements = checks_.elements(weights);
    const bool good = joint_elements && weight_elements && joint_elements->format.shape == Shape::vec4 &&
                      weight_elements->format.shape == Shape::vec4 && joint_elements->count == weight_elements->count &&
                      (joints_.empty() || joints_.front().size() == 4 * joint_elements->count);
    if (!good) {
      joints_.clear();
      return false;
    }
    joints_.push_back(all_values(*joint_elements));
    weights_.push_back(all_values(*weight_elements));
    return true;
  }

  void check_vertex(std::size_t vertex, Faults& faults) {
    used_.clear();
    float sum = 0;  // in the precision that the weights have
    bool twice = false;
    for (std::size_t set = 0; set < joints_.size(); ++set)
      for (std::size_t c = 0; c < 4; ++c) {
        const double joint = joints_[set][4 * vertex + c], weight = weights_[set][4 * vertex + c];
        if (joint >= static_cast<double>(joint_count_)) {
          faults.joint_beyond.add(vertex);
        } else if (weight == 0) {
          if (joint != 0) faults.joint_without_weight.add(vertex);
        } else if (std::find(used_.begin(), used_.end(), joint) != used_.end()) {
          twice = true;
          if (weight < 0) faults.weight_negative.add(vertex);
        } else {
          used_.push_back(joint);
          if (weight < 0) {
            faults.weight_negative.add(vertex);
          } else {
            sum += static_cast<float>(weight);
          }
        }
      }
    if (twice) faults.joint_twice.add(vertex);
    const std::size_t pairs = (used_.size() + 1) / 2;
    if (!(std::abs(static_cast<double>(sum) - 1) <= step * (static_cast<double>(pairs) - 1))) faults.sum.add(vertex);
  }

  void report(const Faults& faults) {
    const auto error = [&](const Fault& fault, const char* code, const char* what, const char* attribute) {
      if (fault.count > 0)
        checks_.asset.error(code, fmt::format("{} vertices {}, the first is number {}", fault.count, what, fault.first),
                            pointer_ + "/" + attribute);
    };
    error(faults.joint_beyond, "ACCESSOR_JOINTS_INDEX_OOB", "name joints that the skin does not have", "JOINTS_0");
    error(faults.joint_twice, "ACCESSOR_JOINTS_INDEX_DUPLICATE", "name a joint twice", "JOINTS_0");
    error(faults.weight_negative, "ACCESSOR_WEIGHTS_NEGATIVE", "have negative weights", "WEIGHTS_0");
    error(faults.sum, "ACCESSOR_WEIGHTS_NON_NORMALIZED", "have weights that do not sum to 1", "WEIGHTS_0");
    if (faults.joint_without_weight.count > 0)
      checks_.asset.warning("ACCESSOR_JOINTS_USED_ZERO_WEIGHT",
                            fmt::format("{} vertices name joints with a weight of zero", faults.joint_without_weight.count),
                            pointer_ + "/JOINTS_0");
  }

  DataChecks& checks_;
  const Json& attributes_;
  std::string pointer_;
  std::size_t joint_count_;
  std::vector<std::vector<double>> joints_, weights_;  // by set
  std::vector<double> used_;
};

// Of each mesh, the fewest joints of a skin that a node shows it with; 0: none.
std::vector<std::size_t> joints_by_mesh(const Json& root) {
  const Json& skins = array_at(root, "skins");
  std::vector<std::size_t> joints(array_at(root, "meshes").size(), 0);
  for (const Json& node : array_at(root, "nodes")) {
    const std::int64_t mesh = index_of(node, "mesh"), skin = index_of(node, "skin");
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= joints.size() || skin < 0 || static_cast<std::size_t>(skin) >= skins.size()) continue;
    const std::size_t count = array_at(skins[static_cast<std::size_t>(skin)], "joints").size();
    std::size_t& fewest = joints[static_cast<std::size_t>(mesh)];
    if (count > 0) fewest = fewest == 0 ? count : std::min(fewest, count);
  }
  return joints;
}

}  // namespace

void check_influences(DataChecks& checks) {
  const Json& meshes = array_at(checks.asset.json(), "meshes");
  const std::vector<std::size_t> joints = joints_by_mesh(checks.asset.json());
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (joints[m] == 0) continue;
    const Json& primitives = array_at(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p)
      InfluenceCheck(checks, object_at(primitives[p], "attributes"), fmt::format("/meshes/{}/primitives/{}/attributes", m, p), joints[m])
          .run();
  }
}

}  // namespace etendue::gltf
