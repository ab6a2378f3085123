// Where a program's light and ours differ although their amounts agree.
#include "dialect_rules.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue {
namespace {

using D = Dialect;
enum class Window { none, gltf, frostbite, its_own };

Window window_of(Dialect dialect) {
  switch (dialect) {
    case D::gltf_spec:
    case D::gltf_compat:
    case D::gltf_raw:
      return Window::gltf;
    case D::frostbite:
    case D::filament:
    case D::unreal:
    case D::threejs:
      return Window::frostbite;
    case D::hdrp:
    case D::godot:
      return Window::its_own;
    default:
      return Window::none;
  }
}

void add_range(Dialect dialect, const Light& light, const std::string& name, LossReport& losses) {
  if (!light.range_m) {
    if (light.falloff == Falloff::karis) losses.add(name + ": falloff karis", "inverse square there: twice the light at 1 m");
    return;
  }
  const Window window = window_of(dialect);
  const std::string what = fmt::format("{}: range {} m", name, *light.range_m);
  if (window == Window::none)
    losses.add(what, "there is none: light reaches on");
  else if (window == Window::its_own)
    losses.add(what, "the program has a window of its own, not our (1 - (d/r)^4)^2");
  else if (window == Window::gltf && light.falloff == Falloff::frostbite)
    losses.add(what, "its window there is 1 - (d/r)^4, by up to 25 % of the unwindowed light brighter than its square");
  else if (window == Window::frostbite && light.falloff == Falloff::gltf)
    losses.add(what, "its window there is (1 - (d/r)^4)^2, by up to 25 % of the unwindowed light darker than 1 - (d/r)^4");
  else if (light.falloff != (window == Window::gltf ? Falloff::gltf : Falloff::frostbite))
    losses.add(what, fmt::format("its window there is {}, not \"{}\"", window == Window::gltf ? "1 - (d/r)^4" : "(1 - (d/r)^4)^2",
                                 name_of(light.falloff)));
}

void add_spot(Dialect dialect, const Light& light, const std::string& name, LossReport& losses) {
  const auto* spot = std::get_if<SpotShape>(&light.shape);
  if (spot == nullptr || spot->inner_rad == spot->outer_rad) return;
  const std::string what = name + ": falloff between the cones";
  if (dialect == D::godot) losses.add(what, "a power of its own; the light on the axis is the same");
  if (dialect != D::pbrt && dialect != D::threejs && dialect != D::blender) return;
  // Over s = (cos t - cos o) / (cos i - cos o): s^2 integrates to 1/3, s^2 (3 - 2 s) to 1/2.
  const double inner = solid_angle_of(SpotShape{spot->inner_rad, spot->inner_rad}, FluxConvention::cone),
               outer = solid_angle_of(*spot, FluxConvention::cone), squared = solid_angle_of(*spot, FluxConvention::falloff);
  losses.add(what, fmt::format("smoothstep for a square: the same light on the axis, {:+.1f} % of flux in all",
                               100 * ((inner + outer) / 2 / squared - 1)));
}

}  // namespace

void add_differences(Dialect dialect, const Light& light, LossReport& losses) {
  const std::string name = fmt::format("light '{}'", light.name);
  add_range(dialect, light, name, losses);
  add_spot(dialect, light, name, losses);
  const bool punctual = std::holds_alternative<PointShape>(light.shape) || std::holds_alternative<SpotShape>(light.shape);
  if (dialect == D::frostbite && punctual)
    losses.add(name + ": nearer than 1 cm", "Frostbite holds the illuminance at its value there: E = I / max(d^2, 1 cm^2)");
  if (dialect == D::hdrp && std::holds_alternative<LineShape>(light.shape))
    losses.add(name + ": distribution", "HDRP's tube has the same intensity in all directions, ours the sine of the angle to the line");
  if (const auto* tube = std::get_if<TubeShape>(&light.shape)) {
    if (dialect == D::usd && tube->caps != Caps::none) losses.add(name + ": caps", "a CylinderLight's ends stay dark");
    if (dialect == D::frostbite && tube->caps != Caps::round) losses.add(name + ": caps", "Frostbite's tube is a capsule");
  }
  if (emits_both_sides(light) && dialect != D::pbrt) losses.add(name + ": two-sided", "its back stays dark");
  if (light.emission.texture) losses.add(name + ": emission texture", "even, at the luminance of a white texel");
}

}  // namespace etendue
