#include "lobe_nodes.h"

#include "microfacet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/lobe_nodes_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// G / (4 n.v n.l) as in GgxView.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V masked(D d, const DiskLobe& lobe, V nl) {
  const auto number = [d](double x) { return hn::Set(d, x); };
  if (lobe.masking == Masking::correlated || lobe.masking == Masking::separable) {
    const double alpha2 = lobe.alpha * lobe.alpha;
    const V root = hn::Sqrt(hn::MulAdd(hn::Mul(nl, nl), number(1 - alpha2), number(alpha2)));
    const V seen = lobe.masking == Masking::correlated
                       ? hn::Mul(number(2), hn::MulAdd(nl, number(lobe.view_root), hn::Mul(number(lobe.view.z), root)))
                       : hn::Mul(number(lobe.view.z + lobe.view_root), hn::Add(nl, root));
    return hn::Div(number(1), seen);
  }
  const double view_seen = 4 * schlick_seen_area(lobe.view.z, lobe.k);
  return hn::Div(number(1), hn::MulAdd(nl, number(view_seen * (1 - lobe.k)), number(view_seen * lobe.k)));
}

void Nodes(const DiskLobe& lobe, const Risen& level, const LobeNodes& nodes, double* plain, double* risen) {
  const hn::CappedTag<double, LobeNodes::longest_vector> d;
  const std::size_t lanes = hn::Lanes(d);
  using V = hn::Vec<decltype(d)>;
  const auto number = [d](double x) { return hn::Set(d, x); };
  const V one = number(1), zero = hn::Zero(d), vz = number(lobe.view.z);
  for (std::size_t i = 0; i < nodes.count; i += lanes) {
    const V ratio = hn::Load(d, nodes.ratio.data() + i), q2 = hn::Load(d, nodes.q2.data() + i);
    const V p2 = hn::Mul(hn::Mul(ratio, ratio), q2), p = hn::Sqrt(p2);
    const V less = hn::Mul(hn::Sub(one, p), hn::Add(one, p)), more = hn::Div(one, hn::Add(one, p2));
    // Slopes m = stretch q; v.h / n.h = v.m + v.z, n.l = 2 v.h n.h - v.z.
    const V stretch = hn::Div(hn::Mul(number(2 * lobe.alpha), ratio), less);
    const V vm = hn::Mul(stretch, hn::Load(d, nodes.view_q.data() + i)), m2 = hn::Mul(hn::Mul(stretch, stretch), q2);
    const V per_m = hn::Div(one, hn::Add(one, m2)), c = hn::Add(vm, vz);
    const V nl = hn::Max(hn::Mul(hn::MulAdd(number(2), vm, hn::NegMulAdd(vz, m2, vz)), per_m), zero);
    const V shape = hn::Mul(hn::Mul(hn::Mul(number(4), nl), hn::Max(c, zero)), masked(d, lobe, nl));
    const V away = hn::Min(hn::Max(hn::NegMulAdd(c, hn::Sqrt(per_m), one), zero), one), away2 = hn::Mul(away, away);
    const V w = hn::Mul(hn::Mul(away2, away2), away), up = hn::Mul(shape, w);
    const V here = hn::Mul(hn::Mul(hn::Load(d, nodes.factor.data() + i), hn::Mul(ratio, less)), hn::Mul(more, hn::Mul(more, more)));
    hn::Store(hn::Mul(here, hn::Sub(hn::Sub(shape, up), number(level.plain))), d, plain + i);
    hn::Store(hn::Mul(here, hn::Sub(up, number(level.risen))), d, risen + i);
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(Nodes);

void evaluate(const DiskLobe& lobe, const Risen& level, LobeNodes& nodes, double* plain, double* risen) {
  nodes.fill_up();
  HWY_DYNAMIC_DISPATCH(Nodes)(lobe, level, nodes, plain, risen);
}

}  // namespace etendue::eval
#endif
