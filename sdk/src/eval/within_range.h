// A flat light's outline, cut where its distance from the point is the range.
#pragma once

#include "contour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue::eval {

// A flat light in the plane at the height h from the point, lengths in units of the range. The range cuts a circle of the radius
// rho = sqrt(1 - h^2) out of the plane, about the foot of the point. Whatever of the outline lies beyond it is replaced by the arc of that
// circle that is seen from the foot through the same angle: what is enclosed then is the part within the range, signed, so that neither
// has to be convex. What is beyond has the outline's other parts, and those arcs backwards.
//
// Use: side(p, q) and rim(arc) within, side_beyond(p, q) and rim_beyond(arc), edge(arc) on that circle; an arc is Arc{foot, u, v, 0,
// angle}.
class FlatRange {
 public:
  // `towards`: unit, from the point to the plane, `height` < 1. `endless`: nothing is beyond.
  FlatRange(const Vec3d& towards, double height, bool endless = false)
      : towards_(towards),
        foot_(towards * height),
        height_(height),
        rho_(std::sqrt(std::max((1 - height) * (1 + height), 0.0))),
        limit_(endless ? std::numeric_limits<double>::infinity() : 1) {}

  const Vec3d& towards() const { return towards_; }
  const Vec3d& foot() const { return foot_; }
  double height() const { return height_; }
  double rho() const { return rho_; }
  // Nothing of what was cut is within.
  bool all_beyond() const { return !within_ && std::abs(turned_) < pi; }

  Vec3d on_plane(const Vec3d& direction) const { return direction * (height_ / std::max(dot(direction, towards_), 1e-30)); }
  double turn(const Vec3d& p, const Vec3d& q) const { return dot(towards_, cross(p, q)); }

  template <class Use>
  void cut(const Contour& seen, Use& use) {
    for (const Arc& arc : seen) {
      if (arc.great_circle()) {
        cut_side(on_plane(arc.at(arc.begin)), on_plane(arc.at(arc.end)), use);
      } else {
        cut_rim(arc, use);
      }
    }
  }

 private:
  // Up to two places within (begin, end), and both ends.
  struct Pieces {
    std::array<double, 4> ends;
    std::size_t count = 1;
    Pieces(double begin, double end) : ends{begin, end, end, end} {}
    void divide(std::array<double, 2> roots) {
      const double end = ends[1];
      if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
      for (const double t : roots)
        if (t > ends[0] && t < end) ends[count++] = t;
      ends[count] = end;
    }
  };

  template <class Use>
  void cut_side(const Vec3d& p, const Vec3d& q, Use& use) {
    // |p + t (q - p)| = 1
    const Vec3d along = q - p;
    const double a = dot(along, along), b = dot(p, along), c = dot(p, p) - limit_, root2 = b * b - a * c;
    Pieces pieces(0, 1);
    if (root2 > 0 && std::isfinite(c)) {
      const double k = b > 0 ? -b - std::sqrt(root2) : -b + std::sqrt(root2);
      pieces.divide({k / a, c / k});
    }
    for (std::size_t i = 0; i < pieces.count; ++i) {
      const Vec3d from = p + along * pieces.ends[i], to = i + 1 < pieces.count ? p + along * pieces.ends[i + 1] : q;
      const Vec3d middle = (from + to) * 0.5;
      if (dot(middle, middle) < limit_) {
        within_ = true;
        use.side(from, to);
      } else {
        use.side_beyond(from, to);
        const Vec3d e0 = from - foot_, e1 = to - foot_;
        add_edge(e0, std::atan2(turn(e0, e1), dot(e0, e1)), use);
      }
    }
  }

  // |C + u cos s + v sin s|^2 = m + rho cos(s - phase)
  template <class Use>
  void cut_rim(const Arc& arc, Use& use) {
    const double in_u = dot(arc.centre, arc.u), in_v = dot(arc.centre, arc.v), rho = 2 * std::hypot(in_u, in_v);
    const double m = dot(arc.centre, arc.centre) + dot(arc.u, arc.u), phase = std::atan2(in_v, in_u);
    Pieces pieces(arc.begin, arc.end);
    if (std::abs(limit_ - m) < rho) {
      const double half = std::acos((limit_ - m) / rho);
      const auto root = [&](double s) { return s + 2 * pi * std::ceil((arc.begin - s) / (2 * pi)); };
      pieces.divide({root(phase - half), root(phase + half)});
    }
    for (std::size_t i = 0; i < pieces.count; ++i) {
      Arc part = arc;
      part.begin = pieces.ends[i];
      part.end = pieces.ends[i + 1];
      const Vec3d middle = part.at(0.5 * (part.begin + part.end));
      if (dot(middle, middle) < limit_) {
        within_ = true;
        use.rim(part);
      } else {
        use.rim_beyond(part);
        add_edge(part.at(part.begin) - foot_, seen_from_foot(part), use);
      }
    }
  }

  // The angle that a part of a circle about c is seen under. As complex numbers in the plane: c + R e = e (R + c / e), of which the second
  // factor, where c < R, has a positive real part and no jump in its argument; else c (1 + R e / c).
  double seen_from_foot(const Arc& part) const {
    const Vec3d c = part.centre - foot_;
    const bool around = dot(c, c) < dot(part.u, part.u);
    const auto argument = [&](double s) {
      const Vec3d e = part.u * std::cos(s) + part.v * std::sin(s);
      return around ? s + std::atan2(turn(e, c), dot(e, e) + dot(e, c)) : std::atan2(turn(c, e), dot(c, c) + dot(c, e));
    };
    return argument(part.end) - argument(part.begin);
  }

  template <class Use>
  void add_edge(const Vec3d& from, double turned, Use& use) {
    const double size = length(from);
    if (!(size > 0) || turned == 0) return;
    turned_ += turned;
    const Vec3d u = from * (rho_ / size);
    use.edge(Arc{foot_, u, cross(towards_, u), 0, turned, false});
  }

  Vec3d towards_, foot_;
  double height_, rho_, limit_;
  double turned_ = 0;
  bool within_ = false;
};

}  // namespace etendue::eval
