// glTF 2.0, section 5 (properties reference), and the schemas of the extensions that are read.
#include "schema.h"

#include <map>

namespace etendue::gltf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// tinygltf keeps these in an int.
constexpr double max_int = std::numeric_limits<int>::max();
// "greater than 0" of the schemas.
constexpr double above_zero = std::numeric_limits<double>::denorm_min();

Property any(const char* name) { return {name, Kind::any}; }
Property boolean(const char* name) { return {name, Kind::boolean}; }
Property string(const char* name) { return {name, Kind::string}; }
Property strings(const char* name) { return {name, Kind::strings}; }
Property one_of(const char* name, std::vector<std::string> allowed) {
  return {name, Kind::string, "", false, 0, 0, 0, {}, std::move(allowed)};
}
Property integer(const char* name, double min = 0, double max = infinity) { return {name, Kind::integer, "", false, min, max}; }
Property code(const char* name, std::vector<double> allowed) {
  return {name, Kind::integer, "", false, -infinity, infinity, 0, std::move(allowed)};
}
Property number(const char* name, double min = -infinity, double max = infinity) { return {name, Kind::number, "", false, min, max}; }
Property numbers(const char* name, std::size_t length = 0, double min = -infinity, double max = infinity) {
  return {name, Kind::numbers, "", false, min, max, length};
}
Property index(const char* name, const char* array) { return {name, Kind::index, array}; }
Property indices(const char* name, const char* array) { return {name, Kind::indices, array}; }
Property object(const char* name, const char* type) { return {name, Kind::object, type}; }
Property objects(const char* name, const char* type) { return {name, Kind::objects, type}; }
Property required(Property property) {
  property.required = true;
  return property;
}

using Table = std::map<std::string, std::vector<Property>>;

Table core() {
  const std::vector<double> components = {5120, 5121, 5122, 5123, 5125, 5126};
  return {
      {"glTF",
       {strings("extensionsUsed"), strings("extensionsRequired"), objects("accessors", "accessor"), objects("animations", "animation"),
        required(object("asset", "asset")), objects("buffers", "buffer"), objects("bufferViews", "bufferView"),
        objects("cameras", "camera"), objects("images", "image"), objects("materials", "material"), objects("meshes", "mesh"),
        objects("nodes", "node"), objects("samplers", "sampler"), index("scene", "/scenes"), objects("scenes", "scene"),
        objects("skins", "skin"), objects("textures", "texture")}},
      {"asset", {string("copyright"), string("generator"), required(string("version")), string("minVersion")}},
      {"accessor",
       {index("bufferView", "/bufferViews"), integer("byteOffset"), required(code("componentType", components)), boolean("normalized"),
        required(integer("count", 1)), required(one_of("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})), numbers("max"),
        numbers("min"), object("sparse", "accessor.sparse"), string("name")}},
      {"accessor.sparse",
       {required(integer("count", 1, max_int)), required(object("indices", "accessor.sparse.indices")),
        required(object("values", "accessor.sparse.values"))}},
      {"accessor.sparse.indices",
       {required(index("bufferView", "/bufferViews")), integer("byteOffset", 0, max_int),
        required(code("componentType", {5121, 5123, 5125}))}},
      {"accessor.sparse.values", {required(index("bufferView", "/bufferViews")), integer("byteOffset", 0, max_int)}},
      {"animation",
       {required(objects("channels", "animation.channel")), required(objects("samplers", "animation.sampler")), string("name")}},
      {"animation.channel", {required(integer("sampler")), required(object("target", "animation.channel.target"))}},
      {"animation.channel.target", {index("node", "/nodes"), required(string("path"))}},
      {"animation.sampler",
       {required(index("input", "/accessors")), one_of("interpolation", {"LINEAR", "STEP", "CUBICSPLINE"}),
        required(index("output", "/accessors"))}},
      {"buffer", {string("uri"), required(integer("byteLength", 1)), string("name")}},
      {"bufferView",
       {required(index("buffer", "/buffers")), integer("byteOffset"), required(integer("byteLength", 1)), integer("byteStride", 4, 252),
        code("target", {34962, 34963}), string("name")}},
      {"camera",
       {object("orthographic", "camera.orthographic"), object("perspective", "camera.perspective"),
        required(one_of("type", {"perspective", "orthographic"})), string("name")}},
      {"camera.orthographic",
       {required(number("xmag")), required(number("ymag")), required(number("zfar", above_zero)), required(number("znear", 0))}},
      {"camera.perspective",
       {number("aspectRatio", above_zero), required(number("yfov", above_zero)), number("zfar", above_zero),
        required(number("znear", above_zero))}},
      {"image", {string("uri"), string("mimeType"), index("bufferView", "/bufferViews"), string("name")}},
      {"material",
       {string("name"), object("pbrMetallicRoughness", "material.pbrMetallicRoughness"), object("normalTexture", "material.normalTexture"),
        object("occlusionTexture", "material.occlusionTexture"), object("emissiveTexture", "textureInfo"),
        numbers("emissiveFactor", 3, 0, 1), one_of("alphaMode", {"OPAQUE", "MASK", "BLEND"}), number("alphaCutoff", 0),
        boolean("doubleSided")}},
      {"material.pbrMetallicRoughness",
       {numbers("baseColorFactor", 4, 0, 1), object("baseColorTexture", "textureInfo"), number("metallicFactor", 0, 1),
        number("roughnessFactor", 0, 1), object("metallicRoughnessTexture", "textureInfo")}},
      {"textureInfo", {required(index("index", "/textures")), integer("texCoord")}},
      {"material.normalTexture", {required(index("index", "/textures")), integer("texCoord"), number("scale")}},
      {"material.occlusionTexture", {required(index("index", "/textures")), integer("texCoord"), number("strength", 0, 1)}},
      {"mesh", {required(objects("primitives", "mesh.primitive")), numbers("weights"), string("name")}},
      {"mesh.primitive",
       {required({"attributes", Kind::named_indices, "/accessors"}), index("indices", "/accessors"), index("material", "/materials"),
        code("mode", {0, 1, 2, 3, 4, 5, 6}), any("targets")}},
      {"node",
       {index("camera", "/cameras"), indices("children", "/nodes"), index("skin", "/skins"), numbers("matrix", 16),
        index("mesh", "/meshes"), numbers("rotation", 4, -1, 1), numbers("scale", 3), numbers("translation", 3), numbers("weights"),
        string("name")}},
      {"sampler",
       {code("magFilter", {9728, 9729}), code("minFilter", {9728, 9729, 9984, 9985, 9986, 9987}), code("wrapS", {33071, 33648, 10497}),
        code("wrapT", {33071, 33648, 10497}), string("name")}},
      {"scene", {indices("nodes", "/nodes"), string("name")}},
      {"skin",
       {index("inverseBindMatrices", "/accessors"), index("skeleton", "/nodes"), required(indices("joints", "/nodes")), string("name")}},
      {"texture", {index("sampler", "/samplers"), index("source", "/images"), string("name")}},
  };
}

// Extensions whose content is read; others are named by the importer and not looked into.
Table extensions() {
  const std::vector<Property> transform = {numbers("offset", 2), number("rotation"), numbers("scale", 2), integer("texCoord")};
  return {
      {"glTF.KHR_lights_punctual", {required(objects("lights", "punctual light"))}},
      {"node.KHR_lights_punctual", {required(index("light", "/extensions/KHR_lights_punctual/lights"))}},
      {"punctual light",
       {string("name"), numbers("color", 3, 0), number("intensity", 0), object("spot", "punctual light.spot"),
        required(one_of("type", {"directional", "point", "spot"})), number("range", above_zero)}},
      {"punctual light.spot", {number("innerConeAngle", 0), number("outerConeAngle", above_zero)}},
      {"glTF.EXT_lights_area", {required(objects("lights", "area light"))}},
      {"node.EXT_lights_area", {required(index("light", "/extensions/EXT_lights_area/lights"))}},
      {"area light",
       {string("name"), numbers("color", 3, 0), number("intensity", 0), number("size", above_zero), object("rect", "area light.rect"),
        required(one_of("type", {"rect", "disk"}))}},
      {"area light.rect", {number("aspect", above_zero)}},
      {"material.KHR_materials_emissive_strength", {number("emissiveStrength", 0)}},
      {"material.KHR_materials_ior", {number("ior", 0)}},
      {"textureInfo.KHR_texture_transform", transform},
      {"material.normalTexture.KHR_texture_transform", transform},
      {"material.occlusionTexture.KHR_texture_transform", transform},
  };
}

}  // namespace

const std::vector<Property>* properties_of(const std::string& type) {
  static const Table table = [] {
    Table all = core();
    all.merge(extensions());
    return all;
  }();
  const auto found = table.find(type);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace etendue::gltf
