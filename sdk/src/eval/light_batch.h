// One shape of light made ready for many points: what LightBatch (etendue/illuminance_batch.h) asks of each, and what their kernels share
// before an instruction set is chosen.
#pragma once

#include "etendue/illuminance_batch.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace etendue::eval {

class LightBatch::Shape {
 public:
  virtual ~Shape() = default;
  // LightBatch::projected_solid_angles, sizes checked.
  virtual std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const = 0;
};

// Of a white emitter of each shape; null where its numbers are beyond the kernel.
std::shared_ptr<const LightBatch::Shape> sphere_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> rect_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> tube_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> mesh_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> line_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> punctual_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> distant_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> disk_batch(const Emitter& white);
std::shared_ptr<const LightBatch::Shape> polygon_batch(const Emitter& white);

// A coordinate, and as the sum of two floats: what is left of it after a point's coordinate is taken away has all its digits.
struct Coordinate {
  double whole;
  float high, low;
  explicit Coordinate(double x) : whole(x), high(static_cast<float>(x)), low(static_cast<float>(x - static_cast<double>(high))) {}
};
// A constant of a light in both precisions: converted once, not at every point.
struct Constant {
  double whole = 0;
  float single = 0;
  Constant() = default;
  Constant(double x) : whole(x), single(static_cast<float>(x)) {}  // NOLINT(google-explicit-constructor): a number is one
};
struct Direction {
  Constant x, y, z;
  explicit Direction(const Vec3d& v) : x(v.x), y(v.y), z(v.z) {}
};
struct Place {
  Coordinate x, y, z;
  explicit Place(const Vec3d& p) : x(p.x), y(p.y), z(p.z) {}
};

// The power of two that brings a length to between 1 and 2: in such units no square leaves the range of a float.
double unit_for(double size);

// The definition, eval::illuminance, at one point of a batch.
float in_double(const Emitter& white, const PointBatch& points, std::size_t index);

}  // namespace etendue::eval
