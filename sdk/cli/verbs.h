// The verbs: each adds its options to the command and, when it was asked for, leaves what to run in `run`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "session.h"

namespace etendue::cli {

using Run = std::function<int()>;

void add_info(CLI::App& app, const Common& common, Run& run);
void add_convert(CLI::App& app, const Common& common, Run& run);
void add_render(CLI::App& app, const Common& common, Run& run);
void add_compare(CLI::App& app, const Common& common, Run& run);
void add_validate(CLI::App& app, const Common& common, Run& run);
void add_ies(CLI::App& app, const Common& common, Run& run);
void add_units(CLI::App& app, const Common& common, Run& run);
void add_completion(CLI::App& app, Run& run);

}  // namespace etendue::cli
