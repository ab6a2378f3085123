// Specular light of a rectangle at many points: transformed cosines from the table, and moments.
#include "light_batch.h"
#include "specular_batch.h"
#include "views.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_rect_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/ltc-inl.h"
#include "eval/specular_batch-inl.h"
#include "eval/specular_moments-inl.h"

#ifndef ETENDUE_SPECULAR_RECT_BATCH_SHARED
#define ETENDUE_SPECULAR_RECT_BATCH_SHARED
namespace etendue::eval {
struct SpecularRect {
  std::array<Place, 4> corners;  // counter-clockwise about the directions between them, as seen from the front
  Direction normal;
  float area;
  const Emitter& white;
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// of(frame, alpha, outline): the shares of the light's outline above the horizon, in the view's frame; unit vectors if Of::in_units.
template <class Of>
class RectLobe {
 public:
  RectLobe(const SpecularRect& light, Of of) : light_(light), of_(of) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const Floats d;
    const Lanes zero = number(0);
    const ViewFrame frame = view_frame(normal, view);
    std::array<Vector3, 4> corners{};
    each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { corners[i] = towards(d, light_.corners[i], position); });
    const Lanes height = dot(corners[0], numbers(d, light_.normal));  // below 0 in front
    const Lit front = hn::Lt(height, zero), back = hn::Gt(height, zero);
    if (light_.white.two_sided) {
      // The back is gone around the other way.
      const Vector3 second = corners[1];
      corners[1] = chosen(back, corners[3], second), corners[3] = chosen(back, second, corners[3]);
    }
    const Lanes over_distance = near_inverse_sqrt(d, dot(corners[0], corners[0]));
    each<4>([&](auto i)
                ETENDUE_INLINE_LAMBDA { corners[i] = Of::in_units ? unit(frame(corners[i])) : frame(scaled(corners[i], over_distance)); });
    const Outline<4> whole = outline_of(corners);
    const Shares shares = hn::AllTrue(d, all_above(whole)) ? of_(frame, alpha, whole) : of_(frame, alpha, clipped(whole));
    const Lit lit = hn::And(hn::Gt(frame.cosine, zero), light_.white.two_sided ? hn::Or(front, back) : front);
    // Of what is small all over or in one direction: the solid angle, all but for a factor.
    const Lanes flat = hn::Mul(hn::Abs(height), over_distance), size2 = hn::Mul(number(light_.area), hn::Mul(over_distance, over_distance));
    doubtful = hn::And(lit, hn::Not(hn::Ge(hn::Mul(flat, size2), number(least_angle * least_angle))));
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  const SpecularRect& light_;
  Of of_;
};

std::size_t OverSpecularRect(SpecularRule rule, const SpecularRect& light, const LtcNodes& nodes, const SpecularPoints& points,
                             std::span<float> of_f0, std::span<float> of_f90, float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(rule, light.white, points, index); };
  const auto with = [&](auto of) { return over_views(points, of_f0, of_f90, where_none, RectLobe(light, of), exact); };
  if (rule == SpecularRule::ltc) return with(ThroughTable<false>{nodes});
  if (rule == SpecularRule::ltc_one_cosine) return with(ByOneCosine{nodes});
  if (rule == SpecularRule::ltc_two_lobes) return with(ThroughTable<true>{nodes});
  if (rule == SpecularRule::ltc_two_cosines) return with(ByTwoCosines{nodes});
  return with(ByMoments{});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverSpecularRect);

class RectLight final : public SpecularBatch::Light {
 public:
  RectLight(const Emitter& white, const RectView& view) : white_(white), view_(view) {}
  std::size_t over(SpecularRule rule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    const auto corner = [&](double x, double y) { return Place(view_.at(x * view_.half_x, y * view_.half_y) - points.surface.origin); };
    const SpecularRect rect{{corner(-1, -1), corner(-1, 1), corner(1, 1), corner(1, -1)},
                            Direction(view_.normal),
                            static_cast<float>(4 * view_.half_x * view_.half_y),
                            white_};
    return HWY_DYNAMIC_DISPATCH(OverSpecularRect)(rule, rect, ltc_nodes(), points, of_f0, of_f90, where_none);
  }

 private:
  Emitter white_;
  RectView view_;
};

}  // namespace

std::shared_ptr<const SpecularBatch::Light> specular_rect(SpecularRule rule, const Emitter& white) {
  const auto* polygon = std::get_if<PolygonEmitter>(&white.shape);
  if (polygon == nullptr || rule == SpecularRule::ltc_two_caps) return nullptr;
  const std::optional<RectView> view = rect_view(*polygon, false, {});
  return view ? std::make_shared<RectLight>(white, *view) : nullptr;
}

}  // namespace etendue::eval
#endif
