// Bounds of the light of one or many emitters at every point of a box.
#pragma once

#include "etendue/eval.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace etendue::eval {

// Of positions, or of vectors such as normals.
struct Box {
  Vec3d low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};

  void add(const Vec3d& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box& other) { add(other.low), add(other.high); }
  Vec3d middle() const { return low * 0.5 + high * 0.5; }
  Vec3d half() const { return high * 0.5 - low * 0.5; }

  static constexpr double infinite = std::numeric_limits<double>::infinity();
};

// A box as bounds ask for it. Of positions it is wider than the one it is made from, by more than what sums of its numbers are rounded.
struct Around {
  Vec3d middle, half;
  static Around positions(const Box& box);
  static Around directions(const Box& box) { return {box.middle(), box.half()}; }
};
// Points and their normals, unit vectors to rounding.
struct Surroundings {
  Around positions, normals;
};

// Everything that the lights emit, from anywhere within `places`.
struct LightBound {
  Around places, normals;  // normals: of the emitting sides, or the axes of spots
  // The illuminance facing the lights at the distance d of the nearest is at most (around + facing cos) / d^2, cos that of the angle
  // to the closest of the normals; cd.
  double around = 0, facing = 0;
  // Of it, what is certain where all of the lights is seen: the same with the distance of the furthest.
  double sure_around = 0, sure_facing = 0;
  // Of one tube or line: what of `around` comes from its side, which is seen in proportion to the distance across the axis over that to
  // the point; and of it, for certain, where the first is larger than `hidden_m` and by what is left of it.
  Vec3d axis;
  double across = 0, sure_across = 0, hidden_m = 0, radius_m = 0;
  double most = 0;   // lx, at any distance
  double reach = 0;  // most of Bound's
  // No light goes where the cosine with all normals is less; -1: it goes everywhere.
  double least_cosine = -1;
  double range_m = Box::infinite;  // no light goes further
  Window window;                   // of one light; of many none
};
// Of both together.
LightBound joined(const LightBound& a, const LightBound& b);

// Nothing where there is no such bound: environments, true directions, patterns.
std::optional<LightBound> light_bound(const Emitter& emitter);

// What the lights give at any of the points, in lux, the largest channel: at most `most`, 0 where none is seen, and at least `least`.
// `reach`: what a surface that faces the lights gets at most, without their windows; of area lights the luminance times
// min(1, solid angle).
struct Bound {
  double most = 0, least = 0, reach = 0;
};
Bound bound_at(const LightBound& light, const Surroundings& points);

}  // namespace etendue::eval
