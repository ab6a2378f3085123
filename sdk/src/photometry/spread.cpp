// Beam and field angles.
#include <algorithm>
#include <cmath>
#include <functional>

#include "etendue/photometric_quantities.h"

namespace etendue {
namespace {

// A plane as one curve over the signed angle from the nadir, -180 to 180, with the angles between which it is smooth.
class Curve {
 public:
  Curve(const IntensityWeb& web, PlanePair plane) : web_(web), c_deg_(plane == PlanePair::c0_180 ? 0 : 90) {
    if (web.type() == WebType::c) {
      for (const double gamma : web.polar().nodes()) {
        nodes_.push_back(gamma);
        if (gamma > 0) nodes_.push_back(-gamma);
      }
    } else {
      constexpr double step = 0.25;  // a plane of type A or B crosses cells anywhere
      for (int i = -720; i <= 720; ++i) nodes_.push_back(i * step);
    }
    std::sort(nodes_.begin(), nodes_.end());
  }

  double at(double signed_deg) const { return web_.at(signed_deg >= 0 ? c_deg_ : c_deg_ + 180, std::abs(signed_deg)); }
  const std::vector<double>& nodes() const { return nodes_; }

 private:
  const IntensityWeb& web_;
  double c_deg_;
  std::vector<double> nodes_;
};

struct End {
  double angle;
  bool ends_with_table;
};

// From node `start` in steps of `step` to where the curve first falls to the level.
End fall(const Curve& curve, std::ptrdiff_t start, std::ptrdiff_t step, double level) {
  const std::vector<double>& x = curve.nodes();
  const auto count = static_cast<std::ptrdiff_t>(x.size());
  std::ptrdiff_t i = start;
  while (i + step >= 0 && i + step < count && curve.at(x[static_cast<std::size_t>(i + step)]) > level) i += step;
  double inside = x[static_cast<std::size_t>(i)];
  if (i + step < 0 || i + step >= count) return {inside, true};
  double outside = x[static_cast<std::size_t>(i + step)];
  constexpr int halvings = 60;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (inside + outside);
    (curve.at(middle) > level ? inside : outside) = middle;
  }
  return {outside, false};
}

Spread spread_from(const Curve& curve, std::ptrdiff_t start, double level) {
  const End towards = fall(curve, start, 1, level), away = fall(curve, start, -1, level);
  return {towards.angle - away.angle, towards.angle, away.angle, towards.ends_with_table || away.ends_with_table};
}

}  // namespace

std::optional<Spread> spread_about_peak(const IntensityWeb& web, PlanePair plane, double share) {
  const Curve curve(web, plane);
  const auto brightest =
      std::max_element(curve.nodes().begin(), curve.nodes().end(), [&](double a, double b) { return curve.at(a) < curve.at(b); });
  const double peak = curve.at(*brightest);
  if (!(peak > 0)) return {};
  return spread_from(curve, brightest - curve.nodes().begin(), share * peak);
}

std::optional<Spread> spread_about_axis(const IntensityWeb& web, PlanePair plane, double share) {
  const Curve curve(web, plane);
  const auto axis = std::lower_bound(curve.nodes().begin(), curve.nodes().end(), 0.0);
  if (axis == curve.nodes().end() || *axis != 0 || !(curve.at(0) > 0)) return {};
  return spread_from(curve, axis - curve.nodes().begin(), share * curve.at(0));
}

Peak peak_of(const IntensityWeb& web) {
  for (std::size_t j = 0; j < web.azimuth().nodes().size(); ++j) {
    for (std::size_t i = 0; i < web.polar().nodes().size(); ++i) {
      if (web.node(j, i) != web.max_cd()) continue;
      const double polar = web.polar().nodes()[i], azimuth = web.azimuth().nodes()[j];
      if (web.type() == WebType::b) return {web.max_cd(), {azimuth, polar - 90}};
      return {web.max_cd(), {web.type() == WebType::c ? polar : polar - 90, azimuth}};
    }
  }
  return {};
}

}  // namespace etendue
