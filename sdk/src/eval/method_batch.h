// Lights as the methods of etendue/method_batch.h take them, before an instruction set is chosen: floats from the points' origin.
#pragma once

#include "etendue/method_batch.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace etendue::eval {

struct FlatRect {
  Vec3f centre, x, y, normal;  // unit; cross(x, y) is the normal
  float half_x, half_y;
};
struct FlatDisk {
  Vec3f centre, normal;
  float radius;
};
struct Ball {
  Vec3f centre;
  float radius;
};
struct Capsule {
  Vec3f a, b, axis;  // centres of the caps; unit, from a to b
  float length, radius;
};

// One a shape; how many points were not finite.
std::size_t rect_by(BatchRule rule, const FlatRect& light, const PointBatch& points, std::span<float> sr, float where_none);
std::size_t disk_by(BatchRule rule, const FlatDisk& light, const PointBatch& points, std::span<float> sr, float where_none);
std::size_t sphere_by(BatchRule rule, const Ball& light, const PointBatch& points, std::span<float> sr, float where_none);
std::size_t tube_by(BatchRule rule, const Capsule& light, const PointBatch& points, std::span<float> sr, float where_none);

// 64 x 64 nodes of the ratio of a sphere's form factor above the horizon to its whole, in the cosine to its centre (-1 to 1) and the whole
// one (0 to 1); hill_heitz.cpp.
inline constexpr std::size_t ratio_nodes = 64;
std::span<const float, ratio_nodes * ratio_nodes> sphere_ratios();

}  // namespace etendue::eval
