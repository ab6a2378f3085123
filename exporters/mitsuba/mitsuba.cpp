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
  const bool holes = std::any_of(writer.scene.objects.begin(), writer.scene.objects.end(), [&](const Object& object) {
    return object.material != no_index && has_holes(writer.scene.materials[object.material]);
  });
  add_integer(add_plugin(writer.root, "integrator", holes ? "volpath" : "path"), "max_depth", writer.options.max_depth);
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

class MitsubaExporter : public Exporter {
 public:
  FormatInfo describe() const override {
    return {"mitsuba", "Mitsuba 3", {".xml"}, "Scene file of the Mitsuba 3 renderer, with PLY and OpenEXR files in a folder beside it"};
  }

  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions& options) const override {
    if (const Diagnostics found = validate(scene); found.has_errors()) return invalid(found);
    Exported exported;
    const Bounds bounds = bounds_of(scene);
    Camera camera;
    if (options.camera < scene.cameras.size()) {
      camera = scene.cameras[options.camera];
    } else if (scene.cameras.empty() && options.camera == 0) {
      camera = framing_camera(bounds, static_cast<double>(options.width) / options.height);
      exported.diagnostics.note("CAMERA_ADDED", "the scene has no camera: one that sees all of it was added");
    } else {
      return Error{
          "CAMERA_MISSING",
          "expected a camera with index below " + std::to_string(scene.cameras.size()) + ", found " + std::to_string(options.camera),
          {},
          {},
          {}};
    }

    AssetFolder assets(file);
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("scene");
    root.append_attribute("version") = "3.0.0";
    Writer writer{scene, options, assets, root, exported.losses, bounds, extent_of(bounds, camera)};
    if (Status s = write_scene(writer, camera); !s) return s.error();

    std::ostringstream text;
    document.save(text, "  ");
    const std::string xml = text.str();
    if (Status s = assets.commit(); !s) return s.error();
    if (Status s = write_file(file, std::as_bytes(std::span(xml))); !s) return s.error();
    exported.files = assets.files();
    exported.files.insert(exported.files.begin(), file);
    return exported;
  }
};

}  // namespace
}  // namespace mitsuba

std::unique_ptr<Exporter> make_mitsuba_exporter() { return std::make_unique<mitsuba::MitsubaExporter>(); }

}  // namespace etendue
