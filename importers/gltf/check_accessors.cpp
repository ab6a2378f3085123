// Accessors: bounds, normalisation, alignment, and that their elements lie inside their views.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "checks.h"

namespace etendue::gltf {
namespace {

struct Range {
  double min, max;
};
Range range_of(int component) {
  switch (component) {
    case 5120:
      return {-128, 127};
    case 5121:
      return {0, 255};
    case 5122:
      return {-32768, 32767};
    case 5123:
      return {0, 65535};
    default:
      return {0, 4294967295.0};
  }
}

void check_bounds(Checks& checks, const Json& source, const Format& format, const char* key, const Path& path) {
  const auto found = source.find(key);
  if (found == source.end()) return;
  const Path here = path / key;
  const bool floats = format.component == 5126;
  if (!found->is_array())
    return checks.findings.error("TYPE_MISMATCH", fmt::format("expected an array of numbers, found {}", shown(*found)), here);
  if (found->empty() && floats) return checks.findings.error("EMPTY_ENTITY", "expected at least one element, found none", here);
  if (found->size() != components_of(format.shape))
    return checks.findings.error("ARRAY_LENGTH_NOT_IN_LIST",
                                 fmt::format("expected {} numbers, found {}", components_of(format.shape), found->size()), here);
  const Range range = range_of(format.component);
  for (std::size_t i = 0; i < found->size(); ++i) {
    const Json& value = (*found)[i];
    const double x = value.is_number() ? value.get<double>() : 0;
    if (!value.is_number() || (!floats && std::floor(x) != x))
      return checks.findings.error("ARRAY_TYPE_MISMATCH",
                                   fmt::format("expected {}, found {}", floats ? "a number" : "an integer", shown(value)), here / i);
    if (!floats && (x < range.min || x > range.max))
      return checks.findings.error(
          "INVALID_GL_VALUE", fmt::format("{} is outside of what {} can hold", shown(value), to_string({format.shape, format.component})),
          here / i);
  }
}

void check_sparse_part(Checks& checks, std::int64_t index, const Path& path) {
  const View* view = checks.records.view(index);
  if (view == nullptr) return;
  use_view(checks, index, Usage::other, path / "bufferView");
  if (view->stride != 0)
    checks.findings.error("BUFFER_VIEW_INVALID_BYTE_STRIDE", "sparse data lies in views without byteStride", path / "bufferView");
}

void check_sparse(Checks& checks, const Json& source, const Accessor& accessor, const Path& path) {
  const Json& sparse = object_at(source, "sparse");
  const std::uint64_t count = uint_of(sparse, "count").value_or(0);
  if (count == 0 || !object_at(sparse, "indices").is_object() || !object_at(sparse, "values").is_object()) return;
  const Path here = path / "sparse", indices = here / "indices", values = here / "values";
  if (count > accessor.count)
    checks.findings.error("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
                          fmt::format("{} elements are replaced, and there are {}", count, accessor.count), here / "count");
  const Json &index_part = object_at(sparse, "indices"), &value_part = object_at(sparse, "values");
  const std::int64_t index_view = index_of(index_part, "bufferView"), value_view = index_of(value_part, "bufferView");
  const std::size_t size = component_bytes(static_cast<int>(uint_of(index_part, "componentType").value_or(0) & 0xFFFF));
  check_sparse_part(checks, index_view, indices);
  if (size != 0) check_fit(checks, index_view, uint_of(index_part, "byteOffset").value_or(0), size, count * size, indices);
  check_sparse_part(checks, value_view, values);
  const std::size_t component = component_bytes(accessor.format.component);
  check_fit(checks, value_view, uint_of(value_part, "byteOffset").value_or(0), component,
            extent(count, tight_stride(accessor.format), element_bytes(accessor.format)), values);
}

void check_accessor(Checks& checks, const Json& source, const Accessor& accessor, const Path& path) {
  if (!source.is_object()) return;
  const Path offset = path / "byteOffset", normalised = path / "normalized";
  if (!source.contains("bufferView") && source.contains("byteOffset"))
    checks.findings.error("UNSATISFIED_DEPENDENCY", "expected bufferView beside byteOffset, which is missing", offset);
  if (accessor.format.shape != Shape::unknown && accessor.format.component != 0) {
    check_bounds(checks, source, accessor.format, "min", path);
    check_bounds(checks, source, accessor.format, "max", path);
  }
  if (accessor.format.normalised && (accessor.format.component == 5125 || accessor.format.component == 5126))
    checks.findings.error("ACCESSOR_NORMALIZED_INVALID", "only bytes and shorts can be normalised", normalised);
  if (accessor.format.shape >= Shape::mat2 && accessor.offset % 4 != 0)
    checks.findings.error("ACCESSOR_MATRIX_ALIGNMENT", fmt::format("matrices begin at multiples of 4 bytes, found {}", accessor.offset),
                          offset);
  if (!accessor.is_valid()) return;
  if (const View* view = checks.records.view(accessor.view)) {
    const std::size_t element = element_bytes(accessor.format);
    if (view->stride != 0 && view->stride < element)
      checks.findings.error(
          "ACCESSOR_SMALL_BYTESTRIDE",
          fmt::format("elements of {} bytes do not fit the byteStride {} of bufferView {}", element, view->stride, accessor.view), path);
    const std::uint64_t stride = view->stride != 0 ? view->stride : tight_stride(accessor.format);
    check_fit(checks, accessor.view, accessor.offset, component_bytes(accessor.format.component), extent(accessor.count, stride, element),
              path);
  }
  check_sparse(checks, source, accessor, path);
}

}  // namespace

void check_accessors(Checks& checks) {
  const Path root, path = root / "accessors";
  const Json& accessors = array_at(checks.root, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) check_accessor(checks, accessors[i], checks.records.accessors[i], path / i);
}

void check_fit(Checks& checks, std::int64_t index, std::uint64_t offset, std::size_t component, std::uint64_t bytes, const Path& path) {
  const View* view = checks.records.view(index);
  if (view == nullptr) return;
  if (offset % component != 0)
    checks.findings.error("ACCESSOR_OFFSET_ALIGNMENT", fmt::format("expected a multiple of {} bytes, found {}", component, offset),
                          path / "byteOffset");
  if ((view->offset + offset) % component != 0)
    checks.findings.error("ACCESSOR_TOTAL_OFFSET_ALIGNMENT",
                          fmt::format("components at byte {} of the buffer are not aligned to {} bytes", view->offset + offset, component),
                          path);
  if (view->length == 0) return;
  if (offset > view->length || bytes > view->length - offset)
    checks.findings.error("ACCESSOR_TOO_LONG",
                          fmt::format("{} bytes from byte {} on go beyond bufferView {} of {}", bytes, offset, index, view->length), path);
}

void use_accessor(Checks& checks, std::int64_t index, Usage usage, const Path& user) {
  Accessor* accessor = checks.records.accessor(index);
  if (accessor == nullptr) return;
  if (accessor->usage == Usage::none) accessor->usage = usage;
  if (accessor->usage != usage)
    checks.findings.error("ACCESSOR_USAGE_OVERRIDE",
                          fmt::format("accessor {} is {}, and used as {} here", index, name_of(accessor->usage), name_of(usage)), user);
}

std::string format_expected(const Format& found, const std::vector<Format>& allowed) {
  std::vector<std::string> names;
  names.reserve(allowed.size());
  for (const Format& format : allowed) names.push_back(to_string(format));
  return fmt::format("expected {}, found {}", fmt::join(names, " or "), to_string(found));
}

}  // namespace etendue::gltf
