// Writes a scene as Mitsuba 3 XML with its PLY and EXR files in a folder NAME_files beside it. Mapping and losses: README.md beside this
// file.
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "etendue/io.h"
#include "etendue/mitsuba_parts.h"

namespace etendue {

// What becomes of glTF's optional lobes and of alpha blending: left out, as in our own pictures, or shown by Mitsuba's built-in surfaces as
// far as these go (README.md).
enum class MitsubaLobes { as_ours, as_far_as_can_be };

// With plugins (which run_mitsuba() brings) spots, frusta, photometric webs, windows and the models of Standard, MetalRough and
// SpecularGlossiness are written as they are, for them.
std::unique_ptr<Exporter> make_mitsuba_exporter(MitsubaParts parts = MitsubaParts::built_in, MitsubaLobes lobes = MitsubaLobes::as_ours);

// The scene as make_mitsuba_exporter() writes it, and beside it NAME_light_I.xml for each light I of options.lit (all, if it is empty), in
// which that light alone emits. They name files of the same folder, and each texture and mesh is made once.
struct MitsubaLightByLight {
  Exported all;
  std::vector<std::filesystem::path> single;  // in the order of the lights
};
Result<MitsubaLightByLight> write_mitsuba_light_by_light(const Scene& scene, const std::filesystem::path& file,
                                                         const ExportOptions& options, MitsubaParts parts = MitsubaParts::built_in);

}  // namespace etendue
