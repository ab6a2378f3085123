// What every part of the exporter works on: the scene, the XML under construction, the files beside it, and what gets lost.
#pragma once

#include "assets.h"
#include "etendue/io.h"
#include "etendue/scene.h"
#include "mitsuba.h"
#include "xml.h"

#include <cstdint>
#include <string>

namespace etendue::mitsuba {

struct Writer {
  const Scene& scene;
  const ExportOptions& options;
  AssetFolder& assets;
  pugi::xml_node root;
  LossReport& losses;
  Bounds bounds;  // of the scene
  Vec3d eye;      // of the camera
  MitsubaParts parts;
  MitsubaLobes lobes;
  double extent_m;  // length that the scene, its camera and the origin fit into: floats are as coarse as 6e-8 of it
};

// materials.cpp: the <bsdf> elements of the materials in use, for reference by id; the integrator that they need.
Status write_materials(Writer& writer);
std::string material_id(const Scene& scene, std::uint32_t material);
// The material's lookups need uv coordinates.
bool has_textures(const Material& material, MitsubaParts parts);
// Some part of the surface is a hole.
bool has_holes(const Material& material, MitsubaParts parts);
// The material as the surface of `shape`, and of what lies behind it.
void add_surface(const Writer& writer, pugi::xml_node shape, std::uint32_t material);
// Light that gets through has to be followed by `volpath`.
bool is_passed(const Writer& writer, const Material& material);

// objects.cpp
Status write_objects(Writer& writer);

// lights.cpp
Status write_lights(Writer& writer);

// A <shape> of `mesh`, or its id-less kin, to which the caller adds a <bsdf> or <emitter>.
Result<pugi::xml_node> add_mesh_shape(Writer& writer, const std::string& id, const Mesh& mesh, const Transform& to_world,
                                      bool face_normals);

// Ends the effect of a loss that MitsubaParts::with_plugins has not.
inline constexpr const char* exact_with_plugins = " (none with validate --plugins)";

Error unsupported(std::string text, const std::string& source);

}  // namespace etendue::mitsuba
