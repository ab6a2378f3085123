// What readers of photometric files share: how strict they are, and what they give back.
#pragma once

#include "etendue/photometry.h"
#include "etendue/result.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

enum class PhotometricMode {
  strict,      // what a tolerant reading would repair is an error
  tolerant,    // every repair is a warning that says where and what was done
  header_only  // everything but angles and values, which stay empty
};

struct PhotometricOptions {
  PhotometricMode mode = PhotometricMode::tolerant;
  std::size_t lamp_set = 0;  // of EULUMDAT's alternatives
  // The bytes of the file that TILT names. Without it, or if it fails, the tilt stays unresolved, with a warning.
  std::function<Result<std::vector<std::byte>>(const std::string& name)> tilt_file;
};

struct PhotometricFile {
  IntensityDistribution distribution;
  Diagnostics diagnostics;  // warnings are repairs or doubts; notes change nothing
};

}  // namespace etendue
