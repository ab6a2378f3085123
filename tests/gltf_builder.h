// Small glTF assets made by tests: JSON, and one buffer that grows by accessors.
#pragma once

#include "etendue/io.h"
#include "folder.h"
#include "importers/gltf/gltf.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

using Json = nlohmann::json;

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

// A picture of one pixel.
inline std::vector<std::uint8_t> png() {
  return {0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0,    0,    0,    0x0D, 0x49, 0x48, 0x44, 0x52, 0, 0,
          0,    1,    0,    0,    0,    1,    8,    6,    0,    0,    0,    0x1F, 0x15, 0xC4, 0x89, 0,    0, 0,
          0x0D, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0x64, 0xF8, 0xCF, 0x50, 0x0F, 0,    3,    0x86, 1, 0x80,
          0x5A, 0x34, 0x7D, 0x6B, 0,    0,    0,    0,    0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};
}
inline std::string png_uri() { return "data:image/png;base64," + base64(png()); }

class GltfBuilder {
 public:
  Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}]})");
  std::vector<std::uint8_t> bytes;

  // Appends a bufferView, 4-byte aligned, and returns its index.
  template <class T>
  int view(const std::vector<T>& values) {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    const std::size_t offset = bytes.size(), size = values.size() * sizeof(T);
    bytes.resize(offset + size);
    std::memcpy(bytes.data() + offset, values.data(), size);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  int accessor(Json properties) {
    json["accessors"].push_back(std::move(properties));
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& values, const char* type) {
    const std::size_t width = type == std::string("VEC2") ? 2 : type == std::string("VEC3") ? 3 : 4;
    std::vector<float> least(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), most = least;
    for (std::size_t i = 0; i < values.size(); ++i) {
      least[i % width] = std::min(least[i % width], values[i]);
      most[i % width] = std::max(most[i % width], values[i]);
    }
    return accessor({{"bufferView", view(values)},
                     {"componentType", 5126},
                     {"count", values.size() / width},
                     {"type", type},
                     {"min", least},
                     {"max", most}});
  }
  template <class T>
  int indices(const std::vector<T>& values) {
    const int type = sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : 5125;
    return accessor({{"bufferView", view(values)}, {"componentType", type}, {"count", values.size()}, {"type", "SCALAR"}});
  }
  // One triangle in XY with a right angle at the origin, facing +Z, in a node of its own: mesh 0, primitive 0, node 0.
  void triangle() {
    const int positions = floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    json["meshes"] = Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}}})}}});
    json["nodes"] = Json::array({{{"mesh", 0}, {"name", "thing"}}});
  }
  Json& primitive() { return json["meshes"][0]["primitives"][0]; }

  std::string text() const {
    Json all = json;
    if (!bytes.empty() && !all.contains("buffers"))
      all["buffers"] = Json::array({{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}});
    return all.dump(1);
  }
  std::string glb() const {
    Json all = json;
    all["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    std::string head = all.dump();
    while (head.size() % 4 != 0) head += ' ';
    std::string body(bytes.begin(), bytes.end());
    while (body.size() % 4 != 0) body += '\0';
    const auto u32 = [](std::size_t x) {
      std::string s;
      for (int i = 0; i < 4; ++i) s += static_cast<char>(x >> (8 * i) & 255);
      return s;
    };
    return u32(0x46546C67) + u32(2) + u32(28 + head.size() + body.size()) + u32(head.size()) + u32(0x4E4F534A) + head + u32(body.size()) +
           u32(0x004E4942) + body;
  }
};

inline Result<Imported> read_gltf(const std::filesystem::path& file, const ImportOptions& options = {}) {
  return make_gltf_importer()->read(file, options);
}
inline Result<Imported> read_gltf(const GltfBuilder& builder, const Folder& folder, const ImportOptions& options = {}) {
  return read_gltf(folder.write("asset.gltf", builder.text()), options);
}

inline std::string all_text(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.all()) text += to_string(d) + "\n";
  return text;
}

// Severity, code and pointer of a message that is expected; the text may change.
inline testing::AssertionResult says(const Diagnostics& diagnostics, Severity severity, const std::string& code,
                                     const std::string& pointer) {
  for (const Diagnostic& d : diagnostics.all())
    if (d.severity == severity && d.code == code && d.where.pointer == pointer) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no " << code << " at " << pointer << " in\n" << all_text(diagnostics);
}

}  // namespace etendue::test
