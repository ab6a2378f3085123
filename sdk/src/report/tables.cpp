#include "tables.h"

#include "markup.h"
#include "words.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::report_detail {
namespace {

const char* label_of(Verdict verdict) { return verdict == Verdict::same ? "Agree" : verdict == Verdict::differs ? "Differ" : "Undecided"; }

// Three rows (R, G, B) of one region; shown is the channel that speaks loudest.
struct RegionRow {
  const RegionDifference* shown = nullptr;
  bool left_out = true, merged = false, significant = false;
};

std::vector<RegionRow> rows_of(const Comparison& c) {
  std::vector<RegionRow> rows;
  for (const RegionDifference& r : c.regions) {
    if (rows.empty() || rows.back().shown->region != r.region) rows.push_back({&r, true, r.merged, false});
    RegionRow& row = rows.back();
    if (r.left_out) continue;
    if (row.left_out || std::abs(r.z) > std::abs(row.shown->z)) row.shown = &r;
    row.left_out = false;
    row.significant = row.significant || std::abs(r.z) > c.threshold_z;
  }
  return rows;
}

// The difference with three standard errors to each side, over the band of what was asked about.
std::string whisker(const RegionDifference& r, double asked, double reach) {
  constexpr double half = 110;
  const auto at = [&](double d) { return half + std::clamp(d / reach, -1.0, 1.0) * (half - 4); };
  const double low = at(r.difference - 3 * r.standard_error), high = at(r.difference + 3 * r.standard_error);
  return fmt::format(
      R"(<svg class="whisker" viewBox="0 0 220 18" width="220" height="18" aria-hidden="true"><rect class="band" x="{:.1f}" y="1" width="{:.1f}" height="16" rx="2"/>)"
      R"(<line class="zero" x1="110" y1="1" x2="110" y2="17"/><line class="reach" x1="{:.1f}" y1="9" x2="{:.1f}" y2="9"/><circle class="dot" cx="{:.1f}" cy="9" r="3.2"/></svg>)",
      at(-asked), at(asked) - at(-asked), low, high, at(r.difference));
}

std::string chi2_text(const Comparison& c) {
  return c.chi2_per_pixel < 100 ? fmt::format("{:.3f}", c.chi2_per_pixel) : fmt::format("{:.2g}", c.chi2_per_pixel);
}

const char* colour_of(char channel) { return channel == 'R' ? "red" : channel == 'G' ? "green" : "blue"; }

std::string region_row(const RegionRow& row, const Comparison& c, double reach) {
  const RegionDifference& r = *row.shown;
  const std::string name = escaped(r.region == "all" ? "whole picture" : r.region);
  if (row.left_out) {
    return fmt::format(
        R"(<tr class="quiet"><th scope="row">{}</th><td></td><td class="number">{}</td><td></td><td>too dark to be judged</td></tr>)", name,
        percent(r.difference, true));
  }
  const char* state = row.significant ? "differs, not noise" : row.merged ? "noisy: judged with its neighbours" : "within the noise";
  return fmt::format(
      R"(<tr{}><th scope="row">{}</th><td>{}</td><td class="number">{} <span class="error">± {}</span></td><td class="number">{:.1f}</td><td>{}{}</td></tr>)",
      row.significant ? R"( class="loud")"
      : row.merged    ? R"( class="quiet")"
                      : "",
      name, whisker(r, c.max_difference, reach), percent(r.difference, true), percent(r.standard_error), r.z, state,
      row.significant ? fmt::format(" ({})", colour_of(r.channel)) : "");
}

std::string list_item(const std::string& what, const std::string& more, const char* kind = "") {
  return fmt::format("<li{}><strong>{}</strong>{}{}</li>", *kind ? fmt::format(R"( class="{}")", kind) : "", escaped(what),
                     more.empty() ? "" : "<br>", escaped(more));
}

}  // namespace

std::string verdict_section(const Comparison& c, const std::vector<LightSection>& lights) {
  const Words words = in_words(c);
  std::string html =
      fmt::format(R"(<section class="verdict {}" aria-labelledby="headline"><p class="badge">{}</p><div><h2 id="headline">{}</h2>)",
                  name_of(c.verdict), label_of(c.verdict), escaped(words.headline));
  for (const std::string& line : words.lines) html += "<p>" + escaped(line) + "</p>";
  for (const Finding& finding : c.findings) html += R"(<p class="finding">)" + escaped(finding.text) + "</p>";
  if (c.verdict != Verdict::differs) {
    for (const LightSection& light : lights) {
      if (light.comparison.verdict != Verdict::differs) continue;
      html += fmt::format(R"(<p class="finding">Taken alone, light ‘{}’ differs; see “Light by light” below.</p>)", escaped(light.name));
    }
  }
  return html + "</div></section>";
}

std::string regions_section(const Comparison& c) {
  const std::vector<RegionRow> rows = rows_of(c);
  double reach = c.max_difference;
  for (const RegionRow& row : rows) {
    if (!row.left_out) reach = std::max(reach, std::abs(row.shown->difference) + 3 * row.shown->standard_error);
  }
  reach = std::max(1.1 * std::min(reach, 10 * std::max(c.max_difference, 1e-6)), 1e-9);
  std::string html = fmt::format(
      R"(<section><h2>Region by region</h2><p>How much brighter (right) or darker (left) our picture is. The dot is the difference of the means, the line three )"
      R"(standard errors to each side, the shaded band the {} that was asked about; the scale ends at ± {}. A significance beyond ± {:.1f} is not noise.</p>)"
      R"(<div class="scroll"><table><thead><tr><th scope="col">Region</th><th scope="col">Difference</th><th scope="col" class="number">ours − Mitsuba</th>)"
      R"(<th scope="col" class="number">Significance</th><th scope="col">Reading</th></tr></thead><tbody>)",
      percent(c.max_difference), percent(reach), c.threshold_z);
  for (const RegionRow& row : rows) html += region_row(row, c, reach);
  return html + "</tbody></table></div></section>";
}

std::string lights_section(const std::vector<LightSection>& lights) {
  if (lights.empty()) return {};
  std::string html =
      R"(<section><h2>Light by light</h2><div class="scroll"><table><thead><tr><th scope="col">Light</th><th scope="col">What it is</th>)"
      R"(<th scope="col" class="number">ours − Mitsuba</th><th scope="col" class="number">χ² a pixel</th><th scope="col">Verdict</th></tr></thead><tbody>)";
  for (const LightSection& light : lights) {
    const Comparison& c = light.comparison;
    html += fmt::format(
        R"(<tr{}><th scope="row">{}</th><td>{}</td><td class="number">{}</td><td class="number">{}</td><td><span class="chip {}">{}</span>)",
        c.verdict == Verdict::differs ? R"( class="loud")" : "", escaped(light.name), escaped(light.description), percent(c.mean_rel, true),
        chi2_text(c), name_of(c.verdict), label_of(c.verdict));
    for (const Finding& finding : c.findings) html += "<br>" + escaped(finding.text);
    html += "</td></tr>";
  }
  return html + "</tbody></table></div></section>";
}

std::string losses_section(const std::vector<Loss>& losses) {
  if (losses.empty()) return {};
  std::string html = R"(<section><h2>What Mitsuba was not given as authored</h2><ul class="list">)";
  for (const Loss& loss : losses) html += list_item(loss.what, loss.effect);
  return html + "</ul></section>";
}

std::string diagnostics_section(const Diagnostics& diagnostics) {
  if (diagnostics.all().empty()) return {};
  std::string html = R"(<section><h2>Messages about the asset</h2><ul class="list">)";
  for (const Diagnostic& d : diagnostics.all()) {
    html += list_item(d.text,
                      to_string(d.where) + (d.where.pointer.empty() ? "" : "  " + d.where.pointer) + (d.hint.empty() ? "" : "  " + d.hint),
                      d.severity == Severity::error     ? "error"
                      : d.severity == Severity::warning ? "warning"
                                                        : "note");
  }
  return html + "</ul></section>";
}

std::string facts_section(const std::vector<std::pair<std::string, std::string>>& facts, const Comparison& c) {
  std::string html = R"(<section><h2>The figures</h2><dl class="facts">)";
  const auto add = [&](const std::string& label, const std::string& text) {
    html += "<div><dt>" + escaped(label) + "</dt><dd>" + escaped(text) + "</dd></div>";
  };
  add("Mean difference", percent(c.mean_rel, true) + fmt::format(" ({:+.1f} standard errors)", c.bias_z));
  add("Difference of pixels, rms", percent(c.rms_rel));
  add("Noise of pixels, rms", percent(c.noise_rms_rel));
  add("Chi-squared a pixel", chi2_text(c) + " (noise alone: 1)");
  add("Independent runs of Mitsuba", std::to_string(c.seeds));
  for (const auto& [label, text] : facts) add(label, text);
  return html + "</dl></section>";
}

}  // namespace etendue::report_detail
