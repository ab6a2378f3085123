// The moments of specular_moments.cpp for lanes of points; for kernels as specular_rect_batch.cpp.
#if defined(ETENDUE_SPECULAR_MOMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_MOMENTS_INL_H
#undef ETENDUE_SPECULAR_MOMENTS_INL_H
#else
#define ETENDUE_SPECULAR_MOMENTS_INL_H
#endif

#include "eval/specular_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// Enclosed of specular_moments.cpp, every sum times a number of its own: 2, 2, 6, 6, 12, 12, 24. Moments are about a place of the outline,
// and the area is what lies between the straight chords, which needs no digits far away, and the rest of great circles.
struct MomentSums {
  Vector3 place;
  Lanes rest, flat, x, y, xx, yy, xy;
};
HWY_INLINE void add_chord(const Vector3& from, const Vector3& to, Lanes part, MomentSums& sums) {
  const Vector3 step = to - from;
  const Lanes ax = hn::Sub(from.x, sums.place.x), ay = hn::Sub(from.y, sums.place.y);
  const Lanes bx = hn::Sub(to.x, sums.place.x), by = hn::Sub(to.y, sums.place.y);
  const Lanes about_middle = hn::MulSub(from.x, step.y, hn::Mul(from.y, step.x));
  sums.rest = hn::MulAdd(hn::Mul(part, about_middle), over_sine_less_one(from, step), sums.rest);
  const Lanes turn = hn::Mul(part, hn::MulSub(ax, by, hn::Mul(ay, bx))), x = hn::Add(ax, bx), y = hn::Add(ay, by);
  sums.flat = hn::Add(sums.flat, turn);
  sums.x = hn::MulAdd(turn, x, sums.x);
  sums.y = hn::MulAdd(turn, y, sums.y);
  sums.xx = hn::MulAdd(turn, hn::NegMulAdd(ax, bx, hn::Mul(x, x)), sums.xx);
  sums.yy = hn::MulAdd(turn, hn::NegMulAdd(ay, by, hn::Mul(y, y)), sums.yy);
  sums.xy = hn::MulAdd(turn, hn::MulAdd(ax, ay, hn::MulAdd(bx, by, hn::Mul(x, y))), sums.xy);
}

// h' at a place of a side and how it changes there, times the same factor.
struct CurvePlace {
  Vector3 h, speed;
};
// h' of a circle of directions times 1 + (u t)^2: a quadratic in t from -1 to 1.
struct Quadratic {
  Vector3 c0, c1, c2;
  Lanes u2;
  Vector3 at(Lanes t) const { return along(c0, along(c1, c2, t), t); }
  CurvePlace middle() const { return {c0, c1}; }
  CurvePlace place(Lanes t) const {
    const Vector3 h = at(t);
    const Lanes ut = hn::Mul(u2, t), grown = hn::Mul(hn::Add(ut, ut), near_inverse(hn::MulAdd(ut, t, number(1))));
    return {h, along(along(c1, c2, hn::Add(t, t)), h, hn::Neg(grown))};
  }
};
HWY_INLINE Vector3 bent(const Vector3& v, Lanes over_alpha) { return {hn::Mul(v.x, over_alpha), hn::Mul(v.y, over_alpha), v.z}; }
// Of a part of a circle of directions: its middle is centre + outwards, `onwards` its direction there, both as long as the radius.
HWY_INLINE Quadratic bent_arc(const Vector3& centre, const Vector3& outwards, const Vector3& onwards, Lanes tan_quarter,
                              const Vector3& view, Lanes over_alpha) {
  const Lanes u2 = hn::Mul(tan_quarter, tan_quarter);
  const Vector3 base = view + centre;
  return {bent(base + outwards, over_alpha), scaled(bent(onwards, over_alpha), hn::Add(tan_quarter, tan_quarter)),
          scaled(bent(base - outwards, over_alpha), u2), u2};
}
// Where the nodes lie need not be exact: roots and inverses to 12 bits.
HWY_INLINE Lanes near_root(Lanes x) { return hn::Mul(x, near_inverse_sqrt(Floats(), hn::Max(x, number(1e-30f)))); }
// The same of a part of a circle in space: b(t) is a quadratic too, but its length is a root, h' = M (v + b / |b|), here times |b|.
struct RimPart {
  Vector3 b0, b1, b2, view;
  Lanes over_alpha;
  Vector3 from_view(const Vector3& b) const { return bent(along(b, view, near_root(dot(b, b))), over_alpha); }
  Vector3 at(Lanes t) const {
    const Vector3 b = along(b0, along(b1, b2, t), t);
    return bent(along(b, view, hn::Sqrt(dot(b, b))), over_alpha);
  }
  CurvePlace middle() const { return place_of(b0, b1); }
  CurvePlace place(Lanes t) const { return place_of(along(b0, along(b1, b2, t), t), along(b1, b2, hn::Add(t, t))); }

 private:
  HWY_INLINE CurvePlace place_of(const Vector3& b, const Vector3& onwards) const {
    const Lanes inwards = hn::Neg(hn::Mul(dot(b, onwards), near_inverse(hn::Max(dot(b, b), number(1e-30f)))));
    return {from_view(b), bent(along(onwards, b, inwards), over_alpha)};
  }
};
HWY_INLINE RimPart bent_rim(const Vector3& centre, const Vector3& outwards, const Vector3& onwards, Lanes tan_quarter, const Vector3& view,
                            Lanes over_alpha) {
  return {centre + outwards, scaled(onwards, hn::Add(tan_quarter, tan_quarter)),
          scaled(centre - outwards, hn::Mul(tan_quarter, tan_quarter)), view, over_alpha};
}
// Of the great circle from a to b, unit vectors: with s = a + b and the cosine of half the angle c = |s| / 2, its middle is s / |s|, and
// u = tan of a quarter of the angle, u^2 = (1 - c) / (1 + c) = |b - a|^2 / (4 (1 + c)^2).
HWY_INLINE Quadratic bent_side(const Vector3& a, const Vector3& b, const Vector3& view, Lanes over_alpha) {
  const Floats d;
  const Vector3 sum = a + b, step = b - a;
  const Lanes squared = hn::Max(dot(sum, sum), number(1e-12f)), over_length = inverse_sqrt(d, squared);
  const Lanes over = inverse(d, hn::MulAdd(hn::Mul(number(0.5f), squared), over_length, number(1)));
  const Lanes u2 = hn::Mul(hn::Mul(number(0.25f), dot(step, step)), hn::Mul(over, over));
  const Vector3 middle = scaled(sum, over_length);
  return {bent(view + middle, over_alpha), scaled(bent(step, over_alpha), over), scaled(bent(view - middle, over_alpha), u2), u2};
}
template <class Curve>
HWY_INLINE void add_side(const Curve& side, Lit seen, MomentSums& sums) {
  const Floats d;
  const Lanes one = number(1);
  Lanes nearest = number(0), width = one;
  each<2>([&](auto turn) ETENDUE_INLINE_LAMBDA {
    const auto [h, speed] = turn == 0 ? side.middle() : side.place(nearest);
    const Lanes over = near_inverse(hn::Max(dot(speed, speed), number(1e-30f))), onwards = dot(h, speed);
    const Lanes shift = hn::Mul(onwards, over);
    if constexpr (turn == 1) width = hn::Mul(hn::NegMulAdd(onwards, shift, dot(h, h)), over);
    nearest = within(hn::Sub(nearest, shift), one);
  });
  // One over what is 1 / 4.5 of the width, and half of that.
  const Lanes over_width = hn::Min(near_inverse_sqrt(d, hn::Max(hn::Mul(width, number(1 / (4.5f * 4.5f))), number(1e-12f))), number(1e6f));
  const Lanes half_width = hn::Mul(number(0.5f), near_inverse(over_width));
  // e^u at the ends and between them: sinh(u) = (e^u - e^-u) / 2.
  const auto exponential = [&](Lanes from) ETENDUE_INLINE_LAMBDA {
    const Lanes x = hn::Mul(from, over_width), y = hn::Abs(x), e = hn::Add(y, near_root(hn::MulAdd(y, y, one)));
    return hn::IfThenElse(hn::Lt(x, number(0)), near_inverse(e), e);
  };
  const Lanes first = exponential(hn::Sub(number(-1), nearest)), last = exponential(hn::Sub(one, nearest));
  const Lanes middle = near_root(hn::Mul(first, last));
  const auto node = [&](Lanes e)
                        ETENDUE_INLINE_LAMBDA { return unit(side.at(hn::MulAdd(half_width, hn::Sub(e, near_inverse(e)), nearest))); };
  const std::array<Vector3, 5> at{unit(side.at(number(-1))), node(near_root(hn::Mul(first, middle))), node(middle),
                                  node(near_root(hn::Mul(middle, last))), unit(side.at(one))};
  const Lanes four_thirds = hn::IfThenElseZero(seen, number(4.0f / 3)), third = hn::IfThenElseZero(seen, number(-1.0f / 3));
  for (std::size_t i = 0; i < 4; ++i) add_chord(at[i], at[i + 1], four_thirds, sums);
  for (std::size_t i = 0; i < 4; i += 2) add_chord(at[i], at[i + 2], third, sums);
}

HWY_INLINE Shares shares_of(const MomentSums& sums, Lanes alpha, const ViewFrame& frame) {
  const Floats d;
  const Lanes zero = number(0), one = number(1);
  const Lanes over = inverse(d, hn::Mul(sums.flat, number(3))), from_x = hn::Mul(sums.x, over), from_y = hn::Mul(sums.y, over);
  const Lanes x = hn::Add(sums.place.x, from_x), y = hn::Add(sums.place.y, from_y);
  const Lanes half = hn::Mul(over, number(0.5f)), quarter = hn::Mul(over, number(0.25f));
  const Lanes least = number(1e-12f);
  const Lanes xx = hn::Max(hn::NegMulAdd(from_x, from_x, hn::Mul(sums.xx, half)), least);
  const Lanes yy = hn::NegMulAdd(from_y, from_y, hn::Mul(sums.yy, half));
  const Lanes xy = hn::NegMulAdd(from_x, from_y, hn::Mul(sums.xy, quarter));
  // (a, b) and (0, c) are u and w.
  const Lanes over_a = inverse_sqrt(d, xx), a = hn::Mul(xx, over_a), b = hn::Mul(xy, over_a);
  const Lanes c = hn::Sqrt(positive(hn::NegMulAdd(b, b, yy)));
  const Lanes rim = hn::NegMulAdd(number(0.1f), hn::Max(hn::NegMulAdd(x, x, hn::NegMulAdd(y, y, one)), least), one);
  const Lanes alpha2 = hn::Mul(alpha, alpha);
  const auto root = [&](Lanes z) ETENDUE_INLINE_LAMBDA {
    const Lanes z2 = hn::Mul(z, z);
    return hn::Sqrt(hn::MulAdd(alpha2, hn::Sub(one, z2), z2));
  };
  const Lanes view_root = root(frame.cosine);
  Lanes of_f0 = zero, of_f90 = zero;
  const auto add = [&](Lanes across, Lanes up) ETENDUE_INLINE_LAMBDA {
    const Lanes squared = hn::MulAdd(across, across, hn::Mul(up, up));
    const Lanes inwards = hn::IfThenElse(hn::Gt(squared, rim), hn::Mul(hn::Sqrt(rim), inverse_sqrt(d, squared)), one);
    const Vector3 bent{hn::Mul(alpha, hn::Mul(across, inwards)), hn::Mul(alpha, hn::Mul(up, inwards)),
                       hn::Sqrt(hn::Sub(one, hn::Min(squared, rim)))};
    const Vector3 h = unit(bent);
    const Lanes v_dot_h = hn::MulAdd(frame.sine, h.x, hn::Mul(frame.cosine, h.z));
    const Lanes n_dot_l = hn::MulSub(hn::Add(v_dot_h, v_dot_h), h.z, frame.cosine);
    const Lanes below = hn::Mul(h.z, hn::MulAdd(n_dot_l, view_root, hn::Mul(frame.cosine, root(n_dot_l))));
    const Lit seen = hn::And(hn::Gt(v_dot_h, zero), hn::Gt(n_dot_l, zero));
    const Lanes shape = hn::IfThenElseZero(seen, hn::Div(hn::Mul(n_dot_l, v_dot_h), below));
    const Lanes away = positive(hn::Sub(one, v_dot_h)), away2 = hn::Mul(away, away);
    const Lanes grazing = hn::Mul(shape, hn::Mul(away, hn::Mul(away2, away2)));
    of_f90 = hn::Add(of_f90, grazing);
    of_f0 = hn::Add(of_f0, hn::Sub(shape, grazing));
  };
  constexpr float p = 1.30656296f, q = 0.541196100f;
  const Lanes far_x = hn::Mul(a, number(p)), far_y = hn::MulAdd(b, number(p), hn::Mul(c, number(q)));
  const Lanes near_x = hn::Mul(a, number(q)), near_y = hn::NegMulAdd(b, number(q), hn::Mul(c, number(p)));
  add(hn::Add(x, far_x), hn::Add(y, far_y));
  add(hn::Sub(x, far_x), hn::Sub(y, far_y));
  add(hn::Sub(x, near_x), hn::Add(y, near_y));
  add(hn::Add(x, near_x), hn::Sub(y, near_y));
  // 2 / 4 of the nodes, and the area is half of its sum.
  const Lanes twice = hn::Add(sums.flat, sums.rest);
  const Lanes area = hn::IfThenElseZero(hn::Gt(sums.flat, zero), hn::Mul(positive(twice), number(static_cast<float>(0.25 / pi))));
  const Lanes most = hn::Mul(area, hn::Add(of_f0, of_f90));
  const Lanes kept = hn::Mul(area, hn::Min(one, inverse(d, hn::Max(most, number(1e-30f)))));
  return {hn::Mul(of_f0, kept), hn::Mul(of_f90, kept)};
}

template <class Curve, std::size_t N>
HWY_INLINE void add_sides(const std::array<Curve, N>& sides, const std::array<Lit, N>& seen, MomentSums& sums) {
  // A loop that is left one: sides are hundreds of instructions each.
  for (std::size_t i = 0; i < N; ++i) add_side(sides[i], seen[i], sums);
}
// `from`: a direction of the outline; add(sums) adds its sides.
HWY_INLINE Shares by_moments(const ViewFrame& frame, Lanes alpha, const Vector3& from, const auto& add) {
  const Lanes zero = number(0);
  MomentSums sums{unit(bent(frame.view() + from, inverse(Floats(), alpha))), zero, zero, zero, zero, zero, zero, zero};
  add(sums);
  return shares_of(sums, alpha, frame);
}
struct ByMoments {
  static constexpr bool in_units = true;
  template <std::size_t N>
  HWY_INLINE Shares operator()(const ViewFrame& frame, Lanes alpha, const Outline<N>& light) const {
    const Lanes over_alpha = inverse(Floats(), alpha);
    std::array<Quadratic, N> sides{};
    Vector3 from = light.from[0];
    for (std::size_t i = N; i-- > 0;) {
      sides[i] = bent_side(light.from[i], light.to[i], frame.view(), over_alpha);
      from = chosen(light.seen[i], light.from[i], from);
    }
    return by_moments(frame, alpha, from, [&](MomentSums& sums) ETENDUE_INLINE_LAMBDA { add_sides(sides, light.seen, sums); });
  }
};

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
