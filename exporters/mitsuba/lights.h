// One function a family of lights; lights.cpp chooses.
#pragma once

#include "writer.h"

#include <cstdint>
#include <string>

namespace etendue::mitsuba {

// A light on its way into the file. What is not lit keeps its shape, black.
struct LightEntry {
  const Light& light;
  std::uint32_t index;
  std::string id;
  bool lit;
  Resolved resolved;  // only if lit
};
std::string name_for_losses(const Light& light);
// Whether its light is multiplied by something of the distance: distant lights and environments have none.
bool has_window(const Light& light);
// What an emitter of ours reads of it.
void add_window(pugi::xml_node emitter, const Light& light);

// punctual.cpp: emitters without a shape, and the sun's far disk. Only called for lights that are lit.
Status write_point(Writer& writer, const LightEntry& entry);
Status write_spot(Writer& writer, const LightEntry& entry, const SpotShape& spot);
Status write_frustum(Writer& writer, const LightEntry& entry, const FrustumShape& frustum);
Status write_distant(Writer& writer, const LightEntry& entry, const DistantShape& distant);

// area_lights.cpp: shapes that emit.
Status write_sphere(Writer& writer, const LightEntry& entry, const SphereShape& sphere);
Status write_disk(Writer& writer, const LightEntry& entry, const DiskShape& disk);
Status write_rect(Writer& writer, const LightEntry& entry, const RectShape& rect);
Status write_polygon(Writer& writer, const LightEntry& entry, const PolygonShape& polygon);
Status write_tube(Writer& writer, const LightEntry& entry, const TubeShape& tube);
Status write_line(Writer& writer, const LightEntry& entry, const LineShape& line);
Status write_mesh_light(Writer& writer, const LightEntry& entry, const MeshShape& mesh);

// photometric.cpp
Status write_photometric(Writer& writer, const LightEntry& entry);

// environment.cpp
Status write_environment(Writer& writer, const LightEntry& entry, const EnvironmentShape& environment);

}  // namespace etendue::mitsuba
