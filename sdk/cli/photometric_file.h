// A photometric file as the verb `ies` sees it: read, made ready, and what is wrong with it.
#pragma once

#include "etendue/photometric_quantities.h"
#include "session.h"

namespace etendue::cli {

struct PhotometricChoice {
  Interpolation interpolation = Interpolation::linear;
  std::optional<Orientation> orientation;  // none: the file's own
  std::size_t lamp_set = 0;
  bool strict = false;
};

struct PhotometricReading {
  std::string file, format;
  IntensityDistribution distribution;
  IntensityWeb web;
  double flux_zonal_lm = 0;
  Diagnostics diagnostics;
  std::optional<Error> error;  // then there is nothing but it
};

PhotometricReading read_photometric(const std::string& file, const PhotometricChoice& choice);

// The keys of `ies --json` (CLI.md).
Json to_json(const PhotometricReading& reading);
std::string csv_header();
std::string csv_row(const PhotometricReading& reading);

// For people: what the file says, with a polar diagram.
enum class Units { metric, imperial };
std::string report_of(const PhotometricReading& reading, Units units);
std::string polar_diagram(const IntensityWeb& web);

// Beam diameter and illuminance at its centre, facing the light, at each distance in metres.
struct ConeRow {
  double distance_m = 0, diameter_c0_m = 0, diameter_c90_m = 0, centre_lx = 0;
  bool known = false;  // false: nothing at gamma 0, or a beam of 180 degrees or more
};
ConeRow cone_at(const IntensityWeb& web, double distance_m);

}  // namespace etendue::cli
