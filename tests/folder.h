// Files of tests, which ctest runs side by side.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace etendue::test {

// A new folder, gone with its object.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("etendue_test_" + number() + number())) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  static std::string number() { return std::to_string(std::random_device()()); }
  std::filesystem::path path_;
};

}  // namespace etendue::test
