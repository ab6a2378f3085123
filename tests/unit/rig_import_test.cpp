#include "importers/rig/rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "importers/rig/rig_text.h"
#include "source_dir.h"

namespace etendue {
namespace {

Imported read(std::string_view text, const ImportOptions& options = {}) {
  Result<Imported> imported = rig::read_rig_text(text, "t.rig.json", "no_such_folder", nullptr, options);
  if (imported) return std::move(*imported);
  ADD_FAILURE() << to_string(to_diagnostic(imported.error()));
  return {};
}

std::string told(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.all()) text += to_string(d) + "\n";
  return text;
}

// A rig of one light.
std::string light(std::string_view fields) { return fmt::format("{{\"etendue\": 1,\n \"lights\": [{{{}}}]}}", fields); }

Light only_light(std::string_view fields) {
  const Imported imported = read(light(fields));
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  EXPECT_TRUE(validate(imported.scene).all().empty()) << told(validate(imported.scene));
  if (imported.scene.lights.size() == 1) return imported.scene.lights[0];
  ADD_FAILURE() << "expected one light";
  return {};
}

// `marked` is a rig with '$' before each token that a message is about; messages come in the order of the file.
struct Expected {
  std::string_view code, pointer;
};
void expect_told(std::string_view marked, const std::vector<Expected>& expected) {
  std::string text;
  std::vector<std::string> places;
  int line = 1, column = 1;
  for (const char c : marked) {
    if (c == '$') {
      places.push_back(fmt::format("{}:{}", line, column));
      continue;
    }
    text += c;
    ++column;
    if (c == '\n') {
      ++line;
      column = 1;
    }
  }
  const Imported imported = read(text);
  const std::vector<Diagnostic>& all = imported.diagnostics.all();
  ASSERT_EQ(places.size(), expected.size()) << "one mark a message";
  ASSERT_EQ(all.size(), expected.size()) << marked << "\n" << told(imported.diagnostics);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].code, expected[i].code) << to_string(all[i]);
    EXPECT_EQ(all[i].where.pointer, expected[i].pointer) << to_string(all[i]);
    EXPECT_EQ(fmt::format("{}:{}", all[i].where.line, all[i].where.column), places[i]) << to_string(all[i]);
    EXPECT_EQ(all[i].where.file, "t.rig.json");
  }
}
void expect_light_told(std::string_view fields, std::string_view code, std::string_view pointer_in_light) {
  expect_told(light(fields), {{code, "/lights/0" + std::string(pointer_in_light)}});
}

constexpr std::string_view bulb = R"("shape": {"type": "point"}, "emission": {"flux": "1 lm"}, )";

constexpr std::string_view sample = R"({ "etendue": 1,
  "lights": [
    { "name": "key", "shape": {"type": "rect", "width": "1.2 m", "height": "60 cm"}, "emission": {"flux": "1500 lm"}, "colour": {"temperature": "3000 K"},
      "translation": [0, 2.4, 0], "rotation": [-0.7071068, 0, 0, 0.7071068] },
    { "name": "bulb", "shape": {"type": "sphere", "radius": "3 cm"}, "emission": {"luminance": "20 knit"}, "colour": {"rgb": [1, 0.9, 0.8]}, "translation": [1, 1.5, 0] } ],
  "camera": { "position": [0, 1.6, 4], "target": [0, 1, 0], "vfov": "40 deg", "exposure": {"ev100": 8} },
  "materials": [ { "name": "floor", "model": "lambert", "base_colour": [0.5, 0.5, 0.5] } ],
  "objects": [ { "shape": {"type": "plane", "size": 10}, "material": "floor" } ]
})";

TEST(RigImport, ReadsTheSample) {
  const Imported imported = read(sample);
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  const Scene& scene = imported.scene;
  EXPECT_EQ(scene.format, "rig");
  EXPECT_EQ(scene.file, "t.rig.json");
  ASSERT_EQ(scene.lights.size(), 2u);
  const Light& key = scene.lights[0];
  EXPECT_EQ(key.name, "key");
  EXPECT_EQ(std::get<RectShape>(key.shape).width, 1.2);
  EXPECT_EQ(std::get<RectShape>(key.shape).height, 0.6);
  EXPECT_EQ(key.emission.given, Emission::Given::flux);
  EXPECT_EQ(key.emission.value, 1500);
  EXPECT_EQ(std::get<TemperatureColour>(key.colour).kelvin, 3000);
  EXPECT_EQ(key.source, "/lights/0");
  EXPECT_EQ(key.transform.translation, (Vec3d{0, 2.4, 0}));
  // Turned by -90 degrees about X the light's -Z, where it emits, looks down; the quaternion of 7 digits is made a unit one.
  const Vec3d down = key.transform.vector({0, 0, -1});
  EXPECT_NEAR(down.y, -1, 1e-15);
  EXPECT_EQ(scene.lights[1].emission.value, 20000);
  EXPECT_EQ(std::get<RgbColour>(scene.lights[1].colour).rgb, (Rgb{1, 0.9, 0.8}));
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_NEAR(scene.cameras[0].vfov_rad, 40 * pi / 180, 1e-15);
  EXPECT_EQ(scene.cameras[0].ev100, 8);
  // The line of sight hits the target.
  const Vec3d sight = scene.cameras[0].transform.vector({0, 0, -1});
  EXPECT_NEAR(length(cross(sight, normalised(Vec3d{0, -0.6, -4}))), 0, 1e-15);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(std::get<PlaneGeometry>(scene.objects[0].geometry).size, 10);
  EXPECT_EQ(scene.objects[0].material, 0u);
  EXPECT_EQ(scene.materials[0].name, "floor");
  EXPECT_TRUE(validate(scene).all().empty()) << told(validate(scene));
}

TEST(RigImport, EveryShape) {
  const auto shape_of = [](std::string_view shape, std::string_view emission = R"("flux": "1 lm")") {
    return only_light(fmt::format(R"("shape": {{{}}}, "emission": {{{}}})", shape, emission)).shape;
  };
  EXPECT_TRUE(std::holds_alternative<PointShape>(shape_of(R"("type": "point")")));
  const auto spot = std::get<SpotShape>(shape_of(R"("type": "spot", "inner": "20 deg", "outer": "0.5 rad")"));
  EXPECT_NEAR(spot.inner_rad, pi / 9, 1e-15);
  EXPECT_EQ(spot.outer_rad, 0.5);
  EXPECT_EQ(std::get<SpotShape>(shape_of(R"("type": "spot", "outer": "90 deg")")).outer_rad, pi / 2);
  EXPECT_EQ(std::get<SpotShape>(shape_of(R"("type": "spot", "outer": "90 deg")")).inner_rad, 0);
  const auto frustum = std::get<FrustumShape>(shape_of(R"("type": "frustum", "width_angle": "1 rad", "height_angle": "0.5 rad")"));
  EXPECT_EQ(frustum.width_rad, 1);
  EXPECT_EQ(frustum.height_rad, 0.5);
  EXPECT_EQ(std::get<DistantShape>(shape_of(R"("type": "distant")", R"("illuminance": "100 klx")")).diameter_rad, 0);
  EXPECT_NEAR(
      std::get<DistantShape>(shape_of(R"("type": "distant", "angular_diameter": "0.53 deg")", R"("luminance": "1.6 Gnit")")).diameter_rad,
      0.53 * pi / 180, 1e-16);
  EXPECT_EQ(std::get<SphereShape>(shape_of(R"("type": "sphere", "radius": 2)")).radius, 2);
  EXPECT_EQ(std::get<DiskShape>(shape_of(R"("type": "disk", "radius": "1 ft")")).radius, 0.3048);
  EXPECT_EQ(std::get<RectShape>(shape_of(R"("type": "rect", "width": 1, "height": 2)")).height, 2);
  const auto polygon = std::get<PolygonShape>(shape_of(R"("type": "polygon", "points": [[0, 0], ["50 cm", 0], [0, 1]])"));
  ASSERT_EQ(polygon.points.size(), 3u);
  EXPECT_EQ(polygon.points[1], (Vec2d{0.5, 0}));
  const auto tube = std::get<TubeShape>(shape_of(R"("type": "tube", "length": 1, "radius": "13 mm", "caps": "flat")"));
  EXPECT_EQ(tube.caps, Caps::flat);
  EXPECT_EQ(tube.radius, 0.013);
  EXPECT_EQ(std::get<TubeShape>(shape_of(R"("type": "tube", "length": 1, "radius": 1)")).caps, Caps::round);
  EXPECT_EQ(std::get<LineShape>(shape_of(R"("type": "line", "length": 3)")).length, 3);
  const auto mesh = std::get<MeshShape>(shape_of(R"("type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2], "scale": 2)"));
  EXPECT_EQ(mesh.scale, (Vec3d{2, 2, 2}));
  EXPECT_FALSE(std::get<EnvironmentShape>(shape_of(R"("type": "environment")", R"("luminance": "5 knit")")).image);
}

TEST(RigImport, EveryUnitOfEmission) {
  struct Case {
    std::string_view shape, emission;
    Emission::Given given;
    double value;
    bool radiant;
  };
  constexpr std::string_view point = R"("type": "point")", rect = R"("type": "rect", "width": 1, "height": 1)",
                             sun = R"("type": "distant")";
  const std::vector<Case> cases = {
      {point, R"("flux": "1.5 klm")", Emission::Given::flux, 1500, false},
      {point, R"("intensity": "200 mcd")", Emission::Given::intensity, 0.2, false},
      {rect, R"("luminance": "5000 cd/m2")", Emission::Given::luminance, 5000, false},
      {sun, R"("illuminance": "100 klx")", Emission::Given::illuminance, 1e5, false},
      {point, R"("illuminance": "300 lux", "distance": "2 m")", Emission::Given::illuminance, 300, false},
      {rect, R"("ev": "-3 EV")", Emission::Given::ev, -3, false},
      {point, R"("radiant_flux": "40 W", "efficacy": "100 lm/W")", Emission::Given::flux, 40, true},
      {point, R"("radiant_intensity": "3 W/sr", "efficacy": "100 lm/W")", Emission::Given::intensity, 3, true},
      {rect, R"("radiance": "7 W/m2/sr", "efficacy": "100 lm/W")", Emission::Given::luminance, 7, true},
      {sun, R"("irradiance": "1000 W/m2", "efficacy": "100 lm/W")", Emission::Given::illuminance, 1000, true},
  };
  for (const Case& c : cases) {
    const Emission e = only_light(fmt::format(R"("shape": {{{}}}, "emission": {{{}}})", c.shape, c.emission)).emission;
    EXPECT_EQ(e.given, c.given) << c.emission;
    EXPECT_DOUBLE_EQ(e.value, c.value) << c.emission;
    EXPECT_EQ(e.radiant, c.radiant) << c.emission;
    EXPECT_EQ(e.efficacy_lm_W.value_or(0), c.radiant ? 100 : 0) << c.emission;
  }
  EXPECT_EQ(only_light(R"("shape": {"type": "point"}, "emission": {"illuminance": "1 lx", "distance": "50 cm"})").emission.distance_m, 0.5);
}

TEST(RigImport, EveryKeyOfALight) {
  const Light l = only_light(std::string(R"("name": "a", "shape": {"type": "spot", "outer": "1 rad"}, "emission": {"flux": "1 lm"},
    "colour": {"daylight": "5600 K"}, "filter": [1, 0.5, 0], "visible": false, "range": "8 m", "falloff": "frostbite",
    "flux_convention": "frostbite_pi", "translation": [1, "2 ft", -3], "rotation": [0, 1, 0, 0])"));
  EXPECT_EQ(std::get<DaylightColour>(l.colour).kelvin, 5600);
  EXPECT_EQ(l.filter, (Rgb{1, 0.5, 0}));
  EXPECT_FALSE(l.visible);
  EXPECT_EQ(l.range_m, 8);
  EXPECT_EQ(l.falloff, Falloff::frostbite);
  EXPECT_EQ(l.flux_convention, FluxConvention::frostbite_pi);
  EXPECT_EQ(l.transform.translation, (Vec3d{1, 0.6096, -3}));
  EXPECT_EQ(l.transform.vector({0, 0, -1}), (Vec3d{0, 0, 1}));  // half a turn about Y
  EXPECT_TRUE(only_light(R"("shape": {"type": "disk", "radius": 1}, "emission": {"flux": "1 lm"}, "two_sided": true)").two_sided);
  EXPECT_EQ(only_light(std::string(bulb) + R"("range": 1, "falloff": "gltf")").falloff, Falloff::gltf);
  const auto falloff = [](const std::string& fields) {
    return only_light(std::string(bulb) + R"("range": 2, "falloff": )" + fields).falloff;
  };
  EXPECT_EQ(falloff(R"("linear")"), Falloff::linear);
  EXPECT_EQ(falloff(R"("power", "falloff_exponent": 20)"), (Falloff{Falloff::Law::power, 20}));
  EXPECT_EQ(falloff(R"("power", "falloff_exponent": 4)"), Falloff::gltf);
  EXPECT_EQ(falloff(R"("frostbite", "falloff_exponent": 2.5)"), (Falloff{Falloff::Law::power_squared, 2.5}));
  EXPECT_EQ(falloff(R"("smoothstep")"), Falloff::smoothstep);
  EXPECT_EQ(falloff(R"("scale_bias")"), Falloff::scale_bias);
  EXPECT_EQ(falloff(R"("karis")"), Falloff::karis);
  EXPECT_EQ(only_light(std::string(bulb) + R"("falloff": "karis")").falloff, Falloff::karis);  // and no warning
  const Light plain = only_light(std::string(bulb) + R"("name": "b")");
  EXPECT_TRUE(plain.visible);
  EXPECT_FALSE(plain.two_sided);
  EXPECT_FALSE(plain.range_m);
  EXPECT_EQ(std::get<RgbColour>(plain.colour).rgb, (Rgb{1, 1, 1}));
}

TEST(RigImport, MaterialsObjectsAndCameras) {
  const Imported imported = read(R"({"etendue": 1, "materials": [
      {"name": "p", "model": "principled", "base_colour": [0.1, 0.2, 0.3], "metallic": 0.4, "roughness": 0.5, "specular": 0.6},
      {"name": "s", "model": "standard", "base_colour": [1, 1, 1], "metal": 0.25, "smoothness": 0.75, "reflectance": 0.5},
      {"name": "c", "model": "conductor", "eta": [0.2, 0.9, 1.1], "k": [3.9, 2.4, 2.2], "alpha": 0.2, "masking": "correlated"},
      {"name": "f", "model": "conductor", "f0": [0.04, 0.25, 0.64]},
      {"name": "g", "model": "metal_rough", "metallic": 0, "roughness": 0.3, "ior": 1.33, "double_sided": false}],
    "meshes": [{"name": "tri", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "uvs": [0, 0, 1, 0, 0, 1], "indices": [0, 1, 2]}],
    "objects": [
      {"name": "box", "shape": {"type": "box", "size": [1, "20 cm", 3]}, "material": "s", "scale": [1, 2, -1]},
      {"shape": {"type": "box", "size": 2}, "material": 2, "matrix": [1,0,0,0, 0.5,1,0,0, 0,0,1,0, 4,5,6,1]},
      {"shape": {"type": "sphere", "radius": "10 in"}, "scale": 2},
      {"shape": {"type": "mesh", "mesh": "tri"}},
      {"shape": {"type": "mesh", "positions": [0,0,0, 1,0,0, 0,0,1], "normals": [0,1,0, 0,1,0, 0,1,0], "indices": [0, 2, 1]}}],
    "cameras": [
      {"name": "top", "position": [0, 5, 0], "target": [0, 0, 0], "up": [1, 0, 0], "aspect": 1.5},
      {"name": "turned", "position": [1, 2, 3], "rotation": [0, 0, 0.6, 0.8], "exposure": {"ev100": "9.5 EV"}}]})");
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  const Scene& s = imported.scene;
  EXPECT_TRUE(validate(s).all().empty()) << told(validate(s));
  ASSERT_EQ(s.materials.size(), 5u);
  EXPECT_EQ(std::get<Principled>(s.materials[0].model).specular, 0.6);
  EXPECT_EQ(std::get<Standard>(s.materials[1].model).roughness, 0.25);
  EXPECT_EQ(std::get<Conductor>(s.materials[2].model).k.y, 2.4);
  EXPECT_EQ(std::get<Conductor>(s.materials[2].model).masking, Masking::correlated);
  // (eta - 1)^2 / (eta + 1)^2 is the reflectance again: .25 has eta = 3.
  EXPECT_NEAR(std::get<Conductor>(s.materials[3].model).eta.y, 3, 1e-14);
  EXPECT_EQ(std::get<MetalRough>(s.materials[4].model).ior, 1.33);
  EXPECT_FALSE(s.materials[4].double_sided);
  EXPECT_EQ(s.materials[4].source, "/materials/4");
  ASSERT_EQ(s.objects.size(), 5u);
  EXPECT_EQ(std::get<BoxGeometry>(s.objects[0].geometry).size, (Vec3d{1, 0.2, 3}));
  EXPECT_EQ(s.objects[0].transform.vector({1, 1, 1}), (Vec3d{1, 2, -1}));
  EXPECT_EQ(s.objects[0].material, 1u);
  EXPECT_EQ(s.objects[1].material, 2u);
  EXPECT_EQ(s.objects[1].transform.point({0, 2, 0}), (Vec3d{5, 7, 6}));
  EXPECT_EQ(std::get<SphereGeometry>(s.objects[2].geometry).radius, 0.254);
  EXPECT_EQ(s.objects[2].material, no_index);
  EXPECT_EQ(std::get<MeshGeometry>(s.objects[3].geometry).mesh, 0u);
  EXPECT_EQ(std::get<MeshGeometry>(s.objects[4].geometry).mesh, 1u);
  EXPECT_EQ(s.meshes[0].uvs.size(), 3u);
  EXPECT_EQ(s.meshes[1].normals[2], (Vec3f{0, 1, 0}));
  ASSERT_EQ(s.cameras.size(), 2u);
  // Looking down with +X up, right is forward x up = -Y x X = Z.
  EXPECT_NEAR(length(s.cameras[0].transform.vector({1, 0, 0}) - Vec3d{0, 0, 1}), 0, 1e-15);
  EXPECT_NEAR(length(s.cameras[0].transform.vector({0, 0, -1}) - Vec3d{0, -1, 0}), 0, 1e-15);
  EXPECT_EQ(s.cameras[0].aspect, 1.5);
  EXPECT_EQ(s.cameras[1].ev100, 9.5);
  EXPECT_EQ(s.cameras[1].transform.translation, (Vec3d{1, 2, 3}));
}

TEST(RigImport, TopLevelErrors) {
  expect_told(R"($[])", {{"TYPE_MISMATCH", ""}});
  expect_told(R"(${})", {{"KEY_MISSING", ""}});
  expect_told(R"({"etendue": $2})", {{"VERSION_UNKNOWN", "/etendue"}});
  expect_told(R"({"etendue": $"1"})", {{"VERSION_UNKNOWN", "/etendue"}});
  expect_told("{\"etendue\": 1,\n $\"light\": []}", {{"KEY_UNKNOWN", "/light"}});
  expect_told(R"({"etendue": 1, "lights": ${}})", {{"TYPE_MISMATCH", "/lights"}});
  expect_told(R"({"etendue": 1, "lights": [], $"lights": []})", {{"KEY_DUPLICATE", "/lights"}});
  expect_told(R"({"etendue": 1, "camera": {"position": [0,0,1], "target": [0,0,0]}, $"cameras": []})", {{"KEYS_EXCLUSIVE", "/cameras"}});
}

TEST(RigImport, LightErrors) {
  expect_told(R"({"etendue": 1, "lights": [$7]})", {{"TYPE_MISMATCH", "/lights/0"}});
  expect_told(R"({"etendue": 1, "lights": [${}]})", {{"KEY_MISSING", "/lights/0"}});
  expect_light_told(R"("shape": ${})", "KEY_MISSING", "/shape");
  expect_light_told(R"("shape": {"type": $"rekt"})", "VALUE_UNKNOWN", "/shape/type");
  expect_light_told(R"("shape": {"type": $3})", "VALUE_UNKNOWN", "/shape/type");
  const std::string with_emission = R"(, "emission": {"flux": "1 lm"})";
  const auto shape = [&](std::string_view fields, std::string_view code, std::string_view pointer) {
    expect_light_told(fmt::format("\"shape\": {}{}", fields, with_emission), code, pointer);
  };
  shape(R"(${"type": "rect", "width": 1})", "KEY_MISSING", "/shape");
  shape(R"({"type": "rect", "width": 1, "height": 1, $"radius": 1})", "KEY_UNKNOWN", "/shape/radius");
  shape(R"({"type": "rect", "width": $-1, "height": 1})", "VALUE_OUT_OF_RANGE", "/shape/width");
  shape(R"({"type": "rect", "width": 1, "height": $"0 m"})", "VALUE_OUT_OF_RANGE", "/shape/height");
  shape(R"({"type": "rect", "width": $"1", "height": 1})", "UNIT_MISSING", "/shape/width");
  shape(R"({"type": "rect", "width": $"1 metre", "height": 1})", "UNIT_UNKNOWN", "/shape/width");
  shape(R"({"type": "rect", "width": $"1 lm", "height": 1})", "DIMENSION_MISMATCH", "/shape/width");
  shape(R"({"type": "rect", "width": $"x m", "height": 1})", "NUMBER_INVALID", "/shape/width");
  shape(R"({"type": "rect", "width": $true, "height": 1})", "TYPE_MISMATCH", "/shape/width");
  shape(R"({"type": "spot", "outer": $45})", "UNIT_MISSING", "/shape/outer");
  shape(R"({"type": "spot", "inner": $"50 deg", "outer": "40 deg"})", "VALUE_OUT_OF_RANGE", "/shape/inner");
  shape(R"({"type": "spot", "outer": $"91 deg"})", "VALUE_OUT_OF_RANGE", "/shape/outer");
  shape(R"({"type": "spot", "outer": $"0 deg"})", "VALUE_OUT_OF_RANGE", "/shape/outer");
  shape(R"({"type": "spot", "inner": $"-1 deg", "outer": "40 deg"})", "VALUE_OUT_OF_RANGE", "/shape/inner");
  shape(R"({"type": "frustum", "width_angle": $"180 deg", "height_angle": "1 deg"})", "VALUE_OUT_OF_RANGE", "/shape/width_angle");
  shape(R"({"type": "frustum", "width_angle": "18 deg", "height_angle": $"0 deg"})", "VALUE_OUT_OF_RANGE", "/shape/height_angle");
  shape(R"({"type": "polygon", "points": $[[0, 0], [1, 0]]})", "VALUE_OUT_OF_RANGE", "/shape/points");
  shape(R"({"type": "polygon", "points": $[[0, 0], [1, 1], [2, 2]]})", "VALUE_OUT_OF_RANGE", "/shape/points");
  shape(R"({"type": "polygon", "points": $[[0, 0], [2, 2], [2, 0], [0, 1]]})", "POLYGON_NOT_SIMPLE", "/shape/points");
  shape(R"({"type": "polygon", "points": [[0, 0], $[1], [2, 0]]})", "TYPE_MISMATCH", "/shape/points/1");
  shape(R"({"type": "tube", "length": 1, "radius": 1, "caps": $"square"})", "VALUE_UNKNOWN", "/shape/caps");
  shape(R"({"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0, 1, $3]})", "VALUE_OUT_OF_RANGE", "/shape/indices/2");
  shape(R"({"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "indices": $[0, 1]})", "TYPE_MISMATCH", "/shape/indices");
  shape(R"({"type": "mesh", "positions": $[0,0,0, 1,0], "indices": [0, 1, 1]})", "TYPE_MISMATCH", "/shape/positions");
  shape(R"({"type": "mesh", "positions": [$1e39,0,0], "indices": [0, 0, 0]})", "VALUE_OUT_OF_RANGE", "/shape/positions/0");
  shape(R"({"type": "mesh", "mesh": $"none"})", "REFERENCE_UNKNOWN", "/shape/mesh");
  shape(R"({"type": "photometric", "file": $"../a.ies"})", "PATH_REFUSED", "/shape/file");
  shape(R"({"type": "photometric", "file": $"/a.ies"})", "PATH_REFUSED", "/shape/file");
  shape(R"({"type": "photometric", "file": $"a/../../b.ies"})", "PATH_REFUSED", "/shape/file");
  shape(R"({"type": "photometric", "file": $"file:a.ies"})", "PATH_REFUSED", "/shape/file");
  shape(R"({"type": "photometric", "file": $"absent.ies"})", "FILE_MISSING", "/shape/file");
  expect_told(
      R"({"etendue": 1, "lights": [{"shape": {"type": "photometric", "file": $"absent.ies", "cone": {"outer": "30 deg", "inner": $"31 deg"}}}]})",
      {{"FILE_MISSING", "/lights/0/shape/file"}, {"VALUE_OUT_OF_RANGE", "/lights/0/shape/cone/inner"}});
  expect_told(R"({"etendue": 1, "lights": [{"shape": {"type": "photometric", "file": $"absent.ies", "cone": ${}}}]})",
              {{"FILE_MISSING", "/lights/0/shape/file"}, {"KEY_MISSING", "/lights/0/shape/cone"}});
  shape(R"({"type": "mesh", "gltf": $"absent.glb"})", "FILE_MISSING", "/shape/gltf");
  const auto more = [&](std::string_view fields, std::string_view code, std::string_view pointer) {
    expect_light_told(std::string(bulb) + std::string(fields), code, pointer);
  };
  more(R"($"colour ": {})", "KEY_UNKNOWN", "/colour ");
  more(R"("colour": ${})", "KEY_MISSING", "/colour");
  more(R"("colour": {"rgb": [1, 1, 1], $"temperature": "3000 K"})", "KEYS_EXCLUSIVE", "/colour/temperature");
  more(R"("colour": {"rgb": $[1, 1]})", "TYPE_MISMATCH", "/colour/rgb");
  more(R"("colour": {"rgb": $[0, 0, 0]})", "VALUE_OUT_OF_RANGE", "/colour/rgb");
  more(R"("colour": {"temperature": $3000})", "UNIT_MISSING", "/colour/temperature");
  more(R"("colour": {"temperature": $"50 K"})", "TEMPERATURE_OUT_OF_RANGE", "/colour/temperature");
  more(R"("colour": {"daylight": $"3000 K"})", "TEMPERATURE_OUT_OF_RANGE", "/colour/daylight");
  more(R"("filter": [1, $-0.1, 1])", "VALUE_OUT_OF_RANGE", "/filter/1");
  more(R"("two_sided": $1)", "TYPE_MISMATCH", "/two_sided");
  more(R"("visible": $"yes")", "TYPE_MISMATCH", "/visible");
  more(R"("range": $"-2 m", "falloff": "gltf")", "VALUE_OUT_OF_RANGE", "/range");
  more(R"("falloff": $"cubic")", "VALUE_UNKNOWN", "/falloff");
  more(R"("range": 2, "falloff": $"power")", "KEY_MISSING", "/falloff");
  more(R"("range": 2, "falloff": "power", "falloff_exponent": $0.5)", "VALUE_OUT_OF_RANGE", "/falloff_exponent");
  more(R"("range": 2, "falloff": "frostbite", "falloff_exponent": $65)", "VALUE_OUT_OF_RANGE", "/falloff_exponent");
  more(R"("range": 2, "falloff": "frostbite", "falloff_exponent": $"4 m")", "TYPE_MISMATCH", "/falloff_exponent");
  more(R"("range": $1, "falloff": "scale_bias")", "VALUE_OUT_OF_RANGE", "/range");
  more(R"("flux_convention": $"pi")", "VALUE_UNKNOWN", "/flux_convention");
  more(R"("rotation": $[0, 0, 0, 1.002])", "ROTATION_NOT_UNIT", "/rotation");
  more(R"("rotation": $[0, 0, 1])", "TYPE_MISMATCH", "/rotation");
  more(R"("translation": $[0, 0])", "TYPE_MISMATCH", "/translation");
  more(R"("translation": [0, 0, $"1 K"])", "DIMENSION_MISMATCH", "/translation/2");
  more(R"("name": $5)", "TYPE_MISMATCH", "/name");
  more(R"($"scale": 2)", "KEY_UNKNOWN", "/scale");
}

TEST(RigImport, EmissionErrors) {
  expect_told("{\"etendue\": 1, \"lights\": [\n${\"shape\": {\"type\": \"point\"}}]}", {{"EMISSION_MISSING", "/lights/0"}});
  expect_told(R"({"etendue": 1, "lights": [${"shape": {"type": "environment"}}]})", {{"EMISSION_MISSING", "/lights/0"}});
  const auto point = [](std::string_view emission, std::string_view code, std::string_view pointer) {
    expect_light_told(fmt::format(R"("shape": {{"type": "point"}}, "emission": {})", emission), code, "/emission" + std::string(pointer));
  };
  point(R"(${})", "EMISSION_MISSING", "");
  point(R"({"flux": $1500})", "UNIT_MISSING", "/flux");
  point(R"({"flux": $"-1 lm"})", "VALUE_OUT_OF_RANGE", "/flux");
  point(R"({"flux": $"800 cd"})", "DIMENSION_MISMATCH", "/flux");
  point(R"({"flux": "1 lm", $"intensity": "1 cd"})", "KEYS_EXCLUSIVE", "/intensity");
  point(R"({"radiant_flux": $"1 W"})", "EFFICACY_MISSING", "/radiant_flux");
  point(R"({"radiant_flux": "1 W", "efficacy": $"0 lm/W"})", "VALUE_OUT_OF_RANGE", "/efficacy");
  point(R"({"flux": "1 lm", $"flx": "1 lm"})", "KEY_UNKNOWN", "/flx");
  point(R"(${"illuminance": "1 lx"})", "DISTANCE_MISSING", "");
  point(R"(${"luminance": "1 nit"})", "UNIT_UNSUITABLE", "");
  point(R"({"flux": "1 lm", "texture": $"../a.png"})", "PATH_REFUSED", "/texture");
  point(R"({"flux": "1 lm", "texture": ${}})", "KEY_MISSING", "/texture");
}

TEST(RigImport, SurfaceAndCameraErrors) {
  const auto material = [](std::string_view fields, std::string_view code, std::string_view pointer) {
    expect_told(fmt::format(R"({{"etendue": 1, "materials": [{}]}})", fields), {{code, "/materials/0" + std::string(pointer)}});
  };
  material(R"({"model": $"phong"})", "VALUE_UNKNOWN", "/model");
  material(R"({"model": "lambert", "base_colour": [0, $1.5, 0]})", "VALUE_OUT_OF_RANGE", "/base_colour/1");
  material(R"({"model": "lambert", $"roughness": 1})", "KEY_UNKNOWN", "/roughness");
  material(R"({"model": "standard", "roughness": 1, $"smoothness": 1})", "KEYS_EXCLUSIVE", "/smoothness");
  material(R"(${"model": "conductor", "eta": [1, 1, 1]})", "KEY_MISSING", "");
  material(R"({"model": "conductor", $"f0": [0, 0, 0], "k": [1, 1, 1]})", "KEYS_EXCLUSIVE", "/f0");
  material(R"({"model": "conductor", "f0": [0, $1, 0]})", "VALUE_OUT_OF_RANGE", "/f0/1");
  material(R"({"model": "conductor", "f0": [0, 0, 0], "alpha": $0})", "VALUE_OUT_OF_RANGE", "/alpha");
  const auto object = [](std::string_view fields, std::string_view code, std::string_view pointer) {
    expect_told(fmt::format(R"({{"etendue": 1, "objects": [{}]}})", fields), {{code, "/objects/0" + std::string(pointer)}});
  };
  object(R"(${})", "KEY_MISSING", "");
  object(R"({"shape": {"type": "plane", "size": $[1, 1]}})", "TYPE_MISMATCH", "/shape/size");
  object(R"({"shape": {"type": "box", "size": [1, $0, 1]}})", "VALUE_OUT_OF_RANGE", "/shape/size/1");
  object(R"({"shape": {"type": "box", "size": 1}, "material": $"floor"})", "REFERENCE_UNKNOWN", "/material");
  object(R"({"shape": {"type": "box", "size": 1}, "material": $0})", "REFERENCE_UNKNOWN", "/material");
  object(R"({"shape": {"type": "box", "size": 1}, "scale": $[1, 0, 1]})", "VALUE_OUT_OF_RANGE", "/scale");
  object(R"({"shape": {"type": "box", "size": 1}, "scale": 1, $"matrix": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})", "KEYS_EXCLUSIVE", "/matrix");
  object(R"({"shape": {"type": "box", "size": 1}, "matrix": $[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})", "VALUE_OUT_OF_RANGE", "/matrix");
  object(R"(${"shape": {"type": "sphere", "radius": 1}, "scale": [1, 2, 1]})", "VALUE_OUT_OF_RANGE", "");
  object(R"({"shape": {"type": "box", "size": 1}, $"gltf": "a.glb"})", "KEYS_EXCLUSIVE", "/gltf");
  object(R"({"gltf": $"../a.glb"})", "PATH_REFUSED", "/gltf");
  expect_told(R"({"etendue": 1, "materials": [{"name": "m", "model": "lambert"}, {"name": "m", "model": "lambert"}],
                  "objects": [{"shape": {"type": "box", "size": 1}, "material": $"m"}]})",
              {{"REFERENCE_AMBIGUOUS", "/objects/0/material"}});
  const auto camera = [](std::string_view fields, std::string_view code, std::string_view pointer) {
    expect_told(fmt::format(R"({{"etendue": 1, "camera": {}}})", fields), {{code, "/camera" + std::string(pointer)}});
  };
  camera(R"(${"position": [0, 0, 1]})", "KEY_MISSING", "");
  camera(R"(${"target": [0, 0, 1]})", "KEY_MISSING", "");
  camera(R"({"position": [0, 0, 1], "target": $[0, 0, 1]})", "VALUE_OUT_OF_RANGE", "/target");
  camera(R"({"position": [0, 0, 1], "target": [0, 0, 0], "up": $[0, 0, 5]})", "VALUE_OUT_OF_RANGE", "/up");
  camera(R"({"position": [0, 0, 1], "target": [0, 0, 0], "vfov": $40})", "UNIT_MISSING", "/vfov");
  camera(R"({"position": [0, 0, 1], "target": [0, 0, 0], "vfov": $"180 deg"})", "VALUE_OUT_OF_RANGE", "/vfov");
  camera(R"({"position": [0, 0, 1], "target": [0, 0, 0], "exposure": {"ev100": $"8 lm"}})", "DIMENSION_MISMATCH", "/exposure/ev100");
}

TEST(RigImport, ReportsAllErrorsInTheOrderOfTheFile) {
  expect_told(R"({ "etendue": 1,
    "objects": [ { "shape": {"type": "plane", "size": $-10}, "material": $"flor" } ],
    "lights": [ { "shape": {"type": "rect", "width": $"1 lm", "height": "60 cm"}, "emission": {"flux": $1500} },
                { "shape": {"type": "sphere", $"raduis": "3 cm", "radius": 1}, "emission": {"luminance": "20 knit"} } ],
    "materials": [ { "name": "floor", "model": "lambert", "base_colour": [0.5, $"x", 0.5] } ] })",
              {{"VALUE_OUT_OF_RANGE", "/objects/0/shape/size"},
               {"REFERENCE_UNKNOWN", "/objects/0/material"},
               {"DIMENSION_MISMATCH", "/lights/0/shape/width"},
               {"UNIT_MISSING", "/lights/0/emission/flux"},
               {"KEY_UNKNOWN", "/lights/1/shape/raduis"},
               {"TYPE_MISMATCH", "/materials/0/base_colour/1"}});
}

TEST(RigImport, HintsAtTheNearestWord) {
  const Imported imported = read(light(R"("shape": {"type": "spher", "radius": 1}, "emision": {"flux": "1 lm"})"));
  ASSERT_EQ(imported.diagnostics.all().size(), 2u) << told(imported.diagnostics);
  EXPECT_EQ(imported.diagnostics.all()[0].hint, "did you mean \"sphere\"?");
  EXPECT_EQ(imported.diagnostics.all()[1].hint, "did you mean \"emission\"?");
}

TEST(RigImport, NamesOfLightsAreUnique) {
  const std::string one = R"({"name": "a", "shape": {"type": "point"}, "emission": {"flux": "1 lm"}})";
  const std::string nameless = R"({"shape": {"type": "point"}, "emission": {"flux": "1 lm"}})";
  const Imported imported = read(fmt::format(R"({{"etendue": 1, "lights": [{0}, {0}, {1}, {0}, {1}]}})", one, nameless));
  std::string names;
  for (const Light& l : imported.scene.lights) names += l.name + ",";
  EXPECT_EQ(names, "a,a 2,point,a 3,point 2,");
  ASSERT_EQ(imported.diagnostics.all().size(), 2u) << told(imported.diagnostics);  // of names that were given
  EXPECT_EQ(imported.diagnostics.all()[0].severity, Severity::warning);
  EXPECT_EQ(imported.diagnostics.all()[0].where.pointer, "/lights/1/name");
}

TEST(RigImport, WarnsOfKeysWithoutEffect) {
  const auto more = [](std::string_view fields, std::string_view pointer) {
    expect_light_told(std::string(bulb) + std::string(fields), "KEY_WITHOUT_EFFECT", pointer);
  };
  more(R"("range": $"2 m")", "/range");
  more(R"("falloff": $"gltf")", "/falloff");
  more(R"("falloff": $"smoothstep")", "/falloff");
  more(R"("range": "2 m", "falloff": "gltf", "falloff_exponent": $3)", "/falloff_exponent");
  more(R"("flux_convention": $"cone")", "/flux_convention");
}

TEST(RigImport, BrokenJsonIsAnErrorWithItsPlace) {
  const Result<Imported> imported = rig::read_rig_text("{\"etendue\": 1,\n \"lights\": [}", "t.rig.json", "", nullptr, {});
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, "JSON_INVALID");
  EXPECT_EQ(to_string(imported.error().where), "t.rig.json:2:13");
  ImportOptions shallow;
  shallow.max_depth = 2;
  const Result<Imported> deep = rig::read_rig_text(sample, "t.rig.json", "", nullptr, shallow);
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().code, "JSON_TOO_DEEP");
}

TEST(RigImport, HonoursLimitsAndNeeds) {
  ImportOptions few;
  few.max_items = 1;
  const Imported limited = read(sample, few);
  ASSERT_EQ(limited.diagnostics.all().size(), 1u) << told(limited.diagnostics);
  EXPECT_EQ(limited.diagnostics.all()[0].code, "TOO_MANY_ITEMS");
  ImportOptions lights_alone;
  lights_alone.need = Need::lights;
  const Imported lights = read(sample, lights_alone);
  EXPECT_EQ(lights.scene.lights.size(), 2u);
  EXPECT_TRUE(lights.scene.objects.empty() && lights.scene.cameras.empty() && lights.scene.materials.empty());
  EXPECT_EQ(lights.stats.skipped_meshes, 1u);
}

TEST(RigImport, SniffsTheKey) {
  const Registry none;
  const std::unique_ptr<Importer> importer = make_rig_importer(none);
  const auto sniff = [&](std::string_view head) { return importer->sniff(std::as_bytes(std::span(head))); };
  EXPECT_EQ(sniff(" {\n\"etendue\" : 1"), 100);
  EXPECT_LT(sniff(R"({"asset": {"generator": "etendue", "version": "2.0"}})"), 10);
  EXPECT_EQ(sniff("etendue"), 0);
  EXPECT_EQ(sniff(""), 0);
}

// Every whole rig in the documentation is one.
TEST(RigImport, ReadsTheDocumentation) {
  std::ifstream stream(source_dir() / "sdk" / "docs" / "rig.md");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::string_view opening = "```json\n", closing = "```";
  int count = 0;
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at + 1), ++count) {
    const std::size_t begin = at + opening.size();
    const Imported imported = read(std::string_view(text).substr(begin, text.find(closing, begin) - begin));
    EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
    EXPECT_TRUE(validate(imported.scene).all().empty()) << told(validate(imported.scene));
  }
  EXPECT_EQ(count, 2);
}

// A folder of its own for each test, removed afterwards.
class RigImportFiles : public testing::Test {
 protected:
  RigImportFiles() : folder_(std::filesystem::temp_directory_path() / fmt::format("etendue_rig_{:08x}", std::random_device()())) {
    std::filesystem::create_directories(folder_ / "rig" / "sub");
  }
  ~RigImportFiles() override { std::filesystem::remove_all(folder_); }

  void put(const std::filesystem::path& name, std::string_view text) { std::ofstream(folder_ / name, std::ios::binary) << text; }
  Imported read_file(std::string_view text, const Registry& others = {}) {
    put("rig/t.rig.json", text);
    Result<Imported> imported = make_rig_importer(others)->read(folder_ / "rig" / "t.rig.json", {});
    if (imported) return std::move(*imported);
    ADD_FAILURE() << to_string(to_diagnostic(imported.error()));
    return {};
  }

  std::filesystem::path folder_;
};

TEST_F(RigImportFiles, TexturesAndEnvironments) {
  put("rig/a.png", "x");
  put("rig/sub/sky.hdr", "x");
  const std::string text = R"({"etendue": 1, "lights": [
    {"shape": {"type": "rect", "width": 1, "height": 1}, "emission": {"luminance": "1 nit", "texture": "a.png"}},
    {"shape": {"type": "disk", "radius": 1}, "emission": {"luminance": "1 nit",
      "texture": {"file": "a.png", "encoding": "linear", "wrap": ["clamp", "mirror"], "nearest": true, "uv_transform": [2, 0, 0.5, 0, 3, 0], "uv_set": 1}}},
    {"shape": {"type": "environment", "file": "sub/sky.hdr"}}]})";
  const Imported imported = read_file(text);
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  EXPECT_EQ(imported.stats.bytes_read, text.size());
  const Scene& s = imported.scene;
  ASSERT_EQ(s.images.size(), 2u);  // one file is one image
  EXPECT_TRUE(std::filesystem::equivalent(s.images[0].file, folder_ / "rig" / "a.png"));
  ASSERT_TRUE(s.lights[0].emission.texture && s.lights[1].emission.texture);
  EXPECT_EQ(s.lights[0].emission.texture->encoding, Encoding::srgb);
  const Texture& t = *s.lights[1].emission.texture;
  EXPECT_EQ(t.encoding, Encoding::linear);
  EXPECT_EQ(t.wrap_u, Wrap::clamp);
  EXPECT_EQ(t.wrap_v, Wrap::mirror);
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(t.uv_transform[0][2], 0.5);
  EXPECT_EQ(t.uv_transform[1][1], 3);
  EXPECT_EQ(t.uv_set, 1);
  EXPECT_EQ(std::get<EnvironmentShape>(s.lights[2].shape).image, 1u);
  EXPECT_EQ(s.lights[2].emission.given, Emission::Given::as_file);
}

TEST_F(RigImportFiles, NoPathLeadsOutOfTheFolder) {
  put("secret.exr", "x");
  std::error_code failure;
  std::filesystem::create_symlink(folder_ / "secret.exr", folder_ / "rig" / "link.exr", failure);
  if (failure) GTEST_SKIP() << "no symbolic links here: " << failure.message();
  const Imported imported = read_file(R"({"etendue": 1, "lights": [{"shape": {"type": "environment", "file": "link.exr"}}]})");
  ASSERT_EQ(imported.diagnostics.all().size(), 2u) << told(imported.diagnostics);
  EXPECT_EQ(imported.diagnostics.all()[0].code, "EMISSION_MISSING");
  EXPECT_EQ(imported.diagnostics.all()[1].code, "PATH_REFUSED");
  std::filesystem::create_symlink(folder_ / "rig" / "t.rig.json", folder_ / "rig" / "inside.exr");
  EXPECT_FALSE(
      read_file(R"({"etendue": 1, "lights": [{"shape": {"type": "environment", "file": "inside.exr"}}]})").diagnostics.has_errors());
}

// Stands for the glTF importer: a lamp and a triangle of 1 m2 / 2, whatever the file.
class TwoThings : public Importer {
 public:
  FormatInfo describe() const override { return {"gltf", "", {".glb"}, ""}; }
  int sniff(std::span<const std::byte>) const override { return 0; }
  Result<Imported> read(const std::filesystem::path&, const ImportOptions&) const override {
    Imported imported;
    Scene& s = imported.scene;
    s.images.push_back({"i.png", nullptr, "", "i"});
    Material skin;
    skin.name = "skin";
    skin.base_colour_texture = Texture{};
    skin.source = "/materials/0";
    s.materials.push_back(skin);
    s.meshes.push_back({"tri", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {0, 1, 2}, "/meshes/0"});
    s.objects.push_back({"wall", MeshGeometry{0}, 0, Transform::from_trs({0, 0, 1}, {}), "/nodes/0"});
    Light lamp;
    lamp.name = "lamp";
    lamp.emission = {Emission::Given::intensity, 5, false, {}, {}, {}};
    lamp.transform.translation = {1, 0, 0};
    lamp.source = "/nodes/1";
    s.lights.push_back(lamp);
    lamp.name = "glow";
    lamp.shape = MeshShape{0, {1, 1, 1}};
    lamp.emission = {Emission::Given::luminance, 7, false, {}, {}, {}};
    lamp.surface_material = 0;
    s.lights.push_back(lamp);
    s.cameras.emplace_back();
    return imported;
  }
};

TEST_F(RigImportFiles, MergesAnAsset) {
  put("rig/room.glb", "x");
  Registry others;
  others.add(std::make_unique<TwoThings>());
  const Imported imported = read_file(R"({"etendue": 1,
    "materials": [{"model": "lambert"}],
    "meshes": [{"positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2]}],
    "lights": [{"name": "lamp", "shape": {"type": "point"}, "emission": {"flux": "1 lm"}}],
    "objects": [{"gltf": "room.glb", "translation": [0, 10, 0], "scale": 2},
                {"name": "b", "gltf": "room.glb", "material": 0, "scale": [1, 1, -3]}]})",
                                      others);
  EXPECT_FALSE(imported.diagnostics.has_errors()) << told(imported.diagnostics);
  const Scene& s = imported.scene;
  EXPECT_TRUE(validate(s).all().empty()) << told(validate(s));
  EXPECT_TRUE(s.cameras.empty());
  ASSERT_EQ(s.images.size(), 2u);
  ASSERT_EQ(s.materials.size(), 3u);
  EXPECT_EQ(s.materials[2].base_colour_texture->image, 1u);
  ASSERT_EQ(s.objects.size(), 2u);
  EXPECT_EQ(s.objects[0].material, 1u);
  EXPECT_EQ(std::get<MeshGeometry>(s.objects[0].geometry).mesh, 1u);
  EXPECT_EQ(s.objects[0].transform.point({0, 0, 0}), (Vec3d{0, 10, 2}));
  EXPECT_EQ(s.objects[0].source, "room.glb#/nodes/0");
  EXPECT_EQ(s.objects[1].name, "b/wall");
  EXPECT_EQ(s.objects[1].material, 0u);
  ASSERT_EQ(s.lights.size(), 5u);
  EXPECT_EQ(s.lights[1].name, "lamp 2");
  EXPECT_EQ(s.lights[1].transform.translation, (Vec3d{2, 10, 0}));
  EXPECT_EQ(s.lights[1].transform.columns, Transform{}.columns);  // rigid: the scale moves it and leaves it at that
  EXPECT_EQ(s.lights[3].name, "b/lamp");
  EXPECT_EQ(s.lights[4].surface_material, 0u);
  // The surfaces of mesh lights are where the asset's transform puts them: every corner, wherever the scale went. The area of the
  // triangle in XY grows by 2^2, and by 1 where only Z is stretched.
  for (const auto& [index, corner, area] : {std::tuple{2u, Vec3d{4, 10, 0}, 2.0}, std::tuple{4u, Vec3d{2, 0, 0}, 0.5}}) {
    const Light& glow = s.lights[index];
    const auto& shape = std::get<MeshShape>(glow.shape);
    const Vec3d first = vec_cast<double>(s.meshes[shape.mesh].positions[1]);
    EXPECT_NEAR(length(glow.transform.point(first * shape.scale) - corner), 0, 1e-6);
    EXPECT_NEAR(mesh_area_of(s, glow), area, 1e-6);
  }
}

TEST_F(RigImportFiles, AMeshLightMayBeAnAsset) {
  put("rig/room.glb", "x");
  Registry others;
  others.add(std::make_unique<TwoThings>());
  const std::string text = R"({"etendue": 1, "lights": [
    {"shape": {"type": "mesh", "gltf": "room.glb"}, "emission": {"luminance": "1 nit"}}]})";
  const Imported imported = read_file(text, others);
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  ASSERT_EQ(imported.scene.meshes.size(), 1u);
  EXPECT_EQ(imported.scene.meshes[0].positions.size(), 6u);  // the wall and the glowing surface
  EXPECT_EQ(imported.scene.meshes[0].positions[0], (Vec3f{0, 0, 1}));
  EXPECT_TRUE(imported.scene.objects.empty());
  const Imported without = read_file(text);
  ASSERT_EQ(without.diagnostics.all().size(), 1u) << told(without.diagnostics);
  EXPECT_EQ(without.diagnostics.all()[0].code, "FORMAT_UNKNOWN");
}

}  // namespace
}  // namespace etendue
