#include "mitsuba.h"

#include "assets.h"
#include "writer.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace etendue {
namespace mitsuba {

Error unsupported(std::string text, const std::string& source) {
  return {"EXPORT_UNSUPPORTED", std::move(text), {"", 0, 0, source}, {}, {}};
}

namespace {

Error invalid(const Diagnostics& diagnostics) {
  Error error{"SCENE_INVALID", "the scene has errors", {}, {}, {}};
  for (const Diagnostic& d : diagnostics.all()) {
    if (d.severity == Severity::error) error.notes.push_back(d);
  }
  return error;
}

// The distance from the origin to the farthest corner, or between corners, whichever is larger.
double extent_of(const Bounds& bounds, const Camera& camera) {
  const Vec3d& eye = camera.transform.translation;
  double extent = length(eye);
  if (!bounds.empty()) {
    extent = std::max({extent, length(bounds.min), length(bounds.max), length(bounds.max - bounds.min), length(bounds.max - eye),
                       length(bounds.min - eye)});
  }
  return std::max(extent, 1e-3);
}

bool has_sun(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    const auto* distant = std::get_if<DistantShape>(&light.shape);
    return distant && distant->diameter_rad > 0;
  });
}

void write_integrator(Writer& writer) {
  // `path` takes the border of a hole for a surface that it may not pass again at depth 2, and its shadow rays do not see holes.
  const bool passed = std::any_of(writer.scene.objects.begin(), writer.scene.objects.end(), [&](const Object& object) {
    return object.material != no_index && is_passed(writer, writer.scene.materials[object.material]);
  });
  add_integer(add_plugin(writer.root, "integrator", passed ? "volpath" : "path"), "max_depth", writer.options.max_depth);
}

void write_sensor(Writer& writer, const Camera& camera) {
  pugi::xml_node sensor = add_plugin(writer.root, "sensor", "perspective", "camera");
  add_float(sensor, "fov", camera.vfov_rad * 180 / pi);
  add_string(sensor, "fov_axis", "y");
  // Both planes cut rays. The far one is behind the sun's disk (punctual.cpp), if there is one.
  add_float(sensor, "near_clip", 1e-5 * writer.extent_m);
  add_float(sensor, "far_clip", (has_sun(writer.scene) ? 1e6 : 10) * writer.extent_m);
  add_matrix(sensor, "to_world", facing_forward(camera.transform.rigid()));

  pugi::xml_node film = add_plugin(sensor, "film", "hdrfilm");
  add_integer(film, "width", writer.options.width);
  add_integer(film, "height", writer.options.height);
  add_string(film, "file_format", "openexr");
  add_string(film, "pixel_format", "rgb");
  add_string(film, "component_format", "float32");
  add_plugin(film, "rfilter", "box");

  pugi::xml_node sampler = add_plugin(sensor, "sampler", "independent");
  for (const auto& [name, value] : {std::pair("sample_count", "$spp"), std::pair("seed", "$seed")}) {
    pugi::xml_node integer = sampler.append_child("integer");
    integer.append_attribute("name") = name;
    integer.append_attribute("value") = value;
  }
}

void write_defaults(Writer& writer) {
  for (const auto& [name, value] : {std::pair("spp", std::to_string(writer.options.samples)), std::pair("seed", std::string("0"))}) {
    pugi::xml_node node = writer.root.append_child("default");
    node.append_attribute("name") = name;
    node.append_attribute("value") = value.c_str();
  }
}

Status write_scene(Writer& writer, const Camera& camera) {
  write_defaults(writer);
  write_integrator(writer);
  write_sensor(writer, camera);
  if (Status s = write_materials(writer); !s) return s;
  if (Status s = write_objects(writer); !s) return s;
  return write_lights(writer);
}

Result<Camera> camera_of(const Scene& scene, const Bounds& bounds, const ExportOptions& options, Diagnostics& diagnostics) {
  if (options.camera < scene.cameras.size()) return scene.cameras[options.camera];
  if (scene.cameras.empty() && options.camera == 0) {
    diagnostics.note("CAMERA_ADDED", "the scene has no camera: one that sees all of it was added");
    return framing_camera(bounds, static_cast<double>(options.width) / options.height);
  }
  return Error{"CAMERA_MISSING",
               "expected a camera with index below " + std::to_string(scene.cameras.size()) + ", found " + std::to_string(options.camera),
               {},
               {},
               {}};
}

// Scene files that share one folder of assets.
class SceneFiles {
 public:
  // Errors: SCENE_INVALID, CAMERA_MISSING.
  static Result<std::unique_ptr<SceneFiles>> begin(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options,
                                                   MitsubaParts parts, MitsubaLobes lobes, Diagnostics& diagnostics) {
    if (const Diagnostics found = validate(scene); found.has_errors()) return invalid(found);
    const Bounds bounds = bounds_of(scene);
    Result<Camera> camera = camera_of(scene, bounds, options, diagnostics);
    if (!camera) return camera.error();
    return std::unique_ptr<SceneFiles>(new SceneFiles(scene, file, bounds, std::move(*camera), parts, lobes));
  }

  Status add(const std::filesystem::path& file, const ExportOptions& options, LossReport& losses) {
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("scene");
    root.append_attribute("version") = "3.0.0";
    Writer writer{
        scene_, options, assets_, root, losses, bounds_, camera_.transform.translation, parts_, lobes_, extent_of(bounds_, camera_)};
    if (Status s = write_scene(writer, camera_); !s) return s.error();
    std::ostringstream text;
    document.save(text, "  ");
    texts_.emplace_back(file, text.str());
    return Done{};
  }

  // The files that were written, the scene files first.
  Result<std::vector<std::filesystem::path>> commit() {
    if (Status s = assets_.commit(); !s) return s.error();
    std::vector<std::filesystem::path> files;
    for (const auto& [file, text] : texts_) {
      if (Status s = write_file(file, std::as_bytes(std::span(text))); !s) return s.error();
      files.push_back(file);
    }
    for (std::filesystem::path& asset : assets_.files()) files.push_back(std::move(asset));
    return files;
  }

 private:
  SceneFiles(const Scene& scene, const std::filesystem::path& file, const Bounds& bounds, Camera camera, MitsubaParts parts,
             MitsubaLobes lobes)
      : scene_(scene), bounds_(bounds), camera_(std::move(camera)), parts_(parts), lobes_(lobes), assets_(file) {}

  const Scene& scene_;
  Bounds bounds_;
  Camera camera_;
  MitsubaParts parts_;
  MitsubaLobes lobes_;
  AssetFolder assets_;
  std::vector<std::pair<std::filesystem::path, std::string>> texts_;
};

class MitsubaExporter : public Exporter {
 public:
  MitsubaExporter(MitsubaParts parts, MitsubaLobes lobes) : parts_(parts), lobes_(lobes) {}

  FormatInfo describe() const override {
    return {"mitsuba", "Mitsuba 3", {".xml"}, "Scene file of the Mitsuba 3 renderer, with PLY and OpenEXR files in a folder beside it"};
  }

  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options) const override {
    Exported exported;
    auto files = SceneFiles::begin(scene, file, options, parts_, lobes_, exported.diagnostics);
    if (!files) return files.error();
    if (Status s = (*files)->add(file, options, exported.losses); !s) return s.error();
    auto written = (*files)->commit();
    if (!written) return written.error();
    exported.files = std::move(*written);
    return exported;
  }

 private:
  MitsubaParts parts_;
  MitsubaLobes lobes_;
};

}  // namespace
}  // namespace mitsuba

std::unique_ptr<Exporter> make_mitsuba_exporter(MitsubaParts parts, MitsubaLobes lobes) {
  return std::make_unique<mitsuba::MitsubaExporter>(parts, lobes);
}

Result<MitsubaLightByLight> write_mitsuba_light_by_light(const Scene& scene, const std::filesystem::path& file,
                                                         const ExportOptions& options, MitsubaParts parts) {
  MitsubaLightByLight result;
  auto files = mitsuba::SceneFiles::begin(scene, file, options, parts, MitsubaLobes::as_ours, result.all.diagnostics);
  if (!files) return files.error();
  if (Status s = (*files)->add(file, options, result.all.losses); !s) return s.error();
  std::vector<std::uint32_t> lit = options.lit;
  for (std::uint32_t i = 0; options.lit.empty() && i < scene.lights.size(); ++i) lit.push_back(i);
  for (const std::uint32_t light : lit) {
    ExportOptions one = options;
    one.lit = {light};
    LossReport losses_as_above;
    const std::filesystem::path single = file.parent_path() / (file.stem().string() + "_light_" + std::to_string(light) + ".xml");
    if (Status s = (*files)->add(single, one, losses_as_above); !s) return s.error();
    result.single.push_back(single);
  }
  auto written = (*files)->commit();
  if (!written) return written.error();
  result.all.files = std::move(*written);
  return result;
}

}  // namespace etendue
