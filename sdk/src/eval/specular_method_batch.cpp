// Published methods for specular light at many points: each is a direction towards the light, a factor, and the alpha that D has there.
// What they are, and where they err: karis.cpp, drobot.cpp, eden.cpp, specular_methods.cpp.
#include "etendue/specular_method_batch.h"

#include "batch_error.h"
#include "light_batch.h"
#include "views.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "eval/specular_batch-inl.h"

#ifndef ETENDUE_SPECULAR_METHOD_BATCH_SHARED
#define ETENDUE_SPECULAR_METHOD_BATCH_SHARED
namespace etendue::eval {
enum class PublishedRule {
  punctual,
  covered_lobe,
  drobot_20,
  drobot_20_fitted,
  karis_10,
  karis_11,
  karis_14,
  karis_18,
  karis_19,
  karis_20,
  karis_20_mended,
  eden_sphere,
  eden_tube,
  eden_tube_mended,
};
// Lights from the batch's origin; sides and normals are directions.
struct PlacedRect {
  Place centre;
  Direction x, y, normal;
  float half_x, half_y;
};
struct PlacedDisk {
  Place centre;
  Direction normal;
  float radius;
};
struct PlacedSphere {
  Place centre;
  float radius;
};
struct PlacedTube {
  Place a, b;
  float radius;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// The light stands for a small one in that direction, of any length: BRDF times cosine there, D with `density_alpha`, times the factor.
struct SmallLight {
  Vector3 direction;
  Lanes factor, density_alpha;
};
struct LobeLanes {
  ViewFrame frame;
  Lanes alpha;
  Vector3 mirror() const { return {hn::Neg(frame.sine), number(0), frame.cosine}; }
  // `covered`: covered_lobe of specular_methods.cpp, the factor a solid angle.
  template <bool covered>
  HWY_INLINE Shares lit_by(const SmallLight& light) const {
    const Floats d;
    const Lanes zero = number(0), one = number(1), half = number(0.5f);
    const Vector3 l = unit(light.direction), sum = frame.view() + l;
    const Lanes across = hn::MulAdd(sum.x, sum.x, hn::Mul(sum.y, sum.y)), along2 = hn::Mul(sum.z, sum.z), total = hn::Add(across, along2);
    const Lanes alpha2 = hn::Mul(alpha, alpha);
    const auto root = [&](Lanes z) ETENDUE_INLINE_LAMBDA {
      const Lanes z2 = hn::Mul(z, z);
      return hn::Sqrt(hn::MulAdd(alpha2, hn::Sub(one, z2), z2));
    };
    const Lanes masked = hn::Mul(half, inverse(d, hn::MulAdd(l.z, root(frame.cosine), hn::Mul(frame.cosine, root(l.z)))));
    const Lanes seen_area = hn::Mul(l.z, masked);
    Lanes value;
    if constexpr (covered) {
      // v.h = |v + l| / 2 and n.h = (v + l).z / |v + l| leave no root.
      const Lanes over_z = inverse(d, sum.z), over_z2 = hn::Mul(over_z, over_z), bent = hn::Mul(total, over_z);
      const Lanes r2 = hn::Mul(hn::Mul(light.factor, number(static_cast<float>(0.5 / pi))), hn::Mul(bent, over_z2));
      const Lanes t = hn::Sub(hn::MulAdd(across, over_z2, alpha2), r2), rest = hn::Mul(hn::Mul(number(4), alpha2), r2);
      const Lanes length = hn::Sqrt(hn::MulAdd(t, t, rest)), longer = hn::Add(length, hn::Abs(t));
      const Lanes above = hn::IfThenElse(hn::Gt(t, zero), rest, hn::Mul(longer, longer));
      const Lanes share = hn::Div(hn::Mul(half, above), hn::Mul(length, longer));
      value = hn::Mul(share, hn::Min(hn::Mul(hn::Add(bent, bent), seen_area), one));
    } else {
      const Lanes a2 = hn::Mul(light.density_alpha, light.density_alpha), wide = hn::Mul(total, inverse(d, hn::MulAdd(a2, along2, across)));
      const Lanes density = hn::Mul(hn::Mul(a2, number(static_cast<float>(1 / pi))), hn::Mul(wide, wide));
      value = hn::Mul(hn::Mul(density, light.factor), seen_area);
    }
    const Lanes away = positive(hn::NegMulAdd(half, hn::Sqrt(total), one)), away2 = hn::Mul(away, away);
    const Lit lit = hn::And(hn::Gt(l.z, zero), hn::And(hn::Ge(value, zero), hn::Lt(value, number(1e30f))));
    const Lanes seen = hn::IfThenElseZero(lit, value), of_f90 = hn::Mul(seen, hn::Mul(away, hn::Mul(away2, away2)));
    return {hn::Sub(seen, of_f90), of_f90};
  }
};

// Up to a right angle, by the series.
HWY_INLINE Lanes sine_of(Lanes x) {
  const Lanes p = polynomial(Floats(), hn::Mul(x, x), std::array{1.0, -1 / 6.0, 1 / 120.0, -1 / 5040.0, 1 / 362880.0, -1 / 39916800.0});
  return hn::Mul(x, p);
}
HWY_INLINE Lanes cosine_of(Lanes x) { return sine_of(hn::Sub(number(static_cast<float>(pi / 2)), hn::Abs(x))); }
HWY_INLINE Lanes length_of(const Vector3& v) { return hn::Sqrt(dot(v, v)); }
HWY_INLINE Lanes square(Lanes x) { return hn::Mul(x, x); }

// Of a cone about the mirrored view: its half angle's tangent, infinite from a right angle on.
template <PublishedRule rule>
HWY_INLINE Lanes cone_tangent(Lanes alpha) {
  if constexpr (rule == PublishedRule::drobot_20) return hn::Div(sine_of(alpha), cosine_of(alpha));
  // fitted_cone of cones.h: twice the angle with that squared sine.
  const Lanes one = number(1), a2 = square(alpha);
  const Lanes sine2 = hn::Mul(number(static_cast<float>(0.6487212707001282)), hn::Div(a2, hn::Max(hn::Sub(one, a2), number(1e-9f))));
  const Lanes below = hn::NegMulAdd(number(2), sine2, one);
  const Lanes tangent = hn::Div(hn::Mul(number(2), hn::Sqrt(hn::Mul(sine2, positive(hn::Sub(one, sine2))))), hn::Max(below, number(1e-9f)));
  return hn::IfThenElse(hn::Gt(below, number(1e-9f)), tangent, number(1e18f));
}
// DiskOverlap of cones.h.
struct Overlap {
  Lanes share, middle;
};
HWY_INLINE Overlap disk_overlap(Lanes first, Lanes second, Lanes apart) {
  const Lanes smaller = hn::Min(first, second), outer = hn::Add(first, second);
  const Lanes from = hn::Max(hn::Neg(first), hn::Sub(apart, second)), to = hn::Min(first, hn::Add(apart, second));
  const Lanes x = saturate(hn::Div(hn::Sub(outer, apart), hn::Add(smaller, smaller)));
  return {hn::Mul(hn::Mul(x, x), hn::NegMulAdd(number(2), x, number(3))), hn::Mul(number(0.5f), hn::Add(from, to))};
}
// At the middle of an area of a flat light.
HWY_INLINE SmallLight small_area(const Vector3& middle, Lanes area, Lanes height, Lanes alpha) {
  const Lanes over = inverse_length(middle);
  return {middle, hn::Mul(hn::Mul(area, height), hn::Mul(over, hn::Mul(over, over))), alpha};
}
// Karis' point of a sphere.
HWY_INLINE Vector3 closest_to_ray(const Vector3& centre, Lanes radius, const Vector3& r) {
  const Vector3 to_ray = scaled(r, dot(centre, r)) - centre;
  return along(centre, to_ray, hn::Min(hn::Mul(radius, inverse_sqrt(Floats(), hn::Max(dot(to_ray, to_ray), number(1e-30f)))), number(1)));
}
// Eq 10.
HWY_INLINE Lanes widened(Lanes alpha, Lanes size, Lanes over_distance) {
  return saturate(hn::MulAdd(hn::Mul(number(1.0f / 3), size), over_distance, alpha));
}
HWY_INLINE Lanes falloff(const Vector3& point) { return inverse(Floats(), hn::Add(dot(point, point), number(1))); }
// Eden's.
HWY_INLINE Lanes between_alphas(Lanes alpha, Lanes radius, const Vector3& point) {
  return hn::Sqrt(hn::Mul(alpha, saturate(hn::MulAdd(hn::Mul(number(0.5f), radius), inverse_length(point), alpha))));
}
template <PublishedRule rule>
HWY_INLINE SmallLight small_light(const PlacedRect& rect, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(towards(d, rect.centre, position)), normal = lobe.frame(numbers(d, rect.normal));
  const Lanes height = hn::Neg(dot(centre, normal)), half_x = number(rect.half_x), half_y = number(rect.half_y);
  lit = hn::And(lit, hn::Gt(height, number(0)));
  if constexpr (rule == PublishedRule::punctual || rule == PublishedRule::covered_lobe) {
    return small_area(centre, number(4 * rect.half_x * rect.half_y), height, lobe.alpha);
  } else {
    const Vector3 x = lobe.frame(numbers(d, rect.x)), y = lobe.frame(numbers(d, rect.y)), mirror = lobe.mirror();
    const Lanes falling = hn::Neg(dot(mirror, normal)), distance = hn::Div(height, hn::Max(falling, number(1e-30f)));
    const Lanes half = hn::Mul(number(static_cast<float>(0.5 * std::sqrt(pi))), hn::Mul(distance, cone_tangent<rule>(lobe.alpha)));
    const Vector3 at = scaled(mirror, distance) - centre;
    const Lanes s = dot(at, x), t = dot(at, y);
    const Lanes s0 = hn::Max(hn::Neg(half_x), hn::Sub(s, half)), s1 = hn::Min(half_x, hn::Add(s, half));
    const Lanes t0 = hn::Max(hn::Neg(half_y), hn::Sub(t, half)), t1 = hn::Min(half_y, hn::Add(t, half));
    const Lanes width = hn::Sub(s1, s0), depth = hn::Sub(t1, t0), middle = number(0.5f);
    lit = hn::And(hn::And(lit, hn::Gt(falling, number(0))), hn::And(hn::Gt(width, number(0)), hn::Gt(depth, number(0))));
    return small_area(along(along(centre, x, hn::Mul(middle, hn::Add(s0, s1))), y, hn::Mul(middle, hn::Add(t0, t1))), hn::Mul(width, depth),
                      height, lobe.alpha);
  }
}

template <PublishedRule rule>
HWY_INLINE SmallLight small_light(const PlacedDisk& disk, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(towards(d, disk.centre, position)), normal = lobe.frame(numbers(d, disk.normal));
  const Lanes height = hn::Neg(dot(centre, normal)), radius = number(disk.radius), round = number(static_cast<float>(pi));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  if constexpr (rule == PublishedRule::punctual || rule == PublishedRule::covered_lobe) {
    return small_area(centre, hn::Mul(round, square(radius)), height, lobe.alpha);
  } else {
    const Vector3 mirror = lobe.mirror();
    const Lanes falling = hn::Neg(dot(mirror, normal)), distance = hn::Div(height, hn::Max(falling, number(1e-30f)));
    const Lanes cone = hn::Min(hn::Mul(distance, cone_tangent<rule>(lobe.alpha)), number(1e18f));
    const Vector3 across = scaled(mirror, distance) - centre;
    const Lanes apart = length_of(across);
    const Overlap overlap = disk_overlap(radius, cone, apart);
    lit = hn::And(hn::And(lit, hn::Gt(falling, number(0))), hn::Gt(overlap.share, number(0)));
    const Lanes area = hn::Mul(hn::Mul(overlap.share, round), square(hn::Min(radius, cone)));
    return small_area(along(centre, across, hn::Div(overlap.middle, hn::Max(apart, number(1e-30f)))), area, height, lobe.alpha);
  }
}

template <PublishedRule rule>
HWY_INLINE SmallLight small_light(const PlacedSphere& sphere, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(towards(d, sphere.centre, position));
  const Lanes radius = number(sphere.radius), over = inverse_length(centre), sine = hn::Mul(radius, over);
  const Lanes facing = hn::Mul(number(static_cast<float>(pi)), square(sine)), alpha = lobe.alpha;
  if constexpr (rule == PublishedRule::punctual || rule == PublishedRule::covered_lobe) return {centre, facing, alpha};
  if constexpr (rule == PublishedRule::karis_10) return {centre, facing, widened(alpha, radius, over)};
  const Vector3 mirror = lobe.mirror();
  if constexpr (rule == PublishedRule::drobot_20) {
    // In angles.
    const Vector3 axis = scaled(centre, over), across = along(mirror, axis, hn::Neg(dot(mirror, axis)));
    const Lanes half = angle_of(d, sine, hn::Sqrt(positive(hn::NegMulAdd(sine, sine, number(1))))), off = length_of(across);
    const Overlap overlap = disk_overlap(half, alpha, angle_of(d, off, dot(mirror, axis)));
    const Vector3 sideways = scaled(across, hn::Div(sine_of(overlap.middle), hn::Max(off, number(1e-20f))));
    const Lanes solid_angle = hn::Mul(number(static_cast<float>(4 * pi)), square(sine_of(hn::Mul(number(0.5f), hn::Min(half, alpha)))));
    lit = hn::And(hn::And(lit, hn::Gt(overlap.share, number(0))), hn::Lt(sine, number(1)));
    return {along(sideways, axis, cosine_of(overlap.middle)), hn::Mul(overlap.share, solid_angle), alpha};
  }
  const Vector3 point = closest_to_ray(centre, radius, mirror);
  if constexpr (rule == PublishedRule::eden_sphere) {
    const Lanes intensity = hn::Mul(number(static_cast<float>(pi)), square(radius));
    return {point, hn::Mul(intensity, falloff(point)), between_alphas(alpha, radius, point)};
  }
  if constexpr (rule == PublishedRule::karis_14)
    return {point, hn::Mul(facing, square(hn::Mul(alpha, inverse(d, widened(alpha, radius, over))))), alpha};
  return {point, facing, alpha};
}

template <PublishedRule rule>
HWY_INLINE SmallLight small_light(const PlacedTube& tube, const Vector3& position, const LobeLanes& lobe, Lit&) {
  const Floats d;
  const Lanes zero = number(0), two = number(2);
  const Vector3 a = lobe.frame(towards(d, tube.a, position)), b = lobe.frame(towards(d, tube.b, position)), span = b - a;
  const Lanes radius = number(tube.radius), span2 = dot(span, span), l = hn::Sqrt(span2), alpha = lobe.alpha;
  const Lanes intensity = hn::Mul(radius, hn::MulAdd(two, l, hn::Mul(number(static_cast<float>(pi)), radius)));
  if constexpr (rule == PublishedRule::punctual || rule == PublishedRule::covered_lobe) {
    const Vector3 centre = scaled(a + b, number(0.5f));
    return {centre, hn::Mul(intensity, inverse(d, dot(centre, centre))), alpha};
  } else {
    const Vector3 r = lobe.mirror();
    const Lanes r_a = dot(r, a), r_span = dot(r, span), a_span = dot(a, span), a2 = dot(a, a);
    Lanes t, below;
    if constexpr (rule == PublishedRule::karis_18) {
      below = hn::NegMulAdd(span2, r_a, hn::Mul(a_span, r_span));
      t = hn::NegMulAdd(a2, r_span, hn::Mul(a_span, r_a));
    } else {
      below = hn::NegMulAdd(r_span, r_span, span2);
      t = hn::MulSub(r_a, r_span, a_span);
    }
    t = hn::IfThenElseZero(hn::Ne(below, zero), saturate(hn::Div(t, below)));
    const Vector3 centre = along(a, span, t), point = closest_to_ray(centre, radius, r);
    const Lanes lengths = positive(hn::MulAdd(hn::Sqrt(a2), length_of(b), dot(a, b)));
    if constexpr (rule == PublishedRule::eden_tube || rule == PublishedRule::eden_tube_mended) {
      const Lanes cosines = saturate(hn::Mul(number(0.5f), hn::MulAdd(a.z, inverse_length(a), hn::Mul(b.z, inverse_length(b)))));
      Lanes factor = hn::Mul(hn::Mul(two, hn::Mul(intensity, cosines)), inverse(d, hn::Add(lengths, two)));
      factor = hn::Div(factor, hn::Mul(point.z, inverse_length(point)));
      if constexpr (rule == PublishedRule::eden_tube) factor = hn::Mul(factor, falloff(point));
      return {point, factor, between_alphas(alpha, radius, point)};
    }
    Lanes factor = hn::Div(hn::Mul(hn::Mul(number(4), radius), l), lengths);
    const Lanes over = inverse_length(centre);
    if constexpr (rule != PublishedRule::karis_19) factor = hn::Mul(factor, square(hn::Div(alpha, widened(alpha, radius, over))));
    if constexpr (rule == PublishedRule::karis_18 || rule == PublishedRule::karis_20_mended)
      factor = hn::Mul(factor, hn::Div(alpha, widened(alpha, l, over)));
    return {point, factor, alpha};
  }
}

// light(position, lobe, lit) gives the shares at every point. How many points are not finite.
template <class Light>
HWY_INLINE std::size_t over_points_and_views(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                                             float where_none, const Light& light) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d), count = of_f0.size();
  const PointBatch& s = points.surface;
  const std::array<const float*, 10> all{s.px.data(), s.py.data(),      s.pz.data(),      s.nx.data(),      s.ny.data(),
                                         s.nz.data(), points.vx.data(), points.vy.data(), points.vz.data(), points.alpha.data()};
  std::size_t without = 0;
  const auto step = [&](const std::array<const float*, 10>& in, std::size_t i, float* to, float* to_90) ETENDUE_INLINE_LAMBDA {
    const auto at = [&](std::size_t k) ETENDUE_INLINE_LAMBDA {
      return Vector3{hn::LoadU(d, in[k] + i), hn::LoadU(d, in[k + 1] + i), hn::LoadU(d, in[k + 2] + i)};
    };
    const Vector3 position = at(0), normal = at(3), view = at(6);
    const Lanes alpha = hn::LoadU(d, in[9] + i);
    const Lanes nothing = hn::Add(less_itself(position, normal), hn::Add(less_itself(view, view), hn::Sub(alpha, alpha)));
    const Lit valid = hn::Eq(nothing, number(0));
    const LobeLanes lobe{view_frame(normal, view), hn::Min(hn::Max(alpha, number(1e-4f)), number(1))};
    Lit lit = hn::Gt(lobe.frame.cosine, number(0));
    const Shares shares = light(position, lobe, lit);
    hn::StoreU(hn::IfThenElse(valid, hn::IfThenElseZero(lit, shares.of_f0), number(where_none)), d, to);
    hn::StoreU(hn::IfThenElse(valid, hn::IfThenElseZero(lit, shares.of_f90), number(where_none)), d, to_90);
    if (HWY_UNLIKELY(!hn::AllTrue(d, valid))) without += lanes - hn::CountTrue(d, valid);
  };
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) step(all, i, of_f0.data() + i, of_f90.data() + i);
  if (i < count) {
    // The last points stand in a vector of their own.
    HWY_ALIGN std::array<std::array<float, hn::MaxLanes(d)>, 12> last{};
    std::array<const float*, 10> in{};
    for (std::size_t k = 0; k < 10; ++k) {
      std::copy(all[k] + i, all[k] + count, last[k].begin());
      in[k] = last[k].data();
    }
    step(in, 0, last[10].data(), last[11].data());
    std::copy_n(last[10].begin(), count - i, of_f0.data() + i);
    std::copy_n(last[11].begin(), count - i, of_f90.data() + i);
  }
  return without;
}

using Of = std::span<float>;
// By that of the rules which `rule` is.
template <PublishedRule... rules, class Placed>
std::size_t by_rule(PublishedRule rule, const Placed& light, const SpecularPoints& points, Of of_f0, Of of_f90, float where_none) {
  std::size_t without = 0;
  const auto by = [&](auto of) {
    if (rule != of()) return;
    without = over_points_and_views(points, of_f0, of_f90, where_none,
                                    [&light](const Vector3& position, const LobeLanes& lobe, Lit& lit) ETENDUE_INLINE_LAMBDA {
                                      return lobe.template lit_by<decltype(of)::value == PublishedRule::covered_lobe>(
                                          small_light<decltype(of)::value>(light, position, lobe, lit));
                                    });
  };
  (by(std::integral_constant<PublishedRule, rules>()), ...);
  return without;
}
using enum PublishedRule;
std::size_t OverPublishedRect(PublishedRule rule, const PlacedRect& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, drobot_20, drobot_20_fitted>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedDisk(PublishedRule rule, const PlacedDisk& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, drobot_20, drobot_20_fitted>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedSphere(PublishedRule rule, const PlacedSphere& light, const SpecularPoints& points, Of of_f0, Of of_f90,
                                float none) {
  return by_rule<punctual, covered_lobe, drobot_20, karis_10, karis_11, karis_14, eden_sphere>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedTube(PublishedRule rule, const PlacedTube& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, karis_18, karis_19, karis_20, karis_20_mended, eden_tube, eden_tube_mended>(rule, light, points,
                                                                                                                     of_f0, of_f90, none);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverPublishedRect);
HWY_EXPORT(OverPublishedDisk);
HWY_EXPORT(OverPublishedSphere);
HWY_EXPORT(OverPublishedTube);

constexpr std::array<std::string_view, 14> all_names{
    "punctual", "covered-lobe", "drobot-1-20-mended", "drobot-1-20-fitted", "karis-10",    "karis-11-mended", "karis-14",
    "karis-18", "karis-19",     "karis-20",           "karis-20-mended",    "eden-sphere", "eden-tube",       "eden-tube-mended"};

template <class Shape>
bool takes(PublishedRule rule) {
  using enum PublishedRule;
  const auto is = [rule](std::initializer_list<PublishedRule> some) { return std::find(some.begin(), some.end(), rule) != some.end(); };
  if constexpr (std::is_same_v<Shape, SphereView>)
    return is({punctual, covered_lobe, drobot_20, karis_10, karis_11, karis_14, eden_sphere});
  else if constexpr (std::is_same_v<Shape, TubeView>)
    return is({punctual, covered_lobe, karis_18, karis_19, karis_20, karis_20_mended, eden_tube, eden_tube_mended});
  else
    return is({punctual, covered_lobe, drobot_20, drobot_20_fitted});
}

// From in front of a flat light.
std::optional<LightView> view_from_origin(const Emitter& emitter) {
  Emitter light = emitter;
  light.two_sided = false;
  return light_view(light, {});
}

}  // namespace

class SpecularMethodBatch::Light {
 public:
  explicit Light(const LightView& view) : view_(view) {}
  std::size_t over(PublishedRule rule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float none) const {
    const Vec3d& origin = points.surface.origin;
    const auto radius_of = [](double r) { return static_cast<float>(r); };
    if (const auto* rect = std::get_if<RectView>(&view_)) {
      const PlacedRect placed{Place(rect->centre - origin), Direction(rect->x),      Direction(rect->y),
                              Direction(rect->normal),      radius_of(rect->half_x), radius_of(rect->half_y)};
      return HWY_DYNAMIC_DISPATCH(OverPublishedRect)(rule, placed, points, of_f0, of_f90, none);
    }
    if (const auto* disk = std::get_if<DiskView>(&view_)) {
      const PlacedDisk placed{Place(disk->centre - origin), Direction(disk->normal), radius_of(disk->radius)};
      return HWY_DYNAMIC_DISPATCH(OverPublishedDisk)(rule, placed, points, of_f0, of_f90, none);
    }
    if (const auto* sphere = std::get_if<SphereView>(&view_)) {
      const PlacedSphere placed{Place(sphere->centre - origin), radius_of(sphere->radius)};
      return HWY_DYNAMIC_DISPATCH(OverPublishedSphere)(rule, placed, points, of_f0, of_f90, none);
    }
    const auto& tube = std::get<TubeView>(view_);
    const PlacedTube placed{Place(tube.a - origin), Place(tube.b - origin), radius_of(tube.radius)};
    return HWY_DYNAMIC_DISPATCH(OverPublishedTube)(rule, placed, points, of_f0, of_f90, none);
  }

 private:
  LightView view_;
};

std::span<const std::string_view> SpecularMethodBatch::names() { return all_names; }

Result<SpecularMethodBatch> SpecularMethodBatch::of(std::string_view method, const Emitter& emitter) {
  const auto found = std::find(all_names.begin(), all_names.end(), method);
  const auto place = static_cast<std::size_t>(found - all_names.begin());
  const auto view = emitter.pattern || is_window(emitter.window) || emitter.two_sided ? std::nullopt : view_from_origin(emitter);
  const bool is_taken =
      view && found != all_names.end() &&
      std::visit([&](const auto& shape) { return takes<std::decay_t<decltype(shape)>>(static_cast<PublishedRule>(place)); }, *view);
  if (!is_taken) return Error{"METHOD_SHAPE", std::string(method) + " has no vectors for this light", {}, {}, {}};
  return SpecularMethodBatch(place, std::make_shared<Light>(*view), emitter.radiance);
}

BatchOutcome SpecularMethodBatch::shares(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                                         float where_none) const {
  const PointBatch& s = points.surface;
  for (const std::span<const float>& in : {s.px, s.py, s.pz, s.nx, s.ny, s.nz, points.vx, points.vy, points.vz, points.alpha})
    if (in.size() != of_f0.size()) return batch_sizes_differ(in.size(), of_f0.size());
  if (of_f90.size() != of_f0.size()) return batch_sizes_differ(of_f0.size(), of_f90.size());
  return light_->over(static_cast<PublishedRule>(method_), points, of_f0, of_f90, where_none);
}

}  // namespace etendue::eval
#endif
