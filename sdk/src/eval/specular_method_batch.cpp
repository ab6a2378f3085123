// Published methods for specular light at many points: each is a direction towards the light, a factor, and the alpha that D has there.
// What they are, and where they err: karis.cpp, drobot.cpp, eden.cpp, covered.cpp.
#include "etendue/specular_method_batch.h"

#include "batch_error.h"
#include "light_batch.h"
#include "specular_method_rules.h"
#include "specular_view.h"
#include "views.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "eval/specular_covered-inl.h"
#include "eval/specular_method-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

template <PublishedRule rule>
HWY_INLINE SmallLight small_light(const PlacedRect& rect, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(towards(d, rect.centre, position)), normal = lobe.frame(numbers(d, rect.normal));
  const Lanes height = hn::Neg(dot(centre, normal)), half_x = number(rect.half_x), half_y = number(rect.half_y);
  lit = hn::And(lit, hn::Gt(height, number(0)));
  if constexpr (rule == PublishedRule::punctual) {
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
  if constexpr (rule == PublishedRule::punctual) {
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

// A sun is a sphere at the distance 1.
template <PublishedRule rule, class Ball>
HWY_INLINE SmallLight small_light(const Ball& ball, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(centre_of(ball, position));
  const Lanes radius = number(ball.radius), over = inverse_length(centre), sine = hn::Mul(radius, over);
  const Lanes facing = hn::Mul(number(static_cast<float>(pi)), square(sine)), alpha = lobe.alpha;
  if constexpr (rule == PublishedRule::punctual) return {centre, facing, alpha};
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
  if constexpr (rule == PublishedRule::punctual) {
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

using Of = std::span<float>;
template <PublishedRule rule, class Placed>
HWY_INLINE Shares shares_by(const Placed& light, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  if constexpr (rule == PublishedRule::covered_strip)
    return lit_by_strip(lobe, strip_of(light, position, lobe, lit));
  else if constexpr (rule == PublishedRule::covered_lobe)
    return lit_by_disk(lobe, covered_part(light, position, lobe, lit));
  else
    return lobe.lit_by(small_light<rule>(light, position, lobe, lit));
}
// By that of the rules which `rule` is.
template <PublishedRule... rules, class Placed>
std::size_t by_rule(PublishedRule rule, const Placed& light, const SpecularPoints& points, Of of_f0, Of of_f90, float where_none) {
  std::size_t without = 0;
  const auto by = [&](auto of) {
    if (rule != of()) return;
    without = over_points_and_views(points, of_f0, of_f90, where_none,
                                    [&light](const Vector3& position, const LobeLanes& lobe, Lit& lit)
                                        ETENDUE_INLINE_LAMBDA { return shares_by<decltype(of)::value>(light, position, lobe, lit); });
  };
  (by(std::integral_constant<PublishedRule, rules>()), ...);
  return without;
}
using enum PublishedRule;
std::size_t OverPublishedRect(PublishedRule rule, const PlacedRect& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, covered_strip, drobot_20, drobot_20_fitted>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedDisk(PublishedRule rule, const PlacedDisk& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, covered_strip, drobot_20, drobot_20_fitted>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedSphere(PublishedRule rule, const PlacedSphere& light, const SpecularPoints& points, Of of_f0, Of of_f90,
                                float none) {
  return by_rule<punctual, covered_lobe, covered_strip, drobot_20, karis_10, karis_11, karis_14, eden_sphere>(rule, light, points, of_f0,
                                                                                                              of_f90, none);
}
std::size_t OverPublishedSun(PublishedRule rule, const PlacedSun& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, covered_strip, drobot_20, karis_10, karis_11, karis_14>(rule, light, points, of_f0, of_f90, none);
}
std::size_t OverPublishedTube(PublishedRule rule, const PlacedTube& light, const SpecularPoints& points, Of of_f0, Of of_f90, float none) {
  return by_rule<punctual, covered_lobe, covered_strip, karis_18, karis_19, karis_20, karis_20_mended, eden_tube, eden_tube_mended>(
      rule, light, points, of_f0, of_f90, none);
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
HWY_EXPORT(OverPublishedSun);
HWY_EXPORT(OverPublishedTube);

constexpr std::array<std::string_view, 24> all_names{
    "punctual",        "covered-lobe",    "covered-strip",    "drobot-1-20-mended", "drobot-1-20-fitted", "karis-10",
    "karis-11-mended", "karis-14",        "karis-18",         "karis-19",           "karis-20",           "karis-20-mended",
    "eden-sphere",     "eden-tube",       "eden-tube-mended", "frostbite-point",    "frostbite-16",       "frostbite-6",
    "eden-rect",       "karis-billboard", "karis-cone",       "ltc-line",           "ltc-line-ends",      "covered-footprint"};
// A sun by the sine of its angle.
struct SunView {
  Vec3d towards;
  double radius;
};
using MethodView = std::variant<RectView, DiskView, SphereView, TubeView, SunView>;

template <class Shape>
bool takes(PublishedRule rule) {
  using enum PublishedRule;
  const auto is = [rule](std::initializer_list<PublishedRule> some) { return std::find(some.begin(), some.end(), rule) != some.end(); };
  if constexpr (std::is_same_v<Shape, SphereView>)
    return is({punctual, covered_lobe, covered_strip, drobot_20, karis_10, karis_11, karis_14, eden_sphere, frostbite_point, frostbite_16,
               karis_cone, covered_footprint});
  else if constexpr (std::is_same_v<Shape, SunView>)
    return is({punctual, covered_lobe, covered_strip, drobot_20, karis_10, karis_11, karis_14, frostbite_6, karis_cone, covered_footprint});
  else if constexpr (std::is_same_v<Shape, TubeView>)
    return is({punctual, covered_lobe, covered_strip, karis_18, karis_19, karis_20, karis_20_mended, eden_tube, eden_tube_mended,
               frostbite_point, frostbite_16, ltc_line, ltc_line_ends});
  else if constexpr (std::is_same_v<Shape, RectView>)
    return is({punctual, covered_lobe, covered_strip, drobot_20, drobot_20_fitted, frostbite_point, frostbite_16, eden_rect,
               karis_billboard, covered_footprint});
  else
    return is({punctual, covered_lobe, covered_strip, drobot_20, drobot_20_fitted, frostbite_point, frostbite_16});
}

// Flat lights from in front.
std::optional<MethodView> view_from_origin(const Emitter& emitter) {
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape)) {
    if (!(sun->radius_rad > 0 && sun->radius_rad < 1.5)) return std::nullopt;
    return SunView{sun->towards, std::sin(sun->radius_rad)};
  }
  const std::optional<LightView> view = light_view(emitter, {});
  if (!view) return std::nullopt;
  return std::visit([](const auto& shape) { return MethodView(shape); }, *view);
}

}  // namespace

class SpecularMethodBatch::Light {
 public:
  explicit Light(const MethodView& view) : view_(view) {}
  std::size_t over(PublishedRule rule, const SpecularPoints& points, const MethodOutput& out) const {
    return std::visit([&](const auto& shape) { return over(rule, placed(shape, points.surface.origin), points, out); }, view_);
  }

 private:
  static float single(double r) { return static_cast<float>(r); }
  static PlacedRect placed(const RectView& rect, const Vec3d& origin) {
    return {Place(rect.centre - origin), Direction(rect.x),   Direction(rect.y),
            Direction(rect.normal),      single(rect.half_x), single(rect.half_y)};
  }
  static PlacedDisk placed(const DiskView& disk, const Vec3d& origin) {
    return {Place(disk.centre - origin), Direction(disk.normal), Direction(basis_around(disk.normal).tangent), single(disk.radius)};
  }
  static PlacedSphere placed(const SphereView& sphere, const Vec3d& origin) {
    return {Place(sphere.centre - origin), single(sphere.radius)};
  }
  static PlacedSun placed(const SunView& sun, const Vec3d&) { return {Direction(sun.towards), single(sun.radius)}; }
  static PlacedTube placed(const TubeView& tube, const Vec3d& origin) {
    return {Place(tube.a - origin), Place(tube.b - origin), single(tube.radius)};
  }
  template <class Placed>
  static std::size_t over(PublishedRule rule, const Placed& light, const SpecularPoints& points, const MethodOutput& out) {
    if (is_lit_method(rule)) return by_lit_method(rule, light, points, out);
    const auto call = [&](auto dispatched) { return dispatched(rule, light, points, out.of_f0, out.of_f90, out.where_none); };
    if constexpr (std::is_same_v<Placed, PlacedRect>) return call(HWY_DYNAMIC_DISPATCH(OverPublishedRect));
    if constexpr (std::is_same_v<Placed, PlacedDisk>) return call(HWY_DYNAMIC_DISPATCH(OverPublishedDisk));
    if constexpr (std::is_same_v<Placed, PlacedSphere>) return call(HWY_DYNAMIC_DISPATCH(OverPublishedSphere));
    if constexpr (std::is_same_v<Placed, PlacedSun>) return call(HWY_DYNAMIC_DISPATCH(OverPublishedSun));
    if constexpr (std::is_same_v<Placed, PlacedTube>) return call(HWY_DYNAMIC_DISPATCH(OverPublishedTube));
  }
  MethodView view_;
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
  return SpecularMethodBatch(place, std::make_shared<Light>(*view), luminance_of(emitter));
}

BatchOutcome SpecularMethodBatch::shares(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                                         float where_none) const {
  const PointBatch& s = points.surface;
  for (const std::span<const float>& in : {s.px, s.py, s.pz, s.nx, s.ny, s.nz, points.vx, points.vy, points.vz, points.alpha})
    if (in.size() != of_f0.size()) return batch_sizes_differ(in.size(), of_f0.size());
  if (of_f90.size() != of_f0.size()) return batch_sizes_differ(of_f0.size(), of_f90.size());
  return light_->over(static_cast<PublishedRule>(method_), points, {of_f0, of_f90, where_none});
}

}  // namespace etendue::eval
#endif
