// Directions drawn from a web in proportion to its intensity.
#pragma once

#include "etendue/intensity_web.h"

#include <array>
#include <span>

namespace etendue {

// Exact: the density is I(direction) / flux of the very interpolant that is evaluated, so an unoccluded flux has no variance. The map from
// the square is one to one and continuous but at the borders of the table's cells.
class WebSampler {
 public:
  struct Sample {
    Vec3d direction;  // unit, in the luminaire's frame
    double pdf = 0;   // 1/sr; 0: the web is dark
    double cd = 0;
  };

  // Keeps a reference: the web must outlive it. 16 bytes a cell of the table beside it.
  explicit WebSampler(const IntensityWeb& web);

  Sample sample(const Vec2d& u) const;  // u in [0, 1)^2
  // Of many at once: the same to what the last digits of u change. Linear interpolation runs in vectors on the best instruction set that
  // the machine has; the others are drawn one by one. Errors: BATCH_SIZES_DIFFER.
  Status sample(std::span<const Vec2d> u, std::span<Sample> samples) const;
  double pdf(const Vec3d& direction) const { return web_->flux_lm() > 0 ? web_->towards(direction) / web_->flux_lm() : 0; }
  // The u for which sample() gives this direction, to 1e-9; anything where the web is dark.
  Vec2d inverse(const Vec3d& direction) const;

  struct Rows;  // of numbers, that vectors are made of

 private:
  struct Cell {
    std::uint32_t plane, interval;
  };
  // The cell in whose part of [0, 1) a random number is, how far it is in there, and how large that part is.
  struct Found {
    Cell cell;
    double beyond, of;
  };
  // What a copy of the table does to its angles: azimuth' = shift + sign x azimuth, and the sign of the cosine of the polar angle.
  struct Copy {
    double shift_deg, sign, polar_sign;
  };
  struct Polar {
    double angle_deg, sine, cosine;
  };
  // An interval of the polar angle: its start and width, and the integrals of sin and of (theta - start) sin over it.
  struct Interval {
    double from_deg, width_rad, inverse_width, sine, cosine, end_sine, end_cosine, integral, first_moment;
  };
  // A density that is linear in the polar angle: its values at both ends of an interval, and the share that is to be below.
  struct Part {
    double a, b, share;
  };
  std::uint32_t part_of(double u) const;                 // index of first_
  Found found_from(std::uint32_t cell, double u) const;  // from the cell of the part's lower end
  void look_up(std::span<const Vec2d> u, Rows& rows) const;
  std::array<double, 2> ends(const Cell& cell) const;  // mean of the cell's two planes at both polar angles
  double share_below(const Cell& cell, double polar_deg) const;
  Polar polar_for_share(const Cell& cell, double share) const;
  static Polar polar_for_share(const Interval& interval, const Part& part);
  static Polar bracketed(const Interval& interval, const Part& part);

  // After a step of less than this share of the distance to the nearer end, its fourth power is left.
  static constexpr double last_step = 5e-4;

  const IntensityWeb* web_;
  bool linear_;
  int copies_;
  std::array<Copy, 4> copy_{};
  double inverse_flux_ = 0;
  std::vector<Interval> interval_;
  std::uint32_t intervals_ = 0, planes_ = 0;  // of the table, minus one; rotational: one plane
  std::vector<double> running_;               // flux of the cells before, over the total; one more than cells
  std::vector<std::uint32_t> first_;          // for equal parts of [0, 1), the cell of their lower end
};

}  // namespace etendue
