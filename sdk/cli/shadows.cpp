#include "shadows.h"

namespace etendue::cli {

void ShadowOptions::apply(RenderOptions& to) const {
  to.shadows = form == "ratio" ? Shadows::ratio : Shadows::unbiased;
  to.shadow_samples = samples;
}

void add_shadows(CLI::App& verb, ShadowOptions& options) {
  verb.add_option("--shadows", options.form,
                  "unbiased: exact light less what sampled shadows take away; ratio: exact light times shadowed over unshadowed samples, "
                  "which is never negative but too dark, by less the more samples there are")
      ->capture_default_str()
      ->check(CLI::IsMember({"unbiased", "ratio"}));
  verb.add_option("--shadow-samples", options.samples,
                  "Samples of a pixel in a penumbra, 2 to 4096; without: as many as the tolerance asks for")
      ->check(CLI::Range(2, 4096));
}

}  // namespace etendue::cli
