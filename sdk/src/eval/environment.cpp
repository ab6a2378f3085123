#include "environment.h"

#include "etendue/colour.h"
#include "etendue/units.h"
#include "local.h"
#include "shifted_points.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

Vec2d uv_of(const Vec3d& d) {
  double u = std::atan2(d.x, -d.z) / (2 * pi);
  if (u < 0) u += 1;
  const double v = std::atan2(std::hypot(d.x, d.z), d.y) / pi;
  return {u, v};
}

Vec3d direction_of(double u, double v) {
  const double phi = 2 * pi * u, theta = pi * v, s = std::sin(theta);
  return {s * std::sin(phi), std::cos(theta), -s * std::cos(phi)};
}

}  // namespace

// A bilinear lookup reaches one texel beyond its own, so the density of a texel is taken from the mean of it and its neighbours: it is
// nowhere 0 where the map is not.
EnvironmentMap::EnvironmentMap(std::uint32_t width, std::uint32_t height, std::vector<Vec3f> pixels)
    : width_(std::max(width, 1u)), height_(std::max(height, 1u)), pixels_(std::move(pixels)) {
  pixels_.resize(static_cast<std::size_t>(width_) * height_);
  for (Vec3f& p : pixels_) {
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(p[c])) p[c] = 0;
    }
  }
  conditional_.reserve((static_cast<std::size_t>(width_) + 1) * height_);
  row_weight_.assign(height_, 0);
  double total_solid_angle = 0;
  for (std::uint32_t row = 0; row < height_; ++row) {
    const double solid_angle = std::cos(pi * row / height_) - std::cos(pi * (row + 1) / height_);  // of the row, over 2 pi
    std::vector<double> sums{0};
    for (std::uint32_t column = 0; column < width_; ++column) {
      double near = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Rgb t = texel(std::int64_t{column} + dx, std::int64_t{row} + dy);
          near += std::max({t.x, t.y, t.z, 0.0}) * (dx == 0 ? 2 : 1) * (dy == 0 ? 2 : 1);
        }
      }
      sums.push_back(sums.back() + near);
      mean_luminance_ += luminance_of(texel(column, row)) * solid_angle / width_;
    }
    total_solid_angle += solid_angle;
    row_weight_[row] = sums.back() * solid_angle;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      conditional_.push_back(static_cast<float>(sums.back() > 0 ? sums[i] / sums.back() : static_cast<double>(i) / width_));
    }
  }
  mean_luminance_ /= total_solid_angle;
  double total = 0;
  for (const double w : row_weight_) total += w;
  marginal_.push_back(0);
  for (double& w : row_weight_) {
    w = total > 0 ? w / total : 1.0 / height_;
    marginal_.push_back(marginal_.back() + w);
  }
  marginal_.back() = 1;
}

Rgb EnvironmentMap::texel(std::int64_t column, std::int64_t row) const {
  const std::int64_t w = width_, h = height_;
  column = (column % w + w) % w;
  row = std::clamp<std::int64_t>(row, 0, h - 1);
  return vec_cast<double>(pixels_[static_cast<std::size_t>(row * w + column)]);
}

Rgb EnvironmentMap::lookup(const Vec3d& direction) const {
  const Vec2d uv = uv_of(direction);
  const double x = uv.x * width_ - 0.5, y = uv.y * height_ - 0.5;
  const double fx = std::floor(x), fy = std::floor(y), ax = x - fx, ay = y - fy;
  const auto column = static_cast<std::int64_t>(fx), row = static_cast<std::int64_t>(fy);
  return (texel(column, row) * (1 - ax) + texel(column + 1, row) * ax) * (1 - ay) +
         (texel(column, row + 1) * (1 - ax) + texel(column + 1, row + 1) * ax) * ay;
}

// Within a row the cosine is uniform, within a texel u is: the density is uniform over the solid angle of the texel.
Vec3d EnvironmentMap::sample(const Vec2d& u) const {
  const auto row_end = std::upper_bound(marginal_.begin() + 1, marginal_.end() - 1, u.y);
  const auto row = static_cast<std::size_t>(row_end - marginal_.begin()) - 1;
  const double within_row = row_weight_[row] > 0 ? std::clamp((u.y - marginal_[row]) / row_weight_[row], 0.0, 1.0) : 0.5;
  const double top = std::cos(pi * static_cast<double>(row) / height_), bottom = std::cos(pi * static_cast<double>(row + 1) / height_);
  const float* sums = &conditional_[row * (width_ + 1)];
  const float* column_end = std::upper_bound(sums + 1, sums + width_, static_cast<float>(u.x));
  const auto column = static_cast<std::size_t>(column_end - sums) - 1;
  const double span = double{sums[column + 1]} - sums[column];
  const double within = span > 0 ? std::clamp((u.x - sums[column]) / span, 0.0, 1.0) : 0.5;
  const double cosine = top + (bottom - top) * within_row;
  return direction_of((static_cast<double>(column) + within) / width_, std::acos(std::clamp(cosine, -1.0, 1.0)) / pi);
}

double EnvironmentMap::pdf(const Vec3d& direction) const {
  const Vec2d uv = uv_of(direction);
  const auto row = std::min<std::size_t>(static_cast<std::size_t>(uv.y * height_), height_ - 1);
  const auto column = std::min<std::size_t>(static_cast<std::size_t>(uv.x * width_), width_ - 1);
  const float* sums = &conditional_[row * (width_ + 1)];
  const double solid_angle =
      2 * pi / width_ * (std::cos(pi * static_cast<double>(row) / height_) - std::cos(pi * static_cast<double>(row + 1) / height_));
  return row_weight_[row] * (double{sums[column + 1]} - sums[column]) / solid_angle;
}

std::shared_ptr<const EnvironmentMap> make_environment(std::uint32_t width, std::uint32_t height, std::vector<Vec3f> pixels) {
  return std::make_shared<const EnvironmentMap>(width, height, std::move(pixels));
}
Rgb lookup(const EnvironmentMap& map, const Vec3d& local_direction) { return map.lookup(local_direction); }
double mean_luminance(const EnvironmentMap& map) { return map.mean_luminance(); }

// Both techniques take n points each, weighted by the balance heuristic (Veach 1997): sum of f / (p_map + p_brdf) / n. The points are
// shifted at random 16 times. n doubles until three standard deviations are within the tolerance.
Estimate environment_reference(const Emitter& emitter, const EnvironmentEmitter& environment, const ShadingPoint& point,
                               const Tolerance& tolerance) {
  constexpr int shifts = 16;
  constexpr std::uint64_t most = 1u << 17;  // points of one shift
  const LocalFrame frame(point);
  const Vec3d view = frame.vector(point.view);
  const EnvironmentMap& map = *environment.map;
  Transform to_world;  // the inverse of a rotation is its transpose
  for (int i = 0; i < 3; ++i) {
    to_world.columns[static_cast<std::size_t>(i)] = {environment.to_local.columns[0][i], environment.to_local.columns[1][i],
                                                     environment.to_local.columns[2][i]};
  }
  const auto weighted = [&](const Vec3d& in_map, const Vec3d& world, const Vec3d& light) {
    if (!(light.z > 0) || !(dot(world, point.surface_normal) > 0)) return Rgb{};
    const double pdf = map.pdf(in_map) + pdf_brdf(point.brdf, view, light);
    return pdf > 0 ? brdf_cos(point.brdf, view, light) * map.lookup(in_map) / pdf : Rgb{};
  };
  const ShiftedPoints points(shifts, 1);
  std::array<Rgb, shifts> sums{};
  Estimate estimate;
  std::uint64_t done = 0;
  for (std::uint64_t n = 64; n <= most; n *= 2) {
    for (std::size_t k = 0; k < shifts; ++k) {
      for (std::uint64_t i = done; i < n; ++i) {
        const Vec2d u = points(k, i);
        const Vec3d in_map = map.sample(u);
        const Vec3d world = to_world.vector(in_map);
        sums[k] += weighted(in_map, world, frame.vector(world));
        const DirectionSample drawn = sample_brdf(point.brdf, view, u);
        if (drawn.pdf > 0) {
          const Vec3d out = frame.to_world(drawn.direction);
          sums[k] += weighted(environment.to_local.vector(out), out, drawn.direction);
        }
      }
    }
    done = n;
    estimate.evaluations = 2 * n * shifts;
    std::array<Rgb, shifts> means;
    for (std::size_t k = 0; k < shifts; ++k) means[k] = sums[k] / static_cast<double>(n);
    const ScatteredMean mean = mean_of(means);
    estimate.value = mean.value * emitter.radiance;
    bool enough = true;
    for (int c = 0; c < 3; ++c) {
      estimate.error[c] = 3 * mean.deviation[c] * std::abs(emitter.radiance[c]);
      enough = enough && estimate.error[c] <= std::max(tolerance.relative * std::abs(estimate.value[c]), tolerance.absolute);
    }
    if (enough) break;
  }
  return estimate;
}

}  // namespace etendue::eval
