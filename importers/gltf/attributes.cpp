#include "attributes.h"

#include <algorithm>
#include <map>

namespace etendue::gltf {
namespace {

constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, f32 = 5126;
using Formats = std::map<std::string, std::vector<Format>>;

std::vector<Format> of(const std::vector<Shape>& shapes, const std::vector<int>& plain, const std::vector<int>& normalised = {}) {
  std::vector<Format> formats;
  for (const Shape shape : shapes) {
    for (const int component : plain) formats.push_back({shape, component, false});
    for (const int component : normalised) formats.push_back({shape, component, true});
  }
  return formats;
}

Formats vertex_formats() {
  return {{"POSITION", of({Shape::vec3}, {f32})},
          {"NORMAL", of({Shape::vec3}, {f32})},
          {"TANGENT", of({Shape::vec4}, {f32})},
          {"TEXCOORD", of({Shape::vec2}, {f32}, {u8, u16})},
          {"COLOR", of({Shape::vec3, Shape::vec4}, {f32}, {u8, u16})},
          {"JOINTS", of({Shape::vec4}, {u8, u16})},
          {"WEIGHTS", of({Shape::vec4}, {f32}, {u8, u16})}};
}
Formats target_formats() {
  return {{"POSITION", of({Shape::vec3}, {f32})},
          {"NORMAL", of({Shape::vec3}, {f32})},
          {"TANGENT", of({Shape::vec3}, {f32})},
          {"TEXCOORD", of({Shape::vec2}, {f32}, {i8, u8, i16, u16})},
          {"COLOR", of({Shape::vec3, Shape::vec4}, {f32}, {i8, u8, i16, u16})}};
}

// What KHR_mesh_quantization adds.
Formats quantised_vertex_formats() {
  return {{"POSITION", of({Shape::vec3}, {i8, u8, i16, u16}, {i8, u8, i16, u16})},
          {"NORMAL", of({Shape::vec3}, {}, {i8, i16})},
          {"TANGENT", of({Shape::vec4}, {}, {i8, i16})},
          {"TEXCOORD", of({Shape::vec2}, {i8, u8, i16, u16}, {i8, i16})}};
}
Formats quantised_target_formats() {
  return {{"POSITION", of({Shape::vec3}, {i8, i16}, {i8, i16})},
          {"NORMAL", of({Shape::vec3}, {}, {i8, i16})},
          {"TANGENT", of({Shape::vec3}, {}, {i8, i16})},
          {"TEXCOORD", of({Shape::vec2}, {i8, u8, i16, u16}, {})}};
}

Formats with(Formats all, const Formats& more) {
  for (const auto& [base, formats] : more) all[base].insert(all[base].end(), formats.begin(), formats.end());
  return all;
}

}  // namespace

std::optional<Semantic> semantic_of(std::string_view name) {
  if (name.starts_with('_')) return Semantic{};
  if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") return Semantic{std::string(name), -1};
  const std::size_t line = name.find('_');
  if (line == name.npos) return std::nullopt;
  const std::string_view base = name.substr(0, line), digits = name.substr(line + 1);
  if (base != "TEXCOORD" && base != "COLOR" && base != "JOINTS" && base != "WEIGHTS") return std::nullopt;
  const bool numeric = std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!numeric || digits.empty() || digits.size() > 6 || (digits.size() > 1 && digits[0] == '0')) return std::nullopt;
  int set = 0;
  for (const char digit : digits) set = 10 * set + (digit - '0');
  return Semantic{std::string(base), set};
}

const std::vector<Format>* formats_of(const std::string& base, Role role, bool quantised) {
  static const Formats tables[2][2] = {{vertex_formats(), with(vertex_formats(), quantised_vertex_formats())},
                                       {target_formats(), with(target_formats(), quantised_target_formats())}};
  const Formats& table = tables[role == Role::vertex ? 0 : 1][quantised ? 1 : 0];
  const auto found = table.find(base);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace etendue::gltf
