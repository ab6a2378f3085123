// What a cone of directions over an ellipse covers of transformed cosines, for lanes of points; for kernels as specular_round_batch.cpp.
#if defined(ETENDUE_LTC_CONE_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_LTC_CONE_INL_H
#undef ETENDUE_LTC_CONE_INL_H
#else
#define ETENDUE_LTC_CONE_INL_H
#endif

#include "eval/ltc-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {

// Directions centre + u cos s + v sin s and all between them, whose lengths are of the order of 1 at most. A matrix makes another such
// cone of it.
//
// With S = c c^T - u u^T - v v^T the cone's dual is { n : n^T S n > 0 }, and S has the eigenvalues m > 0 >= -mu_2 >= -mu_1. Along its
// eigenvectors e0, e1 and e2 the cone is that over (A cos t, B sin t, 1), A^2 = mu_1 / m, B^2 = mu_2 / m. Lambert's integral over all of
// it, 1/2 closed integral of b x b' / |b|^2 dt, is pi A B / sqrt((1 + A^2)(1 + B^2)) e0 by symmetry, and as A^2 B^2 m^3 is det^2 of
// (c, u, v) that is pi det / sqrt(m (m + mu_1)(m + mu_2)) e0.
struct Ellipse {
  Vector3 centre, u, v;
};
// S.
struct Form {
  Lanes xx, yy, zz, xy, yz, zx;
};
struct ConeAxis {
  Lanes det, m, mu_1, slope;  // slope: (m + mu_1)(m + mu_2)
  Vector3 e0;
};

// cos(2 / 3 acos s) from 0 to 1: what is left of it is below 3e-8.
HWY_INLINE Lanes third_of_turn(Lanes s) {
  return polynomial(
      Floats(), s,
      std::array{0.500000026, 0.577346917, -0.111038511, 0.0528414091, -0.0302353976, 0.0160472804, -0.00608934568, 0.00112763624});
}

// The root of the characteristic polynomial y^3 - t y^2 + i y - d that is the largest in magnitude comes from Viete's cosine without
// cancellation, with its sign turned to t's: of the others the product and the sum are known, so that they have all their digits too,
// whatever the roots are to each other.
HWY_INLINE ConeAxis axis_of(const Form& form, Lanes minors, Lanes det, const Vector3& centre) {
  const Floats d;
  const Lanes zero = number(0), trace = hn::Add(form.xx, hn::Add(form.yy, form.zz)), det2 = hn::Mul(det, det);
  const Lit wide = hn::Lt(trace, zero);
  const Lanes t = hn::Abs(trace), signed_det2 = hn::IfThenElse(wide, hn::Neg(det2), det2);
  const Lanes q = hn::Max(hn::NegMulAdd(number(3), minors, hn::Mul(t, t)), number(1e-30f)), over_root = inverse_sqrt(d, q);
  const Lanes cubic = hn::MulAdd(number(27), signed_det2, hn::Mul(t, hn::MulSub(number(2), hn::Mul(t, t), hn::Mul(number(9), minors))));
  const Lanes r = hn::Mul(hn::Mul(number(0.5f), cubic), hn::Mul(over_root, hn::Mul(over_root, over_root)));
  const Lanes s = hn::Sqrt(saturate(hn::MulAdd(number(0.5f), r, number(0.5f))));
  const Lanes root = hn::Mul(number(1.0f / 3), hn::MulAdd(hn::Mul(hn::Add(q, q), over_root), third_of_turn(s), t));
  const Lanes largest = hn::Max(root, number(1e-30f)), over_largest = inverse(d, largest), product = hn::Mul(det2, over_largest);
  // narrow: mu_1 + mu_2;  wide: m - mu_2.
  const Lanes rest = hn::Mul(hn::IfThenElse(wide, hn::Neg(hn::Add(minors, product)), hn::Sub(product, minors)), over_largest);
  const Lanes spread = hn::Sqrt(positive(hn::MulAdd(rest, rest, hn::Mul(hn::IfThenElse(wide, number(4), number(-4)), product))));
  const Lanes sum = hn::Add(hn::Abs(rest), spread);
  const Lanes larger = hn::Mul(number(0.5f), sum), smaller = hn::Div(product, hn::Max(larger, number(1e-30f)));
  const Lit rising = hn::Ge(rest, zero);
  const Lanes m = hn::Max(hn::IfThenElse(wide, hn::IfThenElse(rising, larger, smaller), largest), number(1e-30f));
  const Lanes mu_1 = hn::IfThenElse(wide, largest, larger);
  const Lanes mu_2 = hn::IfThenElse(wide, hn::IfThenElse(rising, smaller, larger), smaller);
  // e0 is the adjugate of S - m times the centre, which is on its side.
  const Lanes xx = hn::Sub(form.xx, m), yy = hn::Sub(form.yy, m), zz = hn::Sub(form.zz, m), xy = form.xy, yz = form.yz, zx = form.zx;
  const auto minor = [](Lanes a, Lanes b, Lanes c, Lanes f) ETENDUE_INLINE_LAMBDA { return hn::MulSub(a, b, hn::Mul(c, f)); };
  const Lanes a_xy = minor(zx, yz, xy, zz), a_yz = minor(xy, zx, yz, xx), a_zx = minor(xy, yz, zx, yy);
  const Vector3 w{dot(Vector3{minor(yy, zz, yz, yz), a_xy, a_zx}, centre), dot(Vector3{a_xy, minor(zz, xx, zx, zx), a_yz}, centre),
                  dot(Vector3{a_zx, a_yz, minor(xx, yy, xy, xy)}, centre)};
  const Lanes length2 = dot(w, w);
  const Vector3 e0 = chosen(hn::Gt(length2, number(1e-36f)), scaled(w, inverse_sqrt(d, hn::Max(length2, number(1e-36f)))), centre);
  return {det, m, mu_1, hn::Mul(hn::Add(m, mu_1), hn::Add(m, mu_2)), e0};
}

// Crosses have the digits of narrow cones.
HWY_INLINE ConeAxis axis_of(const Ellipse& e) {
  const Vector3 uv = cross(e.u, e.v), cu = cross(e.centre, e.u), cv = cross(e.centre, e.v);
  const auto of = [&](Lanes Vector3::*i, Lanes Vector3::*k) ETENDUE_INLINE_LAMBDA {
    return hn::NegMulAdd(e.u.*i, e.u.*k, hn::NegMulAdd(e.v.*i, e.v.*k, hn::Mul(e.centre.*i, e.centre.*k)));
  };
  constexpr auto x = &Vector3::x, y = &Vector3::y, z = &Vector3::z;
  return axis_of({of(x, x), of(y, y), of(z, z), of(x, y), of(y, z), of(z, x)}, hn::Sub(dot(uv, uv), hn::Add(dot(cu, cu), dot(cv, cv))),
                 hn::Abs(dot(e.centre, uv)), e.centre);
}

// The cone's own axes, right-handed, and those of the ellipse: its rim is (A cos t, B sin t, 1) along e1, e2 and e0.
struct ConeFrame {
  Vector3 e1, e2, e0;
  Lanes a, b;
};
HWY_INLINE ConeFrame frame_of(const Ellipse& seen, const ConeAxis& cone) {
  const Floats d;
  const Lanes zero = number(0), one = number(1);
  // Any two axes across e0 (Duff et al. 2017), and how far the cone's own are turned from there.
  const Vector3& e0 = cone.e0;
  const Lanes side = hn::CopySign(one, e0.z), f = hn::Neg(inverse(d, hn::Add(side, e0.z))), g = hn::Mul(hn::Mul(e0.x, e0.y), f);
  const Vector3 t1{hn::MulAdd(hn::Mul(side, f), hn::Mul(e0.x, e0.x), one), hn::Mul(side, g), hn::Neg(hn::Mul(side, e0.x))};
  const Vector3 t2{g, hn::MulAdd(f, hn::Mul(e0.y, e0.y), side), hn::Neg(e0.y)};
  const auto form = [&](const Vector3& a, const Vector3& b) ETENDUE_INLINE_LAMBDA {
    return hn::MulAdd(dot(seen.u, a), dot(seen.u, b),
                      hn::MulSub(dot(seen.v, a), dot(seen.v, b), hn::Mul(dot(seen.centre, a), dot(seen.centre, b))));
  };
  const Lanes half = hn::Mul(number(0.5f), hn::Sub(form(t1, t1), form(t2, t2))), mixed = form(t1, t2);
  const Lanes over_spread = inverse_sqrt(d, hn::Max(hn::MulAdd(half, half, hn::Mul(mixed, mixed)), number(1e-36f)));
  const Lanes c2 = hn::Mul(half, over_spread), large = hn::Sqrt(hn::MulAdd(number(0.5f), hn::Abs(c2), number(0.5f)));
  const Lanes small = hn::Div(hn::Mul(hn::Mul(number(0.5f), mixed), over_spread), large);
  const Lit turned = hn::Lt(half, zero);
  const Lanes c = hn::IfThenElse(turned, hn::Abs(small), large), s = hn::IfThenElse(turned, hn::CopySign(large, mixed), small);
  const Vector3 e1 = along(scaled(t1, c), t2, s), e2 = along(scaled(t2, c), t1, hn::Neg(s));
  const Lanes over_m = inverse(d, cone.m), a2 = hn::Mul(cone.mu_1, over_m);
  const Lanes a = hn::Sqrt(hn::Max(a2, number(1e-20f))), b = hn::Min(hn::Div(hn::Mul(cone.det, over_m), hn::Mul(a, hn::Sqrt(cone.m))), a);
  return {e1, e2, e0, a, b};
}

// A place of the rim in the cone's own axes: cos t and sin t.
struct RimPlace {
  Lanes c, s;
};
HWY_INLINE RimPlace chosen(Lit mask, const RimPlace& yes, const RimPlace& no) {
  return {hn::IfThenElse(mask, yes.c, no.c), hn::IfThenElse(mask, yes.s, no.s)};
}
// Twice the integral of half b x b' / |b|^2 dt along the normal n over the rim b = (A cos t, B sin t, 1), A >= B. With k^2 = A^2 - B^2
// its components are
//     -B / (sqrt(1 + A^2) k) atanh(k sin t / sqrt(1 + A^2)),  A / (sqrt(1 + B^2) k) atan(k cos t / sqrt(1 + B^2)),
//     A B / sqrt((1 + A^2)(1 + B^2)) angle of (sqrt(1 + A^2) cos t, sqrt(1 + B^2) sin t).
struct Rim {
  Lanes a, b, over_a, over_b, k;  // over_a: 1 / sqrt(1 + A^2)
  Vector3 n;

  HWY_INLINE Rim(Lanes width, Lanes height, const Vector3& normal) : a(width), b(height), n(normal) {
    const Floats d;
    const Lanes one = number(1), a2 = hn::MulAdd(a, a, one);
    over_a = inverse_sqrt(d, a2), over_b = inverse_sqrt(d, hn::MulAdd(b, b, one));
    // Of circles any small k serves.
    k = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(a, b), hn::Add(a, b)), hn::Mul(number(1e-8f), a2)));
  }
  Vector3 unit_at(const RimPlace& p) const { return unit(Vector3{hn::Mul(a, p.c), hn::Mul(b, p.s), number(1)}); }
  Lanes all() const { return hn::Mul(hn::Mul(n.z, number(static_cast<float>(2 * pi))), hn::Mul(hn::Mul(a, over_a), hn::Mul(b, over_b))); }
  // From one place on to another. `mostly`: where both all but coincide it is all of the rim and not nothing; `alone`: where they do so in
  // the right order too.
  HWY_INLINE Lanes between(const RimPlace& from, const RimPlace& to, Lit mostly, Lit alone) const {
    const Floats d;
    const Lanes zero = number(0), one = number(1), turn = number(static_cast<float>(2 * pi));
    const Lanes p = hn::Mul(k, over_a), q = hn::Mul(k, over_b), ab = hn::Mul(over_a, over_b);
    // Angles of (cos t / over_a, sin t / over_b), a common factor aside.
    const Lanes fx = hn::Mul(from.c, over_b), fy = hn::Mul(from.s, over_a), tx = hn::Mul(to.c, over_b), ty = hn::Mul(to.s, over_a);
    const Lanes sine = hn::MulSub(fx, ty, hn::Mul(fy, tx)), cosine = hn::MulAdd(fx, tx, hn::Mul(fy, ty));
    const Lanes least = angle_of(d, hn::Abs(sine), cosine);
    const Lit back = hn::Lt(sine, zero), close = hn::Lt(least, number(1e-3f));
    Lanes angle = hn::IfThenElse(back, hn::Sub(turn, least), least);
    angle = hn::IfThenElse(hn::And(close, hn::AndNot(mostly, back)), zero, angle);
    angle = hn::IfThenElse(hn::And(hn::And(close, alone), hn::AndNot(back, mostly)), turn, angle);
    const Lanes ahead = hn::MulAdd(p, to.s, one), behind = hn::NegMulAdd(p, from.s, one);
    const Lanes over = hn::Mul(ahead, behind), under = hn::Mul(hn::NegMulAdd(p, to.s, one), hn::MulAdd(p, from.s, one));
    const Lanes step = hn::Mul(hn::Add(p, p), hn::Sub(to.s, from.s));
    const Lanes logs = hn::CopySign(log_ratio(d, hn::Max(over, under), hn::Min(over, under), hn::Abs(step)), step);
    const Lanes x = hn::Mul(q, hn::Sub(to.c, from.c)), y = hn::MulAdd(hn::Mul(q, q), hn::Mul(from.c, to.c), one);
    const Lanes turned = hn::CopySign(angle_of(d, hn::Abs(x), y), x);
    const Lanes along_x = hn::Mul(hn::Mul(hn::Mul(n.x, b), over_a), hn::Mul(number(-0.5f), logs));
    const Lanes along_y = hn::Mul(hn::Mul(hn::Mul(n.y, a), over_b), turned);
    return hn::MulAdd(hn::Div(one, k), hn::Add(along_x, along_y), hn::Mul(hn::Mul(n.z, angle), hn::Mul(hn::Mul(a, b), ab)));
  }
};

// Where the rim passes a plane through the point, n its normal in the cone's axes: it is above from the first place on to the second.
struct Plane {
  Vector3 n;
  Lit cuts;
  RimPlace rises, sets;

  HWY_INLINE Plane(const Vector3& normal, Lit cut, const Rim& rim) : n(normal), cuts(cut) {
    const Lanes x = hn::Mul(n.x, rim.a), y = hn::Mul(n.y, rim.b);
    const Lanes over = inverse_sqrt(Floats(), hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), number(1e-30f)));
    const Lanes cx = hn::Mul(x, over), cy = hn::Mul(y, over), c = hn::Neg(within(hn::Mul(n.z, over), number(1)));
    const Lanes s = hn::Sqrt(positive(hn::Mul(hn::Sub(number(1), c), hn::Add(number(1), c))));
    rises = {hn::MulAdd(cx, c, hn::Mul(cy, s)), hn::MulSub(cy, c, hn::Mul(cx, s))};
    sets = {hn::MulSub(cx, c, hn::Mul(cy, s)), hn::MulAdd(cy, c, hn::Mul(cx, s))};
  }
  Lit keeps(const RimPlace& p, const Rim& rim) const {
    const Lanes height = hn::MulAdd(hn::Mul(n.x, rim.a), p.c, hn::MulAdd(hn::Mul(n.y, rim.b), p.s, n.z));
    return hn::Or(hn::Not(cuts), hn::Ge(height, number(0)));
  }
};

// Through a matrix, with lengths of the order of 1 again.
HWY_INLINE Ellipse transformed(const Cosines& cosines, const Ellipse& light) {
  const Vector3 centre = cosines(light.centre), u = cosines(light.u), v = cosines(light.v);
  const Lanes size = inverse_sqrt(Floats(), hn::Add(dot(centre, centre), hn::Add(dot(u, u), dot(v, v))));
  return {scaled(centre, size), scaled(u, size), scaled(v, size)};
}
// The surface's horizon, M^-T z.
HWY_INLINE Vector3 horizon_of(const Cosines& cosines) {
  const Lanes over = inverse_sqrt(Floats(), hn::MulAdd(cosines.xx, cosines.xx, hn::Mul(cosines.zx, cosines.zx)));
  return {hn::Neg(hn::Mul(cosines.zx, over)), number(0), hn::Mul(cosines.xx, over)};
}

// The cone of a sphere or a disk without its axes across: u u^T + v v^T = r^2 (1 - n n^T), so that a sphere's S is a a^T - r^2, a the unit
// vector to its centre and r the sine of its angle, and a disk's c c^T - r^2 + r^2 n n^T.
struct RoundCone {
  Vector3 centre, normal;  // of a sphere a, and 0
  Lanes radius2, det;
};
template <bool sphere>
HWY_INLINE ConeAxis axis_of(const Cosines& m, const RoundCone& cone) {
  const Floats d;
  const auto twice = [](Lanes a, Lanes b, Lanes c, Lanes f) ETENDUE_INLINE_LAMBDA { return hn::MulAdd(a, b, hn::Mul(c, f)); };
  const Lanes xx = twice(m.xx, m.xx, m.xz, m.xz), yy = hn::Mul(m.yy, m.yy), zz = twice(m.zx, m.zx, m.zz, m.zz),
              zx = twice(m.xx, m.zx, m.xz, m.zz);
  const Vector3 c = m(cone.centre);
  const Lanes sum = hn::MulAdd(cone.radius2, hn::Add(xx, hn::Add(yy, zz)), dot(c, c));
  const Lanes size = inverse_sqrt(d, sum), size2 = hn::Mul(size, size), r2 = hn::Mul(cone.radius2, size2);
  const Vector3 p = scaled(c, size), n = sphere ? p : m(cone.normal);
  const auto part = [&](Lanes Vector3::*i, Lanes Vector3::*k, Lanes squares) ETENDUE_INLINE_LAMBDA {
    if constexpr (!sphere) squares = hn::NegMulAdd(n.*i, n.*k, squares);
    return hn::NegMulAdd(r2, squares, hn::Mul(p.*i, p.*k));
  };
  constexpr auto x = &Vector3::x, y = &Vector3::y, z = &Vector3::z;
  const Lanes zero = number(0);
  const Form s{part(x, x, xx), part(y, y, yy), part(z, z, zz), part(x, y, zero), part(y, z, zero), part(z, x, zx)};
  const auto minor = [](Lanes a, Lanes b, Lanes e) ETENDUE_INLINE_LAMBDA { return hn::MulSub(a, b, hn::Mul(e, e)); };
  const Lanes minors = hn::Add(minor(s.xx, s.yy, s.xy), hn::Add(minor(s.yy, s.zz, s.yz), minor(s.zz, s.xx, s.zx)));
  const Lanes of_matrix = hn::Mul(hn::Abs(m.yy), hn::Abs(hn::MulSub(m.xx, m.zz, hn::Mul(m.xz, m.zx))));
  return axis_of(s, minors, hn::Mul(hn::Mul(of_matrix, cone.det), hn::Mul(size, size2)), p);
}

// The share of the cosine that the cap with the cone's integral covers above the surface's horizon: Covered::share_as_cap of ltc.cpp.
template <bool sphere>
HWY_INLINE Lanes covered_as_cap(const Cosines& cosines, const RoundCone& light) {
  const Floats d;
  const Lanes one = number(1);
  const ConeAxis cone = axis_of<sphere>(cosines, light);
  const Vector3 &axis = cone.e0, horizon = horizon_of(cosines);
  const Lanes sine2 = hn::Min(hn::Mul(cone.det, inverse_sqrt(d, hn::Mul(cone.m, cone.slope))), one), sine = hn::Sqrt(sine2);
  const Lanes whole = hn::Mul(hn::Mul(number(static_cast<float>(pi)), sine2), axis.z), up = dot(horizon, axis);
  Lanes sum = hn::IfThenElseZero(hn::Gt(up, hn::Neg(sine)), whole);
  const Lit cut = hn::Lt(hn::Abs(up), sine);
  if (!hn::AllFalse(d, cut)) {
    const Lanes cosine = hn::Sqrt(hn::Sub(one, sine2));
    const Lanes half_chord = hn::Sqrt(positive(hn::Mul(hn::Sub(sine, up), hn::Add(sine, up))));
    const Lanes phi = angle_of(d, half_chord, hn::Neg(hn::Mul(cosine, up))), psi = angle_of(d, half_chord, cosine);
    const Lanes across2 = hn::Max(hn::NegMulAdd(up, up, one), number(1e-6f)), leaning = hn::NegMulAdd(axis.z, up, horizon.z);
    const Lanes across = hn::Mul(hn::Mul(leaning, inverse(d, across2)), hn::Mul(cosine, half_chord));
    sum = hn::IfThenElse(cut, hn::MulAdd(hn::Mul(axis.z, sine2), phi, hn::MulSub(horizon.z, psi, across)), sum);
  }
  return saturate(hn::Mul(sum, inverse(d, hn::Mul(number(static_cast<float>(pi)), cosines.share_above()))));
}

// What leads towards the light is the middle of all of it.
template <bool sphere>
HWY_INLINE UncutShare covered_uncut(const Cosines& cosines, const Ellipse& light, const RoundCone& round, Lit crossed) {
  const Floats d;
  const ConeAxis cone = axis_of<sphere>(cosines, round);
  Lanes sum =
      hn::Mul(hn::Mul(number(static_cast<float>(2 * pi)), cone.det), hn::Mul(cone.e0.z, inverse_sqrt(d, hn::Mul(cone.m, cone.slope))));
  if (!hn::AllFalse(d, crossed)) {
    const ConeFrame axes = frame_of(transformed(cosines, light), cone);
    const Rim rim(axes.a, axes.b, {axes.e1.z, axes.e2.z, axes.e0.z});
    const Vector3 horizon = horizon_of(cosines);
    const Plane plane({dot(axes.e1, horizon), dot(axes.e2, horizon), dot(axes.e0, horizon)}, crossed, rim);
    const Vector3 begin = rim.unit_at(plane.sets), step = rim.unit_at(plane.rises) - begin;
    const Lanes turn = dot(rim.n, cross(begin, step)), chord = hn::MulAdd(turn, over_sine_less_one(begin, step), turn);
    const Lanes part = hn::Add(rim.between(plane.rises, plane.sets, hn::Gt(plane.n.z, number(0)), crossed), chord);
    sum = hn::IfThenElse(crossed, part, sum);
  }
  return {share_of(cosines, sum), cone.e0};
}

// The share of the cosine above the horizon that the cone covers; `crossed`: the horizon cuts it.
inline HWY_NOINLINE Lanes covered(const Cosines& cosines, const Ellipse& light, Lit crossed) {
  const Floats d;
  const Lanes zero = number(0), one = number(1);
  const Ellipse seen = transformed(cosines, light);
  const ConeAxis cone = axis_of(seen);
  const Lit own = hn::Lt(hn::Mul(seen.centre.z, seen.centre.z), hn::MulAdd(seen.u.z, seen.u.z, hn::Mul(seen.v.z, seen.v.z)));
  const Lit lit = hn::Or(own, hn::Gt(seen.centre.z, zero)), cut = hn::Or(own, crossed);
  Lanes sum =
      hn::Mul(hn::Mul(number(static_cast<float>(2 * pi)), cone.det), hn::Mul(cone.e0.z, inverse_sqrt(d, hn::Mul(cone.m, cone.slope))));
  if (!hn::AllFalse(d, hn::And(lit, cut))) {
    const ConeFrame axes = frame_of(seen, cone);
    const Vector3 &e1 = axes.e1, &e2 = axes.e2, &e0 = axes.e0;
    const Rim rim(axes.a, axes.b, {e1.z, e2.z, e0.z});
    const Vector3 horizon = horizon_of(cosines);
    const Plane first(rim.n, own, rim), second({dot(e1, horizon), dot(e2, horizon), dot(e0, horizon)}, crossed, rim);
    const Lit rises_1 = hn::And(own, second.keeps(first.rises, rim)), sets_1 = hn::And(own, second.keeps(first.sets, rim));
    const Lit rises_2 = hn::And(crossed, first.keeps(second.rises, rim)), sets_2 = hn::And(crossed, first.keeps(second.sets, rim));
    const Lit mostly = hn::And(hn::Or(hn::Not(own), hn::Gt(first.n.z, zero)), hn::Or(hn::Not(crossed), hn::Gt(second.n.z, zero)));
    const Lit twice = hn::And(hn::And(rises_1, sets_1), hn::And(rises_2, sets_2)), any = hn::Or(rises_1, rises_2);
    const RimPlace from = chosen(rises_1, first.rises, second.rises);
    const RimPlace to = chosen(hn::AndNot(twice, sets_1), first.sets, second.sets);
    Lanes part = hn::IfThenElseZero(any, rim.between(from, to, hn::AndNot(twice, mostly), hn::Xor(own, crossed)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, twice))) {
      const Lit never = hn::FirstN(d, 0);
      part = hn::Add(part, hn::IfThenElseZero(twice, rim.between(second.rises, first.sets, never, never)));
    }
    // Along either plane, from where the rim leaves it or from where both meet.
    const Vector3 corner = cross(first.n, second.n);
    const Vector3 meeting = scaled(corner, hn::CopySign(inverse_sqrt(d, hn::Max(dot(corner, corner), number(1e-30f))), corner.z));
    const auto chord = [&](const Plane& plane, Lit rises, Lit sets) ETENDUE_INLINE_LAMBDA {
      const Vector3 begin = chosen(sets, rim.unit_at(plane.sets), meeting), end = chosen(rises, rim.unit_at(plane.rises), meeting);
      const Vector3 step = end - begin;
      const Lanes turn = dot(rim.n, cross(begin, step));
      return hn::IfThenElseZero(hn::Or(rises, sets), hn::MulAdd(turn, over_sine_less_one(begin, step), turn));
    };
    part = hn::Add(part, hn::Add(chord(first, rises_1, sets_1), chord(second, rises_2, sets_2)));
    sum = hn::IfThenElse(cut, part, sum);
  }
  const Lanes over = inverse(d, hn::Mul(number(static_cast<float>(2 * pi)), cosines.share_above()));
  return hn::Min(hn::Mul(positive(hn::IfThenElseZero(lit, sum)), over), one);
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
