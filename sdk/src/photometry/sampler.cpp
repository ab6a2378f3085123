// A cell of the table by its flux, the polar angle in it by the mean of its two planes, the azimuth between them: each by its inverse
// distribution, with the remainder of the same random number.
#include "etendue/web_sampler.h"

#include "angle.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// Where the integral of a density that runs linearly from a to b over [0, 1] reaches `share` of itself. No difference of like numbers.
double linear_inverse(double a, double b, double share) {
  const double root = std::sqrt(a * a + share * (b - a) * (b + a)), sum = a + root;
  return sum > 0 ? std::min(share * (a + b) / sum, 1.0) : share;
}
double linear_share(double a, double b, double t) { return a + b > 0 ? t * (2 * a + t * (b - a)) / (a + b) : t; }

using photometry::degree;
using photometry::SineCosine;

SineCosine sine_cosine(double x) { return x < 0.785 ? photometry::sine_cosine_small(x) : SineCosine{std::sin(x), std::cos(x)}; }

}  // namespace

WebSampler::WebSampler(const IntensityWeb& web) : web_(&web), intervals_(web.polar().nodes().size() - 1) {
  const std::vector<double>&x = web.polar().nodes(), &phi = web.azimuth().nodes();
  planes_ = std::max<std::size_t>(phi.size() - 1, 1);
  for (const double angle : x) {
    const SineCosine t = photometry::sine_cosine_deg(angle);
    node_.push_back({angle, t.sine, t.cosine});
  }
  const bool one_plane = phi.size() < 2;
  running_.reserve(intervals_ * planes_ + 1);
  double sum = 0;
  running_.push_back(0);
  for (std::size_t j = 0; j < planes_; ++j) {
    const double width = one_plane ? 2 * pi : 0.5 * (phi[j + 1] - phi[j]) * degree;
    for (std::uint32_t i = 0; i < intervals_; ++i) {
      sum += width * (web.profile_integral(j, i, x[i], x[i + 1]) + (one_plane ? 0 : web.profile_integral(j + 1, i, x[i], x[i + 1])));
      running_.push_back(sum);
    }
  }
  if (!(sum > 0)) return;
  for (double& r : running_) r /= sum;
  running_.back() = 1;
  const std::size_t cells = running_.size() - 1;
  first_.resize(cells);
  std::uint32_t cell = 0;
  for (std::size_t part = 0; part < cells; ++part) {
    while (cell + 1 < cells && running_[cell + 1] <= static_cast<double>(part) / static_cast<double>(cells)) ++cell;
    first_[part] = cell;
  }
}

std::array<double, 2> WebSampler::ends(const Cell& c) const {
  const std::size_t next = web_->azimuth().nodes().size() < 2 ? c.plane : c.plane + 1;
  return {0.5 * (web_->node(c.plane, c.interval) + web_->node(next, c.interval)),
          0.5 * (web_->node(c.plane, c.interval + 1) + web_->node(next, c.interval + 1))};
}

double WebSampler::share_below(const Cell& c, double polar_deg) const {
  const std::vector<double>& x = web_->polar().nodes();
  if (web_->interpolation() == Interpolation::cosine) {
    const auto [a, b] = ends(c);
    const double top = std::cos(x[c.interval] * degree), bottom = std::cos(x[c.interval + 1] * degree);
    return linear_share(a, b, (top - std::cos(polar_deg * degree)) / (top - bottom));
  }
  const auto integral = [&](double to) {
    if (!(to > x[c.interval])) return 0.0;
    const double below = web_->profile_integral(c.plane, c.interval, x[c.interval], to);
    return web_->azimuth().nodes().size() < 2 ? below : below + web_->profile_integral(c.plane + 1, c.interval, x[c.interval], to);
  };
  const double whole = integral(x[c.interval + 1]);
  return whole > 0 ? integral(polar_deg) / whole : 0;
}

// Linear in the angle: with M = a + s (b - a) / h over s = 0..h from theta0, the flux below is
//   G(s) = a (cos theta0 - cos theta) + (b - a) / h (sin theta - sin theta0 - s cos theta),   G' = M sin theta.
// Newton from the inverse of the density that is linear between its ends gains twice the digits a step.
WebSampler::Polar WebSampler::polar_for_share(const Cell& c, double share) const {
  const std::vector<double>& x = web_->polar().nodes();
  const double from = x[c.interval], width = x[c.interval + 1] - from;
  const std::array<double, 2> sides = ends(c);
  const double a = sides[0], b = sides[1];
  const double h = width * degree, sine0 = node_[c.interval].sine, cosine0 = node_[c.interval].cosine;
  if (web_->interpolation() == Interpolation::cosine) {
    const double cosine = cosine0 + linear_inverse(a, b, share) * (node_[c.interval + 1].cosine - cosine0);
    return {std::acos(std::clamp(cosine, -1.0, 1.0)) / degree, std::sqrt(std::max(0.0, 1 - cosine * cosine)), cosine};
  }
  if (web_->interpolation() == Interpolation::cubic) {
    double lo = from, hi = from + width;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (lo + hi);
      (share_below(c, middle) < share ? lo : hi) = middle;
    }
    return {lo, std::sin(lo * degree), std::cos(lo * degree)};
  }
  const double rise = (b - a) / h;
  const auto at = [&](double s) {
    const SineCosine d = sine_cosine(s);
    return SineCosine{sine0 * d.cosine + cosine0 * d.sine, cosine0 * d.cosine - sine0 * d.sine};
  };
  const auto below = [&](double s, const SineCosine& t) { return a * (cosine0 - t.cosine) + rise * (t.sine - sine0 - s * t.cosine); };
  const SineCosine end{node_[c.interval + 1].sine, node_[c.interval + 1].cosine};
  const double wanted = share * below(h, end);
  double s = h * linear_inverse(a * sine0, b * std::max(0.0, end.sine), share);
  SineCosine t = at(s);
  for (int k = 0; k < 8; ++k) {
    const double density = (a + rise * s) * t.sine;
    if (!(density > 0)) break;
    const double next = std::clamp(s - (below(s, t) - wanted) / density, 0.0, h), moved = std::abs(next - s);
    s = next;
    t = at(s);
    if (moved < 1e-6 * h) break;  // the next step would be its square
  }
  return {from + s / degree, t.sine, t.cosine};
}

WebSampler::Sample WebSampler::sample(const Vec2d& u) const {
  if (first_.empty()) return {};
  const std::size_t cells = first_.size();
  std::size_t cell = first_[std::min(static_cast<std::size_t>(u.x * static_cast<double>(cells)), cells - 1)];
  while (cell + 1 < cells && running_[cell + 1] <= u.x) ++cell;
  const Cell c{static_cast<std::uint32_t>(cell / intervals_), static_cast<std::uint32_t>(cell % intervals_)};
  const double share = std::clamp((u.x - running_[cell]) / (running_[cell + 1] - running_[cell]), 0.0, 1.0);
  const Polar polar = polar_for_share(c, share);

  const int copies = web_->copies();
  const int copy = std::min(static_cast<int>(u.y * copies), copies - 1);
  const double v = u.y * copies - copy;
  const std::vector<double>& phi = web_->azimuth().nodes();
  const double near = web_->profile(c.plane, c.interval, polar.angle_deg, polar.cosine);
  double azimuth = 360 * v, cd = near;
  if (phi.size() > 1) {
    const double far = web_->profile(c.plane + 1, c.interval, polar.angle_deg, polar.cosine), t = linear_inverse(near, far, v);
    azimuth = phi[c.plane] + t * (phi[c.plane + 1] - phi[c.plane]);
    cd = near + t * (far - near);
  }
  const WebAngles own = web_->unfolded(polar.angle_deg, azimuth, copy);
  if (web_->type() != WebType::c) return {direction_of(web_->type(), own, web_->frame()), cd / web_->flux_lm(), cd};
  const SineCosine turn = photometry::sine_cosine_deg(own.horizontal_deg + web_->frame().turn_deg);
  const double y = polar.sine * turn.sine;
  return {{polar.sine * turn.cosine, web_->frame().clockwise ? -y : y, -polar.cosine}, cd / web_->flux_lm(), cd};
}

Vec2d WebSampler::inverse(const Vec3d& direction) const {
  if (first_.empty()) return {};
  const IntensityWeb::Folded f = web_->folded(angles_of(web_->type(), direction, web_->frame()));
  if (!f.lit) return {};
  const std::vector<double>& phi = web_->azimuth().nodes();
  const Cell c{phi.size() < 2 ? 0 : web_->azimuth().interval(f.azimuth_deg), web_->polar().interval(f.polar_deg)};
  const std::size_t cell = c.plane * intervals_ + c.interval;
  const double x = running_[cell] + share_below(c, f.polar_deg) * (running_[cell + 1] - running_[cell]);
  if (phi.size() < 2) return {x, f.azimuth_deg / 360};
  const double cosine = std::cos(f.polar_deg * degree);
  const double near = web_->profile(c.plane, c.interval, f.polar_deg, cosine),
               far = web_->profile(c.plane + 1, c.interval, f.polar_deg, cosine);
  const double t = std::clamp((f.azimuth_deg - phi[c.plane]) / (phi[c.plane + 1] - phi[c.plane]), 0.0, 1.0);
  return {x, (f.copy + linear_share(near, far, t)) / web_->copies()};
}

}  // namespace etendue
