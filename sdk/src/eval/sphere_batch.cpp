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

// The directions to a sphere are a cap of the sine R / d; above the horizon pi (R / d)^2 up / d. `doubtful` marks lanes so close to the
// surface that the cosine, a root of a difference, has too few digits.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_sphere(D d, const PlacedSphere& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), r2 = number(d, light.radius * light.radius);
  const Vector<V> centre = towards(d, light.centre, point.position);
  const V distance2 = dot(centre, centre), beyond = hn::Sub(distance2, r2), up = dot(centre, point.normal), up2 = hn::Mul(up, up);
  const auto outside = hn::Gt(beyond, zero);
  if constexpr (in_floats<D>) doubtful = hn::Lt(hn::Abs(beyond), hn::Mul(number(d, 0.008), r2));
  const V inverse = inverse_sqrt(d, hn::Max(distance2, r2));
  const V height = hn::Mul(up, inverse), s2 = hn::Mul(hn::Mul(r2, inverse), inverse);
  V value = hn::Mul(hn::Mul(number(d, pi), s2), hn::Max(height, zero));
  const auto cut = hn::And(hn::Lt(up2, r2), outside);
  if (!hn::AllFalse(d, cut)) {
    const V s = hn::Mul(number(d, light.radius), inverse), c = hn::Mul(hn::Sqrt(hn::Max(beyond, zero)), inverse);
    value = hn::IfThenElse(cut, cut_cap(d, height, s, c), value);
  }
  return hn::IfThenElse(outside, value, light.white.two_sided ? number(d, pi) : zero);
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
