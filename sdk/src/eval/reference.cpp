// The definition of the answer: closed forms where there are any, else fans over the exact outline.
#include "disk_rule.h"
#include "environment.h"
#include "fan.h"
#include "illuminance.h"
#include "kernels.h"
#include "line.h"
#include "line_integral.h"
#include "lobe_slopes.h"
#include "modulation.h"
#include "punctual.h"
#include "round_light.h"

#include <algorithm>

namespace etendue::eval {
namespace {

// Turns of the outline about c, by chords of its arcs: not 0 if c is inside. Close to a curved arc the chords may err; the fan is signed,
// so that this costs work there and no correctness.
bool encloses(const Contour& contour, const Vec3d& c) {
  double angle = 0;
  for (const Arc& arc : contour) {
    const int pieces = arc.great_circle() && arc.end - arc.begin < 1.5 ? 1 : 8;
    Vec3d from = cross(c, arc.at(arc.begin));
    for (int i = 1; i <= pieces; ++i) {
      const Vec3d to = cross(c, arc.at(arc.begin + (arc.end - arc.begin) * i / pieces));
      angle += std::atan2(dot(c, cross(from, to)), dot(from, to));
      from = to;
    }
  }
  // Pieces on the far side of the sphere count too: a centre opposite to the light would be enclosed clockwise.
  return angle > pi;
}

// A polygon that runs clockwise although the point seemed to be on its emitting side: it is edge-on to within rounding, and not seen.
bool is_inverted(const Contour& contour) {
  const bool polygon = std::all_of(contour.begin(), contour.end(), [](const Arc& arc) { return arc.great_circle(); });
  return polygon && direction_integral(contour).z < 0;
}

void mark_adjacent(Fan& fan) {
  int found = 0;
  for (std::size_t i = 0; i < fan.contour.size() && found < 2; ++i) {
    const Arc& arc = fan.contour[i];
    if (arc.great_circle() && nearest_to(arc, fan.centre).distance < 1e-14) fan.adjacent[found++] = static_cast<int>(i);
  }
}

// Without a lobe any centre will do: a corner of a small polygon, because its two edges then drop out, else the mean direction.
void centre_anywhere(Fan& fan) {
  const bool few_edges = fan.contour.size() <= 4 && std::all_of(fan.contour.begin(), fan.contour.end(), [](const Arc& arc) {
                           return arc.great_circle() && arc.end - arc.begin < 1;
                         });
  if (few_edges) {
    fan.centre = fan.contour[0].at(fan.contour[0].begin);
    mark_adjacent(fan);
  } else {
    const Vec3d mean = direction_integral(fan.contour);
    fan.centre = length(mean) > 0 ? normalised(mean) : Vec3d{0, 0, 1};
  }
  fan.in_plane = basis_around(fan.centre).tangent;
}

// With a lobe the fan stands where the lobe is highest: at the mirror direction, or at the place of the outline whose half vector is
// nearest to the normal. Half vectors h = v + c have the slopes s = (h.x, h.y) / h.z, over which the lobe falls with hypot(alpha, |s|) as
// its scale; the singular values of ds / dc make that two widths of directions: at the mirror direction alpha in the plane of incidence
// and alpha n.v across it, as half angles.
void centre_at_lobe(Fan& fan, const Vec3d& view, double alpha) {
  const Vec3d mirror{-view.x, -view.y, view.z};
  fan.centre = mirror;
  if (!encloses(fan.contour, mirror)) {
    double least = std::numeric_limits<double>::max();
    for (const Arc& arc : fan.contour) {
      const double s = nearest_to_lobe(view, alpha, arc);
      const double away2 = squared(half_slopes(view, alpha, arc, s).q);
      if (away2 < least) least = away2, fan.centre = normalised(arc.at(s));
    }
    mark_adjacent(fan);
  }
  const Vec3d& c = fan.centre;
  const Vec3d h = view + c;
  const double z = std::max(h.z, 1e-9);
  const Vec2d slopes{h.x / z, h.y / z};
  const Basis basis = basis_around(c);
  const auto moved = [&](const Vec3d& t) { return Vec2d{(t.x - slopes.x * t.z) / z, (t.y - slopes.y * t.z) / z}; };
  const Vec2d a = moved(basis.tangent), b = moved(basis.bitangent);
  // Along the direction at this angle from the tangent slopes move the most.
  const double angle = 0.5 * std::atan2(2 * (a.x * b.x + a.y * b.y), squared(a) - squared(b)), cs = std::cos(angle), sn = std::sin(angle);
  const double most = std::sqrt(squared({a.x * cs + b.x * sn, a.y * cs + b.y * sn}));
  const double little = std::sqrt(squared({b.x * cs - a.x * sn, b.y * cs - a.y * sn}));
  const double scale = 0.5 * std::hypot(alpha, std::sqrt(squared(slopes)));
  fan.lobe = std::clamp(scale / little, 1e-9, 1.0);
  fan.lobe_across = std::clamp(scale / most, 1e-9, 1.0);
  fan.in_plane = basis.bitangent * cs - basis.tangent * sn;
  if (fan.lobe_across < 0.4 * fan.lobe) fan.ridge = fan.lobe_across / fan.lobe;
  if (const double layer = std::min(alpha, view.z); layer < 0.5) fan.layer = layer;
}

struct Scaled {
  double factor;  // largest channel of what multiplies the integral
  explicit Scaled(const Rgb& c) : factor(std::max({c.x, c.y, c.z})) {}
  Tolerance operator()(const Tolerance& t) const { return {t.relative, factor > 0 ? t.absolute / factor : 0}; }
};

Rgb magnitude(const Rgb& c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

struct Setting {
  const Emitter& emitter;
  const ShadingPoint& point;
  const Tolerance& tolerance;
  const LocalFrame& frame;
  const Horizons& horizons;
  Vec3d view;

  bool above(const Vec3d& l) const { return l.z > 0 && (!horizons.distinct || dot(l, horizons.surface) > 0); }
};

template <class Kernel>
Estimate one_direction(const Setting& s, const Kernel& kernel, const Vec3d& towards, const Rgb& illuminance) {
  const Vec3d l = s.frame.vector(towards);
  if (!s.above(l)) return {};
  const Rgb value = kernel(l) * illuminance;
  return {value, magnitude(value) * 1e-14, 1};
}

template <class Kernel>
Estimate over_line(const Setting& s, const Kernel& kernel, const LineEmitter& line) {
  auto view = line_view(s.frame.point(line.a), s.frame.point(line.b));
  if (!view) return {};
  clip(*view, {0, 0, 1});
  if (s.horizons.distinct) clip(*view, s.horizons.surface);
  if (!(view->end > view->begin)) return {};
  const Rgb factor = line.intensity * view->scale;
  const Vec3d mirror{-s.view.x, -s.view.y, s.view.z};
  const auto integrand = [&](double psi) {
    const Vec3d l = view->at(psi);
    if (!(l.z > 0)) return Rgb{};
    const double cosine = std::cos(psi);
    return kernel(l) * (cosine * window_at(s.emitter.window, view->height / cosine));
  };
  const Arc arc{{}, view->foot, view->axis, view->begin, view->end, true};
  const Nearest peak = nearest_to(arc, mirror);
  const double alpha = kernel.facts().alpha;
  const double width = alpha > 0 ? std::max(peak.distance, 2 * alpha * std::max(s.view.z, 1e-6)) : 1;
  Estimate estimate = integrate_peaked(integrand, view->begin, view->end, peak.s, width, Scaled(factor)(s.tolerance));
  estimate.value = estimate.value * factor;
  estimate.error = estimate.error * factor;
  return estimate;
}

// Luminance of the light wherever it is seen.
Rgb luminance_of(const Emitter& emitter) {
  const auto* sun = std::get_if<DistantEmitter>(&emitter.shape);
  if (sun == nullptr) return emitter.radiance;
  const double sine = std::sin(sun->radius_rad);
  return sun->illuminance / (pi * sine * sine);
}

bool reached(const Estimate& e, const Tolerance& tolerance) {
  for (int c = 0; c < 3; ++c) {
    if (!(e.error[c] <= std::max(tolerance.relative * e.value[c], tolerance.absolute))) return false;
  }
  return true;
}

// One rule over a round light as a whole, where it is small enough; what it reaches is for the caller to judge. No evaluations: not tried.
template <class Kernel>
Estimate over_small_disk(const Setting& s, const Kernel& kernel, double alpha, const Tolerance& tolerance) {
  constexpr double largest7 = 0.5, largest17 = 0.7, tightest = 1e-7;
  Estimate estimate;
  if (tolerance.relative < tightest) return estimate;
  const auto light = clear_round_light(s.emitter, s.frame, s.horizons);
  if (!light) return estimate;
  const auto integrand = [&](double x, double y) {
    const RoundLight::Place place = light->at(x, y);
    return kernel(place.direction) * place.density;
  };
  // In a few of a thousand places all that a rule looks at vanishes by accident: the error is not believed to be below what the size says.
  const double size = relative_size(*light, s.view, alpha), size2 = size * size, size6 = size2 * size2 * size2;
  const auto take = [&](const DiskValue& v, double least_error, std::uint64_t nodes) {
    estimate.value = v.mean * pi;
    for (int c = 0; c < 3; ++c) estimate.error[c] = pi * std::max(v.error[c], v.mean[c] * (least_error + 1e-13));
    estimate.evaluations += nodes;
  };
  if (size <= largest7) take(disk_rule7(integrand), 0.01 * size6, 7);
  if (size <= largest17 && (estimate.evaluations == 0 || !reached(estimate, tolerance)))
    take(disk_rule17(integrand), 0.01 * size6 * size2, 17);
  return estimate;
}

template <class Kernel>
Estimate over_outlines(const Setting& s, const Kernel& kernel) {
  const LobeFacts facts = kernel.facts();
  const Rgb radiance = luminance_of(s.emitter);
  const Tolerance tolerance = Scaled(radiance)(s.tolerance);
  const bool modulated = is_modulated(s.emitter);
  const Estimate tried = modulated || facts.folded || !facts.round_ggx ? Estimate{} : over_small_disk(s, kernel, facts.alpha, tolerance);
  if (tried.evaluations > 0 && reached(tried, tolerance)) return {tried.value * radiance, tried.error * radiance, tried.evaluations};
  std::vector<Fan> fans;
  each_outline(s.emitter, s.frame, [&](const Contour& outline, std::size_t index) {
    if (outline.empty()) return;
    Contour lit = clipped(outline, s.horizons);
    if (lit.empty() || is_inverted(lit)) return;
    each_smooth_part(std::move(lit), s.view, facts.folded, [&](Contour part) {
      Fan fan;
      fan.contour = std::move(part);
      fan.index = index;
      if (facts.alpha > 0) {
        centre_at_lobe(fan, s.view, facts.alpha);
      } else {
        centre_anywhere(fan);
      }
      fans.push_back(std::move(fan));
    });
  });
  if (fans.empty()) return {};
  Estimate estimate;
  if (modulated) {
    const auto integrand = [&](const Vec3d& l, std::size_t index) {
      if (!(l.z > 0)) return Rgb{};
      return kernel(l) * modulation_along(s.emitter, index, s.point.position, s.frame.to_world(l));
    };
    estimate = FanIntegrator(integrand, tolerance, facts.folded).integrate(fans);
  } else {
    const auto integrand = [&](const Vec3d& l, std::size_t) { return l.z > 0 ? kernel(l) : Rgb{}; };
    estimate = FanIntegrator(integrand, tolerance, facts.folded).integrate(fans);
  }
  estimate.evaluations += tried.evaluations;
  // Below 0 there is no light: where a light is seen edge-on to within rounding, its outline's sense is noise.
  for (int c = 0; c < 3; ++c) {
    if (estimate.value[c] >= 0) continue;
    estimate.error[c] -= estimate.value[c];
    estimate.value[c] = 0;
  }
  estimate.value = estimate.value * radiance;
  estimate.error = estimate.error * radiance;
  return estimate;
}

template <class Kernel>
Estimate evaluate(const Setting& s, const Kernel& kernel) {
  if (const auto* punctual = std::get_if<PunctualEmitter>(&s.emitter.shape)) {
    const auto incident = incident_from(*punctual, s.emitter.window, s.point.position);
    return incident ? one_direction(s, kernel, incident->towards, incident->illuminance) : Estimate{};
  }
  if (const auto* distant = std::get_if<DistantEmitter>(&s.emitter.shape); distant != nullptr && !(distant->radius_rad > 0)) {
    return one_direction(s, kernel, distant->towards, distant->illuminance);
  }
  if (const auto* line = std::get_if<LineEmitter>(&s.emitter.shape)) return over_line(s, kernel, *line);
  if (const auto* environment = std::get_if<EnvironmentEmitter>(&s.emitter.shape); environment != nullptr && environment->map) {
    return environment_reference(s.emitter, *environment, s.point, s.tolerance);
  }
  return over_outlines(s, kernel);
}

}  // namespace

Estimate reference(const Emitter& emitter, const ShadingPoint& point, const Tolerance& tolerance) {
  const LocalFrame frame(point);
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return {};
  if (const auto* lambert = std::get_if<Lambert>(&point.brdf)) {
    if (const auto lux = closed_illuminance(emitter, point.position, frame, horizons)) {
      const Rgb value = lambert->base_colour * *lux / pi;
      return {value, magnitude(value) * 1e-12, 0};
    }
  }
  const Setting setting{emitter, point, tolerance, frame, horizons, view};
  return with_kernel(point.brdf, view, [&](const auto& kernel) { return evaluate(setting, kernel); });
}

}  // namespace etendue::eval
