// A line a shape, position of the horizon and window, the centre of the light at .3 to 1 of the range: shape, above|across, window,
// aggregate error of LightBatch in per cent, its largest error over its bound, aggregate error of the window at the light's position in per
// cent, how many times the time of the closed form the adaptive quadrature to 1e-5 takes. Argument: lights (1000).
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "../eval_protocol.h"
#include "etendue/illuminance_batch.h"
#include "stopwatch.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// Frostbite evaluates the window once, at the light's position (Lagarde and de Rousiers 2014, 4.4).
Vec3d position_of(const EmitterShape& shape) {
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return s->centre;
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) return d->centre;
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return (t->a + t->b) * 0.5;
  const auto& v = std::get<PolygonEmitter>(shape).vertices;
  return (v[0] + v[2]) * 0.5;
}

double in_floats(const Emitter& light, const Vec3d& position, const Vec3d& normal) {
  const std::vector<float> zero{0}, nx{static_cast<float>(normal.x)}, ny{static_cast<float>(normal.y)}, nz{static_cast<float>(normal.z)};
  std::vector<float> sr(1);
  const Result<LightBatch> batch = LightBatch::of(light);
  if (!batch || !batch->projected_solid_angles({zero, zero, zero, nx, ny, nz, position}, sr, -1)) return -1;
  return static_cast<double>(sr[0]);
}

void measure(Kind kind, const char* shape, bool above, Falloff falloff, int lights) {
  Random random(static_cast<std::uint64_t>(kind) + 71);
  double all = 0, batch_off = 0, position_off = 0, over_bound = 0;
  Stopwatch closed, quadrature;
  for (int i = 0; i < lights; ++i) {
    const Placement p = place(kind, random, above);
    Emitter light = p.emitter;
    const double distance = length(position_of(light.shape) - p.position);
    light.window = {falloff, distance / random.uniform(0.3, 1)};
    const Vec3f rounded = vec_cast<float>(p.normal);
    const Vec3d normal = normalised(vec_cast<double>(rounded));
    const double exact = closed([&] { return illuminance(light, p.position, normal).x; });
    const double open = illuminance(p.emitter, p.position, normal).x;
    const double facing = illuminance(p.emitter, p.position, p.towards).x;
    const double error = std::abs(in_floats(light, p.position, p.normal) - exact);
    all += exact;
    batch_off += error;
    position_off += std::abs(open * window_at(light.window, distance) - exact);
    over_bound = std::max(over_bound, error / (1e-5 * exact + 2e-6 * std::min(1.0, facing)));
    light.pattern = [](Vec2d) { return Rgb{1, 1, 1}; };
    const ShadingPoint point{p.position, normal, normal, normal, Lambert{{1, 1, 1}}};
    quadrature([&] { return reference(light, point, {1e-5, 0}); });
  }
  fmt::print("{} {} {} {:.2g} {:.2g} {:.3g} {:.3g}\n", shape, above ? "above" : "across", name_of(falloff), 100 * batch_off / all,
             over_bound, 100 * position_off / all, quadrature.seconds() / closed.seconds());
}

}  // namespace

int main(int argc, char** argv) {
  const int lights = argc > 1 ? std::atoi(argv[1]) : 1000;
  for (const auto& [kind, shape] : {std::pair{Kind::rect, "rect"},
                                    {Kind::sphere, "sphere"},
                                    {Kind::disk, "disk"},
                                    {Kind::capsule, "tube"},
                                    {Kind::flat_tube, "flat-tube"},
                                    {Kind::open_tube, "open-tube"}})
    for (const bool above : {true, false})
      for (const Falloff& falloff : {Falloff::frostbite, Falloff::gltf, Falloff::linear, Falloff::smoothstep, Falloff::karis})
        measure(kind, shape, above, falloff, lights);
}
