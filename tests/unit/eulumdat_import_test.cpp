#include "importers/eulumdat/eulumdat.h"

#include <gtest/gtest.h>

#include <string>

#include "etendue/intensity_web.h"

namespace etendue {
namespace {

// A field a line; the lines of a small file with symmetry 4 and two lamp sets.
std::vector<std::string> lines() {
  return {"maker", "2",   "4",    "4",   "90", "3",   "45", "report", "lamp", "123", "file", "date", "1200", "60",  "80", "1180",
          "50",    "0",   "0",    "0",   "0",  "100", "70", "1",      "0",    "2",   "1",    "LED",  "1000", "840", "80", "10",
          "1",     "LED", "2000", "840", "80", "19",  ".1", ".2",     ".3",   ".4",  ".5",   ".6",   ".7",   ".8",  ".9", "1",
          "0",     "90",  "180",  "270", "0",  "45",  "90", "300",    "200",  "10",  "300",  "150",  "5"};
}

std::string text_of(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) text += field + "\r\n";
  return text;
}

Result<PhotometricFile> read(const std::string& text, PhotometricOptions options = {}) {
  return read_eulumdat(std::as_bytes(std::span(text)), "lamp.ldt", options);
}

// With line `number` (from 1) replaced.
std::string with(std::size_t number, const std::string& field) {
  std::vector<std::string> all = lines();
  all[number - 1] = field;
  return text_of(all);
}

TEST(EulumdatImport, EveryFieldOfACleanFileArrives) {
  PhotometricOptions strict;
  strict.mode = PhotometricMode::strict;
  const auto file = read(text_of(lines()), strict);
  ASSERT_TRUE(file) << file.error().text << to_string(file.error().where);
  const IntensityDistribution& d = file->distribution;
  const auto& ldt = std::get<EulumdatRecord>(d.record);
  EXPECT_EQ(ldt.company, "maker");
  EXPECT_EQ(ldt.length_mm, 1200);
  EXPECT_EQ(ldt.lorl_percent, 70);
  ASSERT_EQ(ldt.lamp_sets.size(), 2u);
  EXPECT_EQ(ldt.lamp_sets[1].watts, 19);
  EXPECT_EQ((*ldt.direct_ratios)[9], 1);
  EXPECT_EQ(d.grid.symmetry, WebSymmetry::quadrant);
  EXPECT_EQ(d.grid.values, (std::vector<double>{300, 200, 10, 300, 150, 5}));
}

// Alternatives, never a sum.
TEST(EulumdatImport, OneLampSetIsUsed) {
  PhotometricOptions second;
  second.lamp_set = 1;
  EXPECT_DOUBLE_EQ(candelas_per_value(read(text_of(lines()))->distribution), 1);
  EXPECT_DOUBLE_EQ(candelas_per_value(read(text_of(lines()), second)->distribution), 2);
  second.lamp_set = 2;
  EXPECT_EQ(read(text_of(lines()), second).error().code, "LAMP_SET_MISSING");
}

TEST(EulumdatImport, MalformationsAreRepairedAndNamedOrRefusedWhenStrict) {
  const struct {
    const char* code;
    std::string text;
  } cases[] = {
      {"FIELD_BLANK", with(13, "")},          {"FIELD_BLANK", with(40, "")},
      {"DECIMAL_COMMA", with(13, "1200,5")},  {"DECIMAL_COMMA", with(57, "200,5")},
      {"C_STEP_MISMATCH", with(5, "15")},     {"GAMMA_STEP_MISMATCH", with(7, "5")},
      {"CANDELA_NEGATIVE", with(61, "-.01")}, {"TRAILING_TEXT", text_of(lines()) + "1\r\n2\r\n"},
  };
  for (const auto& [code, text] : cases) {
    const auto file = read(text);
    ASSERT_TRUE(file) << code << ": " << file.error().text;
    std::vector<std::string> codes;
    for (const Diagnostic& d : file->diagnostics.all())
      if (d.severity == Severity::warning) codes.push_back(d.code);
    EXPECT_EQ(codes, std::vector<std::string>{code});
    PhotometricOptions strict;
    strict.mode = PhotometricMode::strict;
    const auto refused = read(text, strict);
    ASSERT_FALSE(refused) << code;
    EXPECT_EQ(refused.error().code, code);
  }
}

TEST(EulumdatImport, BrokenFilesAreRefusedWhereTheyBreak) {
  std::vector<std::string> short_file = lines();
  short_file.resize(60);
  const struct {
    const char* code;
    std::string text;
    int line;
  } cases[] = {
      {"FILE_EMPTY", "", 1},
      {"FILE_TRUNCATED", "maker\r\n2\r\n", 3},
      {"FILE_TRUNCATED", text_of(short_file), 61},
      {"NUMBER_EXPECTED", with(2, "x"), 2},
      {"NUMBER_EXPECTED", with(60, "x"), 60},
      {"SYMMETRY_INVALID", with(3, "5"), 3},
      {"COUNT_INVALID", with(4, "6"), 4},
      {"COUNT_INVALID", with(4, "1e30"), 4},
      {"COUNT_INVALID", with(6, "100000"), 6},
      {"FACTOR_INVALID", with(24, "0"), 24},
      {"FLUX_MISSING", with(29, "0"), 29},
      {"ANGLES_NOT_INCREASING", with(54, "0"), 54},
      {"ANGLES_RANGE", with(55, "200"), 53},
      {"HORIZONTAL_RANGE", with(50, "80"), 49},
      {"CANDELA_NEGATIVE", with(60, "-50"), 60},
  };
  for (const auto& [code, text, line] : cases) {
    const auto file = read(text);
    ASSERT_FALSE(file) << code;
    EXPECT_EQ(file.error().code, code) << file.error().text;
    EXPECT_EQ(file.error().where.line, line) << code;
    EXPECT_FALSE(file.error().hint.empty()) << code;
  }
}

// Symmetry 3 stores C270 through C0 to C90; the mirror takes C to 180 - C.
TEST(EulumdatImport, SymmetryThreeIsMirroredByThePlaneC90) {
  std::vector<std::string> all = lines();
  all[2] = "3";
  const std::vector<std::string> third{"300", "100", "1"};
  all.insert(all.end(), third.begin(), third.end());
  const auto file = read(text_of(all));
  ASSERT_TRUE(file) << file.error().text;
  const auto web = IntensityWeb::of(file->distribution);
  ASSERT_TRUE(web);
  EXPECT_EQ(file->distribution.grid.horizontal_deg, (std::vector<double>{-90, 0, 90}));
  EXPECT_DOUBLE_EQ(web->at(270, 45), 200);
  EXPECT_DOUBLE_EQ(web->at(0, 45), 150);
  EXPECT_DOUBLE_EQ(web->at(180, 45), 150);
  EXPECT_DOUBLE_EQ(web->at(90, 45), 100);
  EXPECT_DOUBLE_EQ(web->at(135, 45), 125);
}

TEST(EulumdatImport, NegativeLampsMeanAbsolutePhotometry) {
  const auto file = read(with(27, "-1"));
  ASSERT_TRUE(file);
  EXPECT_TRUE(is_absolute(file->distribution));
  EXPECT_DOUBLE_EQ(candelas_per_value(file->distribution), 1);
}

}  // namespace
}  // namespace etendue
