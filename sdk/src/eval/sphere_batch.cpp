// The sphere at many points: the closed form of its cap over the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/sphere_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_SPHERE_BATCH_SHARED
#define ETENDUE_SPHERE_BATCH_SHARED
namespace etendue::eval {
struct PlacedSphere {
  Place centre;
  double radius;  // in units of the batch, as the centre
  double scale;   // units a metre
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// A cap of sine s and cosine c about the direction at the height u = n.axis. Above the horizon pi s^2 u. Where it is cut, with phi half the
// angle of the circle's part above and psi half the angle of the horizon's part below the cap, the integral of half b x db gives
//     phi s^2 u - c q + psi,   q = sqrt(s^2 - u^2), phi = angle(-c u, q), psi = atan(k), k = q / c,
// and with c q = c^2 k = k - s^2 k it is s^2 (phi u + k) - (k - atan k), whose terms are no larger than the result's order s^3.
// `doubtful` marks lanes so close to the surface that c, a root of a difference, has too few digits.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_sphere(D d, const PlacedSphere& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), one = number(d, 1), radius = number(d, light.radius), pi_ = number(d, pi);
  const Vector<V> centre = towards(d, light.centre, point.position);
  const V distance = hn::Sqrt(dot(centre, centre));
  const auto outside = hn::Gt(distance, radius);
  if constexpr (in_floats<D>) doubtful = hn::Lt(hn::Abs(hn::Sub(distance, radius)), hn::Mul(number(d, 0.004), radius));
  const V inverse = hn::Div(one, hn::IfThenElse(outside, distance, one));
  const V s = hn::Mul(radius, inverse);
  const V c = hn::Mul(hn::Sqrt(hn::Max(hn::Mul(hn::Sub(distance, radius), hn::Add(distance, radius)), zero)), inverse);
  const V u = hn::Mul(dot(centre, point.normal), inverse), s2 = hn::Mul(s, s);
  V value = hn::Mul(hn::Mul(pi_, s2), hn::Max(u, zero));
  const auto cut = hn::And(hn::Lt(hn::Abs(u), s), outside);
  if (!hn::AllFalse(d, cut)) {
    const V q = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(s, u), hn::Add(s, u)), zero));
    const V phi = angle_of(d, q, hn::Neg(hn::Mul(c, u))), psi = angle_of(d, q, c);
    // k - atan k by its series where the difference would cancel.
    const V k = hn::Div(q, hn::Max(c, number(d, 1e-6))), k2 = hn::Mul(k, k);
    const V narrow = hn::MulAdd(s2, hn::MulAdd(phi, u, k), hn::Mul(hn::Mul(atan_rest(d, k2), k2), k));
    const V wide = hn::Add(hn::MulSub(hn::Mul(phi, s2), u, hn::Mul(c, q)), psi);
    const V part = hn::IfThenElse(hn::Lt(k, number(d, 0.41421356237309503)), narrow, wide);
    value = hn::IfThenElse(cut, hn::Max(part, zero), value);
  }
  return hn::IfThenElse(outside, value, light.white.two_sided ? pi_ : zero);
}

struct SphereKernel {
  const PlacedSphere& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_sphere(d, light, point, doubtful);
  }
};
std::size_t OverSphere(const PlacedSphere& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, SphereKernel{light});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverSphere);

class SphereBatch final : public LightBatch::Shape {
 public:
  explicit SphereBatch(const Emitter& white) : white_(white), sphere_(std::get<SphereEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const double scale = unit_for(sphere_.radius);
    const PlacedSphere light{Place((sphere_.centre - points.origin) * scale), sphere_.radius * scale, scale, white_};
    return HWY_DYNAMIC_DISPATCH(OverSphere)(light, points, sr, where_none);
  }

 private:
  Emitter white_;
  SphereEmitter sphere_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> sphere_batch(const Emitter& white) { return std::make_shared<SphereBatch>(white); }

}  // namespace etendue::eval
#endif
