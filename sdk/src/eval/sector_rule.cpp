#include "sector_rule.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// Directions of the outline that are looked at to size a sector.
constexpr int looks = 4;

bool polygon_of_few(const Contour& contour) {
  return contour.size() <= 5 && std::all_of(contour.begin(), contour.end(), [](const Arc& arc) { return arc.great_circle(); });
}

// A corner, whose two sides drop out, if all others are seen within a right angle of it; else the mean direction.
Vec3d centre_of(const Contour& contour) {
  if (polygon_of_few(contour)) {
    double best = 0;
    Vec3d corner;
    for (const Arc& arc : contour) {
      const Vec3d b = arc.at(arc.begin);
      double farthest = 1;
      for (const Arc& other : contour) farthest = std::min(farthest, dot(b, other.at(other.begin)));
      if (farthest > best) best = farthest, corner = b;
    }
    if (best > 0) return normalised(corner);
  }
  const Vec3d mean = direction_integral(contour);
  return length(mean) > 0 ? normalised(mean) : Vec3d{0, 0, 1};
}

double farthest_chord(const Arc& arc, const Vec3d& c) {
  const std::vector<double> chords = squared_chords(arc, c, looks);
  return std::sqrt(*std::max_element(chords.begin(), chords.end()));
}

// By size; one node only where the height over the horizon varies little.
std::size_t order_for(double chord, double height) {
  if (chord < 0.04 && chord < 0.2 * height) return 1;
  return chord < 0.35 ? 2 : chord < 0.8 ? 3 : 4;
}

// The direction to the rim turns by about ds / |b|, |b|^2 = m + rho cos(s - phase), m -+ rho the squared distances to its nearest and its
// farthest point. dx / ds is squash at the farthest and 1 / squash at the nearest point: as 1 / |b| for squash^2 = nearest / farthest.
void even_out(SectorPiece& piece) {
  const Arc& arc = *piece.arc;
  const double radius = length(arc.u);
  const Vec3d axis = cross(arc.u, arc.v) / (radius * radius);
  const double cu = dot(arc.centre, arc.u) / radius, cv = dot(arc.centre, arc.v) / radius, h = dot(arc.centre, axis);
  const double in_plane = std::hypot(cu, cv), near = std::hypot(in_plane - radius, h), far = std::hypot(in_plane + radius, h);
  if (!(near > 0)) return;
  piece.squash = std::sqrt(near / far);
  piece.phase = std::atan2(cv, cu);
  const auto x_of = [&](double s) {
    const double from = s - piece.phase, turns = std::floor((from + pi) / (2 * pi)), half = 0.5 * (from - 2 * pi * turns);
    return 2 * (std::atan2(piece.squash * std::sin(half), std::cos(half)) + pi * turns);
  };
  piece.begin = x_of(arc.begin);
  piece.end = x_of(arc.end);
}

}  // namespace

std::span<const SectorNode> nodes_along(std::size_t order) {
  static constexpr std::array<SectorNode, 1> one{{{0.0, 2.0, 0.0}}};
  static constexpr std::array<SectorNode, 2> two{
      {{-0.5773502691896257, 1.0, -0.5773502691896257}, {0.5773502691896257, 1.0, 0.5773502691896257}}};
  static constexpr std::array<SectorNode, 3> three{{{-0.7745966692414834, 0.5555555555555557, 0.2222222222222223},
                                                    {0.0, 0.8888888888888888, -0.4444444444444444},
                                                    {0.7745966692414834, 0.5555555555555557, 0.2222222222222223}}};
  static constexpr std::array<SectorNode, 4> four{{{-0.8611363115940526, 0.34785484513745357, -0.10600771525769916},
                                                   {-0.33998104358485626, 0.6521451548625464, 0.2685064201079295},
                                                   {0.33998104358485626, 0.6521451548625464, -0.2685064201079295},
                                                   {0.8611363115940526, 0.34785484513745357, 0.10600771525769916}}};
  if (order == 1) return one;
  if (order == 2) return two;
  if (order == 3) return three;
  return four;
}

std::span<const SectorNode> nodes_across(std::size_t order) {
  static constexpr std::array<SectorNode, 1> one{{{0.6666666666666686, 0.5, 0.0}}};
  static constexpr std::array<SectorNode, 2> two{
      {{0.3550510257216829, 0.18195861825602266, -0.17010345435994445}, {0.8449489742783202, 0.3180413817439775, 0.17010345435994448}}};
  static constexpr std::array<SectorNode, 3> three{{{0.21234053823915336, 0.06982697990145412, 0.06303969850511298},
                                                    {0.5905331355592671, 0.22924110635958586, -0.13733921444640784},
                                                    {0.9114120404872984, 0.20093191373895972, 0.07429951594129479}}};
  static constexpr std::array<SectorNode, 4> four{{{0.13975986434378068, 0.031180970950008022, -0.027552335425010187},
                                                   {0.41640956763108383, 0.12984754760823214, 0.07993625927342639},
                                                   {0.723156986361878, 0.20346456801027116, -0.09082177519611168},
                                                   {0.9428958038854847, 0.13550691343148846, 0.03843785134769551}}};
  if (order == 1) return one;
  if (order == 2) return two;
  if (order == 3) return three;
  return four;
}

Sectors sectors_of(const Contour& contour) {
  constexpr double longest = 2.2;  // of a piece, rad
  Sectors sectors{centre_of(contour), {}};
  sectors.pieces.reserve(contour.size() + 2);
  for (const Arc& arc : contour) {
    // Sides through the centre span nothing with it.
    if (arc.great_circle() && std::abs(dot(sectors.centre, cross(arc.u, arc.v))) < 1e-14) continue;
    const double chord = farthest_chord(arc, sectors.centre);
    SectorPiece whole{.arc = &arc,
                      .begin = arc.begin,
                      .end = arc.end,
                      .chord = chord,
                      .order = order_for(chord, sectors.centre.z),
                      .closed = contour.size() == 1};
    if (!arc.unit) even_out(whole);
    const double turn = whole.end - whole.begin;
    const int count = whole.closed ? 1 : std::max(1, static_cast<int>(std::ceil(turn / longest)));
    for (int i = 0; i < count; ++i) {
      SectorPiece piece = whole;
      piece.begin = whole.begin + turn * i / count;
      piece.end = whole.begin + turn * (i + 1) / count;
      sectors.pieces.push_back(piece);
    }
  }
  return sectors;
}

SectorRow row_at(const Sectors& sectors, const SectorPiece& piece, double x) {
  double s = x, speed = 1;
  if (piece.squash < 1) {
    const double turns = std::floor((x + pi) / (2 * pi)), half = 0.5 * (x - 2 * pi * turns);
    const double c = piece.squash * std::cos(half), sine = std::sin(half);
    s = piece.phase + 2 * (std::atan2(sine, c) + pi * turns);
    speed = piece.squash / (c * c + sine * sine);
  }
  const Arc& arc = *piece.arc;
  const double cs = std::cos(s), sn = std::sin(s);
  const Vec3d b = arc.centre + arc.u * cs + arc.v * sn, tangent = arc.v * cs - arc.u * sn;
  const double b2 = dot(b, b);
  return {b / std::sqrt(b2), dot(sectors.centre, cross(b, tangent)) / b2 * speed};
}

}  // namespace etendue::eval
