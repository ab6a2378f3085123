// Run time against error of area lights' diffuse light: batches of 4096 points, one thread.
#include "etendue/illuminance_batch.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using protocol::Kind;

constexpr std::size_t count = 4096;

EmitterShape shape_of(Kind kind) {
  switch (kind) {
    case Kind::sphere:
      return SphereEmitter{{}, 1};
    case Kind::disk:
      return DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 1};
    case Kind::capsule:
    case Kind::flat_tube:
    case Kind::open_tube:
      return TubeEmitter{{-0.5, 0, 0},
                         {0.5, 0, 0},
                         0.07,
                         kind == Kind::capsule     ? Caps::round
                         : kind == Kind::flat_tube ? Caps::flat
                                                   : Caps::none};
    default:
      return protocol::rectangle({}, {1, 0, 0}, {0, 1, 0}, 1, 0.7);
  }
}
// A dome of triangles that emit outwards.
MeshEmitter dome() {
  constexpr int rows = 8;
  const auto at = [](int row, int column) {
    const double theta = 0.5 * pi * row / rows, phi = 2 * pi * column / rows;
    return Vec3d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} * 0.3;
  };
  MeshEmitter mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < rows; ++column) {
      mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
      if (row > 0) mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
    }
  }
  return mesh;
}
const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::sphere:
      return "sphere";
    case Kind::disk:
      return "disk";
    case Kind::capsule:
      return "capsule";
    case Kind::flat_tube:
      return "tube with flat ends";
    case Kind::open_tube:
      return "open tube";
    default:
      return "rectangle";
  }
}

// One light, points all around at the protocol's distances and with its normals: those above its horizon or those that it crosses.
struct Case {
  Emitter light;
  std::optional<LightBatch> prepared;
  std::vector<float> px, py, pz, nx, ny, nz, sr;
  PointBatch batch() const { return {px, py, pz, nx, ny, nz, {}}; }

  // Points facing a light and turned away from it.
  explicit Case(const EmitterShape& shape) : sr(count) {
    protocol::Random random(11);
    light = protocol::white(shape);
    prepared = *LightBatch::of(light);
    while (px.size() < count) add(random.direction() * random.uniform(0.5, 6), random.direction());
  }
  Case(Kind kind, bool mixed) : sr(count) {
    protocol::Random random(11);
    light = protocol::white(shape_of(kind));
    prepared = *LightBatch::of(light);
    while (px.size() < count) {
      const bool round = kind == Kind::sphere || kind == Kind::disk;
      Vec3d p = random.direction() * random.uniform(kind == Kind::sphere ? 1.05 : 0.5, round ? 6 : 3);
      if (kind == Kind::rect || kind == Kind::disk) p.z = std::max(std::abs(p.z), kind == Kind::disk ? 0.04 : 0.02);
      if (std::holds_alternative<TubeEmitter>(light.shape) && std::hypot(p.y, p.z) < 0.0735) continue;
      const Vec3d n = random.direction();
      const double low = protocol::lowest(light.shape, p, n), high = -protocol::lowest(light.shape, p, -n);
      if (high <= 0 || (low < 0) != (mixed && px.size() % 2 == 0)) continue;
      add(p, n);
    }
  }
  void end(const Window& window) {
    light.window = window;
    prepared = *LightBatch::of(light);
  }
  void add(const Vec3d& p, const Vec3d& n) {
    px.push_back(static_cast<float>(p.x)), py.push_back(static_cast<float>(p.y)), pz.push_back(static_cast<float>(p.z));
    nx.push_back(static_cast<float>(n.x)), ny.push_back(static_cast<float>(n.y)), nz.push_back(static_cast<float>(n.z));
  }
  Vec3d position(std::size_t i) const { return {px[i], py[i], pz[i]}; }
  Vec3d normal(std::size_t i) const { return normalised(Vec3d{nx[i], ny[i], nz[i]}); }

  void in_vectors() {
    if (!prepared->projected_solid_angles(batch(), sr, 0)) std::fill(sr.begin(), sr.end(), -1.0f);
    bench::keep(sr.data());
  }
  void one_by_one() {
    for (std::size_t i = 0; i < count; ++i) sr[i] = static_cast<float>(illuminance(light, position(i), normal(i)).x);
    bench::keep(sr.data());
  }
  std::string error() {
    in_vectors();
    double sum = 0, worst = 0;
    std::size_t judged = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double expected = illuminance(light, position(i), normal(i)).x;
      if (expected < 1e-3) continue;
      const double relative = std::abs(static_cast<double>(sr[i]) - expected) / expected;
      sum += relative, worst = std::max(worst, relative), ++judged;
    }
    return fmt::format("mean {:.1e}, largest {:.1e}", sum / static_cast<double>(judged), worst);
  }
};

void add_rows(bench::Bench& table, const std::string& name, Case& c) {
  bench::Task& task = table.task(name, count);
  task.contender("one by one, in double", bench::Kind::anchor, "", [&c] { c.one_by_one(); });
  task.contender("in vectors", bench::Kind::ours, c.error(), [&c] { c.in_vectors(); });
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    task.contender(fmt::format("  {}", hwy::TargetName(target)), bench::Kind::ours, "", [&c, target] {
      hwy::SetSupportedTargetsForTest(target);
      c.in_vectors();
      hwy::SetSupportedTargetsForTest(0);
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  bench::Bench table;
  std::vector<std::unique_ptr<Case>> cases;
  for (const Kind kind : {Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube}) {
    for (const bool mixed : {false, true}) {
      cases.push_back(std::make_unique<Case>(kind, mixed));
      add_rows(table, fmt::format("{}, {}", name_of(kind), mixed ? "half of them cut by the horizon" : "above the horizon"), *cases.back());
    }
  }
  // Wholly within the range, cut by it and beyond.
  for (const Kind kind : {Kind::rect, Kind::sphere, Kind::disk, Kind::capsule}) {
    for (const Falloff& falloff : {Falloff::gltf, Falloff::frostbite, Falloff::linear, Falloff::karis}) {
      for (const double range : {30.0, 3.0}) {
        cases.push_back(std::make_unique<Case>(kind, true));
        cases.back()->end({falloff, range});
        add_rows(table, fmt::format("{}, half of them cut by the horizon, {} to {} m", name_of(kind), etendue::name_of(falloff), range),
                 *cases.back());
      }
    }
  }
  const Rgb one{1, 1, 1};
  const std::vector<std::pair<const char*, EmitterShape>> others{{"mesh of 120 triangles", dome()},
                                                                 {"line", LineEmitter{{-0.5, 0, 0}, {0.5, 0, 0}, one}},
                                                                 {"point light", PunctualEmitter{{}, {}, one, PointShape{}}},
                                                                 {"spot", PunctualEmitter{{}, {}, one, SpotShape{0.3, 0.8}}},
                                                                 {"sun", DistantEmitter{{0, 0, 1}, one, 0.0046}}};
  for (const auto& [name, shape] : others) {
    cases.push_back(std::make_unique<Case>(shape));
    add_rows(table, name, *cases.back());
  }
  for (const Falloff& falloff :
       {Falloff::gltf, Falloff::frostbite, Falloff{Falloff::Law::power, 20}, Falloff::smoothstep, Falloff::karis}) {
    cases.push_back(std::make_unique<Case>(PunctualEmitter{{}, {}, one, PointShape{}}));
    cases.back()->end({falloff, 5});
    add_rows(table, fmt::format("point light, {} to 5 m", etendue::name_of(falloff)), *cases.back());
  }
  return table.run(argc, argv);
}
