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

// 4 `groups` numbers of LtcTable::Node from one on, between nodes. A lane's numbers lie side by side in the table: they are read and mixed
// four at a time, and then turned to vectors of one number each.
template <std::size_t groups>
HWY_INLINE std::array<Lanes, 4 * groups> between_nodes(const LtcNodes& nodes, std::size_t first, Lanes alpha, Lanes cosine) {
  const Floats d;
  const hn::RebindToSigned<Floats> integers;
  constexpr std::size_t most = hn::MaxLanes(Floats()), node = LtcTable::terms;
  const std::size_t row = node * nodes.size;
  const Lanes last = hn::Set(d, static_cast<float>(nodes.size - 1)), least = hn::Set(d, static_cast<float>(nodes.size - 2));
  const Lanes x = hn::Mul(hn::Min(positive(cosine), number(1)), last), y = hn::Mul(hn::Sqrt(alpha), last);
  const Lanes i = hn::Min(hn::Floor(x), least), j = hn::Min(hn::Floor(y), least);
  HWY_ALIGN std::array<std::int32_t, most> at;
  HWY_ALIGN std::array<float, most> u, v;
  hn::Store(hn::ConvertTo(integers, hn::MulAdd(j, hn::Set(d, static_cast<float>(row)), hn::Mul(i, number(node)))), integers, at.data());
  hn::Store(hn::Sub(x, i), d, u.data());
  hn::Store(hn::Sub(y, j), d, v.data());
  std::array<Lanes, 4 * groups> terms{};
#if HWY_TARGET == HWY_SCALAR
  const float* from = nodes.first + first + at[0];
  const auto mix = [](float a, float b, float share) { return a + (b - a) * share; };
  each<4 * groups>([&](auto k) ETENDUE_INLINE_LAMBDA {
    terms[k] = number(mix(mix(from[k], from[node + k], u[0]), mix(from[row + k], from[row + node + k], u[0]), v[0]));
  });
#else
  const hn::FixedTag<float, 4> four;
  using Four = hn::Vec<decltype(four)>;
  HWY_ALIGN std::array<std::array<float, 4 * most>, groups> mixed;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    const float* from = nodes.first + first + at[lane];
    const Four across = hn::Set(four, u[lane]), up = hn::Set(four, v[lane]);
    each<groups>([&](auto g) ETENDUE_INLINE_LAMBDA {
      const Four a = hn::LoadU(four, from + 4 * g), b = hn::LoadU(four, from + node + 4 * g);
      const Four c = hn::LoadU(four, from + row + 4 * g), e = hn::LoadU(four, from + row + node + 4 * g);
      const Four lower = hn::MulAdd(hn::Sub(b, a), across, a), upper = hn::MulAdd(hn::Sub(e, c), across, c);
      hn::Store(hn::MulAdd(hn::Sub(upper, lower), up, lower), four, mixed[g].data() + 4 * lane);
    });
  }
  each<groups>([&](auto g) ETENDUE_INLINE_LAMBDA {
    hn::LoadInterleaved4(d, mixed[g].data(), terms[4 * g], terms[4 * g + 1], terms[4 * g + 2], terms[4 * g + 3]);
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
// The share of the cosine above the horizon that the light covers.
template <std::size_t N>
HWY_INLINE Lanes covered(const Cosines& cosines, const Outline<N>& light) {
  Outline<N> seen = light;
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA { seen.from[i] = unit(cosines(light.from[i])), seen.to[i] = unit(cosines(light.to[i])); });
  const Lanes sum = hn::AllTrue(Floats(), all_above(seen)) ? lambert_sum(seen) : lambert_sum(clipped(seen));
  const Lanes over = inverse(Floats(), hn::Mul(number(static_cast<float>(2 * pi)), cosines.share_above()));
  return hn::Min(hn::Mul(sum, over), number(1));
}

// `ltc` and, with a cosine each for both parts that Schlick's weight makes of the lobe, `ltc-two-lobes`.
// covered(cosines): the share of the light of one of them.
template <bool two_lobes>
HWY_INLINE Shares by_cosines(const LtcNodes& nodes, const ViewFrame& view, Lanes alpha, const auto& covered) {
  constexpr std::size_t f0 = LtcTable::albedo, first = two_lobes ? f0 : 0;
  const auto terms = between_nodes < two_lobes ? 3 : 2 > (nodes, first, alpha, view.cosine);
  const auto share = [&](std::size_t from)
                         ETENDUE_INLINE_LAMBDA { return covered(transformed_cosine(terms.data() + (from - first), alpha, view)); };
  const Lanes of_f0 = share(two_lobes ? LtcTable::steep : 0), of_f90 = two_lobes ? share(LtcTable::grazing) : of_f0;
  return {hn::Mul(terms[f0 - first], of_f0), hn::Mul(terms[f0 + 1 - first], of_f90)};
}
template <bool two_lobes>
struct ThroughTable {
  LtcNodes nodes;
  template <std::size_t N>
  HWY_INLINE Shares operator()(const ViewFrame& view, Lanes alpha, const Outline<N>& light) const {
    return by_cosines<two_lobes>(nodes, view, alpha, [&](const Cosines& cosines) ETENDUE_INLINE_LAMBDA { return covered(cosines, light); });
  }
};

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
