// The program `etendue`. Quantities are answered here: readers and writers of pictures bring some 270 shared libraries, which take ten
// times as long to load as a conversion takes. For every other verb this becomes etendue-all, which lies beside it.
#include <fmt/format.h>

#include <cstdio>
#include <string_view>

#include "process.h"
#include "sdk/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace etendue;
  if (argc > 1 && std::string_view(argv[1]) == "units") {
    CLI::App app;
    cli::Common common;
    cli::Run run;
    cli::add_units(app, common, run);
    cli::add_common(app, common);
    return cli::run_command(app, argc, argv, run);
  }
  const Error failed = become_program(program_folder() / "etendue-all", argv);
  fmt::print(stderr, "{}\n", to_string(to_diagnostic(failed)));
  return cli::exit_outside;
}
