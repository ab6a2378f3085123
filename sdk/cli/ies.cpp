// etendue ies: photometric files reported, checked and converted.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <filesystem>
#include <mutex>
#include <thread>

#include "photometric_compare.h"
#include "photometric_convert.h"
#include "photometric_diagrams.h"
#include "photometric_sheet.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> files, at, cone;
  std::string interpolation = "linear", orientation, units = "metric";
  std::size_t lamp_set = 1;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  bool csv = false, check = false, strict = false, compare = false;
  std::string convert, html, svg, diagram = "polar", plane = "3 m";
  double fold = -1;
  ConvertChoice conversion;
};

struct Direction {
  double c_deg = 0, gamma_deg = 0;
};

// Files as they are; of folders everything that is named .ies or .ldt, by name.
Result<std::vector<std::string>> files_of(const std::vector<std::string>& given) {
  std::vector<std::string> files;
  for (const std::string& one : given) {
    std::error_code code;
    if (!fs::is_directory(one, code)) {
      files.push_back(one);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(one, fs::directory_options::skip_permission_denied, code)) {
      std::string extension = entry.path().extension().string();
      std::transform(extension.begin(), extension.end(), extension.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if ((extension == ".ies" || extension == ".ldt") && entry.is_regular_file(code)) found.push_back(entry.path().string());
    }
    std::sort(found.begin(), found.end());
    if (found.empty()) return Error{"FILE_UNREADABLE", fmt::format("\"{}\" holds no .ies or .ldt file", one), {one, 0, 0, {}}, "", {}};
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

Result<Direction> direction_from(const std::string& text) {
  const std::size_t comma = text.find(',');
  Direction direction;
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  bool good = comma != std::string::npos;
  if (good) {
    const auto [c_end, c_error] = std::from_chars(begin, begin + comma, direction.c_deg);
    const auto [gamma_end, gamma_error] = std::from_chars(begin + comma + 1, end, direction.gamma_deg);
    good = c_error == std::errc() && c_end == begin + comma && gamma_error == std::errc() && gamma_end == end;
  }
  if (!good || !(direction.gamma_deg >= 0 && direction.gamma_deg <= 180) || !(std::abs(direction.c_deg) <= 1e6))
    return Error{
        "USAGE", fmt::format("--at: expected C,gamma in degrees, gamma from 0 to 180, found '{}'", text), {}, "as in --at 90,30", {}};
  return direction;
}

// work(i) for every i below `count`, several at a time; the bar shows how many are done.
template <class Work>
void in_parallel(std::size_t count, unsigned jobs, Bar& bar, const char* stage, const Work& work) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex reporting;
  const auto run = [&] {
    for (std::size_t i = next++; i < count && !interrupted(); i = next++) {
      work(i);
      const std::scoped_lock lock(reporting);
      bar.report(stage, static_cast<double>(++done) / static_cast<double>(count));
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::min<std::size_t>(jobs, count); ++i) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
}

void say_cones(const Session& session, Json& json, const IntensityWeb& web, const std::vector<double>& distances, Units units) {
  if (distances.empty()) return;
  json["cone"] = Json::array();
  const bool imperial = units == Units::imperial;
  const double unit_m = imperial ? 0.3048 : 1;
  for (const double distance : distances) {
    const ConeRow row = cone_at(web, distance);
    Json entry = {{"distance_m", row.distance_m}, {"centre_lx", row.centre_lx}};
    if (row.known) entry["beam_diameter_m"] = {{"c0_180", row.diameter_c0_m}, {"c90_270", row.diameter_c90_m}};
    json["cone"].push_back(entry);
    const std::string diameters =
        row.known ? fmt::format("beam {:.4g} x {:.4g} {}", row.diameter_c0_m / unit_m, row.diameter_c90_m / unit_m, imperial ? "ft" : "m")
                  : "no beam below 180 deg";
    session.print(fmt::format("  {:>8.4g} {}  {}, centre {:.5g} {}", distance / unit_m, imperial ? "ft" : "m", diameters,
                              row.centre_lx * (imperial ? 0.3048 * 0.3048 : 1), imperial ? "fc" : "lx"));
  }
}

void say_directions(const Session& session, Json& json, const IntensityWeb& web, const std::vector<Direction>& directions) {
  if (directions.empty()) return;
  json["at"] = Json::array();
  for (const Direction& d : directions) {
    const double cd = web.at(d.c_deg, d.gamma_deg);
    json["at"].push_back({{"c_deg", d.c_deg}, {"gamma_deg", d.gamma_deg}, {"intensity_cd", cd}});
    session.print(fmt::format("  C {:g}, gamma {:g} deg: {:.6g} cd", d.c_deg, d.gamma_deg, cd));
  }
}

// The losses as lines and in the result. The exit status.
int say_conversion(Session& session, Json& json, const PhotometricReading& reading, const Options& options) {
  ConvertChoice choice = options.conversion;
  choice.out = options.convert;
  if (options.fold >= 0) choice.fold = options.fold;
  const Result<ConvertedPhotometry> converted = convert_photometric(reading, choice);
  if (!converted) {
    session.diagnostics.add(to_diagnostic(converted.error()));
    return exit_status_of(converted.error());
  }
  const std::vector<Loss>& losses = converted->losses.losses;
  session.print(fmt::format("{}: {} loss{}", options.convert, losses.size(), losses.size() == 1 ? "" : "es"));
  Json list = Json::array();
  for (const Loss& loss : losses) {
    session.print(fmt::format("  lost: {}: {}", loss.what, loss.effect));
    list.push_back({{"what", loss.what}, {"effect", loss.effect}});
  }
  json["converted"] = {{"out", options.convert}, {"losses", list}};
  if (!choice.resample_deg.empty()) json["converted"]["resample_error_cd"] = converted->resample_error_cd;
  if (choice.fold) json["converted"]["fold_error_cd"] = converted->fold_error_cd;
  return exit_done;
}

std::string title_of(const PhotometricReading& reading) {
  const std::string luminaire = keyword_of(reading.distribution, "LUMINAIRE");
  return luminaire.empty() ? fs::path(reading.file).filename().string() : luminaire;
}

std::string drawn(const std::vector<DrawnWeb>& webs, const std::string& title, const Options& options, double plane_m) {
  if (options.diagram == "cartesian") return cartesian_svg(webs, title);
  if (options.diagram == "web") return web_svg(*webs[0].web, title);
  if (options.diagram == "isolux") return isolux_svg(webs, title, plane_m, options.units == "imperial" ? Units::imperial : Units::metric);
  return polar_svg(webs, title);
}

// One file: FILE.svg; several: a folder with a picture of each, by its name.
Status draw(const PhotometricReading& reading, const Options& options, double plane_m, bool several) {
  const fs::path name = fs::path(reading.file).filename();
  fs::path out = options.svg;
  if (several) {
    std::error_code code;
    fs::create_directories(out, code);
    out /= name.string() + ".svg";
  }
  const std::string svg = drawn({{&reading.web, name.string()}}, title_of(reading), options, plane_m);
  return write_file(out, std::as_bytes(std::span(svg)));
}

Status write_page(const Session& session, const std::vector<PhotometricReading>& readings, const Options& options, Units units) {
  std::vector<std::string> cards(readings.size());
  {
    Bar bar(session);
    in_parallel(readings.size(), options.jobs, bar, "draw", [&](std::size_t i) { cards[i] = luminaire_card(readings[i], units); });
  }
  std::string title = fs::path(options.files.front()).lexically_normal().filename().string();
  if (options.files.size() > 1 || title.empty()) title = "Luminaires";
  const std::string page = luminaire_page(cards, title);
  return write_file(options.html, std::as_bytes(std::span(page)));
}

int say_comparison(Session& session, const std::vector<PhotometricReading>& readings, const Options& options, double plane_m) {
  for (const PhotometricReading& reading : readings) {
    if (reading.error) return session.fail(*reading.error);
    session.diagnostics.append(reading.diagnostics);
  }
  session.print(comparison_of(readings[0], readings[1]));
  session.result = comparison_json(readings[0], readings[1]);
  if (!options.svg.empty()) {
    const std::string a = fs::path(readings[0].file).filename().string(), b = fs::path(readings[1].file).filename().string();
    const std::string svg = drawn({{&readings[0].web, a}, {&readings[1].web, b}}, a + " and " + b, options, plane_m);
    if (const Status written = write_file(options.svg, std::as_bytes(std::span(svg))); !written) return session.fail(written.error());
  }
  session.stats["files"] = readings.size();
  return session.finish(exit_done);
}

int run_ies(const Common& common, const Options& options) {
  Session session("ies", common);
  session.result = Json::array();
  PhotometricChoice choice;
  choice.strict = options.strict;
  choice.lamp_set = options.lamp_set - 1;
  choice.interpolation = options.interpolation == "cos"     ? Interpolation::cosine
                         : options.interpolation == "cubic" ? Interpolation::cubic
                                                            : Interpolation::linear;
  if (!options.orientation.empty()) choice.orientation = options.orientation == "cie" ? Orientation::cie : Orientation::ies;
  const Units units = options.units == "imperial" ? Units::imperial : Units::metric;
  std::vector<Direction> directions;
  for (const std::string& text : options.at) {
    const Result<Direction> direction = direction_from(text);
    if (!direction) return session.fail(direction.error());
    directions.push_back(*direction);
  }
  std::vector<double> distances;
  for (const std::string& text : options.cone) {
    const Result<double> distance = parse_si(text, Dimension::length);
    if (!distance) return session.fail({"USAGE", "--cone: " + distance.error().text, {}, "as in --cone 1m,2m,5m", {}});
    if (!(*distance > 0)) return session.fail({"USAGE", "--cone: expected distances above 0", {}, "as in --cone 1m,2m,5m", {}});
    distances.push_back(*distance);
  }
  const Result<double> plane_m = parse_si(options.plane, Dimension::length);
  if (!plane_m) return session.fail({"USAGE", "--plane: " + plane_m.error().text, {}, "as in --plane \"3 m\"", {}});
  if (!(*plane_m > 0)) return session.fail({"USAGE", "--plane: expected a distance above 0", {}, "as in --plane \"3 m\"", {}});
  const Result<std::vector<std::string>> files = files_of(options.files);
  if (!files) return session.fail(files.error());
  if (!options.convert.empty() && files->size() != 1)
    return session.fail({"USAGE", fmt::format("--convert takes one file, found {}", files->size()), {}, "", {}});
  if (options.compare && files->size() != 2)
    return session.fail({"USAGE", fmt::format("--compare takes two files, found {}", files->size()), {}, "", {}});
  if (options.compare && options.diagram == "web")
    return session.fail({"USAGE", "--compare draws no body over another", {}, "--diagram polar, cartesian or isolux", {}});
  std::vector<PhotometricReading> readings;
  {
    Bar bar(session);
    readings.resize(files->size());
    in_parallel(files->size(), options.jobs, bar, "read", [&](std::size_t i) { readings[i] = read_photometric((*files)[i], choice); });
  }
  if (interrupted()) return session.fail({"CANCELLED", "cancelled", {}, "", {}});

  if (options.compare) return say_comparison(session, readings, options, *plane_m);
  if (!options.html.empty()) {
    if (const Status written = write_page(session, readings, options, units); !written) return session.fail(written.error());
  }
  const bool reported = !options.csv && !options.check && options.convert.empty() && options.html.empty();
  if (options.csv) session.print(csv_header());
  bool bad = false, warned = false;
  int status = exit_done;
  for (const PhotometricReading& reading : readings) {
    Json json = to_json(reading);
    if (options.csv) session.print(csv_row(reading));
    if (reading.error) {
      bad = true;
      session.diagnostics.add(to_diagnostic(*reading.error));
      session.result.push_back(std::move(json));
      continue;
    }
    for (const Diagnostic& d : reading.diagnostics.all()) warned = warned || d.severity == Severity::warning;
    session.diagnostics.append(reading.diagnostics);
    if (reported) session.print(report_of(reading, units));
    say_directions(session, json, reading.web, directions);
    say_cones(session, json, reading.web, distances, units);
    if (!options.svg.empty()) {
      if (const Status drawn = draw(reading, options, *plane_m, readings.size() > 1); !drawn) return session.fail(drawn.error());
    }
    if (!options.convert.empty()) status = say_conversion(session, json, reading, options);
    session.result.push_back(std::move(json));
  }
  session.stats["files"] = readings.size();
  return session.finish(bad || (options.check && warned) ? exit_bad_input : status);
}

}  // namespace

void add_ies(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("ies", "Photometric files: report, check, convert");
  auto options = std::make_shared<Options>();
  verb->add_option("FILE", options->files, "IES LM-63 (.ies) and EULUMDAT (.ldt) files, or folders of them")->required();
  verb->add_flag("--csv", options->csv, "One row a file");
  verb->add_flag("--check", options->check, "Only what is wrong; warnings give exit status 1 too");
  verb->add_flag("--compare", options->compare, "Two files beside each other: figures, and the largest and mean difference of intensity");
  verb->add_option("--html", options->html, "Write a page with a card of each file, to sort and search. What is there is replaced");
  verb->add_flag("--strict", options->strict, "Refuse what a tolerant reading repairs");
  verb->add_option("--at", options->at, "Intensity towards C,gamma in degrees; repeatable");
  verb->add_option("--cone", options->cone, "Beam diameter and illuminance at these distances: 1m,2m,5m")->delimiter(',');
  verb->add_option("--units", options->units, "metric or imperial")->capture_default_str()->check(CLI::IsMember({"metric", "imperial"}));
  verb->add_option("--orientation", options->orientation, "Where C0 lies: ies (along the length) or cie (across it); else as in the file")
      ->check(CLI::IsMember({"ies", "cie"}));
  verb->add_option("--interpolation", options->interpolation, "linear in the angle, cos (in its cosine), or cubic")
      ->capture_default_str()
      ->check(CLI::IsMember({"linear", "cos", "cubic"}));
  verb->add_option("--lamp-set", options->lamp_set, "Which of EULUMDAT's alternatives, from 1")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  verb->add_option("--convert", options->convert, "Write this .ies or .ldt, with a report of what is lost");
  verb->add_option("--svg", options->svg, "Draw a diagram to this file; of several files into this folder. What is there is replaced");
  verb->add_option("--diagram", options->diagram,
                   "What --svg draws: polar, cartesian, web (the distribution as a body) or isolux (on a plane that faces the light)")
      ->capture_default_str()
      ->check(CLI::IsMember({"polar", "cartesian", "web", "isolux"}));
  verb->add_option("--plane", options->plane, "Distance of the isolux plane from the light")->capture_default_str();
  verb->add_option("--year", options->conversion.year, "Version of the .ies that is written")
      ->capture_default_str()
      ->check(CLI::IsMember({"1986", "1991", "1995", "2002", "2019"}));
  verb->add_option("--flux", options->conversion.flux, "Scale what is written to emit this: \"1500 lm\"");
  verb->add_option("--fold", options->fold, "Fold mirrored planes that differ by at most this share of the peak: 0 is exact")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--turn", options->conversion.turn_deg, "Add this to every C angle of what is written, degrees")
      ->check(CLI::Range(-360.0, 360.0));
  verb->add_option("--resample", options->conversion.resample_deg,
                   "Steps of what is written, degrees: of the vertical angles, and of the horizontal ones if they differ: 5 or 5,15")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(CLI::Range(0.1, 90.0));
  verb->add_flag("--same-planes", options->conversion.same_planes, "Across formats, keep the numbers of the C planes");
  verb->add_flag("--force", options->conversion.force, "Replace what is there");
  verb->add_option("--jobs", options->jobs, "Files at a time")->check(CLI::Range(1, 256));
  verb->footer(
      "\nExamples:\n  etendue ies lamp.ies\n  etendue ies library/ --csv > library.csv\n  etendue ies lamp.ldt --at 90,30 --cone 1m,2m,5m\n"
      "  etendue ies library/ --check\n  etendue ies lamp.ies --convert lamp.ldt --fold 0.001\n  etendue ies lamp.ies --convert "
      "smaller.ies --resample 5,15 --turn 30\n  etendue ies lamp.ies --svg lamp.svg\n"
      "  etendue ies library/ --html library.html\n  etendue ies --compare old.ies new.ies --svg both.svg\n"
      "  etendue ies street.ldt --svg street.svg --diagram isolux --plane \"8 m\"");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_ies(common, *options); }; });
}

}  // namespace etendue::cli
