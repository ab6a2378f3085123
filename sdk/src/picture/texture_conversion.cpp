#include "texture_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace etendue {
namespace {

// Of each picture that is read again: of 4 channels of 8 bits 5792 x 5792.
constexpr std::uint64_t most_kept_bytes = std::uint64_t{1} << 27;

bool same_model(const SurfaceModel& a, const SurfaceModel& b) {
  if (a.index() != b.index()) return false;
  if (const auto* x = std::get_if<SpecularGlossiness>(&a)) {
    const auto& y = std::get<SpecularGlossiness>(b);
    return x->diffuse == y.diffuse && x->specular == y.specular && x->glossiness == y.glossiness;
  }
  const auto &x = std::get<MetalRough>(a), &y = std::get<MetalRough>(b);
  return x.base_colour == y.base_colour && x.metallic == y.metallic && x.roughness == y.roughness && x.ior == y.ior;
}

bool same_specular(const std::optional<Specular>& a, const std::optional<Specular>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->factor == b->factor && a->colour == b->colour && a->factor_texture == b->factor_texture &&
         a->colour_texture == b->colour_texture;
}

}  // namespace

Rgb dielectric_f0_of(const Material& material, const MetalRough& model) {
  const double root = model.ior == 0 ? 1 : (model.ior - 1) / (model.ior + 1);
  const Specular specular = material.lobes.specular.value_or(Specular{});
  Rgb f0;
  for (int c = 0; c < 3; ++c) f0[c] = std::min(root * root * specular.colour[c], 1.0) * specular.factor;
  return f0;
}

TextureConversion::TextureConversion(Scene& scene, const ConversionOptions& options, MaterialConversion& out)
    : scene_(scene),
      options_(options),
      out_(out),
      threads_(options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency())) {}

const TextureConversion::Converted* TextureConversion::known(const Material& m) const {
  const auto found = std::find_if(done_.begin(), done_.end(), [&](const Converted& done) {
    const Material& b = done.before;
    return same_model(b.model, m.model) && b.base_colour_texture == m.base_colour_texture &&
           b.metal_rough_texture == m.metal_rough_texture && b.specular_gloss_texture == m.specular_gloss_texture &&
           same_specular(b.lobes.specular, m.lobes.specular);
  });
  return found == done_.end() ? nullptr : &*found;
}

Status TextureConversion::make_folder() const {
  std::error_code failure;
  std::filesystem::create_directories(options_.folder, failure);
  if (failure)
    return Error{"FILE_UNWRITABLE", "cannot make the folder: " + failure.message(), {options_.folder.string(), 0, 0, {}}, {}, {}};
  return Done{};
}

std::optional<Texture> TextureConversion::new_texture(const Texture& like, const std::filesystem::path& file, const std::string& name,
                                                      Encoding encoding) {
  Texture texture = like;
  texture.image = static_cast<std::uint32_t>(scene_.images.size());
  texture.encoding = encoding;
  scene_.images.push_back({file.string(), {}, "image/png", name});
  ++out_.images_written;
  return texture;
}

Result<TextureRows> TextureConversion::open_rows(const TextureRows::Textures& textures, bool again) {
  TextureSource::Settings settings;
  settings.scratch = options_.folder;
  if (again) settings.kept_bytes = most_kept_bytes;
  Result<TextureRows> rows = TextureRows::open(scene_, textures, settings);
  if (rows) out_.images_decoded += rows->images_decoded();
  return rows;
}

// Of a picture that is constant.
Rgb TextureConversion::constant_colour(const TextureOutput& output, const CodeTable& table) {
  Rgb colour;
  for (int c = 0; c < 3; ++c) colour[c] = table.linear(*output.constant(static_cast<std::size_t>(c)));
  return colour;
}

Status TextureConversion::open_all(std::vector<TextureOutput>& outputs, const TextureRows& rows) const {
  for (TextureOutput& output : outputs)
    if (Status opened = output.open(rows.width(), rows.height(), options_.bits); !opened) return opened;
  return Done{};
}

Status TextureConversion::close_all(std::vector<TextureOutput>& outputs) {
  for (TextureOutput& output : outputs)
    if (Status closed = output.close(); !closed) return closed;
  return Done{};
}

void TextureConversion::report_repeats(const Material& material, const TextureRows& rows) {
  if (rows.repeats()) return;
  out_.losses.add(fmt::format("material '{}': its textures are repeated or transformed differently", material.name),
                  "put together as they lie within 0..1 of the first one, and repeated as that one is");
}

}  // namespace etendue
