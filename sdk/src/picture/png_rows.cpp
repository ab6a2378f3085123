#include "png_rows.h"

#include <string>

namespace etendue {
namespace {

Error unwritable(const std::filesystem::path& file, const std::string& reason) {
  return {"FILE_UNWRITABLE", "cannot write \"" + file.string() + "\": " + reason, {file.string(), 0, 0, {}}, {}, {}};
}

}  // namespace

Result<PngRows> PngRows::open(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, int channels, int bits) {
  PngRows rows;
  rows.file_ = file;
  rows.bits_ = bits;
  rows.output_ = OIIO::ImageOutput::create("png");
  if (!rows.output_) return unwritable(file, OIIO::geterror());
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), channels,
                       bits == 8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
  spec["oiio:UnassociatedAlpha"] = 1;
  // Of 9 levels and 5 filters: on the corpus' pictures files are a tenth larger than with 6 and the best filter of each row, in a fifth of
  // the time.
  spec["png:compressionLevel"] = 2;
  spec["png:filter"] = 0x10;  // each sample minus the one of the texel to its left
  if (!rows.output_->open(file.string(), spec)) return unwritable(file, rows.output_->geterror());
  return rows;
}

Status PngRows::write(std::uint32_t rows, std::span<const std::uint16_t> codes) {
  const int end = next_ + static_cast<int>(rows);
  const void* data = codes.data();
  if (bits_ == 8) {
    bytes_.assign(codes.begin(), codes.end());
    data = bytes_.data();
  }
  if (!output_->write_scanlines(next_, end, 0, bits_ == 8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16, data))
    return unwritable(file_, output_->geterror());
  next_ = end;
  return Done{};
}

Status PngRows::close() {
  if (!output_->close()) return unwritable(file_, output_->geterror());
  return Done{};
}

}  // namespace etendue
