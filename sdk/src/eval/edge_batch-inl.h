// Edges of flat lights in vectors, so that nothing cancels far away; for kernels as polygon_batch.cpp.
#if defined(ETENDUE_EDGE_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_EDGE_BATCH_INL_H
#undef ETENDUE_EDGE_BATCH_INL_H
#else
#define ETENDUE_EDGE_BATCH_INL_H
#endif

#include "eval/light_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// Lambert's sum over the edges, value = -1/2 sum of n.(a x b) theta / |a x b|, loses (distance / size) digits twice over as written.
// Against a length r close to all distances it does not: sum of n.(a x b) is n.N twice the area, and what is left of each edge,
//     theta / |a x b| - 1 / r^2 = ((theta / sin theta) (r^2 / |a||b|) - 1) / r^2,
// is found from the ends' (a^2 - r^2) / r^2 and the length's square, all of which are as small as the light: with x = r^-4 a^2 b^2 - 1,
// e = (1 + x)^(-1/2) - 1 and k = a.b / r^2 - 1 it is (1 + (1 - cos) p)(1 + e) - 1, 1 - cos = -(k + e + k e).

// (theta / sin(theta) - 1) / t of t = 1 - cos(theta), up to a right angle: relative error 1e-7 in floats, 2e-15 in doubles.
template <std::size_t N, class D, class V = hn::Vec<D>>
HWY_INLINE std::array<V, N> angle_over_sine_rests(D d, const std::array<V, N>& t) {
  if constexpr (in_floats<D>)
    return polynomials(d, t,
                       std::array{0.3333333637, 0.1333284358, 0.05727148323, 0.02411409888, 0.01784092271, -0.01161207318, 0.02821458834,
                                  -0.01994595728, 0.008251405879});
  else
    return polynomials(
        d, t,
        std::array{0.333333333333333808, 0.133333333332990933, 0.0571428571838049924, 0.0253968234598179477, 0.0115440598000856352,
                   0.00532727451748744947, 0.00249372581673435872, 0.0011187955223941452, 0.000814398819293731566, -0.00071607865514276917,
                   0.00290991324000537366, -0.00595025974298644611, 0.00990830316124906714, -0.0122685651482933913, 0.0113810137293022661,
                   -0.00761557400996455376, 0.00350138714005974618, -0.000991259280245957699, 0.000132844574969350185});
}

// An edge's ends a and b: (a^2 - r^2) / r^2, (b^2 - r^2) / r^2, their sum, of which a caller may know more digits, and half of the squared
// length over r^2.
template <class V>
struct Edge {
  V from, to, sum, half_length2;
};
// a^2 b^2 / r^4 and a.b / r^2.
template <class V>
struct Products {
  V squares, dot;
};
// theta r^2 / |a x b| - 1 of each edge. Where an angle is obtuse, pi - theta stands for theta, with the sign turned: the caller adds
// pi r^2 / |a x b|.
template <std::size_t N, class V, class M>
struct EdgeRests {
  std::array<V, N> rest;
  std::array<M, N> obtuse;
  bool any_obtuse;
};
// Lanes that need more care: `near`, with an end so close that the squares' difference has lost their digits, which products(i) has; `far`,
// where the first guess at a root is farther off than all the edge.
template <class M>
struct Special {
  M near, far;
};
template <std::size_t N, class D, class V = hn::Vec<D>, class M = hn::Mask<D>, class Exact>
HWY_INLINE EdgeRests<N, V, M> edge_rests(D d, const std::array<Edge<V>, N>& edges, const Special<M>& special, Exact products) {
  const V one = number(d, 1), half = number(d, 0.5);
  std::array<V, N> k, x, square, dot, q, e, t;
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    k[i] = hn::MulSub(half, edges[i].sum, edges[i].half_length2);
    x[i] = hn::MulAdd(edges[i].from, edges[i].to, edges[i].sum);
    square[i] = hn::Add(one, x[i]);
    dot[i] = one;
  });
  const M near = special.near;
  const bool any_special = !hn::AllFalse(d, hn::Or(near, special.far));
  if (HWY_UNLIKELY(any_special)) {
    each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
      const Products<V> exact = products(i);
      square[i] = hn::IfThenElse(near, exact.squares, square[i]);
      dot[i] = exact.dot;
    });
  }
  // Of q close to (1 + x)^(-1/2): q - 1 is exact, and so is the remainder (1 + x) q^2 - 1 to its own digits.
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    q[i] = near_inverse_sqrt(d, square[i]);
    if (HWY_UNLIKELY(any_special)) q[i] = hn::IfThenElse(special.far, one, q[i]);
    e[i] = hn::Sub(q[i], one);
  });
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const V h = hn::MulAdd(e[i], e[i], hn::Add(e[i], e[i]));
    V remainder = hn::MulAdd(x[i], h, hn::Add(x[i], h));
    if (HWY_UNLIKELY(any_special)) remainder = hn::IfThenElse(near, hn::MulSub(hn::Mul(square[i], q[i]), q[i], one), remainder);
    e[i] = hn::NegMulAdd(hn::Mul(q[i], remainder), hn::NegMulAdd(remainder, number(d, 0.375), half), e[i]);
  });
  EdgeRests<N, V, M> rests;
  M any = hn::FirstN(d, 0);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    t[i] = hn::NegMulSub(k[i], e[i], hn::Add(k[i], e[i]));
    if (HWY_UNLIKELY(any_special)) t[i] = hn::IfThenElse(near, hn::NegMulAdd(dot[i], hn::Add(one, e[i]), one), t[i]);
    rests.obtuse[i] = hn::Gt(t[i], one);
    any = hn::Or(any, rests.obtuse[i]);
  });
  rests.any_obtuse = !hn::AllFalse(d, any);
  if (rests.any_obtuse) each<N>([&](auto i) ETENDUE_INLINE_LAMBDA { t[i] = hn::Min(t[i], hn::Sub(number(d, 2), t[i])); });
  const std::array<V, N> over_sine = angle_over_sine_rests(d, t);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const V f = hn::Mul(t[i], over_sine[i]);
    rests.rest[i] = hn::MulAdd(f, e[i], hn::Add(f, e[i]));
  });
  if (rests.any_obtuse) {
    each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
      rests.rest[i] = hn::IfThenElse(rests.obtuse[i], hn::Sub(number(d, -2), rests.rest[i]), rests.rest[i]);
    });
  }
  return rests;
}

// Which side of a flat light is seen.
template <class M>
struct Sides {
  M front, seen;
  M unsure;  // its height is lost in rounding
};
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE Sides<M> sides_of(D d, V z, V r2, bool two_sided) {
  const M front = hn::Lt(z, hn::Zero(d)), unsure = hn::Lt(hn::Mul(z, z), hn::Mul(r2, number(d, in_floats<D> ? 2.5e-13 : 1e-18)));
  return {front, two_sided ? hn::Or(front, hn::Gt(z, hn::Zero(d))) : front, unsure};
}

// What may cancel in a flat light's value.
//   Seen edge-on, the part of the sum that is not along its plane is the small rest of two that are not (`shine`), and its height has few
//   digits itself. What of the `longer` side's square is more than the area does not cancel in the sum's rounding.
//   Where an edge or a corner is close, what is seen turns with the direction to it, and a rounding of the point turns that: by one over
//   the distance of the edge that passes beside the point (`closest`), or of the closest end (`least`, of all ends' (a^2 - r^2) / r^2).
template <class V>
struct Cancellation {
  V value, n_z, z, r2, per_r2, area, longer, closest, least;
};
// Where floats are not enough. An estimate, in units of 1e-6, aimed at .7 of LightBatch's bound; its factors are no proof but were set by
// the search of tests/stress, which at random finds nothing over the bound and uphill now and then a case a little over it.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE M cancels(D d, const Cancellation<V>& c) {
  if constexpr (in_floats<D>) {
    const V inverse_r = near_inverse_sqrt(d, c.r2), bulk = hn::Mul(hn::Mul(c.longer, c.longer), number(d, 0.2));
    // |n.(a x unit vector along an edge)| is no more than |n_z| r + |z|.
    const V leaning = hn::Abs(c.n_z), across = hn::MulAdd(hn::Abs(c.z), inverse_r, leaning);
    const V shine = hn::Mul(hn::MulAdd(bulk, across, hn::Mul(c.area, leaning)), c.per_r2);
    const V solid_angle = hn::Mul(hn::Mul(hn::Abs(c.z), inverse_r), hn::Mul(c.area, c.per_r2));
    const V nearness = hn::Max(hn::Add(c.least, number(d, 1)), number(d, 1e-6));
    const V to_end = hn::IfThenElseZero(hn::Lt(nearness, number(d, 0.25)), near_inverse_sqrt(d, nearness));
    const V error =
        hn::MulAdd(hn::Max(hn::Mul(hn::Mul(c.closest, c.r2), inverse_r), to_end), number(d, 0.1), hn::Mul(shine, number(d, 0.75)));
    const V allowed = hn::MulAdd(hn::Abs(c.value), number(d, 7), hn::Mul(solid_angle, number(d, 1.4)));
    const M lost = hn::Or(hn::Gt(error, allowed), hn::Lt(c.least, number(d, -0.9998)));
    const M flat = hn::Lt(hn::Mul(hn::Abs(c.z), inverse_r), number(d, 0.02));
    return hn::Or(lost, hn::And(flat, hn::Lt(hn::Abs(c.value), number(d, 0.05))));
  } else {
    return hn::Lt(c.least, number(d, -1 + 1e-9));
  }
}
// least: as Cancellation's. Beyond 1e4 times its reach all of a light's ends are within 8e-4 of r^2.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE Special<M> special_at(D d, V least, V r2, V reach2) {
  const M near = hn::Lt(least, number(d, -0.55));
  if constexpr (in_floats<D>) return {near, hn::Gt(r2, hn::Mul(reach2, number(d, 1e8)))};
  return {near, hn::FirstN(d, 0)};
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
