#include "json_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace etendue {
namespace {

JsonDocument parsed(std::string_view text, const JsonLimits& limits = {}) {
  Result<JsonDocument> document = JsonDocument::parse(text, "a.json", limits);
  if (!document) {
    ADD_FAILURE() << document.error().text;
    return std::move(*JsonDocument::parse("null", ""));
  }
  return std::move(*document);
}

std::string refused(std::string_view text, const JsonLimits& limits = {}) {
  const Result<JsonDocument> document = JsonDocument::parse(text, "a.json", limits);
  if (document) return "accepted";
  const Error& e = document.error();
  return e.code + " " + to_string(e.where);
}

TEST(JsonText, KeepsValuesAndTheirOrder) {
  const JsonDocument document = parsed(R"({"z": [1, -2.5e1, true, null], "a": "x\u00e9\n", "m": {}})");
  const JsonValue root = document.root();
  ASSERT_EQ(root.kind(), JsonKind::object);
  std::string keys;
  for (const JsonValue member : root) keys += std::string(member.key());
  EXPECT_EQ(keys, "zam");
  const JsonValue z = root.find("z");
  ASSERT_EQ(z.size(), 4u);
  EXPECT_EQ(z.element(0).number(), 1);
  EXPECT_TRUE(z.element(0).is_integer());
  EXPECT_EQ(z.element(1).number(), -25);
  EXPECT_FALSE(z.element(1).is_integer());
  EXPECT_TRUE(z.element(2).boolean());
  EXPECT_EQ(z.element(3).kind(), JsonKind::null);
  EXPECT_FALSE(z.element(4));
  EXPECT_EQ(root.find("a").string(), "x\xC3\xA9\n");
  EXPECT_EQ(root.find("m").kind(), JsonKind::object);
  EXPECT_EQ(root.find("m").size(), 0u);
  EXPECT_FALSE(root.find("absent"));
  EXPECT_EQ(root.find("absent").kind(), JsonKind::missing);
}

TEST(JsonText, EveryValueKnowsItsPlace) {
  const std::string text = "{\n  \"a\" : [ 10,\r\n\t{ \"b\\\"\": \"s\" , \"c\":false}, []],\n \"d\":-0}";
  const JsonDocument document = parsed(text);
  const JsonValue root = document.root();
  const auto place = [](JsonValue v) { return to_string(v.where()) + " " + v.where().pointer; };
  const JsonValue a = root.find("a");
  EXPECT_EQ(place(root), "a.json:1:1 ");
  EXPECT_EQ(place(a), "a.json:2:9 /a");
  EXPECT_EQ(place(a.element(0)), "a.json:2:11 /a/0");
  EXPECT_EQ(place(a.element(1)), "a.json:3:2 /a/1");
  EXPECT_EQ(place(a.element(1).find("b\"")), "a.json:3:11 /a/1/b\"");
  EXPECT_EQ(to_string(a.element(1).find("c").where_key()), "a.json:3:17");
  EXPECT_EQ(place(a.element(1).find("c")), "a.json:3:21 /a/1/c");
  EXPECT_EQ(place(a.element(2)), "a.json:3:29 /a/2");
  EXPECT_EQ(place(root.find("d")), "a.json:4:6 /d");
  EXPECT_TRUE(std::signbit(root.find("d").number()));
  // The text at each offset is the value's own first byte.
  EXPECT_EQ(text[a.offset()], '[');
  EXPECT_EQ(text[a.element(1).find("c").offset()], 'f');
}

TEST(JsonText, PointersAreEscaped) {
  const JsonDocument document = parsed(R"({"a/b~c": {"": 1}})");
  EXPECT_EQ(document.root().find("a/b~c").find("").pointer(), "/a~1b~0c/");
}

TEST(JsonText, ColumnsCountBytesAndAByteOrderMarkIsSkipped) {
  EXPECT_EQ(to_string(parsed("\"\xC3\xA9\"").root().where()), "a.json:1:1");
  EXPECT_EQ(to_string(parsed("[\"\xC3\xA9\", 7]").root().element(1).where()), "a.json:1:8");
  EXPECT_EQ(to_string(parsed("\xEF\xBB\xBF 7").root().where()), "a.json:1:5");
}

TEST(JsonText, NumbersRoundToTheNearestDouble) {
  const JsonDocument document =
      parsed("[9007199254740993, 18446744073709551616, 0.1, 1e-400, 5e-324, 1.7976931348623157e308, 9007199254740993.0]");
  EXPECT_EQ(document.root().element(0).number(), 9007199254740992.0);  // a tie between two doubles goes to the even one
  EXPECT_EQ(document.root().element(1).number(), 18446744073709551616.0);
  EXPECT_TRUE(document.root().element(1).is_integer());
  EXPECT_EQ(document.root().element(2).number(), 0.1);
  EXPECT_EQ(document.root().element(3).number(), 0);
  EXPECT_EQ(document.root().element(4).number(), 5e-324);
  EXPECT_EQ(document.root().element(5).number(), 1.7976931348623157e308);
  EXPECT_FALSE(document.root().element(6).is_integer());
}

TEST(JsonText, ReportsDuplicateKeys) {
  const JsonDocument document = parsed("{\"a\": 1, \"b\": {\"c\": 1, \"\\u0063\": 2},\n \"a\": 3, \"a\": 4}");
  const std::vector<JsonValue> duplicates = document.duplicate_keys();
  ASSERT_EQ(duplicates.size(), 3u);
  EXPECT_EQ(to_string(duplicates[0].where_key()), "a.json:1:24");  // an escape spells the same key
  EXPECT_EQ(to_string(duplicates[1].where_key()), "a.json:2:2");
  EXPECT_EQ(duplicates[2].number(), 4);
  EXPECT_EQ(document.root().find("a").number(), 1);
}

TEST(JsonText, RefusesWhatIsNoJsonWithLineAndColumn) {
  EXPECT_EQ(refused(""), "JSON_INVALID a.json:1:1");
  EXPECT_EQ(refused("[1,\n 2"), "JSON_INVALID a.json:2:3");
  EXPECT_EQ(refused("[1, 2,]"), "JSON_INVALID a.json:1:7");
  EXPECT_EQ(refused("[1,, 2]"), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("{\"a\" \"bcd\"}"), "JSON_INVALID a.json:1:6");
  EXPECT_EQ(refused("[1 23]"), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("{} x"), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("{} {}"), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("[1.]"), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("[\n1e999]"), "JSON_INVALID a.json:2:1");
  EXPECT_EQ(refused("[NaN]"), "JSON_INVALID a.json:1:2");
  EXPECT_EQ(refused("{a: 1}"), "JSON_INVALID a.json:1:2");
  EXPECT_EQ(refused("[1] // no comments"), "JSON_INVALID a.json:1:5");
  EXPECT_EQ(refused("\"a\tb\""), "JSON_INVALID a.json:1:3");
  EXPECT_EQ(refused(std::string_view("{}\0{}", 5)), "JSON_INVALID a.json:1:3");
}

TEST(JsonText, RefusesInvalidUtf8) {
  EXPECT_EQ(refused("\"ab\xFF\""), "JSON_INVALID a.json:1:4");
  EXPECT_EQ(refused("\"\xC3(\""), "JSON_INVALID a.json:1:3");
  EXPECT_EQ(refused("\"\xED\xA0\x80\""), "JSON_INVALID a.json:1:3");  // a surrogate
  EXPECT_EQ(refused("\"\xC0\x80\""), "JSON_INVALID a.json:1:2");      // overlong
  EXPECT_EQ(refused("\"\\ud800\""), "JSON_INVALID a.json:1:8");
}

TEST(JsonText, BoundsDepthAndCount) {
  EXPECT_EQ(refused("[[[[]]]]", {4, 100}), "accepted");
  EXPECT_EQ(refused("[[[\n [{}]]]]", {4, 100}), "JSON_TOO_DEEP a.json:2:3");
  EXPECT_EQ(refused("[1,2,3]", {4, 3}), "JSON_TOO_LARGE a.json:1:6");
  EXPECT_EQ(refused(std::string(100'000, '[')), "JSON_TOO_DEEP a.json:1:257");
}

}  // namespace
}  // namespace etendue
