#include "findings.h"

#include "models.h"
#include "pixels.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace etendue::compare_detail {
namespace {

using Values = std::vector<double>;
constexpr std::size_t most_findings = 4;
// A hypothesis is named when it explains this part of what exceeds the noise.
constexpr double least_explained = .3;
// A simpler one is preferred where it explains this part of what the other does: no model is exact, and many parameters would mend that.
// For two parameters against one, and for a light's shape against any.
constexpr double as_good_as_two = .99, as_good_as_shape = .95;
// Alone in its layer, a light has only its brightness or the camera to blame when those explain this part; else its own shape or direction.
constexpr double mostly = .8;
// A camera or a pixel grid is off by a pixel at most; a larger shift that does not explain all is a light that has moved.
constexpr double likely_shift = 1.5, nearly_all = .9;
// As CompareOptions has it: regions darker than this part of the mean say nothing.
constexpr double dark_region = CompareOptions{}.dark_region;
// Three channels of a pixel share most of their noise: chi-squared over them counts for one.
constexpr double shared_noise = 3;

struct Candidate {
  Model model;
  Fit fit;
  double gain = 0;       // by how much it lowers chi-squared
  double explained = 0;  // the same as a part of the excess over the noise
  double score = 0;      // Bayesian information criterion (Schwarz 1978) over -2: lower is better
};

double relative_change(const Values& before, const Values& after, const Evidence& e) {
  double change = 0, scale = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (e.emitter[i / 3]) continue;
    change += (after[i] - before[i]) * (after[i] - before[i]);
    scale += before[i] * before[i];
  }
  return scale > 0 ? std::sqrt(change / scale) : 0;
}

// By how much chi-squared exceeds what noise alone would give, and the standard deviation of that, pixels being independent.
struct Excess {
  double value = 0, deviation = 0;
};

Excess excess_of(const Values& base, const Evidence& e, const Values& weights) {
  Excess excess;
  double squares = 0;
  for (std::size_t p = 0; p < e.pixels(); ++p) {
    double pixel = 0;
    for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
      pixel += weights[i] * ((e.reference[i] - base[i]) * (e.reference[i] - base[i]) - e.variance[i]);
    excess.value += pixel;
    squares += pixel * pixel;
  }
  excess.deviation = std::sqrt(squares);
  return excess;
}

std::optional<Candidate> best_candidate(const Values& base, const Evidence& e, std::vector<Model> models, const Values& weights,
                                        double threshold_z, double max_difference) {
  const Excess excess = excess_of(base, e, weights);
  // A change of a thousandth everywhere is certain long before the excess rises out of its own noise: what is certain of it counts.
  const double to_explain = excess.value - 2 * excess.deviation;
  const bool obvious = excess.value > threshold_z * excess.deviation;
  const double log_pixels = std::log(static_cast<double>(e.pixels()));
  const double least_change = std::max(max_difference / 10, 3e-5);
  std::stable_sort(models.begin(), models.end(), [](const Model& a, const Model& b) { return a.parameters < b.parameters; });
  std::optional<Candidate> best;
  for (Model& model : models) {
    // The many parameters of a light's shape are for what is obvious and has no simpler reason.
    if (model.kind == Model::Kind::light_shape && (!obvious || (best && best->gain >= as_good_as_shape * excess.value))) continue;
    Candidate candidate;
    candidate.model = std::move(model);
    candidate.fit = fit(candidate.model, e, weights);
    const int parameters = candidate.model.parameters;
    const double gain = candidate.gain = candidate.fit.chi2_before - candidate.fit.chi2;
    candidate.explained = gain >= to_explain ? 1 : gain / to_explain;
    candidate.score = candidate.fit.chi2 / shared_noise + parameters * log_pixels;
    if (gain / shared_noise < threshold_z * threshold_z + 2 * parameters) continue;
    if (candidate.explained < least_explained || relative_change(base, candidate.fit.predicted, e) < least_change) continue;
    const bool far =
        candidate.model.kind == Model::Kind::shift && std::hypot(candidate.fit.theta[0], candidate.fit.theta[1]) > likely_shift;
    if (far && candidate.explained < nearly_all) continue;
    const double as_good = candidate.model.kind == Model::Kind::light_shape ? as_good_as_shape : as_good_as_two;
    const bool needless = best && parameters > best->model.parameters && best->gain >= as_good * gain;
    if (!best || (!needless && candidate.score < best->score)) best = std::move(candidate);
  }
  return best;
}

Finding light_finding(const std::string& light, double factor, double error, bool absent) {
  if (absent || std::abs(factor) < std::max(.05, 3 * error)) {
    return {"LIGHT_MISSING", fmt::format("Light '{}' is missing from our picture.", light), 0};
  }
  return {"LIGHT_DIFFERS", fmt::format("Light '{}' gives {:.4g} times the reference's light.", light, factor), factor};
}

// `change`: rms of the difference over the rms of the picture.
Finding shape_finding(const std::string& light, double change) {
  return {"LIGHT_TURNED",
          fmt::format("Light '{}' throws its light elsewhere than in the reference: turned, moved or of another shape.", light), change};
}

Finding describe(const Candidate& c, const Values& base, const Evidence& e) {
  const Values& t = c.fit.theta;
  switch (c.model.kind) {
    case Model::Kind::scale: {
      const double factor = 1 / (1 + t[0]);
      return {"GLOBAL_SCALE", fmt::format("Our picture is {:.5g} times the reference, everywhere alike.", factor), factor};
    }
    case Model::Kind::gamma: {
      const double exponent = 1 / (1 + t[1]);
      return {"GAMMA", fmt::format("Our picture is the reference raised to the power {:.4g}.", exponent), exponent};
    }
    case Model::Kind::shift:
      return {"SHIFT", fmt::format("Our picture is shifted by {:.3f} pixels to the right and {:.3f} down.", -t[0], -t[1]),
              std::hypot(t[0], t[1])};
    case Model::Kind::filter: {
      // A filter of variance s^2 adds s^2/2 times the Laplacian: s^2 = 2 theta.
      const double width = std::sqrt(2 * std::abs(t[0]));
      return {"PIXEL_FILTER",
              fmt::format("{} is smoother, as if filtered once more with a standard deviation of {:.3f} pixels.",
                          t[0] > 0 ? "The reference" : "Our picture", width),
              std::copysign(width, t[0])};
    }
    case Model::Kind::light_scale:
      return light_finding(c.model.light, 1 - t[0], c.fit.errors[0], c.model.light_absent);
    case Model::Kind::light_shape:
      return shape_finding(c.model.light, relative_change(base, c.fit.predicted, e));
  }
  return {};
}

bool is_global(const Model& model) { return model.kind != Model::Kind::light_scale && model.kind != Model::Kind::light_shape; }

bool is_of_optics(const Finding& finding) { return finding.code == "SHIFT" || finding.code == "PIXEL_FILTER" || finding.code == "GAMMA"; }

// A region that differs by more than the difference asked about, or pixels that do.
bool is_beyond(const Evidence& e, double threshold_z, double max_difference) {
  const PixelStatistics pixels = pixel_statistics(e);
  if (pixels.excess_z > threshold_z && pixels.excess_rel > max_difference) return true;
  const std::vector<Region> regions = divide(e, 4, {});
  const std::array<TailRate, 3> tails = tail_rates(regions[0]);
  return std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Sums &here = region.sums[c], &all = regions[0].sums[c];
      const bool dark = std::max(here.ours, here.reference) * all.pixels < dark_region * all.reference * here.pixels;
      if (!dark && estimate(here, tails[c], max_difference).z_beyond > threshold_z) return true;
    }
    return false;
  });
}

// What a single light's layers show: a LIGHT_... finding, or what a camera or a film would do. A light that agrees within the difference
// asked about is not said to be turned: detail below the size of a pixel looks like that too.
std::optional<Finding> examine_light(const Evidence& e, const std::string& light, double threshold_z, double max_difference) {
  if (!is_beyond(e, threshold_z, 0)) return std::nullopt;
  double ours = 0, reference = 0;
  for (double value : e.ours) ours += std::abs(value);
  for (double value : e.reference) reference += std::abs(value);
  if (ours < .05 * reference) return light_finding(light, 0, 0, true);
  if (relative_change(e.ours, e.reference, e) < max_difference / 10) return std::nullopt;

  const Values weights = weights_of(e);
  const std::optional<Candidate> best = best_candidate(e.ours, e, models_for(e.ours, e, {}, {}), weights, threshold_z, max_difference);
  if (best && best->explained >= mostly) {
    if (best->model.kind != Model::Kind::scale) return describe(*best, e.ours, e);
    return light_finding(light, 1 / (1 + best->fit.theta[0]), best->fit.errors[0], false);
  }
  if (!is_beyond(e, threshold_z, max_difference)) return std::nullopt;
  const std::optional<Candidate> elsewhere =
      best_candidate(e.ours, e, {own_shape_model(e.ours, e, light)}, weights, threshold_z, max_difference);
  return elsewhere ? std::optional(describe(*elsewhere, e.ours, e)) : std::nullopt;
}

// Each light's own layers, where both pictures have them: less noise than the sum of all lights. A camera or a film errs for all lights
// alike: what most of them show is said once, and what only few show is the light's own.
std::vector<Finding> find_in_layers(const Picture& ours, const Picture& reference, double threshold_z, double max_difference) {
  std::vector<Finding> of_lights, of_optics;
  std::size_t lights = 0;
  for (const std::string& light : lights_of(reference)) {
    if (!ours.find("light." + light)) continue;
    const Result<Evidence> evidence = gather(ours, reference, light);
    if (!evidence) continue;
    ++lights;
    std::optional<Finding> finding = examine_light(*evidence, light, threshold_z, max_difference);
    if (!finding) continue;
    if (is_of_optics(*finding)) {
      of_optics.push_back(std::move(*finding));
      finding = shape_finding(light, pixel_statistics(*evidence).excess_rel);
    }
    of_lights.push_back(std::move(*finding));
  }
  if (2 * of_optics.size() > std::max<std::size_t>(lights, 2)) return {of_optics.front()};
  return of_lights;
}

}  // namespace

std::vector<Finding> find_causes(const Evidence& e, const Picture& ours, const Picture& reference, double threshold_z,
                                 double max_difference) {
  const bool beyond = is_beyond(e, threshold_z, max_difference);
  const Values weights = weights_of(e);
  std::vector<Finding> findings;
  Values base = e.ours;
  bool global = false;
  while (findings.size() < most_findings) {
    std::vector<Model> models = models_for(base, e, ours, reference);
    if (!beyond) std::erase_if(models, [](const Model& model) { return model.kind == Model::Kind::light_shape; });
    std::optional<Candidate> best = best_candidate(base, e, std::move(models), weights, threshold_z, max_difference);
    if (!best) break;
    findings.push_back(describe(*best, base, e));
    global = global || is_global(best->model);
    base = std::move(best->fit.predicted);
  }
  if (global) return findings;
  std::vector<Finding> in_layers = find_in_layers(ours, reference, threshold_z, max_difference);
  return in_layers.empty() ? findings : in_layers;
}

std::vector<Finding> find_light_cause(const Evidence& e, const std::string& light, double threshold_z, double max_difference) {
  const std::optional<Finding> finding = examine_light(e, light, threshold_z, max_difference);
  if (!finding) return {};
  return {is_of_optics(*finding) ? shape_finding(light, pixel_statistics(e).excess_rel) : *finding};
}

Finding worst_region(const std::vector<RegionDifference>& regions, double pixel_excess_rel) {
  const RegionDifference* worst = nullptr;
  for (const RegionDifference& region : regions) {
    if (!region.left_out && (!worst || std::abs(region.z) > std::abs(worst->z))) worst = &region;
  }
  if (!worst) return {"REGION", "The pictures differ, and every region is too dark to say where.", 0};
  return {"REGION",
          fmt::format("The largest difference is in {}: {:+.3g} % in {}; single pixels differ by {:.2g} % (rms) beyond the noise.",
                      worst->region, 100 * worst->difference,
                      worst->channel == 'R'   ? "red"
                      : worst->channel == 'G' ? "green"
                                              : "blue",
                      100 * pixel_excess_rel),
          worst->difference};
}

}  // namespace etendue::compare_detail
