#include "scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "etendue/photometric_transform.h"

namespace etendue::photometric {
namespace {

const PhotometricShape* photometric(const Light& light) { return std::get_if<PhotometricShape>(&light.shape); }

void report_the_rest(const Scene& scene, const Light& light, LossReport& losses) {
  if (scene.lights.size() > 1)
    losses.add(fmt::format("{} other lights", scene.lights.size() - 1), "left out: the format holds one luminaire");
  if (!scene.objects.empty()) losses.add(fmt::format("{} objects", scene.objects.size()), "left out: the format holds one luminaire");
  if (!(light.transform == Transform{})) losses.add("place and rotation of the light", "left out: the web stays as it was measured");
  const auto* rgb = std::get_if<RgbColour>(&light.colour);
  if (rgb == nullptr || !(rgb->rgb == Rgb{1, 1, 1}) || !(light.filter == Rgb{1, 1, 1}))
    losses.add("colour and filter", "left out: the format has none");
}

}  // namespace

Result<Exported> write_scene(const Scene& scene, const std::filesystem::path& file, WritePhotometric* write) {
  const auto count = std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return photometric(l) != nullptr; });
  if (count != 1)
    return Error{"EXPORT_UNSUPPORTED",
                 fmt::format("expected a scene with one photometric light, found {}", count),
                 {scene.file, 0, 0, {}},
                 "the format holds one luminaire",
                 {}};
  const Light& light = *std::find_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return photometric(l) != nullptr; });
  if (!photometric(light)->distribution)
    return Error{"EXPORT_UNSUPPORTED",
                 fmt::format("the file of the photometric light '{}' was not read", light.name),
                 {scene.file, 0, 0, {}},
                 {},
                 {}};
  Result<IntensityDistribution> distribution = *photometric(light)->distribution;
  if (light.emission.given == Emission::Given::flux) distribution = scaled_to_flux(std::move(*distribution), light.emission.value);
  if (!distribution) return distribution.error();

  PhotometricWriteOptions options;
  if (const auto* ies = std::get_if<IesRecord>(&distribution->record)) options.version = ies->version;
  Result<PhotometricText> text = write(*distribution, options);
  if (!text) return text.error();
  const Status saved = write_file(file, std::as_bytes(std::span(text->text)));
  if (!saved) return saved.error();
  Exported exported{{file}, std::move(text->losses), {}};
  report_the_rest(scene, light, exported.losses);
  return exported;
}

}  // namespace etendue::photometric
