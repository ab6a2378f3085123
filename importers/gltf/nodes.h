// The node hierarchy of the default scene as objects, lights and cameras in the world.
#pragma once

#include "asset.h"
#include "materials.h"
#include "meshes.h"

#include <set>
#include <string>
#include <vector>

namespace etendue::gltf {

class Nodes {
 public:
  Nodes(Asset& asset, Scene& scene);

  void read_default_scene();

 private:
  std::vector<int> roots();
  bool is_forest();
  void visit(int node, const Transform& parent_to_world, int depth);
  std::optional<Transform> local_transform(int node);
  void add_camera(int node, const Transform& to_world);
  void add_lights(int node, const Transform& to_world);
  void add_mesh(int node, const Transform& to_world);
  void add_light(Light light, const std::string& node_name);
  bool has_orientation(const Transform& to_world, const char* what, const std::string& pointer);
  std::string name_of(int node) const;

  Asset& asset_;
  Scene& scene_;
  Materials materials_;
  Meshes meshes_;
  std::set<std::string> light_names_;
};

}  // namespace etendue::gltf
