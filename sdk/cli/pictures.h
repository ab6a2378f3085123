// The pictures of a scene: what their headers say, and what they are for.
#pragma once

#include <string>
#include <vector>

#include "etendue/scene.h"
#include "session.h"

namespace etendue::cli {

struct Picture {
  std::string name, format;  // "png"; "" if the bytes are of no known format or were not asked for
  std::uint32_t width = 0, height = 0;
  std::uint64_t bytes = 0;        // encoded; 0 if unknown
  std::vector<std::string> uses;  // "base_colour, sRGB"
};
// One for each image; nothing is decoded.
std::vector<Picture> pictures_of(const Scene& scene);

std::string bytes_text(std::uint64_t bytes);  // "34 kB"
std::string describe(const Picture& picture);
Json to_json(const ImageRef& image, const Picture& picture);

}  // namespace etendue::cli
