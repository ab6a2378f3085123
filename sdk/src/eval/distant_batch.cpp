// True directions and the sun's disk at many points, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/distant_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <cmath>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_DISTANT_BATCH_SHARED
#define ETENDUE_DISTANT_BATCH_SHARED
namespace etendue::eval {
// Sine and cosine of the disk's angular radius.
struct PlacedSun {
  Vec3d towards;
  double sine, cosine;
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// For 1 lx facing it: the cosine, and where the horizon cuts a disk, its part of pi sine^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V under_sun(D d, const PlacedSun& sun, const Vector<V>& normal) {
  const V up = dot(numbers(d, sun.towards), normal);
  V value = hn::Max(up, hn::Zero(d));
  if (!(sun.sine > 0)) return value;
  const V sine = number(d, sun.sine);
  const auto cut = hn::Lt(hn::Abs(up), sine);
  if (!hn::AllFalse(d, cut)) {
    const V part = hn::Mul(cut_cap(d, up, sine, number(d, sun.cosine)), number(d, 1 / (pi * sun.sine * sun.sine)));
    value = hn::IfThenElse(cut, part, value);
  }
  return value;
}

struct SunKernel {
  const PlacedSun& sun;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M&) const {
    return under_sun(d, sun, point.normal);
  }
};
std::size_t UnderSun(const PlacedSun& sun, const PointBatch& points, std::span<float> values, float where_none) {
  return at_every_point(sun.white, 1, points, values, where_none, SunKernel{sun});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(UnderSun);

class DistantBatch final : public LightBatch::Shape {
 public:
  explicit DistantBatch(const Emitter& white) : white_(white), distant_(std::get<DistantEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> values, float where_none) const override {
    // A narrower disk is a true direction but for what a float can say of a cosine.
    const bool disk = distant_.radius_rad > 1e-7;
    const PlacedSun sun{distant_.towards, disk ? std::sin(distant_.radius_rad) : 0, disk ? std::cos(distant_.radius_rad) : 1, white_};
    return HWY_DYNAMIC_DISPATCH(UnderSun)(sun, points, values, where_none);
  }

 private:
  Emitter white_;
  DistantEmitter distant_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> distant_batch(const Emitter& white) {
  if (std::get<DistantEmitter>(white.shape).radius_rad > 1.5) return nullptr;  // no cap of less than half the sky
  return std::make_shared<DistantBatch>(white);
}

}  // namespace etendue::eval
#endif
