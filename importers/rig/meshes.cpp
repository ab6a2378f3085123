#include "reader.h"

#include <fmt/format.h>

#include <limits>

namespace etendue::rig {
namespace {

constexpr double largest_float = std::numeric_limits<float>::max();

// Tuples of `width` numbers: [[x, y, z], ...] or, flat, [x, y, z, ...].
std::vector<float> read_tuples(Reader& reader, JsonValue value, std::size_t width) {
  Diagnostics& d = reader.diagnostics;
  std::vector<float> numbers;
  if (!value || !is_array(value, reader.options.max_items * width, d)) return numbers;
  for (const JsonValue element : value) {
    if (element.is(JsonKind::array)) {
      const std::optional<std::vector<double>> tuple = read_numbers(element, width, -largest_float, largest_float, d);
      if (!tuple || numbers.size() % width != 0) return {};
      for (const double x : *tuple) numbers.push_back(static_cast<float>(x));
    } else {
      const std::optional<double> x = read_number(element, -largest_float, largest_float, d);
      if (!x) return {};
      numbers.push_back(static_cast<float>(*x));
    }
  }
  if (numbers.size() % width == 0 && numbers.size() / width <= reader.options.max_items) return numbers;
  fail(d, value, "TYPE_MISMATCH", fmt::format("expected tuples of {} numbers, found {} numbers", width, numbers.size()));
  return {};
}

std::vector<Vec3f> read_vectors(Reader& reader, JsonValue value) {
  const std::vector<float> n = read_tuples(reader, value, 3);
  std::vector<Vec3f> vectors;
  for (std::size_t i = 0; i + 2 < n.size(); i += 3) vectors.push_back({n[i], n[i + 1], n[i + 2]});
  return vectors;
}

std::vector<std::uint32_t> read_indices(Reader& reader, JsonValue value, std::size_t vertices) {
  Diagnostics& d = reader.diagnostics;
  std::vector<std::uint32_t> indices;
  if (!value || !is_array(value, reader.options.max_items, d)) return indices;
  if (value.size() % 3 != 0 || value.size() == 0) {
    fail(d, value, "TYPE_MISMATCH", fmt::format("expected 3 indices for each triangle, found {} indices", value.size()));
    return indices;
  }
  for (const JsonValue element : value) {
    if (!element.is_integer() || element.number() < 0 || element.number() >= static_cast<double>(vertices)) {
      fail(d, element, "VALUE_OUT_OF_RANGE", fmt::format("expected the index of one of {} positions", vertices));
      return {};
    }
    indices.push_back(static_cast<std::uint32_t>(element.number()));
  }
  return indices;
}

}  // namespace

Mesh read_mesh(Reader& reader, Fields& fields) {
  Mesh mesh;
  mesh.source = fields.object().pointer();
  mesh.positions = read_vectors(reader, fields.require("positions"));
  const JsonValue indices = fields.require("indices");
  const JsonValue normals = fields.find("normals");
  const JsonValue uvs = fields.find("uvs");
  mesh.normals = read_vectors(reader, normals);
  const std::vector<float> uv = read_tuples(reader, uvs, 2);
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) mesh.uvs.push_back({uv[i], uv[i + 1]});
  if (mesh.positions.empty()) return mesh;
  mesh.indices = read_indices(reader, indices, mesh.positions.size());
  const auto check_count = [&](JsonValue value, std::size_t count) {
    if (count == 0 || count == mesh.positions.size()) return;
    fail(reader.diagnostics, value, "TYPE_MISMATCH",
         fmt::format("expected one for each of {} positions, found {}", mesh.positions.size(), count));
  };
  check_count(normals, mesh.normals.size());
  check_count(uvs, mesh.uvs.size());
  return mesh;
}

std::optional<std::uint32_t> read_mesh_reference(Reader& reader, Fields& fields) {
  const JsonValue reference = fields.find("mesh");
  if (reference) return read_reference(reader, reference, reader.mesh_names, "mesh");
  reader.scene.meshes.push_back(read_mesh(reader, fields));
  return static_cast<std::uint32_t>(reader.scene.meshes.size() - 1);
}

void read_meshes(Reader& reader, JsonValue meshes) {
  if (!is_array(meshes, reader.options.max_items, reader.diagnostics)) return;
  for (const JsonValue value : meshes) {
    Fields fields(value, reader.diagnostics);
    std::string name = read_string(fields.find("name"), reader.diagnostics).value_or("");
    Mesh mesh = read_mesh(reader, fields);
    fields.finish();
    reader.mesh_names.push_back(name);
    mesh.name = std::move(name);
    reader.scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace etendue::rig
