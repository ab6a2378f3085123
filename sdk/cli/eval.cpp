// etendue eval: the light of a rig at points.
#include "etendue/eval.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "csv.h"
#include "etendue/diffuse_light.h"
#include "etendue/directional_albedo.h"
#include "etendue/illuminance_batch.h"
#include "etendue/light_pictures.h"
#include "etendue/light_within.h"
#include "etendue/probe.h"
#include "etendue/published.h"
#include "etendue/render.h"
#include "etendue/rig_batch.h"
#include "etendue/specular_light.h"
#include "etendue/specular_methods.h"
#include "eval_points.h"
#include "limits.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

using eval::Emitter;

struct Options {
  std::string asset, points, brdf = "lambert", base_colour = "0.5,0.5,0.5", method = "exact", fresnel = "schlick", eta, k, tangent, lights,
                             mute;
  ImportOptions import;
  double alpha = -1, alpha_across = -1, roughness = -1, f0 = 0.04, tolerance = 1e-4;
  std::optional<double> f90;
  std::optional<std::string> masking;
  std::optional<std::uint64_t> samples, seed;
  bool sum = false, micro_occlusion = false, passed_on = false;
  bool tolerance_alone = false;  // named, and no method
};

// Of one light at one point: lux or cd/m2, an absolute bound of the error in the worst channel, and how it was found.
struct Answer {
  Rgb value;
  double bound = 0;
  std::string_view method;
};

double largest(const Rgb& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

Error usage(std::string text, std::string hint = {}) { return {"USAGE", std::move(text), {}, std::move(hint), {}}; }

// Rounding of a closed form in double: 1e-12 for a luminance of 1 (tests/unit/illuminance_property_test.cpp), and of the value.
double rounding_of(const Emitter& emitter, const Rgb& value) { return 1e-12 * (largest(value) + largest(emitter.radiance)); }

constexpr std::string_view brdf_names =
    "lambert, disney, frostbite, gltf-diffuse, oren-nayar, gotanda, ggx, beckmann, blinn-phong, phong, standard or principled";

const std::map<std::string, eval::Distribution> distributions{{"ggx", eval::Distribution::ggx},
                                                              {"beckmann", eval::Distribution::beckmann},
                                                              {"blinn-phong", eval::Distribution::blinn_phong},
                                                              {"phong", eval::Distribution::phong}};
const std::map<std::string, Masking> maskings{{"correlated", Masking::correlated},
                                              {"separable", Masking::separable},
                                              {"schlick-direct", Masking::schlick_direct},
                                              {"schlick-image", Masking::schlick_image}};
const std::map<std::string, eval::Fresnel> fresnels{{"schlick", eval::Fresnel::schlick},
                                                    {"schlick-gaussian", eval::Fresnel::schlick_gaussian},
                                                    {"dielectric", eval::Fresnel::dielectric},
                                                    {"conductor", eval::Fresnel::conductor}};
template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

// Reflectance at normal incidence is ((n - 1) / (n + 1))^2.
double ior_of(double f0) {
  const double root = std::sqrt(std::min(f0, 0.999999));
  return (1 + root) / (1 - root);
}

Result<Rgb> colour_of(const char* option, const std::string& text) {
  const std::optional<Rgb> c = parse_rgb(text);
  if (!c) return usage(fmt::format("{}: expected r,g,b, found '{}'", option, text));
  return *c;
}

Result<eval::Brdf> specular_of(const Options& o, double alpha) {
  eval::SpecularLobe lobe;
  lobe.distribution = distributions.at(o.brdf);
  lobe.alpha_x = alpha;
  lobe.alpha_y = o.alpha_across >= 0 ? o.alpha_across : alpha;
  lobe.masking = maskings.at(o.masking.value_or("correlated"));
  lobe.fresnel = fresnels.at(o.fresnel);
  lobe.f0 = {o.f0, o.f0, o.f0};
  lobe.f90 = o.micro_occlusion ? eval::micro_occlusion_f90(lobe.f0) : o.f90.value_or(1);
  const bool exact = lobe.fresnel == eval::Fresnel::dielectric || lobe.fresnel == eval::Fresnel::conductor;
  if (exact && (o.f90 || o.micro_occlusion))
    return usage(fmt::format("--f90, --micro-occlusion: expected --fresnel schlick or schlick-gaussian with them, found {}", o.fresnel));
  if (o.f90 && o.micro_occlusion) return usage("expected --f90 or --micro-occlusion, found both");
  if (o.masking && lobe.distribution == eval::Distribution::phong)
    return usage("--masking: expected --brdf ggx, beckmann or blinn-phong, found phong, which has no facets");
  if (!exact && !(o.eta.empty() && o.k.empty())) return usage("--eta, --k: expected --fresnel dielectric or conductor with them");
  if (lobe.alpha_x != lobe.alpha_y && (o.brdf == "blinn-phong" || o.brdf == "phong"))
    return usage(fmt::format("--alpha-across: expected --brdf ggx or beckmann, found {}, which is round", o.brdf));
  lobe.eta = Rgb{1, 1, 1} * ior_of(o.f0);
  if (!o.eta.empty()) {
    const Result<Rgb> eta = colour_of("--eta", o.eta);
    if (!eta) return eta.error();
    lobe.eta = *eta;
  }
  if (lobe.fresnel == eval::Fresnel::conductor) {
    if (o.eta.empty() || o.k.empty()) return usage("--fresnel conductor: expected --eta r,g,b and --k r,g,b with it");
    const Result<Rgb> k = colour_of("--k", o.k);
    if (!k) return k.error();
    lobe.k = *k;
  } else if (!o.k.empty()) {
    return usage("--k: expected --fresnel conductor with it");
  }
  if (!(std::min({lobe.eta.x, lobe.eta.y, lobe.eta.z}) > 0) || !(std::min({lobe.k.x, lobe.k.y, lobe.k.z}) >= 0))
    return usage("--eta, --k: expected indices of refraction above 0 and extinctions of 0 or more");
  if (o.passed_on && lobe.distribution == eval::Distribution::phong)
    return usage("--passed-on: expected --brdf ggx, beckmann or blinn-phong, found phong, which has no facets");
  if (o.passed_on) lobe.compensation = eval::albedo_curve(lobe);
  return eval::Brdf{lobe};
}

Result<eval::Brdf> brdf_of(const Options& o, const Rgb& base, double roughness) {
  if (distributions.contains(o.brdf)) return specular_of(o, o.alpha >= 0 ? o.alpha : roughness * roughness);
  if (o.alpha_across >= 0 || !o.tangent.empty() || o.fresnel != "schlick" || !o.eta.empty() || !o.k.empty() || o.f90 || o.micro_occlusion ||
      o.masking || o.passed_on)
    return usage(fmt::format(
        "--alpha-across, --tangent, --fresnel, --eta, --k, --f90, --micro-occlusion, --masking, --passed-on: expected --brdf ggx, "
        "beckmann, blinn-phong or phong with them, found {}",
        o.brdf));
  if (o.brdf == "lambert") return eval::Brdf{Lambert{{1, 1, 1}}};
  if (o.brdf == "disney") return eval::Brdf{eval::DisneyDiffuse{base, roughness}};
  if (o.brdf == "frostbite") return eval::Brdf{eval::FrostbiteDiffuse{base, roughness}};
  if (o.brdf == "gltf-diffuse") return eval::Brdf{eval::GltfDiffuse{base, ior_of(o.f0)}};
  if (o.brdf == "oren-nayar") return eval::Brdf{eval::OrenNayar{base, eval::oren_nayar_sigma_rad(roughness * roughness)}};
  if (o.brdf == "gotanda") return eval::Brdf{eval::GotandaDiffuse{base, roughness, o.f0}};
  if (o.brdf == "standard") return eval::Brdf{Standard{base, 0, roughness, std::sqrt(o.f0 / 0.16)}};
  if (o.brdf == "principled") return eval::Brdf{Principled{base, 0, roughness, o.f0 / 0.08}};
  return usage(fmt::format("--brdf: expected {}, found '{}'", brdf_names, o.brdf));
}

// How the lights are evaluated, checked before the first point is read.
class Evaluator {
 public:
  static Result<Evaluator> of(const Options& options);

  bool wants_view() const { return !lambert_; }
  // In floats, where a sum may leave out lights that are below the tolerance.
  bool in_floats() const { return fast_ && lambert_; }
  Answer operator()(const Emitter& emitter, const PointRow& point) const;
  // Many points of one light: `fast` and whatever keeps a tolerance know shorter ways, which are prepared once a light.
  struct Prepared {
    std::optional<eval::LightBatch> batch;
    std::optional<eval::LightPlan> plan;
  };
  Prepared prepared(const Emitter& emitter, const std::shared_ptr<const eval::PictureMoments>& picture) const;
  std::vector<Answer> operator()(const Emitter& emitter, const Prepared& prepared, std::span<const PointRow> points) const;
  // Whether the method takes this light.
  Status accepts(const Emitter& emitter, const std::string& name) const;
  // Of patches: a light's card comes before it is asked for; the emitter stays where it is.
  bool wants_pictures() const { return planned_; }
  bool wants_cards() const { return patches_ || looked_up_ != nullptr; }
  void take_card(const Emitter& emitter, eval::LightCard card) {
    const eval::LightCard& kept = cards_.emplace(&emitter, std::move(card)).first->second;
    if (looked_up_ != nullptr) lookups_.emplace(&emitter, looked_up_->lookups(emitter, kept));
  }

 private:
  Status choose_rule(const Options& options);
  eval::ShadingPoint shading_point(const PointRow& point) const;
  Answer by_reference(const Emitter& emitter, const PointRow& point) const;
  Answer by_rule(const Emitter& emitter, const PointRow& point) const;
  std::optional<Answer> adaptively(const Emitter& emitter, const PointRow& point) const;
  Answer by_samples(const Emitter& emitter, const PointRow& point) const;

  std::optional<Answer> by_card(const Emitter& emitter, const PointRow& point) const;
  std::optional<Answer> by_lookup(const Emitter& emitter, const PointRow& point) const;

  bool lambert_ = true, fast_ = false, patches_ = false;
  const eval::CardMethod* looked_up_ = nullptr;
  std::map<const Emitter*, eval::LightCard> cards_;
  std::map<const Emitter*, eval::CardLookups> lookups_;
  const eval::DiffuseMethod* published_ = nullptr;  // of lambert
  const eval::DiffuseRule* rule_ = nullptr;         // of other diffuse BRDFs
  const eval::SpecularMethod* specular_ = nullptr;  // of specular lobes
  std::optional<eval::Sampling> sampling_;
  bool adaptive_ = false;  // of specular lobes
  bool planned_ = false;   // whatever keeps the tolerance
  bool closed_ = true;     // closed forms where there are any
  eval::Brdf brdf_;
  Vec3d tangent_;
  double tolerance_ = 1e-4;
};

Result<Evaluator> Evaluator::of(const Options& o) {
  Evaluator e;
  if (o.alpha >= 0 && o.roughness >= 0) return usage("expected --alpha or --roughness, found both", "alpha is roughness squared");
  const double roughness = o.roughness >= 0 ? o.roughness : o.alpha >= 0 ? std::sqrt(o.alpha) : 0.5;
  const std::optional<Rgb> base = parse_rgb(o.base_colour);
  if (!base) return usage(fmt::format("--base-colour: expected r,g,b, found '{}'", o.base_colour));
  const Result<eval::Brdf> brdf = brdf_of(o, *base, roughness);
  if (!brdf) return brdf.error();
  e.brdf_ = *brdf;
  if (!o.tangent.empty()) {
    const std::optional<Vec3d> tangent = parse_vector(o.tangent);
    if (!tangent || !(length(*tangent) > 0)) return usage(fmt::format("--tangent: expected x,y,z, found '{}'", o.tangent));
    e.tangent_ = *tangent;
  }
  e.tolerance_ = o.tolerance;
  e.lambert_ = o.brdf == "lambert";
  if (o.method == "monte-carlo") {
    e.sampling_.emplace();
    e.sampling_->samples = o.samples.value_or(e.sampling_->samples);
    e.sampling_->seed = o.seed.value_or(e.sampling_->seed);
    return e;
  }
  if (o.samples || o.seed)
    return usage(fmt::format("--{}: expected --method monte-carlo with it, found {}", o.samples ? "samples" : "seed", o.method));
  if (o.method == "patches") {
    e.patches_ = true;
    return e;
  }
  e.looked_up_ = eval::find_card_method(o.method);
  if (e.looked_up_ != nullptr) return e;
  e.adaptive_ = distributions.contains(o.brdf) && o.method == "adaptive";
  e.planned_ = o.tolerance_alone;
  if (o.method == "exact" || o.method == "reference" || e.adaptive_) {
    e.closed_ = o.method != "reference";
    return e;
  }
  if (!e.lambert_) {
    if (const Status chosen = e.choose_rule(o); !chosen) return chosen.error();
    return e;
  }
  if (o.method == "fast") {
    e.fast_ = true;
    return e;
  }
  e.published_ = eval::find_diffuse_method(o.method);
  if (e.published_ != nullptr) return e;
  std::string names;
  for (const eval::DiffuseMethod& m : eval::diffuse_methods()) names += fmt::format("{}{}", names.empty() ? "" : ", ", m.name);
  return usage(fmt::format("--method: expected exact, fast, reference, monte-carlo or a published one, found '{}'", o.method),
               "published: " + names);
}

Status Evaluator::choose_rule(const Options& o) {
  std::string names;
  const auto list = [&](const auto& all) {
    for (const auto& each : all) names += fmt::format(", {}", each.name);
  };
  if (eval::is_diffuse(brdf_)) {
    fast_ = o.method == "fast";
    rule_ = eval::find_diffuse_rule(o.method);
    if (fast_ || rule_ != nullptr) return Done{};
    names = ", fast";
    list(eval::diffuse_rules());
  } else if (distributions.contains(o.brdf)) {
    specular_ = eval::find_specular_method(o.method);
    if (specular_ != nullptr) return Done{};
    names = ", adaptive";
    list(eval::specular_methods());
  }
  return usage(fmt::format("--method: expected exact, reference, monte-carlo{} with --brdf {}, found '{}'", names, o.brdf, o.method));
}

Status Evaluator::accepts(const Emitter& emitter, const std::string& name) const {
  const PointRow probe{{0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
  const auto refused = [&](std::string_view method) {
    return Error{"METHOD_UNSUPPORTED",
                 fmt::format("light '{}': expected one that {} takes: its shape, without pattern or range", name, method),
                 {},
                 "--lights chooses some",
                 {}};
  };
  if (looked_up_ != nullptr && !by_lookup(emitter, probe)) {
    return Error{
        "METHOD_UNSUPPORTED",
        fmt::format("light '{}': expected a rectangle without a range, and the lobe that {} takes: lambert of drobot-diffuse-card, "
                    "round GGX of correlated masking and Schlick's Fresnel of the others",
                    name, looked_up_->name),
        {},
        "--lights chooses some",
        {}};
  }
  if (patches_ && !by_card(emitter, probe)) {
    return Error{
        "METHOD_UNSUPPORTED",
        fmt::format("light '{}': expected a rectangle without a range, and lambert or round GGX of correlated masking and Schlick's "
                    "Fresnel, which patches takes",
                    name),
        {},
        "--lights chooses some",
        {}};
  }
  // None knows patterns or ranges of area lights.
  if (published_ != nullptr &&
      !(has_closed_form(emitter) && !is_window(emitter.window) && published_->illuminance(emitter, probe.position, probe.normal)))
    return refused(published_->name);
  if (rule_ != nullptr && !rule_->luminance(emitter, shading_point(probe))) return refused(rule_->name);
  if (adaptive_ && !adaptively(emitter, probe)) {
    return Error{"METHOD_UNSUPPORTED",
                 fmt::format("light '{}': expected an area light without pattern or range and round GGX of Schlick's Fresnel, which "
                             "adaptive takes",
                             name),
                 {},
                 "--lights chooses some",
                 {}};
  }
  if (specular_ != nullptr && !specular_->luminance(emitter, shading_point(probe))) {
    return Error{
        "METHOD_UNSUPPORTED",
        fmt::format("light '{}': expected an area light without pattern or range, of a shape that {} takes, and a round lobe that it takes",
                    name, specular_->name),
        {},
        "--lights chooses some",
        {}};
  }
  return Done{};
}

eval::ShadingPoint Evaluator::shading_point(const PointRow& p) const {
  return {p.position, p.normal, p.normal, lambert_ ? p.normal : p.view, brdf_, tangent_};
}

Answer Evaluator::by_reference(const Emitter& emitter, const PointRow& p) const {
  // |error| <= X max(value, 1e-3 E L), E the cosine integral for a luminance of 1.
  const double floor = has_closed_form(emitter) ? 1e-3 * largest(eval::illuminance(emitter, p.position, p.normal)) : 0;
  const double scale = lambert_ ? pi : 1;
  const eval::Estimate estimate = eval::reference(emitter, shading_point(p), {tolerance_, tolerance_ * floor / scale});
  return {estimate.value * scale, largest(estimate.error) * scale, "reference"};
}

std::optional<Answer> Evaluator::adaptively(const Emitter& emitter, const PointRow& p) const {
  const std::optional<eval::Estimate> estimate = eval::specular_luminance(emitter, shading_point(p), tolerance_);
  if (!estimate) return std::nullopt;
  return Answer{estimate->value, largest(estimate->error), "adaptive"};
}

std::optional<Answer> Evaluator::by_card(const Emitter& emitter, const PointRow& p) const {
  const auto found = eval::by_patches(emitter, cards_.at(&emitter), shading_point(p), {tolerance_, 1 << 16});
  if (!found) return std::nullopt;
  const double scale = lambert_ ? pi : 1;
  return Answer{found->value * scale, largest(found->error) * scale, "patches"};
}

// What a lookup is off by is measured here, against patches.
std::optional<Answer> Evaluator::by_lookup(const Emitter& emitter, const PointRow& p) const {
  const std::optional<Rgb> luminance = looked_up_->luminance(emitter, lookups_.at(&emitter), shading_point(p));
  const std::optional<Answer> exact = by_card(emitter, p);
  if (!luminance || !exact) return std::nullopt;
  const Rgb value = *luminance * (lambert_ ? pi : 1);
  return Answer{value, largest(value - exact->value) + exact->bound, looked_up_->name};
}

Answer Evaluator::by_rule(const Emitter& emitter, const PointRow& p) const {
  const eval::ShadingPoint point = shading_point(p);
  if (rule_ == nullptr && specular_ == nullptr) {
    const eval::Estimate estimate = eval::diffuse_luminance(emitter, point).value_or(eval::Estimate{});
    return {estimate.value, largest(estimate.error), "ratio"};
  }
  // What others' rules are off by is measured here, against the reference.
  const Answer exact = by_reference(emitter, p);
  const std::optional<Rgb> luminance = rule_ != nullptr ? rule_->luminance(emitter, point) : specular_->luminance(emitter, point);
  const Rgb value = luminance.value_or(Rgb{});
  return {value, largest(value - exact.value) + exact.bound, rule_ != nullptr ? rule_->name : specular_->name};
}

Answer Evaluator::by_samples(const Emitter& emitter, const PointRow& p) const {
  const double scale = lambert_ ? pi : 1;
  const eval::SampledEstimate estimate = eval::monte_carlo(emitter, shading_point(p), *sampling_);
  return {estimate.value * scale, largest(estimate.error()) * scale, "monte-carlo"};
}

Answer Evaluator::operator()(const Emitter& emitter, const PointRow& p) const {
  if (sampling_) return by_samples(emitter, p);
  if (patches_) return by_card(emitter, p).value_or(Answer{{}, 0, "patches"});
  if (looked_up_ != nullptr) return by_lookup(emitter, p).value_or(Answer{{}, 0, looked_up_->name});
  if (adaptive_) return adaptively(emitter, p).value_or(Answer{{}, 0, "adaptive"});
  if (published_ != nullptr) {
    // What a published approximation is off by is measured here, against the closed form.
    const std::optional<double> sr = published_->illuminance(emitter, p.position, p.normal);
    const Rgb value = emitter.radiance * sr.value_or(0);
    const Rgb exact = eval::illuminance(emitter, p.position, p.normal);
    return {value, largest(value - exact) + rounding_of(emitter, exact), published_->name};
  }
  if (!lambert_ && (rule_ != nullptr || specular_ != nullptr || (fast_ && has_closed_form(emitter) && !is_window(emitter.window))))
    return by_rule(emitter, p);
  if (!lambert_ || !closed_ || !has_closed_form(emitter)) return by_reference(emitter, p);
  const Rgb value = eval::illuminance(emitter, p.position, p.normal);
  return {value, rounding_of(emitter, value), "exact"};
}

// Points as floats, relative to the first of them.
struct FloatPoints {
  explicit FloatPoints(std::span<const PointRow> points) : origin(points.front().position) {
    for (const PointRow& p : points) {
      const Vec3d at = p.position - origin;
      const std::array<double, 6> from{at.x, at.y, at.z, p.normal.x, p.normal.y, p.normal.z};
      for (std::size_t k = 0; k < 6; ++k) columns[k].push_back(static_cast<float>(from[k]));
      const Vec3d rounded{columns[0].back(), columns[1].back(), columns[2].back()};
      if (std::isfinite(length(rounded))) moved_m = std::max(moved_m, length(rounded - at));
    }
  }
  eval::PointBatch batch() const { return {columns[0], columns[1], columns[2], columns[3], columns[4], columns[5], origin}; }

  Vec3d origin;
  std::array<std::vector<float>, 6> columns;
  double moved_m = 0;  // the furthest that a point was by rounding
};

// What a surface facing the light gets at most, where a LightBatch errs by it: the luminance times a solid angle of 1, the intensity over
// the distance squared, the illuminance of a true direction. Lines are evaluated one by one.
double facing(const Emitter& emitter, const Rgb& scale, const Vec3d& position) {
  if (std::holds_alternative<eval::LineEmitter>(emitter.shape)) return 0;
  const auto* punctual = std::get_if<eval::PunctualEmitter>(&emitter.shape);
  if (punctual == nullptr) return largest(scale);
  const Vec3d to = punctual->position - position;
  return largest(scale) / std::max(dot(to, to), 1e-280);
}

Evaluator::Prepared Evaluator::prepared(const Emitter& emitter, const std::shared_ptr<const eval::PictureMoments>& picture) const {
  Prepared made;
  // Lambert's closed forms need no plan; pictures have none.
  if (planned_ && (!lambert_ || picture != nullptr)) made.plan.emplace(emitter, eval::Tolerance{tolerance_, 0}, picture);
  if (!in_floats()) return made;
  Result<eval::LightBatch> batch = eval::LightBatch::of(emitter);
  if (batch) made.batch = *std::move(batch);
  return made;
}

std::vector<Answer> Evaluator::operator()(const Emitter& emitter, const Prepared& prepared, std::span<const PointRow> points) const {
  std::vector<Answer> answers;
  answers.reserve(points.size());
  if (prepared.plan) {
    std::vector<eval::ShadingPoint> places;
    for (const PointRow& p : points) places.push_back(shading_point(p));
    const double scale = lambert_ ? pi : 1;
    for (const eval::LightWithin& found : (*prepared.plan)(places))
      answers.push_back({found.light.value * scale, largest(found.light.error) * scale, found.way});
    return answers;
  }
  const std::optional<eval::LightBatch>& batch = prepared.batch;
  if (!batch) {
    for (const PointRow& p : points) answers.push_back((*this)(emitter, p));
    return answers;
  }
  const FloatPoints floats(points);
  std::vector<float> sr(points.size());
  const BatchOutcome done = batch->projected_solid_angles(floats.batch(), sr, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!done || !std::isfinite(sr[i])) {  // too far from the others for a float
      answers.push_back((*this)(emitter, points[i]));
      continue;
    }
    const Rgb value = batch->scale() * static_cast<double>(sr[i]);
    answers.push_back({value, 1e-5 * largest(value) + 2e-6 * facing(emitter, batch->scale(), points[i].position), "fast"});
  }
  return answers;
}

// All lights together in floats, those that are below the tolerance skipped.
class Sum {
 public:
  Sum(const std::vector<Emitter>& emitters, const Evaluator& one_by_one, double tolerance)
      : rig_(emitters), one_by_one_(one_by_one), tolerance_{tolerance, 0} {}

  std::vector<Answer> operator()(std::span<const PointRow> points) {
    const FloatPoints floats(points);
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    std::vector<Vec3f> lux(points.size());
    std::vector<float> bound(points.size());
    const Result<eval::RigCounts> done = rig_.illuminance(floats.batch(), tolerance_, lux, bound, {none, none, none}, workspace_);
    moved_m_ = std::max(moved_m_, floats.moved_m);
    std::vector<Answer> answers;
    answers.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (done && std::isfinite(lux[i].x)) {
        answers.push_back({vec_cast<double>(lux[i]), static_cast<double>(bound[i]), "sum"});
        continue;
      }
      Answer all{{}, 0, "sum"};  // too far from the others for a float
      for (const Emitter& emitter : rig_.emitters()) {
        const Answer one = one_by_one_(emitter, points[i]);
        all.value += one.value;
        all.bound += one.bound;
      }
      counts_.evaluated += rig_.emitters().size();
      answers.push_back(all);
    }
    if (!done) return answers;
    counts_.evaluated += done->evaluated;
    counts_.repeated += done->repeated;
    counts_.skipped_unseen += done->skipped_unseen;
    counts_.skipped_small += done->skipped_small;
    counts_.bounds += done->bounds;
    return answers;
  }
  void tell(Json& stats) const {
    stats["evaluations"] = counts_.evaluated;
    stats["repeated"] = counts_.repeated;
    stats["skipped_unseen"] = counts_.skipped_unseen;
    stats["skipped_small"] = counts_.skipped_small;
    stats["bounds"] = counts_.bounds;
    stats["rounded_m"] = moved_m_;
  }

 private:
  eval::RigBatch rig_;
  const Evaluator& one_by_one_;
  eval::Tolerance tolerance_;
  eval::RigBatch::Workspace workspace_;
  eval::RigCounts counts_;
  double moved_m_ = 0;
};

int run_eval(const Common& common, const Options& options) {
  Session session("eval", common);
  Result<Evaluator> evaluator = Evaluator::of(options);
  if (!evaluator) return session.fail(evaluator.error());
  Result<Imported> imported = read_asset(session, options.asset, options.import);
  if (!imported) return session.fail(imported.error());
  session.diagnostics.append(validate(imported->scene));
  if (session.diagnostics.has_errors()) return session.finish(exit_bad_input);
  const auto lit = lit_lights(imported->scene, options.lights, options.mute);
  if (!lit) return session.fail(lit.error());
  Result<std::vector<Emitter>> emitters = std::vector<Emitter>{};
  std::vector<std::shared_ptr<const eval::PictureMoments>> pictures(lit->size());
  if (evaluator->wants_pictures()) {
    Result<std::vector<PicturedEmitter>> pictured = pictured_emitters_of(imported->scene, *lit);
    if (!pictured) return session.fail(pictured.error());
    for (std::size_t i = 0; i < lit->size(); ++i)
      emitters->push_back(std::move((*pictured)[i].emitter)), pictures[i] = std::move((*pictured)[i].picture);
  } else {
    emitters = emitters_of(imported->scene, *lit);
  }
  if (!emitters) return session.fail(emitters.error());
  const auto name = [&](std::size_t i) -> const std::string& { return imported->scene.lights[(*lit)[i]].name; };
  for (std::size_t i = 0; i < emitters->size() && evaluator->wants_cards(); ++i) {
    Result<eval::LightCard> card = card_of(imported->scene, imported->scene.lights[(*lit)[i]]);
    if (!card) return session.fail(card.error());
    evaluator->take_card((*emitters)[i], std::move(*card));
  }
  for (std::size_t i = 0; i < emitters->size(); ++i)
    if (const Status ok = evaluator->accepts((*emitters)[i], name(i)); !ok) return session.fail(ok.error());

  std::optional<Sum> sum;
  std::vector<Evaluator::Prepared> prepared;
  if (options.sum && evaluator->in_floats()) {
    sum.emplace(*emitters, *evaluator, options.tolerance);
  } else {
    for (std::size_t i = 0; i < emitters->size(); ++i) prepared.push_back(evaluator->prepared((*emitters)[i], pictures[i]));
  }
  session.result = Json::array();
  std::uint64_t points = 0;
  std::string rows = "index,light,r,g,b,bound,method\n";
  const auto tell = [&](std::uint64_t index, const std::string& light, const Answer& a) {
    if (common.json) {
      session.result.push_back({{"index", index},
                                {"light", light},
                                {"r", a.value.x},
                                {"g", a.value.y},
                                {"b", a.value.z},
                                {"bound", a.bound},
                                {"method", a.method}});
      return;
    }
    fmt::format_to(std::back_inserter(rows), "{},", index);
    append_field(rows, light);
    fmt::format_to(std::back_inserter(rows), ",{},{},{},{},{}\n", a.value.x, a.value.y, a.value.z, a.bound, a.method);
  };
  const auto write_rows = [&]() -> Status {
    if (!common.json && (std::fwrite(rows.data(), 1, rows.size(), stdout) != rows.size() || std::fflush(stdout) != 0))
      return Error{"FILE_UNWRITABLE", "the output cannot be written", {}, {}, {}};
    rows.clear();
    return Done{};
  };
  Status read = each_block(options.points, evaluator->wants_view(), [&](std::span<const PointRow> block) -> Status {
    if (interrupted()) return Error{"CANCELLED", "stopped", {}, {}, {}};
    if (sum) {
      const std::vector<Answer> answers = (*sum)(block);
      for (std::size_t p = 0; p < block.size(); ++p) tell(points + p, "all", answers[p]);
    } else {
      std::vector<std::vector<Answer>> by_light;
      by_light.reserve(emitters->size());
      for (std::size_t i = 0; i < emitters->size(); ++i) by_light.push_back((*evaluator)((*emitters)[i], prepared[i], block));
      for (std::size_t p = 0; p < block.size(); ++p) {
        Answer all{{}, 0, "sum"};
        for (std::size_t i = 0; i < by_light.size(); ++i) {
          const Answer& one = by_light[i][p];
          all.value += one.value;
          all.bound += one.bound;
          if (!options.sum) tell(points + p, name(i), one);
        }
        if (options.sum) tell(points + p, "all", all);
      }
    }
    points += block.size();
    return write_rows();
  });
  if (read) read = write_rows();  // the heading, if there are no points
  session.stats["points"] = points;
  session.stats["evaluations"] = points * emitters->size();
  if (sum) sum->tell(session.stats);
  if (!read) return session.fail(read.error());
  return session.finish(exit_done);
}

}  // namespace

void add_eval(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("eval", "The light of a rig at points, light by light, with a bound of its error");
  auto options = std::make_shared<Options>();
  verb->add_option("RIG", options->asset, "A light rig or glTF file")->required();
  verb->add_option("--points", options->points, "CSV: px,py,pz,nx,ny,nz, and vx,vy,vz towards the eye but for lambert; metres; - is stdin")
      ->required();
  verb->add_option("--brdf", options->brdf, fmt::format("{}; lambert gives lux, the others cd/m2 towards the eye", brdf_names))
      ->capture_default_str();
  verb->add_option("--alpha", options->alpha, "Roughness squared")->check(CLI::Range(0.0, 1.0));
  verb->add_option("--roughness", options->roughness, "Perceptually linear (default 0.5)")->check(CLI::Range(0.0, 1.0));
  verb->add_option("--f0", options->f0, "Reflectance at normal incidence")->capture_default_str()->check(CLI::Range(0.0, 1.0));
  verb->add_option("--f90", options->f90, "Of a lobe: reflectance at grazing incidence (default 1)")->check(CLI::Range(0.0, 1.0));
  verb->add_flag("--micro-occlusion", options->micro_occlusion, "Of a lobe: f90 = min(50 f0, 1)");
  verb->add_flag("--passed-on", options->passed_on, "Of a lobe: with the light that facets pass on to each other");
  verb->add_option("--masking", options->masking,
                   "Of a lobe: correlated (default), separable (both Smith's), schlick-direct or schlick-image (Karis')")
      ->check(CLI::IsMember(names_of(maskings)));
  verb->add_option("--fresnel", options->fresnel, "Of a lobe: schlick, schlick-gaussian (Karis'), dielectric or conductor (exact)")
      ->capture_default_str()
      ->check(CLI::IsMember(names_of(fresnels)));
  verb->add_option("--eta", options->eta, "Index of refraction r,g,b; of a dielectric that of f0 unless given");
  verb->add_option("--k", options->k, "Extinction r,g,b of a conductor");
  verb->add_option("--alpha-across", options->alpha_across, "Of ggx and beckmann: alpha across the tangent, another than along it")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--tangent", options->tangent, "x,y,z: along it alpha is --alpha; made perpendicular to each normal");
  verb->add_option("--base-colour", options->base_colour, "r,g,b, linear")->capture_default_str();
  const CLI::Option* const method =
      verb->add_option(
              "--method", options->method,
              "exact, fast (floats; of other diffuse BRDFs a few dozen evaluations, whose bound is an estimate that 99 of 100 keep), "
              "reference, monte-carlo (samples of the light, with a statistical bound), patches (pictures on rectangles, under lambert and "
              "ggx, to "
              "about --tolerance), one lookup into them (drobot-diffuse-card of lambert; drobot-card, ltc-along-f, ltc-perpendicular of "
              "ggx), or a method's name: published ones of diffuse "
              "light; of ggx adaptive (to --tolerance), moments, ltc, ltc-two-lobes, and published ones such as karis-14, drobot-elongated "
              "(of "
              "every round lobe), frostbite-6 (the sun). A name that is none lists them. With --tolerance alone, of lambert for pictures "
              "on rectangles: whatever "
              "keeps it at the least cost, which the answer names")
          ->capture_default_str();
  verb->add_option("--samples", options->samples, "Of monte-carlo: samples of each light at each point (default 65536)")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32));
  verb->add_option("--seed", options->seed, "Of monte-carlo: the same answers for the same seed (default 1)");
  const CLI::Option* const tolerance =
      verb->add_option(
              "--tolerance", options->tolerance,
              "Where nothing is exact: error at most this part of the value. With --sum, of lambert: lights that are below it are left "
              "out, from 1e-6 on; --stats counts them")
          ->capture_default_str()
          ->check(CLI::Range(1e-9, 0.1));
  verb->add_flag("--sum", options->sum, "One row a point: all lights together");
  verb->add_option("--lights", options->lights, "Only these lights, by name: a,b");
  verb->add_option("--mute", options->mute, "All but these lights");
  add_limits(*verb, options->import);
  verb->footer(
      "\nNothing stands in the light's way: shadows are render's.\n"
      "\nExamples:\n"
      "  echo 0,0,0,0,1,0 | etendue eval kitchen.rig.json --points - --sum\n"
      "  etendue eval street.rig.json --points road.csv --method fast --sum --tolerance 1e-2 --stats\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf ggx --alpha 0.1 --tolerance 1e-3\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf ggx --alpha 0.1 --lights key --method moments\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf phong --alpha 0.1 --lights key --method drobot-1-20-fitted\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf beckmann --alpha 0.05 --alpha-across 0.3 --tangent 1,0,0\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf ggx --alpha 0.2 --fresnel conductor --eta 0.2,0.92,1.1 --k 3.9,2.4,2.1\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf oren-nayar --roughness 0.8 --method fast\n"
      "  etendue eval studio.rig.json --points floor.csv --brdf standard --method monte-carlo --samples 1000000 --seed 7\n"
      "  etendue eval studio.rig.json --points floor.csv --lights key --method frostbite-12\n"
      "  etendue eval screen.rig.json --points floor.csv --brdf ggx --alpha 0.2 --method patches --tolerance 1e-2\n"
      "  etendue eval screen.rig.json --points floor.csv --method drobot-diffuse-card\n"
      "  etendue eval screen.rig.json --points floor.csv --brdf standard --tolerance 1e-3");
  verb->callback([&common, &run, options, method, tolerance] {
    options->tolerance_alone = method->count() == 0 && tolerance->count() > 0;
    run = [&common, options] { return run_eval(common, *options); };
  });
}

}  // namespace etendue::cli
