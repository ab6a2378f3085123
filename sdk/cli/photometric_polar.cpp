// The polar diagram.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "photometric_diagrams.h"
#include "svg.h"

namespace etendue::cli {
namespace {

constexpr double width = 680, radius = 250, under_heading = 92, with_keys = 92;

// The brightest direction whose gamma is within a range.
double brightest(std::span<const DrawnWeb> webs, double from_deg, double to_deg) {
  double most = 0;
  for (const DrawnWeb& drawn : webs)
    for (const double c : {0.0, 90.0, 180.0, 270.0})
      for (const double gamma : ticks(from_deg, to_deg, 0.5)) most = std::max(most, drawn.web->at(c, gamma));
  return most;
}

// Half a circle where the other half is dark.
enum class Part { whole, lower, upper };

struct Frame {
  Part part;
  Vec2d centre;
  double outer_cd, height;
  Vec2d at(double side, double gamma_deg, double r) const {
    const double angle = gamma_deg * pi / 180;
    return {centre.x + side * r * std::sin(angle), centre.y + r * std::cos(angle)};
  }
  bool shows(double gamma_deg) const { return part == Part::whole || (part == Part::lower ? gamma_deg <= 90.01 : gamma_deg >= 89.99); }
};

Frame frame_of(std::span<const DrawnWeb> webs, double top, double below_it) {
  const double peak = brightest(webs, 0, 180), up = brightest(webs, 92, 180), down = brightest(webs, 0, 88);
  const Part part = up <= 0.005 * peak ? Part::lower : down <= 0.005 * peak ? Part::upper : Part::whole;
  const double above = part == Part::lower ? 16 : radius, below = part == Part::upper ? 16 : radius;
  return {part, {width / 2, top + above + 20}, peak > 0 ? round_up(peak) : 1, top + above + below + below_it};
}

void draw_grid(SvgSheet& sheet, const Frame& frame) {
  const double step = round_step(frame.outer_cd, 5);
  const double from = frame.part == Part::upper ? 90 : 0, to = frame.part == Part::lower ? 90 : 180;
  const auto arc = [&](double r, const char* classes) {
    std::vector<Vec2d> points;
    for (const double gamma : ticks(to, from, -2)) points.push_back(frame.at(-1, gamma, r));
    for (const double gamma : ticks(from, to, 2)) points.push_back(frame.at(1, gamma, r));
    sheet.path(points, frame.part == Part::whole, classes);
  };
  for (const double cd : ticks(step, frame.outer_cd, step)) arc(radius * cd / frame.outer_cd, "grid");
  arc(radius, "axis");
  for (int gamma = 0; gamma <= 180; gamma += 15) {
    if (!frame.shows(gamma)) continue;
    const bool named = gamma % 30 == 0;
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && gamma % 180 == 0) continue;
      sheet.line(frame.at(side, gamma, 0), frame.at(side, gamma, radius), gamma % 90 == 0 ? "axis" : "grid");
      if (!named) continue;
      const Vec2d label = frame.at(side, gamma, radius + 18);
      const bool level = std::abs(std::sin(gamma * pi / 180)) > 0.3;
      sheet.text({label.x, label.y + 4}, fmt::format("{}\u00B0", gamma), "soft", !level ? "middle" : side > 0 ? "start" : "end");
    }
  }
}

// Beside the axis that has most room: values of the circles.
void draw_scale(SvgSheet& sheet, const Frame& frame) {
  const double step = round_step(frame.outer_cd, 5), gamma = frame.part == Part::upper ? 180 : 0;
  for (const double cd : ticks(step, frame.outer_cd, step)) {
    const Vec2d at = frame.at(1, gamma, radius * cd / frame.outer_cd);
    sheet.text({at.x + 5, at.y + (gamma == 0 ? -4 : 13)}, fmt::format("{:g}", cd), "soft halo", "start", 11);
  }
}

std::vector<Vec2d> curve(const Frame& frame, const IntensityWeb& web, double c_deg, double step) {
  std::vector<Vec2d> points;
  const auto add = [&](double c, double side, double gamma) {
    if (frame.shows(gamma)) points.push_back(frame.at(side, gamma, radius * web.at(c, gamma) / frame.outer_cd));
  };
  for (const double gamma : ticks(180, step, -step)) add(c_deg + 180, -1, gamma);
  for (const double gamma : ticks(0, 180, step)) add(c_deg, 1, gamma);
  return points;
}

// The first web in front; a point every `step` degrees.
void draw_curves(SvgSheet& sheet, const Frame& frame, std::span<const DrawnWeb> webs, double step) {
  const bool several = webs.size() > 1;
  for (std::size_t i = webs.size(); i-- > 0;) {
    const bool second = several && i == 1;
    const std::vector<Vec2d> across = curve(frame, *webs[i].web, 90, step), along = curve(frame, *webs[i].web, 0, step);
    const bool closed = frame.part == Part::whole;
    sheet.path(across, true, second || !several ? "fb" : "fa");
    sheet.path(along, true, second ? "fb" : "fa");
    sheet.path(across, closed, second || !several ? "b dash" : "a dash");
    sheet.path(along, closed, second ? "b" : "a");
  }
}

}  // namespace

std::string polar_figure(const IntensityWeb& web) {
  const DrawnWeb drawn{&web, ""};
  const Frame frame = frame_of({&drawn, 1}, 22, 62);
  SvgSheet sheet(width, frame.height);
  draw_grid(sheet, frame);
  draw_curves(sheet, frame, {&drawn, 1}, 1.5);
  draw_scale(sheet, frame);
  return sheet.str(SvgSheet::Style::of_the_page);
}

std::string polar_svg(std::span<const DrawnWeb> webs, const std::string& title) {
  const Frame frame = frame_of(webs, under_heading, with_keys);
  const bool several = webs.size() > 1;
  SvgSheet sheet(width, frame.height + (several ? 24 : 0));
  sheet.heading(title, several ? "intensity, cd" : key_figures(*webs[0].web));
  draw_grid(sheet, frame);
  draw_curves(sheet, frame, webs, 0.5);
  draw_scale(sheet, frame);
  const double y = frame.height - 18;
  if (several) {
    for (std::size_t i = 0; i < webs.size(); ++i) {
      const double next = sheet.key({24, y + 24.0 * static_cast<double>(i)}, i == 0 ? "a" : "b", shortened(webs[i].label, 56));
      sheet.key({std::max(next, 460.0), y + 24.0 * static_cast<double>(i)}, i == 0 ? "a dash" : "b dash", "C90\u2013C270");
    }
  } else {
    const double next = sheet.key({24, y}, "a", "C0\u2013C180");
    sheet.key({next, y}, "b dash", "C90\u2013C270");
    sheet.text({width - 24, y}, "C0 and C90 to the right; cd", "soft", "end");
  }
  return sheet.str();
}

}  // namespace etendue::cli
