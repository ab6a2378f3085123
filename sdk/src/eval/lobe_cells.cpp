#include "lobe_cells.h"

#include "fresnel.h"
#include "gauss_rule.h"
#include "lobe_nodes.h"
#include "microfacet.h"

#include <cmath>

namespace etendue::eval {

DiskLobe::DiskLobe(const GgxLobe& lobe, const Vec3d& v)
    : alpha(std::max(lobe.alpha, min_alpha)),
      masking(lobe.masking),
      view(v),
      view_root(std::sqrt(v.z * v.z + alpha * alpha * (1 - v.z * v.z))),
      k(schlick_masking_k(lobe.masking, alpha)) {}

LobeArc::Place LobeArc::at(const DiskLobe& lobe, double tau) const {
  const double per = 1 / (1 + tau * tau), cs = (1 - tau * tau) * per, sn = 2 * tau * per;
  const Vec3d b = centre + u * cs + v * sn;
  Vec3d l = b, speed = (v * cs - u * sn) * (2 * per);
  if (!unit) {
    const double inverse = 1 / length(b);
    l = b * inverse;
    speed = (speed - l * dot(l, speed)) * inverse;
  }
  const Vec3d h = lobe.view + l;
  const double over = 1 / (lobe.alpha * h.z);
  return {{h.x * over, h.y * over}, (h.x * speed.y - h.y * speed.x) * over * over};
}

double LobeArc::height(double tau) const {
  const double per = 1 / (1 + tau * tau);
  const Vec3d b = centre + u * ((1 - tau * tau) * per) + v * (2 * tau * per);
  return unit ? b.z : b.z / length(b);
}

namespace {

double masked(const DiskLobe& lobe, double nl) {
  const double root = std::sqrt(nl * nl + lobe.alpha * lobe.alpha * (1 - nl * nl));
  switch (lobe.masking) {
    case Masking::correlated:
      return 1 / (2 * (nl * lobe.view_root + lobe.view.z * root));
    case Masking::separable:
      return 1 / ((lobe.view.z + lobe.view_root) * (nl + root));
    default:
      return 1 / (4 * schlick_seen_area(lobe.view.z, lobe.k) * schlick_seen_area(nl, lobe.k));
  }
}

constexpr double far_out = 0.25;
// What is told of a cell's error, in units of what its coefficients say.
constexpr double safety = 3;

// vm = view.m, m2 = |m|^2: with the half vector h along (m.x, m.y, 1), v.h / n.h = vm + v.z and n.l = 2 v.h n.h - v.z.
LobeWeight weight_at(const DiskLobe& lobe, double vm, double m2) {
  const double c = vm + lobe.view.z, per_m = 1 / (1 + m2), nl = std::max((2 * vm + lobe.view.z * (1 - m2)) * per_m, 0.0);
  return {4 * nl * std::max(c, 0.0) * masked(lobe, nl), schlick_weight(c * std::sqrt(per_m))};
}

// From the coefficients of the four highest degrees to the rule's error. Where they fall like rho^-k the rule errs by what they are at 2 N:
// rho^-2 is the larger of the highest two over the larger of the two before, and N + 1 degrees further on they are rho^-(N + 1) of the
// highest. Only four are taken, because what falls more slowly may be hidden below what is seen; of four nodes, whose lower two are the
// mean and the slope, a^(5/2) at least, a the highest of all.
struct Tail {
  std::array<double, told> coefficient{};
  double size = 0;
};
template <std::size_t N>
double left(const Tail& t) {
  if (!(t.size > 0)) return 0;
  const double high = std::max(t.coefficient[0], t.coefficient[1]), low = std::max(t.coefficient[2], t.coefficient[3]);
  const double r = high < low ? high / low : 1, a = t.coefficient[0] / t.size, followed = std::min(high, high * r * r);
  if constexpr (N == 4) return std::max(followed, std::min(high, t.size * a * a * std::sqrt(a)));
  return followed;
}
using Coefficients = std::array<double, told>;
inline void add(Coefficients& sum, double value, const Coefficients& high) {
  for (std::size_t k = 0; k < told; ++k) sum[k] += value * high[k];
}
inline void add_magnitudes(Tail& t, const Coefficients& sum) {
  for (std::size_t k = 0; k < told; ++k) t.coefficient[k] += std::abs(sum[k]);
}

double p_of(const Vec2d& q) {
  const double q2 = q.x * q.x + q.y * q.y;
  return std::sqrt(q2) / (1 + std::sqrt(1 + q2));
}
// 1 - r^2 at the radius that p stands for.
double outside(double p) {
  const double less = (1 - p) * (1 + p), more = 1 / (1 + p * p);
  return less * less * more * more;
}

template <std::size_t NX, std::size_t NT>
void by_gauss(const DiskLobe& lobe, const LobeArc& arc, const LobeFan& fan, LobeCell& cell) {
  const Gauss<NX>& gx = gauss<NX>();
  const Gauss<NT>& gt = gauss<NT>();
  const double base = fan.base;
  alignas(64) std::array<double, LobeNodes::most> plain, risen;
  LobeNodes nodes;
  std::array<double, NX> area{}, turns{};
  const double x_span = cell.x1 - cell.x0, t_span = cell.t1 - cell.t0;
  // Away from the middle the azimuth may turn fast where the outline is far out: of what no longer hangs on p it takes the exact turn.
  const bool far = base > 0 || cell.x0 >= far_out || cell.x1 <= -far_out;
  const Vec2d from = arc.at(lobe, arc.tau_of(cell.x0)).q, to = arc.at(lobe, arc.tau_of(cell.x1)).q;
  const double turn = std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
  const auto p_at = [&](double t, double p1) { return base + t * (p1 - base); };
  // A thin outline has no area that does not hang on p.
  const bool exact_turn = far && (base == 0 || outside(p_of(arc.at(lobe, arc.tau_of(0.5 * (cell.x0 + cell.x1))).q)) < 0.25 * outside(base));
  const double all = exact_turn ? outside(p_at(cell.t0, 1)) - outside(p_at(cell.t1, 1)) : 0;
  // Nodes of one ray from the base; times the factor they add up to what is in it of the remainder.
  const auto add_ray = [&](const Vec2d& q, double factor) {
    const double q2 = q.x * q.x + q.y * q.y, q_length = std::sqrt(q2), per_root = 1 / (1 + std::sqrt(1 + q2));
    const double per_q = q_length > 0 ? 1 / q_length : 0, view_q = lobe.view.x * q.x + lobe.view.y * q.y;
    // p / |q| at both ends.
    const double from_ratio = base > 0 ? base * per_q : 0, way = per_root - from_ratio, row = factor * way * 4 * t_span / pi;
    for (std::size_t j = 0; j < NT; ++j) {
      nodes.add(from_ratio + (cell.t0 + t_span * gt.x[j]) * way, q2, view_q, row * gt.weight[j]);
    }
  };
  cell.turned = 0;
  for (std::size_t i = 0; i < NX; ++i) {
    const double x = cell.x0 + x_span * gx.x[i], inner = 1 / ((1 - x) * (1 + x));
    const LobeArc::Place place = arc.at(lobe, arc.kappa * x * inner);
    const double weight = gx.weight[i] * x_span * arc.kappa * (1 + x * x) * inner * inner * place.turn;
    const double q2 = place.q.x * place.q.x + place.q.y * place.q.y, per_root = 1 / (1 + std::sqrt(1 + q2)), p1 = std::sqrt(q2) * per_root;
    turns[i] = q2 > 0 ? weight / q2 : 0;
    cell.turned += turns[i];
    if (far) {
      area[i] = turns[i] * (outside(p_at(cell.t0, p1)) - outside(p_at(cell.t1, p1)) - all) / (2 * pi);
    } else {
      // r / q = 2 (p / q) / (1 + p^2)
      const auto r_over_q = [&](double t) { return 2 * t * per_root / (1 + t * t * p1 * p1); };
      const double outer = r_over_q(cell.t1), within = r_over_q(cell.t0);
      area[i] = weight * (outer - within) * (outer + within) / (2 * pi);
    }
    add_ray(place.q, weight);
  }
  evaluate(lobe, fan.level, nodes, plain.data(), risen.data());
  // The turn that the nodes have missed, times the most that rays have in them; where it is much, at both ends too.
  const double off = std::abs(turn - cell.turned);
  Risen missed;
  const auto count_ray = [&](const double* plain_row, const double* risen_row, double turned) {
    double plain_sum = 0, risen_sum = 0;
    for (std::size_t j = 0; j < NT; ++j) plain_sum += plain_row[j], risen_sum += risen_row[j];
    const double times = off / std::max(std::abs(turned), 1e-300);
    missed.plain = std::max(missed.plain, times * std::abs(plain_sum)), missed.risen = std::max(missed.risen, times * std::abs(risen_sum));
  };
  if (far) {
    for (std::size_t i = 0; i < NX; ++i) count_ray(&plain[i * NT], &risen[i * NT], turns[i]);
    if (off > 0.01 * std::abs(turn)) {
      nodes.count = 0;
      for (const Vec2d& q : {from, to}) add_ray(q, q.x * q.x + q.y * q.y);
      alignas(64) std::array<double, LobeNodes::most> plain_ends, risen_ends;
      evaluate(lobe, fan.level, nodes, plain_ends.data(), risen_ends.data());
      for (const std::size_t end : {std::size_t{0}, NT}) count_ray(&plain_ends[end], &risen_ends[end], 1);
    }
  }
  double area_sum = 0;
  Tail area_tail;
  Coefficients area_coefficients{};
  for (std::size_t i = 0; i < NX; ++i) {
    add(area_coefficients, area[i], gx.high[i]);
    area_sum += area[i], area_tail.size += std::abs(area[i]);
  }
  add_magnitudes(area_tail, area_coefficients);
  double area_error = left<NX>(area_tail);
  // Nor can the rule be right where it has not seen all of the turn, of which every ray has some area.
  if (!exact_turn) {
    double least = 1;
    for (std::size_t i = 0; i < NX; ++i) least = std::min(least, std::abs(area[i]) / std::max(std::abs(turns[i]), 1e-300));
    area_error = std::max(area_error, least * std::abs(turn - cell.turned));
  }
  area_sum += turn * all / (2 * pi);
  const auto judge = [&](const std::array<double, LobeNodes::most>& f, double level, double ends, double& value, double& error,
                         double& along_x, double& along_t) {
    double sum = 0;
    Tail x, t;
    std::array<Coefficients, NT> columns{};
    for (std::size_t i = 0; i < NX; ++i) {
      Coefficients row{};
      for (std::size_t j = 0; j < NT; ++j) {
        const double v = f[i * NT + j];
        sum += v, x.size += std::abs(v);
        add(row, v, gt.high[j]);
        add(columns[j], v, gx.high[i]);
      }
      add_magnitudes(t, row);
    }
    for (const Coefficients& column : columns) add_magnitudes(x, column);
    t.size = x.size;
    along_x = left<NX>(x) + level * area_error + ends, along_t = left<NT>(t);
    value = sum + level * area_sum, error = safety * (along_x + along_t) + 1e-15 * x.size;
  };
  double px = 0, pt = 0, rx = 0, rt = 0;
  judge(plain, fan.level.plain, missed.plain, cell.value.plain, cell.error.plain, px, pt);
  judge(risen, fan.level.risen, missed.risen, cell.value.risen, cell.error.risen, rx, rt);
  cell.split_x = px + rx > pt + rt;
}

}  // namespace

LobeWeight weight_at(const DiskLobe& lobe, const Vec2d& m) {
  return weight_at(lobe, lobe.view.x * m.x + lobe.view.y * m.y, m.x * m.x + m.y * m.y);
}

void evaluate(const DiskLobe& lobe, const LobeArc& arc, const LobeFan& fan, LobeRule rule, LobeCell& cell) {
  switch (rule) {
    case LobeRule::gauss6x4:
      return by_gauss<6, 4>(lobe, arc, fan, cell);
    case LobeRule::gauss6x6:
      return by_gauss<6, 6>(lobe, arc, fan, cell);
    case LobeRule::gauss8x6:
      return by_gauss<8, 6>(lobe, arc, fan, cell);
    case LobeRule::gauss10x8:
      return by_gauss<10, 8>(lobe, arc, fan, cell);
  }
}

}  // namespace etendue::eval
