#include "etendue/io.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>

#if defined(__unix__)
#include <sys/resource.h>
#include <csignal>
#endif

namespace etendue {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text.data(), text.size())); }
std::string text_of(const std::vector<std::byte>& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

// A folder that exists for one test.
class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("etendue_io_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_), {}); }
  fs::path folder_;
};

// A format known by how its files begin.
class FakeImporter : public Importer {
 public:
  FakeImporter(std::string id, std::vector<std::string> extensions, std::string magic)
      : info_{std::move(id), "Fake", std::move(extensions), ""}, magic_(std::move(magic)) {}
  FormatInfo describe() const override { return info_; }
  int sniff(std::span<const std::byte> head) const override {
    return !magic_.empty() && head.size() >= magic_.size() && std::memcmp(head.data(), magic_.data(), magic_.size()) == 0 ? 90 : 0;
  }
  Result<Imported> read(const fs::path&, const ImportOptions&) const override { return Imported{}; }

 private:
  FormatInfo info_;
  std::string magic_;
};
class FakeExporter : public Exporter {
 public:
  FakeExporter(std::string id, std::vector<std::string> extensions) : info_{std::move(id), "Fake", std::move(extensions), ""} {}
  FormatInfo describe() const override { return info_; }
  Result<Exported> write(const Scene&, const fs::path&, const ExportOptions&) const override { return Exported{}; }

 private:
  FormatInfo info_;
};

Registry sample_registry() {
  Registry registry;
  registry.add(std::make_unique<FakeImporter>("json", std::vector<std::string>{".json"}, ""));
  registry.add(std::make_unique<FakeImporter>("rig", std::vector<std::string>{".rig.json"}, ""));
  registry.add(std::make_unique<FakeImporter>("glb", std::vector<std::string>{".glb"}, "glTF"));
  registry.add(std::make_unique<FakeExporter>("json", std::vector<std::string>{".json"}));
  registry.add(std::make_unique<FakeExporter>("rig", std::vector<std::string>{".rig.json"}));
  return registry;
}

using RegistryTest = Files;
TEST_F(RegistryTest, ContentGoesBeforeTheExtension) {
  const Registry registry = sample_registry();
  EXPECT_EQ((*registry.importer_for(file("misnamed.json", "glTF....")))->describe().id, "glb");
  EXPECT_EQ((*registry.importer_for(file("a.json", "{}")))->describe().id, "json");
  EXPECT_EQ((*registry.importer_for(file("a.RIG.json", "{}")))->describe().id, "rig") << "the longest match, in any case";
  EXPECT_EQ((*registry.importer_for(file("empty.glb", "")))->describe().id, "glb");
}
TEST_F(RegistryTest, SaysWhatItKnows) {
  const Registry registry = sample_registry();
  const auto unknown = registry.importer_for(file("a.blend", "BLENDER"));
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code, "FORMAT_UNKNOWN");
  EXPECT_NE(unknown.error().hint.find(".rig.json"), std::string::npos);
  EXPECT_EQ(registry.importer_for(folder_ / "missing.json").error().code, "FILE_UNREADABLE");
  EXPECT_EQ(registry.importer_for(folder_).error().code, "FILE_UNREADABLE");
}
TEST_F(RegistryTest, ExportersGoByTheLongestExtension) {
  const Registry registry = sample_registry();
  EXPECT_EQ((*registry.exporter_for("x/out.rig.json"))->describe().id, "rig");
  EXPECT_EQ((*registry.exporter_for("out.json"))->describe().id, "json");
  EXPECT_EQ(registry.exporter_for("out.usd").error().code, "FORMAT_UNKNOWN");
}

using ReadFile = Files;
TEST_F(ReadFile, ReadsEveryByte) {
  std::string content(200000, 'x');
  content[7] = '\0';
  content[100000] = '\r';
  const auto bytes = read_file(file("a.bin", content), content.size());
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(text_of(*bytes), content);
  EXPECT_TRUE(read_file(file("empty", ""), 0)->empty());
}
TEST_F(ReadFile, RefusesWhatIsTooLargeOrNotThere) {
  EXPECT_EQ(read_file(file("a", "12345"), 4).error().code, "FILE_TOO_LARGE");
  EXPECT_EQ(read_file(folder_ / "missing", 10).error().code, "FILE_UNREADABLE");
  EXPECT_EQ(read_file(folder_, 10).error().code, "FILE_UNREADABLE");
  EXPECT_EQ(read_file("", 10).error().code, "FILE_UNREADABLE");
  if (fs::exists("/dev/zero")) {
    EXPECT_EQ(read_file("/dev/zero", 1 << 20).error().code, "FILE_TOO_LARGE") << "without a size the limit holds too";
  }
}

using WriteFile = Files;
TEST_F(WriteFile, WritesAndReplacesWholeFiles) {
  const fs::path out = folder_ / "out.txt";
  ASSERT_TRUE(write_file(out, bytes_of("first, longer")).ok());
  ASSERT_TRUE(write_file(out, bytes_of("second")).ok());
  EXPECT_EQ(text_of(*read_file(out, 100)), "second");
  ASSERT_TRUE(write_file(out, {}).ok());
  EXPECT_EQ(fs::file_size(out), 0u);
  EXPECT_EQ(entries(), 1) << "no temporary file stays";
}
TEST_F(WriteFile, FailsWithoutATrace) {
  EXPECT_EQ(write_file(folder_ / "no" / "such" / "out", bytes_of("x")).error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(write_file(folder_, bytes_of("x")).error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(write_file("", bytes_of("x")).error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(entries(), 0);
}
TEST_F(WriteFile, WritesToDevicesInsteadOfReplacingThem) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  EXPECT_TRUE(write_file("/dev/null", bytes_of("x")).ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(write_file("/dev/full", bytes_of("x")).error().code, "FILE_UNWRITABLE");
}
#if defined(__unix__)
// A file that may not grow stands for a full disk: the old file survives, the temporary one does not.
TEST_F(WriteFile, LeavesTheOldFileWhenTheDiskIsFull) {
  const fs::path out = file("out.txt", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Status status = write_file(out, bytes_of(std::string(100000, 'x')));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(text_of(*read_file(out, 100)), "old");
  EXPECT_EQ(entries(), 1);
}
#endif

}  // namespace
}  // namespace etendue
