// Specular light of tubes with round caps at many points, by moments.
#include "light_batch.h"
#include "specular_batch.h"
#include "specular_tube.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_tube_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/specular_moments-inl.h"
#include "eval/tube_outline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

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
    const Shares shares = by_moments(frame, alpha, above.somewhere, [&](MomentSums& sums) ETENDUE_INLINE_LAMBDA {
      std::array<Quadratic, 7> sides{};
      std::array<Lit, 7> seen{};
      const auto side = [&](std::size_t at, const Side& of)
                            ETENDUE_INLINE_LAMBDA { sides[at] = bent_side(of.from, of.to, eye, over_alpha), seen[at] = of.seen; };
      const auto in_two = [&](const CapArc& of, const ArcPart& part, std::size_t at) ETENDUE_INLINE_LAMBDA {
        arc<2>(of, part, half_of(part.half), part.half, eye, over_alpha, sides.data() + at, seen.data() + at);
      };
      // 1 part of what is half a turn at most, and of the longer arc 2 unless it is most of a turn.
      const ArcPart &longer = above.a.cut.first, &shorter = above.b.cut.first;
      arc<1>(tube.b, shorter, shorter.half, shorter.half, eye, over_alpha, sides.data(), seen.data());
      side(1, above.sides[0]), side(2, above.sides[1]);
      const bool wide = !hn::AllFalse(d, hn::And(hn::And(lit, longer.seen), hn::Lt(longer.half.c, number(-0.3f))));
      if (HWY_UNLIKELY(wide)) {
        const Turn quarter = half_of(longer.half);
        arc<4>(tube.a, longer, half_of(quarter), quarter, eye, over_alpha, sides.data() + 3, seen.data() + 3);
      } else {
        in_two(tube.a, longer, 3);
      }
      for (std::size_t i = 0; i < (wide ? 7U : 5U); ++i) add_side(sides[i], seen[i], sums);
      const Lit cuts = hn::And(lit, above.sides[2].seen);
      if (hn::AllFalse(d, cuts)) return;
      add_side(bent_side(above.sides[2].from, above.sides[2].to, eye, over_alpha), cuts, sums);
      const ArcPart &other_a = above.a.cut.other, &other_b = above.b.cut.other;
      if (HWY_LIKELY(hn::AllFalse(d, hn::And(lit, hn::Or(other_a.seen, other_b.seen))))) return;
      in_two(tube.a, other_a, 0), in_two(tube.b, other_b, 2);
      for (std::size_t i = 0; i < 4; ++i) add_side(sides[i], seen[i], sums);
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
  std::size_t over(SpecularRule rule, const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90,
                   float where_none) const override {
    const auto& tube = std::get<TubeEmitter>(white_.shape);
    const Vec3d span = tube.b - tube.a, axis = normalised(span), &origin = points.surface.origin;
    const PlacedTubeAxis light{Place(tube.a - origin), Direction(axis), Direction(basis_around(axis).tangent),
                               static_cast<float>(length(span)), static_cast<float>(tube.radius)};
    if (rule != SpecularRule::moments) return tube_by_cosines(rule, light, white_, points, of_f0, of_f90, where_none);
    return HWY_DYNAMIC_DISPATCH(OverTubeMoments)(light, white_, points, of_f0, of_f90, where_none);
  }

 private:
  Emitter white_;
};

}  // namespace

// Without a length it is a sphere.
std::shared_ptr<const SpecularBatch::Light> specular_tube(SpecularRule rule, const Emitter& white) {
  const auto* tube = std::get_if<TubeEmitter>(&white.shape);
  const bool has_vectors = rule == SpecularRule::moments || rule == SpecularRule::ltc || rule == SpecularRule::ltc_two_lobes;
  if (tube == nullptr || !has_vectors || tube->caps != Caps::round || !(tube->radius > 0)) return nullptr;
  if (length(tube->b - tube->a) > 0) return std::make_shared<TubeLight>(white);
  Emitter ball = white;
  ball.shape = SphereEmitter{tube->a, tube->radius};
  return rule == SpecularRule::moments ? specular_round_moments(rule, ball) : specular_round(rule, ball);
}

}  // namespace etendue::eval
#endif
