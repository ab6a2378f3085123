// Buffers and bufferViews: URIs, lengths, strides, and that a view has one use.
#include <fmt/format.h>

#include "checks.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

void check_buffer(Checks& checks, const Json& source, const Path& path) {
  const std::string* uri = text_of(source, "uri");
  if (uri == nullptr) return;
  const Path here = path / "uri";
  if (checks.is_glb) checks.findings.note("URI_GLB", "a GLB that is not whole: it needs what this names", here);
  if (auto form = check_uri(*uri); !form) {
    checks.findings.error("INVALID_URI", form.error().text, here);
  } else if (is_data_uri(*uri)) {
    if (checks.is_glb) checks.findings.warning("DATA_URI_GLB", "a data URI where the binary chunk would be shorter", here);
    const std::string type = mime_type_of(*uri);
    if (type != "application/octet-stream" && type != "application/gltf-buffer")
      checks.findings.error("BUFFER_DATA_URI_MIME_TYPE_INVALID",
                            fmt::format("expected application/octet-stream or application/gltf-buffer, found \"{}\"", type), here);
  } else if (!is_relative(*uri)) {
    checks.findings.warning("NON_RELATIVE_URI", "not relative to the asset: it is never opened", here);
  }
}

void check_view(Checks& checks, const Json& source, const View& view, const Path& path) {
  const Path offset = path / "byteOffset", length = path / "byteLength", stride = path / "byteStride";
  if (view.stride != 0) {
    if (view.length != 0 && view.stride > view.length)
      checks.findings.error("BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
                            fmt::format("byteStride {} is greater than byteLength {}", view.stride, view.length), stride);
    if (view.stride % 4 != 0)
      checks.findings.error("VALUE_MULTIPLE_OF", fmt::format("expected a multiple of 4, found {}", view.stride), stride);
    if (view.usage == Usage::indices)
      checks.findings.error("BUFFER_VIEW_INVALID_BYTE_STRIDE", "a byteStride belongs to vertex attributes, not to indices", stride);
  }
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= checks.records.buffers.size()) return;
  const std::uint64_t size = checks.records.buffers[static_cast<std::size_t>(view.buffer)].length;
  if (size == 0 || !source.is_object()) return;
  if (view.offset >= size) {
    checks.findings.error("BUFFER_VIEW_TOO_LONG",
                          fmt::format("begins at byte {} of buffer {}, which has {}", view.offset, view.buffer, size), offset);
  } else if (view.length > size - view.offset) {
    checks.findings.error("BUFFER_VIEW_TOO_LONG",
                          fmt::format("{} bytes from byte {} on go beyond buffer {} of {}", view.length, view.offset, view.buffer, size),
                          length);
  }
}

// EXT_meshopt_compression: the compressed bytes of a view, and what they become.
void check_meshopt(Checks& checks, const Json& source, const View& view, const Path& path) {
  const Json& meshopt = object_at(object_at(source, "extensions"), "EXT_meshopt_compression");
  if (meshopt.empty()) return;
  const Path extensions = path / "extensions", here = extensions / "EXT_meshopt_compression";
  const std::uint64_t offset = uint_of(meshopt, "byteOffset").value_or(0), length = uint_of(meshopt, "byteLength").value_or(0);
  const std::uint64_t count = uint_of(meshopt, "count").value_or(0), stride = uint_of(meshopt, "byteStride").value_or(0);
  const std::int64_t buffer = index_of(meshopt, "buffer");
  if (buffer >= 0 && static_cast<std::size_t>(buffer) < checks.records.buffers.size()) {
    const std::uint64_t size = checks.records.buffers[static_cast<std::size_t>(buffer)].length;
    if (size != 0 && (offset >= size || length > size - offset))
      checks.findings.error("BUFFER_VIEW_TOO_LONG",
                            fmt::format("{} compressed bytes from byte {} on go beyond buffer {} of {}", length, offset, buffer, size),
                            here);
  }
  if (stride >= 2 && stride <= 256 && view.length != 0 && count * stride != view.length)
    checks.findings.error("MESHOPT_LENGTH_MISMATCH",
                          fmt::format("{} elements of {} bytes do not make the view's {}", count, stride, view.length), here);
  const std::string* mode = text_of(meshopt, "mode");
  if (mode == nullptr) return;
  const bool good = *mode == "ATTRIBUTES" ? stride % 4 == 0 : stride == 2 || stride == 4;
  if (!good || (*mode == "TRIANGLES" && count % 3 != 0))
    checks.findings.error("MESHOPT_LAYOUT_INVALID",
                          fmt::format("{} elements of {} bytes are not what the mode {} stores", count, stride, *mode), here);
}

}  // namespace

void check_buffers(Checks& checks) {
  const Path root, buffers = root / "buffers", views = root / "bufferViews";
  const Json &buffer_array = array_at(checks.root, "buffers"), &view_array = array_at(checks.root, "bufferViews");
  for (std::size_t i = 0; i < buffer_array.size(); ++i) check_buffer(checks, buffer_array[i], buffers / i);
  for (std::size_t i = 0; i < view_array.size(); ++i) {
    check_view(checks, view_array[i], checks.records.views[i], views / i);
    check_meshopt(checks, view_array[i], checks.records.views[i], views / i);
  }
}

void use_view(Checks& checks, std::int64_t index, Usage usage, const Path& user) {
  View* view = checks.records.view(index);
  if (view == nullptr) return;
  if (view->usage == Usage::none) view->usage = usage;
  if (view->usage != usage)
    checks.findings.error("BUFFER_VIEW_TARGET_OVERRIDE",
                          fmt::format("bufferView {} is for {}, and used for {} here", index, name_of(view->usage), name_of(usage)), user);
}

}  // namespace etendue::gltf
