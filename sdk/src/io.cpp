#include "etendue/io.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include "whole_file.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason_of(int error_number) { return std::error_code(error_number, std::generic_category()).message(); }

Error unreadable(const fs::path& file, const std::string& reason) {
  return {"FILE_UNREADABLE", fmt::format("cannot read \"{}\": {}", file.string(), reason), {file.string(), 0, 0, ""}, {}, {}};
}
Error unwritable(const fs::path& file, const std::string& reason) {
  return {"FILE_UNWRITABLE", fmt::format("cannot write \"{}\": {}", file.string(), reason), {file.string(), 0, 0, ""}, {}, {}};
}

Result<File> open_to_read(const fs::path& file) {
  std::error_code code;
  if (fs::is_directory(file, code)) return unreadable(file, "it is a folder");
  errno = 0;
  File opened(std::fopen(file.string().c_str(), "rb"));
  if (!opened) return unreadable(file, reason_of(errno));
  return opened;
}

// The first bytes, as many as the file has.
Result<std::vector<std::byte>> read_head(const fs::path& file, std::size_t most) {
  Result<File> opened = open_to_read(file);
  if (!opened) return opened.error();
  std::vector<std::byte> head(most);
  head.resize(std::fread(head.data(), 1, head.size(), opened->get()));
  if (std::ferror(opened->get()) != 0) return unreadable(file, "reading failed");
  return head;
}

// Length of the longest of the format's extensions that ends the file's name, whatever its case; 0 if none does.
std::size_t matching_extension(const FormatInfo& format, const fs::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  std::size_t longest = 0;
  for (const std::string& extension : format.extensions)
    if (name.size() >= extension.size() && name.compare(name.size() - extension.size(), extension.size(), extension) == 0)
      longest = std::max(longest, extension.size());
  return longest;
}

template <class Formats>
Error unknown_format(const char* verb, const fs::path& file, const Formats& formats) {
  std::string known;
  for (const auto& format : formats) {
    const FormatInfo info = format->describe();
    known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", info.name, fmt::join(info.extensions, " "));
  }
  return {"FORMAT_UNKNOWN",
          fmt::format("no format that can be {} fits \"{}\"", verb, file.string()),
          {file.string(), 0, 0, ""},
          known.empty() ? "no formats are registered" : "known: " + known,
          {}};
}

// A name beside `file` that no other call picks; creation is exclusive all the same.
fs::path temporary_beside(const fs::path& file) {
  static std::atomic<std::uint64_t> counter{0};
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  fs::path temporary = file;
  temporary.replace_filename(fmt::format(".{}.{:x}-{:x}.part", file.filename().string(), now, counter++));
  return temporary;
}

// Whether all bytes reached the file, buffers included.
bool write_and_close(File file, std::span<const std::span<const std::byte>> pieces) {
  const bool written = std::all_of(pieces.begin(), pieces.end(), [&](std::span<const std::byte> piece) {
    return std::fwrite(piece.data(), 1, piece.size(), file.get()) == piece.size();
  });
  return std::fclose(file.release()) == 0 && written;
}

}  // namespace

Result<const Importer*> Registry::importer_for(const fs::path& file) const {
  constexpr std::size_t head_bytes = 4096;
  const Result<std::vector<std::byte>> head = read_head(file, head_bytes);
  if (!head) return head.error();
  const Importer* best = nullptr;
  std::pair<int, std::size_t> best_rank{0, 0};  // by content first, then by extension
  for (const auto& importer : importers_) {
    const std::pair<int, std::size_t> rank{importer->sniff(*head), matching_extension(importer->describe(), file)};
    if (rank > best_rank) {
      best = importer.get();
      best_rank = rank;
    }
  }
  if (best == nullptr) return unknown_format("read", file, importers_);
  return best;
}

Result<const Exporter*> Registry::exporter_for(const fs::path& file) const {
  const Exporter* best = nullptr;
  std::size_t longest = 0;
  for (const auto& exporter : exporters_) {
    const std::size_t length = matching_extension(exporter->describe(), file);
    if (length > longest) {
      best = exporter.get();
      longest = length;
    }
  }
  if (best == nullptr) return unknown_format("written", file, exporters_);
  return best;
}

Result<std::vector<std::byte>> read_file(const fs::path& file, std::uint64_t max_bytes) {
  const auto too_large = [&](const std::string& found) {
    return Error{"FILE_TOO_LARGE",
                 fmt::format("expected at most {} bytes in \"{}\", found {}", max_bytes, file.string(), found),
                 {file.string(), 0, 0, ""},
                 {},
                 {}};
  };
  Result<File> opened = open_to_read(file);
  if (!opened) return opened.error();
  std::error_code code;
  const std::uintmax_t size = fs::file_size(file, code);
  const bool size_known = !code;
  if (size_known && size > max_bytes) return too_large(std::to_string(size));
  try {
    std::vector<std::byte> bytes;
    if (size_known) bytes.reserve(static_cast<std::size_t>(size));
    // The size is a hint only: pipes have none, and files grow.
    std::vector<std::byte> piece(std::size_t{1} << 16);
    for (std::size_t count = 0; (count = std::fread(piece.data(), 1, piece.size(), opened->get())) > 0;) {
      if (bytes.size() + count > max_bytes) return too_large("more");
      bytes.insert(bytes.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(count));
    }
    if (std::ferror(opened->get()) != 0) return unreadable(file, "reading failed");
    return bytes;
  } catch (const std::bad_alloc&) {
    return too_large("more than fits into memory");
  }
}

Status write_file(const fs::path& file, std::span<const std::byte> bytes) { return write_file(file, std::span(&bytes, 1)); }

Status write_file(const fs::path& file, std::span<const std::span<const std::byte>> pieces) {
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  errno = 0;
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    // Devices and pipes are written to, never replaced; a folder cannot be opened.
    File device(std::fopen(file.string().c_str(), "wb"));
    if (!device) return unwritable(file, reason_of(errno));
    if (!write_and_close(std::move(device), pieces)) return unwritable(file, reason_of(errno));
    return Done{};
  }
  const fs::path temporary = temporary_beside(file);
  File opened(std::fopen(temporary.string().c_str(), "wbx"));
  if (!opened) return unwritable(file, reason_of(errno));
  if (!write_and_close(std::move(opened), pieces)) {
    const Error error = unwritable(file, reason_of(errno));
    fs::remove(temporary, code);
    return error;
  }
  fs::rename(temporary, file, code);
  if (code) {
    const Error error = unwritable(file, code.message());
    fs::remove(temporary, code);
    return error;
  }
  return Done{};
}

}  // namespace etendue
