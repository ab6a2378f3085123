// The luminous opening: LM-63 codes its shape in the signs of three numbers, and changed the code twice (1995, 2002).
#include "etendue/photometry.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

using Shape = OpeningShape;

// Signs of width, length and height as one number in base 3: (w + 1) 9 + (l + 1) 3 + (h + 1).
constexpr int code(int w, int l, int h) { return (w + 1) * 9 + (l + 1) * 3 + (h + 1); }
int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

Shape shape_1986(int signs) {
  switch (signs) {
    case code(-1, 0, 0):
      return Shape::disk;
    case code(-1, 0, 1):
      return Shape::vertical_cylinder;
    case code(-1, 1, 0):
      return Shape::ellipse;
    case code(-1, 1, 1):
      return Shape::ellipsoid;
    default:
      return Shape::unknown;
  }
}

Shape shape_1995(int signs) {
  switch (signs) {
    case code(-1, 0, 0):
      return Shape::disk;
    case code(-1, 0, 1):
      return Shape::vertical_cylinder;
    case code(-1, 0, -1):
      return Shape::sphere;
    case code(0, 1, -1):
      return Shape::cylinder_along_length;
    case code(1, 0, -1):
      return Shape::cylinder_along_width;
    case code(-1, 1, 1):
    case code(1, -1, 1):
      return Shape::vertical_elliptical_cylinder;
    case code(-1, 1, -1):
    case code(1, -1, -1):
      return Shape::ellipsoid;
    default:
      return Shape::unknown;
  }
}

Shape shape_2002(int signs, bool round, bool equal) {
  switch (signs) {
    case code(-1, -1, 0):
      return round ? Shape::disk : Shape::ellipse;
    case code(-1, -1, 1):
      return round ? Shape::vertical_cylinder : Shape::vertical_elliptical_cylinder;
    case code(-1, -1, -1):
      return equal ? Shape::sphere : Shape::ellipsoid;
    case code(-1, 1, -1):
      return Shape::cylinder_along_length;
    case code(1, -1, -1):
      return Shape::cylinder_along_width;
    case code(-1, 0, -1):
      return Shape::vertical_disk;
    default:
      return Shape::unknown;
  }
}

LuminousOpening opening_of(const IesRecord& record) {
  const double w = record.width, l = record.length, h = record.height, metres = record.feet ? 0.3048 : 1;
  LuminousOpening opening{Shape::unknown, std::abs(w) * metres, std::abs(l) * metres, std::abs(h) * metres};
  if (w >= 0 && l >= 0 && h >= 0) {
    opening.shape = h > 0 ? Shape::box : w > 0 || l > 0 ? Shape::rectangle : Shape::point;
    return opening;
  }
  const int signs = code(sign(w), sign(l), sign(h));
  opening.shape = record.version >= IesVersion::lm_63_2002   ? shape_2002(signs, w == l, w == l && l == h)
                  : record.version == IesVersion::lm_63_1995 ? shape_1995(signs)
                                                             : shape_1986(signs);
  // Where one number gives a diameter, it is the extent both ways.
  if (opening.shape == Shape::disk || opening.shape == Shape::vertical_cylinder || opening.shape == Shape::sphere)
    opening.length_m = opening.width_m;
  if (opening.shape == Shape::cylinder_along_length && w == 0) opening.width_m = opening.height_m;
  if (opening.shape == Shape::cylinder_along_width && l == 0) opening.length_m = opening.height_m;
  return opening;
}

LuminousOpening opening_of(const EulumdatRecord& record) {
  const bool circular = record.opening_width_mm == 0 && record.opening_length_mm > 0;
  const double length = record.opening_length_mm / 1000, width = circular ? length : record.opening_width_mm / 1000;
  const double height = *std::max_element(record.opening_height_mm.begin(), record.opening_height_mm.end()) / 1000;
  const Shape shape = circular     ? (height > 0 ? Shape::vertical_cylinder : Shape::disk)
                      : height > 0 ? Shape::box
                      : length > 0 ? Shape::rectangle
                                   : Shape::point;
  return {shape, width, length, height};
}

}  // namespace

LuminousOpening opening_of(const IntensityDistribution& distribution) {
  return std::visit([](const auto& record) { return opening_of(record); }, distribution.record);
}

std::string_view name_of(OpeningShape shape) {
  static constexpr std::string_view names[] = {"point",
                                               "rectangle",
                                               "box",
                                               "disk",
                                               "ellipse",
                                               "vertical_cylinder",
                                               "vertical_elliptical_cylinder",
                                               "sphere",
                                               "ellipsoid",
                                               "cylinder_along_length",
                                               "cylinder_along_width",
                                               "vertical_disk",
                                               "unknown"};
  return names[static_cast<int>(shape)];
}

}  // namespace etendue
