// From the file's grid to the table that is evaluated, and its evaluation.
#include <algorithm>
#include <cmath>

#include "angle.h"
#include "etendue/intensity_web.h"

namespace etendue {
namespace {

constexpr double degree = pi / 180;

bool mirrors_polar(WebType type, WebSymmetry s) {
  return (type == WebType::a && (s == WebSymmetry::vertical || s == WebSymmetry::lateral_and_vertical)) ||
         (type == WebType::b && (s == WebSymmetry::lateral || s == WebSymmetry::lateral_and_vertical));
}
bool mirrors_azimuth(WebType type, WebSymmetry s) {
  return (type == WebType::a && (s == WebSymmetry::lateral || s == WebSymmetry::lateral_and_vertical)) ||
         (type == WebType::b && (s == WebSymmetry::vertical || s == WebSymmetry::lateral_and_vertical));
}

std::vector<double> from_pole(std::vector<double> latitudes) {
  for (double& angle : latitudes) angle += 90;
  return latitudes;
}

// Fritsch and Carlson's limit, with Brodlie's weighted harmonic mean of the neighbouring chords inside and one-sided parabolas at the ends
// (the same choice as SciPy's PchipInterpolator): monotone where the data are, so never outside their range, and never negative.
void monotone_slopes(const std::vector<double>& x, const double* y, double* slope) {
  const std::size_t n = x.size();
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  if (n == 2) {
    slope[0] = slope[1] = chord(0);
    return;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = chord(i - 1), right = chord(i), a = x[i] - x[i - 1], b = x[i + 1] - x[i];
    slope[i] = left * right > 0 ? 3 * (a + b) / ((2 * b + a) / left + (b + 2 * a) / right) : 0;
  }
  const auto end_slope = [](double near, double far, double chord_near, double chord_far) {
    const double parabola = ((2 * near + far) * chord_near - near * chord_far) / (near + far);
    if (parabola * chord_near <= 0) return 0.0;
    if (chord_near * chord_far <= 0 && std::abs(parabola) > 3 * std::abs(chord_near)) return 3 * chord_near;
    return parabola;
  };
  slope[0] = end_slope(x[1] - x[0], x[2] - x[1], chord(0), chord(1));
  slope[n - 1] = end_slope(x[n - 1] - x[n - 2], x[n - 2] - x[n - 3], chord(n - 2), chord(n - 3));
}

}  // namespace

Result<IntensityWeb> IntensityWeb::of(const IntensityDistribution& distribution, Interpolation interpolation, const WebFrame& frame) {
  if (const Status valid = check(distribution); !valid) return valid.error();
  const IntensityGrid& grid = distribution.grid;
  IntensityWeb web;
  web.type_ = grid.type;
  web.symmetry_ = grid.symmetry;
  web.interpolation_ = interpolation;
  web.frame_ = frame;

  const std::size_t verticals = grid.vertical_deg.size(), horizontals = grid.horizontal_deg.size();
  const double factor = candelas_per_value(distribution);
  if (grid.type == WebType::b) {
    web.polar_ = AngleAxis(from_pole(grid.horizontal_deg));
    web.azimuth_ = AngleAxis(grid.vertical_deg);
    web.candela_.resize(grid.values.size());
    for (std::size_t h = 0; h < horizontals; ++h)
      for (std::size_t v = 0; v < verticals; ++v) web.candela_[v * horizontals + h] = grid.values[h * verticals + v] * factor;
  } else {
    std::vector<double> azimuths = grid.horizontal_deg;
    web.candela_.reserve(grid.values.size() + verticals);
    for (const double value : grid.values) web.candela_.push_back(value * factor);
    if (grid.type == WebType::c && grid.symmetry == WebSymmetry::none && azimuths.back() - azimuths.front() < 360) {
      azimuths.push_back(azimuths.front() + 360);
      for (std::size_t v = 0; v < verticals; ++v) web.candela_.push_back(web.candela_[v]);
    }
    web.polar_ = AngleAxis(grid.type == WebType::c ? grid.vertical_deg : from_pole(grid.vertical_deg));
    web.azimuth_ = AngleAxis(std::move(azimuths));
  }

  if (grid.type == WebType::c && web.copies() > 1) web.half_deg_ = 180;
  if (grid.symmetry == WebSymmetry::quadrant) web.quarter_deg_ = 90;
  const std::vector<double>& polar = web.polar_.nodes();
  for (const double angle : polar) web.cosine_.push_back(std::cos(angle * degree));
  if (interpolation == Interpolation::cubic) {
    web.slope_.resize(web.candela_.size());
    for (std::size_t at = 0; at < web.candela_.size(); at += polar.size()) monotone_slopes(polar, &web.candela_[at], &web.slope_[at]);
  }
  web.usual_ = grid.type == WebType::c && interpolation == Interpolation::linear;
  web.origin_deg_ = frame.turn_deg + web.azimuth_.first();
  web.angles_ = polar.size();
  web.max_cd_ = *std::max_element(web.candela_.begin(), web.candela_.end());
  web.flux_lm_ = web.flux_between(0, 180);
  return web;
}

int IntensityWeb::copies() const {
  switch (symmetry_) {
    case WebSymmetry::none:
    case WebSymmetry::rotational:
      return 1;
    case WebSymmetry::quadrant:
    case WebSymmetry::lateral_and_vertical:
      return 4;
    default:
      return 2;
  }
}

IntensityWeb::Folded IntensityWeb::folded(const WebAngles& own) const {
  Folded f{own.vertical_deg, own.horizontal_deg, 0, false};
  if (type_ == WebType::b) std::swap(f.polar_deg, f.azimuth_deg);
  if (type_ != WebType::c) {
    f.polar_deg += 90;
    int bit = 1;
    if (mirrors_azimuth(type_, symmetry_)) {
      if (f.azimuth_deg < 0) f.azimuth_deg = -f.azimuth_deg, f.copy = bit;
      bit = 2;
    }
    if (mirrors_polar(type_, symmetry_) && f.polar_deg < 90) f.polar_deg = 180 - f.polar_deg, f.copy += bit;
    f.lit = f.polar_deg >= polar_.nodes().front() && f.polar_deg <= polar_.nodes().back() && f.azimuth_deg >= azimuth_.nodes().front() &&
            f.azimuth_deg <= azimuth_.nodes().back();
    return f;
  }
  f.lit = f.polar_deg >= polar_.nodes().front() && f.polar_deg <= polar_.nodes().back();
  const double start = azimuth_.nodes().front();
  double past = f.azimuth_deg - start;
  if (past < 0) past += 360;
  if (!(past >= 0 && past <= 360)) past -= 360 * std::floor(past / 360);
  const bool beyond_half = past > half_deg_;
  past = beyond_half ? 360 - past : past;
  const bool beyond_quarter = past > quarter_deg_;
  past = beyond_quarter ? 180 - past : past;
  f.copy = symmetry_ == WebSymmetry::quadrant ? 2 * beyond_half + beyond_quarter : beyond_half;
  f.azimuth_deg = start + past;
  return f;
}

WebAngles IntensityWeb::unfolded(double polar, double azimuth, int copy) const {
  if (type_ != WebType::c) {
    const bool azimuths = mirrors_azimuth(type_, symmetry_);
    if (azimuths && (copy & 1) != 0) azimuth = -azimuth;
    if ((copy & (azimuths ? 2 : 1)) != 0) polar = 180 - polar;
    return type_ == WebType::b ? WebAngles{azimuth, polar - 90} : WebAngles{polar - 90, azimuth};
  }
  const double start = azimuth_.nodes().front();
  double past = azimuth - start;
  const bool quadrant = symmetry_ == WebSymmetry::quadrant;
  if (quadrant && (copy & 1) != 0) past = 180 - past;
  if ((copy & (quadrant ? 2 : 1)) != 0) past = 360 - past;
  return {polar, start + past};
}

double IntensityWeb::profile(std::size_t plane, std::uint32_t i, double polar_deg, double cosine) const {
  const std::vector<double>& x = polar_.nodes();
  const double* const y = &candela_[plane * x.size() + i];
  const double width = x[i + 1] - x[i];
  if (interpolation_ == Interpolation::cosine) {
    const double t = std::clamp((cosine_[i] - cosine) / (cosine_[i] - cosine_[i + 1]), 0.0, 1.0);
    return y[0] + t * (y[1] - y[0]);
  }
  const double t = polar_.position(i, polar_deg);
  if (interpolation_ == Interpolation::linear) return y[0] + t * (y[1] - y[0]);
  const double* const s = &slope_[plane * x.size() + i];
  const double u = 1 - t;
  const double value = y[0] * u * u * (1 + 2 * t) + y[1] * t * t * (1 + 2 * u) + width * t * u * (s[0] * u - s[1] * t);
  return std::clamp(value, std::min(y[0], y[1]), std::max(y[0], y[1]));  // rounding alone could leave the range
}

double IntensityWeb::at_table(double polar_deg, double azimuth_deg) const {
  const AngleAxis::Place p = polar_.place(polar_deg);
  const bool one_plane = symmetry_ == WebSymmetry::rotational;
  const AngleAxis::Place a = one_plane ? AngleAxis::Place{0, 0} : azimuth_.place(azimuth_deg);
  const double cosine = interpolation_ == Interpolation::cosine ? std::cos(polar_deg * degree) : 0;
  const double near = profile(a.interval, p.interval, polar_deg, cosine);
  if (one_plane) return near;
  const double far = profile(a.interval + 1, p.interval, polar_deg, cosine);
  return near + a.position * (far - near);
}

// The usual web, type C and linear, without a call; `past_deg` from the first plane.
inline double IntensityWeb::at_usual(double gamma_deg, double past_deg) const {
  if (!(gamma_deg >= polar_.first() && gamma_deg <= polar_.last())) return 0;
  const AngleAxis::Place p = polar_.place(gamma_deg);
  if (symmetry_ == WebSymmetry::rotational) {
    const double* const y = &candela_[p.interval];
    return y[0] + p.position * (y[1] - y[0]);
  }
  if (!(past_deg >= -360 && past_deg <= 360)) past_deg -= 360 * std::floor(past_deg / 360);
  const AngleAxis::Place a = azimuth_.place_past(photometry::folded_past(past_deg, half_deg_, quarter_deg_));
  const double* const y = &candela_[a.interval * angles_ + p.interval];
  const double* const z = y + angles_;
  const double near = y[0] + p.position * (y[1] - y[0]), far = z[0] + p.position * (z[1] - z[0]);
  return near + a.position * (far - near);
}

double IntensityWeb::at_own_angles(const WebAngles& angles) const {
  if (usual_) return at_usual(angles.vertical_deg, angles.horizontal_deg - azimuth_.first());
  const Folded f = folded(angles);
  return f.lit ? at_table(f.polar_deg, f.azimuth_deg) : 0;
}

double IntensityWeb::at(double c_deg, double gamma_deg) const {
  const double turned = frame_.clockwise ? -c_deg : c_deg;
  if (usual_) return at_usual(gamma_deg, turned - origin_deg_);
  if (type_ == WebType::c) return at_own_angles({gamma_deg, turned - frame_.turn_deg});
  return towards(direction_of(WebType::c, {gamma_deg, c_deg}));
}

double IntensityWeb::towards(const Vec3d& direction) const {
  if (!usual_) return at_own_angles(angles_of(type_, direction, frame_));
  const double x = direction.x, y = frame_.clockwise ? -direction.y : direction.y, square = x * x + y * y;
  const double leg = square > 1e-290 && square < 1e290 ? std::sqrt(square) : std::hypot(x, y);
  if (symmetry_ == WebSymmetry::rotational) return at_usual(photometry::atan2_deg(leg, -direction.z), 0);
  const photometry::Pair angles = photometry::two_atan2_deg(leg, -direction.z, y, x);
  return at_usual(angles[0], angles[1] - origin_deg_);
}

}  // namespace etendue
