// Methods for spheres, disks and tubes at many points: the published ones as their sources state them, and rules of ours.
#include "method_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/round_method_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/method_batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

constexpr auto pi_single = static_cast<float>(pi);

HWY_INLINE Lanes arc_tangent(Lanes y, Lanes x) { return angle_of(Floats(), y, x); }  // of y / x, both at least 0
HWY_INLINE Lanes sine_of(Lanes cosine) { return hn::Sqrt(positive(hn::NegMulAdd(cosine, cosine, number(1)))); }

// Relative to the point: squared distance, one over the distance, cosine between normal and centre.
struct Aimed {
  Vector3 centre, n;
  Lanes d2, inverse, z;
  HWY_INLINE Aimed(const Vec3f& place, const Vector3& position, const Vector3& surface)
      : centre(numbers(place) - position),
        n(surface),
        d2(dot(centre, centre)),
        inverse(inverse_sqrt(Floats(), d2)),
        z(hn::Mul(dot(n, centre), inverse)) {}
};

// ---- Spheres ----

HWY_INLINE Lanes patch_without_horizon(const Aimed& a, Lanes r2) {
  return hn::Mul(hn::Mul(number(pi_single), saturate(a.z)), hn::Div(r2, hn::Max(r2, a.d2)));
}
HWY_INLINE Lanes patch(const Aimed& a, Lanes r2) {
  const Floats d;
  const Lanes s2 = hn::Div(r2, a.d2), above = hn::Mul(number(pi_single), hn::Mul(a.z, s2));
  const Lit is_above = hn::And(hn::Gt(hn::Mul(a.z, a.z), s2), hn::Gt(a.z, number(0)));
  if (hn::AllTrue(d, is_above)) return above;
  const Lanes x = hn::Sqrt(hn::Sub(hn::Div(number(1), s2), number(1))), sine = sine_of(a.z), y = hn::Neg(hn::Div(hn::Mul(x, a.z), sine));
  // No number where the sphere is below the horizon or the point inside: as printed, and 0 in the end.
  const Lanes root = hn::Mul(sine, hn::Sqrt(hn::NegMulAdd(y, y, number(1))));
  const Lanes cut = hn::MulAdd(hn::MulSub(a.z, arc_cosine(y), hn::Mul(x, root)), s2, arc_tangent(root, x));
  return hn::IfThenElse(is_above, above, cut);
}
// Listing 10's function.
HWY_INLINE Lanes cap(Lanes z, Lanes s2) {
  const Floats d;
  const Lanes whole = hn::Mul(hn::Mul(number(pi_single), s2), saturate(z));
  const Lit is_whole = hn::Gt(hn::Mul(z, z), s2);
  if (hn::AllTrue(d, is_whole)) return whole;
  const Lanes sine = sine_of(z), x = hn::Sqrt(hn::Sub(hn::Div(number(1), s2), number(1))), y = hn::Neg(hn::Div(hn::Mul(x, z), sine));
  const Lanes root = hn::Mul(sine, sine_of(y));
  const Lanes cut = hn::MulAdd(hn::MulSub(z, arc_cosine(y), hn::Mul(x, root)), s2, arc_tangent(root, x));
  return hn::IfThenElse(is_whole, whole, positive(cut));
}
HWY_INLINE Lanes sphere_or_disk(const Aimed& a, Lanes r2) {
  return cap(within(a.z, number(0.999f)), hn::Min(hn::Div(r2, a.d2), number(0.9999f)));
}
HWY_INLINE Lanes karis_sphere(const Aimed& a, Lanes r2) {
  return hn::Mul(hn::Mul(number(pi_single), r2), hn::Mul(hn::Mul(a.inverse, a.inverse), saturate(a.z)));
}
HWY_INLINE Lanes falloff(Lanes d2) { return inverse(Floats(), hn::Add(d2, number(1))); }
HWY_INLINE Lanes karis_sphere_9(const Aimed& a, Lanes r2) {
  return hn::Mul(hn::Mul(number(pi_single), r2), hn::Mul(falloff(a.d2), saturate(a.z)));
}
// Of a sphere, the closest point to the ray along the unit vector r.
HWY_INLINE Vector3 closest_to_ray(const Vector3& centre, Lanes radius, const Vector3& r) {
  const Vector3 to_ray = scaled(r, dot(centre, r)) - centre;
  const Lanes share = hn::Min(hn::Mul(radius, inverse_sqrt(Floats(), hn::Max(dot(to_ray, to_ray), number(1e-30f)))), number(1));
  return along(centre, to_ray, share);
}
HWY_INLINE Lanes eden_sphere(const Aimed& a, Lanes radius) {
  const Vector3 point = closest_to_ray(a.centre, radius, a.n);
  const Lanes intensity = hn::Mul(number(pi_single), hn::Mul(radius, radius));
  return hn::Mul(hn::Mul(intensity, cosine_towards(point, a.n)), falloff(dot(point, point)));
}

// Ours: all of the sphere above the horizon, or as much as its centre has.
HWY_INLINE Lanes ball_by_centre(const Ball& light, const Vector3& position, const Vector3& n) {
  const Vector3 centre = numbers(light.centre) - position;
  const Lanes d2 = dot(centre, centre), near = inverse_sqrt(Floats(), d2), area = number(pi_single * light.radius * light.radius);
  return hn::Mul(hn::Mul(area, positive(dot(centre, n))), hn::Mul(hn::Mul(near, near), near));
}

std::size_t BallBy(BatchRule rule, const Ball& light, const PointBatch& points, std::span<float> sr, float where_none) {
  const auto by = [&](auto method) ETENDUE_INLINE_LAMBDA {
    return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
      return method(Aimed(light.centre, position, n), number(light.radius * light.radius));
    });
  };
  switch (rule) {
    case BatchRule::patch_without_horizon:
      return by([](const Aimed& a, Lanes r2) ETENDUE_INLINE_LAMBDA { return patch_without_horizon(a, r2); });
    case BatchRule::patch:
      return by([](const Aimed& a, Lanes r2) ETENDUE_INLINE_LAMBDA { return patch(a, r2); });
    case BatchRule::sphere_or_disk:
      return by([](const Aimed& a, Lanes r2) ETENDUE_INLINE_LAMBDA { return sphere_or_disk(a, r2); });
    case BatchRule::karis_sphere:
      return by([](const Aimed& a, Lanes r2) ETENDUE_INLINE_LAMBDA { return karis_sphere(a, r2); });
    case BatchRule::karis_sphere_9:
      return by([](const Aimed& a, Lanes r2) ETENDUE_INLINE_LAMBDA { return karis_sphere_9(a, r2); });
    case BatchRule::eden_sphere:
      return by([&](const Aimed& a, Lanes) ETENDUE_INLINE_LAMBDA { return eden_sphere(a, number(light.radius)); });
    default:
      return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
        return ball_by_centre(light, position, n);
      });
  }
}

// ---- Disks ----

struct SeenDisk {
  Aimed to;
  Lanes height, r2;
  HWY_INLINE SeenDisk(const FlatDisk& light, const Vector3& position, const Vector3& n)
      : to(light.centre, position, n), height(hn::Neg(dot(to.centre, numbers(light.normal)))), r2(number(light.radius * light.radius)) {}
  HWY_INLINE Lanes cosine_at_light() const { return saturate(hn::Mul(height, to.inverse)); }
};
HWY_INLINE Lanes facing_disk_without_horizon(const SeenDisk& s) {
  const Lanes share = hn::Div(s.r2, hn::Add(s.to.d2, s.r2));
  return hn::Mul(hn::Mul(number(pi_single), share), hn::Mul(saturate(s.to.z), s.cosine_at_light()));
}
HWY_INLINE Lanes facing_disk(const SeenDisk& s) {
  const Floats d;
  const Lanes z = s.to.z, h2 = hn::Div(s.to.d2, s.r2), share = hn::Div(number(1), hn::Add(number(1), h2));
  const Lanes whole = hn::Mul(number(pi_single), hn::Mul(z, share));
  // theta < atan h
  const Lit is_whole = hn::And(hn::Gt(hn::Mul(z, z), share), hn::Gt(z, number(0)));
  if (hn::AllTrue(d, is_whole)) return hn::Mul(whole, s.cosine_at_light());
  const Lanes h = hn::Sqrt(h2), sine = sine_of(z), h_cot = hn::Mul(h, hn::Div(z, sine));
  const Lanes x_sine = hn::Mul(sine, hn::Sqrt(hn::NegMulAdd(h_cot, h_cot, number(1))));
  const Lanes rest = hn::MulSub(z, hn::Sub(number(pi_single), arc_cosine(h_cot)), hn::Mul(h, x_sine));
  const Lanes cut = hn::MulAdd(rest, share, arc_tangent(x_sine, h));
  return hn::Mul(hn::IfThenElse(is_whole, whole, cut), s.cosine_at_light());
}
HWY_INLINE Lanes disk_as_cap(const SeenDisk& s) {
  const Lanes s2 = hn::Div(s.r2, hn::Add(s.r2, hn::Max(s.r2, s.to.d2)));
  return hn::Mul(cap(s.to.z, s2), s.cosine_at_light());
}

// Ours. Of the disk's vector of illuminance, which is exact above the horizon (disk_batch.cpp), what points along the normal:
//     pi / 2 (n_a (w - k) + 4 R^2 h n.c / (m + w)) / w,   k = |C|^2 - R^2, m = |C|^2 + R^2, w = sqrt(k^2 + 4 R^2 h^2).
HWY_INLINE Lanes disk_vector(const FlatDisk& light, const Vector3& position, const Vector3& n) {
  const Floats d;
  const Vector3 centre = numbers(light.centre) - position, facing = numbers(light.normal);
  const Lanes r2 = number(light.radius * light.radius), height = hn::Neg(dot(centre, facing)), n_a = hn::Neg(dot(n, facing));
  const Lanes d2 = dot(centre, centre), k = hn::Sub(d2, r2), m = hn::Add(d2, r2),
              four_r2h = hn::Mul(number(4 * light.radius * light.radius), height);
  const Lanes w2 = hn::MulAdd(k, k, hn::Mul(four_r2h, height)), per_w = inverse_sqrt(d, w2), w = hn::Mul(w2, per_w);
  const Lanes n_c = hn::NegMulAdd(n_a, height, dot(n, centre));
  const Lanes across = hn::Mul(hn::Mul(four_r2h, n_c), inverse(d, hn::Add(m, w)));
  const Lanes value = hn::Mul(hn::MulAdd(n_a, hn::Sub(w, k), across), per_w);
  return hn::IfThenElseZero(hn::Gt(height, number(0)), positive(hn::Mul(number(pi_single / 2), value)));
}
// The middle alone: pi R^2 h n.C / (|C|^2 (|C|^2 + R^2)), whose last factor keeps what is near finite.
HWY_INLINE Lanes disk_by_centre(const FlatDisk& light, const Vector3& position, const Vector3& n) {
  const Vector3 centre = numbers(light.centre) - position;
  const Lanes height = positive(hn::Neg(dot(centre, numbers(light.normal)))), d2 = dot(centre, centre);
  const Lanes area = number(pi_single * light.radius * light.radius), r2 = number(light.radius * light.radius);
  return hn::Mul(hn::Mul(area, height), hn::Mul(positive(dot(centre, n)), inverse(Floats(), hn::Mul(d2, hn::Add(d2, r2)))));
}

std::size_t DiskBy(BatchRule rule, const FlatDisk& light, const PointBatch& points, std::span<float> sr, float where_none) {
  const auto by = [&](auto method) ETENDUE_INLINE_LAMBDA {
    return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
      return method(SeenDisk(light, position, n));
    });
  };
  switch (rule) {
    case BatchRule::patch_without_horizon:
      return by([](const SeenDisk& s) ETENDUE_INLINE_LAMBDA { return facing_disk_without_horizon(s); });
    case BatchRule::patch:
      return by([](const SeenDisk& s) ETENDUE_INLINE_LAMBDA { return facing_disk(s); });
    case BatchRule::sphere_or_disk:
      return by([](const SeenDisk& s) ETENDUE_INLINE_LAMBDA { return disk_as_cap(s); });
    case BatchRule::nodes_1:
      return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
        return disk_by_centre(light, position, n);
      });
    default:
      return over_points(points, sr, where_none,
                         [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA { return disk_vector(light, position, n); });
  }
}

// ---- Tubes ----

struct SeenTube {
  Vector3 a, b, axis, n;
  Lanes length, radius;
  HWY_INLINE SeenTube(const Capsule& light, const Vector3& position, const Vector3& surface)
      : a(numbers(light.a) - position),
        b(numbers(light.b) - position),
        axis(numbers(light.axis)),
        n(surface),
        length(number(light.length)),
        radius(number(light.radius)) {}
};
// Listing 13: a facing rectangle as listing 12 has it, and a sphere at the closest point of the axis.
HWY_INLINE Lanes capsule(const SeenTube& t) {
  const Vector3 left = t.axis, forward = unit(along(t.a, left, hn::Neg(dot(t.a, left)))), up = cross(left, forward);
  const Vector3 centre = scaled(t.a + t.b, number(0.5f)), side = scaled(up, t.radius);
  const std::array<Vector3, 4> v{t.a - side, t.a + side, t.b + side, t.b - side};
  std::array<Vector3, 4> planes = v;
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA { planes[i] = unit(cross(v[i], v[(i + 1) % 4])); });
  Lanes omega = number(-2 * pi_single), sum = cosine_towards(centre, t.n);
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    omega = hn::Add(omega, arc_cosine(hn::Neg(dot(planes[i], planes[(i + 1) % 4]))));
    sum = hn::Add(sum, cosine_towards(v[i], t.n));
  });
  const Lanes share = saturate(hn::Div(hn::Neg(dot(t.a, left)), t.length));
  const Vector3 ball = along(t.a, left, hn::Mul(share, t.length));
  const Lanes caps = hn::Mul(cosine_towards(ball, t.n), hn::Div(hn::Mul(t.radius, t.radius), dot(ball, ball)));
  return hn::MulAdd(hn::Mul(omega, sum), number(0.2f), hn::Mul(number(pi_single), caps));
}
HWY_INLINE Lanes line_irradiance(const SeenTube& t, Lanes floor) {
  const Lanes a2 = dot(t.a, t.a), b2 = dot(t.b, t.b), per_a = inverse_sqrt(Floats(), a2), per_b = inverse_sqrt(Floats(), b2);
  const Lanes cosines = hn::MulAdd(dot(t.n, t.a), per_a, hn::Mul(dot(t.n, t.b), per_b));
  const Lanes ab = hn::Mul(hn::Mul(a2, per_a), hn::Mul(b2, per_b));
  return hn::Div(hn::Mul(number(2), saturate(hn::Mul(cosines, number(0.5f)))), hn::Add(hn::Add(ab, dot(t.a, t.b)), floor));
}
HWY_INLINE Lanes intensity_across(const SeenTube& t) {
  return hn::Mul(t.radius, hn::MulAdd(number(2), t.length, hn::Mul(number(pi_single), t.radius)));
}
HWY_INLINE Lanes karis_16(const SeenTube& t) { return hn::Mul(intensity_across(t), line_irradiance(t, number(2))); }
HWY_INLINE Lanes eden_tube(const SeenTube& t) {
  const Vector3 span = scaled(t.axis, t.length);
  const Lanes forward = dot(t.n, span);
  const Lanes share =
      hn::Div(hn::MulSub(dot(t.n, t.a), forward, dot(t.a, span)), hn::NegMulAdd(forward, forward, hn::Mul(t.length, t.length)));
  const Vector3 point = closest_to_ray(along(t.a, span, saturate(share)), t.radius, t.n);
  return hn::Mul(karis_16(t), falloff(dot(point, point)));
}

// Ours. Every place of the axis shows 2 R across it, D / r of that towards the point; D: the point's distance from the axis. The caps
// together show pi R^2 from anywhere: shared out among the places. Gauss and Legendre's, each no lower than the horizon. The guess at a
// root is close enough, a thousandth of the rule's own error.
struct AxisNode {
  float at, share;
};
constexpr std::array<AxisNode, 1> one_place{{{0, 1}}};
constexpr std::array<AxisNode, 2> two_places{{{-0.28867513f, 0.5f}, {0.28867513f, 0.5f}}};
template <std::size_t N>
HWY_INLINE Lanes tube_by_nodes(const Capsule& light, const Vector3& position, const Vector3& n, const std::array<AxisNode, N>& nodes) {
  const Floats d;
  const Vector3 a = numbers(light.a) - position, axis = numbers(light.axis);
  const Vector3 middle = along(a, axis, number(0.5f * light.length));
  const Lanes x = dot(middle, axis), up = dot(middle, n), n_x = dot(n, axis);
  const Lanes across2 = positive(hn::NegMulAdd(x, x, dot(middle, middle)));
  const Lanes side =
      hn::Mul(number(2 * light.radius * light.length), hn::Mul(across2, near_inverse_sqrt(d, hn::Max(across2, number(1e-30f)))));
  const Lanes caps = number(pi_single * light.radius * light.radius);
  Lanes sum = number(0);
  for (const AxisNode& node : nodes) {
    const Lanes at = hn::Add(x, number(node.at * light.length)), near = near_inverse_sqrt(d, hn::MulAdd(at, at, across2));
    const Lanes height = positive(hn::MulAdd(n_x, number(node.at * light.length), up)), shown = hn::MulAdd(side, near, caps);
    sum = hn::MulAdd(hn::Mul(hn::Mul(near, near), hn::Mul(near, number(node.share))), hn::Mul(height, shown), sum);
  }
  return sum;
}
// Three places for the side, and each cap where it is: R^2 times the half angle of its arc, pi / 2 - atan(R x / (D r)) for a thin tube.
constexpr std::array<AxisNode, 3> three_places{{{-0.38729833f, 0.27777778f}, {0, 0.44444444f}, {0.38729833f, 0.27777778f}}};
HWY_INLINE Lanes tube_with_caps(const Capsule& light, const Vector3& position, const Vector3& n) {
  const Floats d;
  const Vector3 a = numbers(light.a) - position, axis = numbers(light.axis);
  const Vector3 middle = along(a, axis, number(0.5f * light.length));
  const Lanes x = dot(middle, axis), up = dot(middle, n), n_x = dot(n, axis);
  const Lanes across2 = hn::Max(hn::NegMulAdd(x, x, dot(middle, middle)), number(1e-12f * light.length * light.length));
  const Lanes per_across = inverse_sqrt(d, across2);
  Lanes sum = number(0);
  for (const AxisNode& node : three_places) {
    const Lanes at = hn::Add(x, number(node.at * light.length)), near2 = inverse(d, hn::MulAdd(at, at, across2));
    const Lanes height = positive(hn::MulAdd(n_x, number(node.at * light.length), up));
    sum = hn::MulAdd(hn::Mul(hn::Mul(near2, near2), number(node.share)), height, sum);
  }
  const Lanes side = hn::Mul(hn::Mul(number(2 * light.radius * light.length), hn::Mul(across2, per_across)), sum);
  const auto end = [&](float to) ETENDUE_INLINE_LAMBDA {
    const Lanes at = hn::Add(x, number(to)), near = inverse_sqrt(d, hn::MulAdd(at, at, across2)),
                height = positive(hn::MulAdd(n_x, number(to), up));
    const Lanes out = to > 0 ? at : hn::Neg(at);
    const Lanes q = within(hn::Mul(hn::Mul(out, near), hn::Mul(number(light.radius), per_across)), number(4));
    // atan q to 5e-3.
    const Lanes turned = hn::Mul(q, near_inverse(hn::MulAdd(hn::Mul(q, q), number(0.28f), number(1))));
    const Lanes half = positive(hn::Sub(number(pi_single / 2), turned));
    return hn::Mul(hn::Mul(hn::Mul(near, near), near), hn::Mul(height, half));
  };
  const Lanes caps = hn::Add(end(-0.5f * light.length), end(0.5f * light.length));
  return hn::MulAdd(number(light.radius * light.radius), caps, side);
}

std::size_t TubeBy(BatchRule rule, const Capsule& light, const PointBatch& points, std::span<float> sr, float where_none) {
  const auto by = [&](auto method) ETENDUE_INLINE_LAMBDA {
    return over_points(points, sr, where_none, [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA {
      return method(SeenTube(light, position, n));
    });
  };
  const auto ours = [&](auto method) ETENDUE_INLINE_LAMBDA {
    return over_points(points, sr, where_none,
                       [&](const Vector3& position, const Vector3& n) ETENDUE_INLINE_LAMBDA { return method(position, n); });
  };
  switch (rule) {
    case BatchRule::capsule:
      return by([](const SeenTube& t) ETENDUE_INLINE_LAMBDA { return capsule(t); });
    case BatchRule::karis_line:
      return by([](const SeenTube& t) ETENDUE_INLINE_LAMBDA {
        return hn::Mul(hn::Mul(number(2), hn::Mul(t.radius, t.length)), line_irradiance(t, number(0)));
      });
    case BatchRule::karis_line_16:
      return by([](const SeenTube& t) ETENDUE_INLINE_LAMBDA { return karis_16(t); });
    case BatchRule::eden_tube:
      return by([](const SeenTube& t) ETENDUE_INLINE_LAMBDA { return eden_tube(t); });
    case BatchRule::nodes_1:
      return ours([&](const Vector3& p, const Vector3& n) ETENDUE_INLINE_LAMBDA { return tube_by_nodes(light, p, n, one_place); });
    case BatchRule::nodes_2:
      return ours([&](const Vector3& p, const Vector3& n) ETENDUE_INLINE_LAMBDA { return tube_by_nodes(light, p, n, two_places); });
    default:
      return ours([&](const Vector3& p, const Vector3& n) ETENDUE_INLINE_LAMBDA { return tube_with_caps(light, p, n); });
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(BallBy);
HWY_EXPORT(DiskBy);
HWY_EXPORT(TubeBy);

std::size_t sphere_by(BatchRule rule, const Ball& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return HWY_DYNAMIC_DISPATCH(BallBy)(rule, light, points, sr, where_none);
}
std::size_t disk_by(BatchRule rule, const FlatDisk& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return HWY_DYNAMIC_DISPATCH(DiskBy)(rule, light, points, sr, where_none);
}
std::size_t tube_by(BatchRule rule, const Capsule& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return HWY_DYNAMIC_DISPATCH(TubeBy)(rule, light, points, sr, where_none);
}

}  // namespace etendue::eval
#endif
