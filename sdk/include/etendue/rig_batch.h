// The illuminance that many lights together give at many points, where only a few matter at each: the others are skipped by bounds of their
// light, and the tolerance is kept at every point.
#pragma once

#include "etendue/illuminance_batch.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue::eval {

// Pairs of a light and a point, but for `bounds` and `without`.
struct RigCounts {
  std::uint64_t evaluated = 0;
  std::uint64_t skipped_unseen = 0;  // below the horizon, behind the light, out of its range: nothing is lost
  std::uint64_t skipped_small = 0;   // within the tolerance
  std::uint64_t repeated = 0;        // evaluated once more, where floats are not within the tolerance: for fewer points, or in double
  std::uint64_t bounds = 0;          // upper bounds computed, of one light or several and of one point or many
  std::uint64_t without = 0;         // points that are not finite
};

// The emitters of a rig made ready once: a tree of their bounds, and each as a LightBatch where it can be one.
class RigBatch {
 public:
  explicit RigBatch(std::vector<Emitter> emitters);
  ~RigBatch();
  RigBatch(RigBatch&&) noexcept;
  RigBatch& operator=(RigBatch&&) noexcept;

  // Memory that calls share, one at a time: about 64 bytes a point, of the first million. A kept one is not allocated again.
  class Workspace {
   public:
    Workspace();
    ~Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;

   private:
    friend class RigBatch;
    struct Parts;
    std::unique_ptr<Parts> parts_;
  };

  // lx, linear Rec.709, of all lights together. In every channel and at every point, whatever the order of the points,
  //     |error| <= max(tolerance.absolute, tolerance.relative * largest channel of the sum)
  // against the sum of illuminance() over all emitters; the least that floats can hold, 1e-7 of the sum, is always granted. `bound`, as
  // long as the points or empty: what |error| is at most at each. A light that is skipped is left out where it may be unseen; where all of
  // it is seen for certain, the middle of its bounds stands for it. Environments, true directions and lights with a pattern are skipped
  // only where they are not seen. Points with a number that is not finite become `where_none`, their bound 0. Errors: BATCH_SIZES_DIFFER.
  Result<RigCounts> illuminance(const PointBatch& points, const Tolerance& tolerance, std::span<Vec3f> lux, std::span<float> bound,
                                Vec3f where_none, Workspace& workspace) const;

  const std::vector<Emitter>& emitters() const;

 private:
  struct Prepared;
  struct Run;
  std::unique_ptr<const Prepared> prepared_;
};

}  // namespace etendue::eval
