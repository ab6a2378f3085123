// The published approximations of diffuse light from area lights, by name: what others reach, to be measured against eval::illuminance.
//   const DiffuseMethod* m = find_diffuse_method("frostbite-12");
//   std::optional<double> lux = m->illuminance(emitter, position, normal);   // for a luminance of 1 cd/m2
#pragma once

#include "etendue/eval.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue::eval {

// Lights as a shading point sees them; sdk/src/eval/views.h.
struct RectView;
struct DiskView;
struct SphereView;
struct TubeView;

// One method in the form of its source. Where a source is wrong or not defined, the printed form keeps what is printed and another method,
// "NAME-mended", says what is right; `note` tells the error of both.
struct DiffuseMethod {
  std::string_view name;    // lower case, words joined by hyphens
  std::string_view source;  // authors, year, listing or equation
  std::string_view note;    // what it approximates, where it breaks
  // One function a shape that it takes, given the light and the normal relative to the point.
  double (*rect)(const RectView&, const Vec3d& normal) = nullptr;
  double (*disk)(const DiskView&, const Vec3d& normal) = nullptr;
  double (*sphere)(const SphereView&, const Vec3d& normal) = nullptr;
  double (*tube)(const TubeView&, const Vec3d& normal) = nullptr;

  // Illuminance (lx) at a point with a unit normal under the emitter with a luminance of 1 cd/m2, without pattern and window. Nothing if
  // the method does not take the shape: a rectangle is a polygon of four right angles, a tube one with round caps. One-sided flat lights
  // are dark from behind. Where a printed form divides by zero or leaves the domain of its functions the answer is 0.
  std::optional<double> illuminance(const Emitter& emitter, const Vec3d& position, const Vec3d& normal) const;
};

// Every method, in the order of its sources.
std::span<const DiffuseMethod> diffuse_methods();
// Null if no method has the name.
const DiffuseMethod* find_diffuse_method(std::string_view name);

}  // namespace etendue::eval
