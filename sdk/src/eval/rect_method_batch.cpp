// Methods for rectangles at many points: the published ones as their sources state them, and rules of ours.
#include "method_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/rect_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/method_batch-inl.h"
#include "eval/rect_rules-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// ---- As the published methods see it: views.h in vectors ----

struct Seen {
  Vector3 centre, x, y, normal, n;
  Lanes half_x, half_y, height;
  std::array<Vector3, 4> corners;

  HWY_INLINE Seen(const FlatRect& light, const Vector3& position, const Vector3& surface)
      : centre(numbers(light.centre) - position),
        x(numbers(light.x)),
        y(numbers(light.y)),
        normal(numbers(light.normal)),
        n(surface),
        half_x(number(light.half_x)),
        half_y(number(light.half_y)),
        height(hn::Neg(dot(centre, normal))) {
    const Vector3 hx = scaled(x, half_x), hy = scaled(y, half_y), low = centre - hx, high = centre + hx;
    corners = {low - hy, low + hy, high + hy, high - hy};
  }
  HWY_INLINE Vector3 closest(const Vector3& p) const {
    const Vector3 from = p - centre;
    return along(along(centre, x, within(dot(from, x), half_x)), y, within(dot(from, y), half_y));
  }
};

HWY_INLINE Lanes sum_of_cosines(const Seen& s) {
  Lanes sum = cosine_towards(s.centre, s.n);
  for (const Vector3& p : s.corners) sum = hn::Add(sum, cosine_towards(p, s.n));
  return sum;
}
HWY_INLINE Lanes solid_angle_printed(const Seen& s) {
  std::array<Vector3, 4> planes{s.centre, s.centre, s.centre, s.centre};
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { planes[i] = unit(cross(s.corners[i], s.corners[(i + 1) % 4])); });
  Lanes sum = number(static_cast<float>(-2 * pi));
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { sum = hn::Add(sum, arc_cosine(hn::Neg(dot(planes[i], planes[(i + 1) % 4])))); });
  return sum;
}
HWY_INLINE Lanes triangle(const Vector3& p, const Vector3& q, const Vector3& r, Lanes a, Lanes b, Lanes c) {
  const Lanes volume = dot(p, cross(q - p, r - p));
  const Lanes rest = hn::MulAdd(hn::Mul(a, b), c, hn::MulAdd(a, dot(q, r), hn::MulAdd(b, dot(r, p), hn::Mul(c, dot(p, q)))));
  const Lanes angle = angle_of(Floats(), hn::Abs(volume), rest);
  return hn::CopySign(hn::Add(angle, angle), volume);
}
HWY_INLINE Lanes length_of(const Vector3& v) { return hn::Sqrt(dot(v, v)); }
HWY_INLINE Lanes solid_angle(const Seen& s) {
  const auto& v = s.corners;
  const Lanes a = length_of(v[0]), b = length_of(v[1]), c = length_of(v[2]), e = length_of(v[3]);
  return hn::Add(triangle(v[0], v[1], v[2], a, b, c), triangle(v[0], v[2], v[3], a, c, e));
}

// The outline above the horizon: each side's part, and the horizon's own that closes it. All vectors are unit.
struct Clipped {
  std::array<Vector3, 4> from, to;
  std::array<Lit, 4> seen;
  Vector3 gone, risen;  // where it goes below, and comes up
  Lit cut;
  bool any;
};
HWY_INLINE Clipped clipped(const Seen& s) {
  const Floats d;
  std::array<Vector3, 4> u{unit(s.corners[0]), unit(s.corners[1]), unit(s.corners[2]), unit(s.corners[3])};
  std::array<Lanes, 4> up{dot(s.n, u[0]), dot(s.n, u[1]), dot(s.n, u[2]), dot(s.n, u[3])};
  std::array<Lit, 4> above{hn::Ge(up[0], number(0)), hn::Ge(up[1], number(0)), hn::Ge(up[2], number(0)), hn::Ge(up[3], number(0))};
  Clipped c{u, {u[1], u[2], u[3], u[0]}, above, u[0], u[0], hn::FirstN(d, 0), false};
  const Lit some = hn::Or(hn::Or(above[0], above[1]), hn::Or(above[2], above[3]));
  const Lit all = hn::And(hn::And(above[0], above[1]), hn::And(above[2], above[3]));
  c.cut = hn::AndNot(all, some);
  c.any = !hn::AllTrue(d, all);
  if (!c.any) return c;
  // Between unit vectors p above and q below, p (-q.n) + q p.n lies on the horizon.
  Vector3 p = u[0], q = u[1], r = u[0], t = u[1];
  Lanes p_up = up[0], q_up = up[1], r_up = up[0], t_up = up[1];
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    constexpr std::size_t j = (i + 1) % 4;
    const Lit goes = hn::AndNot(above[j], above[i]), rises = hn::AndNot(above[i], above[j]);
    p = chosen(goes, u[i], p), q = chosen(goes, u[j], q);
    p_up = hn::IfThenElse(goes, up[i], p_up), q_up = hn::IfThenElse(goes, up[j], q_up);
    r = chosen(rises, u[i], r), t = chosen(rises, u[j], t);
    r_up = hn::IfThenElse(rises, up[i], r_up), t_up = hn::IfThenElse(rises, up[j], t_up);
  });
  c.gone = unit(along(scaled(q, p_up), p, hn::Neg(q_up)));
  c.risen = unit(along(scaled(t, hn::Neg(r_up)), r, t_up));
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    constexpr std::size_t j = (i + 1) % 4;
    c.from[i] = chosen(above[i], u[i], c.risen);
    c.to[i] = chosen(above[j], u[j], c.gone);
    c.seen[i] = hn::Or(above[i], above[j]);
  });
  return c;
}
HWY_INLINE Lanes solid_angle_above(const Seen& s) {
  const Clipped c = clipped(s);
  const Lanes one = number(1);
  const auto fan = [&](const Vector3& tip, std::size_t i)
                       ETENDUE_INLINE_LAMBDA { return hn::IfThenElseZero(c.seen[i], triangle(tip, c.from[i], c.to[i], one, one, one)); };
  if (!c.any) return hn::Add(fan(c.from[0], 1), fan(c.from[0], 2));
  const Vector3 tip = chosen(c.cut, c.risen, c.from[0]);
  return hn::Add(hn::Add(fan(tip, 0), fan(tip, 1)), hn::Add(fan(tip, 2), fan(tip, 3)));
}

// ---- Drobot ----

struct EndPoints {
  Vector3 nearest, frontal;
};
HWY_INLINE EndPoints end_points(const Seen& s) {
  const Lanes skew = number(1e-6f), facing = hn::Neg(dot(s.n, s.normal));
  const Vector3 foot = scaled(s.normal, hn::Neg(s.height));
  const Vector3 up = along(s.n, s.normal, hn::Min(hn::Sub(facing, skew), number(0)));
  const Vector3 moved = along(foot, s.n, hn::Neg(dot(s.n, foot)));
  return {chosen(hn::Lt(facing, number(0)), moved, foot), scaled(up, hn::Div(s.height, hn::Max(facing, skew)))};
}
HWY_INLINE Vector3 halfway(const Seen& s, const Vector3& a, const Vector3& b) {
  const Vector3 half = unit(a) + unit(b);
  return s.closest(scaled(half, hn::Div(s.height, hn::Neg(dot(half, s.normal)))));
}
HWY_INLINE Lanes towards_clamped_point(const Seen& s) {
  const EndPoints e = end_points(s);
  return cosine_towards(halfway(s, s.closest(e.nearest), s.closest(e.frontal)), s.n);
}
HWY_INLINE Lanes towards_plain_point(const Seen& s) {
  const EndPoints e = end_points(s);
  return cosine_towards(halfway(s, e.nearest, e.frontal), s.n);
}

// ---- Frostbite ----

HWY_INLINE Lanes structured_sampling(const Seen& s) { return hn::Mul(hn::Mul(solid_angle_printed(s), sum_of_cosines(s)), number(0.2f)); }
HWY_INLINE Lanes form_factor(const Seen& s) {
  std::array<Vector3, 4> u{unit(s.corners[0]), unit(s.corners[1]), unit(s.corners[2]), unit(s.corners[3])};
  Lanes sum = number(0);
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Vector3& a = u[i];
    const Vector3& b = u[(i + 1) % 4];
    const Vector3 across = cross(a, b);
    const Lanes square = dot(across, across), inverse = inverse_sqrt(Floats(), hn::Max(square, number(1e-30f)));
    sum = hn::MulAdd(hn::Mul(dot(across, s.n), inverse), angle_of(Floats(), hn::Mul(square, inverse), dot(a, b)), sum);
  });
  return hn::Mul(positive(sum), number(0.5f));
}
HWY_INLINE Lanes towards_e2_point(const Seen& s) {
  const Lanes clamped = hn::Add(number(0.001f), saturate(dot(s.n, s.normal)));
  const Vector3 d0 = unit(scaled(s.n, clamped) - s.normal), d1 = unit(along(s.n, s.normal, hn::Neg(clamped)));
  const Vector3 half = unit(d0 + d1);
  const Vector3 point = s.closest(scaled(half, hn::Div(hn::Neg(s.height), dot(s.normal, half))));
  return cosine_towards(point, s.n);
}

// ---- Hill and Heitz: theta / sin(theta) of x = cos(theta) between unit vectors, times n.(a x b) ----

HWY_INLINE Lanes fitted(Lanes x, Lanes fit) {
  const Floats d;
  const Lit obtuse = hn::Lt(x, number(0));
  if (hn::AllFalse(d, obtuse)) return fit;
  const Lanes inverse_sine = inverse_sqrt(d, hn::Max(hn::NegMulAdd(x, x, number(1)), number(1e-12f)));
  return hn::IfThenElse(obtuse, hn::MulSub(number(static_cast<float>(pi)), inverse_sine, fit), fit);
}
struct ByRational {
  HWY_INLINE Lanes operator()(Lanes x) const {
    const Floats d;
    const Lanes y = hn::Abs(x), above = polynomial(d, y, std::array{5.42031, 3.12829, 0.0902326}),
                below = polynomial(d, y, std::array{3.45068, 4.18814, 1.0});
    return fitted(x, hn::Mul(above, inverse(d, below)));
  }
};
struct ByQuadratic {
  HWY_INLINE Lanes operator()(Lanes x) const {
    return fitted(x, polynomial(Floats(), hn::Abs(x), std::array{1.5708, -0.879406, 0.308609}));
  }
};
template <class Fit>
HWY_INLINE Lanes edge_by(Fit fit, const Vector3& a, const Vector3& b, const Vector3& n) {
  return hn::Mul(dot(cross(a, b), n), fit(dot(a, b)));
}
HWY_INLINE Lanes edge_by_acos(const Vector3& a, const Vector3& b, const Vector3& n) {
  const Vector3 across = cross(a, b);
  const Lanes inverse = inverse_sqrt(Floats(), hn::Max(dot(across, across), number(1e-30f)));
  return hn::Mul(hn::Mul(dot(across, n), inverse), arc_cosine(dot(a, b)));
}
template <class Edge>
HWY_INLINE Lanes clipped_polygon(const Seen& s, Edge edge) {
  const Clipped c = clipped(s);
  Lanes sum = number(0);
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { sum = hn::Add(sum, hn::IfThenElseZero(c.seen[i], edge(c.from[i], c.to[i], s.n))); });
  if (c.any) sum = hn::Add(sum, hn::IfThenElseZero(c.cut, edge(c.gone, c.risen, s.n)));
  return hn::Mul(positive(sum), number(0.5f));
}
template <class Fit>
HWY_INLINE Lanes clipped_by(const Seen& s, Fit fit) {
  return clipped_polygon(s,
                         [&](const Vector3& a, const Vector3& b, const Vector3& n) ETENDUE_INLINE_LAMBDA { return edge_by(fit, a, b, n); });
}

// The vector form factor's length, at most 1, and the cosine between it and the normal.
struct Proxy {
  Lanes factor, z;
};
HWY_INLINE Proxy proxy(const Seen& s) {
  std::array<Vector3, 4> u{unit(s.corners[0]), unit(s.corners[1]), unit(s.corners[2]), unit(s.corners[3])};
  Vector3 f{number(0), number(0), number(0)};
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Vector3& a = u[i];
    const Vector3& b = u[(i + 1) % 4];
    f = along(f, cross(a, b), ByRational()(dot(a, b)));
  });
  const Lanes square = dot(f, f), inverse = inverse_sqrt(Floats(), hn::Max(square, number(1e-30f)));
  return {hn::Min(hn::Mul(hn::Mul(square, inverse), number(static_cast<float>(0.5 / pi))), number(1)),
          within(hn::Mul(dot(f, s.n), inverse), number(1))};
}
HWY_INLINE Lanes hill_cheap(const Seen& s) {
  const Proxy p = proxy(s);
  const Lanes lit = hn::Div(hn::Mul(p.factor, hn::Add(p.factor, p.z)), hn::Add(p.factor, number(1)));
  return hn::Mul(number(static_cast<float>(pi)), positive(lit));
}
HWY_INLINE Lanes hill_ratio_table(const Seen& s, const float* table) {
  const Floats d;
  const hn::RebindToSigned<Floats> integers;
  const Proxy p = proxy(s);
  constexpr auto last = static_cast<float>(ratio_nodes - 1);
  const Lanes x = hn::Mul(hn::MulAdd(p.z, number(0.5f), number(0.5f)), number(last)), y = hn::Mul(p.factor, number(last));
  const Lanes column = hn::Min(hn::Floor(x), number(last - 1)), row = hn::Min(hn::Floor(y), number(last - 1));
  const Lanes u = hn::Sub(x, column), v = hn::Sub(y, row);
  const auto at = hn::ConvertTo(integers, hn::MulAdd(row, number(static_cast<float>(ratio_nodes)), column));
  const auto mix = [&](const float* from) ETENDUE_INLINE_LAMBDA {
    const Lanes a = hn::GatherIndex(d, from, at), b = hn::GatherIndex(d, from + 1, at);
    return hn::MulAdd(hn::Sub(b, a), u, a);
  };
  const Lanes low = mix(table), high = mix(table + ratio_nodes);
  return hn::Mul(hn::Mul(number(static_cast<float>(pi)), p.factor), hn::MulAdd(hn::Sub(high, low), v, low));
}

// ---- The choice ----

HWY_INLINE Lanes only_in_front(const Seen& s, Lanes value) { return hn::IfThenElseZero(hn::Gt(s.height, number(0)), value); }
template <class Method>
HWY_INLINE std::size_t seen(const FlatRect& light, const PointBatch& points, std::span<float> sr, float where_none, Method method) {
  return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
    const Seen s(light, position, n);
    return only_in_front(s, method(s));
  });
}
template <class Method>
HWY_INLINE std::size_t framed(const FlatRect& light, const PointBatch& points, std::span<float> sr, float where_none, Method method) {
  return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
    const Vector3 centre = numbers(light.centre) - position, x = numbers(light.x), y = numbers(light.y), z = numbers(light.normal);
    const Framed<Lanes> f{dot(centre, x), dot(centre, y), dot(centre, z),       dot(n, x),
                          dot(n, y),      dot(n, z),      number(light.half_x), number(light.half_y)};
    return hn::IfThenElseZero(hn::Lt(f.z, number(0)), method(f));
  });
}

std::size_t RectBy(BatchRule rule, const FlatRect& light, const PointBatch& points, std::span<float> sr, float where_none) {
  const auto by = [&](auto method) ETENDUE_INLINE_LAMBDA { return seen(light, points, sr, where_none, method); };
  const auto ours = [&](auto method) ETENDUE_INLINE_LAMBDA { return framed(light, points, sr, where_none, method); };
  switch (rule) {
    case BatchRule::structured_sampling:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return structured_sampling(s); });
    case BatchRule::form_factor:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return form_factor(s); });
    case BatchRule::simplified_point:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle_printed(s), towards_e2_point(s)); });
    case BatchRule::light_position:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle_printed(s), cosine_towards(s.centre, s.n)); });
    case BatchRule::drobot_point:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle(s), towards_clamped_point(s)); });
    case BatchRule::drobot_point_horizon:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle_above(s), towards_clamped_point(s)); });
    case BatchRule::drobot_simplified:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle(s), towards_plain_point(s)); });
    case BatchRule::drobot_simplified_horizon:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hn::Mul(solid_angle_above(s), towards_plain_point(s)); });
    case BatchRule::hill_acos:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA {
        return clipped_polygon(
            s, [](const Vector3& a, const Vector3& b, const Vector3& n) ETENDUE_INLINE_LAMBDA { return edge_by_acos(a, b, n); });
      });
    case BatchRule::hill_rational:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return clipped_by(s, ByRational()); });
    case BatchRule::hill_quadratic:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return clipped_by(s, ByQuadratic()); });
    case BatchRule::hill_ratio_table:
      return by([table = sphere_ratios().data()](const Seen& s) ETENDUE_INLINE_LAMBDA { return hill_ratio_table(s, table); });
    case BatchRule::hill_cheap:
      return by([](const Seen& s) ETENDUE_INLINE_LAMBDA { return hill_cheap(s); });
    case BatchRule::nodes_1:
      return ours([](const Framed<Lanes>& f) ETENDUE_INLINE_LAMBDA { return by_nodes(Floats(), f, gauss1, near_inverse); });
    case BatchRule::nodes_2:
      return ours([](const Framed<Lanes>& f) ETENDUE_INLINE_LAMBDA { return by_nodes(Floats(), f, gauss2, near_inverse); });
    case BatchRule::nodes_3:
      return ours([](const Framed<Lanes>& f) ETENDUE_INLINE_LAMBDA { return by_nodes(Floats(), f, gauss3, near_inverse); });
    default:
      return ours([](const Framed<Lanes>& f) ETENDUE_INLINE_LAMBDA { return positive(by_edges(Floats(), f).value); });
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(RectBy);

std::size_t rect_by(BatchRule rule, const FlatRect& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return HWY_DYNAMIC_DISPATCH(RectBy)(rule, light, points, sr, where_none);
}

}  // namespace etendue::eval
#endif
