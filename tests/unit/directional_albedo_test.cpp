// What lobes give back of a white sky: closed forms, other integrals, published estimators, and no light lost once facets pass it on.
#include "etendue/directional_albedo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../sdk/src/eval/quadrature.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using eval::protocol::Random;

Vec3d at(double cosine, double azimuth = 0) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

SpecularLobe lobe_of(Distribution d, double alpha_x, double alpha_y, Masking masking = Masking::correlated) {
  SpecularLobe lobe;
  lobe.distribution = d;
  lobe.alpha_x = alpha_x;
  lobe.alpha_y = alpha_y;
  lobe.masking = masking;
  lobe.f0 = {1, 1, 1};
  return lobe;
}

Estimate under_sky(const Brdf& brdf, const Vec3d& view, double relative = 1e-9) {
  Emitter sky;
  sky.shape = EnvironmentEmitter{};
  sky.radiance = {1, 1, 1};
  return reference(sky, {{}, {0, 0, 1}, {0, 0, 1}, view, brdf, {1, 0, 0}}, {relative, 0});
}

// From above, at alpha 1: with u the squared slope of the half vector, P = 1 / (pi (1 + u)^2), n.l = (1 - u) / (1 + u) and
// G2 = 1 / (1 + Lambda(l)) = 2 n.l / (1 + n.l) = 1 - u: the integral of (1 - u) / (1 + u)^2 from 0 to 1 is 1 - ln 2.
TEST(DirectionalAlbedo, RoughestFromAbove) {
  const AlbedoParts parts = directional_albedo(lobe_of(Distribution::ggx, 1, 1), {0, 0, 1});
  EXPECT_NEAR(parts.sum(), 1 - std::log(2), 1e-14);
  EXPECT_LE(parts.error, 1e-10);
}

// Two ways to the same: half vectors' slopes here, the outline of the sky in reference().
TEST(DirectionalAlbedo, IsTheReferenceUnderASky) {
  Random random(1);
  for (int i = 0; i < 24; ++i) {
    const auto d = static_cast<Distribution>(i % 4);
    const bool round = d == Distribution::blinn_phong || d == Distribution::phong || i % 3 == 0;
    const double alpha = random.log_uniform(d == Distribution::phong ? 0.1 : 1e-3, 1);
    SpecularLobe lobe = lobe_of(d, alpha, round ? alpha : alpha * random.uniform(0.2, 1), static_cast<Masking>(i / 4 % 4));
    lobe.fresnel = i % 2 == 0 ? Fresnel::schlick : Fresnel::schlick_gaussian;
    lobe.f0 = {0.04, 0.5, 1};
    lobe.f90 = 0.9;
    const Vec3d view = at(random.uniform(0.05, 1), random.uniform(0, 6));
    const AlbedoParts parts = directional_albedo(lobe, view);
    const Estimate sky = under_sky(lobe, view, 1e-7), all = reflectance(lobe, view);
    for (int c = 0; c < 3; ++c) {
      const double ours = lobe.f0[c] * parts.f0_part + lobe.f90 * parts.f90_part;
      EXPECT_NEAR(ours, sky.value[c], 3e-8 * ours + sky.error[c]) << static_cast<int>(d) << " alpha " << alpha << " cosine " << view.z;
      EXPECT_NEAR(ours, all.value[c], 1e-8 * ours + all.error[c]);
    }
  }
}

// At grazing views the lobe is a ridge in azimuth as thin as n.v, that runs into the horizon where its outline begins.
TEST(DirectionalAlbedo, ReferenceKeepsRidges) {
  for (const double alpha : {1e-3, 0.1, 1.0}) {
    for (const double cosine : {1e-4, 1e-3, 1e-2}) {
      for (const double azimuth : {0.0, 1e-5, -1e-5, 0.3, pi}) {
        const SpecularLobe lobe = lobe_of(Distribution::ggx, alpha, alpha);
        const Vec3d view = at(cosine, azimuth);
        const Estimate sky = under_sky(lobe, view, 1e-6);
        EXPECT_NEAR(sky.value.x, directional_albedo(lobe, view, 1e-8).sum(), 2e-6) << alpha << ' ' << cosine << ' ' << azimuth;
      }
    }
  }
}

// A mirror: f90's part is Schlick's weight at the view's own angle, f0's the rest, to the order of alpha^2 (log alpha)^2; and all of it is
// finite, positive and in sum at most 1 over the whole domain, for every lobe, where the quadrature keeps its promise.
TEST(DirectionalAlbedo, LimitsAndDomain) {
  for (const double cosine : {0.05, 0.3, 0.7, 1.0}) {
    const AlbedoParts mirror = directional_albedo(lobe_of(Distribution::ggx, 1e-4, 1e-4), at(cosine));
    EXPECT_NEAR(mirror.f90_part, std::pow(1 - cosine, 5), 1e-5);
    EXPECT_NEAR(mirror.sum(), 1, 1e-5);
  }
  for (const Distribution d : {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong}) {
    for (int m = 0; m < 4; ++m) {
      for (const double alpha : {1e-4, 1e-2, 0.3, 1.0}) {
        for (const double cosine : {1e-4, 1e-3, 0.03, 1.0}) {
          const AlbedoParts parts = directional_albedo(lobe_of(d, alpha, alpha, static_cast<Masking>(m)), at(cosine), 1e-8);
          EXPECT_GT(parts.f0_part, 0);
          EXPECT_GE(parts.f90_part, 0);
          EXPECT_LE(parts.sum(), 1 + 1e-8);
          EXPECT_LE(parts.error, 1e-8);
        }
      }
    }
  }
  // Grazing views of rough facets: all is given back (correlated masking leaves of each visible facet (1 + Lv) / (1 + Lv + Ll) -> 1).
  double before = 0;
  for (const double cosine : {1e-2, 1e-3, 1e-4, 1e-6}) {
    const double sum = directional_albedo(lobe_of(Distribution::ggx, 0.5, 0.5), at(cosine)).sum();
    EXPECT_GT(sum, before);
    before = sum;
  }
  EXPECT_GT(before, 0.9999);
  EXPECT_EQ(directional_albedo(lobe_of(Distribution::ggx, 0.5, 0.5), {0, 0, -1}).sum(), 0);
}

// Karis' IntegrateBRDF and Lagarde and de Rousiers' listing 18, as they stand: normals drawn by D n.h on a Hammersley set, G v.h / (n.h
// n.v) weighted by 1 - Fc and Fc. 2^16 points are good to 1e-3.
AlbedoParts by_half_vectors(double alpha, double nv, double (*masking)(double alpha, double nv, double nl)) {
  constexpr unsigned n = 1u << 16;
  const Vec3d v = at(nv);
  AlbedoParts parts;
  for (unsigned i = 0; i < n; ++i) {
    unsigned bits = i;
    double radical = 0;
    for (double half = 0.5; bits != 0; bits >>= 1, half *= 0.5) radical += (bits & 1u) != 0 ? half : 0;
    const double phi = 2 * pi * (i + 0.5) / n, y = radical + 0.5 / n;
    const double cosine = std::sqrt((1 - y) / (1 + (alpha * alpha - 1) * y)), sine = std::sqrt(1 - cosine * cosine);
    const Vec3d h{sine * std::cos(phi), sine * std::sin(phi), cosine}, l = h * (2 * dot(v, h)) - v;
    const double vh = dot(v, h);
    if (!(l.z > 0) || !(vh > 0)) continue;
    const double visible = masking(alpha, nv, l.z) * vh / (cosine * nv), fc = std::pow(1 - vh, 5);
    parts.f0_part += (1 - fc) * visible / n;
    parts.f90_part += fc * visible / n;
  }
  return parts;
}
TEST(DirectionalAlbedo, PublishedEstimators) {
  const auto karis = [](double alpha, double nv, double nl) {
    const double k = alpha / 2;
    return nv / (nv * (1 - k) + k) * nl / (nl * (1 - k) + k);
  };
  const auto frostbite = [](double alpha, double nv, double nl) {
    const auto lambda = [alpha](double x) { return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - x * x) / (x * x)) - 1); };
    return 1 / (1 + lambda(nv) + lambda(nl));
  };
  for (const double alpha : {0.05, 0.3, 1.0}) {
    for (const double nv : {0.1, 0.5, 0.95}) {
      const AlbedoParts one = by_half_vectors(alpha, nv, karis), other = by_half_vectors(alpha, nv, frostbite);
      const AlbedoParts ours = directional_albedo(lobe_of(Distribution::ggx, alpha, alpha, Masking::schlick_image), at(nv));
      const AlbedoParts correlated = directional_albedo(lobe_of(Distribution::ggx, alpha, alpha), at(nv));
      EXPECT_NEAR(ours.f0_part, one.f0_part, 1e-3) << alpha << ' ' << nv;
      EXPECT_NEAR(ours.f90_part, one.f90_part, 1e-3) << alpha << ' ' << nv;
      EXPECT_NEAR(correlated.f0_part, other.f0_part, 1e-3) << alpha << ' ' << nv;
      EXPECT_NEAR(correlated.f90_part, other.f90_part, 1e-3) << alpha << ' ' << nv;
    }
  }
}

TEST(DirectionalAlbedo, DiffuseInClosedForm) {
  for (const double roughness : {0.0, 0.3, 0.7, 1.0}) {
    for (const double cosine : {0.05, 0.2, 0.6, 1.0}) {
      const Estimate disney = under_sky(DisneyDiffuse{{1, 1, 1}, roughness}, at(cosine));
      const Estimate frostbite = under_sky(FrostbiteDiffuse{{1, 1, 1}, roughness}, at(cosine));
      EXPECT_NEAR(disney_albedo(roughness, cosine), disney.value.x, 1e-8);
      EXPECT_NEAR(frostbite_albedo(roughness, cosine), frostbite.value.x, 1e-8);
    }
  }
}

// Frostbite's model is not energy safe: with white base colour diffuse and specular give back 1.063 (f0 .04, roughness .1, n.v .05)
// and 1.13 (f0 .16, roughness 1, n.v .05), diffuse alone up to 1.031, at grazing.
TEST(DirectionalAlbedo, FrostbitesModelGivesBackTooMuch) {
  const auto both = [](double f0, double roughness, double cosine) {
    const AlbedoParts parts = directional_albedo(lobe_of(Distribution::ggx, roughness * roughness, roughness * roughness), at(cosine));
    return frostbite_albedo(roughness, cosine) + f0 * parts.f0_part + parts.f90_part;
  };
  EXPECT_NEAR(both(0.04, 0.1, 0.05), 1.063, 2e-3);
  EXPECT_NEAR(both(0.16, 1, 0.05), 1.13, 5e-3);
  const auto most_from = [](double least_cosine) {
    double most = 0;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 100; ++j) most = std::max(most, frostbite_albedo(i / 100.0, least_cosine + (1 - least_cosine) * j / 100.0));
    return most;
  };
  EXPECT_LT(most_from(0.05), 1);
  EXPECT_NEAR(most_from(1e-4), 1.031, 1e-3);
}

TEST(AlbedoCurve, IsTheAlbedo) {
  Random random(3);
  for (const Distribution d : {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong}) {
    for (const double alpha : {1e-4, 0.03, 1.0}) {
      for (int m = 0; m < 4; ++m) {
        if (d == Distribution::blinn_phong && m % 3 != 0) continue;
        const SpecularLobe lobe = lobe_of(d, alpha, alpha, static_cast<Masking>(m));
        const auto curve = albedo_curve(lobe);
        const double within = d == Distribution::ggx ? 5e-7 : 5e-5;
        for (int i = 0; i < 20; ++i) {
          const Vec3d v = at(i % 2 == 0 ? random.log_uniform(1e-4, 1) : random.uniform(0, 1), 1);
          EXPECT_NEAR(albedo(*curve, v), directional_albedo(lobe, v, 1e-8).sum(), within)
              << static_cast<int>(d) << ' ' << m << ' ' << alpha;
        }
      }
    }
  }
  EXPECT_EQ(albedo_curve(lobe_of(Distribution::phong, 0.3, 0.3)), nullptr);
}
TEST(AlbedoCurve, OfStretchedFacets) {
  Random random(4);
  for (const double alpha : {0.1, 1.0}) {
    const SpecularLobe lobe = lobe_of(Distribution::ggx, 0.3 * alpha, alpha);
    const auto curve = albedo_curve(lobe);
    for (int i = 0; i < 40; ++i) {
      const double cosine = random.log_uniform(1e-4, 1), azimuth = random.uniform(0, 6.3);
      const Vec3d v = at(cosine, azimuth);
      EXPECT_NEAR(albedo(*curve, v), directional_albedo(lobe, v, 1e-8).sum(), 5e-5) << alpha;
    }
  }
}

// Every place between the entries: alphas and cosines all over their decades, and the corners.
TEST(AlbedoTable, KeepsItsBound) {
  Random random(6);
  struct Case {
    SpecularLobe lobe;
    double within;
  };
  for (const Case& c :
       {Case{lobe_of(Distribution::ggx, 1, 1), 5e-4}, Case{lobe_of(Distribution::beckmann, 1, 1, Masking::separable), 1e-3}}) {
    const auto table = albedo_table(c.lobe);
    SpecularLobe lobe = c.lobe;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      double alpha = i % 3 == 0 ? random.uniform(1e-4, 1) : random.log_uniform(1e-4, 1);
      double cosine = i % 2 == 0 ? random.uniform(1e-4, 1) : random.log_uniform(1e-4, 1);
      if (i < 4) alpha = i % 2 == 0 ? 1e-4 : 1, cosine = i < 2 ? 1e-4 : 1;
      lobe.alpha_x = lobe.alpha_y = alpha;
      const AlbedoParts exact = directional_albedo(lobe, at(cosine), 1e-7), fast = albedo_parts(*table, alpha, cosine);
      worst = std::max({worst, std::abs(exact.f0_part - fast.f0_part), std::abs(exact.f90_part - fast.f90_part)});
    }
    EXPECT_LE(worst, c.within);
  }
  EXPECT_EQ(albedo_table(lobe_of(Distribution::phong, 1, 1)), nullptr);
}

// Integral over the hemisphere of what two lobes differ by, smooth but for a layer of alpha above the horizon.
Rgb difference_of(const SpecularLobe& one, const SpecularLobe& other, const Vec3d& view, double alpha) {
  Rgb sum;
  const double end = std::asinh(1 / alpha);
  constexpr int panels = 8, azimuths = 64;
  for (int p = 0; p < panels; ++p) {
    for (const GaussNode& node : gauss24()) {
      const double w = end * (p + 0.5 * (1 + node.x)) / panels, z = std::min(alpha * std::sinh(w), 1.0);
      for (int i = 0; i < azimuths; ++i) {
        const Vec3d l = at(z, 2 * pi * (i + 0.5) / azimuths);
        sum += (brdf_cos(one, view, l) - brdf_cos(other, view, l)) *
               (node.weight * 0.5 * end / panels * alpha * std::cosh(w) * 2 * pi / azimuths);
      }
    }
  }
  return sum;
}

// The white furnace: a lobe that mirrors all and passes on what its facets send each other gives back the whole sky, to what its curve is
// off by; with f0 below 1 less, and with each bounce coloured more.
TEST(Compensation, ClosesTheFurnace) {
  struct Case {
    SpecularLobe lobe;
    double within;
  };
  const std::vector<Case> cases{{lobe_of(Distribution::ggx, 1, 1), 1e-6},
                                {lobe_of(Distribution::ggx, 0.3, 0.3), 1e-6},
                                {lobe_of(Distribution::ggx, 0.05, 0.05, Masking::separable), 1e-6},
                                {lobe_of(Distribution::ggx, 0.4, 0.4, Masking::schlick_direct), 1e-6},
                                {lobe_of(Distribution::ggx, 0.2, 0.2, Masking::schlick_image), 1e-6},
                                {lobe_of(Distribution::beckmann, 0.6, 0.6), 5e-5},
                                {lobe_of(Distribution::blinn_phong, 0.6, 0.6), 5e-5},
                                {lobe_of(Distribution::ggx, 0.15, 0.5), 1e-4}};
  for (const Case& c : cases) {
    SpecularLobe full = c.lobe;
    full.compensation = albedo_curve(full);
    for (const double cosine : {1e-4, 0.02, 0.3, 1.0}) {
      const Vec3d v = at(cosine, 0.6);
      const double once = directional_albedo(c.lobe, v).sum();
      const Rgb more = difference_of(full, c.lobe, v, std::min(c.lobe.alpha_x, c.lobe.alpha_y));
      EXPECT_NEAR(once + more.x, 1, c.within) << c.lobe.alpha_x << ' ' << cosine;
      SpecularLobe gold = full;
      gold.f0 = {1, 0.7, 0.3};
      SpecularLobe bare = gold;
      bare.compensation = nullptr;
      const Rgb coloured = difference_of(gold, bare, v, std::min(c.lobe.alpha_x, c.lobe.alpha_y));
      EXPECT_GT(coloured.x, coloured.y);
      EXPECT_GT(coloured.y / coloured.x, coloured.z / coloured.y * 0.99);  // F^2 / (1 - F (1 - Em)) falls faster than F
      EXPECT_LT(coloured.z, 0.3 * coloured.x);
    }
  }
}

TEST(Compensation, IsReciprocalAndDrawn) {
  SpecularLobe lobe = lobe_of(Distribution::ggx, 0.6, 0.6);
  lobe.f0 = {0.9, 0.6, 0.3};
  lobe.compensation = albedo_curve(lobe);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3d v = at(random.log_uniform(1e-4, 1), random.uniform(0, 6)), l = at(random.log_uniform(1e-4, 1), random.uniform(0, 6));
    const Rgb there = brdf_cos(lobe, v, l) / l.z, back = brdf_cos(lobe, l, v) / v.z;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-11 * there[c]);
    EXPECT_LE(pdf_brdf(lobe, v, l), highest_pdf(lobe, v) * (1 + 1e-12));
  }
  constexpr int n = 40000;
  for (const double cosine : {0.1, 0.8}) {
    const Vec3d v = at(cosine);
    double sum = 0, square = 0;
    for (int i = 0; i < n; ++i) {
      const DirectionSample s = sample_brdf(lobe, v, {(i + 0.5) / n, std::fmod((i + 0.5) * 0.6180339887498949, 1.0)});
      const double x = s.pdf > 0 ? brdf_cos(lobe, v, s.direction).y / s.pdf : 0;
      sum += x;
      square += x * x;
    }
    const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
    EXPECT_NEAR(mean, reflectance(lobe, v, 1e-7).value.y, 4 * error);
  }
}

}  // namespace
