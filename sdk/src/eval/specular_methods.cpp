// The list of the specular methods, source by source.
#include "etendue/specular_methods.h"

#include "karis.h"
#include "specular_line.h"
#include "specular_moments.h"
#include "specular_view.h"

#include <algorithm>
#include <vector>

namespace etendue::eval {
namespace {

std::optional<Rgb> moments(const Emitter& emitter, const ShadingPoint& point) {
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  if (const LineEmitter* line = lobe ? plain_line(emitter) : nullptr) return line->intensity * line_by_moments(*line, point, *lobe);
  if (!lobe || !is_uniform_area_light(emitter)) return std::nullopt;
  return luminance_of(emitter) * by_moments(emitter, point, *lobe);
}

// A small light at the centre; of a tube with the intensity across its axis, whatever its tilt.
Rgb at_centre(const LobeView& lobe, const Vec3d& centre, double intensity) { return lobe(centre) * (intensity / dot(centre, centre)); }
template <class Flat>
Rgb flat_point(const Flat& light, const LobeView& lobe) {
  return at_centre(lobe, light.centre, light.area() * light.height() / length(light.centre));
}
Rgb round_point(const SphereView& sphere, const LobeView& lobe) {
  return at_centre(lobe, sphere.centre, pi * sphere.radius * sphere.radius);
}
Rgb tube_point(const TubeView& tube, const LobeView& lobe) { return at_centre(lobe, (tube.a + tube.b) * 0.5, intensity_across(tube)); }
constexpr SpecularRules point_rules{.rect = flat_point<RectView>,
                                    .disk = flat_point<DiskView>,
                                    .sphere = round_point,
                                    .tube = tube_point,
                                    .sun = round_point,
                                    .lobes = Lobes::every};
constexpr SpecularMethod baseline[] = {
    {"punctual", "none", "A point of the same intensity at the light's centre: what area lights are to be better than.",
     published<point_rules>},
};

constexpr SpecularMethod ours[] = {
    {"moments", "Etendue",
     "Exact but for the slow factor of the lobe, which is taken at four places, and for outlines in pieces; no table. Of a line the lobe "
     "itself at some "
     "dozen places.",
     moments},
};

}  // namespace

std::span<const SpecularMethod> specular_methods() {
  static const std::vector<SpecularMethod> all = [] {
    std::vector<SpecularMethod> methods;
    for (const std::span<const SpecularMethod> part :
         {std::span<const SpecularMethod>(baseline), frostbite_specular_methods(), drobot_specular_methods(), karis_specular_methods(),
          eden_specular_methods(), hill_heitz_specular_methods(), ltc_methods(), covered_specular_methods(),
          std::span<const SpecularMethod>(ours)})
      methods.insert(methods.end(), part.begin(), part.end());
    return methods;
  }();
  return all;
}

const SpecularMethod* find_specular_method(std::string_view name) {
  const auto all = specular_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SpecularMethod& m) { return m.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace etendue::eval
