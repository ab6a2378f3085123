// Nodes and weights on [-1, 1]: Gauss-Legendre, and Kronrod's extensions with the Gauss rule inside.
#pragma once

#include <array>

namespace etendue::eval {

struct GaussNode {
  double x, weight;
};
const std::array<GaussNode, 24>& gauss24();

// `gauss` is the weight in the embedded Gauss rule, 0 for the nodes that Kronrod added (Kronrod 1965).
struct KronrodNode {
  double x, weight, gauss;
};
struct KronrodRule {
  int count;
  std::array<KronrodNode, 15> nodes;  // the first `count` of them
};
const KronrodRule& kronrod5();   // Gauss 2 inside
const KronrodRule& kronrod7();   // Gauss 3 inside
const KronrodRule& kronrod15();  // Gauss 7 inside

}  // namespace etendue::eval
