// What becomes of each property and extension of glTF: one table, which the importer follows and sdk/docs/gltf.md shows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

enum class Fate {
  represented,  // the scene says it
  carried,      // kept in Scene::carried; nothing shown here depends on it
  unshown       // carried likewise, but pictures and other formats miss it: a warning
};
const char* name_of(Fate fate);

struct MappingRow {
  const char* holder;  // a type of object; "any" for all
  // Names, blanks between them. "nodes:node": the values are objects of that type. "nodes:*node": each of them counts only if the importer
  // took it up (Asset::take), and is carried whole otherwise.
  const char* names;
  Fate fate;
  const char* becomes;            // where it stands in the scene, or what is missed
  bool (*available)() = nullptr;  // a component that a build may lack: without it the fate is `unshown`
  Fate actual_fate() const { return available == nullptr || available() ? fate : Fate::unshown; }
  bool is_extension() const;
};
const std::vector<MappingRow>& mapping_rows();

// What stands under `name` in an object of type `holder`. `row` is null for what the table does not know.
struct Mapped {
  const MappingRow* row = nullptr;
  std::string type;       // of the objects below it, if it has some
  bool taken_up = false;  // "*"
};
Mapped mapped(std::string_view holder, std::string_view name);

// The first row of an extension wherever it stands, or null.
const MappingRow* row_of_extension(std::string_view name);

// The table of sdk/docs/gltf.md.
std::string mapping_table();

}  // namespace etendue::gltf
