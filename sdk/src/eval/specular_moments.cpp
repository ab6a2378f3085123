// With the half vector h = v + l and h' = (h.x / alpha, h.y / alpha, h.z), normalised, the lobe of GGX is a clamped cosine at every alpha:
// D(h) n.h dh = n.h' / pi dh', and n.h' dh' is the area dx dy of (x, y) = (h'.x, h'.y) in the unit disk. A light's luminance is
//     integral of D G2 F / (4 n.v n.l) n.l dl = 1 / pi  integral of W dx dy,    W = G2 F v.h / (n.v n.h),
// over what the light covers of that disk, and W varies slowly. The area is found from the outline in pieces, each a great circle in h' by
// Lambert's formula; W is taken at the four nodes that have the first two moments of the area.
#include "specular_moments.h"

#include "fresnel.h"
#include "local.h"
#include "microfacet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

class Disk {
 public:
  Disk(const GgxLobe& lobe, const Vec3d& view)
      : lobe_(lobe), alpha_(std::max(lobe.alpha, min_alpha)), view_(view), view_root_(root(view.z)) {}

  // h' of a direction, of any length.
  Vec3d bent(const Vec3d& light) const {
    const Vec3d h = view_ + normalised(light);
    return {h.x / alpha_, h.y / alpha_, h.z};
  }
  // W at a place of the disk, no further out than the radius squared `rim`; nothing where the light would come from below the horizon.
  Rgb weight(const Vec2d& at, double rim) const {
    const double squared = at.x * at.x + at.y * at.y, inwards = squared > rim ? std::sqrt(rim / squared) : 1;
    const double x = at.x * inwards, y = at.y * inwards;
    const Vec3d h = normalised(Vec3d{alpha_ * x, alpha_ * y, std::sqrt(1 - x * x - y * y)});
    const double v_dot_h = dot(view_, h), n_dot_l = 2 * v_dot_h * h.z - view_.z;
    if (!(v_dot_h > 0 && n_dot_l > 0)) return {};
    const double shape = 2 * n_dot_l * v_dot_h / (h.z * (n_dot_l * view_root_ + view_.z * root(n_dot_l)));
    return schlick(lobe_.f0, lobe_.f90, schlick_weight(v_dot_h)) * shape;
  }

 private:
  double root(double x) const { return std::sqrt(x * x + alpha_ * alpha_ * (1 - x * x)); }

  const GgxLobe& lobe_;
  double alpha_;
  Vec3d view_;
  double view_root_;
};

// Area and moments of what a closed chain of great circles encloses of the disk, or sums of such chains.
class Enclosed {
 public:
  void add(const Vec3d& from, const Vec3d& to, double share) {
    const Vec3d across = cross(from, to);
    const double sine = length(across);
    if (sine > 0) area_ += share * 0.5 * across.z * std::atan2(sine, dot(from, to)) / sine;
    const double turn = share * (from.x * to.y - from.y * to.x);
    flat_ += turn / 2;
    x_ += turn * (from.x + to.x) / 6;
    y_ += turn * (from.y + to.y) / 6;
    xx_ += turn * (from.x * from.x + from.x * to.x + to.x * to.x) / 12;
    yy_ += turn * (from.y * from.y + from.y * to.y + to.y * to.y) / 12;
    xy_ += turn * (2 * from.x * from.y + from.x * to.y + to.x * from.y + 2 * to.x * to.y) / 24;
  }
  double area() const { return area_; }
  Vec2d middle() const { return {x_ / flat_, y_ / flat_}; }
  // Equal shares at (+-sigma_1, +-sigma_2) from the middle, along the axes of the second moments.
  std::array<Vec2d, 4> nodes() const {
    const auto [x, y] = middle();
    const double xx = xx_ / flat_ - x * x, yy = yy_ / flat_ - y * y, xy = xy_ / flat_ - x * y;
    const double mean = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy), angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double longer = std::sqrt(std::max(mean + apart, 0.0)), shorter = std::sqrt(std::max(mean - apart, 0.0));
    const Vec2d a{longer * std::cos(angle), longer * std::sin(angle)}, b{-shorter * std::sin(angle), shorter * std::cos(angle)};
    return {
        {{x + a.x + b.x, y + a.y + b.y}, {x + a.x - b.x, y + a.y - b.y}, {x - a.x + b.x, y - a.y + b.y}, {x - a.x - b.x, y - a.y - b.y}}};
  }
  bool is_flat() const { return !(flat_ > 0); }

 private:
  double area_ = 0, flat_ = 0, x_ = 0, y_ = 0, xx_ = 0, yy_ = 0, xy_ = 0;
};

// Where the outline passes the lobe it takes a short way in its parameter: the pieces are even in u, s = s_0 + width sinh(u), s_0 close to
// where the slopes (h'.x, h'.y) / h'.z are least, and the width the one over which they grow by half of their distance from the lobe.
constexpr int pieces = 6;
constexpr double longest = 0.5 * pi;
void add(const Disk& disk, const Arc& arc, double begin, double end, Enclosed& enclosed) {
  double nearest = 0.5 * (begin + end), width = end - begin;
  for (int turn = 0; turn < 2; ++turn) {
    const double step = 1e-4 * (end - begin);
    const auto slopes = [&](double s) {
      const Vec3d h = disk.bent(arc.at(s));
      return Vec2d{h.x / h.z, h.y / h.z};
    };
    const Vec2d at = slopes(nearest), before = slopes(nearest - step), after = slopes(nearest + step);
    const Vec2d speed{(after.x - before.x) / (2 * step), (after.y - before.y) / (2 * step)};
    const double squared = std::max(speed.x * speed.x + speed.y * speed.y, 1e-30);
    width = 0.5 * std::sqrt((1 + at.x * at.x + at.y * at.y) / squared);
    if (turn == 0) nearest = std::clamp(nearest - (at.x * speed.x + at.y * speed.y) / squared, begin, end);
  }
  const double first = std::asinh((begin - nearest) / width), last = std::asinh((end - nearest) / width);
  // Chords miss of a curve what goes with the square of their length: four thirds of all, less a third of every other.
  std::array<Vec3d, pieces + 1> at;
  for (int i = 0; i <= pieces; ++i) {
    const double s = nearest + width * std::sinh(first + (last - first) * i / pieces);
    at[static_cast<std::size_t>(i)] = normalised(disk.bent(arc.at(i == 0 ? begin : i == pieces ? end : s)));
  }
  for (std::size_t i = 0; i < pieces; ++i) enclosed.add(at[i], at[i + 1], 4.0 / 3);
  for (std::size_t i = 0; i < pieces; i += 2) enclosed.add(at[i], at[i + 2], -1.0 / 3);
}

}  // namespace

Rgb by_moments(const Emitter& emitter, const ShadingPoint& point, const GgxLobe& lobe) {
  const LocalFrame frame(point.position, point.normal);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return Rgb{};
  const Disk disk(lobe, view);
  Rgb sum;
  each_outline(emitter, frame, [&](const Contour& outline, std::size_t) {
    Enclosed enclosed;
    for (const Arc& arc : clipped(outline, horizons_of(frame, point.normal, point.surface_normal))) {
      const int parts = std::max(1, static_cast<int>(std::ceil((arc.end - arc.begin) / longest - 1e-9)));
      const double length = (arc.end - arc.begin) / parts;
      for (int i = 0; i < parts; ++i) add(disk, arc, arc.begin + i * length, arc.begin + (i + 1) * length, enclosed);
    }
    if (!(enclosed.area() > 0) || enclosed.is_flat()) return;
    Rgb weights;
    // At grazing views W grows without bound towards the rim, where there is hardly any area; a node may lie closer to it than all that is
    // enclosed, or beyond.
    const Vec2d middle = enclosed.middle();
    const double rim = 1 - 0.03 * std::max(1 - middle.x * middle.x - middle.y * middle.y, 1e-12);
    for (const Vec2d& node : enclosed.nodes()) weights = weights + disk.weight(node, rim);
    sum = sum + weights * (0.25 * enclosed.area() / pi);
  });
  // The lobe of a perfect mirror sums to 1 at most.
  const Rgb most{std::max(lobe.f0.x, lobe.f90), std::max(lobe.f0.y, lobe.f90), std::max(lobe.f0.z, lobe.f90)};
  return {std::min(sum.x, most.x), std::min(sum.y, most.y), std::min(sum.z, most.z)};
}

}  // namespace etendue::eval
