// Cells of the unit disk in which GGX is uniform, between an outline and its middle, and what a product rule says of each.
// Derivations: sdk/docs/specular.md, "To a tolerance".
//
// The slopes of h' = (h.x / alpha, h.y / alpha, h.z) are q = (h'.x, h'.y) / h'.z; p = q / (1 + sqrt(1 + q^2)) is h' seen stereographically.
// At the radius r of the disk r = 2 p / (1 + p^2) and r dr = 4 p (1 - p^2) / (1 + p^2)^3 dp. For the outline q(tau) and any single base
//     luminance = 1 / pi  closed integral of (q x q') / q^2 d tau  integral from base to p(tau) of W 4 p (1 - p^2) / (1 + p^2)^3 dp,
// all rational but for roots.
#pragma once

#include "contour.h"
#include "etendue/eval.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue::eval {

// The lobe seen from one view: W = 4 n.l (G / (4 n.v n.l)) (v.h / n.h) F.
struct DiskLobe {
  DiskLobe(const GgxLobe& lobe, const Vec3d& view);

  double alpha;
  Masking masking;
  Vec3d view;
  double view_root;  // S(n.v)
  double k;          // of Schlick's masking
};

// A part of an arc about the place s_0 where it is nearest to the middle of the lobe: tau = tan((s - s_0) / 2), tau = kappa x / (1 - x^2).
// For a great circle of h' with kappa / 2 the tau over which q grows by sqrt(1 + q_0^2), x is the tangent of half the azimuth from there.
struct LobeArc {
  Vec3d centre, u, v;  // Arc, turned to s_0
  bool unit = true;
  double kappa = 1;
  double x0 = 0, x1 = 0;
  bool horizon = false;  // n.l = 0 all along

  double tau_of(double x) const { return kappa * x / ((1 - x) * (1 + x)); }
  double x_of(double tau) const { return 2 * tau / (kappa + std::sqrt(kappa * kappa + 4 * tau * tau)); }
  struct Place {
    Vec2d q;
    double turn;  // q x dq/dtau
  };
  Place at(const DiskLobe& lobe, double tau) const;
  double height(double tau) const;  // n.l
};

// Of each the part without Schlick's weight w, and with it: luminance = f0 (shape - risen) + f90 risen for shape = integral of W / F.
struct Risen {
  double plain = 0, risen = 0;  // integrals of (1 - w) W / F and w W / F
};
struct LobeCell {
  std::uint32_t arc = 0;
  double x0 = 0, x1 = 0, t0 = 0, t1 = 1;  // t: between the base and the outline
  Risen value, error;
  double rim = 2;     // the t at which p would be 1
  double turned = 0;  // of the azimuth, radians
  bool split_x = false;
};

// Gauss and Legendre's product rules, by their nodes along the outline and along a ray: the one with the fewest nodes in all.
enum class LobeRule { gauss6x4, gauss6x6, gauss8x6, gauss10x8 };
constexpr LobeRule lobe_rule_for(double tolerance) {
  return tolerance >= 5e-3   ? LobeRule::gauss6x4
         : tolerance >= 5e-4 ? LobeRule::gauss6x6
         : tolerance >= 2e-5 ? LobeRule::gauss8x6
                             : LobeRule::gauss10x8;
}
constexpr std::size_t nodes_of(LobeRule rule) {
  constexpr std::size_t nodes[] = {24, 36, 48, 80};
  return nodes[static_cast<std::size_t>(rule)];
}

// W / F at the slopes m, and Schlick's weight there.
struct LobeWeight {
  double shape, w;
};
LobeWeight weight_at(const DiskLobe& lobe, const Vec2d& m);

// Where the fans of an outline begin, and the W that is taken out: of it only the area is integrated.
struct LobeFan {
  double base = 0;
  Risen level;
};
void evaluate(const DiskLobe& lobe, const LobeArc& arc, const LobeFan& fan, LobeRule rule, LobeCell& cell);

}  // namespace etendue::eval
