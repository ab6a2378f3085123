#include "shapes.h"

namespace etendue::python {
namespace {

constexpr std::array<std::pair<std::string_view, Caps>, 3> caps{{{"round", Caps::round}, {"flat", Caps::flat}, {"none", Caps::none}}};

template <class... Numbers>
ShapeNumbers numbers(const char* name, Numbers... x) {
  return {name, {x...}, ""};
}

struct NumbersOf {
  ShapeNumbers operator()(const PointShape&) const { return numbers("point"); }
  ShapeNumbers operator()(const SpotShape& s) const { return numbers("spot", s.inner_rad, s.outer_rad); }
  ShapeNumbers operator()(const FrustumShape& s) const { return numbers("frustum", s.width_rad, s.height_rad); }
  ShapeNumbers operator()(const DistantShape& s) const { return numbers("distant", s.diameter_rad); }
  ShapeNumbers operator()(const SphereShape& s) const { return numbers("sphere", s.radius); }
  ShapeNumbers operator()(const DiskShape& s) const { return numbers("disk", s.radius); }
  ShapeNumbers operator()(const RectShape& s) const { return numbers("rect", s.width, s.height); }
  ShapeNumbers operator()(const PolygonShape& s) const {
    ShapeNumbers polygon = numbers("polygon");
    for (const Vec2d& p : s.points) std::get<1>(polygon).insert(std::get<1>(polygon).end(), {p.x, p.y});
    return polygon;
  }
  ShapeNumbers operator()(const TubeShape& s) const {
    ShapeNumbers tube = numbers("tube", s.length, s.radius);
    for (const auto& [name, value] : caps)
      if (value == s.caps) std::get<2>(tube) = name;
    return tube;
  }
  ShapeNumbers operator()(const LineShape& s) const { return numbers("line", s.length); }
  ShapeNumbers operator()(const MeshShape&) const { return numbers("mesh", 0.0); }
  ShapeNumbers operator()(const PhotometricShape&) const { return numbers("photometric", 0.0); }
  ShapeNumbers operator()(const EnvironmentShape&) const { return numbers("environment"); }
};

}  // namespace

Shape shape_of(const ShapeNumbers& given) {
  const auto& [name, x, cap] = given;
  const auto at = [&numbers = x](std::size_t i) { return i < numbers.size() ? numbers[i] : 0; };
  if (name == "spot") return SpotShape{at(0), at(1)};
  if (name == "frustum") return FrustumShape{at(0), at(1)};
  if (name == "distant") return DistantShape{at(0)};
  if (name == "sphere") return SphereShape{at(0)};
  if (name == "disk") return DiskShape{at(0)};
  if (name == "rect") return RectShape{at(0), at(1)};
  if (name == "tube") return TubeShape{at(0), at(1), named(cap, caps)};
  if (name == "line") return LineShape{at(0)};
  if (name == "environment") return EnvironmentShape{};
  if (name == "mesh") return MeshShape{};
  if (name == "photometric") return PhotometricShape{};
  if (name == "point") return PointShape{};
  PolygonShape polygon;
  for (std::size_t i = 0; i + 1 < x.size(); i += 2) polygon.points.push_back({x[i], x[i + 1]});
  return polygon;
}

ShapeNumbers numbers_of(const Shape& shape) { return std::visit(NumbersOf(), shape); }

}  // namespace etendue::python
