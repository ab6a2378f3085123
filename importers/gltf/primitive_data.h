// The arrays of a primitive, whether they stand in accessors or in what KHR_draco_mesh_compression holds.
#pragma once

#include "asset.h"
#include "draco_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue::gltf {

class PrimitiveData {
 public:
  static Result<PrimitiveData> open(Asset& asset, const tinygltf::Primitive& primitive, const std::string& pointer);

  const tinygltf::Primitive& primitive() const { return *primitive_; }
  const std::string& pointer() const { return pointer_; }
  bool has(const std::string& attribute) const;
  std::string pointer_of(const std::string& attribute) const;

  // Errors are those of read_vec3() and its like.
  Result<std::vector<Vec2f>> vec2(const std::string& attribute) const;
  Result<std::vector<Vec3f>> vec3(const std::string& attribute) const;
  Result<std::vector<Vec4f>> vec4(const std::string& attribute) const;
  Result<std::vector<Vec4f>> colours(const std::string& attribute) const;
  bool has_indices() const;
  Result<std::vector<std::uint32_t>> indices() const;

 private:
  PrimitiveData(Asset& asset, const tinygltf::Primitive& primitive, std::string pointer)
      : asset_(&asset), primitive_(&primitive), pointer_(std::move(pointer)) {}
  const DracoMesh::Attribute* stored_as(const std::string& attribute) const;  // null: in accessors
  template <class Vector>
  Result<std::vector<Vector>> vectors(const std::string& attribute, Result<std::vector<Vector>> (*read)(Asset&, int)) const;

  Asset* asset_;
  const tinygltf::Primitive* primitive_;
  std::string pointer_;
  std::optional<DracoMesh> compressed_;
};

}  // namespace etendue::gltf
