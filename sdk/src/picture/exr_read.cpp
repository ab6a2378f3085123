#include "etendue/io.h"
#include "etendue/picture.h"
#include "exr_channels.h"
#include "exr_header.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>

#include <cstring>
#include <exception>
#include <stdexcept>

namespace etendue {
namespace {

constexpr std::uint64_t max_file_bytes = std::uint64_t{1} << 33;

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(const std::vector<std::byte>& bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (count < 0 || size > bytes_.size() - position_) throw std::runtime_error("the file ends too early");
    std::memcpy(to, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("an offset points behind the end of the file");
    position_ = position;
  }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t position_ = 0;
};

Error unsuitable(const std::filesystem::path& file, std::string text) {
  return {"PICTURE_UNSUITABLE", std::move(text), {file.string(), 0, 0, {}}, {}, {}};
}

// The layers that a file's channels make up, without their pixels. Alpha is left out; a lone Y is the picture in grey.
std::vector<Layer> layers_of(const Imf::ChannelList& channels) {
  std::vector<Layer> layers;
  const auto has = [&channels](const std::string& name) { return channels.findChannel(name) != nullptr; };
  if (has("R") && has("G") && has("B")) layers.push_back({"", 3, {}});
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    const std::size_t dot = name.rfind('.');
    const std::string prefix = dot == std::string::npos ? "" : name.substr(0, dot);
    const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
    const bool triple = has(channel_name(prefix, 3, 0)) && has(channel_name(prefix, 3, 1)) && has(channel_name(prefix, 3, 2));
    if (triple && (last == "R" || last == "G" || last == "B")) {
      if (last == "R" && !prefix.empty()) layers.push_back({prefix, 3, {}});
    } else if (last != "A") {
      layers.push_back({name, 1, {}});
    }
  }
  return layers;
}

void read_attributes(const Imf::Header& header, Picture& picture) {
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string name = it.name();
    const Imf::Attribute& attribute = it.attribute();
    if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
      picture.numbers[name] = number->value();
    } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
      if (name != "pixelAspectRatio" && name != "screenWindowWidth") picture.numbers[name] = single->value();
    } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
      if (name != "version" && name != "chunkCount") picture.numbers[name] = whole->value();
    } else if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
      if (name != "type" && name != "name") picture.texts[name] = text->value();
    }
  }
}

// A file's only channel Y becomes the picture's R = G = B.
void spread_grey(Picture& picture) {
  Layer* grey = picture.find("Y");
  if (grey == nullptr || picture.find("") != nullptr) return;
  std::vector<float> rgb;
  rgb.reserve(grey->pixels.size() * 3);
  for (const float y : grey->pixels) rgb.insert(rgb.end(), {y, y, y});
  *grey = {"", 3, std::move(rgb)};
}

Result<Picture> read_pixels(Imf::InputFile& input, const std::filesystem::path& file) {
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  Picture picture;
  picture.width = static_cast<std::uint32_t>(width);
  picture.height = static_cast<std::uint32_t>(height);
  picture.layers = layers_of(header.channels());
  Imf::FrameBuffer buffer;
  for (Layer& layer : picture.layers) {
    layer.pixels.resize(static_cast<std::size_t>(width * height * layer.channels));
    const std::size_t stride = sizeof(float) * static_cast<std::size_t>(layer.channels);
    for (int c = 0; c < layer.channels; ++c) {
      const std::string name = channel_name(layer.name, layer.channels, c);
      const Imf::Channel* channel = header.channels().findChannel(name);
      if (channel->xSampling != 1 || channel->ySampling != 1) return unsuitable(file, "channel '" + name + "' is subsampled");
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, layer.pixels.data() + c, window, stride, stride * picture.width));
    }
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  read_attributes(header, picture);
  spread_grey(picture);
  if (picture.find("") == nullptr) return unsuitable(file, "expected channels R, G, B or Y, found neither");
  return picture;
}

}  // namespace

Result<Picture> read_exr(const std::filesystem::path& file, std::uint64_t max_pixels) {
  const Result<std::vector<std::byte>> bytes = read_file(file, max_file_bytes);
  if (!bytes) return bytes.error();
  const Status header = check_exr_header(*bytes, max_pixels, file);
  if (!header) return header.error();
  try {
    MemoryStream stream(*bytes);
    Imf::InputFile input(stream);
    return read_pixels(input, file);
  } catch (const std::exception& e) {
    return unsuitable(file, std::string("OpenEXR: ") + e.what());
  }
}

}  // namespace etendue
