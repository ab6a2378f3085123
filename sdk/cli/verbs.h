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
void add_bench(CLI::App& app, const Common& common, Run& run);
void add_eval(CLI::App& app, const Common& common, Run& run);
void add_validate(CLI::App& app, const Common& common, Run& run);
void add_fit(CLI::App& app, const Common& common, Run& run);
void add_check(CLI::App& app, const Common& common, Run& run);
void add_filter(CLI::App& app, const Common& common, Run& run);
void add_fit_ltc(CLI::App& app, const Common& common, Run& run);
void add_ies(CLI::App& app, const Common& common, Run& run);
void add_units(CLI::App& app, const Common& common, Run& run);
void add_completion(CLI::App& app, Run& run);

// Options that every verb takes behind it, where people write them: for all that were added so far.
void add_common(CLI::App& app, Common& common);
// Adds --version, reads the command line and runs what the verb left in `run`; returns the exit status.
int run_command(CLI::App& app, int argc, char** argv, const Run& run);

}  // namespace etendue::cli
