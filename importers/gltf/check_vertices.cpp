// What a primitive's indices and attributes have to hold: vertices that are there, unit normals and tangents, colours from 0 to 1.
#include <fmt/format.h>

#include <cmath>

#include "data_checks.h"

namespace etendue::gltf {
namespace {

// The validator's: what normalised bytes can miss a unit length by.
constexpr double unit_tolerance = 0.00674;

struct Fault {
  std::size_t count = 0, first = 0;
  void add(std::size_t element) {
    if (count++ == 0) first = element;
  }
};

// Elements that are no unit vectors, and fourth components that are no sign.
template <class T>
void check_units(const Elements& elements, Fault& lengths, Fault& signs) {
  const bool has_sign = elements.components() == 4;
  for (std::size_t i = 0; i < elements.count; ++i) {
    const double x = value_at<T>(elements, i, 0), y = value_at<T>(elements, i, 1), z = value_at<T>(elements, i, 2);
    if (!(std::abs(std::sqrt(x * x + y * y + z * z) - 1) <= unit_tolerance)) lengths.add(i);
    if (has_sign && std::abs(value_at<T>(elements, i, 3)) != 1) signs.add(i);
  }
}

void check_directions(DataChecks& checks, std::int64_t accessor, const std::string& pointer) {
  if (!checks.is_new("unit", accessor)) return;
  const auto elements = checks.elements(accessor);
  if (!elements || elements->format.shape < Shape::vec3 || elements->format.shape > Shape::vec4) return;
  Fault lengths, signs;
  with_type(elements->format.component, [&](auto type) { check_units<decltype(type)>(*elements, lengths, signs); });
  if (lengths.count > 0)
    checks.asset.error("ACCESSOR_VECTOR3_NON_UNIT",
                       fmt::format("{} vectors are not of unit length, the first is number {}", lengths.count, lengths.first), pointer);
  if (signs.count > 0)
    checks.asset.error("ACCESSOR_INVALID_SIGN",
                       fmt::format("{} tangents have no sign of 1 or -1, the first is number {}", signs.count, signs.first), pointer);
}

void check_colours(DataChecks& checks, std::int64_t accessor, const std::string& pointer) {
  if (!checks.is_new("colour", accessor)) return;
  const auto elements = checks.elements(accessor);
  if (!elements || elements->format.component != 5126) return;
  Fault fault;
  for (std::size_t i = 0; i < elements->count; ++i)
    for (std::size_t c = 0; c < elements->components(); ++c)
      if (const double x = value_at<float>(*elements, i, c); !(x >= 0 && x <= 1)) {
        fault.add(i);
        break;
      }
  if (fault.count > 0)
    checks.asset.error("ACCESSOR_NON_CLAMPED",
                       fmt::format("{} colours are outside of 0 to 1, the first is number {}", fault.count, fault.first), pointer);
}

template <class T>
void check_index_values(DataChecks& checks, const Elements& indices, std::uint64_t vertices, bool triangles, const std::string& pointer) {
  constexpr T restart = std::numeric_limits<T>::max();
  Fault beyond, restarts;
  for (std::size_t i = 0; i < indices.count; ++i) {
    const T index = load<T>(indices.first + i * indices.stride);
    if (index >= vertices) beyond.add(i);
    if (index == restart) restarts.add(i);
  }
  if (beyond.count > 0)
    checks.asset.error("ACCESSOR_INDEX_OOB",
                       fmt::format("{} indices are not below {}, the first is number {}", beyond.count, vertices, beyond.first), pointer);
  if (restarts.count > 0)
    checks.asset.error(
        "ACCESSOR_INDEX_PRIMITIVE_RESTART",
        fmt::format("{} indices are {}, which restarts a primitive; the first is number {}", restarts.count, restart, restarts.first),
        pointer);
  if (!triangles) return;
  std::size_t degenerate = 0;
  for (std::size_t i = 0; i + 2 < indices.count; i += 3) {
    const T a = load<T>(indices.first + i * indices.stride), b = load<T>(indices.first + (i + 1) * indices.stride);
    const T c = load<T>(indices.first + (i + 2) * indices.stride);
    degenerate += a == b || b == c || c == a ? 1 : 0;
  }
  if (degenerate > 0)
    checks.asset.note("ACCESSOR_INDEX_TRIANGLE_DEGENERATE",
                      fmt::format("{} of {} triangles have two equal indices", degenerate, indices.count / 3), pointer);
}

void check_primitive(DataChecks& checks, const Json& primitive, const std::string& pointer) {
  const Json& attributes = object_at(primitive, "attributes");
  const Accessor* any = nullptr;
  for (const auto& [name, value] : attributes.items())
    if (const Accessor* accessor = checks.records.accessor(index_of(attributes, name.c_str())); accessor != nullptr && any == nullptr)
      any = accessor;
  check_directions(checks, index_of(attributes, "NORMAL"), pointer + "/attributes/NORMAL");
  check_directions(checks, index_of(attributes, "TANGENT"), pointer + "/attributes/TANGENT");
  check_colours(checks, index_of(attributes, "COLOR_0"), pointer + "/attributes/COLOR_0");

  const std::int64_t index = index_of(primitive, "indices");
  if (any == nullptr || !checks.is_new("indices", index, any->count)) return;
  const auto indices = checks.elements(index);
  const bool triangles = !primitive.contains("mode") || uint_of(primitive, "mode") == 4u;
  if (!indices || indices->format.shape != Shape::scalar) return;
  with_type(indices->format.component, [&](auto type) {
    if constexpr (std::is_unsigned_v<decltype(type)>)
      check_index_values<decltype(type)>(checks, *indices, any->count, triangles, pointer + "/indices");
  });
}

}  // namespace

void check_vertices(DataChecks& checks) {
  const Json& meshes = array_at(checks.asset.json(), "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Json& primitives = array_at(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p)
      check_primitive(checks, primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p));
  }
}

}  // namespace etendue::gltf
