#include "svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::cli {
namespace {

// Plain properties, so that readers without variables show the light colours.
constexpr std::string_view style = R"(<style>
.sheet{font-family:system-ui,"Segoe UI","Helvetica Neue",Arial,sans-serif}
.sheet text{stroke:none}
.sheet .paper{fill:#fff}.sheet .halo{stroke:#fff;stroke-width:3.5;paint-order:stroke;stroke-linejoin:round}
.sheet .ink{fill:#1c2126}.sheet .soft{fill:#66707a}
.sheet .grid{fill:none;stroke:#e1e5e9;stroke-width:1}.sheet .axis{fill:none;stroke:#b4bcc4;stroke-width:1}
.sheet .a{fill:none;stroke:#1f5fbf}.sheet .b{fill:none;stroke:#c9571a}
.sheet .a,.sheet .b{stroke-width:2.2;stroke-linejoin:round;stroke-linecap:round}.sheet .dash{stroke-dasharray:7 5}
.sheet .fa{fill:#1f5fbf;fill-opacity:.11}.sheet .fb{fill:#c9571a;fill-opacity:.09}
.sheet .thin{stroke-width:1.1}
@media (prefers-color-scheme:dark){
.sheet .paper{fill:#15181b}.sheet .halo{stroke:#15181b}
.sheet .ink{fill:#e8ebee}.sheet .soft{fill:#98a3ad}
.sheet .grid{stroke:#2c3238}.sheet .axis{stroke:#56606a}
.sheet .a{stroke:#6fa8ff}.sheet .b{stroke:#ff9c5b}.sheet .fa{fill:#6fa8ff}.sheet .fb{fill:#ff9c5b}
}
</style>
)";

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) out += c;  // XML 1.0 has no control characters
    }
  }
  return out;
}

std::string shortened(std::string_view text, std::size_t count) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80;
    if (begins && ++characters > count) return std::string(text.substr(0, i)) + "\u2026";
  }
  return std::string(text);
}

double round_up(double x) {
  const double decade = std::pow(10, std::floor(std::log10(x)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (x <= step * decade * (1 + 1e-12)) return step * decade;
  return 10 * decade;
}

double round_step(double x, int count) {
  const double least = x / count, decade = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 2.5, 5.0})
    if (least <= step * decade * (1 + 1e-12)) return step * decade;
  return 10 * decade;
}

std::vector<double> ticks(double from, double to, double step) {
  const auto count = static_cast<int>(std::floor((to - from) / step + 1e-6));
  std::vector<double> at;
  for (int i = 0; i <= count; ++i) at.push_back(from + i * step);
  return at;
}

void SvgSheet::text(Vec2d at, std::string_view text, std::string_view classes, std::string_view anchor, double size) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\" text-anchor=\"{}\" font-size=\"{:g}\">{}</text>\n", at.x, at.y,
                       classes, anchor, size, xml_escaped(text));
}

void SvgSheet::line(Vec2d from, Vec2d to, std::string_view classes) {
  body_ +=
      fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", from.x, from.y, to.x, to.y, classes);
}

void SvgSheet::circle(Vec2d centre, double radius, std::string_view classes) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" class=\"{}\"/>\n", centre.x, centre.y, radius, classes);
}

void SvgSheet::path(const std::vector<Vec2d>& points, bool closed, std::string_view classes) {
  if (points.empty()) return;
  std::string d;
  for (std::size_t i = 0; i < points.size(); ++i) d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", points[i].x, points[i].y);
  body_ += fmt::format("<path d=\"{}{}\" class=\"{}\"/>\n", d, closed ? "Z" : "", classes);
}

void SvgSheet::heading(std::string_view title, std::string_view subtitle) {
  text({24, 34}, shortened(title, 64), "ink", "start", 17);
  text({24, 56}, shortened(subtitle, 100), "soft", "start", 12.5);
}

double SvgSheet::key(Vec2d at, std::string_view classes, std::string_view label) {
  line({at.x, at.y - 4}, {at.x + 28, at.y - 4}, classes);
  text({at.x + 36, at.y}, label, "ink");
  return at.x + 60 + 6.6 * static_cast<double>(label.size());
}

std::string_view svg_style() { return style; }

std::string SvgSheet::str(Style which) const {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" class=\"sheet\">\n",
             width_, height_) +
         (which == Style::own ? std::string(style) : std::string()) +
         fmt::format("<rect width=\"{:g}\" height=\"{:g}\" class=\"paper\"/>\n", width_, height_) + body_ + "</svg>\n";
}

// Seven colours of matplotlib's "viridis" (public domain, van der Walt and Smith 2015), straight between them.
std::string ramp_colour(double t, double shade) {
  constexpr std::array<std::array<double, 3>, 7> stops{
      {{68, 1, 84}, {68, 57, 131}, {49, 104, 142}, {33, 145, 140}, {53, 183, 121}, {144, 215, 67}, {253, 231, 37}}};
  const double x = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double between = stops[i][k] + (x - static_cast<double>(i)) * (stops[i + 1][k] - stops[i][k]);
    rgb[k] = static_cast<int>(std::lround(std::clamp(between * shade, 0.0, 255.0)));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

}  // namespace etendue::cli
