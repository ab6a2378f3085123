// With the half vector h = v + l and h' = (h.x / alpha, h.y / alpha, h.z), normalised, the lobe of GGX is a clamped cosine at every alpha:
// D(h) n.h dh = n.h' / pi dh', and n.h' dh' is the area dx dy of (x, y) = (h'.x, h'.y) in the unit disk. A light's luminance is
//     integral of D G2 F / (4 n.v n.l) n.l dl = 1 / pi  integral of W dx dy,    W = G2 F v.h / (n.v n.h),
// over what the light covers of that disk, and W varies slowly. The area is found from the outline in pieces, each a great circle in h' by
// Lambert's formula; W is taken at four nodes that have the first two moments of the area.
#include "specular_moments.h"

#include "fresnel.h"
#include "local.h"
#include "microfacet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

// Factors on f0 and on f90.
struct SchlickParts {
  double f0 = 0, f90 = 0;
};

class Disk {
 public:
  Disk(double alpha, const Vec3d& view) : alpha_(std::clamp(alpha, min_alpha, 1.0)), view_(view), view_root_(root(view.z)) {}

  Vec3d linear(const Vec3d& v) const { return {v.x / alpha_, v.y / alpha_, v.z}; }
  // h' of a direction, of any length.
  Vec3d bent(const Vec3d& light) const { return linear(view_ + light); }
  // W at a place of the disk, no further out than the radius squared `rim`; nothing where the light would come from below the horizon.
  SchlickParts weight(const Vec2d& at, double rim) const {
    const double squared = at.x * at.x + at.y * at.y, inwards = squared > rim ? std::sqrt(rim / squared) : 1;
    const double x = at.x * inwards, y = at.y * inwards;
    const Vec3d h = normalised(Vec3d{alpha_ * x, alpha_ * y, std::sqrt(1 - x * x - y * y)});
    const double v_dot_h = dot(view_, h), n_dot_l = 2 * v_dot_h * h.z - view_.z;
    if (!(v_dot_h > 0 && n_dot_l > 0)) return {};
    const double shape = 2 * n_dot_l * v_dot_h / (h.z * (n_dot_l * view_root_ + view_.z * root(n_dot_l)));
    const double grazing = shape * schlick_weight(v_dot_h);
    return {shape - grazing, grazing};
  }

 private:
  double root(double x) const { return std::sqrt(x * x + alpha_ * alpha_ * (1 - x * x)); }

  double alpha_;
  Vec3d view_;
  double view_root_;
};

// Nodes of a smooth part of an outline: unit vectors in h', closer where it passes the lobe.
constexpr std::size_t pieces = 4;
using Nodes = std::array<Vec3d, pieces + 1>;

// Area and moments of what closed chains of such parts enclose of the disk.
class Enclosed {
 public:
  void add(const Nodes& at) {
    // Chords miss of a curve what goes with the square of their length: four thirds of all, less a third of every other.
    for (std::size_t i = 0; i < pieces; ++i) add(at[i], at[i + 1], 4.0 / 3);
    for (std::size_t i = 0; i < pieces; i += 2) add(at[i], at[i + 2], -1.0 / 3);
  }
  double area() const { return area_; }
  Vec2d middle() const { return {x_ / flat_, y_ / flat_}; }
  // Equal shares at +-(p u + q w) and +-(p w - q u) from the middle, p^2 + q^2 = 2, u u^T + w w^T the second moments, w across the view:
  // any p has them; tan(22.5 degrees) between q and p is least wrong for Fresnel's term at alpha 1.
  std::array<Vec2d, 4> nodes() const {
    constexpr double p = 1.3065629648763766, q = 0.5411961001461970;
    const auto [x, y] = middle();
    const double xx = std::max(xx_ / flat_ - x * x, least_square), yy = yy_ / flat_ - y * y, xy = xy_ / flat_ - x * y;
    const double along = std::sqrt(xx), b = xy / along, across = std::sqrt(std::max(yy - b * b, 0.0));
    const Vec2d u{along, b};
    return {{{x + p * u.x, y + p * u.y + q * across},
             {x - p * u.x, y - p * u.y - q * across},
             {x - q * u.x, y - q * u.y + p * across},
             {x + q * u.x, y + q * u.y - p * across}}};
  }
  bool is_flat() const { return !(flat_ > 0); }

 private:
  static constexpr double least_square = 1e-12;
  // The area between the great circle and the middle of the disk is Lambert's; the moments are those of straight chords.
  void add(const Vec3d& from, const Vec3d& to, double share) {
    const double sine = length(cross(from, to)), turn = share * (from.x * to.y - from.y * to.x);
    if (sine > 0) area_ += 0.5 * turn * std::atan2(sine, dot(from, to)) / sine;
    flat_ += turn / 2;
    x_ += turn * (from.x + to.x) / 6;
    y_ += turn * (from.y + to.y) / 6;
    xx_ += turn * (from.x * from.x + from.x * to.x + to.x * to.x) / 12;
    yy_ += turn * (from.y * from.y + from.y * to.y + to.y * to.y) / 12;
    xy_ += turn * (2 * from.x * from.y + from.x * to.y + to.x * from.y + 2 * to.x * to.y) / 24;
  }

  double area_ = 0, flat_ = 0, x_ = 0, y_ = 0, xx_ = 0, yy_ = 0, xy_ = 0;
};

// A part of an arc as directions b(t) = b_0 + b_1 t + b_2 t^2 of any length, t from -1 to 1: with t = tan of a quarter of the turn, a
// circle is such a quadratic over 1 + t^2.
class Curve {
 public:
  Curve(const Disk& disk, const Arc& arc, double begin, double end) : disk_(disk) {
    const double middle = 0.5 * (begin + end), cosine = std::cos(middle), sine = std::sin(middle), t = std::tan(0.25 * (end - begin));
    const Vec3d outwards = arc.u * cosine + arc.v * sine, onwards = arc.v * cosine - arc.u * sine;
    b_ = {arc.centre + outwards, onwards * (2 * t), (arc.centre - outwards) * (t * t)};
  }
  // M (v + l), and how it changes with t.
  Vec3d at(double t) const { return disk_.bent(normalised(place(t))); }
  Vec3d speed(double t) const {
    const Vec3d b = place(t), onwards = b_[1] + b_[2] * (2 * t);
    return disk_.linear((onwards - b * (dot(b, onwards) / dot(b, b))) / length(b));
  }

 private:
  Vec3d place(double t) const { return b_[0] + (b_[1] + b_[2] * t) * t; }
  const Disk& disk_;
  std::array<Vec3d, 3> b_;
};

// Where the outline passes the lobe it takes a short way in its parameter: the pieces are even in u, t = t_0 + w sinh(u) / 4.5, with t_0 +-
// i w close to where |v + l| is zero once the matrix has been at it: in two steps of Newton's from the middle, kept to the arc.
constexpr double longest = pi / 3, longest_great_circle = 0.999 * pi;
void add(const Curve& curve, Enclosed& enclosed) {
  double nearest = 0, width = 1;
  for (int turn = 0; turn < 2; ++turn) {
    const Vec3d h = curve.at(nearest), speed = curve.speed(nearest);
    const double squared = std::max(dot(speed, speed), 1e-300);
    width = std::max(length(cross(h, speed)) / (4.5 * squared), 1e-9);
    nearest = std::clamp(nearest - dot(h, speed) / squared, -1.0, 1.0);
  }
  const double first = std::asinh((-1 - nearest) / width), last = std::asinh((1 - nearest) / width);
  Nodes at;
  for (std::size_t i = 0; i <= pieces; ++i) {
    const double t = nearest + width * std::sinh(first + (last - first) * static_cast<double>(i) / pieces);
    at[i] = normalised(curve.at(i == 0 ? -1 : i == pieces ? 1 : t));
  }
  enclosed.add(at);
}

}  // namespace

Rgb by_moments(const Emitter& emitter, const ShadingPoint& point, const GgxLobe& lobe) {
  // The nodes' axes are the view's plane and across it.
  ShadingPoint turned = point;
  turned.tangent = point.view;
  const LocalFrame frame(turned);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return Rgb{};
  const Disk disk(lobe.alpha, view);
  SchlickParts sum;
  each_outline(emitter, frame, [&](const Contour& outline, std::size_t) {
    Enclosed enclosed;
    for (const Arc& arc : clipped(outline, horizons_of(frame, point.normal, point.surface_normal))) {
      const double most = arc.great_circle() ? longest_great_circle : longest;
      const int parts = std::max(1, static_cast<int>(std::ceil((arc.end - arc.begin) / most - 1e-9)));
      const double length = (arc.end - arc.begin) / parts;
      for (int i = 0; i < parts; ++i) add(Curve(disk, arc, arc.begin + i * length, arc.begin + (i + 1) * length), enclosed);
    }
    if (!(enclosed.area() > 0) || enclosed.is_flat()) return;
    // At grazing views W grows without bound towards the rim, where there is hardly any area; a node may lie closer to it than all that is
    // enclosed, or beyond.
    const Vec2d middle = enclosed.middle();
    const double rim = 1 - 0.1 * std::max(1 - middle.x * middle.x - middle.y * middle.y, 1e-12);
    const double share = 0.25 * enclosed.area() / pi;
    for (const Vec2d& node : enclosed.nodes()) {
      const SchlickParts weight = disk.weight(node, rim);
      sum.f0 += share * weight.f0, sum.f90 += share * weight.f90;
    }
  });
  // The lobe of a perfect mirror sums to 1 at most.
  const double kept = 1 / std::max(sum.f0 + sum.f90, 1.0);
  return lobe.f0 * (kept * sum.f0) + Rgb{1, 1, 1} * (kept * sum.f90 * lobe.f90);
}

}  // namespace etendue::eval
