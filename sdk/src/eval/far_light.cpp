#include "etendue/far_light.h"

#include <cmath>
#include <span>

#include "quadrature.h"

namespace etendue::eval {
namespace {

// The integral of h g / r^4 over the area, h the point's height above the light's plane, the same for all of it, and g = n.p.
template <class T>
T integrate(std::span<const GaussNode> nodes, const Parallelogram<T>& light, const Vec3<T>& normal) {
  const T height_area = -dot(cross(light.half_x, light.half_y), light.centre);
  if (!(height_area > 0)) return 0;
  T sum = 0;
  for (const GaussNode& u : nodes) {
    for (const GaussNode& v : nodes) {
      const Vec3<T> p = light.centre + (light.half_x * static_cast<T>(u.x) + light.half_y * static_cast<T>(v.x));
      const T inverse = 1 / dot(p, p);
      sum += static_cast<T>(u.weight * v.weight) * (dot(normal, p) * inverse) * (height_area * inverse);
    }
  }
  return sum;
}

template <class T>
T by_rule(FarRule rule, const Parallelogram<T>& light, const Vec3<T>& normal) {
  switch (rule) {
    case FarRule::point:
      return integrate<T>(gauss1, light, normal);
    case FarRule::gauss2:
      return integrate<T>(gauss2, light, normal);
    case FarRule::gauss3:
      return integrate<T>(gauss3, light, normal);
    case FarRule::gauss4:
      break;
  }
  return integrate<T>(gauss4, light, normal);
}

// Of the rule with n nodes a side: e_k is what it misses of the mean of u^k over [-1, 1], c_k = (k + 3)(k + 2)(k + 1) / 6 the largest value
// of Gegenbauer's C_k^(2).
struct Missed {
  int degree;              // 2 n
  double odd, even, grow;  // e_2n c_(2n-1), e_2n c_2n, and the largest ratio of what follows: e_(k+2) c_(k+1) / (e_k c_(k-1))
};
constexpr Missed missed_by(FarRule rule) {
  switch (rule) {
    case FarRule::point:
      return {2, 4.0 / 3, 10.0 / 3, 3};
    case FarRule::gauss2:
      return {4, 16.0 / 9, 28.0 / 9, 10.0 / 3};
    case FarRule::gauss3:
      return {6, 32.0 / 25, 48.0 / 25, 11.0 / 3};
    case FarRule::gauss4:
      break;
  }
  return {8, 512.0 / 735, 704.0 / 735, 57.0 / 14};
}

}  // namespace

std::optional<double> far_error(FarRule rule, double distance_over_size) {
  if (!(distance_over_size >= 3.5)) return std::nullopt;
  // Half a side over the least distance of the middle of a row.
  const double e = 1 / (2 * distance_over_size - 1);
  const Missed m = missed_by(rule);
  const double tail = 1 - m.grow * e * e, odd = m.odd * std::pow(e, m.degree - 1) / tail, even = m.even * std::pow(e, m.degree) / tail;
  const double along = (odd + even) / (1 - 4 * e / 3), across = even / (1 - 2 * e * e / 3);
  return along + across + along * across;
}

std::optional<FarRule> far_rule(double distance_over_size, double relative_tolerance) {
  for (const FarRule rule : {FarRule::point, FarRule::gauss2, FarRule::gauss3, FarRule::gauss4}) {
    const std::optional<double> error = far_error(rule, distance_over_size);
    if (error && *error <= relative_tolerance) return rule;
  }
  return std::nullopt;
}

double far_projected_solid_angle(FarRule rule, const Parallelogram<double>& light, const Vec3d& normal) {
  return by_rule(rule, light, normal);
}
float far_projected_solid_angle(FarRule rule, const Parallelogram<float>& light, const Vec3f& normal) {
  return by_rule(rule, light, normal);
}

}  // namespace etendue::eval
