#include "article.h"
#include "polygon.h"
#include "validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

constexpr std::size_t most_polygon_points = 4096;  // the check for crossing edges is quadratic

// Parameters of a shape; whether it has an area is emitting_area()'s to say.
struct CheckShape {
  Validator& check;

  bool operator()(const PointShape&) const { return true; }
  bool operator()(const SpotShape& s) const {
    return check.between("the outer half angle in rad", s.outer_rad, 0, pi / 2) &&
           check.between("the inner half angle in rad", s.inner_rad, 0, s.outer_rad);
  }
  bool operator()(const FrustumShape& s) const {
    const bool positive = check.above("width_angle in rad", s.width_rad, 0) && check.above("height_angle in rad", s.height_rad, 0);
    return positive && check.between("the larger angle in rad", std::max(s.width_rad, s.height_rad), 0, std::nextafter(pi, 0));
  }
  bool operator()(const DistantShape& s) const { return check.between("angular_diameter in rad", s.diameter_rad, 0, pi); }
  bool operator()(const SphereShape& s) const { return check.above("radius in m", s.radius, 0); }
  bool operator()(const DiskShape& s) const { return check.above("radius in m", s.radius, 0); }
  bool operator()(const RectShape& s) const { return check.above("width in m", s.width, 0) && check.above("height in m", s.height, 0); }
  bool operator()(const PolygonShape& s) const {
    const std::size_t n = s.points.size();
    if (!check.between("the number of points", static_cast<double>(n), 3, static_cast<double>(most_polygon_points))) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isfinite(s.points[i].x) && std::isfinite(s.points[i].y)) continue;
      check.error("NUMBER_INVALID", fmt::format("expected finite points, found ({}, {}) as point {}", s.points[i].x, s.points[i].y, i));
      return false;
    }
    if (is_simple(s.points)) return true;
    check.error("POLYGON_NOT_SIMPLE", "expected a polygon whose edges do not meet but at its corners");
    return false;
  }
  bool operator()(const TubeShape& s) const { return check.above("length in m", s.length, 0) && check.above("radius in m", s.radius, 0); }
  bool operator()(const LineShape& s) const { return check.above("length in m", s.length, 0); }
  bool operator()(const MeshShape& s) const {
    const bool scaled = std::isfinite(s.scale.x * s.scale.y * s.scale.z);
    if (!scaled) check.error("NUMBER_INVALID", "expected a finite scale");
    return check.index("the mesh", s.mesh, check.scene().meshes.size()) && scaled;
  }
  bool operator()(const PhotometricShape& s) const {
    const bool given = !s.file.empty() || s.embedded;
    if (!given) check.error("FILE_MISSING", "expected the name of an .ies or .ldt file");
    return given && (!s.cone || (*this)(*s.cone));
  }
  bool operator()(const EnvironmentShape& s) const {
    if (!s.cube.empty() && (s.image || s.cube.size() != 6))
      check.error("VALUE_UNSUITABLE", "expected one image or the six faces of a cube");
    const auto known = [&](std::uint32_t image) { return check.index("the image", image, check.scene().images.size()); };
    return (!s.image || known(*s.image)) && std::all_of(s.cube.begin(), s.cube.end(), known);
  }
};

}  // namespace

void validate_light(Validator& check, const Light& light) {
  check.rigid(light.transform);
  if (light.range_m) check.above("range in m", *light.range_m, light.falloff.law == Falloff::Law::scale_bias ? 1 : 0);
  check.between("exponent of the falloff", light.falloff.exponent, Falloff::least_exponent, Falloff::most_exponent);
  if (light.emission.texture) check.texture("the image of the emission's texture", *light.emission.texture);
  if (light.surface_material) {
    check.index("the surface's material", *light.surface_material, check.scene().materials.size());
    if (!std::holds_alternative<MeshShape>(light.shape)) check.error("VALUE_UNSUITABLE", "only a mesh light has a surface material");
  }
  if (light.two_sided && !emits_both_sides(light))
    check.warning("TWO_SIDED_UNUSED", fmt::format("{} light has no second side that could be seen", with_article(name_of(light.shape))));

  if (!std::visit(CheckShape{check}, light.shape)) return;
  if (const Result<Resolved> resolved = resolve(light, mesh_area_of(check.scene(), light)); !resolved) check.append(resolved.error());
}

}  // namespace etendue
