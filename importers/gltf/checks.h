// The parts of check_document(), one a file: what the tables of the schema cannot say. Each takes a document of any shape: what the
// schema's check has reported is passed over.
#pragma once

#include "findings.h"
#include "records.h"
#include "schema.h"

#include <set>
#include <string>

namespace etendue::gltf {

struct Checks {
  const Json& root;
  Findings& findings;
  SchemaFindings& schema;
  Records records;
  bool is_glb = false;
  int max_depth = 256;

  // Of nodes, known after check_nodes(): the last parent or -1, and how deep they stand (1: a root) where there are no loops.
  std::vector<std::int64_t> parents;
  std::vector<int> depths;
  bool is_forest = true;

  std::set<std::string> declared;  // extensionsUsed

  bool declares(const std::string& extension) const { return declared.contains(extension); }
};

void check_extensions(Checks& checks);
void check_buffers(Checks& checks);
void check_accessors(Checks& checks);
void check_images(Checks& checks);
void check_materials(Checks& checks);
void check_meshes(Checks& checks);
void check_nodes(Checks& checks);
void check_skins(Checks& checks);
void check_animations(Checks& checks);
void check_cameras(Checks& checks);
void check_lights(Checks& checks);
void check_declarations(Checks& checks);
void check_unused(Checks& checks);

// `user` names the property that uses the view or accessor; what contradicts an earlier use is an error there.
void use_view(Checks& checks, std::int64_t view, Usage usage, const Path& user);
void use_accessor(Checks& checks, std::int64_t accessor, Usage usage, const Path& user);

// Elements at `offset` in a view: alignment and length.
void check_fit(Checks& checks, std::int64_t view, std::uint64_t offset, std::size_t component, std::uint64_t bytes, const Path& path);

// Its message where an accessor's format is not among those allowed.
std::string format_expected(const Format& found, const std::vector<Format>& allowed);

}  // namespace etendue::gltf
