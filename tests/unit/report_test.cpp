// The page is complete in itself, escapes what it is given, and says what was found.
#include "etendue/report.h"
#include "report/encode.h"
#include "report/markup.h"
#include "synthetic_pictures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace etendue {
namespace {

using namespace report_detail;

double from_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const double size = exponent ? std::ldexp(1 + mantissa / 1024., exponent - 15) : std::ldexp(mantissa, -24);
  return bits & 0x8000 ? -size : size;
}

TEST(Half, KnownValues) {
  // IEEE 754-2019, binary16.
  EXPECT_EQ(to_half(0), 0x0000);
  EXPECT_EQ(to_half(1), 0x3c00);
  EXPECT_EQ(to_half(-2), 0xc000);
  EXPECT_EQ(to_half(65504), 0x7bff);
  EXPECT_EQ(to_half(1e9F), 0x7bff);
  EXPECT_EQ(to_half(0x1p-14F), 0x0400);
  EXPECT_EQ(to_half(0x1p-24F), 0x0001);
  EXPECT_EQ(to_half(.33325195F), 0x3555);
}

TEST(Half, EveryValueSurvivesAndRoundingIsWithinHalfAStep) {
  for (int bits = 0; bits < 0x7c00; ++bits) EXPECT_EQ(to_half(static_cast<float>(from_half(static_cast<std::uint16_t>(bits)))), bits);
  for (float value = 1e-4F; value < 6e4F; value *= 1.0137F) EXPECT_NEAR(from_half(to_half(value)) / value, 1, 0x1p-11) << value;
}

TEST(Encode, FactorCarriesLargeValues) {
  const Encoded encoded = encode({3e8F, 1.F, 0.F});
  EXPECT_EQ(encoded.base64.size(), 8U);  // 6 bytes
  EXPECT_NEAR(from_half(to_half(static_cast<float>(3e8 / encoded.factor))) * encoded.factor, 3e8, 3e8 * 0x1p-11);
  EXPECT_EQ(encode({1.F, 1.F}).base64.substr(0, 4), encode({2.F, 2.F}).base64.substr(0, 4));
}

TEST(Markup, Escapes) {
  EXPECT_EQ(escaped("<b a='x' & \"y\">"), "&lt;b a=&#39;x&#39; &amp; &quot;y&quot;&gt;");
  EXPECT_EQ(escaped(std::string_view("a\0b\x01", 4)), "a b ");
}

TEST(Markup, Percentages) {
  EXPECT_EQ(percent(.002), "0.2\u202f%");
  EXPECT_EQ(percent(.01, true), "+1\u202f%");
  EXPECT_EQ(percent(-.0456), "\u22124.6\u202f%");
  EXPECT_EQ(percent(1.234), "123\u202f%");
  EXPECT_EQ(percent(-1e-9), "0\u202f%");
}

struct Made {
  Report report;
  Picture ours, reference;
};

Made make(double scale) {
  using namespace synthetic;
  Made made;
  const Picture truth = draw(rig(), View{64, 0, 0});
  std::mt19937_64 random(1);
  made.reference = *pool(runs_of(truth, 8, gaussian(.1), random));
  made.ours = truth;
  for (Layer& layer : made.ours.layers) {
    for (float& value : layer.pixels) value = static_cast<float>(value * scale);
  }
  made.report.title = "rig </title><script>alert(1)</script>";
  made.report.comparison = *compare(made.ours, made.reference, {});
  for (const Lamp& lamp : rig()) {
    made.report.lights.push_back({lamp.name, "a <lamp>", *compare(made.ours, made.reference, {}, {}, lamp.name)});
  }
  made.report.losses = {{"light 'key': range 8 m", "brighter beyond 4 m"}};
  made.report.diagnostics.warning("X", "texture & more", {"rig.json", 3, 7, "/lights/0"});
  made.report.facts = {{"Mitsuba", "3.9.1"}};
  return made;
}

std::string html_of(const Made& made) { return to_html(made.report, made.ours, made.reference); }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Report, IsCompleteInItself) {
  const std::string html = html_of(make(1));
  EXPECT_EQ(html.rfind("<!doctype html>", 0), 0U);
  for (const char* outside : {"http:", "https:", "src=", "href=", "@import", "url("}) EXPECT_FALSE(contains(html, outside)) << outside;
  EXPECT_FALSE(contains(html, "{{"));
  for (const char* part : {"Direct light only", "3.9.1", "brighter beyond 4 m", "rig.json:3:7", "/lights/0", "texture &amp; more"}) {
    EXPECT_TRUE(contains(html, part)) << part;
  }
}

TEST(Report, EscapesNames) {
  const std::string html = html_of(make(1));
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_FALSE(contains(html, "a <lamp>"));
  EXPECT_TRUE(contains(html, "a &lt;lamp&gt;"));
}

TEST(Report, SaysTheVerdictInWords) {
  EXPECT_TRUE(contains(html_of(make(1)), "agree within 1\u202f%."));
  const std::string differs = html_of(make(1.05));
  EXPECT_TRUE(contains(differs, "differ by more than 1\u202f%."));
  EXPECT_TRUE(contains(differs, "1.05 times the reference"));
  EXPECT_TRUE(contains(differs, "% brighter than Mitsuba"));
}

TEST(Report, NamesTheLightThatTheSumHides) {
  Made made = make(1);
  EXPECT_FALSE(contains(html_of(made), "Taken alone"));
  made.report.lights[5].comparison.verdict = Verdict::differs;
  EXPECT_TRUE(contains(html_of(made), "Taken alone, light \u2018tiny\u2019 differs"));
}

// The data element is JSON, and its difference and ours give the reference back to half a float's last place of each.
TEST(Report, PicturesComeBack) {
  const Made made = make(1);
  const std::string html = html_of(made), open = "id=\"data\">";
  const std::size_t begin = html.find(open) + open.size();
  const nlohmann::json data = nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  ASSERT_EQ(data["tabs"].size(), 7U);
  EXPECT_EQ(data["tabs"][1]["name"], "key");
  EXPECT_EQ(data["tabs"][0]["width"], 64);
  const std::string ours = data["tabs"][0]["ours"]["data"];
  EXPECT_EQ(ours.size(), std::size_t{64} * 64 * 3 * 2 * 4 / 3);
  // First pixel, red: two bytes are in the first three characters.
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t group = digits.find(ours[0]) << 18 | digits.find(ours[1]) << 12 | digits.find(ours[2]) << 6;
  const auto bits = static_cast<std::uint16_t>((group >> 16 & 255) | (group >> 8 & 255) << 8);
  const double value = from_half(bits) * data["tabs"][0]["ours"]["factor"].get<double>();
  EXPECT_NEAR(value / made.ours.find("")->pixels[0], 1, 0x1p-11);
}

TEST(Report, StaysSmallForALargePictureWithManyLights) {
  Picture large;
  large.width = large.height = 1024;
  large.add("", 3);
  Report report;
  for (int i = 0; i < 8; ++i) {
    report.lights.push_back({"light" + std::to_string(i), "", {}});
    large.add("light.light" + std::to_string(i), 3);
  }
  EXPECT_LT(to_html(report, large, large).size(), std::size_t{30} << 20);
}

}  // namespace
}  // namespace etendue
