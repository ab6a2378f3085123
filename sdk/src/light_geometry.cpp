#include "light_ratio.h"

#include "parameter_error.h"

#include <fmt/format.h>

namespace etendue {

Wide area_of(const SphereShape& s) { return 4 * wide_pi * squared(s.radius); }
Wide area_of(const DiskShape& s) { return wide_pi * squared(s.radius); }
Wide area_of(const RectShape& s) { return Wide(s.width) * s.height; }
// Gauss' sum over the edges, from the first point, so that a polygon far from its origin keeps its digits.
Wide area_of(const PolygonShape& s) {
  double twice = 0;
  for (std::size_t i = 2; i < s.points.size(); ++i) {
    const Vec2d a{s.points[i - 1].x - s.points[0].x, s.points[i - 1].y - s.points[0].y};
    const Vec2d b{s.points[i].x - s.points[0].x, s.points[i].y - s.points[0].y};
    twice += a.x * b.y - b.x * a.y;
  }
  return std::fabs(twice) / 2;
}
Wide area_of(const TubeShape& s) {
  const Wide side = 2 * wide_pi * s.radius * s.length, disk = wide_pi * squared(s.radius);
  return s.caps == Caps::round ? side + 4 * disk : s.caps == Caps::flat ? side + 2 * disk : side;
}

Wide face_of(const SphereShape& s) { return wide_pi * squared(s.radius); }
Wide face_of(const DiskShape& s) { return area_of(s); }
Wide face_of(const RectShape& s) { return area_of(s); }
Wide face_of(const PolygonShape& s) { return area_of(s); }
// Seen across, a tube is a rectangle, with round caps a stadium.
Wide face_of(const TubeShape& s) {
  const Wide side = 2 * Wide(s.radius) * s.length;
  return s.caps == Caps::round ? side + wide_pi * squared(s.radius) : side;
}

namespace {
// 1 - cos x = 2 sin^2(x/2), without cancellation.
Wide versine(double x) { return 2 * squared(Wide(std::sin(x / 2))); }
}  // namespace

// With c = cos t the integral of a falloff g(s) over the ring between the half angles is 2 pi (ci - co) times the integral of g over
// s = 0 .. 1, which is w = 1/3 for s^2 and 1/2 for the smoothstep. With the full middle, 2 pi (1 - ci), and
// ci - co = (1 - co) - (1 - ci): Omega = 2 pi [(1 - w) (1 - ci) + w (1 - co)], a sum of positive terms.
Wide solid_angle_of(const SpotShape& spot, const Conventions& conventions) {
  switch (conventions.spot_flux) {
    case FluxConvention::frostbite_pi:
      return wide_pi;
    case FluxConvention::isotropic:
      return 4 * wide_pi;
    case FluxConvention::cone:
      return 2 * wide_pi * versine(spot.outer_rad);
    case FluxConvention::falloff:
      break;
  }
  switch (conventions.spot_falloff) {
    case SpotFalloff::squared:
      return 2 * wide_pi * (2 * versine(spot.inner_rad) + versine(spot.outer_rad)) / 3;
    case SpotFalloff::smoothstep:
      return wide_pi * (versine(spot.inner_rad) + versine(spot.outer_rad));
    case SpotFalloff::hard:
      break;
  }
  return 2 * wide_pi * versine(spot.outer_rad);
}

// 4 asin(sin(a/2) sin(b/2)), in the form that keeps its digits near 180 degrees.
Wide solid_angle_of_frustum(const FrustumShape& frustum) {
  const double a = frustum.width_rad / 2, b = frustum.height_rad / 2;
  return 4 * Wide(std::atan2(std::sin(a) * std::sin(b), std::hypot(std::cos(a), std::sin(a) * std::cos(b))));
}

// ---- Sizes ----

namespace {

// A size as a parameter, and as words: "a radius in metres".
struct Named {
  const char *parameter, *words;
};
constexpr Named named_radius{"radius", "a radius in metres"}, named_length{"length", "a length in metres"};

Status size(const Named& name, double value) {
  if (value > 0 && std::isfinite(value)) return Done{};
  if (value == 0) return parameter_error(name.parameter, "SIZE_MISSING", fmt::format("expected {} greater than zero", name.words));
  return parameter_error(name.parameter, "NUMBER_INVALID", fmt::format("expected {} above 0 and finite, found {}", name.words, value));
}
Status sizes(const Named& first, double first_m, const Named& second, double second_m) {
  const Status checked = size(first, first_m);
  return checked ? size(second, second_m) : checked;
}
Status angle(const Named& name, double rad, double most_rad) {
  if (rad >= 0 && rad <= most_rad) return Done{};
  return parameter_error(
      name.parameter, "NUMBER_INVALID",
      fmt::format("expected {} from 0 to {:g} degrees, found {:g} degrees", name.words, degrees.of({most_rad}), degrees.of({rad})),
      rad > most_rad ? "angles are radians in code and carry their unit as text, such as 30 deg" : "");
}

}  // namespace

Status check_size(const PointShape&) { return Done{}; }
Status check_size(const SpotShape& s) {
  if (Status outer = angle({"outer", "an outer half angle"}, s.outer_rad, pi); !outer) return outer;
  if (Status inner = angle({"inner", "an inner half angle"}, s.inner_rad, pi); !inner) return inner;
  if (s.inner_rad <= s.outer_rad) return Done{};
  return parameter_error("inner", "NUMBER_INVALID",
                         fmt::format("expected an inner half angle up to the outer one, {:g} degrees, found {:g} degrees",
                                     degrees.of({s.outer_rad}), degrees.of({s.inner_rad})));
}
Status check_size(const FrustumShape& s) {
  const Status width = angle({"width_angle", "a width angle"}, s.width_rad, pi);
  return width ? angle({"height_angle", "a height angle"}, s.height_rad, pi) : width;
}
Status check_size(const BeamOfSolidAngle& s) {
  if (s.flux_over_axial_sr > 0 && std::isfinite(s.flux_over_axial_sr)) return Done{};
  return parameter_error("flux_over_axial", "NUMBER_INVALID",
                         fmt::format("expected a flux over axial intensity above 0 sr and finite, found {} sr", s.flux_over_axial_sr));
}
Status check_size(const SphereShape& s) { return size(named_radius, s.radius); }
Status check_size(const DiskShape& s) { return size(named_radius, s.radius); }
Status check_size(const RectShape& s) { return sizes({"width", "a width in metres"}, s.width, {"height", "a height in metres"}, s.height); }
Status check_size(const TubeShape& s) {
  // Without a length round caps are a sphere, and flat ones two disks back to back.
  if (s.length == 0 && s.caps != Caps::none) return size(named_radius, s.radius);
  return sizes(named_length, s.length, named_radius, s.radius);
}
Status check_size(const PolygonShape& s) { return size({"points", "a polygon's area in square metres"}, double(area_of(s))); }
Status check_size(const SurfaceOfArea& s) { return size({"area_m2", "an area in square metres"}, s.area_m2); }
Status check_size(const LineShape& s) { return size(named_length, s.length); }
Status check_size(const DistantShape& s) { return angle({"angular_diameter", "an angular diameter"}, s.diameter_rad, pi); }
Status check_size(const EnvironmentShape&) { return Done{}; }

}  // namespace etendue
