// What the kernels of SpecularMethodBatch share, once for each instruction set: include it after HWY_TARGET_INCLUDE and
// hwy/foreach_target.h.
#if defined(ETENDUE_SPECULAR_METHOD_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_METHOD_INL_H
#undef ETENDUE_SPECULAR_METHOD_INL_H
#else
#define ETENDUE_SPECULAR_METHOD_INL_H
#endif

#include "eval/specular_batch-inl.h"
#include "eval/specular_method_rules.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// To 12 bits on any machine.
HWY_INLINE Lanes rough_inverse(Lanes x) {
#if HWY_ARCH_X86 && HWY_TARGET < HWY_EMU128
  return near_inverse(x);
#else
  return hn::Div(number(1), x);
#endif
}

HWY_INLINE Lanes near_root(Lanes x) { return hn::Mul(x, near_inverse_sqrt(Floats(), hn::Max(x, number(1e-30f)))); }

// The light stands for a small one in that direction, of any length: BRDF times cosine there, D with `density_alpha`, times the factor.
struct SmallLight {
  Vector3 direction;
  Lanes factor, density_alpha;
};
struct LobeLanes {
  ViewFrame frame;
  Vector3 eye;
  Lanes alpha;
  Vector3 mirror() const { return {hn::Neg(frame.sine), number(0), frame.cosine}; }
  // n.l G2 / (4 n.v n.l); `near`: to 12 bits.
  template <bool near>
  HWY_INLINE Lanes seen_area(Lanes z) const {
    const Lanes alpha2 = hn::Mul(alpha, alpha);
    const auto root = [&](Lanes x) ETENDUE_INLINE_LAMBDA {
      const Lanes x2 = hn::Mul(x, x), square = hn::MulAdd(alpha2, hn::Sub(number(1), x2), x2);
      if constexpr (near) return hn::Mul(square, near_inverse_sqrt(Floats(), square));
      return hn::Sqrt(square);
    };
    const Lanes below = hn::MulAdd(z, root(frame.cosine), hn::Mul(frame.cosine, root(z))), half = hn::Mul(number(0.5f), z);
    if constexpr (near) return hn::Mul(half, rough_inverse(below));
    return hn::Mul(half, inverse(Floats(), below));
  }
  // Of a value without Fresnel's term, with the length of v + l; nothing where it is no number.
  HWY_INLINE static Shares split(Lanes value, Lanes length, Lit above) {
    const Lanes zero = number(0), away = positive(hn::NegMulAdd(number(0.5f), length, number(1))), away2 = hn::Mul(away, away);
    const Lit lit = hn::And(above, hn::And(hn::Ge(value, zero), hn::Lt(value, number(1e30f))));
    const Lanes seen = hn::IfThenElseZero(lit, value), of_f90 = hn::Mul(seen, hn::Mul(away, hn::Mul(away2, away2)));
    return {hn::Sub(seen, of_f90), of_f90};
  }
  HWY_INLINE Shares lit_by(const SmallLight& light) const {
    const Vector3 l = unit(light.direction), sum = frame.view() + l;
    const Lanes across = hn::MulAdd(sum.x, sum.x, hn::Mul(sum.y, sum.y)), along2 = hn::Mul(sum.z, sum.z), total = hn::Add(across, along2);
    const Lanes a2 = hn::Mul(light.density_alpha, light.density_alpha),
                wide = hn::Mul(total, inverse(Floats(), hn::MulAdd(a2, along2, across)));
    const Lanes density = hn::Mul(hn::Mul(a2, number(static_cast<float>(1 / pi))), hn::Mul(wide, wide));
    return split(hn::Mul(hn::Mul(density, light.factor), seen_area<false>(l.z)), hn::Sqrt(total), hn::Gt(l.z, number(0)));
  }
};

// Up to a right angle, by the series.
HWY_INLINE Lanes sine_of(Lanes x) {
  const Lanes p = polynomial(Floats(), hn::Mul(x, x), std::array{1.0, -1 / 6.0, 1 / 120.0, -1 / 5040.0, 1 / 362880.0, -1 / 39916800.0});
  return hn::Mul(x, p);
}
HWY_INLINE Lanes cosine_of(Lanes x) { return sine_of(hn::Sub(number(static_cast<float>(pi / 2)), hn::Abs(x))); }
HWY_INLINE Lanes length_of(const Vector3& v) { return hn::Sqrt(dot(v, v)); }
HWY_INLINE Lanes square(Lanes x) { return hn::Mul(x, x); }

// Of a cone about the mirrored view: its half angle's tangent, infinite from a right angle on.
template <PublishedRule rule>
HWY_INLINE Lanes cone_tangent(Lanes alpha) {
  if constexpr (rule == PublishedRule::drobot_20) return hn::Div(sine_of(alpha), cosine_of(alpha));
  // fitted_cone of cones.h: twice the angle with that squared sine.
  const Lanes one = number(1), a2 = square(alpha);
  const Lanes sine2 = hn::Mul(number(static_cast<float>(0.6487212707001282)), hn::Div(a2, hn::Max(hn::Sub(one, a2), number(1e-9f))));
  const Lanes below = hn::NegMulAdd(number(2), sine2, one);
  const Lanes tangent = hn::Div(hn::Mul(number(2), hn::Sqrt(hn::Mul(sine2, positive(hn::Sub(one, sine2))))), hn::Max(below, number(1e-9f)));
  return hn::IfThenElse(hn::Gt(below, number(1e-9f)), tangent, number(1e18f));
}
// DiskOverlap of cones.h.
struct Overlap {
  Lanes share, middle;
};
HWY_INLINE Overlap disk_overlap(Lanes first, Lanes second, Lanes apart) {
  const Lanes smaller = hn::Min(first, second), outer = hn::Add(first, second);
  const Lanes from = hn::Max(hn::Neg(first), hn::Sub(apart, second)), to = hn::Min(first, hn::Add(apart, second));
  const Lanes x = saturate(hn::Div(hn::Sub(outer, apart), hn::Add(smaller, smaller)));
  return {hn::Mul(hn::Mul(x, x), hn::NegMulAdd(number(2), x, number(3))), hn::Mul(number(0.5f), hn::Add(from, to))};
}
// At the middle of an area of a flat light.
HWY_INLINE SmallLight small_area(const Vector3& middle, Lanes area, Lanes height, Lanes alpha) {
  const Lanes over = inverse_length(middle);
  return {middle, hn::Mul(hn::Mul(area, height), hn::Mul(over, hn::Mul(over, over))), alpha};
}
// Karis' point of a sphere.
HWY_INLINE Vector3 closest_to_ray(const Vector3& centre, Lanes radius, const Vector3& r) {
  const Vector3 to_ray = scaled(r, dot(centre, r)) - centre;
  return along(centre, to_ray, hn::Min(hn::Mul(radius, inverse_sqrt(Floats(), hn::Max(dot(to_ray, to_ray), number(1e-30f)))), number(1)));
}
// Eq 10.
HWY_INLINE Lanes widened(Lanes alpha, Lanes size, Lanes over_distance) {
  return saturate(hn::MulAdd(hn::Mul(number(1.0f / 3), size), over_distance, alpha));
}
HWY_INLINE Lanes falloff(const Vector3& point) { return inverse(Floats(), hn::Add(dot(point, point), number(1))); }
// Eden's.
HWY_INLINE Lanes between_alphas(Lanes alpha, Lanes radius, const Vector3& point) {
  return hn::Sqrt(hn::Mul(alpha, saturate(hn::MulAdd(hn::Mul(number(0.5f), radius), inverse_length(point), alpha))));
}
// light(position, lobe, lit) gives the shares at every point. How many points are not finite.
template <class Light>
HWY_INLINE std::size_t over_points_and_views(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                                             float where_none, const Light& light) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d), count = of_f0.size();
  const PointBatch& s = points.surface;
  const std::array<const float*, 10> all{s.px.data(), s.py.data(),      s.pz.data(),      s.nx.data(),      s.ny.data(),
                                         s.nz.data(), points.vx.data(), points.vy.data(), points.vz.data(), points.alpha.data()};
  std::size_t without = 0;
  const auto step = [&](const std::array<const float*, 10>& in, std::size_t i, float* to, float* to_90) ETENDUE_INLINE_LAMBDA {
    const auto at = [&](std::size_t k) ETENDUE_INLINE_LAMBDA {
      return Vector3{hn::LoadU(d, in[k] + i), hn::LoadU(d, in[k + 1] + i), hn::LoadU(d, in[k + 2] + i)};
    };
    const Vector3 position = at(0), normal = at(3), view = at(6);
    const Lanes alpha = hn::LoadU(d, in[9] + i);
    const Lanes nothing = hn::Add(less_itself(position, normal), hn::Add(less_itself(view, view), hn::Sub(alpha, alpha)));
    const Lit valid = hn::Eq(nothing, number(0));
    const LobeLanes lobe{view_frame(normal, view), unit(view), hn::Min(hn::Max(alpha, number(1e-4f)), number(1))};
    Lit lit = hn::Gt(lobe.frame.cosine, number(0));
    const Shares shares = light(position, lobe, lit);
    hn::StoreU(hn::IfThenElse(valid, hn::IfThenElseZero(lit, shares.of_f0), number(where_none)), d, to);
    hn::StoreU(hn::IfThenElse(valid, hn::IfThenElseZero(lit, shares.of_f90), number(where_none)), d, to_90);
    if (HWY_UNLIKELY(!hn::AllTrue(d, valid))) without += lanes - hn::CountTrue(d, valid);
  };
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) step(all, i, of_f0.data() + i, of_f90.data() + i);
  if (i < count) {
    // The last points stand in a vector of their own.
    HWY_ALIGN std::array<std::array<float, hn::MaxLanes(d)>, 12> last{};
    std::array<const float*, 10> in{};
    for (std::size_t k = 0; k < 10; ++k) {
      std::copy(all[k] + i, all[k] + count, last[k].begin());
      in[k] = last[k].data();
    }
    step(in, 0, last[10].data(), last[11].data());
    std::copy_n(last[10].begin(), count - i, of_f0.data() + i);
    std::copy_n(last[11].begin(), count - i, of_f90.data() + i);
  }
  return without;
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
