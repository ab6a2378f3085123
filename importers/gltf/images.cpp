// Where the pixels of an image are: a file, or encoded bytes inside the asset. Nothing is decoded, no image file is opened.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "json_values.h"
#include "materials.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

Result<ImageRef> read_image(Asset& asset, const nlohmann::json& source, const std::string& pointer) {
  ImageRef image;
  image.mime_type = text_or(source, "mimeType", "");
  const std::string uri = text_or(source, "uri", "");
  image.name = text_or(source, "name", is_data_uri(uri) || uri.empty() ? "image " + pointer.substr(pointer.rfind('/') + 1) : uri);
  const bool wanted = has(asset.options().need, Need::images);
  if (!wanted) ++asset.stats.skipped_images;

  if (source.contains("uri") == source.contains("bufferView"))
    return asset.failure("INVALID_IMAGE", "expected either uri or bufferView", pointer);
  if (source.contains("bufferView")) {
    if (!wanted) return image;
    auto bytes = asset.view(int_index_of(source, "bufferView"));
    if (!bytes) return bytes.error();
    image.embedded = std::move(*bytes);
  } else if (is_data_uri(uri)) {
    if (!wanted) return image;
    auto data = asset.data_of(uri, pointer + "/uri");
    if (!data) return data.error();
    if (image.mime_type.empty()) image.mime_type = mime_type_of(uri);
    image.embedded = std::move(*data);
  } else {
    const auto path = file_inside(asset.folder(), uri);
    if (!path) return asset.failure(path.error().code, path.error().text, pointer + "/uri");
    image.file = path->string();
  }
  return image;
}

}  // namespace

std::optional<std::uint32_t> Materials::image(int index) {
  if (const auto found = images_.find(index); found != images_.end()) return found->second;
  const std::string pointer = fmt::format("/images/{}", index);
  asset_.take(pointer);
  const nlohmann::json::json_pointer place(pointer);
  std::optional<std::uint32_t> result;
  if (asset_.json().contains(place) && asset_.json().at(place).is_object()) {
    auto image = read_image(asset_, asset_.json().at(place), pointer);
    if (image) {
      result = static_cast<std::uint32_t>(scene_.images.size());
      scene_.images.push_back(std::move(*image));
    } else {
      asset_.error(image.error());
    }
  }
  images_.emplace(index, result);
  return result;
}

}  // namespace etendue::gltf
