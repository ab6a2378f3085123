// What a window takes from spheres, the caps and the sides of tubes: integrals over one variable, the other one in closed form.
#include "window_part.h"

#include "line_integral.h"
#include "quadrature.h"
#include "smooth_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

const Vec3d up{0, 0, 1};

// Values within an interval, in order: where an integrand bends.
class Bends {
 public:
  Bends(double begin, double end) : begin_(begin), end_(end), at_{begin} {}
  void add(double x) {
    if (x > begin_ && x < end_ && count_ + 1 < at_.size()) at_[count_++] = x;
  }
  // use(from, to) for the intervals between.
  template <class Use>
  void each(Use use) {
    std::sort(at_.begin(), at_.begin() + count_);
    at_[count_] = end_;
    for (std::size_t i = 0; i < count_; ++i)
      if (at_[i] < at_[i + 1]) use(at_[i], at_[i + 1]);
  }

 private:
  double begin_, end_;
  std::array<double, 16> at_;
  std::size_t count_ = 1;
};

// What a window takes has no peak, what it leaves one where the light is nearest. The rule's own difference is larger than its error.
template <class Function>
double integral(const Taken&, double begin, double end, double, double, const Function& f) {
  const auto grey = [&](double x) {
    const double value = f(x);
    return Rgb{value, value, value};
  };
  return integrate_peaked(grey, begin, end, begin, end - begin, {1e-10, 1e-13}).value.x;
}
template <class Function>
double integral(const Kept&, double begin, double end, double peak, double width, const Function& f) {
  const auto grey = [&](double x) {
    const double value = f(x);
    return Rgb{value, value, value};
  };
  const double nearest = std::clamp(peak, begin, end);
  return integrate_peaked(grey, begin, end, nearest, std::min(std::hypot(width, nearest - peak), end - begin), {1e-10, 0}).value.x;
}

// Half the angle of the part of a turn with  across cos(x) + along > 0,  across >= 0.
double half_turn_above(double along, double across) {
  if (along >= across) return pi;
  return along <= -across ? 0 : std::acos(-along / across);
}

// Directions at one angle from the centre c of a sphere meet it at one distance d, |c| - R <= d <= sqrt(|c|^2 - R^2), where
//     mu = cos(angle) = (d^2 + |c|^2 - R^2) / (2 |c| d),   sin(angle) = sqrt(e (2 R - e) ((|c| + d)^2 - R^2)) / (2 |c| d),  e = d - |c| +
//     R.
// Over such a ring n.omega = u mu + sqrt(1 - u^2) sin(angle) cos(psi), u = n.c / |c|; its part above the horizon is within psi_n of psi =
// 0, and of that the part where the sphere's normal m has m.a > 0 within psi_a of the direction chi of a's part across c.
class Rings {
 public:
  Rings(const Vec3d& centre, double radius, const std::optional<Vec3d>& outwards)
      : distance_(length(centre)), radius_(radius), along_(centre.z / distance_), across_(std::hypot(centre.x, centre.y) / distance_) {
    if (!outwards) return;
    half_ = true;
    const Vec3d axis = centre / distance_, off = cross(axis, *outwards);
    half_along_ = dot(axis, *outwards);
    half_across_ = length(off);
    chi_ = std::abs(std::atan2(off.z, outwards->z - along_ * half_along_));
  }
  double nearest() const { return distance_ - radius_; }
  // e of the tangents.
  double last() const {
    const double near = std::sqrt(distance_ - radius_), far = std::sqrt(distance_ + radius_);
    return near * 2 * radius_ / (near + far);
  }
  // Of the ring at e: the integral of n.omega over what is seen of it, times |d mu / d e|.
  double operator()(double e) const {
    const double d = nearest() + e, tangent2 = (distance_ - radius_) * (distance_ + radius_), far = distance_ + d;
    const double mu = (d * d + tangent2) / (2 * distance_ * d);
    const double sine = std::sqrt(std::max(e * (2 * radius_ - e) * (far - radius_) * (far + radius_), 0.0)) / (2 * distance_ * d);
    const double up_along = along_ * mu, up_across = across_ * sine, above = half_turn_above(up_along, up_across);
    const double speed = std::max(tangent2 / (d * d) - 1, 0.0) / (2 * distance_);
    if (!half_) return speed * 2 * (up_along * above + up_across * std::sin(above));
    // m.a = (d omega - c).a / R
    const double outwards = half_turn_above(half_along_ * (d * mu - distance_), half_across_ * d * sine);
    double sum = 0;
    for (const double turn : {0.0, 2 * pi}) {
      const double from = std::max(-above, chi_ - outwards - turn), to = std::min(above, chi_ + outwards - turn);
      if (from < to) sum += up_along * (to - from) + up_across * (std::sin(to) - std::sin(from));
    }
    return speed * sum;
  }
  // Where the horizon, or the plane across the axis, touches a ring.
  void add_bends(Bends& bends) const {
    const double sine = std::abs(along_), chord = sine * distance_;
    if (chord < radius_)
      bends.add(std::sqrt((1 - sine) * (1 + sine)) * distance_ - std::sqrt((radius_ - chord) * (radius_ + chord)) - nearest());
    if (half_) {
      const double cosine = std::sqrt(std::max((1 - half_along_) * (1 + half_along_), 0.0));
      bends.add(std::sqrt(distance_ * distance_ + radius_ * radius_ - 2 * distance_ * radius_ * cosine) - nearest());
    }
  }

 private:
  double distance_, radius_, along_, across_;
  bool half_ = false;
  double half_along_ = 0, half_across_ = 0, chi_ = 0;
};

// With e = e0 + (e1 - e0) sin^2(t / 2) the roots at the ends of each interval are smooth.
template <class Weight>
double ball(const Vec3d& centre, double radius, const Weight& window, const std::optional<Vec3d>& outwards) {
  if (!(radius > 0) || !(centre.z + radius > 0)) return 0;
  const Rings rings(centre, radius, outwards);
  Bends bends(0, rings.last());
  bends.add(1 - rings.nearest());
  rings.add_bends(bends);
  if (outwards) {
    // Where the horizon crosses the circle in which the cap meets the side: m = k p +- sqrt(1 - k^2) q.
    const Vec3d across = up - *outwards * outwards->z;
    const double size = length(across), k = -centre.z / (radius * size);
    if (size > 0 && std::abs(k) < 1) {
      const Vec3d p = across / size, q = cross(*outwards, p) * std::sqrt((1 - k) * (1 + k));
      for (const Vec3d& m : {p * k + q, p * k - q}) bends.add(length(centre + m * radius) - rings.nearest());
    }
  }
  double sum = 0;
  bends.each([&](double from, double to) {
    const double width = 2 * std::sqrt((rings.nearest() + from) / (to - from));
    sum += integral(window, 0, pi, 0, width, [&](double t) {
      const double s = std::sin(0.5 * t), e = from + (to - from) * s * s, d = rings.nearest() + e;
      return 0.5 * (to - from) * std::sin(t) * rings(e) * window.at(d * d);
    });
  });
  return sum;
}

// Integral of (p + q x) / (g^2 + x^2)^2 from x0 to x1. Its closed form cancels to (g / x)^3 where g is small against both; with x = 1 / u
// the integrand is smooth there.
double inverse_fourth(double p, double q, double g2, double x0, double x1) {
  if (x1 < 0) return inverse_fourth(p, -q, g2, -x1, -x0);
  const double y0 = g2 + x0 * x0, y1 = g2 + x1 * x1;
  if (x0 <= 0 || g2 > 0.5 * x0 * x0) {
    const double g = std::sqrt(g2), turned = std::atan2(g * (x1 - x0), g2 + x0 * x1);
    return p / (2 * g * g2) * (turned + g * (x1 - x0) * (g2 - x0 * x1) / (y0 * y1)) + 0.5 * q * (x1 - x0) * (x1 + x0) / (y0 * y1);
  }
  double sum = 0;
  const double middle = 0.5 * (1 / x0 + 1 / x1), half = 0.5 * (1 / x0 - 1 / x1);
  for (const KronrodNode& node : kronrod15().nodes) {
    const double u = middle + half * node.x, y = 1 + g2 * u * u;
    sum += half * node.weight * (p * u + q) * u / (y * y);
  }
  return sum;
}

// Along a line on the tube at g^2 across from the point, x0 <= x <= x1: the integral of (p + q x) (1 - w) / |y|^4. Within the range it is
// a polynomial of the degree 5.
double along_side(double p, double q, double g2, double x0, double x1, const Taken& taken) {
  if (g2 >= 1) return inverse_fourth(p, q, g2, x0, x1);
  const double reach = std::sqrt(1 - g2), from = std::clamp(-reach, x0, x1), to = std::clamp(reach, x0, x1);
  double sum = 0;
  for (const GaussNode& node : gauss3) {
    const double x = 0.5 * (from + to) + 0.5 * (to - from) * node.x;
    sum += 0.5 * (to - from) * node.weight * (p + q * x) * taken.per_fourth(g2 + x * x);
  }
  if (x0 < from) sum += inverse_fourth(p, q, g2, x0, from);
  if (to < x1) sum += inverse_fourth(p, q, g2, to, x1);
  return sum;
}

double along_side(double p, double q, double g2, double x0, double x1, const Kept& kept) {
  if (!(g2 < kept.end())) return 0;
  const double reach = kept.end() > 1 ? kept.end() : std::sqrt(1 - g2), from = std::clamp(-reach, x0, x1), to = std::clamp(reach, x0, x1);
  if (!(from < to)) return 0;
  double sum = 0;
  smooth_integral(from, to, 0, std::sqrt(g2), kept.steepest(), [&](double x, double weight) {
    const double d2 = g2 + x * x;
    sum += weight * (p + q * x) * kept.at(d2) / (d2 * d2);
  });
  return sum;
}
// What is above the horizon: p + q x > 0.
template <class Weight>
double above_along_side(double p, double q, double g2, double x0, double x1, const Weight& window) {
  if (q > 0) x0 = std::max(x0, -p / q);
  if (q < 0) x1 = std::min(x1, -p / q);
  return (q == 0 && p <= 0) || !(x0 < x1) ? 0 : along_side(p, q, g2, x0, x1, window);
}

// y = D e + R m + x axis with the outward normal m = -e cos(phi) + f sin(phi), f = axis x e: the side is seen where -m.y = D cos(phi) - R
// is positive.
template <class Weight>
double tube_side(const Vec3d& a, const Vec3d& b, double radius, const Weight& window) {
  const Vec3d span = b - a;
  const double l = length(span);
  if (!(radius > 0) || !(l > 0) || std::max(a.z, b.z) + radius <= 0) return 0;
  const Vec3d axis = span / l;
  const double x0 = dot(a, axis), x1 = x0 + l;
  const Vec3d off = a - axis * x0;
  const double across = length(off);
  if (!(across > radius)) return 0;
  const Vec3d e = off / across, f = cross(axis, e);
  const double last = std::acos(radius / across), twice = 2 * across * radius, most = across * across + radius * radius;
  Bends bends(-last, last);
  const auto add = [&](double middle, double cosine) {
    if (!(std::abs(cosine) < 1)) return;
    const double half = std::acos(cosine);
    for (const double turn : {-2 * pi, 0.0, 2 * pi}) bends.add(middle - half + turn), bends.add(middle + half + turn);
  };
  // Where the horizon passes the ends, and where the range passes the ends and the foot.
  const double ripple = radius * std::hypot(e.z, f.z), phase = std::atan2(-f.z, e.z);
  for (const double x : {x0, x1}) {
    if (ripple > 0) add(phase, (across * e.z + axis.z * x) / ripple);
    add(0, (most + x * x - 1) / twice);
  }
  if (x0 < 0 && x1 > 0) add(0, (most - 1) / twice);
  const auto row = [&](double phi) {
    const double c = std::cos(phi), s = std::sin(phi), sine = std::sin(0.5 * phi);
    const double g2 = (across - radius) * (across - radius) + 2 * twice * sine * sine;
    return (across * c - radius) * above_along_side((across - radius * c) * e.z + radius * s * f.z, axis.z, g2, x0, x1, window);
  };
  const double width = (across - radius) / std::sqrt(twice);
  double sum = 0;
  bends.each([&](double from, double to) { sum += integral(window, from, to, 0, width, row); });
  return radius * sum;
}

}  // namespace

double ball_part(const Vec3d& centre, double radius, const Taken& taken, const std::optional<Vec3d>& outwards) {
  return ball(centre, radius, taken, outwards);
}
double ball_part(const Vec3d& centre, double radius, const Kept& kept, const std::optional<Vec3d>& outwards) {
  return ball(centre, radius, kept, outwards);
}
double tube_side_part(const Vec3d& a, const Vec3d& b, double radius, const Taken& taken) { return tube_side(a, b, radius, taken); }
double tube_side_part(const Vec3d& a, const Vec3d& b, double radius, const Kept& kept) { return tube_side(a, b, radius, kept); }

}  // namespace etendue::eval
