#include "pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "mapped_file.h"
#include "picture_header.h"

namespace etendue::cli {
namespace {

void use(std::vector<Picture>& pictures, std::uint32_t image, std::string what) {
  if (image >= pictures.size()) return;
  auto& uses = pictures[image].uses;
  if (std::find(uses.begin(), uses.end(), what) == uses.end()) uses.push_back(std::move(what));
}

std::string use_of(const std::string& role, const Texture& texture) {
  return role + (texture.encoding == Encoding::srgb ? " (sRGB)" : " (linear)");
}

}  // namespace

std::vector<Picture> pictures_of(const Scene& scene) {
  std::vector<Picture> pictures;
  for (const ImageRef& image : scene.images) {
    Picture picture;
    picture.name = image.name.empty() ? image.file : image.name;
    SharedBytes bytes = image.embedded;
    if (!bytes && !image.file.empty()) {
      constexpr std::uint64_t any_size = ~std::uint64_t{0};
      if (auto mapped = map_file(image.file, any_size)) bytes = std::move(*mapped);
    }
    picture.bytes = bytes.size();
    if (const auto header = picture_header(bytes.bytes())) {
      picture.format = header->format;
      picture.width = header->width;
      picture.height = header->height;
    }
    pictures.push_back(std::move(picture));
  }
  for (const Material& material : scene.materials)
    for_each_texture(material,
                     [&](const std::string& role, const Texture& texture) { use(pictures, texture.image, use_of(role, texture)); });
  for (const Light& light : scene.lights) {
    if (light.emission.texture) use(pictures, light.emission.texture->image, use_of("emission", *light.emission.texture));
    if (const auto* sky = std::get_if<EnvironmentShape>(&light.shape)) {
      if (sky->image) use(pictures, *sky->image, "environment");
      for (const std::uint32_t face : sky->cube) use(pictures, face, "environment, a face of its cube");
    }
  }
  return pictures;
}

std::string bytes_text(std::uint64_t bytes) {
  const auto x = static_cast<double>(bytes);
  if (bytes < 1000) return fmt::format("{} B", bytes);
  return bytes < 1'000'000 ? fmt::format("{:.3g} kB", x / 1e3) : fmt::format("{:.3g} MB", x / 1e6);
}

std::string describe(const Picture& picture) {
  std::vector<std::string> parts;
  parts.push_back(picture.format.empty() ? (picture.bytes > 0 ? "unknown format" : "not looked at") : picture.format);
  if (picture.width > 0) parts.back() += fmt::format(" {} x {}", picture.width, picture.height);
  if (picture.bytes > 0) parts.push_back(bytes_text(picture.bytes));
  parts.insert(parts.end(), picture.uses.begin(), picture.uses.end());
  if (picture.uses.empty()) parts.emplace_back("used by nothing");
  return fmt::format("{}", fmt::join(parts, ", "));
}

Json to_json(const ImageRef& image, const Picture& picture) {
  Json json = {{"name", image.name}, {"file", image.file}, {"mime_type", image.mime_type}};
  if (!picture.format.empty()) json["format"] = picture.format;
  if (picture.width > 0) {
    json["width"] = picture.width;
    json["height"] = picture.height;
  }
  if (picture.bytes > 0) json["bytes"] = picture.bytes;
  if (!picture.uses.empty()) json["uses"] = picture.uses;
  return json;
}

}  // namespace etendue::cli
