// The albedo of Frostbite's standard model over its parameters, and the variant that stays at or under 1.
#include "etendue/energy_safe.h"

#include "eval/quadrature.h"
#include "eval_protocol.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace etendue;
using namespace etendue::eval;
using eval::protocol::Random;

Vec3d at(double cosine, double azimuth = 0) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

EnergySafeStandard safe_of(const Standard& surface) {
  static const auto albedos = standard_albedos();
  return {surface, albedos};
}

// f(cosine) integrated over [0, 1], in panels that lie close where Schlick's weights and the bend of diffuse_kept() are.
template <class Function>
Rgb over_cosines(Function f) {
  constexpr double ends[] = {0, 0.003, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
  Rgb sum;
  for (std::size_t p = 1; p < std::size(ends); ++p) {
    for (const GaussNode& node : gauss24()) {
      const double half = 0.5 * (ends[p] - ends[p - 1]);
      sum += f(ends[p - 1] + half * (1 + node.x)) * (node.weight * half);
    }
  }
  return sum;
}

// Over all of the hemisphere, the specular lobe's peak included.
template <class BrdfCos>
Rgb over_hemisphere(int azimuths, BrdfCos brdf_cos_towards) {
  return over_cosines([&](double cosine) {
    Rgb sum;
    for (int k = 0; k < azimuths; ++k) sum += brdf_cos_towards(at(cosine, 2 * pi * (k + 0.5) / azimuths));
    return sum * (2 * pi / azimuths);
  });
}

// Of the diffuse lobe alone, which is a quadratic of v.l: 8 azimuths are exact.
Rgb safe_diffuse_albedo(const EnergySafeStandard& safe, double cosine) {
  const Standard& s = safe.surface;
  const FrostbiteDiffuse diffuse{s.base_colour * (1 - s.metal), s.roughness};
  const Vec3d view = at(cosine);
  return diffuse_kept(safe, cosine) *
         over_hemisphere(8, [&](const Vec3d& l) { return brdf_cos(Brdf(diffuse), view, l) * diffuse_kept(safe, l.z); });
}

constexpr double reflectances[] = {0, 0.25, 0.3535533905932738, 0.5, 0.75, 1};  // f0 0, .01, .02, .04, .09, .16
constexpr double cosines[] = {1e-3, 0.01, 0.03, 0.05, 0.08, 0.12, 0.2, 0.3, 0.45, 0.6, 0.8, 1};

// Closed form and moments of slopes against the plain integral of the BRDF: 1024 azimuths see the lobes of these.
TEST(StandardAlbedo, IsTheIntegral) {
  for (const Standard& surface :
       {Standard{{1, 0.5, 0.1}, 0, 0.6, 0.5}, Standard{{0.9, 0.6, 0.3}, 0.4, 0.8, 1}, Standard{{1, 1, 1}, 1, 1, 0}}) {
    for (const double cosine : {0.05, 0.4, 1.0}) {
      const Vec3d view = at(cosine);
      const Rgb whole = over_hemisphere(1024, [&](const Vec3d& l) { return brdf_cos(Brdf(surface), view, l); });
      const Rgb ours = standard_albedo(surface, cosine);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], whole[c], 1e-5) << surface.roughness << " " << cosine;
    }
  }
}

// 004's figure 9 (right) over n.v, roughness and f0, white: 1.13 for cosines from .05 on, at its corner (f0 .16, roughness 1, n.v .05), and
// 1.23 towards grazing. Smooth common dielectrics are above 1 as well.
TEST(StandardAlbedo, MapAndItsMaximum) {
  double most = 0, most_grazing = 0;
  Standard where;
  double where_cosine = 0;
  for (const double reflectance : reflectances) {
    for (int i = 0; i <= 20; ++i) {
      const Standard surface{{1, 1, 1}, 0, i / 20.0, reflectance};
      for (const double cosine : cosines) {
        const double albedo = standard_albedo(surface, cosine, 1e-5).x;
        EXPECT_GE(albedo, 0);
        most_grazing = std::max(most_grazing, albedo);
        if (cosine < 0.05 || albedo <= most) continue;
        most = albedo, where = surface, where_cosine = cosine;
      }
    }
  }
  EXPECT_NEAR(most, 1.132, 2e-3);
  EXPECT_EQ(where.roughness, 1);
  EXPECT_EQ(where.reflectance, 1);
  EXPECT_EQ(where_cosine, 0.05);
  EXPECT_NEAR(most_grazing, 1.228, 2e-3);
  EXPECT_GT(standard_albedo({{1, 1, 1}, 0, 0.1, 0.5}, 0.2).x, 1.02);
}

TEST(EnergySafe, GivesBackNoMoreThanItGets) {
  double most = 0;
  for (const double metal : {0.0, 0.6}) {
    for (const double reflectance : reflectances) {
      for (int i = 0; i <= 8; ++i) {
        // A channel of each kind: white, half and black.
        const EnergySafeStandard safe = safe_of({{1, 0.5, 0}, metal, i / 8.0, reflectance});
        for (const double cosine : cosines) {
          const Rgb diffuse = safe_diffuse_albedo(safe, cosine);
          const Rgb whole = standard_albedo(safe.surface, cosine, 1e-6);
          const Rgb specular = whole - safe.surface.base_colour * ((1 - metal) * frostbite_albedo(safe.surface.roughness, cosine));
          for (int c = 0; c < 3; ++c) {
            const double albedo = specular[c] + diffuse[c];
            EXPECT_LE(albedo, 1) << metal << " " << reflectance << " " << i / 8.0 << " " << cosine;
            EXPECT_LE(albedo, whole[c] + 1e-9);
            EXPECT_NEAR(standard_albedo(safe, cosine, 1e-6)[c], albedo, 1e-5);
            most = std::max(most, albedo);
          }
        }
      }
    }
  }
  EXPECT_GT(most, 0.98);  // a bound that is reached
}

// What the test above adds up is what brdf_cos() gives.
TEST(EnergySafe, IsTheSumOfItsLobes) {
  for (const double metal : {0.0, 0.3}) {
    for (const double cosine : {0.05, 0.5}) {
      const EnergySafeStandard safe = safe_of({{1, 0.5, 0.1}, metal, 0.9, 1});
      const Vec3d view = at(cosine);
      const Rgb whole = over_hemisphere(256, [&](const Vec3d& l) { return brdf_cos(safe, view, l); });
      const Rgb diffuse = safe_diffuse_albedo(safe, cosine);
      const Rgb gone = safe.surface.base_colour * ((1 - metal) * frostbite_albedo(0.9, cosine)) - diffuse;
      const Rgb expected = standard_albedo(safe.surface, cosine) - gone;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(whole[c], expected[c], 1e-5);
    }
  }
}

TEST(EnergySafe, IsReciprocalAndNeverBrighter) {
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    Vec3d v = random.direction(), l = random.direction();
    v.z = std::abs(v.z) + 1e-4, l.z = std::abs(l.z) + 1e-4;
    v = normalised(v), l = normalised(l);
    const double red = random.uniform(0, 1), metal = random.uniform(0, 1), roughness = random.uniform(0.1, 1);
    const double reflectance = random.uniform(0, 1);
    const EnergySafeStandard safe = safe_of({{red, 1, 0.3}, metal, roughness, reflectance});
    const Rgb there = brdf_cos(safe, v, l) / l.z, back = brdf_cos(safe, l, v) / v.z, plain = brdf_cos(Brdf(safe.surface), v, l) / l.z;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(there[c], back[c], 1e-11 * there[c]);
      EXPECT_LE(there[c], plain[c] * (1 + 1e-11));
    }
  }
}

// Where white is safe as it is, nothing changes: rough common dielectrics but for grazing angles.
TEST(EnergySafe, LeavesWhatIsSafe) {
  for (const double roughness : {0.3, 0.5, 0.7, 0.9}) {
    const EnergySafeStandard safe = safe_of({{1, 1, 1}, 0, roughness, 0.5});
    EXPECT_EQ(diffuse_kept(safe, 0.3), (Rgb{1, 1, 1})) << roughness;
    EXPECT_EQ(brdf_cos(safe, at(0.5), at(0.9, 2)), brdf_cos(Brdf(safe.surface), at(0.5), at(0.9, 2)));
  }
  const EnergySafeStandard safe = safe_of({{1, 1, 1}, 0, 1, 1});
  EXPECT_LT(diffuse_kept(safe, 0.05).x, 0.9);
  EXPECT_EQ(brdf_cos(safe, {0, 0, -1}, {0, 0, 1}), Rgb{});
}

}  // namespace
