#include "fan.h"

namespace etendue::eval {

namespace {

double azimuth_speed(const Arc& arc, const Vec3d& c, double s) {
  const Vec3d b = arc.at(s), tangent = arc.v * std::cos(s) - arc.u * std::sin(s), across = cross(c, b);
  return std::abs(dot(c, cross(b, tangent))) / std::max(dot(across, across), 1e-300);
}

Arc part_of(const Arc& arc, double begin, double end) {
  Arc part = arc;
  part.begin = begin;
  part.end = end;
  return part;
}

// A rim seen at a slant is a thin ellipse and may come close to the centre on both sides. Cut where it is farthest, each part has one
// closest approach. (Great circles and circles of caps have one as they are.)
std::vector<Arc> with_one_approach(const Arc& arc, const Vec3d& c) {
  if (arc.unit) return {arc};
  constexpr int samples = 32;
  const double step = (arc.end - arc.begin) / samples;
  const std::vector<double> distance2 = squared_chords(arc, c, samples);
  std::vector<Arc> parts;
  double begin = arc.begin;
  for (std::size_t i = 1; i < samples; ++i) {
    if (!(distance2[i] > distance2[i - 1] && distance2[i] >= distance2[i + 1])) continue;
    const double at = arc.begin + step * static_cast<double>(i);
    parts.push_back(part_of(arc, begin, at));
    begin = at;
  }
  parts.push_back(part_of(arc, begin, arc.end));
  return parts;
}

// Sine of the azimuth about the centre, from the plane of the ridge.
double off_ridge(const Fan& fan, const Vec3d& b) {
  return std::abs(dot(cross(fan.centre, fan.in_plane), b)) / std::max(length(cross(fan.centre, b)), 1e-300);
}

// Where the plane of the ridge crosses the arc, and ends of the arc where the integrand is not flat in azimuth: on the ridge's flank, whose
// other flank is another arc's, and close to the direction opposite to the centre, about which the azimuth turns fast.
std::vector<double> ridge_places(const Fan& fan, const Arc& arc) {
  constexpr double flank = 30, fast = 3;  // widths; turns of the azimuth per turn of the arc
  if (!(fan.ridge < 1)) return {};
  const Crossings crossed = crossings(arc, cross(fan.centre, fan.in_plane));
  std::vector<double> places(crossed.s.begin(), crossed.s.begin() + static_cast<std::ptrdiff_t>(crossed.count));
  const auto steep = [&](double s) {
    const Vec3d b = arc.at(s);
    return off_ridge(fan, b) < flank * fan.ridge || (dot(fan.centre, b) < 0 && azimuth_speed(arc, fan.centre, s) > fast);
  };
  if (steep(arc.begin)) places.insert(places.begin(), arc.begin);
  if (steep(arc.end)) places.push_back(arc.end);
  return places;
}

void add_pieces(std::vector<FanArc>& pieces, const Fan& fan, const Arc& arc, double lobe) {
  const Nearest nearest = nearest_to(arc, fan.centre);
  const double scale = std::max(nearest.distance, lobe) / std::max(nearest.speed, 1e-300);
  const std::vector<double> ridges = ridge_places(fan, arc);
  // Each place on the ridge owns the part of the arc up to halfway (in w) to the closest approach or to the next place. One that is nearer
  // to the closest approach than that is wide stands for it too: on neither side is a ridge, however narrow, left to its coarser cells.
  const auto halfway = [&](double s, double t) {
    const double w = 0.5 * (std::asinh((s - nearest.s) / scale) + std::asinh((t - nearest.s) / scale));
    return nearest.s + scale * std::sinh(w);
  };
  double begin = arc.begin;
  for (std::size_t k = 0; k < ridges.size(); ++k) {
    const double at = ridges[k];
    const bool apart = std::abs(at - nearest.s) > scale;
    double lo = apart && at > nearest.s ? halfway(nearest.s, at) : arc.begin,
           hi = apart && at < nearest.s ? halfway(at, nearest.s) : arc.end;
    if (k > 0) lo = std::max(lo, halfway(ridges[k - 1], at));
    if (k + 1 < ridges.size()) hi = std::min(hi, halfway(at, ridges[k + 1]));
    const double turn = std::max(fan.ridge, off_ridge(fan, arc.at(at)));
    const double width = std::min(turn / std::max(azimuth_speed(arc, fan.centre, at), 1e-300), scale);
    if (lo > begin) pieces.emplace_back(fan, part_of(arc, begin, lo), nearest.s, scale);
    lo = std::max(lo, begin);
    if (at > lo) pieces.emplace_back(fan, part_of(arc, lo, at), at, width);
    if (hi > at) pieces.emplace_back(fan, part_of(arc, at, hi), at, width);
    begin = std::max(begin, hi);
  }
  if (arc.end > begin) pieces.emplace_back(fan, part_of(arc, begin, arc.end), nearest.s, scale);
}

}  // namespace

std::vector<FanArc> pieces_of(const Fan& fan) {
  std::vector<FanArc> pieces;
  const double lobe = 2 * std::sqrt(fan.lobe * fan.lobe_across);
  for (int i = 0; i < static_cast<int>(fan.contour.size()); ++i) {
    if (i == fan.adjacent[0] || i == fan.adjacent[1]) continue;
    for (const Arc& arc : with_one_approach(fan.contour[static_cast<std::size_t>(i)], fan.centre)) add_pieces(pieces, fan, arc, lobe);
  }
  return pieces;
}

namespace {

// Layers of masking: cells that grow away from a border of no height, the first four layers high.
constexpr double first_layer = 4, layer_growth = 8;

// Adds the borders between `from`, where the integrand is `lowest` above the horizon and rises with `slope`, and `to`.
void add_layers(std::vector<double>& marks, double from, double to, double lowest, double slope, double layer) {
  const double span = std::abs(to - from), sign = to > from ? 1 : -1;
  if (!(lowest < first_layer * layer) || !(slope * span > layer)) return;
  double height = first_layer * layer;
  while (height < 1) {
    const double away = (height - lowest) / slope;
    if (!(away < 0.8 * span)) break;
    marks.push_back(from + sign * away);
    height *= layer_growth;
  }
}

}  // namespace

std::vector<double> FanArc::borders_w(double longest_w, double longest_s) const {
  std::vector<double> marks{arc_.begin};
  if (fan_->layer > 0) {
    const Vec3d b0 = normalised(arc_.at(arc_.begin)), b1 = normalised(arc_.at(arc_.end));
    const double step = 1e-3 * (arc_.end - arc_.begin);
    const double slope0 = (normalised(arc_.at(arc_.begin + step)).z - b0.z) / step;
    const double slope1 = (normalised(arc_.at(arc_.end - step)).z - b1.z) / step;
    add_layers(marks, arc_.begin, arc_.end, b0.z, slope0, fan_->layer);
    add_layers(marks, arc_.end, arc_.begin, b1.z, slope1, fan_->layer);
    std::sort(marks.begin(), marks.end());
  }
  marks.push_back(arc_.end);
  std::vector<double> borders{w_of(marks[0])};
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    const double w0 = borders.back(), w1 = w_of(marks[i + 1]);
    const double parts = std::max((w1 - w0) / longest_w, (marks[i + 1] - marks[i]) / longest_s);
    const int n = std::max(1, static_cast<int>(std::ceil(parts)));
    for (int j = 1; j <= n; ++j) borders.push_back(w0 + (w1 - w0) * j / n);
  }
  return borders;
}

Vec3d FanArc::direction(const Row& row, double tau) const {
  const double q = row.a * std::sinh(row.u * tau);
  return (fan_->centre * (1 - q * q) + row.e * (2 * q)) / (1 + q * q);
}

std::vector<double> FanArc::borders_tau(double w, double longest_u) const {
  const Row at = row(w);
  std::vector<double> marks{0};
  if (fan_->layer > 0) {
    constexpr double step = 1e-3;
    const double low = direction(at, 0).z, high = direction(at, 1).z;
    add_layers(marks, 0, 1, low, (direction(at, step).z - low) / step, fan_->layer);
    add_layers(marks, 1, 0, high, (direction(at, 1 - step).z - high) / step, fan_->layer);
    std::sort(marks.begin(), marks.end());
  }
  marks.push_back(1);
  std::vector<double> borders{0};
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    const double t0 = marks[i], t1 = marks[i + 1];
    const int n = std::max(1, static_cast<int>(std::ceil((t1 - t0) * at.u / longest_u)));
    for (int j = 1; j <= n; ++j) borders.push_back(t0 + (t1 - t0) * j / n);
  }
  return borders;
}

FanArc::Row FanArc::row(double w) const {
  double sh, ch;
  sinh_cosh(w, sh, ch);
  const double s = pivot_ + scale_ * sh;
  const double cs = std::cos(s), sn = std::sin(s);
  const Vec3d b = arc_.centre + arc_.u * cs + arc_.v * sn, tangent = arc_.v * cs - arc_.u * sn;
  const Vec3d& c = fan_->centre;
  const double along = dot(c, b);
  const Vec3d across = b - c * along;
  const double across2 = dot(across, across);
  if (!(across2 > 0)) return {{}, 0, 1, 0};
  const double across_length = std::sqrt(across2);
  Row row;
  row.e = across / across_length;
  row.weight = dot(c, cross(b, tangent)) / across2 * scale_ * ch;
  const double b_length = arc_.unit ? 1 : std::sqrt(across2 + along * along);
  // tan(Theta / 2) = sin Theta / (1 + cos Theta), and its inverse beyond a right angle, where that loses digits.
  const double q = along >= 0 ? across_length / (b_length + along) : (b_length - along) / across_length;
  const double x = dot(row.e, fan_->in_plane), y2 = std::max(1 - x * x, 0.0);
  row.a = 1 / std::sqrt(x * x / (fan_->lobe * fan_->lobe) + y2 / (fan_->lobe_across * fan_->lobe_across));
  row.u = std::asinh(q / row.a);
  return row;
}

FanRule fan_rule_for(double relative) {
  if (relative >= 2e-4) return {&kronrod5(), 3, 1.7, 3.2, 8};
  if (relative >= 1e-7) return {&kronrod7(), 3, 1.7, 3.2, 32};
  return {&kronrod15(), 4, 3.2, 5, 400};
}

}  // namespace etendue::eval
