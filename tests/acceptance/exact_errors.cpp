// Lines: shape, above|across, 99th percentile and largest relative error of eval::illuminance in double against long double, mean relative
// error of LightBatch against eval::illuminance and its largest error over its bound; "-" where there is no form in long double here.
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

// Lambert's contour integral around the rim above the horizon by Gauss and Legendre's 5 places in each of 400 parts, and the chord.
Long of_disk(const DiskEmitter& e, const Vec& p, const Vec& n) {
  const Vec c = longer(e.centre) - p, facing = longer(e.normal);
  const Basis basis = basis_around(e.normal);
  Vec x = longer(basis.tangent);
  x = x - facing * dot(x, facing);
  x = x * (1 / std::sqrt(dot(x, x)));
  const Vec y = cross(facing, x);
  const Long r = e.radius, up = dot(c, n), swing = r * std::hypot(dot(x, n), dot(y, n)), middle = std::atan2(dot(y, n), dot(x, n));
  const Long half = up >= swing ? pi_l : up <= -swing ? 0 : std::acos(-up / swing);
  const auto at = [&](Long s) { return c + x * (r * std::cos(s)) + y * (r * std::sin(s)); };
  const Long a = std::sqrt(5 - 2 * std::sqrt(10.0L / 7)) / 3, b = std::sqrt(5 + 2 * std::sqrt(10.0L / 7)) / 3;
  const Long wa = (322 + 13 * std::sqrt(70.0L)) / 900, wb = (322 - 13 * std::sqrt(70.0L)) / 900;
  const std::array<std::array<Long, 2>, 5> places{{{-b, wb}, {-a, wa}, {0, 128.0L / 225}, {a, wa}, {b, wb}}};
  constexpr int parts = 400;
  const Long h = half / parts;
  Long sum = 0;
  for (int i = 0; i < parts; ++i) {
    for (const auto& [place, weight] : places) {
      const Long s = middle - half + h * (2 * i + 1 + place);
      const Vec q = at(s), along = y * (r * std::cos(s)) - x * (r * std::sin(s));
      sum -= weight * h * dot(cross(q, along), n) / dot(q, q);
    }
  }
  if (half > 0 && half < pi_l) sum -= edge(at(middle + half), at(middle - half), n);
  return sum / 2;
}

std::optional<Long> in_long_double(const EmitterShape& shape, const Vec& p, const Vec& n) {
  if (const auto* e = std::get_if<PolygonEmitter>(&shape)) return of_polygon(*e, p, n);
  if (const auto* e = std::get_if<SphereEmitter>(&shape)) return of_sphere(*e, p, n);
  if (const auto* e = std::get_if<DiskEmitter>(&shape)) return of_disk(*e, p, n);
  return {};
}

void measure(Kind kind, const char* name, bool above, int lights) {
  protocol::Random random(above ? 21 : 22);
  std::vector<double> errors;
  double sum = 0, over_bound = 0;
  for (int i = 0; i < lights; ++i) {
    const protocol::Placement p = protocol::place(kind, random, above);
    const double value = protocol::lux_at(p.emitter, p.position, p.normal);
    Vec n = longer(p.normal);
    n = n * (1 / std::sqrt(dot(n, n)));
    if (const auto exact = in_long_double(p.emitter.shape, longer(p.position), n))
      errors.push_back(static_cast<double>(std::abs((value - *exact) / *exact)));

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
  const std::string in_double = errors.empty() ? "- -" : fmt::format("{:.2g} {:.2g}", errors[errors.size() * 99 / 100], errors.back());
  fmt::print("{} {} {} {:.2g} {:.2g}\n", name, above ? "above" : "across", in_double, sum / lights, over_bound);
}

}  // namespace

int main(int argc, char** argv) {
  const int lights = argc > 1 ? std::atoi(argv[1]) : 2000;
  for (const auto& [kind, name] :
       {std::pair(Kind::rect, "rect"), std::pair(Kind::sphere, "sphere"), std::pair(Kind::disk, "disk"), std::pair(Kind::capsule, "tube")})
    for (const bool above : {true, false}) measure(kind, name, above, lights);
}
