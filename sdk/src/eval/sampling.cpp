// Directions towards lights, their densities, and what comes from there.
#include "environment.h"
#include "hit.h"
#include "line.h"
#include "modulation.h"
#include "punctual.h"
#include "triangle_sampling.h"
#include "tube_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue::eval {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// On the emitting side of a plane.
bool faces(const Vec3d& on_plane, const Vec3d& normal, const Vec3d& position, bool two_sided) {
  const double height = dot(position - on_plane, normal);
  return height > 0 || (two_sided && height < 0);
}

bool seen(const PolygonEmitter& e, const Vec3d& position, bool two_sided) {
  return e.vertices.size() >= 3 && faces(e.vertices[0], e.normal, position, two_sided);
}

TriangleSampler polygon_sampler(const PolygonEmitter& e, const Vec3d& position) {
  std::vector<std::array<Vec3d, 3>> triangles;
  triangles.reserve(e.triangles.size());
  for (const auto& t : e.triangles) {
    triangles.push_back({e.vertices[t[0]] - position, e.vertices[t[1]] - position, e.vertices[t[2]] - position});
  }
  return TriangleSampler(std::move(triangles));
}

struct MeshHit {
  std::size_t triangle;
  double distance;
};
std::optional<MeshHit> hit_mesh(const MeshEmitter& e, const Vec3d& position, const Vec3d& direction, bool two_sided) {
  std::optional<MeshHit> best;
  for (std::size_t i = 0; i < e.triangles.size(); ++i) {
    const auto& t = e.triangles[i];
    if (!two_sided && dot(cross(t[1] - t[0], t[2] - t[0]), direction) >= 0) continue;
    const auto distance = hit_triangle(t, position, direction);
    if (distance && (!best || *distance < best->distance)) best = MeshHit{i, *distance};
  }
  return best;
}

double mesh_pdf(const MeshEmitter& e, std::size_t triangle, const Vec3d& direction, double distance) {
  const auto& t = e.triangles[triangle];
  const double cosine = std::abs(dot(normalised(cross(t[1] - t[0], t[2] - t[0])), direction));
  return cosine > 0 ? distance * distance / (e.running_area.back() * cosine) : 0;
}

// Density and radiance of a given direction. The same functions give both callers their answer, so that they cannot disagree.
struct Along {
  const Emitter& emitter;
  const Vec3d& position;
  const Vec3d& direction;

  LightSample met(double distance, double pdf, std::size_t index = 0) const {
    if (!(pdf > 0) || !std::isfinite(pdf)) return {direction, distance, 0, {}, false};
    const Rgb modulation = is_modulated(emitter) ? modulation_along(emitter, index, position, direction) : Rgb{1, 1, 1};
    return {direction, distance, pdf, emitter.radiance * modulation, false};
  }
  LightSample missed(double pdf = 0) const { return {direction, infinite, pdf, {}, false}; }

  LightSample operator()(const PunctualEmitter&) const { return missed(); }
  LightSample operator()(const LineEmitter&) const { return missed(); }
  LightSample operator()(const DistantEmitter& e) const {
    const Cone cone{e.towards, std::sin(e.radius_rad), std::cos(e.radius_rad)};
    if (!(e.radius_rad > 0) || !contains(cone, direction)) return missed();
    return {direction, infinite, 1 / solid_angle_of(cone), e.illuminance / (pi * cone.sine * cone.sine), false};
  }
  LightSample operator()(const SphereEmitter& e) const {
    const Vec3d centre = e.centre - position;
    if (!(e.radius > 0)) return missed();
    const bool outside = dot(centre, centre) > e.radius * e.radius;
    const auto distance = hit_sphere(e.centre, e.radius, position, direction);
    if (!distance || (!outside && !emitter.two_sided)) return missed();
    return met(*distance, outside ? 1 / solid_angle_of(cone_around(centre, e.radius)) : 0.25 / pi);
  }
  LightSample operator()(const DiskEmitter& e) const {
    if (!faces(e.centre, e.normal, position, emitter.two_sided)) return missed();
    const auto distance = hit_disk(e.centre, e.normal, e.radius, position, direction);
    if (!distance) return missed();
    return met(*distance, *distance * *distance / (pi * e.radius * e.radius * std::abs(dot(direction, e.normal))));
  }
  LightSample operator()(const PolygonEmitter& e) const {
    const auto distance = seen(e, position, emitter.two_sided) ? hit_polygon(e, position, direction) : std::nullopt;
    return distance ? met(*distance, polygon_sampler(e, position).pdf(direction, *distance)) : missed();
  }
  LightSample operator()(const TubeEmitter& e) const {
    if (inside_tube(e.a - position, e.b - position, e.radius, e.caps)) {
      const auto wall = emitter.two_sided ? hit_tube(e, position, direction) : std::nullopt;
      return wall ? met(*wall, 0.25 / pi) : missed();
    }
    // All that is sampled lies within the sphere around the tube.
    const double reach = (0.5 * length(e.b - e.a) + e.radius) * (1 + 1e-9);
    if (!hit_sphere((e.a + e.b) * 0.5, reach, position, direction)) return missed();
    return on_tube(e, TubeSampler(e, position));
  }
  LightSample on_tube(const TubeEmitter& e, const TubeSampler& sampler) const {
    const double pdf = sampler.pdf(direction);
    auto distance = hit_tube(e, position, direction);
    // Through the mouth of a tube without caps one sees its dark inside.
    if (distance && e.caps == Caps::none) {
      const Vec3d axis = normalised(e.b - e.a), p = position + direction * *distance - e.a;
      if (dot(p - axis * dot(p, axis), direction) >= 0) distance.reset();
    }
    return distance ? met(*distance, pdf) : missed(pdf);
  }
  LightSample operator()(const MeshEmitter& e) const {
    if (e.running_area.empty()) return missed();
    const auto hit = hit_mesh(e, position, direction, emitter.two_sided);
    return hit ? met(hit->distance, mesh_pdf(e, hit->triangle, direction, hit->distance), hit->triangle) : missed();
  }
  LightSample operator()(const EnvironmentEmitter& e) const {
    if (!e.map) return {direction, infinite, 0.25 / pi, emitter.radiance, false};
    const Vec3d local = e.to_local.vector(direction);
    return {direction, infinite, e.map->pdf(local), emitter.radiance * e.map->lookup(local), false};
  }
};

Vec3d uniform_direction(const Vec2d& u) {
  const double z = 1 - 2 * u.x, r = std::sqrt(std::max(1 - z * z, 0.0)), phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

struct Sample {
  const Emitter& emitter;
  const Vec3d& position;
  const Vec2d& u;

  LightSample along(const Vec3d& direction) const {
    if (direction == Vec3d{}) return {};
    return std::visit(Along{emitter, position, direction}, emitter.shape);
  }

  LightSample operator()(const PunctualEmitter& e) const {
    const auto incident = incident_from(e, emitter.window, position);
    return incident ? LightSample{incident->towards, incident->distance, 1, incident->illuminance, true} : LightSample{};
  }
  LightSample operator()(const DistantEmitter& e) const {
    if (!(e.radius_rad > 0)) return {e.towards, infinite, 1, e.illuminance, true};
    return along(sample(Cone{e.towards, std::sin(e.radius_rad), std::cos(e.radius_rad)}, u));
  }
  LightSample operator()(const SphereEmitter& e) const {
    const Vec3d centre = e.centre - position;
    if (!(dot(centre, centre) > e.radius * e.radius)) return emitter.two_sided ? along(uniform_direction(u)) : LightSample{};
    return along(sample(cone_around(centre, e.radius), u));
  }
  LightSample operator()(const DiskEmitter& e) const {
    const Basis basis = basis_around(e.normal);
    const double r = e.radius * std::sqrt(u.x), phi = 2 * pi * u.y;
    return along(normalised(e.centre + basis.tangent * (r * std::cos(phi)) + basis.bitangent * (r * std::sin(phi)) - position));
  }
  // The samplers of polygons and tubes are costly: the one that chose the direction also tells its density.
  LightSample operator()(const PolygonEmitter& e) const {
    if (!seen(e, position, emitter.two_sided)) return {};
    const TriangleSampler sampler = polygon_sampler(e, position);
    const Vec3d direction = sampler.sample(u);
    if (direction == Vec3d{}) return {};
    const Along ray{emitter, position, direction};
    const auto distance = hit_polygon(e, position, direction);
    return distance ? ray.met(*distance, sampler.pdf(direction, *distance)) : ray.missed();
  }
  LightSample operator()(const TubeEmitter& e) const {
    if (inside_tube(e.a - position, e.b - position, e.radius, e.caps)) return along(uniform_direction(u));
    const TubeSampler sampler(e, position);
    const Vec3d direction = sampler.sample(u);
    return direction == Vec3d{} ? LightSample{} : Along{emitter, position, direction}.on_tube(e, sampler);
  }
  // Uniform in psi (line.h), which is nearly proportional to what arrives.
  LightSample operator()(const LineEmitter& e) const {
    const auto view = line_view(e.a - position, e.b - position);
    if (!view) return {};
    const double psi = view->begin + (view->end - view->begin) * u.x, cosine = std::cos(psi);
    const double distance = view->height / cosine;
    const double factor = view->scale * cosine * (view->end - view->begin) * window_at(emitter.window, distance);
    return {view->at(psi), distance, 1, e.intensity * factor, true};
  }
  // A point uniform over the area of all triangles. Where several lie behind one another, each point counts for itself.
  LightSample operator()(const MeshEmitter& e) const {
    if (e.running_area.empty() || !(e.running_area.back() > 0)) return {};
    const double at = u.x * e.running_area.back();
    const auto found = std::upper_bound(e.running_area.begin(), e.running_area.end() - 1, at);
    const auto i = static_cast<std::size_t>(found - e.running_area.begin());
    const double before = i > 0 ? e.running_area[i - 1] : 0, own = e.running_area[i] - before;
    if (!(own > 0)) return {};
    const double root = std::sqrt(std::clamp((at - before) / own, 0.0, 1.0));
    const auto& t = e.triangles[i];
    const Vec3d to = t[0] * (1 - root) + t[1] * (root * (1 - u.y)) + t[2] * (root * u.y) - position;
    const double distance = length(to);
    if (!(distance > 0)) return {};
    const Vec3d direction = to / distance;
    const double facing = -dot(cross(t[1] - t[0], t[2] - t[0]), direction);
    if (!(facing > 0 || (emitter.two_sided && facing < 0))) return {};
    return Along{emitter, position, direction}.met(distance, mesh_pdf(e, i, direction, distance), i);
  }
  LightSample operator()(const EnvironmentEmitter& e) const {
    if (!e.map) return along(uniform_direction(u));
    const Vec3d local = e.map->sample(u);
    const auto& c = e.to_local.columns;  // a rotation: its inverse is its transpose
    return along({dot(c[0], local), dot(c[1], local), dot(c[2], local)});
  }
};

}  // namespace

LightSample sample_light(const Emitter& emitter, const Vec3d& position, const Vec2d& u) {
  return std::visit(Sample{emitter, position, u}, emitter.shape);
}

LightSample light_along(const Emitter& emitter, const Vec3d& position, const Vec3d& direction) {
  return std::visit(Along{emitter, position, direction}, emitter.shape);
}

}  // namespace etendue::eval
