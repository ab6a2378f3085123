// glTF's lobes as the real Mitsuba shows them: each against a closed form of what the extension asks for, or of what the loss report says.
#include "fixture.h"

#include "etendue/picture.h"
#include "exporters/mitsuba/lobe_fits.h"

#include <cmath>

namespace etendue::testing {
namespace {

constexpr double environment_luminance = 1000;

Material surface(double roughness, const Rgb& base_colour, double metallic = 0) {
  Material m;
  m.name = "tried";
  m.model = MetalRough{base_colour, metallic, roughness, 1.5};
  return m;
}

// A unit square in XY that faces +Z, u along X and v downwards, seen from above under an angle of .001: all directions of view are the
// normal.
Scene square(const Material& material) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(mesh);
  scene.materials.push_back(material);
  Object object;
  object.geometry = MeshGeometry{0};
  object.material = 0;
  scene.objects.push_back(object);
  scene.cameras.push_back(look_at({0, 0, 10}, {0, 0, 0}, 0.001));
  return scene;
}

// Illuminance 1000 pi lx on a plane across its direction.
void add_distant(Scene& scene, const Vec3d& direction) {
  Light sun = light_of(DistantShape{0});
  sun.emission.value = 1000 * pi;
  sun.transform = aimed({0, 0, 0}, direction);
  scene.lights.push_back(sun);
}

void add_environment(Scene& scene) {
  Light sky = light_of(EnvironmentShape{});
  sky.emission.value = environment_luminance;
  scene.lights.push_back(sky);
}

Rgb seen(const Scene& scene, const std::string& name, std::uint32_t samples = 64, int max_depth = 8) {
  ExportOptions options;
  options.width = options.height = 8;
  options.max_depth = max_depth;
  const auto written =
      make_mitsuba_exporter(MitsubaParts::built_in, MitsubaLobes::as_far_as_can_be)->write(scene, scratch() / (name + ".xml"), options);
  EXPECT_TRUE(written.ok());
  if (!written.ok()) return {};
  const std::vector<Picture> pictures = rendered({scratch() / (name + ".xml")}, samples);
  if (pictures.size() != 1) return {};
  Rgb sum;
  for (std::uint32_t y = 0; y < 8; ++y)
    for (std::uint32_t x = 0; x < 8; ++x) sum += pixel(pictures[0], x, y) / 64.0;
  return sum;
}

// GGX with alpha_x, alpha_y in the direction h: 1 / (pi ax ay (x^2 / ax^2 + y^2 / ay^2 + z^2)^2).
double ggx(double ax, double ay, const Vec3d& h) {
  const double sum = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
  return 1 / (pi * ax * ay * sum * sum);
}

// A white metal seen along its normal has D G1(light) / (4 cos(light)), and cos(light) E falls on it.
TEST(Lobes, AnisotropyLiesAlongU) {
  ETENDUE_NEEDS_MITSUBA();
  const double alpha = 0.25, strength = 0.5, along = alpha + (1 - alpha) * strength * strength;
  for (const int quarter_turns : {0, 1}) {
    for (const bool light_along_u : {true, false}) {
      Material m = surface(0.5, {1, 1, 1}, 1);
      m.lobes.anisotropy = Anisotropy{strength, quarter_turns * pi / 2, {}};
      Scene scene = square(m);
      const double tilt = 0.9;
      add_distant(scene, light_along_u ? Vec3d{-std::sin(tilt), 0, -std::cos(tilt)} : Vec3d{0, -std::sin(tilt), -std::cos(tilt)});
      const double ax = quarter_turns == 0 ? along : alpha, ay = quarter_turns == 0 ? alpha : along;
      const Vec3d h{light_along_u ? std::sin(tilt / 2) : 0, light_along_u ? 0 : std::sin(tilt / 2), std::cos(tilt / 2)};
      const double lateral = (light_along_u ? ax : ay) * std::tan(tilt);
      const double g1 = 2 / (1 + std::sqrt(1 + lateral * lateral));
      // Float32 and directions of view that are .0005 off: some 1e-4.
      EXPECT_NEAR(seen(scene, "anisotropy").y / (1000 * pi * ggx(ax, ay, h) * g1 / 4), 1, 1e-3) << quarter_turns << light_along_u;
    }
  }
}

// Black, lit along the normal: E F0 D / 4 with D = 1 / (pi alpha^2).
TEST(Lobes, SpecularIsTheDielectricsF0) {
  ETENDUE_NEEDS_MITSUBA();
  for (const double factor : {0.25, 0.5, 1.0}) {
    Material m = surface(0.6, {0, 0, 0});
    m.lobes.specular = Specular{factor, {1, 1, 1}, {}, {}};
    Scene scene = square(m);
    add_distant(scene, {0, 0, -1});
    EXPECT_NEAR(seen(scene, "specular").y / (1000 * 0.04 * factor / (4 * 0.36 * 0.36)), 1, 1e-3) << factor;
  }
}

// The coat adds E c .04 / (4 pi alpha^2) there, as the extension's GGX does.
TEST(Lobes, ClearcoatIsRightFromAhead) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(1, {0, 0, 0});
  Scene bare = square(m);
  add_distant(bare, {0, 0, -1});
  const double without = seen(bare, "uncoated").y;
  for (const double roughness : {0.2, 0.4}) {
    m.lobes.clearcoat = Clearcoat{};
    m.lobes.clearcoat->factor = 0.7;
    m.lobes.clearcoat->roughness = roughness;
    Scene scene = square(m);
    add_distant(scene, {0, 0, -1});
    // Directions of view .0005 off are a part of 1e-3 of the narrower peak.
    EXPECT_NEAR((seen(scene, "coated").y - without) / (1000 * 0.7 * 0.04 / (4 * std::pow(roughness, 4))), 1, 4e-3) << roughness;
  }
}

// What of a white sky's light the coat reflects, over all views, is what the loss report says.
TEST(Lobes, ClearcoatsShareOfASky) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(1, {0, 0, 0});
  m.lobes.clearcoat = Clearcoat{};
  m.lobes.clearcoat->factor = 1;
  m.lobes.clearcoat->roughness = 0.3;
  double with = 0, without = 0;
  // 2 integral of albedo(c) c dc by Gauss and Legendre's rule of three: exact to the fifth degree.
  const double places[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)}, weights[] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
  for (int i = 0; i < 3; ++i) {
    const double c = places[i];
    for (const bool coated : {true, false}) {
      Material tried = m;
      if (!coated) tried.lobes.clearcoat.reset();
      Scene scene = square(tried);
      scene.cameras[0] = look_at({10 * std::sqrt(1 - c * c), 0, 10 * c}, {0, 0, 0}, 0.001);
      add_environment(scene);
      (coated ? with : without) += weights[i] * 2 * c * seen(scene, "sky", 4096).y / environment_luminance;
    }
  }
  // Schlick's fifth power times c^3 is beyond that degree; the rest's 5 % covers it.
  EXPECT_NEAR((with - without) / mitsuba::principled_coat_albedo(mitsuba::coat_width(0.09)), 1, 0.05);
}

// All that a thin wall gets from a sky of 1000 cd/m2: F0 of it back, and the rest through it, tinted once. Half of it passing, black: F0.
TEST(Lobes, ThinTransmissionSharesALight) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(0.1, {0.5, 1, 0.25});
  m.lobes.transmission = Transmission{1, {}};
  Scene clear = square(m);
  add_environment(clear);
  const Rgb through = seen(clear, "pane", 1024);
  EXPECT_NEAR(through.x, 1000 * (0.04 + 0.96 * 0.5), 3);
  EXPECT_NEAR(through.y, 1000, 3);
  EXPECT_NEAR(through.z, 1000 * (0.04 + 0.96 * 0.25), 3);
  std::get<MetalRough>(m.model).base_colour = {0, 0, 0};
  m.lobes.transmission->factor = 0.5;
  Scene half = square(m);
  add_environment(half);
  EXPECT_NEAR(seen(half, "half_pane", 4096).y, 40, 1);
}

// One texel whose red is .25: a quarter of the factor, of the coat as of the weight of a blend.
TEST(Lobes, TexturesMultiplyFactors) {
  ETENDUE_NEEDS_MITSUBA();
  Picture texel;
  texel.width = texel.height = 1;
  texel.add("", 3).pixels = {0.25f, 1, 1};
  ASSERT_TRUE(write_exr(texel, scratch() / "texel.exr").ok());
  ImageRef image;
  image.file = (scratch() / "texel.exr").string();
  const Texture quarter;

  const auto coated = [&](double factor, bool textured) {
    Material m = surface(1, {0, 0, 0});
    m.lobes.clearcoat = Clearcoat{};
    m.lobes.clearcoat->factor = factor;
    m.lobes.clearcoat->roughness = 0.4;
    if (textured) m.lobes.clearcoat->factor_texture = quarter;
    Scene scene = square(m);
    scene.images.push_back(image);
    add_distant(scene, {0, 0, -1});
    return seen(scene, "coat").y;
  };
  const double none = coated(0, false), all = coated(1, false);
  EXPECT_NEAR((coated(1, true) - none) / (all - none), 0.25, 1e-4);

  const auto pane = [&](double factor, bool textured) {
    Material m = surface(0.3, {0.5, 0.5, 0.5});
    m.lobes.transmission = Transmission{factor, {}};
    if (textured) m.lobes.transmission->factor_texture = quarter;
    Scene scene = square(m);
    scene.images.push_back(image);
    add_distant(scene, {0, 0, -1});
    return seen(scene, "pane").y;
  };
  // What is reflected diffusely goes down with what passes.
  const double opaque = pane(0, false), clear = pane(1, false);
  EXPECT_LT(clear, 0.95 * opaque);
  EXPECT_NEAR((opaque - pane(1, true)) / (opaque - clear), 0.25, 1e-3);
}

// Lambert's law on the other side: E f colour / pi.
TEST(Lobes, DiffuseTransmission) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(0.5, {0.3, 0.3, 0.3});
  m.lobes.diffuse_transmission = DiffuseTransmission{0.75, {0.8, 0.4, 0.2}, {}, {}};
  Scene scene = square(m);
  add_distant(scene, {0, 0, 1});
  const Rgb light = seen(scene, "paper");
  // `principledthin` tells Lambert's from Disney's diffuse by (1 - F / 2)^2 terms, 0 along the normal.
  EXPECT_NEAR(light.x, 1000 * 0.75 * 0.8, 1);
  EXPECT_NEAR(light.y, 1000 * 0.75 * 0.4, 1);
  EXPECT_NEAR(light.z, 1000 * 0.75 * 0.2, 1);
}

// A slab of glass across the view in a white sky: each passage leaves e = exp(-absorption thickness), each surface F. Of the light that
// comes from behind (1 - F)^2 e / (1 - F^2 e^2) is seen, of that from ahead F + (1 - F)^2 F e^2 / (1 - F^2 e^2).
TEST(Lobes, VolumeAbsorbs) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(0, {1, 1, 1});
  m.lobes.transmission = Transmission{1, {}};
  m.lobes.volume = Volume{0.2, 0.4, {0.25, 0.81, 1}, {}};
  Scene scene = square(m);
  scene.objects[0].geometry = BoxGeometry{{4, 4, 0.2}};
  add_environment(scene);
  const Rgb light = seen(scene, "glass", 4096, 16);
  const double kept[] = {0.5, 0.9, 1};  // half the attenuation distance
  for (int c = 0; c < 3; ++c) {
    const double f = 0.04, e = kept[c], inside = (1 - f) * (1 - f) / (1 - f * f * e * e);
    EXPECT_NEAR(light[c] / (1000 * (inside * e + f + inside * f * e * e)), 1, 0.01) << c;
  }
}

// A quarter of the surface's light and three of the sky's behind it.
TEST(Lobes, AlphaIsCoverage) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(0.5, {0.5, 0.5, 0.5});
  Scene whole = square(m);
  add_environment(whole);
  const double opaque = seen(whole, "opaque", 1024).y;
  m.blended = true;
  m.base_alpha = 0.25;
  Scene veil = square(m);
  add_environment(veil);
  EXPECT_NEAR(seen(veil, "veil", 1024).y, 0.25 * opaque + 0.75 * 1000, 5);
}

// Under a sky Disney's sheen of weight s adds s times the mean of (1 - cos(d))^5 cos(light) over directions, d half the angle to the view.
TEST(Lobes, SheenHasTheClothsShare) {
  ETENDUE_NEEDS_MITSUBA();
  Material m = surface(1, {0, 0, 0});
  const auto camera = look_at({9.5, 0, 10 * std::sqrt(1 - 0.95 * 0.95)}, {0, 0, 0}, 0.001);
  Scene bare = square(m);
  bare.cameras[0] = camera;
  add_environment(bare);
  m.lobes.sheen = Sheen{{0.5, 0.5, 0.5}, 0.6, {}, {}};
  Scene scene = square(m);
  scene.cameras[0] = camera;
  add_environment(scene);
  double mean = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double z = (i + 0.5) / steps, angle = 2 * pi * (j + 0.5) / steps;
      const double cosine = 0.95 * std::sqrt(1 - z * z) * std::cos(angle) + std::sqrt(1 - 0.95 * 0.95) * z;
      mean += 2 * pi * std::pow(1 - std::sqrt((1 + cosine) / 2), 5) * z / (steps * steps);
    }
  }
  const double weight = 0.5 * mitsuba::cloth_albedo(0.6) / mitsuba::principled_sheen_albedo();
  const double added = seen(scene, "cloth", 4096).y - seen(bare, "bare", 4096).y;
  EXPECT_NEAR(added / (1000 * weight * mean), 1, 0.02);
}

}  // namespace
}  // namespace etendue::testing
