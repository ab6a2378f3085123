// What no picture shows of a material, in numbers: closed forms against integrals and sums of rays, and every lobe with its number.
#include "etendue/unshown.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "etendue/units.h"

namespace {

using namespace etendue;

// The midpoint rule with 1000 steps is off by 1e-6 of the integral.
TEST(Unshown, SchlickAlbedoIsTheSkysMean) {
  for (const double f0 : {0.0, 0.04, 0.7}) {
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
      const double c = (i + 0.5) / 1000;
      sum += 2 * c * (f0 + (1 - f0) * std::pow(1 - c, 5)) / 1000;
    }
    EXPECT_NEAR(schlick_albedo(f0), sum, 3e-6);
  }
}

// Rays that go to and fro in the film, summed one by one for phases all around: r + (1 - r^2) s e^it sum of (-r s e^it)^k.
TEST(Unshown, FilmReflectanceBoundsTheSumOfRays) {
  for (const double film : {1.2, 1.38, 1.5, 2.4}) {
    for (const double f0 : {0.0, 0.04, 0.5}) {
      const double base = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
      const double r = (1 - film) / (1 + film), s = (film - base) / (film + base);
      double least = 1, most = 0;
      for (int i = 0; i < 360; ++i) {
        const std::complex<double> turn = std::polar(1.0, 2 * pi * i / 360);
        std::complex<double> sum = r, ray = (1 - r * r) * s * turn;
        for (int k = 0; k < 200; ++k) sum += ray, ray *= -r * s * turn;
        least = std::min(least, std::norm(sum));
        most = std::max(most, std::norm(sum));
      }
      const ReflectanceRange range = film_reflectance(film, f0);
      EXPECT_NEAR(range.least, least, 1e-12) << film << ' ' << f0;
      EXPECT_NEAR(range.most, most, 1e-12) << film << ' ' << f0;
    }
  }
  // A film without a step to the air or to the surface is no film.
  EXPECT_NEAR(film_reflectance(1, 0.04).least, 0.04, 1e-15);
  EXPECT_NEAR(film_reflectance(1.5, 0.04).most, 0.04, 1e-15);
}

TEST(Unshown, EveryLobeHasItsNumber) {
  Material m;
  m.model = MetalRough{{0.5, 0.25, 1}, 0, 0.5, 1.5};
  m.lobes.unlit = true;
  m.blended = true;
  m.base_alpha = 0.25;
  m.lobes.clearcoat = Clearcoat{};
  m.lobes.clearcoat->factor = 0.5;
  m.lobes.sheen = Sheen{};
  m.lobes.sheen->colour = {0.2, 0.3, 0.4};
  m.lobes.transmission = Transmission{};
  m.lobes.transmission->factor = 0.5;
  m.lobes.diffuse_transmission = DiffuseTransmission{};
  m.lobes.diffuse_transmission->factor = 0.7;
  m.lobes.volume = Volume{};
  m.lobes.volume->thickness_m = 0.02;
  m.lobes.volume->attenuation_distance_m = 0.01;
  m.lobes.volume->attenuation_colour = {0.5, 1, 0.1};
  m.lobes.dispersion = Dispersion{2};
  m.lobes.specular = Specular{};
  m.lobes.specular->factor = 0.5;
  m.lobes.specular->colour = {1, 0.5, 100};
  m.lobes.iridescence = Iridescence{};
  m.lobes.anisotropy = Anisotropy{};
  m.lobes.anisotropy->strength = 0.5;
  const std::vector<Loss> losses = unshown_losses(m);
  const std::vector<Unshown> named = unshown_of(m);
  ASSERT_EQ(losses.size(), named.size());
  const char* const numbers[] = {
      "0.25 of it",  // base_alpha
      "its base colour: (0.5, 0.25, 1)",
      "0.02 of light from ahead, 0.0429 of a white",  // .5 x .04, .5 x (.04 + .96 / 21)
      "(0.2, 0.3, 0.4)",
      "0.48 of light from ahead",  // .5 x (1 - .04)
      "0.7 of the diffuse",
      "(0.25, 1, 0.01) of light would pass 0.02 m",   // two attenuation distances
      "an index 0.05 higher",                         // .5 x 2 / 20
      "F0 is 0.04 instead of (0.02, 0.01, 0.5), at",  // min(.04 x 100, 1) x .5
      "F0 is 0.04 instead of 0.04 to 0.04",           // a factor of 0
      "alpha is 0.25 in all directions, 0.438 along"  // .25 + .75 x .25
  };
  ASSERT_EQ(losses.size(), std::size(numbers));
  for (std::size_t i = 0; i < losses.size(); ++i) {
    EXPECT_EQ(losses[i].what, named[i].what);
    EXPECT_NE(losses[i].effect.find(numbers[i]), std::string::npos) << losses[i].effect;
  }
}

}  // namespace
