// Real photometric files against what an independent reader found in them (../shared/corpus/photometry/README.md).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "etendue/intensity_web.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "source_dir.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using Row = std::map<std::string, std::string>;

const fs::path& corpus() {
  static const fs::path folder = source_dir() / "../shared/corpus/photometry";
  return folder;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

std::vector<Row> reference() {
  std::ifstream in(corpus() / "REFERENCE.csv");
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = fields_of(line);
    Row row;
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

Result<PhotometricFile> read(const std::string& name) {
  const auto bytes = read_file(corpus() / name, 1u << 28);
  if (!bytes) return bytes.error();
  return name.ends_with(".ies") ? read_ies(*bytes, name) : read_eulumdat(*bytes, name);
}

class Corpus : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(corpus() / "REFERENCE.csv")) GTEST_SKIP() << "needs ../shared/corpus/photometry";
  }
};

TEST_F(Corpus, FluxIsTheIndependentReadersToRounding) {
  std::size_t read_files = 0;
  for (const Row& row : reference()) {
    if (row.at("status") != "ok") continue;
    const std::string& file = row.at("file");
    const Result<PhotometricFile> found = read(file);
    ASSERT_TRUE(found) << file << " " << to_string(to_diagnostic(found.error()));
    const Result<IntensityWeb> web = IntensityWeb::of(found->distribution);
    const Result<IntensityWeb> zonal = IntensityWeb::of(found->distribution, Interpolation::cosine);
    ASSERT_TRUE(web) << file << " " << web.error().text;
    ASSERT_TRUE(zonal);
    const double flux = std::stod(row.at("flux"));
    EXPECT_NEAR(web->flux_lm() / flux, 1, 1e-9) << file;
    EXPECT_NEAR(zonal->flux_lm(), std::stod(row.at("flux_zonal")), 0.005) << file;
    EXPECT_NEAR(web->max_cd() / std::stod(row.at("max_cd")), 1, 1e-7) << file;
    // The zones are given with all digits.
    EXPECT_NEAR(web->flux_between(0, 30), std::stod(row.at("f0_30")), 1e-9 * flux) << file;
    EXPECT_NEAR(web->flux_between(0, std::acos(0.25) * 180 / pi), std::stod(row.at("f0_75")), 1e-9 * flux) << file;
    EXPECT_NEAR(web->flux_between(90, 180), std::stod(row.at("f90_180")), 1e-9 * flux) << file;
    ++read_files;
  }
  EXPECT_EQ(read_files, 167u);
}

TEST_F(Corpus, ErroneousFilesSayWhere) {
  std::size_t refused = 0;
  for (const Row& row : reference()) {
    if (row.at("status") == "ok") continue;
    const Result<PhotometricFile> found = read(row.at("file"));
    ASSERT_FALSE(found) << row.at("file");
    const Error& error = found.error();
    EXPECT_FALSE(error.code.empty());
    EXPECT_GT(error.where.line, 0) << row.at("file");
    EXPECT_GT(error.where.column, 0) << row.at("file");
    EXPECT_FALSE(error.hint.empty()) << row.at("file");
    ++refused;
  }
  EXPECT_EQ(refused, 3u);
}

}  // namespace
}  // namespace etendue
