// Extended lights with a distance window: what it takes of their light, or what it leaves.
//
// (1 - x^4) and its square are 1 less a polynomial that begins with x^4, and the form factor has n.y m.y / |y|^4: what they take within the
// range is the integral of a polynomial over the emitter, beyond it all of the light there, and E is that without them less this. Of the
// other windows what is left is integrated, along outlines and over one variable. Derivation: sdk/docs/area-lights.md.
#pragma once

#include "local.h"

#include <limits>
#include <optional>

namespace etendue::eval {

// 1 - w where it is a polynomial, lengths in units of the range.
class Taken {
 public:
  // Only of windows that suit(it).
  explicit Taken(const Window& window) : unit_m(window.range_m), squared_(window.falloff == Falloff::frostbite) {}
  static bool suits(const Window& window) { return window.falloff == Falloff::frostbite || window.falloff == Falloff::gltf; }
  const double unit_m;
  static constexpr bool is_left = false;

  // Nothing is left from here on.
  static constexpr double end() { return 1; }
  // (1 - w) / d^4 within the range: 1, and 2 - d^4 of the squared window.
  double per_fourth(double d2) const { return squared_ ? 2 - d2 * d2 : 1; }
  // 1 - w.
  double at(double d2) const { return d2 < 1 ? d2 * d2 * per_fourth(d2) : 1; }

 private:
  bool squared_;
};

// w of any window, lengths in units of the range, or of 1 m without one. With q = d^2 the integrals over a plane at the height h ask for
// those of w / q^2 over q, which are logarithms and powers; kept.cpp has them.
class Kept {
 public:
  explicit Kept(const Window& window);
  const double unit_m;
  static constexpr bool is_left = true;

  double end() const { return endless_ ? std::numeric_limits<double>::infinity() : 1; }
  double at(double d2) const;  // w, 0 from the end on
  // Half the integral of w / q^2 from h^2 to h^2 + rho^2, over rho^2. h > 0.
  double spread(double h2, double rho2) const;
  // Half the integral of w / q^2 from q to the end.
  double beyond(double q) const;
  // No power of d in w is higher.
  double steepest() const;
  bool linear() const { return falloff_ == Falloff::linear; }

 private:
  Falloff falloff_;
  bool endless_;
  double gain_ = 1, soft2_ = 0;  // of `scale_bias`; 1 m^2 of `karis`
};

struct WindowPart {
  double value = 0;           // sr; of a line 1/m2. What is taken, or left: `of_left`
  bool of_left = false;       // which of both
  bool nothing_left = false;  // the whole light is beyond the range
};

// For a luminance of 1 cd/m2, or of lines an intensity of 1 cd. `emitter` has a window. Nothing from inside of what emits on both sides,
// and of round lights with two horizons.
std::optional<WindowPart> window_part(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons);

// All of the following above the horizon of z, in Taken's or Kept's unit.
// A flat light, cut at its horizons. `on_light`: any point of its plane.
WindowPart flat_part(const Contour& seen, const Vec3d& on_light, const Vec3d& normal, const Taken& taken);
WindowPart flat_part(const Contour& seen, const Vec3d& on_light, const Vec3d& normal, const Kept& kept);
// A line in metres.
struct LineView;
WindowPart line_part(const LineView& view, const Taken& taken);
WindowPart line_part(const LineView& view, const Kept& kept);
// A sphere seen from outside; with `outwards` that half of it, the cap of a tube.
double ball_part(const Vec3d& centre, double radius, const Taken& taken, const std::optional<Vec3d>& outwards);
double ball_part(const Vec3d& centre, double radius, const Kept& kept, const std::optional<Vec3d>& outwards);
// The side of a tube from a to b.
double tube_side_part(const Vec3d& a, const Vec3d& b, double radius, const Taken& taken);
double tube_side_part(const Vec3d& a, const Vec3d& b, double radius, const Kept& kept);

}  // namespace etendue::eval
