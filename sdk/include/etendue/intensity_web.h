// An intensity distribution made ready: luminous intensity towards any direction, and the exact flux of what is evaluated.
// Directions are in the luminaire's frame: -z is the nadir (gamma = 0, H = V = 0), +x is C0 and +V, +y is C90 and +H.
#pragma once

#include "etendue/photometry.h"
#include "etendue/units.h"
#include "etendue/vec.h"

#include <cstdint>
#include <vector>

namespace etendue {

// Between the tabulated angles. All meet them to rounding, never overshoot them, and are linear in the azimuth (C; H of type A; V of type
// B).
enum class Interpolation {
  linear,  // linear in the polar angle (gamma; V of type A; H of type B)
  cosine,  // linear in its cosine (sine of a latitude): the zonal rule's interpolant, exact for a Lambertian
  cubic    // monotone cubic in the polar angle (Fritsch and Carlson 1980, SIAM J. Numer. Anal. 17, 238)
};

// Where C0 lies and which way C grows. LM-63: counter-clockwise for C, here seen from above; clockwise mirrors y.
struct WebFrame {
  bool clockwise = false;
  double turn_deg = 0;  // C asked for, less C of the file
};

// LM-63 lays the length of a luminaire along C0-C180, CIE practice along C90-C270: C_CIE = C_IES + 90 deg.
enum class Orientation { ies, cie };
double turn_between(Orientation file, Orientation wanted);

// Angles of a web's own kind (deg) and unit vectors. C: horizontal in [0, 360); A, B: in (-180, 180]. Exact to rounding at the poles too.
struct WebAngles {
  double vertical_deg = 0, horizontal_deg = 0;
};
WebAngles angles_of(WebType type, const Vec3d& direction, const WebFrame& frame = {});
Vec3d direction_of(WebType type, const WebAngles& angles, const WebFrame& frame = {});

// One axis of a table: where an angle falls. Nodes may have any spacing.
class AngleAxis {
 public:
  AngleAxis() = default;
  explicit AngleAxis(std::vector<double> nodes);
  const std::vector<double>& nodes() const { return nodes_; }
  double first() const { return start_; }
  double last() const { return end_; }
  bool uniform() const { return uniform_; }  // nodes are first + i step to rounding
  // The interval that holds x, the nearest one if none does, and where x lies in it, 0 to 1.
  struct Place {
    std::uint32_t interval;
    double position;
  };
  Place place(double x) const { return place_past(x - start_); }
  // Of start + past.
  Place place_past(double past) const {
    const double cell = past * cells_per_unit_, held = cell > 0 ? cell : 0;
    auto i = static_cast<std::uint32_t>(static_cast<std::int32_t>(held < last_cell_ ? held : last_cell_));
    if (uniform_) return {i, clamped(cell - static_cast<std::int32_t>(i))};
    if (intervals_.empty()) return {0, 0};
    const double x = start_ + past;
    i = first_[i];
    // Most cells hold the end of at most one interval, and whether x is beyond it is as good as random: no branch for that step.
    i += x >= intervals_[i].upper ? 1 : 0;
    while (x >= intervals_[i].upper) ++i;
    return {i, position(i, x)};
  }
  std::uint32_t interval(double x) const { return place(x).interval; }
  // Where x lies in interval i.
  double position(std::uint32_t i, double x) const { return clamped((x - intervals_[i].lower) * intervals_[i].inverse_width); }

 private:
  struct Interval {
    double lower, inverse_width, upper;  // the last one has no upper end
  };
  static double clamped(double t) { return t > 0 ? (t < 1 ? t : 1) : 0; }

  std::vector<double> nodes_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> first_;  // per cell of equal width, the interval of its lower end
  double start_ = 0, end_ = 0, cells_per_unit_ = 0, last_cell_ = 0;
  bool uniform_ = false;  // nodes are start + i step to rounding
};

class IntensityWeb {
 public:
  // Errors: as check().
  static Result<IntensityWeb> of(const IntensityDistribution& distribution, Interpolation interpolation = Interpolation::linear,
                                 const WebFrame& frame = {});

  // cd; 0 where nothing is tabulated, never negative.
  double towards(const Vec3d& direction) const;  // of any length but 0
  double at(double c_deg, double gamma_deg) const;
  double at_own_angles(const WebAngles& angles) const;  // of the file's type, in its own frame

  // lm: the integral of the above over all directions, to rounding.
  double flux_lm() const { return flux_lm_; }
  // lm between two cones about the nadir, 0 <= from <= to <= 180. To rounding for type C, to 1e-8 of the flux for A and B.
  double flux_between(double from_gamma_deg, double to_gamma_deg) const;
  double max_cd() const { return max_cd_; }

  WebType type() const { return type_; }
  WebSymmetry symmetry() const { return symmetry_; }
  Interpolation interpolation() const { return interpolation_; }
  const WebFrame& frame() const { return frame_; }
  // The table that is evaluated: polar angle 0..180 from the web's pole (C: gamma; A: 90 + V; B: 90 + H), azimuth (C; H; V) closed and
  // folded.
  const AngleAxis& polar() const { return polar_; }
  const AngleAxis& azimuth() const { return azimuth_; }
  // cd at a node, and of all of them, the polar angle fastest.
  double node(std::size_t azimuth, std::size_t polar) const { return candela_[azimuth * polar_.nodes().size() + polar]; }
  const std::vector<double>& candelas() const { return candela_; }
  // How often the sphere repeats the table: 1, 2 or 4.
  int copies() const;

  // Along one plane of the table, by interval and position; the derivative per degree of the cubic at its nodes.
  double profile(std::size_t plane, std::uint32_t interval, double polar_deg, double cosine) const;
  // Integral of profile(plane) sin(theta) dtheta over part of an interval, angles in degrees.
  double profile_integral(std::size_t plane, std::uint32_t interval, double from_deg, double to_deg) const;

  // From the web's own angles to the table, and back from one of the copies() that mirror it.
  struct Folded {
    double polar_deg = 0, azimuth_deg = 0;
    int copy = 0;      // 0 to copies() - 1
    bool lit = false;  // false: nothing is tabulated there
  };
  Folded folded(const WebAngles& own) const;
  WebAngles unfolded(double polar_deg, double azimuth_deg, int copy) const;

 private:
  double at_table(double polar_deg, double azimuth_deg) const;
  double at_usual(double gamma_deg, double past_deg) const;
  double plane_integral(std::size_t plane, double from_deg, double to_deg) const;

  WebType type_ = WebType::c;
  WebSymmetry symmetry_ = WebSymmetry::none;
  Interpolation interpolation_ = Interpolation::linear;
  WebFrame frame_;
  AngleAxis polar_, azimuth_;
  std::vector<double> candela_;  // polar angle fastest
  std::vector<double> slope_;    // cubic alone, cd per degree
  std::vector<double> cosine_;   // of the polar nodes
  double flux_lm_ = 0, max_cd_ = 0;
  bool usual_ = false;                             // type C, linear in the angle
  std::size_t angles_ = 0;                         // polar nodes
  double origin_deg_ = 0;                          // type C: the first plane, in the frame's C
  double half_deg_ = 1e300, quarter_deg_ = 1e300;  // type C: beyond which a mirror folds, from the first plane
};

}  // namespace etendue
