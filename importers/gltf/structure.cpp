#include "structure.h"

#include <fmt/format.h>

#include <algorithm>

#include "records.h"

namespace etendue::gltf {
namespace {

// Its use as anything is an error that check_document() has reported: a format that nothing may have.
Json accessors_of(const Json& source) {
  const Json stand_in = {{"componentType", 5120}, {"count", 1}, {"type", "SCALAR"}};
  Json accessors = source;
  const Records records(Json{{"accessors", source}});
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    if (!records.accessors[i].is_valid()) accessors[i] = stand_in;
    if (!accessors[i].contains("bufferView")) accessors[i]["bufferView"] = 0;
  }
  return accessors;
}

bool is_known_camera(const Json& camera) {
  const std::string* type = text_of(camera, "type");
  return type != nullptr && (*type == "perspective" || *type == "orthographic");
}

Json cameras_of(const Json& source) {
  const Json stand_in = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
  Json cameras = source;
  for (Json& camera : cameras)
    if (!is_known_camera(camera)) camera = stand_in;
  return cameras;
}

// No node shows a stand-in.
Json nodes_of(const Json& source, const Json& cameras) {
  Json nodes = source;
  for (Json& node : nodes) {
    const std::int64_t camera = index_of(node, "camera");
    if (camera >= 0 && static_cast<std::size_t>(camera) < cameras.size() && !is_known_camera(cameras[static_cast<std::size_t>(camera)]))
      node.erase("camera");
  }
  return nodes;
}

}  // namespace

std::string structure_of(const Json& root) {
  std::string text = "{";
  for (const char* key :
       {"asset", "accessors", "bufferViews", "cameras", "materials", "meshes", "nodes", "samplers", "scene", "scenes", "textures"}) {
    const auto member = root.find(key);
    if (member == root.end() || (member->is_array() && member->empty())) continue;
    const std::string_view name = key;
    const bool is_array = member->is_array();
    const std::string value = name == "accessors" && is_array ? accessors_of(*member).dump()
                              : name == "cameras" && is_array ? cameras_of(*member).dump()
                              : name == "nodes" && is_array   ? nodes_of(*member, array_at(root, "cameras")).dump()
                                                              : member->dump();
    text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", key, value);
  }
  if (array_at(root, "bufferViews").empty()) text += R"(,"bufferViews":[{"buffer":0,"byteLength":1}])";
  return text + "}";
}

void remove_stand_ins(const Json& root, tinygltf::Model& model) {
  const Json& accessors = array_at(root, "accessors");
  for (std::size_t i = 0; i < std::min(accessors.size(), model.accessors.size()); ++i)
    if (index_of(accessors[i], "bufferView") < 0) model.accessors[i].bufferView = -1;
  if (array_at(root, "bufferViews").empty()) model.bufferViews.clear();
}

}  // namespace etendue::gltf
