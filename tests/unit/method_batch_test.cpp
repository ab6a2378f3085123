// Methods in vectors of floats against their double forms, and rules of ours against the exact illuminance.
#include "etendue/method_batch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "etendue/published.h"
#include "eval_protocol.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr std::array kinds{Kind::rect, Kind::sphere, Kind::disk, Kind::capsule};

// One point, relative to which the light stands.
float at(const MethodBatch& batch, const Vec3d& position, const Vec3f& normal) {
  const float zero = 0;
  float value = -1;
  const PointBatch point{{&zero, 1}, {&zero, 1}, {&zero, 1}, {&normal.x, 1}, {&normal.y, 1}, {&normal.z, 1}, position};
  EXPECT_TRUE(batch.projected_solid_angles(point, {&value, 1}, -1));
  return value;
}
struct Differences {
  double sum = 0, worst = 0;
  int count = 0;
  void add(double difference) { sum += std::abs(difference), worst = std::max(worst, std::abs(difference)), ++count; }
  double mean() const { return sum / count; }
};
Differences from_double(const BatchMethod& method, Kind kind, int lights) {
  Differences out;
  for (const bool above : {true, false}) {
    Random random(71);
    for (int i = 0; i < lights; ++i) {
      const Placement p = place(kind, random, above);
      const Result<MethodBatch> batch = MethodBatch::of(method, p.emitter);
      if (!batch) return out;
      const Vec3f n = vec_cast<float>(p.normal);
      const Vec3d same = normalised(vec_cast<double>(n));
      const auto value = static_cast<double>(at(*batch, p.position, n));
      EXPECT_TRUE(std::isfinite(value));
      const double expected = method.ours ? lux_at(p.emitter, p.position, same)
                                          : find_diffuse_method(method.name)->illuminance(p.emitter, p.position, same).value_or(NAN);
      out.add(value - expected);
    }
  }
  return out;
}

// An angle that is the acos of a cosine with the rounding 6e-8 is off by 6e-8 / sine: sqrt(2 6e-8) = 3.5e-4 where the sine vanishes, and
// on the mean, over sines alike likely down to there, by some ten times the rounding.
TEST(Published, InVectorsIsWhatItIsInDouble) {
  on_each_instruction_set([] {
    for (const BatchMethod& method : batch_methods()) {
      if (method.ours) continue;
      int shapes = 0;
      for (const Kind kind : kinds) {
        SCOPED_TRACE(std::string(method.name) + " " + std::to_string(static_cast<int>(kind)));
        const Differences d = from_double(method, kind, 300);
        if (d.count == 0) continue;
        ++shapes;
        EXPECT_LT(d.mean(), 1e-6);
        EXPECT_LT(d.worst, 3.5e-4);
      }
      EXPECT_GT(shapes, 0) << method.name;
    }
  });
}

// The polynomial's 8e-8 of every edge's vector, none longer than pi, and the roundings of five.
TEST(Ours, EdgesAreExactToTheirPolynomial) {
  on_each_instruction_set([] {
    const Differences d = from_double(*find_batch_method("edges"), Kind::rect, 2000);
    EXPECT_LT(d.mean(), 1e-6);
    EXPECT_LT(d.worst, 5e-6);
  });
}
// More places are closer to the light, and none of them counts below the horizon.
TEST(Ours, MorePlacesErrLess) {
  for (const Kind kind : {Kind::rect, Kind::capsule}) {
    const double one = from_double(*find_batch_method("nodes-1"), kind, 2000).mean(),
                 two = from_double(*find_batch_method("nodes-2"), kind, 2000).mean(),
                 three = from_double(*find_batch_method("nodes-3"), kind, 2000).mean();
    EXPECT_LT(two, 0.5 * one);
    EXPECT_LT(three, 0.6 * two);
  }
}
// Above the horizon the vector of illuminance is all there is: a double's value to the cancellation of w - k, twelve diameters being 1e-5.
TEST(Ours, TheVectorOfADiskIsExactAboveTheHorizon) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Placement p = place(Kind::disk, random, true);
    const Vec3f n = vec_cast<float>(p.normal);
    const double exact = lux_at(p.emitter, p.position, normalised(vec_cast<double>(n)));
    EXPECT_NEAR(at(*MethodBatch::of(*find_batch_method("vector"), p.emitter), p.position, n), exact, 1e-5 + 1e-5 * exact);
  }
}
// Far away all lights are their middle: what is left falls as (size / distance)^2, here 1e-4.
TEST(Ours, OnePlaceIsRightFarAway) {
  Random random(9);
  for (const Kind kind : kinds) {
    for (int i = 0; i < 200; ++i) {
      const Placement p = place(kind, random, true);
      if (dot(p.normal, p.towards) < 0.1) continue;
      const Vec3d far = p.position - p.towards * 1000;
      if (const auto* t = std::get_if<TubeEmitter>(&p.emitter.shape); t != nullptr) {
        if (length(cross(normalised(t->b - t->a), p.towards)) < 0.3) continue;
      }
      const Vec3f n = vec_cast<float>(p.normal);
      const double exact = lux_at(p.emitter, far, normalised(vec_cast<double>(n)));
      EXPECT_NEAR(at(*MethodBatch::of(*find_batch_method("nodes-1"), p.emitter), far, n), exact, 0.01 * exact) << static_cast<int>(kind);
    }
  }
}

TEST(Batches, EveryPointCountsOnceAndThoseWithoutNumbersAreTold) {
  on_each_instruction_set([] {
    constexpr std::size_t count = 37;  // two vectors and a part of one, or more
    Random random(3);
    std::array<std::vector<float>, 6> in;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d p = random.direction() * 2, n = random.direction();
      const std::array<double, 6> all{p.x, p.y, p.z, n.x, n.y, n.z};
      for (std::size_t k = 0; k < 6; ++k) in[k].push_back(static_cast<float>(all[k]));
    }
    in[1][36] = std::numeric_limits<float>::infinity();
    in[4][3] = std::numeric_limits<float>::quiet_NaN();
    const PointBatch points{in[0], in[1], in[2], in[3], in[4], in[5], {}};
    const Emitter light = white(rectangle({0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}, 1, 2));
    for (const BatchMethod& method : batch_methods()) {
      const Result<MethodBatch> batch = MethodBatch::of(method, light);
      if (!method.rect) {
        ASSERT_FALSE(batch);
        EXPECT_EQ(batch.error().code, "METHOD_SHAPE");
        continue;
      }
      std::vector<float> sr(count, -1);
      EXPECT_EQ(batch->projected_solid_angles(points, sr, -2).value(), 2u);
      for (std::size_t i = 0; i < count; ++i) {
        if (i == 3 || i == 36) {
          EXPECT_EQ(sr[i], -2);
          continue;
        }
        const Vec3f normal{in[3][i], in[4][i], in[5][i]};
        const Vec3d position{static_cast<double>(in[0][i]), static_cast<double>(in[1][i]), static_cast<double>(in[2][i])};
        EXPECT_NEAR(sr[i], at(*batch, position, normal), 1e-4) << method.name;
        if (in[2][i] < 0.1f) {
          EXPECT_EQ(sr[i], 0) << method.name;
        }
      }
      EXPECT_FALSE(batch->projected_solid_angles(points, std::span(sr).first(5), 0));
    }
  });
}

}  // namespace
