// The reference against closed forms, an independent integral and itself.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// A window that is 1 to double precision: the closed forms do not take it, so that even Lambert goes the quadrature's way.
Emitter through_quadrature(Emitter emitter) {
  emitter.window = {Falloff::gltf, 1e9};
  return emitter;
}

class FanAgainstClosedForm : public testing::TestWithParam<Kind> {};

TEST_P(FanAgainstClosedForm, LambertWithin1e9) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 17);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const Placement p = place(GetParam(), random, i % 2 == 0);
    const double closed = illuminance(p.emitter, p.position, p.normal).x;
    const ShadingPoint point{p.position, p.normal, p.normal, p.normal, Lambert{{1, 1, 1}}};
    const Estimate fan = reference(through_quadrature(p.emitter), point, {1e-11, 1e-13});
    EXPECT_NEAR(fan.value.x * pi, closed, 1e-9 * std::max(closed, 1e-3)) << i;
    EXPECT_LE(std::abs(fan.value.x * pi - closed), fan.error.x * pi + 1e-12) << i;
    worst = std::max(worst, std::abs(fan.value.x * pi - closed) / std::max(closed, 1e-3));
  }
  RecordProperty("worst_relative", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Shapes, FanAgainstClosedForm,
                         testing::Values(Kind::rect, Kind::sphere, Kind::disk, Kind::capsule, Kind::flat_tube, Kind::open_tube));

}  // namespace
