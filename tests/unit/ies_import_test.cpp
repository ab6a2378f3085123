#include "importers/ies/ies.h"

#include <gtest/gtest.h>

#include <charconv>
#include <random>
#include <string>

#include "etendue/intensity_web.h"
#include "importers/photometry/scanner.h"

namespace etendue {
namespace {

Result<PhotometricFile> read(const std::string& text, const PhotometricOptions& options = {}) {
  return read_ies(std::as_bytes(std::span(text)), "lamp.ies", options);
}

const std::string head =
    "IESNA:LM-63-2002\r\n[TEST] 1\r\n[TESTLAB] b\r\n[ISSUEDATE] c\r\n[MANUFAC] d\r\n[OTHER] first\r\n[MORE] second\r\n";
const std::string body = "TILT=NONE\r\n1 1000 2 3 2 1 2 .3 .6 0\r\n.9 1 50\r\n0 45 90\r\n0 90\r\n100 50 10\r\n100 40 5\r\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::vector<std::string> warnings_of(const PhotometricFile& file) {
  std::vector<std::string> codes;
  for (const Diagnostic& d : file.diagnostics.all())
    if (d.severity == Severity::warning) codes.push_back(d.code);
  return codes;
}

TEST(IesImport, EveryFieldOfACleanFileArrives) {
  PhotometricOptions strict;
  strict.mode = PhotometricMode::strict;
  const auto file = read(head + body, strict);
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_TRUE(file->diagnostics.all().empty());
  const IntensityDistribution& d = file->distribution;
  const auto& ies = std::get<IesRecord>(d.record);
  EXPECT_EQ(ies.version, IesVersion::lm_63_2002);
  EXPECT_EQ(keyword_of(d, "OTHER"), "first second");
  EXPECT_EQ(keyword_of(d, "LAMP"), "");
  EXPECT_EQ(d.grid.type, WebType::c);
  EXPECT_EQ(d.grid.symmetry, WebSymmetry::quadrant);
  EXPECT_EQ(d.grid.values, (std::vector<double>{100, 50, 10, 100, 40, 5}));
  EXPECT_EQ(candelas_per_value(d), 2 * 0.9);
  EXPECT_EQ(rated_flux_lm(d), 1000);
  EXPECT_EQ(input_watts(d), 50);
  EXPECT_EQ(opening_of(d).shape, OpeningShape::rectangle);
}

// Each repair: what is changed in the clean file, and the only warning it gives.
TEST(IesImport, MalformationsAreRepairedAndNamedOrRefusedWhenStrict) {
  const std::string clean = head + body;
  const struct {
    const char* code;
    std::string text;
  } cases[] = {
      {"VERSION_TAG_VARIANT", replaced(clean, "IESNA:LM", "IESNA: LM")},
      {"VERSION_TAG_VARIANT", replaced(clean, "IESNA:LM-63-2002", "IESNA:LM-63-02")},
      {"VERSION_TAG_VARIANT", " \xEF\xBB\xBF" + clean},
      {"VERSION_UNKNOWN", replaced(clean, "IESNA:LM-63-2002", "IESNA:LM-63-1066")},
      {"VERSION_SHARES_LINE", replaced(clean, "2002\r\n", "2002")},
      {"VERSION_MISSING", replaced(clean, "IESNA:LM-63-2002\r\n", "")},
      {"KEYWORD_MISSING", replaced(clean, "[TESTLAB] b\r\n", "")},
      {"LABEL_WITHOUT_KEYWORD", replaced(clean, "[OTHER] first", "no keyword")},
      {"TILT_SPELLING", replaced(clean, "TILT=NONE", "tilt = none")},
      {"HEADER_RECORD_SPLIT", replaced(clean, "3 2 1 2", "3\r\n2 1 2")},
      {"RECORD_SHARES_LINE", replaced(clean, "0\r\n.9", "0 .9")},
      {"FUTURE_USE", replaced(clean, ".9 1 50", ".9 1.1 50")},
      {"RATED_FLUX_ZERO", replaced(clean, "1 1000 2", "1 0 2")},
      {"VERTICAL_RANGE", replaced(clean, "0 45 90", "0 45 80")},
      {"CANDELA_NEGATIVE", replaced(clean, "40 5", "40 -.01")},
      {"TRAILING_TEXT", clean + "END\x1a"},
      {"LINE_END_CR",
       [&] {
         std::string text = clean;
         std::erase(text, '\n');
         return text;
       }()},
  };
  for (const auto& [code, text] : cases) {
    const auto file = read(text);
    ASSERT_TRUE(file) << code << ": " << file.error().text;
    EXPECT_EQ(warnings_of(*file), std::vector<std::string>{code});
    EXPECT_EQ(file->distribution.grid.values.size(), 6u);
    PhotometricOptions strict;
    strict.mode = PhotometricMode::strict;
    const auto refused = read(text, strict);
    ASSERT_FALSE(refused) << code;
    EXPECT_EQ(refused.error().code, code);
    EXPECT_GT(refused.error().where.line, 0);
  }
}

// To the last bit what from_chars makes of it, whatever its length and whatever stands behind it; what is none is none.
TEST(IesImport, NumbersAreRoundedAsFromChars) {
  std::mt19937 random(9);
  const auto below = [&](unsigned n) { return static_cast<std::size_t>(random() % n); };
  for (int i = 0; i < 200'000; ++i) {
    std::string number;
    for (std::size_t k = below(10); k > 0; --k) number += static_cast<char>('0' + below(10));
    if (below(3) > 0) number += '.';
    for (std::size_t k = below(10); k > 0; --k) number += static_cast<char>('0' + below(10));
    if (number.empty() || number == ".") number += '7';
    if (below(8) == 0) number += below(2) == 0 ? "e-3" : "E2";
    const bool negative = below(4) == 0;
    const std::string text = (negative ? "-" : below(4) == 0 ? "+" : "") + number;
    double expected = 0, found = 0;
    const auto [stop, code] = std::from_chars(number.data(), number.data() + number.size(), expected);
    ASSERT_EQ(code, std::errc()) << number;
    const std::string behind = below(2) == 0 ? text : text + std::string(1, "\r ,x"[below(4)]) + "12345678";
    ASSERT_EQ(photometric::parse_number(behind.data(), behind.data() + behind.size(), found), behind.data() + text.size()) << behind;
    ASSERT_EQ(found, negative ? -expected : expected) << behind;
  }
  for (const std::string none : {"", ".", "-", "+.", "e5", "x1", "1e", "1e+", "-.e1"}) {
    double found = 0;
    for (const std::string& text : {none, none + "         "})
      EXPECT_EQ(photometric::parse_number(text.data(), text.data() + text.size(), found), nullptr) << text;
  }
}

TEST(IesImport, WhatSeparatesNumbersAndEndsLinesDoesNotMatter) {
  const auto reference = read(head + body);
  std::string commas = replaced(head + body, "100 50 10", "100,50 ,\t10"), lf = head + body,
              signs = replaced(head + body, "100 40 5", "+1.0D+02 4e1 5.");
  std::erase(lf, '\r');
  std::string marked = "\xEF\xBB\xBF", ended = head + body;
  marked.append(head).append(body);
  ended += '\x1a';
  for (const std::string& text : {commas, lf, signs, marked, ended}) {
    const auto file = read(text);
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(file->distribution.grid.values, reference->distribution.grid.values);
    EXPECT_TRUE(warnings_of(*file).empty());
  }
  std::string wide = "\xFF\xFE";
  for (const char c : head + body) wide += {c, '\0'};
  const auto file = read(wide);
  ASSERT_TRUE(file);
  EXPECT_EQ(file->distribution.grid.values, reference->distribution.grid.values);
  EXPECT_EQ(warnings_of(*file), std::vector<std::string>{"ENCODING_UTF16"});
}

TEST(IesImport, BrokenFilesAreRefusedWhereTheyBreak) {
  const std::string clean = head + body;
  const struct {
    const char* code;
    std::string text;
    int line, column;
  } cases[] = {
      {"FILE_EMPTY", "", 1, 1},
      {"NUL_BYTES", replaced(clean, "[TEST] 1", std::string("[TEST]\0", 7)), 2, 7},
      {"TILT_MISSING", head, 8, 1},
      {"TILT_MISSING", replaced(clean, "TILT=NONE", "TILT=NO\x1aNE"), 8, 6},
      {"FILE_TRUNCATED", replaced(clean, "100 40 5\r\n", "100 40"), 14, 7},
      {"FILE_TRUNCATED", head + "TILT=NONE\r\n1 1000 2", 9, 9},
      {"NUMBER_EXPECTED", replaced(clean, "100 40 5", "100 x 5"), 14, 5},
      {"NUMBER_EXPECTED", replaced(clean, "100 40 5", "100 nan 5"), 14, 5},
      {"NUMBER_RANGE", replaced(clean, "100 40 5", "100 4e999 5"), 14, 5},
      {"NUMBER_RANGE", replaced(clean, "1000 2 3", "1000 1e308 3"), 14, 8},
      {"NUMBER_RANGE", replaced(clean, "100 40 5", "100 1e101 5"), 14, 11},
      {"COUNT_INVALID", replaced(clean, "1000 2 3", "1000 2 1e30"), 9, 10},
      {"COUNT_INVALID", replaced(clean, "1000 2 3", "1000 2 -3"), 9, 10},
      {"COUNT_INVALID", replaced(clean, "1000 2 3", "1000 2 3.5"), 9, 10},
      {"PHOTOMETRIC_TYPE", replaced(clean, "3 2 1 2", "3 2 4 2"), 9, 14},
      {"UNITS_INVALID", replaced(clean, "3 2 1 2", "3 2 1 0"), 9, 16},
      {"BALLAST_RECORD_MISSING", replaced(clean, ".9 1 50\r\n", ""), 10, 1},
      {"ANGLES_NOT_INCREASING", replaced(clean, "0 45 90", "0 45 45"), 11, 6},
      {"ANGLES_RANGE", replaced(clean, "0 45 90", "0 45 190"), 11, 6},
      {"ANGLES_RANGE", replaced(replaced(clean, "3 2 1 2", "3 1 1 2"), "\r\n0 90\r\n100 50 10\r\n", "\r\n2701\r\n"), 12, 1},
      {"HORIZONTAL_RANGE", replaced(clean, "\r\n0 90\r\n", "\r\n0 80\r\n"), 12, 3},
      {"CANDELA_NEGATIVE", replaced(clean, "100 40 5", "100 -40 5"), 14, 5},
  };
  for (const auto& [code, text, line, column] : cases) {
    const auto file = read(text);
    ASSERT_FALSE(file) << code;
    EXPECT_EQ(file.error().code, code);
    EXPECT_EQ(file.error().where.line, line) << code;
    EXPECT_EQ(file.error().where.column, column) << code;
    EXPECT_FALSE(file.error().hint.empty()) << code;
  }
}

TEST(IesImport, HugeCountsAreRefusedWithoutMemory) {
  const auto file = read(replaced(head + body, "1000 2 3 2", "1000 2 100000 100000"));
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, "COUNT_INVALID");
}

TEST(IesImport, FactorsMultiplyByVersion) {
  const auto factor = [](const char* first_line) {
    const auto file = read(std::string(first_line) + "[TEST] 1\r\n[TESTLAB] b\r\n[ISSUEDATE] c\r\n[MANUFAC] d\r\n" +
                           replaced(body, ".9 1 50", ".9 1.1111 50"));
    return file ? candelas_per_value(file->distribution) : 0;
  };
  EXPECT_DOUBLE_EQ(factor("IESNA91\r\n"), 2 * 0.9 * 1.1111);
  EXPECT_DOUBLE_EQ(factor("IESNA:LM-63-1995\r\n"), 2 * 0.9);
  EXPECT_DOUBLE_EQ(factor("IES:LM-63-2019\r\n"), 2 * 0.9);
}

TEST(IesImport, HorizontalAnglesSayTheSymmetry) {
  const auto symmetry = [](const std::string& first_line, int type, const std::string& vertical, const std::string& horizontal,
                           int planes) {
    std::string text = first_line + "\r\n[TEST] 1\r\n[TESTLAB] b\r\n[ISSUEDATE] c\r\n[MANUFAC] d\r\nTILT=NONE\r\n1 -1 1 2 " +
                       std::to_string(planes) + " " + std::to_string(type) + " 2 0 0 0\r\n1 1 5\r\n" + vertical + "\r\n" + horizontal +
                       "\r\n";
    for (int i = 0; i < planes; ++i) text += "1 1\r\n";
    const auto file = read(text);
    return file ? std::string(name_of(file->distribution.grid.symmetry)) : file.error().code;
  };
  const std::string v95 = "IESNA:LM-63-1995", v02 = "IESNA:LM-63-2002";
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0", 1), "rotational");
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0 90", 2), "quadrant");
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0 90 180", 3), "about_0_180");
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0 180 360", 3), "none");
  EXPECT_EQ(symmetry(v95, 1, "0 90", "90 180 270", 3), "about_90_270");
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0 90 180 270", 4), "none");  // the gap is one step: the circle closes
  EXPECT_EQ(symmetry(v02, 1, "0 90", "0 90 200", 3), "HORIZONTAL_RANGE");
  EXPECT_EQ(symmetry(v02, 2, "-90 90", "-90 90", 2), "none");
  EXPECT_EQ(symmetry(v02, 2, "-90 90", "0 90", 2), "lateral");
  EXPECT_EQ(symmetry(v02, 3, "0 90", "0 90", 2), "lateral_and_vertical");
}

TEST(IesImport, TiltIsIncludedResolvedOrUnresolved) {
  const std::string records = "1\r\n3\r\n0 45 90\r\n1 .9 .8\r\n";
  const auto included = read(replaced(head + body, "TILT=NONE\r\n", "TILT=INCLUDE\r\n" + records));
  ASSERT_TRUE(included);
  EXPECT_EQ(std::get<IesRecord>(included->distribution.record).tilt->factors, (std::vector<double>{1, .9, .8}));
  const std::string named = replaced(head + body, "TILT=NONE", "TILT=lamp.tlt");
  const auto unresolved = read(named);
  ASSERT_TRUE(unresolved);
  EXPECT_EQ(warnings_of(*unresolved), std::vector<std::string>{"TILT_UNRESOLVED"});
  PhotometricOptions options;
  options.tilt_file = [&](const std::string& name) -> Result<std::vector<std::byte>> {
    EXPECT_EQ(name, "lamp.tlt");
    const auto bytes = std::as_bytes(std::span(records));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  const auto resolved = read(named, options);
  ASSERT_TRUE(resolved);
  EXPECT_EQ(std::get<IesRecord>(resolved->distribution.record).tilt->angles_deg.size(), 3u);
  EXPECT_TRUE(warnings_of(*resolved).empty());
}

TEST(IesImport, HeaderOnlyLeavesTheWebEmpty) {
  PhotometricOptions options;
  options.mode = PhotometricMode::header_only;
  const auto file = read(head + body, options);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->distribution.grid.values.empty());
  EXPECT_EQ(input_watts(file->distribution), 50);
}

// The same three numbers are a sphere in 1995 and a vertical disk in 2002.
TEST(IesImport, TheOpeningIsReadByTheTableOfItsVersion) {
  const auto shape = [](const char* first_line, const char* size) {
    const auto file = read(std::string(first_line) + replaced(body, ".3 .6 0", size));
    return file ? opening_of(file->distribution).shape : OpeningShape::unknown;
  };
  EXPECT_EQ(shape("IESNA:LM-63-1995\r\n", "-.2 0 -.2"), OpeningShape::sphere);
  EXPECT_EQ(shape("IESNA:LM-63-2002\r\n", "-.2 0 -.2"), OpeningShape::vertical_disk);
  EXPECT_EQ(shape("IESNA:LM-63-2002\r\n", "-.2 -.2 -.2"), OpeningShape::sphere);
  EXPECT_EQ(shape("IESNA:LM-63-2002\r\n", "-.2 -.2 0"), OpeningShape::disk);
  EXPECT_EQ(shape("IESNA91\r\n", "-.2 0 0"), OpeningShape::disk);
  EXPECT_EQ(shape("IESNA:LM-63-2002\r\n", "-.2 1 -.2"), OpeningShape::cylinder_along_length);
  EXPECT_EQ(shape("IESNA:LM-63-1995\r\n", "0 1 -.2"), OpeningShape::cylinder_along_length);
}

}  // namespace
}  // namespace etendue
