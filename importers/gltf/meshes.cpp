#include "meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "accessors.h"

namespace etendue::gltf {
namespace {

const char* mode_name(int mode) {
  switch (mode) {
    case 0:
      return "points";
    case 1:
      return "lines";
    case 2:
      return "a line loop";
    default:
      return "a line strip";
  }
}

std::optional<int> attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? std::nullopt : std::optional<int>(found->second);
}

// Unit vectors, as 3.7.2.1 wants normals. False if one has no direction.
bool normalise(std::vector<Vec3f>& normals) {
  for (Vec3f& normal : normals) {
    const Vec3d unit = normalised(vec_cast<double>(normal));
    if (!(dot(unit, unit) > 0)) return false;
    normal = vec_cast<float>(unit);
  }
  return true;
}

std::vector<Vec3f> triples(const std::vector<float>& values) {
  std::vector<Vec3f> out(values.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return out;
}

}  // namespace

std::vector<std::uint32_t> triangles_of(int mode, const std::vector<std::uint32_t>& indices) {
  const std::size_t count = indices.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) return {indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(count - count % 3)};
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
      out.insert(out.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    } else {
      out.insert(out.end(), {indices[i + 1], indices[i + 2], indices[0]});
    }
  }
  return out;
}

std::optional<std::uint32_t> Meshes::at(int mesh, std::size_t primitive, const Materials::Entry& material) {
  const auto key = std::make_pair(mesh, primitive);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const tinygltf::Mesh& source = asset_.model().meshes[static_cast<std::size_t>(mesh)];
  const std::string pointer = fmt::format("/meshes/{}/primitives/{}", mesh, primitive);
  std::optional<Mesh> loaded = load(source.primitives[primitive], pointer, material);
  std::optional<std::uint32_t> index;
  if (loaded) {
    loaded->name = source.name.empty() ? fmt::format("mesh {}", mesh) : source.name;
    if (source.primitives.size() > 1) loaded->name += fmt::format("/{}", primitive);
    loaded->source = pointer;
    index = static_cast<std::uint32_t>(scene_.meshes.size());
    scene_.meshes.push_back(std::move(*loaded));
  }
  known_.emplace(key, index);
  return index;
}

std::optional<Mesh> Meshes::load(const tinygltf::Primitive& primitive, const std::string& pointer, const Materials::Entry& material) {
  if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    asset_.warning("NOT_REPRESENTED", fmt::format("{} have no surface; they are left out", mode_name(primitive.mode)), pointer + "/mode");
    return std::nullopt;
  }
  Mesh mesh;
  if (!read_) {
    ++asset_.stats.skipped_meshes;
    return mesh;
  }
  Status status = read_geometry(primitive, pointer, mesh);
  if (status) status = read_uvs(primitive, pointer, material, mesh);
  if (!status) {
    asset_.error(status.error());
    return std::nullopt;
  }
  name_losses(primitive, pointer, material);
  return mesh;
}

// Many primitives may share one accessor: the limit on one array alone would let a small file fill the memory.
Status Meshes::spend(std::size_t elements, const std::string& pointer) {
  const std::size_t limit = asset_.options().max_items > SIZE_MAX / 8 ? SIZE_MAX : 8 * asset_.options().max_items;
  if (elements > limit - spent_)
    return asset_.failure("LIMIT_EXCEEDED", fmt::format("all meshes together have more than {} vertices and indices", limit), pointer);
  spent_ += elements;
  return Done{};
}

Status Meshes::read_geometry(const tinygltf::Primitive& primitive, const std::string& pointer, Mesh& mesh) {
  const auto position = attribute(primitive, "POSITION");
  if (!position)
    return asset_.failure("MESH_PRIMITIVE_NO_POSITION", "expected the attribute POSITION, which is missing", pointer + "/attributes");
  auto positions = read_floats(asset_, *position, 3);
  if (!positions) return positions.error();
  if (auto within = spend(positions->size(), pointer); !within) return within.error();
  mesh.positions = triples(*positions);

  if (const auto normal = attribute(primitive, "NORMAL")) {
    auto normals = read_floats(asset_, *normal, 3);
    if (!normals) return normals.error();
    mesh.normals = triples(*normals);
    if (mesh.normals.size() != mesh.positions.size())
      return asset_.failure("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                            fmt::format("expected {} normals, one a vertex, found {}", mesh.positions.size(), mesh.normals.size()),
                            pointer + "/attributes/NORMAL");
    if (!normalise(mesh.normals)) {
      mesh.normals.clear();
      asset_.warning("ACCESSOR_VECTOR3_NON_UNIT", "a normal has no direction; the mesh is shaded flat", pointer + "/attributes/NORMAL");
    }
  }

  std::vector<std::uint32_t> indices(mesh.positions.size());
  if (primitive.indices >= 0) {
    auto read = read_indices(asset_, primitive.indices);
    if (!read) return read.error();
    indices = std::move(*read);
  } else {
    std::iota(indices.begin(), indices.end(), 0U);
  }
  if (auto within = spend(indices.size(), pointer); !within) return within.error();
  const auto outside = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= mesh.positions.size(); });
  if (outside != indices.end())
    return asset_.failure(
        "ACCESSOR_INDEX_OOB",
        fmt::format("expected indices below {}, found {} at {}", mesh.positions.size(), *outside, outside - indices.begin()),
        pointer + "/indices");
  mesh.indices = triangles_of(primitive.mode, indices);
  const bool whole = primitive.mode == TINYGLTF_MODE_TRIANGLES ? indices.size() % 3 == 0 : indices.size() >= 3;
  if (!whole)
    asset_.warning("MESH_PRIMITIVE_INCOMPATIBLE_MODE",
                   fmt::format("{} indices make no whole number of triangles; the rest is left out", indices.size()), pointer);
  if (mesh.indices.empty()) return asset_.failure("MESH_PRIMITIVE_EMPTY", "expected at least one triangle, found none", pointer);
  return Done{};
}

Status Meshes::read_uvs(const tinygltf::Primitive& primitive, const std::string& pointer, const Materials::Entry& material, Mesh& mesh) {
  const std::string name = fmt::format("TEXCOORD_{}", material.uv_set);
  const auto uv = attribute(primitive, name);
  if (!uv) {
    if (material.wants_uvs)
      asset_.warning("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
                     fmt::format("the material's textures use {}, which the mesh lacks: they show one texel", name),
                     pointer + "/attributes");
    return Done{};
  }
  auto values = read_floats(asset_, *uv, 2);
  if (!values) return values.error();
  mesh.uvs.resize(values->size() / 2);
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i) mesh.uvs[i] = {(*values)[2 * i], (*values)[2 * i + 1]};
  if (mesh.uvs.size() != mesh.positions.size())
    return asset_.failure("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                          fmt::format("expected {} texture coordinates, one a vertex, found {}", mesh.positions.size(), mesh.uvs.size()),
                          pointer_to(pointer + "/attributes", name));
  return spend(values->size(), pointer);
}

void Meshes::name_losses(const tinygltf::Primitive& primitive, const std::string& pointer, const Materials::Entry& material) {
  if (attribute(primitive, "TANGENT") && material.wants_tangents)
    asset_.note("NOT_REPRESENTED", "tangents are not carried: the normal map's frame comes from the texture coordinates",
                pointer + "/attributes/TANGENT");
  if (attribute(primitive, "COLOR_0"))
    asset_.warning("NOT_REPRESENTED", "vertex colours are lost: the base colour is not multiplied by them",
                   pointer + "/attributes/COLOR_0");
  if (!primitive.targets.empty())
    asset_.warning("NOT_REPRESENTED", "morph targets are lost: the mesh has its base shape", pointer + "/targets");
  for (const auto& [name, accessor] : primitive.attributes)
    if (name.starts_with("_"))
      asset_.note("NOT_REPRESENTED", "an attribute of the application's own is not carried", pointer_to(pointer + "/attributes", name));
}

}  // namespace etendue::gltf
