// Real files: those of the scene folders are read, those of Khronos' validator are refused where its report has an error, and nowhere else.
// tests/acceptance/gltf_import compares codes, and mutated files.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "gltf_builder.h"
#include "source_dir.h"

namespace etendue::test {
namespace {

namespace fs = std::filesystem;

const fs::path corpus = source_dir() / ".." / "shared" / "corpus" / "gltf";

std::vector<fs::path> assets_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool has_place(const Diagnostic& d) { return !d.where.pointer.empty() || d.where.line > 0 || d.where.offset >= 0; }

TEST(GltfCorpus, ScenesAreRead) {
  if (!fs::exists(corpus)) GTEST_SKIP() << "../shared/corpus/gltf is not there";
  int read = 0;
  for (const char* folder : {"bevyengine__bevy", "KhronosGroup__glTF", "sbtron__glTF-Sample-Models", "bghgary__glTF-Asset-Generator"}) {
    for (const fs::path& file : assets_below(corpus / folder)) {
      SCOPED_TRACE(file.filename().string());
      const auto imported = read_gltf(file);
      ASSERT_TRUE(imported.ok()) << imported.error().text;
      EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
      EXPECT_FALSE(imported->scene.meshes.empty());
      const Diagnostics faults = validate(imported->scene);
      EXPECT_FALSE(faults.has_errors()) << all_text(faults);
      ++read;
    }
  }
  EXPECT_EQ(read, 13);
}

TEST(GltfCorpus, KhronosValidatorsFilesAreJudgedAsItJudgesThem) {
  const fs::path folder = corpus / "KhronosGroup__glTF-Validator";
  if (!fs::exists(folder)) GTEST_SKIP() << "../shared/corpus/gltf is not there";
  int invalid = 0, invalid_refused = 0, valid = 0, valid_refused = 0;
  for (const fs::path& file : assets_below(folder)) {
    const fs::path report_file = file.string() + ".report.json";
    const auto imported = read_gltf(file);
    const bool refused = !imported.ok() || imported->diagnostics.has_errors();
    EXPECT_TRUE(imported.ok() || has_place(to_diagnostic(imported.error()))) << file;
    const Diagnostics found = imported.ok() ? imported->diagnostics : Diagnostics();
    for (const Diagnostic& d : found.all()) EXPECT_TRUE(d.severity != Severity::error || has_place(d)) << file;
    if (!fs::exists(report_file)) continue;
    std::ifstream stream(report_file);
    const Json report = Json::parse(stream);
    const bool is_invalid = report["issues"]["numErrors"].get<int>() > 0;
    ++(is_invalid ? invalid : valid);
    if (refused) ++(is_invalid ? invalid_refused : valid_refused);
    if (std::getenv("ETENDUE_CORPUS_LIST") != nullptr && refused != is_invalid)
      std::printf("%s %s\n", is_invalid ? "accepted, invalid:" : "refused, valid:  ", fs::relative(file, folder).c_str());
  }
  std::printf("refused: %d of %d invalid files, %d of %d valid ones\n", invalid_refused, invalid, valid_refused, valid);
  EXPECT_GT(invalid, 100);
  EXPECT_GT(valid, 50);
  EXPECT_EQ(invalid_refused, invalid);
  EXPECT_EQ(valid_refused, 0);
}

}  // namespace
}  // namespace etendue::test
