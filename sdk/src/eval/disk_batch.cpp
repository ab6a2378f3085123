// The disk at many points, tilted and over the horizon: the closed form of its rim, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/disk_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_DISK_BATCH_SHARED
#define ETENDUE_DISK_BATCH_SHARED
namespace etendue::eval {
struct PlacedDisk {
  Place centre;
  Vec3d normal;
  double radius;  // in units of the batch, as the centre
  double scale;   // units a metre
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// Seen from the point, which is at the height h over the disk's plane, let C be the centre, R the radius, c the distance of the centre from
// the point's foot, and
//     k = |C|^2 - R^2,  m = |C|^2 + R^2,  w = sqrt(k^2 + 4 R^2 h^2).
// On the rim |b|^2 = m + 2 R c cos s, which is (1 + 2 b cos s + b^2) c R / b with b = 2 R c / (m + w). So Lambert's 1/2 n.(b x b') / |b|^2
// has the integral (see rim_integral in contour.cpp)
//     1/4 { V (ds + e) - n_a e + h n_g (c_g e - c_t l) / c^2 },   V = (n_a (1 - k / w) + 4 R^2 h n.c / (w (m + w))),
// where e - i l = 2 i ln(1 + b exp(i s)) is taken between both ends, n_a = -n.normal, n_g is the length of the rest of n, which points
// along g in the disk's plane, and c_g, c_t are the components of the foot's distance along g and across it. All of the rim: 2 pi V / 4.
// Cut by the horizon, the rim ends at g = s0 = -n.C / n_g, at +-a across, a^2 = R^2 - s0^2, and the chord between both adds half the angle
// that it is seen under. With D = h / n_g its distance and v = D^2 + c_t^2 + a^2 + w the difference of the complex logarithms has the angle
// of
//     (v^2 / 4 + c_t^2 s0^2 - c^2 a^2,  a (c_g v + 2 c_t^2 s0)),
// whose first part does not cancel, and its modulus is the ratio of both ends' squared distances, D^2 + (c_t +- a)^2.
// `doubtful`: close to the rim, within the disk's plane, and far lights that the horizon cuts, whose terms cancel.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_disk(D d, const PlacedDisk& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), one = number(d, 1), radius = number(d, light.radius), r2 = hn::Mul(radius, radius);
  const Vector<V> centre = towards(d, light.centre, point.position);
  Vector<V> facing = numbers(d, light.normal);
  V height = hn::Neg(dot(centre, facing));
  if (light.white.two_sided) {
    const V side = hn::CopySign(one, height);
    facing = {hn::Mul(facing.x, side), hn::Mul(facing.y, side), hn::Mul(facing.z, side)};
    height = hn::Abs(height);
  }
  const Vector<V>& n = point.normal;
  const V n_a = hn::Neg(dot(n, facing)), up = dot(n, centre), d2 = dot(centre, centre), h2 = hn::Mul(height, height);
  const Vector<V> rest{hn::MulAdd(n_a, facing.x, n.x), hn::MulAdd(n_a, facing.y, n.y), hn::MulAdd(n_a, facing.z, n.z)};
  const V n_g2 = dot(rest, rest), reach2 = hn::Mul(r2, n_g2), k = hn::Sub(d2, r2), m = hn::Add(d2, r2);
  const auto cut = hn::Lt(hn::Mul(up, up), reach2);
  const auto lit = hn::And(hn::Gt(height, zero), hn::Or(cut, hn::Gt(up, zero)));
  if constexpr (in_floats<D>) {
    const auto edge_on = hn::Lt(h2, hn::Mul(number(d, 5e-4), d2));
    const auto far = hn::Gt(d2, hn::IfThenElse(cut, hn::Mul(number(d, 50), r2), number(d, 1e16)));
    const auto at_rim = hn::Lt(hn::MulAdd(k, k, hn::Mul(hn::Mul(number(d, 4), r2), h2)), hn::Mul(number(d, 0.01), hn::Mul(r2, r2)));
    // Which side an edge-on disk shows is not known either.
    doubtful = hn::And(hn::Or(cut, hn::Gt(up, zero)), hn::Or(edge_on, hn::And(lit, hn::Or(far, at_rim))));
  }
  const V four_r2h = hn::Mul(hn::Mul(number(d, 4), r2), height), four_r2h2 = hn::Mul(four_r2h, height);
  const V w = hn::Sqrt(hn::MulAdd(k, k, four_r2h2)), sum = hn::Add(w, hn::Abs(k)), y = hn::Div(number(d, 2), hn::Add(m, w));
  // w - k, as (w^2 - k^2) / (w + k) where it cancels.
  const V w_less_k = hn::IfThenElse(hn::Gt(k, zero), hn::Div(four_r2h2, sum), sum), n_c = hn::NegMulAdd(n_a, height, up);
  const V whole = hn::Div(hn::MulAdd(n_a, w_less_k, hn::Mul(hn::Mul(four_r2h, hn::Mul(number(d, 0.5), y)), n_c)), w);
  V value = hn::Mul(number(d, pi / 2), whole);
  const auto cut_and_lit = hn::And(cut, lit);
  if (!hn::AllFalse(d, cut_and_lit)) {
    const V n_g = hn::Sqrt(n_g2), inverse = hn::Div(one, n_g);
    const V c_g = hn::Mul(dot(rest, centre), inverse), c_t = hn::Mul(hn::Abs(dot(centre, cross(facing, n))), inverse);
    const V from = hn::Mul(height, inverse), s0 = hn::Neg(hn::MulAdd(n_a, from, c_g));
    const V a = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(radius, s0), hn::Add(radius, s0)), zero));
    const V a2 = hn::Mul(a, a), from2 = hn::Mul(from, from), c_t2 = hn::Mul(c_t, c_t), c2 = hn::MulAdd(c_g, c_g, c_t2);
    const V v = hn::Add(hn::Add(from2, c_t2), hn::Add(a2, w)), half_v = hn::Mul(number(d, 0.5), v), a_c_g = hn::Mul(a, c_g);
    const V x = hn::MulAdd(hn::Sub(half_v, a_c_g), hn::Add(half_v, a_c_g), hn::Mul(c_t2, hn::MulSub(s0, s0, a2)));
    const V sine = hn::Mul(a, hn::MulAdd(c_g, v, hn::Mul(hn::Mul(number(d, 2), c_t2), s0)));
    const V e = hn::Mul(number(d, -2), hn::CopySign(angle_of(d, hn::Abs(sine), x), sine));
    const V less = hn::Sub(c_t, a), more = hn::Add(c_t, a);
    const V l = log_ratio(d, hn::MulAdd(more, more, from2), hn::MulAdd(less, less, from2), hn::Mul(number(d, 4), hn::Mul(a, c_t)));
    const V turned = hn::MulAdd(number(d, 2), angle_of(d, a, s0), e);
    const V chord = angle_of(d, hn::Mul(hn::Add(a, a), from), hn::MulAdd(less, more, from2));
    // Straight over the centre nothing depends on g: any small c_g does.
    const auto centred = hn::Lt(c2, number(d, 1e-30));
    const V across = hn::IfThenElse(centred, hn::Mul(number(d, -4), hn::Mul(y, a)), hn::Div(hn::MulSub(c_g, e, hn::Mul(c_t, l)), c2));
    const V rim = hn::MulAdd(whole, turned, hn::MulSub(hn::Mul(height, n_g), across, hn::Mul(n_a, e)));
    const V part = hn::MulAdd(number(d, 0.25), rim, hn::Mul(number(d, 0.5), chord));
    value = hn::IfThenElse(cut_and_lit, part, value);
    if constexpr (in_floats<D>) {
      // The terms of a cut rim are of the order of the angle that it is seen under, whatever is left of them.
      const V per_d = near_inverse_sqrt(d, d2),
              solid_angle = hn::Mul(hn::Mul(number(d, pi), hn::Mul(r2, height)), hn::Mul(per_d, hn::Mul(per_d, per_d)));
      const V allowed = hn::MulAdd(value, number(d, 7), hn::Mul(solid_angle, number(d, 1.4)));
      doubtful =
          hn::Or(doubtful, hn::And(cut_and_lit, hn::Lt(allowed, hn::Min(number(d, 0.25), hn::Mul(number(d, 0.5 * light.radius), per_d)))));
    }
  }
  return hn::IfThenElseZero(lit, hn::Max(value, zero));
}

struct DiskKernel {
  const PlacedDisk& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_disk(d, light, point, doubtful);
  }
};
std::size_t OverDisk(const PlacedDisk& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, DiskKernel{light});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverDisk);

class DiskBatch final : public LightBatch::Shape {
 public:
  explicit DiskBatch(const Emitter& white) : white_(white), disk_(std::get<DiskEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const double scale = unit_for(disk_.radius);
    const PlacedDisk light{Place((disk_.centre - points.origin) * scale), disk_.normal, disk_.radius * scale, scale, white_};
    return HWY_DYNAMIC_DISPATCH(OverDisk)(light, points, sr, where_none);
  }

 private:
  Emitter white_;
  DiskEmitter disk_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> disk_batch(const Emitter& white) { return std::make_shared<DiskBatch>(white); }

}  // namespace etendue::eval
#endif
