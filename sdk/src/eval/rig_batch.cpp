// Points are put next to their neighbours (point_blocks.h). A group of them walks the tree of the lights' bounds; what it ends with, lights
// and parts of the tree, is where each of its blocks begins. There bounds are drawn closer and lights evaluated, what leaves the largest
// error first, until the bounds of all that is left are within the tolerance at every point. Where half of the points are done they leave
// the block, and the others go on with closer bounds. (Greedy refinement by bounds: Walter et al. 2005, Lightcuts.)
#include "etendue/rig_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "batch_error.h"
#include "light_bound.h"
#include "point_blocks.h"

namespace etendue::eval {
namespace {

constexpr std::size_t block_size = 128, few = 8;
constexpr std::size_t points_at_once = std::size_t{1} << 20;
// Of LightBatch: of the value, and of what a surface facing the light gets.
constexpr double batch_error = 1e-5, batch_error_of_reach = 2e-6;
// Half a unit in the last place, which every term adds to a sum, and its own product and factor to it.
constexpr double float_rounding = 6e-8, double_rounding = 1.2e-16;
// Up to this share of the tolerance a group leaves parts of the tree whole.
constexpr double share_of_parts = 0.2;
// Bounds cost much less than an evaluation that they may spare: a light's error counts for so much beside those of what has bounds yet to
// be drawn closer.
constexpr double bounds_first = 0.1;

struct Node {
  LightBound bound;
  std::uint32_t lights, light;  // how many; of one, which
  std::uint32_t left, right;    // 0: one light
  Rgb tint;                     // of their light, 1 in the largest channel of each
  double spread;                // no channel of a light is further from the tint
};
double largest(const Rgb& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

struct Light {
  std::optional<LightBatch> batch;  // none: one point after the other, in double
  Rgb colour;                       // of the emission
};
// One without an upper bound, though perhaps with one of where it is seen.
struct Unbounded {
  std::uint32_t light;
  std::optional<LightBound> place;
};

// What is not decided yet: one light or a part of the tree. Where all of it is seen for certain, the middle of its bounds stands for it,
// else nothing; and how far that is off at most, in any channel.
struct Entry {
  double middle, error, reach;
  double rank;  // what is done first
  std::uint32_t node;
  std::uint32_t boxes;  // of which of the boxes its bounds are: they hold within

  double most() const { return middle + error; }
};

// A heap, the largest rank first, and sums over it that are kept up to date as entries come and go.
class Undecided {
 public:
  bool empty() const { return heap_.empty(); }
  double error() const { return unlimited_ > 0 ? Box::infinite : error_ + drift_; }
  double standing() const { return standing_; }  // of the middles
  const Rgb& middle() const { return middle_; }  // with their tints
  std::uint64_t lights() const { return lights_; }

  void clear() {
    heap_.clear();
    reset();
  }
  void push(const Entry& e, const Node& node) {
    heap_.push_back(e);
    std::push_heap(heap_.begin(), heap_.end(), Lower());
    count(e, node, 1);
    lights_ += node.lights;
  }
  const Entry& largest() const { return heap_.front(); }
  void pop(const Node& node) {
    const Entry e = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(), Lower());
    heap_.pop_back();
    count(e, node, -1);
    lights_ -= node.lights;
    if (heap_.empty()) reset();
  }

 private:
  struct Lower {
    bool operator()(const Entry& a, const Entry& b) const { return a.rank < b.rank; }
  };
  void count(const Entry& e, const Node& node, int sign) {
    if (!std::isfinite(e.error)) {
      sign > 0 ? ++unlimited_ : --unlimited_;
      return;
    }
    drift_ += double_rounding * (error_ + e.error + standing_ + e.middle);
    error_ += sign * e.error;
    standing_ += sign * e.middle;
    middle_ += node.tint * (sign * e.middle);
  }
  void reset() {
    error_ = drift_ = standing_ = 0;
    middle_ = {};
    unlimited_ = 0;
    lights_ = 0;
  }

  std::vector<Entry> heap_;
  double error_ = 0, standing_ = 0;
  double drift_ = 0;  // more than what both are rounded by
  Rgb middle_;
  std::size_t unlimited_ = 0;  // whose error is infinite
  std::uint64_t lights_ = 0;
};

Surroundings surroundings_of(std::span<const PlacedPoint> points, const Vec3d& origin) {
  std::array<float, 6> low = points[0].at, high = low;
  for (const PlacedPoint& p : points) {
    for (std::size_t k = 0; k < 6; ++k) low[k] = p.at[k] < low[k] ? p.at[k] : low[k];
    for (std::size_t k = 0; k < 6; ++k) high[k] = p.at[k] > high[k] ? p.at[k] : high[k];
  }
  Box positions, normals;
  for (const std::array<float, 6>& c : {low, high}) {
    positions.add(Vec3d{c[0], c[1], c[2]});
    normals.add(Vec3d{c[3], c[4], c[5]});
  }
  Surroundings s{Around::positions(positions), Around::directions(normals)};
  // Sums with the origin are rounded again.
  for (int i = 0; i < 3; ++i) s.positions.half[i] += 2e-15 * std::abs(origin[i]);
  s.positions.middle += origin;
  return s;
}

// Points in work.
struct Block {
  std::size_t count = 0;
  std::array<PlacedPoint, block_size> points;
  std::array<std::array<float, block_size>, 6> columns;
  Surroundings surroundings;

  std::span<const PlacedPoint> all() const { return {points.data(), count}; }
  void add(const PlacedPoint& p) { points[count++] = p; }
  // Once the points are there. Columns are whole vectors: the last point is repeated.
  void settle(const Vec3d& origin) {
    surroundings = surroundings_of(all(), origin);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 6; ++k) columns[k][i] = points[i].at[k];
    for (std::size_t k = 0; k < 6; ++k) std::fill(columns[k].begin() + count, columns[k].begin() + padded(), columns[k][count - 1]);
  }
  std::size_t padded() const { return std::min((count + 15) / 16 * 16, block_size); }
  PointBatch batch(const Vec3d& origin) const {
    const auto column = [this](std::size_t k) { return std::span(columns[k].data(), padded()); };
    return {column(0), column(1), column(2), column(3), column(4), column(5), origin};
  }
  Vec3d position(std::size_t i, const Vec3d& origin) const { return origin + Vec3d{points[i].at[0], points[i].at[1], points[i].at[2]}; }
  Vec3d normal(std::size_t i) const { return normalised(Vec3d{points[i].at[3], points[i].at[4], points[i].at[5]}); }
};

template <class T>
struct Sums {
  std::array<T, block_size> r, g, b;
  std::array<bool, block_size> done;
};

float as_float(double x) {
  constexpr double most = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(x, -most, most));
}

bool below_horizon(const DistantEmitter& e, const Around& normals) {
  double highest = dot(e.towards, normals.middle);
  for (int i = 0; i < 3; ++i) highest += std::abs(e.towards[i]) * normals.half[i];
  return highest < -std::sin(std::min(e.radius_rad, 0.5 * pi)) - 1e-6;
}

}  // namespace

struct RigBatch::Prepared {
  std::vector<Emitter> emitters;
  std::vector<Light> lights;
  std::vector<Node> nodes;  // the first is the root
  std::vector<Unbounded> unbounded;
  bool out_of_gamut = false;  // some light has a negative channel

  std::uint32_t build(std::span<const LightBound> bounds, std::span<std::uint32_t> which);
};

struct RigBatch::Workspace::Parts {
  PointBlocks points;
  Undecided parts;     // of the tree, on a group's way through it
  Undecided of_group;  // where it ends
  Undecided open;      // of a block
  Block block, again;
  std::vector<PlacedPoint> waiting;
  Sums<float> sums;
  Sums<double> exact;
  std::array<float, block_size> values;
};

// Halves of equal number across the longest edge of the box of the lights' middles.
std::uint32_t RigBatch::Prepared::build(std::span<const LightBound> bounds, std::span<std::uint32_t> which) {
  const auto at = static_cast<std::uint32_t>(nodes.size());
  const auto lights_here = static_cast<std::uint32_t>(which.size());
  const Rgb& colour = lights[which[0]].colour;
  nodes.push_back({bounds[which[0]], lights_here, which[0], 0, 0, largest(colour) > 0 ? colour / largest(colour) : Rgb{}, 0});
  if (lights_here == 1) return at;
  const auto middle = [&](std::uint32_t i) { return bounds[i].places.middle; };
  Box middles;
  for (const std::uint32_t i : which) middles.add(middle(i));
  const Vec3d edge = middles.high - middles.low;
  const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
  const std::size_t half = which.size() / 2;
  std::nth_element(which.begin(), which.begin() + static_cast<std::ptrdiff_t>(half), which.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return middle(a)[axis] < middle(b)[axis]; });
  const std::uint32_t left = build(bounds, which.first(half)), right = build(bounds, which.subspan(half));
  const Node &a = nodes[left], &b = nodes[right];
  Node both{joined(a.bound, b.bound), lights_here, 0, left, right, a.tint, 0};
  const double emitted_a = a.bound.around + a.bound.facing, emitted = both.bound.around + both.bound.facing;
  const double share = emitted > 0 ? emitted_a / emitted : 0.5;
  both.tint = a.tint * share + b.tint * (1 - share);
  both.spread = std::max(a.spread + largest(a.tint - both.tint), b.spread + largest(b.tint - both.tint));
  nodes[at] = both;
  return at;
}

RigBatch::RigBatch(std::vector<Emitter> emitters) {
  auto prepared = std::make_unique<Prepared>();
  std::vector<LightBound> bounds(emitters.size());
  std::vector<std::uint32_t> bounded;
  for (std::uint32_t i = 0; i < emitters.size(); ++i) {
    const Emitter& e = emitters[i];
    Light light{std::nullopt, e.radiance};
    if (Result<LightBatch> batch = LightBatch::of(e)) {
      light.colour = batch->scale();
      light.batch = std::move(*batch);
    }
    prepared->out_of_gamut = prepared->out_of_gamut || std::min({light.colour.x, light.colour.y, light.colour.z}) < 0;
    prepared->lights.push_back(std::move(light));
    if (const std::optional<LightBound> bound = light_bound(e)) {
      bounds[i] = *bound;
      bounded.push_back(i);
    } else {
      Emitter plain = e;
      plain.pattern = {};
      plain.radiance = {1, 1, 1};
      prepared->unbounded.push_back({i, light_bound(plain)});
    }
  }
  prepared->emitters = std::move(emitters);
  prepared->nodes.reserve(2 * bounded.size());
  if (!bounded.empty()) prepared->build(bounds, bounded);
  prepared_ = std::move(prepared);
}
RigBatch::~RigBatch() = default;
RigBatch::RigBatch(RigBatch&&) noexcept = default;
RigBatch& RigBatch::operator=(RigBatch&&) noexcept = default;
const std::vector<Emitter>& RigBatch::emitters() const { return prepared_->emitters; }

RigBatch::Workspace::Workspace() : parts_(std::make_unique<Parts>()) {}
RigBatch::Workspace::~Workspace() = default;
RigBatch::Workspace::Workspace(Workspace&&) noexcept = default;
RigBatch::Workspace& RigBatch::Workspace::operator=(Workspace&&) noexcept = default;

struct RigBatch::Run {
  const Prepared& rig;
  Workspace::Parts& work;
  Vec3d origin;
  double absolute, relative;
  std::span<Vec3f> lux;
  std::span<float> bound;
  RigCounts& counts;

  std::uint32_t boxes = 0;  // counts those of groups and blocks

  // Of a block.
  double reached = 0;  // what no point has more of from what is evaluated
  double reach = 0;    // that of Bound, of the same
  std::size_t terms = 0;
  bool repeating = false;

  Entry entry(std::uint32_t node, const Surroundings& where, bool of_block = true) {
    ++counts.bounds;
    const Node& n = rig.nodes[node];
    const double rank = of_block && n.left == 0 ? bounds_first : 1;
    const Bound b = bound_at(n.bound, where);
    const double error = 0.5 * (b.most - b.least) + n.spread * b.most;
    if (!(b.least > 0 && error < b.most)) return {0, b.most, b.reach, rank * b.most, node, boxes};
    return {0.5 * (b.most + b.least), error, b.reach, rank * error, node, boxes};
  }
  bool is_light(const Entry& e) const { return rig.nodes[e.node].left == 0; }
  void unseen(const Entry& e, std::size_t points) {
    if (!repeating) counts.skipped_unseen += rig.nodes[e.node].lights * points;
  }

  void walk(std::span<const PlacedPoint> points);
  void blocks(std::span<const PlacedPoint> points);
  void repeat();

  template <class T>
  void solve(Sums<T>& sums);
  void push(const Entry& e);
  void settle();
  template <class T>
  void evaluate(std::uint32_t light, double most, double reach_of_it, Sums<T>& sums);
  template <class T>
  void evaluate_unbounded(Sums<T>& sums);
  template <class T>
  std::size_t judge(Sums<T>& sums);
  template <class T>
  void leave(Sums<T>& sums, bool all);

  // e = part P + rest_of_error is what the error may be where the sum is P.
  double part = 0, rest_of_error = 0;
};

void RigBatch::Run::walk(std::span<const PlacedPoint> points) {
  const Surroundings here = surroundings_of(points, origin);
  ++boxes;
  work.of_group.clear();
  work.parts.clear();
  double lights = 0;
  const auto offer = [&](std::uint32_t node) {
    const Entry e = entry(node, here, false);
    if (!(e.most() > 0)) return unseen(e, points.size());
    const bool one = is_light(e);
    (one ? work.of_group : work.parts).push(e, rig.nodes[node]);
    if (one && std::isfinite(e.error)) lights += e.most();
  };
  if (!rig.nodes.empty()) offer(0);
  while (!work.parts.empty() && !(work.parts.error() <= share_of_parts * std::max(absolute, relative * (lights + work.parts.standing())))) {
    const Node& node = rig.nodes[work.parts.largest().node];
    work.parts.pop(node);
    offer(node.left);
    offer(node.right);
  }
  while (!work.parts.empty()) {
    const Entry e = work.parts.largest();
    work.parts.pop(rig.nodes[e.node]);
    work.of_group.push(e, rig.nodes[e.node]);
  }
}

// Equal parts: none is short.
void RigBatch::Run::blocks(std::span<const PlacedPoint> points) {
  Block& block = work.block;
  for (std::size_t parts = (points.size() + block_size - 1) / block_size; parts > 0; --parts) {
    const std::size_t count = points.size() / parts;
    block.count = 0;
    work.again.count = 0;
    for (const PlacedPoint& p : points.first(count)) block.add(p);
    points = points.subspan(count);
    solve(work.sums);
    if (work.again.count > 0) repeat();
  }
}

// Points that floats were not enough for: few at a time, whose bounds are closer, and what is left of them in double.
void RigBatch::Run::repeat() {
  repeating = true;
  work.waiting.assign(work.again.points.begin(), work.again.points.begin() + static_cast<std::ptrdiff_t>(work.again.count));
  for (std::size_t first = 0; first < work.waiting.size(); first += few) {
    work.block.count = work.again.count = 0;
    for (std::size_t i = first; i < std::min(first + few, work.waiting.size()); ++i) work.block.add(work.waiting[i]);
    solve(work.sums);
    if (work.again.count == 0) continue;
    std::swap(work.block, work.again);
    solve(work.exact);
  }
  repeating = false;
}

void RigBatch::Run::push(const Entry& e) {
  if (!(e.most() > 0)) return unseen(e, work.block.count);
  work.open.push(e, rig.nodes[e.node]);
}

void RigBatch::Run::settle() {
  work.block.settle(origin);
  ++boxes;
}

// `most` and `reach_of_it`: its bounds, for lights that LightBatch takes.
template <class T>
void RigBatch::Run::evaluate(std::uint32_t light, double most, double reach_of_it, Sums<T>& sums) {
  const Block& block = work.block;
  ++terms;
  (repeating ? counts.repeated : counts.evaluated) += block.count;
  if constexpr (std::is_same_v<T, float>) {
    const Light& l = rig.lights[light];
    const std::size_t count = block.padded();
    if (l.batch && l.batch->projected_solid_angles(block.batch(origin), std::span(work.values.data(), count), 0)) {
      const Vec3f colour = vec_cast<float>(l.colour);
      for (std::size_t i = 0; i < count; ++i) {
        sums.r[i] += work.values[i] * colour.x;
        sums.g[i] += work.values[i] * colour.y;
        sums.b[i] += work.values[i] * colour.z;
      }
      reached += most;
      reach += reach_of_it;
      return;
    }
  }
  double most_here = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    const Rgb one = eval::illuminance(rig.emitters[light], block.position(i, origin), block.normal(i));
    sums.r[i] += static_cast<T>(one.x);
    sums.g[i] += static_cast<T>(one.y);
    sums.b[i] += static_cast<T>(one.z);
    most_here = std::max(most_here, largest(one));
  }
  reached += most_here;
}

template <class T>
void RigBatch::Run::evaluate_unbounded(Sums<T>& sums) {
  const Surroundings& here = work.block.surroundings;
  for (const Unbounded& u : rig.unbounded) {
    ++counts.bounds;
    const auto* distant = std::get_if<DistantEmitter>(&rig.emitters[u.light].shape);
    const bool hidden = distant != nullptr ? below_horizon(*distant, here.normals) : u.place && !(bound_at(*u.place, here).most > 0);
    // Of what LightBatch takes: an environment's luminance, what a true direction gives a surface facing it.
    const double emitted = largest(rig.lights[u.light].colour);
    if (!hidden)
      evaluate(u.light, pi * emitted, emitted, sums);
    else if (!repeating)
      counts.skipped_unseen += work.block.count;
  }
}

// Marks the points that are done and counts them. Let P be the largest channel of a point's sum. Its error is at most e = a P + s: s are
// the bounds of what is open and what evaluation errs by in parts of the luminance, a P what it errs by in parts of the value. The exact
// largest channel is then at least P - e, so that e <= max(absolute, relative (P - e)) is enough, which is
//     P <= (absolute - s) / a   or   P >= s (1 + relative) / (relative - a (1 + relative)).
// Where channels are negative P may be less than what it is the sum of: then for a P stands a times the bounds of what was evaluated.
template <class T>
std::size_t RigBatch::Run::judge(Sums<T>& sums) {
  constexpr bool in_floats = std::is_same_v<T, float>;
  const auto n = static_cast<double>(terms);
  part = float_rounding + double_rounding * n;  // of the answer, and of the sum
  rest_of_error = work.open.error();
  const Rgb& middle = work.open.middle();
  if constexpr (in_floats) {
    part = batch_error + float_rounding * (n + 3);
    rest_of_error += batch_error_of_reach * reach;
  }
  if (rig.out_of_gamut) {
    rest_of_error += part * (reached + largest(middle));
    part = 0;
  }
  const double s = rest_of_error, slope = relative - part * (1 + relative);
  const double up_to = part > 0 ? (absolute - s) / part : s <= absolute ? Box::infinite : -Box::infinite;
  const double from = slope > 0 ? s * (1 + relative) / slope : Box::infinite;
  // Compared as floats they may be rounded the wrong way.
  const auto low = static_cast<T>(up_to - 1e-6 * std::abs(up_to)), high = static_cast<T>(from * (1 + 1e-6));
  const auto r = static_cast<T>(middle.x), g = static_cast<T>(middle.y), b = static_cast<T>(middle.z);
  std::size_t done = 0;
  for (std::size_t i = 0; i < work.block.count; ++i) {
    const T p = std::max(std::max(sums.r[i] + r, sums.g[i] + g), sums.b[i] + b);
    sums.done[i] = ((p <= low) | (p >= high)) & (p <= std::numeric_limits<T>::max());
    done += sums.done[i] ? 1 : 0;
  }
  return done;
}

// Writes the points that are done, or all, and keeps the others in the block.
template <class T>
void RigBatch::Run::leave(Sums<T>& sums, bool all) {
  Block& block = work.block;
  const Rgb& middle = work.open.middle();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    if (all || sums.done[i]) {
      const std::uint32_t index = block.points[i].index;
      const Rgb sum = Rgb{sums.r[i], sums.g[i], sums.b[i]} + middle;
      lux[index] = {as_float(sum.x), as_float(sum.y), as_float(sum.z)};
      if (!bound.empty()) bound[index] = as_float(part * std::max({sum.x, sum.y, sum.z}) + rest_of_error);
      continue;
    }
    block.points[kept] = block.points[i];
    sums.r[kept] = sums.r[i], sums.g[kept] = sums.g[i], sums.b[kept] = sums.b[i];
    ++kept;
  }
  if (!repeating) counts.skipped_small += work.open.lights() * (block.count - kept);
  block.count = kept;
}

template <class T>
void RigBatch::Run::solve(Sums<T>& sums) {
  constexpr bool in_floats = std::is_same_v<T, float>;
  Block& block = work.block;
  double judge_at = Box::infinite;  // the error of what is open: not again before it has become less
  reached = reach = 0;
  terms = 0;
  settle();
  sums.r.fill(0), sums.g.fill(0), sums.b.fill(0);
  evaluate_unbounded(sums);
  work.open = work.of_group;
  while (block.count > 0) {
    const double error = work.open.error();
    if (work.open.empty() || (error <= judge_at && error <= std::max(absolute, relative * (reached + work.open.standing())))) {
      judge_at = 0.9 * error;
      const std::size_t done = judge(sums);
      if (work.open.empty()) {
        // Floats are not enough for the others.
        for (std::size_t i = 0; i < block.count && in_floats; ++i)
          if (!sums.done[i]) work.again.add(block.points[i]);
        return leave(sums, !in_floats);
      }
      if (2 * done >= block.count) {
        leave(sums, false);
        if (block.count == 0) return;
        settle();
        continue;
      }
    }
    const Entry e = work.open.largest();
    const Node& node = rig.nodes[e.node];
    work.open.pop(node);
    if (e.boxes != boxes) {
      push(entry(e.node, block.surroundings));
    } else if (is_light(e)) {
      evaluate(node.light, e.most(), e.reach, sums);
    } else {
      push(entry(node.left, block.surroundings));
      push(entry(node.right, block.surroundings));
    }
  }
}

Result<RigCounts> RigBatch::illuminance(const PointBatch& points, const Tolerance& tolerance, std::span<Vec3f> lux, std::span<float> bound,
                                        Vec3f where_none, Workspace& workspace) const {
  for (const std::span<const float>& s : {points.px, points.py, points.pz, points.nx, points.ny, points.nz})
    if (s.size() != lux.size()) return batch_sizes_differ(s.size(), lux.size());
  if (!bound.empty() && bound.size() != lux.size()) return batch_sizes_differ(lux.size(), bound.size());
  Workspace::Parts& work = *workspace.parts_;
  RigCounts counts;
  const double absolute = tolerance.absolute > 0 ? tolerance.absolute : 0;
  const double relative = tolerance.relative > 1e-7 ? tolerance.relative : 1e-7;
  for (std::size_t first = 0; first < lux.size(); first += points_at_once) {
    const std::size_t count = std::min(points_at_once, lux.size() - first);
    work.points.arrange(points, first, count);
    Run run{
        *prepared_, work, points.origin, absolute, relative, lux.subspan(first, count), bound.empty() ? bound : bound.subspan(first, count),
        counts};
    for (const std::uint32_t i : work.points.not_finite()) {
      run.lux[i] = where_none;
      if (!bound.empty()) run.bound[i] = 0;
    }
    counts.without += work.points.not_finite().size();
    for (const PointBlocks::Group& group : work.points.groups()) {
      const std::span<const PlacedPoint> ordered = work.points.ordered(group);
      run.walk(ordered);
      run.blocks(ordered);
    }
  }
  return counts;
}

}  // namespace etendue::eval
