// Every material of an asset, shown by its scene or not.
#pragma once

#include <filesystem>

#include "session.h"

namespace etendue::cli {

// As read_asset(), but a glTF document's materials come whole, as libraries of them have no scene that shows them. Says nothing to the
// session.
Result<Imported> read_all_materials(const std::filesystem::path& file, ImportOptions options);

}  // namespace etendue::cli
