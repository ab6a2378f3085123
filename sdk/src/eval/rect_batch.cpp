// The rectangle at many points: the edges' closed form in the light's own frame, cut at the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/rect_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/light_batch-inl.h"
#include "eval/rect_rules-inl.h"

#ifndef ETENDUE_RECT_BATCH_SHARED
#define ETENDUE_RECT_BATCH_SHARED
namespace etendue::eval {
// In units of the batch.
struct PlacedRect {
  Place centre;
  Direction x, y, normal;
  Constant half_x, half_y, area;
  Constant far2;  // the square of 4 longer sides: from there on 4 x 4 nodes are within a relative 1.6e-6 (far_light.h)
  double scale;   // units a metre
  const Emitter& white;
  PlacedRect(const Place& c, const Vec3d& along_x, const Vec3d& along_y, const Vec3d& n, double hx, double hy, double units,
             const Emitter& e)
      : centre(c),
        x(along_x),
        y(along_y),
        normal(n),
        half_x(hx),
        half_y(hy),
        area(4 * hx * hy),
        far2(4 * 4 * 4 * std::max(hx, hy) * std::max(hx, hy)),
        scale(units),
        white(e) {}
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

class RectKernel {
 public:
  static constexpr bool refuses_not_finite = true, linear_in_normal = true;
  explicit RectKernel(const PlacedRect& light) : light_(light) {}

  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    const Vector<V> c = towards(d, light_.centre, point.position), n = point.normal;
    const Vector<V> x = numbers(d, light_.x), y = numbers(d, light_.y), facing = numbers(d, light_.normal);
    const Framed<V> f{dot(c, x), dot(c, y),      dot(c, facing),           dot(n, x),
                      dot(n, y), dot(n, facing), number(d, light_.half_x), number(d, light_.half_y)};
    if constexpr (in_floats<D>) {
      const V distance2 = dot(c, c);
      if (hn::AllTrue(d, hn::Ge(distance2, number(d, light_.far2)))) return far_off(d, f, distance2, doubtful);
    }
    return close_by(d, f, doubtful);
  }

 private:
  template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
  HWY_INLINE M dark_side(D d, const Framed<V>& f) const {
    return light_.white.two_sided ? hn::FirstN(d, 0) : hn::Ge(f.z, hn::Zero(d));
  }
  template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
  HWY_INLINE V seen(D d, M dark, V value) const {
    return hn::IfThenZeroElse(dark, light_.white.two_sided ? hn::Abs(value) : hn::Max(value, hn::Zero(d)));
  }
  // The edges as they stand. An estimate of what roundings do to them, in units of 1e-6, aimed at .7 of LightBatch's bound; its factors are
  // no proof but were set by the search of tests/stress.
  template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
  HWY_INLINE V close_by(D d, const Framed<V>& f, M& doubtful) const {
    constexpr double rounding = in_floats<D> ? 1 : 1e-4;
    const EdgeSum<V> sum = by_edges(d, f);
    const V across = hn::Mul(hn::Abs(f.z), sum.farthest), per_r2 = hn::Mul(sum.farthest, sum.farthest);
    const V solid_angle = hn::Mul(hn::Mul(across, number(d, light_.area)), per_r2);
    const V allowed = hn::MulAdd(hn::Abs(sum.value), number(d, 7), hn::Mul(solid_angle, number(d, 1.4)));
    const V left = hn::NegMulAdd(sum.terms, number(d, 0.18 * rounding), allowed);
    const V corner = hn::MulSub(sum.nearest, number(d, 0.1 * rounding), hn::Mul(sum.farthest, number(d, 0.8 * rounding)));
    const V spare = hn::Mul(left, sum.farthest);
    const M enough = hn::And(hn::Le(hn::Max(corner, hn::Zero(d)), spare),
                             hn::Le(hn::Mul(hn::Abs(sum.value), number(d, 0.15 * rounding)), hn::Mul(spare, hn::Abs(f.z))));
    const M sure = hn::Ge(across, number(d, 1e-6 * rounding)), finite = hn::Lt(hn::Abs(sum.value), number(d, 4));
    const M dark = dark_side(d, f);
    doubtful = hn::Not(hn::And(hn::And(sure, finite), hn::Or(enough, dark)));
    return seen(d, dark, sum.value);
  }
  // Nodes, whose terms are all positive where the horizon does not cut the light. The height's rounding is all that counts: 3 of a float's
  // epsilons times the distance, 7e-6 of a height of .025 distances.
  template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
  HWY_INLINE V far_off(D d, const Framed<V>& f, V distance2, M& doubtful) const {
    const V up = hn::MulAdd(f.x, f.n_x, hn::MulAdd(f.y, f.n_y, hn::Mul(f.z, f.n_z)));
    const V spread = hn::MulAdd(hn::Abs(f.n_x), f.half_x, hn::Mul(hn::Abs(f.n_y), f.half_y));
    const V value = by_nodes(d, f, gauss4, [&](V square) ETENDUE_INLINE_LAMBDA { return inverse(d, square); });
    const M sure = hn::Ge(hn::Mul(f.z, f.z), hn::Mul(distance2, number(d, 0.025 * 0.025)));
    const M finite = hn::Lt(hn::Abs(up), number(d, 1e18)), enough = hn::Ge(hn::Abs(up), spread);
    const M dark = dark_side(d, f);
    doubtful = hn::Not(hn::And(hn::And(sure, finite), hn::Or(enough, dark)));
    return seen(d, dark, value);
  }

  const PlacedRect& light_;
};

std::size_t OverRect(const PlacedRect& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, RectKernel(light));
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverRect);

class RectBatch final : public LightBatch::Shape {
 public:
  RectBatch(const Emitter& white, const Vec3d& along_x, const Vec3d& along_y)
      : white_(white),
        first_(std::get<PolygonEmitter>(white.shape).vertices[0]),
        middle_((along_x + along_y) * 0.5),
        x_(normalised(along_x)),
        y_(normalised(along_y)),
        normal_(std::get<PolygonEmitter>(white.shape).normal),
        half_x_(length(along_x) / 2),
        half_y_(length(along_y) / 2),
        scale_(unit_for(std::max(half_x_, half_y_))) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const Place centre((first_ - points.origin + middle_) * scale_);
    return HWY_DYNAMIC_DISPATCH(OverRect)(PlacedRect(centre, x_, y_, normal_, half_x_ * scale_, half_y_ * scale_, scale_, white_), points,
                                          sr, where_none);
  }

 private:
  Emitter white_;
  Vec3d first_, middle_;  // the middle from the first corner: far from the origin their sum would be rounded
  Vec3d x_, y_, normal_;
  double half_x_, half_y_, scale_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> rect_batch(const Emitter& white) {
  const auto& v = std::get<PolygonEmitter>(white.shape).vertices;
  if (v.size() != 4) return nullptr;
  const Vec3d x = v[1] - v[0], y = v[3] - v[0], skew = v[2] - v[1] - y;
  const double area = length(x) * length(y);
  // Far from the origin corners are off by a double's rounding; where that shows, they are those of a polygon.
  constexpr double rounding = 1e-12;
  if (!(area > 0) || std::abs(dot(x, y)) > rounding * area) return nullptr;
  if (dot(skew, skew) > rounding * rounding * std::min(dot(x, x), dot(y, y))) return nullptr;
  return std::make_shared<RectBatch>(white, x, y);
}

}  // namespace etendue::eval
#endif
