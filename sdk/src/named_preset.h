// A row of a table of presets by its name.
#pragma once

#include "edit_distance.h"
#include "parameter_error.h"

#include "etendue/result.h"

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

// `what`: "source whose temperature", for the message that it is not known. PRESET_UNKNOWN, with the nearest names.
template <class Preset>
Result<Preset> named_preset(std::span<const Preset> all, std::string_view name, const char* what) {
  std::vector<Candidate> candidates;
  for (const Preset& known : all) {
    if (known.name == name) return known;
    candidates.push_back({std::string(known.name), std::string(known.name)});
  }
  return parameter_error("name", "PRESET_UNKNOWN", fmt::format("\"{}\" is no {} is known", name, what),
                         fmt::format("nearest: {}", fmt::join(nearest_candidates(name, candidates, 3), ", ")));
}

}  // namespace etendue
