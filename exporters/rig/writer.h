// Writing one rig file: what the parts of the writer share.
#pragma once

#include "etendue/io.h"
#include "json_writer.h"

#include <filesystem>
#include <map>
#include <optional>

namespace etendue::rig {

struct Writer {
  const Scene& scene;
  std::filesystem::path file;
  JsonWriter json;
  LossReport losses;
  std::vector<std::optional<std::uint32_t>> mesh_index;  // in the file, of each mesh of the scene; nothing for those that are left out
  std::map<std::string, std::size_t> material_names;     // how many materials have each
  // Files beside the rig: the name in the rig of what was put there, by its origin ("image 3", a path).
  std::map<std::string, std::string> placed;
  std::vector<std::filesystem::path> files_beside;
};

// How the rig names a file: relative if it is inside the rig's folder, else copied to NAME_files beside the rig.
Result<std::string> place_file(Writer& writer, const std::string& file);
Result<std::string> place_image(Writer& writer, std::uint32_t image);
Result<std::string> place_photometry(Writer& writer, const PhotometricShape& shape);

// "45 deg" if that reads back as the same double, else radians.
std::string angle_text(double radians);
std::string length_text(double metres);
void write_vec3(JsonWriter& json, const Vec3d& v);
void write_scale(JsonWriter& json, const Vec3d& scale);  // nothing if it is 1
void write_quaternion(JsonWriter& json, const Quat& q);
// "translation", "rotation" and, if asked for, "scale" or the whole as "matrix"; nothing that is the identity.
void write_transform(JsonWriter& json, const Transform& transform, bool with_scale);
Quat rotation_of(const Transform& rigid);

// What is written, and what it is called; before anything refers to it.
void choose_meshes(Writer& writer);
void count_material_names(Writer& writer);
// The material's name if it is its own alone, else its position.
void write_material_reference(Writer& writer, std::string_view key, std::uint32_t material);

void write_meshes(Writer& writer);
void write_materials(Writer& writer);
Status write_lights(Writer& writer);
void write_objects(Writer& writer);
void write_cameras(Writer& writer);

}  // namespace etendue::rig
