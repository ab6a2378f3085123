#include "comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace etendue::cli {
Json to_json(const Comparison& comparison) {
  Json json = {{"verdict", name_of(comparison.verdict)},
               {"mean_rel", comparison.mean_rel},
               {"rms_rel", comparison.rms_rel},
               {"noise_rms_rel", comparison.noise_rms_rel},
               {"chi2_per_pixel", comparison.chi2_per_pixel},
               {"chi2_expected", comparison.chi2_expected},
               {"chi2_pixels", comparison.chi2_pixels},
               {"bias_z", comparison.bias_z},
               {"pixel_excess_rel", comparison.pixel_excess_rel},
               {"pixel_excess_z", comparison.pixel_excess_z},
               {"max_difference", comparison.max_difference},
               {"threshold_z", comparison.threshold_z},
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
      item["z"] = region.z;
      item["merged"] = region.merged;
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
                    [](const RegionDifference& a, const RegionDifference& b) { return std::abs(a.z) > std::abs(b.z); });
  text += fmt::format("  {:<24} {} {:>10} {:>9} {:>6}\n", "region (worst first)", "ch", "difference", "se", "z");
  for (std::size_t i = 0; i < shown; ++i) {
    const RegionDifference& region = judged[i];
    text += fmt::format("  {:<24} {}  {:>+8.3f} % {:>7.3f} % {:>+6.2f}\n", region.region, region.channel, 100 * region.difference,
                        100 * region.standard_error, region.z);
  }
  if (left_out > 0) text += fmt::format("  {} too dark to be judged\n", left_out);
  for (const Finding& finding : comparison.findings) text += fmt::format("  found: {} [{}]\n", finding.text, finding.code);
  if (comparison.samples_needed) text += fmt::format("  about {} samples per pixel would tell\n", *comparison.samples_needed);
  text.pop_back();
  return text;
}

std::vector<std::string> grouped(const std::vector<Loss>& losses) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_effect;
  for (const Loss& loss : losses) {
    const auto known = std::find_if(by_effect.begin(), by_effect.end(), [&](const auto& entry) { return entry.first == loss.effect; });
    if (known == by_effect.end()) {
      by_effect.push_back({loss.effect, {loss.what}});
    } else {
      known->second.push_back(loss.what);
    }
  }
  constexpr std::size_t most = 3;
  std::vector<std::string> lines;
  for (const auto& [effect, whats] : by_effect) {
    const std::size_t shown = whats.size() > most + 1 ? most : whats.size();
    std::string line = fmt::format("{}", fmt::join(whats.begin(), whats.begin() + static_cast<std::ptrdiff_t>(shown), "; "));
    if (shown < whats.size()) line += fmt::format("; and {} more", whats.size() - shown);
    lines.push_back(fmt::format("{}: {}", line, effect));
  }
  return lines;
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
