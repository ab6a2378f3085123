// Methods for the diffuse light of one area light at many points at once, in float, by name: the published ones of published.h that have
// been written in vectors, and rules of ours that are cheaper than LightBatch and less exact. `etendue bench` shows what each costs and
// errs.
//   const Result<MethodBatch> batch = MethodBatch::of(*find_batch_method("frostbite-12"), emitter);
//   BatchOutcome done = batch->projected_solid_angles(points, sr, 0);
#pragma once

#include "etendue/illuminance_batch.h"

#include <memory>
#include <span>
#include <string_view>
#include <utility>

namespace etendue::eval {

enum class BatchRule {
  // Published, as in published.h.
  structured_sampling,
  form_factor,
  simplified_point,
  light_position,
  drobot_point,
  drobot_point_horizon,
  drobot_simplified,
  drobot_simplified_horizon,
  hill_acos,
  hill_rational,
  hill_quadratic,
  hill_ratio_table,
  hill_cheap,
  patch_without_horizon,
  patch,
  sphere_or_disk,
  capsule,
  karis_sphere,
  karis_sphere_9,
  karis_line,
  karis_line_16,
  eden_sphere,
  eden_tube,
  // Ours.
  nodes_1,
  nodes_2,
  nodes_3,
  edges,
  vector,
};

struct BatchMethod {
  std::string_view name;  // of a published method: that of published.h
  bool ours;
  std::string_view note;  // what it does
  BatchRule rule;
  bool rect = false, disk = false, sphere = false,
       tube = false;  // One-sided rectangles and disks, spheres, tubes with round caps and a length: those that it takes.
};

std::span<const BatchMethod> batch_methods();
// Null if no method has the name.
const BatchMethod* find_batch_method(std::string_view name);

// One light made ready for a method.
class MethodBatch {
 public:
  // Errors: METHOD_SHAPE: the method does not take the emitter.
  static Result<MethodBatch> of(const BatchMethod& method, const Emitter& emitter);

  // The illuminance at each point for a luminance of 1 cd/m2, without pattern and window. A published method gives what its double form
  // gives, but for the roundings of floats; where it has no finite number the value is 0. Flat lights are dark from behind. Points with a
  // number that is not finite become `where_none`, and are counted. Errors: BATCH_SIZES_DIFFER.
  BatchOutcome projected_solid_angles(const PointBatch& points, std::span<float> values, float where_none) const;

  class Light;  // sdk/src/eval/method_batch.h

 private:
  MethodBatch(BatchRule rule, std::shared_ptr<const Light> light) : rule_(rule), light_(std::move(light)) {}
  BatchRule rule_;
  std::shared_ptr<const Light> light_;
};

}  // namespace etendue::eval
