// Layers: weights, normals, and how far blending their parameters is from summing up their light.
#include "etendue/layered_surface.h"

#include "etendue/layered_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using eval::blending_error;
using eval::protocol::Random;

LayerValue layer(const Rgb& base, double metal, double roughness, double reflectance = 0.5) {
  LayerValue value;
  value.surface = {base, metal, roughness, reflectance};
  return value;
}
double error_of(const LayerValue& below, const LayerValue& above, double mask, LayerBlend blend) {
  const LayerValue layers[] = {below, above};
  const double masks[] = {1, mask};
  return blending_error(layers, masks, blend);
}

const LayerValue steel = layer({0.56, 0.57, 0.58}, 1, 0.3), rust = layer({0.25, 0.09, 0.04}, 0, 0.8),
                 gold = layer({1, 0.766, 0.336}, 1, 0.5), black_paint = layer({0.02, 0.02, 0.02}, 0, 0.5),
                 white_paint = layer({0.8, 0.8, 0.8}, 0, 0.5), red_paint = layer({0.5, 0.05, 0.05}, 0, 0.5);

TEST(Layers, WeightsAreWhatIsSeen) {
  const double masks[] = {0.3, 0.5, 0.25};  // the lowest is everywhere
  const std::vector<double> weights = layer_weights(masks);
  EXPECT_DOUBLE_EQ(weights[2], 0.25);
  EXPECT_DOUBLE_EQ(weights[1], 0.75 * 0.5);
  EXPECT_DOUBLE_EQ(weights[0], 0.75 * 0.5);
  EXPECT_TRUE(layer_weights({}).empty());
}

TEST(Layers, AMaskOfAllOrNothingIsALayer) {
  LayerValue above = rust;
  above.normal = normalised(Vec3d{0.2, 0.1, 1});
  above.occlusion = 0.5;
  above.emissive = {3, 2, 1};
  const LayerValue layers[] = {steel, above};
  for (const LayerBlend blend : {LayerBlend::parameters, LayerBlend::colours}) {
    const double none[] = {0, 0}, all[] = {0, 7};  // beyond 1 is 1
    EXPECT_EQ(blended(layers, none, NormalBlend::slopes, blend).surface.base_colour, steel.surface.base_colour);
    const LayerValue top = blended(layers, all, NormalBlend::replace, blend);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(top.surface.base_colour[c], rust.surface.base_colour[c], 1e-7);
    EXPECT_NEAR(top.surface.metal, 0, 1e-7);
    EXPECT_LT(length(top.normal - above.normal), 1e-15);  // made unit again
    EXPECT_EQ(top.occlusion, 0.5);
    EXPECT_EQ(top.emissive, above.emissive);
  }
}

// Within one roughness, light is linear in what is mixed: base colours of non-metals of one reflectance, or of metals.
TEST(Layers, BlendedParametersAreExactWithinAKind) {
  for (const double mask : {0.1, 0.5, 0.9}) {
    EXPECT_LT(error_of(white_paint, red_paint, mask, LayerBlend::parameters), 1e-12);
    EXPECT_LT(error_of(layer({0.95, 0.64, 0.54}, 1, 0.2), layer({0.97, 0.96, 0.92}, 1, 0.2), mask, LayerBlend::parameters), 1e-12);
    // Whatever the kind, the two colours are: where Disney parameters have them, so is the light, but for f90 of the nearly black.
    EXPECT_LT(error_of(white_paint, layer({0.5, 0.2, 0.2}, 0, 0.5, 1), mask, LayerBlend::colours), 1e-6);
    EXPECT_LT(error_of(gold, black_paint, mask, LayerBlend::colours), 0.01);
  }
}

// The table of sdk/docs/materials.md: metals beside others, and lobes of unequal width, are not what their mean parameters are.
TEST(Layers, HowFarBlendingIsFromSummedLight) {
  EXPECT_NEAR(error_of(gold, black_paint, 0.5, LayerBlend::parameters), 0.299, 2e-3);
  EXPECT_NEAR(error_of(gold, white_paint, 0.5, LayerBlend::parameters), 0.103, 2e-3);
  EXPECT_NEAR(error_of(steel, rust, 0.5, LayerBlend::parameters), 0.840, 5e-3);
  EXPECT_NEAR(error_of(steel, rust, 0.5, LayerBlend::colours), 0.812, 5e-3);
  EXPECT_NEAR(error_of(layer({0.5, 0.5, 0.5}, 0, 0.5), layer({0.5, 0.5, 0.5}, 0, 0.6), 0.5, LayerBlend::parameters), 0.048, 2e-3);
}

// A part of the light for each layer, by its own normal.
TEST(Layers, LightIsTheSumOfTheirs) {
  LayerValue tilted = red_paint;
  tilted.normal = normalised(Vec3d{0.4, 0, 1});
  const LayerValue layers[] = {gold, tilted};
  const double weights[] = {0.75, 0.25}, second[] = {0, 1};
  const Vec3d view = normalised(Vec3d{0.2, 0.5, 1}), light = normalised(Vec3d{-0.3, 0.1, 0.8});
  const Rgb both = eval::brdf_cos(layers, weights, view, light), one = eval::brdf_cos(eval::Brdf(gold.surface), view, light);
  const Rgb other = eval::brdf_cos(layers, second, view, light);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(both[c], 0.75 * one[c] + 0.25 * other[c], 1e-14);
  // From straight along its normal, a tilted layer is what a level one is from above.
  EXPECT_NEAR(eval::brdf_cos(layers, second, tilted.normal, tilted.normal).x,
              eval::brdf_cos(eval::Brdf(tilted.surface), {0, 0, 1}, {0, 0, 1}).x, 1e-14);
}

TEST(Normals, LevelLayersChangeNothing) {
  Random random(11);
  const Vec3d up{0, 0, 1};
  for (int i = 0; i < 100; ++i) {
    Vec3d n = random.direction(), m = random.direction();
    n.z = std::abs(n.z) + 0.01, m.z = std::abs(m.z) + 0.01;
    n = normalised(n), m = normalised(m);
    for (const NormalBlend blend : {NormalBlend::slopes, NormalBlend::reoriented}) {
      EXPECT_LT(length(blended_normal(n, up, blend) - n), 1e-14);
      EXPECT_LT(length(blended_normal(up, n, blend) - n), 1e-14);
    }
    EXPECT_EQ(blended_normal(n, m, NormalBlend::replace), m);
    // Slopes of two height fields add up; a layer that is turned keeps its angle to what it stands on.
    const Vec3d sum = blended_normal(n, m, NormalBlend::slopes);
    EXPECT_NEAR(sum.x / sum.z, n.x / n.z + m.x / m.z, 1e-12 / (n.z * m.z * sum.z));
    EXPECT_NEAR(dot(blended_normal(n, m, NormalBlend::reoriented), n), m.z, 1e-13);
  }
  for (const NormalBlend blend : normal_blends) EXPECT_EQ(normal_blend_named(name_of(blend)), blend);
  EXPECT_FALSE(normal_blend_named("whiteout"));
  EXPECT_EQ(blended_normal({0, 0, -1}, up, NormalBlend::reoriented), up);
}

TEST(Layers, AnyModelIsDisneyParameters) {
  const Standard paint = standard_of(MetalRough{{0.5, 0.3, 0.1}, 0, 0.4, 1.5});
  EXPECT_NEAR(paint.reflectance, 0.5, 1e-12);
  EXPECT_NEAR(paint.base_colour.y, 0.3, 1e-12);
  EXPECT_EQ(paint.roughness, 0.4);
  const Standard metal = standard_of(conductor_from_f0({1 - 1e-6, 0.766, 0.336}, 0.25));
  EXPECT_EQ(metal.metal, 1);
  EXPECT_NEAR(metal.base_colour.z, 0.336, 1e-6);
  EXPECT_EQ(metal.roughness, 0.5);
  const Standard two = standard_of(SpecularGlossiness{{0.5, 0.5, 0.5}, {0.04, 0.04, 0.04}, 0.7});
  EXPECT_NEAR(two.base_colour.x, 0.48, 1e-6);  // 1 - .04 of it
  EXPECT_NEAR(two.roughness, 0.3, 1e-15);
  EXPECT_EQ(standard_of(Lambert{}).reflectance, 0);
  EXPECT_EQ(standard_of(Standard{{0.1, 0.2, 0.3}, 0.4, 0.5, 0.6}).metal, 0.4);
}

}  // namespace
