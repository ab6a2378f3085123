#include "light_curves.h"

#include "etendue/far_light.h"
#include "etendue/published.h"
#include "eval/contour.h"
#include "eval/silhouette.h"
#include "eval_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace etendue::bench {

using Json = nlohmann::ordered_json;
using namespace eval;

namespace {

constexpr Vec3d up{0, 0, 1};
constexpr double degree = pi / 180;

Json numbers(const Vec3d& v) { return Json::array({v.x, v.y, v.z}); }
Json numbers(double x, double y) { return Json::array({x, y}); }

const char* kind_of(const Arc& arc) {
  if (arc.great_circle()) return std::abs(arc.u.z) + std::abs(arc.v.z) < 1e-9 ? "horizon" : "side";
  return arc.unit ? "cap" : "rim";
}

Json arcs_of(const Contour& contour) {
  Json all = Json::array();
  for (const Arc& arc : contour) {
    Json points = Json::array();
    constexpr int steps = 48;
    for (int i = 0; i <= steps; ++i) points.push_back(numbers(normalised(arc.at(arc.begin + (arc.end - arc.begin) * i / steps))));
    all.push_back({{"kind", kind_of(arc)}, {"points", points}});
  }
  return all;
}

Json outline(const Contour& whole, Json shape) {
  const Contour cut = clipped(whole, up);
  return {{"shape", std::move(shape)}, {"whole", arcs_of(whole)}, {"cut", arcs_of(cut)}, {"solid_angle", direction_integral(cut).z}};
}

// Normal in the plane of x and z.
Vec3d tilted(double degrees) { return {std::sin(degrees * degree), 0, std::cos(degrees * degree)}; }

template <class At>
void along(double low, double high, int count, At at) {
  for (int i = 0; i < count; ++i) at(low * std::pow(high / low, i / (count - 1.0)));
}

}  // namespace

Json light_outlines() {
  Json all;
  const auto rectangle = protocol::rectangle({0.4, -1.4, 0.5}, {1, 0, 0}, {0, 0.35, 0.94}, 1.9, 1.7);
  Json corners = Json::array();
  for (const Vec3d& v : rectangle.vertices) corners.push_back(numbers(v));
  all["polygon"] = outline(polygon_silhouette(rectangle.vertices, rectangle.normal, true), {{"corners", corners}});

  const Vec3d centre{0.7, -1.5, 0.35};
  all["sphere"] = outline(sphere_silhouette(centre, 0.75), {{"centres", {numbers(centre)}}, {"radius", 0.75}});

  const Vec3d middle{0.4, -1.4, 0.5}, normal = normalised(Vec3d{0.3, 0.9, -0.5});
  const Basis b = basis_around(normal);
  Json rim = Json::array();
  for (int i = 0; i < 72; ++i)
    rim.push_back(numbers(middle + (b.tangent * std::cos(i * pi / 36) + b.bitangent * std::sin(i * pi / 36)) * 0.95));
  all["disk"] = outline(disk_silhouette(middle, normal, 0.95, false), {{"corners", rim}});

  const Vec3d first{-0.7, -1.3, 1.05}, last{1.4, -1.2, 0.12};
  all["capsule"] = outline(tube_silhouette(first, last, 0.3, Caps::round), {{"centres", {numbers(first), numbers(last)}}, {"radius", 0.3}});
  return all;
}

Json sphere_units() {
  Json curves;
  constexpr double reference_radius = 0.1;
  along(0.01, 0.99, 200, [&](double radius) {
    // The luminance of a power of 4 pi lm is 1 / (pi R^2).
    const double of_power = 1 / (pi * radius * radius), given = 1 / (pi * reference_radius * reference_radius);
    const Emitter sphere = protocol::white(SphereEmitter{up, radius});
    for (const double degrees : {0.0, 75.0}) {
      const double lux = protocol::lux_at(sphere, {}, tilted(degrees)) / std::cos(degrees * degree);
      curves[fmt::format("given power, centre at {:g} degrees", degrees)].push_back(numbers(radius, lux * of_power));
      curves[fmt::format("given luminance, centre at {:g} degrees", degrees)].push_back(numbers(radius, lux * given));
    }
    curves["luminance of the given power"].push_back(numbers(radius, of_power / given));
  });
  return curves;
}

Json sphere_without_horizon() {
  Json curves;
  const DiffuseMethod& method = *find_diffuse_method("frostbite-7-without-horizon");
  for (const double radius : {0.1, 0.3, 0.6, 0.9}) {
    const Emitter sphere = protocol::white(SphereEmitter{up, radius});
    for (int half = 0; half <= 300; ++half) {
      const double degrees = half * 0.5;
      const double exact = protocol::lux_at(sphere, {}, tilted(degrees));
      if (!(exact > 1e-9)) break;
      curves[fmt::format("radius / distance {:g}", radius)].push_back(
          numbers(degrees, *method.illuminance(sphere, {}, tilted(degrees)) / exact - 1));
    }
  }
  return curves;
}

Json inverse_square_errors() {
  Json curves;
  const auto error = [](double distance, const Emitter& light, double area, double cosines, const Vec3d& normal) {
    return std::abs(area * cosines / (distance * distance) / protocol::lux_at(light, {}, normal) - 1);
  };
  along(0.5, 100, 200, [&](double distance) {
    const Vec3d centre = up * distance;
    const auto disk = [&](const Vec3d& normal) { return protocol::white(DiskEmitter{centre, normal, basis_around(normal).tangent, 0.5}); };
    const auto square = [&](const Vec3d& x) { return protocol::white(protocol::rectangle(centre, x, {0, -1, 0}, 1, 1)); };
    const auto add = [&](const char* name, double value) { curves[name].push_back(numbers(distance, value)); };
    add("disk, facing", error(distance, disk(-up), pi / 4, 1, up));
    add("disk turned by 60 degrees", error(distance, disk(-tilted(60)), pi / 4, 0.5, up));
    add("square, facing", error(distance, square({1, 0, 0}), 1, 1, up));
    // Turned so that x, half a side or a radius from the centre, lies on the horizon.
    double of_disk = 0, of_square = 0;
    for (int degrees = -85; degrees <= 85; degrees += 5) {
      const Vec3d normal = -tilted(degrees), x{-normal.z, 0, normal.x}, lowest = centre + x * 0.5;
      const Vec3d surface = normalised(Vec3d{-lowest.z, 0, lowest.x} * (lowest.x < 0 ? -1 : 1));
      const double cosines = -normal.z * surface.z;
      of_disk = std::max(of_disk, error(distance, disk(normal), pi / 4, cosines, surface));
      of_square = std::max(of_square, error(distance, square(x), 1, cosines, surface));
    }
    add("disk that touches the horizon, worst tilt", of_disk);
    add("square that touches the horizon, worst tilt", of_square);
    if (const auto bound = far_error(FarRule::point, distance)) add("bound for parallelograms", *bound);
  });
  return curves;
}

// Straight under the middle of a square all edges span one angle and give the same, so the relative error of the sum is that of one edge.
// Its cosine is h^2 / (1 + h^2) with h the height in half diagonals.
Json edge_fit_errors() {
  Json curves;
  const std::pair<const char*, const char*> methods[] = {{"hill-heitz-rational", "cubic rational fit of theta / sin(theta)"},
                                                         {"hill-heitz-quadratic", "quadratic fit of theta / sin(theta)"}};
  // Abramowitz and Stegun 4.4.45, which stands for acos in shading languages.
  const auto shader_acos = [](double x) { return std::sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - x * 0.0187293))); };
  for (int quarter = 1; quarter < 360; ++quarter) {
    const double degrees = quarter * 0.25;
    const double cosine = std::cos(degrees * degree), height = std::sqrt(cosine / (1 - cosine));
    const Emitter square = protocol::white(protocol::rectangle(up * height, {1, 0, 0}, {0, -1, 0}, std::sqrt(2), std::sqrt(2)));
    const double exact = protocol::lux_at(square, {}, up);
    curves["acos of shading languages"].push_back(numbers(degrees, std::abs(shader_acos(cosine) / (degrees * degree) - 1)));
    for (const auto& [name, title] : methods)
      curves[title].push_back(numbers(degrees, std::abs(*find_diffuse_method(name)->illuminance(square, {}, up) / exact - 1)));
  }
  return curves;
}

}  // namespace etendue::bench
