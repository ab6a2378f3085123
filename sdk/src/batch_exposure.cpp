// Exposure values and plain factors, many at once.
#include "etendue/batch.h"

#include "batch_error.h"
#include "parameter_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch_exposure.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "simd-inl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#ifndef ETENDUE_BATCH_EXPOSURE_SHARED
#define ETENDUE_BATCH_EXPOSURE_SHARED
namespace etendue {
namespace {
// 2^EV K/100 = 2^(whole + f) factor, EV = whole - shift + f, factor = K/100 2^-shift near 1. EV is held where the luminance is a normal
// float.
struct EvScale {
  float shift, factor, lowest_ev, highest_ev;
};
}  // namespace
}  // namespace etendue
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {

constexpr float largest = std::numeric_limits<float>::max();

// The factor as f (1 + rest), f rounded towards zero, since one float alone would cost up to an ulp more. rest > 0 keeps infinities from
// meeting their opposites.
void Scaled(const float* in, float factor, float rest, float* out, std::size_t count) {
  const hn::ScalableTag<float> d;
  const auto f = hn::Set(d, factor), r = hn::Set(d, rest), highest = hn::Set(d, largest), lowest = hn::Set(d, -largest);
  for_each_vector<1, 1>(d, in, out, count, 0.0f, [&](const float* from, float* to) {
    const auto product = hn::Mul(hn::LoadU(d, from), f);
    hn::StoreU(held_within(lowest, hn::MulAdd(product, r, product), highest), d, to);
  });
}

std::size_t LuminanceOfEv100(const float* ev100, EvScale scale, float* luminance, std::size_t count, float where_none) {
  const hn::ScalableTag<float> d;
  const auto shift = hn::Set(d, scale.shift), factor = hn::Set(d, scale.factor), none = hn::Set(d, where_none);
  const auto lowest = hn::Set(d, scale.lowest_ev), highest = hn::Set(d, scale.highest_ev);
  std::size_t without = 0;
  for_each_vector<1, 1>(d, ev100, luminance, count, 0.0f, [&](const float* from, float* to) {
    const auto ev = hn::LoadU(d, from);
    const auto invalid = hn::IsNaN(ev);
    const auto held = hn::Min(hn::Max(ev, lowest), highest);
    const auto whole = hn::Round(held);
    const auto power = exp2_of(d, hn::Add(whole, shift), hn::Sub(held, whole), factor);
    hn::StoreU(hn::IfThenElse(invalid, none, power), d, to);
    without += hn::CountTrue(d, invalid);
  });
  return without;
}

// The whole part of log2(K/100) goes to the whole part of log2(L), exactly; the fractions are added first.
std::size_t Ev100OfLuminance(const float* luminance, float whole_shift, float fraction_shift, float* ev100, std::size_t count,
                             float where_none) {
  const hn::ScalableTag<float> d;
  const auto whole = hn::Set(d, whole_shift), fraction = hn::Set(d, fraction_shift);
  const auto none = hn::Set(d, where_none);
  std::size_t without = 0;
  for_each_vector<1, 1>(d, luminance, ev100, count, 1.0f, [&](const float* from, float* to) {
    const auto l = hn::LoadU(d, from);
    const auto ev_of = [&](const auto& log) { return hn::Add(hn::Sub(log.whole, whole), hn::Sub(log.fraction, fraction)); };
    const auto finite = hn::Le(l, hn::Set(d, largest));
    if (HWY_LIKELY(hn::AllTrue(d, hn::And(finite, hn::Ge(l, hn::Set(d, least_normal))))))
      return hn::StoreU(ev_of(log2_of_normal(d, l)), d, to);
    const auto valid = hn::And(finite, hn::Gt(l, hn::Zero(d)));
    hn::StoreU(hn::IfThenElse(valid, ev_of(log2_of(d, l)), none), d, to);
    without += hn::CountTrue(d, hn::Not(valid));
  });
  return without;
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(Scaled);
HWY_EXPORT(LuminanceOfEv100);
HWY_EXPORT(Ev100OfLuminance);

Status usable(const Calibration& calibration) {
  if (calibration.meter_k > 0 && std::isfinite(calibration.meter_k)) return Done{};
  return parameter_error("calibration", "CALIBRATION_INVALID",
                         fmt::format("expected a meter's K above 0 and finite, found {}", calibration.meter_k));
}

}  // namespace

Status scaled(std::span<const float> in, double factor, std::span<float> out) {
  if (in.size() != out.size()) return batch_sizes_differ(in.size(), out.size());
  const double held = std::clamp<double>(factor, -std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
  auto rounded = static_cast<float>(held);
  if (std::abs(rounded) > std::abs(held)) rounded = std::nextafter(rounded, 0.0f);
  const double rest = std::max(rounded != 0 ? held / rounded - 1 : 0, 1e-30);
  HWY_DYNAMIC_DISPATCH(Scaled)(in.data(), rounded, static_cast<float>(rest), out.data(), in.size());
  return Done{};
}

BatchOutcome luminance_of_ev100(std::span<const float> ev100, const Calibration& calibration, std::span<float> luminance_cd_m2,
                                float where_none) {
  if (ev100.size() != luminance_cd_m2.size()) return batch_sizes_differ(ev100.size(), luminance_cd_m2.size());
  if (const Status checked = usable(calibration); !checked) return checked.error();
  const double log = std::log2(calibration.meter_k / 100), shift = std::round(log);
  constexpr double margin = 1e-4;  // more than rounding
  const EvScale scale{static_cast<float>(shift), static_cast<float>(std::exp2(log - shift)), static_cast<float>(-126 - log + margin),
                      static_cast<float>(128 - log - margin)};
  return HWY_DYNAMIC_DISPATCH(LuminanceOfEv100)(ev100.data(), scale, luminance_cd_m2.data(), ev100.size(), where_none);
}

BatchOutcome ev100_of_luminance(std::span<const float> luminance_cd_m2, const Calibration& calibration, std::span<float> ev100,
                                float where_none) {
  if (luminance_cd_m2.size() != ev100.size()) return batch_sizes_differ(luminance_cd_m2.size(), ev100.size());
  if (const Status checked = usable(calibration); !checked) return checked.error();
  const double shift = std::log2(calibration.meter_k / 100), whole = std::round(shift);
  return HWY_DYNAMIC_DISPATCH(Ev100OfLuminance)(luminance_cd_m2.data(), static_cast<float>(whole), static_cast<float>(shift - whole),
                                                ev100.data(), luminance_cd_m2.size(), where_none);
}

}  // namespace etendue
#endif  // HWY_ONCE
