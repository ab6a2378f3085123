// Specular lobes of every distribution, masking and Fresnel term: each held to an integral or to a known value.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "../sdk/src/eval/facets.h"
#include "../sdk/src/eval/fresnel.h"
#include "../sdk/src/eval/microfacet.h"
#include "../sdk/src/eval/quadrature.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using eval::protocol::Random;

constexpr Distribution of_facets[] = {Distribution::ggx, Distribution::beckmann, Distribution::blinn_phong};
constexpr Masking every_masking[] = {Masking::correlated, Masking::separable, Masking::schlick_direct, Masking::schlick_image};

Vec3d at(double cosine, double azimuth = 0) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// Integral of f over the unit facet normals above the plane, in slopes p = r (cos, sin): dm = r / (1 + r^2)^(3/2) dr dphi, r = width
// sinh(w), in panels of 24 nodes until cos(theta) is 1e-12; azimuths by the trapezoidal rule, which is exact for what is smooth and
// periodic. Where f bends, f itself says so by its own error.
template <class Function>
double over_normals(double width, int azimuths, const Function& f) {
  const double last = std::asinh(1e12 / width), panel = 0.75;
  const int panels = static_cast<int>(std::ceil(last / panel));
  double sum = 0;
  for (int p = 0; p < panels; ++p) {
    for (const GaussNode& node : gauss24()) {
      const double w = panel * (p + 0.5 * (1 + node.x)), r = width * std::sinh(w), cosine = 1 / std::sqrt(1 + r * r);
      double ring = 0;
      for (int i = 0; i < azimuths; ++i) {
        const double phi = 2 * pi * (i + 0.5) / azimuths;
        ring += f(Vec3d{r * cosine * std::cos(phi), r * cosine * std::sin(phi), cosine});
      }
      sum += 0.5 * panel * node.weight * width * std::cosh(w) * r * cosine * cosine * cosine * ring * 2 * pi / azimuths;
    }
  }
  return sum;
}

// The integral of D(m) n.m over the hemisphere is 1: facets cover the plane.
TEST(Facets, CoverThePlane) {
  for (const Distribution d : of_facets) {
    for (const double alpha : {1e-4, 1e-3, 0.03, 0.4, 1.0}) {
      for (const double aspect : {1.0, 0.5}) {
        const Facets facets(d, alpha, alpha * aspect);
        const double sum = over_normals(alpha, 256, [&](const Vec3d& m) { return facets.density(m) * m.z; });
        EXPECT_NEAR(sum, 1, 2e-11) << static_cast<int>(d) << " alpha " << alpha << " aspect " << aspect;
      }
    }
  }
}

// Lagarde and de Rousiers, 4.9.3: of GGX's facets the share E, by projected area, is within the angle theta with tan^2(theta) = E alpha^2
// / (1 - E), found from the integral of 2 alpha^2 r / (alpha^2 + r^2)^2 over slopes r. The text's atan(E alpha^2 / (1 - E)) has no root: at
// alpha .1 and E = .75 its cone has 8 % of them within 1.7 degrees.
TEST(Errata, E22TheConeOfFacets) {
  const auto share_within = [](double alpha, double tangent) {
    const Facets facets(Distribution::ggx, alpha, alpha);
    double sum = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
      // In w, slope = alpha sinh(w), dm = r / (1 + r^2)^(3/2) dr dphi.
      const double top = std::asinh(tangent / alpha), w = top * (i + 0.5) / steps, r = alpha * std::sinh(w);
      const double cosine = 1 / std::sqrt(1 + r * r);
      const double density = facets.density({r * cosine, 0, cosine}) * cosine;
      sum += 2 * pi * density * r * cosine * cosine * cosine * alpha * std::cosh(w) * top / steps;
    }
    return sum;
  };
  for (const double alpha : {0.01, 0.1, 0.5, 1.0}) {
    for (const double share : {0.25, 0.75, 0.95}) {
      const double tangent2 = share * alpha * alpha / (1 - share);
      EXPECT_NEAR(share_within(alpha, std::sqrt(tangent2)), share, 1e-5);
    }
  }
  EXPECT_NEAR(share_within(0.1, 0.75 * 0.01 / 0.25), 0.09 / 1.09, 1e-5);
}

// U(v) is the integral of D(m) <v.m>: Smith's G1 normalises the visible normals exactly. <v.m> bends across the equator of v: azimuths by
// the midpoint rule of step h err by a few h^2 / 24.
TEST(Facets, SeenAreaIsTheProjectedOne) {
  for (const Distribution d : of_facets) {
    for (const double alpha : {1e-4, 0.01, 0.2, 0.6, 1.0}) {
      for (const double aspect : {1.0, 0.4}) {
        const Facets facets(d, alpha, alpha * aspect);
        for (const double cosine : {1e-4, 0.01, 0.3, 0.9, 1.0}) {
          const Vec3d v = at(cosine, 0.7);
          const double sum = over_normals(alpha, 384, [&](const Vec3d& m) { return facets.density(m) * std::max(dot(v, m), 0.0); });
          EXPECT_NEAR(facets.seen_area(v), sum, 1.5e-4 * sum) << static_cast<int>(d) << " alpha " << alpha << " cosine " << cosine;
          EXPECT_GE(facets.seen_area(v), v.z * (1 - 1e-15));
        }
      }
    }
  }
}

// Blinn-Phong of exponent 0 and GGX of alpha 1 are the same even spread of normals; a narrow Blinn-Phong is Beckmann's.
TEST(Facets, DistributionsMeet) {
  const Facets blinn(Distribution::blinn_phong, 1, 1), ggx(Distribution::ggx, 1, 1);
  const Facets narrow(Distribution::blinn_phong, 1e-3, 1e-3), beckmann(Distribution::beckmann, 1e-3, 1e-3);
  for (const double cosine : {1e-4, 0.1, 0.5, 0.99}) {
    const Vec3d v = at(cosine);
    EXPECT_NEAR(blinn.density(v), ggx.density(v), 1e-14);
    EXPECT_NEAR(blinn.seen_area(v), ggx.seen_area(v), 1e-12);  // 24 nodes for a cosine
    // (1 + p^2)^-(n + 4)/2 against exp(-p^2 / alpha^2): the exponents differ by parts of alpha^2.
    EXPECT_NEAR(narrow.seen_area(v), beckmann.seen_area(v), 1e-6 * v.z + 1e-9);
  }
  const Vec3d h = normalised(Vec3d{1.2e-3, 0, 1});
  EXPECT_NEAR(narrow.density(h) / beckmann.density(h), 1, 1e-5);
}

// Walter et al. 2007: alpha = sqrt(2 / (n + 2)); at exponent 2 (alpha^-2 - 1) the lobe falls to 1 / e at tan(theta) = alpha for alpha -> 0.
TEST(Facets, ExponentsAndAlphas) {
  EXPECT_DOUBLE_EQ(blinn_phong_exponent(1), 0);
  EXPECT_DOUBLE_EQ(blinn_phong_exponent(0.1), 198);
  EXPECT_DOUBLE_EQ(alpha_of_blinn_phong(198), 0.1);
  EXPECT_DOUBLE_EQ(phong_exponent(0.1), 49.5);
  EXPECT_DOUBLE_EQ(alpha_of_phong(49.5), 0.1);
  const Facets facets(Distribution::blinn_phong, 1e-3, 1e-3);
  EXPECT_NEAR(facets.density({1e-3, 0, 1}) / facets.density({0, 0, 1}), std::exp(-1), 1e-6);
}

// Karis' k = alpha / 2 is Smith's masking at alpha 1, and at any other masks no less: energy safe, also where alpha depends on the
// direction (2 K - c = c (1 - a) + a against sqrt(c^2 (1 - a^2) + a^2): the difference of their squares is 2 a (1 - a) c (1 - c)). What it
// hides too much of the normals, 1 - integral of G1 D <v.m> / n.v = 1 - U / K, is at most 1/5, where c = 3/4 alpha -> 0.
TEST(Masking, SchlicksFormHidesMore) {
  double most_image = 0;
  for (int i = 0; i <= 200; ++i) {
    const double alpha = std::pow(10, -4 + 4 * i / 200.0);
    const Facets facets(Distribution::ggx, alpha, alpha);
    const double image = schlick_masking_k(Masking::schlick_image, alpha), direct = schlick_masking_k(Masking::schlick_direct, alpha);
    EXPECT_GE(direct, image * (1 - 1e-15));
    for (int j = 0; j <= 400; ++j) {
      const double cosine = std::pow(10, -4 + 4 * j / 400.0), seen = facets.seen_area(at(cosine));
      const double deficit = 1 - seen / schlick_seen_area(cosine, image);
      EXPECT_GE(deficit, -1e-14);
      most_image = std::max(most_image, deficit);
    }
  }
  EXPECT_NEAR(most_image, 0.2, 1e-4);
  for (const double cosine : {1e-4, 0.2, 0.7, 1.0}) {
    EXPECT_NEAR(Facets(Distribution::ggx, 1, 1).seen_area(at(cosine)), schlick_seen_area(cosine, 0.5), 1e-15);
    // By hand: roughness .5, alpha .25: k = 1.5^2 / 8.
    EXPECT_NEAR(schlick_masking_k(Masking::schlick_direct, 0.25), 0.28125, 1e-16);
  }
}

// GGX in the general form is the fast one, digit for digit but rounding.
TEST(SpecularLobe, RoundGgxIsGgxLobe) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const double alpha = random.log_uniform(1e-4, 1);
    const Vec3d v = at(random.log_uniform(1e-4, 1), random.uniform(0, 6)), l = at(random.log_uniform(1e-4, 1), random.uniform(0, 6));
    for (const Masking masking : every_masking) {
      SpecularLobe lobe;
      lobe.alpha_x = lobe.alpha_y = alpha;
      lobe.masking = masking;
      const double fast = brdf_cos(GgxLobe{alpha, {0.04, 0.04, 0.04}, 1, masking}, v, l).x;
      EXPECT_NEAR(brdf_cos(lobe, v, l).x, fast, 1e-12 * fast);
      EXPECT_NEAR(pdf_brdf(lobe, v, l), pdf_brdf(GgxLobe{alpha, {1, 1, 1}, 1, masking}, v, l), 1e-12 * pdf_brdf(lobe, v, l));
    }
  }
}

SpecularLobe mirror_lobe(Distribution d, Masking masking, double alpha_x, double alpha_y) {
  SpecularLobe lobe;
  lobe.distribution = d;
  lobe.masking = masking;
  lobe.alpha_x = alpha_x;
  lobe.alpha_y = alpha_y;
  lobe.f0 = {1, 1, 1};
  return lobe;
}

std::vector<SpecularLobe> every_lobe(double alpha) {
  std::vector<SpecularLobe> lobes{mirror_lobe(Distribution::phong, Masking::correlated, alpha, alpha)};
  for (const Distribution d : of_facets) {
    for (const Masking masking : every_masking) {
      lobes.push_back(mirror_lobe(d, masking, alpha, alpha));
      if (d != Distribution::blinn_phong) lobes.push_back(mirror_lobe(d, masking, alpha, 0.3 * alpha));
    }
  }
  return lobes;
}

// f(v, l) = f(l, v), at grazing and at tiny alpha too.
TEST(SpecularLobe, IsReciprocal) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3d v = at(random.log_uniform(1e-4, 1), random.uniform(0, 6));
    // Half of the lights near the mirror direction, where the lobe is.
    Vec3d l = at(random.log_uniform(1e-4, 1), random.uniform(0, 6));
    const double alpha = random.log_uniform(1e-4, 1);
    if (i % 2 == 0) l = normalised(Vec3d{-v.x + alpha * random.uniform(-1, 1), -v.y + alpha * random.uniform(-1, 1), v.z});
    for (const SpecularLobe& lobe : every_lobe(alpha)) {
      const double there = brdf_cos(lobe, v, l).x / l.z, back = brdf_cos(lobe, l, v).x / v.z;
      EXPECT_NEAR(there, back, 1e-9 * there) << static_cast<int>(lobe.distribution);
    }
  }
}

// A white sky gives back no more than it sends, at any view: the mean of f / pdf, drawn. Scatter within 5 standard deviations.
TEST(SpecularLobe, GivesBackNoMoreThanItGets) {
  constexpr int n = 1500;
  for (const double alpha : {1e-4, 0.02, 0.3, 1.0}) {
    for (const double cosine : {1e-4, 0.02, 0.3, 1.0}) {
      const Vec3d v = at(cosine, 0.4);
      for (const SpecularLobe& lobe : every_lobe(alpha)) {
        double sum = 0, square = 0;
        for (int i = 0; i < n; ++i) {
          const DirectionSample s = sample_brdf(lobe, v, {(i + 0.5) / n, std::fmod((i + 0.5) * 0.6180339887498949, 1.0)});
          const double x = s.pdf > 0 ? brdf_cos(lobe, v, s.direction).x / s.pdf : 0;
          ASSERT_TRUE(std::isfinite(x) && x >= 0) << static_cast<int>(lobe.distribution) << " alpha " << alpha << " cosine " << cosine;
          sum += x;
          square += x * x;
        }
        const double mean = sum / n, error = std::sqrt(std::max(square / n - mean * mean, 0.0) / n);
        EXPECT_LE(mean, 1 + 5 * error + 1e-9) << static_cast<int>(lobe.distribution) << " alpha " << alpha << " cosine " << cosine;
      }
    }
  }
}

// Drawn facets follow D <v.m> / U: chi-squared over cells of the projected disc, each cell's share by quadrature. With 63 degrees of
// freedom 1 in 1e5 exceeds 124.
TEST(SpecularLobe, DrawnNormalsFollowTheirDensity) {
  Random random(6);
  constexpr int side = 8, n = 20000, fine = 24;
  for (const Distribution d : of_facets) {
    for (const auto& [ax, ay] : std::vector<std::pair<double, double>>{{0.4, 0.4}, {0.9, 0.9}, {0.15, 0.6}}) {
      for (const double cosine : {0.05, 0.6, 1.0}) {
        const Facets facets(d, ax, ay);
        const Vec3d v = at(cosine, 0.5);
        // Cells in the components of m across n: rings of equal sin^2, sectors of azimuth.
        constexpr std::size_t cells = std::size_t{side} * side;
        std::vector<double> expected(cells), drawn(cells);
        const auto cell = [](int ring, int sector) { return static_cast<std::size_t>(ring) * side + static_cast<std::size_t>(sector); };
        for (int r = 0; r < side * fine; ++r) {
          for (int a = 0; a < side * fine; ++a) {
            const double s2 = (r + 0.5) / (side * fine), phi = 2 * pi * (a + 0.5) / (side * fine), z = std::sqrt(1 - s2);
            const Vec3d m{std::sqrt(s2) * std::cos(phi), std::sqrt(s2) * std::sin(phi), z};
            // dm = d(sin^2) dphi / (2 cos)
            expected[cell(r / fine, a / fine)] +=
                facets.density(m) * std::max(dot(v, m), 0.0) / facets.seen_area(v) * pi / (side * fine) / (side * fine) / z;
          }
        }
        for (int i = 0; i < n; ++i) {
          const Vec3d m = facets.seen_normal(v, random.square());
          ASSERT_GE(dot(v, m), -1e-12);
          const double s2 = m.x * m.x + m.y * m.y, turn = std::atan2(m.y, m.x) / (2 * pi);
          const int r = std::min(side - 1, static_cast<int>(s2 * side)),
                    a = std::min(side - 1, static_cast<int>((turn - std::floor(turn)) * side));
          drawn[cell(r, a)] += 1;
        }
        double chi2 = 0, pooled_expected = 0, pooled_drawn = 0;
        const auto add = [&](double e, double o) { chi2 += (o - e) * (o - e) / e; };
        for (std::size_t i = 0; i < expected.size(); ++i) {
          const double e = expected[i] * n;
          if (e >= 10 && i < expected.size() - side) {
            add(e, drawn[i]);
          } else {  // few, and the outermost ring, where 1 / cos has no end
            pooled_expected += e;
            pooled_drawn += drawn[i];
          }
        }
        if (pooled_expected > 10) chi2 += std::pow(pooled_drawn - pooled_expected, 2) / pooled_expected;
        EXPECT_LT(chi2, 124) << static_cast<int>(d) << " alphas " << ax << ' ' << ay << " cosine " << cosine;
      }
    }
  }
}

// Sampling is exact where a lobe is a millionth of a degree wide: the sums of drawn slopes' squares, by alpha^2. Beckmann's slopes have the
// variance alpha^2 / 2 each, seen from above.
TEST(SpecularLobe, DrawnSlopesAtAlpha1e4) {
  Random random(7);
  for (const Distribution d : {Distribution::beckmann, Distribution::blinn_phong}) {
    const Facets facets(d, 1e-4, 1e-4);
    constexpr int n = 20000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const Vec3d m = facets.seen_normal({0, 0, 1}, random.square());
      sum += (m.x * m.x + m.y * m.y) / (m.z * m.z) / 1e-8;
    }
    EXPECT_NEAR(sum / n, 1, 5 / std::sqrt(n));  // an exponential distribution: its deviation is its mean
  }
}

// Phong: albedo 1 straight from above (the integral of (n + 2) / (2 pi) cos^(n + 1)), for any exponent.
TEST(SpecularLobe, PhongFromAbove) {
  for (const double alpha : {1e-4, 0.1, 0.5}) {
    const SpecularLobe lobe = mirror_lobe(Distribution::phong, Masking::correlated, alpha, alpha);
    double sum = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      const DirectionSample s = sample_brdf(lobe, {0, 0, 1}, {(i + 0.5) / n, 0.3});
      sum += brdf_cos(lobe, {0, 0, 1}, s.direction).x / s.pdf / n;
    }
    EXPECT_NEAR(sum, 1, 1e-4);
  }
}

// x and y of an anisotropic lobe are the point's tangent and its bitangent: turning the tangent by a right angle exchanges the alphas.
TEST(SpecularLobe, AnisotropyFollowsTheTangent) {
  Emitter lamp;
  lamp.shape = SphereEmitter{{0.5, 2, 1}, 0.3};
  lamp.radiance = {1, 1, 1};
  const Vec3d n{0, 1, 0}, view = normalised(Vec3d{-0.4, 1, 0.3});
  const SpecularLobe along = mirror_lobe(Distribution::ggx, Masking::correlated, 0.1, 0.4),
                     across = mirror_lobe(Distribution::ggx, Masking::correlated, 0.4, 0.1);
  const double one = reference(lamp, {{}, n, n, view, along, {1, 0.3, 0}}, {1e-8, 0}).value.x;
  const double other = reference(lamp, {{}, n, n, view, across, {0, 0, 5}}, {1e-8, 0}).value.x;
  const double turned = reference(lamp, {{}, n, n, view, across, {1, 0, 0}}, {1e-8, 0}).value.x;
  EXPECT_NEAR(one, other, 1e-7 * one);
  EXPECT_GT(std::abs(one - turned), 0.1 * one);
}

// Reflectance at normal incidence is ((n - 1) / (n + 1))^2: water .02, glass .04; at Brewster's angle, tan = n, nothing that swings in the
// plane of incidence; all at grazing. With eta < 1 all beyond sin = eta.
TEST(Fresnel, KnownValues) {
  EXPECT_NEAR(dielectric_reflectance(1, 1.33), 0.02006, 1e-5);
  EXPECT_NEAR(dielectric_reflectance(1, 1.5), 0.04, 1e-15);
  for (const double eta : {1.1, 1.33, 1.5, 2.4, 1 / 1.5}) {
    const double brewster = 1 / std::sqrt(1 + eta * eta);
    EXPECT_NEAR(dielectric_reflectances(brewster, eta).p, 0, 1e-30);
    // There r_s is sin(theta_i - theta_t) / sin(theta_i + theta_t) with a right angle between both: cos(2 theta_t) = (eta^2 - 1) / (eta^2 +
    // 1).
    EXPECT_NEAR(dielectric_reflectances(brewster, eta).s, std::pow((eta * eta - 1) / (eta * eta + 1), 2), 1e-14);
    EXPECT_NEAR(dielectric_reflectance(1e-9, eta), 1, 1e-7);
  }
  const double critical = std::sqrt(1 - 1 / 2.25);
  EXPECT_EQ(dielectric_reflectance(critical - 1e-9, 1 / 1.5), 1);
  EXPECT_LT(dielectric_reflectance(critical + 1e-3, 1 / 1.5), 0.9);
}

// The complex index put straight into Fresnel's equations, and no absorption at all: a dielectric.
TEST(Fresnel, ConductorIsTheComplexDielectric) {
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const double eta = random.uniform(0.05, 4), k = random.uniform(0, 6), c = random.uniform(1e-4, 1);
    const std::complex<double> n(eta, k), t = std::sqrt(n * n - (1 - c * c));
    const double s = std::norm((c - t) / (c + t)), p = std::norm((n * n * c - t) / (n * n * c + t));
    EXPECT_NEAR(conductor_reflectance(c, eta, k), 0.5 * (s + p), 1e-12);
    EXPECT_NEAR(conductor_reflectance(c, 1 + eta, 0), dielectric_reflectance(c, 1 + eta), 1e-12);
  }
}

// How far Schlick's approximation is from the exact one: glass .036 of reflectance, near grazing; both forms within .0038 of
// each other for f0 = 0 (less for others).
TEST(Fresnel, SchlicksForms) {
  double glass = 0, forms = 0;
  for (int i = 0; i <= 10000; ++i) {
    const double c = i / 10000.0;
    glass = std::max(glass, std::abs(0.04 + 0.96 * schlick_weight(c) - dielectric_reflectance(std::max(c, 1e-12), 1.5)));
    forms = std::max(forms, std::abs(schlick_weight(c) - gaussian_schlick_weight(c)));
  }
  EXPECT_NEAR(glass, 0.0357, 1e-4);
  EXPECT_LE(forms, 0.0038);
  EXPECT_GE(forms, 0.0037);
  EXPECT_EQ(gaussian_schlick_weight(0), 1);
}

// f0 below .02 takes the grazing reflectance along; .33 three times is .99, so that f0 = .02 reaches .99.
TEST(Fresnel, MicroOcclusion) {
  EXPECT_EQ(micro_occlusion_f90({0, 0, 0}), 0);
  EXPECT_NEAR(micro_occlusion_f90({0.01, 0.01, 0.01}), 0.495, 1e-15);
  EXPECT_EQ(micro_occlusion_f90({0.04, 0.04, 0.04}), 1);
  SpecularLobe lobe;
  lobe.f0 = {0.01, 0.01, 0.01};
  lobe.f90 = micro_occlusion_f90(lobe.f0);
  EXPECT_NEAR(fresnel_reflectance(lobe, 0).x, 0.495, 1e-12);
}

}  // namespace
