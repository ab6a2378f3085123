// ImageRef: where pixels are and what they mean. Nothing is opened or decoded here.
#pragma once

#include "etendue/bytes.h"
#include "etendue/vec.h"

#include <cstdint>
#include <string>

namespace etendue {

// How the numbers of a file become linear values.
enum class Encoding { linear, srgb };

// Pixels in a file, or in bytes that an asset carries inside itself (an encoded PNG or JPEG, not decoded). Neither where the pixels were
// not asked for (Need).
struct ImageRef {
  std::string file;  // absolute or relative to the working directory; "" if embedded
  SharedBytes embedded = {};
  std::string mime_type;  // as authored, may be ""
  std::string name;       // for messages
};

enum class Wrap { repeat, mirror, clamp };

// A lookup into an image: v = 0 is the first row, as in glTF.
struct Texture {
  std::uint32_t image = 0;  // index into Scene::images
  Encoding encoding = Encoding::linear;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;
  // uv' = (m00 u + m01 v + m02, m10 u + m11 v + m12), KHR_texture_transform.
  double uv_transform[2][3] = {{1, 0, 0}, {0, 1, 0}};
  int uv_set = 0;
  friend bool operator==(const Texture&, const Texture&) = default;
};

}  // namespace etendue
