#include "photometric_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "importers/photometry/scene.h"

namespace etendue {
namespace {

using Distribution = std::shared_ptr<const IntensityDistribution>;

// By content: what has a TILT line is LM-63, whatever its name ends in.
Result<PhotometricFile> read_bytes(std::span<const std::byte> bytes, const std::string& name, const PhotometricOptions& options) {
  const std::unique_ptr<Importer> ies = make_ies_importer();
  return ies->sniff(bytes) > 0 ? read_ies(bytes, name, options) : read_eulumdat(bytes, name, options);
}

// A web is evaluated as a point. A Lambertian disk of radius R gives 1 / (1 + (R / d)^2) of what its intensity at a point would: 1 % less
// from five diameters.
void warn_of_opening(const IntensityDistribution& distribution, const Light& light, const std::string& file, Diagnostics& found) {
  constexpr double small_sphere_m = 0.1, diameters = 5;
  const LuminousOpening opening = opening_of(distribution);
  const double largest = std::max({opening.width_m, opening.length_m, opening.height_m});
  if (!(largest > small_sphere_m)) return;
  found.warning("OPENING_AS_POINT",
                fmt::format("the {} of '{}', {:.4g} m at its largest, is evaluated as a point: within 1 % from {:.3g} m on",
                            name_of(opening.shape), light.name, largest, diameters * largest),
                {file, 0, 0, light.source});
}

Distribution read_one(const PhotometricShape& shape, const Light& light, std::uint64_t max_bytes, Diagnostics& found) {
  const auto fail = [&](const Error& error) {
    found.add(to_diagnostic(error));
    found.note("LIGHT_WITHOUT_WEB", fmt::format("the photometric light '{}' stays dark", light.name), {shape.file, 0, 0, light.source});
    return Distribution();
  };
  Result<PhotometricFile> file = Error{};
  if (shape.embedded) {
    const std::string name = shape.file.empty() ? light.name : shape.file;
    file = read_bytes(shape.embedded.bytes(), name, {});
  } else {
    const Result<std::vector<std::byte>> bytes = read_file(shape.file, max_bytes);
    if (!bytes) return fail(bytes.error());
    file = read_bytes(*bytes, shape.file, photometric::with_neighbours({}, shape.file, max_bytes));
  }
  if (!file) return fail(file.error());
  found.append(file->diagnostics);
  warn_of_opening(file->distribution, light, shape.file, found);
  return std::make_shared<const IntensityDistribution>(std::move(file->distribution));
}

}  // namespace

Diagnostics read_photometric_lights(Scene& scene, std::uint64_t max_bytes) {
  Diagnostics found;
  std::map<std::string, Distribution> by_file;
  for (Light& light : scene.lights) {
    auto* const shape = std::get_if<PhotometricShape>(&light.shape);
    if (shape == nullptr || shape->distribution) continue;
    if (shape->embedded) {
      shape->distribution = read_one(*shape, light, max_bytes, found);
      continue;
    }
    const auto [known, fresh] = by_file.try_emplace(shape->file);
    if (fresh) known->second = read_one(*shape, light, max_bytes, found);
    shape->distribution = known->second;
  }
  return found;
}

}  // namespace etendue
