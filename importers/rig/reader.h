// Reading one rig file: what the parts of the reader share.
#pragma once

#include "etendue/io.h"
#include "fields.h"

#include <filesystem>
#include <map>

namespace etendue::rig {

struct Reader {
  std::filesystem::path folder;  // files are looked up here and nowhere else
  const ImportOptions& options;
  const Registry* others = nullptr;  // null: other assets are not read (an error where one is named)
  Scene scene;
  Diagnostics diagnostics;          // of the rig file itself
  Diagnostics foreign_diagnostics;  // of the assets it names
  Stats stats;
  std::vector<std::string> material_names, mesh_names;  // of the rig's own, which come first in the scene
  std::map<std::string, std::size_t> light_names;       // how many lights wanted each
};

// The file that a value names, inside the rig's folder: relative, without "..", and not leading out of it through a link. Absence is
// reported where the file will be needed (`must_exist`).
std::optional<std::filesystem::path> read_path(Reader& reader, JsonValue value, bool must_exist);
// A texture: a file name, or {file, encoding, wrap, nearest, uv_transform, uv_set}.
std::optional<Texture> read_texture(Reader& reader, JsonValue value);
// An image that is no texture (an environment): its index in Scene::images.
std::optional<std::uint32_t> read_image(Reader& reader, JsonValue file);

// The index of one of the file's own things, by its name or by its position. `what`: "material".
std::optional<std::uint32_t> read_reference(Reader& reader, JsonValue value, const std::vector<std::string>& names, std::string_view what);

void read_meshes(Reader& reader, JsonValue meshes);
void read_materials(Reader& reader, JsonValue materials);
void read_lights(Reader& reader, JsonValue lights);
void read_objects(Reader& reader, JsonValue objects);
void read_cameras(Reader& reader, JsonValue camera, JsonValue cameras);

// "positions", "indices", "normals", "uvs" of an object that is being read.
Mesh read_mesh(Reader& reader, Fields& fields);
// {"mesh": reference} or the mesh itself, for lights and objects.
std::optional<std::uint32_t> read_mesh_reference(Reader& reader, Fields& fields);

std::optional<Shape> read_shape(Reader& reader, JsonValue value);
Emission read_emission(Reader& reader, JsonValue value, const Shape& shape);

// The asset behind "gltf", read by its own importer.
std::optional<Scene> read_asset(Reader& reader, JsonValue file, Need need);
// Everything but its cameras, moved by `transform`; `material` (if any) on every object, `prefix` before every name.
struct Placement {
  Transform transform;
  std::uint32_t material = no_index;
  std::string prefix;
  std::string file;  // for provenance
};
void merge(Reader& reader, Scene asset, const Placement& placement, JsonValue at);
// All its surfaces as one mesh, in its world.
Mesh merged_surfaces(const Scene& asset);

// The name, or the name with a number behind it if a light already has it.
std::string unique_light_name(Reader& reader, const std::string& wanted);

}  // namespace etendue::rig
