// Linearly transformed cosines: the fit and its table, closed forms through a matrix, what no light may do.
#include "etendue/ltc.h"

#include "etendue/specular_methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

Vec3d view_of(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }
// In the plane of incidence, on the side away from the view.
Vec3d light_at(double angle) { return {-std::sin(angle), 0, std::cos(angle)}; }

ShadingPoint surface(double alpha, const Vec3d& view, double f0 = 1) {
  return {{}, {0, 0, 1}, {0, 0, 1}, view, GgxLobe{alpha, {f0, f0, f0}, 1, Masking::correlated}};
}
double through(std::string_view name, const Emitter& emitter, const ShadingPoint& point) {
  const SpecularMethod* method = find_specular_method(name);
  EXPECT_NE(method, nullptr) << name;
  const auto value = method == nullptr ? std::nullopt : method->luminance(emitter, point);
  EXPECT_TRUE(value.has_value()) << name;
  return value.value_or(Rgb{-1, -1, -1}).x;
}

// ---- The table ----

const LtcTable::Node& node_at(const LtcTable& table, std::size_t row, std::size_t column) {
  return table.nodes()[row * table.size() + column];
}
TransformedCosine cosine_at(const LtcTable& table, std::uint32_t row, std::uint32_t column) {
  const LtcTable::Node& node = node_at(table, row, column);
  std::array<double, 5> terms;
  std::copy_n(node.begin(), 5, terms.begin());
  return transformed_cosine(terms, table.alpha_of(row), table.cosine_of(column));
}

// Found again from fewer neighbours: the same sums; a node that ends in another valley, as deep by chi^2, misplaces at most .6 % of the
// lobe more or less.
TEST(LtcTable, IsWhatTheFitFinds) {
  const LtcTable& table = ltc_table();
  constexpr std::uint32_t size = 5;
  ASSERT_EQ((table.size() - 1) % (size - 1), 0u);
  const std::uint32_t step = (table.size() - 1) / (size - 1);
  const auto fresh = fit_ltc(size);
  ASSERT_TRUE(fresh);
  for (std::uint32_t row = 0; row < size; ++row) {
    for (std::uint32_t column = 0; column < size; ++column) {
      const LtcTable::Node& ours = node_at(*fresh, row, column);
      const LtcTable::Node& theirs = node_at(table, std::size_t{row} * step, std::size_t{column} * step);
      const double alpha = fresh->alpha_of(row), cosine = fresh->cosine_of(column);
      EXPECT_DOUBLE_EQ(alpha, table.alpha_of(row * step));
      EXPECT_DOUBLE_EQ(cosine, table.cosine_of(column * step));
      // Printed to six digits.
      EXPECT_NEAR(ours[5], theirs[5], 1e-5 * theirs[5]);
      EXPECT_NEAR(ours[6], theirs[6], 1e-5 * theirs[6]);
      if (cosine < 0.1) continue;
      EXPECT_NEAR(misplaced_share(cosine_at(*fresh, row, column), alpha, cosine),
                  misplaced_share(cosine_at(table, row * step, column * step), alpha, cosine), 6e-3)
          << "alpha " << alpha << ", cosine " << cosine;
    }
  }
}

// Between nodes too: where the lobe is narrow against its height over the horizon it is a transformed cosine to within a few alphas,
// because both fall with the fourth power of the distance from the middle.
TEST(LtcTable, NarrowLobesAreTransformedCosines) {
  for (const double alpha : {1e-4, 1e-3, 0.004, 0.01}) {
    for (const double cosine : {0.2, 0.33, 0.5, 0.71, 0.9, 0.97, 1.0}) {
      EXPECT_LE(misplaced_share(ltc_table().at(alpha, cosine).whole, alpha, cosine), 2 * alpha / cosine + 4e-3)
          << "alpha " << alpha << ", cosine " << cosine;
    }
  }
}
TEST(LtcTable, NoLobeIsFurtherOffThanStated) {
  for (const double alpha : {0.03, 0.07, 0.13, 0.2, 0.33, 0.5, 0.75, 1.0}) {
    for (const double cosine : {0.1, 0.2, 0.31, 0.52, 0.73, 0.94}) {
      const double limit = cosine < 0.3 ? 0.22 : cosine < 0.5 ? 0.12 : 0.07;
      EXPECT_LE(misplaced_share(ltc_table().at(alpha, cosine).whole, alpha, cosine), limit) << "alpha " << alpha << ", cosine " << cosine;
    }
  }
}

// Against the adaptive reference under a white sky: sums at nodes to the error of the fit's rule, whose kink at the horizon leaves 1e-4.
TEST(LtcTable, AlbedosAreTheLobes) {
  const Emitter sky = white(EnvironmentEmitter{});
  const LtcTable& table = ltc_table();
  for (std::uint32_t row = 4; row < table.size(); row += 7) {
    for (std::uint32_t column = 4; column < table.size(); column += 7) {
      const double alpha = table.alpha_of(row), cosine = table.cosine_of(column);
      const LtcLobe lobe = table.at(alpha, cosine);
      const double whole = reference(sky, surface(alpha, view_of(cosine)), {1e-7, 0}).value.x;
      const double grazing = reference(sky, surface(alpha, view_of(cosine), 0), {1e-7, 0}).value.x;
      EXPECT_NEAR(lobe.f0.albedo + lobe.f90.albedo, whole, 2e-4 * whole) << "alpha " << alpha << ", cosine " << cosine;
      EXPECT_NEAR(lobe.f90.albedo, grazing, 2e-4 * whole) << "alpha " << alpha << ", cosine " << cosine;
    }
  }
}

// Cosines drawn out to slivers would cost the closed forms their digits, and neighbours that have nothing to do with each other would have
// mirrors between them: the determinant, alpha counted out, stays above a part of what it is at the nodes.
TEST(LtcTable, NoCosineIsASliver) {
  const LtcTable& table = ltc_table();
  const auto node = [&](std::size_t row, std::size_t column) -> const LtcTable::Node& { return node_at(table, row, column); };
  const auto determinant = [](const double* t) { return t[0] * t[4] - t[1] * t[3]; };
  for (const std::size_t first : {std::size_t{0}, LtcTable::first, LtcTable::second, LtcTable::one}) {
    for (const LtcTable::Node& n : table.nodes()) {
      for (std::size_t k = first; k < first + 5; ++k) EXPECT_LT(std::abs(n[k]), 40);
      EXPECT_GT(n[first + 2], 3e-4);
    }
    for (std::size_t row = 0; row + 1 < table.size(); ++row) {
      for (std::size_t column = 0; column + 1 < table.size(); ++column) {
        std::array<double, 5> middle{};
        double least = HUGE_VAL;
        for (const auto* corner : {&node(row, column), &node(row, column + 1), &node(row + 1, column), &node(row + 1, column + 1)}) {
          std::array<double, 5> own{};
          for (std::size_t k = 0; k < 5; ++k) own[k] = static_cast<double>((*corner)[first + k]), middle[k] += 0.25 * own[k];
          least = std::min(least, determinant(own.data()));
        }
        EXPECT_GT(least, 0) << row << ' ' << column;
        EXPECT_GT(determinant(middle.data()), 0.2 * least) << row << ' ' << column;
      }
    }
  }
}

// ---- Closed forms ----

// The midpoint rule over equal parts of z and of the turn; the density is smooth but for its own horizon.
TEST(TransformedCosine, DensitySumsToWhatIsAboveTheHorizon) {
  for (const double alpha : {0.3, 0.6, 1.0}) {
    const TransformedCosine cosine = ltc_table().at(alpha, 0.4).whole;
    constexpr int steps = 400;
    double above = 0, below = 0;
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < steps; ++k) {
        const double z = (i + 0.5) / steps, phi = 2 * pi * (k + 0.5) / steps, r = std::sqrt(1 - z * z);
        above += cosine.density({r * std::cos(phi), r * std::sin(phi), z});
        below += cosine.density({r * std::cos(phi), r * std::sin(phi), -z});
      }
    }
    const double part = 2 * pi / (steps * steps);
    EXPECT_NEAR(above * part, cosine.share_above(), 1e-4);
    EXPECT_NEAR((above + below) * part, 1, 1e-4);
  }
}

// The whole sky is the whole lobe, whatever the matrix does to its horizon.
TEST(Ltc, AWhiteSkyGivesTheAlbedo) {
  const Emitter sky = white(EnvironmentEmitter{}, 3);
  for (const double alpha : {1e-4, 0.01, 0.2, 1.0}) {
    for (const double cosine : {1e-4, 0.05, 0.5, 1.0}) {
      const LtcLobe lobe = ltc_table().at(alpha, cosine);
      EXPECT_NEAR(through("ltc", sky, surface(alpha, view_of(cosine))), 3 * (lobe.f0.albedo + lobe.f90.albedo), 1e-9);
      EXPECT_NEAR(through("ltc-two-lobes", sky, surface(alpha, view_of(cosine), 0.04)), 3 * (0.04 * lobe.f0.albedo + lobe.f90.albedo),
                  1e-9);
    }
  }
}

// Half the light crosses the horizon, half the views have the mirror direction inside the light; all errors over all light. On a thousand
// lights it is .011 to .014, by caps .014 to .015, and by `ltc` .018 at f0 = 1 and .093 at .04.
TEST(Ltc, TwoLobesFollowRoundLights) {
  Random random(17);
  for (const Kind kind : {Kind::sphere, Kind::disk}) {
    std::array<double, 2> errors{}, of_caps{}, sums{};
    for (int i = 0; i < 400; ++i) {
      const Placement p = place(kind, random, i % 2 == 0);
      const LightSample s = sample_light(p.emitter, p.position, random.square());
      Vec3d view = i % 4 < 2 ? p.normal * (2 * dot(p.normal, s.direction)) - s.direction : random.direction();
      if (dot(view, p.normal) < 0) view = -view;
      if (dot(view, p.normal) < 0.05) continue;
      const double alpha = random.log_uniform(0.01, 1);
      for (const std::size_t dielectric : {std::size_t{0}, std::size_t{1}}) {
        const double f0 = dielectric != 0 ? 0.04 : 1;
        const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{alpha, {f0, f0, f0}}};
        const double exact = reference(p.emitter, point, {1e-4, 1e-8}).value.x;
        errors[dielectric] += std::abs(through("ltc-two-lobes", p.emitter, point) - exact), sums[dielectric] += exact;
        of_caps[dielectric] += std::abs(through("ltc-two-caps", p.emitter, point) - exact);
      }
    }
    EXPECT_LT(errors[0], 0.02 * sums[0]);
    EXPECT_LT(errors[1], 0.02 * sums[1]);
    EXPECT_LT(of_caps[0], 0.022 * sums[0]);
    EXPECT_LT(of_caps[1], 0.022 * sums[1]);
  }
}

// Mirrors of f0 = f90 = 1 are as by `ltc`; towards a small light Schlick's term is what it is there, for any f90. On a thousand rectangles
// the error for f0 = .04 is .045, that of `ltc` .093.
TEST(Ltc, FresnelAtOneDirection) {
  Random random(23);
  double error = 0, averaged = 0, sum = 0;
  for (int i = 0; i < 600; ++i) {
    const Placement p = place(Kind::rect, random, i % 2 == 0);
    const LightSample s = sample_light(p.emitter, p.position, random.square());
    Vec3d view = i % 4 < 2 ? p.normal * (2 * dot(p.normal, s.direction)) - s.direction : random.direction();
    if (dot(view, p.normal) < 0) view = -view;
    if (dot(view, p.normal) < 0.05) continue;
    ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{random.log_uniform(0.01, 1), {1, 1, 1}}};
    EXPECT_NEAR(through("ltc-fresnel", p.emitter, point), through("ltc", p.emitter, point), 1e-9);
    std::get<GgxLobe>(point.brdf).f0 = {0.04, 0.04, 0.04};
    const double exact = reference(p.emitter, point, {1e-4, 1e-8}).value.x;
    error += std::abs(through("ltc-fresnel", p.emitter, point) - exact), averaged += std::abs(through("ltc", p.emitter, point) - exact);
    sum += exact;
  }
  EXPECT_LT(error, 0.056 * sum);
  EXPECT_LT(error, 0.7 * averaged);
  const Vec3d l = normalised(Vec3d{-0.9, 0.3, 0.4}), view = view_of(0.3);
  const Emitter small = white(SphereEmitter{l * 10.0, 0.01});
  ShadingPoint point = surface(0.5, view);
  const double mirror = through("ltc-fresnel", small, point), weight = std::pow(1 - dot(view, normalised(view + l)), 5);
  for (const double f90 : {1.0, 0.5}) {
    point.brdf = GgxLobe{0.5, {0.04, 0.04, 0.04}, f90};
    EXPECT_NEAR(through("ltc-fresnel", small, point), mirror * (0.04 + (f90 - 0.04) * weight), 1e-5 * mirror);
  }
}

// Where the transformed light is a cap itself nothing is lost: lights about the axis of a view along the normal, the steep lobe of which is
// round. And a cap that the plane through its axis cuts has half of what is along the axis.
TEST(Ltc, CapsAreExactWhereTheLightIsOne) {
  for (const double alpha : {0.05, 0.3, 1.0}) {
    for (const double radius : {0.01, 0.4, 0.9}) {
      const Emitter light = white(SphereEmitter{{0, 0, 1}, radius});
      const ShadingPoint point = surface(alpha, {0, 0, 1}, 0.04);
      const double exact = through("ltc-two-lobes", light, point);
      EXPECT_NEAR(through("ltc-two-caps", light, point), exact, 2e-4 * exact) << alpha << ' ' << radius;
    }
  }
}

// A disk is the limit of polygons of the same area: corners on the circle of radius R sqrt(2 x / sin 2 x), x = pi / corners.
TEST(Ltc, RimsAreLimitsOfPolygons) {
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const Placement p = place(Kind::disk, random, i % 2 == 0);
    const auto& disk = std::get<DiskEmitter>(p.emitter.shape);
    constexpr int corners = 4000;
    const double x = pi / corners, radius = disk.radius * std::sqrt(2 * x / std::sin(2 * x));
    PolygonEmitter polygon;
    polygon.normal = disk.normal;
    const Vec3d y = cross(disk.normal, disk.x);
    for (int k = 0; k < corners; ++k)
      polygon.vertices.push_back(disk.centre + (disk.x * std::cos(2 * x * k) + y * std::sin(2 * x * k)) * radius);
    Vec3d view = random.direction();
    if (dot(view, p.normal) < 0) view = -view;
    const double alpha = random.log_uniform(0.01, 1);
    const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{alpha, {1, 1, 1}}};
    for (const std::string_view name : {"ltc", "ltc-unclipped"}) {
      const double value = through(name, p.emitter, point);
      EXPECT_NEAR(value, through(name, white(polygon), point), 1e-5 * value + 1e-8) << i << " " << name << ", alpha " << alpha;
    }
  }
}
// A sphere has the outline of a disk across the way to it: of the radius R c, at d c^2, c^2 = 1 - R^2 / d^2.
TEST(Ltc, ASphereIsItsDisk) {
  Random random(12);
  for (int i = 0; i < 200; ++i) {
    const Placement p = place(Kind::sphere, random, i % 2 == 0);
    const auto& sphere = std::get<SphereEmitter>(p.emitter.shape);
    const double d = length(sphere.centre - p.position), c2 = 1 - sphere.radius * sphere.radius / (d * d);
    const Vec3d towards = (sphere.centre - p.position) / d;
    const Emitter disk =
        white(DiskEmitter{p.position + towards * (d * c2), -towards, basis_around(towards).tangent, sphere.radius * std::sqrt(c2)});
    Vec3d view = random.direction();
    if (dot(view, p.normal) < 0) view = -view;
    const double alpha = random.log_uniform(1e-3, 1);
    const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{alpha, {1, 1, 1}}};
    const double value = through("ltc", p.emitter, point);
    EXPECT_NEAR(value, through("ltc", disk, point), 1e-8 * value + 1e-10) << i << ", alpha " << alpha;
  }
}

// ---- Lights ----

Emitter square_towards(const Vec3d& direction, double distance, double side) {
  const Basis b = basis_around(-direction);
  return white(rectangle(direction * distance, b.tangent, b.bitangent, side, side));
}

// What a small light gives is the density times its solid angle: to (size / distance / alpha)^2 and the digits of an edge integral.
TEST(Ltc, SmallLightsSeeTheDensity) {
  for (const double alpha : {0.1, 0.3, 1.0}) {
    for (const double angle : {0.0, 0.4, 0.9}) {
      const Vec3d light = light_at(angle), view = view_of(0.7);
      const LtcLobe lobe = ltc_table().at(alpha, 0.7);
      const double expected = (lobe.f0.albedo + lobe.f90.albedo) * lobe.whole.density(light) / lobe.whole.share_above() * 1e-6;
      EXPECT_NEAR(through("ltc", square_towards(light, 2, 0.002), surface(alpha, view)), expected, 1e-3 * expected);
    }
  }
}
// At the mirror direction, where most of the lobe is, that is the BRDF to a few per cent.
TEST(Ltc, SmallLightsAtTheMirrorDirectionSeeTheBrdf) {
  for (const double alpha : {0.001, 0.01, 0.1, 0.3, 1.0}) {
    for (const double cosine : {0.5, 0.8, 1.0}) {
      const Vec3d view = view_of(cosine), mirror{-view.x, 0, view.z};
      const double side = 1e-3 * alpha, brdf = brdf_cos(surface(alpha, view).brdf, view, mirror).x;
      const double expected = brdf * side * side;
      EXPECT_NEAR(through("ltc", square_towards(mirror, 1, side), surface(alpha, view)), expected, 0.12 * expected)
          << "alpha " << alpha << ", cosine " << cosine;
    }
  }
}

TEST(Ltc, NoLightComesFromBelowTheHorizon) {
  Random random(13);
  double leaked = 0;
  for (int i = 0; i < 300; ++i) {
    const Kind kind = i % 3 == 0 ? Kind::rect : i % 3 == 1 ? Kind::disk : Kind::capsule;
    const Placement p = place(kind, random, true);
    Vec3d view = random.direction();
    if (dot(view, p.normal) > 0) view = -view;
    // Seen from a surface that faces the other way the light is below.
    const ShadingPoint point{p.position, -p.normal, -p.normal, view, GgxLobe{random.log_uniform(1e-3, 1), {1, 1, 1}}};
    EXPECT_EQ(through("ltc", p.emitter, point), 0) << i;
    EXPECT_EQ(through("ltc-two-lobes", p.emitter, point), 0) << i;
    EXPECT_EQ(through("ltc-two-caps", p.emitter, point), 0) << i;
    leaked = std::max(leaked, through("ltc-unclipped", p.emitter, point));
  }
  EXPECT_GT(leaked, 1e-4);  // which the published form lets through
}

TEST(Ltc, NoLightGivesMoreThanItsLuminance) {
  Random random(14);
  for (int i = 0; i < 20000; ++i) {
    const Kind kind = i % 4 == 0 ? Kind::rect : i % 4 == 1 ? Kind::disk : i % 4 == 2 ? Kind::sphere : Kind::capsule;
    const Placement p = place(kind, random, i % 8 < 4);
    Vec3d view = random.direction();
    if (dot(view, p.normal) < 0) view = -view;
    const double f0 = i % 3 == 0 ? 0.04 : 1;
    const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{random.log_uniform(1e-4, 1), {f0, f0, f0}}};
    for (const std::string_view name : {"ltc-four-terms", "ltc-unclipped", "ltc", "ltc-fresnel", "ltc-two-lobes"}) {
      const double value = through(name, p.emitter, point);
      EXPECT_TRUE(value >= 0 && value <= 1) << i << " " << name << " " << value;
    }
  }
}

// The matrix is taken in the frame of the mirror direction, so that lobes narrower than a table's step still stand where they should.
TEST(Ltc, TheSunOnPolishedSurfaces) {
  const double radius = 0.00465;
  for (const double alpha : {3e-4, 0.001, 0.003}) {
    for (const double cosine : {0.22, 0.47, 0.83, 0.99}) {
      for (const double away : {0.0, 0.004, 0.01}) {
        const Emitter sun{DistantEmitter{light_at(std::acos(cosine) + away), {1e5, 1e5, 1e5}, radius}, {}, false, {}, {}};
        const ShadingPoint point = surface(alpha, view_of(cosine));
        const double expected = reference(sun, point, {1e-6, 0}).value.x;
        EXPECT_NEAR(through("ltc", sun, point), expected, (cosine < 0.3 ? 0.015 : 0.01) * expected)
            << "alpha " << alpha << ", cosine " << cosine << ", away " << away;
      }
    }
  }
}

TEST(Ltc, TakesWhatItSays) {
  const SpecularMethod& ltc = *find_specular_method("ltc");
  const Emitter light = square_towards({0, 0, 1}, 1, 1);
  EXPECT_FALSE(ltc.luminance(light, {{}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, Lambert{}}));
  EXPECT_FALSE(ltc.luminance(light, {{}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, GgxLobe{.masking = Masking::separable}}));
  EXPECT_FALSE(ltc.luminance(white(PunctualEmitter{{0, 0, 1}, {}, {1, 1, 1}, PointShape{}}), surface(0.1, {0, 0, 1})));
  EXPECT_EQ(through("ltc", light, surface(0.1, {0.6, 0, -0.8})), 0);
  EXPECT_EQ(find_specular_method("ltc-of-nobody"), nullptr);
}

}  // namespace
