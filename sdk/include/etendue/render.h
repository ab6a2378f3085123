// Direct-light pictures of a scene: primary rays and visibility through Embree, light from eval.h.
#pragma once

#include "etendue/eval.h"
#include "etendue/io.h"
#include "etendue/light_card.h"
#include "etendue/mitsuba_parts.h"
#include "etendue/picture.h"
#include "etendue/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

// How shadows of extended lights are joined to their exact light.
enum class Shadows {
  unbiased,  // what the samples' shadows take away is subtracted
  // Multiplied by the samples' shadowed light over their unblocked light (Heitz, Hill and McGuire 2018): never negative, never more than
  // the unblocked light, and dark by a bias that falls with the number of samples (sdk/docs/rendering.md has figures). Light that is not
  // exact (of patterns and environments, on uneven surfaces) is unbiased all the same.
  ratio,
};

struct RenderOptions {
  std::uint32_t width = 512, height = 512;
  std::uint32_t camera = 0;        // index into Scene::cameras
  std::vector<std::uint32_t> lit;  // lights that emit, by index; empty: all. The others keep their shapes and are black.
  // What the Mitsuba exporter writes: materials as mitsuba_twin() has them, no windows of ranges, every area light visible.
  bool mitsuba_model = false;
  MitsubaParts mitsuba_parts = MitsubaParts::built_in;  // that the exporter writes for; with plugins windows stay
  // What need not be resolved: the relative noise (standard deviation over value) per pixel of the picture that ours is compared
  // with, for one light. Shading is computed to a fiftieth of it, shadows to a fifth. 0.01 suits a picture to look at.
  double expected_noise = 0.01;
  // Of shading: |error| <= shading_tolerance max(value, 1e-3 E L) of each light at each place, diffuse and specular together, by the
  // cheapest way that keeps it (light_within.h). 0: a fiftieth of the noise, and less closely where the picture is dark.
  double shading_tolerance = 0;
  Shadows shadows = Shadows::unbiased;
  std::uint32_t shadow_samples = 0;  // of a pixel in a penumbra, 2 to 4096, a few less to be even; 0: as many as expected_noise asks for
  unsigned threads = 0;              // 0: all cores
  std::uint64_t seed = 1;            // of the shadow estimates
};

struct RenderStats {
  std::uint64_t primary_rays = 0, shadow_rays = 0, evaluations = 0;
  std::uint64_t smooth_pixels = 0, split_pixels = 0;
  std::uint64_t images_decoded = 0;
  double seconds = 0;
};

struct Rendered {
  Picture picture;  // every layer that picture.h names
  RenderStats stats;
  Diagnostics diagnostics;
};

// Errors: SCENE_INVALID (validate() found errors), CAMERA_MISSING, EVALUATION_UNSUPPORTED, CANCELLED, FILE_UNREADABLE (a texture).
Result<Rendered> render(const Scene& scene, const RenderOptions& options, Progress* progress = nullptr);

// Lights of a scene, by index, as what eval.h evaluates, with their meshes, textures and environments decoded. The scene has to be valid.
// Errors: EVALUATION_UNSUPPORTED, FILE_UNREADABLE.
Result<std::vector<eval::Emitter>> emitters_of(const Scene& scene, std::span<const std::uint32_t> lights);
// The card of a light's texture, read row by row; of a light without one a white one. Wrapping is that of Wrap::clamp.
// Errors: EVALUATION_UNSUPPORTED (a texture that is looked up nearest or with a transform), FILE_UNREADABLE, PICTURE_UNSUITABLE.
Result<eval::LightCard> card_of(const Scene& scene, const Light& light);

}  // namespace etendue
