// Bytes kept alive by everybody who refers to them: an array, or a part of a mapped file. Copies share them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

class SharedBytes {
 public:
  SharedBytes() = default;
  SharedBytes(std::nullptr_t) {}
  SharedBytes(std::vector<std::uint8_t> array) {
    const auto owned = std::make_shared<const std::vector<std::uint8_t>>(std::move(array));
    *this = SharedBytes(owned, std::as_bytes(std::span(*owned)));
  }
  // `bytes` stay where they are as long as `owner` lives.
  SharedBytes(const std::shared_ptr<const void>& owner, std::span<const std::byte> bytes)
      : first_(owner, reinterpret_cast<const std::uint8_t*>(bytes.data())), size_(bytes.size()) {}

  explicit operator bool() const { return first_ != nullptr; }
  const std::uint8_t* data() const { return first_.get(); }
  std::size_t size() const { return size_; }
  const std::uint8_t* begin() const { return data(); }
  const std::uint8_t* end() const { return data() + size_; }
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(data(), size_)); }
  // Shares the owner. offset + count <= size().
  SharedBytes part(std::size_t offset, std::size_t count) const { return {first_, bytes().subspan(offset, count)}; }

 private:
  std::shared_ptr<const std::uint8_t> first_;
  std::size_t size_ = 0;
};

}  // namespace etendue
