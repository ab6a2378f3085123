// A picture as SVG text: one sheet with a title, in colours that follow a light or dark reader.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "etendue/vec.h"

namespace etendue::cli {

// Text as XML takes it.
std::string xml_escaped(std::string_view text);

// At most `count` characters of UTF-8, with an ellipsis where some are left out.
std::string shortened(std::string_view text, std::size_t count);

// The next of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below x > 0.
double round_up(double x);
// Equal round steps, at most `count` of them, from 0 to beyond x > 0: the step.
double round_step(double x, int count);

// from, from + step, ... up to `to`, which rounding does not lose; downwards for a step below 0.
std::vector<double> ticks(double from, double to, double step);

// Classes that its text may use: ink, soft (text); grid, axis (thin lines); a, b (lines of two colours), dash; fa, fb (areas of them,
// faint).
class SvgSheet {
 public:
  SvgSheet(double width, double height) : width_(width), height_(height) {}
  double width() const { return width_; }
  double height() const { return height_; }

  void raw(std::string_view markup) { body_ += markup; }
  // `anchor`: start, middle or end.
  void text(Vec2d at, std::string_view text, std::string_view classes, std::string_view anchor = "start", double size = 12);
  void line(Vec2d from, Vec2d to, std::string_view classes);
  void circle(Vec2d centre, double radius, std::string_view classes);
  void path(const std::vector<Vec2d>& points, bool closed, std::string_view classes);
  // A title over the sheet and a line below it.
  void heading(std::string_view title, std::string_view subtitle);
  // A sample of a line, and what it stands for; returns where the next one may begin.
  double key(Vec2d at, std::string_view classes, std::string_view label);

  // The whole file; or, to stand in a page that has svg_style() once, without its colours.
  enum class Style { own, of_the_page };
  std::string str(Style style = Style::own) const;

 private:
  double width_, height_;
  std::string body_;
};

// The classes' colours, as a style element.
std::string_view svg_style();

// A colour for 0 (dark) to 1 (bright), of even steps to the eye and in any kind of colour vision: "#rrggbb".
std::string ramp_colour(double t, double shade = 1);

}  // namespace etendue::cli
