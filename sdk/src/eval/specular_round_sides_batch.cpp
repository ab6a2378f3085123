// specular_outline.h: spheres and suns, a circle of directions.
#include "specular_outline.h"

#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_round_sides_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/specular_sides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

constexpr std::size_t arcs = 4;

struct WideCap {
  Wide3 axis;
  Wide cosine, sine;
  WideMask lit, doubtful;
};
HWY_INLINE WideCap seen_cap(const OutlinedLight& light, const WidePoints& points) {
  const WideMask always = hn::FirstN(Doubles(), hn::Lanes(Doubles()));
  if (const CapSeen* cap = std::get_if<CapSeen>(&light.shape))
    return {points.local(wide(cap->axis)), wide(cap->cosine), wide(cap->sine), always, none_of()};
  const BallSeen& ball = *std::get_if<BallSeen>(&light.shape);
  const Wide3 towards = wide(ball.centre) - points.position;
  const Wide distance = hn::Sqrt(dot(towards, towards)), over = hn::Div(wide(1), hn::Max(distance, wide(1e-300))), r = wide(ball.radius);
  const WideMask outside = hn::Gt(distance, r);
  return {points.local(times(towards, over)), hn::Mul(wide_root(hn::Mul(hn::Sub(distance, r), hn::Add(distance, r))), over),
          hn::Mul(r, over), outside, light.two_sided ? hn::Not(outside) : none_of()};
}

// What is above the horizon of the circle axis cosine + sine (u cos s + v sin s), u as steeply upwards as it goes: |s| <= half. It is laid
// out in four parts, where it is no more than half a turn in two.
void LayRoundSides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  const Doubles d;
  const Wide zero = wide(0), one = wide(1), half = wide(0.5);
  block.make_room(arcs, 1, false);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const WidePoints points(places, i);
    const WideCap cap = seen_cap(light, points);
    const Wide3& axis = cap.axis;
    const Wide across2 = hn::MulAdd(axis.x, axis.x, hn::Mul(axis.y, axis.y)), across = hn::Sqrt(across2);
    const WideMask upright = hn::Lt(across, wide(1e-10));
    const Wide over = hn::Div(one, hn::Max(across, wide(1e-10)));
    const Wide ahead_x = hn::IfThenElse(upright, one, hn::Mul(axis.x, over)),
               ahead_y = hn::IfThenElseZero(hn::Not(upright), hn::Mul(axis.y, over));
    const Wide3 up = times({hn::Neg(hn::Mul(ahead_x, axis.z)), hn::Neg(hn::Mul(ahead_y, axis.z)), across}, cap.sine);
    const Wide3 side = times({ahead_y, hn::Neg(ahead_x), zero}, cap.sine), centre = times(axis, cap.cosine);
    // centre.z + up.z cos s is above.
    const WideMask whole = hn::Ge(centre.z, up.z), above = hn::Gt(hn::Add(centre.z, up.z), zero), cut = hn::AndNot(whole, above);
    const Wide c =
        hn::IfThenElse(whole, wide(-1), hn::Max(wide(-1), hn::Min(one, hn::Div(hn::Neg(centre.z), hn::Max(up.z, wide(1e-300))))));
    const Wide s = wide_root(hn::Mul(hn::Sub(one, c), hn::Add(one, c)));
    // Cosines and sines of a half and a quarter of it, and of three quarters.
    const Wide c2 = wide_root(hn::MulAdd(half, c, half)), s2 = wide_root(hn::NegMulAdd(half, c, half));
    const Wide c4 = wide_root(hn::MulAdd(half, c2, half)), s4 = hn::Div(s2, hn::Add(c4, c4));
    const Wide c34 = hn::MulSub(c2, c4, hn::Mul(s2, s4)), s34 = hn::MulAdd(s2, c4, hn::Mul(c2, s4));
    const WideMask four = hn::Lt(c, zero), seen = hn::And(cap.lit, above);
    const Wide reach = hn::Div(s4, hn::IfThenElse(four, hn::Add(one, c4), c4));
    const Wide near_c = hn::IfThenElse(four, c4, c2), near_s = hn::IfThenElse(four, s4, s2);
    SideLayer layer(points, block, i);
    const auto part = [&](std::size_t index, Wide cs, Wide sn, WideMask is_seen) ETENDUE_INLINE_LAMBDA {
      layer.lay(index, WideArc{centre, plus(times(up, cs), side, sn), plus(times(side, cs), up, hn::Neg(sn)), reach, is_seen});
    };
    part(0, near_c, near_s, seen), part(1, near_c, hn::Neg(near_s), seen);
    part(2, c34, s34, hn::And(seen, four)), part(3, c34, hn::Neg(s34), hn::And(seen, four));
    const auto end = [&](Wide sn) ETENDUE_INLINE_LAMBDA {
      Wide3 place = plus(plus(centre, up, c), side, sn);
      place.z = zero;
      return wide_unit(place);
    };
    layer.lay(arcs, WideSide{end(s), end(hn::Neg(s)), hn::And(seen, cut)});
    // Of a circle that is small beside the digits of its directions little is known, and of a sliver of one.
    const WideMask thin = hn::And(cut, hn::Lt(hn::Add(centre.z, up.z), hn::Mul(wide(5e-3), cap.sine)));
    layer.doubtful = hn::Or(layer.doubtful, hn::Or(cap.doubtful, hn::And(seen, hn::Or(thin, hn::Lt(cap.sine, wide(1e-5))))));
    const Wide to_mirror = hn::MulSub(axis.z, points.view.z, hn::Mul(axis.x, points.view.x));
    layer.finish(light, seen, hn::Gt(to_mirror, cap.cosine));
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(LayRoundSides);

void lay_round_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  HWY_DYNAMIC_DISPATCH(LayRoundSides)(light, places, count, block);
}

}  // namespace etendue::eval
#endif
