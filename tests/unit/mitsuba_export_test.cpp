// The exporter without Mitsuba: what it writes, what it refuses, what it leaves behind.
#include "exporters/mitsuba/mitsuba.h"

#include "etendue/eval.h"
#include "etendue/picture.h"
#include "exporters/mitsuba/environment_rows.h"
#include "exporters/mitsuba/light_meshes.h"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <unistd.h>

namespace etendue {
namespace {

namespace fs = std::filesystem;

class MitsubaExport : public ::testing::Test {
 protected:
  MitsubaExport() : folder(fs::temp_directory_path() / ("etendue-export-" + std::to_string(::getpid()))) { fs::create_directories(folder); }
  ~MitsubaExport() override { fs::remove_all(folder); }

  Result<Exported> write(const Scene& scene, const ExportOptions& options = {}) const {
    return make_mitsuba_exporter()->write(scene, folder / "scene.xml", options);
  }
  std::string text() const {
    std::ifstream in(folder / "scene.xml");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder;
};

Light luminous(std::string name, Shape shape, const Vec3d& position) {
  Light light;
  light.name = std::move(name);
  light.shape = std::move(shape);
  light.emission.given = Emission::Given::luminance;
  light.emission.value = 1000;
  light.transform.translation = position;
  return light;
}

Scene table() {
  Scene scene;
  Material matte;
  matte.name = "table top";
  matte.model = Lambert{{0.25, 0.5, 0.75}};
  scene.materials.push_back(matte);
  matte.name = "unused";
  scene.materials.push_back(matte);
  Object top;
  top.name = "top";
  top.geometry = PlaneGeometry{2};
  top.material = 0;
  scene.objects.push_back(top);
  scene.lights.push_back(luminous("key", RectShape{0.5, 0.25}, {0, 1, 0}));
  scene.lights.push_back(luminous("ball", SphereShape{0.125}, {1, 1, 0}));
  Light bulb = luminous("bulb", PointShape{}, {0, 2, 0});
  bulb.emission.given = Emission::Given::intensity;
  bulb.range_m = 4;
  bulb.falloff = Falloff::gltf;
  scene.lights.push_back(bulb);
  scene.cameras.push_back({"view", {{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}, {0, 1, 4}}, 0.5 * pi, {}, 0, {}, {}, {}});
  return scene;
}

// tests/golden/mitsuba/table.xml; ETENDUE_UPDATE_GOLDEN=1 in the environment of the test rewrites it.
TEST_F(MitsubaExport, Golden) {
  ExportOptions options;
  options.width = 64, options.height = 32;
  options.lit = {0, 2};
  const Result<Exported> exported = write(table(), options);
  ASSERT_TRUE(exported.ok()) << exported.error().text;
  const fs::path golden = source_dir() / "tests/golden/mitsuba/table.xml";
  if (std::getenv("ETENDUE_UPDATE_GOLDEN") != nullptr) fs::copy_file(folder / "scene.xml", golden, fs::copy_options::overwrite_existing);
  std::ifstream in(golden);
  EXPECT_EQ(text(), std::string(std::istreambuf_iterator<char>(in), {}));
  EXPECT_EQ(exported->files, std::vector<fs::path>{folder / "scene.xml"});  // nothing to put beside it
  EXPECT_FALSE(fs::exists(folder / "scene_files"));
}

TEST_F(MitsubaExport, LossesAreNamedWithTheirEffect) {
  const Result<Exported> exported = write(table());
  ASSERT_TRUE(exported.ok());
  ASSERT_EQ(exported->losses.losses.size(), 1u);
  EXPECT_EQ(exported->losses.losses[0].what, "light 'bulb': range 4 m");
  EXPECT_NE(exported->losses.losses[0].effect.find("+6.7 % at 2 m"), std::string::npos);  // 1 / (1 - (1/2)^4) = 16/15
}

TEST_F(MitsubaExport, EqualFilesAreWrittenOnce) {
  Scene scene = table();
  scene.lights = {luminous("a", TubeShape{1, 0.02, Caps::round}, {0, 1, 0}), luminous("b", TubeShape{1, 0.02, Caps::round}, {0, 1, 1}),
                  luminous("c", TubeShape{1, 0.02, Caps::flat}, {0, 1, 2})};
  const Result<Exported> exported = write(scene);
  ASSERT_TRUE(exported.ok());
  EXPECT_EQ(exported->files.size(), 3u);
  for (const fs::path& file : exported->files) EXPECT_TRUE(fs::exists(file)) << file;
}

// Each file of one light is what an export of that light alone would be, but for the folder that all of them share.
TEST_F(MitsubaExport, LightByLightSharesItsFiles) {
  Scene scene = table();
  std::ofstream(folder / "red.ppm", std::ios::binary) << "P6\n1 2\n255\n" << std::string("\xff\0\0\x80\0\0", 6);
  scene.images.push_back({(folder / "red.ppm").string(), nullptr, "", "red"});
  scene.materials[0].base_colour_texture = Texture{0, Encoding::srgb};
  ExportOptions options;
  options.lit = {0, 2};
  const auto written = write_mitsuba_light_by_light(scene, folder / "scene.xml", options);
  ASSERT_TRUE(written.ok()) << written.error().text;
  ASSERT_EQ(written->single.size(), 2u);
  const auto content = [](const fs::path& file) {
    std::ifstream in(file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (std::size_t i = 0; i < 2; ++i) {
    ExportOptions one;
    one.lit = {options.lit[i]};
    ASSERT_TRUE(make_mitsuba_exporter()->write(scene, folder / "alone.xml", one).ok());
    std::string alone = content(folder / "alone.xml");
    for (std::size_t at = 0; (at = alone.find("alone_files", at)) != std::string::npos;) alone.replace(at, 5, "scene");
    EXPECT_EQ(content(written->single[i]), alone) << i;
  }
  const auto count = std::distance(fs::directory_iterator(folder / "scene_files"), fs::directory_iterator{});
  EXPECT_EQ(written->all.files.size(), 3u + static_cast<std::size_t>(count));
  // The picture and the textured table top.
  EXPECT_EQ(count, 2);
}

TEST_F(MitsubaExport, ReplacesItsOwnFolderAndNoOther) {
  Scene scene = table();
  scene.lights = {luminous("tube", TubeShape{1, 0.02, Caps::round}, {0, 1, 0})};
  ASSERT_TRUE(write(scene).ok());
  const fs::path first = *fs::directory_iterator(folder / "scene_files");
  std::get<TubeShape>(scene.lights[0].shape).radius = 0.03;
  ASSERT_TRUE(write(scene).ok());
  EXPECT_FALSE(fs::exists(first));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "scene_files"), fs::directory_iterator()), 1);

  std::ofstream(folder / "scene_files" / "precious.txt") << "mine";
  const std::string before = text();
  const Result<Exported> refused = write(scene);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, "FOLDER_NOT_OURS");
  EXPECT_TRUE(fs::exists(folder / "scene_files" / "precious.txt"));
  EXPECT_EQ(text(), before);
}

TEST_F(MitsubaExport, FailureLeavesNothing) {
  Scene scene = table();
  scene.lights.push_back(luminous("tube", TubeShape{1, 0.02, Caps::round}, {0, 1, 0}));
  Light file = luminous("file", PhotometricShape{"lamp.ies"}, {0, 1, 0});
  file.emission.given = Emission::Given::as_file;
  scene.lights.push_back(file);
  const Result<Exported> exported = write(scene);
  ASSERT_FALSE(exported.ok());
  EXPECT_EQ(exported.error().code, "EXPORT_UNSUPPORTED");
  EXPECT_NE(exported.error().text.find("'file'"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder));
  // Muted, it is in nobody's way.
  ExportOptions options;
  options.lit = {0};
  EXPECT_TRUE(write(scene, options).ok());
}

TEST_F(MitsubaExport, TwoEnvironmentsAreRefused) {
  Scene scene = table();
  scene.lights = {luminous("sky", EnvironmentShape{}, {}), luminous("other sky", EnvironmentShape{}, {})};
  const Result<Exported> exported = write(scene);
  ASSERT_FALSE(exported.ok());
  EXPECT_NE(exported.error().text.find("'other sky'"), std::string::npos);
}

// Mitsuba's interpolation over our rewritten rows is our own interpolation, everywhere on the sphere.
TEST(EnvironmentRows, SameFunctionAsOurLookup) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  DecodedImage image;
  image.width = 8, image.height = 5;
  std::vector<Vec3f> pixels;
  for (int i = 0; i < 40; ++i) {
    const Vec3f p{static_cast<float>(unit(random)), static_cast<float>(unit(random)), static_cast<float>(unit(random))};
    pixels.push_back(p);
    image.rgba.insert(image.rgba.end(), {p.x, p.y, p.z, 1});
  }
  const auto ours = eval::make_environment(8, 5, pixels);
  const std::vector<float> rows = mitsuba::rows_aligned_with_poles(image, {1, 1, 1});
  ASSERT_EQ(rows.size(), 11u * 8 * 3);
  for (int i = 0; i < 2000; ++i) {
    const double u = unit(random), theta = pi * unit(random), phi = 2 * pi * u;
    const Vec3d direction{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
    // Columns texel-centred and periodic, rows on theta = pi r / (H - 1).
    const double x = u * 8 - 0.5, y = theta / pi * 10;
    const auto at = [&](double column, double row) {
      const auto c = (static_cast<int>(column) + 8) % 8, r = std::min(static_cast<int>(row), 10);
      const float* p = &rows[(static_cast<std::size_t>(r) * 8 + static_cast<std::size_t>(c)) * 3];
      return Rgb{p[0], p[1], p[2]};
    };
    const double fx = std::floor(x), fy = std::floor(y), ax = x - fx, ay = y - fy;
    const Rgb theirs =
        (at(fx, fy) * (1 - ax) + at(fx + 1, fy) * ax) * (1 - ay) + (at(fx, fy + 1) * (1 - ax) + at(fx + 1, fy + 1) * ax) * ay;
    EXPECT_LT(length(theirs - eval::lookup(*ours, direction)), 1e-6);  // of floats
  }
}

double enclosed_volume(const Mesh& mesh) {
  double six = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return vec_cast<double>(mesh.positions[mesh.indices[i + k]]); };
    six += dot(corner(0), cross(corner(1), corner(2)));
  }
  return six / 6;
}

// Surface of the true tube; outward faces enclose a positive volume, which exceeds the true one by no more than the polyhedron's defect.
TEST(LightMeshes, TubesHaveTheTrueArea) {
  const double r = 0.06, l = 0.8;
  const Mesh round = mitsuba::tube_mesh({l, r, Caps::round}), flat = mitsuba::tube_mesh({l, r, Caps::flat});
  EXPECT_NEAR(area_of(round, {}) / (2 * pi * r * l + 4 * pi * r * r), 1, 1e-6);
  EXPECT_NEAR(area_of(flat, {}) / (2 * pi * r * l + 2 * pi * r * r), 1, 1e-6);
  EXPECT_NEAR(area_of(mitsuba::tube_mesh({l, r, Caps::none}), {}) / (2 * pi * r * l), 1, 1e-6);
  EXPECT_NEAR(enclosed_volume(round) / (pi * r * r * l + 4.0 / 3 * pi * r * r * r), 1, 3e-4);
  EXPECT_NEAR(enclosed_volume(flat) / (pi * r * r * l), 1, 3e-4);
  // A capsule without length is a ball.
  EXPECT_NEAR(area_of(mitsuba::tube_mesh({0, r, Caps::round}), {}) / (4 * pi * r * r), 1, 1e-6);
}

// Both windings face -Z and cover the same area.
TEST(LightMeshes, PolygonsFaceForward) {
  std::vector<Vec2d> arrow{{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {0, 0}, {-0.4, 0.4}};
  for (int winding = 0; winding < 2; ++winding) {
    const Mesh mesh = mitsuba::polygon_mesh({arrow});
    EXPECT_NEAR(area_of(mesh, {}), 0.48, 1e-6);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return vec_cast<double>(mesh.positions[mesh.indices[i + k]]); };
      EXPECT_LT(cross(corner(1) - corner(0), corner(2) - corner(0)).z, 0);
    }
    std::reverse(arrow.begin(), arrow.end());
  }
}

TEST(LightMeshes, TwoSidedFacesLookApart) {
  const Mesh both = mitsuba::two_sided(mitsuba::polygon_mesh({{{0, 0}, {1, 0}, {0, 1}}}), 0.5);
  ASSERT_EQ(both.indices.size(), 6u);
  for (std::size_t i = 0; i < 6; i += 3) {
    const auto corner = [&](std::size_t k) { return vec_cast<double>(both.positions[both.indices[i + k]]); };
    const Vec3d normal = normalised(cross(corner(1) - corner(0), corner(2) - corner(0)));
    EXPECT_NEAR(dot(normal, corner(0)), 0.25, 1e-6);  // each lies gap / 2 along the way it looks
  }
}

}  // namespace
}  // namespace etendue
