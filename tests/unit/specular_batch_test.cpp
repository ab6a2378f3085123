// Specular light in vectors of floats against the methods in double.
#include "etendue/specular_batch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "etendue/specular_methods.h"
#include "eval_protocol.h"
#include "float_points.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr std::array methods{"ltc", "ltc-one-cosine", "ltc-two-lobes", "ltc-two-cosines", "moments"};

struct Views {
  FloatPoints surface;
  std::vector<float> vx, vy, vz, alpha;

  void add(const Vec3d& position, const Vec3d& normal, const Vec3d& view, double a) {
    surface.add(position, normal);
    const Vec3f v = vec_cast<float>(view);
    vx.push_back(v.x), vy.push_back(v.y), vz.push_back(v.z), alpha.push_back(static_cast<float>(a));
  }
  SpecularPoints points() const { return {surface.batch(), vx, vy, vz, alpha}; }
  // What the floats say.
  ShadingPoint point(std::size_t i, double f0, double f90) const {
    const Vec3d n = surface.normal(i);
    return {surface.position(i), n, n, normalised(Vec3d{vx[i], vy[i], vz[i]}), GgxLobe{alpha[i], {f0, f0, f0}, f90}};
  }
};
struct Answers {
  std::vector<float> of_f0, of_f90;
  explicit Answers(std::size_t count) : of_f0(count, -1), of_f90(count, -1) {}
};
Answers answers(const char* method, const Emitter& light, const Views& views) {
  Answers out(views.alpha.size());
  const Result<SpecularBatch> batch = SpecularBatch::of(*SpecularBatch::rule_named(method), light);
  EXPECT_TRUE(batch);
  EXPECT_TRUE(batch->shares(views.points(), out.of_f0, out.of_f90, -1));
  return out;
}
// Half of them with the mirror direction within the light.
Vec3d view_of(const Placement& p, Random& random) {
  const double choice = random.uniform(0, 1);
  if (choice < 0.5) {
    const Vec3d l = sample_light(p.emitter, p.position, random.square()).direction;
    if (const double z = dot(l, p.normal); z > 0.01) return p.normal * (2 * z) - l;
  }
  for (;;) {
    const Vec3d view = random.direction();
    if (dot(view, p.normal) > 0.01) return view;
  }
}
// Of a rectangle and points around it, some behind it and some under whose horizon it is.
Views views_around(const Emitter& light, Random& random, int count) {
  Views views;
  for (int i = 0; i < count; ++i) {
    Placement p{light, random.direction() * random.uniform(0.5, 4), random.direction(), {}};
    views.add(p.position, p.normal, view_of(p, random), std::pow(10.0, random.uniform(-3, 0)));
  }
  return views;
}

// The roundings of directions in floats, some 1e-6 after frames and half vectors, move an outline by as much over alpha n.v of the lobe's
// width, (v + l) being as high as n.v at least. On the whole it is nothing.
TEST(SpecularBatch, IsTheMethodInDouble) {
  on_each_instruction_set([] {
    for (const char* name : methods) {
      SCOPED_TRACE(name);
      const SpecularMethod& method = *find_specular_method(name);
      Random random(3);
      double errors = 0, sum = 0;
      for (const bool two_sided : {false, true}) {
        Emitter light = white(rectangle({0.3, -0.2, 0.1}, {0.6, 0, 0.8}, {0, 1, 0}, 1.3, 0.7));
        light.two_sided = two_sided;
        const Views views = views_around(light, random, 1500);
        const Answers found = answers(name, light, views);
        for (std::size_t i = 0; i < views.alpha.size(); ++i) {
          for (const bool metal : {true, false}) {
            const double expected = method.luminance(light, views.point(i, metal ? 1 : 0.04, 1))->x;
            const double value = (metal ? 1 : 0.04) * static_cast<double>(found.of_f0[i]) + static_cast<double>(found.of_f90[i]);
            const ShadingPoint point = views.point(i, 1, 1);
            const double cosine = std::abs(dot(point.view, point.normal)), narrow = static_cast<double>(views.alpha[i]) * cosine;
            EXPECT_NEAR(value, expected, 2e-3 * expected + 1e-4 + 2e-6 / narrow)
                << "alpha " << views.alpha[i] << " cosine " << cosine << " point " << i;
            errors += std::abs(value - expected), sum += expected;
          }
        }
      }
      EXPECT_LT(errors, 5e-5 * sum);
    }
  });
}
// Over points around 40 lights, light_of(i, random), on every instruction set: near in each answer, nearer on the mean.
template <class LightOf>
void expect_cosines_as_in_double(std::initializer_list<const char*> names, unsigned seed, LightOf light_of) {
  on_each_instruction_set([&] {
    for (const char* name : names) {
      const SpecularMethod& method = *find_specular_method(name);
      Random random(seed);
      double errors = 0, sum = 0;
      for (int i = 0; i < 40; ++i) {
        const Emitter light = light_of(i, random);
        Views views;
        for (int k = 0; k < 100; ++k) {
          const auto position = point_around(light.shape, random);
          if (!position) continue;
          const Placement p{light, *position, random.direction(), {}};
          views.add(p.position, p.normal, view_of(p, random), std::pow(10.0, random.uniform(-3, 0)));
        }
        const Answers found = answers(name, light, views);
        for (std::size_t k = 0; k < views.alpha.size(); ++k) {
          for (const bool metal : {true, false}) {
            const ShadingPoint point = views.point(k, metal ? 1 : 0.04, 1);
            const double expected = method.luminance(light, point)->x;
            const double value = (metal ? 1 : 0.04) * static_cast<double>(found.of_f0[k]) + static_cast<double>(found.of_f90[k]);
            const double narrow = static_cast<double>(views.alpha[k]) * std::abs(dot(point.view, point.normal));
            EXPECT_NEAR(value, expected, 1e-4 * expected + 1e-5 + 2e-6 / narrow)
                << name << ' ' << i << ' ' << k << " alpha " << views.alpha[k] << " cosine " << dot(point.view, point.normal);
            errors += std::abs(value - expected), sum += expected;
          }
        }
      }
      EXPECT_LT(errors, 5e-6 * sum);
    }
  });
}

// A round light's outline stays a cone over an ellipse, so that its form is as exact in floats as digits allow.
TEST(SpecularBatch, OfRoundLightsIsTheTransformedCosineInDouble) {
  expect_cosines_as_in_double({"ltc", "ltc-one-cosine", "ltc-two-lobes", "ltc-two-caps"}, 6, [](int i, Random& random) {
    Emitter light = place(i % 2 == 0 ? Kind::sphere : Kind::disk, random, true).emitter;
    light.two_sided = i % 4 == 1;
    return light;
  });
}
// Caps are parts of cones over ellipses: as exact.
TEST(SpecularBatch, OfTubesIsTheTransformedCosineInDouble) {
  expect_cosines_as_in_double({"ltc", "ltc-two-lobes"}, 13, [](int, Random& random) { return place(Kind::capsule, random, true).emitter; });
}
// Of the size of the real one on narrow lobes too, of which it fills much.
TEST(SpecularBatch, OfSunsIsTheMethodInDouble) {
  on_each_instruction_set([] {
    for (const std::string name : {"ltc", "ltc-one-cosine", "ltc-two-lobes", "ltc-two-caps", "moments"}) {
      Random random(7);
      double errors = 0, sum = 0;
      for (const double radius : {0.00465, 0.1, 0.8}) {
        const Vec3d towards = random.direction();
        const Emitter sun{DistantEmitter{towards, {2, 2, 2}, radius}, {}, false, {}, {}};
        Views views;
        for (int k = 0; k < 300; ++k) {
          const Placement p{sun, random.direction(), random.direction(), towards};
          views.add(p.position, p.normal, view_of(p, random), std::pow(10.0, random.uniform(-3, 0)));
        }
        const auto batch = SpecularBatch::of(*SpecularBatch::rule_named(name), sun);
        ASSERT_TRUE(batch);
        Answers found(views.alpha.size());
        ASSERT_TRUE(batch->shares(views.points(), found.of_f0, found.of_f90, -1));
        for (std::size_t k = 0; k < views.alpha.size(); ++k) {
          const double expected = find_specular_method(name)->luminance(sun, views.point(k, 0.5, 1))->x;
          const double value = batch->scale().x * (0.5 * static_cast<double>(found.of_f0[k]) + static_cast<double>(found.of_f90[k]));
          errors += std::abs(value - expected) / batch->scale().x, sum += expected / batch->scale().x;
        }
      }
      // Moments: of other parts of the outline.
      EXPECT_LT(errors, (name == "moments" ? 1e-2 : 2e-4) * sum) << name;
    }
  });
}
// In contact, within, far away, edge-on, of no size and of any, from every angle.
void expect_finite_light(const char* name, const Emitter& light, double size, Random& random) {
  Views views;
  for (int i = 0; i < 1500; ++i) {
    const Vec3d n = random.direction(), across = normalised(cross(n, random.direction()));
    const double lift = std::array{0.0, 1e-9, 1e-4, 0.1, 1.0}[static_cast<std::size_t>(i % 5)];
    Vec3d position = random.direction() * std::pow(10.0, random.uniform(-6, 6));
    if (i % 3 == 0) position.z *= std::pow(10.0, random.uniform(-8, 0));
    if (i % 11 == 0) position = random.direction() * (size * (1 + std::pow(10.0, random.uniform(-8, 0))));
    if (i % 13 == 0) position.y = position.z = 0;
    views.add(position, n, i % 7 == 0 ? n : normalised(across + n * lift), std::pow(10.0, random.uniform(-6, 0.5)));
  }
  views.add({}, {0, 0, 1}, {0, 0, 1}, 0.3);
  const Answers found = answers(name, light, views);
  for (std::size_t i = 0; i < views.alpha.size(); ++i) {
    EXPECT_TRUE(found.of_f0[i] >= 0 && found.of_f90[i] >= 0 && found.of_f0[i] + found.of_f90[i] <= 1.0002f)
        << name << ' ' << size << ' ' << i << ' ' << found.of_f0[i] << ' ' << found.of_f90[i];
  }
}
TEST(SpecularBatch, OfRoundLightsIsFiniteLight) {
  on_each_instruction_set([] {
    Random random(10);
    for (const char* name : {"ltc", "ltc-one-cosine", "ltc-two-lobes", "ltc-two-caps", "moments"}) {
      for (const double size : {0.0, 1e-6, 1.0, 1e5}) {
        Emitter disk = white(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, size});
        disk.two_sided = true;
        for (const Emitter& light : {disk, white(SphereEmitter{{}, size})}) expect_finite_light(name, light, size, random);
      }
    }
  });
}
TEST(SpecularBatch, OfTubesIsFiniteLight) {
  on_each_instruction_set([] {
    Random random(11);
    for (const char* name : {"moments", "ltc", "ltc-two-lobes"})
      for (const double size : {1e-6, 1.0, 1e5})
        for (const double radius : {0.01, 0.5, 3.0})
          expect_finite_light(name, white(TubeEmitter{{-size, 0, 0}, {size, 0, 0}, radius * size, Caps::round}), size, random);
  });
}
// Close to its axis' line beyond an end the nearer cap hides nearly all else, or all: its arc is most of a turn.
TEST(SpecularBatch, MomentsOfTubesSeenEndOnAreCloseToTheDouble) {
  Random random(14);
  const Emitter tube = white(TubeEmitter{{0, 0, 0}, {0, 0, 1}, 0.2, Caps::round});
  Views views;
  for (int i = 0; i < 1000; ++i) {
    const double height = -0.25 - random.uniform(0, 1), angle = random.uniform(0, 2 * pi), off = random.uniform(0, 0.6);
    Placement p{tube, {off * std::cos(angle), off * std::sin(angle), height}, random.direction(), {}};
    p.normal = normalised(p.normal + Vec3d{0, 0, 1});
    const Vec3d view = view_of(p, random);
    if (dot(view, p.normal) > 0.05) views.add(p.position, p.normal, view, std::pow(10.0, random.uniform(-2, 0)));
  }
  on_each_instruction_set([&] {
    const Answers found = answers("moments", tube, views);
    double apart = 0, sum = 0;
    for (std::size_t i = 0; i < views.alpha.size(); ++i) {
      const double value = 0.04 * static_cast<double>(found.of_f0[i]) + static_cast<double>(found.of_f90[i]);
      const double expected = find_specular_method("moments")->luminance(tube, views.point(i, 0.04, 1))->x;
      apart += std::abs(value - expected), sum += expected;
    }
    // In two parts it would be .6 %.
    EXPECT_LT(apart, 0.003 * sum);
  });
}
// A tube without a length is a sphere, and one that is hardly longer is hardly another light.
TEST(SpecularBatch, OfTheShortestTubeIsThatOfASphere) {
  Random random(12);
  const Emitter sphere = white(SphereEmitter{{0.3, -0.2, 0.1}, 0.4});
  const Views views = views_around(sphere, random, 300);
  const Answers expected = answers("moments", sphere, views);
  for (const double length : {0.0, 1e-4}) {
    const Emitter tube = white(TubeEmitter{{0.3, -0.2, 0.1}, {0.3, -0.2, 0.1 + length}, 0.4, Caps::round});
    const Answers found = answers("moments", tube, views);
    double apart = 0, sum = 0;
    for (std::size_t i = 0; i < views.alpha.size(); ++i)
      apart += std::abs(static_cast<double>(found.of_f0[i] - expected.of_f0[i])), sum += static_cast<double>(expected.of_f0[i]);
    EXPECT_LT(apart, (length > 0 ? 0.02 : 0) * sum + 1e-12);
  }
}
// A round outline, and a tube's, is cut into other parts than in double, so that each has errors of its own, of which the batch's are up to
// twice as large: all of them over all the light, within what is asked of a fast mode.
TEST(SpecularBatch, MomentsOfRoundLightsAndTubesAreCloseToTheReference) {
  for (const Kind kind : {Kind::sphere, Kind::disk, Kind::capsule}) {
    Random random(4);
    for (const bool two_sided : {false, true}) {
      double truths = 0;
      std::vector<std::pair<Emitter, Views>> all;
      std::vector<double> truth, in_double;
      while (truth.size() < 1500) {
        Emitter light = place(kind, random, true).emitter;
        light.two_sided = two_sided;
        Views views;
        while (views.alpha.size() < 50) {
          const auto position = point_around(light.shape, random);
          if (!position) continue;
          const Placement p{light, *position, random.direction(), {}};
          const Vec3d view = view_of(p, random);
          if (dot(view, p.normal) < 0.05) continue;
          views.add(p.position, p.normal, view, std::pow(10.0, random.uniform(-2, 0)));
          const ShadingPoint point = views.point(views.alpha.size() - 1, 0.04, 1);
          truth.push_back(reference(light, point, {1e-4, 1e-8}).value.x);
          in_double.push_back(find_specular_method("moments")->luminance(light, point)->x);
          truths += truth.back();
        }
        all.emplace_back(light, views);
      }
      on_each_instruction_set([&] {
        double errors = 0, apart = 0;
        std::size_t i = 0;
        for (const auto& [light, views] : all) {
          const Answers found = answers("moments", light, views);
          for (std::size_t k = 0; k < views.alpha.size(); ++k, ++i) {
            const double value = 0.04 * static_cast<double>(found.of_f0[k]) + static_cast<double>(found.of_f90[k]);
            errors += std::abs(value - truth[i]), apart += std::abs(value - in_double[i]);
          }
        }
        EXPECT_LT(errors, 0.03 * truths);
        EXPECT_LT(apart, 0.01 * truths);
      });
    }
  }
}
TEST(SpecularBatch, OfASphereFromInsideAndAtItsSkinIsWhatItIsInDouble) {
  const Emitter light = white(SphereEmitter{{}, 1});
  Views views;
  for (const double z : {0.0, 0.5, 0.999999, 1.0, 1.000001, 1.1, 30000.0})
    views.add({0, 0, -z}, {0, 0, 1}, normalised(Vec3d{0.3, 0, 1}), 0.4);
  const Answers found = answers("moments", light, views);
  for (std::size_t i = 0; i < views.alpha.size(); ++i) {
    const double expected = find_specular_method("moments")->luminance(light, views.point(i, 1, 1))->x;
    EXPECT_NEAR(static_cast<double>(found.of_f0[i] + found.of_f90[i]), expected, 5e-3 * expected) << i;
  }
  EXPECT_GT(found.of_f0[6], 0);
}
TEST(SpecularBatch, HorizonsAndBacksAreDark) {
  const Emitter light = white(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, 1, 1));  // down
  Views views;
  views.add({0, 0, 0}, {0, 0, 1}, normalised(Vec3d{0.2, 0, 1}), 0.3);    // under it
  views.add({0, 0, 4}, {0, 0, -1}, normalised(Vec3d{0.2, 0, -1}), 0.3);  // behind
  views.add({0, 0, 0}, {0, 0, -1}, normalised(Vec3d{0.2, 0, -1}), 0.3);  // set
  views.add({0, 0, 0}, {0, 0, 1}, normalised(Vec3d{0.2, 0, -1}), 0.3);   // seen from below
  views.add({0, 0, 2}, {0, 0, 1}, normalised(Vec3d{0.2, 0, 1}), 0.3);    // within its plane
  for (const char* name : methods) {
    const Answers found = answers(name, light, views);
    EXPECT_GT(found.of_f0[0], 0.01f) << name;
    for (std::size_t i = 1; i < 5; ++i) EXPECT_EQ(found.of_f0[i] + found.of_f90[i], 0) << name << ' ' << i;
  }
}
// Every angle, alpha from below the least to above the most, views along the normal and along the surface, in contact and far away.
TEST(SpecularBatch, IsFiniteLight) {
  on_each_instruction_set([] {
    Random random(8);
    const Emitter light = white(rectangle({}, {1, 0, 0}, {0, 1, 0}, 1, 0.02));
    Views views;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d n = random.direction(), across = normalised(cross(n, random.direction()));
      const double lift = std::array{0.0, 1e-9, 1e-4, 0.1, 1.0}[static_cast<std::size_t>(i % 5)];
      const double distance = std::pow(10.0, random.uniform(-6, 6));
      const Vec3d view = i % 7 == 0 ? n : normalised(across + n * lift);
      views.add(random.direction() * distance, n, view, std::pow(10.0, random.uniform(-6, 0.5)));
    }
    for (const char* name : methods) {
      const Answers found = answers(name, light, views);
      for (std::size_t i = 0; i < views.alpha.size(); ++i) {
        const float sum = found.of_f0[i] + found.of_f90[i];
        EXPECT_TRUE(found.of_f0[i] >= -1e-4f && found.of_f90[i] >= -1e-4f && sum <= 1.0002f)
            << name << ' ' << i << ' ' << found.of_f0[i] << ' ' << found.of_f90[i];
      }
    }
  });
}
TEST(SpecularBatch, OfASphereIsFiniteLight) {
  on_each_instruction_set([] {
    Random random(9);
    const Emitter light = white(SphereEmitter{{}, 1});
    Views views;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d n = random.direction(), out = random.direction();
      const double distance = 1 + std::pow(10.0, random.uniform(-6, 4));
      const Vec3d view = i % 7 == 0 ? n : normalised(n + normalised(cross(n, out)) * std::pow(10.0, random.uniform(-2, 5)));
      views.add(i % 5 == 0 ? n * -distance : out * distance, n, view, std::pow(10.0, random.uniform(-6, 0)));
    }
    const Answers found = answers("moments", light, views);
    for (std::size_t i = 0; i < views.alpha.size(); ++i) {
      EXPECT_TRUE(found.of_f0[i] >= -1e-4f && found.of_f90[i] >= -1e-4f && found.of_f0[i] + found.of_f90[i] <= 1.0002f)
          << i << ' ' << found.of_f0[i] << ' ' << found.of_f90[i];
    }
  });
}
TEST(SpecularBatch, NotFinitePointsAreCounted) {
  const Emitter light = white(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, 1, 1));
  Random random(1);
  Views views = views_around(light, random, 37);
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  views.vy[3] = nan, views.alpha[11] = nan, views.surface.px[20] = infinity, views.surface.nz[36] = nan;
  for (const char* name : methods) {
    Answers found(37);
    const auto batch = SpecularBatch::of(*SpecularBatch::rule_named(name), light);
    const BatchOutcome outcome = batch->shares(views.points(), found.of_f0, found.of_f90, -7);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(*outcome, 4u);
    for (const std::size_t i : {3, 11, 20, 36}) EXPECT_EQ(found.of_f0[i], -7) << name;
    for (const std::size_t i : {0, 4, 35}) EXPECT_GE(found.of_f0[i], 0) << name;
  }
}
TEST(SpecularBatch, RefusesWhatItHasNoVectorsFor) {
  EXPECT_FALSE(SpecularBatch::rule_named("karis"));
  Emitter light = white(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, 1, 1));
  const auto batch = SpecularBatch::of(SpecularRule::ltc, light);
  ASSERT_TRUE(batch);
  std::vector<float> one(1), two(2);
  Views views;
  views.add({}, {0, 0, 1}, {0, 0, 1}, 0.5);
  EXPECT_EQ(batch->shares(views.points(), two, one, 0).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(batch->shares(views.points(), one, two, 0).error().code, "BATCH_SIZES_DIFFER");
  light.window = {Falloff::gltf, 3};
  EXPECT_EQ(SpecularBatch::of(SpecularRule::ltc, light).error().code, "METHOD_SHAPE");
  EXPECT_EQ(SpecularBatch::of(SpecularRule::ltc_two_caps, white(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, 1, 1))).error().code,
            "METHOD_SHAPE");
  EXPECT_EQ(SpecularBatch::of(SpecularRule::ltc, white(TubeEmitter{{}, {1, 0, 0}, 1, Caps::flat})).error().code, "METHOD_SHAPE");
  EXPECT_EQ(SpecularBatch::of(SpecularRule::ltc, white(PunctualEmitter{{}, {}, {1, 1, 1}, PointShape{}})).error().code, "METHOD_SHAPE");
}
TEST(SpecularBatch, ScalesWithTheLuminance) {
  const auto batch = SpecularBatch::of(SpecularRule::moments, white(rectangle({0, 0, 2}, {1, 0, 0}, {0, -1, 0}, 1, 1), 250));
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->scale().y, 250);
}

}  // namespace
