// etendue fit-ltc: tables of linearly transformed cosines from our own GGX, with what they misplace.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "etendue/ltc.h"
#include "etendue/picture.h"
#include "svg.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

using eval::LtcTable;

struct Options {
  std::string out, map, rows;
  std::uint32_t size = 33;
  bool force = false;
};

constexpr std::array<std::string_view, LtcTable::terms> terms{
    "whole_00_alpha",    "whole_02_alpha",  "whole_width_alpha",  "whole_20",          "whole_22",  "f0_part",
    "f90_part",          "first_00_alpha",  "first_02_alpha",     "first_width_alpha", "first_20",  "first_22",
    "second_00_alpha",   "second_02_alpha", "second_width_alpha", "second_20",         "second_22", "f0_part_of_first",
    "f90_part_of_first", "one_00_alpha",    "one_02_alpha",       "one_width_alpha",   "one_20",    "one_22"};

// What is misplaced at places of the table; the middles between nodes tell what reading it between them adds.
struct Misplaced {
  double alpha, cosine, share;
};
std::vector<Misplaced> misplaced_at(const LtcTable& table, double offset) {
  std::vector<Misplaced> all;
  const double last = table.size() - 1;
  for (std::uint32_t row = 0; row + offset <= last; ++row) {
    for (std::uint32_t column = 0; column + offset <= last; ++column) {
      const double root = (row + offset) / last, alpha = std::max(root * root, LtcTable::lowest_alpha);
      const double cosine = std::max((column + offset) / last, LtcTable::lowest_cosine);
      all.push_back({alpha, cosine, eval::misplaced_share(table.at(alpha, cosine).whole, alpha, cosine)});
    }
  }
  return all;
}

struct Band {
  std::string_view name;
  double above, up_to;
};
constexpr Band bands[] = {{"to .01", 0, 0.01}, {".01 to .1", 0.01, 0.1}, {".1 to .3", 0.1, 0.3}, {".3 to 1", 0.3, 1}};
constexpr double least_cosine = 0.05;

struct Figures {
  double mean = 0, p99 = 0, largest = 0;
};
// None where the table has no such place.
std::optional<Figures> figures_of(const std::vector<Misplaced>& all, const Band& band) {
  std::vector<double> shares;
  for (const Misplaced& m : all) {
    if (m.cosine >= least_cosine && m.alpha > band.above && m.alpha <= band.up_to) shares.push_back(m.share);
  }
  if (shares.empty()) return std::nullopt;
  Figures f;
  std::sort(shares.begin(), shares.end());
  for (const double s : shares) f.mean += s / static_cast<double>(shares.size());
  f.p99 = shares[shares.size() * 99 / 100];
  f.largest = shares.back();
  return f;
}

Picture picture_of(const LtcTable& table, const std::vector<Misplaced>& misplaced) {
  Picture picture;
  picture.width = picture.height = table.size();
  picture.texts["etendue:axes"] = "columns: cosine of the view from 0 to 1; rows from the top: square root of alpha from 0 to 1";
  for (std::size_t k = 0; k < terms.size(); ++k) {
    Layer& layer = picture.add(std::string(terms[k]), 1);
    std::transform(table.nodes().begin(), table.nodes().end(), layer.pixels.begin(), [k](const LtcTable::Node& n) { return n[k]; });
  }
  Layer& layer = picture.add("misplaced", 1);
  std::transform(misplaced.begin(), misplaced.end(), layer.pixels.begin(), [](const Misplaced& m) { return static_cast<float>(m.share); });
  return picture;
}

std::string map_of(const LtcTable& table, const std::vector<Misplaced>& misplaced) {
  constexpr double left = 70, top = 70, side = 420, highest = 0.3;
  SvgSheet sheet(left + side + 110, top + side + 60);
  sheet.heading("Share of the GGX lobe that a transformed cosine misplaces",
                "of its light above the horizon: no light of one luminance is further off");
  const double cell = side / table.size();
  std::string cells;
  for (std::uint32_t row = 0; row < table.size(); ++row) {
    for (std::uint32_t column = 0; column < table.size(); ++column) {
      const Misplaced& m = misplaced[static_cast<std::size_t>(row) * table.size() + column];
      cells += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", left + column * cell,
                           top + (table.size() - 1 - row) * cell, cell + 0.3, cell + 0.3, ramp_colour(std::min(m.share / highest, 1.0)));
    }
  }
  sheet.raw(cells);
  for (const double cosine : {0.0, 0.25, 0.5, 0.75, 1.0})
    sheet.text({left + 0.5 * cell + cosine * (side - cell), top + side + 18}, fmt::format("{:g}", cosine), "soft", "middle");
  sheet.text({left + 0.5 * side, top + side + 40}, "cosine of the view", "ink", "middle");
  for (const double alpha : {0.0001, 0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0})
    sheet.text({left - 8, top + 0.5 * cell + (1 - std::sqrt(alpha)) * (side - cell) + 4}, fmt::format("{:g}", alpha), "soft", "end");
  sheet.text({left - 8, top + side + 18}, "alpha", "ink", "end");
  constexpr int steps = 60;
  std::string scale;
  for (int i = 0; i < steps; ++i)
    scale += fmt::format("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"16\" height=\"{:.2f}\" fill=\"{}\"/>\n", left + side + 24,
                         top + side * (steps - 1 - i) / steps, side / steps + 0.3, ramp_colour((i + 0.5) / steps));
  sheet.raw(scale);
  for (const double share : {0.0, 0.1, 0.2, 0.3})
    sheet.text({left + side + 46, top + side * (1 - share / highest) + 4},
               fmt::format("{:g} %{}", 100 * share, share == highest ? "+" : ""), "soft");
  return sheet.str();
}

// As the library's own table stands in its source: six digits, more than the fit has.
std::string rows_of(const LtcTable& table) {
  std::string text;
  for (const LtcTable::Node& node : table.nodes()) {
    text += "{";
    for (std::size_t k = 0; k < node.size(); ++k) {
      std::string number = fmt::format("{:.6g}", node[k]);
      if (number.find_first_of(".e") == std::string::npos) number += '.';
      text += fmt::format("{}{}f", k == 0 ? "" : ", ", number);
    }
    text += "},\n";
  }
  return text;
}

int run_fit_ltc(const Common& common, const Options& options) {
  Session session("fit-ltc", common);
  for (const std::string& file : {options.out, options.map, options.rows}) {
    if (!file.empty() && !options.force && std::filesystem::exists(file))
      return session.fail({"USAGE", fmt::format("{} is there already", file), {}, "--force replaces it", {}});
  }
  const auto table = [&] {
    Bar bar(session);
    return eval::fit_ltc(options.size, [&](double done) { return bar.report("fit", done); });
  }();
  if (!table) return session.finish(exit_cancelled);
  const std::vector<Misplaced> at_nodes = misplaced_at(*table, 0), between = misplaced_at(*table, 0.5);
  if (const Status written = write_exr(picture_of(*table, at_nodes), options.out); !written) return session.fail(written.error());
  const auto write_text = [](const std::string& file, const std::string& text) { return write_file(file, std::as_bytes(std::span(text))); };
  if (!options.map.empty()) {
    if (const Status written = write_text(options.map, map_of(*table, at_nodes)); !written) return session.fail(written.error());
  }
  if (!options.rows.empty()) {
    if (const Status written = write_text(options.rows, rows_of(*table)); !written) return session.fail(written.error());
  }
  session.result = {{"file", options.out}, {"size", options.size}, {"bands", Json::array()}};
  session.print(
      fmt::format("{}: {} x {} nodes. Share of the lobe that is misplaced, views with a cosine from {:g} on, in %:\n"
                  "{:<10} {:^24}   {:^24}\n{:<10} {:>8}{:>8}{:>8}   {:>8}{:>8}{:>8}",
                  options.out, options.size, options.size, least_cosine, "alpha", "at nodes", "half way between", "", "mean", "p99",
                  "largest", "mean", "p99", "largest"));
  for (const Band& band : bands) {
    const auto text = [](const std::optional<Figures>& f) {
      return f ? fmt::format("{:>8.2f}{:>8.2f}{:>8.2f}", 100 * f->mean, 100 * f->p99, 100 * f->largest)
               : std::string("       -       -       -");
    };
    const auto at = figures_of(at_nodes, band), off = figures_of(between, band);
    session.print(fmt::format("{:<10} {}   {}", band.name, text(at), text(off)));
    Json row{{"alpha_above", band.above}, {"alpha_to", band.up_to}};
    const auto json = [](const Figures& f) { return Json{{"mean", f.mean}, {"p99", f.p99}, {"largest", f.largest}}; };
    if (at) row["at_nodes"] = json(*at);
    if (off) row["between"] = json(*off);
    session.result["bands"].push_back(std::move(row));
  }
  session.stats["nodes"] = table->nodes().size();
  return session.finish(exit_done);
}

}  // namespace

void add_fit_ltc(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("fit-ltc", "Tables of linearly transformed cosines fitted to GGX, as OpenEXR layers");
  auto options = std::make_shared<Options>();
  verb->add_option("OUT", options->out, "OpenEXR file: twenty-four terms a node, and the share of the lobe that is misplaced")->required();
  verb->add_option("--size", options->size, "Nodes along each side: cosine of the view across, square root of alpha down")
      ->capture_default_str()
      ->check(CLI::Range(2, 256));
  verb->add_option("--map", options->map, "SVG file: the misplaced share over the table");
  verb->add_option("--rows", options->rows, "Text file: the nodes as rows of C++ numbers, as the library's own table stands in its source");
  verb->add_flag("--force", options->force, "Replace files that are there");
  verb->footer(
      "\nExamples:\n  etendue fit-ltc ltc.exr\n  etendue fit-ltc ltc.exr --size 65 --map ltc.svg\n"
      "  etendue fit-ltc ltc.exr --rows sdk/src/eval/ltc_table.inc --force");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_fit_ltc(common, *options); }; });
}

}  // namespace etendue::cli
