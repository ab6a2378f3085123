// The shape that a mesh has in the pose of the file: morph targets by their weights, then the joints where their nodes stand.
#pragma once

#include "asset.h"
#include "node_tree.h"
#include "primitive_data.h"

#include <map>
#include <vector>

namespace etendue::gltf {

struct Pose {
  int node = -1;                  // whose
  std::vector<double> weights;    // of the morph targets; empty: all 0
  std::vector<Transform> joints;  // from the space of the mesh to the world; empty: no skin
  bool is_at_base() const { return weights.empty() && joints.empty(); }
};

class Poses {
 public:
  Poses(Asset& asset, NodeTree& tree) : asset_(asset), tree_(tree) {}
  // Of the node's mesh, by the node's or the mesh's weights and the node's skin. What is wrong with a skin is reported, and it is left out.
  Pose of(int node);

 private:
  Asset& asset_;
  NodeTree& tree_;
  std::map<int, std::vector<Transform>> joints_;  // of a skin: the same whichever node has it
};

// Moves positions, normals and tangents. With joints the mesh is in the world afterwards, wherever its node is (3.7.3.3).
Status apply_pose(const PrimitiveData& data, Asset& asset, const Pose& pose, Mesh& mesh);

}  // namespace etendue::gltf
