#include "reader.h"

#include <limits>

namespace etendue::rig {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

std::optional<double> read_exposure(Reader& reader, JsonValue value) {
  if (!value) return {};
  Fields fields(value, reader.diagnostics);
  const JsonValue ev100 = fields.require("ev100");
  fields.finish();
  // The key names the unit, so that a plain number is as good as "8 EV".
  if (ev100.is(JsonKind::number)) return read_number(ev100, -1000, 1000, reader.diagnostics);
  return read_quantity(ev100, Dimension::exposure_value, Bound::any, reader.diagnostics);
}

// Looks from `position` to `target`, with `up` in the vertical plane of the picture.
std::optional<Transform> looking(const Vec3d& position, const Vec3d& target, const Vec3d& up) {
  const Vec3d z = normalised(position - target);
  const Vec3d x = cross(normalised(up), z);
  constexpr double parallel = 1e-9;
  if (!(length(x) > parallel)) return {};
  return Transform{{normalised(x), cross(z, normalised(x)), z}, position};
}

void read_orientation(Reader& reader, Fields& fields, Camera& camera, const Vec3d& position) {
  Diagnostics& d = reader.diagnostics;
  const JsonValue given = fields.one_of({"target", "rotation"});
  const JsonValue up_value = fields.find("up");
  if (fields.valid() && !given) fail(d, fields.object(), "KEY_MISSING", "expected one of \"target\", \"rotation\"");
  if (!given) return;
  if (given.key() == "rotation") {
    if (up_value) d.error("KEYS_EXCLUSIVE", "\"rotation\" already says what is up, found both", up_value.where_key());
    camera.transform = Transform::from_trs(position, read_rotation(given, d).value_or(Quat{}));
    return;
  }
  const std::optional<Vec3d> target = read_position(given, d);
  const std::optional<Vec3d> up = read_vec3(up_value, -1e9, 1e9, d);
  if (!target) return;
  if (!(length(*target - position) > 0) || !std::isfinite(length(*target - position))) {
    fail(d, given, "VALUE_OUT_OF_RANGE", "expected a target away from the camera's position");
    return;
  }
  if (!up) {
    camera.transform = look_at(position, *target, camera.vfov_rad).transform;
    return;
  }
  const std::optional<Transform> transform = looking(position, *target, *up);
  if (!transform) fail(d, up_value, "VALUE_OUT_OF_RANGE", "expected an up direction that is not the line of sight");
  camera.transform = transform.value_or(Transform{});
}

void read_camera(Reader& reader, JsonValue value) {
  Diagnostics& d = reader.diagnostics;
  Fields fields(value, d);
  Camera camera;
  camera.name = read_string(fields.find("name"), d).value_or("");
  camera.source = value.pointer();
  const JsonValue vfov = fields.find("vfov");
  camera.vfov_rad = read_quantity(vfov, Dimension::angle, Bound::positive, d).value_or(camera.vfov_rad);
  if (camera.vfov_rad >= pi) {
    fail(d, vfov, "VALUE_OUT_OF_RANGE", "expected a field of view below 180 deg");
    camera.vfov_rad = Camera{}.vfov_rad;
  }
  const Vec3d position = read_position(fields.require("position"), d).value_or(Vec3d{});
  read_orientation(reader, fields, camera, position);
  camera.ev100 = read_exposure(reader, fields.find("exposure"));
  camera.aspect = read_number(fields.find("aspect"), std::numeric_limits<double>::min(), unlimited, d).value_or(0);
  fields.finish();
  reader.scene.cameras.push_back(std::move(camera));
}

}  // namespace

void read_cameras(Reader& reader, JsonValue camera, JsonValue cameras) {
  if (camera) read_camera(reader, camera);
  if (!is_array(cameras, reader.options.max_items, reader.diagnostics)) return;
  for (const JsonValue value : cameras) read_camera(reader, value);
}

}  // namespace etendue::rig
