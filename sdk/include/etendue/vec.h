// Small vectors, quaternions and affine transforms. Right-handed, +Y up, metres where they are positions.
#pragma once

#include <array>
#include <cmath>

namespace etendue {

template <class T>
struct Vec2 {
  T x{}, y{};
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3& operator+=(const Vec3& o) { return x += o.x, y += o.y, z += o.z, *this; }
  constexpr Vec3& operator-=(const Vec3& o) { return x -= o.x, y -= o.y, z -= o.z, *this; }
  constexpr Vec3& operator*=(T s) { return x *= s, y *= s, z *= s, *this; }
  friend constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return a *= s; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a *= s; }
  friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

// For what has four numbers and is no point of space: tangents with a sign, colours with alpha.
template <class T>
struct Vec4 {
  T x{}, y{}, z{}, w{};
  friend constexpr bool operator==(const Vec4&, const Vec4&) = default;
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec4f = Vec4<float>;

template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}
// The zero vector stays zero.
template <class T>
Vec3<T> normalised(const Vec3<T>& a) {
  const T l = length(a);
  return l > T(0) ? a / l : a;
}
template <class To, class From>
constexpr Vec3<To> vec_cast(const Vec3<From>& a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

// Linear Rec.709, channel by channel.
using Rgb = Vec3<double>;

// Unit quaternion, x y z w as in glTF.
struct Quat {
  double x = 0, y = 0, z = 0, w = 1;
  friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

// Two unit vectors that make a right-handed orthonormal basis (tangent, bitangent, n). n is a unit vector.
struct Basis {
  Vec3d tangent, bitangent, normal;
};
Basis basis_around(const Vec3d& n);

// Affine map x -> linear x + translation. `columns` are the images of the axes.
struct Transform {
  std::array<Vec3d, 3> columns{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  Vec3d translation;

  static Transform from_trs(const Vec3d& translation, const Quat& rotation, const Vec3d& scale = {1, 1, 1});
  // 16 numbers column by column, as glTF stores a matrix; the last row is taken to be 0 0 0 1.
  static Transform from_column_major(const std::array<double, 16>& m);

  Vec3d vector(const Vec3d& v) const { return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z; }
  Vec3d point(const Vec3d& p) const { return vector(p) + translation; }
  // Image of a normal: the cofactor matrix, not normalised. Points to the same side of the surface also for mirrored maps.
  Vec3d normal(const Vec3d& n) const;
  double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }
  // Rotation and translation alone: Gram-Schmidt from -Z (the direction of a light or a camera), then +Y.
  // A mirrored map keeps -Z and +Y.
  Transform rigid() const;

  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform&, const Transform&) = default;
};

}  // namespace etendue
