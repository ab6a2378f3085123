// etendue bench: run time against error of every method for a shape of light.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "diffuse_bench.h"
#include "etendue/io.h"
#include "specular_bench.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct Options {
  DiffuseBench bench;
  SpecularBench specular;
  std::string brdf = "lambert", svg;
  std::optional<std::uint64_t> samples;
  bool is_specular() const { return brdf == "ggx"; }
};

// What a rectangle costs at least, by the count of its operations: whole, and cut by the horizon.
constexpr double whole_rect_flop = 273, cut_rect_flop = 371;

void add_figures(Json& row, const std::string& side, const MethodFigures& f, const std::vector<InstructionSet>& sets) {
  row["ns_" + side] = f.ns;
  for (std::size_t k = 0; k < sets.size(); ++k) row["ns_by_set"][sets[k].name][side] = f.ns_on[k];
  row["error_" + side + "_agg"] = f.agg;
  row["error_" + side + "_mean_rel"] = f.mean_rel;
  row["error_" + side + "_p99_rel"] = f.p99;
  row["error_" + side + "_max_abs"] = f.max_abs;
  row["exact_" + side] = f.exact;
  if (!f.ours.empty()) {
    row["matched_" + side + "_by"] = f.ours;
    row["matched_" + side + "_ratio"] = f.ratio;
  }
}
Json to_json(const MethodTable& table) {
  Json rows = Json::array();
  for (const MethodRow& r : table.rows) {
    Json row = {{"shape", table.shape},
                {"method", r.method},
                {"kind", r.is_ours ? "ours" : "published"},
                {"in_vectors", !r.one_by_one},
                {"ns", 0.5 * (r.above.ns + r.across.ns)}};
    if (table.yardstick && !r.one_by_one) {
      row["over_ltc_rect_above"] = r.above.ns / table.yardstick->above.ns;
      row["over_ltc_rect_across"] = r.across.ns / table.yardstick->across.ns;
      for (std::size_t k = 0; k < table.instruction_sets.size(); ++k)
        row["ltc_rect_ns_by_set"][table.instruction_sets[k].name] = {{"above", table.yardstick->above.ns_on[k]},
                                                                     {"across", table.yardstick->across.ns_on[k]}};
    }
    add_figures(row, "above", r.above, table.instruction_sets);
    add_figures(row, "across", r.across, table.instruction_sets);
    row["note"] = r.note;
    rows.push_back(row);
  }
  return rows;
}

std::string match_of(const MethodRow& row, const MethodFigures& f) {
  if (row.one_by_one) return row.is_ours ? "ours, one by one in double" : "one by one in double";
  if (row.is_ours) return f.exact ? "ours, exact" : "ours";
  const std::string self = f.exact ? "exact itself; " : "";
  if (f.ours.empty()) return self + "NOT MATCHED: none of ours errs as little";
  return fmt::format("{}{}{} at {:.2f} x", self, f.ratio <= matched_ratio ? "" : "NOT MATCHED: ", f.ours, f.ratio);
}
std::string text_of(const MethodTable& table) {
  const std::vector<InstructionSet>& sets = table.instruction_sets;
  std::string out = fmt::format(
      "{} of {}, {} points above the horizon and as many across it, seed {}; peak of multiply-adds, measured in the same turns: ",
      table.light, table.shape, table.samples, table.seed);
  for (const InstructionSet& set : sets)
    out += fmt::format("{}{} {:.0f} GFLOP/s", &set == &sets.front() ? "" : ", ", set.name, set.peak_gflops);
  out += "\n";
  for (const auto& [side, title] : {std::pair{&MethodRow::above, "above the horizon"},
                                    {&MethodRow::across, table.shape == "point" ? "risen or set" : "across the horizon"}}) {
    out += fmt::format("\n{:<28}", title);
    for (const InstructionSet& set : sets) out += fmt::format(" {:>10}", set.name + " ns");
    if (table.yardstick) out += fmt::format(" {:>8}", "of ltc");
    out += fmt::format(" {:>9} {:>9} {:>9} {:>9}  {}\n", "agg", "mean rel", "p99 rel", "max abs",
                       "who of ours errs no more, at what part of its time");
    std::vector<std::size_t> order(table.rows.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&, by = side](std::size_t a, std::size_t b) { return (table.rows[a].*by).ns < (table.rows[b].*by).ns; });
    for (const std::size_t i : order) {
      const MethodRow& row = table.rows[i];
      const MethodFigures& f = row.*side;
      out += fmt::format("{:<28}", row.method);
      for (const double ns : f.ns_on) out += fmt::format(" {:>10.2f}", ns);
      if (table.yardstick) out += row.one_by_one ? std::string(9, ' ') : fmt::format(" {:>8.2f}", f.ns / (*table.yardstick.*side).ns);
      out += fmt::format(" {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g}  {}\n", f.agg, f.mean_rel, f.p99, f.max_abs, match_of(row, f));
    }
  }
  const auto exact = std::find_if(table.rows.begin(), table.rows.end(), [](const MethodRow& r) { return r.method == "exact"; });
  if (table.shape == "rect" && exact != table.rows.end()) {
    out += "\n";
    for (std::size_t k = 0; k < sets.size(); ++k)
      out += fmt::format(
          "exact on {}: {:.2f} times the time of {:.0f} FLOP at its peak above the horizon, {:.2f} times that of {:.0f} across it\n",
          sets[k].name, exact->above.ns_on[k] * sets[k].peak_gflops / whole_rect_flop, whole_rect_flop,
          exact->across.ns_on[k] * sets[k].peak_gflops / cut_rect_flop, cut_rect_flop);
  }
  return out;
}

int run_bench(const Common& common, const Options& options) {
  Session session("bench", common);
  Result<MethodTable> table = Error{};
  {
    Bar bar(session);
    const auto report = [&](double done) { return bar.report("measuring", done); };
    table = options.is_specular() ? run_specular_bench(options.specular, report) : run_diffuse_bench(options.bench, report);
  }
  if (!table) return session.fail(table.error());
  session.result = to_json(*table);
  session.stats = {{"shape", table->shape},
                   {"points", table->samples},
                   {"seed", table->seed},
                   {"instruction_set", table->instruction_sets.front().name},
                   {"peak_gflops", table->instruction_sets.front().peak_gflops}};
  for (const InstructionSet& set : table->instruction_sets) session.stats["peak_gflops_by_set"][set.name] = set.peak_gflops;
  session.print(text_of(*table));
  if (!options.svg.empty()) {
    const std::string svg = method_scatter(*table);
    if (const Status written = write_file(options.svg, std::as_bytes(std::span(svg))); !written) return session.fail(written.error());
  }
  return session.finish(exit_done);
}

}  // namespace

void add_bench(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("bench", "Run time against error of every method for the light of a shape");
  auto options = std::make_shared<Options>();
  verb->add_option("SHAPE", options->bench.shape, "rect, sphere, disk, tube (with round caps), line or point")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(bench_shapes.begin(), bench_shapes.end())));
  verb->add_option("--brdf", options->brdf, "lambert: the light that falls on a surface; ggx: what its specular lobe sends to the eye")
      ->capture_default_str()
      ->check(CLI::IsMember({"lambert", "ggx"}));
  verb->add_option("--f0", options->specular.f0, "Of the lobe: reflectance at normal incidence")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--alpha", options->specular.alphas, "Of the lobe: roughness squared, or several that points have in turn")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 1.0));
  verb->add_option("--svg", options->svg, "Draw time against error to this file; what is there is replaced");
  verb->add_option("--samples", options->samples,
                   "Points on each side of the horizon, in batches of 4096 a light (131072; of lobes, whose reference takes longer, 16384)")
      ->check(CLI::Range(4096, 1 << 22));
  verb->add_option("--seed", options->bench.seed, "Of lights and points")->capture_default_str();
  verb->add_option("--rounds", options->bench.rounds, "Turns that the methods take; the median counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 10001));
  verb->footer(
      "\nErrors are those of floats against the exact light in double, for a luminance of 1: agg is the sum of all errors over the\n"
      "sum of the light; relative ones are of what gives a thousandth or more. Methods take turns on one thread, so what slows the\n"
      "machine down slows all of them, and it is the processor's time that counts. There is a column of times (ns a point) for the\n"
      "machine's best instruction set, by which methods are compared, and one each for AVX2 and SSE4. Of a line and a point light\n"
      "there is the closed form alone. Of lobes, methods without vectors are timed once, in double, and `of ltc` is a time over that\n"
      "of transformed cosines of rectangles in the same turns.\n"
      "\nExamples:\n"
      "  etendue bench rect\n"
      "  etendue bench tube --svg tube.svg\n"
      "  etendue bench rect --brdf ggx --f0 .04\n"
      "  etendue bench rect --brdf ggx --alpha .01,.02,.05 --svg narrow.svg\n"
      "  etendue bench disk --samples 65536 --seed 7 --json");
  verb->callback([&common, &run, options, verb] {
    const auto& shapes = specular_bench_shapes;
    const std::string& shape = options->bench.shape;
    if (options->is_specular() && std::find(shapes.begin(), shapes.end(), shape) == shapes.end())
      throw CLI::ValidationError("SHAPE", "lobes are measured with rect, sphere, disk and tube, not with " + shape);
    if (!options->is_specular() && verb->count("--f0") + verb->count("--alpha") > 0)
      throw CLI::ValidationError("--f0, --alpha", "are of a lobe: add --brdf ggx");
    options->specular.shape = shape, options->specular.seed = options->bench.seed, options->specular.rounds = options->bench.rounds;
    if (options->samples) options->bench.samples = options->specular.samples = *options->samples;
    run = [&common, options] { return run_bench(common, *options); };
  });
}

}  // namespace etendue::cli
