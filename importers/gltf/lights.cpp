#include "lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "json_values.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

const Json* light_at(const Asset& asset, const char* extension, int index, std::string& pointer) {
  pointer = fmt::format("/extensions/{}/lights/{}", extension, index);
  const Json::json_pointer place(pointer);
  return index >= 0 && asset.json().contains(place) && asset.json().at(place).is_object() ? &asset.json().at(place) : nullptr;
}

// What both extensions share. Their colour multiplies the intensity channel by channel: it is a filter, and the light's photometric value
// is intensity x Y(colour).
Light common_light(const Json& source, const std::string& pointer, const Transform& node_to_world) {
  Light light;
  light.name = text_or(source, "name", "");
  light.source = pointer;
  light.filter = {number_or(source, "color", 0, 1), number_or(source, "color", 1, 1), number_or(source, "color", 2, 1)};
  light.transform = node_to_world.rigid();
  return light;
}

// The type itself is the schema's affair.
std::optional<Light> unknown_type(Asset& asset, const std::string& pointer) {
  asset.warning("NOT_REPRESENTED", "a light of a type that is not known: carried, and it lights nothing", pointer);
  return std::nullopt;
}

std::optional<Shape> spot_shape(Asset& asset, const Json& source, const std::string& pointer) {
  const Json none = Json::object();
  const auto found = source.find("spot");
  const Json& spot = found != source.end() && found->is_object() ? *found : none;
  const double inner = number_or(spot, "innerConeAngle", 0), outer = number_or(spot, "outerConeAngle", pi / 4);
  // Files written in single precision hold a float's pi/2, 4.4e-8 above ours.
  if (!(inner >= 0 && inner < outer && outer <= pi / 2 + 1e-6)) {
    asset.error("KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
                fmt::format("expected 0 <= innerConeAngle < outerConeAngle <= pi/2, found {} and {}", inner, outer), pointer + "/spot");
    return std::nullopt;
  }
  return SpotShape{inner, std::min(outer, pi / 2)};
}

// A photometric file: named, or its text inside the asset.
Result<PhotometricShape> profile_of(Asset& asset, const Json& source, const std::string& pointer) {
  if (source.contains("bufferView") == source.contains("uri"))
    return asset.failure("ONE_OF_MISMATCH", "expected either uri or bufferView", pointer);
  if (source.contains("bufferView")) {
    auto bytes = asset.view(int_index_of(source, "bufferView"));
    if (!bytes) return bytes.error();
    return PhotometricShape{"", std::move(*bytes)};
  }
  const std::string uri = text_or(source, "uri", "");
  if (is_data_uri(uri)) {
    auto data = asset.data_of(uri, pointer + "/uri");
    if (!data) return data.error();
    return PhotometricShape{"", std::move(*data)};
  }
  const auto path = file_inside(asset.folder(), uri);
  if (!path) return asset.failure(path.error().code, path.error().text, pointer + "/uri");
  return PhotometricShape{path->string(), {}};
}

}  // namespace

std::optional<Light> punctual_light(Asset& asset, const Json& use, const Transform& node_to_world) {
  std::string pointer;
  const Json* source = light_at(asset, "KHR_lights_punctual", int_index_of(use, "light"), pointer);
  if (source == nullptr) return std::nullopt;
  Light light = common_light(*source, pointer, node_to_world);
  const std::string type = text_or(*source, "type", "");
  light.emission.value = number_or(*source, "intensity", 1);
  light.emission.given = Emission::Given::intensity;
  if (type == "point") {
    light.shape = PointShape{};
  } else if (type == "spot") {
    const auto spot = spot_shape(asset, *source, pointer);
    if (!spot) return std::nullopt;
    light.shape = *spot;
  } else if (type == "directional") {
    light.shape = DistantShape{};
    light.emission.given = Emission::Given::illuminance;
    if (source->contains("range"))
      asset.warning("NOT_REPRESENTED", "a directional light has no place and so no range; it is ignored", pointer + "/range");
    return light;
  } else {
    return unknown_type(asset, pointer);
  }
  if (const double range = number_or(*source, "range", 0); range > 0) {
    light.range_m = range;
    light.falloff = Falloff::gltf;
  }
  return light;
}

std::optional<Light> area_light(Asset& asset, const Json& use, const Transform& node_to_world) {
  std::string pointer;
  const Json* source = light_at(asset, "EXT_lights_area", int_index_of(use, "light"), pointer);
  if (source == nullptr) return std::nullopt;
  Light light = common_light(*source, pointer, node_to_world);
  const std::string type = text_or(*source, "type", "");
  light.emission.given = Emission::Given::luminance;
  light.emission.value = number_or(*source, "intensity", 1000);

  // "The light's size is its size property multiplied by the absolute value of the largest component of the node's world scale."
  const auto& columns = node_to_world.columns;
  const double scale = std::max({length(columns[0]), length(columns[1]), length(columns[2])});
  const double size = scale * number_or(*source, "size", 1);
  if (type == "rect") {
    const Json none = Json::object();
    const auto rect = source->find("rect");
    light.shape = RectShape{size * number_or(rect != source->end() && rect->is_object() ? *rect : none, "aspect", 1), size};
  } else if (type == "disk") {
    light.shape = DiskShape{size / 2};
  } else {
    return unknown_type(asset, pointer);
  }
  return light;
}

// The file's nadir goes along the node's -Z, as our lights emit. `multiplier` and `color` scale the file's candelas; the node's scale does
// not.
std::optional<Light> ies_light(Asset& asset, const Json& use, const Transform& node_to_world) {
  std::string pointer;
  const Json* source = light_at(asset, "EXT_lights_ies", int_index_of(use, "light"), pointer);
  if (source == nullptr) return std::nullopt;
  auto shape = profile_of(asset, *source, pointer);
  if (!shape) {
    asset.error(shape.error());
    return std::nullopt;
  }
  Light light = common_light(use, pointer, node_to_world);
  light.name = text_or(*source, "name", "");
  light.shape = std::move(*shape);
  light.filter = light.filter * number_or(use, "multiplier", 1);
  return light;
}

std::vector<int> image_based_cube(Asset& asset, int index) {
  std::string pointer;
  const Json* source = light_at(asset, "EXT_lights_image_based", index, pointer);
  const Json::json_pointer finest("/specularImages/0");
  if (source == nullptr || !source->contains(finest) || !source->at(finest).is_array() || source->at(finest).size() != 6) return {};
  std::vector<int> images;
  for (const Json& image : source->at(finest))
    if (image.is_number_integer() && image.get<double>() >= 0 && image.get<double>() <= std::numeric_limits<int>::max())
      images.push_back(image.get<int>());
  asset.warning("NOT_SHOWN", "an environment in the form of a cube: a reference, from which no light comes in pictures", pointer);
  return images;
}

Light image_based_light(Asset& asset, int index, std::vector<std::uint32_t> faces) {
  std::string pointer;
  const Json& source = *light_at(asset, "EXT_lights_image_based", index, pointer);
  Light light;
  light.name = text_or(source, "name", "environment");
  light.source = pointer;
  EnvironmentShape sky;
  sky.cube = std::move(faces);
  light.shape = std::move(sky);
  const double intensity = number_or(source, "intensity", 1);
  light.filter = {intensity, intensity, intensity};
  const Quat turn{number_or(source, "rotation", 0, 0), number_or(source, "rotation", 1, 0), number_or(source, "rotation", 2, 0),
                  number_or(source, "rotation", 3, 1)};
  light.transform = Transform::from_trs({}, turn).rigid();
  return light;
}

}  // namespace etendue::gltf
