#include "illuminance.h"

#include "line.h"
#include "punctual.h"
#include "window_part.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

Contour clipped(const Contour& outline, const Horizons& horizons) {
  Contour above = clipped(outline, Vec3d{0, 0, 1});
  return horizons.distinct ? clipped(above, horizons.surface) : above;
}

namespace {

double cosine_above(const Vec3d& direction, const Horizons& horizons) {
  return horizons.distinct && !(dot(direction, horizons.surface) > 0) ? 0 : std::max(direction.z, 0.0);
}

// x - atan(x), x >= 0, by its series where the difference would cancel.
double beyond_arc_tangent(double x) {
  if (x > 0.4) return x - std::atan(x);
  double sum = 0, power = x * x * x;
  for (int k = 3; std::abs(power) > 1e-17 * sum; k += 2) {
    sum += power / k;
    power *= -x * x;
  }
  return sum;
}

// A cap of half angle sigma: pi sin^2(sigma) cos(theta) wholly above the horizon, else with the circle's part above and the horizon's below
// the cap as sphere_batch.cpp derives it.
double cap_form(const Vec3d& axis, double sine, double cosine, const Horizons& horizons) {
  if (axis.z <= -sine) return 0;
  if (axis.z >= sine && (!horizons.distinct || dot(axis, horizons.surface) >= sine)) return pi * sine * sine * axis.z;
  if (horizons.distinct) return std::max(direction_integral(clipped(Contour{cap_circle(axis, cosine, sine)}, horizons)).z, 0.0);
  const double u = axis.z, q = std::sqrt((sine - u) * (sine + u)), phi = std::atan2(q, -cosine * u);
  if (q > 0.4 * cosine) return std::max(phi * sine * sine * u - cosine * q + std::atan2(q, cosine), 0.0);
  const double k = q / cosine;
  return std::max(sine * sine * (phi * u + k) - beyond_arc_tangent(k), 0.0);
}

// A tube with round caps, wholly above the horizon: both lines along which planes through the point touch its side and both circles along
// which cones do, summed so that nothing cancels however far it is. Symbols and derivation: tube_batch.cpp.
double whole_capsule(const Vec3d& a, const Vec3d& axis, double length_m, double radius) {
  const double a_x = dot(a, axis), b_x = a_x + length_m;
  const Vec3d off = a - axis * a_x;
  const double across2 = dot(off, off), touching2 = std::max(across2 - radius * radius, 0.0), touching = std::sqrt(touching2);
  const auto cap = [&](double x, double outwards) {
    const double distance2 = across2 + x * x, distance = std::sqrt(distance2);
    return radius * radius * (off.z + axis.z * x) / (distance2 * distance) * std::atan2(touching * distance, radius * outwards);
  };
  double sides = 0;
  if (touching > 0) {
    const double bracket = across2 * axis.z * (a_x + b_x) + off.z * (across2 - a_x * b_x);
    sides = off.z * std::atan2(touching * length_m, touching2 + a_x * b_x) +
            touching * length_m * bracket / ((across2 + a_x * a_x) * (across2 + b_x * b_x));
    sides *= radius / across2;
  }
  return sides + cap(a_x, -a_x) + cap(b_x, b_x);
}

// A disk over the horizon, its centre and its normal towards the point's side relative to the point: symbols and derivation in
// disk_batch.cpp.
double disk_form(const Vec3d& centre, const Vec3d& facing, double radius) {
  const double height = -dot(centre, facing), up = centre.z, n_a = -facing.z, n_g2 = facing.x * facing.x + facing.y * facing.y;
  const double r2 = radius * radius, d2 = dot(centre, centre);
  const bool cut = up * up < r2 * n_g2;
  if (!(height > 0) || (!cut && up <= 0)) return 0;
  const double k = d2 - r2, m = d2 + r2, four_r2h = 4 * r2 * height, w = std::sqrt(k * k + four_r2h * height);
  const double w_less_k = k > 0 ? four_r2h * height / (w + k) : w - k, n_c = up - n_a * height;
  const double whole = (n_a * w_less_k + four_r2h * n_c / (m + w)) / w;
  if (!cut) return std::max(0.5 * pi * whole, 0.0);
  const double n_g = std::sqrt(n_g2), from = height / n_g, from2 = from * from;
  const Vec3d rest = Vec3d{0, 0, 1} + facing * n_a;
  const double c_g = dot(rest, centre) / n_g, c_t = std::abs(centre.x * facing.y - centre.y * facing.x) / n_g;
  const double s0 = -up / n_g, a2 = std::max((radius - s0) * (radius + s0), 0.0), a = std::sqrt(a2), c2 = c_g * c_g + c_t * c_t;
  const double v = from2 + c_t * c_t + a2 + w, x = (0.5 * v - a * c_g) * (0.5 * v + a * c_g) + c_t * c_t * (s0 - a) * (s0 + a);
  const double e = -2 * std::atan2(a * (c_g * v + 2 * c_t * c_t * s0), x), nearer = (c_t - a) * (c_t - a) + from2;
  const double turned = 2 * std::atan2(a, s0) + e, chord = std::atan2(2 * a * from, (c_t - a) * (c_t + a) + from2);
  const double across = c2 < 1e-30 * r2 ? -8 * a / (m + w) : (c_g * e - c_t * std::log1p(4 * a * c_t / nearer)) / c2;
  return std::max(0.25 * (whole * turned - n_a * e + height * n_g * across) + 0.5 * chord, 0.0);
}

struct ClosedForm {
  const Emitter& emitter;
  const Vec3d& position;
  const LocalFrame& frame;
  const Horizons& horizons;

  Rgb operator()(const PunctualEmitter& e) const {
    const auto incident = incident_from(e, emitter.window, position);
    return incident ? incident->illuminance * cosine_above(frame.vector(incident->towards), horizons) : Rgb{};
  }
  // A disk in the sky with the illuminance E on a plane facing it has the luminance E / (pi sin^2 rho).
  Rgb operator()(const DistantEmitter& e) const {
    const Vec3d towards = frame.vector(e.towards);
    if (!(e.radius_rad > 0)) return e.illuminance * cosine_above(towards, horizons);
    const double sine = std::sin(e.radius_rad);
    return e.illuminance * (cap_form(towards, sine, std::cos(e.radius_rad), horizons) / (pi * sine * sine));
  }
  Rgb operator()(const SphereEmitter& e) const {
    const Vec3d centre = frame.point(e.centre);
    const double d = length(centre);
    if (!(d > e.radius)) return outlines();
    const double cosine = std::sqrt((d - e.radius) * (d + e.radius)) / d;
    return emitter.radiance * cap_form(centre / d, e.radius / d, cosine, horizons);
  }
  Rgb operator()(const DiskEmitter& e) const {
    if (horizons.distinct || !(e.radius > 0)) return outlines();
    const Vec3d centre = frame.point(e.centre), normal = frame.vector(e.normal);
    return emitter.radiance * disk_form(centre, emitter.two_sided && dot(centre, normal) > 0 ? -normal : normal, e.radius);
  }
  Rgb operator()(const PolygonEmitter& e) const {
    if (e.vertices.size() < 3) return {};
    const double height = -dot(frame.point(e.vertices[0]), frame.vector(e.normal));
    if (!(height > 0 || (emitter.two_sided && height < 0))) return {};
    std::array<Vec3d, 8> few;
    std::vector<Vec3d> many;
    std::span<Vec3d> vertices(few.data(), std::min(e.vertices.size(), few.size()));
    if (e.vertices.size() > few.size()) {
      many.resize(e.vertices.size());
      vertices = many;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = frame.point(e.vertices[i]);
    // Counter-clockwise about the normal is clockwise as seen from its side. Where rounding cannot tell the side, nothing is seen.
    return emitter.radiance * std::max((height > 0 ? -1 : 1) * projected_solid_angle(vertices, horizons), 0.0);
  }
  Rgb operator()(const TubeEmitter& e) const {
    const Vec3d a = frame.point(e.a), b = frame.point(e.b), span = b - a;
    const double l = length(span);
    const bool whole = e.caps == Caps::round && !horizons.distinct && std::min(a.z, b.z) >= e.radius && l > 0 && e.radius > 0;
    if (!whole || inside_tube(a, b, e.radius, e.caps)) return outlines();
    return emitter.radiance * std::max(whole_capsule(a, span / l, l, e.radius), 0.0);
  }
  Rgb operator()(const MeshEmitter& e) const {
    double sum = 0;
    for (const auto& triangle : e.triangles) {
      const std::array<Vec3d, 3> t{frame.point(triangle[0]), frame.point(triangle[1]), frame.point(triangle[2])};
      const bool front = dot(cross(t[1] - t[0], t[2] - t[0]), t[0]) < 0;
      if (front || emitter.two_sided) sum += std::max((front ? -1 : 1) * projected_solid_angle(t, horizons), 0.0);
    }
    return emitter.radiance * sum;
  }
  Rgb operator()(const LineEmitter& e) const {
    auto view = line_view(frame.point(e.a), frame.point(e.b));
    if (!view) return {};
    clip(*view, {0, 0, 1});
    if (horizons.distinct) clip(*view, horizons.surface);
    return e.intensity * std::max(direction_integral(*view).z, 0.0);
  }
  template <class Other>
  Rgb operator()(const Other&) const {
    return outlines();
  }
  Rgb outlines() const {
    double sum = 0;
    each_outline(emitter, frame, [&](const Contour& outline, std::size_t) { sum += direction_integral(clipped(outline, horizons)).z; });
    return emitter.radiance * std::max(sum, 0.0);
  }
};

// At distances that a window could tell.
bool has_extent(const Emitter& emitter) {
  return !std::holds_alternative<PunctualEmitter>(emitter.shape) && !std::holds_alternative<DistantEmitter>(emitter.shape) &&
         !std::holds_alternative<EnvironmentEmitter>(emitter.shape);
}

}  // namespace

bool has_closed_form(const Emitter& emitter) {
  if (emitter.pattern) return false;
  const auto* environment = std::get_if<EnvironmentEmitter>(&emitter.shape);
  return environment == nullptr || !environment->map;
}

std::optional<Rgb> closed_illuminance(const Emitter& emitter, const Vec3d& position, const LocalFrame& frame, const Horizons& horizons) {
  if (!has_closed_form(emitter)) return std::nullopt;
  const Rgb whole = std::visit(ClosedForm{emitter, position, frame, horizons}, emitter.shape);
  if (!is_window(emitter.window) || !has_extent(emitter) || whole == Rgb{}) return whole;
  const std::optional<WindowPart> part = window_part(emitter, frame, horizons);
  if (!part) return std::nullopt;
  if (part->nothing_left) return Rgb{};
  const auto* line = std::get_if<LineEmitter>(&emitter.shape);
  const Rgb& colour = line != nullptr ? line->intensity : emitter.radiance;  // channels out of gamut are negative
  int channel = 0;
  for (const int c : {1, 2})
    if (std::abs(colour[c]) > std::abs(colour[channel])) channel = c;
  const double open = whole[channel] / colour[channel], rest = part->of_left ? part->value : open - part->value;
  // Rounding makes it no more than the window's largest value does.
  return colour * std::clamp(rest, 0.0, open * std::max(window_at(emitter.window, 0), 1.0));
}

Rgb illuminance(const Emitter& emitter, const Vec3d& position, const Vec3d& normal) {
  const LocalFrame frame(position, normal);
  if (const auto closed = closed_illuminance(emitter, position, frame, {})) return *closed;
  // A white Lambert surface reflects the luminance E / pi.
  const ShadingPoint point{position, normal, normal, normal, Lambert{{1, 1, 1}}};
  return reference(emitter, point, {1e-7, 0}).value * pi;
}

}  // namespace etendue::eval
