#include "texture_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <thread>

#include "png_rows.h"
#include "reader_weight.h"
#include "stored_metal_rough.h"
#include "texel_cache.h"
#include "texture_rows.h"

namespace etendue {
namespace {

constexpr double core_f0 = 0.04;

const Texture* pointer_to(const std::optional<Texture>& texture) { return texture ? &*texture : nullptr; }

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }
Rgb product(const Rgb& a, const Rgb& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Rgb rgb_at(const TexelKey& key, std::size_t first) { return {key[first], key[first + 1], key[first + 2]}; }

// A picture that is being made: its rows, its file, and whether any channel differs between texels.
class Output {
 public:
  Output(std::filesystem::path file, int channels) : file_(std::move(file)), channels_(static_cast<std::size_t>(channels)) {}

  Status open(std::uint32_t width, std::uint32_t height, int bits) {
    Result<PngRows> png = PngRows::open(file_, width, height, static_cast<int>(channels_), bits);
    if (!png) return png.error();
    png_ = std::move(*png);
    width_ = width;
    codes_.resize(std::size_t{width} * TextureRows::band_rows * channels_);
    return Done{};
  }
  std::uint16_t* texel(std::uint32_t row, std::uint32_t x) { return codes_.data() + (std::size_t{row} * width_ + x) * channels_; }
  Status write(std::uint32_t rows) {
    const std::size_t count = std::size_t{rows} * width_ * channels_;
    for (std::size_t i = 0; i < count; ++i) {
      lowest_[i % channels_] = std::min(lowest_[i % channels_], codes_[i]);
      highest_[i % channels_] = std::max(highest_[i % channels_], codes_[i]);
    }
    return png_->write(rows, std::span(codes_).first(count));
  }
  Status close() { return png_->close(); }
  // The code of a channel that is the same in all texels.
  std::optional<std::uint16_t> constant(std::size_t channel) const {
    return lowest_[channel] == highest_[channel] ? std::optional(lowest_[channel]) : std::nullopt;
  }
  bool is_constant() const {
    for (std::size_t c = 0; c < channels_; ++c)
      if (!constant(c)) return false;
    return true;
  }
  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  const std::filesystem::path& file() const { return file_; }
  std::size_t channels() const { return channels_; }

 private:
  std::filesystem::path file_;
  std::size_t channels_;
  std::optional<PngRows> png_;
  std::uint32_t width_ = 0;
  std::vector<std::uint16_t> codes_;
  std::array<std::uint16_t, 4> lowest_{0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF}, highest_{0, 0, 0, 0};
};

Status write_all(std::vector<Output>& outputs, std::uint32_t rows, bool at_once) {
  std::vector<Status> written(outputs.size(), Status(Done{}));
  std::vector<std::thread> writers;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto one = [&, i] { written[i] = outputs[i].write(rows); };
    if (at_once)
      writers.emplace_back(one);
    else
      one();
  }
  for (std::thread& writer : writers) writer.join();
  for (const Status& status : written)
    if (!status) return status;
  return Done{};
}

// What a thread gathers.
struct Worker {
  TexelCache cache;
  DeviationSums core, full;
  Rgb largest_k{0, 0, 0};

  auto leaving() {
    return [this](const TexelValue& value, std::uint64_t count) {
      core.add(value.core, value.wanted, count);
      full.add(value.full, value.wanted, count);
    };
  }
};

// Some texels that stand for all: one in each cell of a grid, at a place in it that no pattern of the picture follows.
class Samples {
 public:
  Samples(std::uint32_t width, std::uint32_t height)
      : cell_(static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(width) * height / 2048)))),
        columns_((width + cell_ - 1) / cell_),
        pairs_(std::size_t{columns_} * ((height + cell_ - 1) / cell_)),
        width_(width),
        height_(height) {}
  // The sampled texels of a row. Each has a place of its own, so that rows can be given from several threads.
  template <class PairAt>
  void add_row(std::uint32_t y, PairAt pair_at) {
    const std::uint32_t row = y / cell_;
    if (place(row, columns_, std::min(cell_, height_ - row * cell_)) != y % cell_) return;
    for (std::uint32_t column = 0; column < columns_; ++column)
      pairs_[std::size_t{row} * columns_ + column] = pair_at(column * cell_ + place(row, column, std::min(cell_, width_ - column * cell_)));
  }
  std::span<const ColourPair> pairs() const { return pairs_; }

 private:
  // The high half of a product of Knuth's multiplicative hashing.
  static std::uint32_t place(std::uint32_t row, std::uint32_t column, std::uint32_t size) {
    const std::uint64_t hash = ((std::uint64_t{row} << 32 | column) + 1) * 0x9e3779b97f4a7c15u;
    return static_cast<std::uint32_t>((hash >> 40) % size);
  }
  std::uint32_t cell_, columns_;
  std::vector<ColourPair> pairs_;
  std::uint32_t width_, height_;
};

// Codes: 0-2 specular, 3-5 diffuse. The diffuse colour makes up for the specular one as it is stored.
class StoredSpecGloss {
 public:
  explicit StoredSpecGloss(int bits) : colour_(bits, true), mask_(bits, false) {}
  TexelValue operator()(const ColourPair& pair) const {
    TexelValue out;
    SpecularGlossiness stored;
    for (int c = 0; c < 3; ++c) stored.specular[c] = colour_.linear(out.codes[static_cast<std::size_t>(c)] = colour_.nearest(pair.f0[c]));
    const SpecularGlossiness wanted = specular_glossiness_of({pair.diffuse, stored.specular, 1});
    for (int c = 0; c < 3; ++c)
      stored.diffuse[c] = colour_.linear(out.codes[static_cast<std::size_t>(3 + c)] = colour_.nearest(wanted.diffuse[c]));
    const TwoColour read = two_colour_of(stored);
    out.wanted = pair;
    out.core = out.full = {read.diffuse, read.f0};
    return out;
  }
  const CodeTable& colour() const { return colour_; }
  const CodeTable& mask() const { return mask_; }

 private:
  CodeTable colour_, mask_;
};

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

std::string plain(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name;
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

Result<MaterialChange> TextureConversion::to_metal_rough(Material& material) {
  if (const Converted* done = known(material)) {
    const Material& after = done->after;
    material.model = after.model;
    material.base_colour_texture = after.base_colour_texture;
    material.metal_rough_texture = after.metal_rough_texture;
    material.specular_gloss_texture.reset();
    material.lobes.specular = after.lobes.specular;
    material.fallback.reset();
    return done->change;
  }
  const Material before = material;
  const auto model = std::get<SpecularGlossiness>(material.model);
  const bool has_specular = material.specular_gloss_texture.has_value();
  Result<TextureRows> rows =
      TextureRows::open(scene_, {pointer_to(material.base_colour_texture), pointer_to(material.specular_gloss_texture)});
  if (!rows) return rows.error();
  out_.images_decoded += rows->images_decoded();
  const auto pair_of = [&](const TexelKey& key) {
    const TwoColour two =
        two_colour_of(SpecularGlossiness{product(rgb_at(key, 0), model.diffuse), product(rgb_at(key, 3), model.specular), 1});
    return ColourPair{two.diffuse, two.f0};
  };
  const auto key_at = [](const TextureRows::Row& row, std::size_t x) {
    const float *d = row.rgba[0].data() + 4 * x, *s = row.rgba[1].data() + 4 * x;
    return TexelKey{d[0], d[1], d[2], s[0], s[1], s[2], 0, 0};
  };

  // First what all texels have in common: the largest f0 of the dielectric part, which the stored ones are shares of, and samples for how
  // much each reader counts. That is not known yet: the largest f0 is that of a weight which most materials stay below, since the more the
  // full reader counts, the more of it is asked for.
  const bool for_all = options_.readers == Readers::all;
  const double survey_weight = !for_all ? weight_for_core : options_.bits == 8 ? 1e3 : 1e5;
  std::vector<Worker> workers(threads_);
  Samples samples(rows->width(), rows->height());
  Status done = rows->for_each(
      threads_, options_.progress, "survey of " + material.name,
      [&](const TextureRows::Row& row) {
        Worker& worker = workers[row.thread];
        samples.add_row(row.y, [&](std::uint32_t x) { return pair_of(key_at(row, x)); });
        for (std::uint32_t x = 0; x < rows->width(); ++x) {
          worker.cache.at(
              key_at(row, x),
              [&](const TexelKey& key) {
                const ColourPair pair = pair_of(key);
                const MetalRoughColours colours = metal_rough_of(pair, survey_weight);
                for (int c = 0; c < 3 && colours.metal < 1; ++c)
                  worker.largest_k[c] = std::max(worker.largest_k[c], colours.dielectric_f0[c]);
                TexelValue value;
                value.wanted = pair;
                value.core = in_core_reader({pair.diffuse, 0, {}});
                return value;
              },
              worker.leaving());
        }
      },
      [](std::uint32_t) { return Status(Done{}); });
  if (!done) return done.error();
  Rgb largest_k{0, 0, 0};
  DeviationSums diffuse_alone;
  for (Worker& worker : workers) {
    worker.cache.empty(worker.leaving());
    for (int c = 0; c < 3; ++c) largest_k[c] = std::max(largest_k[c], worker.largest_k[c]);
    diffuse_alone.add(worker.core);
  }
  StoredMetalRough solve(options_.bits, largest_k);
  if (for_all) solve.fit(samples.pairs());

  MaterialChange change;
  change.texels = std::uint64_t{rows->width()} * rows->height();
  material.fallback.reset();
  material.specular_gloss_texture.reset();
  const auto specular_lobe = [&](const Rgb& f0, std::optional<Texture> texture) {
    const bool plain_f0 = f0 == Rgb{core_f0, core_f0, core_f0} && !texture;
    material.lobes.specular = plain_f0 ? std::nullopt : std::optional(Specular{1, f0 * (1 / core_f0), {}, std::move(texture)});
  };
  // One specular colour for all texels, and no metal would bring a core-only reader closer: the diffuse picture stays as it is, its factor
  // takes 1 - max(specular), and a full reader loses nothing.
  DeviationSums alone, best;
  for (const ColourPair& pair : samples.pairs()) {
    alone.add(in_core_reader({pair.diffuse, 0, {}}), pair);
    best.add(in_core_reader(metal_rough_of(pair, solve.weight())), pair);
  }
  if (!has_specular && rms_of(alone.deviation()) <= 1.005 * rms_of(best.deviation()) + 1e-4) {
    material.model = MetalRough{model.diffuse * (1 - std::clamp(largest(model.specular), 0.0, 1.0)), 0, 1 - model.glossiness, 1.5};
    specular_lobe(model.specular, {});
    change.core = diffuse_alone.deviation();
    done_.push_back({before, material, change});
    return change;
  }

  const CodeTable& mask = solve.mask();
  if (Status made = make_folder(); !made) return made.error();
  const std::string stem = fmt::format("{}_{}", files_++, plain(material.name));
  const bool has_alpha = rows->has_alpha(0);
  std::vector<Output> outputs;
  outputs.emplace_back(options_.folder / (stem + "_baseColor.png"), has_alpha ? 4 : 3);
  outputs.emplace_back(options_.folder / (stem + "_metallicRoughness.png"), 3);
  outputs.emplace_back(options_.folder / (stem + "_specularColor.png"), 3);
  for (Output& output : outputs)
    if (Status opened = output.open(rows->width(), rows->height(), options_.bits); !opened) return opened.error();

  workers = std::vector<Worker>(threads_);
  done = rows->for_each(
      threads_, options_.progress, "textures of " + material.name,
      [&](const TextureRows::Row& row) {
        Worker& worker = workers[row.thread];
        for (std::uint32_t x = 0; x < rows->width(); ++x) {
          const TexelValue& value = worker.cache.at(
              key_at(row, x), [&](const TexelKey& key) { return solve(pair_of(key)); }, worker.leaving());
          std::uint16_t *base = outputs[0].texel(row.band, x), *metal_rough = outputs[1].texel(row.band, x);
          std::copy_n(value.codes.begin(), 3, base);
          if (has_alpha) base[3] = mask.nearest(static_cast<double>(row.rgba[0][4 * x + 3]));
          metal_rough[0] = static_cast<std::uint16_t>(mask.top());  // occlusion, for those who look for it there: none
          metal_rough[1] = mask.nearest(1 - model.glossiness * static_cast<double>(row.rgba[1][4 * x + 3]));
          metal_rough[2] = value.codes[3];
          std::copy_n(value.codes.begin() + 4, 3, outputs[2].texel(row.band, x));
        }
      },
      [&](std::uint32_t count) { return write_all(outputs, count, threads_ > 1); });
  if (!done) return done.error();
  DeviationSums core, full;
  for (Worker& worker : workers) {
    worker.cache.empty(worker.leaving());
    core.add(worker.core);
    full.add(worker.full);
  }
  for (Output& output : outputs)
    if (Status closed = output.close(); !closed) return closed.error();
  change.core = core.deviation();
  change.full = full.deviation();

  // What is the same everywhere needs no picture.
  const Texture like = before.base_colour_texture ? *before.base_colour_texture : *before.specular_gloss_texture;
  if (!rows->repeats())
    out_.losses.add(fmt::format("material '{}': its two textures are repeated or transformed differently", material.name),
                    "put together as they lie within 0..1 of the first one, and repeated as that one is");
  MetalRough metal_rough;
  const auto colour_if_constant = [&](const Output& output) {
    Rgb colour;
    for (int c = 0; c < 3; ++c) colour[c] = solve.colour().linear(*output.constant(static_cast<std::size_t>(c)));
    return colour;
  };
  material.base_colour_texture.reset();
  if (outputs[0].is_constant() && !has_alpha) {
    metal_rough.base_colour = colour_if_constant(outputs[0]);
    outputs[0].remove();
  } else {
    material.base_colour_texture = new_texture(like, outputs[0].file(), material.name + " base colour", Encoding::srgb);
  }
  if (outputs[1].is_constant()) {
    metal_rough.roughness = has_specular ? mask.linear(*outputs[1].constant(1)) : 1 - model.glossiness;
    metal_rough.metallic = mask.linear(*outputs[1].constant(2));
    outputs[1].remove();
  } else {
    material.metal_rough_texture = new_texture(like, outputs[1].file(), material.name + " metal and roughness", Encoding::linear);
  }
  if (outputs[2].is_constant()) {
    specular_lobe(product(largest_k, colour_if_constant(outputs[2])), {});
    outputs[2].remove();
  } else {
    specular_lobe(largest_k, new_texture(like, outputs[2].file(), material.name + " specular colour", Encoding::srgb));
  }
  material.model = metal_rough;
  done_.push_back({before, material, change});
  return change;
}

Result<MaterialChange> TextureConversion::to_spec_gloss(Material& material) {
  const Fallback fallback{std::get<MetalRough>(material.model), material.base_colour_texture, material.metal_rough_texture};
  if (const Converted* done = known(material)) {
    const Material& after = done->after;
    material.model = after.model;
    material.base_colour_texture = after.base_colour_texture;
    material.specular_gloss_texture = after.specular_gloss_texture;
    material.metal_rough_texture.reset();
    material.lobes.specular.reset();
    material.fallback = fallback;
    return done->change;
  }
  const Material before = material;
  const MetalRough model = fallback.model;
  const Specular lobe = material.lobes.specular.value_or(Specular{});
  Result<TextureRows> rows = TextureRows::open(scene_, {pointer_to(material.base_colour_texture), pointer_to(material.metal_rough_texture),
                                                        pointer_to(lobe.colour_texture), pointer_to(lobe.factor_texture)});
  if (!rows) return rows.error();
  out_.images_decoded += rows->images_decoded();
  const double root = model.ior == 0 ? 1 : (model.ior - 1) / (model.ior + 1);
  const auto pair_of = [&](const TexelKey& key) {
    Rgb k;
    for (int c = 0; c < 3; ++c)
      k[c] = std::min(root * root * lobe.colour[c] * static_cast<double>(key[static_cast<std::size_t>(4 + c)]), 1.0) * lobe.factor *
             static_cast<double>(key[7]);
    return in_full_reader({product(rgb_at(key, 0), model.base_colour), model.metallic * static_cast<double>(key[3]), k});
  };

  if (Status made = make_folder(); !made) return made.error();
  const StoredSpecGloss solve(options_.bits);
  const std::string stem = fmt::format("{}_{}", files_++, plain(material.name));
  const bool has_alpha = rows->has_alpha(0);
  std::vector<Output> outputs;
  outputs.emplace_back(options_.folder / (stem + "_diffuse.png"), has_alpha ? 4 : 3);
  outputs.emplace_back(options_.folder / (stem + "_specularGlossiness.png"), 4);
  for (Output& output : outputs)
    if (Status opened = output.open(rows->width(), rows->height(), options_.bits); !opened) return opened.error();
  std::vector<Worker> workers(threads_);
  const Status done = rows->for_each(
      threads_, options_.progress, "textures of " + material.name,
      [&](const TextureRows::Row& row) {
        Worker& worker = workers[row.thread];
        for (std::uint32_t x = 0; x < rows->width(); ++x) {
          const float *b = row.rgba[0].data() + 4 * x, *m = row.rgba[1].data() + 4 * x, *k = row.rgba[2].data() + 4 * x;
          const TexelKey key{b[0], b[1], b[2], m[2], k[0], k[1], k[2], row.rgba[3][4 * x + 3]};
          const TexelValue& value = worker.cache.at(
              key, [&](const TexelKey& at) { return solve(pair_of(at)); }, worker.leaving());
          std::uint16_t *diffuse = outputs[0].texel(row.band, x), *gloss = outputs[1].texel(row.band, x);
          std::copy_n(value.codes.begin() + 3, 3, diffuse);
          if (has_alpha) diffuse[3] = solve.mask().nearest(static_cast<double>(b[3]));
          std::copy_n(value.codes.begin(), 3, gloss);
          gloss[3] = solve.mask().nearest(1 - model.roughness * static_cast<double>(m[1]));
        }
      },
      [&](std::uint32_t count) { return write_all(outputs, count, threads_ > 1); });
  if (!done) return done.error();
  MaterialChange change;
  change.texels = std::uint64_t{rows->width()} * rows->height();
  DeviationSums sums;
  for (Worker& worker : workers) {
    worker.cache.empty(worker.leaving());
    sums.add(worker.full);
  }
  change.core = change.full = sums.deviation();
  for (Output& output : outputs)
    if (Status closed = output.close(); !closed) return closed.error();
  if (!rows->repeats())
    out_.losses.add(fmt::format("material '{}': its textures are repeated or transformed differently", material.name),
                    "put together as they lie within 0..1 of the first one, and repeated as that one is");

  Texture like;
  for (const auto* texture : {&lobe.factor_texture, &lobe.colour_texture, &before.metal_rough_texture, &before.base_colour_texture})
    if (*texture) like = **texture;
  SpecularGlossiness gloss;
  const auto colour_if_constant = [&](const Output& output) {
    Rgb colour;
    for (int c = 0; c < 3; ++c) colour[c] = solve.colour().linear(*output.constant(static_cast<std::size_t>(c)));
    return colour;
  };
  material.base_colour_texture.reset();
  if (outputs[0].is_constant() && !has_alpha) {
    gloss.diffuse = colour_if_constant(outputs[0]);
    outputs[0].remove();
  } else {
    material.base_colour_texture = new_texture(like, outputs[0].file(), material.name + " diffuse", Encoding::srgb);
  }
  if (outputs[1].is_constant()) {
    gloss.specular = colour_if_constant(outputs[1]);
    gloss.glossiness = solve.mask().linear(*outputs[1].constant(3));
    outputs[1].remove();
  } else {
    material.specular_gloss_texture = new_texture(like, outputs[1].file(), material.name + " specular and glossiness", Encoding::srgb);
  }
  material.metal_rough_texture.reset();
  material.lobes.specular.reset();
  material.model = gloss;
  material.fallback = fallback;
  done_.push_back({before, material, change});
  return change;
}

}  // namespace etendue
