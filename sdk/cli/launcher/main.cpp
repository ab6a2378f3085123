// The program `etendue`. What needs no picture is answered here: readers and writers of pictures bring some 270 shared libraries, which
// take ten times as long to load as most answers take. For every other verb this becomes etendue-all, which lies beside it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "process.h"
#include "sdk/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace etendue;
  CLI::App app;
  cli::Common common;
  cli::Run run;
  cli::add_info(app, common, run);
  cli::add_fit(app, common, run);
  cli::add_ies(app, common, run);
  cli::add_units(app, common, run);
  cli::add_common(app, common);
  const std::string first = argc > 1 ? argv[1] : "";
  const auto verbs = app.get_subcommands({});
  const bool answered_here = std::any_of(verbs.begin(), verbs.end(), [&](const CLI::App* verb) { return verb->get_name() == first; });
  if (answered_here || first == "--version") return cli::run_command(app, argc, argv, run);
  const Error failed = become_program(program_folder() / "etendue-all", argv);
  fmt::print(stderr, "{}\n", to_string(to_diagnostic(failed)));
  return cli::exit_outside;
}
