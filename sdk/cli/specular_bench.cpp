#include "specular_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "etendue/specular_batch.h"
#include "etendue/specular_light.h"
#include "etendue/specular_method_batch.h"
#include "etendue/specular_methods.h"
#include "sdk/src/eval/light_protocol.h"

namespace etendue::cli {
namespace {

using namespace eval;

// Lights, and views of points under each; the light at every one by the reference.
struct Side {
  const SpecularBench& bench;
  std::vector<Emitter> lights;
  std::array<std::vector<float>, 10> columns;  // position, normal, view, alpha
  std::vector<double> exact;
  std::vector<float> of_f0, of_f90;

  const bool with_truth;
  Side(const SpecularBench& settings, bool above, bool truth, const std::function<bool(double)>& report, bool& cancelled)
      : bench(settings), with_truth(truth) {
    protocol::Random random(settings.seed + (above ? 0 : 1));
    while (exact.size() < settings.samples && !cancelled) {
      Emitter light;
      light.shape = protocol::random_shape(protocol::kind_named(settings.shape), {}, random.direction(), random);
      light.radiance = {1, 1, 1};
      for (std::size_t i = 0; i < bench_batch;) i += add(light, above, random) ? 1 : 0;
      lights.push_back(std::move(light));
      cancelled = !report(static_cast<double>(exact.size()) / static_cast<double>(settings.samples));
    }
    of_f0.resize(exact.size()), of_f90.resize(exact.size());
  }
  SpecularPoints points(std::size_t light) const {
    const auto part = [&](std::size_t k) { return std::span(columns[k]).subspan(light * bench_batch, bench_batch); };
    return {{part(0), part(1), part(2), part(3), part(4), part(5), {}}, part(6), part(7), part(8), part(9)};
  }
  ShadingPoint point(std::size_t i) const {
    const auto at = [&](std::size_t k) { return Vec3d{columns[k][i], columns[k + 1][i], columns[k + 2][i]}; };
    const Vec3d normal = normalised(at(3));
    return {at(0), normal, normal, normalised(at(6)), GgxLobe{columns[9][i], {bench.f0, bench.f0, bench.f0}}};
  }
  // What SpecularBatch's two numbers make.
  std::vector<double> values() const {
    std::vector<double> out(exact.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = bench.f0 * static_cast<double>(of_f0[i]) + static_cast<double>(of_f90[i]);
    return out;
  }

 private:
  bool add(const Emitter& light, bool above, protocol::Random& random) {
    const auto place = protocol::point_around(light.shape, random);
    if (!place) return false;
    const Vec3f p = vec_cast<float>(*place), n = vec_cast<float>(random.direction());
    const Vec3d position = vec_cast<double>(p), normal = normalised(vec_cast<double>(n));
    const double low = protocol::lowest(light.shape, position, normal), high = -protocol::lowest(light.shape, position, -normal);
    if (illuminance(light, position, normal).x < 1e-3 || (above ? low < 1e-3 : (low >= 0 || high <= 0))) return false;
    Vec3d view = random.direction();
    if (exact.size() % 2 == 0) {
      const LightSample s = sample_light(light, position, random.square());
      if (!(s.pdf > 0)) return false;
      view = normal * (2 * dot(normal, s.direction)) - s.direction;
    }
    if (dot(view, normal) < 0.05) return false;
    const Vec3f v = vec_cast<float>(view);
    const auto alpha = static_cast<float>(bench.alphas[exact.size() / 2 % bench.alphas.size()]);
    const std::array<float, 10> all{p.x, p.y, p.z, n.x, n.y, n.z, v.x, v.y, v.z, alpha};
    for (std::size_t k = 0; k < all.size(); ++k) columns[k].push_back(all[k]);
    exact.push_back(0);
    if (with_truth) exact.back() = reference(light, point(exact.size() - 1), {1e-5, 1e-9}).value.x;
    return true;
  }
};

struct InVectors {
  std::string_view name, note;
  bool is_ours;
};
constexpr InVectors in_vectors[] = {
    {"ltc", "a transformed cosine from a table of ours, cut at the surface's horizon", false},
    {"ltc-one-cosine", "one that is fitted between nodes, cut at the surface's horizon alone, Fresnel's term at the light", true},
    {"ltc-two-lobes", "two cosines, weighed one way for f0 and another for f90", true},
    {"ltc-two-cosines", "the same two, cut at the surface's horizon alone", true},
    {"ltc-two-caps", "the same two, through a cap of directions instead of the light's outline", true},
    {"moments", "the area under the lobe, its slow factor at four places; no table", true},
};

// In double, one by one and once: a mark for the error, and a time that says what its double form takes.
struct OneByOne {
  std::string_view name, note;
  bool is_ours;
  std::function<std::optional<Rgb>(const Emitter&, const ShadingPoint&)> luminance;
};
std::vector<OneByOne> one_by_one() {
  std::vector<OneByOne> all;
  for (const SpecularMethod& m : specular_methods()) {
    const auto published = SpecularMethodBatch::names();
    const bool known = std::any_of(std::begin(in_vectors), std::end(in_vectors), [&](const InVectors& v) { return v.name == m.name; }) ||
                       std::find(published.begin(), published.end(), m.name) != published.end();
    if (!known) all.push_back({m.name, m.source, false, m.luminance});
  }
  for (const auto& [name, tolerance] : {std::pair{"adaptive 1e-2", 1e-2}, {"adaptive 1e-3", 1e-3}, {"adaptive 1e-4", 1e-4}}) {
    all.push_back(
        {name, "to that tolerance", true, [asked = tolerance](const Emitter& light, const ShadingPoint& point) -> std::optional<Rgb> {
           const auto estimate = specular_luminance(light, point, asked);
           return estimate ? std::optional(estimate->value) : std::nullopt;
         }});
  }
  return all;
}
// Nothing where it does not take the lights.
std::optional<MethodFigures> figures_of(const OneByOne& method, const Side& side, std::size_t sets) {
  std::vector<double> values(side.exact.size());
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<Rgb> value = method.luminance(side.lights[i / bench_batch], side.point(i));
    if (!value) return std::nullopt;
    values[i] = value->x;
  }
  const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  MethodFigures figures = errors_of(values, side.exact);
  figures.ns = 1e9 * taken / static_cast<double>(values.size());
  figures.ns_on.assign(sets, figures.ns);
  return figures;
}

// What gives the shares of a light by a method in vectors.
using ShareCall = std::function<void(const SpecularPoints&, std::span<float>, std::span<float>)>;
template <class Batch>
std::optional<ShareCall> call_of(const Result<Batch>& batch) {
  if (!batch) return std::nullopt;
  return [shared = std::make_shared<Batch>(*batch)](const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90) {
    (void)shared->shares(points, of_f0, of_f90, 0);
  };
}
std::optional<ShareCall> share_call(std::string_view method, const Emitter& light) {
  if (const auto rule = SpecularBatch::rule_named(method)) return call_of(SpecularBatch::of(*rule, light));
  return call_of(SpecularMethodBatch::of(method, light));
}
// Those that take the light: ours and, by name, what is published.
std::vector<MethodRow> rows_in_vectors(const Emitter& light) {
  std::vector<MethodRow> all;
  for (const InVectors& v : in_vectors)
    if (share_call(v.name, light)) all.push_back({v.name, v.note, v.is_ours, false, {}, {}});
  for (const std::string_view name : SpecularMethodBatch::names()) {
    const SpecularMethod& method = *find_specular_method(name);
    if (share_call(name, light)) all.push_back({name, method.source, method.source == "Etendue", false, {}, {}});
  }
  return all;
}

}  // namespace

Result<MethodTable> run_specular_bench(const SpecularBench& bench, const std::function<bool(double)>& report) {
  const Error stopped{"CANCELLED", "stopped", {}, {}, {}};
  MethodTable table{
      bench.shape, fmt::format("Specular light (GGX, f0 {:g})", bench.f0), bench.samples, bench.seed, measured_instruction_sets(), {}, {}};
  const std::size_t sets = table.instruction_sets.size();
  table.yardstick = MethodRow{"ltc", "of rectangles", false, false, {}, {}};
  SpecularBench of_rectangles = bench;
  of_rectangles.shape = "rect";
  std::vector<std::vector<double>> rates(sets);
  const std::vector<OneByOne> doubles = one_by_one();
  std::vector<MethodRow> in_double;
  in_double.reserve(doubles.size());
  for (const OneByOne& m : doubles) in_double.push_back({m.name, m.note, m.is_ours, true, {}, {}});
  std::vector<MethodRow> vectors;
  for (const bool above : {true, false}) {
    const auto done = [&](double from, double to) {
      return [&report, above, from, to](double part) { return report((above ? 0.0 : 0.5) + 0.5 * (from + (to - from) * part)); };
    };
    const auto figures = [&](MethodRow& row) -> MethodFigures& { return above ? row.above : row.across; };
    bool cancelled = false;
    Side side(bench, above, true, done(0, 0.3), cancelled);
    Side rectangles(of_rectangles, above, false, done(0.3, 0.3), cancelled);
    if (cancelled) return stopped;
    table.samples = side.exact.size();
    for (std::size_t m = 0; m < doubles.size(); ++m) {
      if (!done(0.3, 0.6)(static_cast<double>(m) / static_cast<double>(doubles.size()))) return stopped;
      if (const auto f = figures_of(doubles[m], side, sets)) figures(in_double[m]) = *f;
    }
    if (vectors.empty()) vectors = rows_in_vectors(side.lights.front());
    std::vector<MethodCall> calls;
    for (MethodRow& row : vectors) {
      std::vector<ShareCall> of_light;
      for (const Emitter& e : side.lights) of_light.push_back(*share_call(row.method, e));
      calls.push_back([&side, of_light](std::size_t i) {
        const auto out = [&](std::vector<float>& all) { return std::span(all).subspan(i * bench_batch, bench_batch); };
        of_light[i](side.points(i), out(side.of_f0), out(side.of_f90));
      });
      for (std::size_t i = 0; i < side.lights.size(); ++i) calls.back()(i);  // also warms up
      figures(row) = errors_of(side.values(), side.exact);
    }
    std::vector<ShareCall> yardsticks;
    for (const Emitter& e : rectangles.lights) yardsticks.push_back(*share_call("ltc", e));
    calls.push_back([&rectangles, &yardsticks](std::size_t i) {
      const std::size_t k = i % yardsticks.size();
      const auto out = [&](std::vector<float>& all) { return std::span(all).subspan(k * bench_batch, bench_batch); };
      yardsticks[k](rectangles.points(k), out(rectangles.of_f0), out(rectangles.of_f90));
    });
    const auto seconds = measured_seconds(calls, side.lights.size(), table.instruction_sets, bench.rounds, rates, done(0.6, 1));
    if (!seconds) return stopped;
    for (std::size_t c = 0; c < calls.size(); ++c) {
      MethodFigures& f = figures(c < vectors.size() ? vectors[c] : *table.yardstick);
      for (const double s : (*seconds)[c]) f.ns_on.push_back(1e9 * s);
      f.ns = f.ns_on.front();
    }
  }
  for (std::size_t k = 0; k < sets; ++k) table.instruction_sets[k].peak_gflops = median(rates[k]);
  for (MethodRow& row : vectors) table.rows.push_back(std::move(row));
  for (MethodRow& row : in_double)
    if (!row.above.ns_on.empty() && !row.across.ns_on.empty()) table.rows.push_back(std::move(row));
  find_matches(table.rows, &MethodRow::above);
  find_matches(table.rows, &MethodRow::across);
  return table;
}

}  // namespace etendue::cli
