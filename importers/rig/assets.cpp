// The glTF files that a rig names.
#include "reader.h"

#include <fmt/format.h>

#include <limits>

namespace etendue::rig {
namespace {

bool mirrors(const Transform& t) { return t.determinant() < 0; }

// The mesh as `to` sees it. A mirror does not swap the sides of a surface, so that its triangles turn round.
void append(Mesh& all, const Mesh& mesh, const Transform& to, bool normals, bool uvs) {
  const auto first = static_cast<std::uint32_t>(all.positions.size());
  for (const Vec3f& p : mesh.positions) all.positions.push_back(vec_cast<float>(to.point(vec_cast<double>(p))));
  if (normals)
    for (const Vec3f& n : mesh.normals) all.normals.push_back(vec_cast<float>(normalised(to.normal(vec_cast<double>(n)))));
  if (uvs) all.uvs.insert(all.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const bool turn = mirrors(to);
    all.indices.push_back(first + mesh.indices[i]);
    all.indices.push_back(first + mesh.indices[turn ? i + 2 : i + 1]);
    all.indices.push_back(first + mesh.indices[turn ? i + 1 : i + 2]);
  }
}

Transform scaling(const Vec3d& s) { return Transform::from_trs({}, {}, s); }

// The inverse of a rotation and translation.
Transform inverse_of_rigid(const Transform& t) {
  const auto& [x, y, z] = t.columns;
  return {{Vec3d{x.x, y.x, z.x}, Vec3d{x.y, y.y, z.y}, Vec3d{x.z, y.z, z.z}},
          {-dot(x, t.translation), -dot(y, t.translation), -dot(z, t.translation)}};
}

// The factor of a map that is a rotation times a positive number, or nothing.
std::optional<double> uniform_scale(const Transform& t) {
  constexpr double tolerance = 1e-12;
  const double s = length(t.columns[0]);
  const Transform rigid = t.rigid();
  for (std::size_t i = 0; i < 3; ++i)
    if (length(t.columns[i] - rigid.columns[i] * s) > tolerance * s) return {};
  return s;
}

// A light stays rigid; what else its transform does goes into the surface of a mesh light. Other lights keep their sizes.
void place(Reader& reader, Light& light, const Transform& by, JsonValue at) {
  const Transform moved = by * light.transform;
  light.transform = moved.rigid();
  auto* shape = std::get_if<MeshShape>(&light.shape);
  const std::optional<double> scale = uniform_scale(moved);
  if (!shape) {
    const bool sizeless = std::holds_alternative<PointShape>(light.shape) || std::holds_alternative<SpotShape>(light.shape) ||
                          std::holds_alternative<DistantShape>(light.shape);
    if (!sizeless && std::abs(scale.value_or(0) - 1) > 1e-9) {
      warn(reader.diagnostics, at, "SCALE_IGNORED", fmt::format("the light \"{}\" keeps its size: a light is not scaled", light.name));
    }
    return;
  }
  if (scale) {
    shape->scale = shape->scale * *scale;
    return;
  }
  const Transform rest = inverse_of_rigid(light.transform) * moved * scaling(shape->scale);
  const Mesh& original = reader.scene.meshes[shape->mesh];
  Mesh baked;
  baked.name = original.name;
  baked.source = original.source;
  append(baked, original, rest, true, true);
  shape->mesh = static_cast<std::uint32_t>(reader.scene.meshes.size());
  shape->scale = {1, 1, 1};
  reader.scene.meshes.push_back(std::move(baked));
}

void shift(std::optional<Texture>& texture, std::uint32_t images) {
  if (texture) texture->image += images;
}

void shift(Material& material, std::uint32_t images) {
  for_each_texture(material, [images](const char*, Texture& texture) { texture.image += images; });
}

template <class T>
std::uint32_t count_of(const std::vector<T>& all) {
  return static_cast<std::uint32_t>(all.size());
}

template <class T>
void move_behind(std::vector<T>& all, std::vector<T>& more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

std::optional<Scene> read_asset(Reader& reader, JsonValue file, Need need) {
  Diagnostics& d = reader.diagnostics;
  const std::optional<std::filesystem::path> path = read_path(reader, file, true);
  if (!path) return {};
  const Importer* gltf = nullptr;
  if (reader.others != nullptr)
    for (const auto& importer : reader.others->importers())
      if (importer->describe().id == "gltf") gltf = importer.get();
  if (gltf == nullptr) {
    fail(d, file, "FORMAT_UNKNOWN", "expected a program that reads glTF; this one does not");
    return {};
  }
  ImportOptions options = reader.options;
  options.need = need;
  Result<Imported> imported = gltf->read(*path, options);
  if (!imported) {
    d.add(to_diagnostic(imported.error()));
    for (const Diagnostic& note : imported.error().notes) d.add(note);
    fail(d, file, "ASSET_INVALID", fmt::format("expected a glTF file that can be read, found \"{}\"", file.string()));
    return {};
  }
  reader.foreign_diagnostics.append(imported->diagnostics);
  reader.stats.bytes_read += imported->stats.bytes_read;
  reader.stats.skipped_bytes += imported->stats.skipped_bytes;
  reader.stats.images_decoded += imported->stats.images_decoded;
  reader.stats.skipped_meshes += imported->stats.skipped_meshes;
  reader.stats.skipped_images += imported->stats.skipped_images;
  if (imported->diagnostics.has_errors()) {
    fail(d, file, "ASSET_INVALID", fmt::format("expected a glTF file without errors, found \"{}\"", file.string()));
    return {};
  }
  return std::move(imported->scene);
}

void merge(Reader& reader, Scene asset, const Placement& placement, JsonValue at) {
  Scene& scene = reader.scene;
  const std::uint32_t images = count_of(scene.images), meshes = count_of(scene.meshes), materials = count_of(scene.materials);
  const auto provenance = [&](const std::string& source) { return placement.file + "#" + source; };
  for (Mesh& mesh : asset.meshes) mesh.source = provenance(mesh.source);
  for (Material& material : asset.materials) {
    shift(material, images);
    material.source = provenance(material.source);
  }
  move_behind(scene.images, asset.images);
  move_behind(scene.meshes, asset.meshes);
  move_behind(scene.materials, asset.materials);
  for (Object& object : asset.objects) {
    if (auto* mesh = std::get_if<MeshGeometry>(&object.geometry)) mesh->mesh += meshes;
    if (object.material != no_index) object.material += materials;
    if (placement.material != no_index) object.material = placement.material;
    object.transform = placement.transform * object.transform;
    object.name = placement.prefix + object.name;
    object.source = provenance(object.source);
    scene.objects.push_back(std::move(object));
  }
  for (Light& light : asset.lights) {
    shift(light.emission.texture, images);
    if (auto* mesh = std::get_if<MeshShape>(&light.shape)) mesh->mesh += meshes;
    if (auto* sky = std::get_if<EnvironmentShape>(&light.shape)) {
      if (sky->image) *sky->image += images;
      for (std::uint32_t& face : sky->cube) face += images;
    }
    if (light.surface_material) *light.surface_material += materials;
    if (light.surface_material && placement.material != no_index) light.surface_material = placement.material;
    place(reader, light, placement.transform, at);
    const std::string wanted = placement.prefix + light.name;
    light.name = unique_light_name(reader, wanted);
    if (light.name != wanted) {
      warn(reader.diagnostics, at, "NAME_DUPLICATE",
           fmt::format("another light is named \"{}\"; this one is now \"{}\"", wanted, light.name));
    }
    light.source = provenance(light.source);
    scene.lights.push_back(std::move(light));
  }
}

Mesh merged_surfaces(const Scene& asset) {
  struct Part {
    const Mesh* mesh;
    Transform to_world;
  };
  std::vector<Part> parts;
  for (const Object& object : asset.objects)
    if (const auto* geometry = std::get_if<MeshGeometry>(&object.geometry))
      parts.push_back({&asset.meshes[geometry->mesh], object.transform});
  for (const Light& light : asset.lights)
    if (const auto* shape = std::get_if<MeshShape>(&light.shape))
      parts.push_back({&asset.meshes[shape->mesh], light.transform * scaling(shape->scale)});
  bool normals = true, uvs = true;
  for (const Part& part : parts) {
    normals = normals && !part.mesh->normals.empty();
    uvs = uvs && !part.mesh->uvs.empty();
  }
  Mesh all;
  for (const Part& part : parts) append(all, *part.mesh, part.to_world, normals, uvs);
  return all;
}

}  // namespace etendue::rig
