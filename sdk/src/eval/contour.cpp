#include "contour.h"

#include "quadrature.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

std::optional<Arc> great_circle(const Vec3d& p, const Vec3d& q) {
  // The difference keeps the digits of two nearly parallel vectors; their cross product would not.
  const Vec3d normal = cross(p, q - p);
  const double sine = length(normal), p_length = length(p);
  if (!(sine > 0) || !(p_length > 0)) return std::nullopt;
  const Vec3d u = p / p_length;
  return Arc{{}, u, cross(normal / sine, u), 0, std::atan2(sine, dot(p, q)), true};
}

Arc horizon_circle(const Vec3d& n) {
  const Basis b = basis_around(n);
  return {{}, b.tangent, b.bitangent, 0, 2 * pi, true};
}

Arc cap_circle(const Vec3d& axis, double cosine, double sine) {
  const Basis b = basis_around(axis);
  return {axis * cosine, b.tangent * sine, b.bitangent * sine, 0, 2 * pi, true};
}

// a cos s + b sin s + c = 0 at s = phase +- acos(-c / r), r = |(a, b)|.
Crossings crossings(const Arc& arc, const Vec3d& n) {
  const double a = dot(n, arc.u), b = dot(n, arc.v), c = dot(n, arc.centre), r = std::hypot(a, b);
  Crossings zeros;
  if (!(r > std::abs(c))) return zeros;
  const double phase = std::atan2(b, a), half = std::acos(std::clamp(-c / r, -1.0, 1.0));
  for (const double root : {phase - half, phase + half}) {
    const double s = root + 2 * pi * std::ceil((arc.begin - root) / (2 * pi));
    if (s > arc.begin && s < arc.end) zeros.s[zeros.count++] = s;
  }
  if (zeros.count == 2 && zeros.s[0] > zeros.s[1]) std::swap(zeros.s[0], zeros.s[1]);
  return zeros;
}

namespace {

double chord2(const Arc& arc, const Vec3d& c, double s) {
  const Vec3d d = normalised(arc.at(s)) - c;
  return dot(d, d);
}

}  // namespace

// Sine and cosine are turned from step to step.
std::vector<double> squared_chords(const Arc& arc, const Vec3d& c, int count) {
  const double step = (arc.end - arc.begin) / count, turn_c = std::cos(step), turn_s = std::sin(step);
  double cs = std::cos(arc.begin), sn = std::sin(arc.begin);
  std::vector<double> chords(static_cast<std::size_t>(count) + 1);
  for (double& chord : chords) {
    const Vec3d d = normalised(arc.centre + arc.u * cs + arc.v * sn) - c;
    chord = dot(d, d);
    const double next = cs * turn_c - sn * turn_s;
    sn = sn * turn_c + cs * turn_s;
    cs = next;
  }
  return chords;
}

// On circles with |b| = 1 the closest point is where u cos s + v sin s points along c; elsewhere a search: samples, then thirds.
Nearest nearest_to(const Arc& arc, const Vec3d& c) {
  double s = 0;
  if (arc.unit) {
    s = std::atan2(dot(arc.v, c), dot(arc.u, c));
    s += 2 * pi * std::ceil((arc.begin - s) / (2 * pi));
    if (s > arc.end) s = chord2(arc, c, arc.begin) < chord2(arc, c, arc.end) ? arc.begin : arc.end;
  } else {
    constexpr int samples = 16;
    const double step = (arc.end - arc.begin) / samples;
    const std::vector<double> chords = squared_chords(arc, c, samples);
    s = arc.begin + step * static_cast<double>(std::min_element(chords.begin(), chords.end()) - chords.begin());
    double lo = std::max(arc.begin, s - step), hi = std::min(arc.end, s + step);
    for (int i = 0; i < 12; ++i) {
      const double third = (hi - lo) / 3;
      if (chord2(arc, c, lo + third) < chord2(arc, c, hi - third)) {
        hi -= third;
      } else {
        lo += third;
      }
    }
    s = 0.5 * (lo + hi);
  }
  const Vec3d b = arc.at(s), tangent = arc.v * std::cos(s) - arc.u * std::sin(s);
  return {s, std::sqrt(chord2(arc, c, s)), length(cross(b, tangent)) / dot(b, b)};
}

namespace {

// From the direction of `from` along the horizon of n to that of `to`, counter-clockwise about n. An outline that is narrower than half a
// turn may also run backwards there (a light that is not convex): the sign of the angle tells. Half a turn is always forwards.
void add_horizon(Contour& out, const Vec3d& from, const Vec3d& to, const Vec3d& n) {
  const Vec3d u = normalised(from - n * dot(from, n));
  const Vec3d v = cross(n, u);
  double angle = std::atan2(dot(to, v), dot(to, u));
  if (angle < -3) angle += 2 * pi;
  if (angle > 0) out.push_back({{}, u, v, 0, angle, true});
  if (angle < 0) out.push_back({{}, u, -v, 0, -angle, true});
}

}  // namespace

Contour clipped(const Contour& outline, const Vec3d& n) {
  Contour out;
  out.reserve(outline.size() + 2);
  bool cut = false;                  // something was left out since the last arc that was kept
  bool cut_first = false;            // ... before the first one
  std::optional<Vec3d> first, last;  // ends of what was kept
  for (const Arc& arc : outline) {
    const Crossings zeros = crossings(arc, n);
    double begin = arc.begin;
    for (std::size_t i = 0; i <= zeros.count; ++i) {
      const double end = i < zeros.count ? zeros.s[i] : arc.end;
      // Of one sign between crossings, but for a point that touches the plane: that may be any one of the three.
      if (dot(n, arc.at(begin) + arc.at(0.5 * (begin + end)) + arc.at(end)) >= 0) {
        Arc part = arc;
        part.begin = begin;
        part.end = end;
        const Vec3d head = part.at(begin);
        if (!first) {
          first = head;
          cut_first = cut;
        } else if (cut) {
          add_horizon(out, *last, head, n);
        }
        cut = false;
        last = part.at(end);
        out.push_back(part);
      } else {
        cut = true;
      }
      begin = end;
    }
  }
  if (first && (cut || cut_first)) add_horizon(out, *last, *first, n);
  return out;
}

namespace {

// Half the integral of b x b' / |b|^2 along a circle in space. With b = C + u cos s + v sin s, |u| = |v| = R, u.v = 0:
//   b x b' = C x v cos s - C x u sin s + u x v,   |b|^2 = m + rho cos(s - phase),  m = |C|^2 + R^2,  rho = 2 R |C in the plane|.
// After turning s by the phase the numerator is p + q cos s + r sin s, and
//   I = q s / rho + (p - q m / rho) J - r ln(m + rho cos s) / rho,   J = 2 / w atan(sqrt((m - rho) / (m + rho)) tan(s / 2)),
// w = sqrt(m^2 - rho^2). m - rho and m + rho are squared distances to the nearest and the farthest point of the rim and are formed as
// such. Where rho is small against m the terms cancel; there 24 Gauss points are exact to rounding: the integrand's poles are at the height
// arcosh(m / rho) over the arc, seen from the middle of an arc of the half length H at z = height / H or more, and the rule's error falls
// like (z + sqrt(z^2 + 1))^-48, which is 1e-16 at z = .85.
Vec3d rim_integral(const Arc& arc) {
  const double radius = length(arc.u);
  const Vec3d axis = cross(arc.u, arc.v) / (radius * radius);
  const double cu = dot(arc.centre, arc.u) / radius, cv = dot(arc.centre, arc.v) / radius, h = dot(arc.centre, axis);
  const double in_plane = std::hypot(cu, cv);
  const double near2 = (in_plane - radius) * (in_plane - radius) + h * h, far2 = (in_plane + radius) * (in_plane + radius) + h * h;
  const double m = in_plane * in_plane + radius * radius + h * h, rho = 2 * radius * in_plane;
  if (!(near2 > 0)) return {};
  const double half = 0.5 * (arc.end - arc.begin);
  if (std::acosh(std::max(m / rho, 1.0)) > 0.85 * half) {
    Vec3d sum;
    const double middle = 0.5 * (arc.end + arc.begin);
    for (const GaussNode& node : gauss24()) {
      const double s = middle + half * node.x, cs = std::cos(s), sn = std::sin(s);
      const Vec3d b = arc.centre + arc.u * cs + arc.v * sn;
      sum += cross(b, arc.v * cs - arc.u * sn) * (node.weight / dot(b, b));
    }
    return sum * (0.5 * half);
  }
  const double phase = std::atan2(cv, cu);
  const Vec3d turned_u = arc.u * std::cos(phase) + arc.v * std::sin(phase), turned_v = arc.v * std::cos(phase) - arc.u * std::sin(phase);
  const Vec3d p = cross(arc.u, arc.v), q = cross(arc.centre, turned_v), r = -cross(arc.centre, turned_u);
  const double w = std::sqrt(near2 * far2), k = std::sqrt(near2 / far2);
  const auto angle_of = [&](double s) {
    const double turns = std::floor((s + pi) / (2 * pi));
    const double within = s - 2 * pi * turns;  // -pi .. pi
    return std::atan2(k * std::sin(0.5 * within), std::cos(0.5 * within)) + pi * turns;
  };
  const double s0 = arc.begin - phase, s1 = arc.end - phase;
  const double big_j = 2 / w * (angle_of(s1) - angle_of(s0));
  // Rounding must not leave what the rim's distances can be.
  const auto distance2 = [&](double s) { return std::clamp(m + rho * std::cos(s), near2, far2); };
  const double logs = std::log(distance2(s1) / distance2(s0));
  return (q * ((s1 - s0) / rho) + (p - q * (m / rho)) * big_j - r * (logs / rho)) * 0.5;
}

}  // namespace

Vec3d direction_integral(const Arc& arc) {
  const double b = arc.begin, e = arc.end;
  if (arc.great_circle()) return cross(arc.u, arc.v) * (0.5 * (e - b));
  if (!arc.unit) return rim_integral(arc);
  // |b| = 1: b x b' = centre x (v cos s - u sin s) + u x v.
  return (cross(arc.centre, arc.v * (std::sin(e) - std::sin(b)) + arc.u * (std::cos(e) - std::cos(b))) + cross(arc.u, arc.v) * (e - b)) *
         0.5;
}

Vec3d direction_integral(const Contour& contour) {
  Vec3d sum;
  for (const Arc& arc : contour) sum += direction_integral(arc);
  return sum;
}

}  // namespace etendue::eval
