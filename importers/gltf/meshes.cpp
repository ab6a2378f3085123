#include "meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

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

// Unit vectors, as 3.7.2.1 wants normals. Those that are so to single precision stay as authored. False if one has no direction.
bool normalise(std::vector<Vec3f>& normals) {
  constexpr float precise = 1e-6F;
  float worst = 0;
  for (const Vec3f& n : normals) worst = std::max(worst, std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1));
  if (worst <= precise) return true;
  for (Vec3f& normal : normals) {
    const Vec3d unit = normalised(vec_cast<double>(normal));
    if (!(dot(unit, unit) > 0)) return false;
    normal = vec_cast<float>(unit);
  }
  return true;
}

std::uint32_t largest(const std::vector<std::uint32_t>& indices) {
  std::uint32_t most = 0;
  for (const std::uint32_t index : indices) most = std::max(most, index);
  return most;
}

}  // namespace

std::vector<std::uint32_t> triangles_of(int mode, std::vector<std::uint32_t> indices) {
  const std::size_t count = indices.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    indices.resize(count - count % 3);
    return indices;
  }
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

std::optional<std::uint32_t> Meshes::at(int mesh, std::size_t primitive, const Materials::Entry& material, const Pose& pose) {
  const auto key = std::make_tuple(mesh, primitive, pose.is_at_base() ? -1 : pose.node);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const tinygltf::Mesh& source = asset_.model().meshes[static_cast<std::size_t>(mesh)];
  const std::string pointer = fmt::format("/meshes/{}/primitives/{}", mesh, primitive);
  std::optional<Mesh> loaded = load(source.primitives[primitive], pointer, material, pose);
  std::optional<std::uint32_t> index;
  if (loaded) {
    loaded->name = source.name.empty() ? fmt::format("mesh {}", mesh) : source.name;
    if (source.primitives.size() > 1) loaded->name += fmt::format("/{}", primitive);
    loaded->source = pointer;
    asset_.take(pointer);
    index = static_cast<std::uint32_t>(scene_.meshes.size());
    scene_.meshes.push_back(std::move(*loaded));
  }
  known_.emplace(key, index);
  return index;
}

std::optional<Mesh> Meshes::load(const tinygltf::Primitive& primitive, const std::string& pointer, const Materials::Entry& material,
                                 const Pose& pose) {
  if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    asset_.warning("NOT_REPRESENTED", fmt::format("{} have no surface: carried, and shown in no picture", mode_name(primitive.mode)),
                   pointer + "/mode");
    return std::nullopt;
  }
  Mesh mesh;
  if (!read_) {
    ++asset_.stats.skipped_meshes;
    return mesh;
  }
  if (is_full_) return std::nullopt;  // said where it was
  const auto data = PrimitiveData::open(asset_, primitive, pointer);
  Status status = data ? read_vertices(*data, mesh) : Status(data.error());
  if (status) status = read_triangles(*data, mesh);
  if (status) status = read_uvs(*data, material, mesh);
  if (status && !pose.is_at_base()) status = apply_pose(*data, asset_, pose, mesh);
  if (!status) {
    asset_.error(status.error());
    return std::nullopt;
  }
  if (!normalise(mesh.normals)) {
    mesh.normals.clear();
    asset_.warning("ACCESSOR_VECTOR3_NON_UNIT", "a normal has no direction; the mesh is shaded flat", data->pointer_of("NORMAL"));
  }
  name_unshown(*data, material, mesh);
  return mesh;
}

// Many primitives may share one accessor: the limit on one array alone would let a small file fill the memory.
Status Meshes::spend(std::size_t elements, const std::string& pointer) {
  const std::size_t limit = asset_.options().max_items > SIZE_MAX / 8 ? SIZE_MAX : 8 * asset_.options().max_items;
  is_full_ = elements > limit - spent_;
  if (is_full_)
    return asset_.over_limit(fmt::format("an eighth of all meshes' {} numbers", spent_ + elements), "max_items", asset_.options().max_items,
                             pointer);
  spent_ += elements;
  return Done{};
}

Status Meshes::read_vertices(const PrimitiveData& data, Mesh& mesh) {
  if (!data.has("POSITION"))
    return asset_.failure("MESH_PRIMITIVE_NO_POSITION", "expected the attribute POSITION, which is missing",
                          data.pointer() + "/attributes");
  auto positions = data.vec3("POSITION");
  if (!positions) return positions.error();
  mesh.positions = std::move(*positions);
  if (auto within = spend(3 * mesh.positions.size(), data.pointer()); !within) return within.error();

  const auto one_a_vertex = [&](const char* name, std::size_t count) -> Status {
    if (count == mesh.positions.size()) return spend(count, data.pointer());
    return asset_.failure("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                          fmt::format("expected {} elements, one a vertex, found {}", mesh.positions.size(), count), data.pointer_of(name));
  };
  if (data.has("NORMAL")) {
    auto normals = data.vec3("NORMAL");
    if (!normals) return normals.error();
    mesh.normals = std::move(*normals);
    if (auto matching = one_a_vertex("NORMAL", mesh.normals.size()); !matching) return matching;
  }
  // Without normals they mean nothing (3.7.2.1).
  if (data.has("TANGENT") && !mesh.normals.empty()) {
    auto tangents = data.vec4("TANGENT");
    if (!tangents) return tangents.error();
    mesh.tangents = std::move(*tangents);
    if (auto matching = one_a_vertex("TANGENT", mesh.tangents.size()); !matching) return matching;
  }
  if (data.has("COLOR_0")) {
    auto colours = data.colours("COLOR_0");
    if (!colours) return colours.error();
    mesh.colours = std::move(*colours);
    if (auto matching = one_a_vertex("COLOR_0", mesh.colours.size()); !matching) return matching;
  }
  return Done{};
}

Status Meshes::read_triangles(const PrimitiveData& data, Mesh& mesh) {
  std::vector<std::uint32_t> indices;
  if (data.has_indices()) {
    auto read = data.indices();
    if (!read) return read.error();
    indices = std::move(*read);
  } else {
    indices.resize(mesh.positions.size());
    std::iota(indices.begin(), indices.end(), 0U);
  }
  const std::string& pointer = data.pointer();
  const std::size_t count = indices.size();
  if (auto within = spend(count, pointer); !within) return within.error();
  if (count > 0 && largest(indices) >= mesh.positions.size()) {
    const auto outside = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= mesh.positions.size(); });
    return asset_.failure(
        "ACCESSOR_INDEX_OOB",
        fmt::format("expected indices below {}, found {} at {}", mesh.positions.size(), *outside, outside - indices.begin()),
        pointer + "/indices");
  }
  const int mode = data.primitive().mode;
  mesh.indices = triangles_of(mode, std::move(indices));
  const bool whole = mode == TINYGLTF_MODE_TRIANGLES ? count % 3 == 0 : count >= 3;
  if (!whole)
    asset_.warning("MESH_PRIMITIVE_INCOMPATIBLE_MODE",
                   fmt::format("{} indices make no whole number of triangles; the rest is left out", count), pointer);
  if (mesh.indices.empty()) return asset_.failure("MESH_PRIMITIVE_EMPTY", "expected at least one triangle, found none", pointer);
  return Done{};
}

Status Meshes::read_uvs(const PrimitiveData& data, const Materials::Entry& material, Mesh& mesh) {
  const std::string name = fmt::format("TEXCOORD_{}", material.uv_set);
  if (!data.has(name)) {
    if (material.wants_uvs)
      asset_.warning("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
                     fmt::format("the material's textures use {}, which the mesh lacks: they show one texel", name),
                     data.pointer() + "/attributes");
    return Done{};
  }
  auto uvs = data.vec2(name);
  if (!uvs) return uvs.error();
  mesh.uvs = std::move(*uvs);
  if (mesh.uvs.size() != mesh.positions.size())
    return asset_.failure("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
                          fmt::format("expected {} texture coordinates, one a vertex, found {}", mesh.positions.size(), mesh.uvs.size()),
                          data.pointer_of(name));
  return spend(2 * mesh.uvs.size(), data.pointer());
}

void Meshes::name_unshown(const PrimitiveData& data, const Materials::Entry& material, const Mesh& mesh) {
  if (!mesh.tangents.empty() && material.wants_tangents)
    asset_.note("NOT_SHOWN", "tangents are carried, but pictures take the normal map's frame from the texture coordinates",
                data.pointer_of("TANGENT"));
  if (!mesh.colours.empty())
    asset_.warning("NOT_SHOWN", "vertex colours are carried, but no picture multiplies the base colour by them",
                   data.pointer_of("COLOR_0"));
}

}  // namespace etendue::gltf
