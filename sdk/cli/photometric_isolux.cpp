// Illuminance on a plane that faces the light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contours.h"
#include "photometric_diagrams.h"
#include "svg.h"

namespace etendue::cli {
namespace {

constexpr double width = 720, left = 70, top = 94, side = 600;
constexpr std::size_t nodes = 201;

// A plane at `distance` in front of the light, of which a square of `half` to each side is shown; x towards C0, y towards C90.
struct Plane {
  double distance_m, half_m;
  bool above;
  Vec2d metres(double column, double row) const {
    const double cell = 2 * half_m / (nodes - 1);
    return {column * cell - half_m, half_m - row * cell};
  }
  Vec2d sheet(double column, double row) const { return {left + side * column / (nodes - 1), top + side * row / (nodes - 1)}; }
};

// E = I cos(angle) / r^2 = I d / r^3.
double illuminance(const IntensityWeb& web, const Plane& plane, const Vec2d& at) {
  const Vec3d to{at.x, at.y, plane.above ? plane.distance_m : -plane.distance_m};
  const double square = dot(to, to);
  return web.towards(to) * plane.distance_m / (square * std::sqrt(square));
}

ContourGrid grid_of(const IntensityWeb& web, const Plane& plane, double per_lux) {
  return {nodes, [&](double column, double row) { return per_lux * illuminance(web, plane, plane.metres(column, row)); }};
}

// 1, 2, 5, 10, ...: at most eight below the largest.
std::vector<double> levels_below(double largest) {
  std::vector<double> levels;
  for (int decade = static_cast<int>(std::floor(std::log10(largest))); levels.size() < 8 && decade > -12; --decade)
    for (const double step : {5.0, 2.0, 1.0})
      if (const double level = step * std::pow(10, decade); level < 0.95 * largest && levels.size() < 8) levels.push_back(level);
  std::reverse(levels.begin(), levels.end());
  return levels;
}

// The smallest of some squares at whose border the plane has got dark; narrow beams are shown close, wide ones to five distances.
Plane plane_for(std::span<const DrawnWeb> webs, double distance_m) {
  double up = 0, down = 0;
  for (const DrawnWeb& drawn : webs) {
    down += drawn.web->flux_between(0, 90);
    up += drawn.web->flux_between(90, 180);
  }
  Plane plane{distance_m, 0, up > down};
  for (const double ratio : {0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0}) {
    plane.half_m = ratio * distance_m;
    bool dark = true;
    for (const DrawnWeb& drawn : webs) {
      const ContourGrid grid = grid_of(*drawn.web, plane, 1);
      dark = dark && grid.largest_on_border() < 0.01 * grid.largest();
    }
    if (dark) break;
  }
  return plane;
}

std::string path_of(const Plane& plane, const std::vector<std::vector<Vec2d>>& loops) {
  std::string d;
  for (const std::vector<Vec2d>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2d p = plane.sheet(loop[i].x, loop[i].y);
      d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", p.x, p.y);
    }
    d += "Z";
  }
  return d;
}

struct Label {
  Vec2d at;
  std::string text;
};

// On each line, where it is farthest towards one of a few directions in turn, inside of the frame and away from the labels before it.
void place_label(std::vector<Label>& labels, const Plane& plane, const std::vector<std::vector<Vec2d>>& loops, double level,
                 std::size_t rank) {
  std::optional<Vec2d> best;
  double most = -1e300;
  const double turn = (35.0 + 29.0 * static_cast<double>(rank)) * pi / 180;
  for (const std::vector<Vec2d>& loop : loops)
    for (const Vec2d& node : loop) {
      const Vec2d p = plane.sheet(node.x, node.y);
      if (p.x < left + 24 || p.x > left + side - 24 || p.y < top + 14 || p.y > top + side - 14) continue;
      if (std::any_of(labels.begin(), labels.end(),
                      [&](const Label& l) { return std::abs(l.at.x - p.x) < 46 && std::abs(l.at.y - p.y) < 17; }))
        continue;
      const double far = p.x * std::cos(turn) - p.y * std::sin(turn);
      if (far > most) most = far, best = p;
    }
  if (best) labels.push_back({*best, fmt::format("{:g}", level)});
}

void draw_axes(SvgSheet& sheet, const Plane& plane, Units units) {
  const double unit_m = units == Units::imperial ? 0.3048 : 1, half = plane.half_m / unit_m, step = round_step(half, 4);
  const auto x_of = [&](double at) { return left + side * (at + half) / (2 * half); };
  for (const double at : ticks(-std::floor(half / step + 1e-9) * step, half, step)) {
    const double shown = std::abs(at) < 1e-9 * step ? 0 : at, mirrored = top + side - (x_of(at) - left);
    sheet.line({x_of(at), top}, {x_of(at), top + side}, "grid");
    sheet.line({left, mirrored}, {left + side, mirrored}, "grid");
    sheet.text({x_of(at), top + side + 19}, fmt::format("{:g}", shown), "soft", "middle");
    sheet.text({left - 9, mirrored + 4}, fmt::format("{:g}", shown), "soft", "end");
  }
  const std::string unit = units == Units::imperial ? "ft" : "m";
  sheet.text({left + side, top + side + 40}, unit + ", towards C0 \u2192", "soft", "end");
  sheet.text({left, top - 10}, unit + ", towards C90 \u2191", "soft", "start");
}

}  // namespace

std::string isolux_svg(std::span<const DrawnWeb> webs, const std::string& title, double distance_m, Units units) {
  const bool imperial = units == Units::imperial, several = webs.size() > 1;
  const double per_lux = imperial ? 0.3048 * 0.3048 : 1, unit_m = imperial ? 0.3048 : 1;
  const char* const unit = imperial ? "fc" : "lx";
  const Plane plane = plane_for(webs, distance_m);
  SvgSheet sheet(width, top + side + (several ? 96 : 62));
  std::vector<ContourGrid> grids;
  double largest = 0;
  for (const DrawnWeb& drawn : webs) {
    grids.push_back(grid_of(*drawn.web, plane, per_lux));
    largest = std::max(largest, grids.back().largest());
  }
  sheet.heading(title, fmt::format("illuminance, {}, on a plane {:.4g} {} {} the light; at most {:.4g} {}", unit, distance_m / unit_m,
                                   imperial ? "ft" : "m", plane.above ? "above" : "below", largest, unit));
  sheet.raw(
      fmt::format("<clipPath id=\"frame\"><rect x=\"{0:g}\" y=\"{1:g}\" width=\"{2:g}\" height=\"{2:g}\"/></clipPath>\n", left, top, side));
  const std::vector<double> levels = largest > 0 ? levels_below(largest) : std::vector<double>{};
  std::vector<Label> labels;
  if (!several) {
    // The first band begins at the lowest level: below it the sheet shows through.
    for (std::size_t i = 0; i < levels.size(); ++i)
      sheet.raw(fmt::format("<path clip-path=\"url(#frame)\" fill-rule=\"evenodd\" d=\"{}\" fill=\"{}\" fill-opacity=\".85\"/>\n",
                            path_of(plane, grids[0].loops(levels[i])),
                            ramp_colour(static_cast<double>(i + 1) / static_cast<double>(levels.size()))));
  }
  draw_axes(sheet, plane, units);
  for (std::size_t w = 0; w < webs.size(); ++w)
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto loops = grids[w].loops(levels[i]);
      const char* const paint = several ? (w == 0 ? "class=\"a thin\"" : "class=\"b thin\"")
                                        : "fill=\"none\" stroke=\"#0b1014\" stroke-opacity=\".55\" stroke-width=\"1\"";
      sheet.raw(fmt::format("<path clip-path=\"url(#frame)\" d=\"{}\" {}/>\n", path_of(plane, loops), paint));
      place_label(labels, plane, loops, levels[i], i);
    }
  sheet.raw(fmt::format("<rect x=\"{0:g}\" y=\"{1:g}\" width=\"{2:g}\" height=\"{2:g}\" class=\"axis\"/>\n", left, top, side));
  for (const Label& label : labels) sheet.text({label.at.x, label.at.y + 4}, label.text, "ink halo", "middle", 11.5);
  if (several)
    for (std::size_t w = 0; w < webs.size(); ++w)
      sheet.key({left, top + side + 62 + 22.0 * static_cast<double>(w)}, w == 0 ? "a" : "b", shortened(webs[w].label, 80));
  return sheet.str();
}

}  // namespace etendue::cli
