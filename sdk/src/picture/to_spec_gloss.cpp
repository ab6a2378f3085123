// Metallic-roughness textures as specular-glossiness ones.
#include "texture_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// Codes: 0-2 specular, 3-5 diffuse. The diffuse colour makes up for the specular one as it is stored.
class StoredSpecGloss {
 public:
  explicit StoredSpecGloss(int bits) : colour_(bits, true), mask_(bits, false) {}
  using Codes = std::array<std::uint16_t, 6>;
  Codes operator()(const ColourPair& pair) const {
    Codes codes{};
    Rgb specular;
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      specular[c] = colour_.linear(codes[channel] = colour_.nearest(pair.f0[c]));
    }
    const SpecularGlossiness wanted = specular_glossiness_of({pair.diffuse, specular, 1});
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      codes[3 + channel] = colour_.nearest(wanted.diffuse[c]);
    }
    return codes;
  }
  ColourPair read(const Codes& codes) const {
    SpecularGlossiness stored;
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      stored.specular[c] = colour_.linear(codes[channel]);
      stored.diffuse[c] = colour_.linear(codes[3 + channel]);
    }
    const TwoColour read = two_colour_of(stored);
    return {read.diffuse, read.f0};
  }
  const CodeTable& colour() const { return colour_; }
  const CodeTable& mask() const { return mask_; }

 private:
  CodeTable colour_, mask_;
};

// What a thread has.
struct Worker {
  struct Found {
    StoredSpecGloss::Codes codes{};
    std::uint64_t count = 0;
  };
  TexelCache<Found> cache;
  DeviationSums sums;
};

}  // namespace

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
  Result<TextureRows> rows = open_rows({pointer_to(material.base_colour_texture), pointer_to(material.metal_rough_texture),
                                        pointer_to(lobe.colour_texture), pointer_to(lobe.factor_texture)},
                                       false);
  if (!rows) return rows.error();
  const double root = model.ior == 0 ? 1 : (model.ior - 1) / (model.ior + 1);
  const auto pair_of = [&](const TexelKey& key) {
    const Rgb colour = rgb_at(key, 4);
    Rgb k;
    for (int c = 0; c < 3; ++c)
      k[c] = std::min(root * root * lobe.colour[c] * colour[c], 1.0) * lobe.factor * static_cast<double>(number_at(key, 7));
    return in_full_reader({product(rgb_at(key, 0), model.base_colour), model.metallic * static_cast<double>(number_at(key, 3)), k});
  };

  if (Status made = make_folder(); !made) return made.error();
  const StoredSpecGloss solve(options_.bits);
  const std::string stem = fmt::format("{}_{}", files_++, plain(material.name));
  const bool has_alpha = rows->has_alpha(0);
  std::vector<TextureOutput> outputs;
  outputs.emplace_back(options_.folder / (stem + "_diffuse.png"), has_alpha ? 4 : 3);
  outputs.emplace_back(options_.folder / (stem + "_specularGlossiness.png"), 4);
  if (Status opened = open_all(outputs, *rows); !opened) return opened.error();
  std::vector<Worker> workers(threads_);
  const auto leaving = [&](Worker& worker) {
    return [&](const TexelKey& key, const Worker::Found& found) { worker.sums.add(solve.read(found.codes), pair_of(key), found.count); };
  };
  TextureRows::Work work;
  work.row = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    const auto key_at = [&](std::uint32_t x) {
      const std::size_t at = std::size_t{4} * x;
      const float *b = row.rgba[0].data() + at, *m = row.rgba[1].data() + at, *k = row.rgba[2].data() + at;
      return TexelKey{word_of(b[0], b[1]), word_of(b[2], m[2]), word_of(k[0], k[1]), word_of(k[2], row.rgba[3][at + 3])};
    };
    const auto put = [&](std::uint32_t x, Worker::Found& value) {
      ++value.count;
      std::uint16_t *diffuse = outputs[0].texel(x, row.y), *gloss = outputs[1].texel(x, row.y);
      const std::size_t at = std::size_t{4} * x;
      std::copy_n(value.codes.begin() + 3, 3, diffuse);
      if (has_alpha) diffuse[3] = solve.mask().nearest(static_cast<double>(row.rgba[0][at + 3]));
      std::copy_n(value.codes.begin(), 3, gloss);
      gloss[3] = solve.mask().nearest(1 - model.roughness * static_cast<double>(row.rgba[1][at + 1]));
    };
    worker.cache.each(
        rows->width(), key_at,
        [&](std::uint32_t, const TexelKey& key) {
          return Worker::Found{solve(pair_of(key)), 0};
        },
        put, leaving(worker));
  };
  work.writers = outputs.size();
  work.write = [&](std::size_t picture, std::uint32_t begin, std::uint32_t count) { return outputs[picture].write(begin, count); };
  if (Status done = rows->for_each(threads_, options_.progress, "textures of " + material.name, work); !done) return done.error();
  MaterialChange change;
  change.texels = std::uint64_t{rows->width()} * rows->height();
  DeviationSums sums;
  for (Worker& worker : workers) {
    worker.cache.empty(leaving(worker));
    sums.add(worker.sums);
  }
  change.core = change.full = sums.deviation();
  if (Status closed = close_all(outputs); !closed) return closed.error();
  report_repeats(material, *rows);

  Texture like;
  for (const auto* texture : {&lobe.factor_texture, &lobe.colour_texture, &before.metal_rough_texture, &before.base_colour_texture})
    if (*texture) like = **texture;
  SpecularGlossiness gloss;
  material.base_colour_texture.reset();
  if (outputs[0].is_constant() && !has_alpha) {
    gloss.diffuse = constant_colour(outputs[0], solve.colour());
    outputs[0].remove();
  } else {
    material.base_colour_texture = new_texture(like, outputs[0].file(), material.name + " diffuse", Encoding::srgb);
  }
  if (outputs[1].is_constant()) {
    gloss.specular = constant_colour(outputs[1], solve.colour());
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
