// The light of a picture T on a rectangle is the integral of f T over it, f being what a unit of area gives. Over a cell f is close to the
// polynomial p of second degree in u and in v that it agrees with at nine nodes, and the integral of p T is f's values there times weights
// that hang on T alone (PictureMoments). What is missed is, by Cauchy and Schwarz, at most
//     rms(f - p) sigma + |mean of f - p| mean T,
// times the area, sigma being T's deviation. f - p is measured at the corners, where it is largest: where it goes with the third
// derivatives, x (x^2 - 3/5), the root mean square is .38 times the value at the end (of x and y together less), and the mean is what Gauss
// and Legendre's rule misses, sixth derivatives. Where a horizon cuts the cell (or anywhere under a lobe that is folded) f has a kink, and
// the corners show less: over straight kinks in all places and directions f - p has up to 1.22 times the largest corner as its root mean
// square, and .24 times it as its mean. The cell that is furthest off is split into its quarters until the sum of all is below the
// tolerance.
#include "etendue/picture_light.h"

#include "kernels.h"
#include "quadratic_nodes.h"
#include "rectangle_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace etendue::eval {
namespace {

// Of what the corners show: root mean square and mean.
struct Shares {
  double rms, mean;
};
constexpr Shares smooth{0.4, 0.05}, kinked{1.25, 0.25};
constexpr int most_cells = 4096;

struct Patch {
  int level;
  std::uint32_t x, y;
  Rgb value, error;
  double doubt;  // infinite where f may have a peak that no node has met

  friend bool operator<(const Patch& a, const Patch& b) { return a.doubt < b.doubt; }
};

class PicturedLight {
 public:
  PicturedLight(const Emitter& emitter, const PolygonEmitter& rectangle, const PictureMoments& picture, const ShadingPoint& point,
                double alpha)
      : picture_(picture),
        point_(point),
        frame_(shading_basis(point)),
        view_(local(point.view)),
        lambert_(std::get_if<Lambert>(&point.brdf)),
        folded_(std::holds_alternative<OrenNayar>(point.brdf) || std::holds_alternative<GotandaDiffuse>(point.brdf)),
        corner_(rectangle.uv_frame[0] - point.position),
        u_(rectangle.uv_frame[1]),
        v_(rectangle.uv_frame[2]),
        normal_(rectangle.normal),
        area_(length(cross(u_, v_))),
        mirror_(point.normal * (2 * dot(point.normal, point.view)) - point.view) {
    if (emitter.two_sided && dot(corner_, normal_) > 0) normal_ = -normal_;
    // Half vectors move by half of what the light does, and across the view's plane by 1 / (2 n.v) of it.
    lobe_ = alpha < 1 ? 2 * alpha * std::max(dot(point.normal, point.view), 1e-3) : 0;
    const Rgb mean = picture.mean();
    for (int c = 0; c < 3; ++c) scale_[c] = mean[c] > 0 ? 1 / mean[c] : 0;
  }

  Patch patch(int level, std::uint32_t x, std::uint32_t y) {
    ++count_;
    const double side = std::ldexp(1.0, -level), area = area_ * side * side;
    const PictureMoments::Cell& cell = picture_.cell(level, x, y);
    const auto at = [&](double a, double b) { return f(side * (x + 0.5 * (1 + a)), side * (y + 0.5 * (1 + b))); };
    std::array<Rgb, 9> values;
    Rgb sum, mean;
    int dark = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      for (std::size_t a = 0; a < 3; ++a) {
        const Rgb weight = vec_cast<double>(cell.weights[3 * b + a]);
        values[3 * b + a] = at(quadratic_nodes[a], quadratic_nodes[b]);
        sum += values[3 * b + a] * weight, mean += weight;
        dark += values[3 * b + a] == Rgb{} ? 1 : 0;
      }
    }
    Rgb off;
    for (const double b : {-1.0, 1.0}) {
      for (const double a : {-1.0, 1.0}) {
        const auto pa = quadratics(a), pb = quadratics(b);
        Rgb missed = at(a, b);
        dark += missed == Rgb{} ? 1 : 0;
        for (std::size_t k = 0; k < 9; ++k) missed = missed - values[k] * (pa[k % 3] * pb[k / 3]);
        for (int c = 0; c < 3; ++c) off[c] = std::max(off[c], std::abs(missed[c]));
      }
    }
    const Shares& share = folded_ || (dark > 0 && dark < 13) ? kinked : smooth;
    const Rgb error = off * (vec_cast<double>(cell.deviation) * share.rms + mean * share.mean) * area, relative = error * scale_;
    const double doubt = may_hide(side, x, y) ? std::numeric_limits<double>::infinity() : std::max({relative.x, relative.y, relative.z});
    return {level, x, y, sum * area, error, doubt};
  }
  int count() const { return count_; }

 private:
  Vec3d local(const Vec3d& v) const { return {dot(frame_.tangent, v), dot(frame_.bitangent, v), dot(frame_.normal, v)}; }
  // BRDF times both cosines over the distance squared.
  Rgb f(double u, double v) const {
    const Vec3d d = corner_ + u_ * u + v_ * v;
    const double squared = dot(d, d), facing = -dot(normal_, d), above = dot(point_.normal, d);
    if (!(facing > 0 && above > 0 && dot(point_.surface_normal, d) > 0)) return {};
    if (lambert_ != nullptr) return lambert_->base_colour * (above * facing / (pi * squared * squared));
    const double distance = std::sqrt(squared);
    return brdf_cos(point_.brdf, view_, local(d / distance)) * (facing / (squared * distance));
  }
  // Whether a cell is wider than what f has of structure: its distance, and where the lobe is the lobe.
  bool may_hide(double side, std::uint32_t x, std::uint32_t y) const {
    constexpr double widest = 1.5;
    const double uu = dot(u_, u_), vv = dot(v_, v_), longer = side * std::sqrt(std::max(uu, vv));
    const auto nearest = [&](const Vec3d& axis, double squared, std::uint32_t k) {
      return std::clamp(-dot(corner_, axis) / squared, side * k, side * (k + 1));
    };
    const Vec3d close = corner_ + u_ * nearest(u_, uu, x) + v_ * nearest(v_, vv, y);
    const double distance = length(close);
    if (longer > widest * distance) return true;
    if (lobe_ == 0) return false;
    const Vec3d middle = corner_ + u_ * (side * (x + 0.5)) + v_ * (side * (y + 0.5));
    const double angle = std::atan2(length(cross(mirror_, middle)), dot(mirror_, middle)), width = longer / distance;
    return width > widest * (lobe_ + std::max(angle - 0.75 * width, 0.0));
  }

  const PictureMoments& picture_;
  const ShadingPoint& point_;
  Basis frame_;
  Vec3d view_;
  const Lambert* lambert_;
  bool folded_;  // bends within the hemisphere
  Vec3d corner_, u_, v_, normal_;
  double area_, lobe_ = 0;
  Vec3d mirror_;
  Rgb scale_;
  int count_ = 0;
};

struct Alpha {
  double operator()(const GgxLobe& m) const { return m.alpha; }
  double operator()(const SpecularLobe& m) const { return std::min(m.alpha_x, m.alpha_y); }
  double operator()(const Conductor& m) const { return m.alpha; }
  double operator()(const Principled& m) const { return m.roughness * m.roughness; }
  double operator()(const Standard& m) const { return m.roughness * m.roughness; }
  double operator()(const MetalRough& m) const { return m.roughness * m.roughness; }
  double operator()(const TwoColour& m) const { return m.roughness * m.roughness; }
  template <class Diffuse>
  double operator()(const Diffuse&) const {
    return 1;
  }
};

bool within(const Rgb& error, const Rgb& value, const Tolerance& tolerance) {
  for (int c = 0; c < 3; ++c)
    if (!(error[c] <= std::max(tolerance.relative * value[c], tolerance.absolute))) return false;
  return true;
}

}  // namespace

bool carries_picture(const Emitter& emitter) {
  const auto* rectangle = std::get_if<PolygonEmitter>(&emitter.shape);
  return rectangle != nullptr && fills_its_frame(*rectangle) && !is_window(emitter.window);
}

double narrowest_alpha(const Brdf& brdf) { return std::clamp(std::visit(Alpha{}, brdf), min_alpha, 1.0); }

std::optional<Estimate> picture_luminance(const Emitter& emitter, const PictureMoments& picture, const ShadingPoint& point,
                                          const Tolerance& tolerance) {
  if (!carries_picture(emitter)) return std::nullopt;
  const auto& rectangle = std::get<PolygonEmitter>(emitter.shape);
  const double behind = dot(point.position - rectangle.uv_frame[0], rectangle.normal);
  if (!(dot(point.normal, point.view) > 0) || !(emitter.two_sided ? behind != 0 : behind > 0)) return Estimate{};
  // Weights are floats, and sums of differences are rounded.
  constexpr double rounding = 1e-6;
  const Tolerance left{tolerance.relative - rounding, tolerance.absolute};
  PicturedLight light(emitter, rectangle, picture, point, narrowest_alpha(point.brdf));
  const Rgb& radiance = emitter.radiance;
  std::priority_queue<Patch> open;
  open.push(light.patch(0, 0, 0));
  Rgb value = open.top().value, error = open.top().error;
  while (open.top().doubt == std::numeric_limits<double>::infinity() || !within(error * radiance, value * radiance, left)) {
    const Patch parent = open.top();
    // What is furthest off of the finest cells stays so; others may make up for it.
    if (parent.level == PictureMoments::finest && std::isfinite(parent.doubt)) {
      open.pop();
      if (open.empty()) return std::nullopt;
      continue;
    }
    if (parent.level == PictureMoments::finest || light.count() + 4 > most_cells) return std::nullopt;
    open.pop();
    value = value - parent.value, error = error - parent.error;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Patch quarter = light.patch(parent.level + 1, 2 * parent.x + i % 2, 2 * parent.y + i / 2);
      value += quarter.value, error += quarter.error;
      open.push(quarter);
    }
  }
  for (int c = 0; c < 3; ++c) value[c] = std::max(value[c], 0.0), error[c] = std::max(error[c], 0.0) + rounding * value[c];
  return Estimate{value * radiance, error * radiance, static_cast<std::uint64_t>(light.count()) * 13};
}

}  // namespace etendue::eval
