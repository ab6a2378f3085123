#include "fields.h"

#include <fmt/format.h>

#include <limits>

namespace etendue::rig {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

bool finite(const Transform& t) {
  for (const Vec3d& v : {t.columns[0], t.columns[1], t.columns[2], t.translation})
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  return std::isfinite(t.determinant());
}

std::optional<Transform> read_matrix(JsonValue value, Diagnostics& diagnostics) {
  const std::optional<std::vector<double>> n = read_numbers(value, 16, -unlimited, unlimited, diagnostics);
  if (!n) return {};
  std::array<double, 16> m{};
  std::copy(n->begin(), n->end(), m.begin());
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
    fail(diagnostics, value, "VALUE_OUT_OF_RANGE", "expected a matrix whose last row (elements 3, 7, 11, 15) is 0 0 0 1");
    return {};
  }
  const Transform transform = Transform::from_column_major(m);
  if (finite(transform)) return transform;
  fail(diagnostics, value, "VALUE_OUT_OF_RANGE", "expected a matrix of moderate numbers: its determinant is not finite");
  return {};
}

}  // namespace

std::optional<Quat> read_rotation(JsonValue value, Diagnostics& diagnostics) {
  const std::optional<std::vector<double>> n = read_numbers(value, 4, -unlimited, unlimited, diagnostics);
  if (!n) return {};
  const Quat q{(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
  const double length = std::hypot(std::hypot(q.x, q.y), std::hypot(q.z, q.w));
  if (!(std::abs(length - 1) <= 1e-3)) {
    fail(diagnostics, value, "ROTATION_NOT_UNIT", fmt::format("expected a unit quaternion x y z w, found one of length {:.6g}", length));
    return {};
  }
  // What was already unit within rounding stays bit for bit as it was written: reading what was written changes nothing.
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(length - 1) <= rounding) return q;
  return Quat{q.x / length, q.y / length, q.z / length, q.w / length};
}

std::optional<Vec3d> read_scale(JsonValue value, Diagnostics& diagnostics) {
  if (!value) return {};
  std::optional<Vec3d> scale;
  if (value.is(JsonKind::number)) {
    scale = Vec3d{value.number(), value.number(), value.number()};
  } else {
    scale = read_vec3(value, -unlimited, unlimited, diagnostics);
  }
  if (!scale) return {};
  if (scale->x == 0 || scale->y == 0 || scale->z == 0) {
    fail(diagnostics, value, "VALUE_OUT_OF_RANGE", "expected a scale other than zero on every axis");
    return {};
  }
  return scale;
}

Transform read_transform(Fields& fields, bool with_scale, Diagnostics& diagnostics) {
  const JsonValue translation = fields.find("translation");
  const JsonValue rotation = fields.find("rotation");
  const JsonValue scale = with_scale ? fields.find("scale") : JsonValue();
  const JsonValue matrix = with_scale ? fields.find("matrix") : JsonValue();
  if (matrix && (translation || rotation || scale)) {
    diagnostics.error("KEYS_EXCLUSIVE", "\"matrix\" stands for \"translation\", \"rotation\" and \"scale\", found both",
                      matrix.where_key());
  }
  if (matrix) return read_matrix(matrix, diagnostics).value_or(Transform{});
  const Transform transform =
      Transform::from_trs(read_position(translation, diagnostics).value_or(Vec3d{}), read_rotation(rotation, diagnostics).value_or(Quat{}),
                          read_scale(scale, diagnostics).value_or(Vec3d{1, 1, 1}));
  if (finite(transform) && transform.determinant() != 0) return transform;
  fail(diagnostics, scale ? scale : fields.object(), "VALUE_OUT_OF_RANGE", "expected a transform that is finite and can be inverted");
  return {};
}

}  // namespace etendue::rig
