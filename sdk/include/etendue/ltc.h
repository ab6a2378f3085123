// Linearly transformed cosines of our own (Heitz, Dupuy, Hill and Neubelt 2016): the lobe of GGX stood in for by a clamped cosine whose
// directions are sent through a matrix. A light seen through the inverse matrix lights the cosine as it does a Lambert surface, in closed
// form. How the matrices are found, what is off by how much: sdk/docs/specular.md.
#pragma once

#include "etendue/eval.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace etendue::eval {

// Directions stand in the shading frame turned so that the view lies in the half plane x >= 0, y = 0.
struct TransformedCosine {
  Transform inverse;  // from directions to those of the cosine; mirrored y is the same

  // Of the clamped cosine the share whose directions are above the horizon z = 0: (1 + n'.z) / 2, n' the horizon's normal there.
  double share_above() const;
  // Of the directions of the cosine, 1/sr: sums to 1 over the sphere, to share_above() over what is above the horizon.
  double density(const Vec3d& light) const;
};
// From five terms (LtcTable::Node) of the inverse in the frame of the mirror direction.
TransformedCosine transformed_cosine(const std::array<double, 5>& terms, double alpha, double cosine);

// Stand-ins for one view and one alpha. With w = (1 - v.h)^5, Schlick's weight, the light is f0 times what the lobe times 1 - w gives and
// f90 times what the lobe times w does: of each part of the lobe the albedo, and how much of that two cosines have, which both parts share.
struct LtcLobe {
  struct Part {
    double albedo = 0, of_first = 0;  // the second has the rest; either may be below 0
  };
  TransformedCosine whole;  // one for a lobe that mirrors all, fitted at the nodes as others' are
  TransformedCosine one;    // the same, fitted between nodes too
  TransformedCosine first, second;
  Part f0, f90;
};

// Fitted over the square of sqrt(alpha) and cos(view), `size` nodes along each, from 0 to 1. Nodes at alpha 0 and cosine 0 stand for
// `lowest_alpha` and `lowest_cosine`.
class LtcTable {
 public:
  // 5 terms of the inverse matrix for directions in the frame whose z is the mirror direction and whose y is across the plane of incidence,
  // which stay smooth and finite there as alpha goes to 0: (0, 0) and (0, 2) times alpha, 1 / (1, 1) over alpha, (2, 0), (2, 2). Then
  // the directional albedo's parts: f0 * [5] + f90 * [6]. Then 5 terms for each of the two cosines, what of the parts is the
  // first's, and 5 terms of the one that is fitted between nodes.
  static constexpr std::size_t terms = 24, albedo = 5, first = 7, second = 12, of_first = 17, one = 19;
  using Node = std::array<float, terms>;
  static constexpr double lowest_alpha = 1e-4, lowest_cosine = 1e-4;

  // size * size nodes, those of one alpha side by side.
  LtcTable(std::uint32_t size, std::vector<Node> nodes) : size_(size), nodes_(std::move(nodes)) {}
  // Bilinear.
  LtcLobe at(double alpha, double cosine) const;

  std::uint32_t size() const { return size_; }
  std::span<const Node> nodes() const { return nodes_; }
  double alpha_of(std::uint32_t row) const;
  double cosine_of(std::uint32_t column) const;

 private:
  std::uint32_t size_;
  std::vector<Node> nodes_;
};
// 33 x 33, part of the library.
const LtcTable& ltc_table();

// Height-correlated GGX fitted anew: every node's matrix makes chi^2 = integral of (p - q)^2 / (p + q) over the directions above the
// horizon smallest, p the lobe and q the cosine, both as densities there; `one` does so between nodes too, and so do the two cosines for
// the lobes of f0 = 1 and f0 = .04. `progress`, told the share that is done: false ends the work.
std::optional<LtcTable> fit_ltc(std::uint32_t size, const std::function<bool(double share_done)>& progress = {});
// How much of the lobe is in other directions than it should be: half the integral of |p - q|. No light's share of the lobe is further off.
double misplaced_share(const TransformedCosine& whole, double alpha, double view_cosine);

}  // namespace etendue::eval
