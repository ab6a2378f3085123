// Pictures: their first bytes against what the document says of them, and their size against the limit. Nothing is decoded.
#include <fmt/format.h>

#include <fstream>

#include "data_checks.h"
#include "picture_header.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

// Metadata may stand before the size: what is read of a file at most.
constexpr std::size_t largest_head = std::size_t{1} << 20;

std::vector<std::byte> head_of_file(const std::filesystem::path& file) {
  std::vector<std::byte> head(largest_head);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

bool is_power_of_two(std::uint32_t x) { return x != 0 && (x & (x - 1)) == 0; }

class PictureCheck {
 public:
  PictureCheck(DataChecks& checks, const Json& image, std::size_t index)
      : asset_(checks.asset), image_(image), index_(index), pointer_(fmt::format("/images/{}", index)) {}

  void run() {
    const std::string* uri = text_of(image_, "uri");
    if (const std::int64_t view = index_of(image_, "bufferView"); view >= 0) {
      if (const auto bytes = asset_.view(static_cast<int>(view))) check_bytes(bytes->bytes(), "/bufferView");
    } else if (uri != nullptr && is_data_uri(*uri)) {
      check_bytes(head_of_data_uri(*uri, largest_head), "/uri");
    } else if (uri != nullptr) {
      check_file(*uri);
    }
  }

 private:
  void check_file(const std::string& uri) {
    const auto file = file_inside(asset_.folder(), uri);
    if (file) return check_bytes(head_of_file(*file), "/uri");
    // Nobody opens what nothing uses.
    if (asset_.is_used("/images", index_) || file.error().code != "PATH_OUTSIDE_FOLDER")
      return asset_.error(asset_.failure(file.error().code, file.error().text, pointer_ + "/uri"));
    asset_.warning(file.error().code, file.error().text + "; nothing uses it", pointer_ + "/uri");
  }

  void check_bytes(std::span<const std::byte> bytes, const char* where) {
    const auto header = picture_header(bytes);
    // The validator leaves a kind that it does not know to the reader.
    if (!header || header->mime_type[0] == '\0')
      return asset_.warning("IMAGE_UNRECOGNIZED_FORMAT", "the bytes are of no kind of picture that glTF knows", pointer_);
    if (header->fault == PictureFault::malformed)
      return asset_.error("IMAGE_DATA_INVALID", fmt::format("its header is none of a {}", header->format), pointer_);
    // More metadata than is read here is no fault.
    if (header->fault == PictureFault::cut_off && bytes.size() < largest_head)
      return asset_.error("IMAGE_UNEXPECTED_EOS", "the picture ends inside its header", pointer_);
    if (header->channels != 0 && header->channels != 1 && header->channels != 3)
      return asset_.error("IMAGE_DATA_INVALID", fmt::format("expected a JPEG of 1 or 3 channels, found {}", header->channels), pointer_);
    const std::string* declared = text_of(image_, "mimeType");
    if (declared != nullptr && *declared != header->mime_type)
      asset_.error("IMAGE_MIME_TYPE_INVALID", fmt::format("expected {}, found {}", *declared, header->mime_type), pointer_ + where);
    if (!is_enabled(header->mime_type))
      asset_.error("IMAGE_NON_ENABLED_MIME_TYPE", fmt::format("{} needs an extension in extensionsUsed", header->mime_type), pointer_);
    if (header->width == 0) return;
    if (!is_power_of_two(header->width) || !is_power_of_two(header->height))
      asset_.note("IMAGE_NPOT_DIMENSIONS", fmt::format("{} x {} are not powers of two", header->width, header->height), pointer_);
    const std::uint64_t pixels = std::uint64_t{header->width} * header->height;
    if (pixels > asset_.options().max_pixels)
      asset_.error(asset_.over_limit(fmt::format("a picture of {} pixels", pixels), "max_pixels", asset_.options().max_pixels, pointer_));
  }

  bool is_enabled(const std::string& mime_type) const {
    if (mime_type == "image/png" || mime_type == "image/jpeg") return true;
    const char* extension = mime_type == "image/webp"   ? "EXT_texture_webp"
                            : mime_type == "image/ktx2" ? "KHR_texture_basisu"
                                                        : "EXT_texture_avif";
    for (const Json& name : array_at(asset_.json(), "extensionsUsed"))
      if (name == extension) return true;
    return false;
  }

  Asset& asset_;
  const Json& image_;
  std::size_t index_;
  std::string pointer_;
};

}  // namespace

void check_pictures(DataChecks& checks) {
  const Json& images = array_at(checks.asset.json(), "images");
  for (std::size_t i = 0; i < images.size(); ++i) PictureCheck(checks, images[i], i).run();
}

}  // namespace etendue::gltf
