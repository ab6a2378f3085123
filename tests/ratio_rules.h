// Diffuse models under extended lights: what a rule is off by, as an aggregate over random lights and views.
#pragma once

#include "etendue/diffuse_light.h"

#include <array>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "eval_protocol.h"

namespace etendue::eval::protocol {

struct DiffuseModel {
  std::string_view name;
  Brdf (*of)(double roughness);
};
inline constexpr DiffuseModel diffuse_models[] = {
    {"disney",
     [](double r) -> Brdf {
       return DisneyDiffuse{{1, 1, 1}, r};
     }},
    {"frostbite",
     [](double r) -> Brdf {
       return FrostbiteDiffuse{{1, 1, 1}, r};
     }},
    {"gltf", [](double) -> Brdf { return GltfDiffuse{}; }},
    {"oren-nayar",
     [](double r) -> Brdf {
       return OrenNayar{{1, 1, 1}, oren_nayar_sigma_rad(r * r)};
     }},
    {"gotanda",
     [](double r) -> Brdf {
       return GotandaDiffuse{{1, 1, 1}, r, 0.04};
     }},
};
inline constexpr double roughnesses[] = {0.1, 0.3, 0.5, 0.8, 1.0};

// Views at a cosine of .05 to 1, or grazing ones at .05 to .2.
struct DiffuseCase {
  Placement placement;
  ShadingPoint point;
  bool grazing;
};
inline std::vector<DiffuseCase> diffuse_cases(Kind kind, bool above, int lights, std::uint64_t seed) {
  Random random(seed + 10 * static_cast<std::uint64_t>(kind) + (above ? 0 : 1));
  std::vector<DiffuseCase> cases;
  for (int i = 0; i < lights; ++i) {
    const Placement p = place(kind, random, above);
    const Basis b = basis_around(p.normal);
    for (const bool grazing : {false, true}) {
      const double nv = grazing ? random.uniform(0.05, 0.2) : random.uniform(0.05, 1), phi = random.uniform(0, 2 * pi);
      const Vec3d view = p.normal * nv + (b.tangent * std::cos(phi) + b.bitangent * std::sin(phi)) * std::sqrt(1 - nv * nv);
      cases.push_back({p, {p.position, p.normal, p.normal, view, Lambert{}}, grazing});
    }
  }
  return cases;
}

// sum |x - reference| / sum reference.
struct Aggregate {
  double off = 0, all = 0;
  void add(double value, double reference) {
    off += std::abs(value - reference);
    all += reference;
  }
  double share() const { return off / all; }
};

// Limits on the aggregate of each model, shape, roughness and kind of view.
inline constexpr double limit_above = 0.0015, limit_across = 0.015;

}  // namespace etendue::eval::protocol
