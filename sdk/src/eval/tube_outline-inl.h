// The outline of a tube with round caps above the horizon, for lanes of points: two arcs of circles of directions, what the horizon leaves
// of them, and two sides that touch the tube lengthwise. For kernels as specular_tube_batch.cpp; in double it is tube_silhouette.
#if defined(ETENDUE_TUBE_OUTLINE_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_TUBE_OUTLINE_INL_H
#undef ETENDUE_TUBE_OUTLINE_INL_H
#else
#define ETENDUE_TUBE_OUTLINE_INL_H
#endif

#include "eval/specular_batch-inl.h"
#include "eval/specular_tube.h"

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
// From one place on to another, by twice `half`, which is up to half a turn.
struct ArcPart {
  Turn from, to, half;
  Lit seen;
};
// `wide`: whether it is most of a turn where both ends all but coincide.
HWY_INLINE Turn half_between(const Turn& from, const Turn& to, Lit wide) {
  const Lanes half = number(0.5f), dc = hn::Sub(to.c, from.c), ds = hn::Sub(to.s, from.s);
  const Lanes sc = hn::Add(to.c, from.c), ss = hn::Add(to.s, from.s), chord2 = hn::MulAdd(dc, dc, hn::Mul(ds, ds));
  const Lanes c = hn::Mul(half, hn::Sqrt(hn::MulAdd(sc, sc, hn::Mul(ss, ss))));
  const Lit turned = hn::Lt(hn::MulSub(from.c, to.s, hn::Mul(from.s, to.c)), number(0));
  const Lit close = hn::Lt(chord2, number(1e-6f)), most = hn::Or(hn::And(close, wide), hn::AndNot(close, turned));
  return {hn::IfThenElse(most, hn::Neg(c), c), hn::Mul(half, hn::Sqrt(chord2))};
}

// What a plane leaves of a part of an arc: one part, or two where it takes something out of the middle.
struct CutArc {
  ArcPart first, other;
  Turn sets, rises;
  Lit does_set, does_rise;  // within the part
};
// Over the plane the arc's place at s has the height centre + u cos s + v sin s: above around its highest place, between where it rises and
// where it sets. What its ends say of themselves decides, so that arcs and the sides that go on from there agree whatever rounding does.
struct ArcHeight {
  Lanes centre, u, v;
};
HWY_INLINE CutArc cut_arc(const ArcHeight& height, const ArcPart& part, Lanes at_from, Lanes at_to) {
  const Lanes zero = number(0), one = number(1);
  const Lanes level2 = hn::MulAdd(height.u, height.u, hn::Mul(height.v, height.v));
  const Lanes over = inverse_sqrt(Floats(), hn::Max(level2, number(1e-24f)));
  const Turn top{hn::Mul(height.u, over), hn::Mul(height.v, over)};
  const Lanes reach = hn::Neg(within(hn::Mul(height.centre, over), one));
  const Turn reached{reach, hn::Sqrt(positive(hn::NegMulAdd(reach, reach, one)))};
  CutArc cut;
  cut.sets = sum_of(top, reached), cut.rises = sum_of(top, back(reached));
  const Turn middle = sum_of(part.from, part.half);
  const Lanes to_top = hn::MulAdd(top.c, middle.c, hn::Mul(top.s, middle.s));
  const Lit begins = hn::And(part.seen, hn::Ge(at_from, zero)), ends = hn::And(part.seen, hn::Ge(at_to, zero));
  const Lit both = hn::And(begins, ends), crosses = hn::And(part.seen, hn::Lt(hn::Mul(height.centre, height.centre), level2));
  const Lit gap = hn::And(both, hn::And(crosses, hn::Ge(hn::Neg(to_top), part.half.c)));
  const Lit inside = hn::And(hn::Not(hn::Or(begins, ends)), hn::And(crosses, hn::Ge(to_top, part.half.c)));
  const Turn from = chosen(hn::AndNot(gap, begins), part.from, cut.rises), to = chosen(ends, part.to, cut.sets);
  const Lit whole = hn::AndNot(gap, both), never = hn::FirstN(Floats(), 0);
  cut.first = {from, to, chosen(whole, part.half, half_between(from, to, never)), hn::Or(inside, hn::Or(begins, ends))};
  cut.other = {part.from, cut.sets, half_between(part.from, cut.sets, never), gap};
  const Lit also = hn::Or(inside, gap);
  cut.does_set = hn::Or(also, hn::AndNot(ends, begins)), cut.does_rise = hn::Or(also, hn::AndNot(begins, ends));
  return cut;
}

// A part of a great circle between unit vectors.
struct Side {
  Vector3 from, to;
  Lit seen;
};
// Where a closed convex chain of arcs and sides goes below the plane z = 0 and comes up again.
class Closing {
 public:
  explicit Closing(const Vector3& anywhere) : setting_(anywhere), rising_(anywhere) { sets_ = rises_ = hn::FirstN(Floats(), 0); }
  HWY_INLINE void pass(Lit sets, const Vector3& setting, Lit rises, const Vector3& rising) {
    setting_ = chosen(sets, setting, setting_), rising_ = chosen(rises, rising, rising_);
    sets_ = hn::Or(sets_, sets), rises_ = hn::Or(rises_, rises);
  }
  // What of it is above.
  HWY_INLINE Side cut(const Side& side) {
    const Lanes zero = number(0);
    const Vector3 &from = side.from, &to = side.to;
    const Lit begins = hn::And(side.seen, hn::Ge(from.z, zero)), ends = hn::And(side.seen, hn::Ge(to.z, zero));
    const Lit goes = hn::AndNot(ends, begins), comes = hn::AndNot(begins, ends);
    // from (-to.z) + to from.z, or the other way round.
    const Lanes x = hn::MulSub(to.x, from.z, hn::Mul(from.x, to.z)), y = hn::MulSub(to.y, from.z, hn::Mul(from.y, to.z));
    const Lanes length = inverse_sqrt(Floats(), hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), number(1e-30f)));
    const Lanes over = hn::IfThenElse(comes, hn::Neg(length), length);
    const Vector3 place{hn::Mul(x, over), hn::Mul(y, over), zero};
    pass(goes, place, comes, place);
    return {chosen(comes, place, from), chosen(goes, place, to), hn::Or(begins, ends)};
  }
  // Along the plane.
  Side side() const { return {setting_, rising_, hn::And(sets_, rises_)}; }
  const Vector3& rising() const { return rising_; }

 private:
  Lit sets_, rises_;
  Vector3 setting_, rising_;
};

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

// What of the outline is above the surface's horizon.
struct CutCap {
  Vector3 begin, end, setting, rising;  // of the whole arc, and of the parts that are left of it
  CutArc cut;
  HWY_INLINE explicit CutCap(const CapArc& arc) : begin(arc.at(back(arc.half))), end(arc.at(arc.half)) {
    const ArcPart whole{back(arc.half), arc.half, arc.half, hn::FirstN(Floats(), hn::Lanes(Floats()))};
    cut = cut_arc({arc.centre.z, arc.u.z, arc.v.z}, whole, begin.z, end.z);
    setting = arc.at(cut.sets), rising = arc.at(cut.rises);
  }
};
struct AboveHorizon {
  CutCap a, b;
  std::array<Side, 3> sides;  // the last one along the horizon
  Vector3 somewhere;          // a direction of it
  HWY_INLINE explicit AboveHorizon(const TubeOutline& tube) : a(tube.a), b(tube.b) {
    Closing closing(a.begin);
    closing.pass(a.cut.does_set, a.setting, a.cut.does_rise, a.rising);
    closing.pass(b.cut.does_set, b.setting, b.cut.does_rise, b.rising);
    sides[0] = closing.cut({a.end, b.begin, tube.sides}), sides[1] = closing.cut({b.end, a.begin, tube.sides});
    sides[2] = closing.side(), somewhere = closing.rising();
  }
};

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
