// What a distribution says beside its grid: factors, flux, keywords, names.
#include "etendue/photometry.h"

#include <algorithm>

namespace etendue {
namespace {

const LampSet* chosen_set(const IntensityDistribution& distribution, const EulumdatRecord& record) {
  return distribution.lamp_set < record.lamp_sets.size() ? &record.lamp_sets[distribution.lamp_set] : nullptr;
}

std::string_view eulumdat_text(const EulumdatRecord& record, std::string_view name) {
  if (name == "MANUFAC") return record.company;
  if (name == "LUMINAIRE") return record.luminaire;
  if (name == "LUMCAT") return record.number;
  if (name == "TEST") return record.report;
  if (name == "LAMP" && !record.lamp_sets.empty()) return record.lamp_sets.front().type;
  return {};
}

}  // namespace

std::string_view name_of(WebType type) {
  static constexpr std::string_view names[] = {"C", "B", "A"};
  return names[static_cast<int>(type)];
}

std::string_view name_of(WebSymmetry symmetry) {
  static constexpr std::string_view names[] = {"none",       "about_0_180", "about_90_270", "quadrant",
                                               "rotational", "lateral",     "vertical",     "lateral_and_vertical"};
  return names[static_cast<int>(symmetry)];
}

std::string_view name_of(IesVersion version) {
  static constexpr std::string_view names[] = {"1986", "1991", "1995", "2002", "2019"};
  return names[static_cast<int>(version)];
}

double candelas_per_value(const IntensityDistribution& distribution) {
  if (const auto* ies = std::get_if<IesRecord>(&distribution.record)) {
    const double factor = ies->multiplier * ies->ballast_factor;
    return ies->version <= IesVersion::lm_63_1991 ? factor * ies->third_factor : factor;
  }
  const auto& ldt = *std::get_if<EulumdatRecord>(&distribution.record);
  const LampSet* const set = chosen_set(distribution, ldt);
  return set != nullptr ? ldt.conversion_factor * set->flux_lm / 1000 : 0;
}

bool is_absolute(const IntensityDistribution& distribution) {
  if (const auto* ies = std::get_if<IesRecord>(&distribution.record)) return ies->lumens_per_lamp < 0;
  const LampSet* const set = chosen_set(distribution, *std::get_if<EulumdatRecord>(&distribution.record));
  return set != nullptr && set->lamps < 0;
}

std::optional<double> rated_flux_lm(const IntensityDistribution& distribution) {
  if (const auto* ies = std::get_if<IesRecord>(&distribution.record)) {
    return ies->lumens_per_lamp < 0 ? std::optional<double>() : ies->lamps * ies->lumens_per_lamp;
  }
  const LampSet* const set = chosen_set(distribution, *std::get_if<EulumdatRecord>(&distribution.record));
  return set != nullptr ? std::optional<double>(set->flux_lm) : std::nullopt;
}

double input_watts(const IntensityDistribution& distribution) {
  if (const auto* ies = std::get_if<IesRecord>(&distribution.record)) return ies->watts;
  const LampSet* const set = chosen_set(distribution, *std::get_if<EulumdatRecord>(&distribution.record));
  return set != nullptr ? set->watts : 0;
}

std::string keyword_of(const IntensityDistribution& distribution, std::string_view name) {
  const auto* ies = std::get_if<IesRecord>(&distribution.record);
  if (ies == nullptr) return std::string(eulumdat_text(*std::get_if<EulumdatRecord>(&distribution.record), name));
  auto line = std::find_if(ies->keywords.begin(), ies->keywords.end(), [&](const Keyword& k) { return k.name == name; });
  if (line == ies->keywords.end()) return {};
  std::string text = line->text;
  for (++line; line != ies->keywords.end() && line->name == "MORE"; ++line) text += " " + line->text;
  return text;
}

}  // namespace etendue
