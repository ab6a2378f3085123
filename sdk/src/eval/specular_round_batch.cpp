// Specular light of spheres, disks and suns at many points by transformed cosines: their outlines are cones over ellipses, whatever the
// matrix.
#include "light_batch.h"
#include "specular_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_round_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>
#include <type_traits>

#include "eval/ltc_cone-inl.h"

#ifndef ETENDUE_SPECULAR_ROUND_BATCH_SHARED
#define ETENDUE_SPECULAR_ROUND_BATCH_SHARED
namespace etendue::eval {
enum class Round { sphere, disk, sun };
struct SpecularRound {
  Place centre;
  float radius;            // of a sun the sine of its angle
  Direction normal, x, y;  // of a disk; of a sun x is the direction to it
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// The cone, what of its lanes is seen at all, and those that floats are not enough for.
struct Outlook {
  Ellipse ellipse;
  RoundCone round;
  Lit crossed, is_up;  // the horizon cuts it; some of it is above
  Lit seen, doubtful;
};
// beside2: the squared height of what is highest beside the centre.
HWY_INLINE Outlook outlook(const Ellipse& ellipse, const RoundCone& round, Lanes beside2, Lit seen, Lit doubtful) {
  const Lanes z = ellipse.centre.z;
  const Lit crossed = hn::Lt(hn::Mul(z, z), beside2);
  return {ellipse, round, crossed, hn::Or(crossed, hn::Gt(z, number(0))), seen, doubtful};
}

// A cone of that angle about a unit axis.
HWY_INLINE Outlook outlook_along(const Vector3& axis, Lanes sine) {
  const Floats d;
  const Lanes one = number(1), cosine = hn::Sqrt(positive(hn::NegMulAdd(sine, sine, one)));
  // Any axes across it (Duff et al. 2017).
  const Lanes side = hn::CopySign(one, axis.z), f = hn::Neg(inverse(d, hn::Add(side, axis.z))), g = hn::Mul(hn::Mul(axis.x, axis.y), f);
  const Vector3 u{hn::MulAdd(hn::Mul(side, f), hn::Mul(axis.x, axis.x), one), hn::Mul(side, g), hn::Neg(hn::Mul(side, axis.x))};
  const Vector3 v{g, hn::MulAdd(f, hn::Mul(axis.y, axis.y), side), hn::Neg(axis.y)};
  const Lanes sine2 = hn::Mul(sine, sine);
  return outlook({scaled(axis, cosine), scaled(u, sine), scaled(v, sine)}, {axis, axis, sine2, hn::Mul(cosine, sine2)},
                 hn::Mul(sine2, hn::NegMulAdd(axis.z, axis.z, one)), hn::FirstN(d, hn::Lanes(d)),
                 hn::Or(hn::Lt(sine, number(0.5f * least_angle)), hn::Ge(sine, number(0.99999f))));
}
HWY_INLINE Outlook outlook_of_sphere(const SpecularRound& light, const Vector3& position, const ViewFrame& frame) {
  const Vector3 centre = frame(towards(Floats(), light.centre, position));
  const Lanes over_distance = inverse_length(centre);
  return outlook_along(scaled(centre, over_distance), hn::Mul(number(light.radius), over_distance));
}
HWY_INLINE Outlook outlook_of_disk(const SpecularRound& light, const Vector3& position, const ViewFrame& frame) {
  const Floats d;
  const Lanes zero = number(0);
  const Vector3 centre = towards(d, light.centre, position);
  const Lanes height = hn::Neg(dot(centre, numbers(d, light.normal))), r = number(light.radius), distance2 = dot(centre, centre);
  const Lanes over = inverse_sqrt(d, hn::MulAdd(r, r, distance2)), radius = hn::Mul(r, over);
  const Lit front = light.white.two_sided ? hn::Ne(height, zero) : hn::Gt(height, zero);
  // Edge-on, far away, at the rim.
  const Lanes flat = hn::Mul(height, over), inside = hn::MulSub(hn::Mul(distance2, over), over, hn::Mul(radius, radius));
  const Lanes flat2 = hn::Mul(flat, flat), to_rim2 = hn::MulAdd(hn::Mul(inside, inside), number(0.25f), flat2);
  const Lit doubtful =
      hn::Or(hn::Or(hn::Lt(flat2, number(1e-6f)), hn::Lt(to_rim2, number(1e-5f))), hn::Lt(radius, number(0.5f * least_angle)));
  const Lanes radius2 = hn::Mul(radius, radius);
  const Vector3 middle = frame(scaled(centre, over)), facing = frame(numbers(d, light.normal));
  return outlook({middle, frame(scaled(numbers(d, light.x), radius)), frame(scaled(numbers(d, light.y), radius))},
                 {middle, facing, radius2, hn::Mul(radius2, hn::Abs(flat))}, hn::Mul(radius2, hn::NegMulAdd(facing.z, facing.z, number(1))),
                 front, hn::And(doubtful, front));
}

template <Round shape>
HWY_INLINE Outlook outlook_of(const SpecularRound& light, const Vector3& position, const ViewFrame& frame) {
  if constexpr (shape == Round::sphere) return outlook_of_sphere(light, position, frame);
  if constexpr (shape == Round::disk) return outlook_of_disk(light, position, frame);
  return outlook_along(frame(numbers(Floats(), light.x)), number(light.radius));
}

template <SpecularRule rule, Round shape>
class RoundLobe {
 public:
  RoundLobe(const SpecularRound& light, const LtcNodes& nodes) : light_(light), nodes_(nodes) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const Lanes zero = number(0);
    const ViewFrame frame = view_frame(normal, view);
    const Outlook out = outlook_of<shape>(light_, position, frame);
    const Lit lit = hn::And(hn::And(hn::Gt(frame.cosine, zero), out.seen), out.is_up);
    doubtful = hn::And(out.doubtful, hn::Gt(frame.cosine, zero));
    const Shares shares = through(frame, alpha, out);
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  HWY_INLINE Shares through(const ViewFrame& frame, Lanes alpha, const Outlook& out) const {
    constexpr bool is_unit = shape != Round::disk;
    if constexpr (rule == SpecularRule::ltc_one_cosine) {
      return by_one_cosine(nodes_, frame, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA {
        return covered_uncut<is_unit>(cosines, out.ellipse, out.round, out.crossed);
      });
    } else {
      return by_cosines<rule != SpecularRule::ltc>(nodes_, frame, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA {
        if constexpr (rule == SpecularRule::ltc_two_caps) return covered_as_cap<is_unit>(cosines, out.round);
        return covered(cosines, out.ellipse, out.crossed);
      });
    }
  }

  const SpecularRound& light_;
  LtcNodes nodes_;
};

std::size_t OverSpecularRound(SpecularRule rule, const SpecularRound& light, const LtcNodes& nodes, const SpecularPoints& points,
                              std::span<float> of_f0, std::span<float> of_f90, float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(rule, light.white, points, index); };
  const auto with = [&](auto kernel) { return over_views(points, of_f0, of_f90, where_none, kernel, exact); };
  const auto by = [&](auto of) {
    if (std::holds_alternative<SphereEmitter>(light.white.shape)) return with(RoundLobe<of(), Round::sphere>(light, nodes));
    if (std::holds_alternative<DiskEmitter>(light.white.shape)) return with(RoundLobe<of(), Round::disk>(light, nodes));
    return with(RoundLobe<of(), Round::sun>(light, nodes));
  };
  if (rule == SpecularRule::ltc) return by(std::integral_constant<SpecularRule, SpecularRule::ltc>());
  if (rule == SpecularRule::ltc_one_cosine) return by(std::integral_constant<SpecularRule, SpecularRule::ltc_one_cosine>());
  if (rule == SpecularRule::ltc_two_lobes) return by(std::integral_constant<SpecularRule, SpecularRule::ltc_two_lobes>());
  return by(std::integral_constant<SpecularRule, SpecularRule::ltc_two_caps>());
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverSpecularRound);

class RoundLight final : public SpecularBatch::Light {
 public:
  explicit RoundLight(const Emitter& white) : white_(white) {}
  std::size_t over(SpecularRule rule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    return HWY_DYNAMIC_DISPATCH(OverSpecularRound)(rule, placed(points.surface.origin), ltc_nodes(), points, of_f0, of_f90, where_none);
  }

 private:
  SpecularRound placed(const Vec3d& origin) const {
    const auto light = [&](const Vec3d& centre, double radius, const Vec3d& normal, const Vec3d& x) {
      return SpecularRound{Place(centre - origin), static_cast<float>(radius),  Direction(normal),
                           Direction(x),           Direction(cross(normal, x)), white_};
    };
    if (const auto* sphere = std::get_if<SphereEmitter>(&white_.shape)) return light(sphere->centre, sphere->radius, {}, {});
    if (const auto* sun = std::get_if<DistantEmitter>(&white_.shape)) return light({}, std::sin(sun->radius_rad), {}, sun->towards);
    const auto& disk = std::get<DiskEmitter>(white_.shape);
    return light(disk.centre, disk.radius, disk.normal, disk.x);
  }

  Emitter white_;
};

}  // namespace

bool is_round(const Emitter& emitter) {
  const auto* sun = std::get_if<DistantEmitter>(&emitter.shape);
  return std::holds_alternative<SphereEmitter>(emitter.shape) || std::holds_alternative<DiskEmitter>(emitter.shape) ||
         (sun != nullptr && sun->radius_rad > 0 && sun->radius_rad < 1.5);
}

std::shared_ptr<const SpecularBatch::Light> specular_round(SpecularRule rule, const Emitter& white) {
  const bool has_vectors = rule != SpecularRule::moments && rule != SpecularRule::ltc_two_cosines;
  return is_round(white) && has_vectors ? std::make_shared<RoundLight>(white) : nullptr;
}

}  // namespace etendue::eval
#endif
