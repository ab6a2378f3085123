// Lights whose outlines are made of circles of directions or in space, and their sides at many points: what the kernels of
// specular_polygon_sides_batch.cpp, specular_round_sides_batch.cpp and specular_arc_sides_batch.cpp lay out, and specular_cells_batch.cpp
// integrates from.
#pragma once

#include "specular_cells.h"

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

namespace etendue::eval {

// Places are relative to the origin of the points.
struct CornersSeen {
  std::vector<Vec3d> corners;  // counter-clockwise about the directions between them, as seen from the front
  Vec3d normal;
  std::size_t most_parts = 1;  // into which a horizon may cut it
};
struct BallSeen {
  Vec3d centre;
  double radius;
};
struct CapSeen {  // of directions, the same everywhere
  Vec3d axis;
  double cosine, sine;
};
struct DiskSeen {
  Vec3d centre, normal;
  double radius;
};
struct TubeSeen {
  Vec3d a, b;  // centres of the caps
  double radius;
  Caps caps;
};
struct OutlinedLight {
  std::variant<CornersSeen, BallSeen, CapSeen, DiskSeen, TubeSeen> shape;
  bool two_sided = false;
  bool separable = false;  // masking; else height-correlated
  double least = 0;        // of the floor below which errors are not relative to the value

  OutlinedLight seen_from(const Vec3d& origin) const;
};

// Nothing for lights with another outline. Within a sphere or a tube that emits there too points are in doubt.
std::optional<OutlinedLight> outlined(const Emitter& emitter);

// Of a polygon that is not convex the parts that are laid out; points that see more are in doubt.
inline constexpr std::size_t most_horizon_sides = 4;

// The sides of the first `count` points.
void lay_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block);

// Kernels of one shape each.
void lay_polygon_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block);
void lay_round_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block);
void lay_arc_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block);

}  // namespace etendue::eval
