// A side of SideBlock at tau, once for each instruction set: include it after light_batch-inl.h.
#if defined(ETENDUE_SPECULAR_CURVE_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_CURVE_INL_H
#undef ETENDUE_SPECULAR_CURVE_INL_H
#else
#define ETENDUE_SPECULAR_CURVE_INL_H
#endif

#include "eval/light_batch-inl.h"
#include "specular_cells.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// h' but for its length, as SideBlock has it: quadratics, and of `Rims` what the view has beyond them, view r(tau) (specular_cells.h).
template <bool Rims, class D>
class SideCurve {
  using V = hn::Vec<D>;

 public:
  // of_side(k): SideBlock's numbers of a vector of sides; their points' view, and alpha.
  template <class OfSide>
  HWY_INLINE SideCurve(const OfSide& of_side, V view_x, V view_z, V alpha)
      : x0_(of_side(SideBlock::x0)),
        x1_(of_side(SideBlock::x1)),
        x2_(of_side(SideBlock::x2)),
        y0_(of_side(SideBlock::y0)),
        y1_(of_side(SideBlock::y1)),
        y2_(of_side(SideBlock::y2)),
        z0_(of_side(SideBlock::z0)),
        z1_(of_side(SideBlock::z1)),
        z2_(of_side(SideBlock::z2)),
        view_z_(view_z) {
    if constexpr (Rims) {
      for (std::size_t k = 0; k < w_.size(); ++k) w_[k] = of_side(static_cast<SideBlock::OfSide>(SideBlock::w0 + k));
      bent_x_ = hn::Div(view_x, alpha);
    }
  }
  struct At {
    V x, y, z, length;  // |b| (1 + tau^2)
    // Of rims: r, and W's first part.
    V r, w;
  };
  HWY_INLINE At at(V tau) const {
    const auto quadratic = [&](V c0, V c1, V c2) ETENDUE_INLINE_LAMBDA { return hn::MulAdd(hn::MulAdd(c2, tau, c1), tau, c0); };
    At at{quadratic(x0_, x1_, x2_), quadratic(y0_, y1_, y2_), quadratic(z0_, z1_, z2_), hn::MulAdd(tau, tau, hn::Set(D(), 1.0f)), {}, {}};
    if constexpr (Rims) {
      const V rest = hn::Mul(hn::Mul(tau, hn::Mul(tau, tau)), hn::MulAdd(w_[4], tau, w_[3]));
      at.w = quadratic(w_[0], w_[1], w_[2]);
      at.length = hn::Sqrt(hn::Max(hn::MulAdd(at.w, at.w, rest), hn::Zero(D())));
      at.r = hn::Div(rest, hn::Add(at.w, at.length));
      at.x = hn::MulAdd(bent_x_, at.r, at.x), at.z = hn::MulAdd(view_z_, at.r, at.z);
    }
    return at;
  }
  // n.l: h' is v + l there, but for its length.
  HWY_INLINE V height(const At& at) const { return hn::Sub(hn::Div(at.z, at.length), view_z_); }
  // What q x dq/dtau has beyond (turn0 + turn1 tau + turn2 tau^2) / z^2: view_x (r y' - r' y), of 2 length r' = d rest / d tau - 2 r w'.
  HWY_INLINE V more_turn(V tau, const At& at) const {
    static_assert(Rims);
    const V two = hn::Set(D(), 2.0f), speed_y = hn::MulAdd(hn::Mul(two, y2_), tau, y1_),
            speed_w = hn::MulAdd(hn::Mul(two, w_[2]), tau, w_[1]);
    const V of_rest = hn::Mul(hn::Mul(tau, tau), hn::MulAdd(hn::Mul(hn::Set(D(), 4.0f), w_[4]), tau, hn::Mul(hn::Set(D(), 3.0f), w_[3])));
    const V speed_r = hn::Div(hn::NegMulAdd(hn::Mul(two, at.r), speed_w, of_rest), hn::Mul(two, at.length));
    return hn::Mul(bent_x_, hn::MulSub(at.r, speed_y, hn::Mul(speed_r, at.y)));
  }

 private:
  V x0_, x1_, x2_, y0_, y1_, y2_, z0_, z1_, z2_, view_z_;
  V bent_x_{};
  std::array<V, 5> w_{};
};

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
