// A few nodes over what a contour encloses, for integrands that are smooth there. Derivations: sdk/docs/area-lights.md.
//
// A direction c within and the unit direction b(s) of the outline span sectors: P(s, t) = c + t (b(s) - c), 0 <= t <= 1, with
//   d omega = t det(c, b, b') / |P|^3 dt ds,
// smooth in both however small, thin or near the light is. Gauss-Legendre along s, Gauss for the weight t along t. Signed, so that outlines
// that are not convex are right as they are.
#pragma once

#include "contour.h"

#include <array>
#include <cstddef>
#include <span>

namespace etendue::eval {

// `high` is the weight times the polynomial of the rule's highest degree that it can tell from others, normalised to 1 at its end: sums
// with it say how much of that degree there is.
struct SectorNode {
  double x, weight, high;
};
std::span<const SectorNode> nodes_along(std::size_t order);   // [-1, 1], order 1 to 4
std::span<const SectorNode> nodes_across(std::size_t order);  // weight t on [0, 1]

// A piece of an arc with the nodes that it gets: b(s) at s(x) for x in [begin, end].
struct SectorPiece {
  const Arc* arc = nullptr;
  double begin = 0, end = 0;
  // tan(x / 2) = squash tan((s - phase) / 2): of a rim, x is spread more evenly over what is seen than s. 1: s is x.
  double squash = 1, phase = 0;
  double chord = 0;  // from the centre to the farthest b
  std::size_t order = 3;
  bool closed = false;  // a whole turn: equally spaced nodes
};
// Of a contour that has to outlive them.
struct Sectors {
  Vec3d centre;  // unit
  std::vector<SectorPiece> pieces;
};
Sectors sectors_of(const Contour& contour);

// Equally spaced nodes of a whole turn.
constexpr std::size_t turn_nodes(std::size_t order) { return 2 * order + 4; }

struct SectorRow {
  Vec3d b;        // unit, on the outline
  double weight;  // det(c, b, b') ds
};
SectorRow row_at(const Sectors& sectors, const SectorPiece& piece, double x);

}  // namespace etendue::eval
