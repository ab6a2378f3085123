// Images opened through OpenImageIO, from files or from bytes inside an asset.
#pragma once

#include "etendue/image.h"
#include "etendue/result.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <memory>
#include <string>

namespace etendue {

struct ImageFile {
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  // outlives its reader
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  bool srgb = false;  // whether its colours are to be decoded
};
// Flat, of 1 to 64 channels, colours as stored and not multiplied by alpha. Errors: FILE_UNREADABLE, PICTURE_UNSUITABLE.
Result<ImageFile> open_image(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels);

std::string shown_name(const ImageRef& image);
Error unreadable(const ImageRef& image, std::string text);

}  // namespace etendue
