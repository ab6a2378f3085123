#include "etendue/texture_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "image_rows.h"
#include "png_rows.h"
#include "srgb_encoder.h"
#include "texture_output.h"

namespace etendue {
namespace {

constexpr std::uint32_t band_rows = 64;
// Matrices in float miss white by some 1e-7.
constexpr float rounding = 1e-5F;

bool is_colour(std::string_view role) {
  return role == "base_colour" || role == "fallback.base_colour" || role == "specular_gloss" || role == "emissive" ||
         role.ends_with(".colour");
}

// Texels that 0 to 1 do not hold.
struct Beyond {
  std::uint64_t texels = 0;
  float most = 0;  // by so much at most

  void add(const Vec3f& colour) {
    float by = 0;
    for (int c = 0; c < 3; ++c) by = std::max({by, -colour[c], colour[c] - 1});
    if (by <= rounding) return;
    ++texels;
    most = std::max(most, by);
  }
};

class ExrRows {
 public:
  static Result<ExrRows> open(const std::filesystem::path& file, const ImageRows& like, int channels) {
    ExrRows rows;
    rows.file_ = file;
    rows.output_ = OIIO::ImageOutput::create("openexr");
    if (!rows.output_) return rows.unwritable(OIIO::geterror());
    const OIIO::ImageSpec spec(static_cast<int>(like.width()), static_cast<int>(like.height()), channels, OIIO::TypeDesc::FLOAT);
    if (!rows.output_->open(file.string(), spec)) return rows.unwritable(rows.output_->geterror());
    return rows;
  }
  Status write(std::uint32_t rows, std::span<const float> numbers) {
    const int end = next_ + static_cast<int>(rows);
    if (!output_->write_scanlines(next_, end, 0, OIIO::TypeDesc::FLOAT, numbers.data())) return unwritable(output_->geterror());
    next_ = end;
    return Done{};
  }
  Status close() {
    if (!output_->close()) return unwritable(output_->geterror());
    return Done{};
  }

 private:
  Error unwritable(const std::string& reason) const {
    return {"FILE_UNWRITABLE", "cannot write \"" + file_.string() + "\": " + reason, {file_.string(), 0, 0, {}}, {}, {}};
  }

  std::filesystem::path file_;
  std::unique_ptr<OIIO::ImageOutput> output_;
  int next_ = 0;
};

class Converter {
 public:
  Converter(Scene& scene, const ColourStep& step, const TextureSpaceOptions& options) : scene_(scene), step_(step), options_(options) {}

  Result<LossReport> run() {
    std::vector<Texture*> textures;
    for (Material& material : scene_.materials)
      for_each_texture(material, [&](const char* role, Texture& texture) {
        if (is_colour(role)) textures.push_back(&texture);
      });
    for (Light& light : scene_.lights)
      if (light.emission.texture) textures.push_back(&*light.emission.texture);
    for (const Texture* texture : textures) made_.emplace(texture->image, std::nullopt);
    for (auto& [image, made] : made_)
      if (Status written = write(image, made); !written) return written.error();
    for (Texture* texture : textures) {
      const Made& made = *made_.at(texture->image);
      texture->image = made.image;
      texture->encoding = made.encoding;
    }
    return std::move(losses_);
  }

 private:
  struct Made {
    std::uint32_t image;
    Encoding encoding;
  };

  Status write(std::uint32_t index, std::optional<Made>& made) {
    const ImageRef before = scene_.images[index];
    Result<ImageRows> rows = ImageRows::open(before, Encoding::linear, options_.max_pixels);
    if (!rows) return rows.error();
    std::error_code failure;
    std::filesystem::create_directories(options_.folder, failure);
    if (failure)
      return Error{"FILE_UNWRITABLE", "cannot make the folder: " + failure.message(), {options_.folder.string(), 0, 0, {}}, {}, {}};
    const bool whole = rows->code_type() != OIIO::TypeDesc::FLOAT;
    const std::string name = before.name.empty() ? std::filesystem::path(before.file).stem().string() : before.name;
    const auto file = options_.folder / fmt::format("{}_{}.{}", index, plain(name).substr(0, 60), whole ? "png" : "exr");
    if (Status written = whole ? write_png(*rows, file, name) : write_exr(*rows, file); !written) {
      std::filesystem::remove(file, failure);
      return written;
    }
    made = Made{static_cast<std::uint32_t>(scene_.images.size()), whole ? Encoding::srgb : Encoding::linear};
    scene_.images.push_back({file.string(), {}, whole ? "image/png" : "image/x-exr", name});
    ++done_;
    return Done{};
  }

  // Bands of linear Rec.709 from the top down: use(rows, colours, rgba as read).
  template <class Use>
  Status for_each_band(ImageRows& rows, Use use) {
    const std::size_t width = rows.width();
    std::vector<float> rgba;
    std::vector<Vec3f> colours;
    while (rows.next() < rows.height()) {
      const std::uint32_t count = std::min(band_rows, rows.height() - rows.next());
      rgba.resize(count * width * 4);
      colours.resize(count * width);
      if (Status read = rows.read(count, rgba); !read) return read;
      for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
      step_.apply(colours);
      if (Status used = use(count, std::span<const Vec3f>(colours), std::span<const float>(rgba)); !used) return used;
      const double done = static_cast<double>(done_) + static_cast<double>(rows.next()) / rows.height();
      if (options_.progress != nullptr && !options_.progress->report("colours of textures", done / static_cast<double>(made_.size())))
        return Error{"CANCELLED", "cancelled", {}, {}, {}};
    }
    return Done{};
  }

  Status write_png(ImageRows& rows, const std::filesystem::path& file, const std::string& name) {
    const std::size_t channels = rows.has_alpha() ? 4 : 3;
    Result<PngRows> png = PngRows::open(file, rows.width(), rows.height(), static_cast<int>(channels), options_.bits);
    if (!png) return png.error();
    const double last = options_.bits == 8 ? 255 : 65535;
    const auto code = [last](double value) { return static_cast<std::uint16_t>(std::lround(value * last)); };
    Beyond beyond;
    std::vector<std::uint16_t> codes;
    Status written = for_each_band(rows, [&](std::uint32_t count, std::span<const Vec3f> colours, std::span<const float> rgba) {
      codes.resize(colours.size() * channels);
      for (std::size_t i = 0; i < colours.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
          codes[i * channels + c] = code(SrgbEncoder::get()(static_cast<double>(colours[i][static_cast<int>(c)])));
        if (channels == 4) codes[i * 4 + 3] = code(static_cast<double>(rgba[4 * i + 3]));
        beyond.add(colours[i]);
      }
      return png->write(count, codes);
    });
    if (!written) return written;
    if (beyond.texels > 0)
      losses_.add(fmt::format("image '{}': colours that sRGB does not hold", name),
                  fmt::format("{} of {} texels are held to 0..1 in linear Rec.709, of which they are up to {:.3g} outside", beyond.texels,
                              std::uint64_t{rows.width()} * rows.height(), beyond.most));
    return png->close();
  }

  Status write_exr(ImageRows& rows, const std::filesystem::path& file) {
    const std::size_t channels = rows.has_alpha() ? 4 : 3;
    Result<ExrRows> exr = ExrRows::open(file, rows, static_cast<int>(channels));
    if (!exr) return exr.error();
    std::vector<float> numbers;
    Status written = for_each_band(rows, [&](std::uint32_t count, std::span<const Vec3f> colours, std::span<const float> rgba) {
      numbers.resize(colours.size() * channels);
      for (std::size_t i = 0; i < colours.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) numbers[i * channels + c] = colours[i][static_cast<int>(c)];
        if (channels == 4) numbers[i * 4 + 3] = rgba[4 * i + 3];
      }
      return exr->write(count, numbers);
    });
    return written ? exr->close() : written;
  }

  Scene& scene_;
  const ColourStep& step_;
  const TextureSpaceOptions& options_;
  LossReport losses_;
  std::map<std::uint32_t, std::optional<Made>> made_;  // by the image that is read
  std::size_t done_ = 0;
};

}  // namespace

Result<LossReport> convert_colour_textures(Scene& scene, const ColourStep& to_linear_rec709, const TextureSpaceOptions& options) {
  return Converter(scene, to_linear_rec709, options).run();
}

}  // namespace etendue
