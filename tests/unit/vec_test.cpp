#include "etendue/vec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace etendue {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Vec, CrossProductIsRightHanded) {
  EXPECT_EQ(cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}), (Vec3d{0, 0, 1}));
  EXPECT_EQ(normalised(Vec3d{0, 0, 0}), (Vec3d{0, 0, 0}));
}

// Also at the pole, where other constructions fail: every basis is orthonormal and right-handed to a few roundings.
TEST(Basis, IsOrthonormalEverywhere) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> directions{{0, 0, 1}, {0, 0, -1}, {1e-12, 0, -1}, {0, -1, 0}};
  for (int i = 0; i < 1000; ++i) directions.push_back(normalised(Vec3d{normal(random), normal(random), normal(random)}));
  for (const Vec3d& n : directions) {
    const Basis basis = basis_around(n);
    EXPECT_NEAR(length(basis.tangent), 1, 1e-14);
    EXPECT_NEAR(dot(basis.tangent, n), 0, 1e-14);
    expect_near(cross(basis.tangent, basis.bitangent), n, 1e-14);
  }
}

TEST(Transform, QuaternionTurnsAsInGltf) {
  // 90 degrees around +X takes -Z to +Y, so the rig file's (-sin 45, 0, 0, cos 45) takes a light's -Z down.
  const double s = std::sqrt(0.5);
  expect_near(Transform::from_trs({}, {s, 0, 0, s}).vector({0, 0, -1}), {0, 1, 0}, 1e-15);
  expect_near(Transform::from_trs({}, {-s, 0, 0, s}).vector({0, 0, -1}), {0, -1, 0}, 1e-15);
  // Scale first, then rotation, then translation.
  expect_near(Transform::from_trs({10, 0, 0}, {0, s, 0, s}, {2, 3, 4}).point({1, 1, 1}), {14, 3, -2}, 1e-14);
}

TEST(Transform, ColumnMajorMatrixAndTrsAgree) {
  const double s = std::sqrt(0.5);
  const Transform trs = Transform::from_trs({5, 6, 7}, {0, 0, s, s}, {2, 3, 4});
  const Transform matrix = Transform::from_column_major({0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1});
  expect_near(trs.point({1, 2, 3}), matrix.point({1, 2, 3}), 1e-14);
}

TEST(Transform, ProductAppliesTheRightOneFirst) {
  const Transform a = Transform::from_trs({1, 2, 3}, {0.5, 0.5, 0.5, 0.5}, {2, 2, 2});
  const Transform b = Transform::from_trs({-1, 0, 4}, {0, 0.6, 0, 0.8}, {1, 3, 1});
  expect_near((a * b).point({0.3, -0.7, 2}), a.point(b.point({0.3, -0.7, 2})), 1e-14);
  EXPECT_NEAR((a * b).determinant(), a.determinant() * b.determinant(), 1e-13);
}

// A normal stays perpendicular to the image of its plane, and on the side of the image of a point in front of it; mirrored or not.
TEST(Transform, NormalsStayPerpendicularAndOnTheirSide) {
  for (const double mirror : {1.0, -1.0}) {
    const Transform t = Transform::from_trs({1, 2, 3}, {0.1, 0.2, 0.3, std::sqrt(1 - 0.14)}, {2 * mirror, 0.5, 3});
    const Vec3d n = normalised(Vec3d{1, 2, 3});
    const Basis basis = basis_around(n);
    const Vec3d image = t.normal(n);
    EXPECT_NEAR(dot(image, t.vector(basis.tangent)), 0, 1e-13);
    EXPECT_NEAR(dot(image, t.vector(basis.bitangent)), 0, 1e-13);
    EXPECT_GT(dot(image, t.vector(n)), 0);
  }
}

TEST(Transform, RigidDropsScaleShearAndMirroring) {
  Transform sheared = Transform::from_trs({1, 2, 3}, {0, 0.6, 0, 0.8}, {-2, 3, 4});
  sheared.columns[1] += sheared.columns[2] * 0.3;
  const Transform rigid = sheared.rigid();
  EXPECT_NEAR(rigid.determinant(), 1, 1e-14);
  expect_near(rigid.columns[2], normalised(sheared.columns[2]), 1e-15);
  EXPECT_NEAR(dot(rigid.columns[1], rigid.columns[2]), 0, 1e-15);
  EXPECT_GT(dot(rigid.columns[1], sheared.columns[1]), 0);
  EXPECT_EQ(rigid.translation, sheared.translation);
}

}  // namespace
}  // namespace etendue
