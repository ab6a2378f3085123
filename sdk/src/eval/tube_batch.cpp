// Tubes at many points, over the horizon, in vectors: with round caps the closed form of the silhouette; the side alone as strips along the
// axis, to which flat ends add disks.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/tube_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/light_batch-inl.h"
#include "eval/quadrature.h"

#ifndef ETENDUE_TUBE_BATCH_SHARED
#define ETENDUE_TUBE_BATCH_SHARED
namespace etendue::eval {
struct PlacedTube {
  Place a;                // centre of the first cap
  Vec3d axis, across;     // unit: to the second cap, and any perpendicular
  double length, radius;  // in units of the batch, as the place
  double scale;           // units a metre
  const Emitter& white;
};

// Gauss and Legendre's of 12 nodes.
inline constexpr std::array<GaussNode, 12> gauss12{{{-0.9815606342467192, 0.0471753363865118},
                                                    {-0.9041172563704749, 0.1069393259953184},
                                                    {-0.7699026741943047, 0.1600783285433462},
                                                    {-0.5873179542866175, 0.2031674267230659},
                                                    {-0.3678314989981802, 0.2334925365383548},
                                                    {-0.1252334085114689, 0.2491470458134028},
                                                    {0.1252334085114689, 0.2491470458134028},
                                                    {0.3678314989981802, 0.2334925365383548},
                                                    {0.5873179542866175, 0.2031674267230659},
                                                    {0.7699026741943047, 0.1600783285433462},
                                                    {0.9041172563704749, 0.1069393259953184},
                                                    {0.9815606342467192, 0.0471753363865118}}};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// Seen from the point, x is the axis, e points across it from the point to the axis, w = x cross e; the caps' centres are at a and b along
// x and at the distance D across, the normal has n_w >= 0 (w may be either way). With H = sqrt(D^2 - R^2) the planes through the point that
// touch the side do so along two lines at the distance H, at the angles of (H, x) from their feet.
template <class V>
struct TubeView {
  V a, b, across, touching;  // a, b, D, H
  V n_x, n_e, n_w;
  V radius;
};
// One cap: half angle of the part of its circle of tangency that bounds the tube, outwards from the tube.
template <class V>
struct CapView {
  V up, distance2, inverse;  // of the centre: n.c, |c|^2, 1 / |c|
  V tangent;                 // sqrt(|c|^2 - R^2)
  V outwards;                // the centre's place along x, less than nothing towards the tube
  V section2, section;       // of the circle that the horizon cuts out of the cap: its radius, squared and itself
  V half;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE CapView<V> cap_view(D d, const TubeView<V>& t, V x, V outwards) {
  const V distance2 = hn::MulAdd(x, x, hn::Mul(t.across, t.across));
  const V distance = hn::Sqrt(distance2), inverse = hn::Div(number(d, 1), distance);
  const V tangent = hn::Sqrt(hn::Max(hn::NegMulAdd(t.radius, t.radius, distance2), hn::Zero(d)));
  const V half = angle_of(d, hn::Mul(t.touching, distance), hn::Mul(t.radius, outwards));
  const V up = hn::MulAdd(t.across, t.n_e, hn::Mul(x, t.n_x)), section2 = hn::Mul(hn::Sub(t.radius, up), hn::Add(t.radius, up));
  return {up, distance2, inverse, tangent, outwards, section2, hn::Sqrt(hn::Max(section2, hn::Zero(d))), half};
}

// Twice what the cap's circle of tangency gives above the horizon: of b(s) = c cos(sigma) + sin(sigma) (u cos s + v sin s), u outwards,
// -half <= s <= half, n.(b x b') has the integral n.c sin^2 s - cos sin (n.u sin s - n.v cos s). Above the horizon it is within eta of the
// direction chi of n's part across c.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V cut_cap_arc(D d, const TubeView<V>& t, const CapView<V>& cap, V n_u) {
  const V zero = hn::Zero(d);
  const V sine = hn::Mul(t.radius, cap.inverse), cosine = hn::Mul(cap.tangent, cap.inverse), n_c = hn::Mul(cap.up, cap.inverse);
  const V q = hn::Mul(cap.section, cap.inverse);
  const V eta = angle_of(d, q, hn::Neg(hn::Mul(cosine, n_c))), chi = angle_of(d, t.n_w, n_u);
  // Sine and cosine of the half angle, times the sine of sigma.
  const V scale = hn::Div(sine, hn::Mul(t.across, cap.tangent));
  const V sine_half = hn::Mul(scale, hn::Mul(t.touching, hn::Mul(cap.distance2, cap.inverse)));
  // Within the infinite cylinder it is half a turn.
  const V cosine_half = hn::Min(hn::Max(hn::Mul(scale, hn::Mul(t.radius, cap.outwards)), hn::Neg(sine)), sine);
  const V along = hn::Mul(n_u, sine_half), aside = hn::Mul(t.n_w, cosine_half);
  const V window_end = hn::Add(chi, eta), window_begin = hn::Sub(chi, eta), begin = hn::Neg(cap.half);
  const V at_end = hn::Sub(along, aside), at_begin = hn::Neg(hn::Add(along, aside));
  const V to = hn::Min(cap.half, window_end), from = hn::Max(begin, window_begin);
  const V at_to = hn::IfThenElse(hn::Lt(cap.half, window_end), at_end, q);
  const V at_from = hn::IfThenElse(hn::Gt(begin, window_begin), at_begin, hn::Neg(q));
  const auto is_part = hn::Gt(to, from);
  V turned = hn::IfThenElseZero(is_part, hn::Sub(to, from)), moved = hn::IfThenElseZero(is_part, hn::Sub(at_to, at_from));
  // The window's end after a whole turn.
  const V wrapped = hn::Sub(hn::Sub(window_end, number(d, 2 * pi)), begin);
  const auto wraps = hn::Gt(wrapped, zero);
  turned = hn::Add(turned, hn::IfThenElseZero(wraps, wrapped));
  moved = hn::Add(moved, hn::IfThenElseZero(wraps, hn::Sub(q, at_begin)));
  return hn::MulSub(hn::Mul(n_c, hn::Mul(sine, sine)), turned, hn::Mul(cosine, moved));
}

// Cut by the horizon. Where a small difference counts it is formed as such, of the same rounded heights everywhere: those belong to a
// normal that is hardly another one. `cancels`: much more is seen of one line of contact than of the other, so that there are terms that
// are not small however thin the tube.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V cut_tube(D d, const TubeView<V>& t, const CapView<V>& a, const CapView<V>& b, V length, M& cancels) {
  const V zero = hn::Zero(d), one = number(d, 1), two = number(d, 2);
  const V n_x = hn::Max(t.n_x, number(d, in_floats<D> ? 1e-18 : 1e-150)), per_x = hn::Div(one, n_x);
  const V per_across = hn::Div(one, t.across), per_tube = hn::Mul(t.radius, per_across), side = hn::Mul(t.touching, per_across);
  const V p_a = hn::MulSub(n_x, t.across, hn::Mul(t.n_e, t.a)), p_b = hn::MulSub(n_x, t.across, hn::Mul(t.n_e, t.b));
  const V caps = hn::Add(cut_cap_arc(d, t, a, hn::Neg(hn::Mul(p_a, a.inverse))), cut_cap_arc(d, t, b, hn::Mul(p_b, b.inverse)));

  // Heights of the ends of both lines of contact: the line on the side of w is the higher one, b the higher end.
  const M has_side = hn::Gt(t.touching, zero);
  const V less = hn::Mul(hn::Mul(t.radius, per_tube), t.n_e), apart = hn::Mul(hn::Mul(t.radius, side), t.n_w);
  const V a_middle = hn::Sub(a.up, less), b_middle = hn::Sub(b.up, less);
  const V a_low = hn::Sub(a_middle, apart), a_high = hn::Add(a_middle, apart);
  const V b_low = hn::Sub(b_middle, apart), b_high = hn::Add(b_middle, apart);
  const M a_low_under = hn::Lt(a_low, zero), a_high_under = hn::Lt(a_high, zero);
  const M lengthwise = hn::Lt(b_low, zero), b_high_under = hn::Lt(b_high, zero);
  // Where the lines come up: the higher one, and what it has beyond the lower one.
  const V touching2 = hn::Mul(t.touching, t.touching);
  const auto angle_between = [&](V from, V to, V difference) {
    return angle_of(d, hn::Mul(t.touching, difference), hn::MulAdd(from, to, touching2));
  };
  const V gap = hn::IfThenElse(lengthwise, hn::Max(b_high, zero), hn::Min(hn::Max(hn::Neg(a_low), zero), hn::Add(apart, apart)));
  const V more = hn::Min(length, hn::Mul(gap, per_x)), rises = hn::MulAdd(hn::Max(hn::Neg(a_high), zero), per_x, t.a);
  const V high = hn::IfThenElse(lengthwise, hn::Sub(t.b, more), hn::Min(rises, t.b)), low = hn::Min(hn::Add(high, more), t.b);
  const V low_angle = hn::IfThenZeroElse(lengthwise, angle_between(low, t.b, hn::Sub(t.b, low)));
  const V beyond = angle_between(high, low, more);
  cancels = hn::And(has_side, hn::Gt(hn::Mul(beyond, t.n_w), hn::Mul(number(d, 3), per_tube)));
  const V sides = hn::MulSub(hn::Mul(per_tube, t.n_e), hn::MulAdd(two, low_angle, beyond), hn::Mul(hn::Mul(side, t.n_w), beyond));

  // The horizon's part: from the rightmost to the leftmost direction of its section. If it cuts a cap with the centre c, let c' be c's foot
  // in the horizon's plane. In the basis c' and n cross c' the tangents to the circle that is cut out of the cap, of the radius s, are (l,
  // +-s), l = sqrt(|c|^2 - R^2), those of the other cap (l +- i s) times its centre's foot, and the lines of contact rise at c + R m - x
  // height / n_x, with m the normals of the planes that touch the tube. If it cuts no cap, the lines rise at H p +- R r, p = n_x e - n_e x,
  // r = n_x w - n_w x.
  const M cuts_a = hn::Gt(a.section2, zero), cuts_b = hn::Gt(b.section2, zero), cuts_cap = hn::Or(cuts_a, cuts_b);
  const auto of_cut = [&](V of_a, V of_b) { return hn::IfThenElse(cuts_a, of_a, of_b); };
  struct Direction {
    V along, across;
  };
  const auto turn = [](const Direction& from, const Direction& to) {
    return hn::MulSub(from.along, to.across, hn::Mul(from.across, to.along));
  };
  const auto choose = [](M mask, const Direction& yes, const Direction& no) {
    return Direction{hn::IfThenElse(mask, yes.along, no.along), hn::IfThenElse(mask, yes.across, no.across)};
  };
  const V x = of_cut(t.a, t.b), p = of_cut(p_a, p_b), l = of_cut(a.tangent, b.tangent), s = of_cut(a.section, b.section);
  const V r_x = hn::Mul(t.radius, n_x), r_w = hn::Mul(t.radius, t.n_w), l2_x = hn::Mul(hn::Mul(l, l), n_x),
          across_w = hn::Mul(t.across, t.n_w);
  const V middle = hn::Mul(hn::Mul(x, per_tube), t.n_w), aside = hn::Mul(side, p);
  const V high_end = of_cut(a_high, b_high), low_end = of_cut(a_low, b_low);
  const Direction on_high{hn::NegMulAdd(high_end, x, l2_x), hn::MulAdd(high_end, across_w, hn::Mul(r_x, hn::Sub(aside, middle)))};
  const Direction on_low{hn::NegMulAdd(low_end, x, l2_x), hn::MulSub(low_end, across_w, hn::Mul(r_x, hn::Add(aside, middle)))};
  const Direction centre{hn::NegMulAdd(a.up, b.up, hn::MulAdd(t.a, t.b, hn::Mul(t.across, t.across))), hn::Neg(hn::Mul(length, across_w))};
  const V l_along = hn::Mul(b.tangent, centre.along), l_across = hn::Mul(b.tangent, centre.across);
  const Direction b_left{hn::NegMulAdd(b.section, centre.across, l_along), hn::MulAdd(b.section, centre.along, l_across)};
  const Direction b_right{hn::MulAdd(b.section, centre.across, l_along), hn::NegMulAdd(b.section, centre.along, l_across)};
  const M high_rises = hn::And(has_side, hn::AndNot(b_high_under, a_high_under));
  const M low_rises = hn::And(has_side, hn::AndNot(lengthwise, a_low_under)), cuts_both = hn::And(cuts_a, cuts_b);
  Direction left{l, s}, right{l, hn::Neg(s)};
  left = choose(hn::And(high_rises, hn::Gt(turn(left, on_high), zero)), on_high, left);
  left = choose(hn::And(cuts_both, hn::Gt(turn(left, b_left), zero)), b_left, left);
  right = choose(hn::And(low_rises, hn::Lt(turn(right, on_low), zero)), on_low, right);
  right = choose(hn::And(cuts_both, hn::Lt(turn(right, b_right), zero)), b_right, right);
  const V p2 = hn::MulAdd(n_x, n_x, hn::Mul(t.n_e, t.n_e)), r2 = hn::MulAdd(r_x, r_x, hn::Mul(r_w, r_w));
  const V sine = hn::IfThenElse(cuts_cap, turn(right, left), hn::Mul(hn::Mul(two, t.touching), r_x));
  const V cosine =
      hn::IfThenElse(cuts_cap, hn::MulAdd(left.along, right.along, hn::Mul(left.across, right.across)), hn::MulSub(touching2, p2, r2));
  const V horizon = angle_of(d, hn::Max(sine, zero), cosine);
  return hn::Mul(number(d, 0.5), hn::Add(hn::Add(caps, hn::IfThenElseZero(has_side, sides)),
                                         hn::IfThenElseZero(hn::Or(cuts_cap, hn::And(high_rises, low_rises)), horizon)));
}

// The view, and the squared distance from the axis' line.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE TubeView<V> tube_view(D d, const PlacedTube& light, const Point<V>& point, V& off2) {
  const V zero = hn::Zero(d), radius = number(d, light.radius), r2 = hn::Mul(radius, radius), length = number(d, light.length);
  const Vector<V> first = towards(d, light.a, point.position), axis = numbers(d, light.axis);
  TubeView<V> t;
  t.radius = radius;
  const V along = dot(first, axis);
  // Taken off once more, what rounding has left along the axis is small beside a small distance too.
  const auto without = [&](const Vector<V>& v, V part) {
    return Vector<V>{hn::NegMulAdd(part, axis.x, v.x), hn::NegMulAdd(part, axis.y, v.y), hn::NegMulAdd(part, axis.z, v.z)};
  };
  const Vector<V> nearly = without(first, along), off = without(nearly, dot(nearly, axis));
  off2 = dot(off, off);
  // On the axis any direction across it is e.
  const M on_axis = hn::Not(hn::Gt(off2, hn::Mul(number(d, in_floats<D> ? 1e-13 : 1e-30), hn::MulAdd(along, along, r2))));
  const Vector<V> e = chosen(on_axis, numbers(d, light.across), off);
  const V across = hn::Sqrt(off2), per_length = hn::Div(number(d, 1), hn::IfThenElse(on_axis, number(d, 1), across));
  t.across = hn::IfThenElse(on_axis, hn::Mul(number(d, 1e-8), radius), across);
  t.touching = hn::Sqrt(hn::Max(hn::Sub(hn::Mul(t.across, t.across), r2), zero));
  // b is the higher end.
  const V rise = dot(point.normal, axis);
  const M falls = hn::Lt(rise, zero);
  t.n_x = hn::Abs(rise);
  t.a = hn::IfThenElse(falls, hn::Neg(hn::Add(along, length)), along);
  t.b = hn::Add(t.a, length);
  t.n_e = hn::Mul(dot(point.normal, e), per_length);
  t.n_w = hn::Mul(hn::Abs(dot(point.normal, cross(axis, e))), per_length);
  const V tiny = number(d, in_floats<D> ? 1e-8 : 1e-17);
  t.n_e = hn::IfThenElse(hn::Lt(hn::Max(t.n_x, hn::Abs(t.n_e)), tiny), tiny, t.n_e);
  return t;
}

template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_tube(D d, const PlacedTube& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), radius = number(d, light.radius), r2 = hn::Mul(radius, radius), length = number(d, light.length);
  V off2;
  const TubeView<V> t = tube_view(d, light, point, off2);
  const CapView<V> a = cap_view(d, t, t.a, hn::Neg(t.a)), b = cap_view(d, t, t.b, t.b);
  const V lowest = hn::Sub(hn::Min(a.up, b.up), radius), highest = hn::Add(hn::Max(a.up, b.up), radius);
  const V nearest = hn::Add(hn::Max(t.a, zero), hn::Min(t.b, zero)), near2 = hn::MulAdd(nearest, nearest, hn::Mul(t.across, t.across));
  const M outside = hn::Gt(near2, r2), lit = hn::Gt(highest, zero), cut = hn::And(lit, hn::Lt(lowest, zero));

  const V inverse_ab = hn::Mul(a.inverse, b.inverse),
          angle = angle_of(d, hn::Mul(t.touching, length), hn::MulAdd(t.a, t.b, hn::Mul(t.touching, t.touching)));
  const V bracket =
      hn::MulAdd(hn::Mul(t.across, t.n_x), hn::Add(t.a, t.b), hn::Mul(t.n_e, hn::MulSub(t.across, t.across, hn::Mul(t.a, t.b))));
  const V sides = hn::MulAdd(angle, t.n_e, hn::Mul(hn::Mul(hn::Mul(t.touching, length), hn::Mul(inverse_ab, inverse_ab)), bracket));
  const auto cap = [&](const CapView<V>& c) { return hn::Mul(hn::Mul(c.up, c.inverse), hn::Mul(hn::Mul(c.inverse, c.inverse), c.half)); };
  V value = hn::MulAdd(hn::Div(radius, t.across), sides, hn::Mul(r2, hn::Add(cap(a), cap(b))));
  const M cut_and_seen = hn::And(cut, outside);
  M cancels = hn::FirstN(d, 0);
  if (!hn::AllFalse(d, cut_and_seen)) value = hn::IfThenElse(cut_and_seen, cut_tube(d, t, a, b, length, cancels), value);
  if constexpr (in_floats<D>) {
    const V size = hn::MulAdd(number(d, 2), radius, length), size2 = hn::Mul(size, size);
    const M at_surface = hn::Lt(hn::Sub(near2, r2), hn::MulAdd(number(d, 0.08), r2, hn::Mul(number(d, 1.2e-2), hn::Mul(radius, length))));
    const M rod = hn::Lt(hn::Mul(number(d, 1600), r2), near2);
    const M thin = hn::Lt(hn::Mul(number(d, 60), r2), near2),
            far = hn::Gt(near2, hn::Mul(hn::IfThenElse(rod, number(d, 4), number(d, 10)), size2));
    const M too_far = hn::Gt(near2, number(d, 1e12));
    // Close to the axis' line the distance from it is rounded as that of the tube's ends is.
    const V farther2 = hn::Max(hn::Mul(t.a, t.a), hn::Mul(t.b, t.b));
    // A cut tube's terms are of the order of its radius over its distance, whatever is left of them.
    const M little = hn::Lt(hn::Mul(value, t.across), hn::Mul(number(d, 0.02), radius));
    const M grazing = hn::Lt(hn::Mul(highest, highest), hn::Mul(number(d, 2e-2), farther2));
    const M end_on = hn::Lt(off2, hn::Mul(hn::IfThenElse(hn::Or(cut, grazing), number(d, 2e-2), number(d, 5e-3)), farther2));
    doubtful = hn::And(
        hn::Gt(highest, hn::Neg(hn::Mul(number(d, 1e-5), radius))),
        hn::Or(hn::Or(hn::Or(at_surface, end_on), too_far), hn::And(cut_and_seen, hn::Or(hn::Or(far, little), hn::And(thin, cancels)))));
  }
  value = hn::IfThenElse(outside, hn::Max(value, zero), light.white.two_sided ? number(d, pi) : zero);
  return hn::IfThenElseZero(hn::Or(lit, hn::Not(outside)), value);
}

struct TubeKernel {
  const PlacedTube& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_tube(d, light, point, doubtful);
  }
};
std::size_t OverTube(const PlacedTube& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, TubeKernel{light});
}

// The side alone. Directions in a plane through the point that contains the axis' direction, at the angle beta from e, meet it along a
// strip at the distance g across, D sin(beta) = R sin(t), g = D cos(beta) - R cos(t) = H^2 / (D cos(beta) + R cos(t)), with t the angle to
// the side's normal there. With x = g tan(psi) along it and n_u = n_e cos(beta) + n_w sin(beta) the strip gives
//     integral of (n_u cos(psi) + n_x sin(psi))+ cos(psi) dpsi,   dbeta = R cos(t) / (D cos(beta)) dt,
// in closed form, and all terms are positive: nothing cancels from contact to far away. Over t it is smooth above
// the horizon; with tan(t / 2) for t it is rational but for the roots. Gauss and Legendre's 12 nodes keep a fifth of the bound where
// D >= 1.1 R, 24 a thousandth where D >= 1.02 R.
template <class D, class V = hn::Vec<D>>
struct SideRow {
  const TubeView<V>& t;
  V length, ratio, touching2;

  // With n_u and n_x: twice the strip's integral, from x0 on for `part`.
  HWY_INLINE V strip(D d, V g, V n_u, V x0, V part) const {
    const V g2 = hn::Mul(g, g), product = hn::Mul(x0, t.b);
    const V q = hn::Mul(hn::MulAdd(x0, x0, g2), hn::MulAdd(t.b, t.b, g2)), moved = hn::Div(hn::Mul(g, part), q);
    const V angle = angle_of(d, hn::Mul(g, part), hn::Add(g2, product));
    return hn::MulAdd(n_u, hn::MulAdd(moved, hn::Sub(g2, product), angle), hn::Mul(hn::Mul(t.n_x, hn::Mul(g, moved)), hn::Add(x0, t.b)));
  }
  // f(weight, g, n_u) at tan(t / 2) = tau: weight = dbeta / dtau.
  template <class F>
  HWY_INLINE V at(D d, V tau, F f) const {
    const V one = number(d, 1), two = number(d, 2), tau2 = hn::Mul(tau, tau), per = hn::Div(two, hn::Add(one, tau2));
    const V sine = hn::Mul(tau, per), cosine = hn::Sub(per, one), sine_b = hn::Mul(ratio, sine);
    const V cosine_b = hn::Sqrt(hn::NegMulAdd(sine_b, sine_b, one));
    const V g = hn::Div(touching2, hn::MulAdd(t.across, cosine_b, hn::Mul(t.radius, cosine)));
    const V weight = hn::Div(hn::Mul(hn::Mul(ratio, cosine), per), cosine_b);
    return hn::Mul(weight, f(g, hn::MulAdd(t.n_e, cosine_b, hn::Mul(t.n_w, sine_b))));
  }
};

// tan(t / 2) where the horizon passes the rim at x, on either side; 1, the end, where it does not or that is not seen. With c and s the
// cosine and sine of the angle around the axis from -e:  D n_e + x n_x = R (n_e c - n_w s).
template <class D, class V = hn::Vec<D>>
HWY_INLINE std::array<V, 2> rim_crossings(D d, const TubeView<V>& t, V x) {
  const V zero = hn::Zero(d), one = number(d, 1), tiny = number(d, 1e-30);
  const V across2 = hn::MulAdd(t.n_e, t.n_e, hn::Mul(t.n_w, t.n_w)), inverse = hn::Div(one, hn::Sqrt(hn::Max(across2, tiny)));
  const V cosine = hn::Mul(hn::Div(hn::MulAdd(t.across, t.n_e, hn::Mul(x, t.n_x)), t.radius), inverse);
  const auto crosses = hn::Lt(hn::Abs(cosine), one);
  const V sine = hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, one), zero));
  std::array<V, 2> tau;
  for (std::size_t i = 0; i < 2; ++i) {
    const V turn = i == 0 ? sine : hn::Neg(sine);
    const V c = hn::Mul(hn::MulAdd(cosine, t.n_e, hn::Mul(turn, t.n_w)), inverse);
    const V s = hn::Mul(hn::NegMulAdd(cosine, t.n_w, hn::Mul(turn, t.n_e)), inverse);
    const V near = hn::NegMulAdd(t.radius, c, t.across), aside = hn::Mul(t.radius, s);
    const V facing = hn::MulSub(t.across, c, t.radius);
    const V along = hn::Add(hn::Sqrt(hn::MulAdd(near, near, hn::Mul(aside, aside))), facing);
    const auto seen = hn::And(crosses, hn::Gt(facing, zero));
    tau[i] = hn::IfThenElse(seen, hn::Max(hn::Min(hn::Div(hn::Mul(t.across, s), hn::Max(along, tiny)), one), hn::Neg(one)), one);
  }
  return tau;
}

// tan(t / 2) where n_u = 0, or 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V turning(D d, const TubeView<V>& t, V ratio) {
  const V one = number(d, 1), size = hn::Sqrt(hn::MulAdd(t.n_e, t.n_e, hn::Mul(t.n_w, t.n_w)));
  const V sine = hn::Div(hn::Neg(t.n_e), hn::Max(hn::Mul(size, ratio), number(d, 1e-30)));
  const V cosine = hn::Sqrt(hn::Max(hn::NegMulAdd(sine, sine, one), hn::Zero(d)));
  return hn::IfThenElse(hn::Lt(hn::Abs(sine), one), hn::Div(sine, hn::Add(one, cosine)), one);
}

// Between the places where the horizon passes a rim, and where n_u = 0: there the horizon runs along the tube, and a strip's lit part
// changes within an angle of n_x. 24 nodes, closer together at both ends of each piece: tau = middle + half (3 s - s^3) / 2.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V cut_side(D d, const SideRow<D>& row, M cut) {
  const TubeView<V>& t = row.t;
  const V zero = hn::Zero(d), n_x = hn::Max(t.n_x, number(d, in_floats<D> ? 1e-18 : 1e-150));
  const std::array<V, 2> at_a = rim_crossings(d, t, t.a), at_b = rim_crossings(d, t, t.b);
  std::array<V, 7> ends{number(d, -1), at_a[0], at_a[1], at_b[0], at_b[1], turning(d, t, row.ratio), number(d, 1)};
  for (std::size_t last = 5; last > 1; --last) {
    for (std::size_t k = 1; k < last; ++k) {
      const V lower = hn::Min(ends[k], ends[k + 1]);
      ends[k + 1] = hn::Max(ends[k], ends[k + 1]);
      ends[k] = lower;
    }
  }
  V sum = zero;
  for (std::size_t k = 0; k < 6; ++k) {
    const V half = hn::Mul(number(d, 0.5), hn::Sub(ends[k + 1], ends[k])), middle = hn::Mul(number(d, 0.5), hn::Add(ends[k + 1], ends[k]));
    if (hn::AllFalse(d, hn::And(cut, hn::Gt(half, zero)))) continue;
    V piece = zero;
    for (const GaussNode& node : gauss24()) {
      const double s2 = node.x * node.x;
      const V tau = hn::MulAdd(half, number(d, 0.5 * node.x * (3 - s2)), middle);
      const V part = row.at(d, tau, [&](V g, V n_u) ETENDUE_INLINE_LAMBDA {
        // Above the horizon up to b.
        const V above = hn::MulAdd(g, n_u, hn::Mul(t.b, t.n_x)), lit = hn::Min(hn::Div(hn::Max(above, zero), n_x), row.length);
        return hn::IfThenElseZero(hn::Gt(above, zero), row.strip(d, g, n_u, hn::Sub(t.b, lit), lit));
      });
      piece = hn::MulAdd(number(d, node.weight * 1.5 * (1 - s2)), part, piece);
    }
    sum = hn::MulAdd(half, piece, sum);
  }
  return hn::Mul(sum, number(d, 0.5));
}

template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_side(D d, const PlacedTube& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), radius = number(d, light.radius), r2 = hn::Mul(radius, radius), length = number(d, light.length);
  V off2;
  const TubeView<V> t = tube_view(d, light, point, off2);
  const V a_up = hn::MulAdd(t.across, t.n_e, hn::Mul(t.a, t.n_x)), b_up = hn::MulAdd(t.across, t.n_e, hn::Mul(t.b, t.n_x));
  const V lowest = hn::Sub(a_up, radius), highest = hn::Add(b_up, radius), across2 = hn::Mul(t.across, t.across);
  const M seen = hn::Gt(t.touching, zero), lit = hn::And(seen, hn::Gt(highest, zero)), cut = hn::And(lit, hn::Lt(lowest, zero));
  // Where nothing is seen anything finite will do.
  const V touching2 = hn::IfThenElse(seen, hn::Mul(t.touching, t.touching), across2);
  const SideRow<D> row{t, length, hn::Min(hn::Div(radius, t.across), number(d, 1)), touching2};
  const auto rule = [&] {
    if constexpr (in_floats<D>)
      return std::span<const GaussNode>(gauss12);
    else
      return std::span<const GaussNode>(gauss24());
  }();

  V value = zero;
  // Both signs of t side by side: the parts along w cancel.
  if (!hn::AllFalse(d, hn::AndNot(cut, lit))) {
    for (std::size_t i = rule.size() / 2; i < rule.size(); ++i) {
      const V part = row.at(d, number(d, rule[i].x), [&](V g, V n_u) ETENDUE_INLINE_LAMBDA {
        const V sine_part = hn::Mul(t.n_w, hn::Mul(row.ratio, number(d, 2 * rule[i].x / (1 + rule[i].x * rule[i].x))));
        return row.strip(d, g, hn::Sub(n_u, sine_part), t.a, length);
      });
      value = hn::MulAdd(number(d, rule[i].weight), part, value);
    }
  }
  if (!hn::AllFalse(d, cut)) value = hn::IfThenElse(cut, cut_side(d, row, cut), value);

  const M within = hn::And(hn::Le(across2, r2), hn::And(hn::Le(t.a, zero), hn::Ge(t.b, zero)));
  const V farther2 = hn::Max(hn::Mul(t.a, t.a), hn::Mul(t.b, t.b)), size = hn::MulAdd(number(d, 2), radius, length);
  const auto share = [&](V whole, double part) { return hn::Mul(whole, number(d, part)); };
  constexpr bool single = in_floats<D>;
  // Just outside of the infinite cylinder too few nodes; beside an end, within it, rounding says on which side.
  const V surface = single ? hn::MulAdd(share(radius, 1.2e-2), length, share(r2, 1.25)) : share(r2, 1.04);
  const M at_surface = hn::And(hn::Lt(across2, surface), hn::Or(seen, hn::Gt(across2, share(r2, single ? 0.99 : 1 - 1e-12))));
  const M at_end = hn::And(hn::Le(across2, r2), hn::Lt(hn::Min(hn::Abs(t.a), hn::Abs(t.b)), share(size, single ? 1e-5 : 1e-13)));
  const M end_on = hn::And(lit, hn::Lt(off2, share(farther2, single ? 2e-2 : 1e-14)));
  const M too_far = hn::Gt(hn::Add(across2, farther2), number(d, single ? 1e12 : 1e30));
  const M above = hn::Gt(highest, hn::Neg(share(radius, 1e-5)));
  doubtful = hn::Or(at_end, hn::And(above, hn::Or(hn::Or(at_surface, end_on), too_far)));
  value = hn::IfThenElseZero(lit, hn::Max(value, zero));
  return hn::IfThenElse(within, light.white.two_sided ? number(d, pi) : zero, value);
}

struct SideKernel {
  const PlacedTube& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_side(d, light, point, doubtful);
  }
};
std::size_t OverSide(const PlacedTube& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, SideKernel{light});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverTube);
HWY_EXPORT(OverSide);

class TubeBatch final : public LightBatch::Shape {
 public:
  explicit TubeBatch(const Emitter& white) : white_(white), tube_(std::get<TubeEmitter>(white.shape)) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const Vec3d span = tube_.b - tube_.a, axis = normalised(span);
    const double l = length(span), scale = unit_for(l + 2 * tube_.radius);
    const PlacedTube light{
        Place((tube_.a - points.origin) * scale), axis, basis_around(axis).tangent, l * scale, tube_.radius * scale, scale, white_};
    if (tube_.caps == Caps::round) return HWY_DYNAMIC_DISPATCH(OverTube)(light, points, sr, where_none);
    return HWY_DYNAMIC_DISPATCH(OverSide)(light, points, sr, where_none);
  }

 private:
  Emitter white_;
  TubeEmitter tube_;
};

// A tube is convex: what is seen of its side and of the ends that face the point does not hide each other.
class ClosedTubeBatch final : public LightBatch::Shape {
 public:
  explicit ClosedTubeBatch(const Emitter& white) {
    Emitter side = white, end = white;
    auto& tube = std::get<TubeEmitter>(side.shape);
    tube.caps = Caps::none;
    side_ = std::make_unique<TubeBatch>(side);
    const Vec3d axis = normalised(tube.b - tube.a), across = basis_around(axis).tangent;
    end.two_sided = false;
    end.shape = DiskEmitter{tube.a, -axis, across, tube.radius};
    ends_[0] = disk_batch(end);
    end.shape = DiskEmitter{tube.b, axis, across, tube.radius};
    ends_[1] = disk_batch(end);
  }
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const std::size_t without = side_->over(points, sr, where_none);
    std::array<float, 256> part;
    for (std::size_t i = 0; i < sr.size(); i += part.size()) {
      const std::size_t count = std::min(part.size(), sr.size() - i);
      const auto some = [&](std::span<const float> all) { return all.subspan(i, count); };
      const PointBatch few{some(points.px), some(points.py), some(points.pz), some(points.nx),
                           some(points.ny), some(points.nz), points.origin};
      for (const auto& end : ends_) {
        end->over(few, {part.data(), count}, 0);
        for (std::size_t k = 0; k < count; ++k) sr[i + k] += part[k];
      }
    }
    return without;
  }

 private:
  std::unique_ptr<TubeBatch> side_;
  std::array<std::shared_ptr<const LightBatch::Shape>, 2> ends_;
};

}  // namespace

// Without a length a tube with round caps is a sphere.
std::shared_ptr<const LightBatch::Shape> tube_batch(const Emitter& white) {
  const auto& tube = std::get<TubeEmitter>(white.shape);
  if (!(tube.radius > 0)) return nullptr;
  if (length(tube.b - tube.a) > 0) {
    if (tube.caps != Caps::flat) return std::make_shared<TubeBatch>(white);
    return std::make_shared<ClosedTubeBatch>(white);
  }
  if (tube.caps != Caps::round) return nullptr;
  Emitter ball = white;
  ball.shape = SphereEmitter{tube.a, tube.radius};
  return sphere_batch(ball);
}

}  // namespace etendue::eval
#endif
