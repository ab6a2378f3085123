#include "tube_sampling.h"

#include "hit.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

Cone cone_around(const Vec3d& centre, double radius) {
  const double d = length(centre);
  return {centre / d, radius / d, std::sqrt((d - radius) * (d + radius)) / d};
}

// 1 - cos = sin^2 / (1 + cos), which keeps its digits for narrow cones.
double solid_angle_of(const Cone& cone) { return 2 * pi * cone.sine * cone.sine / (1 + cone.cosine); }

Vec3d sample(const Cone& cone, const Vec2d& u) {
  const double height = u.x * cone.sine * cone.sine / (1 + cone.cosine);  // 1 - cosine of the angle to the axis
  const double sine = std::sqrt(std::max(height * (2 - height), 0.0)), phi = 2 * pi * u.y;
  const Basis basis = basis_around(cone.axis);
  return normalised(basis.tangent * (sine * std::cos(phi)) + basis.bitangent * (sine * std::sin(phi)) + cone.axis * (1 - height));
}

// By the chord, whose square is 2 (1 - cos).
bool contains(const Cone& cone, const Vec3d& direction) {
  const Vec3d chord = direction - cone.axis;
  return dot(chord, chord) <= 2 * cone.sine * cone.sine / (1 + cone.cosine);
}

namespace {

std::optional<double> hit_quad(const std::array<Vec3d, 4>& corner, const Vec3d& direction) {
  const auto first = hit_triangle({corner[0], corner[1], corner[2]}, {}, direction);
  return first ? first : hit_triangle({corner[0], corner[2], corner[3]}, {}, direction);
}

}  // namespace

TubeSampler::TubeSampler(const TubeEmitter& tube, const Vec3d& position)
    : end_{tube.a - position, tube.b - position},
      axis_(normalised(tube.b - tube.a)),
      radius_(tube.radius),
      round_(tube.caps == Caps::round) {
  if (!(radius_ > 0) || inside_tube(end_[0], end_[1], radius_, tube.caps)) return;
  const TubeTangents tangents = tube_tangents(end_[0], end_[1], radius_);
  const bool only_a = !tangents.exist && dot(end_[0], axis_) > 0, only_b = !tangents.exist && !only_a;
  for (std::size_t i = 0; i < 2; ++i) {
    if ((i == 0 && only_b) || (i == 1 && only_a)) continue;
    const double d2 = dot(end_[i], end_[i]);
    if (round_) {
      weight_[i] = solid_angle_of(cone_around(end_[i], radius_));
    } else {
      weight_[i] = std::min(pi * radius_ * radius_ * std::abs(dot(end_[i], axis_)) / (d2 * std::sqrt(d2)), 2 * pi);
    }
  }
  if (tangents.exist) {
    const Vec3d t0 = tangents.normal[0] * radius_, t1 = tangents.normal[1] * radius_;
    corner_ = {end_[0] + t0, end_[1] + t0, end_[1] + t1, end_[0] + t1};
    using Triangle = std::array<Vec3d, 3>;
    side_.emplace(std::vector<Triangle>{{corner_[0], corner_[1], corner_[2]}, {corner_[0], corner_[2], corner_[3]}});
    weight_[2] = side_->solid_angle();
  }
  const double total = weight_[0] + weight_[1] + weight_[2];
  for (double& w : weight_) w = total > 0 ? w / total : 0;
}

double TubeSampler::end_pdf(std::size_t end, const Vec3d& direction) const {
  if (round_) {
    const Cone cone = cone_around(end_[end], radius_);
    return contains(cone, direction) ? 1 / solid_angle_of(cone) : 0;
  }
  const auto distance = hit_disk(end_[end], axis_, radius_, {}, direction);
  const double projected = pi * radius_ * radius_ * std::abs(dot(direction, axis_));
  return distance && projected > 0 ? *distance * *distance / projected : 0;
}

double TubeSampler::pdf(const Vec3d& direction) const {
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (weight_[i] > 0) sum += weight_[i] * end_pdf(i, direction);
  }
  if (weight_[2] > 0) {
    if (const auto distance = hit_quad(corner_, direction)) sum += weight_[2] * side_->pdf(direction, *distance);
  }
  return sum;
}

Vec3d TubeSampler::sample(Vec2d u) const {
  double before = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(weight_[i] > 0)) continue;
    if (u.x < before + weight_[i] || i == 2) {
      const Vec2d inner{std::clamp((u.x - before) / weight_[i], 0.0, 1.0), u.y};
      if (i == 2) return side_->sample(inner);
      if (round_) return eval::sample(cone_around(end_[i], radius_), inner);
      const Basis basis = basis_around(axis_);
      const double r = radius_ * std::sqrt(inner.x), phi = 2 * pi * inner.y;
      return normalised(end_[i] + basis.tangent * (r * std::cos(phi)) + basis.bitangent * (r * std::sin(phi)));
    }
    before += weight_[i];
  }
  return {};
}

}  // namespace etendue::eval
