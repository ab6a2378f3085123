// Specular-glossiness textures as metallic-roughness ones.
#include "texture_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "best_masks.h"
#include "metal_mask_rows.h"
#include "reader_weight.h"
#include "stored_metal_rough.h"
#include "texel_samples.h"

namespace etendue {
namespace {

// A picture without specular-glossiness texture keeps its diffuse one where that is so close to the best, in rms.
constexpr double close_share = 1.005, close_rms = 1e-4;

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }
using Entries = std::span<TexelCache::Entry* const>;

// A texel of both textures.
TexelKey key_at(const TextureRows::Row& row, std::size_t x) {
  const float *d = row.rgba[0].data() + 4 * x, *s = row.rgba[1].data() + 4 * x;
  return {d[0], d[1], d[2], s[0], s[1], s[2], 0, 0};
}

struct Sums {
  DeviationSums core, full;
  auto leaving() {
    return [this](const TexelValue& value, std::uint64_t count) {
      core.add(value.core, value.wanted, count);
      full.add(value.full, value.wanted, count);
    };
  }
};

// What a thread has.
struct Worker {
  TexelCache cache, stored;  // texels on their own; with the metal mask that they get beside their neighbours
  Sums sums;
  Rgb largest_k{0, 0, 0};
  MaskVariation best;
  std::vector<std::uint16_t> wanted;  // masks of a row
  std::vector<ColourPair> pairs;      // that are solved together
  std::vector<MaskCost> masks;
  std::vector<StoredMetalRough::Choice> choices;
};

// From texels to pairs of colours.
class Pairs {
 public:
  explicit Pairs(const SpecularGlossiness& model) : model_(model) {}
  ColourPair operator()(const TexelKey& key) const {
    const SpecularGlossiness texel{product(rgb_at(key, 0), model_.diffuse), product(rgb_at(key, 3), model_.specular), 1};
    const TwoColour two = two_colour_of(texel);
    return held(ColourPair{two.diffuse, two.f0});
  }
  void all(Entries entries, std::vector<ColourPair>& out) const {
    out.clear();
    for (const TexelCache::Entry* entry : entries) out.push_back((*this)(entry->key));
  }

 private:
  SpecularGlossiness model_;
};

// What all texels have in common: the largest f0 of the dielectric part, which the stored ones are shares of; samples for how much each
// reader counts; and how near the diffuse colour as it is, without metal, comes to them in a core-only reader.
struct Survey {
  Rgb largest_k{0, 0, 0};
  std::vector<ColourPair> samples;
  ReaderDeviation core;
};

// The weight is not known yet: the largest f0 is that of one which most materials stay below, since the more the full reader counts, the
// more of it is asked for.
Result<Survey> survey_of(TextureRows& rows, const Pairs& pairs, const ConversionOptions& options, unsigned threads,
                         const std::string& name) {
  const double weight = options.readers == Readers::core ? weight_for_core : options.bits == 8 ? 1e3 : 1e5;
  std::vector<Worker> workers(threads);
  Samples samples(rows.width(), rows.height());
  TextureRows::Work work;
  work.row = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    samples.add_row(row.y, [&](std::uint32_t x) { return pairs(key_at(row, x)); });
    const auto solve = [&](Entries entries) {
      pairs.all(entries, worker.pairs);
      worker.masks.resize(entries.size());
      best_masks(worker.pairs, weight, worker.masks);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        TexelValue& value = entries[i]->value;
        value.wanted = worker.pairs[i];
        const MetalRoughColours colours = metal_rough_with(worker.masks[i], value.wanted, weight);
        for (int c = 0; c < 3 && colours.metal < 1; ++c) worker.largest_k[c] = std::max(worker.largest_k[c], colours.dielectric_f0[c]);
        value.core = in_core_reader({value.wanted.diffuse, 0, {}});
      }
    };
    worker.cache.row(
        rows.width(), [&](std::uint32_t x) { return key_at(row, x); }, solve, [](std::uint32_t, const TexelValue&) {},
        worker.sums.leaving());
  };
  if (Status done = rows.for_each(threads, options.progress, "survey of " + name, work); !done) return done.error();
  Survey survey;
  Sums sums;
  for (Worker& worker : workers) {
    worker.cache.empty(worker.sums.leaving());
    for (int c = 0; c < 3; ++c) survey.largest_k[c] = std::max(survey.largest_k[c], worker.largest_k[c]);
    sums.core.add(worker.sums.core);
  }
  survey.samples.assign(samples.pairs().begin(), samples.pairs().end());
  survey.core = sums.core.deviation();
  return survey;
}

// Whether no metal would bring a core-only reader closer.
bool does_without_metal(std::span<const ColourPair> samples, double weight) {
  DeviationSums alone, best;
  for (const ColourPair& pair : samples) {
    alone.add(in_core_reader({pair.diffuse, 0, {}}), pair);
    best.add(in_core_reader(metal_rough_of(pair, weight)), pair);
  }
  return rms_of(alone.deviation()) <= close_share * rms_of(best.deviation()) + close_rms;
}

enum Picture : std::size_t { base_colour, metal_rough, specular_colour };

}  // namespace

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
  Result<TextureRows> rows = open_rows({pointer_to(material.base_colour_texture), pointer_to(material.specular_gloss_texture)});
  if (!rows) return rows.error();
  const Pairs pairs(model);
  const Result<Survey> survey = survey_of(*rows, pairs, options_, threads_, material.name);
  if (!survey) return survey.error();
  const Rgb largest_k = survey->largest_k;
  StoredMetalRough stored(options_.bits, largest_k);
  if (options_.readers == Readers::all) stored.fit(survey->samples);

  MaterialChange change;
  change.texels = std::uint64_t{rows->width()} * rows->height();
  material.fallback.reset();
  material.specular_gloss_texture.reset();
  const auto specular_lobe = [&](const Rgb& f0, const std::optional<Texture>& texture) {
    const bool plain_f0 = f0 == Rgb{core_f0, core_f0, core_f0} && !texture;
    material.lobes.specular = plain_f0 ? std::nullopt : std::optional(Specular{1, f0 * (1 / core_f0), {}, texture});
  };
  // One specular colour for all texels, and no metal would bring a core-only reader closer: the diffuse picture stays as it is, its factor
  // takes 1 - max(specular), and a full reader loses nothing.
  if (!has_specular && does_without_metal(survey->samples, stored.weight())) {
    material.model = MetalRough{model.diffuse * (1 - std::clamp(largest(model.specular), 0.0, 1.0)), 0, 1 - model.glossiness, 1.5};
    specular_lobe(model.specular, {});
    change.core = survey->core;
    done_.push_back({before, material, change});
    return change;
  }

  const CodeTable& mask = stored.mask();
  if (Status made = make_folder(); !made) return made.error();
  const std::string stem = fmt::format("{}_{}", files_++, plain(material.name));
  const bool has_alpha = rows->has_alpha(0);
  std::vector<TextureOutput> outputs;
  outputs.emplace_back(options_.folder / (stem + "_baseColor.png"), has_alpha ? 4 : 3);
  outputs.emplace_back(options_.folder / (stem + "_metallicRoughness.png"), 3);
  outputs.emplace_back(options_.folder / (stem + "_specularColor.png"), 3);
  if (Status opened = open_all(outputs, *rows); !opened) return opened.error();

  std::vector<Worker> workers(threads_);
  MetalMaskRows masks(rows->width(), rows->height(), static_cast<std::uint16_t>(mask.top()));
  MaskVariation variation;
  std::vector<std::uint16_t> last_masks;
  TextureRows::Work work;
  work.survey = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    worker.cache.row(
        rows->width(), [&](std::uint32_t x) { return key_at(row, x); },
        [&](Entries entries) {
          pairs.all(entries, worker.pairs);
          stored.best_of(worker.pairs, worker.choices);
          for (std::size_t i = 0; i < entries.size(); ++i) {
            entries[i]->value.codes = worker.choices[i].codes;
            entries[i]->value.limits = worker.choices[i].limits;
          }
        },
        [&](std::uint32_t x, const TexelValue& value) {
          masks.put(x, row.y, {value.codes, value.limits});
        },
        [](auto...) {});
    masks.finish_row(row.y);
  };
  work.row = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    masks.wanted_row(row.y, worker.wanted);
    for (std::uint32_t x = 0; x < rows->width(); ++x) {
      const StoredMetalRough::Choice& choice = masks.at(x, row.y);
      const std::uint16_t wanted = worker.wanted[x];
      TexelKey key = key_at(row, x);
      key[6] = static_cast<float>(wanted);
      const auto find = [&](const TexelKey& texel) {
        const ColourPair pair = pairs(texel);
        return stored.read(stored.towards(wanted, choice, pair), pair);
      };
      const TexelValue& value = worker.stored.at(key, find, worker.sums.leaving());
      std::uint16_t *base = outputs[base_colour].texel(x, row.y), *rough = outputs[metal_rough].texel(x, row.y);
      std::copy_n(value.codes.begin(), 3, base);
      if (has_alpha) base[3] = mask.nearest(static_cast<double>(row.rgba[0][std::size_t{4} * x + 3]));
      rough[0] = static_cast<std::uint16_t>(mask.top());  // occlusion, for those who look for it there: none
      rough[1] = mask.nearest(1 - model.glossiness * static_cast<double>(row.rgba[1][std::size_t{4} * x + 3]));
      rough[2] = value.codes[StoredMetalRough::metal];
      std::copy_n(value.codes.begin() + StoredMetalRough::dielectric, 3, outputs[specular_colour].texel(x, row.y));
    }
    const std::uint16_t* best = masks.best_row(row.y);
    worker.best.add_row(
        rows->width(), [&](std::uint32_t x) { return best[x]; }, row.y > 0 ? masks.best_row(row.y - 1) : nullptr);
  };
  work.writers = outputs.size();
  work.write = [&](std::size_t picture, std::uint32_t begin, std::uint32_t count) {
    for (std::uint32_t y = begin; picture == metal_rough && y < begin + count; ++y) {
      const std::uint16_t* codes = outputs[metal_rough].texel(0, y) + 2;
      const auto code = [&](std::uint32_t x) { return codes[std::size_t{3} * x]; };
      variation.add_row(rows->width(), code, y > 0 ? last_masks.data() : nullptr);
      last_masks.resize(rows->width());
      for (std::uint32_t x = 0; x < rows->width(); ++x) last_masks[x] = code(x);
    }
    return outputs[picture].write(begin, count);
  };
  if (Status done = rows->for_each(threads_, options_.progress, "textures of " + material.name, work); !done) return done.error();
  Sums sums;
  MaskVariation best_variation;
  for (Worker& worker : workers) {
    worker.stored.empty(worker.sums.leaving());
    sums.core.add(worker.sums.core);
    sums.full.add(worker.sums.full);
    best_variation.add(worker.best);
  }
  if (Status closed = close_all(outputs); !closed) return closed.error();
  change.core = sums.core.deviation();
  change.full = sums.full.deviation();
  change.metal_variation = variation.mean(mask.top());
  change.metal_variation_of_best = best_variation.mean(mask.top());

  // What is the same everywhere needs no picture.
  const Texture like = before.base_colour_texture ? *before.base_colour_texture : *before.specular_gloss_texture;
  report_repeats(material, *rows);
  MetalRough result;
  material.base_colour_texture.reset();
  if (outputs[base_colour].is_constant() && !has_alpha) {
    result.base_colour = constant_colour(outputs[base_colour], stored.colour());
    outputs[base_colour].remove();
  } else {
    material.base_colour_texture = new_texture(like, outputs[base_colour].file(), material.name + " base colour", Encoding::srgb);
  }
  if (outputs[metal_rough].is_constant()) {
    result.roughness = has_specular ? mask.linear(*outputs[metal_rough].constant(1)) : 1 - model.glossiness;
    result.metallic = mask.linear(*outputs[metal_rough].constant(2));
    outputs[metal_rough].remove();
  } else {
    material.metal_rough_texture = new_texture(like, outputs[metal_rough].file(), material.name + " metal and roughness", Encoding::linear);
  }
  if (outputs[specular_colour].is_constant()) {
    specular_lobe(product(largest_k, constant_colour(outputs[specular_colour], stored.colour())), {});
    outputs[specular_colour].remove();
  } else {
    specular_lobe(largest_k, new_texture(like, outputs[specular_colour].file(), material.name + " specular colour", Encoding::srgb));
  }
  material.model = result;
  done_.push_back({before, material, change});
  return change;
}

}  // namespace etendue
