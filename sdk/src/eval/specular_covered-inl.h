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
HWY_INLINE SolidAngle covered_part(const PlacedRect& rect, const Vector3& position, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, rect.centre, position);
  const Lanes height = hn::Neg(dot(centre, numbers(d, rect.normal)));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  return flat_part(centre, number(4 * rect.half_x * rect.half_y), height);
}
HWY_INLINE SolidAngle covered_part(const PlacedDisk& disk, const Vector3& position, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, disk.centre, position);
  const Lanes height = hn::Neg(dot(centre, numbers(d, disk.normal)));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  return flat_part(centre, number(static_cast<float>(pi) * disk.radius * disk.radius), height);
}
HWY_INLINE Vector3 centre_of(const PlacedSphere& sphere, const Vector3& position) { return towards(Floats(), sphere.centre, position); }
HWY_INLINE Vector3 centre_of(const PlacedSun& sun, const Vector3&) { return numbers(Floats(), sun.towards); }
HWY_INLINE SolidAngle round_part(const Vector3& centre, float intensity) {
  return {centre, hn::Mul(number(intensity), rough_inverse(dot(centre, centre)))};
}
HWY_INLINE SolidAngle covered_part(const PlacedSphere& sphere, const Vector3& position, Lit&) {
  return round_part(towards(Floats(), sphere.centre, position), static_cast<float>(pi) * sphere.radius * sphere.radius);
}
HWY_INLINE SolidAngle covered_part(const PlacedSun& sun, const Vector3&, Lit&) {
  return {numbers(Floats(), sun.towards), number(static_cast<float>(pi) * sun.radius * sun.radius)};
}
HWY_INLINE SolidAngle covered_part(const PlacedTube& tube, const Vector3& position, Lit&) {
  const Floats d;
  const Vector3 a = towards(d, tube.a, position), b = towards(d, tube.b, position), span = b - a;
  const Lanes length = near_root(dot(span, span)), radius = number(tube.radius);
  const Vector3 centre = scaled(a + b, number(0.5f));
  const Lanes intensity = hn::Mul(radius, hn::MulAdd(number(2), length, hn::Mul(number(static_cast<float>(pi)), radius)));
  return {centre, hn::Mul(intensity, rough_inverse(dot(centre, centre)))};
}
HWY_INLINE Shares lit_by_disk(const LobeLanes& lobe, const SolidAngle& light) {
  const Floats d;
  const Vector3 l = unit(light.direction);
  const Halfway at(lobe, l);
  // v.h = |v + l| / 2 and n.h = n.(v + l) / |v + l| leave no root.
  const Vector3 across = along(at.sum, lobe.frame.z, hn::Neg(at.z));
  const Lanes alpha2 = square(lobe.alpha), over_z = rough_inverse(at.z), over_z2 = square(over_z), bent = hn::Mul(at.total, over_z);
  const Lanes r2 = hn::Mul(hn::Mul(light.size, number(static_cast<float>(0.5 / pi))), hn::Mul(bent, over_z2));
  const Lanes t = hn::Sub(hn::MulAdd(dot(across, across), over_z2, alpha2), r2), rest = hn::Mul(hn::Mul(number(4), alpha2), r2);
  const Lanes length2 = hn::Max(hn::MulAdd(t, t, rest), number(1e-30f)), over_length = near_inverse_sqrt(d, length2);
  const Lanes longer = hn::MulAdd(length2, over_length, hn::Abs(t));
  const Lanes above = hn::IfThenElse(hn::Gt(t, number(0)), hn::Mul(rest, rough_inverse(longer)), longer);
  const Lanes value = hn::Mul(hn::Mul(hn::Mul(number(0.5f), above), over_length), slow_part<false>(lobe, at, bent));
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

// A strip has ends() and broad(place), half its width there times the length of `onwards`; a rounded one caps(place), how far it goes on
// beyond its ends, over that length.
struct TubeStrip {
  StripEnds ends;
  OverDistances over;
  float radius;
  static constexpr bool rounded = true;
  HWY_INLINE Lanes angle(const StripPlace& place) const {
    const Lanes whole = hn::Mul(number(radius), over(place));
    return HWY_UNLIKELY(ends.cut) ? hn::Min(whole, place.at.rise) : whole;
  }
  HWY_INLINE Lanes caps(const StripPlace& place) const { return hn::Mul(angle(place), near_inverse_sqrt(Floats(), place.turned2())); }
  HWY_INLINE Lanes broad(const StripPlace& place) const { return hn::Mul(caps(place), place.turned2()); }
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

// Of a sphere of directions the diameter in the plane of the mirrored view, and as wide as leaves its area.
struct RoundStrip {
  StripEnds ends;
  Lanes angle;
  static constexpr bool rounded = false;
  HWY_INLINE Lanes broad(const StripPlace& place) const {
    const Lanes turned = near_root(place.turned2());
    // On the lower side no farther than the horizon.
    if (HWY_UNLIKELY(ends.cut)) return hn::Mul(turned, hn::Mul(number(0.5f), hn::Add(angle, hn::Min(angle, place.at.rise))));
    return hn::Mul(turned, angle);
  }
};
template <class Ball>
HWY_INLINE RoundStrip strip_of(const Ball& ball, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), cosine = lobe.frame.cosine;
  const Vector3 &n = lobe.frame.z, centre = centre_of(ball, position);
  const Lanes over = inverse_length(centre), sine = hn::Min(hn::Mul(number(ball.radius), over), one);
  const Vector3 l = scaled(centre, over), mirror = along(opposite(lobe.eye), n, hn::Add(cosine, cosine));
  Vector3 side = along(mirror, l, hn::Neg(dot(l, mirror)));
  Lanes side2 = dot(side, side);
  const Lit within = hn::Lt(side2, number(1e-10f));
  if (HWY_UNLIKELY(!hn::AllFalse(d, within))) {
    // The mirrored view meets the centre: any diameter.
    const Lit steep = hn::Gt(hn::Abs(l.x), number(0.7f));
    const Vector3 axis{hn::IfThenZeroElse(steep, one), hn::IfThenElseZero(steep, one), zero};
    side = chosen(within, cross(l, axis), side);
    side2 = dot(side, side);
  }
  const Vector3 middle = scaled(l, hn::Sqrt(hn::NegMulAdd(sine, sine, one))), half = scaled(side, hn::Mul(sine, inverse_sqrt(d, side2)));
  Vector3 a = middle + half, b = middle - half;
  Lanes rise_a = dot(a, n), rise_b = dot(b, n);
  const bool cut = !hn::AllTrue(d, hn::Ge(dot(l, n), sine));
  if (HWY_UNLIKELY(cut)) {
    lit = hn::And(lit, hn::Gt(hn::Max(rise_a, rise_b), zero));
    const Vector3 crossing = unit(scaled(a, hn::Abs(rise_b)) + scaled(b, hn::Abs(rise_a)));
    a = chosen(hn::Lt(rise_a, zero), crossing, a), b = chosen(hn::Lt(rise_b, zero), crossing, b);
    rise_a = positive(rise_a), rise_b = positive(rise_b);
  }
  return {{a, b, rise_a, rise_b, cut}, hn::Mul(number(static_cast<float>(pi / 4)), sine)};
}

// Of a flat light what the plane of its centre and the mirrored view cuts, and as wide as leaves its area: of a solid angle
// area height / distance^3 there is, on the chord's way, as much as 1 / distance has there of both ends'.
struct FlatStrip {
  StripEnds ends;
  OverDistances over;
  Lanes half_volume;
  static constexpr bool rounded = false;
  HWY_INLINE Lanes broad(const StripPlace& place) const {
    return hn::Mul(hn::Mul(half_volume, hn::Mul(over.a, over.b)), hn::Mul(over(place), place.over_chord));
  }
};
HWY_INLINE FlatStrip flat_strip(const Vector3& centre, const Vector3& half, Lanes half_volume, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), high = dot(centre, lobe.frame.z), more = dot(half, lobe.frame.z);
  Lanes high_a = hn::Add(high, more), high_b = hn::Sub(high, more), part_a = one, part_b = one;
  const bool cut = !hn::AllTrue(d, hn::Ge(hn::Min(high_a, high_b), zero));
  if (HWY_UNLIKELY(cut)) {
    lit = hn::And(lit, hn::Gt(hn::Max(high_a, high_b), zero));
    // At high + more t = 0.
    const Lanes t = hn::Neg(hn::Mul(high, inverse(d, more)));
    part_a = hn::IfThenElse(hn::Lt(high_a, zero), t, one), part_b = hn::IfThenElse(hn::Lt(high_b, zero), hn::Neg(t), one);
    high_a = positive(high_a), high_b = positive(high_b);
    half_volume = hn::Mul(half_volume, hn::Mul(number(0.5f), hn::Add(part_a, part_b)));
  }
  const Vector3 a = along(centre, half, part_a), b = along(centre, half, hn::Neg(part_b));
  const Lanes over_a = inverse_length(a), over_b = inverse_length(b);
  return {{scaled(a, over_a), scaled(b, over_b), hn::Mul(high_a, over_a), hn::Mul(high_b, over_b), cut}, {over_a, over_b}, half_volume};
}
// In the light's plane, from the centre to where the mirrored view meets it, or comes from: some multiple of it.
HWY_INLINE Vector3 towards_mirror(const Vector3& centre, const Vector3& normal, const Vector3& x, Lanes height, const LobeLanes& lobe) {
  const Vector3 mirror = along(opposite(lobe.eye), lobe.frame.z, hn::Add(lobe.frame.cosine, lobe.frame.cosine));
  return along(along(scaled(mirror, height), centre, dot(mirror, normal)), x, hn::Mul(number(1e-6f), height));
}
HWY_INLINE FlatStrip strip_of(const PlacedRect& rect, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, rect.centre, position), normal = numbers(d, rect.normal), x = numbers(d, rect.x);
  const Lanes height = hn::Neg(dot(centre, normal));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  const Vector3 way = towards_mirror(centre, normal, x, height, lobe);
  const Lanes s = hn::Mul(hn::Abs(dot(way, x)), number(1 / rect.half_x)),
              t = hn::Mul(hn::Abs(dot(way, numbers(d, rect.y))), number(1 / rect.half_y));
  return flat_strip(centre, scaled(way, inverse(d, hn::Max(s, t))), hn::Mul(number(2 * rect.half_x * rect.half_y), height), lobe, lit);
}
HWY_INLINE FlatStrip strip_of(const PlacedDisk& disk, const Vector3& position, const LobeLanes& lobe, Lit& lit) {
  const Floats d;
  const Vector3 centre = towards(d, disk.centre, position), normal = numbers(d, disk.normal);
  const Lanes height = hn::Neg(dot(centre, normal));
  lit = hn::And(lit, hn::Gt(height, number(0)));
  const Vector3 way = towards_mirror(centre, normal, numbers(d, disk.x), height, lobe);
  const Vector3 half = scaled(way, hn::Mul(number(disk.radius), inverse_length(way)));
  return flat_strip(centre, half, hn::Mul(number(static_cast<float>(0.5 * pi) * disk.radius * disk.radius), height), lobe, lit);
}

// Of the way from a to b where the mirrored view r meets their plane, or the end that is nearer: with p = r.a, q = r.b and c = a.b,
// r = ((p - c q) a + (q - c p) b) / (1 - c^2).
HWY_INLINE Lanes mirrored_share(const LobeLanes& lobe, const StripEnds& ends, const Vector3& span) {
  const Lanes twice = hn::Add(lobe.frame.cosine, lobe.frame.cosine), less = hn::Mul(number(0.5f), dot(span, span));
  const Lanes p = hn::MulSub(twice, ends.rise_a, dot(lobe.eye, ends.to_a)), q = hn::MulSub(twice, ends.rise_b, dot(lobe.eye, ends.to_b));
  const Lanes below = hn::Max(hn::Mul(hn::Add(p, q), less), number(1e-12f));
  return saturate(hn::Mul(hn::MulAdd(less, p, hn::Sub(q, p)), rough_inverse(below)));
}
template <class Strip>
HWY_INLINE Shares lit_by_strip(const LobeLanes& lobe, const Strip& strip) {
  const Floats d;
  const Lanes zero = number(0), alpha2 = square(lobe.alpha), cosine = lobe.frame.cosine;
  const auto& [to_a, to_b, rise_a, rise_b, cut] = strip.ends;
  const Vector3 &n = lobe.frame.z, span = to_b - to_a;
  const Lanes z_a = hn::Add(rise_a, cosine), z_b = hn::Add(rise_b, cosine);
  const Vector3 from = scaled(lobe.eye + to_a, inverse(d, z_a)), to = scaled(lobe.eye + to_b, inverse(d, z_b));
  // Seen end-on its direction is the slope's.
  const Vector3 slope = from - n, step = along(to - from, slope, number(1e-6f));
  const Lanes length2 = hn::MulAdd(step.x, step.x, hn::MulAdd(step.y, step.y, hn::MulAdd(step.z, step.z, number(1e-20f))));
  const Lanes over_length = near_inverse_sqrt(d, length2), behind = dot(slope, step);
  // The lobe's mean on the strip.
  const Lanes pull = hn::Mul(number(1.5f), alpha2);
  Lanes of_a, of_b;
  if constexpr (Strip::rounded) {
    const Lanes closest = hn::Min(positive(hn::Neg(behind)), length2);
    of_b = hn::Mul(hn::Add(closest, pull), z_a), of_a = hn::Mul(hn::Add(hn::Sub(length2, closest), pull), z_b);
  } else {
    const Lanes middle = hn::Mul(hn::Mul(number(0.5f), length2), hn::Add(z_a, z_b)),
                of_closest = hn::Mul(middle, mirrored_share(lobe, strip.ends, span));
    of_b = hn::MulAdd(pull, z_a, of_closest), of_a = hn::MulAdd(pull, z_b, hn::Sub(middle, of_closest));
  }
  const Lanes share = hn::Mul(of_b, rough_inverse(hn::Add(of_a, of_b)));
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
  const Lanes beta = hn::Mul(dot(n, cross(at.sum, place.onwards)), aside);
  const Lanes w = hn::Mul(hn::Mul(strip.broad(place), hn::Mul(number(0.5f), bent)), aside);
  Lanes begin = hn::Mul(behind, over_length), end = hn::Mul(hn::Add(behind, length2), over_length);
  if constexpr (Strip::rounded) {
    const Lanes longer = hn::Mul(hn::Mul(number(static_cast<float>(pi / 4)), strip.caps(place)), hn::Mul(aside, gone2));
    begin = hn::Sub(begin, longer), end = hn::Add(end, longer);
  }
  // Twice s / sqrt(s^2 + w^2), a step of Newton's.
  const auto part = [&](Lanes s, Lanes w2) ETENDUE_INLINE_LAMBDA {
    const Lanes square = hn::MulAdd(s, s, w2), guess = near_inverse_sqrt(d, square);
    return hn::Mul(hn::Mul(s, guess), hn::NegMulAdd(hn::Mul(square, guess), guess, number(3)));
  };
  const Lanes wider2 = hn::Mul(number(static_cast<float>(pi * pi / 16)), hn::MulAdd(beta, beta, alpha2));
  const Lanes across = hn::Sub(part(hn::Add(beta, w), alpha2), part(hn::Sub(beta, w), alpha2));
  const Lanes lengthwise = hn::Sub(part(end, wider2), part(begin, wider2));
  const Lanes value = hn::Mul(hn::Mul(across, lengthwise), hn::Mul(slow_part<!Strip::rounded>(lobe, at, bent), number(0.0625f)));
  return LobeLanes::split(value, near_root(at.total), hn::Gt(at.rise, zero));
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
