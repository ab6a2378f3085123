// Mitsuba's picture of a scene, one light at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "exporters/mitsuba/run.h"
#include "session.h"

namespace etendue::cli {

// How many samples each light gets: `total` per pixel split over the lights, in `seeds` independent runs each.
struct Split {
  std::uint32_t samples_per_seed = 64, seeds = 16;
  std::uint32_t per_light() const { return samples_per_seed * seeds; }
};
// At least five seeds of at least one sample; fewer seeds rather than fewer than four samples in each.
Split split_samples(std::uint32_t total, std::uint32_t seeds, std::size_t lights);

// A scene file in which one light alone emits.
struct LightFile {
  std::string light;
  std::filesystem::path scene;
};

struct PictureRequest {
  std::uint32_t width = 0, height = 0;
  std::vector<LightFile> lights;
  Split split;
  std::optional<std::filesystem::path> cache;
};

// The sum over the lights, with layers "light.NAME" and "light_variance.NAME"; "variance" is the sum of theirs.
Result<Picture> mitsuba_picture(const Mitsuba& mitsuba, const PictureRequest& request, Progress* progress);

// Samples per pixel over all lights that take about `seconds`, from a first small run.
Result<std::uint32_t> samples_in(const Mitsuba& mitsuba, const PictureRequest& request, double seconds);

// Mitsuba where the caller said, or in $ETENDUE_MITSUBA, .venv beside the program or here, or the PATH.
Result<Mitsuba> locate_mitsuba(const std::string& hint);

}  // namespace etendue::cli
