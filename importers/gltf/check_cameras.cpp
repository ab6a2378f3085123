// Cameras and lights: what their type asks for, and numbers that only make sense together.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "checks.h"

namespace etendue::gltf {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // every comparison with it is false

double number_at(const Json& object, const char* key, double otherwise = unknown) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

// The object that the type of another one asks for.
const Json& of_type(Checks& checks, const Json& source, const char* key, const Path& path) {
  if (!source.contains(key))
    checks.findings.error("UNDEFINED_PROPERTY", fmt::format("expected the property \"{}\" of this type, which is missing", key), path);
  return object_at(source, key);
}

void check_magnification(Checks& checks, const Json& lens, const char* key, const Path& path) {
  const double mag = number_at(lens, key);
  if (mag == 0) checks.findings.error("CAMERA_XMAG_YMAG_ZERO", "expected a magnification other than zero", path / key);
  if (mag < 0) checks.findings.warning("CAMERA_XMAG_YMAG_NEGATIVE", "a negative magnification mirrors the picture", path / key);
}

void check_depth(Checks& checks, const Json& lens, const Path& path) {
  const double far = number_at(lens, "zfar"), near = number_at(lens, "znear");
  if (far <= near)
    checks.findings.error("CAMERA_ZFAR_LEQUAL_ZNEAR", fmt::format("expected zfar above znear, found {} and {}", far, near), path);
}

void check_camera(Checks& checks, const Json& camera, const Path& path) {
  const std::string* type = text_of(camera, "type");
  if (camera.is_object() && camera.contains("orthographic") && camera.contains("perspective"))
    checks.findings.error("ONE_OF_MISMATCH", "expected either perspective or orthographic, found both", path);
  if (type == nullptr) return;
  if (*type == "perspective") {
    const Json& lens = of_type(checks, camera, "perspective", path);
    const Path here = path / "perspective";
    if (number_at(lens, "yfov") >= 3.14159265358979323846)
      checks.findings.warning("CAMERA_YFOV_GEQUAL_PI", fmt::format("expected a yfov below pi, found {}", number_at(lens, "yfov")), here);
    check_depth(checks, lens, here);
  } else if (*type == "orthographic") {
    const Json& lens = of_type(checks, camera, "orthographic", path);
    const Path here = path / "orthographic";
    check_magnification(checks, lens, "xmag", here);
    check_magnification(checks, lens, "ymag", here);
    check_depth(checks, lens, here);
  }
}

void check_punctual(Checks& checks, const Json& light, const Path& path) {
  const std::string* type = text_of(light, "type");
  if (type == nullptr) return;
  if (*type == "spot") {
    const Json& spot = of_type(checks, light, "spot", path);
    const double inner = number_at(spot, "innerConeAngle", 0), outer = number_at(spot, "outerConeAngle", 0.7853981633974483);
    if (outer <= inner)
      checks.findings.error("KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
                            fmt::format("expected an outerConeAngle above the innerConeAngle {}, found {}", inner, outer), path / "spot");
  } else if (light.contains("spot")) {
    checks.findings.note("EXTRA_PROPERTY", "only a spot light has a spot", path / "spot");
  }
  if (*type == "directional" && light.contains("range"))
    checks.findings.note("EXTRA_PROPERTY", "a directional light has no range", path / "range");
}

}  // namespace

void check_cameras(Checks& checks) {
  const Path root, path = root / "cameras";
  const Json& cameras = array_at(checks.root, "cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) check_camera(checks, cameras[i], path / i);
}

void check_lights(Checks& checks) {
  const Json& extensions = object_at(checks.root, "extensions");
  const Path root, path = root / "extensions", punctual = path / "KHR_lights_punctual", ies = path / "EXT_lights_ies";
  const Path punctual_lights = punctual / "lights", ies_lights = ies / "lights";
  const Json& lights = array_at(object_at(extensions, "KHR_lights_punctual"), "lights");
  if (checks.declares("KHR_lights_punctual"))
    for (std::size_t i = 0; i < lights.size(); ++i) check_punctual(checks, lights[i], punctual_lights / i);
  const Json& profiles = array_at(object_at(extensions, "EXT_lights_ies"), "lights");
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    if (!profiles[i].is_object()) continue;
    if (profiles[i].contains("uri") == profiles[i].contains("bufferView"))
      checks.findings.error("ONE_OF_MISMATCH", "expected either uri or bufferView", ies_lights / i);
    use_view(checks, index_of(profiles[i], "bufferView"), Usage::other, ies_lights / i);
  }
}

}  // namespace etendue::gltf
