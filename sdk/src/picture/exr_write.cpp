#include "etendue/io.h"
#include "etendue/picture_write.h"
#include "exr_channels.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <set>

namespace etendue {
namespace {

// OpenEXR writes here, so that the file itself can appear whole or not at all.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, bytes, size);
    position_ += size;
  }
  // OpenEXR 3.1 says Int64 here and later versions uint64_t; both are this type.
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
};

Error unsuitable(const std::filesystem::path& file, std::string text) {
  return {"PICTURE_UNSUITABLE", std::move(text), {file.string(), 0, 0, {}}, {}, {}};
}

Status add_numbers(const Picture& picture, const std::filesystem::path& file, Imf::Header& header) {
  Imf::addWhiteLuminance(header, 1.0f);
  // Rec.709 primaries and D65, which is OpenEXR's default too: stated, so that no reader has to know that.
  Imf::addChromaticities(header, Imf::Chromaticities{});
  for (const auto& [name, value] : picture.numbers) {
    const auto as_float = static_cast<float>(value);
    if (name == "whiteLuminance") {
      Imf::addWhiteLuminance(header, as_float);
    } else if (name == "expTime") {
      Imf::addExpTime(header, as_float);
    } else if (name == "aperture") {
      Imf::addAperture(header, as_float);
    } else if (name == "isoSpeed") {
      Imf::addIsoSpeed(header, as_float);
    } else if (header.find(name.c_str()) != header.end()) {
      return unsuitable(file, "the number '" + name + "' has the name of an attribute that OpenEXR keeps for itself");
    } else {
      header.insert(name, Imf::DoubleAttribute(value));
    }
  }
  return Done{};
}

Status add_texts(const Picture& picture, const std::filesystem::path& file, Imf::Header& header) {
  for (const auto& [name, text] : picture.texts) {
    if (header.find(name.c_str()) != header.end()) {
      return unsuitable(file, "the text '" + name + "' has the name of another attribute of the picture");
    }
    header.insert(name, Imf::StringAttribute(text));
  }
  return Done{};
}

Status check_layers(const Picture& picture, const std::filesystem::path& file) {
  if (picture.width == 0 || picture.height == 0) return unsuitable(file, "expected a picture with pixels, found none");
  std::set<std::string> names;
  for (const Layer& layer : picture.layers) {
    const std::string shown = "layer '" + layer.name + "'";
    if (layer.channels != 1 && layer.channels != 3) return unsuitable(file, shown + ": expected 1 or 3 channels");
    if (layer.channels == 1 && layer.name.empty()) return unsuitable(file, "a layer of one channel needs a name");
    if (layer.pixels.size() != std::size_t{picture.width} * picture.height * static_cast<std::size_t>(layer.channels)) {
      return unsuitable(file, shown + ": its number of values is not width x height x channels");
    }
    for (int c = 0; c < layer.channels; ++c) {
      if (!names.insert(channel_name(layer.name, layer.channels, c)).second) return unsuitable(file, shown + " is there twice");
    }
  }
  return Done{};
}

// What the header says of the picture, and its channels.
Status add_all(const Picture& picture, const std::filesystem::path& file, Imf::Header& header) {
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const Layer& layer : picture.layers) {
    for (int c = 0; c < layer.channels; ++c)
      header.channels().insert(channel_name(layer.name, layer.channels, c), Imf::Channel(Imf::FLOAT));
  }
  if (Status added = add_numbers(picture, file, header); !added) return added;
  return add_texts(picture, file, header);
}

Imf::FrameBuffer buffer_of(const Picture& picture) {
  Imf::FrameBuffer buffer;
  for (const Layer& layer : picture.layers) {
    const std::size_t stride = sizeof(float) * static_cast<std::size_t>(layer.channels);
    for (int c = 0; c < layer.channels; ++c) {
      // OpenEXR takes one pointer type for reading and writing; nothing is written through it here.
      char* base = reinterpret_cast<char*>(const_cast<float*>(layer.pixels.data() + c));
      buffer.insert(channel_name(layer.name, layer.channels, c), Imf::Slice(Imf::FLOAT, base, stride, stride * picture.width));
    }
  }
  return buffer;
}

}  // namespace

Status write_exr(const Picture& picture, const std::filesystem::path& file) {
  if (Status checked = check_layers(picture, file); !checked) return checked;
  MemoryStream stream;
  try {
    Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
    if (Status added = add_all(picture, file, header); !added) return added;
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(buffer_of(picture));
    output.writePixels(static_cast<int>(picture.height));
  } catch (const std::exception& e) {
    return unsuitable(file, std::string("OpenEXR: ") + e.what());
  }
  return write_file(file, stream.bytes());
}

Status write_exr_levels(std::span<const Picture> levels, const std::filesystem::path& file) {
  if (levels.empty()) return unsuitable(file, "expected at least one level");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (Status checked = check_layers(levels[i], file); !checked) return checked;
    const std::string level = "level " + std::to_string(i) + ": ";
    const auto part = [&](std::uint32_t side) { return std::max(side >> std::min<std::size_t>(i, 31), 1u); };
    const std::uint32_t width = part(levels[0].width), height = part(levels[0].height);
    if (levels[i].width != width || levels[i].height != height)
      return unsuitable(file, level + "expected " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    const auto same = [](const Layer& a, const Layer& b) { return a.name == b.name && a.channels == b.channels; };
    if (!std::equal(levels[i].layers.begin(), levels[i].layers.end(), levels[0].layers.begin(), levels[0].layers.end(), same))
      return unsuitable(file, level + "expected the layers of level 0");
  }
  if (levels.back().width > 1 || levels.back().height > 1) return unsuitable(file, "expected levels down to one pixel");
  MemoryStream stream;
  try {
    Imf::Header header(static_cast<int>(levels[0].width), static_cast<int>(levels[0].height));
    if (Status added = add_all(levels[0], file, header); !added) return added;
    header.setTileDescription({64, 64, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN});
    Imf::TiledOutputFile output(stream, header);
    for (int level = 0; level < output.numLevels(); ++level) {
      output.setFrameBuffer(buffer_of(levels[static_cast<std::size_t>(level)]));
      output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
    }
  } catch (const std::exception& e) {
    return unsuitable(file, std::string("OpenEXR: ") + e.what());
  }
  return write_file(file, stream.bytes());
}

}  // namespace etendue
