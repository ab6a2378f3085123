// The line light at many points, over the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/line_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <limits>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_LINE_BATCH_SHARED
#define ETENDUE_LINE_BATCH_SHARED
namespace etendue::eval {
struct PlacedLine {
  Place a;
  Vec3d axis;     // unit, from a to the other end
  double length;  // in units of the batch, as the place
  double scale;   // units a metre
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// The integral of line.h between the places a and b along the axis x, D the distance across it, e pointing there, with the differences of
// sin psi = x / |(D, x)| and cos psi = D / |(D, x)| written out: for 1 cd and the whole length l it is
//     1 / (2 l D) (n_e (psi_b - psi_a) + D (b - a) / (|a|^2 |b|^2) (n_e (D^2 - a b) + n_x D (a + b))).
// x is turned so that b is the higher end; if a is below the horizon, the line begins at b - height / n_x.
// `doubtful`: points on the line or its continuation, and what leaves the range of floats.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_line(D d, const PlacedLine& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), length = number(d, light.length);
  const Vector<V> first = towards(d, light.a, point.position), axis = numbers(d, light.axis);
  const V along = dot(first, axis), rise = dot(point.normal, axis), n_x = hn::Abs(rise);
  const Vector<V> off{hn::NegMulAdd(along, axis.x, first.x), hn::NegMulAdd(along, axis.y, first.y), hn::NegMulAdd(along, axis.z, first.z)};
  const V across2 = dot(off, off), per_across = inverse_sqrt(d, across2), across = hn::Mul(across2, per_across);
  const V n_e = hn::Mul(dot(point.normal, off), per_across);
  const V low_end = hn::IfThenElse(hn::Lt(rise, zero), hn::Neg(hn::Add(along, length)), along), b = hn::Add(low_end, length);
  const V low_height = hn::MulAdd(across, n_e, hn::Mul(low_end, n_x)), height = hn::MulAdd(across, n_e, hn::Mul(b, n_x));
  const V part = hn::IfThenElse(hn::Lt(low_height, zero), hn::Min(hn::Div(height, n_x), length), length), a = hn::Sub(b, part);
  const V a_b = hn::Mul(a, b), a2 = hn::MulAdd(a, a, across2), b2 = hn::MulAdd(b, b, across2);
  const V angle = angle_of(d, hn::Mul(across, hn::Max(part, zero)), hn::Add(across2, a_b));
  const V bracket = hn::MulAdd(n_e, hn::Sub(across2, a_b), hn::Mul(hn::Mul(n_x, across), hn::Add(a, b)));
  const V sum = hn::MulAdd(n_e, angle, hn::Mul(hn::Mul(hn::Mul(across, part), inverse(d, hn::Mul(a2, b2))), bracket));
  const V value = hn::Mul(hn::Mul(sum, per_across), number(d, 0.5 / light.length * light.scale * light.scale));
  const V extent = hn::Add(hn::Abs(along), length), extent2 = hn::Mul(extent, extent);
  if constexpr (in_floats<D>) doubtful = hn::Or(hn::Lt(across2, hn::Mul(number(d, 1e-10), extent2)), hn::Gt(extent2, number(d, 1e16)));
  const M lit = hn::And(hn::Gt(height, zero), hn::Gt(across2, hn::Mul(number(d, in_floats<D> ? 0 : 1e-28), extent2)));
  const V most = number(d, static_cast<double>(hwy::HighestValue<float>()));
  return hn::IfThenElseZero(lit, hn::Min(hn::Max(value, zero), most));
}

struct LineKernel {
  const PlacedLine& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_line(d, light, point, doubtful);
  }
};
std::size_t OverLine(const PlacedLine& light, const PointBatch& points, std::span<float> values, float where_none) {
  return at_every_point(light.white, light.scale, points, values, where_none, LineKernel{light}, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverLine);

class LineBatch final : public LightBatch::Shape {
 public:
  explicit LineBatch(const Emitter& white) : white_(white), line_(std::get<LineEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> values, float where_none) const override {
    const Vec3d span = line_.b - line_.a;
    const double l = length(span), scale = unit_for(l);
    const PlacedLine light{Place((line_.a - points.origin) * scale), span / l, l * scale, scale, white_};
    return HWY_DYNAMIC_DISPATCH(OverLine)(light, points, values, where_none);
  }

 private:
  Emitter white_;
  LineEmitter line_;
};

}  // namespace

// Lengths whose square a float can say.
std::shared_ptr<const LightBatch::Shape> line_batch(const Emitter& white) {
  const auto& line = std::get<LineEmitter>(white.shape);
  const double l = length(line.b - line.a);
  if (!(l > 1e-15 && l < 1e15)) return nullptr;
  return std::make_shared<LineBatch>(white);
}

}  // namespace etendue::eval
#endif
