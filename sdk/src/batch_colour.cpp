// Colours of temperatures and sRGB, many at once.
#include "etendue/batch.h"

#include "etendue/colour_space.h"

#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch_colour.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "simd-inl.h"

#include <array>
#include <cstddef>

#ifndef ETENDUE_BATCH_COLOUR_SHARED
#define ETENDUE_BATCH_COLOUR_SHARED
namespace etendue {
namespace {
#include "colour_fits.inc"

constexpr float coldest_K = 800, hottest_K = 100000;
// X, Y and X + Y + Z, or R, G and B, of a Planckian radiator up to a common factor: polynomials of s = 800 K / T in colour_fits.inc, here
// times t^7, t = T / 800 K, which saves a division. The factor 1e-30 makes room for t^7 up to the 10^9 that stand for infinity.
constexpr std::size_t planckian_terms = std::size(planckian_s);
using PlanckianPolynomials = std::array<std::array<float, planckian_terms>, 3>;
}  // namespace
}  // namespace etendue
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {

template <class D, class V>
HWY_INLINE V polynomial(D d, const std::array<float, planckian_terms>& c, V t) {
  V sum = hn::Set(d, c[planckian_terms - 1]);
  for (std::size_t i = planckian_terms - 1; i-- > 0;) sum = hn::MulAdd(sum, t, hn::Set(d, c[i]));
  return sum;
}

template <class D, class V>
HWY_INLINE V reduced(D d, V kelvin) {
  return hn::Mul(hn::Min(kelvin, hn::Set(d, 1e9f * coldest_K)), hn::Set(d, 1 / coldest_K));
}
// 800 K to 100000 K, and infinity.
template <class D, class V>
HWY_INLINE auto has_planckian(D d, V kelvin) {
  return hn::And(hn::Ge(kelvin, hn::Set(d, coldest_K)), hn::Or(hn::Le(kelvin, hn::Set(d, hottest_K)), hn::IsInf(kelvin)));
}

std::size_t PlanckianXy(const float* kelvin, const PlanckianPolynomials& polynomials, float* xy, std::size_t count, Vec2f where_none) {
  const hn::ScalableTag<float> d;
  const PlanckianPolynomials p = polynomials;  // out of reach of what is written: its numbers stay in registers
  std::size_t without = 0;
  for_each_vector<1, 2>(d, kelvin, xy, count, coldest_K, [&](const float* from, float* to) {
    const auto k = hn::LoadU(d, from);
    const auto valid = has_planckian(d, k);
    const auto t = reduced(d, k);
    const auto scale = hn::Div(hn::Set(d, 1.0f), polynomial(d, p[2], t));
    const auto x = hn::Mul(polynomial(d, p[0], t), scale), y = hn::Mul(polynomial(d, p[1], t), scale);
    if (HWY_LIKELY(hn::AllTrue(d, valid))) return hn::StoreInterleaved2(x, y, d, to);
    hn::StoreInterleaved2(hn::IfThenElse(valid, x, hn::Set(d, where_none.x)), hn::IfThenElse(valid, y, hn::Set(d, where_none.y)), d, to);
    without += hn::CountTrue(d, hn::Not(valid));
  });
  return without;
}

std::size_t PlanckianRgb(const float* kelvin, const PlanckianPolynomials& polynomials, float* rgb, std::size_t count, Vec3f where_none) {
  const hn::ScalableTag<float> d;
  const PlanckianPolynomials p = polynomials;
  const StoreThree store(d);
  std::size_t without = 0;
  for_each_vector<1, 3>(d, kelvin, rgb, count, coldest_K, [&](const float* from, float* to) {
    const auto k = hn::LoadU(d, from);
    const auto valid = has_planckian(d, k);
    const auto t = reduced(d, k);
    const auto r = polynomial(d, p[0], t), g = polynomial(d, p[1], t), b = polynomial(d, p[2], t);
    const auto luminance = hn::MulAdd(r, hn::Set(d, 0.2126f), hn::MulAdd(g, hn::Set(d, 0.7152f), hn::Mul(b, hn::Set(d, 0.0722f))));
    const auto scale = hn::Div(hn::Set(d, 1.0f), luminance);
    const auto red = hn::Mul(r, scale), green = hn::Mul(g, scale), blue = hn::Mul(b, scale);
    if (HWY_LIKELY(hn::AllTrue(d, valid))) return store(d, red, green, blue, to);
    store(d, hn::IfThenElse(valid, red, hn::Set(d, where_none.x)), hn::IfThenElse(valid, green, hn::Set(d, where_none.y)),
          hn::IfThenElse(valid, blue, hn::Set(d, where_none.z)), to);
    without += hn::CountTrue(d, hn::Not(valid));
  });
  return without;
}

void SrgbToLinear(const float* encoded, float* linear, std::size_t count) {
  const hn::ScalableTag<float> d;
  for_each_vector<1, 1>(d, encoded, linear, count, 0.0f, [&](const float* from, float* to) {
    const auto v = hn::LoadU(d, from);
    const auto curved = power_of(d, hn::MulAdd(v, hn::Set(d, 1 / 1.055f), hn::Set(d, 0.055f / 1.055f)), 2.4);
    const auto straight = hn::Mul(v, hn::Set(d, 1 / 12.92f));
    hn::StoreU(hn::IfThenElse(hn::Gt(v, hn::Set(d, 0.04045f)), curved, straight), d, to);
  });
}

void LinearToSrgb(const float* linear, float* encoded, std::size_t count) {
  const hn::ScalableTag<float> d;
  for_each_vector<1, 1>(d, linear, encoded, count, 0.0f, [&](const float* from, float* to) {
    const auto v = hn::LoadU(d, from);
    const auto curved = hn::MulSub(power_of(d, v, 1 / 2.4), hn::Set(d, 1.055f), hn::Set(d, 0.055f));
    const auto straight = hn::Mul(v, hn::Set(d, 12.92f));
    hn::StoreU(hn::IfThenElse(hn::Gt(v, hn::Set(d, 0.0031308f)), curved, straight), d, to);
  });
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(PlanckianXy);
HWY_EXPORT(PlanckianRgb);
HWY_EXPORT(SrgbToLinear);
HWY_EXPORT(LinearToSrgb);

static_assert(sizeof(Vec2f) == 2 * sizeof(float) && sizeof(Vec3f) == 3 * sizeof(float));

// R, G, B are linear in X, Y, Z, and so are their polynomials' coefficients.
PlanckianPolynomials polynomials(const Matrix3& from_xyz) {
  PlanckianPolynomials made;
  for (std::size_t k = 0; k < planckian_terms; ++k) {
    const double x = planckian_x[k], y = planckian_y[k];
    const Vec3d channels = from_xyz * Vec3d{x, y, planckian_s[k] - x - y};
    constexpr double room = 1e-30;
    for (int i = 0; i < 3; ++i) made[static_cast<std::size_t>(i)][planckian_terms - 1 - k] = static_cast<float>(channels[i] * room);
  }
  return made;
}

}  // namespace

BatchOutcome planckian(std::span<const float> temperature_K, std::span<Vec2f> xy, Vec2f where_none) {
  if (temperature_K.size() != xy.size()) return batch_sizes_differ(temperature_K.size(), xy.size());
  static const PlanckianPolynomials x_y_sum = polynomials({{1, 0, 1}, {0, 1, 1}, {0, 0, 1}});
  return HWY_DYNAMIC_DISPATCH(PlanckianXy)(temperature_K.data(), x_y_sum, reinterpret_cast<float*>(xy.data()), xy.size(), where_none);
}

BatchOutcome planckian_rgb(std::span<const float> temperature_K, std::span<Vec3f> rgb, Vec3f where_none) {
  if (temperature_K.size() != rgb.size()) return batch_sizes_differ(temperature_K.size(), rgb.size());
  static const PlanckianPolynomials r_g_b = polynomials(xyz_to_rgb(rec709));
  return HWY_DYNAMIC_DISPATCH(PlanckianRgb)(temperature_K.data(), r_g_b, reinterpret_cast<float*>(rgb.data()), rgb.size(), where_none);
}

Status srgb_to_linear(std::span<const float> encoded, std::span<float> linear) {
  if (encoded.size() != linear.size()) return batch_sizes_differ(encoded.size(), linear.size());
  HWY_DYNAMIC_DISPATCH(SrgbToLinear)(encoded.data(), linear.data(), encoded.size());
  return Done{};
}

Status linear_to_srgb(std::span<const float> linear, std::span<float> encoded) {
  if (linear.size() != encoded.size()) return batch_sizes_differ(linear.size(), encoded.size());
  HWY_DYNAMIC_DISPATCH(LinearToSrgb)(linear.data(), encoded.data(), linear.size());
  return Done{};
}

}  // namespace etendue
#endif  // HWY_ONCE
