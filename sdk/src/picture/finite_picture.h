// Pictures whose numbers are to be computed with.
#pragma once

#include "etendue/picture.h"
#include "image_file.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace etendue {

// decode(), and PICTURE_UNSUITABLE with the pixel where a number is not finite.
inline Result<DecodedImage> decode_finite(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels) {
  Result<DecodedImage> picture = decode(image, encoding, max_pixels);
  if (!picture) return picture;
  const auto bad = std::find_if(picture->rgba.begin(), picture->rgba.end(), [](float v) { return !std::isfinite(v); });
  if (bad == picture->rgba.end()) return picture;
  const auto pixel = static_cast<std::size_t>(bad - picture->rgba.begin()) / 4;
  return Error{"PICTURE_UNSUITABLE",
               "expected finite numbers, found another one at pixel (" + std::to_string(pixel % picture->width) + ", " +
                   std::to_string(pixel / picture->width) + ")",
               {shown_name(image), 0, 0, {}},
               {},
               {}};
}

}  // namespace etendue
