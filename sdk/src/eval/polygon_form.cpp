// The projected solid angle of polygons.
#include "illuminance.h"

#include <algorithm>
#include <array>

namespace etendue::eval {
namespace {

// Sutherland and Hodgman 1974: the part of the polygon with n.p >= 0.
void clip_polygon(const std::vector<Vec3d>& in, const Vec3d& n, std::vector<Vec3d>& out) {
  out.clear();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Vec3d& p = in[i];
    const Vec3d& q = in[(i + 1) % in.size()];
    const double dp = dot(n, p), dq = dot(n, q);
    if (dp >= 0) out.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) out.push_back(p + (q - p) * (dp / (dp - dq)));
  }
}

// Lambert's sum over the edges, 1/2 sum of angle n.m with m the unit normal of the plane through the edge and the point.
double edge_sum(std::span<const Vec3d> p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3d& a = p[i];
    const Vec3d& b = p[(i + 1) % p.size()];
    const Vec3d m = cross(a, b - a);
    const double sine = length(m);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * m.z / sine;
  }
  return 0.5 * sum;
}

// Far away the edges cancel to (size / distance)^2 of their size; there the integral over the area is taken instead, triangle by
// triangle: of p.z (N.p) / |p|^4 with N twice the vector area, Gauss-Legendre 4 x 4 on the collapsed square (a, b) ->
// p0 + a e1 + a b (e2 - e1), whose density is a. Its error is (size / distance)^8: below 1e-15 where size < .01 distance.
double area_sum(std::span<const Vec3d> p) {
  static constexpr std::array<double, 4> x{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970262};
  static constexpr std::array<double, 4> w{0.17392742256872692, 0.32607257743127307, 0.32607257743127307, 0.17392742256872692};
  double sum = 0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec3d e1 = p[i] - p[0], e12 = p[i + 1] - p[i];
    const Vec3d area = cross(e1, p[i + 1] - p[0]);
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) {
        const Vec3d q = p[0] + e1 * x[j] + e12 * (x[j] * x[k]);
        const double q2 = dot(q, q);
        sum += w[j] * w[k] * x[j] * q.z * dot(area, q) / (q2 * q2);
      }
    }
  }
  return sum;
}

}  // namespace

double projected_solid_angle(std::span<const Vec3d> vertices, const Horizons& horizons) {
  if (vertices.size() < 3) return 0;
  double lowest = vertices[0].z, highest = vertices[0].z, lowest_surface = dot(horizons.surface, vertices[0]);
  double size2 = 0;
  for (const Vec3d& v : vertices) {
    lowest = std::min(lowest, v.z);
    highest = std::max(highest, v.z);
    if (horizons.distinct) lowest_surface = std::min(lowest_surface, dot(horizons.surface, v));
    size2 = std::max(size2, dot(v - vertices[0], v - vertices[0]));
  }
  if (highest <= 0) return 0;
  const bool far = size2 < 1e-4 * dot(vertices[0], vertices[0]);
  const bool cuts_surface = horizons.distinct && lowest_surface < 0;
  if (lowest >= 0 && !cuts_surface) return far ? area_sum(vertices) : edge_sum(vertices);
  std::vector<Vec3d> polygon(vertices.begin(), vertices.end()), other;
  if (lowest < 0) {
    clip_polygon(polygon, {0, 0, 1}, other);
    polygon.swap(other);
  }
  if (cuts_surface) {
    clip_polygon(polygon, horizons.surface, other);
    polygon.swap(other);
  }
  if (polygon.size() < 3) return 0;
  return far ? area_sum(polygon) : edge_sum(polygon);
}

}  // namespace etendue::eval
