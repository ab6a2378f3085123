// What the kernels of method_batch.h share, once for each instruction set: include it after HWY_TARGET_INCLUDE and hwy/foreach_target.h.
#if defined(ETENDUE_METHOD_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_METHOD_BATCH_INL_H
#undef ETENDUE_METHOD_BATCH_INL_H
#else
#define ETENDUE_METHOD_BATCH_INL_H
#endif

#include "eval/light_batch-inl.h"
#include "eval/method_batch.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

using Floats = hn::ScalableTag<float>;
using Lanes = hn::Vec<Floats>;
using Lit = hn::Mask<Floats>;
using Vector3 = Vector<Lanes>;

HWY_INLINE Lanes number(float x) { return hn::Set(Floats(), x); }
HWY_INLINE Vector3 numbers(const Vec3f& v) { return {number(v.x), number(v.y), number(v.z)}; }
HWY_INLINE Vector3 scaled(const Vector3& v, Lanes s) { return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)}; }
// a + b s
HWY_INLINE Vector3 along(const Vector3& a, const Vector3& b, Lanes s) {
  return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}
HWY_INLINE Vector3 opposite(const Vector3& v) { return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}; }
HWY_INLINE Lanes inverse_length(const Vector3& v) { return inverse_sqrt(Floats(), dot(v, v)); }
HWY_INLINE Vector3 unit(const Vector3& v) { return scaled(v, inverse_length(v)); }
HWY_INLINE Lanes saturate(Lanes x) { return hn::Min(hn::Max(x, number(0)), number(1)); }
HWY_INLINE Lanes within(Lanes x, Lanes half) { return hn::Min(hn::Max(x, hn::Neg(half)), half); }
HWY_INLINE Lanes positive(Lanes x) { return hn::Max(x, number(0)); }
HWY_INLINE Lanes cosine_towards(const Vector3& p, const Vector3& n) { return saturate(hn::Mul(dot(n, p), inverse_length(p))); }
// 1 / x to 12 bits or more.
HWY_INLINE Lanes near_inverse(Lanes x) { return hn::ApproximateReciprocal(x); }

// Within 2e-8 for |x| <= 1 (Abramowitz and Stegun 4.4.46), beyond as at 1.
HWY_INLINE Lanes arc_cosine(Lanes x) {
  const Floats d;
  const Lanes y = hn::Abs(x);
  const Lanes p = polynomial(
      d, y, std::array{1.5707963050, -0.2145988016, 0.0889789874, -0.0501743046, 0.0308918810, -0.0170881256, 0.0066700901, -0.0012624911});
  const Lanes angle = hn::Mul(hn::Sqrt(positive(hn::Sub(number(1), y))), p);
  return hn::IfThenElse(hn::Lt(x, number(0)), hn::Sub(number(static_cast<float>(pi)), angle), angle);
}

// kernel(position, normal), inlined, at every point; what is not finite becomes 0. How many points are not finite.
template <class Kernel>
HWY_INLINE std::size_t over_points(const PointBatch& points, std::span<float> out, float where_none, Kernel kernel) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d), count = out.size();
  std::size_t without = 0;
  const auto step = [&](const std::array<const float*, 6>& in, float* to) ETENDUE_INLINE_LAMBDA {
    const Vector3 position{hn::LoadU(d, in[0]), hn::LoadU(d, in[1]), hn::LoadU(d, in[2])};
    const Vector3 normal{hn::LoadU(d, in[3]), hn::LoadU(d, in[4]), hn::LoadU(d, in[5])};
    // No number less itself is zero, and neither is infinity.
    const auto part = [](const Vector3& v)
                          ETENDUE_INLINE_LAMBDA { return hn::Add(hn::Sub(v.x, v.x), hn::Add(hn::Sub(v.y, v.y), hn::Sub(v.z, v.z))); };
    const Lit valid = hn::Eq(hn::Add(part(position), part(normal)), number(0));
    const Lanes value = kernel(position, normal);
    const Lanes finite = hn::IfThenElseZero(hn::Lt(hn::Abs(value), number(1e30f)), value);
    hn::StoreU(hn::IfThenElse(valid, finite, number(where_none)), d, to);
    if (HWY_UNLIKELY(!hn::AllTrue(d, valid))) without += lanes - hn::CountTrue(d, valid);
  };
  const std::array<const float*, 6> all{points.px.data(), points.py.data(), points.pz.data(),
                                        points.nx.data(), points.ny.data(), points.nz.data()};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) step({all[0] + i, all[1] + i, all[2] + i, all[3] + i, all[4] + i, all[5] + i}, out.data() + i);
  if (i < count) {
    // The last points stand in a vector of their own.
    HWY_ALIGN std::array<std::array<float, hn::MaxLanes(d)>, 7> last{};
    for (std::size_t k = 0; k < 6; ++k) std::copy(all[k] + i, all[k] + count, last[k].begin());
    step({last[0].data(), last[1].data(), last[2].data(), last[3].data(), last[4].data(), last[5].data()}, last[6].data());
    std::copy_n(last[6].begin(), count - i, out.data() + i);
  }
  return without;
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
