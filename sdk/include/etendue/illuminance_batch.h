// The illuminance of one light at many points at once, in float, on the best instruction set that the machine has.
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

// One light made ready for batches.
class LightBatch {
 public:
  // Errors: EVALUATION_UNSUPPORTED: no closed form (eval.h): a pattern or a map.
  static Result<LightBatch> of(const Emitter& emitter);

  // The illuminance at each point over scale(), so that illuminance() = scale() * value, by the shape of the light:
  //   area lights and constant environments: sr, the integral of max(n.l, 0) over the directions of the light. scale(): cd/m2;
  //   punctual lights and lines: 1/m2, the illuminance for an intensity of 1 cd, window included. scale(): cd;
  //   true directions and sun disks: no unit, for 1 lx on a plane facing the light. scale(): lx.
  // Spheres, disks, polygons (convex or not), meshes and tubes run in vectors with
  //     |error| <= 1e-5 value + 2e-6 min(1, solid angle of the light),
  // point lights, spots, frusta, lines and distant lights with
  //     |error| <= 1e-5 value + 2e-6 (what the axial intensity gives a facing surface from the closest point, no window),
  // of doubles where those of floats would not hold it. The solid angle of a mesh is that of all its triangles that face the point. All
  // else is evaluated one by one: profiles, lines with a window, area lights with one but frostbite's and glTF's on flat lights. Too large
  // for a float: becomes the largest. Points with a number that is not finite become `where_none`, and are counted. Errors:
  // BATCH_SIZES_DIFFER.
  BatchOutcome projected_solid_angles(const PointBatch& points, std::span<float> values, float where_none) const;
  // cd/m2, cd or lx: what the light emits.
  const Rgb& scale() const { return scale_; }

  class Shape;  // sdk/src/eval/light_batch.h

 private:
  LightBatch(std::shared_ptr<const Shape> shape, const Rgb& scale) : shape_(std::move(shape)), scale_(scale) {}
  std::shared_ptr<const Shape> shape_;
  Rgb scale_;
};

}  // namespace etendue::eval
