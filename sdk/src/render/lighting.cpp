#include "lighting.h"
#include "hashing.h"

#include <array>
#include <cmath>
#include <vector>

namespace etendue::rendering {
namespace {

constexpr int dimensions = 6;  // pixel, light, BRDF: two each

// Additive recurrence with the powers of 1/phi, phi the root of phi^7 = phi + 1 (Roberts 2018, "The unreasonable effectiveness of
// quasirandom sequences"), shifted at random: every point is uniform, so the estimate has no bias, and the points keep their distance.
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) {
    Random random(seed);
    for (double& s : place_) s = random.next();
  }
  std::array<double, dimensions> next() {
    static const std::array<double, dimensions> steps = [] {
      double phi = 1;
      for (int i = 0; i < 64; ++i) phi = std::pow(1 + phi, 1.0 / (dimensions + 1));
      std::array<double, dimensions> s{};
      double power = 1;
      for (double& step : s) step = power /= phi;
      return s;
    }();
    const std::array<double, dimensions> out = place_;
    for (std::size_t i = 0; i < dimensions; ++i) {
      place_[i] += steps[i];
      if (place_[i] >= 1) place_[i] -= 1;
    }
    return out;
  }

 private:
  std::array<double, dimensions> place_{};
};

// A shading point with its frame: directions of the world in, reflected parts out.
class Reflector {
 public:
  explicit Reflector(const eval::ShadingPoint& point) : point_(point), frame_(eval::shading_basis(point)), view_(local(point.view)) {}

  // BRDF times cosine; 0 below either horizon.
  Rgb brdf_cos(const Vec3d& direction) const {
    if (dot(direction, point_.surface_normal) <= 0) return {};
    return eval::brdf_cos(point_.brdf, view_, local(direction));
  }
  double pdf(const Vec3d& direction) const { return eval::pdf_brdf(point_.brdf, view_, local(direction)); }
  double highest_pdf() const { return eval::highest_pdf(point_.brdf, view_); }
  // pdf 0: none
  eval::DirectionSample choose(const Vec2d& u) const {
    eval::DirectionSample s = eval::sample_brdf(point_.brdf, view_, u);
    s.direction = frame_.tangent * s.direction.x + frame_.bitangent * s.direction.y + frame_.normal * s.direction.z;
    return s;
  }

 private:
  Vec3d local(const Vec3d& v) const { return {dot(frame_.tangent, v), dot(frame_.bitangent, v), dot(frame_.normal, v)}; }

  const eval::ShadingPoint& point_;
  Basis frame_;
  Vec3d view_;
};

// Solid angle of the ball, as seen from outside it.
std::optional<double> solid_angle(const Ball& ball, const Vec3d& from) {
  const double sine = ball.radius / length(ball.centre - from);
  if (!(sine < 1)) return std::nullopt;
  return 2 * pi * sine * sine / (1 + std::sqrt(1 - sine * sine));
}

// Whether the BRDF is to be sampled beside the light. Where the light is small and far, directions chosen by the BRDF hardly meet it: no
// more than highest_pdf times its solid angle do, and beside a density of about 1 / solid angle the balance heuristic leaves them no more
// than that share of the light.
bool samples_brdf(const StageLight& light, const eval::ShadingPoint& point, const Reflector& reflector) {
  constexpr double least_share = 0.25;
  if (std::holds_alternative<eval::EnvironmentEmitter>(light.emitter.shape)) return true;
  if (std::holds_alternative<Lambert>(point.brdf)) return false;
  const auto angle = light.extent ? solid_angle(*light.extent, point.position) : std::nullopt;
  return !angle || reflector.highest_pdf() * *angle > least_share;
}

}  // namespace

Sampled::Sums Sampled::total() const {
  Sums sum;
  for (const Sums& r : replicates) sum.visible += r.visible, sum.all += r.all;
  return sum;
}

Deviating Sampled::difference(double beta) const {
  const auto count = static_cast<double>(replicates.size());
  const auto estimate = [&](const Sums& sums) { return (sums.visible - sums.all * beta) / static_cast<double>(points); };
  Deviating out;
  for (const Sums& r : replicates) out.mean += estimate(r) / count;
  for (const Sums& r : replicates) out.variance += squared(estimate(r) - out.mean) / (count * (count - 1));
  return out;
}

// With v and a a replicate's sums and R = sum v / sum a, to first order in the deviations R is off by mean(v - R a) / mean(a).
Deviating Sampled::ratio(double otherwise) const {
  const auto count = static_cast<double>(replicates.size());
  const Sums sum = total();
  Deviating out;
  for (int c = 0; c < 3; ++c) {
    out.mean[c] = sum.all[c] > 0 ? sum.visible[c] / sum.all[c] : otherwise;
    if (!(sum.all[c] > 0)) continue;
    double squares = 0;
    for (const Sums& r : replicates) squares += std::pow((r.visible[c] - out.mean[c] * r.all[c]) / sum.all[c], 2);
    out.variance[c] = squares * count / (count - 1);
  }
  return out;
}

Rgb Lighting::emitted(const StageLight& light, const std::optional<SurfacePoint>& point, const Ray& ray) const {
  const bool met = point ? point->thing == light.thing : light.background;
  return met ? eval::light_along(light.as_seen, ray.origin, ray.direction).radiance : Rgb{};
}

Reflected Lighting::from_direction(const StageLight& light, const SeenPoint& seen, const eval::ShadingPoint& shading,
                                   RayCounts& counts) const {
  const eval::LightSample sample = delta_light(light, seen.point.position);
  if (sample.pdf <= 0) return {};
  const Rgb value = Reflector(shading).brdf_cos(sample.direction) * sample.radiance;
  ++counts.evaluations;
  if (value == Rgb{}) return {};
  ++counts.shadow;
  if (stage_.blocked(seen.point, sample.direction, sample.distance, light.thing)) return {};
  return {value, 0};
}

std::vector<Reflected> Lighting::reflected(const StageLight& light, std::span<const SeenPoint> points, const eval::LightPlan& plan,
                                           RayCounts& counts) const {
  std::vector<Reflected> out(points.size());
  std::vector<eval::ShadingPoint> planned;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SeenPoint& seen = points[i];
    const auto shading = shading_point(stage_.thing(seen.point.thing).paint, seen.point, seen.view, seen.base_colour);
    if (!shading) continue;
    if (light.delta) {
      out[i] = from_direction(light, seen, *shading, counts);
    } else {
      planned.push_back(*shading), index.push_back(i);
    }
  }
  const std::vector<eval::LightWithin> lights = plan(planned);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    counts.evaluations += lights[k].light.evaluations;
    out[index[k]] = {lights[k].light.value, largest(lights[k].light.error)};
  }
  return out;
}

std::vector<Response> Lighting::responses(const StageLight& light, std::span<const SeenPoint> points, const eval::LightPlan& plan,
                                          RayCounts& counts) const {
  std::vector<SeenPoint> wanted;
  std::vector<std::size_t> first;
  for (const SeenPoint& seen : points) {
    first.push_back(wanted.size());
    const Paint* const paint = stage_.thing(seen.point.thing).paint;
    if (paint == nullptr || !paint->coloured()) {
      wanted.push_back(seen);
    } else {
      wanted.push_back({seen.point, seen.view, Rgb{0, 0, 0}}), wanted.push_back({seen.point, seen.view, Rgb{1, 1, 1}});
    }
  }
  first.push_back(wanted.size());
  const std::vector<Reflected> lit = reflected(light, wanted, plan, counts);
  std::vector<Response> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Reflected &black = lit[first[i]], &white = lit[first[i + 1] - 1];
    out.push_back({black.value, white.value - black.value, std::max(black.bound, white.bound)});
  }
  return out;
}

std::optional<SurfacePoint> Lighting::target_point(const PixelTarget& target, const Ray& ray, RayCounts& counts) const {
  if (target.plane == nullptr) {
    ++counts.primary;
    return stage_.first(ray);
  }
  SurfacePoint point = *target.plane;
  point.distance = dot(point.geometric_normal, point.position - ray.origin) / dot(point.geometric_normal, ray.direction);
  point.position = ray.origin + ray.direction * point.distance;
  return point;
}

Sampled Lighting::sample(const StageLight& light, const PixelTarget& target, const Effort& effort, std::uint64_t seed,
                         RayCounts& counts) const {
  Sampled result{std::vector<Sampled::Sums>(static_cast<std::size_t>(effort.replicates)), effort.points};
  const std::uint32_t own = light.convex ? light.thing : no_index;
  for (std::size_t r = 0; r < result.replicates.size(); ++r) {
    Sequence sequence(mixed(seed) + r);
    Sampled::Sums& sums = result.replicates[r];
    for (int i = 0; i < effort.points; ++i) {
      const auto u = sequence.next();
      const Ray ray = camera_.through(target.x + u[0], target.y + u[1]);
      const std::optional<SurfacePoint> point = target_point(target, ray, counts);
      if (!point) continue;
      const auto shading = shading_point(stage_.thing(point->thing).paint, *point, -ray.direction);
      if (!shading) continue;
      const Reflector reflector(*shading);
      const auto add = [&](const Vec3d& direction, double distance, const Rgb& value) {
        if (value == Rgb{}) return;
        sums.all += value;
        ++counts.shadow;
        if (!stage_.blocked(*point, direction, distance, own)) sums.visible += value;
      };
      // Both strategies, one sample each; the balance heuristic (Veach 1997, section 9.2.2) divides by the sum of their densities.
      const bool both = samples_brdf(light, *shading, reflector);
      const eval::LightSample towards = eval::sample_light(light.emitter, point->position, {u[2], u[3]});
      ++counts.evaluations;
      if (towards.pdf > 0) {
        const double density = towards.pdf + (both && !towards.delta ? reflector.pdf(towards.direction) : 0);
        add(towards.direction, towards.distance, reflector.brdf_cos(towards.direction) * towards.radiance / density);
      }
      if (!both || towards.delta) continue;
      const eval::DirectionSample reflection = reflector.choose({u[4], u[5]});
      if (reflection.pdf <= 0) continue;
      const eval::LightSample met = eval::light_along(light.emitter, point->position, reflection.direction);
      if (met.radiance == Rgb{}) continue;
      add(reflection.direction, met.distance, reflector.brdf_cos(reflection.direction) * met.radiance / (met.pdf + reflection.pdf));
    }
  }
  return result;
}

}  // namespace etendue::rendering
