#include "reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace etendue::rig {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

template <class T>
bool is(const Shape& shape) {
  return std::holds_alternative<T>(shape);
}

// What a key of "emission" gives, and in which unit.
struct Unit {
  std::string_view key;
  Emission::Given given;
  Dimension dimension;
  bool radiant;
};
constexpr Unit emission_units[] = {
    {"flux", Emission::Given::flux, Dimension::luminous_flux, false},
    {"intensity", Emission::Given::intensity, Dimension::luminous_intensity, false},
    {"luminance", Emission::Given::luminance, Dimension::luminance, false},
    {"illuminance", Emission::Given::illuminance, Dimension::illuminance, false},
    {"ev", Emission::Given::ev, Dimension::exposure_value, false},
    {"radiant_flux", Emission::Given::flux, Dimension::radiant_flux, true},
    {"radiant_intensity", Emission::Given::intensity, Dimension::radiant_intensity, true},
    {"radiance", Emission::Given::luminance, Dimension::radiance, true},
    {"irradiance", Emission::Given::illuminance, Dimension::irradiance, true},
};

// A file says how much it emits; any other light must.
bool brings_its_own(const Shape& shape) {
  const auto* environment = std::get_if<EnvironmentShape>(&shape);
  return is<PhotometricShape>(shape) || (environment && environment->image);
}

bool carries_texture(const Scene& scene, const Shape& shape) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->mesh < scene.meshes.size() && !scene.meshes[mesh->mesh].uvs.empty();
  return is<RectShape>(shape) || is<DiskShape>(shape) || is<PolygonShape>(shape);
}

LightColour read_colour(Reader& reader, JsonValue value) {
  if (!value) return RgbColour{};
  Diagnostics& d = reader.diagnostics;
  Fields fields(value, d);
  const JsonValue given = fields.one_of({"rgb", "temperature", "daylight"});
  fields.finish();
  if (fields.valid() && !given) fail(d, value, "KEY_MISSING", "expected one of \"rgb\", \"temperature\", \"daylight\"");
  if (!given) return RgbColour{};
  LightColour colour;
  if (given.key() == "rgb") {
    const std::optional<Vec3d> rgb = read_vec3(given, -unlimited, unlimited, d);
    if (rgb && !(luminance_of(*rgb) > 0 && luminance_of(*rgb) <= unlimited)) {
      fail(d, given, "VALUE_OUT_OF_RANGE", "expected a colour whose luminance .2126 r + .7152 g + .0722 b is above zero");
      return RgbColour{};
    }
    return RgbColour{rgb.value_or(Vec3d{1, 1, 1})};
  }
  const std::optional<double> kelvin = read_quantity(given, Dimension::temperature, Bound::positive, d);
  if (!kelvin) return RgbColour{};
  if (given.key() == "temperature") {
    colour = TemperatureColour{*kelvin};
  } else {
    colour = DaylightColour{*kelvin};
  }
  const Result<Rgb> rgb = rgb_of(colour);
  if (!rgb) fail(d, given, rgb.error().code, rgb.error().text, rgb.error().hint);
  return colour;
}

std::string read_name(Reader& reader, JsonValue value, const Shape& shape) {
  const std::string wanted = read_string(value, reader.diagnostics).value_or("");
  std::string name = unique_light_name(reader, wanted.empty() ? name_of(shape) : wanted);
  if (!wanted.empty() && name != wanted) {
    warn(reader.diagnostics, value, "NAME_DUPLICATE", fmt::format("another light is named \"{}\"; this one is now \"{}\"", wanted, name));
  }
  return name;
}

// Keys that are right but say nothing about this light.
void warn_without_effect(Reader& reader, const Light& light, JsonValue convention, JsonValue range, JsonValue falloff) {
  Diagnostics& d = reader.diagnostics;
  const Shape& s = light.shape;
  if (convention && !is<SpotShape>(s)) warn(d, convention, "KEY_WITHOUT_EFFECT", "only the flux of a spot depends on a convention");
  const Falloff::Law law = light.falloff.law;
  if (range && law == Falloff::Law::inverse_square)
    warn(d, range, "KEY_WITHOUT_EFFECT", "the falloff \"inverse_square\" has no end; \"range\" needs another \"falloff\"");
  if (falloff && law != Falloff::Law::inverse_square && law != Falloff::Law::karis && !light.range_m)
    warn(d, falloff, "KEY_WITHOUT_EFFECT", "without \"range\" the falloff is that of the inverse square");
}

Falloff read_falloff(JsonValue value, JsonValue exponent, Diagnostics& d) {
  Falloff falloff = read_choice<Falloff>(value,
                                         {{"inverse_square", Falloff::inverse_square},
                                          {"linear", Falloff::linear},
                                          {"gltf", Falloff::gltf},
                                          {"power", {Falloff::Law::power}},
                                          {"frostbite", Falloff::frostbite},
                                          {"smoothstep", Falloff::smoothstep},
                                          {"scale_bias", Falloff::scale_bias},
                                          {"karis", Falloff::karis}},
                                         d)
                        .value_or(Falloff{});
  const std::string_view name = value.is(JsonKind::string) ? value.string() : std::string_view();
  if (name == "power" && !exponent) {
    fail(d, value, "KEY_MISSING", "expected the key \"falloff_exponent\" beside \"power\": n of 1 - (d/r)^n");
  } else if (exponent && name != "power" && name != "frostbite") {
    warn(d, exponent, "KEY_WITHOUT_EFFECT", "the exponent is that of \"power\" and \"frostbite\"");
  } else {
    falloff.exponent = read_number(exponent, Falloff::least_exponent, Falloff::most_exponent, d).value_or(falloff.exponent);
  }
  return falloff;
}

// Units that do not fit the shape, sizes that are missing: what resolve() refuses is told where it stands.
void check_resolvable(Reader& reader, const Light& light, JsonValue at) {
  if (is<PhotometricShape>(light.shape)) return;  // needs the photometric file
  const Result<Resolved> resolved = resolve(light, mesh_area_of(reader.scene, light));
  if (!resolved) fail(reader.diagnostics, at, resolved.error().code, resolved.error().text, resolved.error().hint);
}

bool has_error_since(const Reader& reader, std::size_t first) {
  const std::vector<Diagnostic>& all = reader.diagnostics.all();
  return std::any_of(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::error; });
}

void read_light(Reader& reader, JsonValue value) {
  Diagnostics& d = reader.diagnostics;
  const std::size_t told_before = d.all().size();
  Fields fields(value, d);
  const JsonValue name = fields.find("name");
  Light light;
  const std::optional<Shape> shape = read_shape(reader, fields.require("shape"));
  light.shape = shape.value_or(PointShape{});
  light.name = read_name(reader, name, light.shape);
  const JsonValue emission = fields.find("emission");
  light.emission = read_emission(reader, emission, light.shape);
  if (shape && !emission && !brings_its_own(light.shape)) {
    fail(d, value, "EMISSION_MISSING", fmt::format("expected the key \"emission\": what the {} emits", name_of(light.shape)));
  }
  light.colour = read_colour(reader, fields.find("colour"));
  light.filter = read_vec3(fields.find("filter"), 0, unlimited, d).value_or(Rgb{1, 1, 1});
  light.two_sided = read_boolean(fields.find("two_sided"), d).value_or(false);
  light.visible = read_boolean(fields.find("visible"), d).value_or(true);
  const JsonValue range = fields.find("range");
  light.range_m = read_length(range, Bound::positive, d);
  const JsonValue falloff = fields.find("falloff");
  light.falloff = read_falloff(falloff, fields.find("falloff_exponent"), d);
  if (light.falloff.law == Falloff::Law::scale_bias && light.range_m && *light.range_m <= 1)
    fail(d, range, "VALUE_OUT_OF_RANGE",
         fmt::format("expected a range above 1 m with the falloff \"scale_bias\", found {} m", *light.range_m));
  const JsonValue convention = fields.find("flux_convention");
  light.flux_convention = read_choice<FluxConvention>(convention,
                                                      {{"falloff", FluxConvention::falloff},
                                                       {"cone", FluxConvention::cone},
                                                       {"frostbite_pi", FluxConvention::frostbite_pi},
                                                       {"isotropic", FluxConvention::isotropic}},
                                                      d)
                              .value_or(FluxConvention::falloff);
  const JsonValue material = fields.find("surface_material");
  if (has(reader.options.need, Need::materials))
    light.surface_material = read_reference(reader, material, reader.material_names, "material");
  if (material && shape && !is<MeshShape>(*shape))
    fail(d, material, "VALUE_UNSUITABLE", "expected a mesh light: only its surface reflects");
  light.transform = read_transform(fields, false, d);
  light.source = value.pointer();
  fields.finish();
  if (!has_error_since(reader, told_before)) {
    warn_without_effect(reader, light, convention, range, falloff);
    check_resolvable(reader, light, emission ? emission : value);
  }
  reader.scene.lights.push_back(std::move(light));
}

}  // namespace

Emission read_emission(Reader& reader, JsonValue value, const Shape& shape) {
  Emission emission;
  if (!value) return emission;
  Diagnostics& d = reader.diagnostics;
  Fields fields(value, d);
  std::vector<std::string_view> keys;
  for (const Unit& unit : emission_units) keys.push_back(unit.key);
  const JsonValue given = fields.one_of(keys);
  const JsonValue efficacy = fields.find("efficacy");
  for (const Unit& unit : emission_units) {
    if (!given || unit.key != given.key()) continue;
    const Bound bound = unit.given == Emission::Given::ev ? Bound::any : Bound::not_negative;
    emission.given = unit.given;
    emission.radiant = unit.radiant;
    emission.value = read_quantity(given, unit.dimension, bound, d).value_or(0);
    if (unit.radiant && !efficacy) fail(d, given, "EFFICACY_MISSING", fmt::format("expected \"efficacy\" (lm/W) beside \"{}\"", unit.key));
    if (!unit.radiant && efficacy)
      warn(d, efficacy, "KEY_WITHOUT_EFFECT", fmt::format("\"{}\" is photometric already and needs no efficacy", unit.key));
  }
  if (fields.valid() && !given && !brings_its_own(shape)) {
    fail(
        d, value, "EMISSION_MISSING",
        "expected exactly one of \"flux\", \"intensity\", \"luminance\", \"illuminance\", \"ev\", \"radiant_flux\", \"radiant_intensity\", "
        "\"radiance\", \"irradiance\"");
  }
  emission.efficacy_lm_W = read_quantity(efficacy, Dimension::efficacy, Bound::positive, d);
  emission.distance_m = read_length(fields.find("distance"), Bound::positive, d);
  const JsonValue texture = fields.find("texture");
  emission.texture = read_texture(reader, texture);
  if (emission.texture && !carries_texture(reader.scene, shape)) {
    fail(d, texture, "VALUE_UNSUITABLE", "expected a texture on a rect, disk or polygon, or on a mesh with uvs");
  }
  fields.finish();
  return emission;
}

std::string unique_light_name(Reader& reader, const std::string& wanted) {
  std::size_t& number = reader.light_names[wanted];  // the last one given to this name; 0: the name is free
  if (number++ == 0) return wanted;
  std::string name = fmt::format("{} {}", wanted, number);
  while (reader.light_names.count(name) != 0) name = fmt::format("{} {}", wanted, ++number);
  reader.light_names[name] = 1;
  return name;
}

void read_lights(Reader& reader, JsonValue lights) {
  if (!is_array(lights, reader.options.max_items, reader.diagnostics)) return;
  for (const JsonValue light : lights) read_light(reader, light);
}

}  // namespace etendue::rig
