#include "source_dir.h"

std::filesystem::path etendue::source_dir() { return ETENDUE_SOURCE_DIR; }
