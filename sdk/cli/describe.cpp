#include "describe.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "etendue/camera.h"
#include "etendue/intensity_web.h"
#include "etendue/photometric_quantities.h"

namespace etendue::cli {
namespace {

double in_degrees(double radians_) { return degrees.of({radians_}); }

// Shortest text of at most six significant digits.
std::string number(double x) { return fmt::format("{:.6g}", x); }

std::string describe_shape(const Shape& shape) {
  struct {
    std::string operator()(const PointShape&) { return ""; }
    std::string operator()(const SpotShape& s) {
      return fmt::format(" {}/{} deg", number(in_degrees(s.inner_rad)), number(in_degrees(s.outer_rad)));
    }
    std::string operator()(const FrustumShape& s) {
      return fmt::format(" {} x {} deg", number(in_degrees(s.width_rad)), number(in_degrees(s.height_rad)));
    }
    std::string operator()(const DistantShape& s) {
      return s.diameter_rad > 0 ? fmt::format(" {} deg", number(in_degrees(s.diameter_rad))) : "";
    }
    std::string operator()(const SphereShape& s) { return fmt::format(" radius {} m", number(s.radius)); }
    std::string operator()(const DiskShape& s) { return fmt::format(" radius {} m", number(s.radius)); }
    std::string operator()(const RectShape& s) { return fmt::format(" {} m x {} m", number(s.width), number(s.height)); }
    std::string operator()(const PolygonShape& s) { return fmt::format(" of {} points", s.points.size()); }
    std::string operator()(const TubeShape& s) { return fmt::format(" {} m, radius {} m", number(s.length), number(s.radius)); }
    std::string operator()(const LineShape& s) { return fmt::format(" {} m", number(s.length)); }
    std::string operator()(const MeshShape&) { return ""; }
    std::string operator()(const PhotometricShape& s) {
      return (s.embedded ? " embedded" : " " + s.file) + (s.cone ? " through a cone of" + (*this)(*s.cone) : "");
    }
    std::string operator()(const EnvironmentShape& s) { return s.image ? " map" : !s.cube.empty() ? " cube" : " constant"; }
  } text;
  return name_of(shape) + std::visit(text, shape);
}

// The authored unit of an emission, for texts and for JSON keys.
struct GivenUnit {
  const char* text;
  const char* key;
};
GivenUnit unit_of(const Emission& emission) {
  using Given = Emission::Given;
  switch (emission.given) {
    case Given::flux:
      return emission.radiant ? GivenUnit{"W", "radiant_flux_W"} : GivenUnit{"lm", "flux_lm"};
    case Given::intensity:
      return emission.radiant ? GivenUnit{"W/sr", "radiant_intensity_W_sr"} : GivenUnit{"cd", "intensity_cd"};
    case Given::luminance:
      return emission.radiant ? GivenUnit{"W/m2/sr", "radiance_W_m2_sr"} : GivenUnit{"cd/m2", "luminance_cd_m2"};
    case Given::illuminance:
      return emission.radiant ? GivenUnit{"W/m2", "irradiance_W_m2"} : GivenUnit{"lx", "illuminance_lx"};
    case Given::ev:
      return {"EV", "ev100"};
    case Given::as_file:
      break;
  }
  return {"", ""};
}

std::string describe_colour(const LightColour& colour) {
  if (const auto* const rgb = std::get_if<RgbColour>(&colour)) {
    return rgb->rgb == Rgb{1, 1, 1} ? "" : fmt::format(", rgb {} {} {}", number(rgb->rgb.x), number(rgb->rgb.y), number(rgb->rgb.z));
  }
  if (const auto* const planck = std::get_if<TemperatureColour>(&colour)) return fmt::format(", {} K", number(planck->kelvin));
  return fmt::format(", daylight {} K", number(std::get<DaylightColour>(colour).kelvin));
}

const char* model_name(const SurfaceModel& model) {
  static constexpr const char* names[] = {"lambert", "principled", "standard", "conductor", "metal-rough", "specular-glossiness"};
  return names[model.index()];
}

// The factors of a model, as authored.
using Parameters = std::vector<std::pair<const char*, std::variant<Rgb, double>>>;
struct ParametersOf {
  Parameters operator()(const Lambert& m) const { return {{"base_colour", m.base_colour}}; }
  Parameters operator()(const Principled& m) const {
    return {{"base_colour", m.base_colour}, {"metallic", m.metallic}, {"roughness", m.roughness}, {"specular", m.specular}};
  }
  Parameters operator()(const Standard& m) const {
    return {{"base_colour", m.base_colour}, {"metal", m.metal}, {"roughness", m.roughness}, {"reflectance", m.reflectance}};
  }
  Parameters operator()(const Conductor& m) const { return {{"eta", m.eta}, {"k", m.k}, {"alpha", m.alpha}}; }
  Parameters operator()(const MetalRough& m) const {
    Parameters all = {{"base_colour", m.base_colour}, {"metallic", m.metallic}, {"roughness", m.roughness}};
    if (m.ior != MetalRough{}.ior) all.emplace_back("ior", m.ior);
    return all;
  }
  Parameters operator()(const SpecularGlossiness& m) const {
    return {{"diffuse", m.diffuse}, {"specular", m.specular}, {"glossiness", m.glossiness}};
  }
};

std::string rgb_text(const Rgb& rgb) {
  if (rgb.x == rgb.y && rgb.y == rgb.z) return number(rgb.x);
  return fmt::format("{} {} {}", number(rgb.x), number(rgb.y), number(rgb.z));
}

// What a photometric file emits as it is, before colour, filter and a stated flux.
std::string web_text(const PhotometricShape& shape) {
  const Result<IntensityWeb> web = shape.distribution ? IntensityWeb::of(*shape.distribution) : Result<IntensityWeb>(Error{});
  if (!web) return "";
  if (!shape.cone) return fmt::format("  up to {:.6g} cd, {:.6g} lm", web->max_cd(), web->flux_lm());
  const double passed = flux_through_cone(*web, in_degrees(shape.cone->inner_rad), in_degrees(shape.cone->outer_rad));
  return fmt::format("  up to {:.6g} cd, {:.6g} lm, {:.6g} lm through its cone", web->max_cd(), web->flux_lm(), passed);
}

std::string image_name(const Scene& scene, const Texture& texture) {
  if (texture.image >= scene.images.size()) return "?";
  const ImageRef& image = scene.images[texture.image];
  return image.name.empty() ? image.file : image.name;
}

}  // namespace

Json to_json(const Vec3d& v) { return Json::array({v.x, v.y, v.z}); }

std::string describe(const Light& light) {
  std::string text = describe_shape(light.shape);
  if (light.emission.given != Emission::Given::as_file)
    text += fmt::format(", {} {}", number(light.emission.value), unit_of(light.emission).text);
  text += describe_colour(light.colour);
  if (light.filter != Rgb{1, 1, 1}) text += fmt::format(", filter {}", rgb_text(light.filter));
  if (light.two_sided) text += ", two-sided";
  if (light.range_m) text += fmt::format(", range {} m", number(*light.range_m));
  if (light.falloff != Falloff::inverse_square) text += fmt::format(", falloff {}", name_of(light.falloff));
  return text;
}

std::string resolved_text(const Scene& scene, const Light& light) {
  if (const auto* photometric = std::get_if<PhotometricShape>(&light.shape)) return web_text(*photometric);
  const Result<Resolved> resolved = resolve(light, mesh_area_of(scene, light));
  if (!resolved) return "";
  static constexpr const char* units[] = {"cd", "cd/m2", "lx", "cd"};
  const double y = luminance_of(resolved->rgb);
  std::string text = fmt::format("  = {} {}", number(y), units[static_cast<int>(resolved->kind)]);
  if (resolved->flux_lm > 0) text += fmt::format(", {} lm", number(resolved->flux_lm));
  // A reflected-light meter's reading of the surface; an incident-light meter's where the light is stated as what arrives.
  if (resolved->kind == Resolved::Kind::luminance && y > 0) text += fmt::format(", EV {:.4g}", ev100_of_luminance(y));
  if (const auto incident = ev100_of_illuminance(y, {}); resolved->kind == Resolved::Kind::illuminance && incident)
    text += fmt::format(", EV {:.4g} incident", *incident);
  return text;
}

Json to_json(const Scene& scene, const Light& light) {
  Json json = {{"name", light.name}, {"shape", name_of(light.shape)}, {"description", describe(light)}};
  if (light.emission.given != Emission::Given::as_file) json["authored"] = {{unit_of(light.emission).key, light.emission.value}};
  const Result<Resolved> resolved = resolve(light, mesh_area_of(scene, light));
  if (resolved) {
    static constexpr const char* keys[] = {"intensity_cd", "luminance_cd_m2", "illuminance_lx", "perpendicular_intensity_cd"};
    const double y = luminance_of(resolved->rgb);
    json[keys[static_cast<int>(resolved->kind)]] = y;
    json["rgb"] = to_json(resolved->rgb);
    if (resolved->flux_lm > 0) json["flux_lm"] = resolved->flux_lm;
    if (resolved->area_m2 > 0) json["area_m2"] = resolved->area_m2;
    if (resolved->kind == Resolved::Kind::luminance && y > 0) json["ev100"] = ev100_of_luminance(y);
  }
  if (light.range_m) json["range_m"] = *light.range_m;
  if (light.falloff != Falloff::inverse_square) json["falloff"] = name_of(light.falloff);
  json["position"] = to_json(light.transform.translation);
  json["direction"] = to_json(-light.transform.columns[2]);
  if (!light.source.empty()) json["pointer"] = light.source;
  return json;
}

std::string describe(const Scene& scene, const Material& material) {
  std::string text = model_name(material.model);
  for (const auto& [name, value] : std::visit(ParametersOf{}, material.model)) {
    const auto* rgb = std::get_if<Rgb>(&value);
    text += fmt::format(", {} {}", name, rgb != nullptr ? rgb_text(*rgb) : number(std::get<double>(value)));
  }
  if (const double emitted = luminance_of(material.emissive); emitted > 0) text += fmt::format(", emits {} cd/m2", number(emitted));
  if (material.alpha_cutoff) text += fmt::format(", holes where alpha < {}", number(*material.alpha_cutoff));
  if (material.blended) text += ", blended";
  for (const Unshown& unshown : unshown_of(material)) text += fmt::format(", {}", unshown.what);
  for_each_texture(material,
                   [&](const char* role, const Texture& texture) { text += fmt::format(", {} {}", role, image_name(scene, texture)); });
  if (material.double_sided) text += ", double-sided";
  return text;
}

Json to_json(const Scene& scene, const Material& material) {
  Json json = {{"name", material.name}, {"model", model_name(material.model)}, {"double_sided", material.double_sided}};
  for (const auto& [name, value] : std::visit(ParametersOf{}, material.model)) {
    const auto* rgb = std::get_if<Rgb>(&value);
    json["parameters"][name] = rgb != nullptr ? to_json(*rgb) : Json(std::get<double>(value));
  }
  for (const Unshown& unshown : unshown_of(material)) json["not_in_pictures"].push_back(unshown.what);
  if (const double emitted = luminance_of(material.emissive); emitted > 0) json["luminance_cd_m2"] = emitted;
  if (material.alpha_cutoff) json["alpha_cutoff"] = *material.alpha_cutoff;
  if (material.blended) json["blended"] = true;
  for_each_texture(material, [&](const char* role, const Texture& texture) {
    json["textures"][role] = {{"image", image_name(scene, texture)}, {"encoding", texture.encoding == Encoding::srgb ? "srgb" : "linear"}};
  });
  if (!material.source.empty()) json["pointer"] = material.source;
  return json;
}

std::string describe(const Camera& camera) {
  std::string text = fmt::format("{:.4g} deg high", in_degrees(camera.vfov_rad));
  if (camera.aspect > 0) text += fmt::format(", aspect {:.4g}", camera.aspect);
  if (camera.ev100) text += fmt::format(", EV {}", number(*camera.ev100));
  if (camera.near_m) text += fmt::format(", near {} m", number(*camera.near_m));
  if (camera.far_m) text += fmt::format(", far {} m", number(*camera.far_m));
  return text;
}

Json to_json(const Camera& camera) {
  Json json = {{"name", camera.name},
               {"position", to_json(camera.transform.translation)},
               {"direction", to_json(-camera.transform.columns[2])},
               {"vfov_deg", in_degrees(camera.vfov_rad)}};
  if (camera.ev100) json["ev100"] = *camera.ev100;
  if (camera.aspect > 0) json["aspect"] = camera.aspect;
  if (camera.near_m) json["near_m"] = *camera.near_m;
  if (camera.far_m) json["far_m"] = *camera.far_m;
  if (!camera.source.empty()) json["pointer"] = camera.source;
  return json;
}

}  // namespace etendue::cli
