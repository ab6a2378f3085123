// Specular light of tubes with round caps at many points, by moments.
#include "light_batch.h"
#include "specular_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_tube_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#ifndef ETENDUE_SPECULAR_TUBE_BATCH_SHARED
#define ETENDUE_SPECULAR_TUBE_BATCH_SHARED
namespace etendue::eval {
struct PlacedTubeAxis {
  Place a;                 // centre of the first cap
  Direction axis, across;  // unit: to the second one, and any direction across
  float length, radius;
};
}  // namespace etendue::eval
#endif

#include "eval/specular_moments-inl.h"
#include "eval/tube_outline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// What of the chain of arcs and sides is above the horizon, and the horizon between where it sets and where it rises.
class AboveHorizon {
 public:
  AboveHorizon(const TubeOutline& tube) : a(cut_by_horizon(tube.a)), b(cut_by_horizon(tube.b)) {
    const Lit never = hn::FirstN(Floats(), 0);
    sets_ = rises_ = never;
    setting_ = rising_ = a.begin;
    pass(a.sets, a.setting, a.rises, a.rising);
    pass(b.sets, b.setting, b.rises, b.rising);
    sides = {cut(a.end, b.begin, tube.sides), cut(b.end, a.begin, tube.sides)};
  }
  struct Side {
    Vector3 from, to;
    Lit seen;
  };
  CutArc a, b;
  std::array<Side, 2> sides;
  Side horizon() const { return {setting_, rising_, hn::And(sets_, rises_)}; }
  // A direction of the outline.
  const Vector3& begin() const { return rising_; }

 private:
  HWY_INLINE void pass(Lit sets, const Vector3& setting, Lit rises, const Vector3& rising) {
    setting_ = chosen(sets, setting, setting_), rising_ = chosen(rises, rising, rising_);
    sets_ = hn::Or(sets_, sets), rises_ = hn::Or(rises_, rises);
  }
  HWY_INLINE Side cut(const Vector3& from, const Vector3& to, Lit exists) {
    const Floats d;
    const Lanes zero = number(0);
    const Lit begins = hn::And(exists, hn::Ge(from.z, zero)), ends = hn::And(exists, hn::Ge(to.z, zero));
    const Lit goes = hn::AndNot(ends, begins), comes = hn::AndNot(begins, ends);
    // from (-to.z) + to from.z, or the other way round.
    const Lanes x = hn::MulSub(to.x, from.z, hn::Mul(from.x, to.z)), y = hn::MulSub(to.y, from.z, hn::Mul(from.y, to.z));
    const Lanes length = inverse_sqrt(d, hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), number(1e-30f)));
    const Lanes over = hn::IfThenElse(comes, hn::Neg(length), length);
    const Vector3 place{hn::Mul(x, over), hn::Mul(y, over), zero};
    pass(goes, place, comes, place);
    return {chosen(comes, place, from), chosen(goes, place, to), hn::Or(begins, ends)};
  }

  Lit sets_, rises_;
  Vector3 setting_, rising_;
};

class TubeLobe {
 public:
  explicit TubeLobe(const PlacedTubeAxis& light) : light_(light) {}
  HWY_INLINE Shares operator()(const Vector3& position, const Vector3& normal, const Vector3& view, Lanes alpha, Lit& doubtful) const {
    const Floats d;
    const ViewFrame frame = view_frame(normal, view);
    const TubeOutline tube = tube_outline(light_, position, frame);
    const Lit lit = hn::And(hn::And(hn::Gt(frame.cosine, number(0)), tube.above), hn::Not(tube.inside));
    doubtful = hn::And(hn::Or(lit, tube.inside), tube.doubtful);
    if (hn::AllFalse(d, lit)) return {number(0), number(0)};
    const AboveHorizon above(tube);
    const Lanes over_alpha = inverse(d, alpha);
    const Vector3 eye = frame.view();
    const Shares shares = by_moments(frame, alpha, above.begin(), [&](MomentSums& sums) ETENDUE_INLINE_LAMBDA {
      std::array<Quadratic, 10> sides{};
      std::array<Lit, 10> seen{};
      const auto quarter = [&](const ArcPart& part) ETENDUE_INLINE_LAMBDA { return half_of(part.half); };
      // 4 parts of the longer arc, up to a whole turn, 2 of what is half a turn at most.
      const Turn quarter_a = quarter(above.a.first);
      arc<4>(tube.a, above.a.first, half_of(quarter_a), quarter_a, eye, over_alpha, sides.data(), seen.data());
      const auto in_two = [&](const CapArc& of, const ArcPart& part, std::size_t at) ETENDUE_INLINE_LAMBDA {
        arc<2>(of, part, quarter(part), part.half, eye, over_alpha, sides.data() + at, seen.data() + at);
      };
      in_two(tube.b, above.b.first, 4);
      for (std::size_t i = 0; i < 2; ++i) {
        sides[6 + i] = bent_side(above.sides[i].from, above.sides[i].to, eye, over_alpha);
        seen[6 + i] = above.sides[i].seen;
      }
      for (std::size_t i = 0; i < 8; ++i) add_side(sides[i], seen[i], sums);
      const auto horizon = above.horizon();
      const Lit cuts = hn::And(lit, horizon.seen);
      if (hn::AllFalse(d, cuts)) return;
      in_two(tube.a, above.a.other, 0);
      in_two(tube.b, above.b.other, 2);
      sides[4] = bent_side(horizon.from, horizon.to, eye, over_alpha), seen[4] = cuts;
      const bool gaps = !hn::AllFalse(d, hn::And(lit, hn::Or(seen[0], seen[2])));
      for (std::size_t i = gaps ? 0 : 4; i < 5; ++i) add_side(sides[i], seen[i], sums);
    });
    return {hn::IfThenElseZero(lit, shares.of_f0), hn::IfThenElseZero(lit, shares.of_f90)};
  }

 private:
  // N parts of one length: the angle from the begin to the first one's middle, and from middle to middle.
  template <std::size_t N>
  HWY_INLINE static void arc(const CapArc& of, const ArcPart& part, const Turn& middle, const Turn& step, const Vector3& eye,
                             Lanes over_alpha, Quadratic* sides, Lit* seen) {
    const Turn quarter = half_of(middle);
    const Lanes tan_quarter = hn::Div(quarter.s, quarter.c);
    Turn at = sum_of(part.from, middle);
    for (std::size_t i = 0; i < N; ++i) {
      const Vector3 outwards = along(scaled(of.u, at.c), of.v, at.s), onwards = along(scaled(of.v, at.c), of.u, hn::Neg(at.s));
      sides[i] = bent_arc(of.centre, outwards, onwards, tan_quarter, eye, over_alpha), seen[i] = part.seen;
      at = sum_of(at, step);
    }
  }
  const PlacedTubeAxis& light_;
};

std::size_t OverTubeMoments(const PlacedTubeAxis& light, const Emitter& white, const SpecularPoints& points, std::span<float> of_f0,
                            std::span<float> of_f90, float where_none) {
  const auto exact = [&](std::size_t index) { return in_double(SpecularRule::moments, white, points, index); };
  return over_views(points, of_f0, of_f90, where_none, TubeLobe(light), exact);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverTubeMoments);

class TubeLight final : public SpecularBatch::Light {
 public:
  explicit TubeLight(const Emitter& white) : white_(white) {}
  std::size_t over(SpecularRule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    const auto& tube = std::get<TubeEmitter>(white_.shape);
    const Vec3d span = tube.b - tube.a, axis = normalised(span), &origin = points.surface.origin;
    const PlacedTubeAxis light{Place(tube.a - origin), Direction(axis), Direction(basis_around(axis).tangent),
                               static_cast<float>(length(span)), static_cast<float>(tube.radius)};
    return HWY_DYNAMIC_DISPATCH(OverTubeMoments)(light, white_, points, of_f0, of_f90, where_none);
  }

 private:
  Emitter white_;
};

}  // namespace

// Without a length it is a sphere.
std::shared_ptr<const SpecularBatch::Light> specular_tube(SpecularRule rule, const Emitter& white) {
  const auto* tube = std::get_if<TubeEmitter>(&white.shape);
  if (tube == nullptr || rule != SpecularRule::moments || tube->caps != Caps::round || !(tube->radius > 0)) return nullptr;
  if (length(tube->b - tube->a) > 0) return std::make_shared<TubeLight>(white);
  Emitter ball = white;
  ball.shape = SphereEmitter{tube->a, tube->radius};
  return specular_round_moments(rule, ball);
}

}  // namespace etendue::eval
#endif
