// Our plugins inside the real Mitsuba: their BSDFs are our BRDFs, and pictures with them are ours.
#include "fixture.h"

#include "etendue/compare.h"
#include "etendue/eval.h"
#include "etendue/render.h"
#include "process.h"
#include "source_dir.h"

#include <cmath>
#include <sstream>

namespace etendue::testing {
namespace {

bool vectorised() { return mitsuba() != nullptr && !mitsuba()->variant.starts_with("scalar"); }

// Rows of numbers that plugin_values.py prints.
std::vector<std::vector<double>> values_of(const std::string& model, int materials, int directions) {
  std::vector<std::vector<double>> rows;
  ProcessCall call;
  call.arguments = {mitsuba()->python.string(),
                    (source_dir() / "tests/mitsuba/plugin_values.py").string(),
                    (source_dir() / "exporters/mitsuba/surface_bsdfs.py").string(),
                    model,
                    std::to_string(materials),
                    std::to_string(directions),
                    "7"};
  if (mitsuba()->llvm) call.environment.emplace_back("DRJIT_LIBLLVM_PATH", mitsuba()->llvm->string());
  std::string last;
  call.on_line = [&](std::string_view line) {
    last = line;
    std::stringstream cells{last};
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      row.push_back(std::strtod(cell.c_str(), &end));
      if (end == cell.c_str()) return;  // a message
    }
    rows.push_back(std::move(row));
  };
  const Result<ProcessEnd> end = run_process(call);
  EXPECT_TRUE(end.ok() && end->exit_status == 0) << last;
  return rows;
}

// What directions are chosen by: facets that the view sees, or the cosine. Facets have their part of what is reflected to the view, at
// least .1 and of narrow ones .75 (1 - alpha), at most .9.
struct Chosen {
  Rgb f0, f90, albedo;
  double roughness;
};
double mean_of(const Rgb& c) { return (c.x + c.y + c.z) / 3; }
double density(const Chosen& lobes, const Vec3d& view, const Vec3d& light) {
  const double w = std::pow(1 - view.z, 5), alpha = std::max(lobes.roughness * lobes.roughness, 1e-4);
  const double specular = mean_of(lobes.f0 * (1 - w) + lobes.f90 * w), diffuse = mean_of(lobes.albedo);
  const double part = std::clamp(specular / (specular + diffuse), std::max(0.1, 0.75 * (1 - alpha)), 0.9);
  const double share = diffuse > 0 && specular > 0 ? part : specular > 0 ? 1 : 0;
  // All of our own directions are chosen so where nothing is diffused.
  return share * eval::pdf_brdf(TwoColour{{0, 0, 0}, {1, 1, 1}, lobes.roughness}, view, light) + (1 - share) * light.z / pi;
}

// The directions are floats that are read in full, so both evaluate the same configuration, and v + l loses no digit where they nearly
// cancel across the normal. What is left is the rounding of some 30 operations, each of them 6e-8 of a value that the result follows at
// most by its fourth power (D, w): 30 * 4 * 6e-8 = 7e-6 if all went one way.
void expect_equal(const std::string& model, std::size_t parameters, const std::function<eval::Brdf(const double*)>& brdf_of,
                  const std::function<Chosen(const double*)>& chosen_of) {
  const auto rows = values_of(model, 30, 400);
  ASSERT_EQ(rows.size(), 12000u);
  constexpr double limit = 7e-6;
  double worst = 0, worst_pdf = 0;
  for (const std::vector<double>& row : rows) {
    ASSERT_EQ(row.size(), parameters + 10);
    const double* const d = row.data() + parameters;
    const Vec3d view{d[0], d[1], d[2]}, light{d[3], d[4], d[5]};
    const eval::Brdf brdf = brdf_of(row.data());
    const Rgb ours = eval::brdf_cos(brdf, view, light);
    for (int c = 0; c < 3; ++c) {
      ASSERT_GT(ours[c], 0);
      worst = std::max(worst, std::abs(d[6 + c] / ours[c] - 1));
    }
    worst_pdf = std::max(worst_pdf, std::abs(d[9] / density(chosen_of(row.data()), view, light) - 1));
  }
  EXPECT_LE(worst, limit) << model;
  EXPECT_LE(worst_pdf, limit) << model;
  std::printf("%s: largest relative deviation %.1e, of the density %.1e (limit %.0e)\n", model.c_str(), worst, worst_pdf, limit);
}

TEST(Plugins, StandardIsOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  expect_equal(
      "etendue_standard", 6,
      [](const double* p) {
        return Standard{{p[0], p[1], p[2]}, p[3], p[4], p[5]};
      },
      [](const double* p) {
        const Rgb base{p[0], p[1], p[2]};
        const double metal = p[3], roughness = p[4], f0_dielectric = 0.16 * p[5] * p[5];
        const Rgb f0 = Rgb{1, 1, 1} * (f0_dielectric * (1 - metal)) + base * metal;
        const double f90 = std::min(50 * 0.33 * (f0.x + f0.y + f0.z), 1.0);
        return Chosen{f0, {f90, f90, f90}, base * ((1 - metal) * (1 + roughness * (1 / 1.51 - 1))), roughness};
      });
}
TEST(Plugins, MetalRoughIsOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  expect_equal(
      "etendue_metal_rough", 6,
      [](const double* p) {
        return MetalRough{{p[0], p[1], p[2]}, p[3], p[4], p[5]};
      },
      [](const double* p) {
        const Rgb base{p[0], p[1], p[2]};
        const double metallic = p[3], root = (p[5] - 1) / (p[5] + 1);
        return Chosen{Rgb{1, 1, 1} * (root * root * (1 - metallic)) + base * metallic, {1, 1, 1}, base * (1 - metallic), p[4]};
      });
}
TEST(Plugins, SpecularGlossinessIsOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  const auto two_colour = [](const double* p) { return two_colour_of({{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, p[6]}); };
  expect_equal("etendue_specular_glossiness", 7, two_colour, [&](const double* p) {
    const TwoColour lobes = two_colour(p);
    return Chosen{lobes.f0, {1, 1, 1}, lobes.diffuse, lobes.roughness};
  });
}

// A floor under a lamp of 1000 cd/m2 or 1000 cd.
Scene lit_floor(const SurfaceModel& model, const Shape& lamp) {
  Scene scene;
  Object floor;
  floor.name = "floor";
  floor.geometry = PlaneGeometry{4};
  floor.material = 0;
  scene.objects.push_back(floor);
  Material material;
  material.model = model;
  scene.materials.push_back(material);
  Light light = light_of(lamp);
  light.transform = aimed({0.4, 1, -0.6}, {-0.3, -1, 0.3});
  scene.lights.push_back(light);
  scene.cameras.push_back(look_at({0, 1.6, 2.2}, {0, 0, 0}, 0.7));
  return scene;
}

// Ours against Mitsuba's. `same` excludes a larger difference in the picture and in its tiles, so 1 % more of either side fails.
void expect_same_picture(const std::string& name, const Scene& scene, double max_difference = 0.003) {
  ExportOptions options;
  options.width = options.height = 32;
  const auto written = make_mitsuba_exporter(MitsubaParts::with_plugins)->write(scene, scratch() / (name + ".xml"), options);
  ASSERT_TRUE(written.ok());
  EXPECT_TRUE(written->losses.losses.empty()) << written->losses.losses[0].what;
  const std::vector<Picture> theirs = rendered({scratch() / (name + ".xml")}, 256, 8);
  ASSERT_EQ(theirs.size(), 1u);

  RenderOptions ours;
  ours.width = ours.height = 32;
  ours.mitsuba_model = true;
  ours.mitsuba_parts = MitsubaParts::with_plugins;
  const Result<Rendered> picture = render(scene, ours);
  ASSERT_TRUE(picture.ok());
  CompareOptions asked;
  asked.max_difference = max_difference;
  const Result<Comparison> comparison = compare(picture->picture, theirs[0], asked, {"floor"});
  ASSERT_TRUE(comparison.ok());
  EXPECT_EQ(comparison->verdict, Verdict::same) << name << ": mean difference " << comparison->mean_rel;
  std::printf("%s: mean difference %+.3f %%, verdict %s\n", name.c_str(), 100 * comparison->mean_rel, name_of(comparison->verdict));
}

TEST(Plugins, PicturesOfStandardAreOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  expect_same_picture("dielectric", lit_floor(Standard{{0.8, 0.5, 0.2}, 0, 0.5, 0.5}, SphereShape{0.15}));
  expect_same_picture("metal", lit_floor(Standard{{0.8, 0.5, 0.2}, 1, 0.7, 0.5}, RectShape{0.5, 0.4}));
}

// Base colour, metal and roughness from one picture: texel (x, y) has red by columns, green (roughness) by rows, blue (metal) by both.
TEST(Plugins, PicturesOfTexturesAreOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  Scene scene = lit_floor(Standard{{1, 0.7, 0.4}, 0.8, 0.9, 0.6}, SphereShape{0.15});
  Picture picture;
  picture.width = picture.height = 4;
  std::vector<float>& texels = picture.add("", 3).pixels;
  for (std::size_t i = 0; i < 16; ++i) {
    const std::size_t x = i % 4, y = i / 4;
    texels[3 * i] = 0.2f * static_cast<float>(x + 1);
    texels[3 * i + 1] = 0.5f + 0.12f * static_cast<float>(y + 1);
    texels[3 * i + 2] = (x + y) % 2 == 0 ? 1.0f : 0.25f;
  }
  ASSERT_TRUE(write_exr(picture, scratch() / "texels.exr").ok());
  ImageRef image;
  image.file = (scratch() / "texels.exr").string();
  scene.images.push_back(image);
  scene.materials[0].base_colour_texture = scene.materials[0].metal_rough_texture = Texture{};
  expect_same_picture("textures", scene);
}

// A window lies on what the floor gets, not on what the camera sees of the light.
TEST(Plugins, PicturesWithWindowsAreOurs) {
  if (!vectorised()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA, or no LLVM library for it";
  const Standard dielectric{{0.8, 0.5, 0.2}, 0, 0.5, 0.5};
  Scene scene = lit_floor(dielectric, SpotShape{0.3, 0.9});
  scene.lights[0].falloff = Falloff::frostbite;
  scene.lights[0].range_m = 1.5;
  expect_same_picture("frostbite_spot", scene);
  scene = lit_floor(dielectric, SphereShape{0.15});
  scene.lights[0].falloff = Falloff::karis;
  scene.lights[0].range_m = 1.5;
  scene.lights[0].transform.translation = {0.3, 0.5, -0.3};  // in the picture: its edge is noisy
  expect_same_picture("karis_sphere", scene, 0.01);
}

}  // namespace
}  // namespace etendue::testing
