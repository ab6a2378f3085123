// What every verb's command line has in common.
#include "verbs.h"

namespace etendue::cli {
namespace {

// In CLI11's order, last first. A minus before a digit belongs to a quantity ("-3 EV"), which a blank before it says.
std::vector<std::string> arguments_of(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = argc - 1; i > 0; --i) {
    const std::string_view text = argv[i];
    const bool negative = text.size() > 1 && text[0] == '-' && ((text[1] >= '0' && text[1] <= '9') || text[1] == '.');
    arguments.push_back((negative ? " " : "") + std::string(text));
  }
  return arguments;
}

}  // namespace

void add_common(CLI::App& app, Common& common) {
  for (CLI::App* const verb : app.get_subcommands({})) {
    verb->add_flag("--json", common.json, "One JSON document on stdout");
    verb->add_flag("--stats", common.stats, "What was read, decoded, evaluated and skipped");
    verb->add_flag("-q,--quiet", common.quiet, "Errors alone");
    verb->add_flag("-v,--verbose", common.verbose, "Notes as well");
  }
}

int run_command(CLI::App& app, int argc, char** argv, const Run& run) {
  app.name("etendue");
  app.set_version_flag("--version", std::string("etendue ") + ETENDUE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  try {
    app.parse(arguments_of(argc, argv));
  } catch (const CLI::Success& asked_for_text) {  // --help, --version
    return app.exit(asked_for_text);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return exit_usage;
  }
  catch_interrupts();
  return run();
}

}  // namespace etendue::cli
