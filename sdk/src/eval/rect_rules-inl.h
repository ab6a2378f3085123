// Rules of ours for a rectangle at many points, in the light's own frame, where sides are straight along x and y; for kernels as
// rect_batch.cpp.
#if defined(ETENDUE_RECT_RULES_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_RECT_RULES_INL_H
#undef ETENDUE_RECT_RULES_INL_H
#else
#define ETENDUE_RECT_RULES_INL_H
#endif

#include "eval/light_batch-inl.h"
#include "eval/quadrature.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

template <class V>
struct Framed {
  V x, y, z, n_x, n_y, n_z;  // of the centre and the surface's normal; the light faces along z, z < 0 is its front
  V half_x, half_y;
};
// The integral of h n.p / r^4 over the area, n.p at every node no less than 0. over(r^2): its inverse.
template <std::size_t N, class D, class V = hn::Vec<D>, class Inverse>
HWY_INLINE V by_nodes(D d, const Framed<V>& f, const std::array<GaussNode, N>& nodes, Inverse over) {
  std::array<V, N> y2{}, y_up{};
  const V z2 = hn::Mul(f.z, f.z), z_up = hn::Mul(f.z, f.n_z);
  each<N>([&](auto j) ETENDUE_INLINE_LAMBDA {
    const V y = hn::MulAdd(number(d, nodes[j].x), f.half_y, f.y);
    y2[j] = hn::MulAdd(y, y, z2), y_up[j] = hn::MulAdd(y, f.n_y, z_up);
  });
  V sum = number(d, 0);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const V x = hn::MulAdd(number(d, nodes[i].x), f.half_x, f.x);
    V row = number(d, 0);
    each<N>([&](auto j) ETENDUE_INLINE_LAMBDA {
      const V near = over(hn::MulAdd(x, x, y2[j])), up = hn::Max(hn::MulAdd(x, f.n_x, y_up[j]), number(d, 0));
      row = hn::MulAdd(hn::Mul(hn::Mul(near, near), number(d, nodes[j].weight)), up, row);
    });
    sum = hn::MulAdd(row, number(d, nodes[i].weight), sum);
  });
  return hn::Mul(hn::Mul(hn::Neg(f.z), hn::Mul(f.half_x, f.half_y)), sum);
}

// theta / sin(theta) in t = 1 - cos(theta) up to a right angle: of all polynomials of their degree that are 1 at 0 the one with the least
// relative error, 8e-8 in floats, 9e-12 in doubles.
template <std::size_t N, class D, class V = hn::Vec<D>>
HWY_INLINE std::array<V, N> acute_over_sine(D d, const std::array<V, N>& t) {
  if constexpr (in_floats<D>)
    return polynomials(
        d, t,
        std::array{1.0, 0.333325869, 0.133567985, 0.054650157, 0.0380049009, -0.0229278993, 0.0581812321, -0.0411491849, 0.0171431505});
  else
    return polynomials(
        d, t,
        std::array{1.0, 0.333333335490827665, 0.133333165812088345, 0.0571473861329587773, 0.0253354483959348994, 0.0120317642055017757,
                   0.00285570742681832968, 0.0108695833934349916, -0.0183202255033167033, 0.031818403117336351, -0.0338931510428726671,
                   0.0245468570597019362, -0.0103538050042205083, 0.00209185729692948743});
}

// Lambert's sum, half of it and turned, of the light that is seen from its front; and how far roundings may have taken it.
template <class V>
struct EdgeSum {
  V value;              // less than 0 from behind
  V terms;              // of magnitudes that the value's digits were lost from
  V nearest, farthest;  // one over the distance of the corners, and of sides that pass beside the point
};
// theta / sin(theta) of each edge, of the cosines. Where an angle is obtuse, pi - theta stands for theta, with the sign turned.
template <std::size_t N, class V, class M>
struct Angles {
  std::array<V, N> over_sine;
  std::array<M, N> obtuse;
  bool any_obtuse;
};
template <std::size_t N, class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE Angles<N, V, M> angles_of(D d, const std::array<V, N>& cosine) {
  std::array<V, N> t = cosine;
  V least = cosine[0];
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    t[i] = hn::Sub(number(d, 1), hn::Abs(cosine[i]));
    least = hn::Min(least, cosine[i]);
  });
  Angles<N, V, M> angles;
  angles.over_sine = acute_over_sine(d, t);
  angles.any_obtuse = !hn::AllTrue(d, hn::Ge(least, number(d, 0)));
  if (angles.any_obtuse) each<N>([&](auto i) ETENDUE_INLINE_LAMBDA { angles.obtuse[i] = hn::Lt(cosine[i], number(d, 0)); });
  return angles;
}

// Lambert's sum over the sides above the horizon, and over the horizon between them.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE EdgeSum<V> by_edges(D d, const Framed<V>& f) {
  const V x0 = hn::Sub(f.x, f.half_x), x1 = hn::Add(f.x, f.half_x), y0 = hn::Sub(f.y, f.half_y), y1 = hn::Add(f.y, f.half_y);
  const V z2 = hn::Mul(f.z, f.z);
  const V bottom2 = hn::MulAdd(y0, y0, z2), top2 = hn::MulAdd(y1, y1, z2), left2 = hn::Mul(x0, x0), right2 = hn::Mul(x1, x1);
  // One over the distances of the corners, counter-clockwise from (x0, y0).
  const std::array<V, 4> near{inverse_root(d, hn::Add(left2, bottom2)), inverse_root(d, hn::Add(right2, bottom2)),
                              inverse_root(d, hn::Add(right2, top2)), inverse_root(d, hn::Add(left2, top2))};
  // n.(a x unit vector along the side) of the bottom, right, top and left one.
  const V m_y = hn::Mul(f.n_y, f.z), m_x = hn::Mul(f.n_x, f.z);
  const std::array<V, 4> m{hn::NegMulAdd(f.n_z, y0, m_y), hn::MulSub(f.n_z, x1, m_x), hn::MulSub(f.n_z, y1, m_y),
                           hn::NegMulAdd(f.n_z, x0, m_x)};
  // The magnitudes of both terms of m, half way between opposite sides.
  const V most_x = hn::MulAdd(hn::Abs(f.n_z), hn::Abs(f.y), hn::Abs(m_y)), most_y = hn::MulAdd(hn::Abs(f.n_z), hn::Abs(f.x), hn::Abs(m_x));
  const std::array<V, 4> other2{bottom2, hn::Add(right2, z2), top2, hn::Add(left2, z2)};
  const std::array<V, 4> begin{x0, y0, x1, y1}, end{x1, y1, x0, y0};
  V nearest = hn::Max(hn::Max(near[0], near[1]), hn::Max(near[2], near[3]));
  const V farthest = hn::Min(hn::Min(near[0], near[1]), hn::Min(near[2], near[3]));
  // The corners' heights over the horizon.
  const V up_z = hn::Mul(f.n_z, f.z), up_bottom = hn::MulAdd(f.n_y, y0, up_z), up_top = hn::MulAdd(f.n_y, y1, up_z);
  const std::array<V, 4> up{hn::MulAdd(f.n_x, x0, up_bottom), hn::MulAdd(f.n_x, x1, up_bottom), hn::MulAdd(f.n_x, x1, up_top),
                            hn::MulAdd(f.n_x, x0, up_top)};
  const M all = hn::Ge(hn::Min(hn::Min(up[0], up[1]), hn::Min(up[2], up[3])), number(d, 0));
  if (hn::AllTrue(d, all)) {
    std::array<V, 4> cosine = m, part = m;
    each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
      part[i] = hn::Mul(near[i], near[(i + 1) % 4]);
      cosine[i] = hn::Mul(hn::MulAdd(begin[i], end[i], other2[i]), part[i]);
    });
    const Angles<4, V, M> angles = angles_of(d, cosine);
    each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { part[i] = hn::Mul(part[i], angles.over_sine[i]); });
    if (angles.any_obtuse) {
      const V over_width = hn::Div(number(d, 0.5 * pi), f.half_x), over_height = hn::Div(number(d, 0.5 * pi), f.half_y);
      each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
        const V closeness = inverse_root(d, other2[i]);
        part[i] = hn::IfThenElse(angles.obtuse[i], hn::MulSub(closeness, i % 2 == 0 ? over_width : over_height, part[i]), part[i]);
        nearest = hn::Max(nearest, hn::IfThenElseZero(angles.obtuse[i], closeness));
      });
    }
    const V along_x = hn::MulAdd(part[0], m[0], hn::Mul(part[2], m[2])), along_y = hn::MulAdd(part[1], m[1], hn::Mul(part[3], m[3]));
    const V sum = hn::MulAdd(along_x, f.half_x, hn::Mul(along_y, f.half_y));
    const V terms =
        hn::MulAdd(hn::Mul(hn::Add(part[0], part[2]), most_x), f.half_x, hn::Mul(hn::Mul(hn::Add(part[1], part[3]), most_y), f.half_y));
    return {hn::Neg(sum), terms, nearest, farthest};
  }
  const std::array<M, 4> above{hn::Ge(up[0], number(d, 0)), hn::Ge(up[1], number(d, 0)), hn::Ge(up[2], number(d, 0)),
                               hn::Ge(up[3], number(d, 0))};
  const M some = hn::Or(hn::Or(above[0], above[1]), hn::Or(above[2], above[3]));
  // Where the sides' lines meet the horizon, within the sides.
  const auto over = [&](V a) ETENDUE_INLINE_LAMBDA {
    return inverse(d, hn::IfThenElse(hn::Lt(hn::Abs(a), number(d, 1e-20)), number(d, 1e-20), a));
  };
  const V over_x = over(hn::Neg(f.n_x)), over_y = over(hn::Neg(f.n_y));
  const auto between = [&](V low, V x, V high) ETENDUE_INLINE_LAMBDA { return hn::Min(hn::Max(x, low), high); };
  const std::array<V, 4> crossing{between(x0, hn::Mul(up_bottom, over_x), x1),
                                  between(y0, hn::Mul(hn::MulAdd(f.n_x, x1, up_z), over_y), y1), between(x0, hn::Mul(up_top, over_x), x1),
                                  between(y0, hn::Mul(hn::MulAdd(f.n_x, x0, up_z), over_y), y1)};
  const auto place = [&](M bottom, M right, M top) ETENDUE_INLINE_LAMBDA {
    const auto one_of = [&](V a, V b, V c, V e) ETENDUE_INLINE_LAMBDA {
      return hn::IfThenElse(bottom, a, hn::IfThenElse(right, b, hn::IfThenElse(top, c, e)));
    };
    return std::array<V, 2>{one_of(crossing[0], x1, crossing[2], x0), one_of(y0, crossing[1], y1, crossing[3])};
  };
  const auto gone = place(hn::AndNot(above[1], above[0]), hn::AndNot(above[2], above[1]), hn::AndNot(above[3], above[2]));
  const auto risen = place(hn::AndNot(above[0], above[1]), hn::AndNot(above[1], above[2]), hn::AndNot(above[2], above[3]));
  const auto near_of = [&](const std::array<V, 2>& p)
                           ETENDUE_INLINE_LAMBDA { return inverse_root(d, hn::MulAdd(p[0], p[0], hn::MulAdd(p[1], p[1], z2))); };
  const V near_gone = near_of(gone), near_risen = near_of(risen);
  std::array<V, 5> cosine{z2, z2, z2, z2, z2};
  std::array<V, 4> part = m;
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    constexpr std::size_t j = (i + 1) % 4;
    const V from = hn::IfThenElse(above[i], begin[i], crossing[i]), to = hn::IfThenElse(above[j], end[i], crossing[i]);
    const V product = hn::Mul(hn::IfThenElse(above[i], near[i], near_risen), hn::IfThenElse(above[j], near[j], near_gone));
    const V length = hn::IfThenElseZero(hn::Or(above[i], above[j]), i < 2 ? hn::Sub(to, from) : hn::Sub(from, to));
    part[i] = hn::Mul(length, product);
    cosine[i] = hn::IfThenElse(hn::Or(above[i], above[j]), hn::Mul(hn::MulAdd(from, to, other2[i]), product), number(d, 1));
  });
  const M cut = hn::AndNot(all, some);
  const V dx = hn::Sub(risen[0], gone[0]), dy = hn::Sub(risen[1], gone[1]), product = hn::Mul(near_gone, near_risen);
  const V turn = hn::MulSub(gone[0], dy, hn::Mul(gone[1], dx));
  const V whole = hn::MulAdd(f.z, hn::MulSub(f.n_y, dx, hn::Mul(f.n_x, dy)), hn::Mul(f.n_z, turn));
  const V across = hn::IfThenElseZero(cut, hn::Mul(whole, product));
  cosine[4] = hn::IfThenElse(cut, hn::Mul(hn::MulAdd(gone[0], risen[0], hn::MulAdd(gone[1], risen[1], z2)), product), number(d, 1));
  const Angles<5, V, M> angles = angles_of(d, cosine);
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { part[i] = hn::Mul(part[i], angles.over_sine[i]); });
  V sum = hn::Mul(across, angles.over_sine[4]);
  if (angles.any_obtuse) {
    each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
      const V closeness = inverse_root(d, other2[i]);
      part[i] = hn::IfThenElse(angles.obtuse[i], hn::MulSub(closeness, number(d, pi), part[i]), part[i]);
      nearest = hn::Max(nearest, hn::IfThenElseZero(angles.obtuse[i], closeness));
    });
    // Along the horizon |a x b| = |n.(a x b)|, and what is seen lies on the normal's side: it has the sign of z, which half a turn from a
    // to b leaves no digit of.
    sum = hn::IfThenElse(angles.obtuse[4], hn::Sub(hn::CopySign(number(d, pi), f.z), sum), sum);
  }
  V terms = hn::Abs(sum);
  terms = hn::MulAdd(hn::Add(part[0], part[2]), most_x, hn::MulAdd(hn::Add(part[1], part[3]), most_y, terms));
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { sum = hn::MulAdd(part[i], m[i], sum); });
  return {hn::Mul(sum, number(d, -0.5)), hn::Mul(terms, number(d, 0.5)), nearest, farthest};
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
