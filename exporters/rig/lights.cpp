#include "writer.h"

#include <fmt/format.h>

#include <set>

namespace etendue::rig {
namespace {

const char* name_of(Caps caps) { return caps == Caps::round ? "round" : caps == Caps::flat ? "flat" : "none"; }
const char* name_of(Wrap wrap) { return wrap == Wrap::repeat ? "repeat" : wrap == Wrap::mirror ? "mirror" : "clamp"; }
const char* name_of(FluxConvention convention) {
  switch (convention) {
    case FluxConvention::falloff:
      return "falloff";
    case FluxConvention::cone:
      return "cone";
    case FluxConvention::frostbite_pi:
      return "frostbite_pi";
    case FluxConvention::isotropic:
      break;
  }
  return "isotropic";
}

// Whether the name alone does not say it.
bool has_exponent(const Falloff& falloff) {
  return falloff.law == Falloff::Law::power ? falloff != Falloff::linear && falloff != Falloff::gltf
                                            : falloff.law == Falloff::Law::power_squared && falloff != Falloff::frostbite;
}

struct Unit {
  const char* key;
  Dimension dimension;
};
Unit unit_of(const Emission& e) {
  switch (e.given) {
    case Emission::Given::flux:
      return e.radiant ? Unit{"radiant_flux", Dimension::radiant_flux} : Unit{"flux", Dimension::luminous_flux};
    case Emission::Given::intensity:
      return e.radiant ? Unit{"radiant_intensity", Dimension::radiant_intensity} : Unit{"intensity", Dimension::luminous_intensity};
    case Emission::Given::luminance:
      return e.radiant ? Unit{"radiance", Dimension::radiance} : Unit{"luminance", Dimension::luminance};
    case Emission::Given::illuminance:
      return e.radiant ? Unit{"irradiance", Dimension::irradiance} : Unit{"illuminance", Dimension::illuminance};
    case Emission::Given::ev:
    case Emission::Given::as_file:
      break;
  }
  return {"ev", Dimension::exposure_value};
}

struct WriteShape {
  Writer& writer;
  JsonWriter& json = writer.json;

  Status operator()(const PointShape&) const { return Done{}; }
  Status operator()(const SpotShape& s) const {
    if (s.inner_rad != 0) json.member("inner", angle_text(s.inner_rad));
    json.member("outer", angle_text(s.outer_rad));
    return Done{};
  }
  Status operator()(const FrustumShape& s) const {
    json.member("width_angle", angle_text(s.width_rad));
    json.member("height_angle", angle_text(s.height_rad));
    return Done{};
  }
  Status operator()(const DistantShape& s) const {
    if (s.diameter_rad != 0) json.member("angular_diameter", angle_text(s.diameter_rad));
    return Done{};
  }
  Status operator()(const SphereShape& s) const { return length("radius", s.radius); }
  Status operator()(const DiskShape& s) const { return length("radius", s.radius); }
  Status operator()(const RectShape& s) const {
    json.member("width", length_text(s.width));
    return length("height", s.height);
  }
  Status operator()(const PolygonShape& s) const {
    json.key("points");
    json.begin_array();
    for (const Vec2d& p : s.points) {
      json.begin_array();
      json.value(p.x);
      json.value(p.y);
      json.end_array();
    }
    json.end_array();
    return Done{};
  }
  Status operator()(const TubeShape& s) const {
    json.member("length", length_text(s.length));
    json.member("radius", length_text(s.radius));
    if (s.caps != Caps::round) json.member("caps", name_of(s.caps));
    return Done{};
  }
  Status operator()(const LineShape& s) const { return length("length", s.length); }
  Status operator()(const MeshShape& s) const {
    json.member("mesh", *writer.mesh_index[s.mesh]);
    write_scale(json, s.scale);
    return Done{};
  }
  Status operator()(const PhotometricShape& s) const {
    if (s.cone) {
      json.key("cone");
      json.begin_object();
      static_cast<void>((*this)(*s.cone));
      json.end_object();
    }
    return file(place_photometry(writer, s));
  }
  Status operator()(const EnvironmentShape& s) const { return s.image ? file(place_image(writer, *s.image)) : Status(Done{}); }

 private:
  Status length(const char* key, double metres) const {
    json.member(key, length_text(metres));
    return Done{};
  }
  Status file(const Result<std::string>& name) const {
    if (!name) return name.error();
    json.member("file", *name);
    return Done{};
  }
};

// Everything said: what a texture defaults to depends on the name of its file, which may change on the way.
Status write_texture(Writer& writer, const Texture& texture) {
  const Result<std::string> file = place_image(writer, texture.image);
  if (!file) return file.error();
  JsonWriter& json = writer.json;
  json.begin_object();
  json.member("file", *file);
  json.member("encoding", texture.encoding == Encoding::linear ? "linear" : "srgb");
  if (texture.wrap_u != Wrap::repeat || texture.wrap_v != Wrap::repeat) {
    json.key("wrap");
    json.begin_array();
    json.value(name_of(texture.wrap_u));
    json.value(name_of(texture.wrap_v));
    json.end_array();
  }
  if (texture.nearest) json.member("nearest", true);
  const auto& m = texture.uv_transform;
  if (m[0][0] != 1 || m[0][1] != 0 || m[0][2] != 0 || m[1][0] != 0 || m[1][1] != 1 || m[1][2] != 0) {
    json.key("uv_transform");
    json.begin_array();
    for (const auto& row : m)
      for (const double x : row) json.value(x);
    json.end_array();
  }
  if (texture.uv_set != 0) json.member("uv_set", static_cast<std::uint32_t>(texture.uv_set));
  json.end_object();
  return Done{};
}

bool carries_texture(const Scene& scene, const Shape& shape) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return !scene.meshes[mesh->mesh].uvs.empty();
  return std::holds_alternative<RectShape>(shape) || std::holds_alternative<DiskShape>(shape) ||
         std::holds_alternative<PolygonShape>(shape);
}

Status write_emission(Writer& writer, const Light& light) {
  const Emission& emission = light.emission;
  const bool as_file = emission.given == Emission::Given::as_file;
  const bool textured = emission.texture && carries_texture(writer.scene, light.shape);
  if (emission.texture && !textured) {
    writer.losses.add(fmt::format("light \"{}\": its texture", light.name), "the shape has no texture coordinates: it emits evenly");
  }
  if (as_file && !emission.efficacy_lm_W && !emission.distance_m && !textured) return Done{};
  JsonWriter& json = writer.json;
  json.key("emission");
  json.begin_object();
  if (!as_file) {
    const Unit unit = unit_of(emission);
    json.member(unit.key, to_string(AnyQuantity{unit.dimension, emission.value}));
  }
  if (emission.efficacy_lm_W) json.member("efficacy", to_string(AnyQuantity{Dimension::efficacy, *emission.efficacy_lm_W}));
  if (emission.distance_m) json.member("distance", length_text(*emission.distance_m));
  if (textured) {
    json.key("texture");
    const Status texture = write_texture(writer, *emission.texture);
    if (!texture) return texture.error();
  }
  json.end_object();
  return Done{};
}

void write_colour(JsonWriter& json, const LightColour& colour) {
  const auto* rgb = std::get_if<RgbColour>(&colour);
  if (rgb && rgb->rgb == Rgb{1, 1, 1}) return;
  json.key("colour");
  json.begin_object();
  if (rgb) {
    json.key("rgb");
    write_vec3(json, rgb->rgb);
  } else if (const auto* planckian = std::get_if<TemperatureColour>(&colour)) {
    json.member("temperature", to_string(AnyQuantity{Dimension::temperature, planckian->kelvin}));
  } else {
    json.member("daylight", to_string(AnyQuantity{Dimension::temperature, std::get<DaylightColour>(colour).kelvin}));
  }
  json.end_object();
}

Status write_light(Writer& writer, const Light& light) {
  JsonWriter& json = writer.json;
  json.begin_object(JsonWriter::Style::one_item_a_line);
  if (!light.name.empty()) json.member("name", light.name);
  json.key("shape");
  json.begin_object();
  json.member("type", etendue::name_of(light.shape));
  const Status shape = std::visit(WriteShape{writer}, light.shape);
  if (!shape) return shape.error();
  json.end_object();
  const Status emission = write_emission(writer, light);
  if (!emission) return emission.error();
  write_colour(json, light.colour);
  if (!(light.filter == Rgb{1, 1, 1})) {
    json.key("filter");
    write_vec3(json, light.filter);
  }
  if (light.two_sided) json.member("two_sided", true);
  if (!light.visible) json.member("visible", false);
  if (light.range_m) json.member("range", length_text(*light.range_m));
  if (light.falloff.law != Falloff::Law::inverse_square) json.member("falloff", etendue::name_of(light.falloff));
  if (has_exponent(light.falloff)) json.member("falloff_exponent", light.falloff.exponent);
  if (light.flux_convention != FluxConvention::falloff) json.member("flux_convention", name_of(light.flux_convention));
  if (light.surface_material) write_material_reference(writer, "surface_material", *light.surface_material);
  write_transform(json, light.transform, false);
  json.end_object();
  return Done{};
}

}  // namespace

Status write_lights(Writer& writer) {
  std::set<std::string> names;
  writer.json.key("lights");
  writer.json.begin_array(JsonWriter::Style::one_item_a_line);
  for (const Light& light : writer.scene.lights) {
    const auto* mesh = std::get_if<MeshShape>(&light.shape);
    if (mesh && !writer.mesh_index[mesh->mesh]) {
      writer.losses.add(fmt::format("light \"{}\"", light.name), "left out: a rig file does not hold its mesh");
      continue;
    }
    if (const auto* sky = std::get_if<EnvironmentShape>(&light.shape); sky && !sky->cube.empty()) {
      writer.losses.add(fmt::format("light \"{}\"", light.name), "left out: a rig file holds no environment in the form of a cube");
      continue;
    }
    if (!names.insert(light.name).second)
      writer.losses.add(fmt::format("light \"{}\": its name", light.name), "another light has it; reading puts a number behind it");
    const Status written = write_light(writer, light);
    if (!written) return written.error();
  }
  writer.json.end_array();
  return Done{};
}

}  // namespace etendue::rig
