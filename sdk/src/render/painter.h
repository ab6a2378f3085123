// One light's part of the picture. The method and its error estimates are derived in sdk/docs/rendering.md.
#pragma once

#include "lighting.h"
#include "rows.h"
#include "survey.h"

#include "etendue/render.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace etendue::rendering {

struct PainterOptions {
  std::uint32_t width = 0, height = 0;
  double expected_noise = 0.01;
  std::uint64_t seed = 1;
  Shadows shadows = Shadows::unbiased;
  std::uint32_t shadow_samples = 0;
  double shading_tolerance = 0;
};

class LightPainter {
 public:
  LightPainter(const Stage& stage, const PinholeCamera& camera, const Survey& survey, const StageLight& light,
               const PainterOptions& options);

  static constexpr int centre_passes = 5;
  static constexpr double gentle_bend = 0.01;  // Curvature::relative up to which second differences give a pixel's mean
  static constexpr std::size_t passes = 3 + centre_passes;
  // Fills width x height values and variances. False: cancelled.
  bool run(RowRunner& rows);
  const std::vector<Rgb>& value() const { return value_; }
  const std::vector<Rgb>& variance() const { return variance_; }
  // The part of the variance that is no deviation but what an error may be: mostly far more than it is.
  const std::vector<Rgb>& bound() const { return bound_; }

 private:
  struct Measured {
    Rgb value, variance;
    double bound = 0;  // of the shading's own error, beside the variance
    Rgb supposed;      // the part of the variance that a quadrature's error may be
  };
  // A square part of the picture, its sides in pixels.
  struct Cell {
    double x, y, side;
  };
  // A cell is quartered at least and at most so often, in between until two rules differ by no more than this share of the tolerance.
  struct Halvings {
    int most, least = 0;
    double share = 1;
    Halvings within() const { return {most - 1, std::max(least - 1, 0), share}; }
  };
  struct Curvature {
    Rgb correction;   // from the centre's value to the pixel's mean
    double relative;  // |f_xx / f| + |f_yy / f|
  };
  // Light around a pixel's centre, as a quadratic function of the place.
  struct Local {
    Rgb f, f_x, f_y, f_xx, f_yy;
    Rgb at(double dx, double dy) const { return f + f_x * dx + f_y * dy + f_xx * (0.5 * dx * dx) + f_yy * (0.5 * dy * dy); }
  };
  // What the pilot samples around a pixel, its own left out, say about shadows there.
  struct Surroundings {
    double beta = 1;
    bool mixed = false;
    bool only_sampled() const { return mixed && !(beta > 0); }
  };
  // A pixel with its shadow, and the variance that is the shadow's alone.
  struct Shadowed {
    Measured all;
    Rgb shadow_variance;
  };

  double typical_luminance() const;
  void pilot_row(std::uint32_t row, RayCounts& counts);
  void picture_row(std::uint32_t row);
  bool find_centres(RowRunner& rows);
  void centre_row(std::uint32_t row, int pass, RayCounts& counts);
  std::optional<Response> interpolated(std::uint32_t x, std::uint32_t y, const Rgb& colour) const;
  void paint_row(std::uint32_t row, RayCounts& counts);
  void pool_row(std::uint32_t row);
  Surroundings surroundings(std::uint32_t x, std::uint32_t y) const;
  bool centre_is_needed(std::uint32_t x, std::uint32_t y) const;
  bool is_uneven(std::size_t pixel) const;
  bool has_plan(std::size_t pixel) const;
  bool is_plain(const std::optional<SurfacePoint>& point) const;
  bool is_coloured(const std::optional<SurfacePoint>& point) const;
  bool is_matt(const SurfacePoint& point) const;
  PixelTarget target(std::uint32_t x, std::uint32_t y, const SurfacePoint* plane) const;
  Reflected at(double x, double y, double beta, RayCounts& counts) const;
  std::vector<Reflected> at(std::span<const Vec2d> places, double beta, RayCounts& counts) const;
  using Integrand = std::function<Reflected(double x, double y)>;
  Measured over_places(std::uint32_t x, std::uint32_t y, const Integrand& light) const;
  Measured over_colours(std::uint32_t x, std::uint32_t y, double beta, const SurfacePoint& centre, RayCounts& counts) const;
  Reflected gauss_legendre(const Cell& cell, double beta, int side, RayCounts& counts) const;
  Measured cubature(const Cell& cell, double beta, const Halvings& halvings, RayCounts& counts) const;
  Measured smooth(std::uint32_t x, std::uint32_t y, double beta, const std::optional<SurfacePoint>& centre, RayCounts& counts) const;
  Measured split(std::uint32_t x, std::uint32_t y, const Regions& regions, double beta, RayCounts& counts) const;
  // What is seen of the light itself, and what surfaces reflect of it, times beta, without shadows.
  Measured exact(std::uint32_t x, std::uint32_t y, double beta, const std::optional<SurfacePoint>& centre, RayCounts& counts) const;
  // Empty where it is known to change nothing.
  Sampled sampled(std::uint32_t x, std::uint32_t y, const Surroundings& around, const std::optional<SurfacePoint>& centre,
                  RayCounts& counts) const;
  Shadowed by_difference(std::uint32_t x, std::uint32_t y, const Surroundings& around, const std::optional<SurfacePoint>& centre,
                         RayCounts& counts) const;
  Shadowed by_ratio(std::uint32_t x, std::uint32_t y, const Surroundings& around, const std::optional<SurfacePoint>& centre,
                    RayCounts& counts) const;
  // `colour`: the base colour that all places are taken to have, where a texture changes it.
  Rgb centre(std::size_t pixel, const Rgb& colour) const { return black_[pixel] + slope_[pixel] * colour; }
  std::optional<Curvature> curvature(std::uint32_t x, std::uint32_t y, const Rgb& colour) const;
  bool is_level(std::uint32_t x, std::uint32_t y, const Rgb& colour) const;
  bool is_gentle(std::uint32_t x, std::uint32_t y, const SurfacePoint& centre) const;
  Local local(const std::vector<Rgb>& values, std::uint32_t x, std::uint32_t y) const;
  std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * options_.width + x; }
  std::uint64_t seed(std::size_t pixel, std::uint64_t purpose) const;

  const Stage& stage_;
  const PinholeCamera& camera_;
  const Survey& survey_;
  const StageLight& light_;
  PainterOptions options_;
  Lighting lighting_;
  eval::Tolerance tolerance_;
  std::optional<eval::LightPlan> plan_;  // to that tolerance
  bool shadows_;                         // something may stand in the light's way
  std::vector<std::uint8_t> pictured_;   // of a picture's light: pixels where nothing mirrors its detail
  std::vector<float> visible_, all_;     // pilot: light with and without shadows
  std::vector<Rgb> black_, slope_;       // unblocked light at the centres of smooth pixels, as Response
  std::vector<float> centre_bound_;      // what its error may be
  std::vector<std::uint8_t> known_;      // where they hold something
  std::vector<Rgb> value_, variance_, bound_;
  std::vector<Rgb> mixed_variance_;     // of the samples in smooth pixels whose shadows are mixed
  std::vector<std::uint8_t> is_mixed_;  // which those are
};

}  // namespace etendue::rendering
