// The command `etendue`: options that all verbs share, and the choice of the verb.
#include <fmt/format.h>

#include "verbs.h"

namespace {

// Every verb takes the shared options behind it, where people write them.
void add_common(CLI::App& verb, etendue::cli::Common& common) {
  verb.add_flag("--json", common.json, "One JSON document on stdout");
  verb.add_flag("--stats", common.stats, "What was read, decoded, evaluated and skipped");
  verb.add_flag("-q,--quiet", common.quiet, "Errors alone");
  verb.add_flag("-v,--verbose", common.verbose, "Notes as well");
}

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

int main(int argc, char** argv) {
  using namespace etendue::cli;
  CLI::App app{
      "Etendue: physical lights and materials.\n"
      "Reads light rigs and glTF, shows them in real units, writes Mitsuba 3, and compares both renderers' light.\n"};
  app.name("etendue");
  app.set_version_flag("--version", std::string("etendue ") + ETENDUE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "\nExamples:\n"
      "  etendue info room.glb\n"
      "  etendue convert kitchen.rig.json kitchen.xml\n"
      "  etendue validate kitchen.rig.json --out report\n"
      "  etendue units 1500lm --shape sphere --radius 15cm --to nit\n"
      "\n`etendue VERB --help` says more. Exit status: 0 done, 1 the input is bad or a check failed, 2 wrong usage,\n"
      "3 something outside is missing or failed, 4 undecided, 130 cancelled.");
  app.get_formatter()->column_width(34);

  Common common;
  Run run;
  add_info(app, common, run);
  add_convert(app, common, run);
  add_render(app, common, run);
  add_compare(app, common, run);
  add_validate(app, common, run);
  add_ies(app, common, run);
  add_units(app, common, run);
  for (CLI::App* const verb : app.get_subcommands({})) add_common(*verb, common);
  add_completion(app, run);

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
