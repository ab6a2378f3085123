#include "etendue/hdri.h"

#include "parameter_error.h"

#include "etendue/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace etendue {
namespace {

// A rectangle in theta (from +Y) and phi = atan2(x, z), given by its middle and its widths.
struct Patch {
  double theta, phi, d_theta, d_phi;

  Vec3d direction() const { return {std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)}; }
  double solid_angle() const { return 2 * d_phi * std::sin(theta) * std::sin(d_theta / 2); }
  // Integral of the direction over the solid angle: of (sin theta sin phi, cos theta, sin theta cos phi) sin theta, with
  //   integral sin^2 = (d_theta - sin(d_theta) cos(2 theta)) / 2,  integral sin cos = sin(2 theta) sin(d_theta) / 2,
  //   integral sin phi = 2 sin(phi) sin(d_phi / 2).
  Vec3d vector() const {
    const double sine_squared = (d_theta - std::sin(d_theta) * std::cos(2 * theta)) / 2, chord = 2 * std::sin(d_phi / 2);
    return {sine_squared * chord * std::sin(phi), std::sin(2 * theta) * std::sin(d_theta) / 2 * d_phi,
            sine_squared * chord * std::cos(phi)};
  }
  // No direction in it is farther from the middle's than this.
  double radius() const { return std::hypot(d_theta, d_phi) / 2; }
  Patch part(int i, int j, int n) const {
    return {theta + d_theta * ((i + 0.5) / n - 0.5), phi + d_phi * ((j + 0.5) / n - 0.5), d_theta / n, d_phi / n};
  }
};

Patch patch_of(const PanoramaSize& size, std::size_t column, std::size_t row) {
  const double d_phi = 2 * pi / static_cast<double>(size.width), d_theta = pi / static_cast<double>(size.height);
  return {(static_cast<double>(row) + 0.5) * d_theta, pi - (static_cast<double>(column) + 0.5) * d_phi, d_theta, d_phi};
}

// Integral of max(0, normal . direction) over a patch.
double projected_solid_angle(const Patch& patch, const Vec3d& normal) {
  const double height = dot(patch.direction(), normal), margin = patch.radius();
  if (height < -margin) return 0;
  if (height > margin) return dot(patch.vector(), normal);
  constexpr int parts = 8;
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) sum += std::max(0.0, dot(patch.part(i, j, parts).vector(), normal));
  return sum;
}

bool finite(const Vec3f& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

std::optional<Error> wrong_with(std::span<const Vec3f> texels, const PanoramaSize& size) {
  const auto invalid = [](std::string text) { return parameter_error("texels", "PANORAMA_INVALID", std::move(text)); };
  if (size.width == 0 || size.height == 0 || texels.size() / size.width != size.height || texels.size() % size.width != 0)
    return invalid(fmt::format("expected width x height texels, found {} for {} x {}", texels.size(), size.width, size.height));
  for (std::size_t i = 0; i < texels.size(); ++i)
    if (!finite(texels[i]))
      return invalid(fmt::format("expected finite texels, found {} {} {} in column {}, row {}", texels[i].x, texels[i].y, texels[i].z,
                                 i % size.width, i / size.width));
  return {};
}
Result<Vec3d> unit(const Vec3d& direction) {
  const double l = length(direction);
  if (l > 0 && std::isfinite(l)) return direction / l;
  return parameter_error("direction", "DIRECTION_INVALID",
                         fmt::format("expected a direction, found {} {} {}", direction.x, direction.y, direction.z));
}

// visit(index, patch) for each texel whose middle is within `outer`, but not within `inner`, of a direction.
template <class Visit>
void each_within(const PanoramaSize& size, const Vec3d& direction, double inner_rad, double outer_rad, Visit visit) {
  for (std::size_t row = 0; row < size.height; ++row)
    for (std::size_t column = 0; column < size.width; ++column) {
      const Patch patch = patch_of(size, column, row);
      const Vec3d middle = patch.direction();
      const double angle = std::atan2(length(cross(middle, direction)), dot(middle, direction));
      if (angle >= inner_rad && angle <= outer_rad) visit(row * size.width + column, patch);
    }
}

std::optional<Rgb> mean_within(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& direction, double inner_rad,
                               double outer_rad) {
  Rgb sum;
  double weight = 0;
  each_within(size, direction, inner_rad, outer_rad, [&](std::size_t i, const Patch& patch) {
    sum += vec_cast<double>(texels[i]) * patch.solid_angle();
    weight += patch.solid_angle();
  });
  if (!(weight > 0)) return {};
  return sum / weight;
}

Result<double> factor(double measured, const Result<Rgb>& found, const char* parameter, const char* what) {
  if (!found) return found.error();
  const double relative = luminance_of(*found), result = measured / relative;
  if (measured > 0 && relative > 0 && std::isfinite(measured) && std::isfinite(result)) return result;
  return parameter_error(
      measured > 0 && std::isfinite(measured) ? "texels" : parameter, "CALIBRATION_IMPOSSIBLE",
      fmt::format("expected a measured {} above 0 and a panorama that is not black there, found {} measured and {} in the panorama", what,
                  measured, relative));
}

constexpr double sun_diameter_rad = 2 * 0.2666 * pi / 180;  // mean over the year

}  // namespace

Vec3d direction_of_texel(const PanoramaSize& size, std::size_t column, std::size_t row) { return patch_of(size, column, row).direction(); }
double solid_angle_of_texel(const PanoramaSize& size, std::size_t row) { return patch_of(size, 0, row).solid_angle(); }

Result<Rgb> illuminance_of_panorama(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& normal) {
  if (const auto error = wrong_with(texels, size)) return *error;
  const Result<Vec3d> n = unit(normal);
  if (!n) return n.error();
  Rgb sum;
  for (std::size_t row = 0; row < size.height; ++row) {
    Rgb of_row;
    for (std::size_t column = 0; column < size.width; ++column)
      of_row += vec_cast<double>(texels[row * size.width + column]) * projected_solid_angle(patch_of(size, column, row), *n);
    sum += of_row;
  }
  return sum;
}

Result<Rgb> luminance_of_panorama(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& direction, double radius_rad) {
  if (const auto error = wrong_with(texels, size)) return *error;
  const Result<Vec3d> d = unit(direction);
  if (!d) return d.error();
  if (const auto mean = mean_within(texels, size, *d, 0, radius_rad)) return *mean;
  const auto index = [](double at, std::size_t count) {
    return std::min(static_cast<std::size_t>(std::max(0.0, at * static_cast<double>(count))), count - 1);
  };
  const std::size_t column = index(0.5 - std::atan2(d->x, d->z) / (2 * pi), size.width),
                    row = index(std::acos(std::clamp(d->y, -1.0, 1.0)) / pi, size.height);
  return vec_cast<double>(texels[row * size.width + column]);
}

Result<double> factor_for_illuminance(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& normal, double lux) {
  return factor(lux, illuminance_of_panorama(texels, size, normal), "lux", "illuminance");
}
Result<double> factor_for_luminance(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& direction, double radius_rad,
                                    double cd_m2) {
  return factor(cd_m2, luminance_of_panorama(texels, size, direction, radius_rad), "cd_m2", "luminance");
}

Result<SunCut> cut_sun(std::span<Vec3f> texels, const PanoramaSize& size, double radius_rad) {
  if (const auto error = wrong_with(texels, size)) return *error;
  const auto luminance = [](const Vec3f& c) { return luminance_of(vec_cast<double>(c)); };
  const std::size_t brightest = static_cast<std::size_t>(
      std::max_element(texels.begin(), texels.end(), [&](const Vec3f& a, const Vec3f& b) { return luminance(a) < luminance(b); }) -
      texels.begin());

  // The brightest texel is somewhere in the sun; the middle of what is above the sky around it is nearer to its middle.
  Vec3d direction = direction_of_texel(size, brightest % size.width, brightest / size.width);
  Rgb sky;
  std::array<Vec3d, 3> vector;  // of each channel
  for (int refinement = 0; refinement < 4; ++refinement) {
    const auto ring =
        radius_rad > 0 && radius_rad < pi / 3 ? mean_within(texels, size, direction, radius_rad, 1.5 * radius_rad) : std::optional<Rgb>();
    if (!ring)
      return parameter_error(
          "radius_rad", "SUN_RADIUS_INVALID",
          fmt::format("expected a radius below 60 degrees with texels around it, found {} degrees with texels of {} degrees",
                      degrees.of({radius_rad}), 180 / static_cast<double>(size.height)));
    sky = *ring;
    vector = {};
    each_within(size, direction, 0, radius_rad, [&](std::size_t i, const Patch& patch) {
      const Rgb above = vec_cast<double>(texels[i]) - sky;
      for (int c = 0; c < 3; ++c) vector[static_cast<std::size_t>(c)] += patch.vector() * above[c];
    });
    const Vec3d of_luminance = vector[0] * 0.2126 + vector[1] * 0.7152 + vector[2] * 0.0722;
    if (!(dot(of_luminance, direction) > 0))
      return parameter_error("texels", "SUN_NOT_FOUND", "expected something brighter than the sky around it, found nothing");
    if (refinement < 3) direction = normalised(of_luminance);
  }

  SunCut cut;
  const Vec3d of_luminance = vector[0] * 0.2126 + vector[1] * 0.7152 + vector[2] * 0.0722;
  cut.direction = normalised(of_luminance);
  cut.illuminance_lx = length(of_luminance);
  const float most = std::max({texels[brightest].x, texels[brightest].y, texels[brightest].z});
  each_within(size, direction, 0, radius_rad, [&](std::size_t i, const Patch&) {
    cut.at_maximum += std::max({texels[i].x, texels[i].y, texels[i].z}) >= most ? 1 : 0;
    ++cut.texels;
    texels[i] = vec_cast<float>(sky);
  });
  cut.light.name = "sun";
  cut.light.shape = DistantShape{sun_diameter_rad};
  cut.light.emission.given = Emission::Given::illuminance;
  cut.light.emission.value = cut.illuminance_lx;
  cut.light.colour = RgbColour{{dot(vector[0], cut.direction), dot(vector[1], cut.direction), dot(vector[2], cut.direction)}};
  const Basis basis = basis_around(cut.direction);  // a light emits along its -Z: away from the sun
  cut.light.transform.columns = {basis.tangent, basis.bitangent, basis.normal};
  return cut;
}

}  // namespace etendue
