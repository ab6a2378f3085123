#include "photometric_convert.h"

#include <fmt/format.h>

#include "etendue/photometric_transform.h"
#include "exporters/eulumdat/eulumdat.h"
#include "exporters/ies/ies.h"

namespace etendue::cli {
namespace {

Result<IesVersion> version_of(const std::string& year) {
  for (const IesVersion version :
       {IesVersion::lm_63_1986, IesVersion::lm_63_1991, IesVersion::lm_63_1995, IesVersion::lm_63_2002, IesVersion::lm_63_2019})
    if (name_of(version) == year) return version;
  return Error{"USAGE", fmt::format("--year: expected 1986, 1991, 1995, 2002 or 2019, found '{}'", year), {}, "", {}};
}

}  // namespace

Result<ConvertedPhotometry> convert_photometric(const PhotometricReading& reading, const ConvertChoice& choice) {
  ConvertedPhotometry done;
  IntensityDistribution d = reading.distribution;
  if (!choice.flux.empty()) {
    const Result<double> flux = parse_si(choice.flux, Dimension::luminous_flux);
    if (!flux) return Error{"USAGE", "--flux: " + flux.error().text, {}, "as in --flux \"1500 lm\"", {}};
    Result<IntensityDistribution> scaled = scaled_to_flux(std::move(d), *flux);
    if (!scaled) return scaled.error();
    d = std::move(*scaled);
  }
  if (choice.turn_deg != 0) {
    Result<IntensityGrid> other = turned(d.grid, choice.turn_deg);
    if (!other) return other.error();
    d = with_grid(std::move(d), std::move(*other));
    done.losses.add("luminous opening", "keeps its place: the light alone is turned");
  }
  if (!choice.resample_deg.empty()) {
    Result<ResampledGrid> other =
        resampled(d.grid, vertical_steps(d.grid, choice.resample_deg.front()), horizontal_steps(d.grid, choice.resample_deg.back()));
    if (!other) return other.error();
    done.resample_error_cd = other->error * candelas_per_value(d);
    if (other->error > 0)
      done.losses.add("intensities between the new angles", fmt::format("differ by up to {:.4g} cd", done.resample_error_cd));
    d = with_grid(std::move(d), std::move(other->grid));
  }
  if (choice.fold) {
    FoldedGrid smaller = folded(d.grid, *choice.fold);
    done.fold_error_cd = smaller.error * candelas_per_value(d);
    if (smaller.error > 0)
      done.losses.add("planes that mirror each other", fmt::format("the first is kept: up to {:.4g} cd anywhere", done.fold_error_cd));
    if (smaller.grid.symmetry != d.grid.symmetry) d = with_grid(std::move(d), std::move(smaller.grid));
  }
  const Result<IesVersion> version = version_of(choice.year);
  if (!version) return version.error();
  const PhotometricWriteOptions options{*version, !choice.same_planes};
  const std::string extension = choice.out.extension().string();
  if (extension != ".ies" && extension != ".ldt")
    return Error{"USAGE", fmt::format("--convert: expected a name that ends in .ies or .ldt, found '{}'", choice.out.string()), {}, "", {}};
  std::error_code code;
  if (std::filesystem::exists(choice.out, code) && !choice.force)
    return Error{"USAGE", fmt::format("{} is there already", choice.out.string()), {}, "--force replaces it", {}};
  const Result<PhotometricText> written = extension == ".ies" ? write_ies(d, options) : write_eulumdat(d, options);
  if (!written) return written.error();
  const Status saved = write_file(choice.out, std::as_bytes(std::span(written->text)));
  if (!saved) return saved.error();
  for (const Loss& loss : written->losses.losses) done.losses.losses.push_back(loss);
  return done;
}

}  // namespace etendue::cli
