// etendue fit: Disney parameters of a diffuse albedo and an f0.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etendue/material.h"
#include "etendue/material_codes.h"
#include "etendue/material_fit_batch.h"
#include "number_text.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

constexpr std::string_view heading = "dr,dg,db,sr,sg,sb";
constexpr std::size_t longest_line = 4096, block = 4096;

struct Options {
  std::vector<std::string> inputs;
  std::string method = "optimum", dielectric = "reflectance";
  std::optional<int> bits;
  bool spec_gloss = false;
};

struct Answer {
  DisneyColours value;
  double residual = 0, optimum = 0;  // of the value, and of the global optimum
  double metal_low = 0, metal_high = 1;
  std::optional<MaterialCodes> codes;

  double excess() const { return std::max(std::sqrt(residual / 6) - std::sqrt(optimum / 6), 0.0); }
};

// Six numbers between commas.
Result<ColourPair> parse_pair(std::string_view line, const Where& where) {
  std::array<double, 6> n{};
  std::string_view text = line;
  const auto wrong = [&](std::string found) {
    Where at = where;
    at.column = where.line > 0 ? static_cast<int>(line.size() - text.size()) + 1 : 0;
    return Error{"COLOUR_PAIR_INVALID", fmt::format("expected six numbers {}, found {}", heading, found), at, {}, {}};
  };
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (i > 0) {
      if (text.empty() || text.front() != ',') return wrong(text.empty() ? fmt::format("only {}", i) : fmt::format("'{}'", text));
      text.remove_prefix(1);
    }
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    if (const char* why = take_decimal(text, n[i]))
      return wrong(text.empty() ? fmt::format("only {}", i) : fmt::format("'{}': {}", text, why));
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  }
  if (!text.empty()) return wrong(fmt::format("'{}' behind them", text));
  return ColourPair{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

class Fit {
 public:
  explicit Fit(const Options& options) : options_(options) {
    format_.bits = options.bits.value_or(0);
    format_.dielectric = options.method == "core-only"         ? DielectricCode::none
                         : options.dielectric == "reflectance" ? DielectricCode::reflectance
                                                               : DielectricCode::specular_factor;
  }

  std::vector<Answer> operator()(std::span<const ColourPair> pairs) const {
    std::vector<Answer> out;
    out.reserve(pairs.size());
    for (const ColourPair& pair : pairs) {
      const DisneyFit optimum = fit_disney(pair);
      const DisneyFit own = options_.method == "core-only" ? fit_disney(pair, DielectricF0::core) : optimum;
      Answer answer{own.value, own.residual, optimum.residual, own.metal_low, own.metal_high, {}};
      if (options_.bits) {
        const StoredFit stored = fit_codes(pair, format_);
        answer.value = stored.value, answer.residual = stored.residual, answer.codes = stored.codes;
      } else if (options_.method == "lm") {
        const LocalFit local = fit_disney_from({{0.5, 0.5, 0.5}, 0.5, 0.5}, pair);
        answer.value = local.value, answer.residual = local.residual;
      }
      out.push_back(answer);
    }
    if (options_.method == "fast" && !options_.bits) in_floats(pairs, out);
    return out;
  }

 private:
  static void in_floats(std::span<const ColourPair> pairs, std::span<Answer> out) {
    std::vector<Vec3f> diffuse, f0, base(pairs.size());
    std::vector<float> metal(pairs.size()), reflectance(pairs.size());
    for (const ColourPair& pair : pairs) diffuse.push_back(vec_cast<float>(pair.diffuse)), f0.push_back(vec_cast<float>(pair.f0));
    if (!fit_disney(diffuse, f0, {base, metal, reflectance})) return;  // the sizes agree
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      out[i].value = {vec_cast<double>(base[i]), metal[i], reflectance[i]};
      out[i].residual = squared_difference(out[i].value, pairs[i]);
    }
  }

  const Options& options_;
  MaterialFormat format_;
};

// Answers as rows or as JSON; a row that was refused leaves an empty row, so that output and input keep step.
class Teller {
 public:
  Teller(Session& session, bool with_codes) : session_(session), with_codes_(with_codes) {
    session.result = Json::array();
    rows_ = "r,g,b,metal,reflectance,residual,excess";
    if (with_codes) rows_ += ",code_r,code_g,code_b,code_metal,code_dielectric";
    rows_ += '\n';
  }

  void tell(const Answer& a) {
    const DisneyColours& v = a.value;
    if (session_.common().json) {
      Json one{{"base_colour", {v.base_colour.x, v.base_colour.y, v.base_colour.z}},
               {"metal", v.metal},
               {"reflectance", v.reflectance},
               {"residual", a.residual},
               {"excess", a.excess()},
               {"metal_low", a.metal_low},
               {"metal_high", a.metal_high}};
      if (a.codes) one["codes"] = {{"base_colour", a.codes->base_colour}, {"metal", a.codes->metal}, {"dielectric", a.codes->dielectric}};
      session_.result.push_back(std::move(one));
      return;
    }
    auto to = std::back_inserter(rows_);
    fmt::format_to(to, "{},{},{},{},{},{},{}", v.base_colour.x, v.base_colour.y, v.base_colour.z, v.metal, v.reflectance, a.residual,
                   a.excess());
    if (a.codes) {
      const auto& b = a.codes->base_colour;
      fmt::format_to(to, ",{},{},{},{},{}", b[0], b[1], b[2], a.codes->metal, a.codes->dielectric);
    }
    rows_ += '\n';
  }
  void tell_refused() {
    if (session_.common().json)
      session_.result.push_back(nullptr);
    else
      rows_ += with_codes_ ? ",,,,,,,,,,,\n" : ",,,,,,\n";
  }
  Status write() {
    if (!session_.common().json && (std::fwrite(rows_.data(), 1, rows_.size(), stdout) != rows_.size() || std::fflush(stdout) != 0))
      return Error{"FILE_UNWRITABLE", "the output cannot be written", {}, {}, {}};
    rows_.clear();
    return Done{};
  }

 private:
  Session& session_;
  bool with_codes_;
  std::string rows_;
};

class FitRun {
 public:
  FitRun(Session& session, const Options& options)
      : session_(session), options_(options), fit_(options), teller_(session, options.bits.has_value()) {}

  Status values(const std::string& text) {
    const Result<ColourPair> pair = parse_pair(trimmed(text), {});
    if (!pair) return pair.error();
    take(*pair, {});
    return answer();
  }

  Status file(const std::string& file) {
    std::ifstream opened;
    if (file != "-") {
      opened.open(file);
      if (!opened)
        return Error{"FILE_UNREADABLE",
                     "neither six numbers nor a file that can be read",
                     {file, 0, 0, {}},
                     fmt::format("six numbers: {}", heading),
                     {}};
    }
    std::istream& in = file == "-" ? std::cin : opened;
    const std::string name = file == "-" ? "stdin" : file;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (line.size() > longest_line)
        return Error{"LINE_TOO_LONG", fmt::format("expected lines of at most {} bytes", longest_line), {name, number, 0, {}}, {}, {}};
      if (line.ends_with('\r')) line.pop_back();
      const std::string_view text = trimmed(line);
      if (text.empty() || (number == 1 && text == heading)) continue;
      const Where where{name, number, 0, {}};
      if (const Result<ColourPair> pair = parse_pair(line, where); pair)
        take(*pair, where);
      else
        refuse(pair.error());
      if (rows_.size() < block) continue;
      if (Status done = answer(); !done) return done;
      if (interrupted()) return Error{"CANCELLED", "stopped", {}, {}, {}};
    }
    if (in.bad()) return Error{"FILE_UNREADABLE", "the colours cannot be read", {name, 0, 0, {}}, {}, {}};
    return answer();
  }

  int finish() {
    if (const Status written = teller_.write(); !written) return session_.fail(written.error());  // the heading, if there are no rows
    session_.stats["rows"] = rows_told_;
    session_.stats["refused"] = refused_;
    session_.stats["out_of_range"] = out_of_range_;
    if (out_of_range_ > 0)
      session_.diagnostics.warning(
          "COLOUR_OUT_OF_RANGE",
          fmt::format("expected albedos and f0 from 0 to 1, found others in {} of {} rows: no parameters reach them", out_of_range_,
                      rows_told_),
          first_out_of_range_);
    if (refused_ > most_told)
      session_.diagnostics.error("COLOUR_PAIR_INVALID", fmt::format("{} further rows are none", refused_ - most_told));
    return session_.finish(refused_ > 0 ? exit_bad_input : exit_done);
  }

 private:
  static constexpr std::uint64_t most_told = 20;

  void take(ColourPair pair, const Where& where) {
    if (options_.spec_gloss) {
      const TwoColour two = two_colour_of(SpecularGlossiness{pair.diffuse, pair.f0, 1});
      pair = {two.diffuse, two.f0};
    }
    for (const Rgb& colour : {pair.diffuse, pair.f0}) {
      if (std::min({colour.x, colour.y, colour.z}) >= 0 && std::max({colour.x, colour.y, colour.z}) <= 1) continue;
      if (out_of_range_++ == 0) first_out_of_range_ = where;
      break;
    }
    rows_.push_back(pair);
  }
  void refuse(const Error& error) {
    if (refused_++ < most_told) session_.diagnostics.error(error.code, error.text, error.where);
    rows_.push_back(std::nullopt);
  }
  Status answer() {
    std::vector<ColourPair> pairs;
    for (const auto& row : rows_)
      if (row) pairs.push_back(*row);
    const std::vector<Answer> answers = fit_(pairs);
    std::size_t next = 0;
    for (const auto& row : rows_) {
      if (row)
        teller_.tell(answers[next++]);
      else
        teller_.tell_refused();
    }
    rows_told_ += rows_.size();
    rows_.clear();
    return teller_.write();
  }

  Session& session_;
  const Options& options_;
  Fit fit_;
  Teller teller_;
  std::vector<std::optional<ColourPair>> rows_;
  std::uint64_t rows_told_ = 0, refused_ = 0, out_of_range_ = 0;
  Where first_out_of_range_;
};

int run_fit(const Common& common, const Options& options) {
  Session session("fit", common);
  if (options.bits && options.method != "optimum" && options.method != "core-only")
    return session.fail(
        {"USAGE", fmt::format("--bits: expected --method optimum or core-only with it, found {}", options.method), {}, {}, {}});
  FitRun run(session, options);
  for (const std::string& input : options.inputs) {
    const bool numbers = input.find(',') != std::string::npos && !std::ifstream(input);
    if (const Status done = numbers ? run.values(input) : run.file(input); !done) return session.fail(done.error());
  }
  return run.finish();
}

}  // namespace

void add_fit(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("fit", "Disney parameters (base colour, metal, reflectance) of a diffuse albedo and an f0");
  auto options = std::make_shared<Options>();
  verb->add_option("INPUT", options->inputs,
                   fmt::format("Six numbers {}: diffuse albedo and f0, linear Rec.709; or a CSV file of such rows; - is stdin", heading))
      ->required();
  verb->add_option("--method", options->method,
                   "optimum (the global one), fast (in float, within 1e-4 rms of it but for one of 10000), lm (Levenberg-Marquardt from "
                   ".5, which may end elsewhere), core-only (with f0 = .04 for dielectrics, as glTF's core has it)")
      ->capture_default_str()
      ->check(CLI::IsMember({"optimum", "fast", "lm", "core-only"}));
  verb->add_option("--bits", options->bits, "The best stored values of 8, 10 or 16 bits instead, base colour sRGB, the others linear")
      ->check(CLI::IsMember({8, 10, 16}));
  verb->add_option("--dielectric", options->dielectric,
                   "What --bits stores of a dielectric's f0: reflectance (f0 = .16 r^2), or specular (KHR_materials_specular's factor "
                   "beside an ior of 7/3, f0 = .16 w)")
      ->capture_default_str()
      ->check(CLI::IsMember({"reflectance", "specular"}));
  verb->add_flag("--spec-gloss", options->spec_gloss,
                 "The rows are glTF's KHR_materials_pbrSpecularGlossiness, whose albedo is diffuse x (1 - max(specular))");
  verb->footer(
      "\nOut come rows r,g,b,metal,reflectance,residual,excess: the residual is the sum of the six squared differences, the excess that\n"
      "of its rms over the global optimum's; with --bits also the codes. A row that is none is told with its place and leaves an empty\n"
      "row; exit status 1.\n"
      "\nExamples:\n"
      "  etendue fit 0.5,0.3,0.1,0.04,0.04,0.04\n"
      "  etendue fit 0.05,0.03,0.01,0.7,0.5,0.2 --json\n"
      "  etendue fit palette.csv --bits 8\n"
      "  etendue fit - --method core-only < palette.csv\n"
      "  etendue fit 0.5,0.5,0.5,0.9,0.6,0.4 --spec-gloss --bits 16 --dielectric specular");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_fit(common, *options); }; });
}

}  // namespace etendue::cli
