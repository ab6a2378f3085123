// A web's table looked up in vectors: two arc tangents, two cells, four gathers.
#include "etendue/web_batch.h"

#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photometry/web_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#ifndef ETENDUE_WEB_BATCH_SHARED
#define ETENDUE_WEB_BATCH_SHARED
namespace etendue {

struct WebBatch::Table {
  struct Axis {
    float start = 0, end = 0, cells_per_unit = 0, last_cell = 0;
    bool uniform = false;                                  // interval and position are those of the cell
    int most_steps = 0;                                    // from the interval of a cell's lower end to that of any x in the cell
    std::vector<std::int32_t> first{};                     // by cell
    std::vector<float> lower{}, inverse_width{}, upper{};  // by interval; the last one has no upper end
  };
  WebType type = WebType::c;
  float y_sign = 1, turn_deg = 0;
  float half_deg = 0, quarter_deg = 0;                // type C: beyond which a mirror folds, from the first plane
  bool mirror_polar = false, mirror_azimuth = false;  // types A and B
  bool one_plane = false;
  Axis polar{}, azimuth{};
  std::int32_t stride = 0;       // polar angles
  std::vector<float> candela{};  // polar angle fastest
};

}  // namespace etendue
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// atan2(y, x) in degrees; 0 for (0, 0). As photometry/angle.h, with a polynomial of degree 5 in q^2 (interpolated in Chebyshev's nodes)
// that is within a relative 1.3e-9 of atan(q) / q.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan2_deg(D d, V y, V x) {
  const V ax = hn::Abs(x), ay = hn::Abs(y), longer = hn::Max(ax, ay), shorter = hn::Min(ax, ay), zero = hn::Zero(d);
  const auto far = hn::Gt(shorter, hn::Mul(hn::Set(d, 0.41421356f), longer));
  const V numerator = hn::Sub(shorter, hn::IfThenElseZero(far, longer)), denominator = hn::Add(longer, hn::IfThenElseZero(far, shorter));
  const V q = hn::IfThenElseZero(hn::Gt(denominator, zero), hn::Div(numerator, denominator)), z = hn::Mul(q, q);
  V p = hn::Set(d, -0.060263049f);
  p = hn::MulAdd(p, z, hn::Set(d, 0.10569829f));
  p = hn::MulAdd(p, z, hn::Set(d, -0.14239533f));
  p = hn::MulAdd(p, z, hn::Set(d, 0.19998182f));
  p = hn::MulAdd(p, z, hn::Set(d, -0.33333308f));
  p = hn::MulAdd(p, z, hn::Set(d, 1.0f));
  const V octant = hn::MulAdd(hn::Mul(p, q), hn::Set(d, 57.295780f), hn::IfThenElseZero(far, hn::Set(d, 45.0f)));
  const V quadrant = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 90.0f), octant), octant);
  const V half = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(d, 180.0f), quadrant), quadrant);
  return hn::IfThenElse(hn::Lt(y, zero), hn::Neg(half), half);
}

template <class V, class I>
struct Place {
  I interval;
  V position;
};
template <class D, class V = hn::Vec<D>, class I = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE Place<V, I> place(D d, const WebBatch::Table::Axis& axis, V x) {
  const hn::RebindToSigned<D> di;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V cell = hn::Mul(hn::Sub(x, hn::Set(d, axis.start)), hn::Set(d, axis.cells_per_unit));
  const I number = hn::ConvertTo(di, hn::Min(hn::Max(cell, zero), hn::Set(d, axis.last_cell)));
  if (axis.uniform) return {number, hn::Min(hn::Max(hn::Sub(cell, hn::ConvertTo(d, number)), zero), one)};
  I i = hn::GatherIndex(di, axis.first.data(), number);
  for (int k = 0; k < axis.most_steps; ++k) {
    const auto beyond = hn::Ge(x, hn::GatherIndex(d, axis.upper.data(), i));
    i = hn::Sub(i, hn::VecFromMask(di, hn::RebindMask(di, beyond)));  // a true mask is -1
  }
  const V position = hn::Mul(hn::Sub(x, hn::GatherIndex(d, axis.lower.data(), i)), hn::GatherIndex(d, axis.inverse_width.data(), i));
  return {i, hn::Min(hn::Max(position, zero), one)};
}

// From the azimuth of type C, turned already, into the table's: `past` its first plane, mirrored.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V folded(D d, const WebBatch::Table& t, V azimuth) {
  V past = hn::Sub(azimuth, hn::Set(d, t.azimuth.start));
  past = hn::NegMulAdd(hn::Floor(hn::Mul(past, hn::Set(d, 1.0f / 360))), hn::Set(d, 360.0f), past);
  past = hn::IfThenElse(hn::Gt(past, hn::Set(d, t.half_deg)), hn::Sub(hn::Set(d, 360.0f), past), past);
  past = hn::IfThenElse(hn::Gt(past, hn::Set(d, t.quarter_deg)), hn::Sub(hn::Set(d, 180.0f), past), past);
  return hn::Add(past, hn::Set(d, t.azimuth.start));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V candelas(D d, const WebBatch::Table& t, V polar, V azimuth) {
  const hn::RebindToSigned<D> di;
  auto lit = hn::And(hn::Ge(polar, hn::Set(d, t.polar.start)), hn::Le(polar, hn::Set(d, t.polar.end)));
  const auto p = place(d, t.polar, polar);
  const float* const table = t.candela.data();
  const auto one = hn::Set(di, 1);
  if (t.one_plane) {
    const V near = hn::GatherIndex(d, table, p.interval), far = hn::GatherIndex(d, table, hn::Add(p.interval, one));
    return hn::IfThenElseZero(lit, hn::MulAdd(p.position, hn::Sub(far, near), near));
  }
  if (t.type != WebType::c)
    lit = hn::And(lit, hn::And(hn::Ge(azimuth, hn::Set(d, t.azimuth.start)), hn::Le(azimuth, hn::Set(d, t.azimuth.end))));
  const auto a = place(d, t.azimuth, azimuth);
  const auto first = hn::Add(hn::Mul(a.interval, hn::Set(di, t.stride)), p.interval), second = hn::Add(first, hn::Set(di, t.stride));
  const V y0 = hn::GatherIndex(d, table, first), y1 = hn::GatherIndex(d, table, hn::Add(first, one));
  const V z0 = hn::GatherIndex(d, table, second), z1 = hn::GatherIndex(d, table, hn::Add(second, one));
  const V near = hn::MulAdd(p.position, hn::Sub(y1, y0), y0), far = hn::MulAdd(p.position, hn::Sub(z1, z0), z0);
  return hn::IfThenElseZero(lit, hn::MulAdd(a.position, hn::Sub(far, near), near));
}

// The number of lanes outside the domain.
template <class D>
HWY_INLINE std::size_t lookup(D d, const WebBatch::Table& t, const float* xs, const float* ys, const float* zs, float* cd,
                              float where_none) {
  using V = hn::Vec<D>;
  const V x = hn::LoadU(d, xs), y = hn::Mul(hn::LoadU(d, ys), hn::Set(d, t.y_sign)), z = hn::LoadU(d, zs), minus_z = hn::Neg(z);
  const V xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
  // From the longest component, whose square may leave the range of a float.
  const V largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z)), sum = hn::Add(hn::Add(xx, yy), zz);
  const auto valid = hn::And(hn::And(hn::Ge(largest, hn::Set(d, 5e-7f)), hn::Le(largest, hn::Set(d, 1e15f))), hn::Eq(sum, sum));

  V polar, azimuth;
  if (t.type == WebType::c) {
    polar = atan2_deg(d, hn::Sqrt(hn::Add(xx, yy)), minus_z);
    azimuth = hn::Sub(atan2_deg(d, y, x), hn::Set(d, t.turn_deg));
    if (!t.one_plane) azimuth = folded(d, t, azimuth);
  } else {
    const V ninety = hn::Set(d, 90.0f);
    if (t.type == WebType::a) {
      polar = hn::Add(ninety, atan2_deg(d, x, hn::Sqrt(hn::Add(yy, zz))));
      azimuth = atan2_deg(d, y, minus_z);
    } else {
      polar = hn::Add(ninety, atan2_deg(d, y, hn::Sqrt(hn::Add(xx, zz))));
      azimuth = atan2_deg(d, x, minus_z);
    }
    if (t.mirror_azimuth) azimuth = hn::Abs(azimuth);
    if (t.mirror_polar) polar = hn::Max(polar, hn::Sub(hn::Set(d, 180.0f), polar));
  }

  hn::StoreU(hn::IfThenElse(valid, candelas(d, t, polar, azimuth), hn::Set(d, where_none)), d, cd);
  return hn::Lanes(d) - hn::CountTrue(d, valid);
}

template <class D>
HWY_INLINE std::size_t lookup(D d, const WebBatch::Table& t, const float* cs, const float* gammas, float* cd, float where_none) {
  using V = hn::Vec<D>;
  const V c = hn::LoadU(d, cs), gamma = hn::LoadU(d, gammas);
  const auto valid = hn::And(hn::Le(hn::Abs(c), hn::Set(d, 720.0f)), hn::Le(hn::Abs(gamma), hn::Set(d, 720.0f)));
  const V turned = hn::IfThenElseZero(valid, hn::MulSub(c, hn::Set(d, t.y_sign), hn::Set(d, t.turn_deg)));
  hn::StoreU(hn::IfThenElse(valid, candelas(d, t, gamma, folded(d, t, turned)), hn::Set(d, where_none)), d, cd);
  return hn::Lanes(d) - hn::CountTrue(d, valid);
}

// body(inputs..., out), each of whole vectors; what is left at the end through vectors of its own, filled up with 1, which is in the
// domain.
template <std::size_t Inputs, class Body>
HWY_INLINE std::size_t over_vectors(const float* const (&in)[Inputs], float* out, std::size_t count, Body body) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t without = 0, i = 0;
  const float* at[Inputs];
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t k = 0; k < Inputs; ++k) at[k] = in[k] + i;
    without += body(at, out + i);
  }
  if (i == count) return without;
  HWY_ALIGN float last[Inputs + 1][hn::MaxLanes(d)];
  for (std::size_t k = 0; k < Inputs; ++k) {
    std::fill_n(last[k], lanes, 1.0f);
    std::copy(in[k] + i, in[k] + count, last[k]);
    at[k] = last[k];
  }
  without += body(at, last[Inputs]);
  std::copy_n(last[Inputs], count - i, out + i);
  return without;
}

std::size_t Towards(const WebBatch::Table& t, const float* x, const float* y, const float* z, float* cd, std::size_t count,
                    float where_none) {
  const hn::ScalableTag<float> d;
  return over_vectors<3>({x, y, z}, cd, count,
                         [&](const auto& in, float* out) { return lookup(d, t, in[0], in[1], in[2], out, where_none); });
}
std::size_t At(const WebBatch::Table& t, const float* c, const float* gamma, float* cd, std::size_t count, float where_none) {
  const hn::ScalableTag<float> d;
  return over_vectors<2>({c, gamma}, cd, count, [&](const auto& in, float* out) { return lookup(d, t, in[0], in[1], out, where_none); });
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(Towards);
HWY_EXPORT(At);

// As AngleAxis, in float: nodes that round to the same float leave an interval of no width, in which the position is 0.
WebBatch::Table::Axis axis_of(const AngleAxis& from) {
  const std::vector<double>& nodes = from.nodes();
  WebBatch::Table::Axis axis;
  if (nodes.empty()) return axis;
  axis.start = static_cast<float>(nodes.front());
  axis.end = static_cast<float>(nodes.back());
  if (nodes.size() < 2) return axis;
  const std::size_t intervals = nodes.size() - 1;
  const double range = nodes.back() - nodes.front();
  axis.uniform = from.uniform();
  double narrowest = range;
  for (std::size_t i = 0; i < intervals; ++i) {
    const auto lower = static_cast<float>(nodes[i]), upper = static_cast<float>(nodes[i + 1]);
    axis.lower.push_back(lower);
    axis.upper.push_back(upper);
    axis.inverse_width.push_back(upper > lower ? 1 / (upper - lower) : 0);
    narrowest = std::min(narrowest, nodes[i + 1] - nodes[i]);
  }
  axis.upper.back() = std::numeric_limits<float>::infinity();
  const double most_cells = 8 * static_cast<double>(intervals);
  const auto cells = axis.uniform ? intervals : static_cast<std::size_t>(std::clamp(std::ceil(range / narrowest), 1.0, most_cells));
  axis.cells_per_unit = static_cast<float>(static_cast<double>(cells) / range);
  axis.last_cell = static_cast<float>(cells - 1);
  // An angle within rounding of a cell's border may fall into the cell beside it.
  constexpr double rounding_deg = 1e-4;
  const auto interval_at = [&](double x) {
    std::size_t i = 0;
    while (i + 1 < intervals && nodes[i + 1] <= x) ++i;
    return static_cast<std::int32_t>(i);
  };
  const double width = range / static_cast<double>(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double lower = nodes.front() + static_cast<double>(cell) * width;
    axis.first.push_back(interval_at(lower - rounding_deg));
    axis.most_steps = std::max(axis.most_steps, interval_at(lower + width + rounding_deg) - axis.first.back());
  }
  return axis;
}

bool mirrors_latitude(WebType type, WebSymmetry s) {
  return s == WebSymmetry::lateral_and_vertical || s == (type == WebType::a ? WebSymmetry::vertical : WebSymmetry::lateral);
}
bool mirrors_longitude(WebType type, WebSymmetry s) {
  return s == WebSymmetry::lateral_and_vertical || s == (type == WebType::a ? WebSymmetry::lateral : WebSymmetry::vertical);
}

}  // namespace

WebBatch::WebBatch(const IntensityWeb& web) : web_(&web) {
  const std::size_t planes = std::max<std::size_t>(web.azimuth().nodes().size(), 1), stride = web.polar().nodes().size();
  if (web.interpolation() != Interpolation::linear || planes * stride > std::numeric_limits<std::int32_t>::max()) return;
  constexpr float never = std::numeric_limits<float>::infinity();
  const WebType type = web.type();
  auto table = std::make_shared<Table>();
  table->type = type;
  table->y_sign = web.frame().clockwise ? -1.0f : 1.0f;
  table->turn_deg = static_cast<float>(web.frame().turn_deg);
  table->half_deg = type == WebType::c && web.copies() > 1 ? 180 : never;
  table->quarter_deg = web.symmetry() == WebSymmetry::quadrant ? 90 : never;
  table->mirror_polar = type != WebType::c && mirrors_latitude(type, web.symmetry());
  table->mirror_azimuth = type != WebType::c && mirrors_longitude(type, web.symmetry());
  table->one_plane = planes == 1;
  table->polar = axis_of(web.polar());
  table->azimuth = axis_of(web.azimuth());
  table->stride = static_cast<std::int32_t>(stride);
  table->candela.reserve(planes * stride);
  for (std::size_t j = 0; j < planes; ++j)
    for (std::size_t i = 0; i < stride; ++i) table->candela.push_back(static_cast<float>(web.node(j, i)));
  table_ = std::move(table);
}

BatchOutcome WebBatch::towards(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::span<float> cd,
                               float where_none) const {
  for (const std::size_t size : {y.size(), z.size(), cd.size()})
    if (size != x.size()) return batch_sizes_differ(x.size(), size);
  if (table_) return HWY_DYNAMIC_DISPATCH(Towards)(*table_, x.data(), y.data(), z.data(), cd.data(), x.size(), where_none);
  std::size_t without = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float largest = std::max({std::abs(x[i]), std::abs(y[i]), std::abs(z[i])});
    const bool valid = largest >= 5e-7f && largest <= 1e15f && !std::isnan(x[i] + y[i] + z[i]);
    cd[i] = valid ? static_cast<float>(web_->towards({x[i], y[i], z[i]})) : where_none;
    without += valid ? 0 : 1;
  }
  return without;
}

BatchOutcome WebBatch::at(std::span<const float> c_deg, std::span<const float> gamma_deg, std::span<float> cd, float where_none) const {
  for (const std::size_t size : {gamma_deg.size(), cd.size()})
    if (size != c_deg.size()) return batch_sizes_differ(c_deg.size(), size);
  if (table_ && table_->type == WebType::c)
    return HWY_DYNAMIC_DISPATCH(At)(*table_, c_deg.data(), gamma_deg.data(), cd.data(), c_deg.size(), where_none);
  std::size_t without = 0;
  for (std::size_t i = 0; i < c_deg.size(); ++i) {
    const bool valid = std::abs(c_deg[i]) <= 720 && std::abs(gamma_deg[i]) <= 720;
    cd[i] = valid ? static_cast<float>(web_->at(c_deg[i], gamma_deg[i])) : where_none;
    without += valid ? 0 : 1;
  }
  return without;
}

}  // namespace etendue
#endif  // HWY_ONCE
