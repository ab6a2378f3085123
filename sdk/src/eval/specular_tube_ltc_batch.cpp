// Specular light of tubes with round caps at many points by transformed cosines: caps are parts of cones over ellipses, sides stay great
// circles.
#include "light_batch.h"
#include "specular_batch.h"
#include "specular_tube.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_tube_ltc_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/ltc_cone-inl.h"
#include "eval/tube_outline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// A cap's cone as the cosine sees it, above the cosine's own horizon.
class SeenCap {
 public:
  HWY_INLINE SeenCap(const Cosines& cosines, const CapArc& arc) : ellipse_(transformed(cosines, {arc.centre, arc.u, arc.v})) {
    axes_ = frame_of(ellipse_, axis_of(ellipse_));
  }
  // Twice Lambert's integral over a part of its rim between two directions. `wide`: more than half a turn.
  HWY_INLINE Lanes integral(const Vector3& from, const Vector3& to, Lit wide, Lit seen, Closing& closing) const {
    const Floats d;
    const Rim rim(axes_.a, axes_.b, {axes_.e1.z, axes_.e2.z, axes_.e0.z});
    const Turn begin = place(from), end = place(to);
    const ArcHeight height{rim.n.z, hn::Mul(rim.n.x, rim.a), hn::Mul(rim.n.y, rim.b)};
    const CutArc cut = cut_arc(height, {begin, end, half_between(begin, end, wide), seen}, from.z, to.z);
    const auto between = [&](const ArcPart& part) ETENDUE_INLINE_LAMBDA {
      const Lit most = hn::Lt(part.half.c, number(0));
      return hn::IfThenElseZero(part.seen, rim.between({part.from.c, part.from.s}, {part.to.c, part.to.s}, most, most));
    };
    Lanes sum = between(cut.first);
    if (HWY_LIKELY(hn::AllFalse(d, hn::Or(cut.does_set, cut.does_rise)))) return sum;
    closing.pass(cut.does_set, direction(rim, cut.sets), cut.does_rise, direction(rim, cut.rises));
    if (HWY_UNLIKELY(!hn::AllFalse(d, cut.other.seen))) sum = hn::Add(sum, between(cut.other));
    return sum;
  }

 private:
  // Of a direction on the rim: (cos t, sin t) as (x / A, y / B).
  Turn place(const Vector3& p) const {
    const Lanes x = hn::Mul(dot(p, axes_.e1), axes_.b), y = hn::Mul(dot(p, axes_.e2), axes_.a);
    const Lanes over = inverse_sqrt(Floats(), hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), number(1e-36f)));
    return {hn::Mul(x, over), hn::Mul(y, over)};
  }
  // Where the rim passes the plane z = 0.
  Vector3 direction(const Rim& rim, const Turn& t) const {
    const Vector3 p = rim.unit_at({t.c, t.s});
    const Vector3 there = along(along(scaled(axes_.e0, p.z), axes_.e1, p.x), axes_.e2, p.y);
    return unit({there.x, there.y, number(0)});
  }
  Ellipse ellipse_;
  ConeFrame axes_;
};

// The share of the cosine above the horizon that the tube covers.
inline HWY_NOINLINE Lanes covered(const Cosines& cosines, const TubeOutline& tube, const AboveHorizon& above) {
  const Floats d;
  const auto seen = [&](const Vector3& v) ETENDUE_INLINE_LAMBDA { return unit(cosines(v)); };
  Closing closing(seen(above.somewhere));
  Lanes sum = number(0);
  const auto add_side = [&](const Side& side) ETENDUE_INLINE_LAMBDA {
    const Vector3 step = side.to - side.from;
    const Lanes turn = hn::MulSub(side.from.x, step.y, hn::Mul(side.from.y, step.x));
    sum = hn::Add(sum, hn::IfThenElseZero(side.seen, hn::MulAdd(turn, over_sine_less_one(side.from, step), turn)));
  };
  for (const Side& side : above.sides) add_side(closing.cut({seen(side.from), seen(side.to), side.seen}));
  const auto add_cap = [&](const CapArc& arc, const CutCap& cap) ETENDUE_INLINE_LAMBDA {
    const SeenCap cone(cosines, arc);
    const ArcPart &first = cap.cut.first, &other = cap.cut.other;
    const Lit begins = hn::AndNot(other.seen, hn::Ge(cap.begin.z, number(0))), ends = hn::Ge(cap.end.z, number(0));
    const Vector3 setting = seen(cap.setting);
    sum = hn::Add(sum, cone.integral(seen(chosen(begins, cap.begin, cap.rising)), chosen(ends, seen(cap.end), setting),
                                     hn::Lt(first.half.c, number(0)), first.seen, closing));
    if (HWY_UNLIKELY(!hn::AllFalse(d, other.seen)))
      sum = hn::Add(sum, cone.integral(seen(cap.begin), setting, hn::Lt(other.half.c, number(0)), other.seen, closing));
  };
  add_cap(tube.a, above.a);
  add_cap(tube.b, above.b);
  add_side(closing.side());
  const Lanes over = inverse(d, hn::Mul(number(static_cast<float>(2 * pi)), cosines.share_above()));
  return saturate(hn::Mul(sum, over));
}

template <bool two_lobes>
class TubeCosines {
 public:
  TubeCosines(const PlacedTubeAxis& light, const LtcNodes& nodes) : light_(light), nodes_(nodes) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const ViewFrame frame = view_frame(normal, view);
    const TubeOutline tube = tube_outline(light_, position, frame);
    const Lit lit = hn::And(hn::And(hn::Gt(frame.cosine, number(0)), tube.above), hn::Not(tube.inside));
    doubtful = hn::And(hn::Or(lit, tube.inside), tube.doubtful);
    if (hn::AllFalse(Floats(), lit)) return {number(0), number(0)};
    const AboveHorizon above(tube);
    const Shares shares = by_cosines<two_lobes>(
        nodes_, frame, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA { return covered(cosines, tube, above); });
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  const PlacedTubeAxis& light_;
  LtcNodes nodes_;
};

std::size_t OverTubeCosines(SpecularRule rule, const PlacedTubeAxis& light, const Emitter& white, const LtcNodes& nodes,
                            const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(rule, white, points, index); };
  if (rule == SpecularRule::ltc) return over_views(points, of_f0, of_f90, where_none, TubeCosines<false>(light, nodes), exact);
  return over_views(points, of_f0, of_f90, where_none, TubeCosines<true>(light, nodes), exact);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(OverTubeCosines);

std::size_t tube_by_cosines(SpecularRule rule, const PlacedTubeAxis& light, const Emitter& white, const SpecularPoints& points,
                            std::span<float> of_f0, std::span<float> of_f90, float where_none) {
  return HWY_DYNAMIC_DISPATCH(OverTubeCosines)(rule, light, white, ltc_nodes(), points, of_f0, of_f90, where_none);
}

}  // namespace etendue::eval
#endif
