// Skins: joints with a common root, and their inverse bind matrices.
#include <fmt/format.h>

#include <algorithm>

#include "checks.h"

namespace etendue::gltf {
namespace {

class SkinCheck {
 public:
  SkinCheck(Checks& checks, std::size_t skins) : checks_(checks), seen_(checks.parents.size(), -1), top_(skins, -1) {
    deepest_ = checks.depths.empty() ? 0 : *std::max_element(checks.depths.begin(), checks.depths.end());
  }

  void run(std::size_t index, const Json& skin, const Path& path) {
    check_matrices(skin, path);
    // Each joint is followed to its root below: not over a loop, and not over more levels than may be.
    if (!checks_.is_forest || deepest_ > checks_.max_depth) return;
    const std::vector<std::size_t> joints = nodes_of(array_at(skin, "joints"));
    if (joints.empty()) return;
    const std::int64_t root = common_root(static_cast<std::int64_t>(index), joints);
    if (root < 0) checks_.findings.error("SKIN_NO_COMMON_ROOT", "the joints stand in different trees", path / "joints");
    const std::int64_t skeleton = index_of(skin, "skeleton");
    if (skeleton >= 0 && static_cast<std::size_t>(skeleton) < checks_.parents.size() && !is_above(skeleton, root))
      checks_.findings.error("SKIN_SKELETON_INVALID", fmt::format("node {} is not above all joints", skeleton), path / "skeleton");
    if (root >= 0) top_[index] = top_of(root);
  }

  void check_users();

 private:
  void check_matrices(const Json& skin, const Path& path) {
    const Path here = path / "inverseBindMatrices";
    const std::int64_t index = index_of(skin, "inverseBindMatrices");
    const Accessor* accessor = checks_.records.accessor(index);
    if (accessor == nullptr) return;
    use_accessor(checks_, index, Usage::inverse_bind_matrices, here);
    use_view(checks_, accessor->view, Usage::inverse_bind_matrices, here);
    if (const View* view = checks_.records.view(accessor->view); view != nullptr && view->stride != 0)
      checks_.findings.error("SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE", "inverse bind matrices lie in a view without byteStride", here);
    const Format expected{Shape::mat4, 5126, false};
    if (accessor->format != expected)
      checks_.findings.error("SKIN_IBM_INVALID_FORMAT", format_expected(accessor->format, {expected}), here);
    const std::size_t joints = array_at(skin, "joints").size();
    if (accessor->count < joints)
      checks_.findings.error("INVALID_IBM_ACCESSOR_COUNT", fmt::format("expected {} matrices, found {}", joints, accessor->count), here);
  }

  std::vector<std::size_t> nodes_of(const Json& list) const {
    std::vector<std::size_t> nodes;
    for (const Json& one : list)
      if (one.is_number_integer() && one.get<double>() >= 0 && one.get<double>() < static_cast<double>(checks_.parents.size()))
        nodes.push_back(one.get<std::size_t>());
    return nodes;
  }

  // The deepest node above or at all joints; -1 if there is none. A way up that meets one that was gone before goes on as that did: the
  // common root is the higher one of where they met and the root so far.
  std::int64_t common_root(std::int64_t skin, const std::vector<std::size_t>& joints) {
    std::int64_t root = -1;
    for (const std::size_t joint : joints) {
      auto at = static_cast<std::int64_t>(joint);
      while (at >= 0 && seen_[static_cast<std::size_t>(at)] != skin) {
        seen_[static_cast<std::size_t>(at)] = skin;
        at = checks_.parents[static_cast<std::size_t>(at)];
      }
      if (root < 0 && at < 0) {
        root = static_cast<std::int64_t>(joint);
      } else if (at < 0) {
        return -1;
      } else if (depth(at) < depth(root)) {
        root = at;
      }
    }
    return root;
  }

  int depth(std::int64_t node) const { return checks_.depths[static_cast<std::size_t>(node)]; }
  bool is_above(std::int64_t node, std::int64_t other) const {
    while (other >= 0 && other != node) other = checks_.parents[static_cast<std::size_t>(other)];
    return other >= 0;
  }
  std::int64_t top_of(std::int64_t node) const {
    while (checks_.parents[static_cast<std::size_t>(node)] >= 0) node = checks_.parents[static_cast<std::size_t>(node)];
    return node;
  }
  bool moves(const Json& node) const;

  Checks& checks_;
  std::vector<std::int64_t> seen_, top_;  // top_: of each skin, the root above its joints
  int deepest_ = 0;
};

bool SkinCheck::moves(const Json& node) const {
  static const Json zero = {0, 0, 0}, one = {1, 1, 1}, none = {0, 0, 0, 1};
  static const Json identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto differs = [&](const char* key, const Json& neutral) { return node.contains(key) && node[key] != neutral; };
  return differs("matrix", identity) || differs("translation", zero) || differs("rotation", none) || differs("scale", one);
}

// A scene that shows a skinned mesh has to show its joints as well.
void SkinCheck::check_users() {
  const Json &nodes = array_at(checks_.root, "nodes"), &scenes = array_at(checks_.root, "scenes");
  if (!checks_.is_forest || deepest_ > checks_.max_depth || top_.empty()) return;
  std::vector<std::vector<std::size_t>> shown_by(nodes.size());  // scenes, by root node
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (const std::size_t node : nodes_of(array_at(scenes[s], "nodes"))) shown_by[node].push_back(s);
  const Path root, path = root / "nodes";
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::int64_t skin = index_of(nodes[i], "skin");
    if (skin < 0 || static_cast<std::size_t>(skin) >= top_.size()) continue;
    const Path here = path / i;
    if (checks_.parents[i] >= 0)
      checks_.findings.warning("NODE_SKINNED_MESH_NON_ROOT", "transforms of its parents do not move a skinned mesh", here);
    if (moves(nodes[i])) checks_.findings.warning("NODE_SKINNED_MESH_LOCAL_TRANSFORMS", "its transform does not move a skinned mesh", here);
    const std::int64_t top = top_[static_cast<std::size_t>(skin)];
    const auto own_top = static_cast<std::size_t>(top_of(static_cast<std::int64_t>(i)));
    if (top < 0 || static_cast<std::size_t>(top) == own_top) continue;
    const auto &mine = shown_by[own_top], &theirs = shown_by[static_cast<std::size_t>(top)];
    if (!std::includes(theirs.begin(), theirs.end(), mine.begin(), mine.end()))
      checks_.findings.error("NODE_SKIN_NO_SCENE", "a scene shows the mesh and not the joints of its skin", here);
  }
}

}  // namespace

void check_skins(Checks& checks) {
  const Path root, path = root / "skins";
  const Json& skins = array_at(checks.root, "skins");
  SkinCheck check(checks, skins.size());
  for (std::size_t i = 0; i < skins.size(); ++i)
    if (skins[i].is_object()) check.run(i, skins[i], path / i);
  check.check_users();
}

}  // namespace etendue::gltf
