#include "fan.h"

namespace etendue::eval {

FanArc::FanArc(const Fan& fan, const Arc& arc) : fan_(&fan), arc_(arc) {
  const Nearest nearest = nearest_to(arc, fan.centre);
  nearest_ = nearest.s;
  const double lobe = 2 * std::sqrt(fan.lobe * fan.lobe_across);
  scale_ = std::max(nearest.distance, lobe) / std::max(nearest.speed, 1e-300);
}

std::vector<double> FanArc::borders(double longest_w, double longest_s) const {
  std::vector<double> marks{arc_.begin};
  if (fan_->has_plane) {
    const Crossings zeros = crossings(arc_, cross(fan_->centre, fan_->in_plane));
    for (std::size_t i = 0; i < zeros.count; ++i) marks.push_back(zeros.s[i]);
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

FanArc::Row FanArc::row(double w) const {
  double sh, ch;
  sinh_cosh(w, sh, ch);
  const double s = nearest_ + scale_ * sh;
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
  if (relative >= 2e-4) return {&kronrod5(), 3, 1.7, 3.2, 4};
  if (relative >= 1e-7) return {&kronrod7(), 3, 1.7, 3.2, 8};
  return {&kronrod15(), 4, 3.2, 5, 60};
}

}  // namespace etendue::eval
