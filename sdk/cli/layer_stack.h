// A file of layers of materials, as `etendue bake` reads it:
//   { "etendue_layers": 1, "name": "rusty steel", "normals": "reoriented", "blend": "parameters",
//     "layers": [ {"asset": "steel.glb", "material": "Steel", "uv_scale": 4},
//                 {"asset": "rust.rig.json", "mask": "rust_mask.png", "opacity": 0.9} ] }
// Files are found from its own folder. "material" may be left out where an asset has one. Unknown keys are errors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "etendue/layered_material.h"
#include "session.h"

namespace etendue::cli {

struct LayerStack {
  LayeredMaterial material;
  std::vector<ImageRef> images;
};
// Nothing where there were errors, which are in the session's diagnostics.
std::optional<LayerStack> read_layer_stack(Session& session, const std::string& file, const ImportOptions& options);

}  // namespace etendue::cli
