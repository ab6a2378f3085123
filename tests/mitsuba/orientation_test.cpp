// Which way round: exported markers against scenes written by hand, and against where things must be in the picture.
#include "fixture.h"

#include "etendue/io.h"
#include "etendue/picture.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace etendue::testing {
namespace {

// 4 x 4 texels, all dark but one: a colour for each corner.
std::string corner_picture() {
  Picture picture;
  picture.width = picture.height = 4;
  std::vector<float>& p = picture.add("", 3).pixels;
  const auto set = [&](std::size_t x, std::size_t y, std::size_t channel) { p[(y * 4 + x) * 3 + channel] = 1; };
  set(0, 0, 0), set(3, 0, 1), set(0, 3, 2);  // red top left, green top right, blue bottom left
  const std::filesystem::path file = scratch() / "corners.exr";
  EXPECT_TRUE(write_exr(picture, file).ok());
  return file.string();
}

// A camera on +Z looks at a light that shines towards it: the picture is upright and not mirrored.
void expect_upright(Light light, const std::string& name, int low, int high) {
  Scene scene;
  ImageRef image;
  image.file = corner_picture();
  scene.images.push_back(image);
  light.emission.texture = Texture{};
  light.emission.texture->wrap_u = light.emission.texture->wrap_v = Wrap::clamp;
  light.transform = aimed({0, 0, 0}, {0, 0, 1});
  scene.lights.push_back(light);
  scene.cameras.push_back(look_at({0, 0, 5}, {0, 0, 0}, 2 * std::atan(0.2)));  // sees 2 m
  const Picture picture = rendered(scene, name, 32, 16, 5);
  ASSERT_FALSE(picture.layers.empty());
  const auto x0 = static_cast<std::uint32_t>(low), x1 = static_cast<std::uint32_t>(high);
  const Rgb top_left = pixel(picture, x0, x0), top_right = pixel(picture, x1, x0), bottom_left = pixel(picture, x0, x1);
  EXPECT_GT(top_left.x, 100) << name;
  EXPECT_LT(top_left.y, 1) << name;
  EXPECT_GT(top_right.y, 100) << name;
  EXPECT_LT(top_right.x, 1) << name;
  EXPECT_GT(bottom_left.z, 100) << name;
  EXPECT_LT(length(pixel(picture, x1, x1)), 1) << name;
}

TEST(Orientation, TexturedLightsAreUpright) {
  ETENDUE_NEEDS_MITSUBA();
  expect_upright(light_of(RectShape{2, 2}), "rect", 3, 28);
  Light both = light_of(RectShape{2, 2});
  both.two_sided = true;
  expect_upright(both, "rect_both", 3, 28);
  expect_upright(light_of(PolygonShape{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}), "polygon", 3, 28);
  // Inside the circle, but still nearest to the corner texels.
  expect_upright(light_of(DiskShape{1}), "disk", 6, 25);
}

// A picture on a light, twice across and shifted, lights a wall as the same picture does when it is drawn out.
TEST(Orientation, TextureTransformsAreSampledRight) {
  ETENDUE_NEEDS_MITSUBA();
  Scene scene;
  ImageRef image;
  image.file = corner_picture();
  scene.images.push_back(image);
  Light light = light_of(RectShape{1, 1});
  light.transform = aimed({0, 0, 0}, {0, 0, 1});
  light.emission.texture = Texture{};
  scene.lights.push_back(light);
  Object wall;
  wall.geometry = PlaneGeometry{4};
  wall.transform = {{Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}}, {0, 0, 1}};
  scene.objects.push_back(wall);
  scene.cameras.push_back(look_at({0, 0, -4}, {0, 0, 0}, 0.6));
  const double once = mean_luminance(rendered(scene, "once", 16, 512)).value;
  // Two repetitions across and down have the same mean: at a distance of 1 m the light on the wall hardly changes.
  scene.lights[0].emission.texture->uv_transform[0][0] = 2;
  scene.lights[0].emission.texture->uv_transform[1][1] = 2;
  scene.lights[0].emission.texture->uv_transform[0][2] = -0.75;
  const Mean twice = mean_luminance(rendered(scene, "twice", 16, 512));
  EXPECT_NEAR(twice.value / once, 1, 0.05 + 4 * twice.standard_error / once);
}

// The hand-written scene uses Mitsuba's own conventions: no transform that the exporter could share.
Picture by_hand(const std::string& name, const std::string& emitter) {
  const std::filesystem::path file = scratch() / (name + ".xml");
  std::ofstream(file) << R"(<scene version="3.0.0"><default name="spp" value="1"/><default name="seed" value="0"/>
    <integrator type="path"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective"><float name="fov" value="45"/><string name="fov_axis" value="y"/>
      <transform name="to_world"><lookat origin="0, 4, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="32"/>
        <string name="pixel_format" value="rgb"/><string name="component_format" value="float32"/><rfilter type="box"/></film>
      <sampler type="independent"><integer name="sample_count" value="$spp"/><integer name="seed" value="$seed"/></sampler></sensor>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="2"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value=".5 .5 .5"/></bsdf></shape>)"
                      << emitter << "</scene>";
  std::vector<Picture> pictures = rendered({file}, 256);
  return pictures.empty() ? Picture{} : std::move(pictures[0]);
}

Scene floor_under(Light light) {
  Scene scene;
  Object floor;
  floor.geometry = PlaneGeometry{4};
  scene.objects.push_back(floor);
  scene.cameras.push_back(look_at({0, 4, 3}, {0, 0, 0}, 45 * pi / 180));
  scene.lights.push_back(std::move(light));
  return scene;
}

// Every pixel within 5 standard errors of the difference and `slack` of the brightest.
void expect_equal(const Picture& a, const Picture& b, double slack) {
  ASSERT_FALSE(a.layers.empty() || b.layers.empty());
  const auto &pa = a.find("")->pixels, &pb = b.find("")->pixels, &va = a.find("variance")->pixels, &vb = b.find("variance")->pixels;
  const double brightest = *std::max_element(pa.begin(), pa.end());
  ASSERT_GT(brightest, 0);
  int bad = 0;
  for (std::size_t i = 0; i < pa.size(); ++i) {
    bad += std::abs(pa[i] - pb[i]) > 6 * std::sqrt(va[i] + vb[i]) + slack * brightest ? 1 : 0;
  }
  EXPECT_EQ(bad, 0) << "of " << pa.size() << ", brightest " << brightest;
}

TEST(Orientation, SpotAimedAside) {
  ETENDUE_NEEDS_MITSUBA();
  Light light = light_of(SpotShape{0.3, 0.3});
  light.transform = aimed({-0.5, 2, 0.5}, {0.5, -2, -1});
  const Picture ours = rendered(floor_under(light), "spot_aside", 32, 256);
  const Picture hand = by_hand("spot_hand", R"(<emitter type="spot"><rgb name="intensity" value="1000 1000 1000"/>
      <float name="cutoff_angle" value="17.188733853924695"/><float name="beam_width" value="17.18873"/>
      <transform name="to_world"><lookat origin="-0.5, 2, 0.5" target="0, 0, -0.5" up="0, 1, 0"/></transform></emitter>)");
  expect_equal(ours, hand, 1e-3);
}

TEST(Orientation, FrustumIsWideAlongX) {
  ETENDUE_NEEDS_MITSUBA();
  Light light = light_of(FrustumShape{1.0, 0.4});
  light.transform = aimed({0, 2, 0}, {0, -1, 0});  // its X along the world's
  const Picture picture = rendered(floor_under(light), "frustum_wide", 32, 64);
  ASSERT_FALSE(picture.layers.empty());
  // On the floor it covers 2 tan .5 = 1.09 m to either side along X and .41 m along Z; the camera, 5 m away, sees 4.1 m across.
  EXPECT_GT(length(pixel(picture, 16 + 6, 16)), 0);
  EXPECT_GT(length(pixel(picture, 16 - 7, 16)), 0);
  EXPECT_EQ(length(pixel(picture, 16, 16 + 6)), 0);
  EXPECT_EQ(length(pixel(picture, 16, 16 - 6)), 0);
}

// One bright texel of 16 x 8 at column 4, row 2: u = 4.5 / 16, v = 2.5 / 8, so theta = 56.25 deg from +Y, and in Mitsuba's convention
// (facts in the page on Mitsuba) x = sin theta sin phi, z = -sin theta cos phi with phi = 2 pi u. A directional light from there has the
// same centre.
TEST(Orientation, EnvironmentTexel) {
  ETENDUE_NEEDS_MITSUBA();
  Picture map;
  map.width = 16, map.height = 8;
  std::vector<float>& texels = map.add("", 3).pixels;
  for (std::size_t c = 0; c < 3; ++c) texels[std::size_t{2 * 16 + 4} * 3 + c] = 100;
  ASSERT_TRUE(write_exr(map, scratch() / "texel.exr").ok());
  Light sky = light_of(EnvironmentShape{0});
  sky.emission.given = Emission::Given::as_file;
  Scene scene = floor_under(sky);
  ImageRef image;
  image.file = (scratch() / "texel.exr").string();
  scene.images.push_back(image);
  // A pole on the floor: its shadow points away from the texel.
  Object pole;
  pole.geometry = BoxGeometry{{0.1, 1, 0.1}};
  pole.transform.translation = {0, 0.5, 0};
  scene.objects.push_back(pole);
  const Picture ours = rendered(scene, "texel", 32, 512);

  // The same map by hand on Mitsuba's rows: 17 of them on theta = pi r / 16, the bright row's centre on r = 5, half of it on r = 4 and 6.
  Picture rows;
  rows.width = 16, rows.height = 17;
  std::vector<float>& values = rows.add("", 3).pixels;
  for (std::size_t r = 4; r <= 6; ++r) {
    for (std::size_t c = 0; c < 3; ++c) values[(r * 16 + 4) * 3 + c] = r == 5 ? 100 : 50;
  }
  ASSERT_TRUE(write_exr(rows, scratch() / "rows.exr").ok());
  const Picture hand = by_hand("texel_hand", R"(<emitter type="envmap"><string name="filename" value="rows.exr"/></emitter>
      <shape type="cube"><transform name="to_world"><scale x=".05" y=".5" z=".05"/><translate y=".5"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value=".5 .5 .5"/></bsdf></shape>)");
  expect_equal(ours, hand, 1e-3);

  // And where the shadow lies, from the formula alone: the light comes from +X (sin phi > 0) and +Z (cos phi < 0), so it falls towards
  // -X and away from the camera.
  const double left = length(pixel(ours, 16 - 4, 16 - 1)), right = length(pixel(ours, 16 + 4, 16 - 1));
  EXPECT_LT(left, 0.8 * right);
}

TEST(Orientation, EnvironmentTurnsWithItsTransform) {
  ETENDUE_NEEDS_MITSUBA();
  // A sky that is bright on one side, turned by 90 deg about Y: +Z of the map comes to lie on +X, which a wall facing +X sees.
  Picture map;
  map.width = 16, map.height = 8;
  std::vector<float>& texels = map.add("", 3).pixels;
  for (std::size_t y = 3; y < 5; ++y) {
    for (std::size_t x = 7; x < 9; ++x) {
      for (std::size_t c = 0; c < 3; ++c) texels[(y * 16 + x) * 3 + c] = 100;
    }
  }
  ASSERT_TRUE(write_exr(map, scratch() / "side.exr").ok());
  Light sky = light_of(EnvironmentShape{0});
  sky.emission.given = Emission::Given::as_file;
  sky.transform = {{Vec3d{0, 0, -1}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}, {}};
  Scene scene;
  scene.lights.push_back(sky);
  ImageRef image;
  image.file = (scratch() / "side.exr").string();
  scene.images.push_back(image);
  Object ball;
  ball.geometry = SphereGeometry{0.5};
  scene.objects.push_back(ball);
  scene.cameras.push_back(look_at({0, 0, 3}, {0, 0, 0}, 0.4));
  const Picture picture = rendered(scene, "side", 16, 256);
  ASSERT_FALSE(picture.layers.empty());
  EXPECT_GT(length(pixel(picture, 13, 8)), 10 * length(pixel(picture, 2, 8)) + 0.1);  // +X is right
}

}  // namespace
}  // namespace etendue::testing
