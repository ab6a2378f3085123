// What writers of photometric files share.
#pragma once

#include "etendue/intensity_web.h"
#include "etendue/io.h"

#include <string>

namespace etendue {

struct PhotometricWriteOptions {
  IesVersion version = IesVersion::lm_63_2002;  // of an .ies file
  // Across formats: turn from one convention of C0 to the other (intensity_web.h); else the planes keep their numbers.
  bool turn = true;
};

struct PhotometricText {
  std::string text;  // lines end in CR LF
  LossReport losses;
};

}  // namespace etendue
