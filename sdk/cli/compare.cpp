// etendue compare: a picture against independent runs of a reference, aware of noise.
#include "etendue/compare.h"

#include <fmt/format.h>

#include "comparison_text.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct Options {
  std::string ours, max_difference = "1%", light;
  std::vector<std::string> references;
  unsigned samples = 0;
};

// One file with a variance layer is a pooled reference; otherwise every file is one run.
Result<Picture> read_reference(const std::vector<std::string>& files) {
  std::vector<Picture> runs;
  for (const std::string& file : files) {
    Result<Picture> picture = read_exr(file);
    if (!picture) return picture;
    runs.push_back(std::move(*picture));
  }
  if (runs.size() == 1 && runs[0].find("variance") != nullptr && runs[0].numbers.contains("etendue:seeds")) return std::move(runs[0]);
  return pool(runs);
}

int run_compare(const Common& common, const Options& options) {
  Session session("compare", common);
  CompareOptions compare_options;
  const Result<double> fraction = parse_fraction(options.max_difference);
  if (!fraction) return session.fail(fraction.error());
  compare_options.max_difference = *fraction;
  compare_options.samples = options.samples;

  const Result<Picture> ours = read_exr(options.ours);
  if (!ours) return session.fail(ours.error());
  const Result<Picture> reference = read_reference(options.references);
  if (!reference) return session.fail(reference.error());
  const Result<Comparison> comparison = compare(*ours, *reference, compare_options, {}, options.light);
  if (!comparison) return session.fail(comparison.error());
  session.result = to_json(*comparison);
  session.print(table_of(*comparison));
  return session.finish(exit_status_of(comparison->verdict));
}

}  // namespace

void add_compare(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("compare", "A picture against independent runs of a reference, aware of noise");
  auto options = std::make_shared<Options>();
  verb->add_option("OURS", options->ours, "The picture that is judged (OpenEXR, linear)")->required();
  verb->add_option("REF", options->references, "Five or more independent runs of the reference, or one pooled picture of `validate`")
      ->required();
  verb->add_option("--max-diff", options->max_difference, "The difference asked about, as 1% or 0.01")->capture_default_str();
  verb->add_option("--light", options->light, "Compare one light's layers of both");
  verb->add_option("--samples", options->samples, "Samples per pixel of the reference over all runs, for advice");
  verb->footer(
      "\nExit status: 0 same, 1 differs, 4 undecided.\n\nExamples:\n  etendue compare ours.exr mitsuba.exr\n"
      "  etendue compare ours.exr run*.exr --max-diff 0.2% --json");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_compare(common, *options); }; });
}

}  // namespace etendue::cli
