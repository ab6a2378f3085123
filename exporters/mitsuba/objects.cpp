#include "writer.h"

#include <cmath>

namespace etendue::mitsuba {
namespace {

// Mitsuba's rectangle is [-1, 1]^2 and faces +Z; a plane faces +Y: x -> x, y -> -z, z -> y.
Transform plane_to_world(const Transform& object, double size) {
  const Transform stand{{Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}}, {}};
  return scaled(object * stand, {size / 2, size / 2, 1});
}

// Mitsuba refuses rectangles whose sides are not perpendicular in the world.
bool is_sheared(const Transform& t) {
  const auto cosine = [](const Vec3d& a, const Vec3d& b) { return std::abs(dot(normalised(a), normalised(b))); };
  return cosine(t.columns[0], t.columns[1]) > 1e-7 || cosine(t.columns[0], t.columns[2]) > 1e-7 ||
         cosine(t.columns[1], t.columns[2]) > 1e-7;
}

void add_sphere(Writer& writer, const std::string& id, const Object& object, double radius) {
  pugi::xml_node shape = add_plugin(writer.root, "shape", "sphere", id);
  add_point(shape, "center", object.transform.translation);
  add_float(shape, "radius", radius * length(object.transform.columns[0]));
  add_surface(writer, shape, object.material);
}

// Mirrored maps turn the winding round, and Mitsuba's geometric normal with it; the front stays the front if the indices turn, too.
Mesh with_reversed_winding(Mesh mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

// glTF turns a normal map's second axis round where texture coordinates are mirrored (their area is positive; with v downwards it usually
// is negative); Mitsuba does not.
bool mirrors_texture(const Mesh& mesh) {
  if (mesh.uvs.empty()) return false;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec2f &a = mesh.uvs[mesh.indices[i]], &b = mesh.uvs[mesh.indices[i + 1]], &c = mesh.uvs[mesh.indices[i + 2]];
    if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0) return true;
  }
  return false;
}

void report_mirrored_normals(Writer& writer, const Object& object, const Mesh& mesh) {
  if (object.material == no_index || !writer.scene.materials[object.material].normal_map || !mirrors_texture(mesh)) return;
  writer.losses.add("object '" + object.name + "': normal map on mirrored texture coordinates",
                    "its slopes along v are the other way round there, in Mitsuba as in our own evaluation");
}

// A material without a picture is a hole everywhere or nowhere.
bool is_all_hole(const Writer& writer, const Object& object) {
  if (object.material == no_index) return false;
  const Material& material = writer.scene.materials[object.material];
  return material.alpha_cutoff && !has_holes(material, writer.parts) && material.base_alpha < *material.alpha_cutoff;
}

}  // namespace

Result<pugi::xml_node> add_mesh_shape(Writer& writer, const std::string& id, const Mesh& mesh, const Transform& to_world,
                                      bool face_normals) {
  Result<std::string> file =
      to_world.determinant() < 0 ? writer.assets.add_mesh(with_reversed_winding(mesh)) : writer.assets.add_mesh(mesh);
  if (!file) return file.error();
  pugi::xml_node shape = add_plugin(writer.root, "shape", "ply", id);
  add_string(shape, "filename", *file);
  if (face_normals) add_boolean(shape, "face_normals", true);
  if (!(to_world == Transform{})) add_matrix(shape, "to_world", to_world);
  return shape;
}

Status write_objects(Writer& writer) {
  const Scene& scene = writer.scene;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (is_all_hole(writer, object)) continue;
    const std::string id = "object_" + std::to_string(i) + "_" + id_safe(object.name);
    const bool textured = object.material != no_index && has_textures(scene.materials[object.material], writer.parts);
    if (const auto* sphere = std::get_if<SphereGeometry>(&object.geometry); sphere && !textured) {
      add_sphere(writer, id, object, sphere->radius);
      continue;
    }
    if (const auto* plane = std::get_if<PlaneGeometry>(&object.geometry); plane && !textured && !is_sheared(object.transform)) {
      pugi::xml_node shape = add_plugin(writer.root, "shape", "rectangle", id);
      add_matrix(shape, "to_world", plane_to_world(object.transform, plane->size));
      add_surface(writer, shape, object.material);
      continue;
    }
    const Mesh mesh = tessellated(object.geometry, scene.meshes);
    report_mirrored_normals(writer, object, mesh);
    Result<pugi::xml_node> shape = add_mesh_shape(writer, id, mesh, object.transform, mesh.normals.empty());
    if (!shape) return shape.error();
    add_surface(writer, *shape, object.material);
  }
  return Done{};
}

}  // namespace etendue::mitsuba
