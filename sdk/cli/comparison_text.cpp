#include "comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace etendue::cli {
namespace {

double z_of(const RegionDifference& region) { return region.standard_error > 0 ? region.difference / region.standard_error : 0; }

}  // namespace

Json to_json(const Comparison& comparison) {
  Json json = {{"verdict", name_of(comparison.verdict)},
               {"mean_rel", comparison.mean_rel},
               {"rms_rel", comparison.rms_rel},
               {"noise_rms_rel", comparison.noise_rms_rel},
               {"chi2_per_pixel", comparison.chi2_per_pixel},
               {"bias_z", comparison.bias_z},
               {"seeds", comparison.seeds}};
  if (comparison.samples_needed) json["samples_needed"] = *comparison.samples_needed;
  json["regions"] = Json::array();
  for (const RegionDifference& region : comparison.regions) {
    Json item = {{"region", region.region},
                 {"channel", std::string(1, region.channel)},
                 {"mean_ours", region.mean_ours},
                 {"mean_reference", region.mean_reference},
                 {"pixels", region.pixels}};
    if (region.left_out) {
      item["left_out"] = true;
    } else {
      item["difference"] = region.difference;
      item["standard_error"] = region.standard_error;
    }
    json["regions"].push_back(std::move(item));
  }
  json["findings"] = Json::array();
  for (const Finding& finding : comparison.findings) {
    json["findings"].push_back({{"code", finding.code}, {"text", finding.text}, {"size", finding.size}});
  }
  return json;
}

std::string table_of(const Comparison& comparison) {
  std::string text = fmt::format("verdict {}   mean {:+.3f} %   chi2 {:.3f}   bias z {:+.2f}   noise of a pixel {:.2f} %   seeds {}\n",
                                 name_of(comparison.verdict), 100 * comparison.mean_rel, comparison.chi2_per_pixel, comparison.bias_z,
                                 100 * comparison.noise_rms_rel, comparison.seeds);
  std::vector<RegionDifference> judged;
  std::size_t left_out = 0;
  for (const RegionDifference& region : comparison.regions) {
    if (region.left_out) {
      ++left_out;
    } else {
      judged.push_back(region);
    }
  }
  const std::size_t shown = std::min<std::size_t>(judged.size(), 5);
  std::partial_sort(judged.begin(), judged.begin() + static_cast<std::ptrdiff_t>(shown), judged.end(),
                    [](const RegionDifference& a, const RegionDifference& b) { return std::abs(z_of(a)) > std::abs(z_of(b)); });
  text += fmt::format("  {:<24} {} {:>10} {:>9} {:>6}\n", "region (worst first)", "ch", "difference", "se", "z");
  for (std::size_t i = 0; i < shown; ++i) {
    const RegionDifference& region = judged[i];
    text += fmt::format("  {:<24} {}  {:>+8.3f} % {:>7.3f} % {:>+6.2f}\n", region.region, region.channel, 100 * region.difference,
                        100 * region.standard_error, z_of(region));
  }
  if (left_out > 0) text += fmt::format("  {} too dark to be judged\n", left_out);
  for (const Finding& finding : comparison.findings) text += fmt::format("  found: {} [{}]\n", finding.text, finding.code);
  if (comparison.samples_needed) text += fmt::format("  about {} samples per pixel would tell\n", *comparison.samples_needed);
  text.pop_back();
  return text;
}

int exit_status_of(Verdict verdict) {
  return verdict == Verdict::same ? exit_done : verdict == Verdict::differs ? exit_bad_input : exit_undecided;
}

Result<double> parse_fraction(const std::string& text) {
  const bool percent = text.ends_with('%');
  const char* const end = text.data() + text.size() - (percent ? 1 : 0);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !(value > 0) || !(value < (percent ? 100 : 1))) {
    return Error{"USAGE", fmt::format("--max-diff: expected a part of one, as 1% or 0.01, found '{}'", text), {}, "", {}};
  }
  return percent ? value / 100 : value;
}

}  // namespace etendue::cli
