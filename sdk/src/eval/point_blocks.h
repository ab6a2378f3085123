// Points put next to their neighbours: groups of up to some thousand, of alike normals and in a box of space.
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

  struct Group {
    std::size_t first, count;
    bool moved;  // to the other of both buffers
  };
  const std::vector<Group>& groups() const { return groups_; }
  // The points of a group, neighbour after neighbour.
  std::span<const PlacedPoint> ordered(const Group& group);
  const std::vector<std::uint32_t>& not_finite() const { return not_finite_; }

 private:
  void divide(const Group& points, int depth);
  PlacedPoint* buffer(bool moved) { return moved ? other_.data() : points_.data(); }

  std::vector<PlacedPoint> points_, other_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> not_finite_;
  std::vector<std::uint8_t> directions_;
};

}  // namespace etendue::eval
