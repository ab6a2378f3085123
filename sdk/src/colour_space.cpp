#include "etendue/colour_space.h"

#include "edit_distance.h"
#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace etendue {
namespace {

constexpr std::array all_spaces{rec709, rec2020, p3_d65, acescg};

struct Cones {
  ChromaticAdaptation adaptation;
  std::string_view name;
  Matrix3 rows;  // the published rows, as columns
};
constexpr std::array all_cones{
    Cones{ChromaticAdaptation::none, "none", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    Cones{ChromaticAdaptation::xyz_scaling, "xyz_scaling", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    Cones{ChromaticAdaptation::von_kries, "von_kries", {{0.40024, 0.70760, -0.08081}, {-0.22630, 1.16532, 0.04570}, {0, 0, 0.91822}}},
    Cones{ChromaticAdaptation::bradford, "bradford", {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}},
    Cones{ChromaticAdaptation::cat02, "cat02", {{0.7328, 0.4296, -0.1624}, {-0.7036, 1.6975, 0.0061}, {0.0030, 0.0136, 0.9834}}},
    Cones{ChromaticAdaptation::cat16,
          "cat16",
          {{0.401288, 0.650173, -0.051461}, {-0.250268, 1.204414, 0.045854}, {-0.002079, 0.048952, 0.953127}}},
};
const Cones& cones_of(ChromaticAdaptation adaptation) { return all_cones[static_cast<std::size_t>(adaptation)]; }

// The one whose name it is, or an error that says what is nearest.
template <class All>
Result<typename All::value_type> named(const All& all, std::string_view name, const char* parameter, const char* code, const char* what) {
  std::vector<Candidate> candidates;
  for (const auto& known : all) {
    if (known.name == name) return known;
    candidates.push_back({std::string(known.name), std::string(known.name)});
  }
  return parameter_error(parameter, code, fmt::format("\"{}\" is no {}", name, what),
                         fmt::format("nearest: {}", fmt::join(nearest_candidates(name, candidates, 3), ", ")));
}

bool has_luminance(const Chromaticity& xy) { return std::isfinite(xy.x) && std::isfinite(xy.y) && xy.y > 0; }

}  // namespace

std::span<const ColourSpace> colour_spaces() { return all_spaces; }
Result<ColourSpace> colour_space(std::string_view name) { return named(all_spaces, name, "space", "COLOUR_SPACE_UNKNOWN", "colour space"); }

std::string_view name_of(ChromaticAdaptation adaptation) { return cones_of(adaptation).name; }
Result<ChromaticAdaptation> adaptation_of(std::string_view name) {
  const Result<Cones> found = named(all_cones, name, "adaptation", "ADAPTATION_UNKNOWN", "chromatic adaptation");
  if (!found) return found.error();
  return found->adaptation;
}

// cones^-1 diag(response to `to` / response to `from`) cones.
Result<Matrix3> adaptation_matrix(const Chromaticity& from, const Chromaticity& to, ChromaticAdaptation adaptation) {
  if (adaptation == ChromaticAdaptation::none) return cones_of(adaptation).rows;
  const Matrix3 cones = transposed(cones_of(adaptation).rows);
  for (const Chromaticity& white : {from, to}) {
    const Vec3d response = has_luminance(white) ? cones * to_xyz(white) : Vec3d{};
    if (!(std::min({response.x, response.y, response.z}) > 0))
      return parameter_error("white", "WHITE_POINT_INVALID",
                             fmt::format("expected a white point that every cone responds to, found ({}, {})", white.x, white.y));
  }
  const Vec3d source = cones * to_xyz(from), target = cones * to_xyz(to);
  const Matrix3 scale{{target.x / source.x, 0, 0}, {0, target.y / source.y, 0}, {0, 0, target.z / source.z}};
  return inverse(cones) * scale * cones;
}

Result<Matrix3> conversion(const ColourSpace& from, const ColourSpace& to, ChromaticAdaptation adaptation) {
  const Result<Matrix3> adapted = adaptation_matrix(from.white, to.white, adaptation);
  if (!adapted) return adapted.error();
  return xyz_to_rgb(to) * *adapted * rgb_to_xyz(from);
}

Result<Matrix3> white_balance(const Chromaticity& scene_white, const ColourSpace& space, ChromaticAdaptation adaptation) {
  const Result<Matrix3> adapted = adaptation_matrix(scene_white, space.white, adaptation);
  if (!adapted) return adapted.error();
  return xyz_to_rgb(space) * *adapted * rgb_to_xyz(space);
}

InSpace in_space(const Rgb& rgb) {
  constexpr double rounding = 1e-9;
  const auto [least, largest] = std::minmax({rgb.x, rgb.y, rgb.z});
  return {rgb, least >= -rounding * std::abs(largest)};
}

Result<InSpace> to_space(const Chromaticity& xy, const ColourSpace& space, const WhitePolicy& white) {
  if (!has_luminance(xy))
    return parameter_error("xy", "CHROMATICITY_INVALID", fmt::format("expected a chromaticity with y > 0, found ({}, {})", xy.x, xy.y));
  const Result<Matrix3> adapted = adaptation_matrix(white.observer_white, space.white, white.adaptation);
  if (!adapted) return adapted.error();
  return in_space(xyz_to_rgb(space) * (*adapted * to_xyz(xy)));
}

}  // namespace etendue
