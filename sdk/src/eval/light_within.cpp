#include "etendue/light_within.h"

#include "etendue/far_luminance.h"
#include "etendue/picture_light.h"
#include "etendue/specular_light.h"
#include "etendue/specular_within_batch.h"
#include "schlick_lobes.h"
#include "specular_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace etendue::eval {

// Cells in vectors by what they are asked for: GGX alone, and beside a diffuse lobe, which has the other half; each of both maskings.
struct LightPlan::Batches {
  using OfMasking = std::array<std::optional<SpecularWithinBatch>, 2>;
  OfMasking whole, half;
};

namespace {

double brightest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }
double dimmest(const Rgb& c) { return std::min({c.x, c.y, c.z}); }

bool has_extent(const Emitter& emitter) {
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape)) return sun->radius_rad > 0;
  return !std::holds_alternative<PunctualEmitter>(emitter.shape);
}

Estimate sum_of(const Estimate& a, const Estimate& b) { return {a.value + b.value, a.error + b.error, a.evaluations + b.evaluations}; }

// One point under one light.
class Planned {
 public:
  Planned(const Emitter& emitter, const Tolerance& tolerance, const ShadingPoint& point, double floor = 0)
      : emitter_(emitter), tolerance_(tolerance), point_(point), floor_(floor) {}

  std::optional<LightWithin> of_picture(const PictureMoments& picture) {
    Emitter plain = emitter_;
    plain.pattern = {};
    plain.radiance = plain.radiance * picture.mean();
    floor_ = 1e-3 * brightest(illuminance(plain, point_.position, point_.normal));
    const double absolute = std::max(tolerance_.relative * floor_, tolerance_.absolute);
    const auto light = picture_luminance(emitter_, picture, point_, {tolerance_.relative, absolute});
    return light ? std::optional(LightWithin{*light, light->value == Rgb{} ? "unseen" : "picture"}) : std::nullopt;
  }

  // Where one of the ways that need no cells is enough.
  std::optional<LightWithin> at_once() {
    if (!(dot(point_.normal, point_.view) > 0)) return LightWithin{{}, "unseen"};
    const bool closed = has_closed_form(emitter_);
    if (std::holds_alternative<Lambert>(point_.brdf) || !has_extent(emitter_)) {
      const Estimate light = by_reference(point_, 1);
      return LightWithin{light, !closed ? "reference" : light.value == Rgb{} ? "unseen" : "exact"};
    }
    if (const auto few = far_luminance(emitter_, point_, tolerance_.relative)) return LightWithin{*few, "far"};
    if (closed && !see()) return LightWithin{{}, "unseen"};
    return std::nullopt;
  }
  double floor() const { return floor_; }
  LightWithin one_by_one() const {
    const std::optional<SchlickLobes> lobes = is_uniform_area_light(emitter_) ? schlick_lobes(point_.brdf) : std::nullopt;
    if (!lobes) return {by_reference(point_, 1), "reference"};
    ShadingPoint lobe = point_;
    lobe.brdf = lobes->specular;
    const double part = lobes->diffuse ? 0.5 : 1;
    const auto specular = specular_luminance(emitter_, lobe, part * tolerance_.relative, tolerance_.absolute / tolerance_.relative);
    if (!specular) return {by_reference(point_, 1), "reference"};
    if (!lobes->diffuse) return {*specular, "adaptive"};
    return {sum_of(*specular, diffuse(*lobes->diffuse)), "two lobes"};
  }
  Estimate diffuse(const Brdf& brdf) const {
    ShadingPoint lobe = point_;
    lobe.brdf = brdf;
    if (const auto few = far_luminance(emitter_, lobe, 0.5 * tolerance_.relative)) return *few;
    return by_reference(lobe, 0.5);
  }

 private:
  bool see() {
    floor_ = 1e-3 * brightest(illuminance(emitter_, point_.position, point_.normal));
    return floor_ > 0;
  }
  Estimate by_reference(const ShadingPoint& point, double part) const {
    return reference(emitter_, point, {tolerance_.relative * part, std::max(tolerance_.relative * floor_, tolerance_.absolute) * part});
  }

  const Emitter& emitter_;
  const Tolerance& tolerance_;
  const ShadingPoint& point_;
  double floor_;  // 1e-3 E L, once it is known
};

// Points that go to cells in vectors together.
struct Group {
  std::vector<std::size_t> index;
  std::vector<SpecularPlace> places;
  std::vector<SchlickLobes> lobes;
  std::vector<double> floors;

  // Whether the lobe is one that those cells take.
  static bool takes(const GgxLobe& ggx) {
    if (ggx.masking != Masking::correlated && ggx.masking != Masking::separable) return false;
    return dimmest(ggx.f0) >= SpecularWithinBatch::least_f0 * ggx.f90 && brightest(ggx.f0) <= ggx.f90;
  }
  void add(std::size_t i, const ShadingPoint& p, const SchlickLobes& parts, double floor) {
    index.push_back(i), places.push_back({p.position, p.normal, p.view, parts.specular.alpha});
    lobes.push_back(parts), floors.push_back(floor);
  }
  // use(k, estimate) for every one of them that has an answer, which those with a number that is not finite have not.
  template <class Use>
  void shares(const SpecularWithinBatch& batch, const Use& use) const {
    const std::size_t count = index.size();
    std::vector<float> numbers(4 * count);
    const auto part = [&](std::size_t k) { return std::span(numbers).subspan(k * count, count); };
    const bool done = static_cast<bool>(batch.shares(places, {part(0), part(1), part(2), part(3)}, -1));
    for (std::size_t k = 0; k < count; ++k) {
      const auto number = [&](std::size_t which) { return static_cast<double>(numbers[which * count + k]); };
      const GgxLobe& ggx = lobes[k].specular;
      const auto mixed = [&](std::size_t of_f0, std::size_t of_f90) {
        return batch.scale() * (ggx.f0 * number(of_f0) + Rgb{1, 1, 1} * (ggx.f90 * number(of_f90)));
      };
      use(k, done && number(0) >= 0 ? std::optional(Estimate{mixed(0, 1), mixed(2, 3), 1}) : std::nullopt);
    }
  }
};

}  // namespace

LightPlan::LightPlan(const Emitter& emitter, const Tolerance& tolerance, std::shared_ptr<const PictureMoments> picture)
    : emitter_(emitter),
      tolerance_{std::clamp(tolerance.relative, 1e-9, 1.0), std::max(tolerance.absolute, 0.0)},
      picture_(std::move(picture)) {
  auto batches = std::make_shared<Batches>();
  const std::array maskings{Masking::correlated, Masking::separable};
  for (std::size_t m = 0; m < maskings.size(); ++m) {
    const auto make = [&](double part) -> std::optional<SpecularWithinBatch> {
      const double asked = std::min(part * tolerance_.relative, SpecularWithinBatch::most_tolerance);
      Result<SpecularWithinBatch> made = SpecularWithinBatch::of(emitter, asked, maskings[m], tolerance_.absolute / tolerance_.relative);
      return made ? std::optional(*std::move(made)) : std::nullopt;
    };
    batches->whole[m] = make(1), batches->half[m] = make(0.5);
  }
  batches_ = std::move(batches);
}

LightWithin LightPlan::operator()(const ShadingPoint& point) const { return (*this)(std::span(&point, 1)).front(); }

std::vector<LightWithin> LightPlan::operator()(std::span<const ShadingPoint> points) const {
  std::vector<LightWithin> answers(points.size());
  std::array<std::array<Group, 2>, 2> groups;  // without a diffuse lobe or with one; by masking
  const auto batch_of = [&](bool diffuse, std::size_t masking) -> const std::optional<SpecularWithinBatch>& {
    return (diffuse ? batches_->half : batches_->whole)[masking];
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    Planned planned(emitter_, tolerance_, points[i]);
    const auto pictured = picture_ != nullptr ? planned.of_picture(*picture_) : std::nullopt;
    if (const auto found = pictured ? pictured : planned.at_once()) {
      answers[i] = *found;
      continue;
    }
    const std::optional<SchlickLobes> lobes = schlick_lobes(points[i].brdf);
    const std::size_t masking = lobes && lobes->specular.masking == Masking::separable ? 1 : 0;
    const bool diffuse = lobes && lobes->diffuse;
    if (lobes && Group::takes(lobes->specular) && batch_of(diffuse, masking) && points[i].normal == points[i].surface_normal) {
      groups[diffuse ? 1 : 0][masking].add(i, points[i], *lobes, planned.floor());
    } else {
      answers[i] = planned.one_by_one();
    }
  }
  for (const bool diffuse : {false, true}) {
    for (const std::size_t masking : {std::size_t{0}, std::size_t{1}}) {
      const Group& group = groups[diffuse ? 1 : 0][masking];
      if (group.index.empty()) continue;
      group.shares(*batch_of(diffuse, masking), [&](std::size_t k, const std::optional<Estimate>& specular) {
        const std::size_t i = group.index[k];
        const Planned planned(emitter_, tolerance_, points[i], group.floors[k]);
        if (!specular) {
          answers[i] = planned.one_by_one();
        } else {
          answers[i] = {diffuse ? sum_of(*specular, planned.diffuse(*group.lobes[k].diffuse)) : *specular, "cells"};
        }
      });
    }
  }
  return answers;
}

LightWithin light_within(const Emitter& emitter, const ShadingPoint& point, double tolerance) {
  const Tolerance asked{std::clamp(tolerance, 1e-9, 1.0), 0};
  Planned planned(emitter, asked, point);
  if (const auto found = planned.at_once()) return *found;
  return planned.one_by_one();
}

}  // namespace etendue::eval
