// Specular light of spheres, disks and suns at many points, by moments: their outlines are circles, of directions or in space, in four
// parts, and the horizon between the ends of what is above it.
#include "light_batch.h"
#include "specular_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_round_moments_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>
#include <type_traits>

#include "eval/specular_batch-inl.h"
#include "eval/specular_moments-inl.h"

#ifndef ETENDUE_SPECULAR_ROUND_MOMENTS_BATCH_SHARED
#define ETENDUE_SPECULAR_ROUND_MOMENTS_BATCH_SHARED
namespace etendue::eval {
enum class RoundShape { sphere, disk, sun };
struct RoundMoments {
  Place centre;
  float radius;         // of a sun the sine of its angle
  Direction direction;  // of a disk its normal, of a sun that to it
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// centre + rising cos s + onwards sin s, from its highest place on, counter-clockwise as it is seen.
struct Circle {
  Vector3 centre, rising, onwards;
  Lit upright, seen, doubtful;
};
// Of that radius about a unit axis that leads away from the point.
HWY_INLINE Circle circle_about(const Vector3& axis, const Vector3& centre, Lanes radius, Lit seen, Lit doubtful) {
  const Lanes level2 = hn::MulAdd(axis.x, axis.x, hn::Mul(axis.y, axis.y)), least = number(1e-12f);
  const Lanes over_level = inverse_sqrt(Floats(), hn::Max(level2, least));
  const Lit upright = hn::Lt(level2, least);
  const Lanes x = hn::IfThenElse(upright, number(1), hn::Mul(axis.x, over_level)),
              y = hn::IfThenZeroElse(upright, hn::Mul(axis.y, over_level));
  const Vector3 rising = unit({hn::Neg(hn::Mul(x, axis.z)), hn::Neg(hn::Mul(y, axis.z)), hn::Mul(level2, over_level)});
  return {centre, scaled(rising, radius), scaled(cross(axis, rising), radius), upright, seen, doubtful};
}

template <RoundShape shape>
HWY_INLINE Circle circle_of(const RoundMoments& light, const Vector3& position, const ViewFrame& frame) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), radius = number(light.radius);
  if constexpr (shape == RoundShape::disk) {
    const Vector3 centre = frame(towards(d, light.centre, position)), normal = frame(numbers(d, light.direction));
    const Lanes height = hn::Neg(dot(centre, normal)), distance2 = dot(centre, centre);
    const Lit front = light.white.two_sided ? hn::Ne(height, zero) : hn::Gt(height, zero);
    const Lanes over = inverse_sqrt(d, hn::MulAdd(radius, radius, distance2)), size = hn::Mul(radius, over);
    // Edge-on, at the rim, far away.
    const Lanes flat = hn::Mul(height, over), flat2 = hn::Mul(flat, flat);
    const Lanes inside = hn::MulSub(hn::Mul(distance2, over), over, hn::Mul(size, size));
    const Lanes to_rim2 = hn::MulAdd(hn::Mul(inside, inside), number(0.25f), flat2);
    const Lit edge = hn::Or(hn::Lt(flat2, number(1e-6f)), hn::Lt(to_rim2, number(1e-5f)));
    const Vector3 away = chosen(hn::Lt(height, zero), normal, opposite(normal));
    return circle_about(away, scaled(centre, over), size, front, hn::Or(edge, hn::Lt(size, number(0.5f * least_angle))));
  } else {
    Vector3 axis;
    Lanes sine = radius;
    if constexpr (shape == RoundShape::sun) {
      axis = frame(numbers(d, light.direction));
    } else {
      const Vector3 centre = frame(towards(d, light.centre, position));
      const Lanes over_distance = inverse_length(centre);
      axis = scaled(centre, over_distance), sine = hn::Mul(radius, over_distance);
    }
    const Lanes cosine = hn::Sqrt(positive(hn::NegMulAdd(sine, sine, one)));
    return circle_about(axis, scaled(axis, cosine), sine, hn::FirstN(d, hn::Lanes(d)),
                        hn::Or(hn::Lt(sine, number(0.5f * least_angle)), hn::Ge(sine, number(0.99999f))));
  }
}

template <RoundShape shape>
class RoundLobe {
 public:
  explicit RoundLobe(const RoundMoments& light) : light_(light) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const Floats d;
    const Lanes zero = number(0), one = number(1), half = number(0.5f);
    const ViewFrame frame = view_frame(normal, view);
    const Circle circle = circle_of<shape>(light_, position, frame);
    // The cosine of the angle from the highest place at which it meets the horizon; up to 1 it does.
    const Lanes height = circle.centre.z, cut = hn::Neg(hn::Div(height, hn::Max(circle.rising.z, number(1e-30f))));
    const Lanes reach = hn::IfThenElse(circle.upright, hn::Neg(hn::CopySign(one, height)), within(cut, one));
    const Lit set = hn::Ge(reach, one), whole = hn::Le(reach, hn::Neg(one));
    // Sines and cosines of a quarter of the reach and of three, by halving.
    const auto halved = [&](Lanes c) ETENDUE_INLINE_LAMBDA { return hn::Sqrt(positive(hn::MulAdd(half, c, half))); };
    const Lanes c2 = halved(reach), c1 = halved(c2), s1 = hn::Sqrt(positive(hn::NegMulAdd(c1, c1, one)));
    const Lanes tan_half = hn::Mul(s1, inverse(d, hn::Add(c1, one)));
    const Lanes s2 = hn::Mul(hn::Add(s1, s1), c1), c3 = hn::NegMulAdd(s2, s1, hn::Mul(c2, c1)), s3 = hn::MulAdd(s2, c1, hn::Mul(c2, s1));
    const Lanes s4 = hn::Mul(hn::Add(s2, s2), c2);

    const Lanes over_alpha = inverse(d, alpha);
    const auto at = [&](Lanes c, Lanes s) ETENDUE_INLINE_LAMBDA { return along(scaled(circle.rising, c), circle.onwards, s); };
    const auto part = [&](Lanes c, Lanes s) ETENDUE_INLINE_LAMBDA {
      if constexpr (shape == RoundShape::disk)
        return bent_rim(circle.centre, at(c, s), at(hn::Neg(s), c), tan_half, frame.view(), over_alpha);
      else
        return bent_arc(circle.centre, at(c, s), at(hn::Neg(s), c), tan_half, frame.view(), over_alpha);
    };
    const Vector3 begin = unit(circle.centre + at(reach, hn::Neg(s4))), end = unit(circle.centre + at(reach, s4));
    const std::array parts{part(c3, hn::Neg(s3)), part(c1, hn::Neg(s1)), part(c1, s1), part(c3, s3)};
    const Lit lit = hn::And(hn::And(hn::Gt(frame.cosine, zero), circle.seen), hn::Not(set));
    doubtful = hn::And(hn::And(hn::Gt(frame.cosine, zero), circle.seen), circle.doubtful);
    const Shares shares = by_moments(frame, alpha, begin, [&](MomentSums& sums) ETENDUE_INLINE_LAMBDA {
      add_sides(parts, std::array{lit, lit, lit, lit}, sums);
      const Lit cuts = hn::AndNot(whole, lit);
      if (!hn::AllFalse(d, cuts)) add_side(bent_side(end, begin, frame.view(), over_alpha), cuts, sums);
    });
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  const RoundMoments& light_;
};

std::size_t OverRoundMoments(const RoundMoments& light, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                             float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(SpecularRule::moments, light.white, points, index); };
  const auto with = [&](auto kernel) { return over_views(points, of_f0, of_f90, where_none, kernel, exact); };
  if (std::holds_alternative<SphereEmitter>(light.white.shape)) return with(RoundLobe<RoundShape::sphere>(light));
  if (std::holds_alternative<DiskEmitter>(light.white.shape)) return with(RoundLobe<RoundShape::disk>(light));
  return with(RoundLobe<RoundShape::sun>(light));
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverRoundMoments);

class RoundMomentsLight final : public SpecularBatch::Light {
 public:
  explicit RoundMomentsLight(const Emitter& white) : white_(white) {}
  std::size_t over(SpecularRule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    const auto over = [&](const Vec3d& centre, double radius, const Vec3d& direction) {
      const RoundMoments light{Place(centre - points.surface.origin), static_cast<float>(radius), Direction(direction), white_};
      return HWY_DYNAMIC_DISPATCH(OverRoundMoments)(light, points, of_f0, of_f90, where_none);
    };
    if (const auto* sphere = std::get_if<SphereEmitter>(&white_.shape)) return over(sphere->centre, sphere->radius, {});
    if (const auto* sun = std::get_if<DistantEmitter>(&white_.shape)) return over({}, std::sin(sun->radius_rad), sun->towards);
    const auto& disk = std::get<DiskEmitter>(white_.shape);
    return over(disk.centre, disk.radius, disk.normal);
  }

 private:
  Emitter white_;
};

}  // namespace

std::shared_ptr<const SpecularBatch::Light> specular_round_moments(SpecularRule rule, const Emitter& white) {
  return rule == SpecularRule::moments && is_round(white) ? std::make_shared<RoundMomentsLight>(white) : nullptr;
}

}  // namespace etendue::eval
#endif
