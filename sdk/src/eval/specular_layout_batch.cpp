// specular_layout.h: a side, or a part of one, a lane of floats.
#include "specular_layout.h"

#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_layout_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <vector>

#include "eval/light_batch-inl.h"
#include "eval/specular_curve-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

using Floats = hn::CappedTag<float, PartList::longest_vector>;
using Numbers = hn::Vec<Floats>;
HWY_INLINE Numbers constant(float x) { return hn::Set(Floats(), x); }

HWY_INLINE Numbers tau_of(Numbers kappa, Numbers origin, Numbers x) {
  const Numbers one = constant(1), to_end = hn::Sub(hn::Sub(one, origin), x), to_begin = hn::Add(hn::Add(one, origin), x);
  return hn::Div(hn::Mul(kappa, hn::Add(origin, x)), hn::Mul(to_end, to_begin));
}
template <bool Rims>
void find_ends_of(const SideBlock& block, std::size_t count, float negligible, SideEnds& ends) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const Numbers one = constant(1), zero = hn::Zero(d), least = constant(std::sqrt(negligible)), step = constant(1e-2f);
  for (std::vector<float>& numbers : ends.side) numbers.resize(block.sides * points_at_once);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto of_point = [&](SideBlock::OfPoint k) ETENDUE_INLINE_LAMBDA { return hn::LoadU(d, block.point[k].data() + i); };
    const Numbers alpha = of_point(SideBlock::alpha), view_x = of_point(SideBlock::view_x), view_z = of_point(SideBlock::view_z),
                  rest = of_point(SideBlock::rest);
    const Numbers layer = hn::Min(alpha, view_z), reach = hn::Max(hn::Add(layer, layer), least);
    for (std::size_t s = 0; s < block.sides; ++s) {
      const std::size_t at = s * points_at_once + i;
      const auto of_side = [&](SideBlock::OfSide k) ETENDUE_INLINE_LAMBDA { return hn::LoadU(d, block.side[k].data() + at); };
      const SideCurve<Rims, Floats> curve(of_side, view_x, view_z, alpha);
      const Numbers rim = of_side(SideBlock::rim);
      const auto keep = [&](std::size_t k, Numbers v) ETENDUE_INLINE_LAMBDA { hn::StoreU(v, d, ends.side[k].data() + at); };
      keep(SideEnds::low, hn::IfThenZeroElse(hn::Gt(of_side(SideBlock::lowest), reach), one));
      const Numbers nearest = hn::Mul(constant(5), hn::Max(rim, hn::Mul(constant(0.1f), alpha)));
      keep(SideEnds::rim, hn::IfThenElseZero(hn::And(hn::Gt(alpha, hn::Mul(constant(0.05f), rim)), hn::Gt(rest, nearest)), one));
      const Numbers begin = of_side(SideBlock::begin), end = of_side(SideBlock::end);
      const auto height = [&](Numbers tau) ETENDUE_INLINE_LAMBDA { return curve.height(curve.at(tau)); };
      const auto rise = [&](Numbers from, Numbers to, std::size_t low, std::size_t slope) ETENDUE_INLINE_LAMBDA {
        const Numbers here = hn::Max(height(from), zero);
        keep(low, here);
        keep(slope, hn::Div(hn::Sub(height(hn::MulAdd(step, hn::Sub(to, from), from)), here), step));
      };
      rise(begin, end, SideEnds::height_begin, SideEnds::slope_begin), rise(end, begin, SideEnds::height_end, SideEnds::slope_end);
    }
  }
}

template <bool Rims>
void find_rays_of(const SideBlock& block, PartList& parts) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d);
  const Numbers one = constant(1), zero = hn::Zero(d), two = constant(2);
  for (std::size_t k = parts.count; k < parts.count + lanes; ++k)
    parts.point[k] = parts.side[k] = 0, parts.origin[k] = parts.x0[k] = parts.x1[k] = 0;
  for (std::size_t i = 0; i < parts.count; i += lanes) {
    const auto at_point = hn::LoadU(di, parts.point.data() + i), at_side = hn::LoadU(di, parts.side.data() + i);
    const auto of_point = [&](SideBlock::OfPoint k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.point[k].data(), at_point); };
    const auto of_side = [&](SideBlock::OfSide k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.side[k].data(), at_side); };
    const Numbers kappa = of_side(SideBlock::kappa), alpha = of_point(SideBlock::alpha), rest = of_point(SideBlock::rest);
    const Numbers view_x = of_point(SideBlock::view_x), view_z = of_point(SideBlock::view_z);
    const SideCurve<Rims, Floats> curve(of_side, view_x, view_z, alpha);
    const Numbers origin = hn::LoadU(d, parts.origin.data() + i);
    const Numbers x0 = hn::LoadU(d, parts.x0.data() + i), x1 = hn::LoadU(d, parts.x1.data() + i);
    struct Ray {
      Numbers u, height, low, slope;
    };
    const auto ray = [&](Numbers x) ETENDUE_INLINE_LAMBDA {
      const auto h = curve.at(tau_of(kappa, origin, x));
      const Numbers over = hn::Div(one, h.z), qx = hn::Mul(h.x, over), qy = hn::Mul(h.y, over);
      const Numbers q2 = hn::MulAdd(qx, qx, hn::Mul(qy, qy)), q = hn::Sqrt(q2);
      // 1 - p, which far out of the lobe has more digits than p.
      const Numbers root = hn::Sqrt(hn::Add(one, q2));
      const Numbers u1 = hn::Div(hn::Add(one, hn::Div(one, hn::Add(root, q))), hn::Add(one, root));
      // n.l at the part t of the ray: slopes stretch q, n.l = 2 v.h n.h - n.v.
      const auto height = [&](float t) ETENDUE_INLINE_LAMBDA {
        const Numbers u = hn::MulAdd(constant(t), hn::Sub(u1, rest), rest), p = hn::Sub(one, u);
        const Numbers stretch = hn::Div(hn::Mul(hn::Mul(two, p), alpha), hn::Mul(hn::Mul(u, hn::Sub(two, u)), q));
        const Numbers vm = hn::Mul(hn::Mul(stretch, view_x), qx), m2 = hn::Mul(hn::Mul(stretch, stretch), q2);
        return hn::Div(hn::MulAdd(two, vm, hn::NegMulAdd(view_z, m2, view_z)), hn::Add(one, m2));
      };
      constexpr float step = 1e-2f;
      const Numbers low = hn::Max(height(1), zero);
      return Ray{u1, curve.height(h), low, hn::Mul(hn::Sub(height(1 - step), low), constant(1 / step))};
    };
    const Ray first = ray(x0), middle = ray(hn::Mul(constant(0.5f), hn::Add(x0, x1))), last = ray(x1);
    Numbers low = zero, slope = zero;
    for (const Ray& r : {first, middle, last}) {
      const auto steeper = hn::Gt(r.slope, slope);
      low = hn::IfThenElse(steeper, r.low, low), slope = hn::IfThenElse(steeper, r.slope, slope);
    }
    hn::StoreU(middle.u, d, parts.u.data() + i);
    hn::StoreU(hn::Max(first.height, hn::Max(middle.height, last.height)), d, parts.highest.data() + i);
    hn::StoreU(low, d, parts.low.data() + i), hn::StoreU(slope, d, parts.slope.data() + i);
  }
}

void FindEnds(const SideBlock& block, std::size_t count, float negligible, SideEnds& ends) {
  if (block.rims) return find_ends_of<true>(block, count, negligible, ends);
  find_ends_of<false>(block, count, negligible, ends);
}
void FindRays(const SideBlock& block, PartList& parts) {
  if (block.rims) return find_rays_of<true>(block, parts);
  find_rays_of<false>(block, parts);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(FindEnds);
HWY_EXPORT(FindRays);

void find_ends(const SideBlock& block, std::size_t count, float negligible, SideEnds& ends) {
  HWY_DYNAMIC_DISPATCH(FindEnds)(block, count, negligible, ends);
}
void find_rays(const SideBlock& block, PartList& parts) { HWY_DYNAMIC_DISPATCH(FindRays)(block, parts); }

}  // namespace etendue::eval
#endif
