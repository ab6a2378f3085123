// The outline of a tube with round caps above the horizon, for lanes of points: two arcs of circles of directions, what the horizon leaves
// of them, and two sides that touch the tube lengthwise. For kernels as specular_tube_batch.cpp; in double it is tube_silhouette.
#if defined(ETENDUE_TUBE_OUTLINE_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_TUBE_OUTLINE_INL_H
#undef ETENDUE_TUBE_OUTLINE_INL_H
#else
#define ETENDUE_TUBE_OUTLINE_INL_H
#endif

#include "eval/specular_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// Cosine and sine of an angle.
struct Turn {
  Lanes c, s;
};
HWY_INLINE Turn chosen(Lit mask, const Turn& yes, const Turn& no) {
  return {hn::IfThenElse(mask, yes.c, no.c), hn::IfThenElse(mask, yes.s, no.s)};
}
HWY_INLINE Turn sum_of(const Turn& a, const Turn& b) {
  return {hn::MulSub(a.c, b.c, hn::Mul(a.s, b.s)), hn::MulAdd(a.s, b.c, hn::Mul(a.c, b.s))};
}
HWY_INLINE Turn back(const Turn& a) { return {a.c, hn::Neg(a.s)}; }
// Of up to half a turn; a small one keeps its digits.
HWY_INLINE Turn half_of(const Turn& a) {
  const Lanes half = number(0.5f), c = hn::Sqrt(positive(hn::MulAdd(half, a.c, half)));
  const Lanes wide = hn::Sqrt(positive(hn::NegMulAdd(half, a.c, half)));
  return {c, hn::IfThenElse(hn::Gt(a.c, number(0)), hn::Div(hn::Mul(half, a.s), hn::Max(c, number(0.5f))), wide)};
}

// Unit directions centre + u cos s + v sin s, -half <= s <= half.
struct CapArc {
  Vector3 centre, u, v;
  Turn half;
  Vector3 at(const Turn& s) const { return along(along(centre, u, s.c), v, s.s); }
};
// From `from` on by twice `half`, which is up to half a turn.
struct ArcPart {
  Turn from, half;
  Lit seen;
};
// What the horizon z = 0 leaves of an arc: one part, or two where it takes something out of the middle.
struct CutArc {
  Vector3 begin, end;  // of the whole arc
  ArcPart first, other;
  Lit sets, rises;  // it goes below within the arc, and comes up
  Vector3 setting, rising;
};
HWY_INLINE Turn half_between(const Turn& from, const Turn& to) {
  const Lanes half = number(0.5f), dc = hn::Sub(to.c, from.c), ds = hn::Sub(to.s, from.s);
  const Lanes sc = hn::Add(to.c, from.c), ss = hn::Add(to.s, from.s);
  const Lanes c = hn::Mul(half, hn::Sqrt(hn::MulAdd(sc, sc, hn::Mul(ss, ss))));
  const Lit wide = hn::Lt(hn::MulSub(from.c, to.s, hn::Mul(from.s, to.c)), number(0));
  return {hn::IfThenElse(wide, hn::Neg(c), c), hn::Mul(half, hn::Sqrt(hn::MulAdd(dc, dc, hn::Mul(ds, ds))))};
}
// The circle is above the horizon around its highest place, between where it rises and where it sets. What its ends say of themselves
// decides, so that the arc and the sides that go on from there agree whatever rounding does.
HWY_INLINE CutArc cut_by_horizon(const CapArc& arc) {
  const Lanes zero = number(0), one = number(1);
  const Lanes level2 = hn::MulAdd(arc.u.z, arc.u.z, hn::Mul(arc.v.z, arc.v.z));
  const Lanes over = inverse_sqrt(Floats(), hn::Max(level2, number(1e-24f)));
  const Turn top{hn::Mul(arc.u.z, over), hn::Mul(arc.v.z, over)};
  const Lanes reach = hn::Neg(within(hn::Mul(arc.centre.z, over), one));
  const Turn reached{reach, hn::Sqrt(positive(hn::NegMulAdd(reach, reach, one)))};
  const Turn set = sum_of(top, reached), risen = sum_of(top, back(reached));
  const Turn begin = back(arc.half), end = arc.half;
  CutArc cut;
  cut.begin = arc.at(begin), cut.end = arc.at(end), cut.setting = arc.at(set), cut.rising = arc.at(risen);
  const Lit begins = hn::Ge(cut.begin.z, zero), ends = hn::Ge(cut.end.z, zero), both = hn::And(begins, ends);
  const Lit crosses = hn::Lt(hn::Mul(arc.centre.z, arc.centre.z), level2);
  const Lit gap = hn::And(both, hn::And(crosses, hn::Ge(hn::Neg(top.c), arc.half.c)));
  const Lit middle = hn::And(hn::Not(hn::Or(begins, ends)), hn::And(crosses, hn::Ge(top.c, arc.half.c)));
  const Turn from = chosen(hn::AndNot(gap, begins), begin, risen), to = chosen(ends, end, set);
  cut.first = {from, chosen(hn::AndNot(gap, both), arc.half, half_between(from, to)), hn::Or(middle, hn::Or(begins, ends))};
  cut.other = {begin, half_between(begin, set), gap};
  const Lit also = hn::Or(middle, gap);
  cut.sets = hn::Or(also, hn::AndNot(ends, begins)), cut.rises = hn::Or(also, hn::AndNot(begins, ends));
  return cut;
}

// With e across from the point to the axis, D far, w = axis x e and x along the axis, the planes that touch the tube lengthwise have the
// normals -(R / D) e +- (H / D) w, H^2 = D^2 - R^2. A cap's circle of tangency is seen about c = x axis + D e at the sine R / |c|; with u
// outwards from the tube it bounds the tube where |s| is below half, cos half = R outwards / (D sqrt(c^2 - R^2)), outwards that x from the
// tube's middle on. Of both caps `a` has the longer arc, up to a whole turn where it hides the rest; the other has half a turn at most.
struct TubeOutline {
  CapArc a, b;
  Lit sides;  // within the infinite cylinder there are none
  Lit above;  // something may be
  Lit doubtful, inside;
};
HWY_INLINE TubeOutline tube_outline(const PlacedTubeAxis& light, const Vector3& position, const ViewFrame& frame) {
  const Floats d;
  const Lanes zero = number(0), one = number(1), radius = number(light.radius), r2 = hn::Mul(radius, radius), length = number(light.length);
  const Vector3 first = towards(d, light.a, position), axis = numbers(d, light.axis);
  const Lanes from = dot(first, axis), to = hn::Add(from, length);
  const auto without = [&](const Vector3& v, Lanes part) ETENDUE_INLINE_LAMBDA { return along(v, axis, hn::Neg(part)); };
  // Taken off once more, what rounding has left along the axis is small beside a small distance too.
  const Vector3 nearly = without(first, from), off = without(nearly, dot(nearly, axis));
  const Lanes off2 = dot(off, off), farther2 = hn::Max(hn::Mul(from, from), hn::Mul(to, to));
  const Lit on_axis = hn::Not(hn::Gt(off2, hn::Mul(number(1e-12f), hn::Add(farther2, r2))));
  const Vector3 e_world = chosen(on_axis, numbers(d, light.across), scaled(off, inverse_sqrt(d, hn::Max(off2, number(1e-30f)))));
  const Lanes across = hn::IfThenElse(on_axis, hn::Mul(number(1e-6f), radius), hn::Sqrt(off2));
  const Lanes touching = hn::Sqrt(positive(hn::MulSub(across, across, r2)));
  // The cap whose centre is farther back from its end, turned so that it is at the lower x.
  const Lit turned = hn::Lt(to, hn::Neg(from));
  const Lanes outwards_a = hn::IfThenElse(turned, to, hn::Neg(from)), outwards_b = hn::IfThenElse(turned, hn::Neg(from), to);
  const Vector3 e = frame(e_world), forwards = frame(axis), x = chosen(turned, opposite(forwards), forwards), w = cross(x, e);
  const auto cap = [&](const Vector3& outward, Lanes outwards, const Vector3& v) ETENDUE_INLINE_LAMBDA {
    const Lanes distance2 = hn::MulAdd(outwards, outwards, hn::Mul(across, across)), over = inverse_sqrt(d, distance2);
    const Lanes tangent = hn::Sqrt(hn::Max(hn::Sub(distance2, r2), hn::Mul(number(1e-7f), r2)));
    const Lanes sine = hn::Mul(radius, over), cosine = hn::Mul(tangent, over);
    const Vector3 towards_end = along(scaled(e, hn::Mul(across, over)), outward, hn::Mul(outwards, over));
    const Vector3 u = along(scaled(outward, hn::Mul(across, over)), e, hn::Neg(hn::Mul(outwards, over)));
    const Lanes scale = hn::Div(one, hn::Mul(across, tangent));
    const Lanes c = within(hn::Mul(hn::Mul(radius, outwards), scale), one);
    const Lanes s = hn::Min(hn::Mul(hn::Mul(touching, hn::Mul(distance2, over)), scale), one);
    return CapArc{scaled(towards_end, cosine), scaled(u, sine), scaled(v, sine), {c, s}};
  };
  TubeOutline t{cap(opposite(x), outwards_a, w), cap(x, outwards_b, opposite(w)), hn::Gt(touching, zero), {}, {}, {}};
  const Lanes high_a = hn::MulSub(across, e.z, hn::Mul(outwards_a, x.z)), high_b = hn::MulAdd(across, e.z, hn::Mul(outwards_b, x.z));
  t.above = hn::Gt(hn::Add(hn::Max(high_a, high_b), radius), zero);
  // Of the axis' points the closest.
  const Lanes beyond = positive(hn::Neg(outwards_b)), before = positive(hn::Neg(outwards_a)), past = hn::Max(beyond, before);
  const Lanes near2 = hn::MulAdd(past, past, hn::Mul(across, across));
  t.inside = hn::Le(near2, r2);
  const Lanes size = hn::MulAdd(number(2), radius, length);
  t.doubtful = hn::Or(hn::Lt(near2, hn::Mul(number(1.004f), r2)), hn::Gt(near2, hn::Mul(number(4 / (least_angle * least_angle)), r2)));
  t.doubtful = hn::Or(t.doubtful, hn::Gt(hn::Mul(near2, number(least_angle * least_angle)), hn::Mul(size, size)));
  return t;
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
