// Published methods for specular light in vectors of floats against their definitions in double.
#include "etendue/specular_method_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "etendue/specular_methods.h"
#include "eval_protocol.h"
#include "float_points.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

struct Views {
  FloatPoints surface;
  std::vector<float> vx, vy, vz, alpha;

  void add(const Vec3d& position, const Vec3d& normal, const Vec3d& view, double a) {
    surface.add(position, normal);
    const Vec3f v = vec_cast<float>(view);
    vx.push_back(v.x), vy.push_back(v.y), vz.push_back(v.z), alpha.push_back(static_cast<float>(a));
  }
  SpecularPoints points() const { return {surface.batch(), vx, vy, vz, alpha}; }
};
Views views_of(const Emitter& light, Random& random, int count) {
  Views views;
  for (int i = 0; i < count; ++i) {
    const auto position = point_around(light.shape, random);
    if (!position) continue;
    const Vec3d normal = random.direction(), l = sample_light(light, *position, random.square()).direction;
    const Vec3d view = i % 2 == 0 ? normal * (2 * dot(normal, l)) - l : random.direction();
    views.add(*position, normal, dot(view, normal) < 0 ? -view : view, std::pow(10.0, random.uniform(-2, 0)));
  }
  return views;
}

// How many of a light's views the batch and the method are apart on.
struct Agreement {
  std::size_t count = 0, apart = 0;
  void add(std::string_view name, const Emitter& light, const Views& views) {
    const auto batch = SpecularMethodBatch::of(name, light);
    if (!batch) return;
    std::vector<float> of_f0(views.alpha.size(), -1), of_f90 = of_f0;
    ASSERT_TRUE(batch->shares(views.points(), of_f0, of_f90, -1));
    for (std::size_t k = 0; k < of_f0.size(); ++k) {
      const Vec3d n = views.surface.normal(k);
      const ShadingPoint point{views.surface.position(k), n, n, normalised(Vec3d{views.vx[k], views.vy[k], views.vz[k]}),
                               GgxLobe{views.alpha[k], {0.3, 0.3, 0.3}, 1}};
      const double expected = find_specular_method(name)->luminance(light, point)->x / batch->scale().x;
      const double value = 0.3 * static_cast<double>(of_f0[k]) + static_cast<double>(of_f90[k]);
      EXPECT_TRUE(std::isfinite(value) && value >= 0);
      ++count;
      if (!(std::abs(value - expected) <= 5e-3 * expected + 1e-5)) ++apart;
    }
  }
};
// A hundredth of them may stand where the floats' roundings decide which part of a method's case it is, or carry a lobe's steepest slope.
TEST(SpecularMethodBatch, IsTheMethodInDouble) {
  on_each_instruction_set([] {
    for (const Kind kind : {Kind::rect, Kind::disk, Kind::sphere, Kind::capsule}) {
      int taken = 0;
      for (const std::string_view name : SpecularMethodBatch::names()) {
        SCOPED_TRACE(name);
        ASSERT_NE(find_specular_method(name), nullptr);
        Random random(21);
        Agreement agreement;
        for (int i = 0; i < 12; ++i) {
          Emitter light = place(kind, random, true).emitter;
          light.two_sided = false;
          if (SpecularMethodBatch::of(name, light)) agreement.add(name, light, views_of(light, random, 101));
        }
        if (agreement.count == 0) continue;
        ++taken;
        EXPECT_LE(agreement.apart, agreement.count / 100) << "of " << agreement.count;
      }
      EXPECT_GE(taken, 6);
    }
  });
}
TEST(SpecularMethodBatch, OfSunsIsTheMethodInDouble) {
  on_each_instruction_set([] {
    int taken = 0;
    for (const std::string_view name : SpecularMethodBatch::names()) {
      SCOPED_TRACE(name);
      Random random(23);
      Agreement agreement;
      for (const double radius : {0.00465, 0.1, 0.8}) {
        const Vec3d towards = random.direction();
        const Emitter sun{DistantEmitter{towards, {2, 2, 2}, radius}, {}, false, {}, {}};
        Views views;
        for (int k = 0; k < 300; ++k) {
          const Vec3d normal = random.direction(), mirrored = normal * (2 * dot(normal, towards)) - towards;
          const Vec3d view = k % 2 == 0 ? normalised(mirrored + random.direction() * 0.1) : random.direction();
          views.add(random.direction(), normal, dot(view, normal) < 0 ? -view : view, std::pow(10.0, random.uniform(-2, 0)));
        }
        agreement.add(name, sun, views);
      }
      if (agreement.count == 0) continue;
      ++taken;
      EXPECT_LE(agreement.apart, agreement.count / 100) << "of " << agreement.count;
    }
    EXPECT_GE(taken, 8);
  });
}
// In contact, within, far away, edge-on, from every angle.
TEST(SpecularMethodBatch, IsFiniteLight) {
  on_each_instruction_set([] {
    const Emitter lights[] = {white(rectangle({}, {1, 0, 0}, {0, 1, 0}, 1, 0.02)), white(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 1}),
                              white(SphereEmitter{{}, 1}), white(TubeEmitter{{-1, 0, 0}, {1, 0, 0}, 0.1, Caps::round}),
                              Emitter{DistantEmitter{{0, 0, 1}, {1, 1, 1}, 0.3}, {}, false, {}, {}}};
    for (const Emitter& light : lights) {
      for (const std::string_view name : SpecularMethodBatch::names()) {
        const auto batch = SpecularMethodBatch::of(name, light);
        if (!batch) continue;
        Random random(22);
        Views views;
        for (int i = 0; i < 700; ++i) {
          const Vec3d n = random.direction(), across = normalised(cross(n, random.direction()));
          Vec3d position = random.direction() * (i % 5 == 0 ? 1 : std::pow(10.0, random.uniform(-6, 6)));
          if (i % 3 == 0) position.z = 0;
          const double lift = std::array{0.0, 1e-9, 1e-4, 0.1, 1.0}[static_cast<std::size_t>(i % 5)];
          views.add(position, n, i % 7 == 0 ? n : normalised(across + n * lift), std::pow(10.0, random.uniform(-6, 0.5)));
        }
        std::vector<float> of_f0(views.alpha.size(), -1), of_f90 = of_f0;
        ASSERT_TRUE(batch->shares(views.points(), of_f0, of_f90, -1));
        for (std::size_t k = 0; k < of_f0.size(); ++k)
          EXPECT_TRUE(of_f0[k] >= 0 && of_f90[k] >= 0 && std::isfinite(of_f0[k] + of_f90[k])) << name << ' ' << k << ' ' << of_f0[k];
      }
    }
  });
}
TEST(SpecularMethodBatch, RefusesWhatItHasNoVectorsFor) {
  Emitter light = white(SphereEmitter{{0, 0, 3}, 1});
  EXPECT_EQ(SpecularMethodBatch::of("karis-18", light).error().code, "METHOD_SHAPE");
  EXPECT_EQ(SpecularMethodBatch::of("moments", light).error().code, "METHOD_SHAPE");
  const auto batch = SpecularMethodBatch::of("karis-14", light);
  ASSERT_TRUE(batch);
  Views views;
  views.add({}, {0, 0, 1}, {0, 0, 1}, 0.5);
  views.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 1}, {0, 0, 1}, 0.5);
  std::vector<float> one(1), two(2), other(2);
  EXPECT_EQ(batch->shares(views.points(), one, two, 0).error().code, "BATCH_SIZES_DIFFER");
  const BatchOutcome done = batch->shares(views.points(), two, other, -7);
  ASSERT_TRUE(done);
  EXPECT_EQ(*done, 1u);
  EXPECT_GT(two[0], 0);
  EXPECT_EQ(two[1], -7);
  light.window = {Falloff::gltf, 3};
  EXPECT_EQ(SpecularMethodBatch::of("karis-14", light).error().code, "METHOD_SHAPE");
}

}  // namespace
