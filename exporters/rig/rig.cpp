#include "rig.h"

#include "writer.h"

namespace etendue {
namespace rig {

void write_cameras(Writer& writer) {
  const std::vector<Camera>& cameras = writer.scene.cameras;
  if (cameras.empty()) return;
  JsonWriter& json = writer.json;
  json.key("cameras");
  json.begin_array(JsonWriter::Style::one_item_a_line);
  for (const Camera& camera : cameras) {
    json.begin_object();
    if (!camera.name.empty()) json.member("name", camera.name);
    json.key("position");
    write_vec3(json, camera.transform.translation);
    json.key("rotation");
    write_quaternion(json, rotation_of(camera.transform));
    json.member("vfov", angle_text(camera.vfov_rad));
    if (camera.ev100) {
      json.key("exposure");
      json.begin_object();
      json.member("ev100", *camera.ev100);
      json.end_object();
    }
    if (camera.aspect > 0) json.member("aspect", camera.aspect);
    json.end_object();
  }
  json.end_array();
}

namespace {

Status write_scene(Writer& writer) {
  JsonWriter& json = writer.json;
  json.begin_object(JsonWriter::Style::one_item_a_line);
  json.member("etendue", std::uint32_t{1});
  choose_meshes(writer);
  count_material_names(writer);
  if (!writer.scene.lights.empty()) {
    const Status lights = write_lights(writer);
    if (!lights) return lights.error();
  }
  write_cameras(writer);
  write_materials(writer);
  write_objects(writer);
  write_meshes(writer);
  json.end_object();
  const std::string text = json.text() + "\n";
  return write_file(writer.file, std::as_bytes(std::span(text)));
}

}  // namespace
}  // namespace rig

namespace {

class RigExporter : public Exporter {
 public:
  FormatInfo describe() const override {
    return {"rig", "Etendue rig", {".rig.json"}, "Lights in real units, a camera, materials and simple objects, as JSON."};
  }

  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions&) const override {
    Diagnostics diagnostics = validate(scene);
    if (diagnostics.has_errors())
      return Error{"SCENE_INVALID", "the scene has errors and cannot be written", {file.string(), 0, 0, {}}, {}, diagnostics.all()};
    rig::Writer writer{scene, file, {}, {}, {}, {}, {}, {}};
    const Status written = rig::write_scene(writer);
    if (!written) {
      std::error_code ignored;
      for (const std::filesystem::path& beside : writer.files_beside) std::filesystem::remove(beside, ignored);
      return written.error();
    }
    Exported exported{{file}, std::move(writer.losses), {}};
    exported.files.insert(exported.files.end(), writer.files_beside.begin(), writer.files_beside.end());
    return exported;
  }
};

}  // namespace

std::unique_ptr<Exporter> make_rig_exporter() { return std::make_unique<RigExporter>(); }

}  // namespace etendue
