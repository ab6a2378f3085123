// specular_outline.h: polygons, whatever their number of corners and whether they are convex.
#include "specular_outline.h"

#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_polygon_sides_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>

#include "eval/specular_sides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// Cuts sides, head to tail, at z = 0. Whenever the outline comes up again a side along the horizon closes it, from where it has gone below;
// what comes up before anything has gone waits for the last one.
class Cut {
 public:
  HWY_INLINE Cut(std::size_t most_parts, const Wide3& anywhere)
      : most_(most_parts), gone_(anywhere), first_(anywhere), count_(wide(0)), open_(none_of()), waits_(none_of()), more_(none_of()) {
    for (WideSide& side : along_) side = {anywhere, anywhere, none_of()};
  }
  HWY_INLINE WideSide operator()(const Wide3& a, const Wide3& b) {
    const Wide zero = wide(0);
    const WideMask from = hn::Ge(a.z, zero), to = hn::Ge(b.z, zero), goes = hn::AndNot(to, from), rises = hn::AndNot(from, to);
    WideSide side{a, b, hn::Or(from, to)};
    if (hn::AllFalse(Doubles(), hn::Or(goes, rises))) return side;
    // Of the upper end and the lower one.
    const Wide3 high = chosen(rises, b, a), low = chosen(rises, a, b);
    const Wide x = hn::NegMulAdd(high.x, low.z, hn::Mul(low.x, high.z)), y = hn::NegMulAdd(high.y, low.z, hn::Mul(low.y, high.z));
    const Wide inverse = inverse_root(Doubles(), hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), wide(1e-60)));
    const Wide3 place{hn::Mul(x, inverse), hn::Mul(y, inverse), zero};
    side.from = chosen(rises, place, a), side.to = chosen(goes, place, b);
    close(hn::And(rises, open_), place);
    const WideMask first = hn::AndNot(open_, rises);
    first_ = chosen(first, place, first_), waits_ = hn::Or(waits_, first);
    gone_ = chosen(goes, place, gone_), open_ = hn::AndNot(rises, hn::Or(open_, goes));
    return side;
  }
  HWY_INLINE void finish() { close(hn::And(waits_, open_), first_); }
  const WideSide& along(std::size_t part) const { return along_[part]; }
  WideMask more() const { return more_; }

 private:
  HWY_INLINE void close(WideMask closes, const Wide3& to) {
    for (std::size_t k = 0; k < most_; ++k) {
      const WideMask here = hn::And(closes, hn::Eq(count_, wide(static_cast<double>(k))));
      along_[k] = {chosen(here, gone_, along_[k].from), chosen(here, to, along_[k].to), hn::Or(along_[k].seen, here)};
    }
    more_ = hn::Or(more_, hn::And(closes, hn::Ge(count_, wide(static_cast<double>(most_)))));
    count_ = hn::Add(count_, hn::IfThenElseZero(closes, wide(1)));
  }

  std::size_t most_;
  std::array<WideSide, most_horizon_sides> along_;
  Wide3 gone_, first_;
  Wide count_;
  WideMask open_, waits_, more_;
};

void LayPolygonSides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  const Doubles d;
  const CornersSeen& polygon = *std::get_if<CornersSeen>(&light.shape);
  const std::size_t sides = polygon.corners.size();
  block.make_room(sides, polygon.most_parts, false);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const WidePoints points(places, i);
    const Wide height = dot(wide(polygon.corners[0]) - points.position, wide(polygon.normal));
    const WideMask front = hn::Lt(height, wide(0)), back = hn::Gt(height, wide(0));
    // From behind they are counter-clockwise the other way round.
    const auto corner = [&](std::size_t k) ETENDUE_INLINE_LAMBDA {
      Wide3 place = wide(polygon.corners[k]);
      if (light.two_sided) place = chosen(back, wide(polygon.corners[sides - 1 - k]), place);
      return wide_unit(points.local(place - points.position));
    };
    SideLayer layer(points, block, i);
    const Wide3 first = corner(0);
    Wide3 from = first;
    Cut cut(polygon.most_parts, first);
    for (std::size_t k = 0; k < sides; ++k) {
      const Wide3 to = k + 1 < sides ? corner(k + 1) : first;
      layer.lay(k, cut(from, to));
      from = to;
    }
    cut.finish();
    for (std::size_t part = 0; part < polygon.most_parts; ++part) layer.lay(sides + part, cut.along(part));
    layer.doubtful = hn::Or(layer.doubtful, cut.more());
    layer.finish(light, light.two_sided ? hn::Or(front, back) : front, hn::Not(hn::Eq(layer.winding, wide(0))));
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(LayPolygonSides);

void lay_polygon_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  HWY_DYNAMIC_DISPATCH(LayPolygonSides)(light, places, count, block);
}

}  // namespace etendue::eval
#endif
