// A rig from text that is already in memory.
#pragma once

#include "etendue/io.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace etendue::rig {

// `file` names the text in messages; files that it names are looked up in `folder`. With `others` null no other asset is opened.
// Error only where the text is no JSON; every other mistake is in the diagnostics, in the order of the file.
Result<Imported> read_rig_text(std::string_view text, const std::string& file, const std::filesystem::path& folder, const Registry* others,
                               const ImportOptions& options);

}  // namespace etendue::rig
