#include "photometric_svg.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue::cli {
namespace {

constexpr double size = 640, middle = size / 2, radius = 260;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

// The next round number that is not below x.
double round_up(double x) {
  const double decade = std::pow(10, std::floor(std::log10(x)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (x <= step * decade * (1 + 1e-12)) return step * decade;
  return 10 * decade;
}

std::string curve(const IntensityWeb& web, double c_deg, double outer_cd, const char* style) {
  std::string points;
  const auto add = [&](double c, double side, double gamma) {
    const double r = radius * web.at(c, gamma) / outer_cd, angle = gamma * pi / 180;
    points += fmt::format("{:.2f},{:.2f} ", middle + side * r * std::sin(angle), middle + r * std::cos(angle));
  };
  constexpr double step = 0.5;
  for (double gamma = 180; gamma > 0; gamma -= step) add(c_deg + 180, -1, gamma);
  for (double gamma = 0; gamma <= 180; gamma += step) add(c_deg, 1, gamma);
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke-width=\"2\" {}/>\n", points, style);
}

}  // namespace

std::string polar_svg(const IntensityWeb& web, const std::string& title) {
  const double outer_cd = web.max_cd() > 0 ? round_up(web.max_cd()) : 1;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n",
      size, size + 40);
  svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", size, size + 40);
  svg += "<g fill=\"none\" stroke=\"#ccc\">\n";
  constexpr int rings = 5;
  for (int ring = 1; ring <= rings; ++ring)
    svg += fmt::format("<circle cx=\"{0}\" cy=\"{0}\" r=\"{1}\"/>\n", middle, radius * ring / rings);
  for (int ray = 0; ray < 12; ++ray) {
    const double angle = ray * pi / 6;
    svg += fmt::format("<line x1=\"{0}\" y1=\"{0}\" x2=\"{1:.2f}\" y2=\"{2:.2f}\"/>\n", middle, middle + radius * std::sin(angle),
                       middle + radius * std::cos(angle));
  }
  svg += "</g>\n<g fill=\"#555\" text-anchor=\"middle\">\n";
  for (int ray = 0; ray <= 6; ++ray) {
    const double angle = ray * pi / 6, x = (radius + 20) * std::sin(angle), y = middle + (radius + 18) * std::cos(angle) + 4;
    svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}&#176;</text>\n", middle + x, y, 30 * ray);
    if (ray % 6 != 0) svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}&#176;</text>\n", middle - x, y, 30 * ray);
  }
  for (int ring = 1; ring <= rings; ++ring)
    svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{:g}</text>\n", middle + 18, middle - radius * ring / rings + 14,
                       outer_cd * ring / rings);
  svg += "</g>\n";
  svg += curve(web, 90, outer_cd, "stroke=\"#c2410c\" stroke-dasharray=\"6 4\"");
  svg += curve(web, 0, outer_cd, "stroke=\"#1d4ed8\"");
  svg += fmt::format("<text x=\"{}\" y=\"20\" text-anchor=\"middle\" font-size=\"14\" fill=\"#111\">{}</text>\n", middle, escaped(title));
  svg += fmt::format(
      "<text x=\"20\" y=\"{0}\" fill=\"#1d4ed8\">C0 (right), C180</text><text x=\"160\" y=\"{0}\" fill=\"#c2410c\">C90 (right), C270, "
      "dashed</text>"
      "<text x=\"{1}\" y=\"{0}\" text-anchor=\"end\" fill=\"#555\">cd; peak {2:.5g} cd, {3:.5g} lm</text>\n",
      size + 24, size - 20, web.max_cd(), web.flux_lm());
  return svg + "</svg>\n";
}

}  // namespace etendue::cli
