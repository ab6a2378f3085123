// Point lights, spots and frusta with their windows at many points, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/punctual_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "eval/light_batch-inl.h"
#include "simd-inl.h"

#ifndef ETENDUE_PUNCTUAL_BATCH_SHARED
#define ETENDUE_PUNCTUAL_BATCH_SHARED
namespace etendue::eval {

struct PlacedPoint {
  Place position;
  Falloff falloff;
  double per_range2;  // 1 / range^2
  double gain;        // of scale_bias
  const Emitter& white;
};
// 1 - cosine of both cones; `steep`: so close to each other that a float's rounding is seen between them.
struct PlacedSpot {
  Vec3d axis;
  double inner, outer;
  bool steep;
};
struct PlacedFrustum {
  Vec3d across, upwards, axis;
  double tan_width, tan_height;  // of the half angles
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// What rounding leaves unknown of a cosine.
template <class D>
constexpr double unknown = in_floats<D> ? 1e-6 : 1e-14;

// x^n of x^2, which is not negative.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V power(D d, V x2, double n) {
  if (n == 4) return hn::Mul(x2, x2);
  if (n == 1) return hn::Sqrt(x2);
  if constexpr (in_floats<D>) {
    return etendue::HWY_NAMESPACE::power_of(d, x2, 0.5 * n);
  } else {
    HWY_ALIGN std::array<double, hn::MaxLanes(d)> lanes;
    hn::Store(x2, d, lanes.data());
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) lanes[i] = std::pow(lanes[i], 0.5 * n);
    return hn::Load(d, lanes.data());
  }
}

// window_at(). Without a range per_range2 is 0. What rounding leaves unknown of x^n is n roundings of x.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V window(D d, const PlacedPoint& light, V distance2, M& doubtful) {
  const V zero = hn::Zero(d), one = number(d, 1), x2 = hn::Mul(distance2, number(d, light.per_range2));
  const auto left = [&](double n) {
    const V taken = power(d, hn::Min(x2, one), n);
    if (in_floats<D> && n > 6) doubtful = hn::Or(doubtful, hn::And(hn::Lt(x2, one), hn::Gt(taken, number(d, 6 / n))));
    return hn::IfThenElseZero(hn::Lt(x2, one), hn::Sub(one, taken));
  };
  switch (light.falloff.law) {
    case Falloff::Law::power:
      return left(light.falloff.exponent);
    case Falloff::Law::power_squared: {
      const V w = left(light.falloff.exponent);
      return hn::Mul(w, w);
    }
    case Falloff::Law::smoothstep: {
      const V x = hn::Sqrt(hn::Min(x2, one)), rest = hn::Sub(one, x);
      return hn::Mul(hn::Mul(rest, rest), hn::MulAdd(x, number(d, 2), one));
    }
    case Falloff::Law::scale_bias:
      if (in_floats<D> && light.gain > 2) doubtful = hn::Or(doubtful, hn::Lt(x2, one));
      return hn::Mul(hn::Max(hn::Sub(one, x2), zero), number(d, light.gain));
    case Falloff::Law::karis: {
      const V w = hn::Max(hn::NegMulAdd(x2, x2, one), zero);
      return hn::Mul(hn::Mul(w, w), hn::Div(distance2, hn::Add(distance2, one)));
    }
    case Falloff::Law::inverse_square:
      break;
  }
  return one;
}

// angular_falloff() in punctual.cpp, of 1 - cosine = sine^2 / (1 + cosine), which has all its digits in narrow cones too.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V in_cone(D d, const PlacedSpot& spot, const Vector<V>& to_light, V inverse, M& doubtful) {
  const V zero = hn::Zero(d), one = number(d, 1), inner = number(d, spot.inner), outer = number(d, spot.outer);
  const Vector<V> axis = numbers(d, spot.axis), across = cross(axis, to_light);
  const V cosine = hn::Mul(dot(axis, to_light), inverse), sine2 = hn::Mul(dot(across, across), hn::Mul(inverse, inverse));
  const V drop = hn::IfThenElse(hn::Gt(cosine, zero), hn::Div(sine2, hn::Add(one, cosine)), hn::Sub(one, cosine));
  if (spot.steep) {
    const V margin = number(d, unknown<D>);
    doubtful = hn::Or(doubtful, hn::And(hn::Lt(drop, hn::Add(outer, margin)), hn::Gt(drop, hn::Sub(inner, margin))));
  }
  const double range = spot.outer - spot.inner;
  const V x = hn::Mul(hn::Max(hn::Sub(outer, drop), zero), number(d, range > 1e-30 ? 1 / range : 0));
  return hn::IfThenElse(hn::Le(drop, inner), one, hn::Mul(x, x));
}

template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V in_frustum(D d, const PlacedFrustum& frustum, const Vector<V>& to_light, V inverse, M& doubtful) {
  const auto along = [&](const Vec3d& axis) { return hn::Mul(dot(numbers(d, axis), to_light), inverse); };
  const V depth = along(frustum.axis);
  const auto inside = [&](V side, double tangent) {
    const V within = hn::Sub(hn::Mul(depth, number(d, tangent)), hn::Abs(side));
    doubtful = hn::Or(doubtful, hn::Lt(hn::Abs(within), number(d, unknown<D> * (1 + tangent))));
    return hn::Ge(within, hn::Zero(d));
  };
  const auto lit = hn::And(inside(along(frustum.across), frustum.tan_width), inside(along(frustum.upwards), frustum.tan_height));
  return hn::IfThenElseZero(hn::And(lit, hn::Gt(depth, hn::Zero(d))), number(d, 1));
}

// share(d, to the light, 1 / distance, mask&): of the axial intensity that goes to each point.
template <class Share>
struct PointKernel {
  const PlacedPoint& light;
  Share share;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    const V zero = hn::Zero(d);
    const Vector<V> to_light = towards(d, light.position, point.position);
    const V distance2 = dot(to_light, to_light), inverse = hn::Div(number(d, 1), hn::Sqrt(distance2));
    if constexpr (in_floats<D>) doubtful = hn::Or(hn::Lt(distance2, number(d, 1e-24)), hn::Gt(distance2, number(d, 1e24)));
    V value = hn::Mul(hn::Mul(hn::Max(dot(to_light, point.normal), zero), inverse), hn::Mul(inverse, inverse));
    value = hn::Mul(value, share(d, to_light, inverse, doubtful));
    if (light.falloff.law != Falloff::Law::inverse_square) value = hn::Mul(value, window(d, light, distance2, doubtful));
    const auto apart = hn::Gt(distance2, number(d, in_floats<D> ? 0 : 1e-280));
    return hn::IfThenElseZero(apart, hn::Min(value, number(d, static_cast<double>(hwy::HighestValue<float>()))));
  }
};
struct AllAround {
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Vector<V>&, V, M&) const {
    return number(d, 1);
  }
};
struct InCone {
  const PlacedSpot& spot;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Vector<V>& to_light, V inverse, M& doubtful) const {
    return in_cone(d, spot, to_light, inverse, doubtful);
  }
};
struct InFrustum {
  const PlacedFrustum& frustum;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Vector<V>& to_light, V inverse, M& doubtful) const {
    return in_frustum(d, frustum, to_light, inverse, doubtful);
  }
};

constexpr double unbounded = std::numeric_limits<double>::infinity();
std::size_t OverPoint(const PlacedPoint& light, const PointBatch& points, std::span<float> values, float where_none) {
  return at_every_point(light.white, 1, points, values, where_none, PointKernel<AllAround>{light, {}}, unbounded);
}
std::size_t OverSpot(const PlacedPoint& light, const PlacedSpot& spot, const PointBatch& points, std::span<float> values,
                     float where_none) {
  return at_every_point(light.white, 1, points, values, where_none, PointKernel<InCone>{light, {spot}}, unbounded);
}
std::size_t OverFrustum(const PlacedPoint& light, const PlacedFrustum& frustum, const PointBatch& points, std::span<float> values,
                        float where_none) {
  return at_every_point(light.white, 1, points, values, where_none, PointKernel<InFrustum>{light, {frustum}}, unbounded);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverPoint);
HWY_EXPORT(OverSpot);
HWY_EXPORT(OverFrustum);

// 1 - cosine is known to some 1e-7 of the sine; x in the falloff x^2 of both cones should be known to 4e-6.
PlacedSpot placed(const SpotShape& spot, const Transform& frame) {
  const auto drop = [](double angle) { return 2 * std::sin(0.5 * angle) * std::sin(0.5 * angle); };
  const double inner = drop(spot.inner_rad), outer = drop(spot.outer_rad);
  return {frame.columns[2], inner, outer, outer - inner < 0.03 * std::sin(spot.outer_rad)};
}
PlacedFrustum placed(const FrustumShape& frustum, const Transform& frame) {
  return {frame.columns[0], frame.columns[1], frame.columns[2], std::tan(0.5 * frustum.width_rad), std::tan(0.5 * frustum.height_rad)};
}

class PunctualBatch final : public LightBatch::Shape {
 public:
  explicit PunctualBatch(const Emitter& white) : white_(white), emitter_(std::get<PunctualEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> values, float where_none) const override {
    const double range = white_.window.range_m, per_range2 = range > 0 ? std::min(1 / (range * range), 1e38) : 0;
    const PlacedPoint light{Place(emitter_.position - points.origin), is_window(white_.window) ? white_.window.falloff : Falloff{},
                            per_range2, per_range2 < 1 ? 1 / (1 - per_range2) : 0, white_};
    if (const auto* spot = std::get_if<SpotShape>(&emitter_.shape))
      return HWY_DYNAMIC_DISPATCH(OverSpot)(light, placed(*spot, emitter_.frame), points, values, where_none);
    if (const auto* frustum = std::get_if<FrustumShape>(&emitter_.shape))
      return HWY_DYNAMIC_DISPATCH(OverFrustum)(light, placed(*frustum, emitter_.frame), points, values, where_none);
    return HWY_DYNAMIC_DISPATCH(OverPoint)(light, points, values, where_none);
  }

 private:
  Emitter white_;
  PunctualEmitter emitter_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> punctual_batch(const Emitter& white) {
  if (std::holds_alternative<ProfileShape>(std::get<PunctualEmitter>(white.shape).shape)) return nullptr;
  return std::make_shared<PunctualBatch>(white);
}

}  // namespace etendue::eval
#endif
