// Hill and Heitz, "Real-Time Area Lighting: a Journey from Research to Production" (2016): edge integrals of a polygon, clipped at the
// horizon, or not clipped and its vector form factor taken for that of a sphere.
#include "method_batch.h"
#include "views.h"

#include <vector>

namespace etendue::eval {
namespace {

// Each is theta / sin(theta) of the angle theta between unit vectors, which times their cross product is the edge's vector.
Vec3d edge_acos(const Vec3d& a, const Vec3d& b) { return shader_normalise(cross(a, b)) * std::acos(dot(a, b)); }
Vec3d edge_sine(const Vec3d& a, const Vec3d& b) {
  const double theta = std::acos(dot(a, b));
  return cross(a, b) / std::sin(theta) * theta;
}
// Both fits hold for 0 <= theta <= pi / 2; beyond, theta = pi - (the angle of -x).
Vec3d edge_fitted(const Vec3d& a, const Vec3d& b, double x, double fit) {
  return cross(a, b) * (x < 0 ? pi / std::sqrt(1 - x * x) - fit : fit);
}
Vec3d edge_rational(const Vec3d& a, const Vec3d& b) {
  const double x = dot(a, b), y = std::abs(x);
  return edge_fitted(a, b, x, (5.42031 + (3.12829 + 0.0902326 * y) * y) / (3.45068 + (4.18814 + y) * y));
}
Vec3d edge_quadratic(const Vec3d& a, const Vec3d& b) {
  const double x = dot(a, b), y = std::abs(x);
  return edge_fitted(a, b, x, 1.5708 + (-0.879406 + 0.308609 * y) * y);
}

// Twice the light's projected area on each plane: the vector form factor times 2 pi.
template <Vec3d (*edge)(const Vec3d&, const Vec3d&)>
Vec3d edge_sum(std::span<const Vec3d> polygon) {
  Vec3d sum;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += edge(shader_normalise(polygon[i]), shader_normalise(polygon[(i + 1) % polygon.size()]));
  return sum;
}
template <Vec3d (*edge)(const Vec3d&, const Vec3d&)>
double clipped_polygon(const RectView& rect, const Vec3d& n) {
  return std::max(0.5 * dot(edge_sum<edge>(clipped(rect.corners(), n).polygon()), n), 0.0);
}

// Form factor of a sphere with the sine squared s2 of its half angle at an elevation with the cosine z from the normal, clipped at the
// horizon (Snyder 1996): with c = cos(sigma), gamma = asin(c / sin(omega)), clamped as for a sphere that fills the sky.
double snyder(double z, double s2) {
  const double s = std::sqrt(s2);
  if (z >= s) return z * s2;
  if (z <= -s) return 0;
  const double c = std::sqrt(1 - s2), sin_omega = std::sqrt(1 - z * z);
  const double sin_gamma = std::min(c / sin_omega, 1.0), cos_gamma = std::sqrt(1 - sin_gamma * sin_gamma), gamma = std::asin(sin_gamma);
  const double g = -2 * sin_omega * c * cos_gamma + pi / 2 - gamma + sin_gamma * cos_gamma;
  const double h = z * (cos_gamma * std::sqrt(std::max(s2 - cos_gamma * cos_gamma, 0.0)) + s2 * std::asin(std::min(cos_gamma / s, 1.0)));
  return (z > 0 ? pi * z * s2 + g - h : g + h) / pi;
}

struct SphereProxy {
  double factor, z;  // form factor facing the light, cosine to its centre
};
SphereProxy proxy(const RectView& rect, const Vec3d& n) {
  const Vec3d f = edge_sum<edge_rational>(rect.corners()) / (2 * pi);
  const double l = length(f);
  if (!(l > 0)) return {0, 0};  // nor where an edge has no number
  return {std::min(l, 1.0), std::clamp(dot(f, n) / l, -1.0, 1.0)};
}

double sphere_exact(const RectView& rect, const Vec3d& n) {
  const SphereProxy p = proxy(rect, n);
  return pi * snyder(p.z, p.factor);
}

// 64 x 64 nodes in the cosine and the form factor, bilinear.
constexpr std::size_t nodes = ratio_nodes;
struct Table {
  std::vector<double> values = std::vector<double>(nodes * nodes);
  static double share(std::size_t i) { return static_cast<double>(i) / (nodes - 1); }
  template <class Value>
  explicit Table(Value value) {
    for (std::size_t j = 0; j < nodes; ++j) {
      for (std::size_t i = 0; i < nodes; ++i) values[j * nodes + i] = value(2 * share(i) - 1, share(j));
    }
  }
  double operator()(double z, double factor) const {
    const double x = (0.5 * z + 0.5) * (nodes - 1), y = factor * (nodes - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), nodes - 2), j = std::min(static_cast<std::size_t>(y), nodes - 2);
    const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
    const double* row = &values[j * nodes + i];
    return (row[0] * (1 - u) + row[1] * u) * (1 - v) + (row[nodes] * (1 - u) + row[nodes + 1] * u) * v;
  }
};
const Table& ratios() {
  static const Table table([](double z, double f) { return f > 0 ? snyder(z, f) / f : std::max(z, 0.0); });
  return table;
}
double sphere_ratio_table(const RectView& rect, const Vec3d& n) {
  const SphereProxy p = proxy(rect, n);
  return pi * p.factor * ratios()(p.z, p.factor);
}
double sphere_absolute_table(const RectView& rect, const Vec3d& n) {
  static const Table table(snyder);
  const SphereProxy p = proxy(rect, n);
  return pi * table(p.z, p.factor);
}
double sphere_cheap(const RectView& rect, const Vec3d& n) {
  const SphereProxy p = proxy(rect, n);
  return pi * std::max((p.factor * p.factor + p.factor * p.z) / (p.factor + 1), 0.0);
}

constexpr std::string_view talk = "Hill and Heitz 2016, edge integral";
constexpr std::string_view sphere = "Hill and Heitz 2016, sphere of the vector form factor";
constexpr DiffuseMethod methods[] = {
    {"hill-heitz-acos", talk,
     "Clipped polygon, acos: exact; loses (distance / size)^2 of the digits far away, no number where the cosine rounds above 1.",
     clipped_polygon<edge_acos>},
    {"hill-heitz-sine", talk, "Clipped polygon, theta / sin(theta): exact, the same losses.", clipped_polygon<edge_sine>},
    {"hill-heitz-rational", talk, "Clipped polygon, cubic rational fit of theta / sin(theta): 8e-5 off in 99 of 100 places.",
     clipped_polygon<edge_rational>},
    {"hill-heitz-quadratic", talk, "Clipped polygon, quadratic fit of theta / sin(theta): 1 % off above the horizon, 4 % across it.",
     clipped_polygon<edge_quadratic>},
    {"hill-heitz-snyder", sphere,
     "The horizon clips a sphere of the same vector form factor in closed form (Snyder 1996) instead of the polygon: as the rational fit "
     "where "
     "neither is clipped, 25 % off across the horizon.",
     sphere_exact},
    {"hill-heitz-ratio-table", sphere, "The same from a table of 64 x 64 ratios to the form factor.", sphere_ratio_table},
    {"hill-heitz-absolute-table", sphere, "The same from a table of 64 x 64 form factors, half as accurate above the horizon.",
     sphere_absolute_table},
    {"hill-heitz-cheap", sphere,
     "(l^2 + F.n) / (l + 1) of the vector form factor F with the length l: 2 % off above the horizon, 43 % across it.", sphere_cheap},
};

}  // namespace

std::span<const DiffuseMethod> hill_heitz_methods() { return methods; }

std::span<const float, ratio_nodes * ratio_nodes> sphere_ratios() {
  static const std::vector<float> single(ratios().values.begin(), ratios().values.end());
  return std::span<const float, nodes * nodes>(single);
}

}  // namespace etendue::eval
