// A photometric file for people.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "photometric_file.h"

namespace etendue::cli {
namespace {

// Braille has two by four dots a character.
class Canvas {
 public:
  Canvas(int columns, int rows)
      : columns_(columns), rows_(rows), cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}
  int width() const { return 2 * columns_; }
  int height() const { return 4 * rows_; }
  void dot(double x, double y) {
    const int i = static_cast<int>(std::lround(x)), j = static_cast<int>(std::lround(y));
    if (i < 0 || j < 0 || i >= width() || j >= height()) return;
    static constexpr int bits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    cells_[static_cast<std::size_t>(j / 4) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i / 2)] |= bits[j % 4][i % 2];
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (int j = 0; j < rows_; ++j) {
      std::string line;
      for (int i = 0; i < columns_; ++i) {
        const int cell = cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
        // U+2800 and the dots in its low byte.
        line += cell == 0 ? std::string(" ")
                          : std::string{'\xE2', static_cast<char>(0xA0 | cell >> 6), static_cast<char>(0x80 | (cell & 0x3F))};
      }
      while (!line.empty() && line.back() == ' ') line.pop_back();
      lines.push_back(line);
    }
    return lines;
  }

 private:
  int columns_, rows_;
  std::vector<int> cells_;
};

std::string length_text(double m, Units units) {
  return units == Units::metric ? fmt::format("{:.4g} m", m) : fmt::format("{:.4g} ft", m / 0.3048);
}

std::string spread_text(const IntensityWeb& web, double share, const auto& spread) {
  std::string text;
  for (const PlanePair plane : {PlanePair::c0_180, PlanePair::c90_270}) {
    const std::optional<Spread> found = spread(web, plane, share);
    if (!text.empty()) text += " x ";
    text += found ? fmt::format("{}{:.1f}", found->ends_with_table ? "over " : "", found->full_deg) : "-";
  }
  return text + " deg";
}

std::string output_text(const LightOutput& out) {
  std::string text = fmt::format("{:.1f} % downwards", 100 * out.downward_share);
  if (out.lor) text += fmt::format("; of the lamps {:.1f} %: {:.1f} % down, {:.1f} % up", 100 * *out.lor, 100 * *out.dlor, 100 * *out.ulor);
  return text;
}

// H x V of floodlights, whose webs are of type A or B.
std::string nema_text(const IntensityWeb& web) {
  if (web.type() == WebType::c) return "";
  const auto h = spread_about_peak(web, PlanePair::c90_270, field_share), v = spread_about_peak(web, PlanePair::c0_180, field_share);
  const auto type = [](const std::optional<Spread>& field) {
    const std::optional<int> found = field ? nema_type(field->full_deg) : std::nullopt;
    return found ? fmt::format("{}", *found) : std::string("-");
  };
  return fmt::format("type {} x {} (H x V)", type(h), type(v));
}

std::string luminance_text(const IntensityDistribution& d, const IntensityWeb& web) {
  std::string text;
  for (const double gamma : {65.0, 75.0, 85.0}) {
    const auto at_0 = opening_luminance(d, web, direction_of(WebType::c, {gamma, 0}));
    const auto at_90 = opening_luminance(d, web, direction_of(WebType::c, {gamma, 90}));
    if (at_0 && at_90) text += fmt::format("{}{} deg {:.4g} x {:.4g}", text.empty() ? "" : ", ", gamma, *at_0, *at_90);
  }
  return text.empty() ? text : text + " cd/m2 (C0 x C90)";
}

}  // namespace

// The nadir points down. C0 to the right with C180, drawn through; C90 with C270 dotted.
std::string polar_diagram(const IntensityWeb& web) {
  if (!(web.max_cd() > 0)) return {};
  Canvas canvas(40, 20);
  const double radius = canvas.height() / 2.0 - 1, x0 = canvas.width() / 2.0 - 0.5, y0 = canvas.height() / 2.0 - 0.5;
  const double aspect = static_cast<double>(canvas.width()) / canvas.height();
  for (int angle = 0; angle < 360; angle += 4)
    for (const double ring : {0.5, 1.0})
      canvas.dot(x0 + aspect * radius * ring * std::sin(angle * pi / 180), y0 + radius * ring * std::cos(angle * pi / 180));
  const auto curve = [&](double c, double side, double step) {
    for (int i = 0; i * step <= 180; ++i) {
      const double gamma = i * step;
      const double r = radius * web.at(c, gamma) / web.max_cd();
      if (r > 0) canvas.dot(x0 + side * aspect * r * std::sin(gamma * pi / 180), y0 + r * std::cos(gamma * pi / 180));
    }
  };
  curve(0, 1, 0.25);
  curve(180, -1, 0.25);
  curve(90, 1, 3);
  curve(270, -1, 3);
  std::string text;
  for (const std::string& line : canvas.lines()) text += "    " + line + "\n";
  return text + fmt::format("    outer circle {:.5g} cd; line C0 (right) and C180, dots C90 (right) and C270; nadir down\n", web.max_cd());
}

std::string report_of(const PhotometricReading& r, Units units) {
  const IntensityDistribution& d = r.distribution;
  const IntensityWeb& web = r.web;
  const auto* ies = std::get_if<IesRecord>(&d.record);
  std::string text = fmt::format("{}: {}, type {}, {} {} x {} angles, symmetry {}\n", r.file,
                                 ies != nullptr ? fmt::format("IES LM-63-{}", name_of(ies->version)) : "EULUMDAT", name_of(d.grid.type),
                                 is_absolute(d) ? "absolute," : "relative,", d.grid.horizontal_deg.size(), d.grid.vertical_deg.size(),
                                 name_of(d.grid.symmetry));
  const auto row = [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<12}{}\n", name, value);
  };
  row("luminaire", keyword_of(d, "LUMINAIRE"));
  row("maker", keyword_of(d, "MANUFAC"));
  row("catalogue", keyword_of(d, "LUMCAT"));
  row("lamp", keyword_of(d, "LAMP"));
  const std::optional<double> rated = rated_flux_lm(d);
  const double watts = input_watts(d);
  row("flux", fmt::format("{:.6g} lm (zonal rule {:.6g} lm){}{}", web.flux_lm(), r.flux_zonal_lm,
                          rated ? fmt::format(", rated {:.6g} lm", *rated) : "",
                          watts > 0 ? fmt::format(", {:.4g} W, {:.4g} lm/W", watts, web.flux_lm() / watts) : ""));
  const Peak peak = peak_of(web);
  row("peak", fmt::format("{:.6g} cd at {} {:.4g}, {} {:.4g} deg", peak.cd, web.type() == WebType::c ? "C" : "H",
                          peak.angles.horizontal_deg, web.type() == WebType::c ? "gamma" : "V", peak.angles.vertical_deg));
  row("beam", spread_text(web, beam_share, spread_about_peak) + " of the peak, " + spread_text(web, beam_share, spread_about_axis) +
                  " of the axis (C0-C180 x C90-C270)");
  row("field", spread_text(web, field_share, spread_about_peak) + " of the peak, " + spread_text(web, field_share, spread_about_axis) +
                   " of the axis");
  const double flux = web.flux_lm();
  std::string zones;
  for (const auto& [from, to] : {std::pair{0, 30}, {30, 60}, {60, 90}, {90, 180}}) {
    const double lm = web.flux_between(from, to);
    zones += fmt::format("{}{}-{} deg {:.5g} lm ({:.1f} %)", zones.empty() ? "" : ", ", from, to, lm, flux > 0 ? 100 * lm / flux : 0);
  }
  row("zones", zones);
  row("output", output_text(light_output(d, web)));
  row("NEMA", nema_text(web));
  const LuminousOpening opening = opening_of(d);
  row("opening", fmt::format("{} {} wide, {} long, {} high", name_of(opening.shape), length_text(opening.width_m, units),
                             length_text(opening.length_m, units), length_text(opening.height_m, units)));
  row("luminance", luminance_text(d, web));
  if (ies != nullptr && ies->tilt)
    row("tilt", fmt::format("{}, not applied", ies->tilt->resolved ? fmt::format("{} angles", ies->tilt->angles_deg.size())
                                                                   : "in " + ies->tilt->file + ", which was not read"));
  return text + polar_diagram(web);
}

}  // namespace etendue::cli
