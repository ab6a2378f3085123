#include "texel_grid.h"

#include <algorithm>
#include <cmath>

#include "angle.h"

namespace etendue {
namespace {

constexpr CubeFace faces[] = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, "nadir"}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, "zenith"},
                              {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, "c0"},      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, "c90"},
                              {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, "c180"},  {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, "c270"}};

}  // namespace

std::span<const CubeFace> cube_faces() { return faces; }

namespace photometry {
namespace {

// Clarberg's map, p = 2 (u, v) - 1: |p| = r along the diagonals' metric, z = 1 - r^2 in the inner half, mirrored in the outer one.
Vec3d octahedral_direction(double u, double v) {
  const double px = 2 * u - 1, py = 2 * v - 1, ax = std::abs(px), ay = std::abs(py);
  const double inside = 1 - (ax + ay), r = 1 - std::abs(inside), quarter = pi / 4;
  const double phi = r > 0 ? ((ay - ax) / r + 1) * quarter : quarter, across = r * std::sqrt(2 - r * r);
  return {std::copysign(std::cos(phi) * across, px), std::copysign(std::sin(phi) * across, py), std::copysign(1 - r * r, inside)};
}

Vec2d octahedral_place(const Vec3d& d) {
  // 1 - |z| without cancellation.
  const double r = std::sqrt((d.x * d.x + d.y * d.y) / (1 + std::abs(d.z)));
  const double along = atan2_deg(std::abs(d.y), std::abs(d.x)) / 90;
  double py = r * along, px = r - py;
  if (d.z < 0) {
    const double outer = 1 - px;
    px = 1 - py;
    py = outer;
  }
  return {(std::copysign(px, d.x) + 1) / 2, (std::copysign(py, d.y) + 1) / 2};
}

std::uint32_t largest_component(const Vec3d& d) {
  const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  if (z >= x && z >= y) return d.z < 0 ? 0 : 1;
  if (x >= y) return d.x > 0 ? 2 : 4;
  return d.y > 0 ? 3 : 5;
}

}  // namespace

Vec3d TexelGrid::direction(const Place& p) const {
  const double across = width_ > 1 ? p.column : 0;
  if (layout_ == BakeLayout::cube) {
    const double x = 1 - 2 * across / (width_ - 1), y = 1 - 2 * p.row / (height_ - 1);
    const CubeFace& face = faces[p.picture];
    return normalised(face.left * x + face.up * y + face.forward);
  }
  const double u = (across + 0.5) / width_, v = (p.row + 0.5) / height_;
  if (layout_ == BakeLayout::octahedral) return octahedral_direction(u, v);
  const SineCosine azimuth = sine_cosine_deg(360 * u);
  if (layout_ == BakeLayout::c_gamma) {
    const SineCosine gamma = sine_cosine_deg(180 * v);
    return {gamma.sine * azimuth.cosine, gamma.sine * azimuth.sine, -gamma.cosine};
  }
  const double z = std::clamp(2 * v - 1, -1.0, 1.0), leg = std::sqrt((1 - z) * (1 + z));
  return {leg * azimuth.cosine, leg * azimuth.sine, z};
}

TexelGrid::Place TexelGrid::place(const Vec3d& any_length) const {
  const Vec3d d = normalised(any_length);
  if (layout_ == BakeLayout::cube) {
    const std::uint32_t picture = largest_component(d);
    const CubeFace& face = faces[picture];
    const double ahead = dot(d, face.forward), x = dot(d, face.left) / ahead, y = dot(d, face.up) / ahead;
    return {picture, 0.5 * (1 - x) * (width_ - 1), 0.5 * (1 - y) * (height_ - 1)};
  }
  if (layout_ == BakeLayout::octahedral) {
    const Vec2d uv = octahedral_place(d);
    return {0, uv.x * width_ - 0.5, uv.y * height_ - 0.5};
  }
  const WebAngles angles = angles_of(WebType::c, d);
  const double u = angles.horizontal_deg / 360, v = layout_ == BakeLayout::c_gamma ? angles.vertical_deg / 180 : (1 + d.z) / 2;
  return {0, u * width_ - 0.5, v * height_ - 0.5};
}

double TexelGrid::candelas_per_value(const Place& p) const {
  if (layout_ != BakeLayout::cube) return 1;
  const double x = 1 - 2 * p.column / (width_ - 1), y = 1 - 2 * p.row / (height_ - 1), square = 1 + x * x + y * y;
  return square * std::sqrt(square);
}

// Tents are cut at the edges of a cube and add what the border holds elsewhere. With s the step of gamma, the tent about gamma has
//   integral of (1 - |t| / s) sin(gamma + t) = sin(gamma) 2 (1 - cos s) / s,
// and the first row, 1 up to a = s / 2 and falling to 0 at b = 3 s / 2, has 1 - (sin b - sin a) / s.
double TexelGrid::weight(std::uint32_t column, std::uint32_t row) const {
  const double columns = width_, rows = height_;
  if (layout_ == BakeLayout::cube) {
    const double across = column == 0 || column + 1 == width_ ? 1 : 2, down = row == 0 || row + 1 == height_ ? 1 : 2;
    return across / (columns - 1) * down / (rows - 1);
  }
  if (layout_ != BakeLayout::c_gamma) return 4 * pi / (columns * rows);
  const double s = pi / rows, turn = 2 * pi / columns;
  if (row == 0 || row + 1 == height_) return turn * (1 - (std::sin(1.5 * s) - std::sin(0.5 * s)) / s);
  const double half = std::sin(0.5 * s);
  return turn * std::sin((row + 0.5) * s) * 4 * half * half / s;
}

std::size_t TexelGrid::texel(std::uint32_t picture, std::ptrdiff_t column, std::ptrdiff_t row) const {
  const auto columns = static_cast<std::ptrdiff_t>(width_), rows = static_cast<std::ptrdiff_t>(height_);
  if (layout_ == BakeLayout::octahedral) {
    // Beyond a border the picture goes on from its other end, turned.
    if (column < 0 || column >= columns) {
      column = column < 0 ? -1 - column : 2 * columns - 1 - column;
      row = rows - 1 - row;
    }
    if (row < 0 || row >= rows) {
      row = row < 0 ? -1 - row : 2 * rows - 1 - row;
      column = columns - 1 - column;
    }
  } else if (layout_ == BakeLayout::cube) {
    column = std::clamp<std::ptrdiff_t>(column, 0, columns - 1);
  } else {
    column = (column % columns + columns) % columns;
  }
  row = std::clamp<std::ptrdiff_t>(row, 0, rows - 1);
  return (std::size_t{picture} * height_ + static_cast<std::size_t>(row)) * width_ + static_cast<std::size_t>(column);
}

double TexelGrid::interpolated(std::span<const float> values, const Place& p) const {
  const double left = std::floor(p.column), top = std::floor(p.row), s = p.column - left, t = p.row - top;
  const auto i = static_cast<std::ptrdiff_t>(left), j = static_cast<std::ptrdiff_t>(top);
  const auto value = [&](std::ptrdiff_t column, std::ptrdiff_t row) -> double { return values[texel(p.picture, column, row)]; };
  return (1 - t) * ((1 - s) * value(i, j) + s * value(i + 1, j)) + t * ((1 - s) * value(i, j + 1) + s * value(i + 1, j + 1));
}

}  // namespace photometry
}  // namespace etendue
