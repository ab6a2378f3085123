#include "etendue/render.h"

#include "etendue/eval.h"
#include "folder.h"
#include "photometry_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace etendue {
namespace {

Light with_luminance(Shape shape, double luminance, Transform transform = {}) {
  Light light;
  light.name = "light";
  light.shape = std::move(shape);
  light.emission.given = Emission::Given::luminance;
  light.emission.value = luminance;
  light.transform = transform;
  return light;
}
Light point_light(double candela, const Vec3d& position) {
  Light light;
  light.name = "point";
  light.shape = PointShape{};
  light.emission.given = Emission::Given::intensity;
  light.emission.value = candela;
  light.transform.translation = position;
  return light;
}
// Emits along -Y instead of -Z.
Transform facing_down(const Vec3d& position) { return {{Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}}, position}; }

Object object(const Geometry& geometry, Transform transform = {}) {
  Object o;
  o.name = "object";
  o.geometry = geometry;
  o.transform = transform;
  return o;
}
Transform at(const Vec3d& position) {
  Transform t;
  t.translation = position;
  return t;
}

// A floor of albedo .5 seen from above.
Scene floor_scene() {
  Scene scene;
  scene.objects.push_back(object(PlaneGeometry{20}));
  scene.cameras.push_back(look_at({0, 4, 2}, {0, 0, 0}, 0.6));
  return scene;
}

Rendered rendered(const Scene& scene, const RenderOptions& options) {
  Result<Rendered> result = render(scene, options);
  EXPECT_TRUE(result.ok()) << result.error().text;
  return result.ok() ? std::move(*result) : Rendered{};
}

RenderOptions small(std::uint32_t width = 24, std::uint32_t height = 24) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  return options;
}

float green(const Picture& p, std::string_view layer, std::size_t pixel) { return p.find(layer)->pixels[3 * pixel + 1]; }

// Where the ray through a place of the picture meets the floor y = 0, from the camera's definition.
Vec3d floor_point(const Camera& camera, const RenderOptions& o, double x, double y) {
  const double t = std::tan(camera.vfov_rad / 2);
  const Vec3d d = camera.transform.vector({(2 * x / o.width - 1) * t * o.width / o.height, (1 - 2 * y / o.height) * t, -1});
  return camera.transform.translation + d * (-camera.transform.translation.y / d.y);
}

// Mean of f over a pixel by 3 x 3 places of Gauss and Legendre: exact up to fifth degree.
template <class F>
double pixel_mean(const Camera& camera, const RenderOptions& o, std::size_t pixel, const F& f) {
  const double away = std::sqrt(0.15);
  const std::array<double, 3> place{0.5 - away, 0.5, 0.5 + away}, weight{5 / 18.0, 8 / 18.0, 5 / 18.0};
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t column = pixel % o.width, row = pixel / o.width;
      const double x = static_cast<double>(column) + place[i], y = static_cast<double>(row) + place[j];
      sum += weight[i] * weight[j] * f(floor_point(camera, o, x, y));
    }
  }
  return sum;
}

TEST(Render, PointLightOnALambertFloorIsTheCosineLawOverThePixelsArea) {
  Scene scene = floor_scene();
  const Vec3d lamp{0.3, 1.2, -0.2};
  scene.lights.push_back(point_light(100, lamp));
  const RenderOptions options = small();
  const Rendered out = rendered(scene, options);
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    const double expected = pixel_mean(scene.cameras[0], options, i, [&](const Vec3d& p) {
      const Vec3d to = lamp - p;
      return 0.5 / pi * 100 * to.y / std::pow(dot(to, to), 1.5);
    });
    ASSERT_NEAR(green(out.picture, "", i), expected, 4e-5 * expected) << i;
  }
  EXPECT_EQ(out.stats.split_pixels, 0u);
}

TEST(Render, RectangleOnALambertFloorIsTheClosedFormIlluminance) {
  Scene scene = floor_scene();
  scene.lights.push_back(with_luminance(RectShape{1, 0.5}, 1000, facing_down({0.2, 1, 0})));
  scene.lights[0].visible = false;
  const RenderOptions options = small();
  const Rendered out = rendered(scene, options);
  const Result<eval::Emitter> emitter = eval::emitter_of(scene.lights[0]);
  ASSERT_TRUE(emitter.ok());
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    const double expected = pixel_mean(scene.cameras[0], options, i, [&](const Vec3d& p) {
      return 0.5 / pi * eval::illuminance(*emitter, p, {0, 1, 0}).y;
    });
    // Pixels are as large as a tenth of the light's height: 4e-5 leaves room for the quadratures' fourth derivatives.
    ASSERT_NEAR(green(out.picture, "", i), expected, 4e-5 * expected) << i;
  }
}

// The sun low over metal: a highlight whose flanks bend one way and then the other, in pixels between which light is interpolated. Where
// the second derivative alone was asked, at the turning point, single pixels were 3 to 5 % off.
TEST(Render, HighlightsFlanksAreInterpolatedToTheTolerance) {
  Scene scene = floor_scene();
  scene.materials.push_back({});
  scene.materials[0].model = conductor_from_f0({0.9, 0.7, 0.4}, 0.1);
  scene.objects[0].material = 0;
  scene.cameras[0] = look_at({2.6, 0.9, 0.4}, {0, 0, 0}, 42 * pi / 180);
  const eval::DistantEmitter sun{normalised(Vec3d{-1, 0.12, -0.2}), {5e4, 5e4, 5e4}, 0.265 * pi / 180};
  const Vec3d x = normalised(cross(Vec3d{0, 1, 0}, sun.towards));
  Light light;
  light.shape = DistantShape{2 * sun.radius_rad};
  light.transform = {{x, cross(sun.towards, x), sun.towards}, {}};
  light.emission.given = Emission::Given::illuminance;
  light.emission.value = 5e4;
  scene.lights.push_back(light);
  constexpr std::uint32_t side = 96;
  const RenderOptions options = small(side, side);
  const Rendered out = rendered(scene, options);
  const Result<eval::Emitter> emitter = eval::emitter_of(scene.lights[0]);
  ASSERT_TRUE(emitter.ok());
  int seen = 0;
  for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
    const std::size_t column = i % side, row = i / side;
    const Vec3d middle = floor_point(scene.cameras[0], options, static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    constexpr double far = 6;  // towards the horizon a pixel sees too much for one rule
    if (4 * row < side || length(middle) > far) continue;
    const double expected = pixel_mean(scene.cameras[0], options, i, [&](const Vec3d& p) {
      const eval::ShadingPoint point{
          p, {0, 1, 0}, {0, 1, 0}, normalised(scene.cameras[0].transform.translation - p), std::get<Conductor>(scene.materials[0].model)};
      return eval::reference(*emitter, point, {1e-6, 0}).value.y;
    });
    // The rule of 3 x 3 over a pixel of the steepest flank, whose sixth derivatives are left, is within 1e-4.
    ASSERT_NEAR(green(out.picture, "", i), expected, 1e-3 * expected) << column << ' ' << row;
    ++seen;
  }
  EXPECT_GT(seen, 4000);
}

// Where a disk's plane meets a metal floor its light fades to nothing, in pixels of which often only a corner is lit.
TEST(Render, PixelsThatTheLightsOwnPlaneCutsAreIntegratedUpToTheKink) {
  Scene scene = floor_scene();
  scene.materials.push_back({});
  scene.materials[0].model = conductor_from_f0({0.9, 0.7, 0.4}, 0.3);
  scene.objects[0].material = 0;
  const Vec3d emits = normalised(Vec3d{-1, -0.4, 0.1}), centre{0.6, 0.3, 0};
  const Vec3d x = normalised(cross(Vec3d{0, 1, 0}, emits));
  scene.lights.push_back(with_luminance(DiskShape{0.2}, 1000, {{x, cross(x, emits), -emits}, centre}));
  scene.lights[0].visible = false;
  const RenderOptions options = small();
  const Rendered out = rendered(scene, options);
  const Result<eval::Emitter> emitter = eval::emitter_of(scene.lights[0]);
  ASSERT_TRUE(emitter.ok());
  constexpr int side = 64;
  int cut = 0;
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    const std::size_t column = i % 24, row = i / 24;
    const auto place = [&](double u, double v) {
      return floor_point(scene.cameras[0], options, static_cast<double>(column) + u, static_cast<double>(row) + v);
    };
    const auto faces = [&](const Vec3d& p) { return dot(p - centre, emits) > 0; };
    int corners = 0;
    for (const double u : {0.0, 1.0}) corners += (faces(place(u, 0)) ? 1 : 0) + (faces(place(u, 1)) ? 1 : 0);
    if (corners == 0 || corners == 4) continue;
    double sum = 0, lit = 0;
    for (int k = 0; k < side * side; ++k) {
      const int across = k % side, down = k / side;
      const Vec3d p = place((across + 0.5) / side, (down + 0.5) / side);
      if (!faces(p)) continue;
      const eval::ShadingPoint point{
          p, {0, 1, 0}, {0, 1, 0}, normalised(scene.cameras[0].transform.translation - p), std::get<Conductor>(scene.materials[0].model)};
      sum += eval::reference(*emitter, point, {1e-5, 0}).value.y;
      lit += 1;
    }
    if (lit < 8) continue;
    // Light grows with the distance h from the kink. Over a lit corner of the length s, side^2 s^2 / 2 = lit midpoints in all, the integral
    // of h is off by about 1 / (side s)^2 = 1 / (2 lit) of it. Besides, pixels are a third of the way to the light: .5 % for the
    // quadrature. (One place a region was 2 to 10 % off.)
    const double expected = sum / (side * side);
    EXPECT_NEAR(green(out.picture, "", i), expected, (5e-3 + 1 / lit) * expected) << i;
    ++cut;
  }
  EXPECT_GT(cut, 20);
}

// A sphere of angular radius a on the axis of the picture fills a circle of radius tan a on the plane at distance 1.
TEST(Render, AVisibleSphereLightHasItsLuminanceAndItsSize) {
  Scene scene;
  scene.cameras.push_back(look_at({0, 0, 3}, {0, 0, 0}, 0.6));
  scene.lights.push_back(with_luminance(SphereShape{0.5}, 700));
  const RenderOptions options = small(32, 32);
  const Rendered out = rendered(scene, options);
  double sum = 0;
  for (std::size_t i = 0; i < std::size_t{32} * 32; ++i) sum += static_cast<double>(green(out.picture, "", i));
  const double side = 2 * std::tan(0.3) / 32, tangent = std::tan(std::asin(0.5 / 3));
  // 60 pixels on the rim, each within .02 noise = 2e-4 of its area: 2e-4 sqrt(60) / 314 at random, 4e-5 if all err alike.
  EXPECT_NEAR(sum * side * side, 700 * pi * tangent * tangent, 1e-4 * 700 * pi * tangent * tangent);
  EXPECT_FLOAT_EQ(green(out.picture, "", 16 * 32 + 16), 700);
  EXPECT_EQ(out.picture.find("emitter")->pixels[16 * 32 + 16], 1);
  EXPECT_EQ(out.picture.find("emitter")->pixels[0], 0);
  EXPECT_EQ(out.picture.find("object")->pixels[16 * 32 + 16], -1);
}

// A half-plane at half the height of a rectangular light hides the light's part x < -p of a point at x = p.
struct Penumbra {
  Scene scene = floor_scene();
  Penumbra() {
    scene.lights.push_back(with_luminance(RectShape{1, 1}, 1000, facing_down({0, 2, 0})));
    scene.lights[0].visible = false;
    scene.objects.push_back(object(PlaneGeometry{40}, at({-20, 1, 0})));
    scene.cameras[0] = look_at({0.9, 0.8, 0.5}, {0.2, 0, 0}, 0.9);
  }
  static double expected(const Vec3d& p) {
    const double left = std::clamp(-p.x, -0.5, 0.5);
    if (left >= 0.5) return 0;
    const Light seen = with_luminance(RectShape{0.5 - left, 1}, 1000, facing_down({(left + 0.5) / 2, 2, 0}));
    return 0.5 / pi * eval::illuminance(*eval::emitter_of(seen), p, {0, 1, 0}).y;
  }
};

TEST(Render, PenumbraOfAHalfPlaneIsTheVisiblePartOfTheLight) {
  const Penumbra penumbra;
  RenderOptions options = small(20, 20);
  options.expected_noise = 0.05;
  const Rendered out = rendered(penumbra.scene, options);
  double ours = 0, theirs = 0, variance = 0, squares = 0;
  int mixed = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    if (out.picture.find("object")->pixels[i] != 1) continue;
    const double expected = pixel_mean(penumbra.scene.cameras[0], options, i, Penumbra::expected);
    const double value = green(out.picture, "", i), v = green(out.picture, "variance", i);
    ours += value, theirs += expected, variance += v;
    squares += (value - expected) * (value - expected);
    if (v > 0) ++mixed;
  }
  ASSERT_GT(mixed, 50);
  EXPECT_NEAR(ours, theirs, 4 * std::sqrt(variance) + 1e-4 * theirs);
  EXPECT_LT(std::sqrt(variance), 0.002 * theirs);
  // The sum of squared errors is what the variances sum to; with some 100 pixels of unequal variance up to a third off by chance.
  EXPECT_GT(squares, 0.5 * variance);
  EXPECT_LT(squares, 2 * variance);
}

// Mean of d^2 / v of two seeds, and sum of d^2 over sum of v.
struct Honesty {
  double mean_of_quotients, quotient_of_means;
};
Honesty honesty(Shadows shadows) {
  const Penumbra penumbra;
  RenderOptions options = small();
  options.expected_noise = 0.05;
  options.shadows = shadows;
  const Rendered a = rendered(penumbra.scene, options);
  options.seed = 2;
  const Rendered b = rendered(penumbra.scene, options);
  double chi2 = 0, squares = 0, variance = 0;
  int count = 0;
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    const double v = green(a.picture, "variance", i) + green(b.picture, "variance", i);
    if (v <= 0) continue;
    const double d = green(a.picture, "", i) - green(b.picture, "", i);
    chi2 += d * d / v;
    squares += d * d, variance += v;
    ++count;
  }
  EXPECT_GT(count, 100);
  return {chi2 / count, squares / variance};
}
TEST(Render, TwoSeedsDifferByWhatTheVarianceSays) {
  // 14 degrees of freedom: mean 14/12 = 1.17.
  const double chi2 = honesty(Shadows::unbiased).mean_of_quotients;
  EXPECT_GT(chi2, 0.7);
  EXPECT_LT(chi2, 2.0);
}
// Where nothing is blocked among what may be, a ratio is exactly 1 and its variance that of its neighbours: too much there, as much too
// little in the neighbours, right in the sum.
TEST(Render, TwoSeedsOfARatioDifferByWhatTheVarianceSays) {
  const double chi2 = honesty(Shadows::ratio).quotient_of_means;
  EXPECT_GT(chi2, 0.7);
  EXPECT_LT(chi2, 1.4);
}

TEST(Render, ARatioOfShadowsStaysBetweenDarknessAndTheUnblockedLight) {
  const Penumbra penumbra;
  RenderOptions options = small();
  options.shadow_samples = 8;
  Scene open = penumbra.scene;
  open.objects.resize(1);
  const Rendered unblocked = rendered(open, options), unbiased = rendered(penumbra.scene, options);
  options.shadows = Shadows::ratio;
  const Rendered ratio = rendered(penumbra.scene, options);
  const auto floor = [&](const Rendered& r, std::size_t i) { return r.picture.find("object")->pixels[i] == 1; };
  int outside = 0, between = 0;
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    if (!floor(ratio, i) || ratio.picture.find("emitter")->pixels[i] != 0) continue;
    const float all = green(unblocked.picture, "", i), part = green(ratio.picture, "", i);
    EXPECT_GE(part, 0) << i;
    EXPECT_LE(part, all * 1.0001f) << i;
    between += part > 0 && part < 0.999f * all ? 1 : 0;
    outside += green(unbiased.picture, "", i) < -0.001f * all || green(unbiased.picture, "", i) > 1.001f * all ? 1 : 0;
  }
  EXPECT_GT(between, 30);
  EXPECT_GT(outside, 0);
}

// The bias is Cov(w, R w - V w) / (n mean(w)^2) to first order. The form without bias differs from the same samples by little more than
// that, so that few pictures show it beside the noise.
TEST(Render, ARatioOfShadowsIsDarkerTheFewerItsSamples) {
  const Penumbra penumbra;
  const auto bias = [&](std::uint32_t samples, std::uint64_t seeds) {
    RenderOptions options = small(12, 12);
    options.shadow_samples = samples;
    double of_ratio = 0, unbiased = 0;
    for (options.seed = 1; options.seed <= seeds; ++options.seed) {
      for (const Shadows shadows : {Shadows::unbiased, Shadows::ratio}) {
        options.shadows = shadows;
        const Picture picture = rendered(penumbra.scene, options).picture;
        for (std::size_t i = 0; i < 144; ++i) {
          if (picture.find("object")->pixels[i] == 1) (shadows == Shadows::ratio ? of_ratio : unbiased) += green(picture, "", i);
        }
      }
    }
    return of_ratio / unbiased - 1;
  };
  const double two = bias(2, 24);
  EXPECT_LT(two, -4e-4);
  EXPECT_GT(two, -2e-3);
  EXPECT_LT(std::abs(bias(256, 4)), 5e-5);
}

// Something small close to a light takes 2 % of it from the whole floor: of 32 samples a pixel half the pixels see none blocked. Meaned
// over neighbours the variances still say how far the picture is from the closed form, the light's illuminance less that of a light in the
// small thing's place; each pixel's own would be some hundred times too small where nothing was blocked.
TEST(Render, VarianceIsHonestWhereLittleIsBlocked) {
  Scene scene = floor_scene();
  constexpr double side = 0.1, below = 0.05;
  scene.lights.push_back(with_luminance(RectShape{1, 0.5}, 1000, facing_down({0, 1.5, 0})));
  scene.lights[0].visible = false;
  scene.objects.push_back(object(PlaneGeometry{side}, at({0.1, 1.5 - below, 0})));
  RenderOptions options = small();
  options.expected_noise = 0.2;
  const Rendered out = rendered(scene, options);
  const Result<eval::Emitter> all = eval::emitter_of(scene.lights[0]);
  const Result<eval::Emitter> blocked = eval::emitter_of(with_luminance(RectShape{side, side}, 1000, facing_down({0.1, 1.5 - below, 0})));
  ASSERT_TRUE(all.ok() && blocked.ok());
  double chi2 = 0;
  int count = 0;
  for (std::size_t i = std::size_t{24} * 6; i < std::size_t{24} * 24; ++i) {  // below the small thing's own picture
    const double expected = pixel_mean(scene.cameras[0], options, i, [&](const Vec3d& p) {
      return 0.5 / pi * (eval::illuminance(*all, p, {0, 1, 0}).y - eval::illuminance(*blocked, p, {0, 1, 0}).y);
    });
    const double error = green(out.picture, "", i) - expected;
    const double reference = std::pow(0.01 * expected, 2);
    chi2 += (error * error + reference) / (static_cast<double>(green(out.picture, "variance", i)) + reference);
    ++count;
  }
  ASSERT_GT(count, 300);
  EXPECT_NEAR(chi2 / count, 1, 0.2);  // four seeds: .96 to 1.05; with variances of single pixels 3.06
}

TEST(Render, LayersOfLightsAddUpAndDoNotDependOnThreads) {
  Scene scene = floor_scene();
  scene.lights.push_back(point_light(50, {1, 2, 0}));
  scene.lights.push_back(with_luminance(SphereShape{0.2}, 500, at({-0.4, 0.8, 0})));
  scene.lights[1].name = "ball.001";
  scene.objects.push_back(object(BoxGeometry{{0.3, 0.6, 0.3}}, at({0.3, 0.3, 0})));
  RenderOptions options = small();
  options.threads = 1;
  const Rendered one = rendered(scene, options);
  options.threads = 3;
  const Rendered three = rendered(scene, options);
  ASSERT_NE(one.picture.find("light.ball_001"), nullptr);
  for (std::size_t i = 0; i < std::size_t{24} * 24; ++i) {
    const float sum = green(one.picture, "light.point", i) + green(one.picture, "light.ball_001", i);
    ASSERT_NEAR(green(one.picture, "", i), sum, 1e-6 * sum);
    const float variance = green(one.picture, "light_variance.point", i) + green(one.picture, "light_variance.ball_001", i);
    ASSERT_NEAR(green(one.picture, "variance", i), variance, 1e-6 * variance);
  }
  for (const Layer& layer : one.picture.layers) EXPECT_EQ(layer.pixels, three.picture.find(layer.name)->pixels) << layer.name;
}

// The centre of the picture, straight below a point light, with a sphere light in between.
TEST(Render, ADarkLightIsStillThere) {
  Scene scene = floor_scene();
  scene.lights.push_back(point_light(100, {0, 3, 0}));
  scene.lights.push_back(with_luminance(SphereShape{0.3}, 500, at({0, 1.5, 0})));
  scene.cameras[0] = look_at({1.5, 1, 0}, {0, 0, 0}, 0.3);
  RenderOptions options = small(9, 9);
  options.lit = {0};
  const std::size_t centre = 4 * 9 + 4;
  const Rendered dark = rendered(scene, options);
  EXPECT_EQ(green(dark.picture, "", centre), 0);
  EXPECT_EQ(dark.picture.find("light.light"), nullptr);
  scene.lights[1].visible = false;
  EXPECT_NEAR(green(rendered(scene, options).picture, "", centre), 0.5 / pi * 100 / 9, 1e-3);
  options.mitsuba_model = true;  // which has no invisible lights
  EXPECT_EQ(green(rendered(scene, options).picture, "", centre), 0);
}

TEST(Render, BacksOfOneSidedSurfacesAreBlackAndHolesAreOpen) {
  Scene scene = floor_scene();
  scene.cameras[0] = look_at({0, -2, 0.5}, {0, 0, 0}, 0.3);
  scene.lights.push_back(point_light(100, {0, -1, 0}));
  scene.materials.push_back({});
  scene.materials[0].model = Lambert{};
  scene.objects[0].material = 0;
  const RenderOptions options = small(5, 5);
  EXPECT_NEAR(green(rendered(scene, options).picture, "", 12), 0.5 / pi * 100, 0.15);  // the pixel is .1 m wide
  scene.materials[0].double_sided = false;
  EXPECT_EQ(green(rendered(scene, options).picture, "", 12), 0);
  scene.materials[0].alpha_cutoff = 0.5;
  scene.materials[0].base_alpha = 0.4;
  const Rendered hole = rendered(scene, options);
  EXPECT_EQ(hole.picture.find("object")->pixels[12], 0);
}

// Uniform light from everywhere: a Lambert surface of albedo .5 shows half of it, whatever its direction.
TEST(Render, UniformEnvironment) {
  Scene scene = floor_scene();
  scene.objects[0] = object(SphereGeometry{0.8});
  scene.cameras[0] = look_at({0, 0, 4}, {0, 0, 0}, 0.6);
  scene.lights.push_back(with_luminance(EnvironmentShape{}, 80));
  RenderOptions options = small(15, 15);
  options.expected_noise = 0.05;
  const Rendered out = rendered(scene, options);
  EXPECT_FLOAT_EQ(green(out.picture, "", 0), 80);
  double sum = 0, variance = 0;
  int count = 0;
  for (std::size_t i = 0; i < std::size_t{15} * 15; ++i) {
    if (out.picture.find("emitter")->pixels[i] != 0) continue;
    sum += static_cast<double>(green(out.picture, "", i));
    variance += static_cast<double>(green(out.picture, "variance", i));
    ++count;
  }
  ASSERT_GT(count, 20);
  EXPECT_NEAR(sum / count, 40, 4 * std::sqrt(variance) / count + 1e-4);
  EXPECT_LT(std::sqrt(variance) / count, 0.2);
}

// A profile that bends sharply every 7.5 degrees, of which a pixel sees up to two bends: the mean over each pixel, against 16 x 16 pixels
// of a finer picture, is within what its variance says or 2.5e-4.
TEST(Render, KinksOfAProfileAreFoundWithinPixels) {
  Scene scene = floor_scene();
  const auto sawtooth = [](const Vec3d& u) { return std::lround(std::acos(-u.z) * 180 / pi / 7.5) % 2 == 0 ? 1000.0 : 1400.0; };
  Light light = point_light(1, {0.3, 1.5, -0.2});
  light.shape = PhotometricShape{"sawtooth.ies",
                                 {},
                                 std::make_shared<const IntensityDistribution>(
                                     test::distribution_of(WebType::c, WebSymmetry::rotational, test::steps(0, 90, 7.5), {0}, sawtooth))};
  light.emission.given = Emission::Given::as_file;
  light.transform = facing_down(light.transform.translation);
  scene.lights.push_back(light);
  constexpr std::size_t side = 40, parts = 16;
  const Rendered coarse = rendered(scene, small(side, side)), fine = rendered(scene, small(side * parts, side * parts));
  const std::vector<float>&means = coarse.picture.find("")->pixels, &variances = coarse.picture.find("variance")->pixels,
        &parts_of = fine.picture.find("")->pixels;
  int lit = 0;
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x) {
      double sum = 0;
      for (std::size_t j = 0; j < parts; ++j)
        for (std::size_t i = 0; i < parts; ++i) sum += static_cast<double>(parts_of[3 * ((y * parts + j) * side * parts + x * parts + i)]);
      const double expected = sum / (parts * parts);
      const std::size_t at = 3 * (y * side + x);
      const double off = std::abs(static_cast<double>(means[at]) - expected);
      EXPECT_LE(off, 4 * std::sqrt(static_cast<double>(variances[at])) + 2.5e-4 * expected) << x << ' ' << y;
      lit += expected > 0;
    }
  EXPECT_GT(lit, 1000);
}

// A black texel beside a white one.
std::filesystem::path black_and_white(const test::Folder& folder) {
  return folder.write("halves.ppm", "P6\n2 1\n255\n" + std::string("\0\0\0\xff\xff\xff", 6));
}

// One pixel over a floor of black and white halves: the mean of the texture.
TEST(Render, TexturesAreIntegratedOverThePixel) {
  const test::Folder folder;
  const auto file = black_and_white(folder);
  Scene scene = floor_scene();
  scene.images.push_back({file.string(), nullptr, "", "halves"});
  scene.materials.push_back({});
  scene.materials[0].model = Lambert{{1, 1, 1}};
  Texture texture;
  texture.nearest = true;
  texture.uv_transform[0][0] = 16;
  scene.materials[0].base_colour_texture = texture;
  scene.objects[0].material = 0;
  Light sun;
  sun.name = "sun";
  sun.shape = DistantShape{};
  sun.emission.given = Emission::Given::illuminance;
  sun.emission.value = pi;
  sun.transform = facing_down({0, 0, 0});
  scene.lights.push_back(sun);
  const Rendered out = rendered(scene, small(8, 8));
  double sum = 0, variance = 0;
  for (std::size_t i = 0; i < 64; ++i)
    sum += static_cast<double>(green(out.picture, "", i)), variance += static_cast<double>(green(out.picture, "variance", i));
  EXPECT_EQ(out.stats.images_decoded, 1u);
  // The frame's sides are not whole periods: half a period of 1.25 m over 2.5 m at the most, though stripes and frame are both symmetric.
  EXPECT_NEAR(sum / 64, 0.5, 0.1);
  EXPECT_GT(variance, 0);
}

// A glossy floor whose colour is a triangle wave of about three pixels, under a rectangle: the mean over the pixel of light times colour,
// against 16 x 16 places evaluated one by one (whose own error, (1/16)^2 / 24 of the wave's slope per pixel, is below 2e-4).
TEST(Render, ATexturesColoursAreMeanedWithTheExactLight) {
  const test::Folder folder;
  const auto file = black_and_white(folder);
  Scene scene = floor_scene();
  scene.images.push_back({file.string(), nullptr, "", "wave"});
  scene.materials.push_back({});
  scene.materials[0].model = Principled{{0.9, 0.6, 0.3}, 0.2, 0.6, 0.5};
  Texture texture;
  constexpr double periods = 60;  // of 20 m
  texture.uv_transform[0][0] = periods;
  scene.materials[0].base_colour_texture = texture;
  scene.objects[0].material = 0;
  scene.lights.push_back(with_luminance(RectShape{1, 0.5}, 1000, facing_down({0.2, 1.5, 0})));
  scene.lights[0].visible = false;
  RenderOptions options = small();
  options.expected_noise = 0.05;
  const Rendered out = rendered(scene, options);
  const Result<eval::Emitter> emitter = eval::emitter_of(scene.lights[0]);
  ASSERT_TRUE(emitter.ok());
  double chi2 = 0;
  int pixels = 0;
  for (std::size_t i = 5; i < std::size_t{24} * 24; i += 23, ++pixels) {
    constexpr int side = 16;
    double expected = 0;
    for (int k = 0; k < side * side; ++k) {
      const double x = static_cast<double>(i % 24) + (k % side + 0.5) / side;
      const std::size_t row = i / 24;
      const int j = k / side;
      const double y = static_cast<double>(row) + (j + 0.5) / side;
      const Vec3d p = floor_point(scene.cameras[0], options, x, y);
      const double phase = p.x / 20 * periods, t = phase - std::floor(phase);  // 0 in the middle of the floor, halfway between texels
      const double wave = 1 - std::abs(2 * std::abs(t - 0.25) - 1);
      Principled model = std::get<Principled>(scene.materials[0].model);
      model.base_colour *= std::clamp(wave, 0.0, 1.0);
      const eval::ShadingPoint point{p, {0, 1, 0}, {0, 1, 0}, normalised(scene.cameras[0].transform.translation - p), model};
      expected += eval::reference(*emitter, point, {1e-5, 0}).value.y / (side * side);
    }
    const double error = green(out.picture, "", i) - expected, variance = static_cast<double>(green(out.picture, "variance", i));
    // 288 places, the most, over a wave that deviates by .58 of its mean: independent ones would leave .034.
    EXPECT_LT(std::sqrt(variance), 0.034 * expected) << i;
    chi2 += error * error / variance;
  }
  // Each of the pairs' variances has 18 to 288 degrees of freedom: the mean of 1 deviates by about sqrt(2 / pixels) = .28.
  EXPECT_LT(chi2 / pixels, 2);
  EXPECT_GT(chi2 / pixels, 0.3);
}

// A quad facing +Z whose texture is black on the left and white on the right.
TEST(Render, AMeshLightShowsItsTextureAtItsTextureCoordinates) {
  const test::Folder folder;
  const auto file = black_and_white(folder);
  Scene scene;
  scene.images.push_back({file.string(), nullptr, "", "halves"});
  Mesh quad;
  quad.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  quad.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(quad);
  scene.lights.push_back(with_luminance(MeshShape{0, {1, 1, 1}}, 300));
  Texture texture;
  texture.nearest = true;
  scene.lights[0].emission.texture = texture;
  scene.cameras.push_back(look_at({0, 0, 4}, {0, 0, 0}, 0.3));
  const Rendered out = rendered(scene, small(8, 8));
  for (std::size_t i = 0; i < 64; ++i) EXPECT_FLOAT_EQ(green(out.picture, "", i), i % 8 < 4 ? 0.0f : 300.0f) << i;
}

// Mitsuba's shadow rays start 1500 x 2^-24 = 9e-5 m above a surface near the origin: what is lower throws no shadow there.
TEST(Render, TheMitsubaModelLosesShadowsOfThingsThatAreLowerThanItsRaysStart) {
  Scene scene;
  scene.objects.push_back(object(PlaneGeometry{0.002}));
  scene.objects.push_back(object(BoxGeometry{{2e-4, 5e-5, 2e-4}}, at({0, 2.5e-5, 0})));
  scene.cameras.push_back(look_at({0, 0.002, 0.0005}, {0, 0, 0}, 0.3));
  Light sun;
  sun.name = "sun";
  sun.shape = DistantShape{};
  sun.emission.given = Emission::Given::illuminance;
  sun.emission.value = pi;
  const Vec3d towards = normalised(Vec3d{1, 0.4, 0});  // 22 degrees high: shadows are 1.25e-4 long
  sun.transform.columns = {Vec3d{0, 0, 1}, cross(towards, Vec3d{0, 0, 1}), towards};
  scene.lights.push_back(sun);
  const auto dark_floor = [&](bool mitsuba_model) {
    RenderOptions options = small();
    options.mitsuba_model = mitsuba_model;
    const Picture picture = rendered(scene, options).picture;
    const double lit = 0.5 * 0.4 / std::sqrt(1.16);
    int dark = 0;
    for (std::size_t i = 0; i < std::size_t{24} * 24; ++i)
      dark += picture.find("object")->pixels[i] == 1 && static_cast<double>(green(picture, "", i)) < 0.1 * lit ? 1 : 0;
    return dark;
  };
  EXPECT_GT(dark_floor(false), 20);
  EXPECT_EQ(dark_floor(true), 0);
}

struct Stop : Progress {
  int calls = 0;
  bool report(std::string_view, double fraction) override {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    return ++calls < 5;
  }
};
TEST(Render, CancelsAndRefuses) {
  Scene scene = floor_scene();
  scene.lights.push_back(point_light(100, {0, 1, 0}));
  Stop stop;
  const Result<Rendered> cancelled = render(scene, small(), &stop);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, "CANCELLED");
  RenderOptions options = small();
  options.camera = 1;
  EXPECT_EQ(render(scene, options).error().code, "CAMERA_MISSING");
  options.shadow_samples = 1;  // no spread to tell a variance from
  EXPECT_EQ(render(scene, options).error().code, "EVALUATION_UNSUPPORTED");
  scene.objects[0].material = 7;
  EXPECT_EQ(render(scene, small()).error().code, "SCENE_INVALID");
}

}  // namespace
}  // namespace etendue
