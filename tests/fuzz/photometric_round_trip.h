// What a fuzz target asks of a photometric file that was read: it is valid, its flux is finite, and written it comes back to the last bit.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "etendue/intensity_web.h"
#include "exporters/photometry/options.h"
#include "importers/photometry/options.h"

namespace etendue::fuzz {

using Read = Result<PhotometricFile>(std::span<const std::byte>, const std::string&, const PhotometricOptions&);
using Write = Result<PhotometricText>(const IntensityDistribution&, const PhotometricWriteOptions&);

[[noreturn]] inline void stop(const char* why, const std::string& detail = {}) {
  std::fprintf(stderr, "%s %s\n", why, detail.c_str());
  std::abort();
}

inline void round_trip(const std::uint8_t* data, std::size_t size, Read* read, Write* write) {
  const auto bytes = std::as_bytes(std::span(data, size));
  for (const PhotometricMode mode : {PhotometricMode::strict, PhotometricMode::header_only}) {
    PhotometricOptions options;
    options.mode = mode;
    (void)read(bytes, "fuzz", options);
  }
  const Result<PhotometricFile> file = read(bytes, "fuzz", {});
  if (!file) {
    if (file.error().code.empty() || file.error().where.line < 1 || file.error().where.column < 1) stop("an error without code or place");
    return;
  }
  const IntensityDistribution& d = file->distribution;
  if (const Status valid = check(d); !valid) stop("read, but not valid:", valid.error().text);
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cosine, Interpolation::cubic}) {
    const Result<IntensityWeb> web = IntensityWeb::of(d, interpolation);
    if (!web) stop("valid, but no web");
    if (!(web->flux_lm() >= 0)) stop("flux is negative or NaN");
    const double found = web->at(12.5, 33);
    if (!(found >= 0 && found <= web->max_cd())) stop("an intensity out of range");
  }
  PhotometricWriteOptions options;
  if (const auto* ies = std::get_if<IesRecord>(&d.record)) options.version = ies->version;
  const Result<PhotometricText> text = write(d, options);
  if (!text) stop("valid, but not written:", text.error().text);
  const Result<PhotometricFile> again = read(std::as_bytes(std::span(text->text)), "again", {});
  if (!again) stop("written, but not read:", again.error().code + " " + again.error().text);
  if (again->distribution.grid.values != d.grid.values && d.grid.symmetry != WebSymmetry::about_90_270 &&
      d.grid.symmetry != WebSymmetry::none)
    stop("values changed");
  if (candelas_per_value(again->distribution) != candelas_per_value(d)) stop("factors changed");
}

}  // namespace etendue::fuzz
