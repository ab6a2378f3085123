#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/photometric_bake.h"
#include "etendue/web_batch.h"
#include "texel_grid.h"

namespace etendue {
namespace {

using photometry::TexelGrid;

constexpr std::uint32_t largest_size = 8192;

TexelGrid grid_of(const WebBake& bake) { return {bake.layout, bake.width, bake.height}; }

double share_of(const WebShade* shade, const Vec3d& direction) { return shade != nullptr ? shade->share(direction) : 1; }
double flux_of(const IntensityWeb& web, const WebShade* shade) { return shade != nullptr ? shade->flux_lm : web.flux_lm(); }

// The largest deviation a quarter of a texel apart, borders included. `batch` is the web in float: its own error counts as deviation.
double deviation_at_texels(const WebBake& bake, const WebBatch& batch, const WebShade* shade) {
  const TexelGrid grid = grid_of(bake);
  constexpr std::uint32_t places = 4;
  const double border = grid.border();
  const auto count = [&](std::uint32_t texels) { return places * (border > 0 ? texels : texels - 1) + 1; };
  const std::uint32_t columns = bake.width == 1 ? 1 : count(bake.width), rows = count(bake.height);
  std::vector<float> x(columns), y(columns), z(columns), cd(columns);
  double worst = 0;
  for (std::uint32_t picture = 0; picture < bake.pictures; ++picture) {
    for (std::uint32_t j = 0; j < rows; ++j) {
      const auto place = [&](std::uint32_t i) {
        return TexelGrid::Place{picture, static_cast<double>(i) / places - border, static_cast<double>(j) / places - border};
      };
      for (std::uint32_t i = 0; i < columns; ++i) {
        const Vec3d d = grid.direction(place(i));
        x[i] = static_cast<float>(d.x), y[i] = static_cast<float>(d.y), z[i] = static_cast<float>(d.z);
      }
      if (!batch.towards(x, y, z, cd, 0)) continue;  // the spans are of one size
      for (std::uint32_t i = 0; i < columns; ++i) {
        const double found = grid.interpolated(bake.values, place(i)) * grid.candelas_per_value(place(i));
        const double wanted = shade != nullptr ? cd[i] * shade->share(grid.direction(place(i))) : cd[i];
        worst = std::max(worst, std::abs(found - wanted));
      }
    }
  }
  return worst;
}

// Nodes, the middles between them, and a hair beyond both ends.
std::vector<double> places_along(const std::vector<double>& nodes) {
  constexpr double hair_deg = 1e-7;
  std::vector<double> places{nodes.front() - hair_deg};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0) places.push_back(0.5 * (nodes[i - 1] + nodes[i]));
    places.push_back(nodes[i]);
  }
  places.push_back(nodes.back() + hair_deg);
  return places;
}

// The largest deviation where the table has its bends and ends.
double deviation_at_table(const WebBake& bake, const IntensityWeb& web, const WebShade* shade) {
  const std::vector<double>& azimuths = web.azimuth().nodes();
  const std::vector<double> polar = places_along(web.polar().nodes());
  const std::vector<double> azimuth = azimuths.size() < 2 ? std::vector<double>{0} : places_along(azimuths);
  double worst = 0;
  for (int copy = 0; copy < web.copies(); ++copy) {
    for (const double theta : polar) {
      if (theta < 0 || theta > 180) continue;
      for (const double phi : azimuth) {
        const Vec3d d = direction_of(web.type(), web.unfolded(theta, phi, copy), web.frame());
        worst = std::max(worst, std::abs(bake.towards(d) - share_of(shade, d) * web.towards(d)));
      }
    }
  }
  return worst;
}

double flux_between(const WebBake& bake, std::uint32_t first_picture, std::uint32_t end) {
  const TexelGrid grid = grid_of(bake);
  double sum = 0;
  const float* value = bake.values.data() + std::size_t{first_picture} * bake.width * bake.height;
  for (std::uint32_t picture = first_picture; picture < end; ++picture) {
    for (std::uint32_t row = 0; row < bake.height; ++row) {
      const double inner = grid.weight(bake.width / 2, row), outer = grid.weight(0, row);
      for (std::uint32_t column = 0; column < bake.width; ++column)
        sum += *value++ * (column == 0 || column + 1 == bake.width ? outer : inner);
    }
  }
  return sum;
}

WebBake baked(const IntensityWeb& web, const WebBatch& batch, BakeLayout layout, std::uint32_t size, const WebShade* shade) {
  WebBake bake;
  bake.layout = layout;
  const bool about_axis = layout == BakeLayout::profile || layout == BakeLayout::c_gamma;
  bake.width = !about_axis ? size : web.symmetry() == WebSymmetry::rotational ? 1 : 2 * size;
  bake.height = size;
  bake.pictures = layout == BakeLayout::cube ? static_cast<std::uint32_t>(cube_faces().size()) : 1;
  const TexelGrid grid = grid_of(bake);
  std::vector<double> exact;
  exact.reserve(std::size_t{bake.pictures} * bake.width * bake.height);
  for (std::uint32_t picture = 0; picture < bake.pictures; ++picture) {
    for (std::uint32_t row = 0; row < bake.height; ++row) {
      for (std::uint32_t column = 0; column < bake.width; ++column) {
        const TexelGrid::Place place{picture, static_cast<double>(column), static_cast<double>(row)};
        const Vec3d d = grid.direction(place);
        exact.push_back(share_of(shade, d) * web.towards(d) / grid.candelas_per_value(place));
      }
    }
  }
  bake.values.assign(exact.begin(), exact.end());
  const double sampled = flux_between(bake, 0, bake.pictures), factor = sampled > 0 ? flux_of(web, shade) / sampled : 1;
  std::transform(exact.begin(), exact.end(), bake.values.begin(), [&](double value) { return static_cast<float>(value * factor); });
  bake.flux_lm = flux_between(bake, 0, bake.pictures);
  bake.error_cd = 4.0 / 3 * std::max(deviation_at_texels(bake, batch, shade), deviation_at_table(bake, web, shade));
  return bake;
}

Status usable(double flux_lm, const WebBake& bake) {
  if (bake.flux_lm > 0 || !(flux_lm > 0)) return Done{};
  return Error{
      "BAKE_TOO_COARSE", fmt::format("expected texels finer than the beam, found it between those of {} rows", bake.height), {}, {}, {}};
}

Status check_size(std::uint32_t size) {
  if (size >= 2 && size <= largest_size) return Done{};
  return Error{"BAKE_SIZE", fmt::format("expected a size of 2 to {} rows, found {}", largest_size, size), {}, {}, {}};
}

}  // namespace

double WebBake::towards(const Vec3d& direction) const {
  const TexelGrid grid = grid_of(*this);
  const TexelGrid::Place place = grid.place(direction);
  return grid.interpolated(values, place) * grid.candelas_per_value(place);
}

double WebBake::flux_of_picture(std::uint32_t picture) const { return flux_between(*this, picture, picture + 1); }

Result<WebBake> bake(const IntensityWeb& web, BakeLayout layout, std::uint32_t size) {
  if (const Status s = check_size(size); !s) return s.error();
  WebBake result = baked(web, WebBatch(web), layout, size, nullptr);
  if (const Status s = usable(web.flux_lm(), result); !s) return s.error();
  return result;
}

Result<WebBake> bake_within(const IntensityWeb& web, BakeLayout layout, double wanted_cd, std::uint32_t fewest, std::uint32_t most,
                            const WebShade* shade) {
  for (const std::uint32_t size : {fewest, most})
    if (const Status s = check_size(size); !s) return s.error();
  const WebBatch batch(web);
  WebBake result;
  double coarser_cd = HUGE_VAL;
  for (std::uint32_t size = fewest;; size *= 2) {
    result = baked(web, batch, layout, size, shade);
    const bool lit = bool(usable(flux_of(web, shade), result)), stuck = result.error_cd > 0.9 * coarser_cd;
    if ((lit && (result.error_cd <= wanted_cd || stuck)) || 2 * std::uint64_t{size} > most) break;
    coarser_cd = lit ? result.error_cd : HUGE_VAL;
  }
  if (const Status s = usable(flux_of(web, shade), result); !s) return s.error();
  return result;
}

std::vector<float> mask_of(const WebBake& bake) {
  const double mean = bake.flux_lm / (4 * pi);
  std::vector<float> mask;
  mask.reserve(bake.values.size());
  for (const float value : bake.values) mask.push_back(mean > 0 ? static_cast<float>(value / mean) : 0.0f);
  return mask;
}

}  // namespace etendue
