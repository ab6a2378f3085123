// Primitives as triangle meshes, read when a node first shows them.
#pragma once

#include "asset.h"
#include "materials.h"
#include "pose.h"
#include "primitive_data.h"

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

namespace etendue::gltf {

class Meshes {
 public:
  // Meshes are appended to the scene's. `read` false: they stay empty (name and source alone), no byte is touched.
  Meshes(Asset& asset, Scene& scene, bool read) : asset_(asset), scene_(scene), read_(read) {}

  // Index into Scene::meshes; none if it is broken (reported) or no triangles (named). A pose makes a mesh of the node's own.
  std::optional<std::uint32_t> at(int mesh, std::size_t primitive, const Materials::Entry& material, const Pose& pose);

 private:
  std::optional<Mesh> load(const tinygltf::Primitive& primitive, const std::string& pointer, const Materials::Entry& material,
                           const Pose& pose);
  Status read_vertices(const PrimitiveData& data, Mesh& mesh);
  Status read_triangles(const PrimitiveData& data, Mesh& mesh);
  Status read_uvs(const PrimitiveData& data, const Materials::Entry& material, Mesh& mesh);
  void name_unshown(const PrimitiveData& data, const Materials::Entry& material, const Mesh& mesh);
  Status spend(std::size_t elements, const std::string& pointer);

  Asset& asset_;
  Scene& scene_;
  bool read_;
  std::size_t spent_ = 0;  // elements decoded so far
  bool is_full_ = false;   // one more mesh would be over the limit
  std::map<std::tuple<int, std::size_t, int>, std::optional<std::uint32_t>> known_;
};

// Indices of triangles from those of a primitive of mode 4, 5 or 6 (3.7.2.1); a rest that makes no triangle is left out.
std::vector<std::uint32_t> triangles_of(int mode, std::vector<std::uint32_t> indices);

}  // namespace etendue::gltf
