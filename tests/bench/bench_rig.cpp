// A rig of many lights: all of them at every point, against those that matter (rig_batch.h). One thread; both take turns.
//   bench_rig [--points N] [--check N] [--rounds N] [--columns N] [--rows N] [--relative X] [--absolute LUX] [--json]
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "bench.h"
#include "street_rig.h"

namespace {

using namespace etendue;
using namespace etendue::eval;

struct Options {
  std::size_t points = 1000000, check = 20000, rounds = 5;
  int columns = 40, rows = 25;
  Tolerance tolerance{0.02, 0.02};
  bool json = false;
};

double seconds_of(const auto& run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

// Every light at every point, by LightBatch, 4096 points at once.
class AllLights {
 public:
  explicit AllLights(const std::vector<Emitter>& lights) {
    for (const Emitter& e : lights) lights_.push_back({*LightBatch::of(e), vec_cast<float>(e.radiance)});
  }
  void operator()(const PointBatch& points, std::span<Vec3f> lux) const {
    std::vector<float> sr(lux.size());
    std::fill(lux.begin(), lux.end(), Vec3f{});
    for (const auto& [light, colour] : lights_) {
      if (!light.projected_solid_angles(points, sr, 0)) std::abort();
      for (std::size_t i = 0; i < sr.size(); ++i) lux[i] += colour * sr[i];
    }
    bench::keep(lux.data());
  }

 private:
  std::vector<std::pair<LightBatch, Vec3f>> lights_;
};

struct Row {
  std::string order;
  double all_ns, rig_ns, ratio, slowest_ratio;
  RigCounts counts;
  double worst = 0;           // of the error over the tolerance
  double worst_of_bound = 0;  // of the error over the bound told
  std::size_t checked = 0;
};

Row measured(std::string order, const Options& o, const std::vector<Emitter>& lights, const FloatPoints& points) {
  Row row{std::move(order), 0, 0, 0, 0, {}};
  const AllLights all(lights);
  const RigBatch rig(lights);
  RigBatch::Workspace workspace;
  std::vector<Vec3f> lux(points.size()), some(std::min<std::size_t>(4096, points.size()));
  std::vector<float> bound(points.size());
  std::vector<double> all_ns, rig_ns, ratios;
  for (std::size_t round = 0; round <= o.rounds; ++round) {
    const std::size_t first = round * some.size() % (points.size() - some.size() + 1);
    const double a = 1e9 * seconds_of([&] { all(points.batch(first, some.size()), some); }) / static_cast<double>(some.size());
    const double r = 1e9 * seconds_of([&] {
                       const Result<RigCounts> counts = rig.illuminance(points.batch(), o.tolerance, lux, bound, {}, workspace);
                       if (!counts) std::abort();
                       row.counts = *counts;
                     }) /
                     static_cast<double>(points.size());
    if (round == 0) continue;  // the workspace grows
    all_ns.push_back(a), rig_ns.push_back(r), ratios.push_back(a / r);
  }
  row.all_ns = median(all_ns), row.rig_ns = median(rig_ns), row.ratio = median(ratios);
  row.slowest_ratio = *std::min_element(ratios.begin(), ratios.end());
  const std::size_t step = std::max<std::size_t>(1, points.size() / std::max<std::size_t>(1, o.check));
  for (std::size_t i = 0; i < points.size(); i += step, ++row.checked) {
    Rgb exact;
    for (const Emitter& e : lights) exact += illuminance(e, points.position(i), points.normal(i));
    const Rgb apart = vec_cast<double>(lux[i]) - exact;
    const double error = std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)});
    const double allowed = std::max(o.tolerance.absolute, o.tolerance.relative * std::max({exact.x, exact.y, exact.z}));
    row.worst = std::max(row.worst, error / allowed);
    if (error > 0) row.worst_of_bound = std::max(row.worst_of_bound, error / static_cast<double>(bound[i]));
  }
  return row;
}

// Of the fewest lights that are enough at a point.
struct Matter {
  double mean = 0;
  std::size_t least = 0, most = 0, lights = 0;  // lights: how many of all matter at one of the points
};
Matter matter(const Options& o, const std::vector<Emitter>& lights, const FloatPoints& points) {
  Matter m;
  m.least = lights.size();
  std::vector<bool> somewhere(lights.size());
  std::vector<std::size_t> which;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 3000);
  std::size_t sampled = 0;
  for (std::size_t i = 0; i < points.size(); i += step, ++sampled) {
    Rgb exact;
    for (const Emitter& e : lights) exact += illuminance(e, points.position(i), points.normal(i));
    const double allowed = std::max(o.tolerance.absolute, o.tolerance.relative * std::max({exact.x, exact.y, exact.z}));
    const std::size_t n = street::lights_that_matter(lights, points.position(i), points.normal(i), allowed, which);
    m.mean += static_cast<double>(n), m.least = std::min(m.least, n), m.most = std::max(m.most, n);
    for (const std::size_t k : which) somewhere[k] = true;
  }
  m.mean /= static_cast<double>(sampled);
  m.lights = static_cast<std::size_t>(std::count(somewhere.begin(), somewhere.end(), true));
  return m;
}

bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option == "--json") {
      o.json = true;
      continue;
    }
    if (i + 1 == argc) return false;
    const double value = std::atof(argv[++i]);
    if (option == "--points")
      o.points = static_cast<std::size_t>(value);
    else if (option == "--check")
      o.check = static_cast<std::size_t>(value);
    else if (option == "--rounds")
      o.rounds = static_cast<std::size_t>(value);
    else if (option == "--columns")
      o.columns = static_cast<int>(value);
    else if (option == "--rows")
      o.rows = static_cast<int>(value);
    else if (option == "--relative")
      o.tolerance.relative = value;
    else if (option == "--absolute")
      o.tolerance.absolute = value;
    else
      return false;
  }
  return o.points > 0 && o.rounds > 0 && o.columns > 0 && o.rows > 0;
}

void print(const Options& o, const Matter& m, const std::vector<Row>& rows) {
  fmt::print("{}\n{} lights, {} points, one thread; |error| <= max({} lx, {} of the sum)\n", bench::machine(), o.columns * o.rows, o.points,
             o.tolerance.absolute, o.tolerance.relative);
  fmt::print(
      "lights that matter (the fewest beside which all others together are within the tolerance): {:.1f} a point, {} to {}; {} of all "
      "matter at some point\n\n",
      m.mean, m.least, m.most, m.lights);
  fmt::print("{:<12} {:>14} {:>12} {:>9} {:>9} | {:>10} {:>8} {:>8} {:>8} | {:>16} {:>9} {:>8}\n", "order", "all lights ns", "rig ns",
             "faster", "at least", "evaluated", "small", "unseen", "bounds", "error/tolerance", "/bound", "checked");
  for (const Row& r : rows) {
    const auto per_point = [&](std::uint64_t n) { return static_cast<double>(n) / static_cast<double>(o.points); };
    fmt::print("{:<12} {:>14.1f} {:>12.1f} {:>8.1f}x {:>8.1f}x | {:>10.1f} {:>8.1f} {:>8.1f} {:>8.2f} | {:>16.3f} {:>9.3f} {:>8}\n",
               r.order, r.all_ns, r.rig_ns, r.ratio, r.slowest_ratio, per_point(r.counts.evaluated), per_point(r.counts.skipped_small),
               per_point(r.counts.skipped_unseen), per_point(r.counts.bounds), r.worst, r.worst_of_bound, r.checked);
  }
}

void print_json(const Options& o, const Matter& m, const std::vector<Row>& rows) {
  nlohmann::ordered_json table = nlohmann::ordered_json::array();
  for (const Row& r : rows)
    table.push_back({{"order", r.order},
                     {"all_ns", r.all_ns},
                     {"ns", r.rig_ns},
                     {"ratio", r.ratio},
                     {"least_ratio", r.slowest_ratio},
                     {"evaluated", r.counts.evaluated},
                     {"skipped_small", r.counts.skipped_small},
                     {"skipped_unseen", r.counts.skipped_unseen},
                     {"repeated", r.counts.repeated},
                     {"bounds", r.counts.bounds},
                     {"error_of_tolerance", r.worst},
                     {"error_of_bound", r.worst_of_bound},
                     {"checked", r.checked}});
  const nlohmann::ordered_json document = {{"schema", "etendue.bench/1"},
                                           {"machine", bench::machine()},
                                           {"lights", o.columns * o.rows},
                                           {"points", o.points},
                                           {"matter", {{"mean", m.mean}, {"least", m.least}, {"most", m.most}, {"lights", m.lights}}},
                                           {"result", table}};
  fmt::print("{}\n", document.dump(1));
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  if (!parse(argc, argv, o)) {
    fmt::print(stderr,
               "usage: {} [--points N] [--check N] [--rounds N] [--columns N] [--rows N] [--relative X] [--absolute LUX] [--json]\n",
               argv[0]);
    return 2;
  }
  protocol::Random random(3);
  const std::vector<Emitter> lights = street::lamps(o.columns, o.rows, random);
  const FloatPoints points = street::points(o.columns, o.rows, o.points, random);
  const Matter m = matter(o, lights, points);
  const std::vector<Row> rows{measured("random", o, lights, points), measured("by street", o, lights, street::in_order(points))};
  o.json ? print_json(o, m, rows) : print(o, m, rows);
  return 0;
}
