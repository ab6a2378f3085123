#include "transformed_contour.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue::eval {
namespace {

// Eigenvalues, ascending, and eigenvectors of the symmetric matrix with the given columns: Jacobi's rotations (1846), which leave small
// eigenvalues their digits better than a characteristic polynomial does.
struct Axes {
  std::array<double, 3> value;
  std::array<Vec3d, 3> vector;
};
Axes axes_of(std::array<Vec3d, 3> m) {
  std::array<Vec3d, 3> vectors{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  for (int round = 0; round < 30; ++round) {
    bool done = true;
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      const double off = m[p][q];
      if (!(std::abs(off) > 1e-18 * std::sqrt(std::abs(m[p][p] * m[q][q])))) continue;
      done = false;
      const double ratio = (m[q][q] - m[p][p]) / (2 * off);
      const double t = (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::hypot(ratio, 1.0)), c = 1 / std::hypot(t, 1.0), s = t * c;
      for (int k = 0; k < 3; ++k) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
      }
      for (int k = 0; k < 3; ++k) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
      }
      m[p][q] = m[q][p] = 0;
      const Vec3d a = vectors[p], b = vectors[q];
      vectors[p] = a * c - b * s, vectors[q] = a * s + b * c;
    }
    if (done) break;
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] < m[b][b]; });
  Axes axes;
  for (int i = 0; i < 3; ++i) axes.value[i] = m[order[i]][order[i]], axes.vector[i] = vectors[order[i]];
  return axes;
}

// The normal of a plane that cuts the cone { B (t cos s, t sin s, t) } in a circle, on the side of B's third column; B's columns are the
// ellipse's half axes and its centre. Rows r of B^-1 are the cross products of the columns over the determinant; on the cone
// (r0.x)^2 + (r1.x)^2 = (r2.x)^2. Of that quadratic form with the eigenvalues a < 0 < b <= c, planes perpendicular to
// sqrt(c - b) e_c +- sqrt(b - a) e_a have circular sections: with c - b taken from the form, the rest is a multiple of |x|^2 there.
Vec3d circular_section(const Vec3d& u, const Vec3d& v, const Vec3d& centre) {
  // Scaled so that each row is about as long as the others and the determinant cancels.
  const std::array<Vec3d, 3> row{cross(v, centre), cross(centre, u), cross(u, v)};
  const double scale = 1 / std::max({length(row[0]), length(row[1]), length(row[2])});
  std::array<Vec3d, 3> form;
  for (int i = 0; i < 3; ++i) form[i] = (row[0] * row[0][i] + row[1] * row[1][i] - row[2] * row[2][i]) * (scale * scale);
  const Axes axes = axes_of(form);
  const double a = axes.value[0], b = axes.value[1], c = axes.value[2];
  const Vec3d axis = axes.vector[0] * (dot(axes.vector[0], centre) < 0 ? -1 : 1);
  return normalised(axes.vector[2] * std::sqrt(std::max(c - b, 0.0)) + axis * std::sqrt(std::max(b - a, 0.0)));
}

// The circle through three points.
struct Circle {
  Vec3d centre, axis;
  double radius;
};
Circle circle_through(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
  const Vec3d a = q - p, b = r - p, n = cross(a, b);
  const double n2 = dot(n, n);
  const Vec3d to_centre = (cross(n, a) * dot(b, b) + cross(b, n) * dot(a, a)) / (2 * n2);
  return {p + to_centre, n / std::sqrt(n2), length(to_centre)};
}

void add_rim(Contour& out, const Arc& arc, const Transform& linear) {
  Arc ellipse{linear.vector(arc.centre), linear.vector(arc.u), linear.vector(arc.v), arc.begin, arc.end, false};
  const Vec3d normal = circular_section(ellipse.u, ellipse.v, ellipse.centre);
  const auto in_plane = [&](double s) {
    const Vec3d b = ellipse.at(s);
    return b / dot(b, normal);
  };
  const Vec3d start = in_plane(arc.begin), end = in_plane(arc.end);
  const Circle circle = circle_through(in_plane(arc.begin), in_plane(arc.begin + 2 * pi / 3), in_plane(arc.begin + 4 * pi / 3));
  if (!std::isfinite(circle.radius) || !(circle.radius > 0)) return;
  // Turning in the ellipse's own sense, which the order of the three points has.
  const Vec3d u = normalised(start - circle.centre) * circle.radius, v = cross(circle.axis, u);
  double turn = 2 * pi;
  if (arc.end - arc.begin < 2 * pi * (1 - 1e-15)) {
    const Vec3d out_to = end - circle.centre;
    turn = std::atan2(dot(out_to, v), dot(out_to, u));
    // Of less than half a turn that rounds to nothing nothing is left; what lies behind is beyond half a turn.
    if (turn < 0) turn = turn > -1e-9 && arc.end - arc.begin < pi ? 0 : turn + 2 * pi;
  }
  out.push_back({circle.centre, u, v, 0, turn, false});
}

}  // namespace

Contour transformed(const Contour& contour, const Transform& linear) {
  Contour out;
  out.reserve(contour.size() + 2);
  for (const Arc& arc : contour) {
    if (!arc.great_circle()) {
      add_rim(out, arc, linear);
      continue;
    }
    // In parts of less than half a turn, which stay such.
    const int parts = 1 + static_cast<int>((arc.end - arc.begin) / 2.5);
    for (int i = 0; i < parts; ++i) {
      const double from = arc.begin + (arc.end - arc.begin) * i / parts, to = arc.begin + (arc.end - arc.begin) * (i + 1) / parts;
      if (const auto part = great_circle(linear.vector(arc.at(from)), linear.vector(arc.at(to)))) out.push_back(*part);
    }
  }
  return out;
}

}  // namespace etendue::eval
