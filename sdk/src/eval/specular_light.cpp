// Adaptive evaluation in the disk in which GGX is uniform (lobe_cells.h): where cells begin, and which are halved.
#include "etendue/specular_light.h"

#include "fresnel.h"
#include "lobe_cells.h"
#include "lobe_grading.h"
#include "lobe_slopes.h"
#include "local.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace etendue::eval {
namespace {

constexpr std::size_t most_cells = 20000;
// Part of what is allowed that is left to what no cell is laid out for.
constexpr double neglected = 0.25;
constexpr double most_cancelled = 10;  // times the light

double angle_between(const Vec2d& a, const Vec2d& b) { return std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y); }
Vec2d stereographic(const Vec2d& q) {
  const double per = 1 / (1 + std::sqrt(1 + squared(q)));
  return {q.x * per, q.y * per};
}

// Arcs of one outline, up to `last`, and their fan.
struct Outline {
  std::size_t first = 0, last = 0;
  LobeFan fan;
};

class Adaptive {
 public:
  Adaptive(const GgxLobe& ggx, const Vec3d& view, double tolerance)
      : ggx_(ggx),
        lobe_(ggx, view),
        tolerance_(tolerance),
        rule_(lobe_rule_for(tolerance)),
        negligible_(neglected * tolerance / contrast()) {}

  void add(const Contour& lit) {
    Outline outline{arcs_.size(), arcs_.size(), {}};
    double turned = 0;
    std::vector<Vec2d> places;
    Vec2d nearest{1e300, 0};
    for (const Arc& arc : lit) {
      // A rim at a slant is a thin ellipse, whose sides come near on their own.
      const int parts = std::max(1, static_cast<int>(std::ceil((arc.end - arc.begin) / ((arc.unit ? 0.5 : 0.25) * pi) - 1e-9)));
      const double span = (arc.end - arc.begin) / parts;
      for (int i = 0; i < parts; ++i) {
        Arc part = arc;
        part.begin = arc.begin + i * span;
        part.end = i + 1 == parts ? arc.end : part.begin + span;
        const double s0 = nearest_to_lobe(lobe_.view, lobe_.alpha, part);
        const HalfSlopes at = half_slopes(lobe_.view, lobe_.alpha, part, s0);
        arcs_.push_back(lobe_arc(part, s0, at));
        const Vec2d from = half_slopes(lobe_.view, lobe_.alpha, part, part.begin).q,
                    to = half_slopes(lobe_.view, lobe_.alpha, part, part.end).q;
        turned += angle_between(from, at.q) + angle_between(at.q, to);
        if (squared(at.q) < squared(nearest)) nearest = at.q;
        for (const Vec2d& q : {at.q, from, to}) places.push_back(stereographic(q));
      }
    }
    outline.last = arcs_.size();
    // Fans begin in the middle of the lobe if it is within, or is as good as within. Else they begin at the outline's nearest place: what
    // is nearer would be added and taken out again.
    double size = 0;
    for (const Vec2d& p : places) size = std::max(size, std::hypot(p.x - places[0].x, p.y - places[0].y));
    const double least = std::sqrt(squared(stereographic(nearest)));
    const bool apart = std::abs(turned) < 1 && (least > 0.25 * size || least > 0.4);
    outline.fan.base = apart ? least : 0;
    const LobeWeight level = weight_at(lobe_, apart ? Vec2d{lobe_.alpha * nearest.x, lobe_.alpha * nearest.y} : Vec2d{});
    outline.fan.level = {level.shape * (1 - level.w), level.shape * level.w};
    outlines_.push_back(outline);
  }

  // Of a light of the luminance 1. floor(): what the tolerance is a part of where the value is less, asked for if it may be or `always`.
  // Nothing where too much cancels: a thin light at the horizon, seen along it.
  template <class Floor>
  std::optional<Estimate> integrate(const Floor& floor_of, bool always) {
    begin_all();
    add_up();
    floor_ = always || largest_value() < 1e-3 * pi ? floor_of() : 0;
    // What is negligible is so beside the light, not beside what cancels.
    double size = 0, light = 0;
    for (int c = 0; c < 3; ++c) {
      light = std::max({light, of_channel(c, value_), floor_});
      double sum = 0;
      for (const LobeCell& cell : cells_) sum += std::abs(of_channel(c, cell.value));
      size = std::max(size, sum);
    }
    if (size > most_cancelled * light) return std::nullopt;
    if (size > 4 * light) {
      negligible_ *= light / size;
      cells_.clear();
      begin_all();
      add_up();
    }
    if (excess(error_, aims()) > 1) refine();
    // 1 - p is alpha where the slopes are 1.
    const double rounding = 1e-13 + 1e-15 / lobe_.alpha;
    Estimate estimate;
    estimate.evaluations = evaluations_;
    for (int c = 0; c < 3; ++c) {
      const double v = of_channel(c, value_);
      estimate.value[c] = std::max(v, 0.0);
      estimate.error[c] = of_channel(c, error_) + neglected * allowed(c) + rounding * std::abs(v) + std::max(-v, 0.0);
    }
    return estimate;
  }

 private:
  // How much more of the light than at the middle of the lobe facets may send elsewhere: Schlick's weight is highest where the light comes
  // from the horizon opposite to the view, v.l = -sin, and the rest of W may be some times what it is in the middle.
  double contrast() const {
    const double sine = std::sqrt((1 - lobe_.view.z) * (1 + lobe_.view.z)), f0 = std::max({ggx_.f0.x, ggx_.f0.y, ggx_.f0.z, 1e-3});
    const auto reflectance = [&](double v_dot_h) { return f0 + (ggx_.f90 - f0) * schlick_weight(v_dot_h); };
    return 4 * std::max(1.0, reflectance(std::sqrt(0.5 * (1 - sine))) / reflectance(lobe_.view.z));
  }

  LobeArc lobe_arc(const Arc& part, double s0, const HalfSlopes& at) const {
    const double cs = std::cos(s0), sn = std::sin(s0);
    LobeArc arc{part.centre, part.u * cs + part.v * sn, part.v * cs - part.u * sn, part.unit};
    // d q / d tau is twice d q / d s there.
    arc.kappa = std::min(std::sqrt((1 + squared(at.q)) / std::max(squared(at.speed), 1e-300)), 1e3);
    arc.x0 = arc.x_of(std::tan(0.5 * (part.begin - s0)));
    arc.x1 = arc.x_of(std::tan(0.5 * (part.end - s0)));
    arc.horizon = part.great_circle() && std::abs(part.u.z) < 1e-14 && std::abs(part.v.z) < 1e-14;
    return arc;
  }

  const LobeFan& fan_of(std::size_t arc) const {
    return std::upper_bound(outlines_.begin(), outlines_.end(), arc, [](std::size_t a, const Outline& o) { return a < o.last; })->fan;
  }

  // ---- First cells ----

  double layer() const { return std::min(lobe_.alpha, lobe_.view.z); }

  // Both ends of an arc, where it ends at the horizon.
  void grade_ends(std::vector<double>& xs, const LobeArc& arc) const {
    for (const bool at_end : {false, true}) {
      const double from = arc.tau_of(at_end ? arc.x1 : arc.x0), way = arc.tau_of(at_end ? arc.x0 : arc.x1) - from, step = 1e-3;
      const double low = arc.height(from), slope = (arc.height(from + step * way) - low) / step;
      if (slope > 0)
        grade_heights(layer(), negligible_, low, slope, false, [&](double h) { xs.push_back(arc.x_of(from + (h - low) / slope * way)); });
    }
  }
  // n.l at the outer end of the ray to x, and how it rises inwards.
  struct Rise {
    double low = 0, slope = 0;
  };
  Rise rise_at(const LobeArc& arc, double base, double x) const {
    const Vec2d q = arc.at(lobe_, arc.tau_of(x)).q;
    const double q_length = std::sqrt(squared(q)), p1 = std::sqrt(squared(stereographic(q)));
    const auto height = [&](double t) {
      const double p = base + t * (p1 - base), stretch = 2 * p / ((1 - p) * (1 + p)) * lobe_.alpha / q_length;
      const double vm = stretch * (lobe_.view.x * q.x + lobe_.view.y * q.y), m2 = stretch * stretch * squared(q);
      return (2 * vm + lobe_.view.z * (1 - m2)) / (1 + m2);
    };
    constexpr double step = 1e-3;
    const double low = std::max(height(1), 0.0);
    return {low, (height(1 - step) - low) / step};
  }

  // Cells of a part of an arc between two parts of its rays, which are cut where the integrand bends along them.
  void add_cells(std::vector<LobeCell>& cells, std::uint32_t index, double x0, double x1, double t0, double t1) {
    const LobeArc& arc = arcs_[index];
    const double base = fan_of(index).base, x = 0.5 * (x0 + x1);
    const double p = std::sqrt(squared(stereographic(arc.at(lobe_, arc.tau_of(x)).q))), length = p - base;
    std::vector<double> ts{t0, t1};
    const auto mark = [&](double t) {
      if (t > t0 && t < t1) ts.push_back(t);
    };
    if (t1 == 1) {
      const bool along = std::max({arc.height(arc.tau_of(x0)), arc.height(arc.tau_of(x)), arc.height(arc.tau_of(x1))}) < 4 * layer();
      Rise steepest;
      for (const double at : {x0, x, x1})
        if (const Rise rise = rise_at(arc, base, at); rise.slope > steepest.slope) steepest = rise;
      if (steepest.slope > 0)
        grade_heights(layer(), negligible_, steepest.low, steepest.slope, along,
                      [&](double h) { mark(1 - (h - steepest.low) / steepest.slope); });
    }
    grade_rim(lobe_.alpha, 1 - base, 1 - p, negligible_, tolerance_, [&](double away) { mark((1 - away - base) / length); });
    std::sort(ts.begin(), ts.end());
    for (std::size_t k = 0; k + 1 < ts.size(); ++k) {
      LobeCell cell;
      cell.arc = index;
      cell.x0 = x0, cell.x1 = x1, cell.t0 = ts[k], cell.t1 = ts[k + 1];
      cell.rim = length > 1e-9 * base ? (1 - base) / length : 1e30;
      measure(cell);
      cells.push_back(cell);
    }
  }

  // Far out along an outline (|x| > 1/2 is 4/3 of the lobe's fall) cells take the exact turn of its azimuth.
  void begin(const Outline& outline) {
    constexpr double far = 0.5, long_way = 0.8;
    for (std::size_t i = outline.first; i < outline.last; ++i) {
      const LobeArc& arc = arcs_[i];
      if (!(arc.x1 > arc.x0)) continue;
      std::vector<double> xs{arc.x0, arc.x1};
      if (arc.x1 > long_way) xs.push_back(std::max(far, arc.x0));
      if (arc.x0 < -long_way) xs.push_back(std::min(-far, arc.x1));
      if (arc.x1 > 0.6 && arc.x0 < -0.6) xs.push_back(0);
      if (!arc.horizon) grade_ends(xs, arc);
      std::sort(xs.begin(), xs.end());
      for (std::size_t j = 0; j + 1 < xs.size(); ++j)
        if (xs[j + 1] > xs[j]) add_cells(cells_, static_cast<std::uint32_t>(i), xs[j], xs[j + 1], 0, 1);
    }
  }

  void begin_all() {
    for (Outline& outline : outlines_) {
      const std::size_t before = cells_.size();
      begin(outline);
      // If the outline turns about the middle all the same.
      double turned = 0;
      for (std::size_t i = before; i < cells_.size(); ++i) turned += cells_[i].t1 == 1 ? cells_[i].turned : 0;
      if (outline.fan.base > 0 && std::abs(turned) > 1) {
        cells_.resize(before);
        outline.fan.base = 0;
        begin(outline);
      }
    }
  }

  void measure(LobeCell& cell) {
    evaluate(lobe_, arcs_[cell.arc], fan_of(cell.arc), rule_, cell);
    evaluations_ += nodes_of(rule_);
  }

  // ---- Refinement ----

  double of_channel(int c, const Risen& r) const { return ggx_.f0[c] * r.plain + ggx_.f90 * r.risen; }
  double largest_value() const { return std::max({of_channel(0, value_), of_channel(1, value_), of_channel(2, value_)}); }
  double allowed(int c) const { return tolerance_ * std::max(of_channel(c, value_), floor_); }
  Rgb aims() const { return Rgb{allowed(0), allowed(1), allowed(2)} * (1 - neglected); }
  // An error in units of what is aimed at, in the worst channel.
  double excess(const Risen& error, const Rgb& aims) const {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
      const double off = of_channel(c, error);
      if (off > 0) worst = std::max(worst, off / std::max(aims[c], 1e-300));
    }
    return worst;
  }
  void add_up() {
    value_ = error_ = {};
    for (const LobeCell& c : cells_) add(c, 1);
  }
  void add(const LobeCell& cell, double times) {
    value_.plain += times * cell.value.plain, value_.risen += times * cell.value.risen;
    error_.plain += times * cell.error.plain, error_.risen += times * cell.error.risen;
  }

  void refine() {
    // Cells are ordered by one measure all along, whatever becomes of the value.
    const Rgb first_aims = aims();
    std::vector<std::pair<double, std::size_t>> queue;
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    for (std::size_t i = 0; i < cells_.size(); ++i) queue.emplace_back(excess(cells_[i].error, first_aims), i);
    std::make_heap(queue.begin(), queue.end(), less);
    std::vector<LobeCell> children;
    while (excess(error_, aims()) > 1 && cells_.size() < most_cells) {
      std::pop_heap(queue.begin(), queue.end(), less);
      const auto [priority, index] = queue.back();
      if (!(priority > 0)) break;
      queue.pop_back();
      const LobeCell parent = cells_[index];
      halve(parent, children);
      distrust(parent, children);
      add(parent, -1);
      for (std::size_t i = 0; i < children.size(); ++i) {
        add(children[i], 1);
        const std::size_t at = i == 0 ? index : cells_.size();
        if (i == 0) {
          cells_[index] = children[i];
        } else {
          cells_.push_back(children[i]);
        }
        queue.emplace_back(excess(children[i].error, first_aims), at);
        std::push_heap(queue.begin(), queue.end(), less);
      }
    }
    add_up();
  }
  void halve(const LobeCell& parent, std::vector<LobeCell>& children) {
    children.clear();
    if (parent.split_x) {
      const double middle = split_towards_rim(parent.x0, parent.x1, 1.0);
      add_cells(children, parent.arc, parent.x0, middle, parent.t0, parent.t1);
      add_cells(children, parent.arc, middle, parent.x1, parent.t0, parent.t1);
      return;
    }
    children = {parent, parent};
    children[0].t1 = children[1].t0 = split_towards_rim(parent.t0, parent.t1, parent.rim);
    for (LobeCell& child : children) measure(child);
  }
  // The parts know how wrong the whole was. If that is more than it had admitted, they share the blame.
  static void distrust(const LobeCell& parent, std::vector<LobeCell>& children) {
    for (double Risen::*part : {&Risen::plain, &Risen::risen}) {
      double sum = 0;
      for (const LobeCell& child : children) sum += child.value.*part;
      const double wrong = std::abs(sum - parent.value.*part), admitted = parent.error.*part;
      if (wrong <= admitted) continue;
      const double factor = std::min(wrong / std::max(admitted, 1e-300), 100.0);
      for (LobeCell& child : children) child.error.*part = std::min(child.error.*part * factor, std::max(child.error.*part, wrong));
    }
  }

  GgxLobe ggx_;
  DiskLobe lobe_;
  double tolerance_;
  LobeRule rule_;
  double negligible_;  // part of the light
  std::vector<LobeArc> arcs_;
  std::vector<Outline> outlines_;
  std::vector<LobeCell> cells_;
  Risen value_, error_;
  double floor_ = 0;
  std::uint64_t evaluations_ = 0;
};

double brightest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

}  // namespace

std::optional<Estimate> specular_luminance(const Emitter& emitter, const ShadingPoint& point, double tolerance, double least) {
  const std::optional<GgxLobe> lobe = round_ggx(point.brdf);
  if (!lobe || !is_uniform_area_light(emitter)) return std::nullopt;
  const LocalFrame frame(point.position, point.normal);
  const Vec3d view = frame.vector(point.view);
  const Rgb luminance = luminance_of(emitter);
  if (!(view.z > 0) || !(brightest(luminance) > 0)) return Estimate{};
  constexpr double tightest = 1e-9;
  Adaptive adaptive(*lobe, view, std::clamp(tolerance, tightest, 1.0));
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  each_outline(emitter, frame, [&](const Contour& outline, std::size_t) {
    if (const Contour lit = clipped(outline, horizons); !lit.empty()) adaptive.add(lit);
  });
  const auto floor = [&] {
    return std::max(1e-3 * brightest(illuminance(emitter, point.position, point.normal)), least) / brightest(luminance);
  };
  const std::optional<Estimate> found = adaptive.integrate(floor, least > 0);
  // The reference's fans stand in the light. At grazing views its own errors are only to be believed where it is asked for little.
  const double closely = std::min(tolerance, 1e-4);
  if (!found) return reference(emitter, point, {closely, closely * floor() * brightest(luminance)});
  Estimate estimate = *found;
  estimate.value = estimate.value * luminance;
  estimate.error = estimate.error * luminance;
  return estimate;
}

}  // namespace etendue::eval
