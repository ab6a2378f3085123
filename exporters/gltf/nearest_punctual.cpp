#include "nearest_punctual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/eval.h"
#include "etendue/intensity_web.h"
#include "etendue/photometric_quantities.h"
#include "etendue/photometry.h"

namespace etendue::gltf {
namespace {

// A flat surface sends I cos t. The spot whose falloff comes near it: 1 up to an inner angle and from there ((cos t) / (cos inner))^2 to 0
// at 90 degrees. Its flux is 2 pi I (1 - 2/3 cos inner), a surface's is pi I: with cos inner = 3/4 both are the same, and so are their
// intensities along the axis. In between it is up to 1/4 I above (at the inner angle) and 9/64 I below (at cos t = 9/32).
const SpotShape flat_spot{std::acos(0.75), pi / 2};

Transform turned_round(const Transform& t) { return {{-t.columns[0], t.columns[1], -t.columns[2]}, t.translation}; }

class Nearest {
 public:
  Nearest(const Light& light, const Resolved& resolved, const Scene& scene, LossReport& losses)
      : light_(light), resolved_(resolved), scene_(scene), losses_(losses) {
    common_.rgb = resolved.rgb;
    common_.transform = light.transform.rigid();
  }

  void operator()(const PointShape&) { add("point"); }
  void operator()(const SpotShape& spot) {
    SpotShape held = spot;
    // The format's inner angle is below its outer one.
    if (!(held.inner_rad < held.outer_rad)) {
      held.inner_rad = held.outer_rad * (1 - 1e-6);
      lose("an edge without a ramp", "a ramp of a millionth of the cone's angle");
    }
    common_.spot = held;
    add("spot");
  }
  void operator()(const FrustumShape& frustum) {
    // Evenly bright within a solid angle: a cone of the same one.
    const double cosine = 1 - solid_angle_of(frustum) / (2 * pi), outer = std::acos(std::clamp(cosine, 0.0, 1.0));
    common_.spot = SpotShape{outer * (1 - 1e-6), outer};
    lose("its pyramid", fmt::format("a cone of the same flux, {:.2f} degrees from its axis to its edge", outer * 180 / pi));
    add("spot");
  }
  void operator()(const DistantShape& sun) {
    if (sun.diameter_rad > 0)
      lose(fmt::format("a diameter of {:.3f} degrees", sun.diameter_rad * 180 / pi), "one direction: sharp shadows");
    if (resolved_.kind == Resolved::Kind::luminance)
      common_.rgb = common_.rgb * (pi * std::pow(std::sin(sun.diameter_rad / 2), 2));  // luminance times the disk's projected solid angle
    add("directional");
  }
  // From outside a sphere lights a surface that all of it is in front of as a point of the intensity L pi r^2 does.
  void operator()(const SphereShape& sphere) {
    common_.rgb = common_.rgb * (pi * sphere.radius * sphere.radius);
    lose("a sphere", "a point of the same intensity: sharp shadows and no highlight of its size");
    add("point");
  }
  void operator()(const DiskShape& disk) { add_flat("a disk", pi * disk.radius * disk.radius); }
  void operator()(const RectShape& rect) { add_flat("a rectangle", rect.width * rect.height); }
  void operator()(const PolygonShape&) { add_flat("a polygon", resolved_.area_m2 / (light_.two_sided ? 2 : 1)); }
  void operator()(const TubeShape&) { add_by_flux("a tube"); }
  void operator()(const LineShape&) { add_by_flux("a line"); }
  void operator()(const MeshShape& mesh) {
    common_.transform.translation = common_.transform.point(centre_of(scene_.meshes[mesh.mesh]) * mesh.scale);
    add_by_flux("a mesh");
  }
  void operator()(const PhotometricShape& shape) {
    double flux = resolved_.flux_lm;
    if (flux == 0 && shape.distribution) {
      const Result<IntensityWeb> web = IntensityWeb::of(*shape.distribution);
      if (web) flux = luminance_of(resolved_.rgb) * (shape.cone ? within(*web, *shape.cone) : web->flux_lm());
    }
    if (flux == 0) return lose("a photometric file", "left out: nothing says its flux");
    common_.rgb = of_flux(flux);
    lose("a photometric file", "a point of the same flux, the same to all sides");
    add("point");
  }
  void operator()(const EnvironmentShape&) { lose("an environment", "left out: the format has none"); }

  std::vector<Punctual> found() && { return std::move(found_); }

 private:
  void lose(const std::string& what, const std::string& effect) { losses_.add(fmt::format("light '{}': {}", light_.name, what), effect); }
  Rgb of_flux(double flux_lm) const {
    const double luminance = luminance_of(resolved_.rgb);
    return luminance > 0 ? resolved_.rgb * (flux_lm / (4 * pi) / luminance) : Rgb{0, 0, 0};
  }

  static double within(const IntensityWeb& web, const SpotShape& cone) {
    return flux_through_cone(web, cone.inner_rad * 180 / pi, cone.outer_rad * 180 / pi);
  }

  void add_by_flux(const char* what) {
    common_.rgb = of_flux(resolved_.flux_lm);
    lose(what, "a point of the same flux, the same to all sides");
    add("point");
  }
  void add_flat(const char* what, double area) {
    common_.rgb = common_.rgb * area;
    common_.spot = flat_spot;
    lose(fmt::format("{}{}", what, light_.two_sided ? " that emits to both sides" : ""),
         fmt::format(
             "{} of the same flux and intensity along the axis; in between up to 25 % of that brighter or 14 % darker, and sharp shadows",
             light_.two_sided ? "two spots" : "a spot"));
    if (light_.emission.texture) lose("its texture", "the spot has one colour for all directions");
    add("spot");
    if (!light_.two_sided) return;
    common_.transform = turned_round(common_.transform);
    add("spot");
  }

  void add(const char* type) {
    common_.type = type;
    if (!std::holds_alternative<DistantShape>(light_.shape)) add_range();
    // Negative channels are of colours out of Rec.709: what is left keeps the luminance.
    Rgb& rgb = common_.rgb;
    if (const double before = luminance_of(rgb); std::min({rgb.x, rgb.y, rgb.z}) < 0) {
      for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0);
      const double after = luminance_of(rgb);
      rgb = after > 0 ? rgb * (std::max(before, 0.0) / after) : Rgb{0, 0, 0};
      if (found_.empty()) lose("a colour outside Rec.709", "the nearest one inside, as bright");
    }
    found_.push_back(common_);
  }

  // The format's window is (1 - (d / range)^4) / d^2.
  void add_range() {
    const Falloff& falloff = light_.falloff;
    if (falloff.law == Falloff::Law::inverse_square) return;
    common_.range_m = light_.range_m;
    if (falloff == Falloff::gltf || !found_.empty()) return;
    const eval::Window window{falloff, light_.range_m.value_or(0)};
    const double at_m = light_.range_m ? *light_.range_m / 2 : 1, ours = eval::window_at(window, at_m);
    const double theirs = light_.range_m ? 1 - 1.0 / 16 : 1;
    lose(fmt::format("the falloff '{}'", name_of(falloff)),
         fmt::format("the format's own: {:+.1f} % at {} m", 100 * (theirs / ours - 1), at_m));
  }

  // Of its surface.
  static Vec3d centre_of(const Mesh& mesh) {
    Vec3d sum{0, 0, 0};
    double area = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Vec3d p[3];
      for (std::size_t c = 0; c < 3; ++c) p[c] = vec_cast<double>(mesh.positions[mesh.indices[i + c]]);
      const double twice = length(cross(p[1] - p[0], p[2] - p[0]));
      sum += (p[0] + p[1] + p[2]) * (twice / 3);
      area += twice;
    }
    return area > 0 ? sum / area : sum;
  }

  const Light& light_;
  const Resolved& resolved_;
  const Scene& scene_;
  LossReport& losses_;
  Punctual common_;
  std::vector<Punctual> found_;
};

}  // namespace

std::vector<Punctual> nearest_punctual(const Light& light, const Resolved& resolved, const Scene& scene, LossReport& losses) {
  Nearest nearest(light, resolved, scene, losses);
  std::visit(nearest, light.shape);
  return std::move(nearest).found();
}

}  // namespace etendue::gltf
