// Lines: shape, above|across, 99th percentile and largest relative error of eval::illuminance in double against long double, mean relative
// error of LightBatch against eval::illuminance and its largest error over its bound.
// Argument: lights for each shape and side of the horizon (2000).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "etendue/illuminance_batch.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using protocol::Kind;
using Long = long double;
using Vec = Vec3<Long>;

Vec longer(const Vec3d& v) { return {v.x, v.y, v.z}; }
constexpr Long pi_l = 3.14159265358979323846264338327950288L;

// Twice Lambert's term of the edge from a to b.
Long edge(const Vec& a, const Vec& b, const Vec& n) {
  const Vec m = cross(a, b - a);
  const Long sine = std::sqrt(dot(m, m));
  return sine > 0 ? std::atan2(sine, dot(a, b)) * dot(m, n) / sine : 0;
}

Long of_polygon(const PolygonEmitter& e, const Vec& p, const Vec& n) {
  std::vector<Vec> above;
  const std::size_t count = e.vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec a = longer(e.vertices[i]) - p, b = longer(e.vertices[(i + 1) % count]) - p;
    const Long a_up = dot(a, n), b_up = dot(b, n);
    if (a_up >= 0) above.push_back(a);
    if ((a_up < 0) != (b_up < 0)) above.push_back(a + (b - a) * (a_up / (a_up - b_up)));
  }
  Long sum = 0;
  for (std::size_t i = 0; i < above.size(); ++i) sum -= edge(above[i], above[(i + 1) % above.size()], n);
  return sum / 2;
}

// Nusselt's for the cap, with the angles of the circle's part above and the horizon's below.
Long of_sphere(const SphereEmitter& e, const Vec& p, const Vec& n) {
  const Vec c = longer(e.centre) - p;
  const Long d = std::sqrt(dot(c, c)), s = e.radius / d, u = dot(c, n) / d, cosine = std::sqrt((1 - s) * (1 + s));
  if (u >= s) return pi_l * s * s * u;
  if (u <= -s) return 0;
  const Long q = std::sqrt((s - u) * (s + u));
  return std::atan2(q, -cosine * u) * s * s * u - cosine * q + std::atan2(q, cosine);
}

// Part of an outline: centre + u cos t + v sin t, u and v of one length across each other. A side that is straight has the point as its
// centre.
struct Arc {
  Vec centre, u, v;
  Long begin, end;
  Vec at(Long t) const { return centre + u * std::cos(t) + v * std::sin(t); }
};

// Lambert's contour integral along it by Gauss and Legendre's 5 places in each of so many parts that the error is below rounding.
Long along(const Arc& arc, const Vec& n) {
  const Long a = std::sqrt(5 - 2 * std::sqrt(10.0L / 7)) / 3, b = std::sqrt(5 + 2 * std::sqrt(10.0L / 7)) / 3;
  const Long wa = (322 + 13 * std::sqrt(70.0L)) / 900, wb = (322 - 13 * std::sqrt(70.0L)) / 900;
  const std::array<std::array<Long, 2>, 5> places{{{-b, wb}, {-a, wa}, {0, 128.0L / 225}, {a, wa}, {b, wb}}};
  const int parts = dot(arc.centre, arc.centre) > 0 ? 400 : 1;  // the integrand of a great circle is constant
  const Long h = (arc.end - arc.begin) / (2 * parts);
  Long sum = 0;
  for (int i = 0; i < parts; ++i) {
    for (const auto& [place, weight] : places) {
      const Long t = arc.begin + h * (2 * i + 1 + place);
      const Vec q = arc.at(t), onwards = arc.v * std::cos(t) - arc.u * std::sin(t);
      sum += weight * h * dot(cross(q, onwards), n) / dot(q, q);
    }
  }
  return sum;
}

// Around an outline: along what of its arcs is above the horizon, and straight from the end of each part to the beginning of the next,
// which is along the horizon where something was cut off, and nothing where not. n.(centre + u cos t + v sin t) is up + swing cos(t -
// middle).
Long around(const std::vector<Arc>& outline, const Vec& n) {
  std::vector<Arc> above;
  for (const Arc& arc : outline) {
    const Long x = dot(arc.u, n), y = dot(arc.v, n), up = dot(arc.centre, n), swing = std::hypot(x, y), middle = std::atan2(y, x);
    if (up <= -swing) continue;
    const Long half = up >= swing ? pi_l : std::acos(-up / swing);
    for (int turn = -2; turn <= 2; ++turn) {
      const Long from = middle + 2 * pi_l * turn - half, to = from + 2 * half;
      Arc part = arc;
      part.begin = std::max(arc.begin, from), part.end = std::min(arc.end, to);
      if (part.begin < part.end) above.push_back(part);
    }
  }
  Long sum = 0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    const Arc& next = above[(i + 1) % above.size()];
    sum += along(above[i], n) + edge(above[i].at(above[i].end), next.at(next.begin), n);
  }
  return sum / 2;
}

Vec unit(const Vec& v) { return v * (1 / std::sqrt(dot(v, v))); }

// Clockwise about its normal.
Long of_disk(const DiskEmitter& e, const Vec& p, const Vec& n) {
  const Vec facing = unit(longer(e.normal)), tangent = longer(basis_around(e.normal).tangent);
  const Vec x = unit(tangent - facing * dot(tangent, facing));
  return around({{longer(e.centre) - p, x * e.radius, cross(x, facing) * e.radius, 0, 2 * pi_l}}, n);
}

// The planes through the point that touch the side do so along lines at the middle of which the outward normal is m, m.e D = -R. Between
// their ends at a and b go the circles in which cones about the caps touch them, or halves of rims: the far one of a face that is seen,
// else the near one. Within the infinite cylinder the nearer end hides all else.
Long of_tube(const TubeEmitter& e, const Vec& p, const Vec& n) {
  const std::array<Vec, 2> ends{longer(e.a) - p, longer(e.b) - p};
  const Vec axis = unit(ends[1] - ends[0]), off = ends[0] - axis * dot(ends[0], axis);
  const Long r = e.radius, distance = std::sqrt(dot(off, off));
  if (distance <= r) {
    const bool first = dot(ends[0], axis) > 0;
    if (e.caps == Caps::round) return of_sphere({first ? e.a : e.b, e.radius}, p, n);
    return e.caps == Caps::flat ? of_disk({first ? e.a : e.b, normalised(first ? e.a - e.b : e.b - e.a), {}, e.radius}, p, n) : 0;
  }
  const Vec towards = off * (1 / distance), aside = cross(axis, towards);
  const Vec m = aside * (std::sqrt((distance - r) * (distance + r)) / distance) - towards * (r / distance);
  const auto cap = [&](std::size_t end) {
    const Vec centre = ends[end], outwards = end == 0 ? -axis : axis, touching = centre + m * r;
    Arc arc{centre, {}, {}, 0, 0};
    if (e.caps == Caps::round) {
      const Long sine2 = r * r / dot(centre, centre);
      const Vec direction = unit(centre), u = unit(outwards - direction * dot(outwards, direction));
      arc.centre = centre * (1 - sine2);
      arc.u = u * (r * std::sqrt(1 - sine2));
      arc.v = cross(direction, arc.u);
    } else {
      const bool far = e.caps == Caps::flat && dot(centre, outwards) < 0;
      arc.u = towards * (far ? r : -r);
      arc.v = far ? cross(arc.u, outwards) : cross(outwards, arc.u);
    }
    const Vec to = touching - arc.centre;
    arc.end = std::abs(std::atan2(dot(to, arc.v), dot(to, arc.u)));
    arc.begin = -arc.end;
    return arc;
  };
  const auto side = [](const Vec& from, const Vec& to) {
    const Vec u = unit(from), across = to - u * dot(u, to);
    return Arc{{}, u, unit(across), 0, std::atan2(std::sqrt(dot(across, across)), dot(u, to))};
  };
  const Arc a = cap(0), b = cap(1);
  return around({a, side(a.at(a.end), b.at(b.begin)), b, side(b.at(b.end), a.at(a.begin))}, n);
}

// At x along it from its foot, which is h away, the length dx of a line of the intensity 1 cd gives h n.r / (l |r|^4) dx. With n.r = up +
// slope x the integral of n.r / (h^2 + x^2)^2 is up (x / (h^2 + x^2) + arctan(x / h) / h) / (2 h^2) - slope / (2 (h^2 + x^2)).
Long of_line(const LineEmitter& e, const Vec& p, const Vec& n) {
  const Vec a = longer(e.a) - p, span = longer(e.b) - longer(e.a), axis = unit(span);
  const Long l = dot(span, axis), from = dot(a, axis);
  const Vec foot = a - axis * from;
  const Long h2 = dot(foot, foot), h = std::sqrt(h2), up = dot(n, foot), slope = dot(n, axis);
  Long low = from, high = from + l;
  if (slope > 0) low = std::max(low, -up / slope);
  if (slope < 0) high = std::min(high, -up / slope);
  if (low >= high) return 0;
  const auto until = [&](Long x) { return up * (x / (h2 + x * x) + std::atan(x / h) / h) / (2 * h2) - slope / (2 * (h2 + x * x)); };
  return h / l * (until(high) - until(low));
}

Long in_long_double(const EmitterShape& shape, const Vec& p, const Vec& n) {
  if (const auto* e = std::get_if<PolygonEmitter>(&shape)) return of_polygon(*e, p, n);
  if (const auto* e = std::get_if<SphereEmitter>(&shape)) return of_sphere(*e, p, n);
  if (const auto* e = std::get_if<DiskEmitter>(&shape)) return of_disk(*e, p, n);
  if (const auto* e = std::get_if<LineEmitter>(&shape)) return of_line(*e, p, n);
  return of_tube(std::get<TubeEmitter>(shape), p, n);
}

void measure(Kind kind, const char* name, bool above, int lights) {
  protocol::Random random(above ? 21 : 22);
  std::vector<double> errors;
  double sum = 0, over_bound = 0;
  for (int i = 0; i < lights; ++i) {
    const protocol::Placement p = protocol::place(kind, random, above);
    const double value = protocol::lux_at(p.emitter, p.position, p.normal);
    const Long exact = in_long_double(p.emitter.shape, longer(p.position), unit(longer(p.normal)));
    errors.push_back(static_cast<double>(std::abs((value - exact) / exact)));

    const std::array<float, 6> at{0, 0, 0, static_cast<float>(p.normal.x), static_cast<float>(p.normal.y), static_cast<float>(p.normal.z)};
    float sr = -1;
    const PointBatch point{{&at[0], 1}, {&at[1], 1}, {&at[2], 1}, {&at[3], 1}, {&at[4], 1}, {&at[5], 1}, p.position};
    if (!LightBatch::of(p.emitter)->projected_solid_angles(point, {&sr, 1}, -1)) std::abort();
    const double expected = protocol::lux_at(p.emitter, p.position, normalised(Vec3d{at[3], at[4], at[5]}));
    const double facing = protocol::lux_at(p.emitter, p.position, p.towards), error = std::abs(static_cast<double>(sr) - expected);
    sum += error / expected;
    over_bound = std::max(over_bound, error / (1e-5 * expected + 2e-6 * std::min(1.0, facing)));
  }
  std::sort(errors.begin(), errors.end());
  fmt::print("{} {} {:.2g} {:.2g} {:.2g} {:.2g}\n", name, above ? "above" : "across", errors[errors.size() * 99 / 100], errors.back(),
             sum / lights, over_bound);
}

}  // namespace

int main(int argc, char** argv) {
  const int lights = argc > 1 ? std::atoi(argv[1]) : 2000;
  for (const auto& [kind, name] : {std::pair(Kind::rect, "rect"), std::pair(Kind::star, "polygon"), std::pair(Kind::sphere, "sphere"),
                                   std::pair(Kind::disk, "disk"), std::pair(Kind::capsule, "tube"), std::pair(Kind::flat_tube, "flat-tube"),
                                   std::pair(Kind::open_tube, "open-tube"), std::pair(Kind::line, "line")})
    for (const bool above : {true, false}) measure(kind, name, above, lights);
}
