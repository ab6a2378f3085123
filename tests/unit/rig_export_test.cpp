#include "exporters/rig/rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "importers/rig/rig.h"
#include "importers/rig/rig_text.h"
#include "source_dir.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

std::string told(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.all()) text += to_string(d) + "\n";
  return text;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class RigExport : public testing::Test {
 protected:
  RigExport() : folder_(fs::temp_directory_path() / fmt::format("etendue_rig_{:08x}", std::random_device()())) {
    fs::create_directories(folder_ / "textures");
  }
  ~RigExport() override { fs::remove_all(folder_); }

  void put(const fs::path& name, std::string_view text) { std::ofstream(folder_ / name, std::ios::binary) << text; }

  Exported write(const Scene& scene, const fs::path& name = "out.rig.json") {
    Result<Exported> exported = make_rig_exporter()->write(scene, folder_ / name, {});
    if (exported) return std::move(*exported);
    std::string notes;
    for (const Diagnostic& d : exported.error().notes) notes += to_string(d) + "\n";
    ADD_FAILURE() << to_string(to_diagnostic(exported.error())) << "\n" << notes;
    return {};
  }
  Scene read(const fs::path& name = "out.rig.json") {
    Result<Imported> imported = make_rig_importer(none_)->read(folder_ / name, {});
    if (!imported) {
      ADD_FAILURE() << to_string(to_diagnostic(imported.error())) << text_of(folder_ / name);
      return {};
    }
    EXPECT_FALSE(imported->diagnostics.has_errors()) << told(imported->diagnostics) << text_of(folder_ / name);
    return std::move(imported->scene);
  }

  fs::path folder_;
  Registry none_;
};

// ---------------------------------------------------------------------------------------------------------------------------------------
// What a scene says, as numbers and words, so that two can be compared. Indices of the shape's variant come first.

using Said = std::vector<std::string>;

template <class... T>
void say(Said& said, const T&... values) {
  (said.push_back(fmt::format("{}", values)), ...);
}
void say(Said& said, const Vec3d& v) { say(said, v.x, v.y, v.z); }

struct SayShape {
  Said& said;
  void operator()(const PointShape&) const {}
  void operator()(const SpotShape& s) const { say(said, s.inner_rad, s.outer_rad); }
  void operator()(const FrustumShape& s) const { say(said, s.width_rad, s.height_rad); }
  void operator()(const DistantShape& s) const { say(said, s.diameter_rad); }
  void operator()(const SphereShape& s) const { say(said, s.radius); }
  void operator()(const DiskShape& s) const { say(said, s.radius); }
  void operator()(const RectShape& s) const { say(said, s.width, s.height); }
  void operator()(const PolygonShape& s) const {
    for (const Vec2d& p : s.points) say(said, p.x, p.y);
  }
  void operator()(const TubeShape& s) const { say(said, s.length, s.radius, static_cast<int>(s.caps)); }
  void operator()(const LineShape& s) const { say(said, s.length); }
  void operator()(const MeshShape& s) const {
    say(said, s.mesh);
    say(said, s.scale);
  }
  void operator()(const PhotometricShape& s) const {
    say(said, fs::weakly_canonical(s.file).string());
    if (s.cone) (*this)(*s.cone);
  }
  void operator()(const EnvironmentShape& s) const { say(said, s.image ? static_cast<int>(*s.image) : -1); }
};

void say(Said& said, const Texture& t) {
  say(said, t.image, static_cast<int>(t.encoding), static_cast<int>(t.wrap_u), static_cast<int>(t.wrap_v), t.nearest, t.uv_set);
  for (const auto& row : t.uv_transform)
    for (const double x : row) say(said, x);
}

Said said_of(const Light& l) {
  Said said;
  say(said, l.name, l.shape.index());
  std::visit(SayShape{said}, l.shape);
  say(said, static_cast<int>(l.emission.given), l.emission.value, l.emission.radiant, l.emission.efficacy_lm_W.value_or(-1),
      l.emission.distance_m.value_or(-1));
  if (l.emission.texture) say(said, *l.emission.texture);
  say(said, l.colour.index());
  if (const auto* rgb = std::get_if<RgbColour>(&l.colour)) say(said, rgb->rgb);
  if (const auto* t = std::get_if<TemperatureColour>(&l.colour)) say(said, t->kelvin);
  if (const auto* t = std::get_if<DaylightColour>(&l.colour)) say(said, t->kelvin);
  say(said, l.filter);
  say(said, l.two_sided, l.visible, l.range_m.value_or(-1), static_cast<int>(l.falloff.law), l.falloff.exponent,
      static_cast<int>(l.flux_convention), l.surface_material.value_or(no_index));
  say(said, l.transform.translation);
  return said;
}

struct SayModel {
  Said& said;
  void operator()(const Lambert& m) const { say(said, m.base_colour); }
  void operator()(const Principled& m) const {
    say(said, m.base_colour);
    say(said, m.metallic, m.roughness, m.specular);
  }
  void operator()(const Standard& m) const {
    say(said, m.base_colour);
    say(said, m.metal, m.roughness, m.reflectance);
  }
  void operator()(const Conductor& m) const {
    say(said, m.eta);
    say(said, m.k);
    say(said, m.alpha, static_cast<int>(m.masking));
  }
  void operator()(const MetalRough& m) const {
    say(said, m.base_colour);
    say(said, m.metallic, m.roughness, m.ior);
  }
  void operator()(const SpecularGlossiness& m) const {
    say(said, m.diffuse);
    say(said, m.specular);
    say(said, m.glossiness);
  }
};

Said said_of(const Material& m) {
  Said said;
  say(said, m.name, m.model.index(), m.double_sided);
  std::visit(SayModel{said}, m.model);
  return said;
}

Said said_of(const Object& o) {
  Said said;
  say(said, o.name, o.geometry.index(), o.material);
  if (const auto* g = std::get_if<PlaneGeometry>(&o.geometry)) say(said, g->size);
  if (const auto* g = std::get_if<BoxGeometry>(&o.geometry)) say(said, g->size);
  if (const auto* g = std::get_if<SphereGeometry>(&o.geometry)) say(said, g->radius);
  if (const auto* g = std::get_if<MeshGeometry>(&o.geometry)) say(said, g->mesh);
  say(said, o.transform.translation);
  return said;
}

Said said_of(const Camera& c) {
  Said said;
  say(said, c.name, c.vfov_rad, c.ev100.value_or(-1e9), c.aspect);
  say(said, c.transform.translation);
  return said;
}

Said said_of(const Mesh& m) {
  Said said;
  say(said, m.name);
  for (const Vec3f& v : m.positions) say(said, v.x, v.y, v.z);
  for (const Vec3f& v : m.normals) say(said, v.x, v.y, v.z);
  for (const Vec2f& v : m.uvs) say(said, v.x, v.y);
  for (const std::uint32_t i : m.indices) say(said, i);
  return said;
}

// A unit quaternion in double keeps a rotation to a few roundings of each element; nothing else may change at all.
void expect_same_axes(const Transform& a, const Transform& b) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(length(a.columns[i] - b.columns[i]), 4e-15 * length(a.columns[i]));
}
void expect_same_axes(const Mesh&, const Mesh&) {}
void expect_same_axes(const Material&, const Material&) {}
template <class T>
void expect_same_axes(const T& a, const T& b) {
  expect_same_axes(a.transform, b.transform);
}

template <class T>
void expect_same(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(said_of(a[i]), said_of(b[i]));
    expect_same_axes(a[i], b[i]);
  }
}

void expect_same(const Scene& a, const Scene& b) {
  expect_same(a.meshes, b.meshes);
  expect_same(a.materials, b.materials);
  expect_same(a.lights, b.lights);
  expect_same(a.objects, b.objects);
  expect_same(a.cameras, b.cameras);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) EXPECT_TRUE(fs::equivalent(a.images[i].file, b.images[i].file));
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// Scenes of everything that the format can say.

class Generator {
 public:
  Generator(std::uint64_t seed, fs::path folder) : random_(seed), folder_(std::move(folder)) {}

  Scene scene() {
    for (int i = 0; i < 3; ++i) s_.materials.push_back(material());
    for (int i = 0; i < 2; ++i) s_.meshes.push_back(mesh());
    s_.images.push_back({(folder_ / "textures" / "a b.exr").string(), nullptr, "", ""});
    s_.images.push_back({(folder_ / "textures" / "sky.hdr").string(), nullptr, "", ""});
    for (int i = 0; i < 16; ++i) s_.lights.push_back(light(i));
    for (int i = 0; i < 8; ++i) s_.objects.push_back(object(i));
    for (int i = 0; i < 2; ++i) s_.cameras.push_back(camera());
    return s_;
  }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  bool maybe() { return below(2) == 0; }
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  // Any order of magnitude.
  double positive() { return std::exp(between(-12, 12)); }
  Vec3d vec(double a, double b) { return {between(a, b), between(a, b), between(a, b)}; }
  std::string word() {
    const char* const words[] = {"", "key", "a \"b\"\\/\n", "caf\xC3\xA9", "\x01", "0"};
    return words[below(6)];
  }
  Quat rotation() {
    if (below(4) == 0) return {};
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_), z = normal(random_), w = normal(random_);
    const double l = std::sqrt(x * x + y * y + z * z + w * w);
    return {x / l, y / l, z / l, w / l};
  }
  Transform rigid() { return Transform::from_trs(maybe() ? vec(-100, 100) : Vec3d{}, rotation()); }
  float single() { return static_cast<float>(between(-1, 1) * positive()); }

  Mesh mesh() {
    Mesh m;
    m.name = word();
    for (int i = 0; i < 5; ++i) {
      m.positions.push_back({single(), single(), single()});
      m.uvs.push_back({single(), single()});
    }
    if (maybe()) m.normals.assign(5, {0, 0.6f, 0.8f});
    m.indices = {0, 1, 2, 2, 3, 4};
    return m;
  }
  Material material() {
    Material m;
    m.name = word();
    m.double_sided = maybe();
    switch (below(6)) {
      case 0:
        m.model = Lambert{vec(0, 1)};
        break;
      case 1:
        m.model = Principled{vec(0, 1), between(0, 1), between(0, 1), between(0, 12)};
        break;
      case 2:
        m.model = Standard{vec(0, 1), between(0, 1), between(0, 1), between(0, 1)};
        break;
      case 3:
        m.model = Conductor{vec(0.1, 5), vec(0, 9), between(0.001, 1),
                            maybe()   ? Masking::separable
                            : maybe() ? Masking::schlick_direct
                                      : Masking::schlick_image};
        break;
      case 4:
        m.model = SpecularGlossiness{vec(0, 1), vec(0, 1), between(0, 1)};
        break;
      default:
        m.model = MetalRough{vec(0, 1), between(0, 1), between(0, 1), maybe() ? 1.5 : between(1, 3)};
    }
    return m;
  }
  Texture texture() {
    Texture t;
    t.image = 0;
    t.encoding = maybe() ? Encoding::linear : Encoding::srgb;
    t.wrap_u = static_cast<Wrap>(below(3));
    t.wrap_v = static_cast<Wrap>(below(3));
    t.nearest = maybe();
    t.uv_set = below(2);
    if (maybe()) t.uv_transform[0][2] = between(-1, 1);
    return t;
  }
  Shape shape(int kind) {
    switch (kind % 13) {
      case 0:
        return PointShape{};
      case 1:
        return SpotShape{maybe() ? 0 : between(0, 0.7), between(0.7, 1.5)};
      case 2:
        return FrustumShape{between(0.01, 3), between(0.01, 3)};
      case 3:
        return DistantShape{maybe() ? 0 : between(0.001, 0.1)};
      case 4:
        return SphereShape{positive()};
      case 5:
        return DiskShape{positive()};
      case 6:
        return RectShape{positive(), positive()};
      case 7:
        return PolygonShape{{{0, 0}, {positive(), 0}, {0, positive()}}};
      case 8:
        return TubeShape{positive(), positive(), static_cast<Caps>(below(3))};
      case 9:
        return LineShape{positive()};
      case 10:
        return MeshShape{static_cast<std::uint32_t>(below(2)), maybe() ? Vec3d{1, 1, 1} : vec(0.5, 2)};
      case 11:
        return PhotometricShape{
            .file = (folder_ / "textures" / "lamp.ies").string(),
            .cone = maybe() ? std::nullopt : std::optional(SpotShape{maybe() ? 0 : between(0, 0.7), between(0.7, 1.5)})};
      default:
        return EnvironmentShape{maybe() ? std::nullopt : std::optional<std::uint32_t>(1)};
    }
  }
  // A unit that the shape takes.
  Emission emission(const Shape& shape, int kind) {
    Emission e;
    e.radiant = maybe();
    if (e.radiant) e.efficacy_lm_W = positive();
    e.value = positive();
    e.given = Emission::Given::flux;
    const bool surface = kind >= 4 && kind <= 8;
    if (kind == 3) e.given = Emission::Given::illuminance;
    if (kind == 12 || (kind == 10 && maybe())) e.given = Emission::Given::luminance;
    if (surface) e.given = static_cast<Emission::Given>(below(3));
    if (surface && below(5) == 0) e = {Emission::Given::ev, between(-10, 20), false, {}, {}, {}};
    if (kind == 0 && maybe()) {
      e.given = Emission::Given::illuminance;
      e.distance_m = positive();
    }
    const auto* sky = std::get_if<EnvironmentShape>(&shape);
    if (kind == 11 || (sky && sky->image)) e = {};
    if (kind >= 5 && kind <= 7 && maybe()) e.texture = texture();
    return e;
  }
  Light light(int index) {
    Light l;
    const int kind = index % 13;
    l.name = fmt::format("{}{}", word(), index);
    l.shape = shape(kind);
    l.emission = emission(l.shape, kind);
    if (maybe()) l.colour = RgbColour{vec(0.1, 3)};
    if (below(3) == 0) l.colour = TemperatureColour{between(1000, 20000)};
    if (below(3) == 0) l.colour = DaylightColour{between(4000, 25000)};
    if (maybe()) l.filter = vec(0, 1);
    l.two_sided = kind >= 5 && kind <= 7 && maybe();
    l.visible = maybe();
    if (maybe()) l.range_m = positive();
    l.falloff.law = static_cast<Falloff::Law>(below(6));
    if (l.falloff.law == Falloff::Law::power || l.falloff.law == Falloff::Law::power_squared)
      l.falloff.exponent = maybe() ? 4 : between(Falloff::least_exponent, Falloff::most_exponent);
    if (l.falloff == Falloff::scale_bias && l.range_m) *l.range_m += 1;
    l.flux_convention = static_cast<FluxConvention>(below(4));
    if (kind == 10 && maybe()) l.surface_material = static_cast<std::uint32_t>(below(3));
    l.transform = rigid();
    return l;
  }
  Object object(int index) {
    Object o;
    o.name = word();
    if (maybe()) o.material = static_cast<std::uint32_t>(below(3));
    const double scale = positive();
    o.transform = Transform::from_trs(vec(-5, 5), rotation(), {scale, scale, scale});
    if (index % 4 == 2) {
      o.geometry = SphereGeometry{positive()};
      return o;
    }
    if (maybe()) o.transform = Transform::from_trs({}, rotation(), vec(-2, -0.5)) * o.transform;
    if (below(3) == 0) o.transform.columns[0] += o.transform.columns[1] * between(0, 2);  // a shear
    if (index % 4 == 0) o.geometry = PlaneGeometry{positive()};
    if (index % 4 == 1) o.geometry = BoxGeometry{{positive(), positive(), positive()}};
    if (index % 4 == 3) o.geometry = MeshGeometry{static_cast<std::uint32_t>(index / 4)};
    return o;
  }
  Camera camera() {
    Camera c;
    c.name = word();
    c.transform = rigid();
    c.vfov_rad = between(0.01, 3);
    if (maybe()) c.ev100 = between(-5, 20);
    if (maybe()) c.aspect = between(0.5, 2);
    return c;
  }

  std::mt19937_64 random_;
  fs::path folder_;
  Scene s_;
};

TEST_F(RigExport, WhatIsWrittenReadsBackAsTheSameScene) {
  put("textures/a b.exr", "x");
  put("textures/sky.hdr", "x");
  put("textures/lamp.ies", "x");
  for (std::uint64_t seed = 0; seed < 200 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = Generator(seed, folder_).scene();
    ASSERT_FALSE(validate(scene).has_errors()) << told(validate(scene));
    const Exported exported = write(scene);
    EXPECT_TRUE(exported.losses.losses.empty());
    EXPECT_EQ(exported.files.size(), 1u);
    // An image that no light uses is not written.
    const Scene again = read();
    bool sky_used = false;
    for (const Light& l : scene.lights)
      if (const auto* sky = std::get_if<EnvironmentShape>(&l.shape)) sky_used = sky_used || sky->image;
    bool texture_used = false;
    for (const Light& l : scene.lights) texture_used = texture_used || l.emission.texture;
    if (!sky_used) scene.images.pop_back();
    if (!texture_used) scene.images.erase(scene.images.begin());
    if (!texture_used && sky_used) {
      for (Light& l : scene.lights)
        if (auto* sky = std::get_if<EnvironmentShape>(&l.shape); sky && sky->image) sky->image = 0;
    }
    expect_same(scene, again);
  }
}

TEST_F(RigExport, IsDeterministic) {
  put("textures/a b.exr", "x");
  put("textures/sky.hdr", "x");
  put("textures/lamp.ies", "x");
  const Scene scene = Generator(7, folder_).scene();
  write(scene, "one.rig.json");
  write(scene, "two.rig.json");
  EXPECT_FALSE(text_of(folder_ / "one.rig.json").empty());
  EXPECT_EQ(text_of(folder_ / "one.rig.json"), text_of(folder_ / "two.rig.json"));
}

// tests/golden/every_light.rig.json is written by hand; what the exporter makes of it was looked through line by line.
TEST_F(RigExport, Golden) {
  const fs::path golden = source_dir() / "tests" / "golden";
  const Result<Imported> imported = make_rig_importer(none_)->read(golden / "every_light.rig.json", {});
  ASSERT_TRUE(imported.ok()) << to_string(to_diagnostic(imported.error()));
  ASSERT_TRUE(imported->diagnostics.all().empty()) << told(imported->diagnostics);
  const Exported exported = write(imported->scene);
  EXPECT_TRUE(exported.losses.losses.empty());
  EXPECT_EQ(text_of(folder_ / "out.rig.json"), text_of(golden / "every_light.written.rig.json"));
  expect_same(imported->scene, read());
}

TEST_F(RigExport, WritesUnitsAsAPersonWould) {
  Scene scene;
  Light l;
  l.name = "a";
  l.shape = SpotShape{20 * pi / 180, 30 * pi / 180};
  l.emission = {Emission::Given::flux, 1500, false, {}, {}, {}};
  l.colour = TemperatureColour{3000};
  scene.lights.push_back(l);
  write(scene);
  EXPECT_EQ(text_of(folder_ / "out.rig.json"), R"({
  "etendue": 1,
  "lights": [
    {
      "name": "a",
      "shape": {"type": "spot", "inner": "20 deg", "outer": "30 deg"},
      "emission": {"flux": "1500 lm"},
      "colour": {"temperature": "3000 K"}
    }
  ]
}
)");
}

TEST_F(RigExport, ReportsWhatIsLost) {
  put("textures/a.png", "x");
  Scene scene;
  scene.images.push_back({(folder_ / "textures" / "a.png").string(), nullptr, "", ""});
  Material m;
  m.name = "brick";
  m.base_colour_texture = Texture{};
  m.metal_rough_texture = Texture{};
  m.normal_map = NormalMap{};
  m.alpha_cutoff = 0.5;
  m.base_alpha = 0.9;
  m.emissive = {1, 1, 1};
  scene.materials.push_back(m);
  Light l;
  l.name = "twin";
  l.emission = {Emission::Given::flux, 1, false, {}, {}, {}};
  scene.lights = {l, l};
  scene.meshes.push_back({"empty", {{0, 0, 0}}, {}, {}, {}, {}, {}, ""});
  scene.objects.push_back({"ghost", MeshGeometry{0}, no_index, {}, ""});
  const Exported exported = write(scene);
  std::string losses;
  for (const Loss& loss : exported.losses.losses) losses += loss.what + "\n";
  EXPECT_EQ(losses,
            "light \"twin\": its name\n"
            "material \"brick\": the texture of its base colour\nmaterial \"brick\": the texture of metal and roughness\n"
            "material \"brick\": its normal map\nmaterial \"brick\": its alpha cutoff\nmaterial \"brick\": the alpha of its base colour\n"
            "material \"brick\": its emission\nobject \"ghost\"\n");
  const Scene again = read();
  EXPECT_EQ(again.lights.size(), 2u);
  EXPECT_TRUE(again.objects.empty() && again.meshes.empty());
}

TEST_F(RigExport, PutsForeignFilesBesideTheRig) {
  fs::create_directories(folder_ / "rig");
  put("outside.hdr", "#?RADIANCE");
  Scene scene;
  const std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G'};
  scene.images.push_back({(folder_ / "outside.hdr").string(), nullptr, "", ""});
  scene.images.push_back({"", png, "image/png", "a/b"});
  Light sky;
  sky.name = "sky";
  sky.shape = EnvironmentShape{0};
  Light panel;
  panel.name = "panel";
  panel.shape = RectShape{1, 1};
  panel.emission = {Emission::Given::luminance, 1, false, {}, {}, Texture{}};
  panel.emission.texture->image = 1;
  scene.lights = {sky, panel, panel};
  scene.lights[2].name = "second panel";
  const Exported exported = write(scene, "rig/out.rig.json");
  ASSERT_EQ(exported.files.size(), 3u);
  EXPECT_EQ(text_of(folder_ / "rig/out_files/0_outside.hdr"), "#?RADIANCE");
  EXPECT_EQ(text_of(folder_ / "rig/out_files/1_a_b.png"), "\x89PNG");
  EXPECT_EQ(read("rig/out.rig.json").images.size(), 2u);
}

TEST_F(RigExport, RefusesAnInvalidSceneAndLeavesNothingBehind) {
  Scene scene;
  scene.lights.emplace_back();  // emits nothing
  const Result<Exported> exported = make_rig_exporter()->write(scene, folder_ / "out.rig.json", {});
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, "SCENE_INVALID");
  EXPECT_FALSE(exported.error().notes.empty());
  EXPECT_FALSE(fs::exists(folder_ / "out.rig.json"));

  put("outside.hdr", "x");
  fs::create_directories(folder_ / "rig");
  scene.lights[0].shape = EnvironmentShape{0};
  scene.images.push_back({(folder_ / "outside.hdr").string(), nullptr, "", ""});
  scene.lights.push_back(scene.lights[0]);
  scene.lights[1].shape = EnvironmentShape{1};
  scene.images.push_back({(folder_ / "absent.hdr").string(), nullptr, "", ""});
  ASSERT_FALSE(make_rig_exporter()->write(scene, folder_ / "rig" / "out.rig.json", {}));
  EXPECT_FALSE(fs::exists(folder_ / "rig" / "out.rig.json"));
  EXPECT_FALSE(fs::exists(folder_ / "rig" / "out_files" / "0_outside.hdr"));
}

}  // namespace
}  // namespace etendue
