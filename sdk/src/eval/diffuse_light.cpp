#include "etendue/diffuse_light.h"

#include "illuminance.h"
#include "kernels.h"
#include "modulation.h"
#include "sector_rule.h"

#include <algorithm>

namespace etendue::eval {
namespace {

double sum_of(const Rgb& c) { return c.x + c.y + c.z; }

// Both sums of the rule, and what each piece of the outline tells of its highest degrees.
class RatioSums {
 public:
  template <class Kernel>
  void add(const Contour& contour, const Kernel& kernel) {
    const Sectors sectors = sectors_of(contour);
    for (const SectorPiece& piece : sectors.pieces) add(sectors, piece, kernel);
  }

  Rgb reflected;      // sum of w f n.l
  double cosine = 0;  // sum of w n.l
  std::uint64_t evaluations = 0;

  // Part of the value that the rule may be off by. What is integrated is f n.l less the ratio times n.l.
  double relative_error() const {
    const double all = sum_of(reflected);
    if (!(all > 0)) return 0;
    const double ratio = all / cosine;
    double high = 0;
    for (const High& h : highs_)
      high += std::hypot(h.along.x - ratio * h.along_cosine.x, h.along.y - ratio * h.along_cosine.y) +
              std::abs(h.across - ratio * h.across_cosine) + ratio * h.unseen;
    return high / all;
  }

 private:
  // Sums of the highest degree along and across a piece, of f n.l and of n.l. One node tells of no degree: there f is taken to be
  // as steep as Schlick's weight is at the horizon, which counts as far as n.l varies.
  struct High {
    Vec2d along, along_cosine;  // of a whole turn cosine and sine
    double across = 0, across_cosine = 0, unseen = 0;
  };

  template <class Kernel>
  void add(const Sectors& sectors, const SectorPiece& piece, const Kernel& kernel) {
    High high;
    const auto across = nodes_across(piece.order);
    const double curvature = piece.order == 1 ? 5 * piece.chord * piece.chord / sectors.centre.z : 0;
    const auto add_row = [&](double x, double along, const Vec2d& along_high) {
      const SectorRow row = row_at(sectors, piece, x);
      const Vec3d outwards = row.b - sectors.centre;
      Rgb row_reflected;
      double row_cosine = 0;
      for (const SectorNode& node : across) {
        const Vec3d p = sectors.centre + outwards * node.x;
        const double size = length(p);
        const Vec3d l = p / size;
        if (!(l.z > 0)) continue;
        const double scale = row.weight * along / (size * size * size);
        const Rgb value = kernel(l) * scale;
        row_reflected += value * node.weight;
        row_cosine += scale * l.z * node.weight;
        high.across += sum_of(value) * node.high;
        high.across_cosine += scale * l.z * node.high;
      }
      evaluations += across.size();
      reflected += row_reflected;
      cosine += row_cosine;
      high.unseen += std::abs(row_cosine) * curvature;
      const double row_sum = sum_of(row_reflected);
      high.along = {high.along.x + along_high.x * row_sum, high.along.y + along_high.y * row_sum};
      high.along_cosine = {high.along_cosine.x + along_high.x * row_cosine, high.along_cosine.y + along_high.y * row_cosine};
    };
    if (piece.closed) {
      const std::size_t count = turn_nodes(piece.order);
      const double step = (piece.end - piece.begin) / static_cast<double>(count);
      // The highest harmonic whose sine the nodes see as well.
      const double harmonic = 0.5 * static_cast<double>(count) - 1;
      for (std::size_t i = 0; i < count; ++i) {
        const double turn = step * static_cast<double>(i);
        add_row(piece.begin + turn, step, {std::cos(harmonic * turn), std::sin(harmonic * turn)});
      }
    } else {
      const double half = 0.5 * (piece.end - piece.begin), middle = 0.5 * (piece.end + piece.begin);
      for (const SectorNode& node : nodes_along(piece.order))
        add_row(middle + half * node.x, half * node.weight, {node.high / node.weight, 0});
    }
    highs_.push_back(high);
  }

  std::vector<High> highs_;
};

template <class Kernel>
RatioSums ratio_sums(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons, const Vec3d& view, const Kernel& kernel) {
  RatioSums sums;
  each_outline(emitter, frame, [&](const Contour& outline, std::size_t) {
    each_smooth_part(clipped(outline, horizons), view, kernel.facts().folded, [&](const Contour& part) { sums.add(part, kernel); });
  });
  return sums;
}

bool has_outline(const Emitter& emitter) {
  if (std::holds_alternative<PunctualEmitter>(emitter.shape) || std::holds_alternative<LineEmitter>(emitter.shape)) return false;
  const auto* distant = std::get_if<DistantEmitter>(&emitter.shape);
  return distant == nullptr || distant->radius_rad > 0;
}

constexpr Tolerance otherwise{1e-4, 0};

}  // namespace

bool is_diffuse(const Brdf& brdf) {
  return with_kernel(brdf, {0, 0, 1}, [](const auto& kernel) { return kernel.facts().specular_share == 0 && kernel.facts().alpha == 0; });
}

std::optional<Estimate> diffuse_luminance(const Emitter& emitter, const ShadingPoint& point) {
  if (!is_diffuse(point.brdf)) return std::nullopt;
  if (std::holds_alternative<Lambert>(point.brdf) || is_modulated(emitter) || !has_closed_form(emitter) || !has_outline(emitter))
    return reference(emitter, point, otherwise);
  const LocalFrame frame(point.position, point.normal);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return Estimate{};
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  const Rgb lux = *closed_illuminance(emitter, point.position, frame, horizons);
  if (!(sum_of(lux) > 0)) return Estimate{};
  const RatioSums sums =
      with_kernel(point.brdf, view, [&](const auto& kernel) { return ratio_sums(emitter, frame, horizons, view, kernel); });
  // Seen edge-on to within rounding.
  if (!(sums.cosine > 0) || !std::isfinite(sum_of(sums.reflected))) return reference(emitter, point, otherwise);
  const Rgb value = sums.reflected * lux / sums.cosine;
  return Estimate{value, value * sums.relative_error(), sums.evaluations};
}

}  // namespace etendue::eval
