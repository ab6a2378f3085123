// The codes of Disney parameters that come nearest to two colours.
//
// With the metal mask and the dielectric part given, each channel's residual is a parabola of its base colour: the best code is one of the
// two around its lowest point. With the metal mask given, what the best base colours of any value leave is convex in the dielectric part
// and below what codes leave: from its lowest point codes are tried both ways until it alone is above the best so far. The same bound
// leaves out whole metal masks.
#include "etendue/material_codes.h"

#include "etendue/srgb.h"
#include "metal_profile.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

std::uint16_t narrow(int code) { return static_cast<std::uint16_t>(code); }

class Coding {
 public:
  explicit Coding(const MaterialFormat& format) : bits_(std::clamp(format.bits, 1, 16)), top_((1 << bits_) - 1), kind_(format.dielectric) {}

  int top() const { return top_; }
  DielectricF0 dielectric_f0() const { return kind_ == DielectricCode::none ? DielectricF0::core : DielectricF0::free; }

  double linear(int code) const { return static_cast<double>(code) / top_; }
  int nearest(double x) const { return static_cast<int>(std::lround(std::clamp(x, 0.0, 1.0) * top_)); }

  double base(int code) const {
    if (bits_ != 8) return srgb_to_linear(linear(code));
    static const std::array<double, 256> table = [] {
      std::array<double, 256> out{};
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = srgb_to_linear(static_cast<double>(i) / 255);
      return out;
    }();
    return table[static_cast<std::size_t>(code)];
  }
  // The last code whose base colour is not above b.
  int base_below(double b) const {
    const int guess = static_cast<int>(linear_to_srgb(b) * top_);
    return std::clamp(base(std::min(guess + 1, top_)) <= b ? guess + 1 : guess, 0, top_);
  }

  double dielectric_f0(int code) const {
    const double x = linear(code);
    return kind_ == DielectricCode::none ? largest_dielectric_f0 / 4
                                         : largest_dielectric_f0 * (kind_ == DielectricCode::reflectance ? x * x : x);
  }
  int dielectric_code(double f0) const {
    const double x = f0 / largest_dielectric_f0;
    return kind_ == DielectricCode::none ? 0 : nearest(kind_ == DielectricCode::reflectance ? std::sqrt(x) : x);
  }
  int last_dielectric_code() const { return kind_ == DielectricCode::none ? 0 : top_; }

 private:
  int bits_, top_;
  DielectricCode kind_;
};

class Search {
 public:
  Search(const ColourPair& pair, const Coding& coding)
      : coding_(coding), profile_(MetalProfile::channels_of(pair), coding.dielectric_f0()) {}

  void consider(const MaterialCodes& codes) { offer(codes, residual_of(codes)); }

  // The best of one metal mask.
  void consider_metal(int metal) {
    const MetalProfile::Point least = profile_(coding_.linear(metal));
    if (found_ && least.residual >= residual_) return;
    const double s = 1 - least.m;
    // A metal has no dielectric part: its code is that of reflectance .5.
    const int start = coding_.dielectric_code(s > 0 ? least.k / s : largest_dielectric_f0 / 4);
    consider_base(metal, start);
    if (s <= 0) return;
    for (const int way : {1, -1})
      for (int code = start + way; code >= 0 && code <= coding_.last_dielectric_code(); code += way) {
        if (profile_.residual(least.m, coding_.dielectric_f0(code) * s) >= residual_) break;
        consider_base(metal, code);
      }
  }

  double residual() const { return residual_; }
  const MaterialCodes& best() const { return best_; }

 private:
  double channel_residual(std::size_t channel, double m, double k, double b) const {
    const auto [d, f] = profile_.channels()[channel];
    const double diffuse = (1 - m) * b - d, f0 = m * b + k - f;
    return diffuse * diffuse + f0 * f0;
  }
  double residual_of(const MaterialCodes& codes) const {
    const double m = coding_.linear(codes.metal), k = coding_.dielectric_f0(codes.dielectric) * (1 - m);
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += channel_residual(c, m, k, coding_.base(codes.base_colour[c]));
    return sum;
  }
  void consider_base(int metal, int dielectric) {
    const double m = coding_.linear(metal), k = coding_.dielectric_f0(dielectric) * (1 - m);
    MaterialCodes codes{{}, narrow(metal), narrow(dielectric)};
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int below = coding_.base_below(MetalProfile::base(profile_.channels()[c], m, k)), above = std::min(below + 1, coding_.top());
      const double at_below = channel_residual(c, m, k, coding_.base(below)), at_above = channel_residual(c, m, k, coding_.base(above));
      codes.base_colour[c] = narrow(at_above < at_below ? above : below);
      sum += std::min(at_below, at_above);
    }
    offer(codes, sum);
  }
  void offer(const MaterialCodes& codes, double residual) {
    if (!found_ || residual < residual_) best_ = codes, residual_ = residual, found_ = true;
  }

  const Coding& coding_;
  MetalProfile profile_;
  MaterialCodes best_;
  double residual_ = 0;
  bool found_ = false;
};

}  // namespace

DisneyColours decoded(const MaterialCodes& codes, const MaterialFormat& format) {
  const Coding coding(format);
  DisneyColours out;
  for (int c = 0; c < 3; ++c) out.base_colour[c] = coding.base(codes.base_colour[static_cast<std::size_t>(c)]);
  out.metal = coding.linear(codes.metal);
  out.reflectance = std::sqrt(coding.dielectric_f0(codes.dielectric) / largest_dielectric_f0);
  return out;
}

MaterialCodes rounded(const DisneyColours& colours, const MaterialFormat& format) {
  const Coding coding(format);
  MaterialCodes out;
  for (int c = 0; c < 3; ++c)
    out.base_colour[static_cast<std::size_t>(c)] = narrow(coding.nearest(linear_to_srgb(MetalProfile::held(colours.base_colour[c]))));
  out.metal = narrow(coding.nearest(MetalProfile::held(colours.metal)));
  const double reflectance = std::clamp(MetalProfile::held(colours.reflectance), 0.0, 1.0);
  out.dielectric = narrow(coding.dielectric_code(largest_dielectric_f0 * reflectance * reflectance));
  return out;
}

StoredFit fit_codes(const ColourPair& pair, const MaterialFormat& format, MetalRange range) {
  const Coding coding(format);
  const auto code_of = [&coding](double m, auto whole) {
    return static_cast<int>(whole(std::clamp(MetalProfile::held(m), 0.0, 1.0) * coding.top()));
  };
  // A range's end that is a code but for rounding counts as one.
  constexpr double rounding = 1e-9;
  int first = code_of(range.low, [](double x) { return std::ceil(x - rounding); });
  int last = code_of(range.high, [](double x) { return std::floor(x + rounding); });
  if (first > last) first = last = coding.nearest((MetalProfile::held(range.low) + MetalProfile::held(range.high)) / 2);

  const DisneyFit optimum = fit_disney(pair, coding.dielectric_f0());
  const int centre = std::clamp(coding.nearest(optimum.value.metal), first, last);
  Search search(pair, coding);
  search.consider(rounded(
      centre == coding.nearest(optimum.value.metal) ? optimum.value : fit_disney_at(coding.linear(centre), pair, coding.dielectric_f0()),
      format));
  search.consider_metal(centre);
  constexpr int around = 256;
  for (int distance = 1; distance < around && search.residual() > optimum.residual; ++distance) {
    if (centre + distance <= last) search.consider_metal(centre + distance);
    if (centre - distance >= first) search.consider_metal(centre - distance);
  }
  return {search.best(), decoded(search.best(), format), search.residual()};
}

}  // namespace etendue
