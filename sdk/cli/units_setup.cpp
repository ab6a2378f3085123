// The light that the options of `units` describe.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "article.h"
#include "etendue/light_presets.h"
#include "number_text.h"
#include "units.h"

namespace etendue::cli {
namespace {

constexpr std::array<std::string_view, 13> all_sizes{"radius",  "width",       "height",       "length",           "caps", "inner", "outer",
                                                     "opening", "width-angle", "height-angle", "angular-diameter", "area", "points"};

Error error(const char* code, std::string text, std::string hint = {}) { return {code, std::move(text), {}, std::move(hint), {}}; }

Error of_option(const std::string& name, Error e) {
  e.text = fmt::format("--{}: {}", name, e.text);
  e.where.pointer.clear();
  return e;
}

// Reads sizes and remembers which, so that one that says nothing about the shape is told.
class Sizes {
 public:
  explicit Sizes(const UnitsOptions& options) : shape_(options.shape), sizes_(options.sizes) {}

  bool has(const std::string& name) const {
    const auto found = sizes_.find(name);
    return found != sizes_.end() && !found->second.empty();
  }
  double length(const std::string& name) { return quantity(name, Dimension::length, "SIZE_MISSING"); }
  double angle(const std::string& name) { return quantity(name, Dimension::angle, "ANGLE_MISSING"); }
  double area() {
    const std::string text = take("area", "SIZE_MISSING");
    // No dimension of its own among the quantities: a product of two lengths.
    const std::size_t unit = text.find_first_not_of("0123456789.eE+- ");
    if (text.empty()) return 0;
    if (unit == std::string::npos || text.substr(unit) != "m2") {
      fail(error("UNIT_UNKNOWN", fmt::format("--area: expected square metres such as \"0.5 m2\", found \"{}\"", text)));
      return 0;
    }
    const Result<double> metres = parse_si(text.substr(0, unit) + "m", Dimension::length);
    if (!metres) fail(of_option("area", metres.error()));
    return metres ? *metres : 0;
  }
  // "0m,0m 2m,0m 2m,60cm": corners with a blank between, coordinates with a comma.
  std::vector<Vec2d> points() {
    const std::string text = take("points", "SIZE_MISSING");
    std::vector<Vec2d> corners;
    for (std::string_view rest = trimmed(text); !rest.empty() && !failed_;) {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      corners.push_back(corner(rest.substr(0, end)));
      rest = trimmed(rest.substr(end));
    }
    if (!text.empty() && corners.size() < 3)
      fail(error("SIZE_MISSING", fmt::format("--points: expected three corners or more, found {}", corners.size()),
                 "such as \"0m,0m 2m,0m 2m,60cm\""));
    return corners;
  }
  Caps caps() {
    if (!has("caps")) return Caps::round;
    const std::string name = take("caps", "");
    if (name == "round") return Caps::round;
    if (name == "flat") return Caps::flat;
    if (name == "none") return Caps::none;
    fail(error("USAGE", fmt::format("--caps: expected round, flat or none, found \"{}\"", name)));
    return Caps::round;
  }

  // The first thing that was wrong; a size that was given and not read.
  std::optional<Error> wrong() const {
    if (failed_) return failed_;
    for (const auto& [name, text] : sizes_)
      if (!text.empty() && std::find(taken_.begin(), taken_.end(), name) == taken_.end())
        return error("OPTION_UNUSED", shape_.empty() ? fmt::format("--{} belongs to a --shape, found none", name)
                                                     : fmt::format("--{} says nothing about {}", name, with_article(shape_)));
    return {};
  }

 private:
  void fail(Error e) {
    if (!failed_) failed_ = std::move(e);
  }
  Vec2d corner(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) {
      fail(error("NUMBER_INVALID", fmt::format("--points: expected a corner such as 2m,60cm, found \"{}\"", text)));
      return {};
    }
    const Result<double> x = parse_si(text.substr(0, comma), Dimension::length), y = parse_si(text.substr(comma + 1), Dimension::length);
    if (!x || !y) fail(of_option("points", x ? y.error() : x.error()));
    return {x ? *x : 0, y ? *y : 0};
  }
  std::string take(const std::string& name, const char* missing) {
    taken_.push_back(name);
    if (has(name)) return sizes_.at(name);
    fail(error(missing, fmt::format("--shape {} needs --{}", shape_, name)));
    return {};
  }
  double quantity(const std::string& name, Dimension dimension, const char* missing) {
    const std::string text = take(name, missing);
    if (text.empty()) return 0;
    const Result<double> si = parse_si(text, dimension);
    if (!si) fail(of_option(name, si.error()));
    return si ? *si : 0;
  }

  std::string shape_;
  std::map<std::string, std::string> sizes_;
  std::vector<std::string> taken_;
  std::optional<Error> failed_;
};

Result<Shape> shape_of(const UnitsOptions& options, const Conventions& conventions, Sizes& sizes) {
  const std::string& name = options.shape;
  if (name == "point") return Shape{PointShape{}};
  if (name == "spot") {
    SpotShape spot;
    spot.outer_rad = sizes.has("opening") ? sizes.angle("opening") / 2 : sizes.angle("outer");
    // Without a falloff only the outer angle means something.
    const bool shaped = conventions.spot_flux == FluxConvention::falloff && conventions.spot_falloff != SpotFalloff::hard;
    spot.inner_rad = shaped || sizes.has("inner") ? sizes.angle("inner") : spot.outer_rad;
    return Shape{spot};
  }
  if (name == "frustum") {
    const double width = sizes.angle("width-angle");
    return Shape{FrustumShape{width, sizes.angle("height-angle")}};
  }
  if (name == "sphere") return Shape{SphereShape{sizes.length("radius")}};
  if (name == "disk") return Shape{DiskShape{sizes.length("radius")}};
  if (name == "rect") {
    const double width = sizes.length("width");
    return Shape{RectShape{width, sizes.length("height")}};
  }
  if (name == "polygon") return Shape{PolygonShape{sizes.points()}};
  if (name == "tube") {
    const double length = sizes.length("length"), radius = sizes.length("radius");
    return Shape{TubeShape{length, radius, sizes.caps()}};
  }
  if (name == "line") return Shape{LineShape{sizes.length("length")}};
  if (name == "mesh") return Shape{MeshShape{}};
  if (name == "distant") return Shape{DistantShape{sizes.angle("angular-diameter")}};
  if (name == "environment") return Shape{EnvironmentShape{}};
  return error("SHAPE_UNKNOWN", fmt::format("--shape: \"{}\" is no shape", name),
               "one of point, spot, frustum, sphere, disk, rect, polygon, tube, line, mesh, distant, environment");
}

Status set_meter(const std::string& text, LightSetup& setup) {
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    const std::string part = text.substr(start, comma - start);
    double* const constant = part.starts_with("K=") ? &setup.meter_k : part.starts_with("C=") ? &setup.meter_c : nullptr;
    // Any unit will do to read a bare number.
    const Result<double> value = constant != nullptr ? parse_si(part.substr(2) + " s", Dimension::duration) : Result<double>(Error{});
    if (!value) return error("USAGE", fmt::format("--meter: expected K=NUMBER and C=NUMBER such as K=12.5,C=250, found \"{}\"", text));
    *constant = *value;
    start = comma + 1;
  }
  return Done{};
}

}  // namespace

std::span<const std::string_view> size_names() { return all_sizes; }

Result<LightSetup> setup_of(const UnitsOptions& options) {
  LightSetup setup;
  setup.conventions.two_sided = options.two_sided;
  if (options.spot_flux == "cone") setup.conventions.spot_flux = FluxConvention::cone;
  if (options.spot_flux == "frostbite_pi") setup.conventions.spot_flux = FluxConvention::frostbite_pi;
  if (options.spot_flux == "isotropic") setup.conventions.spot_flux = FluxConvention::isotropic;
  if (options.spot_falloff == "smoothstep") setup.conventions.spot_falloff = SpotFalloff::smoothstep;
  if (options.spot_falloff == "hard") setup.conventions.spot_falloff = SpotFalloff::hard;
  if (const Status meter = set_meter(options.meter, setup); !meter) return meter.error();

  Sizes sizes(options);
  if (!options.shape.empty()) {
    const Result<Shape> shape = shape_of(options, setup.conventions, sizes);
    if (!shape) return shape.error();
    if (std::holds_alternative<MeshShape>(*shape)) setup.mesh_area_m2 = sizes.area();
    setup.shape = *shape;
  }
  if (const std::optional<Error> wrong = sizes.wrong()) return *wrong;

  if (!options.distance.empty()) {
    const Result<double> distance = parse_si(options.distance, Dimension::length);
    if (!distance) return of_option("distance", distance.error());
    setup.given_distance_m = setup.wanted_distance_m = *distance;
  }
  if (!options.efficacy.empty()) {
    const Result<EfficacyPolicy> policy = efficacy_policy(options.efficacy);
    if (!policy) return of_option("efficacy", policy.error());
    setup.efficacy_lm_W = policy->lm_W;
  }
  return setup;
}

}  // namespace etendue::cli
