#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench_table.h"
#include "svg.h"

namespace etendue::cli {
namespace {

struct Mark {
  double ns, error;
  std::string_view name;
  bool is_ours, in_front;
};
// Where both axes begin and end, in powers of ten.
struct Range {
  double from, to;
};
Range decades(double low, double high) { return {std::floor(std::log10(low) + 1e-9), std::ceil(std::log10(high) - 1e-9)}; }

// A plain box of a panel's drawing.
struct Panel {
  double left, top, width, height;
  Range ns, error;
  Vec2d at(double time, double amount) const {
    return {left + width * (std::log10(time) - ns.from) / (ns.to - ns.from),
            top + height * (error.to - std::log10(amount)) / (error.to - error.from)};
  }
};

std::vector<Mark> marks_of(const MethodTable& table, MethodFigures MethodRow::*side) {
  std::vector<Mark> marks;
  for (const MethodRow& row : table.rows)
    marks.push_back({(row.*side).ns, std::max((row.*side).agg, 1e-9), row.method, row.is_ours, false});
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.ns != b.ns ? a.ns < b.ns : a.error < b.error; });
  double least = 1e300;
  for (Mark& m : marks) {
    m.in_front = m.error < least;
    least = std::min(least, m.error);
  }
  return marks;
}

constexpr double most_decades = 3;  // with lines at 2 and 5 of each

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& b) const { return left < b.right && b.left < right && top < b.bottom && b.top < bottom; }
};

// A name beside its mark, where it meets no other: right, left, and further up or down with a thread to the mark.
void label(SvgSheet& sheet, const Panel& panel, const Mark& mark, std::vector<Box>& taken) {
  constexpr double size = 10.5, glyph = 5.6;
  const Vec2d at = panel.at(mark.ns, mark.error);
  const double width = glyph * static_cast<double>(mark.name.size());
  for (int step = 0; step < 60; ++step) {
    const int row = (step + 2) / 4 * ((step / 2) % 2 == 0 ? 1 : -1);
    const double down = 11.0 * row;
    const bool right = step % 2 == 0;
    const double x = right ? at.x + 8 : at.x - 8 - width, y = at.y + 3.5 + down;
    const Box box{x, y - 9, x + width, y + 2};
    if (box.left < panel.left + 2 || box.right > panel.left + panel.width + 40 || box.top < panel.top ||
        box.bottom > panel.top + panel.height)
      continue;
    if (std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.meets(box); })) continue;
    if (down != 0) sheet.line(at, {right ? x - 1 : x + width + 1, y - 3.5}, "axis");
    sheet.text({x, y}, mark.name, mark.is_ours ? "ink halo" : "soft halo", "start", size);
    taken.push_back(box);
    return;
  }
}

void draw(SvgSheet& sheet, const Panel& panel, std::string_view title, const std::vector<Mark>& marks) {
  sheet.text({panel.left, panel.top - 10}, title, "ink", "start", 13.5);
  for (int decade = static_cast<int>(std::floor(panel.ns.from)); decade < panel.ns.to; ++decade) {
    for (const double part : {1.0, 2.0, 5.0}) {
      if (part > 1 && panel.ns.to - panel.ns.from > most_decades) continue;  // their numbers would overlap
      const double time = part * std::pow(10, decade), place = std::log10(time);
      if (place < panel.ns.from || place > panel.ns.to) continue;
      const double x = panel.at(time, 1).x;
      sheet.line({x, panel.top}, {x, panel.top + panel.height}, "grid");
      sheet.text({x, panel.top + panel.height + 17}, fmt::format("{:g}", time), "soft", "middle", 11);
    }
  }
  for (int e = static_cast<int>(panel.error.from); e <= static_cast<int>(panel.error.to); ++e) {
    const double y = panel.at(1, std::pow(10, e)).y;
    sheet.line({panel.left, y}, {panel.left + panel.width, y}, "grid");
    sheet.text({panel.left - 8, y + 4}, fmt::format("{:g}", std::pow(10, e)), "soft", "end", 11);
  }
  sheet.line({panel.left, panel.top}, {panel.left, panel.top + panel.height}, "axis");
  sheet.line({panel.left, panel.top + panel.height}, {panel.left + panel.width, panel.top + panel.height}, "axis");
  // The front is a stair: what its marks to the left cost less, they err more.
  std::vector<Vec2d> front;
  for (const Mark& m : marks) {
    if (!m.in_front) continue;
    const Vec2d at = panel.at(m.ns, m.error);
    front.push_back({at.x, front.empty() ? panel.top : front.back().y});
    front.push_back(at);
  }
  front.push_back({panel.left + panel.width, front.back().y});
  sheet.path(front, false, "axis dash");
  std::vector<Box> taken;
  for (const Mark& m : marks) {
    const Vec2d at = panel.at(m.ns, m.error);
    sheet.circle(at, 4, m.is_ours ? "a fa" : "b fb");
    taken.push_back({at.x - 5, at.y - 5, at.x + 5, at.y + 5});
  }
  for (const Mark& m : marks) label(sheet, panel, m, taken);
}

}  // namespace

std::string method_scatter(const MethodTable& table) {
  const std::vector<Mark> above = marks_of(table, &MethodRow::above), across = marks_of(table, &MethodRow::across);
  double fastest = 1e300, slowest = 0, least = 1e300, most = 0;
  for (const auto* marks : {&above, &across}) {
    for (const Mark& m : *marks) {
      fastest = std::min(fastest, m.ns), slowest = std::max(slowest, m.ns);
      least = std::min(least, m.error), most = std::max(most, m.error);
    }
  }
  const Range ns{std::log10(0.8 * fastest), std::log10(1.3 * slowest)}, error = decades(least, most);
  SvgSheet sheet(1180, 620);
  sheet.heading(fmt::format("{} of a {}: time against error", table.light,
                            table.shape == "rect"    ? "rectangle"
                            : table.shape == "point" ? "point light"
                                                     : table.shape),
                fmt::format("{} points each, one thread, {}; error: the sum of all errors over the sum of the light", table.samples,
                            table.instruction_sets.front().name));
  constexpr double top = 110, width = 470, height = 430;
  draw(sheet, {80, top, width, height, ns, error}, "Above the horizon", above);
  draw(sheet, {660, top, width, height, ns, error}, table.shape == "point" ? "Risen or set" : "Across the horizon", across);
  sheet.text({80 + width / 2, top + height + 40}, "time a point, ns", "soft", "middle", 12);
  sheet.text({660 + width / 2, top + height + 40}, "time a point, ns", "soft", "middle", 12);
  sheet.circle({86, 600}, 4, "a fa");
  sheet.text({96, 604}, "ours", "ink");
  sheet.circle({150, 600}, 4, "b fb");
  sheet.text({160, 604}, "published", "ink");
  sheet.line({246, 600}, {276, 600}, "axis dash");
  sheet.text({284, 604}, "no method is both quicker and closer", "ink");
  return sheet.str();
}

}  // namespace etendue::cli
