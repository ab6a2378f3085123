// Methods for rectangles at many points: the published ones as their sources state them, and rules of ours.
#include "method_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/rect_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/method_batch-inl.h"

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

// ---- Ours: in the light's own frame, where sides are straight along x and y ----

struct Framed {
  Lanes x, y, z, n_x, n_y, n_z, half_x, half_y;  // of the centre; the light faces along z, z < 0 is its front
  HWY_INLINE Framed(const FlatRect& light, const Vector3& position, const Vector3& n)
      : x(number(0)), y(x), z(x), n_x(x), n_y(x), n_z(x), half_x(number(light.half_x)), half_y(number(light.half_y)) {
    const Vector3 centre = numbers(light.centre) - position, ex = numbers(light.x), ey = numbers(light.y), ez = numbers(light.normal);
    x = dot(centre, ex), y = dot(centre, ey), z = dot(centre, ez);
    n_x = dot(n, ex), n_y = dot(n, ey), n_z = dot(n, ez);
  }
};
// Gauss and Legendre's places in [-1, 1] and shares.
struct Node {
  float at, share;
};
constexpr std::array<Node, 1> one_node{{{0, 1}}};
constexpr std::array<Node, 2> two_nodes{{{-0.57735027f, 0.5f}, {0.57735027f, 0.5f}}};
constexpr std::array<Node, 3> three_nodes{{{-0.77459667f, 0.27777778f}, {0, 0.44444444f}, {0.77459667f, 0.27777778f}}};

// The integral of h n.p / r^4 over the area, n.p at every node no less than 0.
template <std::size_t N>
HWY_INLINE Lanes by_nodes(const Framed& f, const std::array<Node, N>& nodes) {
  std::array<Lanes, N> y2{}, y_up{};
  const Lanes z2 = hn::Mul(f.z, f.z), z_up = hn::Mul(f.z, f.n_z);
  each<N>([&](auto j) ETENDUE_INLINE_LAMBDA {
    const Lanes y = hn::MulAdd(number(nodes[j].at), f.half_y, f.y);
    y2[j] = hn::MulAdd(y, y, z2), y_up[j] = hn::MulAdd(y, f.n_y, z_up);
  });
  Lanes sum = number(0);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Lanes x = hn::MulAdd(number(nodes[i].at), f.half_x, f.x);
    Lanes row = number(0);
    each<N>([&](auto j) ETENDUE_INLINE_LAMBDA {
      const Lanes near = near_inverse(hn::MulAdd(x, x, y2[j])), up = positive(hn::MulAdd(x, f.n_x, y_up[j]));
      row = hn::MulAdd(hn::Mul(hn::Mul(near, near), number(nodes[j].share)), up, row);
    });
    sum = hn::MulAdd(row, number(nodes[i].share), sum);
  });
  return hn::Mul(hn::Mul(hn::Mul(number(-4), f.z), hn::Mul(f.half_x, f.half_y)), sum);
}

// theta / sin(theta) in t = 1 - cos(theta) up to a right angle, within a relative 8e-8: the least of all polynomials of its degree that are
// 1 at 0.
constexpr std::array<double, 9> over_sine{
    1, 0.333325869, 0.133567985, 0.054650157, 0.0380049009, -0.0229278993, 0.0581812321, -0.0411491849, 0.0171431505};

// n.(a x b) theta / |a x b|, of `across` = n.(a x b) / |a||b| and the cosine between a and b.
template <std::size_t N>
HWY_INLINE Lanes sum_of_edges(const std::array<Lanes, N>& across, const std::array<Lanes, N>& cosine) {
  const Floats d;
  std::array<Lanes, N> t = cosine;
  Lit any = hn::FirstN(d, 0);
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    t[i] = hn::Sub(number(1), hn::Abs(cosine[i]));
    any = hn::Or(any, hn::Lt(cosine[i], number(0)));
  });
  std::array<Lanes, N> fit = polynomials(d, t, over_sine);
  if (!hn::AllFalse(d, any)) {
    each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
      const Lanes sine2 = hn::Max(hn::Mul(t[i], hn::Sub(number(2), t[i])), number(1e-12f));
      const Lanes turned = hn::MulSub(number(static_cast<float>(pi)), inverse_sqrt(d, sine2), fit[i]);
      fit[i] = hn::IfThenElse(hn::Lt(cosine[i], number(0)), turned, fit[i]);
    });
  }
  Lanes sum = hn::Mul(across[0], fit[0]);
  each<N - 1>([&](auto i) ETENDUE_INLINE_LAMBDA { sum = hn::MulAdd(across[i + 1], fit[i + 1], sum); });
  return sum;
}

// Lambert's sum over the sides above the horizon, and over the horizon between them.
HWY_INLINE Lanes by_edges(const Framed& f) {
  const Floats d;
  const Lanes x0 = hn::Sub(f.x, f.half_x), x1 = hn::Add(f.x, f.half_x), y0 = hn::Sub(f.y, f.half_y), y1 = hn::Add(f.y, f.half_y);
  const Lanes z2 = hn::Mul(f.z, f.z), up_z = hn::Mul(f.n_z, f.z);
  const Lanes bottom2 = hn::MulAdd(y0, y0, z2), top2 = hn::MulAdd(y1, y1, z2), left2 = hn::Mul(x0, x0), right2 = hn::Mul(x1, x1);
  const Lanes up_bottom = hn::MulAdd(f.n_y, y0, up_z), up_top = hn::MulAdd(f.n_y, y1, up_z);
  // Corners counter-clockwise from (x0, y0): their heights over the horizon, one over their distances.
  const std::array<Lanes, 4> up{hn::MulAdd(f.n_x, x0, up_bottom), hn::MulAdd(f.n_x, x1, up_bottom), hn::MulAdd(f.n_x, x1, up_top),
                                hn::MulAdd(f.n_x, x0, up_top)};
  const std::array<Lanes, 4> near{inverse_sqrt(d, hn::Add(left2, bottom2)), inverse_sqrt(d, hn::Add(right2, bottom2)),
                                  inverse_sqrt(d, hn::Add(right2, top2)), inverse_sqrt(d, hn::Add(left2, top2))};
  // n.(a x unit vector along the side) of the bottom, right, top and left one.
  const Lanes m_y = hn::Mul(f.n_y, f.z), m_x = hn::Mul(f.n_x, f.z);
  const std::array<Lanes, 4> m{hn::NegMulAdd(f.n_z, y0, m_y), hn::MulSub(f.n_z, x1, m_x), hn::MulSub(f.n_z, y1, m_y),
                               hn::NegMulAdd(f.n_z, x0, m_x)};
  const std::array<Lit, 4> above{hn::Ge(up[0], number(0)), hn::Ge(up[1], number(0)), hn::Ge(up[2], number(0)), hn::Ge(up[3], number(0))};
  const Lit some = hn::Or(hn::Or(above[0], above[1]), hn::Or(above[2], above[3]));
  const Lit all = hn::And(hn::And(above[0], above[1]), hn::And(above[2], above[3]));
  const Lanes width = hn::Add(f.half_x, f.half_x), height = hn::Add(f.half_y, f.half_y);
  const std::array<Lanes, 4> other2{bottom2, hn::Add(right2, z2), top2, hn::Add(left2, z2)};
  const std::array<Lanes, 4> begin{x0, y0, x1, y1}, end{x1, y1, x0, y0};
  if (hn::AllTrue(d, all)) {
    std::array<Lanes, 4> across = m, cosine = m;
    each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
      const Lanes product = hn::Mul(near[i], near[(i + 1) % 4]);
      across[i] = hn::Mul(hn::Mul(m[i], i % 2 == 0 ? width : height), product);
      cosine[i] = hn::Mul(hn::MulAdd(begin[i], end[i], other2[i]), product);
    });
    return positive(hn::Mul(sum_of_edges(across, cosine), number(-0.5f)));
  }
  // Where the sides' lines meet the horizon, within the sides.
  const auto over = [&](Lanes a)
                        ETENDUE_INLINE_LAMBDA { return inverse(d, hn::IfThenElse(hn::Lt(hn::Abs(a), number(1e-20f)), number(1e-20f), a)); };
  const Lanes over_x = over(hn::Neg(f.n_x)), over_y = over(hn::Neg(f.n_y));
  const auto between = [&](Lanes low, Lanes x, Lanes high) ETENDUE_INLINE_LAMBDA { return hn::Min(hn::Max(x, low), high); };
  const std::array<Lanes, 4> crossing{
      between(x0, hn::Mul(up_bottom, over_x), x1), between(y0, hn::Mul(hn::MulAdd(f.n_x, x1, up_z), over_y), y1),
      between(x0, hn::Mul(up_top, over_x), x1), between(y0, hn::Mul(hn::MulAdd(f.n_x, x0, up_z), over_y), y1)};
  const auto place = [&](Lit bottom, Lit right, Lit top) ETENDUE_INLINE_LAMBDA {
    const auto one_of = [&](Lanes a, Lanes b, Lanes c, Lanes e) ETENDUE_INLINE_LAMBDA {
      return hn::IfThenElse(bottom, a, hn::IfThenElse(right, b, hn::IfThenElse(top, c, e)));
    };
    return std::array<Lanes, 2>{one_of(crossing[0], x1, crossing[2], x0), one_of(y0, crossing[1], y1, crossing[3])};
  };
  const auto gone = place(hn::AndNot(above[1], above[0]), hn::AndNot(above[2], above[1]), hn::AndNot(above[3], above[2]));
  const auto risen = place(hn::AndNot(above[0], above[1]), hn::AndNot(above[1], above[2]), hn::AndNot(above[2], above[3]));
  const auto near_of = [&](const std::array<Lanes, 2>& p)
                           ETENDUE_INLINE_LAMBDA { return inverse_sqrt(d, hn::MulAdd(p[0], p[0], hn::MulAdd(p[1], p[1], z2))); };
  const Lanes near_gone = near_of(gone), near_risen = near_of(risen);
  std::array<Lanes, 5> across{z2, z2, z2, z2, z2}, cosine = across;
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    constexpr std::size_t j = (i + 1) % 4;
    const Lanes from = hn::IfThenElse(above[i], begin[i], crossing[i]), to = hn::IfThenElse(above[j], end[i], crossing[i]);
    const Lanes product = hn::Mul(hn::IfThenElse(above[i], near[i], near_risen), hn::IfThenElse(above[j], near[j], near_gone));
    const Lanes length = hn::IfThenElseZero(hn::Or(above[i], above[j]), i < 2 ? hn::Sub(to, from) : hn::Sub(from, to));
    across[i] = hn::Mul(hn::Mul(m[i], length), product);
    cosine[i] = hn::IfThenElse(hn::Or(above[i], above[j]), hn::Mul(hn::MulAdd(from, to, other2[i]), product), number(1));
  });
  const Lit cut = hn::AndNot(all, some);
  const Lanes dx = hn::Sub(risen[0], gone[0]), dy = hn::Sub(risen[1], gone[1]), product = hn::Mul(near_gone, near_risen);
  const Lanes turn = hn::MulSub(gone[0], dy, hn::Mul(gone[1], dx));
  const Lanes whole = hn::MulAdd(f.z, hn::MulSub(f.n_y, dx, hn::Mul(f.n_x, dy)), hn::Mul(f.n_z, turn));
  across[4] = hn::IfThenElseZero(cut, hn::Mul(whole, product));
  cosine[4] = hn::IfThenElse(cut, hn::Mul(hn::MulAdd(gone[0], risen[0], hn::MulAdd(gone[1], risen[1], z2)), product), number(1));
  return positive(hn::Mul(sum_of_edges(across, cosine), number(-0.5f)));
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
    const Framed f(light, position, n);
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
      return ours([](const Framed& f) ETENDUE_INLINE_LAMBDA { return by_nodes(f, one_node); });
    case BatchRule::nodes_2:
      return ours([](const Framed& f) ETENDUE_INLINE_LAMBDA { return by_nodes(f, two_nodes); });
    case BatchRule::nodes_3:
      return ours([](const Framed& f) ETENDUE_INLINE_LAMBDA { return by_nodes(f, three_nodes); });
    default:
      return ours([](const Framed& f) ETENDUE_INLINE_LAMBDA { return by_edges(f); });
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
