// The BRDFs: against the real Mitsuba's values, reciprocity, sampling, albedo, extremes.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "eval_protocol.h"
#include "source_dir.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using eval::protocol::Random;

std::vector<std::vector<double>> rows_of(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0])) != 0) continue;
    std::stringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

// Values of tests/mitsuba/brdf_values.py: committed ones, or others through the environment (tests/acceptance/brdf_against_mitsuba).
std::vector<std::vector<double>> mitsuba_values(const std::string& model) {
  const char* other = std::getenv("ETENDUE_BRDF_VALUES");
  return rows_of((other != nullptr ? std::string(other) : (source_dir() / "tests/data").string()) + "/" + model + "_eval.csv");
}

// Mitsuba computes in float32. Its rounding is largest where alpha is small: the half vector is exact to 6e-8, the lobe's exponent sees
// it over alpha. 1e-4 is what is asked of a twin.
void compare_with_mitsuba(const std::string& model, std::size_t parameters, Brdf (*brdf_of)(const std::vector<double>&)) {
  const auto rows = mitsuba_values(model);
  ASSERT_GE(rows.size(), 45u);
  double worst = 0;
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), parameters + 9);
    const double* d = row.data() + parameters;
    const Vec3d view = normalised(Vec3d{d[0], d[1], d[2]}), light = normalised(Vec3d{d[3], d[4], d[5]});
    const Rgb ours = brdf_cos(brdf_of(row), view, light);
    for (int c = 0; c < 3; ++c) {
      const double deviation = std::abs(ours[c] - d[6 + c]) / d[6 + c];
      EXPECT_LE(deviation, 1e-4) << model << " line " << &row - rows.data() + 3 << " channel " << c;
      worst = std::max(worst, deviation);
    }
  }
  std::printf("%s: %zu configurations, largest relative deviation %.2e (limit 1e-4)\n", model.c_str(), rows.size(), worst);
}

TEST(Mitsuba, Principled) {
  compare_with_mitsuba("principled", 6, [](const std::vector<double>& r) -> Brdf {
    return Principled{{r[0], r[1], r[2]}, r[3], r[4], r[5]};
  });
}
TEST(Mitsuba, RoughConductor) {
  compare_with_mitsuba("roughconductor", 7, [](const std::vector<double>& r) -> Brdf {
    return Conductor{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, r[6], Masking::separable};
  });
}
// Measured with Mitsuba 3.9.1: no reflection from a metal whose dielectric layer has the index 1.
TEST(Mitsuba, MetalWithoutSpecularIsBlack) {
  const Vec3d v = normalised(Vec3d{0.7, 0, 0.7}), l = normalised(Vec3d{-0.7, 0.1, 0.7});
  EXPECT_EQ(brdf_cos(Principled{{0.8, 0.3, 0.1}, 1, 0.3, 0}, v, l), Rgb{});
  EXPECT_GT(brdf_cos(Principled{{0.8, 0.3, 0.1}, 1, 0.3, 1e-4}, v, l).x, 4);
}

std::vector<Brdf> every_model(double alpha) {
  const double roughness = std::sqrt(alpha);
  return {Lambert{{0.8, 0.5, 0.2}},
          Principled{{0.8, 0.5, 0.2}, 0, roughness, 0.5},
          Principled{{0.8, 0.5, 0.2}, 0.6, roughness, 0.5},
          Standard{{0.8, 0.5, 0.2}, 0.3, roughness, 0.5},
          Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, alpha, Masking::separable},
          Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, alpha, Masking::correlated},
          MetalRough{{0.8, 0.5, 0.2}, 0.4, roughness, 1.5},
          DisneyDiffuse{{0.8, 0.5, 0.2}, roughness},
          FrostbiteDiffuse{{0.8, 0.5, 0.2}, roughness},
          GgxLobe{alpha, {0.04, 0.5, 1}, 1, Masking::correlated},
          TwoColour{{0.5, 0.3, 0.1}, {0.1, 0.3, 0.5}, roughness},
          GltfDiffuse{{0.8, 0.5, 0.2}, 1.5},
          OrenNayar{{0.8, 0.5, 0.2}, oren_nayar_sigma_rad(alpha)},
          GotandaDiffuse{{0.8, 0.5, 0.2}, roughness, 0.04},
          SpecularLobe{Distribution::ggx, alpha, 0.5 * alpha, Masking::correlated, Fresnel::dielectric},
          SpecularLobe{Distribution::beckmann, alpha, alpha, Masking::correlated, Fresnel::schlick_gaussian, {0.04, 0.5, 1}, 0.8},
          SpecularLobe{Distribution::beckmann, 0.7 * alpha, alpha, Masking::separable, Fresnel::conductor},
          SpecularLobe{Distribution::blinn_phong, alpha, alpha, Masking::correlated},
          SpecularLobe{Distribution::blinn_phong, alpha, alpha, Masking::schlick_image},
          SpecularLobe{Distribution::ggx, alpha, alpha, Masking::schlick_direct},
          SpecularLobe{Distribution::phong, alpha, alpha}};
}

// f(v, l) = f(l, v), so BRDF x cosine over the cosine is symmetric: of all models but Gotanda's fit.
TEST(Brdf, IsReciprocal) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    Vec3d v = random.direction(), l = random.direction();
    v.z = std::abs(v.z) + 1e-3;
    l.z = std::abs(l.z) + 1e-3;
    v = normalised(v);
    l = normalised(l);
    for (const Brdf& brdf : every_model(random.log_uniform(0.01, 1))) {
      const Rgb there = brdf_cos(brdf, v, l) / l.z, back = brdf_cos(brdf, l, v) / v.z;
      if (std::holds_alternative<GotandaDiffuse>(brdf)) continue;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-12 * there[c] + 1e-15) << brdf.index();
    }
  }
}

// Mirror directions, normal incidence, grazing, alpha 1e-4 and less: finite, not negative; nothing from below.
TEST(Brdf, StaysFiniteAtTheExtremes) {
  const std::vector<Vec3d> directions{{0, 0, 1},      {1e-4, 0, 1},  {1, 0, 1e-4}, {-1, 0, 1e-4}, {-1, 1e-9, 1e-9},
                                      {1, 0, 1e-300}, {0, 1, 1e-12}, {0, 0, -1},   {1, 0, 0},     {1, 0, -1e-9}};
  for (const double alpha : {0.0, 1e-6, 1e-4, 1e-3, 1.0}) {
    for (const Brdf& brdf : every_model(alpha)) {
      for (const Vec3d& a : directions) {
        for (const Vec3d& b : directions) {
          const Vec3d v = normalised(a), l = normalised(b);
          const Rgb f = brdf_cos(brdf, v, l);
          for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(f[c]) && f[c] >= 0) << brdf.index() << " alpha " << alpha;
          if (v.z <= 0 || l.z <= 0) {
            EXPECT_EQ(f, Rgb{});
          }
          EXPECT_TRUE(std::isfinite(pdf_brdf(brdf, v, l)));
        }
        const DirectionSample s = sample_brdf(brdf, normalised(a), {0.999999, 0.5});
        EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0);
      }
    }
  }
}

// The peak D(0) = 1 / (pi alpha^2) and the fall at theta_h = alpha, D = 1 / (4 pi alpha^2) to first order: digits are kept at alpha 1e-4.
TEST(Brdf, LobeHasItsShapeAtAlpha1e4) {
  const double alpha = 1e-4;
  const GgxLobe lobe{alpha, {1, 1, 1}, 1, Masking::separable};
  const Vec3d n{0, 0, 1};
  EXPECT_NEAR(brdf_cos(lobe, n, n).x * 4 * pi * alpha * alpha, 1, 1e-12);
  const double theta = 2 * std::atan(alpha);  // tan(theta_h) = alpha: D = 1 / (4 pi alpha^2 cos^4)
  const Vec3d l{std::sin(theta), 0, std::cos(theta)};
  EXPECT_NEAR(brdf_cos(lobe, n, l).x * 16 * pi * alpha * alpha, 1, 1e-7);
}

// Lagarde and de Rousiers, listing 1: f90 = .5 r + 2 r (l.h)^2, factor lerp(1, 1 / 1.51, r). At normal incidence both scatter terms are 1.
TEST(Brdf, FrostbiteDiffuseAtNormalIncidence) {
  const Vec3d n{0, 0, 1};
  EXPECT_NEAR(brdf_cos(FrostbiteDiffuse{{1, 1, 1}, 1}, n, n).x, 1 / (1.51 * pi), 1e-15);
  EXPECT_NEAR(brdf_cos(FrostbiteDiffuse{{1, 1, 1}, 0}, n, n).x, 1 / pi, 1e-15);
  EXPECT_NEAR(brdf_cos(DisneyDiffuse{{1, 1, 1}, 0.7}, n, n).x, 1 / pi, 1e-15);
}

// f0 of the models at normal incidence: mirror direction of a lobe with D = 1 / (pi alpha^2), G = 1: f = F / (4 pi alpha^2).
TEST(Brdf, ReflectanceAtNormalIncidence) {
  const Vec3d n{0, 0, 1};
  const double d = 1 / (4 * pi * 0.01 * 0.01), roughness = 0.1;
  EXPECT_NEAR(brdf_cos(Standard{{0, 0, 0}, 0, roughness, 0.5}, n, n).x, 0.04 * d, 1e-9);
  EXPECT_NEAR(brdf_cos(Principled{{0, 0, 0}, 0, roughness, 0.5}, n, n).x, 0.04 * d, 1e-9);
  EXPECT_NEAR(brdf_cos(MetalRough{{0, 0, 0}, 0, roughness, 1.5}, n, n).x, 0.04 * d, 1e-9);
  EXPECT_NEAR(brdf_cos(MetalRough{{0.9, 0.5, 0.1}, 1, roughness, 1.5}, n, n).y, 0.5 * d, 1e-9);
  // ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
  EXPECT_NEAR(brdf_cos(Conductor{{0.2, 1, 1}, {3.9, 0, 0}, 0.01}, n, n).x, (0.64 + 15.21) / (1.44 + 15.21) * d, 1e-9);
  EXPECT_NEAR(brdf_cos(Conductor{{0.2, 1, 1}, {3.9, 0, 0}, 0.01}, n, n).y, 0, 1e-12);
}

// glTF 2.0, B.3.2 and B.3.5, letter by letter: D, "the separable form of the Smith joint masking-shadowing function" G, and
// material = mix(dielectric_brdf, metal_brdf, metallic). Khronos' sample viewer takes the height-correlated form instead, which is brighter
// at grazing angles: by a tenth and more at the directions below, so that the two cannot be mixed up.
TEST(Brdf, MetalRoughIsAppendixB) {
  const Rgb base{0.8, 0.4, 0.2};
  const double metallic = 0.3, roughness = 0.9, alpha = roughness * roughness, a2 = alpha * alpha;
  const Vec3d v = normalised(Vec3d{0.9, 0.1, 0.3}), l = normalised(Vec3d{-0.5, 0.7, 0.25}), h = normalised(v + l);
  const double nl = l.z, nv = v.z, nh = h.z, vh = dot(v, h);
  const double d = a2 / (pi * (nh * nh * (a2 - 1) + 1) * (nh * nh * (a2 - 1) + 1));
  const auto g1 = [a2](double x) { return 2 * x / (x + std::sqrt(a2 + (1 - a2) * x * x)); };
  const double specular = d * g1(nl) * g1(nv) / (4 * nl * nv);
  const double w = std::pow(1 - vh, 5), fresnel = 0.04 + (1 - 0.04) * w;
  const Rgb ours = brdf_cos(MetalRough{base, metallic, roughness, 1.5}, v, l);
  for (int c = 0; c < 3; ++c) {
    const double metal = specular * (base[c] + (1 - base[c]) * w);
    const double dielectric = (1 - fresnel) * base[c] / pi + fresnel * specular;
    EXPECT_NEAR(ours[c], nl * ((1 - metallic) * dielectric + metallic * metal), 1e-12);
  }
  const double lambda_v = 1 / g1(nv) - 1, lambda_l = 1 / g1(nl) - 1;
  EXPECT_GT(1 / (1 + lambda_v + lambda_l), 1.1 * g1(nl) * g1(nv));
}

// The albedo by quadrature in the reference (an environment of luminance 1) and by sampling: 1 / n sum of f cos / pdf. Both see the same
// density only if sample_brdf and pdf_brdf belong together; the mean of 1 over the pdf's support cannot exceed the hemisphere.
TEST(Brdf, SamplingGivesTheAlbedo) {
  Random random(4);
  Emitter sky;
  sky.shape = EnvironmentEmitter{};
  sky.radiance = {1, 1, 1};
  constexpr int n = 20000;
  for (const double alpha : {0.05, 0.3, 1.0}) {
    for (const double nv : {0.15, 0.8}) {
      const Vec3d view{std::sqrt(1 - nv * nv), 0, nv};
      for (const Brdf& brdf : every_model(alpha)) {
        const ShadingPoint point{{}, {0, 0, 1}, {0, 0, 1}, basis_around({0, 0, 1}).tangent * view.x + Vec3d{0, 0, nv}, brdf};
        const Estimate albedo = reference(sky, point, {1e-5, 0});
        double sum = 0, square = 0;
        for (int i = 0; i < n; ++i) {
          // Stratified in both dimensions by the golden-ratio sequence: scatter below that of independent samples.
          const DirectionSample s = sample_brdf(brdf, view, {(i + random.uniform(0, 1)) / n, std::fmod(i * 0.6180339887498949, 1.0)});
          const double x = s.pdf > 0 ? brdf_cos(brdf, view, s.direction).y / s.pdf : 0;
          sum += x;
          square += x * x;
        }
        const double mean = sum / n, error = std::sqrt(std::max(square / n - mean * mean, 0.0) / n);
        EXPECT_NEAR(mean, albedo.value.y, 4 * error + 1e-4 * mean) << brdf.index() << " alpha " << alpha << " nv " << nv;
      }
    }
  }
}

// What is reflected is an affine function of the base colour: pixels with a texture are computed from two colours. (Frostbite's model is
// one but for metals, whose f90 falls where their colour is nearly black: there it stands with metal 0 and .3.)
TEST(Brdf, IsAffineInTheBaseColour) {
  const Vec3d view = normalised(Vec3d{0.6, 0.1, 0.4}), light = normalised(Vec3d{-0.5, 0.3, 0.6});
  for (const double metal : {0.0, 0.3, 1.0}) {
    const std::vector<Brdf (*)(const Rgb&, double)> models{
        [](const Rgb& c, double) -> Brdf { return Lambert{c}; },
        [](const Rgb& c, double m) -> Brdf {
          return Principled{c, m, 0.4, 0.5};
        },
        [](const Rgb& c, double m) -> Brdf {
          return Standard{c, std::min(m, 0.3), 0.4, 0.5};
        },
        [](const Rgb& c, double m) -> Brdf {
          return MetalRough{c, m, 0.4, 1.5};
        },
        [](const Rgb& c, double) -> Brdf {
          return two_colour_of({c, {0.2, 0.1, 0.3}, 0.6});
        },
    };
    for (const auto& model : models) {
      const Rgb black = brdf_cos(model({0, 0, 0}, metal), view, light), white = brdf_cos(model({1, 1, 1}, metal), view, light);
      const Rgb colour{0.7, 0.2, 0.05}, mixed = black + (white - black) * colour, own = brdf_cos(model(colour, metal), view, light);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(own[c], mixed[c], 1e-14 * white[c]) << "metal " << metal << " channel " << c;
    }
  }
}

// highest_pdf is a bound over the hemisphere, and no loose one: GGX has its peak at the mirror direction, the cosine at the normal, and a
// mixture, whose bound is the sum of both, reaches the larger: at least half.
TEST(Brdf, HighestPdfIsABoundThatIsReached) {
  for (const double alpha : {0.02, 0.3, 1.0}) {
    for (const double nv : {0.1, 0.5, 1.0}) {
      const Vec3d view{std::sqrt(1 - nv * nv), 0, nv}, mirror{-view.x, 0, nv};
      for (const Brdf& brdf : every_model(alpha)) {
        const double bound = highest_pdf(brdf, view);
        double most = std::max(pdf_brdf(brdf, view, mirror), pdf_brdf(brdf, view, {0, 0, 1}));
        for (int i = 0; i < 2000; ++i) {
          const double z = (i + 0.5) / 2000, r = std::sqrt(1 - z * z), phi = 2 * pi * std::fmod(i * 0.6180339887498949, 1.0);
          most = std::max(most, pdf_brdf(brdf, view, {r * std::cos(phi), r * std::sin(phi), z}));
        }
        EXPECT_LE(most, bound * (1 + 1e-12)) << brdf.index() << " alpha " << alpha << " nv " << nv;
        EXPECT_GE(most, 0.5 * bound * (1 - 1e-12)) << brdf.index() << " alpha " << alpha << " nv " << nv;
      }
    }
  }
  EXPECT_EQ(highest_pdf(Lambert{}, {0, 0, -1}), 0);
}

// The density integrates to at most 1 (directions that end up below the horizon are lost): midpoint rule over the hemisphere.
TEST(Brdf, PdfIntegratesToAtMostOne) {
  const Vec3d view = normalised(Vec3d{0.6, 0, 0.4});
  for (const Brdf& brdf : every_model(0.3)) {
    double sum = 0;
    constexpr int nz = 400, nphi = 800;
    for (int i = 0; i < nz; ++i) {
      const double z = (i + 0.5) / nz, r = std::sqrt(1 - z * z);
      for (int j = 0; j < nphi; ++j) {
        const double phi = 2 * pi * (j + 0.5) / nphi;
        sum += pdf_brdf(brdf, view, {r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    sum *= 2 * pi / (nz * nphi);
    EXPECT_LE(sum, 1 + 1e-3) << brdf.index();
    EXPECT_GE(sum, 0.85) << brdf.index();
  }
}

}  // namespace
