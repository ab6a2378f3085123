// The light of a picture T on a rectangle is the integral of f T over it, f being what a unit of area gives. A patch's closed form is E =
// the integral of f, and E times the mean of T misses the integral of (f - mean f) (T - mean T). With f taken as constant over the patch's
// quarters, E_c of them, and sigma the deviation of T, that is by Cauchy and Schwarz no more than
//     2 sigma sqrt(sum (E_c - E / 4)^2):
// nothing where the lobe is even or the picture is. The patch in which that is largest is split, until the root of the sum of squares,
// signs being as good as random, is below the tolerance. Quarters that are equal by symmetry say nothing of what is inside: a patch is
// taken to be as uneven as the lobe is wide for it at least. The shares by moments are off by a few per cent, much alike in all patches:
// they only share out what the whole rectangle gives, which is known better.
#include "etendue/light_card.h"

#include "etendue/specular_light.h"

#include "illuminance.h"
#include "rectangle_frame.h"
#include "specular_moments.h"
#include "specular_view.h"

#include <cmath>
#include <queue>

namespace etendue::eval {
namespace {

struct Patch {
  int level;
  std::uint32_t x, y;
  Rgb share;     // light for a luminance of 1
  double doubt;  // what its mean is expected to miss

  friend bool operator<(const Patch& a, const Patch& b) { return a.doubt < b.doubt; }
};

// The rectangle's patches, and what each gives for a luminance of 1.
class Patches {
 public:
  Patches(const Emitter& emitter, const PolygonEmitter& rectangle, const ShadingPoint& point)
      : point_(point),
        rectangle_(rectangle),
        ggx_(correlated_ggx(point.brdf)),
        frame_(rectangle.uv_frame),
        patch_{rectangle, {1, 1, 1}, emitter.two_sided, {}, {}} {
    mirrored_ = dot(cross(frame_[1], frame_[2]), rectangle.normal) < 0;
  }
  Rgb share(int level, std::uint32_t x, std::uint32_t y) {
    ++count_;
    const double side = std::ldexp(1.0, -level);
    const auto corner = [&](std::uint32_t i, std::uint32_t j) {
      return frame_[0] + frame_[1] * (side * (x + i)) + frame_[2] * (side * (y + j));
    };
    auto& vertices = std::get<PolygonEmitter>(patch_.shape).vertices;
    vertices[0] = corner(0, 0);
    vertices[mirrored_ ? 3 : 1] = corner(1, 0);
    vertices[2] = corner(1, 1);
    vertices[mirrored_ ? 1 : 3] = corner(0, 1);
    if (ggx_) return by_moments(patch_, point_, *ggx_);
    const LocalFrame local(point_.position, point_.normal);
    const auto lux = closed_illuminance(patch_, point_.position, local, horizons_of(local, point_.normal, point_.surface_normal));
    return std::get<Lambert>(point_.brdf).base_colour * lux.value_or(Rgb{}) / pi;
  }
  // Of the whole rectangle, where that is not what `share` says of it already.
  std::optional<Estimate> whole(double tolerance) {
    if (!ggx_) return std::nullopt;
    std::get<PolygonEmitter>(patch_.shape) = rectangle_;
    return specular_luminance(patch_, point_, tolerance);
  }
  // As uneven as a lobe is over a patch beside its peak. (1 + t^2)^-2, the cosine's light straight below a light, deviates by .6 s^2 from
  // its mean over 0 < t < s, .85 s^2 over both axes, s being the side over the distance; a lobe of GGX is as much narrower as 2 alpha is
  // less than
  // 1. No more than 1: the light is in one quarter hardly less often than in none.
  double peaked(int level, std::uint32_t x, std::uint32_t y) const {
    const double side = std::ldexp(1.0, -level);
    const Vec3d middle = frame_[0] + frame_[1] * (side * (x + 0.5)) + frame_[2] * (side * (y + 0.5)) - point_.position;
    const double longer2 = side * side * std::max(dot(frame_[1], frame_[1]), dot(frame_[2], frame_[2]));
    const double narrow = ggx_ ? std::min(2 * ggx_->alpha, 1.0) : 1;
    return std::min(0.85 * longer2 / (narrow * narrow * std::max(dot(middle, middle), 0.25 * longer2)), 1.0);
  }
  int count() const { return count_; }

 private:
  const ShadingPoint& point_;
  const PolygonEmitter& rectangle_;
  std::optional<GgxLobe> ggx_;
  std::array<Vec3d, 3> frame_;
  Emitter patch_;
  bool mirrored_;
  int count_ = 0;
};

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

std::optional<PatchEstimate> by_patches(const Emitter& emitter, const LightCard& card, const ShadingPoint& point,
                                        const PatchOptions& options) {
  const auto* rectangle = std::get_if<PolygonEmitter>(&emitter.shape);
  if (rectangle == nullptr || !fills_its_frame(*rectangle) || is_window(emitter.window)) return std::nullopt;
  if (!std::holds_alternative<Lambert>(point.brdf) && !correlated_ggx(point.brdf)) return std::nullopt;
  Patches patches(emitter, *rectangle, point);
  std::priority_queue<Patch> open;
  const auto lit = [&](const Patch& p) { return p.share * vec_cast<double>(card.cell(p.level, p.x, p.y).mean); };
  const Rgb whole = patches.share(0, 0, 0);
  Patch first{0, 0, 0, whole, largest(whole) * static_cast<double>(card.cell(0, 0, 0).deviation)};
  Rgb value = lit(first), shares = whole;
  double squares = first.doubt * first.doubt, beyond = 0;  // of what can be split, and of what the card has no means of
  open.push(first);
  while (!open.empty() && open.top().doubt > 0 && std::sqrt(squares) > options.tolerance * largest(value) &&
         patches.count() + 4 <= options.most_patches) {
    const Patch parent = open.top();
    open.pop();
    value = value - lit(parent);
    shares = shares - parent.share;
    squares -= parent.doubt * parent.doubt;
    std::array<Patch, 4> quarters;
    Rgb sum;
    for (std::uint32_t i = 0; i < 4; ++i) {
      Patch& p = quarters[i];
      p = {parent.level + 1, 2 * parent.x + i % 2, 2 * parent.y + i / 2, {}, 0};
      p.share = patches.share(p.level, p.x, p.y);
      sum += p.share;
    }
    // How uneven the lobe is over the parent, 0 to sqrt(3); over a quarter a smooth one is half as uneven.
    double uneven = 0;
    for (const Patch& p : quarters) uneven += std::pow(largest(p.share) - 0.25 * largest(sum), 2);
    uneven = largest(sum) > 0 ? 2 * std::sqrt(uneven) / largest(sum) : 0;
    for (Patch& p : quarters) {
      value += lit(p);
      shares += p.share;
      p.doubt = std::max(0.5 * uneven, patches.peaked(p.level, p.x, p.y)) * largest(p.share) *
                static_cast<double>(card.cell(p.level, p.x, p.y).deviation);
      if (p.level < card.finest()) {
        squares += p.doubt * p.doubt;
        open.push(p);
      } else {
        beyond += p.doubt * p.doubt;
      }
    }
  }
  Rgb error = Rgb{1, 1, 1} * std::sqrt(std::max(squares, 0.0) + beyond);
  if (const auto known = patches.whole(std::max(0.1 * options.tolerance, 1e-9))) {
    for (int c = 0; c < 3; ++c) {
      // Where the moments see nothing of a lobe, nothing shares it out.
      if (!(shares[c] > 0)) shares[c] = 1, value[c] = static_cast<double>(card.cell(0, 0, 0).mean[c]), error[c] = value[c];
      const double mean = value[c] / shares[c];
      value[c] = mean * known->value[c], error[c] = error[c] * known->value[c] / shares[c] + mean * known->error[c];
    }
  }
  error += value * 1e-12;
  return PatchEstimate{value * emitter.radiance, error * emitter.radiance, patches.count()};
}

}  // namespace etendue::eval
