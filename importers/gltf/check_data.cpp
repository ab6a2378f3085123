#include "check_data.h"

#include <algorithm>

#include <fmt/format.h>

#include "data_checks.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

// Accessors may share bytes, and honest ones share some. How often all bytes of the buffers may be looked at, and how often as many bytes
// as an array may have items in any case.
constexpr std::uint64_t most_passes = 8;

bool is_fallback(const Json& buffer) { return is_true(object_at(object_at(buffer, "extensions"), "EXT_meshopt_compression"), "fallback"); }

}  // namespace

void check_data(Asset& asset) {
  DataChecks checks(asset);
  check_buffer_files(checks);
  check_pictures(checks);
  check_values(checks);
  check_vertices(checks);
  check_influences(checks);
  check_motion(checks);
}

void check_buffer_files(DataChecks& checks) {
  const Json& buffers = array_at(checks.asset.json(), "buffers");
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string* uri = text_of(buffers[i], "uri");
    const std::string pointer = fmt::format("/buffers/{}", i);
    // Bytes that come from elsewhere, or that nobody wants.
    if (uri == nullptr && !(checks.asset.is_glb() && i == 0)) continue;
    if (is_fallback(buffers[i])) continue;
    if (uri != nullptr && !is_data_uri(*uri) && !is_relative(*uri) && !checks.asset.is_used("/buffers", i)) continue;
    const auto buffer = checks.asset.buffer(static_cast<int>(i));
    if (!buffer) {
      checks.asset.error(buffer.error());
      continue;
    }
    bytes += buffer->size();
    const std::uint64_t padded = (buffer->size() + 3) / 4 * 4, chunk = checks.asset.binary_size();
    if (uri == nullptr && chunk > padded)
      checks.asset.warning("BUFFER_GLB_CHUNK_TOO_BIG", fmt::format("the binary chunk has {} bytes more than the buffer", chunk - padded),
                           pointer);
  }
  const std::uint64_t at_least = std::min<std::uint64_t>(checks.asset.options().max_items, UINT64_MAX / most_passes);
  checks.budget = most_passes * std::max(at_least, std::min(bytes, checks.asset.options().max_memory));
}

std::optional<Elements> DataChecks::placed(std::int64_t view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride,
                                           const Format& format) {
  const View* record = records.view(view);
  const std::size_t element = element_bytes(format);
  if (record == nullptr || record->length == 0 || count == 0 || element == 0 || stride < element) return std::nullopt;
  const std::uint64_t bytes = extent(count, stride, element);
  if (offset > record->length || bytes > record->length - offset) return std::nullopt;
  if (bytes > budget) {
    asset.error(asset.over_limit(fmt::format("1/{} of the bytes that overlapping accessors read", most_passes), "max_items",
                                 asset.options().max_items, fmt::format("/bufferViews/{}", view)));
    budget = 0;
    return std::nullopt;
  }
  const auto shared = asset.view(static_cast<int>(view));
  if (!shared || offset > shared->size() || bytes > shared->size() - offset) return std::nullopt;
  budget -= bytes;
  return Elements{*shared, shared->data() + offset, static_cast<std::size_t>(stride), static_cast<std::size_t>(count), format};
}

std::optional<Elements> DataChecks::elements(std::int64_t index) {
  const Accessor* accessor = records.accessor(index);
  if (accessor == nullptr || !accessor->is_valid()) return std::nullopt;
  std::optional<Elements> base;
  if (const View* view = records.view(accessor->view)) {
    base = placed(accessor->view, accessor->offset, accessor->count, view->stride != 0 ? view->stride : tight_stride(accessor->format),
                  accessor->format);
    if (!base) return std::nullopt;
  }
  if (!accessor->is_sparse) return base;
  return patched(array_at(asset.json(), "accessors")[static_cast<std::size_t>(index)], *accessor, std::move(base));
}

// A copy with the sparse elements in their places.
std::optional<Elements> DataChecks::patched(const Json& source, const Accessor& accessor, std::optional<Elements> base) {
  const Json &sparse = object_at(source, "sparse"), &index_part = object_at(sparse, "indices"), &value_part = object_at(sparse, "values");
  const std::uint64_t count = uint_of(sparse, "count").value_or(0);
  const std::size_t stride = tight_stride(accessor.format), element = element_bytes(accessor.format);
  const Format index_format{Shape::scalar, static_cast<int>(uint_of(index_part, "componentType").value_or(0) & 0xFFFF)};
  if (count > accessor.count || accessor.count > asset.options().max_items || accessor.count * stride > budget) return std::nullopt;
  const auto indices = placed(index_of(index_part, "bufferView"), uint_of(index_part, "byteOffset").value_or(0), count,
                              component_bytes(index_format.component), index_format);
  const auto values =
      placed(index_of(value_part, "bufferView"), uint_of(value_part, "byteOffset").value_or(0), count, stride, accessor.format);
  if (!indices || !values) return std::nullopt;
  budget -= accessor.count * stride;
  std::vector<std::uint8_t> copy(accessor.count * stride, 0);
  if (base)
    for (std::size_t i = 0; i < accessor.count; ++i) std::memcpy(copy.data() + i * stride, base->first + i * base->stride, element);
  with_type(index_format.component, [&](auto type) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto target = static_cast<std::size_t>(value_at<decltype(type)>(*indices, i, 0));
      if (target < accessor.count) std::memcpy(copy.data() + target * stride, values->first + i * values->stride, element);
    }
  });
  const SharedBytes owner(std::move(copy));
  return Elements{owner, owner.data(), stride, accessor.count, accessor.format};
}

}  // namespace etendue::gltf
