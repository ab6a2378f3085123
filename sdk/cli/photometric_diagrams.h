// Diagrams of intensity distributions as SVG pictures.
#pragma once

#include <span>
#include <string>

#include "etendue/intensity_web.h"
#include "photometric_file.h"

namespace etendue::cli {

struct DrawnWeb {
  const IntensityWeb* web = nullptr;
  std::string label;  // said beside its lines where several are drawn
};

// cd over direction in the planes C0-C180, drawn through, and C90-C270, dashed: round about the light, or along an axis of angles. One web,
// or two over each other.
std::string polar_svg(std::span<const DrawnWeb> webs, const std::string& title);
// Of one web, without words about it and without colours of its own, for a page that has svg_style().
std::string polar_figure(const IntensityWeb& web);
std::string cartesian_svg(std::span<const DrawnWeb> webs, const std::string& title);

// The web as a body: towards each direction as far out as it is bright.
std::string web_svg(const IntensityWeb& web, const std::string& title);

// Lux, or footcandles, on a plane that faces the light from `distance_m` below, or from above where most of it goes up. Several webs: lines
// alone.
std::string isolux_svg(std::span<const DrawnWeb> webs, const std::string& title, double distance_m, Units units);

// "1000 cd peak, 1301.6 lm, beam 54 x 90 deg".
std::string key_figures(const IntensityWeb& web);

}  // namespace etendue::cli
