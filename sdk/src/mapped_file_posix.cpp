// POSIX's mmap; the Windows twin would use CreateFileMapping and MapViewOfFile.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "etendue/io.h"
#include "mapped_file.h"

namespace etendue {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file) : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

Result<SharedBytes> read_into_memory(const std::filesystem::path& file, std::uint64_t max_bytes) {
  const auto bytes = read_file(file, max_bytes);
  if (!bytes) return bytes.error();
  std::vector<std::uint8_t> copy(bytes->size());
  if (!copy.empty()) std::memcpy(copy.data(), bytes->data(), copy.size());
  return SharedBytes(std::move(copy));
}

}  // namespace

Result<SharedBytes> map_file(const std::filesystem::path& file, std::uint64_t max_bytes) {
  const Descriptor descriptor(file);
  struct stat status {};
  const bool regular = descriptor.number() >= 0 && ::fstat(descriptor.number(), &status) == 0 && S_ISREG(status.st_mode);
  // An empty file cannot be mapped, and what cannot be opened has its reason said there.
  if (!regular || status.st_size == 0) return read_into_memory(file, max_bytes);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > max_bytes)
    return Error{"FILE_TOO_LARGE",
                 fmt::format("expected at most {} bytes in \"{}\", found {}", max_bytes, file.string(), size),
                 {file.string(), 0, 0, ""},
                 {},
                 {}};
  void* const start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.number(), 0);
  if (start == MAP_FAILED) return read_into_memory(file, max_bytes);
  ::madvise(start, size, MADV_RANDOM);
  const std::shared_ptr<const void> mapping(start, [size](const void* p) { ::munmap(const_cast<void*>(p), size); });
  return SharedBytes(mapping, {static_cast<const std::byte*>(start), size});
}

void will_read_all(const SharedBytes& bytes) {
  if (!bytes || bytes.size() == 0) return;
  // madvise takes whole pages: from the beginning of the first one.
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t before = reinterpret_cast<std::uintptr_t>(bytes.data()) % page;
  ::madvise(const_cast<std::uint8_t*>(bytes.data() - before), bytes.size() + before, MADV_WILLNEED);
}

}  // namespace etendue
