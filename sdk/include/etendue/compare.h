// A picture against independent runs of a reference renderer, aware of the reference's noise.
// Definitions and derivations: sdk/docs/comparison.md.
#pragma once

#include "etendue/picture.h"
#include "etendue/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct CompareOptions {
  double max_difference = 0.01;    // relative; what `same` is asked to exclude
  double false_alarm_rate = 1e-3;  // family-wise, over all regions and channels
  int tiles = 4;                   // tiles x tiles
  double dark_region = 0.05;       // regions under this part of the picture's mean are left out and listed
  std::uint32_t samples = 0;       // the reference's samples per pixel over all seeds, for the advice in `undecided`; 0: unknown
};

enum class Verdict { same, differs, undecided };
const char* name_of(Verdict verdict);

// Channel c of region r: d = (mean ours - mean reference) / mean reference, and its standard error.
struct RegionDifference {
  std::string region;  // "all", "tile 2,3" (column, row, from 1 at the top left), "object floor", "visible emitters"
  char channel = 'R';  // R G B
  double mean_ours = 0, mean_reference = 0;
  double difference = 0, standard_error = 0;
  std::uint64_t pixels = 0;
  double z = 0;           // significance of the difference from zero, as a standard normal deviate
  bool left_out = false;  // too dark to be judged
  bool merged = false;    // too noisy for `same` on its own: judged as part of a larger region
};

// What the difference looks like, where there is one: a hypothesis with the evidence for it.
struct Finding {
  std::string code;  // GLOBAL_SCALE, LIGHT_MISSING, LIGHT_DIFFERS, LIGHT_TURNED, PIXEL_FILTER, SHIFT, GAMMA, REGION
  std::string text;  // for a reader: which light, by how much
  double size = 0;   // the code's own measure: factor, pixels, exponent
};

struct Comparison {
  Verdict verdict = Verdict::undecided;
  double mean_rel = 0, rms_rel = 0, noise_rms_rel = 0, chi2_per_pixel = 0, bias_z = 0;
  // Of noise alone: 1, less where the variance is partly a bound of an error: its float32 sums, our layer "variance_bound".
  double chi2_expected = 0;
  std::uint64_t chi2_pixels = 0;  // not black, no emitter: below 1e4 its own spread is wider than [.92, 1.08]
  std::vector<RegionDifference> regions;
  std::vector<Finding> findings;
  std::optional<std::uint64_t> samples_needed;  // when undecided: about how many would tell
  double pixel_excess_rel = 0;                  // rms of what the pixels differ by beyond the noise, relative; 0 where there is none
  double pixel_excess_z = 0;                    // its significance
  double threshold_z = 0;                       // what a z must exceed for the family-wise false-alarm rate
  double max_difference = 0;                    // the options', for who reads the result
  int seeds = 0;
};

// The reference as K independent runs of equal samples, K >= 5 (REFERENCE_TOO_FEW_SEEDS). All linear, same size (PICTURE_SIZE_MISMATCH).
// Result: layers "", "variance" (of the mean), likewise every "light.NAME" that all runs have, and "etendue:seeds" among the numbers.
Result<Picture> pool(const std::vector<Picture>& runs);

// `reference` as pool() makes it; `ours` with its "variance", "object" and "emitter" layers where it has them.
// `object_names` name the regions of the object layer. `light`: compares the layers "light.NAME" of both instead of the pictures.
Result<Comparison> compare(const Picture& ours, const Picture& reference, const CompareOptions& options,
                           const std::vector<std::string>& object_names = {}, const std::string& light = "");

}  // namespace etendue
