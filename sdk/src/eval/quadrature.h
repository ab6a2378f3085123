// Nodes and weights on [-1, 1]: Gauss-Legendre, and Kronrod's extensions with the Gauss rule inside.
#pragma once

#include <array>

namespace etendue::eval {

struct GaussNode {
  double x, weight;
};
inline constexpr std::array<GaussNode, 1> gauss1{{{0, 2}}};
inline constexpr std::array<GaussNode, 2> gauss2{{{-0.57735026918962576, 1}, {0.57735026918962576, 1}}};
inline constexpr std::array<GaussNode, 3> gauss3{{{-0.77459666924148338, 5.0 / 9}, {0, 8.0 / 9}, {0.77459666924148338, 5.0 / 9}}};
inline constexpr std::array<GaussNode, 4> gauss4{{{-0.86113631159405258, 0.34785484513745386},
                                                  {-0.33998104358485626, 0.65214515486254614},
                                                  {0.33998104358485626, 0.65214515486254614},
                                                  {0.86113631159405258, 0.34785484513745386}}};
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
