// Specular-glossiness textures as metallic-roughness ones.
#include "texture_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metal_mask_rows.h"
#include "reader_weight.h"
#include "stored_metal_rough.h"
#include "texel_samples.h"
#include "without_search.h"

namespace etendue {
namespace {

// A picture without specular-glossiness texture keeps its diffuse one where that is so close to the best, in rms.
constexpr double close_share = 1.005, close_rms = 1e-4;

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

// A texel of both textures, and a mask that it shall come near to.
TexelKey key_at(const TextureRows::Row& row, std::size_t x, float wanted = 0) {
  const float *d = row.rgba[0].data() + 4 * x, *s = row.rgba[1].data() + 4 * x;
  return {word_of(d[0], d[1]), word_of(d[2], wanted), word_of(s[0], s[1]), word_of(s[2], 0)};
}

// What a thread of the survey has.
struct Surveyor {
  struct Texels {
    std::uint64_t count = 0;
  };
  using Cache = TexelCache<Texels>;
  Cache cache;
  DeviationSums core;
  Rgb largest_k{0, 0, 0};
  std::vector<std::uint32_t> open;  // texels of a row that matter
  std::vector<ColourPair> pairs;    // that are solved together
  std::vector<MetalRoughColours> colours;
};

// What a thread of the conversion has.
struct Worker {
  struct Found {
    StoredMetalRough::Codes codes{};
    std::uint64_t count = 0;
  };
  using Choices = TexelCache<StoredMetalRough::Choice>;
  Choices choices;           // of texels on their own
  TexelCache<Found> stored;  // with the metal mask that they get beside their neighbours
  DeviationSums core, full;
  MaskVariation best;
  std::vector<std::uint16_t> wanted;  // masks of a row
  std::vector<ColourPair> pairs;      // that are solved together
  std::vector<StoredMetalRough::Choice> solved;
};

// From texels to pairs of colours.
class Pairs {
 public:
  explicit Pairs(const SpecularGlossiness& model) : model_(model) {}
  ColourPair operator()(const TexelKey& key) const {
    const SpecularGlossiness texel{product(rgb_at(key, 0), model_.diffuse), product(rgb_at(key, 4), model_.specular), 1};
    const TwoColour two = two_colour_of(texel);
    return held(ColourPair{two.diffuse, two.f0});
  }
  template <class Entries>
  void all(Entries entries, std::vector<ColourPair>& out) const {
    out.clear();
    for (const auto* entry : entries) out.push_back((*this)(entry->key));
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
// more of it is asked for. Texels that are certainly below what others ask for are passed by, unless the diffuse colour as it is may do
// (`alone`), whose deviation is that of all texels.
Result<Survey> survey_of(TextureRows& rows, const Pairs& pairs, const ConversionOptions& options, unsigned threads, bool alone,
                         const std::string& name) {
  const double weight = options.readers == Readers::core ? weight_for_core : options.bits == 8 ? 1e3 : 1e5;
  std::vector<Surveyor> workers(threads);
  const auto leaving = [&](Surveyor& worker) {
    return [&](const TexelKey& key, const Surveyor::Texels& texels) {
      if (!alone) return;
      const ColourPair pair = pairs(key);
      worker.core.add(in_core_reader({pair.diffuse, 0, {}}), pair, texels.count);
    };
  };
  Samples samples(rows.width(), rows.height());
  TextureRows::Work work;
  work.row = [&](const TextureRows::Row& row) {
    Surveyor& worker = workers[row.thread];
    samples.add_row(row.y, [&](std::uint32_t x) { return pairs(key_at(row, x)); });
    worker.open.clear();
    TexelKey last{};
    for (std::uint32_t x = 0; x < rows.width(); ++x) {
      const TexelKey key = key_at(row, x);
      const bool again = x > 0 && key == last;
      last = key;
      if (alone || (!again && !dielectric_is_below(worker.largest_k, pairs(key), weight))) worker.open.push_back(x);
    }
    const auto solve = [&](std::span<Surveyor::Cache::Entry* const> entries) {
      pairs.all(entries, worker.pairs);
      metal_rough_of_all(worker.pairs, weight, worker.colours);
      for (const MetalRoughColours& colours : worker.colours)
        for (int c = 0; c < 3 && colours.metal < 1; ++c) worker.largest_k[c] = std::max(worker.largest_k[c], colours.dielectric_f0[c]);
    };
    worker.cache.together(
        static_cast<std::uint32_t>(worker.open.size()), [&](std::uint32_t i) { return key_at(row, worker.open[i]); }, solve,
        [](std::uint32_t, Surveyor::Texels& texels) { ++texels.count; }, leaving(worker));
  };
  if (Status done = rows.for_each(threads, options.progress, "survey of " + name, work); !done) return done.error();
  Survey survey;
  DeviationSums core;
  for (Surveyor& worker : workers) {
    worker.cache.empty(leaving(worker));
    for (int c = 0; c < 3; ++c) survey.largest_k[c] = std::max(survey.largest_k[c], worker.largest_k[c]);
    core.add(worker.core);
  }
  survey.samples.assign(samples.pairs().begin(), samples.pairs().end());
  survey.core = core.deviation();
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
  Result<TextureRows> rows = open_rows({pointer_to(material.base_colour_texture), pointer_to(material.specular_gloss_texture)}, true);
  if (!rows) return rows.error();
  const Pairs pairs(model);
  const Result<Survey> survey = survey_of(*rows, pairs, options_, threads_, !has_specular, material.name);
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
  const auto leaving = [&](Worker& worker) {
    return [&](const TexelKey& key, const Worker::Found& found) {
      const DeviationSums::Stepped asked(pairs(key));
      const ReadColours read = stored.read(found.codes);
      worker.core.add(read.core, asked, found.count);
      worker.full.add(read.full, asked, found.count);
    };
  };
  MaskVariation variation;
  std::vector<std::uint16_t> last_masks;
  TextureRows::Work work;
  work.survey = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    worker.choices.together(
        rows->width(), [&](std::uint32_t x) { return key_at(row, x); },
        [&](std::span<Worker::Choices::Entry* const> entries) {
          pairs.all(entries, worker.pairs);
          stored.best_of(worker.pairs, worker.solved);
          for (std::size_t i = 0; i < entries.size(); ++i) entries[i]->value = worker.solved[i];
        },
        [&](std::uint32_t x, const StoredMetalRough::Choice& choice) { masks.put(x, row.y, choice); }, [](auto...) {});
    masks.finish_row(row.y);
  };
  work.row = [&](const TextureRows::Row& row) {
    Worker& worker = workers[row.thread];
    masks.wanted_row(row.y, worker.wanted);
    const auto wanted_key = [&](std::uint32_t x) { return key_at(row, x, static_cast<float>(worker.wanted[x])); };
    const auto find = [&](std::uint32_t x, const TexelKey& key) {
      return Worker::Found{stored.towards(worker.wanted[x], masks.at(x, row.y), pairs(key)), 0};
    };
    const auto put = [&](std::uint32_t x, Worker::Found& value) {
      ++value.count;
      std::uint16_t *base = outputs[base_colour].texel(x, row.y), *rough = outputs[metal_rough].texel(x, row.y);
      std::copy_n(value.codes.begin(), 3, base);
      if (has_alpha) base[3] = mask.nearest(static_cast<double>(row.rgba[0][std::size_t{4} * x + 3]));
      rough[0] = static_cast<std::uint16_t>(mask.top());  // occlusion, for those who look for it there: none
      rough[1] = mask.nearest(1 - model.glossiness * static_cast<double>(row.rgba[1][std::size_t{4} * x + 3]));
      rough[2] = value.codes[StoredMetalRough::metal];
      std::copy_n(value.codes.begin() + StoredMetalRough::dielectric, 3, outputs[specular_colour].texel(x, row.y));
    };
    worker.stored.each(rows->width(), wanted_key, find, put, leaving(worker));
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
  DeviationSums core, full;
  MaskVariation best_variation;
  for (Worker& worker : workers) {
    worker.stored.empty(leaving(worker));
    core.add(worker.core);
    full.add(worker.full);
    best_variation.add(worker.best);
  }
  if (Status closed = close_all(outputs); !closed) return closed.error();
  change.core = core.deviation();
  change.full = full.deviation();
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
