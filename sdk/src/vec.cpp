#include "etendue/vec.h"

namespace etendue {

// Duff et al. 2017, Building an Orthonormal Basis, Revisited: no branch but the sign, no singularity.
Basis basis_around(const Vec3d& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

Transform Transform::from_trs(const Vec3d& translation, const Quat& q, const Vec3d& scale) {
  // Columns of the rotation matrix of a unit quaternion.
  const Vec3d x{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w)};
  const Vec3d y{2 * (q.x * q.y - q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.x * q.w)};
  const Vec3d z{2 * (q.x * q.z + q.y * q.w), 2 * (q.y * q.z - q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)};
  return {{x * scale.x, y * scale.y, z * scale.z}, translation};
}

Transform Transform::from_column_major(const std::array<double, 16>& m) {
  return {{Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
}

// The cofactor matrix maps normals for every invertible map (n' = det(M) M^-T n); the sign of the determinant keeps mirrored maps on the
// same side.
Vec3d Transform::normal(const Vec3d& n) const {
  const Vec3d cofactor = cross(columns[1], columns[2]) * n.x + cross(columns[2], columns[0]) * n.y + cross(columns[0], columns[1]) * n.z;
  return determinant() < 0 ? -cofactor : cofactor;
}

Transform Transform::rigid() const {
  const Vec3d z = normalised(columns[2]);
  const Vec3d y = normalised(columns[1] - z * dot(columns[1], z));
  return {{cross(y, z), y, z}, translation};
}

Transform operator*(const Transform& a, const Transform& b) {
  return {{a.vector(b.columns[0]), a.vector(b.columns[1]), a.vector(b.columns[2])}, a.point(b.translation)};
}

}  // namespace etendue
