// Hill and Heitz, "Real-Time Area Lighting: a Journey from Research to Production" (2016): edge integrals of a polygon, clipped at the
// horizon, or not clipped and its vector form factor taken for that of a sphere; both for linearly transformed cosines as well. Heitz and
// Hill, "Linear-Light Shading with Linearly Transformed Cosines" (GPU Zen 2017): tubes as lines.
#include "hill_heitz.h"

#include "method_batch.h"
#include "specular_view.h"
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
SphereProxy proxy(const std::array<Vec3d, 4>& corners, const Vec3d& n) {
  const Vec3d f = edge_sum<edge_rational>(corners) / (2 * pi);
  const double l = length(f);
  if (!(l > 0)) return {0, 0};  // nor where an edge has no number
  return {std::min(l, 1.0), std::clamp(dot(f, n) / l, -1.0, 1.0)};
}

double sphere_exact(const RectView& rect, const Vec3d& n) {
  const SphereProxy p = proxy(rect.corners(), n);
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
  const SphereProxy p = proxy(rect.corners(), n);
  return pi * p.factor * ratios()(p.z, p.factor);
}
double sphere_absolute_table(const RectView& rect, const Vec3d& n) {
  static const Table table(snyder);
  const SphereProxy p = proxy(rect.corners(), n);
  return pi * table(p.z, p.factor);
}
double sphere_cheap(const RectView& rect, const Vec3d& n) {
  const SphereProxy p = proxy(rect.corners(), n);
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

// ---- Specular ----

// Nodes of the four-term table, as the terms (0, 0), (0, 2), (1, 1), (2, 0) of the matrix divided by (2, 2).
class FourTerms {
 public:
  FourTerms() : nodes_(std::size_t{size} * size) {
    for (std::size_t row = 0; row < size; ++row) {
      for (std::size_t column = 0; column < size; ++column) {
        const double root = Table::share(row), angle = 0.5 * pi * Table::share(column);
        const auto& m = ltc_table().at(root * root, std::cos(angle)).whole.inverse.columns;
        nodes_[row * size + column] = {m[0].x / m[2].z, m[2].x / m[2].z, m[1].y / m[2].z, m[0].z / m[2].z};
      }
    }
  }
  TransformedCosine at(double alpha, double cosine) const {
    const double x = std::acos(cosine) / (0.5 * pi) * (size - 1), y = std::sqrt(alpha) * (size - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), size - 2), j = std::min(static_cast<std::size_t>(y), size - 2);
    const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
    const auto term = [&](std::size_t k) {
      const auto* row = &nodes_[j * size + i];
      return (row[0][k] * (1 - u) + row[1][k] * u) * (1 - v) + (row[size][k] * (1 - u) + row[size + 1][k] * u) * v;
    };
    TransformedCosine result;
    result.inverse.columns = {Vec3d{term(0), 0, term(3)}, Vec3d{0, term(2), 0}, Vec3d{term(1), 0, 1}};
    return result;
  }

 private:
  static constexpr std::size_t size = 64;
  std::vector<std::array<double, 4>> nodes_;
};

// A lobe as a cosine, and the albedo that its share of the light multiplies.
struct CosineLobe {
  explicit CosineLobe(const LobeView& lobe) : frame(lobe.normal, lobe.view), fit(ltc_table().at(lobe.alpha(), frame.cosine)) {
    albedo = lobe.lobe.f0 * fit.f0.albedo + Rgb{1, 1, 1} * (lobe.lobe.f90 * fit.f90.albedo);
  }
  // Of a world vector.
  Vec3d seen(const Vec3d& v) const { return fit.whole.inverse.vector(frame.vector(v)); }
  Rgb lit(double share) const { return albedo * std::clamp(share, 0.0, 1.0); }
  ViewFrame frame;
  LtcLobe fit;
  Rgb albedo;
};

// A polygon that nothing clips, as the cosine sees it; the horizon cuts the sphere that has its vector form factor.
Rgb ltc_sphere(const RectView& rect, const LobeView& lobe) {
  const CosineLobe cosine(lobe);
  std::array<Vec3d, 4> corners = rect.corners();
  for (Vec3d& p : corners) p = cosine.seen(p);
  const SphereProxy p = proxy(corners, {0, 0, 1});
  return cosine.lit(snyder(p.z, p.factor));
}

// Integral of z / r^3 times the sine of the angle to the line, over r, along the line a b above the horizon: with the foot f at the
// distance d and l along it from there,
//   integral of (f.z + l t.z) d / (d^2 + l^2)^2 dl = f.z / 2 (l / (d (d^2 + l^2)) + atan(l / d) / d^2) + t.z / 2 l^2 / (d (d^2 + l^2)).
double line_form(Vec3d a, Vec3d b) {
  if (!(a.z > 0 || b.z > 0)) return 0;
  if (a.z < 0) a = a + (b - a) * (a.z / (a.z - b.z));
  if (b.z < 0) b = b + (a - b) * (b.z / (b.z - a.z));
  const Vec3d along = normalised(b - a);
  const double from = dot(a, along), to = dot(b, along);
  const Vec3d foot = a - along * from;
  const double d = length(foot);
  if (!(d > 0)) return 0;
  const auto primitive = [&](double l) {
    const double r2 = d * d + l * l;
    return foot.z * (l / (d * r2) + std::atan(l / d) / (d * d)) + along.z * l * l / (d * r2);
  };
  return 0.5 * (primitive(to) - primitive(from));
}
// As a ribbon of the tube's diameter that faces the point. A width across the plane of the line and the point is seen through the matrix as
// one across the plane's image, whose normal is the cofactors' of the plane's: det / |cofactors normal| times as wide.
double line_share(const TubeView& tube, const CosineLobe& cosine) {
  const Vec3d normal = normalised(cosine.frame.vector(cross(tube.a, tube.b)));
  const double wider = std::abs(cosine.fit.whole.inverse.determinant()) / length(cosine.fit.whole.inverse.normal(normal));
  return dot(normal, normal) > 0 ? 2 * tube.radius * wider * line_form(cosine.seen(tube.a), cosine.seen(tube.b)) / pi : 0;
}
// The tube's ends as disks, each with the density towards its middle.
double ends_share(const TubeView& tube, const CosineLobe& cosine) {
  const Vec3d along = normalised(tube.b - tube.a);
  const auto end = [&](const Vec3d& at, const Vec3d& outwards) {
    const double r2 = dot(at, at);
    const double facing = std::max(-dot(at, outwards), 0.0) / std::sqrt(r2);
    return r2 > 0 ? cosine.fit.whole.density(normalised(cosine.frame.vector(at))) * pi * tube.radius * tube.radius * facing / r2 : 0;
  };
  return end(tube.a, -along) + end(tube.b, along);
}
Rgb ltc_line(const TubeView& tube, const LobeView& lobe) {
  const CosineLobe cosine(lobe);
  return cosine.lit(line_share(tube, cosine));
}
Rgb ltc_line_ends(const TubeView& tube, const LobeView& lobe) {
  const CosineLobe cosine(lobe);
  return cosine.lit(line_share(tube, cosine) + ends_share(tube, cosine));
}

constexpr std::string_view lines = "Heitz and Hill 2017 (GPU Zen), with the table of this library";
constexpr SpecularRules rules_sphere{.rect = ltc_sphere, .lobes = Lobes::correlated_ggx};
constexpr SpecularRules rules_line{.tube = ltc_line, .lobes = Lobes::correlated_ggx};
constexpr SpecularRules rules_line_ends{.tube = ltc_line_ends, .lobes = Lobes::correlated_ggx};
constexpr SpecularMethod specular[] = {
    {"ltc-sphere", "Hill and Heitz 2016, with the table of this library",
     "A rectangle that nothing clips, through the matrix; the cosine's horizon cuts the sphere of its vector form factor.",
     published<rules_sphere>},
    {"ltc-line", lines, "A tube as a ribbon of its diameter about its axis that faces the point, through the matrix; without its ends.",
     published<rules_line>},
    {"ltc-line-ends", lines, "The same, and both ends as disks with the density of the cosine towards their middles.",
     published<rules_line_ends>},
};

}  // namespace

std::span<const DiffuseMethod> hill_heitz_methods() { return methods; }
std::span<const SpecularMethod> hill_heitz_specular_methods() { return specular; }

TransformedCosine four_term_cosine(double alpha, double cosine) {
  static const FourTerms table;
  return table.at(std::clamp(alpha, 0.0, 1.0), std::clamp(cosine, 0.0, 1.0));
}

std::span<const float, ratio_nodes * ratio_nodes> sphere_ratios() {
  static const std::vector<float> single(ratios().values.begin(), ratios().values.end());
  return std::span<const float, nodes * nodes>(single);
}

}  // namespace etendue::eval
