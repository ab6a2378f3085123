// For readers that take a file: one file a process, rewritten for each input.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

namespace etendue::fuzz {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : folder_(std::filesystem::temp_directory_path() / ("etendue_fuzz_" + std::to_string(std::random_device()()))),
        file_(folder_ / name) {
    std::filesystem::create_directories(folder_);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& holding(const std::uint8_t* data, std::size_t size) const {
    std::FILE* stream = std::fopen(file_.c_str(), "wb");
    if (stream == nullptr || std::fwrite(data, 1, size, stream) != size || std::fclose(stream) != 0) std::abort();
    return file_;
  }

 private:
  std::filesystem::path folder_, file_;
};

}  // namespace etendue::fuzz
