// The cosine integral of one area light at many points at once, in float, on the best instruction set that the machine has.
#pragma once

#include "etendue/batch.h"
#include "etendue/eval.h"

#include <memory>
#include <span>
#include <utility>

namespace etendue::eval {

// Shading points as a structure of arrays: positions in metres from `origin`, unit normals. All spans are of one size. An origin near the
// points keeps their digits: a float 1 km from it is rounded to .03 mm.
struct PointBatch {
  std::span<const float> px, py, pz, nx, ny, nz;
  Vec3d origin;
};

// One area light made ready for batches.
class LightBatch {
 public:
  // Errors: EVALUATION_UNSUPPORTED: no area light, or one with a pattern or a window.
  static Result<LightBatch> of(const Emitter& emitter);

  // The integral of max(n.l, 0) over the directions of the light (sr): times Emitter::radiance it is illuminance() of the same points.
  // Spheres and polygons, convex or not, run in vectors with
  //     |error| <= 1e-5 value + 2e-6 min(1, solid angle of the light),
  // of doubles where those of floats would not hold it; disks, tubes and meshes are evaluated one by one. Points with a number that is not
  // finite become `where_none`, and are counted. Errors: BATCH_SIZES_DIFFER.
  BatchOutcome projected_solid_angles(const PointBatch& points, std::span<float> sr, float where_none) const;

  class Shape;  // sdk/src/eval/light_batch.h

 private:
  explicit LightBatch(std::shared_ptr<const Shape> shape) : shape_(std::move(shape)) {}
  std::shared_ptr<const Shape> shape_;
};

}  // namespace etendue::eval
