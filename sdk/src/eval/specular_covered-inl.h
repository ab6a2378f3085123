// covered_lobe and covered_strip of specular_methods.cpp in vectors, once for each instruction set: include it after HWY_TARGET_INCLUDE and
// hwy/foreach_target.h. Nothing is turned to the point's frame: a slope is (v + l) / n.(v + l) - n, in the plane across the normal. What
// differences are made of is exact to a few roundings, the rest to 12 bits.
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
// 4 v.h / n.h n.l G2 / (4 n.v n.l), at most 1; `bent` is |v + l|^2 / n.(v + l).
HWY_INLINE Lanes slow_part(const LobeLanes& lobe, const Halfway& at, Lanes bent) {
  return hn::Min(hn::Mul(hn::Add(bent, bent), lobe.seen_area<true>(at.rise)), number(1));
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
  const Lanes value = hn::Mul(hn::Mul(hn::Mul(number(0.5f), above), over_length), slow_part(lobe, at, bent));
  return LobeLanes::split(value, near_root(at.total), hn::Gt(at.rise, number(0)));
}

// ---- A strip ----

// From one direction to another, and their cosines from the normal; a tube's ends are so much nearer than 1.
struct TubeStrip {
  Vector3 to_a, to_b;
  Lanes rise_a, rise_b, over_a, over_b;
  float radius;
  bool cut;
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
  return {scaled(a, over_a), scaled(b, over_b), hn::Mul(high_a, over_a), hn::Mul(high_b, over_b), over_a, over_b, tube.radius, cut};
}
HWY_INLINE Shares lit_by_strip(const LobeLanes& lobe, const TubeStrip& strip) {
  const Floats d;
  const Lanes zero = number(0), half = number(0.5f), alpha2 = square(lobe.alpha), cosine = lobe.frame.cosine;
  const Vector3 &n = lobe.frame.z, span = strip.to_b - strip.to_a;
  const Lanes z_a = hn::Add(strip.rise_a, cosine), z_b = hn::Add(strip.rise_b, cosine);
  const Vector3 from = scaled(lobe.eye + strip.to_a, inverse(d, z_a)), to = scaled(lobe.eye + strip.to_b, inverse(d, z_b));
  // Seen end-on its direction is the slope's.
  const Vector3 slope = from - n, step = along(to - from, slope, number(1e-6f));
  const Lanes length2 = hn::MulAdd(step.x, step.x, hn::MulAdd(step.y, step.y, hn::MulAdd(step.z, step.z, number(1e-20f))));
  const Lanes over_length = near_inverse_sqrt(d, length2), behind = dot(slope, step);
  // The lobe's mean on the strip.
  const Lanes closest = hn::Min(positive(hn::Neg(behind)), length2), pull = hn::Mul(number(1.5f), alpha2);
  const Lanes of_b = hn::Mul(hn::Add(closest, pull), z_a), of_a = hn::Mul(hn::Add(hn::Sub(length2, closest), pull), z_b);
  const Lanes share = hn::Mul(of_b, rough_inverse(hn::Add(of_a, of_b)));
  const Vector3 chord = along(strip.to_a, span, share);
  const Lanes over_chord = inverse_length(chord);
  const Lanes over_distance = hn::Mul(hn::MulAdd(hn::Sub(strip.over_b, strip.over_a), share, strip.over_a), over_chord);
  const Vector3 l = scaled(chord, over_chord);
  const Halfway at(lobe, l);
  const Lanes over_z = inverse(d, at.z), bent = hn::Mul(at.total, over_z);
  // How slopes go with the strip's directions there.
  const Lanes backwards = hn::Neg(dot(l, span)), rises = hn::MulAdd(backwards, at.rise, hn::Sub(z_b, z_a));
  const Vector3 onwards = along(span, l, backwards), go = along(onwards, at.sum, hn::Neg(hn::Mul(rises, over_z)));
  const Lanes turned2 =
      hn::MulAdd(onwards.x, onwards.x, hn::MulAdd(onwards.y, onwards.y, hn::MulAdd(onwards.z, onwards.z, number(1e-12f))));
  const Lanes gone2 = hn::MulAdd(go.x, go.x, hn::MulAdd(go.y, go.y, hn::MulAdd(go.z, go.z, number(1e-12f))));
  const Lanes over_gone = near_inverse_sqrt(d, gone2), over_turned = near_inverse_sqrt(d, turned2), aside = hn::Mul(over_gone, over_z);
  const Vector3 leftwards = cross(at.sum, onwards);
  const Lanes beta = hn::Mul(dot(n, leftwards), aside);
  Lanes angle = hn::Mul(number(0.5f * strip.radius), over_distance);
  if (HWY_UNLIKELY(strip.cut)) angle = hn::Min(angle, hn::Mul(half, at.rise));
  const Lanes over_both = hn::Mul(hn::Mul(angle, over_turned), aside);
  const Lanes w = hn::Mul(over_both, hn::Mul(bent, turned2));
  const Lanes longer = hn::Mul(number(static_cast<float>(pi / 2)), hn::Mul(over_both, gone2));
  const Lanes begin = hn::MulSub(behind, over_length, longer);
  const Lanes end = hn::MulAdd(hn::Add(behind, length2), over_length, longer);
  // Twice s / sqrt(s^2 + w^2), a step of Newton's.
  const auto part = [&](Lanes s, Lanes w2) ETENDUE_INLINE_LAMBDA {
    const Lanes square = hn::MulAdd(s, s, w2), guess = near_inverse_sqrt(d, square);
    return hn::Mul(hn::Mul(s, guess), hn::NegMulAdd(hn::Mul(square, guess), guess, number(3)));
  };
  const Lanes wider2 = hn::Mul(number(static_cast<float>(pi * pi / 16)), hn::MulAdd(beta, beta, alpha2));
  const Lanes broad = hn::Sub(part(hn::Add(beta, w), alpha2), part(hn::Sub(beta, w), alpha2));
  const Lanes lengthwise = hn::Sub(part(end, wider2), part(begin, wider2));
  const Lanes value = hn::Mul(hn::Mul(broad, lengthwise), hn::Mul(slow_part(lobe, at, bent), number(0.0625f)));
  return LobeLanes::split(value, near_root(at.total), hn::Gt(at.rise, zero));
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
