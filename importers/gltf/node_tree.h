// The node hierarchy: who is above whom, and where a node stands in the world.
#pragma once

#include "asset.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue::gltf {

class NodeTree {
 public:
  explicit NodeTree(Asset& asset) : asset_(asset) {}

  // A node has one parent at most, and following parents ends at a root (3.5.2). Without it no walk is sure to end: nothing else may be
  // asked then. What breaks it is reported.
  bool is_forest();
  // The scene that is read: the default one, else the first; -1 if the file has none, and all its roots are one.
  int scene() const;
  std::vector<int> roots() const;
  // None (and reported, once) where a transform is no affine map that can be undone.
  std::optional<Transform> local(int node);
  std::optional<Transform> world(int node);

 private:
  std::optional<Transform> read_local(int node);
  Asset& asset_;
  std::vector<int> parents_;
  std::map<int, std::optional<Transform>> locals_, worlds_;
};

bool is_finite(const Transform& t);
// Relative to the axes' lengths: 0 where the image of space is a plane, a line or a point, 1 for orthogonal axes. At most `flat`: nothing.
double spread(const Transform& t);
constexpr double flat = 1e-9;

std::string node_pointer(int node);

}  // namespace etendue::gltf
