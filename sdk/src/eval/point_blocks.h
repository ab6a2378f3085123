// Points put next to their neighbours: groups of some thousand in a box of space, and within them runs of alike normals.
#pragma once

#include "etendue/illuminance_batch.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue::eval {

struct PlacedPoint {
  std::array<float, 6> at;  // position and normal
  std::uint32_t index;      // from the first one arranged
  std::uint32_t key;
};

class PointBlocks {
 public:
  static constexpr std::size_t longest_group = 2048;

  // Points `first` to `first + count` of the batch, count < 2^32; those that are not finite are left out and listed.
  void arrange(const PointBatch& points, std::size_t first, std::size_t count);

  struct Range {
    std::size_t first, count;
  };
  struct Group {
    Range range;
    bool moved;  // to the other of both buffers
  };
  const std::vector<Group>& groups() const { return groups_; }
  // The points of a group in order: by their normals' runs, counted from the group's first point, and in each neighbour after neighbour.
  std::span<const PlacedPoint> runs_of(const Group& group, std::vector<Range>& runs);
  const std::vector<std::uint32_t>& not_finite() const { return not_finite_; }

 private:
  void divide(Range range, bool moved, int depth);
  PlacedPoint* buffer(bool moved) { return moved ? other_.data() : points_.data(); }

  std::vector<PlacedPoint> points_, other_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> not_finite_, starts_;
};

}  // namespace etendue::eval
