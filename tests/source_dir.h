// Where the repository lies. A function rather than a definition on every command line: objects of one checkout serve another's cache.
#pragma once

#include <filesystem>

namespace etendue {
std::filesystem::path source_dir();
}  // namespace etendue
