// The parts of the page below the pictures, as HTML.
#pragma once

#include "etendue/report.h"

#include <string>

namespace etendue::report_detail {

// Also names the lights that differ on their own, which the sum of all may hide.
std::string verdict_section(const Comparison& comparison, const std::vector<LightSection>& lights);
std::string regions_section(const Comparison& comparison);
std::string lights_section(const std::vector<LightSection>& lights);
std::string losses_section(const std::vector<Loss>& losses);
std::string diagnostics_section(const Diagnostics& diagnostics);
std::string facts_section(const std::vector<std::pair<std::string, std::string>>& facts, const Comparison& comparison);

}  // namespace etendue::report_detail
