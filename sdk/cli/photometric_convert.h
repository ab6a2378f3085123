// etendue ies --convert: one photometric file into another format or version.
#pragma once

#include <filesystem>

#include "photometric_file.h"

namespace etendue::cli {

struct ConvertChoice {
  std::filesystem::path out;         // .ies or .ldt
  std::string year = "2002";         // of .ies
  std::string flux;                  // scale to this, as "1500 lm"
  std::optional<double> fold;        // fold mirrored planes that differ by less than this share of the peak
  double turn_deg = 0;               // added to every C angle
  std::vector<double> resample_deg;  // step of the vertical angles, and of the horizontal ones
  bool same_planes = false;          // keep the C angles' numbers across formats
  bool force = false;
};

struct ConvertedPhotometry {
  LossReport losses;
  double fold_error_cd = 0, resample_error_cd = 0;
};
Result<ConvertedPhotometry> convert_photometric(const PhotometricReading& reading, const ConvertChoice& choice);

}  // namespace etendue::cli
