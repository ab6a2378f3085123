// The published diffuse methods: their errors by the common protocol, the errata of their sources, the places where they break.
#include "etendue/published.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

double lux(std::string_view name, const Emitter& emitter, const Vec3d& position, const Vec3d& normal) {
  const DiffuseMethod* method = find_diffuse_method(name);
  EXPECT_NE(method, nullptr) << name;
  return method == nullptr ? 0 : method->illuminance(emitter, position, normal).value_or(-1);
}

// ---- Errors by the protocol ----

constexpr std::size_t count = 2000;
struct Sample {
  Placement placement;
  double exact;
};
const std::vector<Sample>& samples(Kind kind, bool above) {
  static std::map<std::pair<Kind, bool>, std::vector<Sample>> made;
  std::vector<Sample>& s = made[{kind, above}];
  if (s.empty()) {
    Random random(2014 + 2 * static_cast<std::uint64_t>(kind) + (above ? 1 : 0));
    for (std::size_t i = 0; i < count; ++i) {
      const Placement p = place(kind, random, above);
      s.push_back({p, lux_at(p.emitter, p.position, p.normal)});
    }
  }
  return s;
}

struct Mean {
  double value, deviation;  // deviation of one sample
};
Mean mean_of(const std::vector<double>& x) {
  double sum = 0, squares = 0;
  for (const double v : x) sum += v, squares += v * v;
  const double n = static_cast<double>(x.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(squares / n - mean * mean, 0.0))};
}

// A figure as measured by others, on as many random configurations of their own, with the half unit of its last digit.
struct Figure {
  double value, half_unit;
  Figure(const char* text) : value(std::stod(text)) {  // NOLINT(google-explicit-constructor): rows of a table
    const std::string s = text;
    const std::size_t exponent = s.find('e'), point = s.find('.');
    const std::size_t decimals = point == std::string::npos ? 0 : std::min(exponent, s.size()) - point - 1;
    const int power = exponent == std::string::npos ? 0 : std::stoi(s.substr(exponent + 1));
    half_unit = 0.5 * std::pow(10.0, power - static_cast<int>(decimals));
  }
};
struct Row {
  const char* name;
  Kind kind;
  bool above;
  Figure relative, absolute, p99;
  bool rounding = false;  // theirs is the rounding of single precision: ours, in double, may be any smaller
};

class Figures : public testing::TestWithParam<Row> {};

// The difference of two means of n samples each has the standard deviation s sqrt(2 / n); four of them are allowed, and the rounding of the
// printed figure. The 99th percentile of theirs lies with the same certainty between our ranks .99 +- 4 sqrt(2 .99 .01 / n), cut at the
// highest one.
TEST_P(Figures, AreThoseOfTheProtocol) {
  const Row& row = GetParam();
  std::vector<double> relative, absolute;
  for (const Sample& s : samples(row.kind, row.above)) {
    const double error = std::abs(lux(row.name, s.placement.emitter, s.placement.position, s.placement.normal) - s.exact);
    absolute.push_back(error);
    relative.push_back(error / s.exact);
  }
  const double deviations = 4 * std::sqrt(2.0 / count);
  const Mean r = mean_of(relative), a = mean_of(absolute);
  std::sort(relative.begin(), relative.end());
  if (row.rounding) {
    EXPECT_LE(r.value, row.relative.value + row.relative.half_unit);
    EXPECT_LE(a.value, row.absolute.value + row.absolute.half_unit);
    return;
  }
  EXPECT_NEAR(r.value, row.relative.value, deviations * r.deviation + row.relative.half_unit);
  EXPECT_NEAR(a.value, row.absolute.value, deviations * a.deviation + row.absolute.half_unit);
  const double ranks = 4 * std::sqrt(2 * 0.99 * 0.01 / count);
  EXPECT_LE(relative[static_cast<std::size_t>((0.99 - ranks) * count)], row.p99.value + row.p99.half_unit);
  EXPECT_GE(relative.back(), row.p99.value - row.p99.half_unit);
}

std::string row_name(const testing::TestParamInfo<Row>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  static const std::map<Kind, std::string> kinds{
      {Kind::rect, "_rect"}, {Kind::sphere, "_sphere"}, {Kind::disk, "_disk"}, {Kind::capsule, "_tube"}};
  return name + kinds.at(info.param.kind) + (info.param.above ? "_above" : "_across");
}

INSTANTIATE_TEST_SUITE_P(Rectangles, Figures,
                         testing::Values(Row{"frostbite-12", Kind::rect, true, ".034", ".0079", ".22"},
                                         Row{"frostbite-12", Kind::rect, false, "1.08", ".025", "11.9"},
                                         Row{"frostbite-12-mended", Kind::rect, true, ".034", ".0079", ".22"},
                                         Row{"frostbite-12-mended", Kind::rect, false, "1.08", ".025", "11.9"},
                                         Row{"frostbite-e1-mended", Kind::rect, true, "3.7e-5", "1.9e-7", "7e-4", true},
                                         Row{"frostbite-e1-mended", Kind::rect, false, ".47", ".017", "1"},
                                         Row{"frostbite-e2", Kind::rect, true, ".195", ".0188", ".89"},
                                         Row{"frostbite-e2", Kind::rect, false, "4.1", ".124", "44"},
                                         Row{"drobot-point", Kind::rect, true, ".150", ".0167", ".74"},
                                         Row{"drobot-point", Kind::rect, false, "1.82", ".080", "15"},
                                         Row{"drobot-point-horizon", Kind::rect, false, ".59", ".038", "1.7"},
                                         Row{"hill-heitz-acos", Kind::rect, true, "1.1e-6", "2e-8", "1e-5", true},
                                         Row{"hill-heitz-acos", Kind::rect, false, "2.4e-6", "3e-8", "2e-5", true},
                                         Row{"hill-heitz-rational", Kind::rect, true, "2.4e-6", "5e-8", "3e-5", true},
                                         Row{"hill-heitz-rational", Kind::rect, false, "8.5e-6", "9e-8", "8e-5", true},
                                         Row{"hill-heitz-quadratic", Kind::rect, true, ".011", "5e-4", ".12"},
                                         Row{"hill-heitz-quadratic", Kind::rect, false, ".040", "8e-4", ".42"},
                                         Row{"hill-heitz-absolute-table", Kind::rect, true, "2e-4", "5e-6", ".002"},
                                         Row{"hill-heitz-absolute-table", Kind::rect, false, ".25", ".005", "1"},
                                         Row{"hill-heitz-cheap", Kind::rect, true, ".023", ".0034", ".15"},
                                         Row{"hill-heitz-cheap", Kind::rect, false, ".43", ".024", "1.2"}),
                         row_name);

// Table E.1's own figures are of random ranges that it does not state; the order of its methods is the same above the horizon, as far as
// they differ by more than a tenth.
TEST(TableE1, OrderAboveTheHorizon) {
  const auto relative = [](std::string_view name) {
    double sum = 0;
    for (const Sample& s : samples(Kind::rect, true)) {
      sum += std::abs(lux(name, s.placement.emitter, s.placement.position, s.placement.normal) / s.exact - 1);
    }
    return sum / count;
  };
  const double exact = relative("frostbite-e1-mended"), sampled = relative("frostbite-12"), centre = relative("frostbite-light-position"),
               reference = relative("frostbite-reference-point"), simplified = relative("frostbite-e2");
  EXPECT_LT(exact, sampled);
  EXPECT_LT(sampled, centre);
  EXPECT_LT(centre, 0.5 * reference);
  EXPECT_NEAR(reference / simplified, 1, 0.1);
}

// The methods that are exact are so to rounding.
TEST(Exact, AgreeWithTheClosedForm) {
  for (const bool above : {true, false}) {
    for (const Sample& s : samples(Kind::rect, above)) {
      // acos loses half the digits of small angles: 1e-8 / (distance / size)^2.
      for (const char* name : {"hill-heitz-acos", "hill-heitz-sine"}) {
        EXPECT_NEAR(lux(name, s.placement.emitter, s.placement.position, s.placement.normal), s.exact, 1e-9 * std::max(s.exact, 1e-2))
            << name;
      }
      if (above) {
        EXPECT_NEAR(lux("frostbite-e1-mended", s.placement.emitter, s.placement.position, s.placement.normal), s.exact, 1e-13);
      }
    }
  }
}

// The point of highest cos / r^2 against a search of the rectangle: the illuminance at any other point is not higher in cos / r^2.
TEST(ReferencePoint, IsTheHighest) {
  for (const bool above : {true, false}) {
    for (std::size_t k = 0; k < 100; ++k) {
      const Placement& p = samples(Kind::rect, above)[k].placement;
      const auto& v = std::get<PolygonEmitter>(p.emitter.shape).vertices;
      double best = 0, cosine = 0;
      for (int i = 0; i <= 400; ++i) {
        for (int j = 0; j <= 400; ++j) {
          const Vec3d q = v[0] + (v[1] - v[0]) * (i / 400.0) + (v[3] - v[0]) * (j / 400.0) - p.position;
          const double c = dot(q, p.normal) / length(q), value = c / dot(q, q);
          if (value > best) best = value, cosine = c;
        }
      }
      // The light position's illuminance is the solid angle times its own cosine, which gives the solid angle by itself.
      const Vec3d towards = normalised((v[0] + v[2]) * 0.5 - p.position);
      const double omega = lux("frostbite-light-position", p.emitter, p.position, towards);
      // A grid of 1/400 finds the cosine to about the angle of a step, which is 1/100 at the closest.
      EXPECT_NEAR(lux("frostbite-reference-point", p.emitter, p.position, p.normal) / omega, cosine, 0.02) << k;
    }
  }
}

// ---- Errata ----

// Seen from h below the middle of a square of 2 m, facing it.
Emitter square_above(double h, double side = 2) {
  const double s = 0.5 * side;
  PolygonEmitter square;
  square.vertices = {{-s, -s, h}, {-s, s, h}, {s, s, h}, {s, -s, h}};
  square.normal = {0, 0, -1};
  return white(square);
}

// Listing E.1 presumes left x up = -normal; in a right-handed frame its sum is negative and nothing is left.
TEST(Errata, ListingE1Winding) {
  const Emitter light = square_above(3);
  EXPECT_EQ(lux("frostbite-e1-right-handed", light, {}, {0, 0, 1}), 0);
  EXPECT_NEAR(lux("frostbite-e1-mended", light, {}, {0, 0, 1}), lux_at(light, {}, {0, 0, 1}), 1e-14);
}

// Its saturate() cuts the sum, which is twice the illuminance, at 1: under a light that fills the sky .5 is left of pi.
TEST(Errata, ListingE1Saturates) {
  const Emitter light = square_above(1e-3);
  EXPECT_EQ(lux("frostbite-e1", light, {}, {0, 0, 1}), 0.5);
  EXPECT_NEAR(lux("frostbite-e1-mended", light, {}, {0, 0, 1}), lux_at(light, {}, {0, 0, 1}), 1e-13);
  EXPECT_GT(lux_at(light, {}, {0, 0, 1}), 3.14);
}

// A light of 10 m x 10 m at 1 m: of listing 12's five points four lie near the horizon.
TEST(Errata, Listing12CloseToALargeLight) {
  const Emitter light = square_above(1, 10);
  EXPECT_NEAR(lux("frostbite-12", light, {}, {0, 0, 1}) / lux_at(light, {}, {0, 0, 1}) - 1, -0.47, 0.05);
}

// Drobot's eq 1.16 with the angle between both normals: a light of its tilt far away on the horizontal side is dark, whatever it shows.
TEST(Errata, Drobot116CosineOfTheLight) {
  const Vec3d towards = normalised(Vec3d{1, 0, 1});
  const PolygonEmitter small = rectangle(towards * 20, cross(-towards, Vec3d{0, 1, 0}), {0, 1, 0}, 0.2, 0.2);
  const Emitter light = white(small.normal.x < 0 ? small : rectangle(towards * 20, {0, 1, 0}, cross(-towards, Vec3d{0, 1, 0}), 0.2, 0.2));
  const double exact = lux_at(light, {}, {0, 0, 1});
  ASSERT_GT(exact, 0);
  EXPECT_NEAR(lux("drobot-1-16-mended", light, {}, {0, 0, 1}) / exact, 1, 1e-2);
  EXPECT_NEAR(lux("drobot-1-16", light, {}, {0, 0, 1}) / exact, std::sqrt(0.5), 1e-2);
}

// ---- Places where they break ----

std::vector<Emitter> hard_lights() {
  std::vector<Emitter> lights;
  for (const double size : {0.0, 1e-5, 1.0, 2e6}) {
    for (const double h : {1e-5, 1.0, 1e4, 1e6}) {
      lights.push_back(square_above(h, size));
      lights.push_back(white(rectangle({0.5 * size, 0, h}, {0, 1, 0}, {1, 0, 0}, size, 1)));  // over its side
      lights.push_back(white(rectangle({0.5 * size, 0, 0}, {1, 0, 0}, {0, 0, 1}, size, h)));  // coplanar with the point
      lights.push_back(white(rectangle({size, 0, -h}, {0, 1, 0}, {0, 0, -1}, size, h)));      // set, or setting
    }
  }
  return lights;
}

TEST(Traps, NothingButNumbersLeaves) {
  std::vector<Vec3d> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
  Random random(7);
  for (int i = 0; i < 50; ++i) normals.push_back(random.direction());
  for (Emitter light : hard_lights()) {
    for (const bool two_sided : {false, true}) {
      light.two_sided = two_sided;
      for (const DiffuseMethod& method : diffuse_methods()) {
        for (const Vec3d& n : normals) {
          const auto e = method.illuminance(light, {}, n);
          ASSERT_TRUE(!e || (std::isfinite(*e) && *e >= -1e-9)) << method.name;
        }
      }
    }
  }
}

// The point in the light's own plane sees nothing of it, neither does one behind it.
TEST(Traps, DarkFromThePlaneAndFromBehind) {
  const Emitter light = square_above(1);
  for (const DiffuseMethod& method : diffuse_methods()) {
    if (method.rect == nullptr) continue;
    EXPECT_EQ(method.illuminance(light, {3, 0, 1}, {-1, 0, 0}), 0.0) << method.name;
    EXPECT_EQ(method.illuminance(light, {1, 0, 1}, {0, 0, 1}), 0.0) << method.name;
    EXPECT_EQ(method.illuminance(light, {0, 0, 2}, {0, 0, -1}), 0.0) << method.name;
  }
}

// A square metre at 10 km, 1e-8 lx. Listing 11 takes 2 pi off a sum of angles: rounding leaves some 4e-16 in double, in single precision
// nothing. The sums of edges keep 1e-16 (distance / size)^2 = 1e-8 of it, with acos half the digits less.
TEST(Traps, FarAway) {
  const Emitter light = square_above(1e4, 1);
  const double exact = lux_at(light, {}, {0, 0, 1});
  EXPECT_NEAR(exact, 1e-8, 1e-12);
  EXPECT_NEAR(lux("frostbite-12-mended", light, {}, {0, 0, 1}) / exact, 1, 1e-7);
  EXPECT_NEAR(lux("frostbite-e1-mended", light, {}, {0, 0, 1}) / exact, 1, 1e-6);
  EXPECT_GT(std::abs(lux("frostbite-12", light, {}, {0, 0, 1}) / exact - 1), 1e-9);
}

// ---- Names ----

TEST(Names, AreUniqueAndFound) {
  std::map<std::string_view, int> seen;
  for (const DiffuseMethod& method : diffuse_methods()) {
    EXPECT_EQ(++seen[method.name], 1) << method.name;
    EXPECT_EQ(find_diffuse_method(method.name), &method);
    EXPECT_FALSE(method.source.empty());
    EXPECT_FALSE(method.note.empty());
  }
  EXPECT_EQ(find_diffuse_method("none"), nullptr);
}

TEST(Names, OtherShapesAreRefused) {
  PolygonEmitter triangle;
  triangle.vertices = {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
  triangle.normal = {0, 0, -1};
  PolygonEmitter kite;
  kite.vertices = {{0, 0, 1}, {0, 1, 1}, {2, 2, 1}, {1, 0, 1}};
  kite.normal = {0, 0, -1};
  EXPECT_EQ(find_diffuse_method("frostbite-12")->illuminance(white(triangle), {}, {0, 0, 1}), std::nullopt);
  EXPECT_EQ(find_diffuse_method("frostbite-12")->illuminance(white(kite), {}, {0, 0, 1}), std::nullopt);
  EXPECT_EQ(find_diffuse_method("frostbite-12")->illuminance(white(SphereEmitter{{0, 0, 2}, 1}), {}, {0, 0, 1}), std::nullopt);
}

}  // namespace
