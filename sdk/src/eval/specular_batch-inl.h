// What the kernels of specular_batch.h share, once for each instruction set: include it after HWY_TARGET_INCLUDE and hwy/foreach_target.h.
#if defined(ETENDUE_SPECULAR_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_BATCH_INL_H
#undef ETENDUE_SPECULAR_BATCH_INL_H
#else
#define ETENDUE_SPECULAR_BATCH_INL_H
#endif

#include "eval/edge_batch-inl.h"
#include "eval/method_batch-inl.h"
#include "eval/specular_batch.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

struct Shares {
  Lanes of_f0, of_f90;
};

// Lights that are smaller than this, in radians across, have too few digits in floats.
inline constexpr float least_angle = 2e-4f;

// The shading point's frame: z its normal, the view in the plane x >= 0, y = 0.
struct ViewFrame {
  Vector3 x, y, z;
  Lanes cosine, sine;  // of the view
  Vector3 operator()(const Vector3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  Vector3 view() const { return {sine, number(0), cosine}; }
};
HWY_INLINE ViewFrame view_frame(const Vector3& normal, const Vector3& view) {
  const Floats d;
  const Vector3 z = unit(normal), v = unit(view);
  const Lanes cosine = dot(z, v);
  Vector3 across = along(v, z, hn::Neg(cosine));
  Lanes square = dot(across, across);
  const Lit upright = hn::Lt(square, number(1e-12f));
  if (HWY_UNLIKELY(!hn::AllFalse(d, upright))) {
    // Along the normal any plane is the view's.
    const Lit steep = hn::Gt(hn::Abs(z.x), number(0.7f));
    const Vector3 axis{hn::IfThenZeroElse(steep, number(1)), hn::IfThenElseZero(steep, number(1)), number(0)};
    const Vector3 other = cross(axis, z);
    across = chosen(upright, other, across);
    square = dot(across, across);
  }
  const Lanes inverse = inverse_sqrt(d, square);
  const Vector3 x = scaled(across, inverse);
  return {x, cross(z, x), z, cosine, hn::IfThenElseZero(hn::Not(upright), hn::Mul(square, inverse))};
}

// Outline of a convex outline, head to tail; those that are not seen count for nothing.
template <std::size_t N>
struct Outline {
  std::array<Vector3, N> from, to;
  std::array<Lit, N> seen;
};
template <std::size_t N>
HWY_INLINE Outline<N> outline_of(const std::array<Vector3, N>& corners) {
  Outline<N> s{corners, corners, {}};
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    s.to[i] = corners[(i + 1) % N];
    s.seen[i] = hn::FirstN(Floats(), hn::Lanes(Floats()));
  });
  return s;
}
template <std::size_t N>
HWY_INLINE Lit all_above(const Outline<N>& s) {
  Lanes least = number(1);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA { least = hn::Min(least, hn::IfThenElse(s.seen[i], s.from[i].z, number(1))); });
  return hn::Ge(least, number(0));
}
// What of it has z >= 0, and the side on z = 0 that closes it; crossings are unit vectors.
template <std::size_t N>
HWY_INLINE Outline<N + 1> clipped(const Outline<N>& s) {
  const Floats d;
  const Lanes zero = number(0);
  Outline<N + 1> c{};
  // The ends of the side that goes below and of the one that comes up.
  Vector3 high = s.from[0], low = s.to[0], deep = s.from[0], raised = s.to[0];
  Lit cut = hn::FirstN(d, 0);
  std::array<Lit, N> goes, rises;
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Lit from = hn::And(hn::Ge(s.from[i].z, zero), s.seen[i]), to = hn::And(hn::Ge(s.to[i].z, zero), s.seen[i]);
    goes[i] = hn::AndNot(to, from), rises[i] = hn::And(hn::AndNot(from, to), s.seen[i]);
    high = chosen(goes[i], s.from[i], high), low = chosen(goes[i], s.to[i], low);
    deep = chosen(rises[i], s.from[i], deep), raised = chosen(rises[i], s.to[i], raised);
    c.seen[i] = hn::Or(from, to);
    cut = hn::Or(cut, goes[i]);
  });
  const auto crossing = [&](const Vector3& a, const Vector3& b) ETENDUE_INLINE_LAMBDA {
    // a (-b.z) + b a.z, with a above and b below.
    const Lanes x = hn::NegMulAdd(a.x, b.z, hn::Mul(b.x, a.z)), y = hn::NegMulAdd(a.y, b.z, hn::Mul(b.y, a.z));
    const Lanes inverse = inverse_sqrt(d, hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), number(1e-30f)));
    return Vector3{hn::Mul(x, inverse), hn::Mul(y, inverse), zero};
  };
  const Vector3 gone = crossing(high, low), risen = crossing(raised, deep);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    c.from[i] = chosen(rises[i], risen, s.from[i]);
    c.to[i] = chosen(goes[i], gone, s.to[i]);
  });
  c.from[N] = gone, c.to[N] = risen, c.seen[N] = cut;
  return c;
}

// theta / sin(theta) - 1 between unit vectors, `step` from one to the other.
HWY_INLINE Lanes acute_over_sine_less_one(Lanes t) { return hn::Mul(t, angle_over_sine_rests(Floats(), std::array{t})[0]); }
// Beyond a right angle of pi - theta; 1 + cos(theta) has no digits left close to half a turn.
HWY_INLINE Lanes obtuse_over_sine_less_one(const Vector3& from, const Vector3& step, Lanes t) {
  const Vector3 across = cross(from, step);
  const Lanes two = number(2), f = acute_over_sine_less_one(hn::Min(t, positive(hn::Sub(two, t))));
  const Lanes over_sine = inverse_sqrt(Floats(), hn::Max(dot(across, across), number(1e-20f)));
  return hn::IfThenElse(hn::Gt(t, number(1)), hn::Sub(hn::MulSub(number(static_cast<float>(pi)), over_sine, f), two), f);
}
HWY_INLINE Lanes over_sine_less_one(const Vector3& from, const Vector3& step) {
  const Lanes t = hn::Mul(number(0.5f), dot(step, step));
  if (HWY_LIKELY(hn::AllTrue(Floats(), hn::Le(t, number(1))))) return acute_over_sine_less_one(t);
  return obtuse_over_sine_less_one(from, step, t);
}

// kernel(surface position, normal, view, alpha, doubtful) gives the shares of every lane; of those that it doubts exact(index) does. How
// many points are not finite.
template <class Kernel>
HWY_INLINE std::size_t over_views(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float where_none,
                                  Kernel kernel, const auto& exact) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const PointBatch& s = points.surface;
  const std::array<const float*, 10> all{s.px.data(), s.py.data(),      s.pz.data(),      s.nx.data(),      s.ny.data(),
                                         s.nz.data(), points.vx.data(), points.vy.data(), points.vz.data(), points.alpha.data()};
  Marks<Floats> marks;
  std::array<std::uint16_t, block> indices;
  HWY_ALIGN std::array<std::array<float, hn::MaxLanes(d)>, 12> last;
  std::size_t without = 0;
  for (std::size_t first = 0; first < of_f0.size();) {
    const std::size_t left = of_f0.size() - first, whole = std::min(left - left % lanes, block), count = whole > 0 ? whole : left;
    std::array<const float*, 10> in = all;
    for (const float*& from : in) from += first;
    float *to = of_f0.data() + first, *to_90 = of_f90.data() + first;
    if (whole == 0) {
      // The last points stand in a vector of their own.
      for (std::size_t k = 0; k < 10; ++k) {
        std::fill_n(last[k].begin(), lanes, 1.0f);
        std::copy_n(in[k], count, last[k].begin());
        in[k] = last[k].data();
      }
      to = last[10].data(), to_90 = last[11].data();
    }
    for (std::size_t i = 0, vector = 0; i < count; i += lanes, ++vector) {
      const auto at = [&](std::size_t k) ETENDUE_INLINE_LAMBDA {
        return Vector3{hn::LoadU(d, in[k] + i), hn::LoadU(d, in[k + 1] + i), hn::LoadU(d, in[k + 2] + i)};
      };
      const Vector3 position = at(0), normal = at(3), view = at(6);
      const Lanes alpha = hn::LoadU(d, in[9] + i);
      Lit doubtful = hn::FirstN(d, 0);
      const Shares shares = kernel(position, normal, view, hn::Min(hn::Max(alpha, number(1e-4f)), number(1)), doubtful);
      const Lanes nothing = hn::Add(less_itself(position, normal), hn::Add(less_itself(view, view), hn::Sub(alpha, alpha)));
      const Lit sound = hn::And(hn::Eq(nothing, number(0)), hn::Lt(hn::Max(hn::Abs(shares.of_f0), hn::Abs(shares.of_f90)), number(2)));
      hn::StoreU(shares.of_f0, d, to + i);
      hn::StoreU(shares.of_f90, d, to_90 + i);
      marks.set(d, hn::Or(doubtful, hn::Not(sound)), vector);
    }
    if (whole == 0) {
      std::copy_n(last[10].begin(), count, of_f0.data() + first);
      std::copy_n(last[11].begin(), count, of_f90.data() + first);
    }
    const std::size_t doubted = marks.list(d, (count + lanes - 1) / lanes, indices);
    for (std::size_t k = 0; k < doubted && indices[k] < count; ++k) {
      const std::size_t index = first + indices[k];
      const bool finite = std::all_of(all.begin(), all.end(), [&](const float* from) { return std::isfinite(from[index]); });
      const SchlickShares shares = finite ? exact(index) : SchlickShares{where_none, where_none};
      of_f0[index] = shares.of_f0, of_f90[index] = shares.of_f90;
      if (!finite) ++without;
    }
    first += count;
  }
  return without;
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
