// The answer by sampling the light, as Lagarde and de Rousiers' reference mode does (2014, appendix A): slow, and independent of outlines.
#include "environment.h"
#include "frostbite_reference.h"
#include "kernels.h"
#include "local.h"
#include "modulation.h"
#include "shifted_points.h"
#include "tube_sampling.h"

#include <algorithm>
#include <bit>

namespace etendue::eval {
namespace {

constexpr std::size_t shifts = 32;

// The surface that listing A.3 samples, and whether its back shines too: that of an open surface which is two-sided, or from inside of a
// closed one. Seen from outside, the back of a closed surface is hidden by its front.
struct Sampled {
  Surface surface;
  bool from_behind = false;
};
struct SurfaceOf {
  const Emitter& emitter;
  const Vec3d& position;

  Sampled operator()(const SphereEmitter& e) const {
    const Vec3d centre = e.centre - position;
    return {Surface({SpherePart{e.centre, e.radius}}), emitter.two_sided && dot(centre, centre) <= e.radius * e.radius};
  }
  Sampled operator()(const DiskEmitter& e) const { return {Surface({DiskPart{e.centre, e.normal, e.radius}}), emitter.two_sided}; }
  Sampled operator()(const PolygonEmitter& e) const {
    const auto& v = e.vertices;
    if (v.size() == 4 && length(v[0] - v[1] + v[2] - v[3]) <= 1e-14 * (length(v[1] - v[0]) + length(v[3] - v[0])))
      return {Surface({ParallelogramPart{v[0], v[1] - v[0], v[3] - v[0], e.normal}}), emitter.two_sided};
    std::vector<SurfacePart> parts;
    for (const auto& t : e.triangles) parts.push_back(TrianglePart{v[t[0]], v[t[1]], v[t[2]]});
    return {Surface(std::move(parts)), emitter.two_sided};
  }
  Sampled operator()(const TubeEmitter& e) const {
    std::vector<SurfacePart> parts{CylinderPart{e.a, e.b, e.radius}};
    if (e.caps == Caps::round) parts.push_back(CapsPart{e.a, e.b, e.radius});
    if (e.caps == Caps::flat) {
      const Vec3d axis = normalised(e.b - e.a);
      parts.push_back(DiskPart{e.a, -axis, e.radius});
      parts.push_back(DiskPart{e.b, axis, e.radius});
    }
    return {Surface(std::move(parts)), emitter.two_sided && inside_tube(e.a - position, e.b - position, e.radius, e.caps)};
  }
  Sampled operator()(const MeshEmitter& e) const {
    std::vector<SurfacePart> parts;
    for (const auto& t : e.triangles) parts.push_back(TrianglePart{t[0], t[1], t[2]});
    return {Surface(std::move(parts)), emitter.two_sided};
  }
  // Sampled by other means, or not at all.
  Sampled operator()(const PunctualEmitter&) const { return {Surface({})}; }
  Sampled operator()(const DistantEmitter&) const { return {Surface({})}; }
  Sampled operator()(const LineEmitter&) const { return {Surface({})}; }
  Sampled operator()(const EnvironmentEmitter&) const { return {Surface({})}; }
};

template <class Kernel>
class Sampler {
 public:
  Sampler(const Emitter& emitter, const ShadingPoint& point, const LocalFrame& frame, const Horizons& horizons, const Kernel& kernel)
      : emitter_(emitter),
        point_(point),
        frame_(frame),
        horizons_(horizons),
        kernel_(kernel),
        view_(frame.vector(point.view)),
        sampled_(std::visit(SurfaceOf{emitter, point.position}, emitter.shape)) {}

  // What one sample says of the whole: its mean over u is the answer.
  Rgb operator()(const Vec2d& u) const {
    if (const auto* sun = std::get_if<DistantEmitter>(&emitter_.shape)) return of_sun(*sun, u);
    if (const auto* line = std::get_if<LineEmitter>(&emitter_.shape)) return of_line(*line, u);
    if (const auto* sky = std::get_if<EnvironmentEmitter>(&emitter_.shape)) return of_sky(*sky, u);
    return sampled_.surface.area() > 0 ? of_surface(sampled_.surface.at(u)) : Rgb{};
  }

  // The same of a sample at the mirror direction, which a narrow lobe may hide from all others.
  Rgb at_mirror() const {
    if (!(kernel_.facts().alpha > 0)) return {};
    const Vec3d mirror{-view_.x, -view_.y, view_.z};
    const LightSample met = light_along(emitter_, point_.position, frame_.to_world(mirror));
    if (!(met.pdf > 0)) return {};
    if (std::holds_alternative<DistantEmitter>(emitter_.shape)) return reflected(mirror) * met.radiance / met.pdf;
    return reflected(mirror) * met.radiance * (sampled_.surface.area() / (met.distance * met.distance));
  }

 private:
  // BRDF times cosine, 1/sr, of a direction of the frame.
  Rgb reflected(const Vec3d& l) const { return l.z > 0 && (!horizons_.distinct || dot(l, horizons_.surface) > 0) ? kernel_(l) : Rgb{}; }

  // Listing A.3: L f cos(theta_s) cos(theta) / (d^2 pdf).
  Rgb of_surface(const Surface::Sample& sample) const {
    const Vec3d to = sample.point.position - point_.position;
    const double d2 = dot(to, to), d = std::sqrt(d2);
    if (!(d > 0)) return {};
    double facing = -dot(sample.point.normal, to) / d;
    if (facing < 0 && sampled_.from_behind) facing = -facing;
    if (!(facing > 0)) return {};
    const Rgb there = pattern_at(emitter_, sample.part, sample.point.position) * window_at(emitter_.window, d);
    return reflected(frame_.vector(to / d)) * emitter_.radiance * there * (facing * sampled_.surface.area() / d2);
  }
  // Uniform along the line: an element dx of the length l gives I sin(theta) / (l d^2) dx (line.h).
  Rgb of_line(const LineEmitter& line, const Vec2d& u) const {
    const Vec3d span = line.b - line.a, to = line.a + span * u.x - point_.position;
    const double d2 = dot(to, to), d = std::sqrt(d2), l = length(span);
    if (!(d > 0 && l > 0)) return {};
    const double sine = length(cross(span, to)) / (l * d);
    return reflected(frame_.vector(to / d)) * line.intensity * (sine * window_at(emitter_.window, d) / d2);
  }
  // Uniform over the cone: the sun has no surface to draw from.
  Rgb of_sun(const DistantEmitter& sun, const Vec2d& u) const {
    const double sine = std::sin(sun.radius_rad);
    const Cone cone{sun.towards, sine, std::cos(sun.radius_rad)};
    return reflected(frame_.vector(sample(cone, u))) * sun.illuminance * (solid_angle_of(cone) / (pi * sine * sine));
  }
  // Listings A.1 and A.2 draw from the lobe; ours by visible normals and the cosine together.
  Rgb of_sky(const EnvironmentEmitter& sky, const Vec2d& u) const {
    const DirectionSample drawn = sample_brdf(point_.brdf, view_, u);
    if (!(drawn.pdf > 0)) return {};
    const Rgb from = sky.map ? sky.map->lookup(sky.to_local.vector(frame_.to_world(drawn.direction))) : Rgb{1, 1, 1};
    return reflected(drawn.direction) * emitter_.radiance * from / drawn.pdf;
  }

  const Emitter& emitter_;
  const ShadingPoint& point_;
  const LocalFrame& frame_;
  const Horizons& horizons_;
  const Kernel& kernel_;
  Vec3d view_;
  Sampled sampled_;
};

// Points of one seed are other ones at every place, so that errors of neighbours are independent.
std::uint64_t seed_at(std::uint64_t seed, const ShadingPoint& point) {
  for (const Vec3d& v : {point.position, point.normal, point.view})
    for (int c = 0; c < 3; ++c) {
      seed ^= std::bit_cast<std::uint64_t>(v[c]);
      seed = mixed_successor(seed);
    }
  return seed;
}

bool has_extent(const Emitter& emitter) {
  if (const auto* distant = std::get_if<DistantEmitter>(&emitter.shape)) return distant->radius_rad > 0;
  return !std::holds_alternative<PunctualEmitter>(emitter.shape);
}

}  // namespace

Rgb SampledEstimate::error() const { return (standard_error + heaviest) * 3; }

SampledEstimate monte_carlo(const Emitter& emitter, const ShadingPoint& point, const Sampling& sampling) {
  SampledEstimate estimate;
  if (!has_extent(emitter)) {
    const Estimate exact = reference(emitter, point, {});
    estimate.value = exact.value;
    estimate.standard_error = exact.error / 3;
    return estimate;
  }
  const LocalFrame frame(point);
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return estimate;
  const std::uint64_t each = std::max<std::uint64_t>((sampling.samples + shifts - 1) / shifts, 1);
  estimate.samples = each * shifts;
  const ShiftedPoints points(shifts, seed_at(sampling.seed, point));
  with_kernel(point.brdf, view, [&](const auto& kernel) {
    const Sampler sampler(emitter, point, frame, horizons, kernel);
    Rgb heaviest = sampler.at_mirror();
    std::array<Rgb, shifts> means;
    for (std::size_t k = 0; k < shifts; ++k) {
      for (std::uint64_t i = 0; i < each; ++i) {
        const Rgb value = sampler(points(k, i));
        means[k] += value;
        for (int c = 0; c < 3; ++c) heaviest[c] = std::max(heaviest[c], value[c]);
      }
      means[k] = means[k] / static_cast<double>(each);
    }
    const ScatteredMean mean = mean_of(means);
    estimate.value = mean.value;
    estimate.standard_error = mean.deviation;
    estimate.heaviest = heaviest / static_cast<double>(estimate.samples);
  });
  return estimate;
}

}  // namespace etendue::eval
