#include "exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

namespace etendue {
namespace {

constexpr std::uint64_t max_values = std::uint64_t{1} << 31;          // pixels x channels of a part
constexpr std::uint64_t largest_usual_tile = std::uint64_t{1} << 20;  // pixels

// The header's bytes, front to back, little-endian ("OpenEXR File Layout", openexr.com). Once it has been asked for more than there is,
// it stays at the end.
class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> all) : rest_(all) {}

  bool ended() const { return ended_; }
  std::span<const std::byte> take(std::uint64_t count) {
    if (count > rest_.size()) {
      ended_ = true;
      rest_ = {};
      return {};
    }
    const std::span<const std::byte> taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  std::uint64_t number(std::size_t length) {
    std::uint64_t value = 0;
    const std::span<const std::byte> taken = take(length);
    for (std::size_t i = 0; i < taken.size(); ++i) value |= std::to_integer<std::uint64_t>(taken[i]) << (8 * i);
    return value;
  }
  std::int64_t integer() { return static_cast<std::int32_t>(static_cast<std::uint32_t>(number(4))); }
  // Up to a zero byte, which is taken too.
  std::string_view name() {
    const auto end = std::find(rest_.begin(), rest_.end(), std::byte{0});
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    const std::span<const std::byte> taken = take(std::uint64_t{length} + 1);
    return taken.empty() ? std::string_view() : std::string_view(reinterpret_cast<const char*>(taken.data()), length);
  }

 private:
  std::span<const std::byte> rest_;
  bool ended_ = false;
};

// What of a part's header decides how much memory it takes.
struct Part {
  std::int64_t width = 0, height = 0;
  std::uint64_t channels = 0, bytes_per_pixel = 0;
  std::uint64_t tile_width = 0, tile_height = 0;
  std::uint64_t compression = 0;
};

// OpenEXR takes as many bytes as the type has, whatever length the header gives: where the two differ, it would go on elsewhere than we do.
struct FixedLength {
  std::string_view type;
  std::uint64_t bytes;
};
constexpr FixedLength fixed_lengths[] = {{"box2f", 16},
                                         {"box2i", 16},
                                         {"chromaticities", 32},
                                         {"compression", 1},
                                         {"deepImageState", 1},
                                         {"double", 8},
                                         {"envmap", 1},
                                         {"float", 4},
                                         {"int", 4},
                                         {"keycode", 28},
                                         {"lineOrder", 1},
                                         {"m33d", 72},
                                         {"m33f", 36},
                                         {"m44d", 128},
                                         {"m44f", 64},
                                         {"rational", 8},
                                         {"tiledesc", 9},
                                         {"timecode", 8},
                                         {"v2d", 16},
                                         {"v2f", 8},
                                         {"v2i", 8},
                                         {"v3d", 24},
                                         {"v3f", 12},
                                         {"v3i", 12}};

bool length_fits(std::string_view type, std::uint64_t length) {
  return std::all_of(std::begin(fixed_lengths), std::end(fixed_lengths),
                     [&](const FixedLength& one) { return one.type != type || one.bytes == length; });
}

void read_channels(Bytes& bytes, Part& part) {
  constexpr std::uint64_t half_type = 1;
  part.channels = part.bytes_per_pixel = 0;
  while (!bytes.name().empty()) {
    part.bytes_per_pixel += bytes.number(4) == half_type ? 2 : 4;
    ++part.channels;
    bytes.take(12);  // pLinear, three reserved bytes, the two sampling rates
  }
}

// How many bytes of pixels a byte of the file stands for at most.
// Deflate (ZIPS, ZIP, PXR24): a match of 258 bytes takes at least two bits, 258 x 8 / 2 = 1032 (zlib's "Technical Details" has the same
// figure). Below that: none 1, RLE 64, B44A 11; PIZ's Huffman codes repeat 255 values of 16 bits in no less than 10 bits. DWAA and DWAB (8,
// 9): for each 8 x 8 block of 16-bit values at least one for the mean and one that ends it, deflated: 64 x 1032. Later ones are not known
// to this list and not bounded.
std::uint64_t largest_ratio(std::uint64_t compression) {
  constexpr std::uint64_t deflate = 1032;
  if (compression <= 7) return deflate;
  return compression <= 9 ? 64 * deflate : std::numeric_limits<std::uint32_t>::max();
}

std::string fault_of(const Part& part, std::uint64_t file_bytes, std::uint64_t max_pixels) {
  // OpenEXR takes coordinates up to 2^30 in absolute value; 2^31 sides of 2^31 are below 2^62.
  if (part.width < 1 || part.height < 1) return "expected a picture, found an empty data window";
  const auto pixels = static_cast<std::uint64_t>(part.width) * static_cast<std::uint64_t>(part.height);
  if (pixels > max_pixels) return fmt::format("expected at most {} pixels, found {} x {}", max_pixels, part.width, part.height);
  if (part.channels > max_values / pixels)
    return fmt::format("expected at most 2^31 values in all channels, found {} x {} x {}", part.width, part.height, part.channels);
  if (pixels * part.bytes_per_pixel / largest_ratio(part.compression) > file_bytes)
    return fmt::format("{} x {} pixels of {} bytes cannot be in a file of {} bytes", part.width, part.height, part.bytes_per_pixel,
                       file_bytes);
  // Both sides below 2^32: their product fits.
  if (part.tile_width * part.tile_height > std::max(pixels, largest_usual_tile))
    return fmt::format("tiles of {} x {} in a picture of {} x {}", part.tile_width, part.tile_height, part.width, part.height);
  return {};
}

// One header, its end included; what is wrong with it, if anything is. An empty one, which ends those of a file of several parts, leaves
// `any` false.
std::string read_header(Bytes& bytes, Part& part, bool& any) {
  any = false;
  for (std::string_view name = bytes.name(); !name.empty(); name = bytes.name(), any = true) {
    const std::string_view type = bytes.name();
    const std::uint64_t length = bytes.number(4);
    Bytes value(bytes.take(length));
    if (bytes.ended()) break;
    if (!length_fits(type, length)) return fmt::format("an attribute of type {} is {} bytes long", type, length);
    if (name == "dataWindow" && type == "box2i") {
      const std::int64_t min_x = value.integer(), min_y = value.integer(), max_x = value.integer(), max_y = value.integer();
      part.width = max_x - min_x + 1;
      part.height = max_y - min_y + 1;
    } else if (name == "tiles" && type == "tiledesc") {
      part.tile_width = value.number(4);
      part.tile_height = value.number(4);
    } else if (name == "compression" && type == "compression") {
      part.compression = value.number(1);
    } else if (name == "channels" && type == "chlist") {
      read_channels(value, part);
      if (value.ended() || !value.take(1).empty()) return "the list of channels is not as long as its header says";
    }
  }
  return bytes.ended() ? "the file ends within its header" : std::string();
}

}  // namespace

Status check_exr_header(std::span<const std::byte> bytes, std::uint64_t max_pixels, const std::filesystem::path& file) {
  constexpr std::uint64_t magic = 20000630, several_parts = 0x1000;
  const auto unsuitable = [&file](std::string text) {
    return Error{"PICTURE_UNSUITABLE", std::move(text), {file.string(), 0, 0, {}}, {}, {}};
  };
  Bytes rest(bytes);
  if (rest.number(4) != magic) return unsuitable("expected an OpenEXR file, found another");
  const bool several = (rest.number(4) & several_parts) != 0;
  do {
    Part part;
    bool any = false;
    std::string fault = read_header(rest, part, any);
    if (fault.empty() && !any && several) break;
    if (fault.empty()) fault = fault_of(part, bytes.size(), max_pixels);
    if (!fault.empty()) return unsuitable(fault);
  } while (several);
  return Done{};
}

}  // namespace etendue
