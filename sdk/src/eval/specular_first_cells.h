// Where cells begin: as specular_light.cpp lays them out, sides are cut into parts, rays of those that reach a layer into cells.
#pragma once

#include "specular_cells.h"
#include "specular_layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue::eval {

// One side of one point, in floats.
struct SideAt {
  const SideBlock& block;
  std::size_t side, point;

  float of(SideBlock::OfSide k) const { return block.side[k][side]; }
  float of(SideBlock::OfPoint k) const { return block.point[k][point]; }
  double x_of(double tau) const {
    const double kappa = of(SideBlock::kappa);
    return 2 * tau / (kappa + std::sqrt(kappa * kappa + 4 * tau * tau));
  }
  struct Q {
    float x, y;
    // 1 - p
    float from_rim() const {
      const float q2 = x * x + y * y, root = std::sqrt(1 + q2);
      return (1 + 1 / (root + std::sqrt(q2))) / (1 + root);
    }
  };
  Q middle_of(const SpanOfX& x) const {
    const float middle = 0.5f * (x.from + x.to), to_end = (1 - x.origin) - middle, to_begin = (1 + x.origin) + middle;
    return at(of(SideBlock::kappa) * (x.origin + middle) / (to_end * to_begin));
  }
  Q at(float tau) const {
    const auto quadratic = [&](SideBlock::OfSide c0, SideBlock::OfSide c1, SideBlock::OfSide c2) {
      return of(c0) + tau * (of(c1) + tau * of(c2));
    };
    Q h{quadratic(SideBlock::x0, SideBlock::x1, SideBlock::x2), quadratic(SideBlock::y0, SideBlock::y1, SideBlock::y2)};
    float z = quadratic(SideBlock::z0, SideBlock::z1, SideBlock::z2);
    if (block.rims) {
      const float w = quadratic(SideBlock::w0, SideBlock::w1, SideBlock::w2),
                  rest = tau * tau * tau * (of(SideBlock::w3) + tau * of(SideBlock::w4));
      const float r = rest / (w + std::sqrt(std::max(w * w + rest, 0.0f)));
      h.x += of(SideBlock::view_x) / of(SideBlock::alpha) * r, z += of(SideBlock::view_z) * r;
    }
    return {h.x / z, h.y / z};
  }
};

class FirstCells {
 public:
  // The list has to outlive it.
  FirstCells(double tolerance, PartList& parts) : tolerance_(tolerance), reaching_(&parts) {}

  // Of the points of a block that are asked for, whose cells come one after the other.
  // `negligible`: part of the light that no cell is laid out for.
  void lay(const SideBlock& block, std::span<const bool> wanted, float negligible, CellList& cells);

 private:
  struct Part {
    std::int32_t point, side;
    SpanOfX x;
    std::int32_t reaching = -1;  // where it is in that list
  };
  void cut_side(const SideAt& at, float layer, bool horizon);
  void lay_cells(const Part& part, const SideBlock& block, CellList& cells) const;

  double tolerance_;
  float negligible_ = 0;
  SideEnds ends_;
  std::vector<Part> parts_;
  PartList* reaching_;
};

}  // namespace etendue::eval
