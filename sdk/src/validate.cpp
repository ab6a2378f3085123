#include "validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr double any_positive = std::numeric_limits<double>::max();

struct CheckModel {
  Validator& check;
  void operator()(const Lambert& m) const { check.colour("base_colour", m.base_colour, 1); }
  void operator()(const Principled& m) const {
    check.colour("base_colour", m.base_colour, 1);
    check.between("metallic", m.metallic, 0, 1);
    check.between("roughness", m.roughness, 0, 1);
    check.between("specular", m.specular, 0, std::nextafter(12.5, 0));  // f0 = .08 specular stays below 1
  }
  void operator()(const Standard& m) const {
    check.colour("base_colour", m.base_colour, 1);
    check.between("metal", m.metal, 0, 1);
    check.between("roughness", m.roughness, 0, 1);
    check.between("reflectance", m.reflectance, 0, 1);
  }
  void operator()(const Conductor& m) const {
    check.colour("eta", m.eta, any_positive);
    check.colour("k", m.k, any_positive);
    if (check.above("alpha", m.alpha, 0)) check.between("alpha", m.alpha, 0, 1);
  }
  void operator()(const MetalRough& m) const {
    check.colour("base_colour", m.base_colour, 1);
    check.between("metallic", m.metallic, 0, 1);
    check.between("roughness", m.roughness, 0, 1);
    if (m.ior != 0) check.between("ior (or 0)", m.ior, 1, any_positive);
  }
  void operator()(const SpecularGlossiness& m) const {
    check.colour("diffuse", m.diffuse, 1);
    check.colour("specular", m.specular, 1);
    check.between("glossiness", m.glossiness, 0, 1);
  }
};

// The first fault of each kind: a broken mesh has thousands.
void validate_mesh(Validator& check, const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0)
    check.error("MESH_INVALID", fmt::format("expected three indices a triangle, found {} indices", mesh.indices.size()));
  if (!mesh.normals.empty() && mesh.normals.size() != count)
    check.error("MESH_INVALID", fmt::format("expected {} normals or none, found {}", count, mesh.normals.size()));
  if (!mesh.uvs.empty() && mesh.uvs.size() != count)
    check.error("MESH_INVALID", fmt::format("expected {} texture coordinates or none, found {}", count, mesh.uvs.size()));
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= count) {
      check.error("INDEX_OUT_OF_RANGE", fmt::format("expected indices below {}, found {} as number {}", count, mesh.indices[i], i));
      break;
    }
  const auto finite3 = [](const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  const auto finite2 = [](const Vec2f& v) { return std::isfinite(v.x) && std::isfinite(v.y); };
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), finite3)) check.error("NUMBER_INVALID", "expected finite positions");
  if (!std::all_of(mesh.normals.begin(), mesh.normals.end(), finite3)) check.error("NUMBER_INVALID", "expected finite normals");
  if (!std::all_of(mesh.uvs.begin(), mesh.uvs.end(), finite2)) check.error("NUMBER_INVALID", "expected finite texture coordinates");
}

// Orthogonal columns of one length: a sphere stays a sphere.
bool is_similarity(const Transform& t) {
  const double size = dot(t.columns[0], t.columns[0]);
  double off = 0;
  for (int i = 0; i < 3; ++i) {
    off = std::max(off, std::fabs(dot(t.columns[i], t.columns[i]) - size));
    off = std::max(off, std::fabs(dot(t.columns[i], t.columns[(i + 1) % 3])));
  }
  return size > 0 && off <= 1e-6 * size;
}

struct CheckGeometry {
  Validator& check;
  const Transform& transform;
  void operator()(const PlaneGeometry& g) const { check.above("size in m", g.size, 0); }
  void operator()(const BoxGeometry& g) const {
    for (int i = 0; i < 3; ++i) check.above("size in m", g.size[i], 0);
  }
  void operator()(const SphereGeometry& g) const {
    check.above("radius in m", g.radius, 0);
    if (!is_similarity(transform))
      check.error("TRANSFORM_NOT_SIMILAR", "expected a sphere to be scaled alike in every direction: an ellipsoid needs a mesh");
  }
  void operator()(const MeshGeometry& g) const { check.index("the mesh", g.mesh, check.scene().meshes.size()); }
};

void validate_object(Validator& check, const Object& object) {
  if (object.material != no_index) check.index("the material", object.material, check.scene().materials.size());
  if (!check.finite("transform", object.transform)) return;
  std::visit(CheckGeometry{check, object.transform}, object.geometry);
  if (object.transform.determinant() == 0) check.warning("TRANSFORM_SINGULAR", "its transform flattens it");
}

void validate_camera(Validator& check, const Camera& camera) {
  check.rigid(camera.transform);
  if (check.above("vertical field of view in rad", camera.vfov_rad, 0))
    check.between("vertical field of view in rad", camera.vfov_rad, 0, std::nextafter(pi, 0));
  check.between("aspect", camera.aspect, 0, any_positive);
  if (camera.ev100) check.between("ev100", *camera.ev100, -1000, 1000);
}

void validate_normal_map(Validator& check, const std::optional<NormalMap>& map) {
  if (map && !std::isfinite(map->scale)) check.error("NUMBER_INVALID", "expected a finite scale of the normal map");
}

// The ranges of the extensions' schemas; what they leave open above is any finite number.
void validate_lobes(Validator& check, const Lobes& lobes) {
  if (lobes.clearcoat) {
    check.between("clearcoat factor", lobes.clearcoat->factor, 0, 1);
    check.between("clearcoat roughness", lobes.clearcoat->roughness, 0, 1);
    validate_normal_map(check, lobes.clearcoat->normal_map);
  }
  if (lobes.sheen) {
    check.colour("sheen colour", lobes.sheen->colour, 1);
    check.between("sheen roughness", lobes.sheen->roughness, 0, 1);
  }
  if (lobes.transmission) check.between("transmission", lobes.transmission->factor, 0, 1);
  if (lobes.diffuse_transmission) {
    check.between("diffuse transmission", lobes.diffuse_transmission->factor, 0, 1);
    check.colour("diffuse transmission colour", lobes.diffuse_transmission->colour, 1);
  }
  if (lobes.volume) {
    check.between("thickness in m", lobes.volume->thickness_m, 0, any_positive);
    check.colour("attenuation colour", lobes.volume->attenuation_colour, 1);
    if (!(lobes.volume->attenuation_distance_m > 0))
      check.error("VALUE_OUT_OF_RANGE",
                  fmt::format("expected an attenuation distance above 0 m, found {}", lobes.volume->attenuation_distance_m));
  }
  if (lobes.dispersion) check.between("dispersion", lobes.dispersion->value, 0, any_positive);
  if (lobes.specular) {
    check.between("specular factor", lobes.specular->factor, 0, 1);
    check.colour("specular colour", lobes.specular->colour, any_positive);
  }
  if (lobes.iridescence) {
    check.between("iridescence", lobes.iridescence->factor, 0, 1);
    check.between("iridescence ior", lobes.iridescence->ior, 1, any_positive);
    check.between("minimum film thickness in nm", lobes.iridescence->min_thickness_nm, 0, any_positive);
    check.between("maximum film thickness in nm", lobes.iridescence->max_thickness_nm, 0, any_positive);
  }
  if (lobes.anisotropy) {
    check.between("anisotropy", lobes.anisotropy->strength, 0, 1);
    if (!std::isfinite(lobes.anisotropy->rotation_rad)) check.error("NUMBER_INVALID", "expected a finite rotation of the anisotropy");
  }
}

void validate_material(Validator& check, const Material& material) {
  std::visit(CheckModel{check}, material.model);
  if (material.fallback) CheckModel{check}(material.fallback->model);
  for_each_texture(material, [&check](const char* role, const Texture& texture) {
    check.texture(fmt::format("the image of {}", role).c_str(), texture);
  });
  validate_normal_map(check, material.normal_map);
  validate_lobes(check, material.lobes);
  if (material.occlusion) check.between("occlusion strength", material.occlusion->strength, 0, 1);
  if (material.alpha_cutoff) check.between("the alpha cutoff", *material.alpha_cutoff, 0, any_positive);
  check.between("the base colour's alpha", material.base_alpha, 0, 1);
  check.colour("the emission in cd/m2", material.emissive, any_positive);
}

}  // namespace

Diagnostics validate(const Scene& scene) {
  Diagnostics diagnostics;
  Validator check(scene, diagnostics);
  const auto each = [&check](const char* kind, const auto& things, auto validate_one) {
    for (std::size_t i = 0; i < things.size(); ++i) {
      check.about(kind, i, things[i].name, things[i].source);
      validate_one(check, things[i]);
    }
  };
  each("mesh", scene.meshes, validate_mesh);
  each("material", scene.materials, validate_material);
  each("object", scene.objects, validate_object);
  each("light", scene.lights, validate_light);
  each("camera", scene.cameras, validate_camera);
  return diagnostics;
}

}  // namespace etendue
