// The verdict: same, differs or undecided, by the rule of sdk/docs/comparison.md.
#include "etendue/compare.h"

#include "evidence.h"
#include "findings.h"
#include "pixels.h"
#include "regions.h"
#include "statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

using namespace compare_detail;

// Rec.709 luminance (ITU-R BT.709-6, item 3.2).
constexpr std::array<double, 3> luminance_weights{.2126, .7152, .0722};

// Emitters cover few pixels, and their edges are noisy: where they are fewer than this part of the picture, their noise does not hold up
// `same`.
constexpr double few_pixels = .02;

struct Judged {
  Region region;
  std::array<Estimate, 3> estimates;
  std::array<bool, 3> left_out{};

  // The largest standard error of the channels that are judged; 0 where none is.
  double standard_error() const {
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) worst = left_out[c] ? worst : std::max(worst, estimates[c].standard_error);
    return worst;
  }
};

std::vector<Judged> judge(std::vector<Region> regions, const CompareOptions& options) {
  const std::array<TailRate, 3> tails = tail_rates(regions[0]);
  const ChannelSums& all = regions[0].sums;
  double mean = 0;
  for (std::size_t c = 0; c < 3; ++c) mean += luminance_weights[c] * all[c].reference / std::max(1.0, all[c].pixels);
  std::vector<Judged> judged;
  for (Region& region : regions) {
    Judged j;
    for (std::size_t c = 0; c < 3; ++c) {
      const Sums& s = region.sums[c];
      j.estimates[c] = estimate(s, tails[c], options.max_difference);
      j.left_out[c] = !(s.pixels > 0) || std::max(s.reference, s.ours) / s.pixels < options.dark_region * mean;
    }
    j.region = std::move(region);
    judged.push_back(std::move(j));
  }
  // A picture whose every channel is dark by that measure is black: nothing is left out of "all" then.
  if (!(mean > 0)) judged[0].left_out = {};
  return judged;
}

double count_tests(const std::vector<Judged>& judged) {
  double tests = 1;  // the pixels' excess
  for (const Judged& j : judged) tests += static_cast<double>(std::count(j.left_out.begin(), j.left_out.end(), false));
  return tests;
}

// Which regions stand for themselves, and which are covered by a larger one because they are too noisy. The largest may be too noisy too.
std::vector<bool> covered_by_parent(const std::vector<Judged>& judged, double largest_error) {
  std::vector<bool> covered(judged.size());
  const double pixels = judged[0].region.sums[0].pixels;
  for (std::size_t i = 1; i < judged.size(); ++i) {
    const Region& region = judged[i].region;
    const bool noisy = judged[i].standard_error() > largest_error;
    covered[i] = noisy && (region.parent >= 0 || region.sums[0].pixels < few_pixels * pixels);
  }
  return covered;
}

void list_regions(const std::vector<Judged>& judged, const std::vector<bool>& covered, Comparison& result) {
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const Judged& j = judged[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const Sums& s = j.region.sums[c];
      RegionDifference row;
      row.region = j.region.name;
      row.channel = "RGB"[c];
      row.pixels = static_cast<std::uint64_t>(s.pixels);
      if (s.pixels > 0) {
        row.mean_ours = s.ours / s.pixels;
        row.mean_reference = s.reference / s.pixels;
      }
      row.difference = j.estimates[c].difference;
      row.standard_error = j.estimates[c].standard_error;
      row.z = j.estimates[c].z;
      row.left_out = j.left_out[c];
      row.merged = covered[i];
      result.regions.push_back(std::move(row));
    }
  }
}

void whole_picture(const Evidence& e, const Region& all, Comparison& result) {
  const PixelStatistics pixels = pixel_statistics(e);
  result.chi2_per_pixel = pixels.chi2_per_pixel;
  result.chi2_expected = pixels.chi2_expected;
  result.chi2_pixels = pixels.chi2_pixels;
  result.rms_rel = pixels.rms_rel;
  result.noise_rms_rel = pixels.noise_rms_rel;
  result.pixel_excess_rel = pixels.excess_rel;
  result.pixel_excess_z = pixels.excess_z;
  // In luminance; the channels' noise is taken as fully correlated, so standard errors add.
  const std::array<TailRate, 3> tails = tail_rates(all);
  double ours = 0, reference = 0, error = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    ours += luminance_weights[c] * all.sums[c].ours;
    reference += luminance_weights[c] * all.sums[c].reference;
    error +=
        luminance_weights[c] * std::sqrt(all.sums[c].variance + std::max(all.sums[c].tail_variance, tails[c].variance * all.sums[c].ours2));
  }
  if (reference > 0) result.mean_rel = (ours - reference) / reference;
  if (error > 0) result.bias_z = (ours - reference) / error;
}

// More samples shrink the standard error as 1 / sqrt(samples).
std::optional<std::uint64_t> samples_for(double error_ratio, std::uint32_t samples) {
  const double needed = std::ceil(samples * error_ratio * error_ratio);
  if (samples == 0 || !(needed < 1e18)) return std::nullopt;
  return static_cast<std::uint64_t>(std::max<double>(needed, samples));
}

void decide(const std::vector<Judged>& judged, const std::vector<bool>& covered, const CompareOptions& options, Comparison& result) {
  const double x = options.max_difference;
  bool differs = result.pixel_excess_z > result.threshold_z && result.pixel_excess_rel > x;
  bool same = true;
  double error_ratio = 1;  // by how much the standard errors have to shrink
  for (std::size_t i = 0; i < judged.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (judged[i].left_out[c]) continue;
      const Estimate& estimate = judged[i].estimates[c];
      differs = differs || estimate.z_beyond > result.threshold_z;
      if (covered[i]) continue;
      const double distance = std::abs(estimate.difference), error = estimate.standard_error;
      if (error > x / 4) {
        same = false;
        error_ratio = std::max(error_ratio, x > 0 ? 4 * error / x : HUGE_VAL);
      } else if (distance > x + 3 * error) {
        same = false;
        error_ratio = std::max(error_ratio, result.threshold_z * error / (distance - x));
      }
    }
  }
  result.verdict = differs ? Verdict::differs : same ? Verdict::same : Verdict::undecided;
  if (result.verdict == Verdict::undecided) result.samples_needed = samples_for(error_ratio, options.samples);
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "same";
    case Verdict::differs:
      return "differs";
    case Verdict::undecided:
      return "undecided";
  }
  return "";
}

Result<Comparison> compare(const Picture& ours, const Picture& reference, const CompareOptions& options,
                           const std::vector<std::string>& object_names, const std::string& light) {
  Result<Evidence> gathered = gather(ours, reference, light);
  if (!gathered) return gathered.error();
  const Evidence& e = *gathered;

  Comparison result;
  result.seeds = e.seeds;
  result.max_difference = options.max_difference;
  const std::vector<Judged> judged = judge(divide(e, options.tiles, object_names), options);
  result.threshold_z = two_sided_quantile(sidak_rate(std::clamp(options.false_alarm_rate, 1e-12, .5), count_tests(judged)));
  const std::vector<bool> covered = covered_by_parent(judged, options.max_difference / 4);
  list_regions(judged, covered, result);
  whole_picture(e, judged[0].region, result);
  decide(judged, covered, options, result);

  const bool significant = result.pixel_excess_z > result.threshold_z ||
                           std::any_of(result.regions.begin(), result.regions.end(),
                                       [&](const RegionDifference& r) { return !r.left_out && std::abs(r.z) > result.threshold_z; });
  if (!significant) return result;
  result.findings = light.empty() ? find_causes(e, ours, reference, result.threshold_z, options.max_difference)
                                  : find_light_cause(e, light, result.threshold_z, options.max_difference);
  if (result.findings.empty() && result.verdict == Verdict::differs) {
    result.findings.push_back(worst_region(result.regions, result.pixel_excess_rel));
  }
  return result;
}

}  // namespace etendue
