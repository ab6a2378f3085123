// An arc tangent for kernels that need no more than a float's digits, once for each instruction set: include it after light_batch-inl.h.
#if defined(ETENDUE_ARC_TANGENT_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_ARC_TANGENT_INL_H
#undef ETENDUE_ARC_TANGENT_INL_H
#else
#define ETENDUE_ARC_TANGENT_INL_H
#endif

#include "eval/light_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// Of x >= 0 (Abramowitz and Stegun 4.4.49, within 2e-8).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc_tangent(D d, V x) {
  const V one = number(d, 1);
  const auto beyond = hn::Gt(x, one);
  const V y = hn::IfThenElse(beyond, hn::Div(one, x), x);
  const V p = hn::Mul(y, polynomial(d, hn::Mul(y, y),
                                    std::array{1.0, -0.3333314528, 0.1999355085, -0.1420889944, 0.1065626393, -0.0752896400, 0.0429096138,
                                               -0.0161657367, 0.0028662257}));
  return hn::IfThenElse(beyond, hn::Sub(number(d, 0.5 * pi), p), p);
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
