// An area light gives  L  integral of cos_light cos_surface / r^2 dA  over what is seen of it. With d the least distance, and r n.(y - x),
// the height of y over the surface, and r m.(x - y), that of x over the light, bounded from above over both boxes:
//     E <= L area min(1, height of x / d) min(1, height of y / d) / d^2;
// with the least heights, both positive, and the largest distance it is E >= the same.
// What is curved has no m, and for area stands the largest projected one. A sphere of radius R is seen under the solid angle
// 2 pi (1 - cos sigma) <= pi R^2 / d^2 (sin sigma = R / (d + R)), and has exactly E = pi R^2 L cos / r^2 above the horizon. A tube's side:
// where n is its normal at y, n.(x - y) / r <= cos phi, the angle around the axis between n and x, because (rho cos phi - R) <= cos phi
// sqrt((rho - R cos phi)^2 + R^2 sin^2 phi); the integral over phi gives 2 R l / d^2. In the same way the half spheres at its ends give
// together pi R^2 / d^2 at most.
// Seen along its axis a tube's side is shorter: q / r, q = sqrt((rho - R cos phi)^2 + R^2 sin^2 phi) <= rho + R, is one more factor. From
// below, the integral over phi of (rho cos phi - R) where that is positive is 2 (sqrt(rho^2 - R^2) - R acos(R / rho)) >= 2 (rho - pi R /
// 2): their difference falls with rho, to 0. A line has R = 0, and its intensity for 2 R l L.
// A window w stands under the integral of each upper bound, and w / d^2 falls with d for all of them: its largest value is the nearest
// point's. Of the lower bounds it is the least of w.
#include "light_bound.h"

#include "etendue/intensity_web.h"

#include <cmath>

namespace etendue::eval {
namespace {

double largest(const Rgb& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

Box around_point(const Vec3d& p, const Vec3d& half) {
  Box box;
  box.add(p - half);
  box.add(p + half);
  return box;
}
Box only(const Vec3d& v) { return around_point(v, {}); }

double share(double height, double distance) { return height < distance ? std::max(height / distance, 0.0) : 1; }

Box both_of(const Around& a, const Around& b) {
  Box box;
  for (const Around& one : {a, b}) box.add(one.middle - one.half), box.add(one.middle + one.half);
  return box;
}

// No less than 1. Where one is more anywhere, it is so at the light.
double highest_window(const Window& window) { return std::max(window_at(window, 0), 1.0); }

const Around everywhere{{}, {1, 1, 1}};

struct Bounded {
  const Emitter& emitter;
  double luminance = largest(emitter.radiance);

  LightBound area(const Box& places, double projected) const {
    LightBound b;
    b.places = Around::positions(places);
    b.normals = everywhere;
    b.around = luminance * projected;
    b.most = pi * luminance;
    b.reach = luminance;
    return b;
  }
  LightBound flat(const Box& places, const Box& normals, double surface) const {
    LightBound b = area(places, surface);
    if (emitter.two_sided) return b;
    b.normals = Around::directions(normals);
    std::swap(b.around, b.facing);
    b.least_cosine = 0;
    b.sure_facing = b.facing;
    return b;
  }

  std::optional<LightBound> operator()(const PunctualEmitter& e) const {
    struct Shape {
      double highest, least_cosine, sure;
    };
    const Shape shape = std::visit(
        [](const auto& s) -> Shape {
          using S = std::decay_t<decltype(s)>;
          if constexpr (std::is_same_v<S, SpotShape>) return {1, std::cos(s.outer_rad), 0};
          if constexpr (std::is_same_v<S, FrustumShape>) return {1, 0, 0};
          if constexpr (std::is_same_v<S, ProfileShape>) return {s.web->max_cd(), s.cone ? std::cos(s.cone->outer_rad) : -1, 0};
          return {1, -1, 1};
        },
        e.shape);
    LightBound b;
    b.places = Around::positions(only(e.position));
    b.normals = shape.least_cosine >= 0 ? Around{-e.frame.columns[2], {}} : everywhere;
    b.around = largest(e.intensity) * shape.highest;
    b.sure_around = b.around * shape.sure;
    b.most = b.reach = Box::infinite;
    b.least_cosine = shape.least_cosine < 0 ? -1 : std::max(shape.least_cosine - 1e-9, 0.0);
    return b;
  }
  std::optional<LightBound> operator()(const SphereEmitter& e) const {
    LightBound b = area(around_point(e.centre, {e.radius, e.radius, e.radius}), pi * e.radius * e.radius);
    b.sure_around = b.around;
    return b;
  }
  std::optional<LightBound> operator()(const DiskEmitter& e) const {
    const auto across = [&](double n) { return e.radius * std::sqrt(std::max(1 - n * n, 0.0)); };
    return flat(around_point(e.centre, {across(e.normal.x), across(e.normal.y), across(e.normal.z)}), only(e.normal),
                pi * e.radius * e.radius);
  }
  std::optional<LightBound> operator()(const PolygonEmitter& e) const {
    Box places;
    Vec3d twice;
    for (std::size_t i = 0; i < e.vertices.size(); ++i) {
      const Vec3d& p = e.vertices[i];
      places.add(p);
      twice += cross(p - e.vertices[0], e.vertices[(i + 1) % e.vertices.size()] - e.vertices[0]);
    }
    if (e.vertices.empty()) places.add(Vec3d{});
    return flat(places, only(e.normal), 0.5 * length(twice));
  }
  std::optional<LightBound> operator()(const TubeEmitter& e) const {
    const Vec3d r{e.radius, e.radius, e.radius};
    Box places = around_point(e.a, r);
    places.add(around_point(e.b, r));
    const double end = e.caps == Caps::none ? 0 : pi * e.radius * e.radius, side = 2 * e.radius * length(e.b - e.a);
    LightBound b = area(places, side + end);
    b.axis = normalised(e.b - e.a);
    b.across = b.sure_across = luminance * side;
    b.hidden_m = 0.5 * pi * e.radius;
    b.radius_m = e.radius;
    return b;
  }
  std::optional<LightBound> operator()(const LineEmitter& e) const {
    Box ends;
    ends.add(e.a), ends.add(e.b);
    LightBound b;
    b.places = Around::positions(ends);
    b.normals = everywhere;
    b.around = b.across = b.sure_across = largest(e.intensity);
    b.axis = normalised(e.b - e.a);
    b.most = b.reach = Box::infinite;
    return b;
  }
  std::optional<LightBound> operator()(const MeshEmitter& e) const {
    Box places, normals;
    double surface = 0;
    for (const auto& t : e.triangles) {
      const Vec3d twice = cross(t[1] - t[0], t[2] - t[0]);
      surface += 0.5 * length(twice);
      for (const Vec3d& p : t) places.add(p);
      normals.add(normalised(twice));
    }
    if (e.triangles.empty()) places.add(Vec3d{}), normals.add(Vec3d{});
    LightBound b = flat(places, normals, surface);
    // Each triangle counts, whether or not another stands before it; those that face away do not.
    b.most *= static_cast<double>(e.triangles.size());
    return b;
  }
  std::optional<LightBound> operator()(const DistantEmitter&) const { return std::nullopt; }
  std::optional<LightBound> operator()(const EnvironmentEmitter&) const { return std::nullopt; }
};

}  // namespace

Around Around::positions(const Box& box) {
  Around a{box.middle(), box.half()};
  const auto wider = [](double middle, double half) { return half + 2e-15 * (std::abs(middle) + half); };
  a.half = {wider(a.middle.x, a.half.x), wider(a.middle.y, a.half.y), wider(a.middle.z, a.half.z)};
  return a;
}

LightBound joined(const LightBound& a, const LightBound& b) {
  LightBound both;
  const double of_a = highest_window(a.window), of_b = highest_window(b.window);
  both.places = Around::positions(both_of(a.places, b.places));
  both.normals = Around::directions(both_of(a.normals, b.normals));
  both.around = a.around * of_a + b.around * of_b;
  both.facing = a.facing * of_a + b.facing * of_b;
  if (!is_window(a.window) && !is_window(b.window)) {
    both.sure_around = a.sure_around + b.sure_around;
    both.sure_facing = a.sure_facing + b.sure_facing;
  }
  both.most = a.most + b.most;
  both.reach = a.reach + b.reach;
  both.least_cosine = std::min(a.least_cosine, b.least_cosine);
  both.range_m = std::max(a.range_m, b.range_m);
  return both;
}

std::optional<LightBound> light_bound(const Emitter& emitter) {
  if (emitter.pattern) return std::nullopt;
  std::optional<LightBound> bound = std::visit(Bounded{emitter}, emitter.shape);
  if (!bound) return bound;
  if (is_window(emitter.window)) {
    bound->window = emitter.window;
    if (emitter.window.range_m > 0) bound->range_m = emitter.window.range_m;
    bound->most *= highest_window(emitter.window);
  }
  return bound;
}

// With the middle m and half edges e of the box of differences, and n within c +- h, n.d is within c.m +- (|c|.e + h.(|m| + e)).
Bound bound_at(const LightBound& light, const Surroundings& points) {
  double nearest2 = 0, furthest2 = 0, over_surface = 0, surface_half = 0, over_light = 0, light_half = 0;
  for (int i = 0; i < 3; ++i) {
    // From the light to the point.
    const double middle = points.positions.middle[i] - light.places.middle[i], half = points.positions.half[i] + light.places.half[i];
    const double apart = std::abs(middle), span = apart + half, gap = std::max(apart - half, 0.0);
    nearest2 += gap * gap;
    furthest2 += span * span;
    over_surface -= points.normals.middle[i] * middle;
    surface_half += std::abs(points.normals.middle[i]) * half + points.normals.half[i] * span;
    over_light += light.normals.middle[i] * middle;
    light_half += std::abs(light.normals.middle[i]) * half + light.normals.half[i] * span;
  }
  const double surface_high = over_surface + surface_half, surface_low = over_surface - surface_half;
  const double light_high = over_light + light_half, light_low = over_light - light_half;
  if (!(surface_high > 0)) return {};
  const double nearest = std::sqrt(nearest2);
  if (nearest >= light.range_m) return {};
  if (light.least_cosine >= 0 && !(light_high > 0 && light_high >= light.least_cosine * nearest)) return {};
  if (!(nearest2 > 0)) return {light.most, 0, light.reach};
  double around = light.around, sure_across = 0;
  if (light.across > 0) {
    const Vec3d apart = points.positions.middle - light.places.middle;
    const double along = dot(apart, light.axis), distance = std::sqrt(std::max(dot(apart, apart) - along * along, 0.0));
    // The square root of what cancels has half of the digits.
    const double half = length(points.positions.half) + 1e-7 * length(apart);
    around -= light.across * (1 - share(distance + half + light.radius_m, nearest));
    sure_across = light.sure_across * std::max(distance - half - light.hidden_m, 0.0);
  }
  const double emitted = (around + light.facing * share(light_high, nearest)) / nearest2;
  // Normals are units but for the rounding of floats.
  Bound bound;
  bound.most = std::min(1.000001 * emitted * share(surface_high, nearest) * window_at(light.window, nearest), light.most);
  bound.reach = std::min(emitted, light.reach);
  if (surface_low > 0) {
    const double furthest = std::sqrt(furthest2);
    bound.least = 0.999999 * (light.sure_around + (light.sure_facing * std::max(light_low, 0.0) + sure_across) / furthest) * surface_low /
                  (furthest2 * furthest) * least_window(light.window, nearest, furthest);
  }
  return bound;
}

}  // namespace etendue::eval
