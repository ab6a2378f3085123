// The node hierarchy of the default scene as objects, lights and cameras in the world.
#pragma once

#include "asset.h"
#include "materials.h"
#include "meshes.h"
#include "node_tree.h"
#include "pose.h"

#include <set>
#include <string>
#include <vector>

namespace etendue::gltf {

class Nodes {
 public:
  Nodes(Asset& asset, Scene& scene);

  void read_default_scene();
  // Those that no surface of it shows come behind the others.
  void read_every_material();

 private:
  void visit(int node, const Transform& parent_to_world, int depth);
  bool is_hidden(int node) const;
  void add_camera(int node, const Transform& to_world);
  void add_lights(int node, const Transform& to_world);
  void add_environment();
  void add_mesh(int node, const Transform& to_world);
  void add_primitive(int node, std::size_t primitive, const Pose& pose, const Transform& to_world);
  void add_light(Light light, const std::string& node_name);
  bool has_orientation(const Transform& to_world, const char* what, const std::string& pointer);
  bool wants(Need need) const { return has(asset_.options().need, need); }

  Asset& asset_;
  Scene& scene_;
  NodeTree tree_;
  Poses poses_;
  Materials materials_;
  Meshes meshes_;
  std::set<std::string> light_names_;
};

}  // namespace etendue::gltf
