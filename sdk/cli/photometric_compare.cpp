#include "photometric_compare.h"

#include <fmt/format.h>

#include <cmath>

#include "etendue/photometric_comparison.h"

namespace etendue::cli {
namespace {

struct Figure {
  const char* name;
  const char* key;
  const char* unit;
  std::optional<double> first, second;
};

std::vector<Figure> figures_of(const PhotometricReading& first, const PhotometricReading& second) {
  std::vector<Figure> figures;
  const auto add = [&](const char* name, const char* key, const char* unit, const auto& of) {
    figures.push_back({name, key, unit, of(first), of(second)});
  };
  using Maybe = std::optional<double>;
  using Reading = PhotometricReading;
  const auto angle = [](const Reading& r, PlanePair plane, double share) {
    const std::optional<Spread> spread = spread_about_peak(r.web, plane, share);
    return spread ? Maybe(spread->full_deg) : Maybe();
  };
  add("flux", "flux_lm", "lm", [](const Reading& r) { return Maybe(r.web.flux_lm()); });
  add("peak", "max_cd", "cd", [](const Reading& r) { return Maybe(r.web.max_cd()); });
  add("input power", "watts", "W",
      [](const Reading& r) { return input_watts(r.distribution) > 0 ? Maybe(input_watts(r.distribution)) : Maybe(); });
  add("efficacy", "efficacy_lm_W", "lm/W", [](const Reading& r) { return light_output(r.distribution, r.web).efficacy_lm_w; });
  add("downwards", "downward_flux_share", "", [](const Reading& r) { return Maybe(light_output(r.distribution, r.web).downward_share); });
  add("0-30 deg", "zone_0_30_lm", "lm", [](const Reading& r) { return Maybe(r.web.flux_between(0, 30)); });
  add("30-60 deg", "zone_30_60_lm", "lm", [](const Reading& r) { return Maybe(r.web.flux_between(30, 60)); });
  add("60-90 deg", "zone_60_90_lm", "lm", [](const Reading& r) { return Maybe(r.web.flux_between(60, 90)); });
  add("90-180 deg", "zone_90_180_lm", "lm", [](const Reading& r) { return Maybe(r.web.flux_between(90, 180)); });
  add("beam C0-C180", "beam_c0_180_deg", "deg", [&](const Reading& r) { return angle(r, PlanePair::c0_180, beam_share); });
  add("beam C90-C270", "beam_c90_270_deg", "deg", [&](const Reading& r) { return angle(r, PlanePair::c90_270, beam_share); });
  add("field C0-C180", "field_c0_180_deg", "deg", [&](const Reading& r) { return angle(r, PlanePair::c0_180, field_share); });
  add("field C90-C270", "field_c90_270_deg", "deg", [&](const Reading& r) { return angle(r, PlanePair::c90_270, field_share); });
  return figures;
}

}  // namespace

std::string comparison_of(const PhotometricReading& first, const PhotometricReading& second) {
  std::string text = fmt::format("A {}\nB {}\n  {:<16}{:>12}{:>12}{:>12}{:>10}\n", first.file, second.file, "", "A", "B", "B - A", "");
  const auto cell = [](const std::optional<double>& x) { return x ? fmt::format("{:.5g}", *x) : std::string("-"); };
  for (const Figure& f : figures_of(first, second)) {
    std::string change, relative;
    if (f.first && f.second) {
      change = fmt::format("{:+.4g}", *f.second - *f.first);
      if (*f.first != 0) relative = fmt::format("{:+.2f} %", 100 * (*f.second / *f.first - 1));
    }
    text += fmt::format("  {:<16}{:>12}{:>12}{:>12}{:>10} {}\n", f.name, cell(f.first), cell(f.second), change, relative, f.unit);
  }
  const WebDifference d = difference(first.web, second.web);
  const double peak = std::max(first.web.max_cd(), second.web.max_cd());
  text += fmt::format("  intensity       largest {:+.5g} cd ({:.2f} % of the larger peak) at C {:g}, gamma {:g} deg{}\n", d.largest_cd,
                      peak > 0 ? 100 * std::abs(d.largest_cd) / peak : 0, d.c_deg, d.gamma_deg, d.exact ? "" : ", at half degrees");
  text += fmt::format("                  over all directions: mean {:+.4g} cd, mean of its size {:.4g} cd, rms {:.4g} cd", d.mean_cd,
                      d.mean_abs_cd, d.rms_cd);
  return text;
}

Json comparison_json(const PhotometricReading& first, const PhotometricReading& second) {
  Json json = {{"a", first.file}, {"b", second.file}};
  Json figures = Json::object();
  for (const Figure& f : figures_of(first, second)) {
    Json figure = Json::object();
    if (f.first) figure["a"] = *f.first;
    if (f.second) figure["b"] = *f.second;
    if (f.first && f.second) figure["difference"] = *f.second - *f.first;
    figures[f.key] = figure;
  }
  json["figures"] = figures;
  const WebDifference d = difference(first.web, second.web);
  json["intensity"] = {{"largest_cd", d.largest_cd},
                       {"at_deg", {{"c", d.c_deg}, {"gamma", d.gamma_deg}}},
                       {"exact", d.exact},
                       {"mean_cd", d.mean_cd},
                       {"mean_abs_cd", d.mean_abs_cd},
                       {"rms_cd", d.rms_cd}};
  return json;
}

}  // namespace etendue::cli
