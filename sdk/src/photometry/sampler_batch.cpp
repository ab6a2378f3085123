// Many directions drawn at once: cells are looked up one by one, into rows of numbers; what is computed from these, in vectors, is what
// sampler.cpp computes of one.
#include "etendue/web_sampler.h"

#include "angle.h"
#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photometry/sampler_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#ifndef ETENDUE_SAMPLER_BATCH_SHARED
#define ETENDUE_SAMPLER_BATCH_SHARED
namespace etendue {

// A block of directions, a row a quantity: so many that the processor waits for many cells of the table together.
struct WebSampler::Rows {
  static constexpr std::size_t size = 64;
  using Row = double[size];
  alignas(64) Row near_start, near_end, far_start, far_end;  // cd at the cell's corners
  alignas(64) Row beyond, of;                                // how far the random number is in the cell's part of [0, 1), and that part
  alignas(64) Row width, inverse_width, sine, cosine, end_sine, integral, first_moment;  // WebSampler::Interval
  alignas(64) Row from_deg, width_deg, across;                                           // the azimuth, and where in it by its share
  alignas(64) Row polar_sign;                                                            // of its cosine
  // Results. done: 0 where the careful way has to be gone.
  alignas(64) Row x, y, z, cd, done;
};

}  // namespace etendue
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// As linear_inverse() of sampler.cpp.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V linear_inverse(D d, V a, V b, V share) {
  const V root = hn::Sqrt(hn::MulAdd(hn::Mul(share, hn::Sub(b, a)), hn::Add(b, a), hn::Mul(a, a))), sum = hn::Add(a, root);
  const auto some = hn::Gt(sum, hn::Zero(d));
  return hn::IfThenElse(some, hn::Min(hn::Div(hn::Mul(share, hn::Add(a, b)), hn::IfThenElse(some, sum, hn::Set(d, 1.0))), hn::Set(d, 1.0)),
                        share);
}

template <class V>
struct SineAndVersine {
  V sine, versine;
};
// As photometry::sine_versine_small(): |x| <= pi/4.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SineAndVersine<V> sine_versine(D d, V x) {
  const V q = hn::Mul(x, x);
  V s = hn::Set(d, -1.0 / 1307674368000), c = hn::Set(d, -1.0 / 20922789888000);
  for (const double term : {1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6})
    s = hn::MulAdd(s, q, hn::Set(d, term));
  for (const double term : {1.0 / 87178291200, -1.0 / 479001600, 1.0 / 3628800, -1.0 / 40320, 1.0 / 720, -1.0 / 24, 0.5})
    c = hn::MulAdd(c, q, hn::Set(d, term));
  return {hn::MulAdd(x, hn::Mul(q, s), x), hn::Mul(q, c)};
}

template <class V>
struct Turned {
  V sine, cosine;
};
// Of theta = from + s, from sine and cosine of `from`.
template <class V>
HWY_INLINE Turned<V> turned(V sine, V cosine, const SineAndVersine<V>& s) {
  return {hn::Add(sine, hn::MulSub(cosine, s.sine, hn::Mul(sine, s.versine))),
          hn::Sub(cosine, hn::MulAdd(sine, s.sine, hn::Mul(cosine, s.versine)))};
}

// Householder's step, twice at most, as sampler.cpp derives it.
template <class D>
HWY_INLINE void draw(D d, WebType type, double last_step, std::size_t at, WebSampler::Rows& rows) {
  using V = hn::Vec<D>;
  const auto set = [&](double x) { return hn::Set(d, x); };
  const auto load = [&](const double* row) { return hn::Load(d, row + at); };
  const V zero = hn::Zero(d), one = set(1);
  const V near0 = load(rows.near_start), near1 = load(rows.near_end), far0 = load(rows.far_start), far1 = load(rows.far_end);
  const V a = hn::Mul(set(0.5), hn::Add(near0, far0)), b = hn::Mul(set(0.5), hn::Add(near1, far1));
  const V width = load(rows.width), inverse_width = load(rows.inverse_width), sine = load(rows.sine), cosine = load(rows.cosine);
  const V share = hn::Min(hn::Max(hn::Div(load(rows.beyond), load(rows.of)), zero), one);
  const V r = hn::Mul(hn::Sub(b, a), inverse_width);
  const V wanted = hn::Mul(share, hn::MulAdd(r, load(rows.first_moment), hn::Mul(a, load(rows.integral))));

  V s = hn::Mul(width, linear_inverse(d, hn::Mul(a, sine), hn::Mul(b, load(rows.end_sine)), share));
  V polar_sine = zero, polar_cosine = zero;
  auto done = hn::Gt(zero, one);
  const auto step = [&] {
    const auto turn = sine_versine(d, s);
    const auto t = turned(sine, cosine, turn);
    // sin(from) (s sin s - (1 - cos s)) + cos(from) (sin s - s cos s), and sin(from) sin(s) + cos(from) (1 - cos s).
    const V first =
        hn::MulAdd(sine, hn::MulSub(s, turn.sine, turn.versine), hn::Mul(cosine, hn::MulAdd(s, turn.versine, hn::Sub(turn.sine, s))));
    const V integral = hn::MulAdd(sine, turn.sine, hn::Mul(cosine, turn.versine));
    const V value = hn::MulAdd(r, s, a), density = hn::Mul(value, t.sine);
    const V slope = hn::MulAdd(r, t.sine, hn::Mul(value, t.cosine)), bend = hn::MulSub(hn::Add(r, r), t.cosine, density);
    const V f = hn::Sub(hn::MulAdd(a, integral, hn::Mul(r, first)), wanted), square = hn::Mul(density, density),
            f_slope = hn::Mul(f, slope);
    const V below = hn::MulAdd(density, hn::Sub(square, f_slope), hn::Mul(hn::Mul(f, f), hn::Mul(bend, set(1.0 / 6))));
    const auto defined = hn::And(hn::Gt(density, zero), hn::Gt(below, zero));
    const V by = hn::Neg(hn::Div(hn::Mul(f, hn::NegMulAdd(set(0.5), f_slope, square)), hn::IfThenElse(defined, below, one)));
    const V next = hn::Add(s, by), to_end = hn::Min(next, hn::Sub(width, next));
    const auto here = hn::AndNot(done, hn::And(defined, hn::Le(hn::Abs(by), hn::Mul(set(last_step), to_end))));
    const V by_square = hn::Mul(by, by);
    const auto last = turned(t.sine, t.cosine,
                             SineAndVersine<V>{hn::Mul(by, hn::NegMulAdd(by_square, set(1.0 / 6), one)),
                                               hn::Mul(hn::Mul(set(0.5), by_square), hn::NegMulAdd(by_square, set(1.0 / 12), one))});
    polar_sine = hn::IfThenElse(here, last.sine, polar_sine);
    polar_cosine = hn::IfThenElse(here, last.cosine, polar_cosine);
    s = hn::IfThenElse(done, s, next);
    done = hn::Or(done, hn::And(here, hn::Gt(to_end, zero)));
  };
  // Beyond pi/4 the series of sine_versine() end too soon.
  const auto narrow = hn::Le(width, set(0.785));
  step();
  if (!hn::AllTrue(d, done)) step();
  done = hn::And(done, narrow);

  const V along = hn::Min(hn::Max(hn::Mul(s, inverse_width), zero), one);
  const V near = hn::MulAdd(along, hn::Sub(near1, near0), near0), far = hn::MulAdd(along, hn::Sub(far1, far0), far0);
  const V t = linear_inverse(d, near, far, load(rows.across));
  const V azimuth = hn::MulAdd(t, load(rows.width_deg), load(rows.from_deg));
  // Quarters of a turn, 0 to 3, and the rest within 45 degrees.
  const V quarters = hn::Round(hn::Mul(azimuth, set(1.0 / 90)));
  const auto rest = sine_versine(d, hn::Mul(hn::NegMulAdd(quarters, set(90), azimuth), set(photometry::degree)));
  const V quarter = hn::NegMulAdd(hn::Floor(hn::Mul(quarters, set(0.25))), set(4), quarters), rest_cosine = hn::Sub(one, rest.versine);
  const auto odd = hn::Eq(hn::Abs(hn::Sub(quarter, set(2))), one), lower = hn::Ge(quarter, set(1.5));
  const auto left = hn::Lt(hn::Abs(hn::Sub(quarter, set(1.5))), one);
  const V up = hn::IfThenElse(odd, rest_cosine, rest.sine), ahead = hn::IfThenElse(odd, rest.sine, rest_cosine);
  const V across = hn::Mul(polar_sine, hn::IfThenElse(lower, hn::Neg(up), up));
  const V towards_zero = hn::Mul(polar_sine, hn::IfThenElse(left, hn::Neg(ahead), ahead));
  const V minus_pole = hn::Neg(hn::Mul(polar_cosine, load(rows.polar_sign)));

  // The pole is -z for type C, and -x and -y with the azimuth from -z for types A and B.
  const V x = type == WebType::c ? towards_zero : type == WebType::a ? minus_pole : across;
  const V y = type == WebType::b ? minus_pole : across;
  const V z = type == WebType::c ? minus_pole : hn::Neg(towards_zero);
  hn::Store(x, d, rows.x + at);
  hn::Store(y, d, rows.y + at);
  hn::Store(z, d, rows.z + at);
  hn::Store(hn::MulAdd(t, hn::Sub(far, near), near), d, rows.cd + at);
  hn::Store(hn::IfThenElseZero(done, one), d, rows.done + at);
}

void Draw(WebSampler::Rows& rows, std::size_t count, WebType type, double last_step) {
  const hn::CappedTag<double, WebSampler::Rows::size> d;
  for (std::size_t at = 0; at < count; at += hn::Lanes(d)) draw(d, type, last_step, at, rows);
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(Draw);

}  // namespace

// Random places of a large table are not near the processor. All of a block are asked for at once, then all that these point to.
void WebSampler::look_up(std::span<const Vec2d> u, Rows& rows) const {
  std::uint32_t cell[Rows::size];
  for (std::size_t at = 0; at < Rows::size; ++at) {
    cell[at] = part_of(u[std::min(at, u.size() - 1)].x);  // vectors may go beyond the last one
    hwy::Prefetch(&first_[cell[at]]);
  }
  for (std::uint32_t& c : cell) {
    c = first_[c];
    hwy::Prefetch(&running_[c]);
  }
  const std::vector<double>& phi = web_->azimuth().nodes();
  const bool one_plane = phi.size() < 2;
  const double* const candela = web_->candelas().data();
  const std::size_t stride = web_->polar().nodes().size(), to_next = one_plane ? 0 : stride;
  Found found[Rows::size];
  for (std::size_t at = 0; at < Rows::size; ++at) {
    found[at] = found_from(cell[at], u[std::min(at, u.size() - 1)].x);
    const double* const corner = candela + found[at].cell.plane * stride + found[at].cell.interval;
    hwy::Prefetch(corner);
    hwy::Prefetch(corner + to_next);
  }
  for (std::size_t at = 0; at < Rows::size; ++at) {
    const Found& f = found[at];
    const Interval& w = interval_[f.cell.interval];
    const std::size_t plane = f.cell.plane;
    const double *const near = candela + plane * stride + f.cell.interval, *const far = near + to_next;
    rows.near_start[at] = near[0];
    rows.near_end[at] = near[1];
    rows.far_start[at] = far[0];
    rows.far_end[at] = far[1];
    rows.beyond[at] = f.beyond;
    rows.of[at] = f.of;
    rows.width[at] = w.width_rad;
    rows.inverse_width[at] = w.inverse_width;
    rows.sine[at] = w.sine;
    rows.cosine[at] = w.cosine;
    rows.end_sine[at] = w.end_sine;
    rows.integral[at] = w.integral;
    rows.first_moment[at] = w.first_moment;
    const double y = u[std::min(at, u.size() - 1)].y * copies_;
    const int copy = std::min(static_cast<int>(y), copies_ - 1);
    const Copy& image = copy_[static_cast<std::size_t>(copy)];
    const double from = one_plane ? 0 : phi[plane], width = one_plane ? 360 : phi[plane + 1] - from;
    rows.across[at] = y - copy;
    rows.from_deg[at] = image.shift_deg + image.sign * from;
    rows.width_deg[at] = image.sign * width;
    rows.polar_sign[at] = image.polar_sign;
  }
}

Status WebSampler::sample(std::span<const Vec2d> u, std::span<Sample> samples) const {
  if (samples.size() != u.size()) return batch_sizes_differ(u.size(), samples.size());
  if (!linear_ || first_.empty()) {
    for (std::size_t i = 0; i < u.size(); ++i) samples[i] = sample(u[i]);
    return Done{};
  }
  Rows rows;
  const double y_sign = web_->frame().clockwise ? -1 : 1;
  for (std::size_t from = 0; from < u.size(); from += Rows::size) {
    const std::size_t count = std::min(Rows::size, u.size() - from);
    look_up(u.subspan(from, count), rows);
    HWY_DYNAMIC_DISPATCH(Draw)(rows, count, web_->type(), last_step);
    for (std::size_t i = 0; i < count; ++i)
      samples[from + i] = rows.done[i] > 0 ? Sample{{rows.x[i], y_sign * rows.y[i], rows.z[i]}, rows.cd[i] * inverse_flux_, rows.cd[i]}
                                           : sample(u[from + i]);
  }
  return Done{};
}

}  // namespace etendue
#endif  // HWY_ONCE
