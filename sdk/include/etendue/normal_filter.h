// What the texels of a normal map turn into where they are too small to be seen one by one: roughness.
//   const FilteredLobe lobe = filtered_lobe(alpha, length);   // `length` of the texels' mean normal
//   for (const NormalLevel& level : filter_normals({width, height, normals, alphas})) ...   // a chain of mip levels
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

// von Mises and Fisher's distribution about the mean normal, density kappa / (4 pi sinh kappa) exp(kappa cos): the length of its mean is
// coth kappa - 1 / kappa. From 0 (all directions alike) to infinity at length 1; lengths beyond [0, 1] are taken as its ends. Relative
// error of kappa at most 1e-12 / (1 - length).
double normal_concentration(double mean_length);
double mean_normal_length(double concentration);

enum class NormalFilter {
  // The GGX lobe nearest to the average of the texels' lobes, from a table (sdk/docs/normal-filtering.md).
  ggx,
  // alpha^2 + 2 / kappa, at most 1: slopes' variances add up, as those of Gaussian facets do.
  slopes,
  // Lagarde and de Rousiers 2014, listing 32, as printed: kappa with r^2 where r^3 is meant, and 1 / (2 kappa) for 2 / kappa.
  listing32,
};
std::optional<NormalFilter> normal_filter_named(std::string_view name);  // "ggx", "slopes", "listing32"

struct FilteredLobe {
  double alpha = 1;
  // Share of the facets that the lobe has in other places than the average: 1/2 int |D - D'| cos(h) dh, both normalised. Of `ggx` alone; 0
  // for the others, of which it is not known.
  double misplaced = 0;
};
// Both within [0, 1]. With `ggx` the lobe misplaces no more than 1e-3 beyond what the nearest one does, and `misplaced` is right to 3e-3.
FilteredLobe filtered_lobe(double alpha, double mean_length, NormalFilter filter = NormalFilter::ggx);

// A normal map in tangent space, row by row: directions (not zero; taken as unit vectors), and alpha, one for all texels or one for each.
struct NormalField {
  std::uint32_t width = 0, height = 0;
  std::span<const Vec3f> normals;
  std::span<const float> alphas;
};
// Of every texel of a level: the mean of the normals under it, and alpha as authored (root of the mean square) and filtered.
struct NormalLevel {
  std::uint32_t width = 0, height = 0;
  std::vector<Vec3f> means;
  std::vector<float> authored_alphas, alphas, misplaced;
};
// Half as many texels a side, rounded down, from level to level, down to one; the field itself is the first. A texel stands for the exact
// area under it, so that every level has the same mean. Errors: FIELD_UNSUITABLE (sizes that do not agree, a normal without a direction, an
// alpha that is not within [0, 1]), with the place.
Result<std::vector<NormalLevel>> filter_normals(const NormalField& field, NormalFilter filter = NormalFilter::ggx);

}  // namespace etendue
