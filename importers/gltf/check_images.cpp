// Images and textures: where the bytes are, and of what kind they say that they are.
#include <fmt/format.h>

#include <algorithm>

#include "checks.h"
#include "picture_header.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

// By its first bytes; "" for what no texture may be.
std::string type_of_data(std::string_view uri) {
  const auto header = picture_header(head_of_data_uri(uri, picture_signature_size));
  return header ? header->mime_type : "";
}

std::vector<std::string> mime_types(const Checks& checks) {
  std::vector<std::string> types = {"image/jpeg", "image/png"};
  if (checks.declares("EXT_texture_webp")) types.push_back("image/webp");
  if (checks.declares("KHR_texture_basisu")) types.push_back("image/ktx2");
  if (checks.declares("EXT_texture_avif")) types.push_back("image/avif");
  return types;
}

void check_image_uri(Checks& checks, const std::string& uri, const Path& path) {
  if (checks.is_glb) checks.findings.note("URI_GLB", "a GLB that is not whole: it needs what this names", path);
  if (auto form = check_uri(uri); !form) return checks.findings.error("INVALID_URI", form.error().text, path);
  if (!is_data_uri(uri)) {
    if (!is_relative(uri)) checks.findings.warning("NON_RELATIVE_URI", "not relative to the asset: it is never opened", path);
    return;
  }
  if (checks.is_glb) checks.findings.warning("DATA_URI_GLB", "a data URI where the binary chunk would be shorter", path);
  const std::string declared = mime_type_of(uri);
  const std::string found = type_of_data(uri);
  if (declared != found)
    checks.findings.error("INVALID_URI",
                          fmt::format("the data URI says \"{}\", its bytes are {}", declared, found.empty() ? "no known picture" : found),
                          path);
}

void check_image(Checks& checks, const Json& source, const Path& path) {
  if (!source.is_object()) return;
  const Path view_path = path / "bufferView", mime_path = path / "mimeType";
  const std::int64_t view = index_of(source, "bufferView");
  const std::string *uri = text_of(source, "uri"), *mime_type = text_of(source, "mimeType");
  if (view >= 0 && mime_type == nullptr)
    checks.findings.error("UNSATISFIED_DEPENDENCY", "expected mimeType beside bufferView, which is missing", view_path);
  if ((view >= 0) == (uri != nullptr))
    checks.findings.error("ONE_OF_MISMATCH", fmt::format("expected either bufferView or uri, found {}", view >= 0 ? "both" : "none"), path);
  if (mime_type != nullptr) {
    const auto types = mime_types(checks);
    if (std::find(types.begin(), types.end(), *mime_type) == types.end())
      checks.findings.warning("VALUE_NOT_IN_LIST", fmt::format("expected image/jpeg or image/png, found \"{}\"", *mime_type), mime_path);
  }
  if (uri != nullptr) check_image_uri(checks, *uri, path / "uri");
  if (const View* found = checks.records.view(view)) {
    use_view(checks, view, Usage::image, view_path);
    if (found->stride != 0)
      checks.findings.error("IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "a picture lies in a view without byteStride", view_path);
  }
}

// The image that a texture or its extension names is of the right kind.
void check_source(Checks& checks, const Json& holder, const std::vector<std::string>& allowed, const Path& path) {
  const Json& images = array_at(checks.root, "images");
  const std::int64_t source = index_of(holder, "source");
  if (source < 0 || static_cast<std::size_t>(source) >= images.size()) return;
  const Json& image = images[static_cast<std::size_t>(source)];
  const std::string *uri = text_of(image, "uri"), *declared = text_of(image, "mimeType");
  const std::string type = declared != nullptr ? *declared : uri != nullptr && is_data_uri(*uri) ? type_of_data(*uri) : "";
  if (!type.empty() && std::find(allowed.begin(), allowed.end(), type) == allowed.end())
    checks.findings.error("TEXTURE_INVALID_IMAGE_MIME_TYPE", fmt::format("expected an image of {}, found {}", allowed.front(), type),
                          path / "source");
}

}  // namespace

void check_images(Checks& checks) {
  const Path root, images = root / "images", textures = root / "textures";
  const Json &image_array = array_at(checks.root, "images"), &texture_array = array_at(checks.root, "textures");
  for (std::size_t i = 0; i < image_array.size(); ++i) check_image(checks, image_array[i], images / i);
  for (std::size_t i = 0; i < texture_array.size(); ++i) {
    const Path path = textures / i, extensions = path / "extensions";
    check_source(checks, texture_array[i], {"image/png", "image/jpeg"}, path);
    const Json& objects = object_at(texture_array[i], "extensions");
    if (checks.declares("EXT_texture_webp"))
      check_source(checks, object_at(objects, "EXT_texture_webp"), {"image/webp"}, extensions / "EXT_texture_webp");
    if (checks.declares("KHR_texture_basisu"))
      check_source(checks, object_at(objects, "KHR_texture_basisu"), {"image/ktx2"}, extensions / "KHR_texture_basisu");
    if (checks.declares("EXT_texture_avif"))
      check_source(checks, object_at(objects, "EXT_texture_avif"), {"image/avif"}, extensions / "EXT_texture_avif");
  }
}

}  // namespace etendue::gltf
