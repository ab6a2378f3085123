// The part of a document that tinygltf makes its model of.
#pragma once

#include <tiny_gltf.h>
#include <nlohmann/json_fwd.hpp>

#include <string>

namespace etendue::gltf {

// Extensions, animations, skins, buffers and images are read from the document itself, or have bytes behind them. tinygltf gives up on
// accessors and cameras of types that glTF does not know (a warning where nothing uses them), and on indices without a bufferView, which
// are all zero: stand-ins keep the places of the others, until remove_stand_ins().
std::string structure_of(const nlohmann::json& root);
void remove_stand_ins(const nlohmann::json& root, tinygltf::Model& model);

}  // namespace etendue::gltf
