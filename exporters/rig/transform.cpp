#include "writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace etendue::rig {
namespace {

// 15 significant digits, all that decimal text and double agree about: takes the rounding errors of a decomposition away (2 instead of
// 2.0000000000000004) at a relative cost of at most 5e-16.
double without_noise(double x) { return std::strtod(fmt::format("{:.15g}", x).c_str(), nullptr); }

struct Decomposed {
  Quat rotation;
  Vec3d scale{1, 1, 1};
};

// Rotation after scale, or nothing if the map shears, flattens, or would not come back to within a few roundings.
std::optional<Decomposed> decompose(const Transform& t) {
  Vec3d scale{length(t.columns[0]), length(t.columns[1]), length(t.columns[2])};
  if (!(scale.x > 0 && scale.y > 0 && scale.z > 0)) return {};
  if (t.determinant() < 0) scale.x = -scale.x;
  const Transform rotation{{t.columns[0] / scale.x, t.columns[1] / scale.y, t.columns[2] / scale.z}, {}};
  const Decomposed parts{rotation_of(rotation), {without_noise(scale.x), without_noise(scale.y), without_noise(scale.z)}};
  const Transform again = Transform::from_trs({}, parts.rotation, parts.scale);
  constexpr double roundings = 8 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < 3; ++i)
    if (!(length(again.columns[i] - t.columns[i]) <= roundings * length(t.columns[i]))) return {};
  return parts;
}

double error_of(const Quat& q, const Transform& rotation) {
  const Transform again = Transform::from_trs({}, q);
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) error = std::max(error, length(again.columns[i] - rotation.columns[i]));
  return error;
}

void write_matrix(JsonWriter& json, const Transform& t) {
  json.key("matrix");
  json.begin_array();
  for (const Vec3d& column : t.columns) {
    for (int i = 0; i < 3; ++i) json.value(column[i]);
    json.value(0.0);
  }
  for (int i = 0; i < 3; ++i) json.value(t.translation[i]);
  json.value(1.0);
  json.end_array();
}

}  // namespace

// Shepperd 1978: divides by the largest of the four components, which is at least 1/2. w >= 0, so that the text does not depend on the
// path.
Quat rotation_of(const Transform& t) {
  const auto& [x, y, z] = t.columns;
  const double trace = x.x + y.y + z.z;
  Quat q;
  if (trace >= std::max({x.x, y.y, z.z})) {
    q = {y.z - z.y, z.x - x.z, x.y - y.x, 1 + trace};
  } else if (x.x >= std::max(y.y, z.z)) {
    q = {1 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y};
  } else if (y.y >= z.z) {
    q = {x.y + y.x, 1 + y.y - z.z - x.x, y.z + z.y, z.x - x.z};
  } else {
    q = {z.x + x.z, y.z + z.y, 1 + z.z - x.x - y.y, x.y - y.x};
  }
  const double size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) * (q.w < 0 ? -1 : 1);
  q = {q.x / size + 0.0, q.y / size + 0.0, q.z / size + 0.0, q.w / size + 0.0};  // + 0 makes -0 a 0
  const Quat clean{without_noise(q.x), without_noise(q.y), without_noise(q.z), without_noise(q.w)};
  return error_of(clean, t) <= error_of(q, t) ? clean : q;
}

std::string length_text(double metres) { return to_string(AnyQuantity{Dimension::length, metres}); }

std::string angle_text(double radians) {
  const double degrees_value = degrees.of({radians});
  for (const std::string& text : {fmt::format("{:.15g} deg", degrees_value), fmt::format("{} deg", degrees_value)}) {
    const Result<double> again = parse_si(text, Dimension::angle);
    if (again && *again == radians) return text;
  }
  return to_string(AnyQuantity{Dimension::angle, radians});
}

void write_vec3(JsonWriter& json, const Vec3d& v) {
  json.begin_array();
  for (int i = 0; i < 3; ++i) json.value(v[i]);
  json.end_array();
}

void write_quaternion(JsonWriter& json, const Quat& q) {
  json.begin_array();
  for (const double component : {q.x, q.y, q.z, q.w}) json.value(component);
  json.end_array();
}

void write_scale(JsonWriter& json, const Vec3d& s) {
  if (s == Vec3d{1, 1, 1}) return;
  json.key("scale");
  if (s.x == s.y && s.y == s.z) {
    json.value(s.x);
  } else {
    write_vec3(json, s);
  }
}

void write_transform(JsonWriter& json, const Transform& transform, bool with_scale) {
  const std::optional<Decomposed> parts = with_scale ? decompose(transform) : Decomposed{rotation_of(transform), {1, 1, 1}};
  if (!parts) return write_matrix(json, transform);
  if (!(transform.translation == Vec3d{})) {
    json.key("translation");
    write_vec3(json, transform.translation);
  }
  if (!(parts->rotation == Quat{})) {
    json.key("rotation");
    write_quaternion(json, parts->rotation);
  }
  write_scale(json, parts->scale);
}

}  // namespace etendue::rig
