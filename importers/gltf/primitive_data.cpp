#include "primitive_data.h"

#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accessors.h"

namespace etendue::gltf {

Result<PrimitiveData> PrimitiveData::open(Asset& asset, const tinygltf::Primitive& primitive, const std::string& pointer) {
  PrimitiveData data(asset, primitive, pointer);
  const nlohmann::json* extension = asset.extension(pointer, "KHR_draco_mesh_compression");
  if (extension != nullptr && draco_is_built()) {
    auto mesh = decode_draco(asset, *extension, pointer + "/extensions/KHR_draco_mesh_compression");
    if (!mesh) return mesh.error();
    data.compressed_ = std::move(*mesh);
  }
  return data;
}

bool PrimitiveData::has(const std::string& attribute) const { return primitive_->attributes.contains(attribute); }

std::string PrimitiveData::pointer_of(const std::string& attribute) const { return pointer_to(pointer_ + "/attributes", attribute); }

const DracoMesh::Attribute* PrimitiveData::stored_as(const std::string& attribute) const {
  if (!compressed_) return nullptr;
  const auto found = compressed_->attributes.find(attribute);
  return found == compressed_->attributes.end() ? nullptr : &found->second;
}

template <class Vector>
Result<std::vector<Vector>> PrimitiveData::vectors(const std::string& name, Result<std::vector<Vector>> (*read)(Asset&, int)) const {
  const auto found = primitive_->attributes.find(name);
  if (found == primitive_->attributes.end())
    return asset_->failure("UNDEFINED_PROPERTY", fmt::format("expected the attribute {}, which is missing", name),
                           pointer_ + "/attributes");
  asset_->take(pointer_of(name));
  const DracoMesh::Attribute* stored = stored_as(name);
  if (stored == nullptr) return read(*asset_, found->second);
  constexpr std::size_t width = sizeof(Vector) / sizeof(float);
  if (stored->width != width)
    return asset_->failure("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
                           fmt::format("expected {} numbers an element, found {}", width, stored->width), pointer_of(name));
  std::vector<Vector> values(stored->numbers.size() / width);
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), stored->numbers.data(), values.size() * sizeof(Vector));
  return values;
}

Result<std::vector<Vec2f>> PrimitiveData::vec2(const std::string& attribute) const { return vectors<Vec2f>(attribute, read_vec2); }
Result<std::vector<Vec3f>> PrimitiveData::vec3(const std::string& attribute) const { return vectors<Vec3f>(attribute, read_vec3); }
Result<std::vector<Vec4f>> PrimitiveData::vec4(const std::string& attribute) const { return vectors<Vec4f>(attribute, read_vec4); }

Result<std::vector<Vec4f>> PrimitiveData::colours(const std::string& attribute) const {
  const DracoMesh::Attribute* stored = stored_as(attribute);
  if (stored == nullptr || stored->width != 3) return vectors<Vec4f>(attribute, read_colours);
  asset_->take(pointer_of(attribute));
  const std::vector<float>& rgb = stored->numbers;
  std::vector<Vec4f> values(rgb.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 1};
  return values;
}

bool PrimitiveData::has_indices() const { return compressed_ || primitive_->indices >= 0; }

Result<std::vector<std::uint32_t>> PrimitiveData::indices() const {
  if (compressed_) return compressed_->indices;
  return read_indices(*asset_, primitive_->indices);
}

}  // namespace etendue::gltf
