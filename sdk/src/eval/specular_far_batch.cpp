// specular_far.h: a point a lane of doubles. The formulas are those of far_luminance.cpp.
#include "specular_far.h"

#include "far_places.h"
#include "light_batch.h"
#include "microfacet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_far_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_SPECULAR_FAR_BATCH_SHARED
#define ETENDUE_SPECULAR_FAR_BATCH_SHARED
namespace etendue::eval {

// The rectangle relative to the origin of the points.
struct FarRect {
  explicit FarRect(const FarRectangle& light)
      : centre((light.corners[0] + light.corners[2]) * 0.5),
        half_x((light.corners[3] - light.corners[0]) * 0.5),
        half_y((light.corners[1] - light.corners[0]) * 0.5),
        normal(light.normal),
        x(length(half_x)),
        y(length(half_y)),
        two_sided(light.two_sided),
        separable(light.separable) {}

  Vec3d centre, half_x, half_y, normal;
  double x, y;
  bool two_sided, separable;
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, 8>;
using Wide = hn::Vec<Doubles>;
using Wide3 = Vector<Wide>;
HWY_INLINE Wide wide(double x) { return hn::Set(Doubles(), x); }
HWY_INLINE Wide3 times(const Wide3& v, Wide s) { return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)}; }

struct Setting {
  Wide3 centre, normal, view;  // the light's centre relative to the point; unit
  Wide alpha;
};
using Column = std::array<double, points_at_once>;
HWY_INLINE Setting setting_at(const FarRect& light, const std::array<const double*, 10>& at) {
  const Doubles d;
  const auto vector = [&](std::size_t k) ETENDUE_INLINE_LAMBDA {
    return Wide3{hn::LoadU(d, at[k]), hn::LoadU(d, at[k + 1]), hn::LoadU(d, at[k + 2])};
  };
  const auto unit = [&](const Wide3& v) ETENDUE_INLINE_LAMBDA { return times(v, inverse_root(d, hn::Max(dot(v, v), wide(1e-300)))); };
  return {numbers(d, light.centre) - vector(0), unit(vector(3)), unit(vector(6)),
          hn::Min(hn::Max(hn::LoadU(d, at[9]), wide(min_alpha)), wide(1))};
}

// Sizes of both half sides beside the nearest singularity; more than 1 where the light is not taken.
void Sizes(const FarRect& light, const PlaceBlock& places, std::size_t count, Column& size_x, Column& size_y, Column& rounding) {
  const Doubles d;
  const Wide one = wide(1), none = wide(2);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    std::array<const double*, 10> at;
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = places.numbers[k].data() + i;
    const Setting s = setting_at(light, at);
    const Wide d2 = dot(s.centre, s.centre), inverse = hn::Div(one, hn::Sqrt(d2));
    const Wide3 towards = times(s.centre, inverse);
    const Wide facing_front = hn::Neg(dot(towards, numbers(d, light.normal)));
    const Wide facing = light.two_sided ? hn::Abs(facing_front) : facing_front;
    const Wide cosine = dot(s.normal, s.view), height = dot(s.normal, towards);
    const auto across = [&](const Vec3d& half) ETENDUE_INLINE_LAMBDA { return hn::Abs(dot(s.normal, numbers(d, half))); };
    const Wide reach = hn::Mul(hn::Add(across(light.half_x), across(light.half_y)), inverse);
    // |v + l| (n.h)^2 sqrt(m^2 + alpha^2), m the slope of h = v + l.
    const Wide3 h = s.view + towards, out = cross(s.normal, h);
    const Wide up = dot(s.normal, h), up2 = hn::Mul(up, up), h2 = dot(h, h), apart = hn::Sqrt(h2);
    const Wide m2 = hn::Div(dot(out, out), up2);
    const Wide to_lobe = hn::Mul(hn::Div(up2, apart), hn::Sqrt(hn::MulAdd(s.alpha, s.alpha, m2)));
    const Wide pole = hn::Min(hn::Min(height, apart), to_lobe), pole2 = hn::Mul(pole, pole);
    const Wide x = hn::Mul(wide(light.x), inverse), y = hn::Mul(wide(light.y), inverse);
    const auto beside = [&](Wide size, Wide other) ETENDUE_INLINE_LAMBDA {
      return hn::Div(size, hn::Sqrt(hn::Max(hn::NegMulAdd(other, other, pole2), wide(1e-300))));
    };
    const auto taken = hn::And(hn::And(hn::Gt(facing, wide(0)), hn::Gt(cosine, wide(0))), hn::Gt(height, reach));
    hn::StoreU(hn::IfThenElse(taken, beside(x, y), none), d, size_x.data() + i);
    hn::StoreU(hn::IfThenElse(taken, beside(y, x), none), d, size_y.data() + i);
    // far_rounding()
    const Wide of_lobe = hn::Div(wide(2e-16), hn::Mul(s.alpha, hn::Max(cosine, wide(1e-300))));
    hn::StoreU(hn::Add(hn::Add(wide(1e-12), of_lobe), hn::Div(wide(1e-14), hn::Max(facing, wide(1e-300)))), d, rounding.data() + i);
  }
}

// A vector of points by n x m places.
HWY_NOINLINE void Places(const FarRect& light, const std::array<const double*, 10>& at, std::size_t n, std::size_t m, double* plain,
                         double* risen) {
  const Doubles d;
  const Wide one = wide(1), two = wide(2), zero = wide(0);
  const Setting s = setting_at(light, at);
  const Wide alpha2 = hn::Mul(s.alpha, s.alpha), cosine = dot(s.normal, s.view);
  const auto root = [&](Wide c) ETENDUE_INLINE_LAMBDA { return hn::Sqrt(hn::MulAdd(hn::Mul(c, c), hn::Sub(one, alpha2), alpha2)); };
  const Wide view_root = root(cosine), both = hn::Mul(wide(0.5), hn::Add(cosine, view_root));
  const Wide of_height = light.separable ? both : view_root, of_root = light.separable ? both : cosine;
  const Wide facing = hn::Abs(dot(s.centre, numbers(d, light.normal)));
  const UnitRule along = unit_rule(n), across = unit_rule(m);
  Wide sum = zero, sum_risen = zero;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d row = light.half_x * (2 * along.x[i] - 1);
    for (std::size_t j = 0; j < m; ++j) {
      const Wide3 p = s.centre + numbers(d, row + light.half_y * (2 * across.x[j] - 1));
      const Wide inverse = hn::Div(one, hn::Sqrt(dot(p, p)));
      const Wide3 l = times(p, inverse), h = s.view + l, out = cross(s.normal, h);
      const Wide nl = dot(s.normal, l), up = dot(s.normal, h), h2 = dot(h, h);
      const Wide q = hn::MulAdd(alpha2, hn::Mul(up, up), dot(out, out));
      const Wide seen = hn::MulAdd(nl, of_height, hn::Mul(of_root, root(nl)));
      // D = alpha^2 |h|^4 / (pi q^2), and what the place has of the light.
      const Wide density = hn::Div(hn::Mul(h2, h2), hn::Mul(hn::Mul(q, q), seen));
      const Wide part = hn::Mul(hn::Mul(inverse, hn::Mul(inverse, inverse)), wide(along.weight[i] * across.weight[j]));
      const Wide f = hn::Mul(hn::Mul(density, nl), part);
      const Wide away = hn::Max(hn::NegMulAdd(wide(0.5), hn::Sqrt(h2), one), zero), away2 = hn::Mul(away, away);
      sum = hn::Add(sum, f);
      sum_risen = hn::MulAdd(f, hn::Mul(hn::Mul(away2, away2), away), sum_risen);
    }
  }
  // The area is four times both half sides, and masking has a half.
  const Wide scale = hn::Mul(hn::Mul(alpha2, facing), hn::Mul(two, wide(light.x * light.y / pi)));
  hn::StoreU(hn::Mul(scale, hn::Sub(sum, sum_risen)), d, plain);
  hn::StoreU(hn::Mul(scale, sum_risen), d, risen);
}

void Far(const FarRectangle& rect, const PlaceBlock& places, std::size_t count, const FarOrders& orders, FarShares& to) {
  const FarRect light(rect);
  Column size_x, size_y, rounding;
  Sizes(light, places, count, size_x, size_y, rounding);
  struct Taken {
    std::size_t point, x, y;
  };
  std::array<Taken, points_at_once> taken;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    to.bound[i] = -1;
    const std::size_t x = orders.order(size_x[i]), y = orders.order(size_y[i]);
    if (x > 0 && y > 0 && rounding[i] < 0.01 * orders.tolerance) taken[found++] = {i, x, y};
  }
  // Those that take about as many places go together.
  std::sort(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(found),
            [](const Taken& a, const Taken& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const std::size_t lanes = hn::Lanes(Doubles());
  for (std::size_t first = 0; first < found; first += lanes) {
    HWY_ALIGN std::array<std::array<double, 8>, 10> numbers;
    HWY_ALIGN std::array<double, 8> plain, risen;
    std::array<const double*, 10> at;
    std::size_t n = 1, m = 1;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Taken& one = taken[std::min(first + lane, found - 1)];
      n = std::max(n, one.x), m = std::max(m, one.y);
      for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k][lane] = places.numbers[k][one.point];
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) at[k] = numbers[k].data();
    Places(light, at, n, m, plain.data(), risen.data());
    for (std::size_t lane = 0; lane < lanes && first + lane < found; ++lane) {
      const std::size_t i = taken[first + lane].point;
      to.of_f0[i] = plain[lane], to.of_f90[i] = risen[lane];
      to.bound[i] = far_bound_of_side(n, size_x[i]) + far_bound_of_side(m, size_y[i]) + rounding[i];
    }
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

// 2 C q^2n is half of the tolerance, and size = 2 q / (1 + q^2).
FarOrders::FarOrders(double asked) : tolerance(asked) {
  for (std::size_t n = 0; n < most_far_order; ++n) {
    const double of_one = far_bound_of_side(n + 1, 1), degree = 2 * static_cast<double>(n + 1);
    const double q = std::pow(0.49 * asked / of_one, 1 / degree);
    largest[n] = std::min(2 * q / (1 + q * q), largest_far_size);
  }
}

HWY_EXPORT(Far);

void far_shares(const FarRectangle& light, const PlaceBlock& places, std::size_t count, const FarOrders& orders, FarShares& to) {
  HWY_DYNAMIC_DISPATCH(Far)(light, places, count, orders, to);
}

}  // namespace etendue::eval
#endif
