// Diffuse surfaces under extended lights: the rule of few nodes against the reference, its estimate of its error, its corners.
#include "etendue/diffuse_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/published.h"
#include "ratio_rules.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// Half of the limits that the acceptance program has for a thousand lights: the rule is ten times below those, and sixty lights scatter.
class Rule : public testing::TestWithParam<std::tuple<Kind, bool>> {};
TEST_P(Rule, IsNearToTheReference) {
  const auto& [kind, above] = GetParam();
  const std::vector<DiffuseCase> cases = diffuse_cases(kind, above, 60, 100);
  double broken = 0, count = 0, nodes = 0;
  for (const DiffuseModel& model : diffuse_models) {
    for (const double roughness : roughnesses) {
      Aggregate by_view[2];
      for (const DiffuseCase& c : cases) {
        ShadingPoint point = c.point;
        point.brdf = model.of(roughness);
        const Estimate rule = *diffuse_luminance(c.placement.emitter, point);
        const Estimate exact = reference(c.placement.emitter, point, {1e-6, 1e-10});
        by_view[c.grazing ? 1 : 0].add(rule.value.x, exact.value.x);
        broken += std::abs(rule.value.x - exact.value.x) > rule.error.x + exact.error.x ? 1 : 0;
        nodes += static_cast<double>(rule.evaluations);
        ++count;
      }
      for (const Aggregate& a : by_view)
        EXPECT_LE(a.share(), above ? limit_above / 2 : limit_across / 2) << model.name << " roughness " << roughness;
    }
  }
  EXPECT_LE(broken / count, 0.01);
  EXPECT_LE(nodes / count, 45);
}
INSTANTIATE_TEST_SUITE_P(DiffuseLight, Rule,
                         testing::Combine(testing::Values(Kind::rect, Kind::sphere, Kind::disk, Kind::capsule), testing::Bool()));

constexpr Vec3d up{0, 0, 1};
ShadingPoint point_with(const Brdf& brdf, const Vec3d& view = {0.6, 0, 0.8}) { return {{}, up, up, view, brdf}; }

// All light and no light: a sky of luminance 1 gives the albedo, a sigma of 0 is Lambert's closed form, a light behind gives nothing.
TEST(DiffuseLight, AtItsLimits) {
  Emitter sky = white(EnvironmentEmitter{});
  for (const DiffuseModel& model : diffuse_models) {
    const ShadingPoint point = point_with(model.of(0.5));
    const double albedo = reference(sky, point, {1e-6, 0}).value.x;
    EXPECT_NEAR(diffuse_luminance(sky, point)->value.x, albedo, 0.005 * albedo) << model.name;
    const Emitter set = white(SphereEmitter{{0, 0, -2}, 1});
    EXPECT_EQ(diffuse_luminance(set, point)->value, Rgb{});
    EXPECT_EQ(diffuse_luminance(sky, point_with(model.of(0.5), {0.6, 0, -0.8}))->value, Rgb{});
  }
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Placement p = place(Kind::disk, random, i % 2 == 0);
    const ShadingPoint flat{p.position, p.normal, p.normal, p.normal, OrenNayar{{1, 1, 1}, 0}};
    const double lambert = lux_at(p.emitter, p.position, p.normal) / pi;
    EXPECT_NEAR(diffuse_luminance(p.emitter, flat)->value.x, lambert, 1e-13 * lambert);
  }
}

// Far away one direction is enough: f cos E / cos.
TEST(DiffuseLight, FarLightsArePoints) {
  const Vec3d towards = normalised(Vec3d{0.3, -0.5, 0.7});
  for (const DiffuseModel& model : diffuse_models) {
    const ShadingPoint point = point_with(model.of(0.8));
    const Emitter far = white(SphereEmitter{towards * 1e4, 1});
    const Estimate rule = *diffuse_luminance(far, point);
    const double expected = brdf_cos(point.brdf, point.view, towards).x / towards.z * lux_at(far, {}, up);
    EXPECT_NEAR(rule.value.x, expected, 1e-6 * expected) << model.name;
    EXPECT_LE(rule.evaluations, 6u);
  }
}

// Colours of the light and of the surface multiply; a mesh is the sum of its triangles; two sides, a window, a pattern, punctual lights and
// lines are taken as well.
TEST(DiffuseLight, TakesEveryLight) {
  const Brdf brdf = DisneyDiffuse{{0.8, 0.5, 0.2}, 0.7};
  const ShadingPoint point = point_with(brdf);
  Emitter panel = white(rectangle({0.2, 0.1, 1}, {1, 0, 0}, {0, -1, 0}, 1, 0.7));
  panel.radiance = {1, 2, 3};
  const Estimate whole = *diffuse_luminance(panel, point);
  const Rgb grey = diffuse_luminance(panel, point_with(DisneyDiffuse{{1, 1, 1}, 0.7}))->value;
  const Rgb tint{0.8, 1, 0.6};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(whole.value[c], grey.x * tint[c], 1e-13);
  const auto& v = std::get<PolygonEmitter>(panel.shape).vertices;
  Emitter mesh = white(MeshEmitter{{{v[0], v[1], v[2]}, {v[0], v[2], v[3]}}});
  mesh.radiance = panel.radiance;
  EXPECT_NEAR(diffuse_luminance(mesh, point)->value.x, whole.value.x, 1e-3 * whole.value.x);
  const auto agrees = [&](const Emitter& e) {
    const Estimate rule = *diffuse_luminance(e, point), exact = reference(e, point, {1e-6, 0});
    EXPECT_GT(exact.value.x, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rule.value[c], exact.value[c], 1e-3 * exact.value[c]);
  };
  agrees(white(PunctualEmitter{{0, 0.3, 2}, {}, {5, 5, 5}, PointShape{}}));
  agrees(white(DistantEmitter{normalised(Vec3d{0.1, 0.2, 0.9}), {3, 3, 3}, 0}));
  agrees(white(DistantEmitter{normalised(Vec3d{0.1, 0.2, 0.9}), {3, 3, 3}, 0.3}));
  agrees(white(LineEmitter{{-1, 0.2, 1}, {1, 0.4, 1.5}, {2, 2, 2}}));
  agrees(white(TubeEmitter{{-1, 0.2, 1}, {1, 0.4, 1.5}, 0.1, Caps::flat}));
  Emitter back = white(DiskEmitter{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, 0.5});
  back.two_sided = true;
  agrees(back);
  Emitter patterned = panel;
  patterned.pattern = [](Vec2d uv) { return Rgb{uv.x, uv.y, 1}; };
  agrees(patterned);
  Emitter windowed = panel;
  windowed.window = {Falloff::gltf, 3};
  agrees(windowed);
  ShadingPoint tilted = point;
  tilted.surface_normal = normalised(Vec3d{0.9, 0, 0.5});
  const Emitter low = white(SphereEmitter{{-1, 0, 0.6}, 0.5});
  EXPECT_NEAR(diffuse_luminance(low, tilted)->value.x, reference(low, tilted, {1e-6, 0}).value.x, 1e-3);
}

TEST(DiffuseLight, RefusesSpecularLobes) {
  const Emitter light = white(SphereEmitter{{0, 0, 2}, 1});
  EXPECT_FALSE(is_diffuse(GgxLobe{}));
  EXPECT_FALSE(is_diffuse(Standard{}));
  EXPECT_TRUE(is_diffuse(Lambert{}));
  EXPECT_FALSE(diffuse_luminance(light, point_with(GgxLobe{})));
  EXPECT_FALSE(diffuse_rules()[0].luminance(light, point_with(GgxLobe{})));
}

// In contact, thin, wide, edge-on, huge and tiny: finite, not negative, and within the estimate or a percent of the reference.
TEST(DiffuseLight, StaysFiniteAtTheExtremes) {
  const Brdf brdf = OrenNayar{{1, 1, 1}, 0.5};
  const std::vector<Emitter> lights{white(rectangle({0, 0, 1e-5}, {1, 0, 0}, {0, -1, 0}, 1, 1)),
                                    white(rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, 1e-9, 4)),
                                    white(rectangle({0, 0, 1}, {1, 0, 0}, {0, -1, 0}, 1e6, 1e6)),
                                    white(rectangle({3, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1e-7)),
                                    white(rectangle({0, 0, 1e6}, {1, 0, 0}, {0, -1, 0}, 1, 1)),
                                    white(SphereEmitter{{0, 0, 1.0000001}, 1}),
                                    white(SphereEmitter{{1, 0, -0.9999}, 1}),
                                    white(DiskEmitter{{1, 0, 1e-4}, {0, 0, -1}, {1, 0, 0}, 1}),
                                    white(TubeEmitter{{-100, 0, 0.011}, {100, 0, 0.011}, 0.01, Caps::round}),
                                    white(TubeEmitter{{0, 0, 1}, {0, 0, 2}, 0.3, Caps::round})};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    for (const Vec3d& view : {Vec3d{0, 0, 1}, Vec3d{1e-12, 0, 1}, normalised(Vec3d{1, 0, 1e-6}), normalised(Vec3d{0.3, 0.8, 0.4})}) {
      const Estimate rule = *diffuse_luminance(lights[i], point_with(brdf, view));
      const Estimate exact = reference(lights[i], point_with(brdf, view), {1e-5, 1e-12});
      EXPECT_TRUE(std::isfinite(rule.value.x) && rule.value.x >= 0 && std::isfinite(rule.error.x)) << i;
      EXPECT_NEAR(rule.value.x, exact.value.x, rule.error.x + exact.error.x + 0.01 * exact.value.x + 1e-12) << i;
    }
  }
}

// The rules of others. One direction is exact for Lambert; light from straight above has that direction in all of them.
TEST(DiffuseRules, AreTheirFormulas) {
  const Emitter above = white(DiskEmitter{{0, 0, 2}, {0, 0, -1}, {1, 0, 0}, 0.5});
  const ShadingPoint point = point_with(DisneyDiffuse{{1, 1, 1}, 1}, {0.8, 0, 0.6});
  const double lux = lux_at(above, {}, up), f = brdf_cos(point.brdf, point.view, up).x;
  for (const char* name : {"frostbite-45", "light-vector"})
    EXPECT_NEAR(find_diffuse_rule(name)->luminance(above, point)->x, f * lux, 1e-12);
  const Vec3d shifted = frostbite_diffuse_direction(up, point.view, 1);
  EXPECT_NEAR(find_diffuse_rule("frostbite-15")->luminance(above, point)->x, f * lux_at(above, {}, shifted), 1e-12);
  for (const DiffuseRule& rule : diffuse_rules()) {
    const auto flat = rule.luminance(above, point_with(Lambert{{1, 1, 1}}));
    if (flat) {
      EXPECT_NEAR(flat->x, lux / pi, 1e-12) << rule.name;
    }
    EXPECT_EQ(find_diffuse_rule(rule.name), &rule);
  }
  EXPECT_FALSE(find_diffuse_rule("frostbite-15")->luminance(above, point_with(OrenNayar{})));
  EXPECT_FALSE(find_diffuse_rule("frostbite-45-point")->luminance(above, point));
  EXPECT_EQ(find_diffuse_rule("none"), nullptr);
}

}  // namespace
