// A web's table looked up block by block: two arc tangents in vectors, two cells, then the corners of all of a block, copied one by one,
// for which the processor does not wait in turn as it does for the lanes of a gather, and their mean in vectors.
#include "etendue/web_batch.h"

#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photometry/web_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#ifndef ETENDUE_WEB_BATCH_SHARED
#define ETENDUE_WEB_BATCH_SHARED
namespace etendue {

struct WebBatch::Table {
  struct Axis {
    float start = 0, end = 0, cells_per_unit = 0, last_cell = 0;
    bool uniform = false;               // interval and position are those of the cell
    int most_steps = 0;                 // from the interval of a cell's lower end to that of any x in the cell
    std::vector<std::int32_t> first{};  // by cell
    struct Interval {
      float lower, inverse_width, upper;  // the last one has no upper end
    };
    std::vector<Interval> interval{};
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

// Directions that are looked up together.
struct WebBatchBlock {
  static constexpr std::size_t size = 256;
  alignas(64) float polar_deg[size], azimuth_deg[size];
  alignas(64) float other[size];                        // where it is dark or no direction
  alignas(64) std::int32_t is_lit[size];                // -1 or 0
  alignas(64) std::int32_t polar[size], azimuth[size];  // intervals
  alignas(64) float polar_at[size], azimuth_at[size];   // and where in them, 0 to 1
  alignas(64) float near[2 * size], far[2 * size];      // both ends of an interval along two planes
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

// Intervals and positions of `count` angles, a whole number of vectors.
template <class D>
HWY_INLINE void place(D d, const WebBatch::Table::Axis& axis, const float* x, std::size_t count, std::int32_t* interval, float* position) {
  const hn::RebindToSigned<D> di;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto cell = hn::Mul(hn::Sub(hn::Load(d, x + i), hn::Set(d, axis.start)), hn::Set(d, axis.cells_per_unit));
    const auto number = hn::ConvertTo(di, hn::Min(hn::Max(cell, zero), hn::Set(d, axis.last_cell)));
    hn::Store(number, di, interval + i);
    if (axis.uniform) hn::Store(hn::Min(hn::Max(hn::Sub(cell, hn::ConvertTo(d, number)), zero), one), d, position + i);
  }
  if (axis.uniform) return;
  for (std::size_t i = 0; i < count; ++i) {
    auto k = static_cast<std::size_t>(axis.first[static_cast<std::size_t>(interval[i])]);
    for (int step = 0; step < axis.most_steps; ++step) k += x[i] >= axis.interval[k].upper ? 1 : 0;
    const WebBatch::Table::Axis::Interval& w = axis.interval[k];
    interval[i] = static_cast<std::int32_t>(k);
    position[i] = std::min(std::max((x[i] - w.lower) * w.inverse_width, 0.0f), 1.0f);
  }
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

// What is known of N directions before the table is looked up. The number of lanes outside the domain.
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE std::size_t keep(D d, const WebBatch::Table& t, V polar, V azimuth, M valid, float where_none, std::size_t at,
                            WebBatchBlock& block) {
  const hn::RebindToSigned<D> di;
  auto lit = hn::And(valid, hn::And(hn::Ge(polar, hn::Set(d, t.polar.start)), hn::Le(polar, hn::Set(d, t.polar.end))));
  if (t.type != WebType::c)
    lit = hn::And(lit, hn::And(hn::Ge(azimuth, hn::Set(d, t.azimuth.start)), hn::Le(azimuth, hn::Set(d, t.azimuth.end))));
  // No number of theirs leads out of the table.
  hn::Store(hn::IfThenElseZero(lit, polar), d, block.polar_deg + at);
  hn::Store(hn::IfThenElseZero(lit, azimuth), d, block.azimuth_deg + at);
  hn::Store(hn::IfThenElse(valid, hn::Zero(d), hn::Set(d, where_none)), d, block.other + at);
  hn::Store(hn::VecFromMask(di, hn::RebindMask(di, lit)), di, block.is_lit + at);
  return hn::Lanes(d) - hn::CountTrue(d, valid);
}

// The table at all of a block, `count` a whole number of vectors; results over `other`.
template <class D>
HWY_INLINE void look_up(D d, const WebBatch::Table& t, std::size_t count, WebBatchBlock& block) {
  using V = hn::Vec<D>;
  const hn::RebindToSigned<D> di;
  place(d, t.polar, block.polar_deg, count, block.polar, block.polar_at);
  if (!t.one_plane) place(d, t.azimuth, block.azimuth_deg, count, block.azimuth, block.azimuth_at);
  const float* const table = t.candela.data();
  const auto stride = static_cast<std::size_t>(t.stride);
  if (t.one_plane) {
    for (std::size_t i = 0; i < count; ++i) std::memcpy(block.near + 2 * i, table + block.polar[i], 2 * sizeof(float));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      const float* const corner = table + static_cast<std::size_t>(block.azimuth[i]) * stride + static_cast<std::size_t>(block.polar[i]);
      std::memcpy(block.near + 2 * i, corner, 2 * sizeof(float));
      std::memcpy(block.far + 2 * i, corner + stride, 2 * sizeof(float));
    }
  }
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V along = hn::Load(d, block.polar_at + i);
    V start, end;
    hn::LoadInterleaved2(d, block.near + 2 * i, start, end);
    V value = hn::MulAdd(along, hn::Sub(end, start), start);
    if (!t.one_plane) {
      hn::LoadInterleaved2(d, block.far + 2 * i, start, end);
      const V far = hn::MulAdd(along, hn::Sub(end, start), start);
      value = hn::MulAdd(hn::Load(d, block.azimuth_at + i), hn::Sub(far, value), value);
    }
    const auto lit = hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, block.is_lit + i)));
    hn::Store(hn::IfThenElse(lit, value, hn::Load(d, block.other + i)), d, block.other + i);
  }
}

// The number of lanes outside the domain.
template <class D>
HWY_INLINE std::size_t from_vectors(D d, const WebBatch::Table& t, const float* xs, const float* ys, const float* zs, float where_none,
                                    std::size_t at, WebBatchBlock& block) {
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

  return keep(d, t, polar, azimuth, valid, where_none, at, block);
}

template <class D>
HWY_INLINE std::size_t from_angles(D d, const WebBatch::Table& t, const float* cs, const float* gammas, float where_none, std::size_t at,
                                   WebBatchBlock& block) {
  using V = hn::Vec<D>;
  const V c = hn::LoadU(d, cs), gamma = hn::LoadU(d, gammas);
  const auto valid = hn::And(hn::Le(hn::Abs(c), hn::Set(d, 720.0f)), hn::Le(hn::Abs(gamma), hn::Set(d, 720.0f)));
  const V turned = hn::IfThenElseZero(valid, hn::MulSub(c, hn::Set(d, t.y_sign), hn::Set(d, t.turn_deg)));
  return keep(d, t, gamma, folded(d, t, turned), valid, where_none, at, block);
}

// Block by block: first(inputs..., place in the block, block) of whole vectors, then the table. What is left at the end goes through a
// vector of its own, filled up with 1, which is in the domain.
template <std::size_t Inputs, class First>
HWY_INLINE std::size_t over_blocks(const WebBatch::Table& t, const float* const (&in)[Inputs], float* out, std::size_t count, First first) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t without = 0;
  WebBatchBlock block;
  HWY_ALIGN float last[Inputs][hn::MaxLanes(d)];
  const float* at[Inputs];
  for (std::size_t from = 0; from < count; from += WebBatchBlock::size) {
    const std::size_t here = std::min(WebBatchBlock::size, count - from);
    std::size_t i = 0;
    for (; i < here; i += lanes) {
      const bool whole = i + lanes <= here;
      for (std::size_t k = 0; k < Inputs; ++k) {
        at[k] = whole ? in[k] + from + i : last[k];
        if (whole) continue;
        std::fill_n(last[k], lanes, 1.0f);
        std::copy(in[k] + from + i, in[k] + count, last[k]);
      }
      without += first(at, i, block);
    }
    look_up(d, t, i, block);
    std::copy_n(block.other, here, out + from);
  }
  return without;
}

std::size_t Towards(const WebBatch::Table& t, const float* x, const float* y, const float* z, float* cd, std::size_t count,
                    float where_none) {
  const hn::ScalableTag<float> d;
  return over_blocks<3>(t, {x, y, z}, cd, count, [&](const auto& in, std::size_t at, WebBatchBlock& block) {
    return from_vectors(d, t, in[0], in[1], in[2], where_none, at, block);
  });
}
std::size_t At(const WebBatch::Table& t, const float* c, const float* gamma, float* cd, std::size_t count, float where_none) {
  const hn::ScalableTag<float> d;
  return over_blocks<2>(t, {c, gamma}, cd, count, [&](const auto& in, std::size_t at, WebBatchBlock& block) {
    return from_angles(d, t, in[0], in[1], where_none, at, block);
  });
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
    axis.interval.push_back({lower, upper > lower ? 1 / (upper - lower) : 0, upper});
    narrowest = std::min(narrowest, nodes[i + 1] - nodes[i]);
  }
  axis.interval.back().upper = std::numeric_limits<float>::infinity();
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
