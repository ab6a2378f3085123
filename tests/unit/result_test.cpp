#include "etendue/result.h"

#include <gtest/gtest.h>

#include <string>

namespace etendue {
namespace {

Result<int> half_of(int x) {
  if (x % 2 != 0) return Error{"ODD", "expected an even number", {"numbers.txt", 3, 7, ""}, "double it", {}};
  return x / 2;
}

TEST(Result, CarriesTheValueOrTheError) {
  ASSERT_TRUE(half_of(8).ok());
  EXPECT_EQ(*half_of(8), 4);
  ASSERT_FALSE(half_of(7).ok());
  EXPECT_EQ(half_of(7).error().code, "ODD");
}

TEST(Where, ShowsWhatIsKnown) {
  EXPECT_EQ(to_string(Where{}), "");
  EXPECT_EQ(to_string(Where{"a.gltf", 0, 9, ""}), "a.gltf") << "a column without a line says nothing";
  EXPECT_EQ(to_string(Where{"a.gltf", 12, 0, ""}), "a.gltf:12");
  EXPECT_EQ(to_string(Where{"a.gltf", 12, 5, ""}), "a.gltf:12:5");
  EXPECT_EQ(to_string(Where{"", 12, 5, ""}), "line 12:5");
}

TEST(Diagnostic, IsOneLineWithPointerAndHintBelow) {
  const Diagnostic plain{Severity::warning, "CODE", "text", {"f", 1, 2, ""}, ""};
  EXPECT_EQ(to_string(plain), "f:1:2: warning: text [CODE]");
  const Diagnostic full = to_diagnostic({"ODD", "text", {"f", 0, 0, "/a/0"}, "do this", {}});
  EXPECT_EQ(to_string(full), "f: error: text [ODD]\n  at /a/0\n  hint: do this");
}

TEST(Diagnostics, KeepTheirOrderAndKnowErrorsFromWarnings) {
  Diagnostics all;
  all.note("N", "first");
  all.warning("W", "second");
  EXPECT_FALSE(all.has_errors());
  Diagnostics more;
  more.error("E", "third");
  all.append(more);
  EXPECT_TRUE(all.has_errors());
  ASSERT_EQ(all.all().size(), 3u);
  EXPECT_EQ(all.all()[0].code, "N");
  EXPECT_EQ(all.all()[2].text, "third");
}

}  // namespace
}  // namespace etendue
