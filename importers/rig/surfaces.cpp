#include "reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue::rig {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();
// F0 = .08 specular stays below 1.
constexpr double largest_specular = 12.499999999999998;
constexpr double below_one = 1 - std::numeric_limits<double>::epsilon() / 2;

std::optional<double> unit_number(Reader& reader, JsonValue value) { return read_number(value, 0, 1, reader.diagnostics); }
Rgb base_colour(Reader& reader, Fields& fields, const Rgb& otherwise) {
  return read_vec3(fields.find("base_colour"), 0, 1, reader.diagnostics).value_or(otherwise);
}

SurfaceModel read_principled(Reader& reader, Fields& fields) {
  Principled m;
  m.base_colour = base_colour(reader, fields, m.base_colour);
  m.metallic = unit_number(reader, fields.find("metallic")).value_or(m.metallic);
  m.roughness = unit_number(reader, fields.find("roughness")).value_or(m.roughness);
  m.specular = read_number(fields.find("specular"), 0, largest_specular, reader.diagnostics).value_or(m.specular);
  return m;
}

SurfaceModel read_standard(Reader& reader, Fields& fields) {
  Standard m;
  m.base_colour = base_colour(reader, fields, m.base_colour);
  m.metal = unit_number(reader, fields.find("metal")).value_or(m.metal);
  const JsonValue surface = fields.one_of({"roughness", "smoothness"});
  const std::optional<double> given = unit_number(reader, surface);
  if (given) m.roughness = surface.key() == "smoothness" ? 1 - *given : *given;
  m.reflectance = unit_number(reader, fields.find("reflectance")).value_or(m.reflectance);
  return m;
}

SurfaceModel read_conductor(Reader& reader, Fields& fields) {
  Diagnostics& d = reader.diagnostics;
  Conductor m;
  const JsonValue f0 = fields.find("f0"), eta = fields.find("eta"), k = fields.find("k");
  const double alpha = read_number(fields.find("alpha"), std::numeric_limits<double>::min(), 1, d).value_or(m.alpha);
  if (f0 && (eta || k)) d.error("KEYS_EXCLUSIVE", "\"f0\" stands for \"eta\" and \"k\", found both", f0.where_key());
  if (fields.valid() && !f0 && !(eta && k)) fail(d, fields.object(), "KEY_MISSING", "expected \"f0\", or \"eta\" and \"k\"");
  if (f0) {
    m = conductor_from_f0(read_vec3(f0, 0, below_one, d).value_or(Rgb{0.5, 0.5, 0.5}), alpha);
  } else {
    m.eta = read_vec3(eta, std::numeric_limits<double>::min(), unlimited, d).value_or(m.eta);
    m.k = read_vec3(k, 0, unlimited, d).value_or(m.k);
  }
  m.alpha = alpha;
  m.masking = read_choice<Masking>(fields.find("masking"),
                                   {{"separable", Masking::separable},
                                    {"correlated", Masking::correlated},
                                    {"schlick-direct", Masking::schlick_direct},
                                    {"schlick-image", Masking::schlick_image}},
                                   d)
                  .value_or(m.masking);
  return m;
}

SurfaceModel read_metal_rough(Reader& reader, Fields& fields) {
  MetalRough m;
  m.base_colour = base_colour(reader, fields, m.base_colour);
  m.metallic = unit_number(reader, fields.find("metallic")).value_or(m.metallic);
  m.roughness = unit_number(reader, fields.find("roughness")).value_or(m.roughness);
  const JsonValue ior = fields.find("ior");
  m.ior = read_number(ior, 0, unlimited, reader.diagnostics).value_or(m.ior);
  if (m.ior > 0 && m.ior < 1)
    fail(reader.diagnostics, ior, "VALUE_OUT_OF_RANGE", "expected an index of refraction of 1 or more, or 0 (KHR_materials_ior)");
  return m;
}

SurfaceModel read_specular_glossiness(Reader& reader, Fields& fields) {
  SpecularGlossiness m;
  m.diffuse = read_vec3(fields.find("diffuse"), 0, 1, reader.diagnostics).value_or(m.diffuse);
  m.specular = read_vec3(fields.find("specular"), 0, 1, reader.diagnostics).value_or(m.specular);
  m.glossiness = unit_number(reader, fields.find("glossiness")).value_or(m.glossiness);
  return m;
}

using ReadModel = SurfaceModel (*)(Reader&, Fields&);

Material read_material(Reader& reader, JsonValue value) {
  Fields fields(value, reader.diagnostics);
  Material material;
  material.name = read_string(fields.find("name"), reader.diagnostics).value_or("");
  material.source = value.pointer();
  const ReadModel lambert = [](Reader& r, Fields& f) -> SurfaceModel { return Lambert{base_colour(r, f, Lambert{}.base_colour)}; };
  const Choices<ReadModel> models = {
      {"lambert", lambert},          {"principled", read_principled},   {"standard", read_standard},
      {"conductor", read_conductor}, {"metal_rough", read_metal_rough}, {"specular_glossiness", read_specular_glossiness}};
  const std::optional<ReadModel> read_model = read_choice(fields.require("model"), models, reader.diagnostics);
  material.double_sided = read_boolean(fields.find("double_sided"), reader.diagnostics).value_or(true);
  if (!read_model) return material;
  material.model = (*read_model)(reader, fields);
  fields.finish();
  return material;
}

// A length for a cube, or three.
std::optional<Vec3d> read_box_size(Reader& reader, JsonValue value) {
  Diagnostics& d = reader.diagnostics;
  if (!value.is(JsonKind::array)) {
    const std::optional<double> edge = read_length(value, Bound::positive, d);
    if (!edge) return {};
    return Vec3d{*edge, *edge, *edge};
  }
  if (value.size() != 3) {
    fail(d, value, "TYPE_MISMATCH", fmt::format("expected a length or an array of 3 lengths, found {} elements", value.size()));
    return {};
  }
  Vec3d size;
  bool complete = true;
  int axis = 0;
  for (const JsonValue element : value) {
    const std::optional<double> edge = read_length(element, Bound::positive, d);
    complete = complete && edge.has_value();
    size[axis++] = edge.value_or(1);
  }
  if (!complete) return {};
  return size;
}

enum class Kind { plane, box, sphere, mesh };

Geometry read_geometry(Reader& reader, JsonValue value) {
  Diagnostics& d = reader.diagnostics;
  Fields fields(value, d);
  const std::optional<Kind> kind = read_choice<Kind>(
      fields.require("type"), {{"plane", Kind::plane}, {"box", Kind::box}, {"sphere", Kind::sphere}, {"mesh", Kind::mesh}}, d);
  if (!kind) return PlaneGeometry{};
  Geometry geometry;
  switch (*kind) {
    case Kind::plane:
      geometry = PlaneGeometry{read_length(fields.require("size"), Bound::positive, d).value_or(1)};
      break;
    case Kind::box:
      geometry = BoxGeometry{read_box_size(reader, fields.require("size")).value_or(Vec3d{1, 1, 1})};
      break;
    case Kind::sphere:
      geometry = SphereGeometry{read_length(fields.require("radius"), Bound::positive, d).value_or(1)};
      break;
    case Kind::mesh:
      geometry = MeshGeometry{read_mesh_reference(reader, fields).value_or(no_index)};
      break;
  }
  fields.finish();
  return geometry;
}

// Equal lengths and right angles of the axes, within rounding: the sphere stays one.
bool is_similarity(const Transform& t) {
  constexpr double tolerance = 1e-6;
  const double size = dot(t.columns[0], t.columns[0]);
  double off = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    off = std::max(off, std::abs(dot(t.columns[i], t.columns[i]) - size));
    off = std::max(off, std::abs(dot(t.columns[i], t.columns[(i + 1) % 3])));
  }
  return size > 0 && off <= tolerance * size;
}

void read_object(Reader& reader, JsonValue value) {
  Diagnostics& d = reader.diagnostics;
  const bool surfaces = has(reader.options.need, Need::meshes);
  Fields fields(value, d);
  const JsonValue given = fields.one_of({"shape", "gltf"});
  if (fields.valid() && !given) fail(d, value, "KEY_MISSING", "expected one of \"shape\", \"gltf\"");
  Object object;
  object.name = read_string(fields.find("name"), d).value_or("");
  const JsonValue material = fields.find("material");
  if (has(reader.options.need, Need::materials))
    object.material = read_reference(reader, material, reader.material_names, "material").value_or(no_index);
  object.transform = read_transform(fields, true, d);
  object.source = value.pointer();
  fields.finish();
  if (given && given.key() == "gltf") {
    std::optional<Scene> asset = read_asset(reader, given, reader.options.need);
    if (!asset) return;
    const std::string prefix = object.name.empty() ? "" : object.name + "/";
    merge(reader, std::move(*asset), {object.transform, object.material, prefix, std::string(given.string())}, given);
    return;
  }
  if (!surfaces) {
    ++reader.stats.skipped_meshes;
    return;
  }
  if (!given) return;
  object.geometry = read_geometry(reader, given);
  if (std::holds_alternative<SphereGeometry>(object.geometry) && !is_similarity(object.transform)) {
    fail(d, value, "VALUE_OUT_OF_RANGE", "expected the same scale on all axes of a sphere");
  }
  reader.scene.objects.push_back(std::move(object));
}

}  // namespace

void read_materials(Reader& reader, JsonValue materials) {
  if (!is_array(materials, reader.options.max_items, reader.diagnostics)) return;
  for (const JsonValue material : materials) {
    reader.scene.materials.push_back(read_material(reader, material));
    reader.material_names.push_back(reader.scene.materials.back().name);
  }
}

void read_objects(Reader& reader, JsonValue objects) {
  if (!is_array(objects, reader.options.max_items, reader.diagnostics)) return;
  for (const JsonValue object : objects) read_object(reader, object);
}

}  // namespace etendue::rig
