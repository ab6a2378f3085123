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

// Frostbite's parts that are no illuminance.
// Listing 9: what multiplies a disk's illuminance to fade it out as a spot: the cone's share (listing 4) seen from behind the disk, where a
// cone of the outer angle (half of the whole, below pi / 2) through its rim has its tip.
double frostbite_disk_cone(const DiskEmitter& disk, const SpotShape& cone, const Vec3d& position);
// Listing 15: the direction for which Disney's diffuse lobe of that linear roughness is evaluated in the normal's place, between the normal
// and the view (all unit).
Vec3d frostbite_diffuse_direction(const Vec3d& normal, const Vec3d& view, double roughness);

}  // namespace etendue::eval
