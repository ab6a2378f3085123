// covered.cpp in vectors, once for each instruction set: include it after HWY_TARGET_INCLUDE and hwy/foreach_target.h. Nothing is turned to
// the point's frame: a slope is (v + l) / n.(v + l) - n, in the plane across the normal. What differences are made of is exact to a few
// roundings, the rest to 12 bits.
#if defined(ETENDUE_SPECULAR_COVERED_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_COVERED_INL_H
#undef ETENDUE_SPECULAR_COVERED_INL_H
#else
#define ETENDUE_SPECULAR_COVERED_INL_H
#endif

#include "eval/specular_method-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// What the point sees of a light's place: v + l, its cosine from the normal, its square.
struct Halfway {
  Vector3 sum;
  Lanes rise, z, total;
  HWY_INLINE Halfway(const LobeLanes& lobe, const Vector3& l)
      : sum(lobe.eye + l), rise(dot(lobe.frame.z, l)), z(hn::Add(rise, lobe.frame.cosine)), total(dot(sum, sum)) {}
};
// 4 v.h / n.h n.l G2 / (4 n.v n.l), at most 1; `bent` is |v + l|^2 / n.(v + l). `between`: masked_between of covered.cpp.
template <bool between>
HWY_INLINE Lanes slow_part(const LobeLanes& lobe, const Halfway& at, Lanes bent) {
  const Lanes one = number(1), z = at.rise, twice = hn::Add(bent, bent);
  if constexpr (!between) return hn::Min(hn::Mul(twice, lobe.seen_area<true>(z)), one);
  const Lanes smooth = hn::Mul(z, lobe.frame.cosine), smooth2 = hn::Add(smooth, smooth);
  const Lanes below = hn::MulAdd(lobe.alpha, hn::Sub(at.z, smooth2), smooth2);
  return hn::Min(hn::Mul(hn::Mul(bent, z), rough_inverse(below)), one);
}

// ---- A disk ----

// A solid angle about a direction of any length.
struct SolidAngle {
  Vector3 direction;
  Lanes size;
};
HWY_INLINE SolidAngle flat_part(const Vector3& centre, Lanes area, Lanes height) {
  const Lanes distance2 = dot(centre, centre), below = hn::MulAdd(number(static_cast<float>(1 / pi)), area, distance2);
  return {centre, hn::Mul(hn::Mul(area, height), hn::Mul(near_inverse_sqrt(Floats(), distance2), rough_inverse(below)))};
}
HWY_INLINE SolidAngle covered_part(const PlacedRect& rect, const Vector3& position, const LobeLanes&, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, rect.centre, position);
  const Lanes height = hn::Neg(dot(centre, numbers(d, rect.normal)));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  return flat_part(centre, number(4 * rect.half_x * rect.half_y), height);
}
HWY_INLINE SolidAngle covered_part(const PlacedDisk& disk, const Vector3& position, const LobeLanes&, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, disk.centre, position);
  const Lanes height = hn::Neg(dot(centre, numbers(d, disk.normal)));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  return flat_part(centre, number(static_cast<float>(pi) * disk.radius * disk.radius), height);
}
HWY_INLINE Vector3 centre_of(const PlacedSphere& sphere, const Vector3& position) { return towards(Floats(), sphere.centre, position); }
HWY_INLINE Vector3 centre_of(const PlacedSun& sun, const Vector3&) { return numbers(Floats(), sun.towards); }
// Of a sphere what is above the horizon.
template <class Ball>
HWY_INLINE SolidAngle covered_part(const Ball& ball, const Vector3& position, const LobeLanes& lobe, Lit&) {
  const Lanes radius = number(ball.radius), half = number(0.5f);
  Vector3 centre = centre_of(ball, position);
  Lanes area = number(static_cast<float>(pi) * ball.radius * ball.radius);
  const Lanes high = dot(centre, lobe.frame.z);
  if (HWY_UNLIKELY(!hn::AllTrue(Floats(), hn::Ge(high, radius)))) {
    const Lanes low = positive(hn::Add(high, radius)), part = hn::Min(hn::Mul(number(0.5f / ball.radius), low), number(1));
    centre = along(centre, lobe.frame.z, hn::Sub(hn::Max(high, hn::Mul(half, low)), high));
    area = hn::Mul(hn::Mul(area, square(part)), hn::NegMulAdd(number(2), part, number(3)));
  }
  return {centre, hn::Mul(area, rough_inverse(dot(centre, centre)))};
}
HWY_INLINE SolidAngle covered_part(const PlacedTube& tube, const Vector3& position, const LobeLanes&, Lit&) {
  const Floats d;
  const Vector3 a = towards(d, tube.a, position), b = towards(d, tube.b, position), span = b - a;
  const Lanes length = near_root(dot(span, span)), radius = number(tube.radius);
  const Vector3 centre = scaled(a + b, number(0.5f));
  const Lanes intensity = hn::Mul(radius, hn::MulAdd(number(2), length, hn::Mul(number(static_cast<float>(pi)), radius)));
  return {centre, hn::Mul(intensity, rough_inverse(dot(centre, centre)))};
}
// disk_share of covered.cpp.
HWY_INLINE Lanes disk_share(Lanes off2, Lanes width2, Lanes r2) {
  const Lanes t = hn::Sub(hn::Add(off2, width2), r2), rest = hn::Mul(hn::Mul(number(4), width2), r2);
  const Lanes length2 = hn::Max(hn::MulAdd(t, t, rest), number(1e-30f)), over_length = near_inverse_sqrt(Floats(), length2);
  const Lanes longer = hn::MulAdd(length2, over_length, hn::Abs(t));
  const Lanes above = hn::IfThenElse(hn::Gt(t, number(0)), hn::Mul(rest, rough_inverse(longer)), longer);
  return hn::Mul(hn::Mul(number(0.5f), above), over_length);
}
HWY_INLINE Shares lit_by_disk(const LobeLanes& lobe, const SolidAngle& light) {
  const Vector3 l = unit(light.direction);
  const Halfway at(lobe, l);
  // v.h = |v + l| / 2 and n.h = n.(v + l) / |v + l| leave no root.
  const Vector3 across = along(at.sum, lobe.frame.z, hn::Neg(at.z));
  const Lanes alpha2 = square(lobe.alpha), over_z = rough_inverse(at.z), over_z2 = square(over_z), bent = hn::Mul(at.total, over_z);
  const Lanes r2 = hn::Mul(hn::Mul(light.size, number(static_cast<float>(0.5 / pi))), hn::Mul(bent, over_z2));
  const Lanes value = hn::Mul(disk_share(hn::Mul(dot(across, across), over_z2), alpha2, r2), slow_part<false>(lobe, at, bent));
  return LobeLanes::split(value, near_root(at.total), hn::Gt(at.rise, number(0)));
}

// ---- A strip ----

// From one direction to another, with their cosines from the normal; whether the horizon has cut some of it.
struct StripEnds {
  Vector3 to_a, to_b;
  Lanes rise_a, rise_b;
  bool cut;
};
// Where the lobe's mean on a strip is: l is the chord from a to b, `share` of the way, times over_chord; `onwards` is its step there,
// across l.
struct StripPlace {
  Lanes share, over_chord;
  Vector3 l, onwards;
  Halfway at;
  HWY_INLINE Lanes turned2() const {
    return hn::MulAdd(onwards.x, onwards.x, hn::MulAdd(onwards.y, onwards.y, hn::MulAdd(onwards.z, onwards.z, number(1e-12f))));
  }
};
// One over a distance that is linear in the share of the chord.
struct OverDistances {
  Lanes a, b;
  HWY_INLINE Lanes operator()(const StripPlace& place) const {
    return hn::Mul(hn::MulAdd(hn::Sub(b, a), place.share, a), place.over_chord);
  }
};

// A strip has ends and, at a place, a quarter of its width: a tube's over the length of `onwards`, and its ends are rounded; others' times
// that length. Others lie in the plane of the mirrored view, the nearest to which is so much of the way from a to b.
struct TubeStrip {
  StripEnds ends;
  OverDistances over;
  float radius;
  static constexpr bool rounded = true;
  HWY_INLINE Lanes quarter_width(const StripPlace& place) const {
    Lanes angle = hn::Mul(number(0.5f * radius), over(place));
    if (HWY_UNLIKELY(ends.cut)) angle = hn::Min(angle, hn::Mul(number(0.5f), place.at.rise));
    return hn::Mul(angle, near_inverse_sqrt(Floats(), place.turned2()));
  }
};
HWY_INLINE TubeStrip strip_of(const PlacedTube& tube, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), half = number(0.5f), radius = number(tube.radius);
  const Vector3& n = lobe.frame.z;
  Vector3 a = towards(d, tube.a, position), b = towards(d, tube.b, position);
  Lanes high_a = dot(a, n), high_b = dot(b, n);
  const bool cut = !hn::AllTrue(d, hn::Ge(hn::Min(high_a, high_b), radius));
  if (HWY_UNLIKELY(cut)) {
    // As far as something is above the horizon, and its middle there.
    const Lanes low_a = hn::Add(high_a, radius), low_b = hn::Add(high_b, radius), rise = hn::Sub(low_a, low_b);
    lit = hn::And(lit, hn::Gt(hn::Max(low_a, low_b), zero));
    const Vector3 crossing = along(a, b - a, hn::Mul(low_a, inverse(d, hn::IfThenElse(hn::Eq(rise, zero), one, rise))));
    const auto raise = [&](Vector3& end, Lanes& high, Lanes low) ETENDUE_INLINE_LAMBDA {
      const Lit set = hn::Lt(low, zero);
      const Lanes up = hn::Mul(half, positive(hn::Sub(hn::Add(radius, radius), hn::IfThenZeroElse(set, low))));
      end = along(chosen(set, crossing, end), n, up);
      high = hn::Add(hn::IfThenElse(set, hn::Neg(radius), high), up);
    };
    raise(a, high_a, low_a), raise(b, high_b, low_b);
  }
  const Lanes over_a = inverse_length(a), over_b = inverse_length(b);
  return {{scaled(a, over_a), scaled(b, over_b), hn::Mul(high_a, over_a), hn::Mul(high_b, over_b), cut}, {over_a, over_b}, tube.radius};
}

// In the plane of the mirrored view what is above the horizon of the line centre + half t, t from -1 to 1, which that meets at `met`: its
// share of the line.
struct MirroredLine {
  StripEnds ends;
  OverDistances over;
  Lanes nearest, left;
};
template <bool unit_ends>
HWY_INLINE MirroredLine mirrored_line(const Vector3& centre, const Vector3& half, Lanes met, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), high = dot(centre, lobe.frame.z), more = dot(half, lobe.frame.z);
  Lanes high_a = hn::Add(high, more), high_b = hn::Sub(high, more), t_a = one, t_b = one, left = one;
  const bool cut = !hn::AllTrue(d, hn::Ge(hn::Min(high_a, high_b), zero));
  if (HWY_UNLIKELY(cut)) {
    lit = hn::And(lit, hn::Gt(hn::Max(high_a, high_b), zero));
    // At high + more t = 0.
    const Lanes t = hn::Neg(hn::Mul(high, inverse(d, more)));
    t_a = hn::IfThenElse(hn::Lt(high_a, zero), t, one), t_b = hn::IfThenElse(hn::Lt(high_b, zero), hn::Neg(t), one);
    high_a = positive(high_a), high_b = positive(high_b), left = hn::Mul(number(0.5f), hn::Add(t_a, t_b));
  } else if constexpr (unit_ends) {
    const Lanes nearest = hn::NegMulAdd(number(0.5f), met, number(0.5f));
    return {{centre + half, centre - half, high_a, high_b, false}, {one, one}, nearest, one};
  }
  const Vector3 a = along(centre, half, t_a), b = along(centre, half, hn::Neg(t_b));
  const Lanes over_a = inverse_length(a), over_b = inverse_length(b);
  const Lanes of_b = hn::Mul(positive(hn::Sub(t_a, met)), over_a), of_a = hn::Mul(positive(hn::Add(t_b, met)), over_b);
  const Lanes nearest = hn::Mul(of_b, rough_inverse(hn::Add(of_a, of_b)));
  return {{scaled(a, over_a), scaled(b, over_b), hn::Mul(high_a, over_a), hn::Mul(high_b, over_b), cut}, {over_a, over_b}, nearest, left};
}
HWY_INLINE Vector3 mirrored(const LobeLanes& lobe) {
  return along(opposite(lobe.eye), lobe.frame.z, hn::Add(lobe.frame.cosine, lobe.frame.cosine));
}

// Of a sphere of directions a diameter, and as wide as leaves its area.
struct RoundStrip {
  StripEnds ends;
  Lanes nearest, quarter_angle;
  static constexpr bool rounded = false;
  HWY_INLINE Lanes quarter_width(const StripPlace& place) const {
    // On the lower side no farther than the horizon.
    const Lanes low = hn::Min(quarter_angle, hn::Mul(number(0.25f), place.at.rise));
    return hn::Mul(near_root(place.turned2()), hn::Add(quarter_angle, low));
  }
};
template <class Ball>
HWY_INLINE RoundStrip strip_of(const Ball& ball, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), one = number(1);
  const Vector3 centre = centre_of(ball, position), mirror = mirrored(lobe);
  const Lanes over = inverse_length(centre), sine = hn::Min(hn::Mul(number(ball.radius), over), one);
  const Vector3 l = scaled(centre, over);
  const Lanes along_l = dot(l, mirror), cosine = hn::Sqrt(hn::NegMulAdd(sine, sine, one));
  Vector3 side = along(mirror, l, hn::Neg(along_l));
  Lanes side2 = dot(side, side);
  const Lit within = hn::Lt(side2, number(1e-10f));
  if (HWY_UNLIKELY(!hn::AllFalse(d, within))) {
    // The mirrored view meets the centre: any diameter.
    const Lit steep = hn::Gt(hn::Abs(l.x), number(0.7f));
    const Vector3 axis{hn::IfThenZeroElse(steep, one), hn::IfThenElseZero(steep, one), zero};
    side = chosen(within, cross(l, axis), side);
    side2 = dot(side, side);
  }
  const Lanes over_side = inverse_sqrt(d, side2);
  // The tangent of the mirrored view's angle from the centre over that of the edge's.
  const Lanes met = hn::Mul(hn::Mul(hn::Mul(side2, over_side), cosine), rough_inverse(hn::Max(hn::Mul(along_l, sine), number(1e-20f))));
  const MirroredLine line = mirrored_line<true>(scaled(l, cosine), scaled(side, hn::Mul(sine, over_side)), hn::Min(met, one), lobe, lit);
  return {line.ends, line.nearest, hn::Mul(number(static_cast<float>(pi / 16)), sine)};
}

// A flat light's is as wide as leaves its area: of a solid angle area height / distance^3 there is, on the chord's way, as much as
// 1 / distance has there of both ends'.
struct FlatStrip {
  StripEnds ends;
  Lanes nearest;
  OverDistances over;
  Lanes quarter_volume;
  static constexpr bool rounded = false;
  HWY_INLINE Lanes quarter_width(const StripPlace& place) const {
    return hn::Mul(hn::Mul(quarter_volume, hn::Mul(over.a, over.b)), hn::Mul(over(place), place.over_chord));
  }
};
// From the centre to where the mirrored view meets the light's plane it is the way over `falling`, if that is positive.
struct WayToMirror {
  Vector3 way;
  Lanes falling;
};
HWY_INLINE WayToMirror way_to_mirror(const Vector3& centre, const Vector3& normal, const Vector3& x, Lanes height, const LobeLanes& lobe) {
  const Vector3 mirror = mirrored(lobe);
  const Lanes rising = dot(mirror, normal);
  return {along(along(scaled(mirror, height), centre, rising), scaled(x, number(1e-6f)), height), hn::Neg(rising)};
}
// `over` of the way is as far as the light goes.
HWY_INLINE FlatStrip flat_strip(const Vector3& centre, const WayToMirror& to, Lanes over, Lanes volume, const LobeLanes& lobe, Lit& lit) {
  const Lanes zero = number(0), one = number(1);
  const Lanes met = hn::IfThenElse(hn::Gt(to.falling, zero), hn::Min(rough_inverse(hn::Mul(over, to.falling)), one), one);
  const MirroredLine line = mirrored_line<false>(centre, scaled(to.way, over), met, lobe, lit);
  return {line.ends, line.nearest, line.over, hn::Mul(hn::Mul(number(0.25f), volume), line.left)};
}
HWY_INLINE FlatStrip strip_of(const PlacedRect& rect, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, rect.centre, position), normal = numbers(d, rect.normal), x = numbers(d, rect.x);
  const Lanes height = hn::Neg(dot(centre, normal));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  const WayToMirror to = way_to_mirror(centre, normal, x, height, lobe);
  const Lanes s = hn::Mul(hn::Abs(dot(to.way, x)), number(1 / rect.half_x));
  const Lanes t = hn::Mul(hn::Abs(dot(to.way, numbers(d, rect.y))), number(1 / rect.half_y));
  return flat_strip(centre, to, inverse(d, hn::Max(s, t)), hn::Mul(number(4 * rect.half_x * rect.half_y), height), lobe, lit);
}
HWY_INLINE FlatStrip strip_of(const PlacedDisk& disk, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, disk.centre, position), normal = numbers(d, disk.normal);
  const Lanes height = hn::Neg(dot(centre, normal));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  const WayToMirror to = way_to_mirror(centre, normal, numbers(d, disk.x), height, lobe);
  const Lanes over = hn::Mul(number(disk.radius), inverse_length(to.way));
  return flat_strip(centre, to, over, hn::Mul(number(static_cast<float>(pi) * disk.radius * disk.radius), height), lobe, lit);
}

// Twice s / sqrt(s^2 + w^2), a step of Newton's.
HWY_INLINE Lanes part(Lanes s, Lanes w2) {
  const Lanes square = hn::MulAdd(s, s, w2), guess = near_inverse_sqrt(Floats(), square);
  return hn::Mul(hn::Mul(s, guess), hn::NegMulAdd(hn::Mul(square, guess), guess, number(3)));
}
template <class Strip>
HWY_INLINE Shares lit_by_strip(const LobeLanes& lobe, const Strip& strip) {
  const Floats d;
  const Lanes zero = number(0), alpha2 = square(lobe.alpha), cosine = lobe.frame.cosine;
  const auto& [to_a, to_b, rise_a, rise_b, cut] = strip.ends;
  const Vector3 &n = lobe.frame.z, span = to_b - to_a;
  const Lanes z_a = hn::Add(rise_a, cosine), z_b = hn::Add(rise_b, cosine);
  const Vector3 from = scaled(lobe.eye + to_a, inverse(d, z_a)), to = scaled(lobe.eye + to_b, inverse(d, z_b));
  const Vector3 slope = from - n;
  Vector3 step = to - from;
  // Seen end-on its direction is the slope's.
  if constexpr (Strip::rounded) step = along(step, slope, number(1e-6f));
  const Lanes length2 = hn::MulAdd(step.x, step.x, hn::MulAdd(step.y, step.y, hn::MulAdd(step.z, step.z, number(1e-20f))));
  const Lanes over_length = near_inverse_sqrt(d, length2), behind = dot(slope, step);
  // The lobe's mean on the strip.
  const Lanes pull = hn::Mul(number(1.5f), alpha2);
  Lanes share;
  if constexpr (Strip::rounded) {
    const Lanes closest = hn::Min(positive(hn::Neg(behind)), length2);
    const Lanes of_b = hn::Mul(hn::Add(closest, pull), z_a), of_a = hn::Mul(hn::Add(hn::Sub(length2, closest), pull), z_b);
    share = hn::Mul(of_b, rough_inverse(hn::Add(of_a, of_b)));
  } else {
    share = hn::Mul(hn::MulAdd(strip.nearest, length2, pull), rough_inverse(hn::MulAdd(number(2), pull, length2)));
  }
  const Vector3 chord = along(to_a, span, share);
  const Lanes over_chord = inverse_length(chord);
  const Vector3 l = scaled(chord, over_chord);
  const Lanes backwards = hn::Neg(dot(l, span));
  const StripPlace place{share, over_chord, l, along(span, l, backwards), Halfway(lobe, l)};
  const Halfway& at = place.at;
  const Lanes over_z = inverse(d, at.z), bent = hn::Mul(at.total, over_z);
  // How slopes go with the strip's directions there.
  const Lanes rises = hn::MulAdd(backwards, at.rise, hn::Sub(z_b, z_a));
  const Vector3 go = along(place.onwards, at.sum, hn::Neg(hn::Mul(rises, over_z)));
  const Lanes gone2 = hn::MulAdd(go.x, go.x, hn::MulAdd(go.y, go.y, hn::MulAdd(go.z, go.z, number(1e-12f))));
  const Lanes aside = hn::Mul(near_inverse_sqrt(d, gone2), over_z);
  const Lanes quarter = hn::Mul(strip.quarter_width(place), aside);
  Lanes begin = hn::Mul(behind, over_length), end = hn::Mul(hn::Add(behind, length2), over_length);
  Lanes across, from_middle2 = alpha2;
  if constexpr (Strip::rounded) {
    const Lanes w = hn::Mul(quarter, hn::Mul(bent, place.turned2()));
    const Lanes longer = hn::Mul(number(static_cast<float>(pi / 2)), hn::Mul(quarter, gone2));
    begin = hn::Sub(begin, longer), end = hn::Add(end, longer);
    const Lanes beta = hn::Mul(dot(n, cross(at.sum, place.onwards)), aside);
    across = hn::Sub(part(hn::Add(beta, w), alpha2), part(hn::Sub(beta, w), alpha2));
    from_middle2 = hn::MulAdd(beta, beta, alpha2);
  } else {
    const Lanes w = hn::Mul(quarter, bent);
    across = hn::Mul(number(4), hn::Mul(w, near_inverse_sqrt(d, hn::MulAdd(w, w, alpha2))));
  }
  const Lanes wider2 = hn::Mul(number(static_cast<float>(pi * pi / 16)), from_middle2);
  const Lanes lengthwise = hn::Sub(part(end, wider2), part(begin, wider2));
  const Lanes value = hn::Mul(hn::Mul(across, lengthwise), hn::Mul(slow_part<!Strip::rounded>(lobe, at, bent), number(0.0625f)));
  return LobeLanes::split(value, near_root(at.total), hn::Gt(at.rise, zero));
}

// ---- The lobe's footprint ----

// The square of its width, as a tangent.
HWY_INLINE Lanes footprint2(const LobeLanes& lobe) { return hn::Mul(hn::Mul(number(4), square(lobe.alpha)), hn::Sqrt(lobe.frame.cosine)); }
// What the light has of it.
HWY_INLINE Lanes footprint_share(const PlacedRect& rect, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), half_x = number(rect.half_x), half_y = number(rect.half_y);
  const Vector3 centre = towards(d, rect.centre, position), normal = numbers(d, rect.normal), x = numbers(d, rect.x),
                y = numbers(d, rect.y);
  const Vector3 &n = lobe.frame.z, mirror = mirrored(lobe);
  const Lanes height = hn::Neg(dot(centre, normal)), falling = hn::Neg(dot(mirror, normal));
  const Lanes top = hn::MulAdd(half_x, hn::Abs(dot(n, x)), hn::MulAdd(half_y, hn::Abs(dot(n, y)), dot(n, centre)));
  lit = hn::And(hn::And(lit, hn::Gt(top, zero)), hn::And(hn::Gt(height, zero), hn::Gt(falling, zero)));
  const Lanes over = inverse(d, hn::Max(falling, number(1e-10f))), distance = hn::Mul(height, over);
  const Vector3 at = scaled(mirror, distance) - centre;
  const Lanes slant = hn::Mul(distance, over), width2 = footprint2(lobe), distance2 = square(distance);
  const auto seen = [&](const Vector3& side, Lanes half) ETENDUE_INLINE_LAMBDA {
    const Lanes off = dot(at, side), w2 = hn::Mul(width2, hn::MulAdd(square(dot(mirror, side)), square(slant), distance2));
    return hn::Sub(part(hn::Add(off, half), w2), part(hn::Sub(off, half), w2));
  };
  return hn::Mul(number(1.0f / 16), hn::Mul(seen(x, half_x), seen(y, half_y)));
}
template <class Ball>
HWY_INLINE Lanes footprint_share(const Ball& ball, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Lanes one = number(1);
  const Vector3 centre = centre_of(ball, position);
  const Lanes over = inverse_length(centre), sine = hn::Mul(number(ball.radius), over), sine2 = hn::Min(square(sine), one);
  const Vector3 l = scaled(centre, over), off = l - mirrored(lobe);
  lit = hn::And(lit, hn::Gt(hn::Add(dot(l, lobe.frame.z), sine), number(0)));
  const Lanes chord2 = hn::Mul(hn::Add(sine2, sine2), rough_inverse(hn::Add(one, hn::Sqrt(hn::Sub(one, sine2)))));
  return disk_share(dot(off, off), footprint2(lobe), chord2);
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
