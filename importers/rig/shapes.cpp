#include "polygon.h"
#include "reader.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue::rig {
namespace {

double length_of(Reader& reader, JsonValue value) { return read_length(value, Bound::positive, reader.diagnostics).value_or(1); }

// An angle between 0 and `max` radians, with both ends or without; told in degrees.
enum class Closed { none, both };
std::optional<double> read_angle(Reader& reader, JsonValue value, double max, Closed closed) {
  const std::optional<double> angle = read_quantity(value, Dimension::angle, Bound::any, reader.diagnostics);
  if (!angle) return {};
  const bool above = closed == Closed::none ? *angle > 0 : *angle >= 0;
  const bool below = closed == Closed::both ? *angle <= max : *angle < max;
  if (above && below) return angle;
  fail(reader.diagnostics, value, "VALUE_OUT_OF_RANGE",
       fmt::format("expected an angle {} 0 deg and {} {:.6g} deg, found {:.6g} deg", closed == Closed::none ? "above" : "from",
                   closed == Closed::both ? "up to" : "below", degrees.of({max}), degrees.of({*angle})));
  return {};
}

// "outer" and "inner".
SpotShape read_spot(Reader& reader, Fields& fields) {
  // "90 deg" may come out a rounding error above pi / 2.
  constexpr double right_angle = pi / 2 * (1 + 1e-15);
  const JsonValue inner_value = fields.find("inner");
  const std::optional<double> inner = read_angle(reader, inner_value, right_angle, Closed::both);
  const std::optional<double> outer = read_angle(reader, fields.require("outer"), right_angle, Closed::both);
  SpotShape spot{std::min(inner.value_or(0), pi / 2), std::min(outer.value_or(pi / 2), pi / 2)};
  if (outer && *outer == 0)
    fail(reader.diagnostics, fields.find("outer"), "VALUE_OUT_OF_RANGE", "expected an outer half angle above 0 deg");
  if (inner && outer && spot.inner_rad > spot.outer_rad) {
    fail(reader.diagnostics, inner_value, "VALUE_OUT_OF_RANGE",
         fmt::format("expected an inner half angle up to the outer one ({:.6g} deg), found {:.6g} deg", degrees.of({spot.outer_rad}),
                     degrees.of({spot.inner_rad})));
  }
  return spot;
}

FrustumShape read_frustum(Reader& reader, Fields& fields) {
  const std::optional<double> width = read_angle(reader, fields.require("width_angle"), pi, Closed::none);
  const std::optional<double> height = read_angle(reader, fields.require("height_angle"), pi, Closed::none);
  return {width.value_or(1), height.value_or(1)};
}

double cross2(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Twice the signed area: the shoelace formula, relative to the first point.
double twice_area(const std::vector<Vec2d>& p) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += cross2(p[0], p[i], p[i + 1]);
  return sum;
}

PolygonShape read_polygon(Reader& reader, Fields& fields) {
  constexpr std::size_t most_points = 4096;  // the test for crossing edges takes the square of it
  PolygonShape polygon;
  const JsonValue points = fields.require("points");
  if (!is_array(points, most_points, reader.diagnostics)) return polygon;
  for (const JsonValue point : points) {
    if (!point.is(JsonKind::array) || point.size() != 2) {
      fail(reader.diagnostics, point, "TYPE_MISMATCH", "expected a point [x, y] of two lengths");
      return polygon;
    }
    const std::optional<double> x = read_length(point.element(0), Bound::any, reader.diagnostics);
    const std::optional<double> y = read_length(point.element(1), Bound::any, reader.diagnostics);
    if (!x || !y) return polygon;
    polygon.points.push_back({*x, *y});
  }
  const double area = polygon.points.size() < 3 ? 0 : twice_area(polygon.points);
  if (polygon.points.size() < 3) {
    fail(reader.diagnostics, points, "VALUE_OUT_OF_RANGE", fmt::format("expected at least 3 points, found {}", polygon.points.size()));
  } else if (area == 0 || !std::isfinite(area)) {
    fail(reader.diagnostics, points, "VALUE_OUT_OF_RANGE", "expected a polygon with an area");
  } else if (!is_simple(polygon.points)) {
    fail(reader.diagnostics, points, "POLYGON_NOT_SIMPLE", "expected a polygon whose edges do not meet but at its corners");
  }
  return polygon;
}

TubeShape read_tube(Reader& reader, Fields& fields) {
  TubeShape tube;
  tube.length = length_of(reader, fields.require("length"));
  tube.radius = length_of(reader, fields.require("radius"));
  tube.caps =
      read_choice<Caps>(fields.find("caps"), {{"round", Caps::round}, {"flat", Caps::flat}, {"none", Caps::none}}, reader.diagnostics)
          .value_or(Caps::round);
  return tube;
}

MeshShape read_mesh_shape(Reader& reader, Fields& fields) {
  MeshShape shape;
  const JsonValue file = fields.find("gltf");
  if (!file) {
    shape.mesh = read_mesh_reference(reader, fields).value_or(no_index);
  } else if (const std::optional<Scene> asset = read_asset(reader, file, Need::meshes)) {
    Mesh mesh = merged_surfaces(*asset);
    mesh.source = fields.object().pointer();
    if (mesh.indices.empty()) fail(reader.diagnostics, file, "MESH_EMPTY", "expected an asset with triangles, found none");
    shape.mesh = static_cast<std::uint32_t>(reader.scene.meshes.size());
    reader.scene.meshes.push_back(std::move(mesh));
  }
  shape.scale = read_scale(fields.find("scale"), reader.diagnostics).value_or(Vec3d{1, 1, 1});
  return shape;
}

EnvironmentShape read_environment(Reader& reader, Fields& fields) {
  const JsonValue file = fields.find("file");
  return {file ? read_image(reader, file) : std::nullopt};
}

PhotometricShape read_photometric(Reader& reader, Fields& fields) {
  const std::optional<std::filesystem::path> path = read_path(reader, fields.require("file"), true);
  PhotometricShape shape{path ? path->generic_string() : std::string()};
  if (const JsonValue cone = fields.find("cone")) {
    Fields angles(cone, reader.diagnostics);
    shape.cone = read_spot(reader, angles);
    angles.finish();
  }
  return shape;
}

Shape read_known_shape(Reader& reader, Fields& fields, std::string_view type) {
  Diagnostics& d = reader.diagnostics;
  if (type == "spot") return read_spot(reader, fields);
  if (type == "frustum") return read_frustum(reader, fields);
  if (type == "distant") return DistantShape{read_angle(reader, fields.find("angular_diameter"), pi, Closed::both).value_or(0)};
  if (type == "sphere") return SphereShape{length_of(reader, fields.require("radius"))};
  if (type == "disk") return DiskShape{length_of(reader, fields.require("radius"))};
  if (type == "rect") {
    const double width = length_of(reader, fields.require("width"));
    return RectShape{width, length_of(reader, fields.require("height"))};
  }
  if (type == "polygon") return read_polygon(reader, fields);
  if (type == "tube") return read_tube(reader, fields);
  if (type == "line") return LineShape{read_length(fields.require("length"), Bound::positive, d).value_or(1)};
  if (type == "mesh") return read_mesh_shape(reader, fields);
  if (type == "photometric") return read_photometric(reader, fields);
  if (type == "environment") return read_environment(reader, fields);
  return PointShape{};
}

}  // namespace

std::optional<Shape> read_shape(Reader& reader, JsonValue value) {
  if (!value) return {};
  Choices<std::string_view> types;
  for (const std::string_view type :
       {"point", "spot", "frustum", "distant", "sphere", "disk", "rect", "polygon", "tube", "line", "mesh", "photometric", "environment"}) {
    types.emplace_back(type, type);
  }
  Fields fields(value, reader.diagnostics);
  const std::optional<std::string_view> type = read_choice(fields.require("type"), types, reader.diagnostics);
  if (!type) return {};
  Shape shape = read_known_shape(reader, fields, *type);
  fields.finish();
  return shape;
}

}  // namespace etendue::rig
