#include "diffuse_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "etendue/method_batch.h"
#include "sdk/src/eval/light_protocol.h"

namespace etendue::cli {
namespace {

using namespace eval;
using protocol::Kind;

constexpr std::size_t batch_size = 4096;  // points a light, several times in a row: from a cache, and what a light costs once is little
constexpr std::size_t turns_a_batch = 4;

Kind kind_of(std::string_view shape) {
  if (shape == "sphere") return Kind::sphere;
  if (shape == "disk") return Kind::disk;
  if (shape == "line") return Kind::line;
  if (shape == "point") return Kind::point;
  return shape == "tube" ? Kind::capsule : Kind::rect;
}

// A point around a light as protocol::random_shape puts a light around a point. Nothing where that would not take it.
std::optional<Vec3d> point_around(const EmitterShape& shape, protocol::Random& random) {
  const Vec3d towards = random.direction();
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return s->centre - towards * (s->radius * random.uniform(1.05, 6));
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) {
    const double distance = d->radius * random.uniform(0.5, 6), cosine = -dot(d->normal, towards);
    if (cosine < 0.02 || cosine * distance < 0.04 * d->radius) return std::nullopt;
    return d->centre - towards * distance;
  }
  const auto around_axis = [&](const Vec3d& a, const Vec3d& b, double radius) -> std::optional<Vec3d> {
    const Vec3d span = b - a, p = (a + b) * 0.5 - towards * (random.uniform(0.5, 3) * (length(span) + 2 * radius));
    const double share = std::clamp(dot(p - a, span) / dot(span, span), 0.0, 1.0);
    if (length(p - a - span * share) < 1.05 * radius) return std::nullopt;
    return p;
  };
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return around_axis(t->a, t->b, t->radius);
  if (const auto* l = std::get_if<LineEmitter>(&shape)) return around_axis(l->a, l->b, 0.01 * length(l->b - l->a));
  if (const auto* p = std::get_if<PunctualEmitter>(&shape)) return p->position - towards * protocol::point_distance(random);
  const auto& polygon = std::get<PolygonEmitter>(shape);
  const auto& v = polygon.vertices;
  const double size = std::max(length(v[1] - v[0]), length(v[3] - v[0])), distance = size * random.uniform(0.5, 3);
  const double cosine = -dot(polygon.normal, towards);
  if (cosine < 0.02 || cosine * distance < 0.02 * size) return std::nullopt;
  return (v[0] + v[2]) * 0.5 - towards * distance;
}

// Lights, and points under each; the exact illuminance at every one.
struct Side {
  std::vector<Emitter> lights;
  std::array<std::vector<float>, 6> columns;
  std::vector<double> exact;
  std::vector<float> values;

  Side(Kind kind, bool above, std::uint64_t samples, std::uint64_t seed) {
    protocol::Random random(seed);
    while (exact.size() < samples) {
      Emitter light;
      light.shape = protocol::random_shape(kind, {}, random.direction(), random);
      light.radiance = {1, 1, 1};
      for (std::size_t i = 0; i < batch_size;) i += add(light, above, random) ? 1 : 0;
      lights.push_back(std::move(light));
    }
    values.resize(exact.size());
  }
  PointBatch batch(std::size_t light) const {
    const auto part = [&](std::size_t k) { return std::span(columns[k]).subspan(light * batch_size, batch_size); };
    return {part(0), part(1), part(2), part(3), part(4), part(5), {}};
  }
  std::span<float> out(std::size_t light) { return std::span(values).subspan(light * batch_size, batch_size); }

 private:
  // The floats that the methods are given are what is exact.
  bool add(const Emitter& light, bool above, protocol::Random& random) {
    const std::optional<Vec3d> around = point_around(light.shape, random);
    if (!around) return false;
    const Vec3f p = vec_cast<float>(*around), n = vec_cast<float>(random.direction());
    const Vec3d position = vec_cast<double>(p), normal = normalised(vec_cast<double>(n));
    const double low = protocol::lowest(light.shape, position, normal), high = -protocol::lowest(light.shape, position, -normal);
    const double value = illuminance(light, position, normal).x;
    if (std::holds_alternative<PunctualEmitter>(light.shape)) {  // which no horizon cuts: risen or set
      if (std::abs(low) < 1e-3 || (above && low < 0) || (low > 0 && value < 1e-3)) return false;
    } else if (value < 1e-3 || (above ? low < 1e-3 : (low >= 0 || high <= 0))) {
      return false;
    }
    const std::array<float, 6> all{p.x, p.y, p.z, n.x, n.y, n.z};
    for (std::size_t k = 0; k < 6; ++k) columns[k].push_back(all[k]);
    exact.push_back(value);
    return true;
  }
};

using Call = std::function<void(std::size_t)>;  // of a light: its values go to the side's
struct Contender {
  DiffuseRow row;
  std::function<Call(Side&)> prepare;
};

std::vector<Contender> contenders(const Emitter& light) {
  std::vector<Contender> all;
  for (const BatchMethod& method : batch_methods()) {
    if (!MethodBatch::of(method, light)) continue;
    all.push_back({{method.name, method.note, method.ours, {}, {}}, [&method](Side& side) -> Call {
                     auto batches = std::make_shared<std::vector<MethodBatch>>();
                     for (const Emitter& e : side.lights) batches->push_back(*MethodBatch::of(method, e));
                     return [&side, batches](std::size_t i) { (void)(*batches)[i].projected_solid_angles(side.batch(i), side.out(i), 0); };
                   }});
  }
  all.push_back({{"exact", "closed form, cut at the horizon; within 1e-5 and 2e-6 of the solid angle everywhere", true, {}, {}},
                 [](Side& side) -> Call {
                   auto batches = std::make_shared<std::vector<LightBatch>>();
                   for (const Emitter& e : side.lights) batches->push_back(*LightBatch::of(e));
                   return [&side, batches](std::size_t i) { (void)(*batches)[i].projected_solid_angles(side.batch(i), side.out(i), 0); };
                 }});
  return all;
}

// What closed forms in floats have left: an error below these is none.
constexpr double exact_agg = 1e-6, exact_p99 = 1e-5;
// Those that are closed forms but for fits of single precision and clamps are named so too.
constexpr double exact_named = 3e-6;
bool errs_no_more(const DiffuseFigures& ours, const DiffuseFigures& published) {
  constexpr double rounding = 1 + 1e-6;
  return ours.agg <= std::max(published.agg * rounding, exact_agg) && ours.p99 <= std::max(published.p99 * rounding, exact_p99);
}

DiffuseFigures errors_of(const Side& side) {
  DiffuseFigures f;
  double errors = 0, sum = 0;
  std::vector<double> relative;
  for (std::size_t i = 0; i < side.exact.size(); ++i) {
    const double error = std::abs(static_cast<double>(side.values[i]) - side.exact[i]);
    errors += error, sum += side.exact[i];
    f.max_abs = std::max(f.max_abs, error);
    relative.push_back(error > 0 ? error / side.exact[i] : 0);  // set: nothing, and exactly so
    f.mean_rel += relative.back();
  }
  f.mean_rel /= static_cast<double>(relative.size());
  f.agg = errors / sum;
  const auto rank = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() * 99 / 100);
  std::nth_element(relative.begin(), rank, relative.end());
  f.p99 = *rank;
  f.exact = f.agg < exact_named;
  return f;
}

double seconds_of(const std::function<void()>& run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void find_matches(std::vector<DiffuseRow>& rows, DiffuseFigures DiffuseRow::*side) {
  for (DiffuseRow& row : rows) {
    if (row.is_ours) continue;
    DiffuseFigures& published = row.*side;
    for (const DiffuseRow& candidate : rows) {
      const DiffuseFigures& ours = candidate.*side;
      if (!candidate.is_ours || !errs_no_more(ours, published)) continue;
      const double ratio = ours.ns / published.ns;
      if (published.ours.empty() || ratio < published.ratio) published.ours = candidate.method, published.ratio = ratio;
    }
  }
}

}  // namespace

Result<DiffuseTable> run_diffuse_bench(const DiffuseBench& bench, const std::function<bool(double)>& report) {
  const Error cancelled{"CANCELLED", "stopped", {}, {}, {}};
  DiffuseTable table{bench.shape, bench.samples, bench.seed, measured_instruction_sets(), {}};
  const std::size_t sets = table.instruction_sets.size();
  const Kind kind = kind_of(bench.shape);
  std::vector<std::vector<double>> rates(sets);
  std::vector<Contender> all;
  for (const bool above : {true, false}) {
    Side side(kind, above, bench.samples, bench.seed + (above ? 0 : 1));
    if (all.empty()) all = contenders(side.lights.front());
    table.samples = side.exact.size();
    std::vector<Call> calls;
    std::vector<std::vector<double>> seconds(all.size() * sets);
    for (Contender& c : all) {
      calls.push_back(c.prepare(side));
      for (std::size_t i = 0; i < side.lights.size(); ++i) calls.back()(i);  // also warms up
      (above ? c.row.above : c.row.across) = errors_of(side);
    }
    for (int round = 0; round < bench.rounds; ++round) {
      if (!report((above ? 0.0 : 0.5) + 0.5 * round / bench.rounds)) return cancelled;
      for (std::size_t k = 0; k < sets; ++k) {
        const OnInstructionSet on(table.instruction_sets[k]);
        constexpr std::size_t turns = 20000;
        multiply_adds(turns);  // the first call pays for the choice of the set and for waking wide registers
        double operations = 0;
        const double taken = seconds_of([&] { operations = multiply_adds(turns); });
        rates[k].push_back(operations / taken);
        for (std::size_t c = 0; c < all.size(); ++c) {
          seconds[c * sets + k].push_back(seconds_of([&] {
            for (std::size_t i = 0; i < side.lights.size(); ++i) {
              for (std::size_t turn = 0; turn < turns_a_batch; ++turn) calls[c](i);
            }
          }));
        }
      }
    }
    for (std::size_t c = 0; c < all.size(); ++c) {
      DiffuseFigures& figures = above ? all[c].row.above : all[c].row.across;
      for (std::size_t k = 0; k < sets; ++k)
        figures.ns_on.push_back(1e9 * median(seconds[c * sets + k]) / static_cast<double>(turns_a_batch * side.exact.size()));
      figures.ns = figures.ns_on.front();
    }
  }
  for (std::size_t k = 0; k < sets; ++k) table.instruction_sets[k].peak_gflops = 1e-9 * median(rates[k]);
  for (Contender& c : all) {
    table.rows.push_back(std::move(c.row));
  }
  find_matches(table.rows, &DiffuseRow::above);
  find_matches(table.rows, &DiffuseRow::across);
  return table;
}

}  // namespace etendue::cli
