// Published methods for specular light at many points that take a light's illuminance in one of its points, or a share of all that the lobe
// mirrors. What they are, and where they err: frostbite.cpp, eden.cpp, karis.cpp, hill_heitz.cpp.
#include "light_batch.h"
#include "specular_batch.h"
#include "specular_method_rules.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_lit_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>
#include <type_traits>

#include "eval/ltc-inl.h"
#include "eval/specular_covered-inl.h"
#include "eval/specular_method-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

using enum PublishedRule;

// ---- Illuminance ----

HWY_INLINE Lanes cosine_up(const Vector3& p) { return saturate(hn::Mul(p.z, inverse_length(p))); }

struct RectLanes {
  Vector3 centre, x, y, normal;
  Lanes half_x, half_y;
  Lanes height() const { return hn::Neg(dot(centre, normal)); }
  Vector3 at(Lanes s, Lanes t) const { return along(along(centre, x, s), y, t); }
  std::array<Vector3, 4> corners() const {
    const Lanes left = hn::Neg(half_x), low = hn::Neg(half_y);
    return {at(left, low), at(left, half_y), at(half_x, half_y), at(half_x, low)};
  }
  Vector3 closest(const Vector3& p) const {
    const Vector3 from = p - centre;
    return at(within(dot(from, x), half_x), within(dot(from, y), half_y));
  }
};
// Two triangles' (van Oosterom and Strackee 1983), from in front.
HWY_INLINE Lanes solid_angle(const std::array<Vector3, 4>& v) {
  const Floats d;
  const auto length = [](const Vector3& p) ETENDUE_INLINE_LAMBDA { return length_of(p); };
  const Lanes a = length(v[0]), c = length(v[2]);
  const auto triangle = [&](const Vector3& q, const Vector3& r, Lanes b_length, Lanes c_length) ETENDUE_INLINE_LAMBDA {
    const Vector3& p = v[0];
    const Lanes volume = hn::Abs(dot(p, cross(q - p, r - p)));
    const Lanes rest = hn::MulAdd(a, dot(q, r), hn::MulAdd(b_length, dot(r, p), hn::Mul(c_length, hn::MulAdd(a, b_length, dot(p, q)))));
    return angle_of(d, volume, rest);
  };
  const Lanes sum = hn::Add(triangle(v[1], v[2], length(v[1]), c), triangle(v[2], v[3], c, length(v[3])));
  return hn::Add(sum, sum);
}
// Listing 12.
HWY_INLINE Lanes illuminance(const RectLanes& rect) {
  const std::array<Vector3, 4> corners = rect.corners();
  Lanes sum = cosine_up(rect.centre);
  for (const Vector3& p : corners) sum = hn::Add(sum, cosine_up(p));
  return hn::Mul(solid_angle(corners), hn::Mul(sum, number(0.2f)));
}
// A cap of directions with the sine squared s2 of its half angle about an axis with the cosine `up` from the normal.
HWY_INLINE Lanes cap_above(Lanes up, Lanes s2) {
  const Floats d;
  const Lanes sine2 = hn::Min(s2, number(1)), sine = hn::Sqrt(sine2);
  const Lanes whole = hn::Mul(hn::Mul(number(static_cast<float>(pi)), sine2), positive(up));
  const Lit cut = hn::Lt(hn::Abs(up), sine);
  if (hn::AllFalse(d, cut)) return whole;
  return hn::IfThenElse(cut, cut_cap(d, up, sine, hn::Sqrt(hn::Sub(number(1), sine2))), whole);
}

// ---- The light's point ----

template <PublishedRule rule>
HWY_INLINE Vector3 direction_of(const LobeLanes& lobe) {
  const Vector3 mirror = lobe.mirror();
  if constexpr (rule != frostbite_16) return mirror;
  // Listing 16.
  const Vector3 bent = scaled(mirror, hn::Sub(number(1), lobe.alpha));
  return unit({bent.x, bent.y, hn::Add(bent.z, lobe.alpha)});
}
// Where a ray meets a plane, or below the point.
HWY_INLINE Vector3 on_plane(const Vector3& ray, const Vector3& normal, Lanes height) {
  const Lanes falling = hn::Neg(dot(ray, normal));
  const Vector3 met = scaled(ray, hn::Div(height, hn::Max(falling, number(1e-30f)))), foot = scaled(normal, hn::Neg(height));
  return chosen(hn::Gt(falling, number(0)), met, foot);
}
HWY_INLINE Shares lit_from(const Vector3& point, const LobeLanes& lobe, Lanes lux) {
  const Lanes cosine = hn::Mul(point.z, inverse_length(point));
  return lobe.lit_by({point, hn::Div(lux, cosine), lobe.alpha});
}
// The lobe's albedo, from the nodes of ltc_table().
HWY_INLINE Shares of_albedo(const LtcNodes& nodes, const LobeLanes& lobe, Lanes share) {
  const auto terms = between_nodes<1>(nodes.whole, nodes.size, lobe.alpha, lobe.frame.cosine);
  const Lanes kept = hn::IfThenElseZero(hn::Gt(share, number(0)), share);
  return {hn::Mul(terms[LtcNodes::albedo], kept), hn::Mul(terms[LtcNodes::albedo + 1], kept)};
}
HWY_INLINE Lanes tangent_of(Lanes x) { return hn::Div(sine_of(x), cosine_of(x)); }

HWY_INLINE RectLanes lanes_of(const PlacedRect& rect, const Vector3& position, const ViewFrame& frame) {
  const Floats d;
  return {frame(towards(d, rect.centre, position)), frame(numbers(d, rect.x)), frame(numbers(d, rect.y)),
          frame(numbers(d, rect.normal)),           number(rect.half_x),       number(rect.half_y)};
}
template <PublishedRule rule>
HWY_INLINE Shares lit_by_light(const PlacedRect& light, const Vector3& position, const LobeLanes& lobe, const LtcNodes& nodes, Lit& lit) {
  if constexpr (rule == covered_footprint) return of_albedo(nodes, lobe, footprint_share(light, position, lobe, lit));
  const Lanes zero = number(0), one = number(1);
  const RectLanes rect = lanes_of(light, position, lobe.frame);
  const Lanes height = rect.height();
  lit = hn::And(lit, hn::Gt(height, zero));
  if constexpr (rule == frostbite_point || rule == frostbite_16) {
    const Vector3 point = rect.closest(on_plane(direction_of<rule>(lobe), rect.normal, height));
    return lit_from(point, lobe, illuminance(rect));
  } else {
    const Vector3 mirror = lobe.mirror();
    const Lanes falling = hn::Neg(dot(mirror, rect.normal));
    lit = hn::And(lit, hn::Gt(falling, zero));
    const Lanes distance = hn::Div(height, hn::Max(falling, number(1e-30f)));
    const Vector3 at = scaled(mirror, distance);
    if constexpr (rule == eden_rect) {
      const Lanes smooth = hn::Sub(one, hn::Sqrt(lobe.alpha)), fades = hn::Mul(number(32), square(smooth));
      const Lanes left = hn::Sub(one, saturate(hn::Mul(length_of(at - rect.closest(at)), fades)));
      const Lanes value = hn::Mul(hn::Mul(left, falling), illuminance(rect));
      return {hn::IfThenElseZero(hn::Lt(value, number(1e30f)), value), zero};
    }
    // Karis' billboard.
    const Lanes half = hn::Mul(number(static_cast<float>(0.5 * std::sqrt(pi))), hn::Mul(distance, tangent_of(lobe.alpha)));
    const Vector3 from = at - rect.centre;
    const auto seen = [&](Lanes x, Lanes side) ETENDUE_INLINE_LAMBDA {
      const Lanes both = hn::Sub(hn::Min(hn::Add(x, half), side), hn::Max(hn::Sub(x, half), hn::Neg(side)));
      return hn::Div(positive(both), hn::Add(half, half));
    };
    return of_albedo(nodes, lobe, hn::Mul(seen(dot(from, rect.x), rect.half_x), seen(dot(from, rect.y), rect.half_y)));
  }
}

template <PublishedRule rule>
HWY_INLINE Shares lit_by_light(const PlacedDisk& disk, const Vector3& position, const LobeLanes& lobe, const LtcNodes&, Lit& lit) {
  const Floats d;
  const Vector3 centre = lobe.frame(towards(d, disk.centre, position)), normal = lobe.frame(numbers(d, disk.normal));
  const Lanes height = hn::Neg(dot(centre, normal)), radius = number(disk.radius), r2 = square(radius);
  lit = hn::And(lit, hn::Gt(height, number(0)));
  const Vector3 from = on_plane(direction_of<rule>(lobe), normal, height) - centre;
  const Lanes inwards = hn::Min(hn::Mul(radius, inverse_sqrt(d, hn::Max(dot(from, from), number(1e-30f)))), number(1));
  const Lanes distance2 = dot(centre, centre), over = inverse_sqrt(d, distance2);
  const Lanes lux = hn::Mul(cap_above(hn::Mul(centre.z, over), hn::Div(r2, hn::Add(r2, distance2))), hn::Mul(height, over));
  return lit_from(along(centre, from, inwards), lobe, lux);
}

// The cone intersection: what a sphere of directions takes of the lobe's cone.
HWY_INLINE Shares of_cone(const Vector3& centre, Lanes sine, const LobeLanes& lobe, const LtcNodes& nodes) {
  const Floats d;
  const Vector3 mirror = lobe.mirror(), across = cross(centre, mirror);
  const Lanes half = angle_of(d, sine, hn::Sqrt(positive(hn::NegMulAdd(sine, sine, number(1))))), cone = lobe.alpha;
  const Overlap overlap = disk_overlap(half, cone, angle_of(d, length_of(across), dot(centre, mirror)));
  const auto size = [](Lanes angle) ETENDUE_INLINE_LAMBDA { return square(sine_of(hn::Mul(number(0.5f), angle))); };
  const Lanes share = hn::Mul(overlap.share, hn::Div(size(hn::Min(half, cone)), size(cone)));
  return of_albedo(nodes, lobe, hn::IfThenElseZero(hn::Lt(sine, number(1)), share));
}
HWY_INLINE Lanes gathered(Lanes alpha, Lanes radius, Lanes over) { return hn::Div(alpha, widened(alpha, radius, over)); }
template <PublishedRule rule>
HWY_INLINE Shares lit_by_light(const PlacedSphere& sphere, const Vector3& position, const LobeLanes& lobe, const LtcNodes& nodes,
                               Lit& lit) {
  if constexpr (rule == covered_footprint) return of_albedo(nodes, lobe, footprint_share(sphere, position, lobe, lit));
  const Vector3 centre = lobe.frame(towards(Floats(), sphere.centre, position));
  const Lanes radius = number(sphere.radius), over = inverse_length(centre), sine = hn::Mul(radius, over);
  if constexpr (rule == karis_cone) {
    return of_cone(centre, sine, lobe, nodes);
  } else {
    const Lanes lux = hn::Mul(cap_above(hn::Mul(centre.z, over), square(sine)), square(gathered(lobe.alpha, radius, over)));
    return lit_from(closest_to_ray(centre, radius, direction_of<rule>(lobe)), lobe, lux);
  }
}
template <PublishedRule rule>
HWY_INLINE Shares lit_by_light(const PlacedSun& sun, const Vector3& position, const LobeLanes& lobe, const LtcNodes& nodes, Lit& lit) {
  if constexpr (rule == covered_footprint) return of_albedo(nodes, lobe, footprint_share(sun, position, lobe, lit));
  const Floats d;
  const Vector3 centre = lobe.frame(numbers(d, sun.towards)), mirror = lobe.mirror();
  const Lanes sine = number(sun.radius);
  if constexpr (rule == karis_cone) return of_cone(centre, sine, lobe, nodes);
  // Listing 6: its edge in the direction of the mirrored view.
  const Lanes cosine = dot(centre, mirror), distance = hn::Sqrt(positive(hn::NegMulAdd(sine, sine, number(1))));
  const Vector3 across = along(mirror, centre, hn::Neg(cosine));
  const Lanes outwards = hn::Mul(sine, inverse_sqrt(d, hn::Max(dot(across, across), number(1e-20f))));
  const Vector3 point = chosen(hn::Lt(cosine, distance), along(scaled(centre, distance), across, outwards), mirror);
  return lit_from(point, lobe, hn::Mul(hn::Mul(number(static_cast<float>(pi)), square(sine)), saturate(centre.z)));
}

// ---- Tubes ----

// line_form of hill_heitz.cpp, the primitive's differences written out.
HWY_INLINE Lanes line_form(Vector3 a, Vector3 b) {
  const Floats d;
  const Lanes zero = number(0);
  const Lit up = hn::Or(hn::Gt(a.z, zero), hn::Gt(b.z, zero));
  const auto raised = [&](const Vector3& low, const Vector3& high) ETENDUE_INLINE_LAMBDA {
    const Lanes part = hn::Div(low.z, hn::Sub(low.z, high.z));
    return chosen(hn::Lt(low.z, zero), along(low, high - low, part), low);
  };
  a = raised(a, b), b = raised(b, a);
  const Vector3 span = b - a;
  const Lanes over_length = inverse_sqrt(d, hn::Max(dot(span, span), number(1e-30f)));
  const Vector3 forwards = scaled(span, over_length);
  const Lanes from = dot(a, forwards), to = dot(b, forwards), length = hn::Mul(dot(span, span), over_length);
  const Vector3 foot = along(a, forwards, hn::Neg(from));
  const Lanes d2 = dot(foot, foot), over_d = inverse_sqrt(d, hn::Max(d2, number(1e-30f))), distance = hn::Mul(d2, over_d);
  const Lanes over_ends = hn::Div(length, hn::Mul(hn::MulAdd(from, from, d2), hn::MulAdd(to, to, d2)));
  const Lanes product = hn::Mul(from, to), angle = angle_of(d, hn::Mul(distance, length), hn::Add(d2, product));
  const Lanes moved = hn::Mul(hn::Mul(hn::Sub(d2, product), over_ends), over_d);
  const Lanes level = hn::MulAdd(angle, hn::Mul(over_d, over_d), moved);
  const Lanes rising = hn::Mul(hn::Mul(distance, over_ends), hn::Add(from, to));
  const Lanes value = hn::Mul(number(0.5f), hn::MulAdd(foot.z, level, hn::Mul(forwards.z, rising)));
  return hn::IfThenElseZero(hn::And(up, hn::Gt(d2, zero)), value);
}
// What the cofactors of the cosine's matrix make of a normal.
HWY_INLINE Vector3 cofactors(const Cosines& m, const Vector3& n) {
  const Lanes y = hn::MulSub(m.xx, m.zz, hn::Mul(m.xz, m.zx));
  return {hn::Mul(m.yy, hn::MulSub(m.zz, n.x, hn::Mul(m.zx, n.z))), hn::Mul(y, n.y),
          hn::Mul(m.yy, hn::MulSub(m.xx, n.z, hn::Mul(m.xz, n.x)))};
}
template <PublishedRule rule>
HWY_INLINE Shares by_line(const Vector3& a, const Vector3& b, Lanes radius, const LobeLanes& lobe, const LtcNodes& nodes) {
  const Floats d;
  const Lanes zero = number(0);
  const auto terms = between_nodes<1>(nodes.whole, nodes.size, lobe.alpha, lobe.frame.cosine);
  const Cosines m = transformed_cosine(terms.data(), lobe.alpha, lobe.frame);
  const Lanes det = hn::Abs(hn::Mul(m.yy, hn::MulSub(m.xx, m.zz, hn::Mul(m.xz, m.zx))));
  const Vector3 plane = cross(a, b - a);
  const Lanes plane2 = dot(plane, plane);
  const Vector3 sent = cofactors(m, scaled(plane, inverse_sqrt(d, hn::Max(plane2, number(1e-30f)))));
  const Lanes wider = hn::Mul(det, inverse_sqrt(d, hn::Max(dot(sent, sent), number(1e-30f))));
  const Lanes width = hn::Mul(hn::Mul(radius, number(static_cast<float>(2 / pi))), wider);
  Lanes share = hn::IfThenElseZero(hn::Gt(plane2, zero), hn::Mul(width, line_form(m(a), m(b))));
  if constexpr (rule == ltc_line_ends) {
    const Vector3 forwards = unit(b - a);
    const auto end = [&](const Vector3& at, Lanes inwards) ETENDUE_INLINE_LAMBDA {
      const Lanes over = inverse_length(at), over2 = square(over);
      const Vector3 seen = m(scaled(at, over));
      const Lanes squared = dot(seen, seen), density = hn::Div(hn::Mul(positive(seen.z), det), square(squared));
      return hn::Mul(hn::Mul(density, square(radius)), hn::Mul(hn::Mul(positive(inwards), over), over2));
    };
    share = hn::Add(share, hn::Add(end(a, dot(a, forwards)), end(b, hn::Neg(dot(b, forwards)))));
  }
  const Lanes kept = hn::IfThenElseZero(hn::Gt(share, zero), hn::Min(share, number(1)));
  return {hn::Mul(terms[LtcTable::albedo], kept), hn::Mul(terms[LtcTable::albedo + 1], kept)};
}
template <PublishedRule rule>
HWY_INLINE Shares lit_by_light(const PlacedTube& tube, const Vector3& position, const LobeLanes& lobe, const LtcNodes& nodes, Lit&) {
  const Floats d;
  const Lanes zero = number(0), radius = number(tube.radius);
  const Vector3 a = lobe.frame(towards(d, tube.a, position)), b = lobe.frame(towards(d, tube.b, position)), span = b - a;
  if constexpr (rule == ltc_line || rule == ltc_line_ends) {
    return by_line<rule>(a, b, radius, lobe, nodes);
  } else {
    const Vector3 r = direction_of<rule>(lobe);
    const Lanes span2 = dot(span, span), over_l = inverse_sqrt(d, span2), l = hn::Mul(span2, over_l), a_span = dot(a, span);
    // Listing 13: a facing rectangle, and a sphere at the axis' closest point.
    const Vector3 left = scaled(span, over_l), off = along(a, left, hn::Neg(dot(a, left))), forward = unit(off);
    const Lanes cylinder =
        illuminance({scaled(a + b, number(0.5f)), left, cross(left, forward), opposite(forward), hn::Mul(number(0.5f), l), radius});
    const Vector3 close = along(a, span, saturate(hn::Div(hn::Neg(a_span), span2)));
    const Lanes over_close = inverse_length(close), caps = square(hn::Mul(radius, over_close));
    const Lanes lux = hn::MulAdd(hn::Mul(number(static_cast<float>(pi)), caps), saturate(hn::Mul(close.z, over_close)), cylinder);
    // Karis' point.
    const Lanes r_span = dot(r, span), below = hn::NegMulAdd(r_span, r_span, span2);
    const Lanes t = hn::IfThenElseZero(hn::Gt(below, zero), saturate(hn::Div(hn::MulSub(dot(r, a), r_span, a_span), below)));
    const Vector3 centre = along(a, span, t);
    const Lanes over = inverse_length(centre);
    const Lanes both = hn::Mul(square(gathered(lobe.alpha, radius, over)), gathered(lobe.alpha, l, over));
    return lit_from(closest_to_ray(centre, radius, r), lobe, hn::Mul(lux, both));
  }
}

// By that of the rules which `rule` is.
template <PublishedRule... rules, class Placed>
std::size_t by_rule(PublishedRule rule, const Placed& light, const LtcNodes& nodes, const SpecularPoints& points, const MethodOutput& out) {
  std::size_t without = 0;
  const auto by = [&](auto of) {
    if (rule != of()) return;
    without = over_points_and_views(points, out.of_f0, out.of_f90, out.where_none,
                                    [&](const Vector3& position, const LobeLanes& lobe, Lit& lit) ETENDUE_INLINE_LAMBDA {
                                      return lit_by_light<decltype(of)::value>(light, position, lobe, nodes, lit);
                                    });
  };
  (by(std::integral_constant<PublishedRule, rules>()), ...);
  return without;
}
std::size_t OverLitRect(PublishedRule rule, const PlacedRect& light, const LtcNodes& nodes, const SpecularPoints& points,
                        const MethodOutput& out) {
  return by_rule<frostbite_point, frostbite_16, eden_rect, karis_billboard, covered_footprint>(rule, light, nodes, points, out);
}
std::size_t OverLitDisk(PublishedRule rule, const PlacedDisk& light, const LtcNodes& nodes, const SpecularPoints& points,
                        const MethodOutput& out) {
  return by_rule<frostbite_point, frostbite_16>(rule, light, nodes, points, out);
}
std::size_t OverLitSphere(PublishedRule rule, const PlacedSphere& light, const LtcNodes& nodes, const SpecularPoints& points,
                          const MethodOutput& out) {
  return by_rule<frostbite_point, frostbite_16, karis_cone, covered_footprint>(rule, light, nodes, points, out);
}
std::size_t OverLitSun(PublishedRule rule, const PlacedSun& light, const LtcNodes& nodes, const SpecularPoints& points,
                       const MethodOutput& out) {
  return by_rule<frostbite_6, karis_cone, covered_footprint>(rule, light, nodes, points, out);
}
std::size_t OverLitTube(PublishedRule rule, const PlacedTube& light, const LtcNodes& nodes, const SpecularPoints& points,
                        const MethodOutput& out) {
  return by_rule<frostbite_point, frostbite_16, ltc_line, ltc_line_ends>(rule, light, nodes, points, out);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(OverLitRect);
HWY_EXPORT(OverLitDisk);
HWY_EXPORT(OverLitSphere);
HWY_EXPORT(OverLitSun);
HWY_EXPORT(OverLitTube);

std::size_t by_lit_method(PublishedRule rule, const PlacedRect& light, const SpecularPoints& points, const MethodOutput& out) {
  return HWY_DYNAMIC_DISPATCH(OverLitRect)(rule, light, ltc_nodes(), points, out);
}
std::size_t by_lit_method(PublishedRule rule, const PlacedDisk& light, const SpecularPoints& points, const MethodOutput& out) {
  return HWY_DYNAMIC_DISPATCH(OverLitDisk)(rule, light, ltc_nodes(), points, out);
}
std::size_t by_lit_method(PublishedRule rule, const PlacedSphere& light, const SpecularPoints& points, const MethodOutput& out) {
  return HWY_DYNAMIC_DISPATCH(OverLitSphere)(rule, light, ltc_nodes(), points, out);
}
std::size_t by_lit_method(PublishedRule rule, const PlacedSun& light, const SpecularPoints& points, const MethodOutput& out) {
  return HWY_DYNAMIC_DISPATCH(OverLitSun)(rule, light, ltc_nodes(), points, out);
}
std::size_t by_lit_method(PublishedRule rule, const PlacedTube& light, const SpecularPoints& points, const MethodOutput& out) {
  return HWY_DYNAMIC_DISPATCH(OverLitTube)(rule, light, ltc_nodes(), points, out);
}

}  // namespace etendue::eval
#endif
