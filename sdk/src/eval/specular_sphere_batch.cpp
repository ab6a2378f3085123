// Specular light of a sphere at many points, by moments: its outline is a circle of directions, in four parts, and the horizon between its
// ends.
#include "light_batch.h"
#include "specular_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_sphere_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/specular_batch-inl.h"
#include "eval/specular_moments-inl.h"

#ifndef ETENDUE_SPECULAR_SPHERE_BATCH_SHARED
#define ETENDUE_SPECULAR_SPHERE_BATCH_SHARED
namespace etendue::eval {
struct SpecularSphere {
  Place centre;
  float radius;
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

class SphereLobe {
 public:
  explicit SphereLobe(const SpecularSphere& light) : light_(light) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const Floats d;
    const Lanes zero = number(0), one = number(1), half = number(0.5f);
    const ViewFrame frame = view_frame(normal, view);
    const Vector3 centre = frame(towards(d, light_.centre, position));
    const Lanes distance2 = dot(centre, centre), over_distance = inverse_sqrt(d, distance2);
    const Vector3 axis = scaled(centre, over_distance);
    const Lanes sine = hn::Mul(number(light_.radius), over_distance), cosine = hn::Sqrt(positive(hn::NegMulAdd(sine, sine, one)));
    // From the highest direction of the circle it goes on across the axis.
    const Lanes level2 = hn::MulAdd(axis.x, axis.x, hn::Mul(axis.y, axis.y)), over_level = inverse_sqrt(d, hn::Max(level2, number(1e-12f)));
    const Lit upright = hn::Lt(level2, number(1e-12f));
    const Lanes cx = hn::IfThenElse(upright, one, hn::Mul(axis.x, over_level)),
                cy = hn::IfThenZeroElse(upright, hn::Mul(axis.y, over_level));
    const Vector3 rising = unit({hn::Neg(hn::Mul(cx, axis.z)), hn::Neg(hn::Mul(cy, axis.z)), hn::Mul(level2, over_level)});
    const Vector3 onwards = cross(axis, rising);
    // The cosine of the angle from there at which it meets the horizon; up to 1 it does.
    const Lanes cut = hn::Neg(hn::Mul(hn::Mul(axis.z, cosine), hn::Mul(inverse(d, sine), over_level)));
    const Lanes reach = hn::IfThenElse(upright, hn::Neg(hn::CopySign(one, axis.z)), within(cut, one));
    const Lit set = hn::Ge(reach, one), whole = hn::Le(reach, hn::Neg(one));
    // Sines and cosines of a quarter of the reach and of three, by halving.
    const auto halved = [&](Lanes c) ETENDUE_INLINE_LAMBDA { return hn::Sqrt(positive(hn::MulAdd(half, c, half))); };
    const Lanes c2 = halved(reach), c1 = halved(c2), s1 = hn::Sqrt(positive(hn::NegMulAdd(c1, c1, one)));
    const Lanes tan_half = hn::Mul(s1, inverse(d, hn::Add(c1, one)));
    const Lanes s2 = hn::Mul(hn::Add(s1, s1), c1), c3 = hn::NegMulAdd(s2, s1, hn::Mul(c2, c1)), s3 = hn::MulAdd(s2, c1, hn::Mul(c2, s1));
    const Lanes s4 = hn::Mul(hn::Add(s2, s2), c2);

    const Lanes over_alpha = inverse(d, alpha);
    const Vector3 middle = scaled(axis, cosine), out = scaled(rising, sine), on = scaled(onwards, sine);
    const auto at = [&](Lanes c, Lanes s) ETENDUE_INLINE_LAMBDA { return along(scaled(out, c), on, s); };
    const auto part = [&](Lanes c, Lanes s) ETENDUE_INLINE_LAMBDA {
      return bent_arc(middle, at(c, s), at(hn::Neg(s), c), tan_half, frame.view(), over_alpha);
    };
    const Vector3 begin = middle + at(reach, hn::Neg(s4)), end = middle + at(reach, s4);
    const std::array<Quadratic, 5> sides{part(c3, hn::Neg(s3)), part(c1, hn::Neg(s1)), part(c1, s1), part(c3, s3),
                                         bent_side(end, begin, frame.view(), over_alpha)};
    const Lit lit = hn::And(hn::Gt(frame.cosine, zero), hn::Not(set));
    const std::array<Lit, 5> seen{lit, lit, lit, lit, hn::AndNot(whole, lit)};
    doubtful = hn::Or(hn::And(lit, hn::Lt(sine, number(0.5f * least_angle))), hn::Ge(sine, number(0.99999f)));
    if (hn::AllTrue(d, hn::Or(whole, hn::Not(lit))))
      return by_moments(frame, alpha, begin, std::array{sides[0], sides[1], sides[2], sides[3]}, std::array{lit, lit, lit, lit});
    const Shares shares = by_moments(frame, alpha, begin, sides, seen);
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  const SpecularSphere& light_;
};

std::size_t OverSpecularSphere(const SpecularSphere& light, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                               float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(SpecularRule::moments, light.white, points, index); };
  return over_views(points, of_f0, of_f90, where_none, SphereLobe(light), exact);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverSpecularSphere);

class SphereLight final : public SpecularBatch::Light {
 public:
  explicit SphereLight(const Emitter& white) : white_(white) {}
  std::size_t over(SpecularRule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    const auto& sphere = std::get<SphereEmitter>(white_.shape);
    const SpecularSphere light{Place(sphere.centre - points.surface.origin), static_cast<float>(sphere.radius), white_};
    return HWY_DYNAMIC_DISPATCH(OverSpecularSphere)(light, points, of_f0, of_f90, where_none);
  }

 private:
  Emitter white_;
};

}  // namespace

std::shared_ptr<const SpecularBatch::Light> specular_sphere(SpecularRule rule, const Emitter& white) {
  const bool takes = rule == SpecularRule::moments && std::holds_alternative<SphereEmitter>(white.shape);
  return takes ? std::make_shared<SphereLight>(white) : nullptr;
}

}  // namespace etendue::eval
#endif
