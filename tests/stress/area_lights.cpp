// Looks for what breaks the evaluation of area lights: many configurations of every shape on every instruction set against the definition
// in double, a search uphill from the worst of them, and numbers alone (finite, in range) at many more.
//   stress_area_lights [--configurations N] [--search N] [--points N] [--seed N] [--shape NAME]
#include <fmt/format.h>
#include <hwy/highway.h>

#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "configurations.h"
#include "etendue/illuminance_batch.h"

namespace {

using namespace etendue;
using namespace etendue::stress;
using eval::protocol::Random;

struct Options {
  std::size_t configurations = 20000, search = 2000, points = 1000000;
  std::uint64_t seed = 1;
  std::string_view shape;
};

Options options_from(int argc, char** argv) {
  Options o;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--configurations") o.configurations = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--search") o.search = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--points") o.points = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--seed") o.seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--shape") o.shape = argv[i + 1];
  }
  return o;
}

Numbers random_numbers(Random& random) {
  Numbers u;
  for (double& x : u) x = random.uniform(0, 1);
  return u;
}

float in_floats(const Configuration& c) {
  const auto& p = c.point;
  float sr = -1;
  const Result<eval::LightBatch> batch = eval::LightBatch::of(c.light);
  if (!batch ||
      !batch->projected_solid_angles({{&p[0], 1}, {&p[1], 1}, {&p[2], 1}, {&p[3], 1}, {&p[4], 1}, {&p[5], 1}, c.origin}, {&sr, 1}, -2))
    return -1;
  return sr;
}

// What the definition says, and a surface facing the light, for which the bound's solid angle stands: it is no less.
struct Truth {
  double value, facing;
};
Truth truth_of(const Configuration& c) {
  using eval::protocol::lux_at;
  const Vec3d p = c.position();
  return {lux_at(c.light, p, c.normal()), lux_at(c.light, p, normalised(c.centre - p))};
}

// |error| over 1e-5 value + 2e-6 min(1, solid angle), and what the definition itself is good for: doubles leave some 1e-16 of the edges'
// terms, which are size / distance, and of the terms of a cut circle, which are 1.
double over_bound(Kind kind, float sr, const Truth& truth, const Configuration& c) {
  const bool edges = kind == Kind::rect || kind == Kind::star || kind == Kind::mesh || kind == Kind::sphere;
  const double rounding = 1e-15 * (edges ? std::min(1.0, c.size / c.distance) : 1);
  return std::abs(static_cast<double>(sr) - truth.value) / (1e-5 * truth.value + 2e-6 * std::min(1.0, truth.facing) + rounding + 1e-37);
}
// A mesh that emits on both sides is seen through its own front.
bool is_in_range(Kind kind, float sr) { return sr >= 0 && sr <= static_cast<float>(kind == Kind::mesh ? 2 * pi : pi) * 1.00001f; }

struct Found {
  double ratio = 0;
  Numbers at{};
};
struct Report {
  std::size_t out_of_range = 0, over = 0, judged = 0;
  double relative = 0, mean = 0;
  std::vector<Found> worst;  // a few, the worst first

  void add(Kind kind, float sr, const Truth& truth, const Configuration& c, const Numbers& u) {
    if (!is_in_range(kind, sr)) ++out_of_range;
    const double ratio = std::isfinite(sr) ? over_bound(kind, sr, truth, c) : 1e300;
    if (ratio > 1) ++over;
    if (truth.value >= 1e-3) {
      const double error = std::abs(static_cast<double>(sr) - truth.value) / truth.value;
      relative = std::max(relative, error);
      mean += error;
      ++judged;
    }
    if (worst.size() == 8 && ratio <= worst.back().ratio) return;
    if (worst.size() == 8) worst.pop_back();
    worst.insert(std::upper_bound(worst.begin(), worst.end(), ratio, [](double r, const Found& f) { return r > f.ratio; }), {ratio, u});
  }
};

// Uphill from the worst: a step in some of the numbers, kept if it is worse, smaller if not.
Found climbed(Kind kind, Found from, std::size_t steps, Random& random) {
  double step = 0.1;
  for (std::size_t i = 0; i < steps; ++i) {
    Numbers u = from.at;
    for (double& x : u)
      if (random.uniform(0, 1) < 0.3) x = std::fmod(x + step * random.uniform(-1, 1) + 1, 1);
    const Configuration c = configuration(kind, u);
    const double ratio = over_bound(kind, in_floats(c), truth_of(c), c);
    if (ratio > from.ratio)
      from = {ratio, u};
    else
      step = std::max(step * 0.97, 1e-4);
  }
  return from;
}

std::string described(Kind kind, const Numbers& u) {
  const Configuration c = configuration(kind, u);
  const Truth truth = truth_of(c);
  const Vec3d n = c.normal(), to = normalised(c.centre - c.position());
  std::string text =
      fmt::format("size {:.3g} m, distance {:.3g} sizes, {:.3g} m from the origin, n.l {:.3g}, value {:.4g}, found {:.4g}, facing {:.3g}",
                  c.size, length(c.centre - c.position()) / c.size, length(c.position()), dot(n, to), truth.value,
                  static_cast<double>(in_floats(c)), truth.facing);
  for (const double x : u) text += fmt::format(" {:.17g}", x);
  return text;
}

// Numbers alone, many points a light.
std::size_t count_out_of_range(Kind kind, std::size_t points, Random& random) {
  constexpr std::size_t each = 256;
  std::array<std::vector<float>, 6> p;
  for (auto& part : p) part.resize(each);
  std::vector<float> sr(each);
  std::size_t bad = 0;
  for (std::size_t done = 0; done < points; done += each) {
    const Configuration c = configuration(kind, random_numbers(random));
    const Result<eval::LightBatch> batch = eval::LightBatch::of(c.light);
    for (std::size_t i = 0; i < each; ++i) {
      const Vec3d at = c.centre - c.origin + random.direction() * (c.size * random.log_uniform(1e-5, 1e6)), n = random.direction();
      for (int k = 0; k < 3; ++k) {
        p[static_cast<std::size_t>(k)][i] = static_cast<float>(at[k]);
        p[static_cast<std::size_t>(k) + 3][i] = static_cast<float>(n[k]);
      }
    }
    if (!batch || !batch->projected_solid_angles({p[0], p[1], p[2], p[3], p[4], p[5], c.origin}, sr, -2)) return points;
    for (const float x : sr) bad += is_in_range(kind, x) ? 0 : 1;
  }
  return bad;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = options_from(argc, argv);
  fmt::print(
      "{} configurations of each shape and instruction set against the definition in double, {} steps uphill from each of the 8 worst, {} "
      "points\n"
      "for numbers alone; bound: |error| <= 1e-5 value + 2e-6 min(1, solid angle); relative errors where the value is 1e-3 or more\n\n",
      options.configurations, options.search, options.points);
  fmt::print("{:<16} {:<8} {:>12} {:>10} {:>14} {:>12} {:>12} {:>12}\n", "shape", "set", "out of range", "over bound", "worst/bound",
             "after search", "mean rel.", "worst rel.");
  bool ok = true;
  for (const auto& [kind, name] : kinds) {
    if (!options.shape.empty() && options.shape != name) continue;
    Random random(options.seed);
    std::vector<Numbers> all(options.configurations);
    std::vector<Configuration> made;
    std::vector<Truth> truths;
    for (Numbers& u : all) {
      u = random_numbers(random);
      made.push_back(configuration(kind, u));
      truths.push_back(truth_of(made.back()));
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      Report report;
      for (std::size_t i = 0; i < all.size(); ++i) report.add(kind, in_floats(made[i]), truths[i], made[i], all[i]);
      Found worst = report.worst.front();
      for (const Found& f : report.worst) {
        const Found found = climbed(kind, f, options.search, random);
        if (found.ratio > worst.ratio) worst = found;
      }
      report.out_of_range += count_out_of_range(kind, options.points, random);
      fmt::print("{:<16} {:<8} {:>12} {:>10} {:>14.3g} {:>12.3g} {:>12.2g} {:>12.2g}\n", name, hwy::TargetName(target), report.out_of_range,
                 report.over, report.worst.front().ratio, worst.ratio,
                 report.mean / static_cast<double>(std::max<std::size_t>(report.judged, 1)), report.relative);
      if (worst.ratio > 1) fmt::print("    {}\n", described(kind, worst.at));
      std::fflush(stdout);
      ok = ok && report.out_of_range == 0 && worst.ratio <= 1;
    }
    hwy::SetSupportedTargetsForTest(0);
  }
  return ok ? 0 : 1;
}
