// All verbs of the command `etendue`. launcher/main.cpp is what people start.
#include "bake.h"
#include "verbs.h"

int main(int argc, char** argv) {
  using namespace etendue::cli;
  CLI::App app{
      "Etendue: physical lights and materials.\n"
      "Reads light rigs and glTF, shows them in real units, writes Mitsuba 3, and compares both renderers' light.\n"};
  app.footer(
      "\nExamples:\n"
      "  etendue info room.glb\n"
      "  etendue convert kitchen.rig.json kitchen.xml\n"
      "  etendue validate kitchen.rig.json --out report\n"
      "  etendue units 1500lm --shape sphere --radius 15cm --to nit\n"
      "\n`etendue VERB --help` says more. Exit status: 0 done, 1 the input is bad or a check failed, 2 wrong usage,\n"
      "3 something outside is missing or failed, 4 undecided, 130 cancelled.");
  Common common;
  Run run;
  add_info(app, common, run);
  add_convert(app, common, run);
  add_render(app, common, run);
  add_compare(app, common, run);
  add_validate(app, common, run);
  add_eval(app, common, run);
  add_bench(app, common, run);
  add_fit(app, common, run);
  add_check(app, common, run);
  add_filter(app, common, run);
  add_fit_ltc(app, common, run);
  add_bake(app, common, run);
  add_ies(app, common, run);
  add_units(app, common, run);
  add_common(app, common);
  add_completion(app, run);
  return run_command(app, argc, argv, run);
}
