#include "diffuse_bench.h"

#include <algorithm>
#include <cmath>

#include "etendue/method_batch.h"
#include "sdk/src/eval/light_protocol.h"

namespace etendue::cli {
namespace {

using namespace eval;
using protocol::Kind;

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
      for (std::size_t i = 0; i < bench_batch;) i += add(light, above, random) ? 1 : 0;
      lights.push_back(std::move(light));
    }
    values.resize(exact.size());
  }
  PointBatch batch(std::size_t light) const {
    const auto part = [&](std::size_t k) { return std::span(columns[k]).subspan(light * bench_batch, bench_batch); };
    return {part(0), part(1), part(2), part(3), part(4), part(5), {}};
  }
  std::span<float> out(std::size_t light) { return std::span(values).subspan(light * bench_batch, bench_batch); }

 private:
  // The floats that the methods are given are what is exact.
  bool add(const Emitter& light, bool above, protocol::Random& random) {
    const std::optional<Vec3d> around = protocol::point_around(light.shape, random);
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

struct Contender {
  MethodRow row;
  std::function<MethodCall(Side&)> prepare;  // of a light its values go to the side's
};

std::vector<Contender> contenders(const Emitter& light) {
  std::vector<Contender> all;
  for (const BatchMethod& method : batch_methods()) {
    if (!MethodBatch::of(method, light)) continue;
    all.push_back({{method.name, method.note, method.ours, false, {}, {}}, [&method](Side& side) -> MethodCall {
                     auto batches = std::make_shared<std::vector<MethodBatch>>();
                     for (const Emitter& e : side.lights) batches->push_back(*MethodBatch::of(method, e));
                     return [&side, batches](std::size_t i) { (void)(*batches)[i].projected_solid_angles(side.batch(i), side.out(i), 0); };
                   }});
  }
  all.push_back({{"exact", "closed form, cut at the horizon; within 1e-5 and 2e-6 of the solid angle everywhere", true, false, {}, {}},
                 [](Side& side) -> MethodCall {
                   auto batches = std::make_shared<std::vector<LightBatch>>();
                   for (const Emitter& e : side.lights) batches->push_back(*LightBatch::of(e));
                   return [&side, batches](std::size_t i) { (void)(*batches)[i].projected_solid_angles(side.batch(i), side.out(i), 0); };
                 }});
  return all;
}

}  // namespace

Result<MethodTable> run_diffuse_bench(const DiffuseBench& bench, const std::function<bool(double)>& report) {
  MethodTable table{bench.shape, "Diffuse light", bench.samples, bench.seed, measured_instruction_sets(), {}, {}};
  const std::size_t sets = table.instruction_sets.size();
  const Kind kind = protocol::kind_named(bench.shape);
  std::vector<std::vector<double>> rates(sets);
  std::vector<Contender> all;
  for (const bool above : {true, false}) {
    Side side(kind, above, bench.samples, bench.seed + (above ? 0 : 1));
    if (all.empty()) all = contenders(side.lights.front());
    table.samples = side.exact.size();
    std::vector<MethodCall> calls;
    for (Contender& c : all) {
      calls.push_back(c.prepare(side));
      for (std::size_t i = 0; i < side.lights.size(); ++i) calls.back()(i);  // also warms up
      (above ? c.row.above : c.row.across) = errors_of(std::vector<double>(side.values.begin(), side.values.end()), side.exact);
    }
    const auto seconds = measured_seconds(calls, side.lights.size(), table.instruction_sets, bench.rounds, rates,
                                          [&](double done) { return report((above ? 0.0 : 0.5) + 0.5 * done); });
    if (!seconds) return Error{"CANCELLED", "stopped", {}, {}, {}};
    for (std::size_t c = 0; c < all.size(); ++c) {
      MethodFigures& figures = above ? all[c].row.above : all[c].row.across;
      for (const double s : (*seconds)[c]) figures.ns_on.push_back(1e9 * s);
      figures.ns = figures.ns_on.front();
    }
  }
  for (std::size_t k = 0; k < sets; ++k) table.instruction_sets[k].peak_gflops = median(rates[k]);
  for (Contender& c : all) table.rows.push_back(std::move(c.row));
  find_matches(table.rows, &MethodRow::above);
  find_matches(table.rows, &MethodRow::across);
  return table;
}

}  // namespace etendue::cli
