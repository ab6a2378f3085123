// Every BRDF prepared for one view direction: what depends on the view is computed once, what depends on the light many times.
// A kernel gives BRDF times cosine for a unit direction above the horizon (l.z > 0), with the view above the horizon too.
#pragma once

#include "etendue/directional_albedo.h"
#include "etendue/eval.h"
#include "facets.h"
#include "fresnel.h"
#include "microfacet.h"

#include <utility>

namespace etendue::eval {

// Facts that integration and sampling want to know of a kernel.
struct LobeFacts {
  double alpha = 0;           // of the specular lobe; 0: there is none
  double specular_share = 0;  // probability with which sampling takes the specular lobe
  bool folded = false;        // bends where the light crosses the plane of the normal across the view
  bool round_ggx = true;      // the lobe, if there is one: its poles are known
};

struct LambertKernel {
  LambertKernel(const Lambert& m, const Vec3d&) : scale(m.base_colour / pi) {}
  Rgb operator()(const Vec3d& l) const { return scale * l.z; }
  LobeFacts facts() const { return {}; }
  Rgb scale;
};

// Disney 2012: base / pi (1 + (F90 - 1) w(n.v)) (1 + (F90 - 1) w(n.l)) with Schlick's weights and F90 = .5 + 2 roughness (v.h)^2.
// Frostbite (Lagarde and de Rousiers, listing 1) takes F90 = .5 roughness + 2 roughness (v.h)^2 and multiplies by
// lerp(1, 1 / 1.51, roughness).
struct DisneyDiffuseKernel {
  DisneyDiffuseKernel(const Rgb& base, double roughness_, double bias_, double factor, const Vec3d& view)
      : v(view), scale(base * (factor / pi)), roughness(roughness_), bias(bias_), view_weight(schlick_weight(view.z)) {}
  DisneyDiffuseKernel(const DisneyDiffuse& m, const Vec3d& view) : DisneyDiffuseKernel(m.base_colour, m.roughness, 0.5, 1, view) {}
  DisneyDiffuseKernel(const FrostbiteDiffuse& m, const Vec3d& view)
      : DisneyDiffuseKernel(m.base_colour, m.roughness, 0.5 * m.roughness, 1 + m.roughness * (1 / 1.51 - 1), view) {}
  // Without the base colour and pi.
  double shape(double nl, double v_dot_h) const {
    const double f90 = bias + 2 * roughness * v_dot_h * v_dot_h - 1;
    return (1 + f90 * schlick_weight(nl)) * (1 + f90 * view_weight);
  }
  Rgb operator()(const Vec3d& l) const { return scale * (l.z * shape(l.z, half_angle(v, l).v_dot_h)); }
  LobeFacts facts() const { return {}; }
  Vec3d v;
  Rgb scale;
  double roughness, bias, view_weight;
};

// glTF 2.0 appendix B without its specular part: base / pi (1 - F), F Schlick's from ((ior - 1) / (ior + 1))^2 at v.h.
struct GltfDiffuseKernel {
  GltfDiffuseKernel(const GltfDiffuse& m, const Vec3d& view)
      : v(view), scale(m.base_colour * ((1 - ((m.ior - 1) / (m.ior + 1)) * ((m.ior - 1) / (m.ior + 1))) / pi)) {}
  Rgb operator()(const Vec3d& l) const { return scale * (l.z * (1 - schlick_weight(half_angle(v, l).v_dot_h))); }
  LobeFacts facts() const { return {}; }
  Vec3d v;
  Rgb scale;
};

// Oren and Nayar 1994, qualitative model: base / pi (A + B max(0, cos phi) sin(a) tan(b)), a the larger and b the smaller of both angles
// to the normal, phi between their azimuths; A = 1 - .5 s^2 / (s^2 + .33), B = .45 s^2 / (s^2 + .09). The product of the three is
// (v.l - n.v n.l) / max(n.v, n.l).
struct OrenNayarKernel {
  OrenNayarKernel(const OrenNayar& m, const Vec3d& view) : v(view), scale(m.base_colour / pi) {
    const double s2 = m.sigma_rad * m.sigma_rad;
    a = 1 - 0.5 * s2 / (s2 + 0.33);
    b = 0.45 * s2 / (s2 + 0.09);
  }
  Rgb operator()(const Vec3d& l) const {
    const double along = std::max(v.x * l.x + v.y * l.y, 0.0);
    return scale * (l.z * (a + b * along / std::max(v.z, l.z)));
  }
  LobeFacts facts() const { return {.folded = true}; }
  Vec3d v;
  Rgb scale;
  double a, b;
};

// Gotanda 2014: base / pi 21 / 20 (1 - f0) (Fr Lm + Vd Bp), cosine included. Fr and Vd's factor hang on the view alone; Lm is what the
// facets reflect of the light, Vd Bp their retroreflection. Public transcriptions of the course's slides differ in whether Vd Bp is a
// product and whether Fr's second factor divides by alpha^2 + 1.36053: the product and the division are what comes near to the facets
// that the model was fitted to (diffuse_models_test holds it to that). Where the fit falls below 0 there is no light.
struct GotandaKernel {
  GotandaKernel(const GotandaDiffuse& m, const Vec3d& view)
      : v(view), scale(m.base_colour * (21 / 20.0 * (1 - m.f0) / pi)), alpha(m.roughness * m.roughness) {
    const double a = alpha, a2 = a * a, nv = std::min(view.z, 1.0), divisor = a2 + 1.36053;
    fresnel = (1 - (0.542026 * a2 + 0.303573 * a) / divisor) * (1 - std::pow(1 - nv, 5 - 4 * a2) / divisor) *
              (1 + a * (-0.733996 * a2 + 1.50912 * a - 1.16402) * std::pow(1 - nv, 1 + 1 / (39 * a2 * a2 + 1)));
    retro = a2 / ((a2 + 0.09) * (1.31072 + 0.995584 * nv));
    power = (1 - 0.3726732 * nv * nv) / (0.188566 + 0.38841 * nv);
  }
  Rgb operator()(const Vec3d& l) const {
    const double nl = l.z, away = std::clamp(1 - nl, 0.0, 1.0), along = v.x * l.x + v.y * l.y;
    const double lm = (std::max(1 - 2 * alpha, 0.0) * (1 - pow5(away)) + std::min(2 * alpha, 1.0)) * nl * (1 - 0.5 * alpha * away);
    const double vd = retro * (1 - std::pow(away, power)), bp = along < 0 ? 1.4 * v.z * nl * along : along;
    return scale * std::max(fresnel * lm + vd * bp, 0.0);
  }
  LobeFacts facts() const { return {.folded = true}; }
  Vec3d v;
  Rgb scale;
  double alpha, fresnel, retro, power;
};

struct GgxKernel {
  GgxKernel(const GgxLobe& m, const Vec3d& view) : v(view), lobe(m.alpha, m.masking, view), f0(m.f0), f90(m.f90), alpha(m.alpha) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    return schlick(f0, f90, schlick_weight(h.v_dot_h)) * lobe(h, l.z);
  }
  LobeFacts facts() const { return {std::max(alpha, min_alpha), 1}; }
  Vec3d v;
  GgxView lobe;
  Rgb f0;
  double f90, alpha;
};

// D G F / (4 n.v n.l) n.l of the facets of facets.h, masked by what the view and the light see of them, or Phong's lobe; and with a curve E
// of its albedo the light that facets pass on to each other (Kulla and Conty 2017):
//   (1 - E(v)) (1 - E(l)) / (pi (1 - Em)) F_m,   Em the mean of E over the hemisphere (albedo_curve.cpp).
// Reciprocal; with F_m = 1 its integral over l is 1 - E(v): what the lobe lacks of 1. Light that meets facets k times more is left with the
// mean reflectance F^k and (1 - Em)^(k - 1) Em of it leaves then: of the series from the second reflection on, as a part of what it is
// without loss, F_m = F sum of F^k (1 - Em)^(k - 1) Em = F^2 Em / (1 - F (1 - Em)).
struct SpecularKernel {
  SpecularKernel(const SpecularLobe& m, const Vec3d& view)
      : v(view),
        lobe(m),
        facets(m.distribution, m.alpha_x, m.alpha_y),
        phong(phong_exponent(std::sqrt(std::max(m.alpha_x, min_alpha) * std::max(m.alpha_y, min_alpha)))),
        seen(facets.seen_area(view)) {
    if (m.compensation == nullptr) return;
    const double mean = mean_albedo(*m.compensation), lost = 1 - mean;
    if (!(lost > least_lost)) return;
    missing = 1 - albedo(*m.compensation, view);
    const Rgb f = mean_fresnel(m);
    for (int c = 0; c < 3; ++c) passed_on[c] = missing / (pi * lost) * f[c] * f[c] * mean / (1 - f[c] * lost);
  }
  Rgb operator()(const Vec3d& l) const {
    const Rgb once = fresnel_reflectance(lobe, 0.5 * length(v + l)) * shape(l);
    return missing > 0 ? once + passed_on * ((1 - albedo(*lobe.compensation, l)) * l.z) : once;
  }
  // Without Fresnel and what is passed on.
  double shape(const Vec3d& l) const {
    if (lobe.distribution == Distribution::phong) return (phong + 2) / (2 * pi) * mirror_power(l) * l.z;
    return facets.density(v + l) * l.z * masked(l);
  }
  // G / (4 n.v n.l). With U = n.x / G1(x), G2 = 1 / (1 + Lambda(v) + Lambda(l)) is n.v n.l / (n.l U(v) + n.v U(l) - n.v n.l).
  double masked(const Vec3d& l) const {
    switch (lobe.masking) {
      case Masking::correlated:
        return 0.25 / (l.z * seen + v.z * facets.seen_area(l) - v.z * l.z);
      case Masking::separable:
        return 0.25 / (seen * facets.seen_area(l));
      default:
        return 0.25 / (schlick_area(v) * schlick_area(l));
    }
  }
  double schlick_area(const Vec3d& d) const {
    return schlick_seen_area(d.z, schlick_masking_k(lobe.masking, std::min(facets.alpha_towards(d), 1.0)));
  }
  // cos(delta)^n of the angle between the light and the mirror direction: sin(delta / 2) is half their distance.
  double mirror_power(const Vec3d& l) const {
    const Vec3d apart = l - Vec3d{-v.x, -v.y, v.z};
    const double sine2 = 0.25 * dot(apart, apart);
    return sine2 < 0.5 ? std::exp(phong * std::log1p(-2 * sine2)) : 0;
  }

  // What is missing is drawn by the cosine.
  double pdf(const Vec3d& l) const { return (1 - missing) * lobe_pdf(l) + missing * l.z / pi; }
  double lobe_pdf(const Vec3d& l) const {
    if (lobe.distribution == Distribution::phong) return (phong + 1) / (2 * pi) * mirror_power(l);
    return facets.density(v + l) / (4 * seen);
  }
  double highest_pdf() const {
    const double peak = lobe.distribution == Distribution::phong ? (phong + 1) / (2 * pi) : facets.highest_density() / (4 * seen);
    return (1 - missing) * peak + missing / pi;
  }
  // May lie below the horizon.
  Vec3d sample(const Vec2d& u) const {
    if (u.x < missing) return cosine_direction({u.x / missing, u.y});
    const Vec2d left{(u.x - missing) / (1 - missing), u.y};
    if (lobe.distribution != Distribution::phong) {
      const Vec3d h = facets.seen_normal(v, left);
      return h * (2 * dot(v, h)) - v;
    }
    // cos^(n + 1) is uniform.
    const double cosine = std::pow(1 - left.x, 1 / (phong + 1)), sine = std::sqrt(std::max(-std::expm1(2 * std::log(cosine)), 0.0));
    const Basis about = basis_around({-v.x, -v.y, v.z});
    const Vec3d across = about.tangent * std::cos(2 * pi * left.y) + about.bitangent * std::sin(2 * pi * left.y);
    return across * sine + about.normal * cosine;
  }
  LobeFacts facts() const {
    return {.alpha = std::max(std::min(lobe.alpha_x, lobe.alpha_y), min_alpha),
            .specular_share = 1,
            .round_ggx = lobe.distribution == Distribution::ggx && lobe.alpha_x == lobe.alpha_y};
  }
  static constexpr double least_lost = 1e-9;  // of all light: below it nothing is passed on
  Vec3d v;
  SpecularLobe lobe;
  Facets facets;
  double phong, seen;
  double missing = 0;  // 1 - E(v)
  Rgb passed_on;
};

struct ConductorKernel {
  ConductorKernel(const Conductor& m, const Vec3d& view)
      : v(view),
        lobe(m.alpha, m.masking, view),
        eta(m.eta),
        k(m.k),
        alpha(m.alpha),
        grey(eta.x == eta.y && eta.y == eta.z && k.x == k.y && k.y == k.z) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    const double c = h.v_dot_h;
    const double red = conductor_reflectance(c, eta.x, k.x);
    const Rgb f = grey ? Rgb{red, red, red} : Rgb{red, conductor_reflectance(c, eta.y, k.y), conductor_reflectance(c, eta.z, k.z)};
    return f * lobe(h, l.z);
  }
  LobeFacts facts() const { return {std::max(alpha, min_alpha), 1}; }
  Vec3d v;
  GgxView lobe;
  Rgb eta, k;
  double alpha;
  bool grey;
};

// Share of the specular lobe in a mixture, from reflectances at the view direction; each lobe that is there keeps a tenth.
inline double share_of(double specular, double diffuse) {
  if (!(diffuse > 0)) return 1;
  if (!(specular > 0)) return 0;
  return std::clamp(specular / (specular + diffuse), 0.1, 0.9);
}
inline double mean_of(const Rgb& c) { return (c.x + c.y + c.z) / 3; }

// Mitsuba 3's `principled` (src/bsdfs/principled.cpp) with base colour, metallic, roughness and specular, front side:
//   specular: D G1 G1 / (4 n.v) ((1 - m) F_dielectric(v.h, eta) + m Schlick(base, v.h)), only where F_dielectric > 0,
//   diffuse:  (1 - m) base / pi n.l times Disney's 2012 diffuse,
//   eta = 2 / (1 - sqrt(.08 specular)) - 1, alpha = max(.001, roughness^2).
// With specular 0, eta is 1, F_dielectric is 0 and the metal is black as well (Mitsuba issue 443): kept, because this is its twin.
struct PrincipledKernel {
  PrincipledKernel(const Principled& m, const Vec3d& view)
      : v(view),
        alpha(std::max(0.001, m.roughness * m.roughness)),
        lobe(alpha, Masking::separable, view),
        diffuse(m.base_colour * (1 - m.metallic), m.roughness, 0.5, 1, view),
        base(m.base_colour),
        metallic(m.metallic),
        eta(2 / (1 - std::sqrt(std::clamp(0.08 * m.specular, 0.0, 0.999))) - 1),
        has_specular(m.specular > 0) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    Rgb value = metallic < 1 ? diffuse.scale * (l.z * diffuse.shape(l.z, h.v_dot_h)) : Rgb{};
    if (has_specular) {
      const double s = lobe(h, l.z);
      if (metallic < 1) {
        const double f = (1 - metallic) * dielectric_reflectance(h.v_dot_h, eta) * s;
        value += Rgb{f, f, f};
      }
      if (metallic > 0) value += schlick(base, 1, schlick_weight(h.v_dot_h)) * (metallic * s);
    }
    return value;
  }
  LobeFacts facts() const {
    if (!has_specular) return {};
    const double f = (1 - metallic) * dielectric_reflectance(v.z, eta) + metallic * mean_of(base);
    return {alpha, share_of(f, (1 - metallic) * mean_of(base))};
  }
  Vec3d v;
  double alpha;
  GgxView lobe;
  DisneyDiffuseKernel diffuse;
  Rgb base;
  double metallic, eta;
  bool has_specular;
};

// Frostbite's standard model (Lagarde and de Rousiers 2014, 3.1, 3.2): f0 = .16 reflectance^2 (1 - m) + base m,
// f90 = saturate(50 dot(f0, .33)), diffuse colour base (1 - m), height-correlated masking, alpha = roughness^2.
struct StandardLobes {
  FrostbiteDiffuse diffuse;
  GgxLobe specular;
};
inline StandardLobes lobes_of(const Standard& m) {
  const Rgb f0 = Rgb{1, 1, 1} * (0.16 * m.reflectance * m.reflectance * (1 - m.metal)) + m.base_colour * m.metal;
  return {{m.base_colour * (1 - m.metal), m.roughness},
          {std::max(m.roughness * m.roughness, min_alpha), f0, occluded_f90(f0), Masking::correlated}};
}

struct StandardKernel {
  StandardKernel(const Standard& m, const Vec3d& view) : StandardKernel(lobes_of(m), view) {}
  StandardKernel(const StandardLobes& lobes, const Vec3d& view)
      : v(view),
        alpha(lobes.specular.alpha),
        lobe(alpha, Masking::correlated, view),
        diffuse(lobes.diffuse, view),
        f0(lobes.specular.f0),
        f90(lobes.specular.f90) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    return diffuse.scale * (l.z * diffuse.shape(l.z, h.v_dot_h)) + schlick(f0, f90, schlick_weight(h.v_dot_h)) * lobe(h, l.z);
  }
  LobeFacts facts() const { return {alpha, share_of(mean_of(schlick(f0, f90, schlick_weight(v.z))), pi * mean_of(diffuse.scale))}; }
  Vec3d v;
  double alpha;
  GgxView lobe;
  DisneyDiffuseKernel diffuse;
  Rgb f0;
  double f90;
};

// glTF 2.0 appendix B: mix(dielectric, metal, metallic), metal = Schlick(base) specular, dielectric = mix(base / pi, specular,
// Schlick(f0)), with "the separable form of the Smith joint masking-shadowing function" (B.3.2; Khronos' sample viewer takes the
// height-correlated one), alpha = roughness^2.
struct MetalRoughKernel {
  MetalRoughKernel(const MetalRough& m, const Vec3d& view)
      : v(view),
        alpha(std::max(m.roughness * m.roughness, min_alpha)),
        lobe(alpha, Masking::separable, view),
        base(m.base_colour),
        metallic(m.metallic),
        f0(((m.ior - 1) / (m.ior + 1)) * ((m.ior - 1) / (m.ior + 1))) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    const double w = schlick_weight(h.v_dot_h), fresnel = f0 + (1 - f0) * w, s = lobe(h, l.z);
    const double d = (1 - metallic) * fresnel * s;
    return base * ((1 - metallic) * (1 - fresnel) * l.z / pi) + Rgb{d, d, d} + schlick(base, 1, w) * (metallic * s);
  }
  LobeFacts facts() const {
    return {alpha,
            share_of((1 - metallic) * (f0 + (1 - f0) * schlick_weight(v.z)) + metallic * mean_of(base), (1 - metallic) * mean_of(base))};
  }
  Vec3d v;
  double alpha;
  GgxView lobe;
  Rgb base;
  double metallic, f0;
};

// Diffuse albedo and f0 apart (material.h): the dielectric of glTF's appendix B with both colours free.
struct TwoColourKernel {
  TwoColourKernel(const TwoColour& m, const Vec3d& view)
      : v(view),
        alpha(std::max(m.roughness * m.roughness, min_alpha)),
        lobe(alpha, Masking::separable, view),
        diffuse(m.diffuse),
        f0(m.f0) {}
  Rgb operator()(const Vec3d& l) const {
    const HalfAngle h = half_angle(v, l);
    const Rgb fresnel = schlick(f0, 1, schlick_weight(h.v_dot_h));
    return diffuse * (Rgb{1, 1, 1} - fresnel) * (l.z / pi) + fresnel * lobe(h, l.z);
  }
  LobeFacts facts() const { return {alpha, share_of(mean_of(schlick(f0, 1, schlick_weight(v.z))), mean_of(diffuse))}; }
  Vec3d v;
  double alpha;
  GgxView lobe;
  Rgb diffuse, f0;
};

inline LambertKernel kernel_of(const Lambert& m, const Vec3d& v) { return {m, v}; }
inline PrincipledKernel kernel_of(const Principled& m, const Vec3d& v) { return {m, v}; }
inline StandardKernel kernel_of(const Standard& m, const Vec3d& v) { return {m, v}; }
inline ConductorKernel kernel_of(const Conductor& m, const Vec3d& v) { return {m, v}; }
inline MetalRoughKernel kernel_of(const MetalRough& m, const Vec3d& v) { return {m, v}; }
inline DisneyDiffuseKernel kernel_of(const DisneyDiffuse& m, const Vec3d& v) { return {m, v}; }
inline DisneyDiffuseKernel kernel_of(const FrostbiteDiffuse& m, const Vec3d& v) { return {m, v}; }
inline GltfDiffuseKernel kernel_of(const GltfDiffuse& m, const Vec3d& v) { return {m, v}; }
inline OrenNayarKernel kernel_of(const OrenNayar& m, const Vec3d& v) { return {m, v}; }
inline GotandaKernel kernel_of(const GotandaDiffuse& m, const Vec3d& v) { return {m, v}; }
inline GgxKernel kernel_of(const GgxLobe& m, const Vec3d& v) { return {m, v}; }
inline TwoColourKernel kernel_of(const TwoColour& m, const Vec3d& v) { return {m, v}; }
inline SpecularKernel kernel_of(const SpecularLobe& m, const Vec3d& v) { return {m, v}; }

// Calls `use` with the kernel of whatever the BRDF holds: the choice is made once, not for every direction.
template <class Use>
auto with_kernel(const Brdf& brdf, const Vec3d& view, Use&& use) {
  return std::visit([&](const auto& model) { return use(kernel_of(model, view)); }, brdf);
}

}  // namespace etendue::eval
