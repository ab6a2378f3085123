// Nodes and weights on [-1, 1]: Gauss-Legendre, and Kronrod's extensions with the Gauss rule inside.
#pragma once

#include <array>

namespace etendue::eval {

struct GaussNode {
  double x, weight;
};
const std::array<GaussNode, 24>& gauss24();

// `gauss` is the weight in the embedded Gauss rule of n nodes, 0 for the nodes that Kronrod added (Kronrod 1965). `odd` is `weight` times
// the Legendre polynomial of degree 2 n - 1: sums with it are 0 for all lower degrees (to
// 1e-5 in the rule of 15) and tell how much of that degree there is.
struct KronrodNode {
  double x, weight, gauss, odd;
};
struct KronrodRule {
  int count;
  std::array<KronrodNode, 15> nodes;  // the first `count` of them
};
const KronrodRule& kronrod5();   // Gauss 2 inside
const KronrodRule& kronrod7();   // Gauss 3 inside
const KronrodRule& kronrod15();  // Gauss 7 inside

}  // namespace etendue::eval
