// The rules of SpecularMethodBatch, and lights as their kernels take them.
#pragma once

#include "light_batch.h"
#include "specular_batch.h"

#include <cstddef>
#include <span>

namespace etendue::eval {

enum class PublishedRule {
  punctual,
  covered_lobe,
  covered_strip,
  drobot_20,
  drobot_20_fitted,
  karis_10,
  karis_11,
  karis_14,
  karis_18,
  karis_19,
  karis_20,
  karis_20_mended,
  eden_sphere,
  eden_tube,
  eden_tube_mended,
  // Of a light's illuminance, or of a share of the lobe's albedo: specular_lit_method_batch.cpp.
  frostbite_point,
  frostbite_16,
  frostbite_6,
  eden_rect,
  karis_billboard,
  karis_cone,
  ltc_line,
  ltc_line_ends,
  covered_footprint,
};

// Lights from the batch's origin; sides and normals are directions.
struct PlacedRect {
  Place centre;
  Direction x, y, normal;
  float half_x, half_y;
};
struct PlacedDisk {
  Place centre;
  Direction normal, x;  // x: some direction in its plane
  float radius;
};
struct PlacedSphere {
  Place centre;
  float radius;
};
struct PlacedSun {
  Direction towards;
  float radius;  // the sine of its angle
};
struct PlacedTube {
  Place a, b;
  float radius;
};

// At every point; how many are not finite.
struct MethodOutput {
  std::span<float> of_f0, of_f90;
  float where_none;
};
constexpr bool is_lit_method(PublishedRule rule) { return rule >= PublishedRule::frostbite_point; }
std::size_t by_lit_method(PublishedRule rule, const PlacedRect& light, const SpecularPoints& points, const MethodOutput& out);
std::size_t by_lit_method(PublishedRule rule, const PlacedDisk& light, const SpecularPoints& points, const MethodOutput& out);
std::size_t by_lit_method(PublishedRule rule, const PlacedSphere& light, const SpecularPoints& points, const MethodOutput& out);
std::size_t by_lit_method(PublishedRule rule, const PlacedSun& light, const SpecularPoints& points, const MethodOutput& out);
std::size_t by_lit_method(PublishedRule rule, const PlacedTube& light, const SpecularPoints& points, const MethodOutput& out);

}  // namespace etendue::eval
