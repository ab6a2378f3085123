// Flat lights and lines.
#include "window_part.h"

#include "line.h"
#include "quadrature.h"
#include "sector_rule.h"
#include "smooth_integral.h"
#include "within_range.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// With Lambert's formula over what is beyond (within_range.h), and over what is within
//     integral of n.y h (1 - w) / |y|^4 dA,
// a polynomial of the degree 5 in the plane: from a point z of it, y = z + t (s - z) with s on the outline, dA = t (s - z) x ds dt. Gauss's
// three nodes for the weight t are exact, and Gauss and Legendre's three along a side.
class FlatLoss {
 public:
  FlatLoss(const FlatRange& range, const Taken& taken) : range_(range), taken_(taken) {}

  WindowPart of(const Contour& seen) {
    if (seen.empty()) return {0, false, true};
    const Vec3d start = range_.on_plane(seen[0].at(seen[0].begin));
    base_ = dot(start, start) < 1 ? start : range_.foot();
    range_.cut(seen, *this);
    if (range_.all_beyond()) return {0, false, true};
    return {beyond_ + range_.height() * moment_, false, false};
  }

  void side(const Vec3d& from, const Vec3d& to) {
    const Vec3d middle = (from + to) * 0.5;
    double sum = 0;
    for (const GaussNode& node : gauss3) sum += 0.5 * node.weight * fan_row(middle + (to - from) * (0.5 * node.x));
    moment_ += range_.turn(from - base_, to - from) * sum;
  }
  void side_beyond(const Vec3d& from, const Vec3d& to) {
    if (const auto arc = great_circle(from, to)) beyond_ += direction_integral(*arc).z;
  }
  // A polynomial of the degree 7 in the sine and cosine.
  void rim(const Arc& arc) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(arc.end - arc.begin) / (pi / 2) - 1e-9)));
    const double half = 0.5 * (arc.end - arc.begin) / pieces;
    for (int i = 0; i < pieces; ++i) {
      for (const KronrodNode& node : kronrod15().nodes) {
        const double s = arc.begin + half * (2 * i + 1 + node.x), cs = std::cos(s), sn = std::sin(s);
        const Vec3d y = arc.centre + arc.u * cs + arc.v * sn;
        moment_ += half * node.weight * range_.turn(y - base_, arc.v * cs - arc.u * sn) * fan_row(y);
      }
    }
  }
  void rim_beyond(const Arc& arc) { beyond_ += direction_integral(arc).z; }
  // Half the integral of b x db, b = foot + rho e:  (foot x rho (e1 - e0) + rho^2 towards turned) / 2.
  void edge(const Arc& arc) {
    const Vec3d moved = arc.at(arc.end) - arc.at(0);
    beyond_ -= 0.5 * (cross(range_.foot(), moved).z + range_.rho() * range_.rho() * arc.end * range_.towards().z);
    rim(arc);
  }

 private:
  double fan_row(const Vec3d& s) const {
    double sum = 0;
    for (const SectorNode& node : nodes_across(3)) {
      const Vec3d y = base_ + (s - base_) * node.x;
      sum += node.weight * y.z * taken_.per_fourth(dot(y, y));
    }
    return sum;
  }

  FlatRange range_;
  Taken taken_;
  Vec3d base_;
  double beyond_ = 0, moment_ = 0;
};

// What is left: h times the integral of n.y w / q^2, q = |y|^2, n.y = n.f + n.rho with the foot f and rho in the plane. A function of
// |rho| alone is the divergence of one along rho, and times rho it is a gradient, so that both parts are integrals along the outline: with
//     P = half the integral of w / q^2 from h^2 on,   N the plane's normal,
//     integral of w / q^2 dA  =  of P / rho^2 N.(rho x d rho),     of w / q^2 rho dA  =  of P d rho x N,
// where P may have any constant in the second; less its value at the end it is small there and no larger for small heights. Along the range
// it has one value. Its only poles are at q = 0, as far from a side as the point is (smooth_integral.h).
class FlatRest {
 public:
  FlatRest(const FlatRange& range, const Kept& kept) : range_(range), kept_(kept), h2_(range.height() * range.height()) {}

  WindowPart of(const Contour& seen) {
    range_.cut(seen, *this);
    if (seen.empty() || range_.all_beyond()) return {0, true, true};
    return {range_.height() * (range_.foot().z * around_ + across_), true, false};
  }

  void side(const Vec3d& from, const Vec3d& to) {
    const Vec3d off = from - range_.foot(), moved = to - from;
    const double length_of = length(moved);
    if (!(length_of > 0)) return;
    const Vec3d along = moved / length_of;
    const double begin = dot(off, along), aside2 = std::max(dot(off, off) - begin * begin, 0.0), turn = range_.turn(off, along);
    const double out = cross(along, range_.towards()).z, near = std::sqrt(h2_ + aside2);
    if (kept_.linear()) {
      linear_side(begin, begin + length_of, turn, near, out);
      return;
    }
    smooth_integral(begin, begin + length_of, 0, near, kept_.steepest(), [&](double s, double weight) {
      const double rho2 = aside2 + s * s;
      around_ += weight * turn * kept_.spread(h2_, rho2);
      across_ -= weight * out * kept_.beyond(h2_ + rho2);
    });
  }
  // |y|^2 = m + rho cos(s - phase) is 0 at s = phase + pi +- i acosh(m / rho).
  void rim(const Arc& arc) {
    const double in_u = dot(arc.centre, arc.u), in_v = dot(arc.centre, arc.v), rho = 2 * std::hypot(in_u, in_v);
    const double m = dot(arc.centre, arc.centre) + dot(arc.u, arc.u), nearest = std::atan2(-in_v, -in_u);
    const double width = rho > 0 ? std::acosh(std::max(m / rho, 1 + 1e-15)) : 10;
    const double first = nearest + 2 * pi * std::floor((arc.begin - nearest + pi) / (2 * pi));
    for (double peak = first; peak - pi < arc.end; peak += 2 * pi) {
      const double begin = std::max(arc.begin, peak - pi), end = std::min(arc.end, peak + pi);
      if (!(begin < end)) continue;
      smooth_integral(begin, end, peak, width, kept_.steepest(), [&](double s, double weight) {
        const double cs = std::cos(s), sn = std::sin(s);
        const Vec3d off = arc.centre + arc.u * cs + arc.v * sn - range_.foot(), moved = arc.v * cs - arc.u * sn;
        const double rho2 = dot(off, off);
        around_ += weight * range_.turn(off, moved) * kept_.spread(h2_, rho2);
        across_ -= weight * cross(moved, range_.towards()).z * kept_.beyond(h2_ + rho2);
      });
    }
  }
  void edge(const Arc& arc) { around_ += range_.rho() * range_.rho() * arc.end * kept_.spread(h2_, range_.rho() * range_.rho()); }
  void side_beyond(const Vec3d&, const Vec3d&) {}
  void rim_beyond(const Arc&) {}

 private:
  // w = 1 - d: with p the foot's distance from the side's line and c^2 = h^2 + p^2
  //     integral of p P / rho^2 ds = p / (2 h^2 c) atan(s / c) - (atan(s / p) - atan(h s / (p d))) / h,
  //     integral of (1 / q - 1) / 2 - (1 / d - 1) ds = atan(s / c) / (2 c) - asinh(s / c) + s / 2.
  void linear_side(double s0, double s1, double p, double c, double out) {
    const double h = range_.height(), turned = std::atan2(c * (s1 - s0), c * c + s0 * s1) / (2 * c);
    const auto from_foot = [&](double s) {
      const double rho2 = p * p + s * s, d = std::sqrt(h2_ + rho2);
      return std::atan2(s * p * rho2 / (d + h), p * p * d + s * s * h);
    };
    around_ += p / h2_ * turned - (from_foot(s1) - from_foot(s0)) / h;
    across_ -= out * (turned - (std::asinh(s1 / c) - std::asinh(s0 / c)) + 0.5 * (s1 - s0));
  }

  FlatRange range_;
  const Kept& kept_;
  double h2_;
  double around_ = 0, across_ = 0;
};

}  // namespace

WindowPart flat_part(const Contour& seen, const Vec3d& on_light, const Vec3d& normal, const Taken& taken) {
  const double height = std::abs(dot(on_light, normal));
  if (!(height < 1)) return {0, false, true};
  return FlatLoss(FlatRange(dot(on_light, normal) < 0 ? -normal : normal, height), taken).of(seen);
}
// Nearer than 1e-120 squares leave the range of double.
WindowPart flat_part(const Contour& seen, const Vec3d& on_light, const Vec3d& normal, const Kept& kept) {
  const double height = std::max(std::abs(dot(on_light, normal)), 1e-120);
  if (!(height < kept.end())) return {0, true, true};
  return FlatRest(FlatRange(dot(on_light, normal) < 0 ? -normal : normal, height, kept.end() > 1), kept).of(seen);
}

// An element dx of a line gives I / l h n.y / |y|^4 dx: beyond the range its own integral, within it polynomials of the degree 5.
WindowPart line_part(const LineView& view, const Taken& taken) {
  const double range = taken.unit_m;
  const double height = view.height / range, l = 1 / (view.scale * view.height * range);
  if (!(height < 1)) return {0, false, true};
  const double reach = std::acos(height), begin = std::max(view.begin, -reach), end = std::min(view.end, reach);
  if (!(begin < end)) return {0, false, true};
  double loss = 0;
  for (const auto& [from, to] : {std::pair{view.begin, begin}, {end, view.end}}) {
    LineView part = view;
    part.begin = from;
    part.end = to;
    if (from < to) loss += direction_integral(part).z;
  }
  const double x0 = height * std::tan(begin), x1 = height * std::tan(end);
  for (const GaussNode& node : gauss3) {
    const double x = 0.5 * (x0 + x1) + 0.5 * (x1 - x0) * node.x;
    loss += 0.5 * (x1 - x0) * node.weight * height * (view.foot.z * height + view.axis.z * x) * taken.per_fourth(height * height + x * x) /
            (l * range * range);
  }
  return {loss, false, false};
}

WindowPart line_part(const LineView& view, const Kept& kept) {
  const double unit = kept.unit_m, height = view.height / unit, l = 1 / (view.scale * view.height * unit);
  if (!(height < kept.end())) return {0, true, true};
  const double reach = kept.end() > 1 ? pi : std::acos(height), begin = std::max(view.begin, -reach), end = std::min(view.end, reach);
  if (!(begin < end)) return {0, true, true};
  double left = 0;
  smooth_integral(height * std::tan(begin), height * std::tan(end), 0, height, kept.steepest(), [&](double x, double weight) {
    const double d2 = height * height + x * x;
    left += weight * (view.foot.z * height + view.axis.z * x) * kept.at(d2) / (d2 * d2);
  });
  return {left * height / (l * unit * unit), true, false};
}

}  // namespace etendue::eval
