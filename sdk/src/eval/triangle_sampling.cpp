#include "triangle_sampling.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// Below this solid angle the spherical excess has too few digits.
constexpr double smallest_solid_angle = 1e-3;

Vec3d across(const Vec3d& v, const Vec3d& unit) { return normalised(v - unit * dot(v, unit)); }

// Arvo 1995, Stratified Sampling of Spherical Triangles: the sub-triangle (a, b, c') of area u.x times the whole fixes c' on the edge
// a c; then a point between b and c' with uniform cosine.
Vec3d sample_spherical(const std::array<Vec3d, 3>& t, double area, const Vec2d& u) {
  const Vec3d a = normalised(t[0]), b = normalised(t[1]), c = normalised(t[2]);
  const Vec3d ab = across(b, a), ac = across(c, a);
  const double alpha = std::atan2(length(cross(ab, ac)), dot(ab, ac));
  const double phi = u.x * area - alpha;
  const double s = std::sin(phi), cs = std::cos(phi), cos_alpha = std::cos(alpha), sin_alpha = std::sin(alpha);
  const double p = cs - cos_alpha, v = s + sin_alpha * dot(a, b);
  const double denominator = (v * s + p * cs) * sin_alpha;
  const double q = denominator != 0 ? std::clamp(((v * cs - p * s) * cos_alpha - v) / denominator, -1.0, 1.0) : 1;
  const Vec3d cut = a * q + ac * std::sqrt(1 - q * q);
  const double z = 1 - u.y * (1 - dot(cut, b));
  return normalised(b * z + across(cut, b) * std::sqrt(std::max(1 - z * z, 0.0)));
}

}  // namespace

double solid_angle_of(const std::array<Vec3d, 3>& t) {
  const double a = length(t[0]), b = length(t[1]), c = length(t[2]);
  const double triple = std::abs(dot(t[0], cross(t[1] - t[0], t[2] - t[0])));
  return 2 * std::atan2(triple, a * b * c + dot(t[0], t[1]) * c + dot(t[1], t[2]) * a + dot(t[2], t[0]) * b);
}

TriangleSampler::TriangleSampler(std::vector<std::array<Vec3d, 3>> triangles) : triangles_(std::move(triangles)) {
  running_.reserve(triangles_.size());
  Vec3d vector_area;
  for (const auto& t : triangles_) {
    const Vec3d n = cross(t[1] - t[0], t[2] - t[0]) * 0.5;
    vector_area += n;
    area_ += length(n);
    solid_angle_ += solid_angle_of(t);
    running_.push_back(solid_angle_);
  }
  normal_ = normalised(vector_area);
  by_area_ = solid_angle_ < smallest_solid_angle;
  if (!by_area_) return;
  double area = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& t = triangles_[i];
    running_[i] = area += 0.5 * length(cross(t[1] - t[0], t[2] - t[0]));
  }
}

Vec3d TriangleSampler::sample(Vec2d u) const {
  if (!(area_ > 0) || !(solid_angle_ > 0)) return {};
  const double at = u.x * running_.back();
  const auto found = std::upper_bound(running_.begin(), running_.end() - 1, at);
  const auto i = static_cast<std::size_t>(found - running_.begin());
  const double before = i > 0 ? running_[i - 1] : 0, own = running_[i] - before;
  if (!(own > 0)) return {};
  const Vec2d inner{std::clamp((at - before) / own, 0.0, 1.0), u.y};
  const auto& t = triangles_[i];
  if (!by_area_) return sample_spherical(t, own, inner);
  const double root = std::sqrt(inner.x);
  return normalised(t[0] * (1 - root) + t[1] * (root * (1 - inner.y)) + t[2] * (root * inner.y));
}

double TriangleSampler::pdf(const Vec3d& direction, double distance) const {
  if (!(solid_angle_ > 0)) return 0;
  if (!by_area_) return 1 / solid_angle_;
  const double projected = area_ * std::abs(dot(direction, normal_));
  return projected > 0 ? distance * distance / projected : 0;
}

}  // namespace etendue::eval
