#include "environment_rows.h"
#include "etendue/eval.h"
#include "lights.h"

namespace etendue::mitsuba {
namespace {

// cd/m2 of a pixel value 1. A map with a stated luminance or illuminance has it in the mean over the sphere, as in our evaluation.
Rgb scale_of(const Light& light, const Rgb& resolved, const DecodedImage& image) {
  if (light.emission.given == Emission::Given::as_file) return resolved;
  std::vector<Vec3f> pixels;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) pixels.push_back({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
  const double mean = eval::mean_luminance(*eval::make_environment(image.width, image.height, std::move(pixels)));
  return mean > 0 ? resolved / mean : Rgb{};
}

}  // namespace

Status write_environment(Writer& writer, const LightEntry& entry, const EnvironmentShape& environment) {
  if (!environment.cube.empty()) {
    writer.losses.add(name_for_losses(entry.light) + ": an environment in the form of a cube", "no light comes from it");
    return Done{};
  }
  if (!environment.image) {
    add_rgb(add_plugin(writer.root, "emitter", "constant", entry.id), "radiance", entry.resolved.rgb);
    return Done{};
  }
  Result<DecodedImage> image = decode(writer.scene.images[*environment.image], Encoding::linear);
  if (!image) return image.error();
  std::vector<float> rgb = rows_aligned_with_poles(*image, scale_of(entry.light, entry.resolved.rgb, *image));
  Result<std::string> file = writer.assets.add_picture(image->width, 2 * image->height + 1, std::move(rgb));
  if (!file) return file.error();
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "envmap", entry.id);
  add_string(emitter, "filename", *file);
  Transform rotation = entry.light.transform;
  rotation.translation = {};
  if (!(rotation == Transform{})) add_matrix(emitter, "to_world", rotation);
  return Done{};
}

// Our row r of H lies at theta = pi (r + 1/2) / H, with the first and last row continued to the poles; Mitsuba's row s of H' at
// theta = pi s / (H' - 1). With H' = 2 H + 1 these are the half steps s / (2 H): odd s are our rows, even s lie midway between two, and s =
// 0 and s = 2 H repeat the outermost ones. So every corner of our piecewise linear map is a row of theirs, and both maps are the same
// function.
std::vector<float> rows_aligned_with_poles(const DecodedImage& image, const Rgb& factor) {
  const std::size_t width = image.width, height = image.height;
  std::vector<float> rgb;
  rgb.reserve((2 * height + 1) * width * 3);
  for (std::size_t row = 0; row <= 2 * height; ++row) {
    const std::size_t above = row == 0 ? 0 : (row - 1) / 2;
    const std::size_t below = row == 2 * height ? height - 1 : row / 2;
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = image.rgba[(above * width + x) * 4 + c], b = image.rgba[(below * width + x) * 4 + c];
        rgb.push_back(static_cast<float>((a + b) / 2 * factor[static_cast<int>(c)]));
      }
    }
  }
  return rgb;
}

}  // namespace etendue::mitsuba
