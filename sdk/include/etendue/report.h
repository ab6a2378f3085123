// The report of a validation: one self-contained HTML file, readable by somebody who never saw the tool.
#pragma once

#include "etendue/compare.h"
#include "etendue/io.h"
#include "etendue/picture.h"
#include "etendue/result.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

struct LightSection {
  std::string name;         // layers "light.NAME" in both pictures
  std::string description;  // "rectangle 1.2 m x .6 m, 1500 lm, 3000 K"
  Comparison comparison;
};

struct Report {
  std::string title;  // the asset's file name
  Comparison comparison;
  std::vector<LightSection> lights;
  std::vector<Loss> losses;         // what Mitsuba's scene does not say as authored
  std::optional<Picture> authored;  // our picture with the asset's own models and windows, where they differ from what Mitsuba was given
  Diagnostics diagnostics;
  std::vector<std::pair<std::string, std::string>> facts;  // versions, machine, samples, times: label and text
  std::optional<double> ev100;                             // where the exposure slider starts; none: from the picture
};

// Both pictures as float data, a swipe, exposure, tone-mapped and false-colour views, the difference in units of noise, tabs per light, the
// numbers.
std::string to_html(const Report& report, const Picture& ours, const Picture& reference);

}  // namespace etendue
