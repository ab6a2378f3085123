// --limit NAME=NUMBER: the limits of ImportOptions, by the names that messages give them.
#pragma once

#include <CLI/CLI.hpp>

#include "etendue/io.h"

namespace etendue::cli {

// Of a verb that reads assets; what is asked for goes into `options`, which the verb keeps.
void add_limits(CLI::App& verb, ImportOptions& options);

}  // namespace etendue::cli
