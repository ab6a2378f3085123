#include "emission_texture.h"
#include "light_meshes.h"
#include "lights.h"

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {
namespace {

const char* const black = "black";

// Two faces of a two-sided light stand this far apart: coincident ones would hide each other at random, and floats resolve 6e-8 of the
// extent.
double gap_of(const Writer& writer) { return 4e-6 * writer.extent_m; }

// A shape that carries an emitter is black by default; one that does not has to be told.
void add_black(Writer& writer, pugi::xml_node shape) {
  if (!writer.root.find_child_by_attribute("bsdf", "id", black)) {
    pugi::xml_node bsdf = writer.root.prepend_child("bsdf");
    bsdf.append_attribute("type") = "diffuse";
    bsdf.append_attribute("id") = black;
    add_rgb(bsdf, "reflectance", {0, 0, 0});
  }
  add_reference(shape, black);
}

// What the shape reflects: its surface material, else black.
void add_surface_of(Writer& writer, const LightEntry& entry, pugi::xml_node shape) {
  if (entry.light.surface_material) {
    add_surface(writer, shape, *entry.light.surface_material);
  } else if (!entry.lit) {
    add_black(writer, shape);
  }
}

// An emitter without its radiance. The camera sees a light without its window; its rays begin at the near plane, at a tenth of the
// tolerance (write_sensor()).
pugi::xml_node add_area_emitter(Writer& writer, const LightEntry& entry, pugi::xml_node parent) {
  if (writer.parts == MitsubaParts::built_in || !has_window(entry.light)) return add_plugin(parent, "emitter", "area");
  pugi::xml_node emitter = add_plugin(parent, "emitter", "etendue_area");
  add_point(emitter, "eye", writer.eye);
  add_float(emitter, "eye_radius", 1e-4 * writer.extent_m);
  add_window(emitter, entry.light);
  return emitter;
}

void add_emission(Writer& writer, const LightEntry& entry, pugi::xml_node shape, const Rgb& radiance) {
  if (entry.lit) add_rgb(add_area_emitter(writer, entry, shape), "radiance", radiance);
  add_surface_of(writer, entry, shape);
}

// The other side of a planar light: half a turn about its Y axis.
Transform turned(const Transform& frame) { return facing_forward(frame); }

// `type`: rectangle or disk, unit shapes that face +Z.
Status write_planar(Writer& writer, const LightEntry& entry, const char* type, const Vec3d& scale) {
  const Light& light = entry.light;
  const double shift = emits_both_sides(light) ? gap_of(writer) / 2 : 0;
  const int faces = emits_both_sides(light) ? 2 : 1;
  for (int face = 0; face < faces; ++face) {
    Transform frame = face == 0 ? light.transform : turned(light.transform);
    frame.translation += -frame.columns[2] * shift;
    pugi::xml_node shape = add_plugin(writer.root, "shape", type, face == 0 ? entry.id : entry.id + "_back");
    add_matrix(shape, "to_world", scaled(facing_forward(frame), scale));
    add_emission(writer, entry, shape, entry.resolved.rgb);
  }
  return Done{};
}

// Mesh emitters have flat faces: Mitsuba would emit about interpolated normals.
Status write_mesh_body(Writer& writer, const LightEntry& entry, Mesh mesh, const Rgb& radiance) {
  const Light& light = entry.light;
  if (emits_both_sides(light)) mesh = two_sided(mesh, gap_of(writer));
  pugi::xml_node emitter;
  const bool textured = entry.lit && light.emission.texture && !mesh.uvs.empty();
  if (textured) {
    // The emitter is written first, because it moves the texture coordinates.
    emitter = add_area_emitter(writer, entry, writer.root);
    if (Status s = add_textured_radiance(writer, emitter, mesh, *light.emission.texture, radiance, name_for_losses(light)); !s) return s;
  }
  Result<pugi::xml_node> shape = add_mesh_shape(writer, entry.id, mesh, light.transform, true);
  if (!shape) return shape.error();
  if (!textured) {
    add_emission(writer, entry, *shape, radiance);
    return Done{};
  }
  shape->append_move(emitter);
  add_surface_of(writer, entry, *shape);
  return Done{};
}

// A planar light with a picture, as a mesh: Mitsuba's disk has polar coordinates, its rectangle upside-down ones.
Status write_textured(Writer& writer, const LightEntry& entry, const PolygonShape& outline) {
  Mesh mesh = polygon_mesh(outline);
  set_planar_uvs(mesh);
  return write_mesh_body(writer, entry, std::move(mesh), entry.resolved.rgb);
}

bool is_textured(const LightEntry& entry) { return entry.light.emission.texture.has_value(); }

// 256 corners, at the distance at which the polygon's area, n/2 r^2 sin(2 pi / n), is the disk's.
PolygonShape outline_of(const DiskShape& disk) {
  constexpr int corners = 256;
  const double radius = disk.radius * std::sqrt(2 * pi / corners / std::sin(2 * pi / corners));
  PolygonShape outline;
  for (int i = 0; i < corners; ++i) {
    outline.points.push_back({radius * std::cos(2 * pi * i / corners), radius * std::sin(2 * pi * i / corners)});
  }
  return outline;
}

}  // namespace

Status write_sphere(Writer& writer, const LightEntry& entry, const SphereShape& sphere) {
  pugi::xml_node shape = add_plugin(writer.root, "shape", "sphere", entry.id);
  add_point(shape, "center", entry.light.transform.translation);
  add_float(shape, "radius", sphere.radius);
  add_emission(writer, entry, shape, entry.resolved.rgb);
  return Done{};
}

Status write_disk(Writer& writer, const LightEntry& entry, const DiskShape& disk) {
  if (is_textured(entry)) return write_textured(writer, entry, outline_of(disk));
  return write_planar(writer, entry, "disk", {disk.radius, disk.radius, 1});
}

Status write_rect(Writer& writer, const LightEntry& entry, const RectShape& rect) {
  if (is_textured(entry)) {
    const double x = rect.width / 2, y = rect.height / 2;
    return write_textured(writer, entry, {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
  }
  return write_planar(writer, entry, "rectangle", {rect.width / 2, rect.height / 2, 1});
}

Status write_polygon(Writer& writer, const LightEntry& entry, const PolygonShape& polygon) {
  Mesh mesh = polygon_mesh(polygon);
  if (is_textured(entry)) set_planar_uvs(mesh);
  return write_mesh_body(writer, entry, std::move(mesh), entry.resolved.rgb);
}

Status write_tube(Writer& writer, const LightEntry& entry, const TubeShape& tube) {
  return write_mesh_body(writer, entry, tube_mesh(tube), entry.resolved.rgb);
}

// An open tube of radius r and luminance L sends L 2 r l sin(theta), a line I sin(theta): L = I / (2 r l).
Status write_line(Writer& writer, const LightEntry& entry, const LineShape& line) {
  const double radius = line.length / 1000;
  writer.losses.add(name_for_losses(entry.light) + ": line", "a tube of radius " + text_of(radius) +
                                                                 " m, seen by the camera; up to .3 % off at a distance of " +
                                                                 text_of(20 * radius) + " m, less beyond");
  return write_mesh_body(writer, entry, tube_mesh({line.length, radius, Caps::none}), entry.resolved.rgb / (2 * radius * line.length));
}

Status write_mesh_light(Writer& writer, const LightEntry& entry, const MeshShape& shape) {
  if (entry.light.surface_material && !writer.scene.meshes[shape.mesh].normals.empty()) {
    writer.losses.add(name_for_losses(entry.light) + ": smooth normals of a surface that emits",
                      "flat faces: its own light is exact, what it reflects shows its triangles");
  }
  if (is_textured(entry)) {
    writer.losses.add(name_for_losses(entry.light) + ": emission texture of a mesh",
                      "exact where every place of the picture belongs to one place of the mesh; too dark where several share it");
  }
  return write_mesh_body(writer, entry, scaled_mesh(writer.scene.meshes[shape.mesh], shape.scale), entry.resolved.rgb);
}

}  // namespace etendue::mitsuba
