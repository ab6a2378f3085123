// Transformed cosines of ltc_table() for lanes of points; for kernels as specular_rect_batch.cpp.
#if defined(ETENDUE_LTC_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_LTC_INL_H
#undef ETENDUE_LTC_INL_H
#else
#define ETENDUE_LTC_INL_H
#endif

#include "etendue/ltc.h"
#include "eval/specular_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
// Four lanes' numbers, four of each a block, as four vectors of one number each.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void transpose_fours(D d, const V* rows, V* terms) {
  const hn::Repartition<std::uint64_t, D> pairs;
  const V low_01 = hn::InterleaveLower(d, rows[0], rows[1]), low_23 = hn::InterleaveLower(d, rows[2], rows[3]);
  const V high_01 = hn::InterleaveUpper(d, rows[0], rows[1]), high_23 = hn::InterleaveUpper(d, rows[2], rows[3]);
  const auto lower = [&](V a, V b) ETENDUE_INLINE_LAMBDA {
    return hn::BitCast(d, hn::InterleaveLower(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
  };
  const auto upper = [&](V a, V b) ETENDUE_INLINE_LAMBDA {
    return hn::BitCast(d, hn::InterleaveUpper(pairs, hn::BitCast(pairs, a), hn::BitCast(pairs, b)));
  };
  terms[0] = lower(low_01, low_23), terms[1] = upper(low_01, low_23), terms[2] = lower(high_01, high_23),
  terms[3] = upper(high_01, high_23);
}
// row(numbers of a lane from `first` on, as many as the tag has), of each lane eight, as vectors of one number each.
template <class Row>
HWY_INLINE void transpose_eights(Row row, Lanes* terms) {
  const Floats d;
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  if constexpr (lanes == 4) {
    each<2>([&](auto part) ETENDUE_INLINE_LAMBDA {
      std::array<Lanes, 4> rows;
      each<4>([&](auto lane) ETENDUE_INLINE_LAMBDA { rows[lane] = row(d, lane, 4 * part); });
      transpose_fours(d, rows.data(), terms + 4 * part);
    });
  } else {
    // Blocks of four: of the lanes 0 to 3 (and 8 to 11) the numbers 0 to 3 beside 4 to 7, and the same of the next four lanes.
    std::array<Lanes, 8> rows, blocks;
    each<8>([&](auto lane) ETENDUE_INLINE_LAMBDA {
      if constexpr (lanes == 8) {
        rows[lane] = row(d, lane, 0);
      } else {
        const hn::Half<Floats> half;
        rows[lane] = hn::Combine(d, row(half, lane + 8, 0), row(half, lane, 0));
      }
    });
    transpose_fours(d, rows.data(), blocks.data());
    transpose_fours(d, rows.data() + 4, blocks.data() + 4);
    each<4>([&](auto k) ETENDUE_INLINE_LAMBDA {
      terms[k] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(blocks[k + 4]), blocks[k]);
      terms[k + 4] = hn::OddEvenBlocks(blocks[k + 4], hn::SwapAdjacentBlocks(blocks[k]));
    });
  }
}
#endif
// 8 `eights` numbers between nodes that have that many. A lane's numbers lie side by side in the table: they are read and mixed as they
// are, and then turned to vectors of one number each.
template <std::size_t eights>
HWY_INLINE std::array<Lanes, 8 * eights> between_nodes(const float* nodes, std::size_t size, Lanes alpha, Lanes cosine) {
  const Floats d;
  const hn::RebindToSigned<Floats> integers;
  constexpr std::size_t most = hn::MaxLanes(Floats()), node = 8 * eights;
  const std::size_t row = node * size;
  const Lanes last = hn::Set(d, static_cast<float>(size - 1)), least = hn::Set(d, static_cast<float>(size - 2));
  const Lanes x = hn::Mul(hn::Min(positive(cosine), number(1)), last), y = hn::Mul(hn::Sqrt(alpha), last);
  const Lanes i = hn::Min(hn::Floor(x), least), j = hn::Min(hn::Floor(y), least);
  HWY_ALIGN std::array<std::int32_t, most> at;
  HWY_ALIGN std::array<float, most> u, v;
  const Lanes place = hn::MulAdd(j, hn::Set(d, static_cast<float>(row)), hn::Mul(i, number(static_cast<float>(node))));
  hn::Store(hn::ConvertTo(integers, place), integers, at.data());
  hn::Store(hn::Sub(x, i), d, u.data());
  hn::Store(hn::Sub(y, j), d, v.data());
  std::array<Lanes, 8 * eights> terms{};
#if HWY_TARGET == HWY_SCALAR
  const float* from = nodes + at[0];
  const auto mix = [](float a, float b, float share) { return a + (b - a) * share; };
  each<8 * eights>([&](auto k) ETENDUE_INLINE_LAMBDA {
    terms[k] = number(mix(mix(from[k], from[node + k], u[0]), mix(from[row + k], from[row + node + k], u[0]), v[0]));
  });
#else
  each<eights>([&](auto eight) ETENDUE_INLINE_LAMBDA {
    const auto mixed = [&](auto tag, std::size_t lane, std::size_t first) ETENDUE_INLINE_LAMBDA {
      const float* corner = nodes + at[lane] + 8 * eight + first;
      const auto across = hn::Set(tag, u[lane]), up = hn::Set(tag, v[lane]);
      const auto a = hn::LoadU(tag, corner), b = hn::LoadU(tag, corner + node);
      const auto c = hn::LoadU(tag, corner + row), e = hn::LoadU(tag, corner + row + node);
      const auto lower = hn::MulAdd(hn::Sub(b, a), across, a), upper = hn::MulAdd(hn::Sub(e, c), across, c);
      return hn::MulAdd(hn::Sub(upper, lower), up, lower);
    };
    transpose_eights(mixed, terms.data() + 8 * eight);
  });
#endif
  return terms;
}

// TransformedCosine: rows of the inverse in x and z, and the factor on y.
struct Cosines {
  Lanes xx, xz, yy, zx, zz;
  Vector3 operator()(const Vector3& v) const {
    return {hn::MulAdd(xx, v.x, hn::Mul(xz, v.z)), hn::Mul(yy, v.y), hn::MulAdd(zx, v.x, hn::Mul(zz, v.z))};
  }
  Lanes share_above() const {
    const Lanes squared = hn::MulAdd(xx, xx, hn::Mul(zx, zx));
    return hn::MulAdd(hn::Mul(number(0.5f), xx), inverse_sqrt(Floats(), squared), number(0.5f));
  }
};
HWY_INLINE Cosines transformed_cosine(const Lanes* t, Lanes alpha, const ViewFrame& view) {
  return {hn::MulSub(view.cosine, t[0], hn::Mul(view.sine, t[1])), hn::MulAdd(view.sine, t[0], hn::Mul(view.cosine, t[1])),
          inverse(Floats(), t[2]), hn::Mul(alpha, hn::MulSub(view.cosine, t[3], hn::Mul(view.sine, t[4]))),
          hn::Mul(alpha, hn::MulAdd(view.sine, t[3], hn::Mul(view.cosine, t[4])))};
}

// Lambert's sum, twice.
template <std::size_t N>
HWY_INLINE Lanes lambert_sum(const Outline<N>& s) {
  Lanes sum = number(0);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Vector3 step = s.to[i] - s.from[i];
    const Lanes turn = hn::MulSub(s.from[i].x, step.y, hn::Mul(s.from[i].y, step.x));
    sum = hn::Add(sum, hn::IfThenElseZero(s.seen[i], hn::MulAdd(turn, over_sine_less_one(s.from[i], step), turn)));
  });
  return positive(sum);
}
template <std::size_t N>
HWY_INLINE Outline<N> seen_by(const Cosines& cosines, const Outline<N>& light) {
  Outline<N> seen = light;
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA { seen.from[i] = unit(cosines(light.from[i])), seen.to[i] = unit(cosines(light.to[i])); });
  return seen;
}
// The share of the cosine above the horizon that the light covers.
template <std::size_t N>
HWY_INLINE Lanes covered(const Cosines& cosines, const Outline<N>& light) {
  const Outline<N> seen = seen_by(cosines, light);
  const Lanes sum = hn::AllTrue(Floats(), all_above(seen)) ? lambert_sum(seen) : lambert_sum(clipped(seen));
  const Lanes over = inverse(Floats(), hn::Mul(number(static_cast<float>(2 * pi)), cosines.share_above()));
  return hn::Min(hn::Mul(sum, over), number(1));
}

// theta / sin(theta) - 1 of unit vectors, `step` from one to the other, within 2e-5 up to a right angle. Beyond it is that of pi - theta
// and pi / sin(theta), sin^2 = t (2 - t) with t = 1 - cos(theta) as long as it has digits.
HWY_INLINE Lanes near_over_sine_less_one(const Vector3& from, const Vector3& step) {
  const Floats d;
  const Lanes two = number(2), t = hn::Mul(number(0.5f), dot(step, step)), rest = hn::Sub(two, t), acute = hn::Min(t, rest);
  const Lanes f =
      hn::Mul(acute, polynomial(d, acute, std::array{0.333326172, 0.133845539, 0.0513712322, 0.0483152592, -0.0270476573, 0.0309720657}));
  Lanes sine2 = hn::Mul(t, rest);
  const Lit opposite = hn::Lt(rest, number(1e-3f));
  if (HWY_UNLIKELY(!hn::AllFalse(d, opposite))) {
    const Vector3 across = cross(from, step);
    sine2 = hn::IfThenElse(opposite, dot(across, across), sine2);
  }
  const Lanes over_sine = inverse_sqrt(d, hn::Max(sine2, number(1e-20f)));
  return hn::IfThenElse(hn::Gt(t, number(1)), hn::Sub(hn::MulSub(number(static_cast<float>(pi)), over_sine, f), two), f);
}
// Twice the integral of the directions that the light covers of the cosine, whatever is below its horizon.
template <std::size_t N>
HWY_INLINE Vector3 twice_irradiance(const Outline<N>& seen) {
  const Lanes zero = number(0);
  Vector3 sum{zero, zero, zero};
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Vector3 step = seen.to[i] - seen.from[i];
    const Lanes factor = hn::Add(near_over_sine_less_one(seen.from[i], step), number(1));
    sum = along(sum, cross(seen.from[i], step), hn::IfThenElseZero(seen.seen[i], factor));
  });
  return sum;
}
// The share that the surface's horizon alone cuts, what is below the cosine's own counted as negative, and what leads to the light there.
struct UncutShare {
  Lanes share;
  Vector3 towards;
};
HWY_INLINE Lanes share_of(const Cosines& cosines, Lanes twice) {
  return saturate(hn::Mul(twice, inverse(Floats(), hn::Mul(number(static_cast<float>(2 * pi)), cosines.share_above()))));
}

// Fresnel's term at the direction that goes to `there` in the cosine's space.
HWY_INLINE Shares with_weight_towards(const Vector3& there, const Cosines& m, const ViewFrame& view, Lanes lit) {
  const Floats d;
  const Lanes one = number(1), half = number(0.5f), det = hn::MulSub(m.xx, m.zz, hn::Mul(m.xz, m.zx));
  const Vector3 light{hn::MulSub(m.zz, there.x, hn::Mul(m.xz, there.z)), hn::Mul(hn::Mul(there.y, det), inverse(d, m.yy)),
                      hn::MulSub(m.xx, there.z, hn::Mul(m.zx, there.x))};
  const Lanes over = inverse_sqrt(d, hn::Max(dot(light, light), number(1e-30f)));
  const Lanes between = hn::Mul(hn::MulAdd(view.sine, light.x, hn::Mul(view.cosine, light.z)), over);
  const Lanes rest = hn::Sub(one, hn::Sqrt(saturate(hn::MulAdd(half, between, half)))), rest2 = hn::Mul(rest, rest);
  const Lanes weighed = hn::Mul(lit, hn::Mul(rest, hn::Mul(rest2, rest2)));
  return {hn::Sub(lit, weighed), weighed};
}

// `ltc` and, with two cosines for both parts that Schlick's weight makes of the lobe, `ltc-two-lobes` and what is like it.
// covered(cosines): the share of the light of one of them.
template <bool two>
HWY_INLINE Shares by_cosines(const LtcNodes& nodes, const ViewFrame& view, Lanes alpha, const auto& covered) {
  if constexpr (two) {
    constexpr std::size_t first = LtcNodes::of_first, second = LtcNodes::of_second;
    const auto terms = between_nodes<2>(nodes.pair, nodes.size, alpha, view.cosine);
    const Lanes a = covered(transformed_cosine(terms.data(), alpha, view));
    const Lanes b = covered(transformed_cosine(terms.data() + LtcNodes::second, alpha, view));
    const auto of_part = [&](std::size_t part) ETENDUE_INLINE_LAMBDA {
      const Lanes of_a = terms[first + part], of_b = terms[second + part];
      return hn::Min(positive(hn::MulAdd(of_a, a, hn::Mul(of_b, b))), hn::Add(of_a, of_b));
    };
    return {of_part(0), of_part(1)};
  } else {
    const auto terms = between_nodes<1>(nodes.whole, nodes.size, alpha, view.cosine);
    const Lanes share = covered(transformed_cosine(terms.data(), alpha, view));
    return {hn::Mul(terms[LtcNodes::albedo], share), hn::Mul(terms[LtcNodes::albedo + 1], share)};
  }
}
template <bool two>
struct ThroughTable {
  static constexpr bool in_units = false;
  LtcNodes nodes;
  template <std::size_t N>
  HWY_INLINE Shares operator()(const ViewFrame& view, Lanes alpha, const Outline<N>& light) const {
    return by_cosines<two>(nodes, view, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA { return covered(cosines, light); });
  }
};
// covered(cosines): a share, and what leads `towards` the light in the cosine's space.
HWY_INLINE Shares by_one_cosine(const LtcNodes& nodes, const ViewFrame& view, Lanes alpha, const auto& covered) {
  const auto terms = between_nodes<1>(nodes.one, nodes.size, alpha, view.cosine);
  const Cosines cosines = transformed_cosine(terms.data(), alpha, view);
  const auto found = covered(cosines);
  const Lanes albedo = hn::Add(terms[LtcNodes::albedo], terms[LtcNodes::albedo + 1]);
  return with_weight_towards(found.towards, cosines, view, hn::Mul(albedo, found.share));
}
struct ByOneCosine {
  static constexpr bool in_units = false;
  LtcNodes nodes;
  template <std::size_t N>
  HWY_INLINE Shares operator()(const ViewFrame& view, Lanes alpha, const Outline<N>& light) const {
    return by_one_cosine(nodes, view, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA {
      const Vector3 twice = twice_irradiance(seen_by(cosines, light));
      return UncutShare{share_of(cosines, twice.z), twice};
    });
  }
};
struct ByTwoCosines {
  static constexpr bool in_units = false;
  LtcNodes nodes;
  template <std::size_t N>
  HWY_INLINE Shares operator()(const ViewFrame& view, Lanes alpha, const Outline<N>& light) const {
    return by_cosines<true>(nodes, view, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA {
      return share_of(cosines, twice_irradiance(seen_by(cosines, light)).z);
    });
  }
};

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
