// Whether a glTF document is what it should be: schema, references, sizes, uses, forests, extensions; no byte of a buffer is read.
#pragma once

#include "etendue/io.h"
#include "findings.h"
#include "schema.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue::gltf {

// Codes and severities are Khronos' validator's. Integers that are written as 3.0 become 3.
SchemaFindings check_document(nlohmann::json& root, bool is_glb, const ImportOptions& options, Findings& findings);

// Whether asset.version can be read here; the reason why not is reported.
bool check_version(const nlohmann::json& root, Findings& findings);

}  // namespace etendue::gltf
