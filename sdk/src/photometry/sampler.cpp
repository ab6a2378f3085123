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
using photometry::SineVersine;

SineVersine sine_versine(double x) { return x < 0.785 ? photometry::sine_versine_small(x) : SineVersine{std::sin(x), 1 - std::cos(x)}; }

// Of theta = from + s, from sine and cosine of `from`.
SineCosine turned(double sine, double cosine, const SineVersine& s) {
  return {sine - sine * s.versine + cosine * s.sine, cosine - cosine * s.versine - sine * s.sine};
}

// Integrals over 0..s of sin(theta) and of s' sin(theta), theta = from + s':
//   sin(from) sin(s) + cos(from) (1 - cos s)
//   sin(from) (s sin s - (1 - cos s)) + cos(from) (sin s - s cos s)
struct Moments {
  double integral, first;
};
Moments moments(double sine, double cosine, double s, const SineVersine& t) {
  return {sine * t.sine + cosine * t.versine, sine * (s * t.sine - t.versine) + cosine * (t.sine - s + s * t.versine)};
}

}  // namespace

WebSampler::WebSampler(const IntensityWeb& web)
    : web_(&web),
      linear_(web.interpolation() == Interpolation::linear),
      copies_(web.copies()),
      intervals_(static_cast<std::uint32_t>(web.polar().nodes().size() - 1)) {
  const std::vector<double>&x = web.polar().nodes(), &phi = web.azimuth().nodes();
  planes_ = std::max<std::uint32_t>(static_cast<std::uint32_t>(phi.size()) - 1, 1);
  for (std::size_t i = 0; i < intervals_; ++i) {
    const SineCosine from = photometry::sine_cosine_deg(x[i]), to = photometry::sine_cosine_deg(x[i + 1]);
    const double width = (x[i + 1] - x[i]) * degree;
    const Moments whole = moments(from.sine, from.cosine, width, sine_versine(width));
    interval_.push_back({x[i], width, 1 / width, from.sine, from.cosine, std::max(0.0, to.sine), to.cosine, whole.integral, whole.first});
  }
  const bool one_plane = phi.size() < 2;
  running_.reserve(std::size_t{intervals_} * planes_ + 1);
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
  inverse_flux_ = 1 / web.flux_lm();
  const double turn = web.type() == WebType::c ? std::fmod(web.frame().turn_deg, 360) : 0;
  for (int copy = 0; copy < copies_; ++copy) {
    // A copy mirrors both angles or neither: two places say how.
    const auto image = [&](double polar, double azimuth) {
      const WebAngles own = web.unfolded(polar, azimuth, copy);
      return web.type() == WebType::b   ? std::pair(own.horizontal_deg + 90, own.vertical_deg)
             : web.type() == WebType::a ? std::pair(own.vertical_deg + 90, own.horizontal_deg)
                                        : std::pair(own.vertical_deg, own.horizontal_deg);
    };
    const auto [polar, shift] = image(0, 0);
    copy_[static_cast<std::size_t>(copy)] = {shift + turn, image(0, 90).second > shift ? 1.0 : -1.0, polar > 90 ? -1.0 : 1.0};
  }
  for (double& r : running_) r /= sum;
  // Two parts a cell: few hold more than one border.
  const std::size_t parts = 2 * (running_.size() - 1);
  first_.resize(parts);
  std::uint32_t cell = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    while (running_[cell + 1] <= static_cast<double>(part) / static_cast<double>(parts)) ++cell;
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

// Linear in the angle: M = a + r s with r = (b - a) / h over s = 0..h. The flux below s is G = a (integral of sin) + r (integral of s sin),
// whose derivatives are D = M sin, D' = r sin + M cos, D'' = 2 r cos - M sin. With F = G - wanted, Householder's third method
//   s -= F (D^2 - F D' / 2) / (D^3 - F D D' + F^2 D'' / 6)
// makes of an error x one of order x^4 (Householder 1970, The Numerical Treatment of a Single Nonlinear Equation, 4.4). The density that is
// linear between its ends starts it within about h^2 / 100 of the interval, so that one step is the rule.
namespace {

struct Step {
  double by, sine, cosine;  // of the angle from where it leads away
  double beyond;            // F there
  bool defined;
};
template <class Interval>
Step step_from(const Interval& w, double a, double r, double wanted, double s) {
  const SineVersine d = sine_versine(s);
  const SineCosine t = turned(w.sine, w.cosine, d);
  const Moments m = moments(w.sine, w.cosine, s, d);
  const double value = a + r * s, density = value * t.sine, slope = r * t.sine + value * t.cosine, bend = 2 * r * t.cosine - density;
  const double f = a * m.integral + r * m.first - wanted, square = density * density;
  const double below = density * (square - f * slope) + f * f * (bend * (1.0 / 6));
  return {-f * (square - 0.5 * f * slope) / (below != 0 ? below : 1), t.sine, t.cosine, f, density > 0 && below > 0};
}

// Sine and cosine turned by a last step, of whose series two terms are enough.
SineCosine turned_by(const Step& step) {
  const double x = step.by, square = x * x;
  return turned(step.sine, step.cosine, {x * (1 - square * (1.0 / 6)), 0.5 * square * (1 - square * (1.0 / 12))});
}

}  // namespace

WebSampler::Polar WebSampler::polar_for_share(const Interval& w, const Part& part) {
  const double h = w.width_rad, r = (part.b - part.a) * w.inverse_width;
  const double wanted = part.share * (part.a * w.integral + r * w.first_moment);
  double s = h * linear_inverse(part.a * w.sine, part.b * w.end_sine, part.share);
  for (int k = 0; k < 2; ++k) {
    const Step step = step_from(w, part.a, r, wanted, s);
    s += step.by;
    const double to_end = std::min(s, h - s);
    if (!(step.defined && to_end > 0)) break;
    if (!(std::abs(step.by) <= last_step * to_end)) continue;
    const SineCosine t = turned_by(step);
    return {w.from_deg + s * (1 / degree), t.sine, t.cosine};
  }
  return bracketed(w, part);
}

// The same, wherever the start is: at a pole the density is 0, and steps may lead anywhere. What leaves the bracket is bisected.
WebSampler::Polar WebSampler::bracketed(const Interval& w, const Part& part) {
  const double h = w.width_rad, r = (part.b - part.a) * w.inverse_width;
  const double wanted = part.share * (part.a * w.integral + r * w.first_moment);
  double s = h * linear_inverse(part.a * w.sine, part.b * w.end_sine, part.share), low = 0, high = h;
  for (int k = 0; k < 100 && high - low > 1e-16 * h; ++k) {
    const Step step = step_from(w, part.a, r, wanted, s);
    (step.beyond > 0 ? high : low) = s;
    const double next = s + step.by;
    if (!(step.defined && next >= low && next <= high)) {
      s = 0.5 * (low + high);
      continue;
    }
    s = next;
    if (std::abs(step.by) > std::max(last_step * std::min(s, h - s), 1e-15 * h)) continue;
    const SineCosine t = turned_by(step);
    return {w.from_deg + s / degree, t.sine, t.cosine};
  }
  const SineCosine t = turned(w.sine, w.cosine, sine_versine(s));
  return {w.from_deg + s / degree, t.sine, t.cosine};
}

WebSampler::Polar WebSampler::polar_for_share(const Cell& c, double share) const {
  const Interval& w = interval_[c.interval];
  const std::array<double, 2> sides = ends(c);
  if (web_->interpolation() == Interpolation::cosine) {
    const double cosine = w.cosine + linear_inverse(sides[0], sides[1], share) * (w.end_cosine - w.cosine);
    return {std::acos(std::clamp(cosine, -1.0, 1.0)) / degree, std::sqrt(std::max(0.0, 1 - cosine * cosine)), cosine};
  }
  // Newton on the share below, and bisection where that leaves the bracket.
  const double from = w.from_deg, to = web_->polar().nodes()[c.interval + 1];
  const std::size_t next_plane = web_->azimuth().nodes().size() < 2 ? c.plane : c.plane + 1;
  const auto integral = [&](double end) {
    return web_->profile_integral(c.plane, c.interval, from, end) + web_->profile_integral(next_plane, c.interval, from, end);
  };
  const double whole = integral(to), wanted = share * whole;
  double lo = from, hi = to, angle = from + (to - from) * linear_inverse(sides[0] * w.sine, sides[1] * w.end_sine, share);
  for (int k = 0; k < 60 && hi - lo > 1e-14 * to; ++k) {
    const double beyond = (angle > from ? integral(angle) : 0) - wanted, sine = std::sin(angle * degree), cosine = std::cos(angle * degree);
    (beyond > 0 ? hi : lo) = angle;
    const double density =
        (web_->profile(c.plane, c.interval, angle, cosine) + web_->profile(next_plane, c.interval, angle, cosine)) * sine;
    const double next = density > 0 ? angle - beyond / (density * degree) : lo;
    const double moved = next - angle;
    angle = next > lo && next < hi ? next : 0.5 * (lo + hi);
    if (next > lo && next < hi && std::abs(moved) < 1e-13 * to) break;
  }
  return {angle, std::sin(angle * degree), std::cos(angle * degree)};
}

namespace {

constexpr double below_one = 1 - 0x1p-53;  // the last border, 1, is never passed

}  // namespace

std::uint32_t WebSampler::part_of(double u) const {
  const std::size_t parts = first_.size();
  return static_cast<std::uint32_t>(std::min(static_cast<std::size_t>(std::min(u, below_one) * static_cast<double>(parts)), parts - 1));
}

WebSampler::Found WebSampler::found_from(std::uint32_t cell, double u) const {
  const double x = std::min(u, below_one);
  // Whether the first border is passed is as good as random: no branch for that step.
  cell += running_[cell + 1] <= x ? 1 : 0;
  while (running_[cell + 1] <= x) ++cell;
  return {{cell / intervals_, cell % intervals_}, x - running_[cell], running_[cell + 1] - running_[cell]};
}

WebSampler::Sample WebSampler::sample(const Vec2d& u) const {
  if (first_.empty()) return {};
  const Found found = found_from(first_[part_of(u.x)], u.x);
  const Cell& c = found.cell;
  const double share = std::clamp(found.beyond / found.of, 0.0, 1.0);
  const Interval& w = interval_[c.interval];
  const std::vector<double>& phi = web_->azimuth().nodes();
  const bool one_plane = phi.size() < 2;
  const std::uint32_t next = one_plane ? c.plane : c.plane + 1;

  Polar polar{};
  double near = 0, far = 0;
  if (linear_) {
    const double a0 = web_->node(c.plane, c.interval), a1 = web_->node(c.plane, c.interval + 1);
    const double b0 = web_->node(next, c.interval), b1 = web_->node(next, c.interval + 1);
    polar = polar_for_share(w, Part{0.5 * (a0 + b0), 0.5 * (a1 + b1), share});
    const double along = std::clamp((polar.angle_deg - w.from_deg) * (degree * w.inverse_width), 0.0, 1.0);
    near = a0 + along * (a1 - a0);
    far = b0 + along * (b1 - b0);
  } else {
    polar = polar_for_share(c, share);
    near = web_->profile(c.plane, c.interval, polar.angle_deg, polar.cosine);
    far = web_->profile(next, c.interval, polar.angle_deg, polar.cosine);
  }

  const int copy = std::min(static_cast<int>(u.y * copies_), copies_ - 1);
  const double v = u.y * copies_ - copy, t = one_plane ? 0 : linear_inverse(near, far, v);
  const double azimuth = one_plane ? 360 * v : phi[c.plane] + t * (phi[next] - phi[c.plane]), cd = near + t * (far - near);
  const WebAngles own =
      copies_ == 1 && web_->type() == WebType::c ? WebAngles{polar.angle_deg, azimuth} : web_->unfolded(polar.angle_deg, azimuth, copy);
  if (web_->type() != WebType::c) return {direction_of(web_->type(), own, web_->frame()), cd * inverse_flux_, cd};
  const SineCosine turn = photometry::sine_cosine_deg(own.horizontal_deg + web_->frame().turn_deg);
  const double y = polar.sine * turn.sine;
  return {{polar.sine * turn.cosine, web_->frame().clockwise ? -y : y, -polar.cosine}, cd * inverse_flux_, cd};
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
