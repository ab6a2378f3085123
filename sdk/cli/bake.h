#pragma once

#include "verbs.h"

namespace etendue::cli {

void add_bake(CLI::App& app, const Common& common, Run& run);

}  // namespace etendue::cli
