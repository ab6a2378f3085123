// glTF 2.0, section 5 (properties reference).
#include "schema_properties.h"

namespace etendue::gltf {
namespace {

// ^[0-9]+\.[0-9]+$
bool is_version(std::string_view text) {
  const auto digits = [](std::string_view part) { return !part.empty() && part.find_first_not_of("0123456789") == part.npos; };
  const std::size_t point = text.find('.');
  return point != text.npos && digits(text.substr(0, point)) && digits(text.substr(point + 1));
}

}  // namespace

SchemaTable core_schema() {
  const std::vector<double> components = {5120, 5121, 5122, 5123, 5125, 5126};
  return {
      {"glTF",
       {strings("extensionsUsed"), strings("extensionsRequired"), objects("accessors", "accessor"), objects("animations", "animation"),
        required(object("asset", "asset")), objects("buffers", "buffer"), objects("bufferViews", "bufferView"),
        objects("cameras", "camera"), objects("images", "image"), objects("materials", "material"), objects("meshes", "mesh"),
        objects("nodes", "node"), objects("samplers", "sampler"), index("scene", "/scenes"), objects("scenes", "scene"),
        objects("skins", "skin"), objects("textures", "texture")}},
      {"asset", {string("copyright"), string("generator"), required(matching("version", is_version)), matching("minVersion", is_version)}},
      {"accessor",
       {index("bufferView", "/bufferViews"), integer("byteOffset"), required(code("componentType", components)), boolean("normalized"),
        required(integer("count", 1)), required(one_of("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})), any("max"),
        any("min"), object("sparse", "accessor.sparse"), string("name")}},
      {"accessor.sparse",
       {required(integer("count", 1)), required(object("indices", "accessor.sparse.indices")),
        required(object("values", "accessor.sparse.values"))}},
      {"accessor.sparse.indices",
       {required(index("bufferView", "/bufferViews")), integer("byteOffset"), required(code("componentType", {5121, 5123, 5125}))}},
      {"accessor.sparse.values", {required(index("bufferView", "/bufferViews")), integer("byteOffset")}},
      {"animation",
       {required(objects("channels", "animation.channel")), required(objects("samplers", "animation.sampler")), string("name")}},
      {"animation.channel", {required(integer("sampler")), required(object("target", "animation.channel.target"))}},
      {"animation.channel.target",
       {index("node", "/nodes"), required(one_of("path", {"translation", "rotation", "scale", "weights", "pointer"}))}},
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
       {required(named_indices("attributes", "/accessors")),
        index("indices", "/accessors"),
        index("material", "/materials"),
        integer("mode", 0, 6),
        {"targets", Kind::named_indices_list, "/accessors"}}},
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

}  // namespace etendue::gltf
