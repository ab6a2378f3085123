// etendue units: quantities of lights, cameras and colours in one another's units.
#include "units.h"

#include <fmt/format.h>

#include "number_text.h"
#include "units_stream.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

Json to_json(const Explanation& e) {
  Json json = {{"formula", e.formula}, {"symbols", Json::object()}, {"notes", e.notes}};
  for (const Symbol& s : e.symbols) json["symbols"][s.name] = s.unit.empty() ? Json(s.value) : Json{{"value", s.value}, {"unit", s.unit}};
  return json;
}

Json to_json(const Answer& a) {
  Json json = {{"value", a.value.size() == 1 ? Json(a.value[0]) : Json(a.value)}, {"unit", a.unit}, {"text", a.text}};
  if (a.duv) json["duv"] = *a.duv;
  if (a.in_gamut) json["in_gamut"] = *a.in_gamut;
  if (a.efficacy_lm_W) {
    json["efficacy_lm_W"] = *a.efficacy_lm_W;
    json["efficacy"] = a.efficacy;
  }
  if (a.explanation) json["explain"] = to_json(*a.explanation);
  return json;
}

// Below a line of its own.
std::string nested(const Explanation& explanation) {
  std::string text = "    ";
  for (const char c : to_string(explanation)) text += c == '\n' ? std::string("\n    ") : std::string(1, c);
  return text;
}

// One of several quantities as a place. The parameter of a call is for readers of JSON: the text names the option or the size.
Where in_quantity(Where where, const std::string& text, bool json) {
  where.file = fmt::format("\"{}\"", trimmed(text));
  if (where.column > 0) where.line = 1;
  if (!json) where.pointer.clear();
  return where;
}

Status answer_one(Session& session, const std::string& text, const std::optional<Target>& target, const LightSetup& setup,
                  const UnitsOptions& options, Json& results) {
  Diagnostics told;
  const Result<Written> written = read_quantity(text, options, told);
  if (!written) return written.error();
  for (Diagnostic d : told.all()) {
    d.where = in_quantity(d.where, text, session.common().json);
    session.diagnostics.add(d);
  }
  if (const Status said = say(session, text, *written, target, setup, options, results); !said) return said.error();
  if (!told.all().empty()) results.back()["clamped"] = true;
  return Done{};
}

int run_units(const Common& common, const UnitsOptions& options) {
  Session session("units", common);
  if (options.list) {
    list_units(session);
    return session.finish(exit_done);
  }
  if (!options.table.empty()) {
    const Status printed = print_table(session, options.table);
    return printed ? session.finish(exit_done) : session.fail(printed.error());
  }
  if (options.quantities.empty()) return session.fail({"USAGE", "expected a QUANTITY such as \"1500 lm\", --list or --table", {}, {}, {}});
  const Result<LightSetup> setup = setup_of(options);
  if (!setup) return session.fail(setup.error());
  std::optional<Target> target;
  if (!options.to.empty() && options.dialect.empty()) {
    const Result<Target> named = target_named(options.to);
    if (!named) return session.fail(named.error());
    target = *named;
  }

  if (options.quantities == std::vector<std::string>{"-"}) {
    if (!target) return session.fail({"USAGE", "a stream needs --to: the unit of all its rows", {}, {}, {}});
    if (common.json) return session.fail({"USAGE", "a stream is CSV, or with --jsonl JSON lines; --json is one document", {}, {}, {}});
    RowConverter rows(*target, *setup, options);
    if (const Status done = convert_rows(rows, options.jsonl, stdin, stdout); !done) return session.fail(done.error());
    session.stats["rows"] = rows.rows;
    session.stats["refused"] = rows.refused;
    return session.finish(rows.refused == 0 ? exit_done : exit_bad_input);
  }

  Json results = Json::array();
  int status = exit_done;
  for (const std::string& text : options.quantities) {
    const bool in_dialect = !options.dialect.empty() || !options.from.empty();
    const Status answered = in_dialect ? state_in_dialect(session, text, target, *setup, options, results)
                                       : answer_one(session, text, target, *setup, options, results);
    if (answered) continue;
    Diagnostic why = to_diagnostic(answered.error());
    why.where = in_quantity(why.where, text, common.json);
    session.diagnostics.add(why);
    results.push_back({{"error", {{"code", answered.error().code}, {"text", answered.error().text}}}});
    status = std::max(status, exit_status_of(answered.error()));
  }
  session.result = results.size() == 1 ? results[0] : results;
  return session.finish(status);
}

}  // namespace

Status say(Session& session, const std::string& text, const Written& written, const std::optional<Target>& target, const LightSetup& setup,
           const UnitsOptions& options, Json& results) {
  if (!target) {
    const std::vector<Answer> known = every_answer(written, setup, options);
    // Nothing at all: a colour that has not even a chromaticity.
    if (known.empty()) return answer(written, *target_named("xy"), setup, options).error();
    Json json = {{"text", to_string(written)}, {"known", Json::array()}};
    session.print(to_string(written));
    for (const Answer& a : known) {
      json["known"].push_back(to_json(a));
      const std::string number = a.value.size() == 1 ? fmt::format("{:.6g}", a.value[0]) : fmt::format("{:.4f}", fmt::join(a.value, " "));
      session.print(fmt::format("  {:<8} {}{}", a.duv ? "cct" : a.unit, number, a.duv ? fmt::format(" K, Duv {:.5f}", *a.duv) : ""));
      if (a.explanation) session.print(nested(*a.explanation));
    }
    results.push_back(json);
    return Done{};
  }
  const Result<Answer> a = answer(written, *target, setup, options);
  if (!a) return a.error();
  session.print(a->text);
  if (a->explanation) session.print("  " + to_string(*a->explanation));
  if (a->in_gamut == false) session.diagnostics.note("OUT_OF_GAMUT", fmt::format("{} is outside of Rec.709: a channel is negative", text));
  if (a->efficacy_lm_W) {
    const bool named = a->efficacy.find("lm/W") == std::string::npos;
    session.diagnostics.note("EFFICACY_USED",
                             fmt::format("{} through {} lm/W{}", text, *a->efficacy_lm_W, named ? ", " + a->efficacy : ""));
  }
  results.push_back(to_json(*a));
  return Done{};
}

void add_units(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("units", "Quantities of lights, cameras and colours in other units");
  auto options = std::make_shared<UnitsOptions>();
  verb->add_option("QUANTITY", options->quantities,
                   "\"1500 lm\", \"15 klx @ 2 m\", \"f/16 1/125 ISO100\", \"3000 K\", \"#ffb46b\"; - for rows from stdin");
  verb->add_option("--to", options->to, "Unit of the result, or rgb, xy, cct. Without it: all that can be known");
  verb->add_option("--shape", options->shape, "point, spot, frustum, sphere, disk, rect, polygon, tube, line, mesh, distant, environment");
  for (const std::string_view name : size_names())
    verb->add_option("--" + std::string(name), options->sizes[std::string(name)],
                     name == "caps"     ? "Of a tube: round (default), flat, none"
                     : name == "points" ? "Of a polygon: its corners, \"0m,0m 2m,0m 2m,60cm\""
                                        : "Of the shape, with its unit")
        ->group("Sizes");
  verb->add_flag("--two-sided", options->two_sided, "A flat light emits to both sides; its flux is that of both together");
  verb->add_option("--distance", options->distance, "Where an illuminance is measured, from the light's origin");
  verb->add_option("--efficacy", options->efficacy,
                   "Between watts and lumens: \"15 lm/W\", a name of --table efficacies, \"2856 K\", \"2856 K visible\"");
  verb->add_option("--spot-flux", options->spot_flux, "falloff (default), cone, frostbite_pi, isotropic")
      ->check(CLI::IsMember({"falloff", "cone", "frostbite_pi", "isotropic"}));
  verb->add_option("--spot-falloff", options->spot_falloff, "squared (default), smoothstep, hard")
      ->check(CLI::IsMember({"squared", "smoothstep", "hard"}));
  verb->add_option("--meter", options->meter, "Constants of the light meter behind EV: K=12.5,C=250");
  verb->add_option("--normalise", options->normalise, "max: the largest channel of rgb is 1, instead of Y")->check(CLI::IsMember({"max"}));
  verb->add_option("--dialect", options->dialect,
                   "What another program calls this light: blender, usd, hdrp, unreal, ...; --to is its unit");
  verb->add_option("--from", options->from,
                   "The quantity is what that program calls this light: \"100 W\" of blender; --to is ours, or --dialect");
  verb->add_option("--metres-per-unit", options->metres_per_unit, "Of the stage, for usd")->check(CLI::PositiveNumber)->group("Dialects");
  verb->add_option("--exposure", options->exposure_stop, "Of usd: times 2^this")->group("Dialects");
  verb->add_flag("--normalize", options->normalize, "Of usd: divided by the area in units of the stage")->group("Dialects");
  verb->add_flag("--reflector", options->reflector, "Of hdrp and filament: lumens over the cone of a spot")->group("Dialects");
  verb->add_flag("--clamp", options->clamp, "A temperature beyond 100 K to 100000 K counts as the nearer one, with a warning");
  verb->add_flag("--explain", options->explain, "The formula, its symbols, its convention and its source");
  verb->add_flag("--jsonl", options->jsonl, "Rows from stdin are JSON lines instead of CSV");
  verb->add_flag("--list", options->list, "Every unit");
  verb->add_option("--table", options->table, "formulas, ev, sunny16, calibrations, temperatures, efficacies, dialects, spread");
  verb->footer(
      "\nExamples:\n"
      "  etendue units 1200lm --shape sphere --radius 15cm --to nit\n"
      "  etendue units 5600K --to rgb\n"
      "  etendue units \"f/16 1/125 ISO100\" --to EV\n"
      "  etendue units \"15 klx @ 2 m\" --shape point --to cd --explain\n"
      "  etendue units \"60 W at 15 lm/W\" --to lm\n"
      "  etendue units 100W --efficacy \"CIE D65\" --shape polygon --points \"0m,0m 2m,0m 2m,60cm\" --to nit\n"
      "  etendue units 1500lm --shape sphere --radius 15cm --dialect blender --efficacy 683lm/W\n"
      "  etendue units \"8 unitless\" --from unreal --shape point --to cd\n"
      "  etendue units - --shape point --to cd < fluxes.csv");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_units(common, *options); }; });
}

}  // namespace etendue::cli
