// Intensity along an axis of angles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "photometric_diagrams.h"
#include "photometric_file.h"
#include "svg.h"

namespace etendue::cli {
namespace {

constexpr double width = 760, height = 520, left = 74, right = 736, top = 94, bottom = 424;

double signed_at(const IntensityWeb& web, double c_deg, double signed_deg) {
  return web.at(signed_deg >= 0 ? c_deg : c_deg + 180, std::abs(signed_deg));
}

// The first of some round angles beyond which less than a hundredth of the peak is left.
double reach_of(std::span<const DrawnWeb> webs, double peak_cd) {
  for (const double reach : {10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0}) {
    double beyond = 0;
    for (const DrawnWeb& drawn : webs)
      for (const double c : {0.0, 90.0})
        for (const double gamma : ticks(reach, 180, 0.25))
          beyond = std::max({beyond, signed_at(*drawn.web, c, gamma), signed_at(*drawn.web, c, -gamma)});
    if (beyond < 0.01 * peak_cd) return reach;
  }
  return 180;
}

double tick_of(double reach) { return reach <= 10 ? 2 : reach <= 20 ? 5 : reach <= 45 ? 10 : reach <= 60 ? 15 : reach <= 90 ? 30 : 45; }

}  // namespace

std::string key_figures(const IntensityWeb& web) {
  std::string text = fmt::format("peak {:.5g} cd, flux {:.5g} lm", web.max_cd(), web.flux_lm());
  const auto one = spread_about_peak(web, PlanePair::c0_180, beam_share), other = spread_about_peak(web, PlanePair::c90_270, beam_share);
  if (one && other) text += fmt::format(", beam {:.1f}\u00B0 \u00D7 {:.1f}\u00B0", one->full_deg, other->full_deg);
  return text;
}

std::string cartesian_svg(std::span<const DrawnWeb> webs, const std::string& title) {
  double peak = 0;
  for (const DrawnWeb& drawn : webs)
    for (const double c : {0.0, 90.0})
      for (const double gamma : ticks(-180, 180, 0.25)) peak = std::max(peak, signed_at(*drawn.web, c, gamma));
  const double reach = peak > 0 ? reach_of(webs, peak) : 90, step_cd = peak > 0 ? round_step(peak * 1.02, 6) : 0.2;
  const double most_cd = step_cd * std::ceil(std::max(peak * 1.02, step_cd) / step_cd);
  const auto x_of = [&](double angle) { return left + (right - left) * (angle + reach) / (2 * reach); };
  const auto y_of = [&](double cd) { return bottom - (bottom - top) * cd / most_cd; };
  const bool several = webs.size() > 1;
  SvgSheet sheet(width, height + (several ? 24 : 0));
  sheet.heading(title, several ? "" : key_figures(*webs[0].web));
  for (const double cd : ticks(0, most_cd, step_cd)) {
    sheet.line({left, y_of(cd)}, {right, y_of(cd)}, cd == 0 ? "axis" : "grid");
    sheet.text({left - 9, y_of(cd) + 4}, fmt::format("{:g}", cd), "soft", "end");
  }
  const double tick = tick_of(reach);
  for (const double angle : ticks(-std::floor(reach / tick) * tick, reach, tick)) {
    sheet.line({x_of(angle), top}, {x_of(angle), bottom}, angle == 0 ? "axis" : "grid");
    sheet.text({x_of(angle), bottom + 19}, fmt::format("{:g}\u00B0", std::abs(angle)), "soft", "middle");
  }
  sheet.text({left - 9, top - 10}, "cd", "soft", "end");
  sheet.text({left, bottom + 40}, "\u2190 C180, C270", "soft");
  sheet.text({(left + right) / 2, bottom + 40}, "gamma, from the nadir", "soft", "middle");
  sheet.text({right, bottom + 40}, "C0, C90 \u2192", "soft", "end");
  const auto curve = [&](const IntensityWeb& web, double c) {
    std::vector<Vec2d> points;
    constexpr int count = 720;
    for (int i = 0; i <= count; ++i) {
      const double angle = reach * (2.0 * i / count - 1);
      points.push_back({x_of(angle), y_of(signed_at(web, c, angle))});
    }
    return points;
  };
  const auto area = [&](std::vector<Vec2d> points) {
    points.push_back({right, bottom});
    points.push_back({left, bottom});
    return points;
  };
  for (std::size_t i = webs.size(); i-- > 0;) {
    const bool second = several && i == 1;
    const std::vector<Vec2d> across = curve(*webs[i].web, 90), along = curve(*webs[i].web, 0);
    sheet.path(area(across), true, second || !several ? "fb" : "fa");
    sheet.path(area(along), true, second ? "fb" : "fa");
    sheet.path(across, false, second || !several ? "b dash" : "a dash");
    sheet.path(along, false, second ? "b" : "a");
  }
  const double y = height - 20;
  if (!several) {
    sheet.key({sheet.key({left, y}, "a", "C0\u2013C180"), y}, "b dash", "C90\u2013C270");
  } else {
    for (std::size_t i = 0; i < webs.size(); ++i) {
      const double row = y + 24.0 * static_cast<double>(i), next = sheet.key({left, row}, i == 0 ? "a" : "b", shortened(webs[i].label, 56));
      sheet.key({std::max(next, 540.0), row}, i == 0 ? "a dash" : "b dash", "C90\u2013C270");
    }
  }
  return sheet.str();
}

}  // namespace etendue::cli
