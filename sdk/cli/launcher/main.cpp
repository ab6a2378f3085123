// The program `etendue`. What needs no picture is answered here: readers and writers of pictures bring some 270 shared libraries, which
// take ten times as long to load as most answers take. For every other verb this becomes etendue-all, which lies beside it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "process.h"
#include "sdk/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace etendue;
  constexpr std::array<std::string_view, 4> answered_here = {"info", "ies", "units", "--version"};
  if (argc > 1 && std::find(answered_here.begin(), answered_here.end(), argv[1]) != answered_here.end()) {
    CLI::App app;
    cli::Common common;
    cli::Run run;
    cli::add_info(app, common, run);
    cli::add_ies(app, common, run);
    cli::add_units(app, common, run);
    cli::add_common(app, common);
    return cli::run_command(app, argc, argv, run);
  }
  const Error failed = become_program(program_folder() / "etendue-all", argv);
  fmt::print(stderr, "{}\n", to_string(to_diagnostic(failed)));
  return cli::exit_outside;
}
