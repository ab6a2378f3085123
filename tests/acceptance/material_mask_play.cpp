// How calm a metal mask can be: material_mask_play FOLDER FILE... converts the files' specular-glossiness materials with 8 bits, pictures
// into FOLDER, and prints a line of JSON for each: the mean difference of neighbouring texels' masks as stored, as each texel's own best
// one, and the least that masks within the limits of each texel can have; and the share of texels that have more than one.
#include "etendue/material_conversion.h"
#include "etendue/picture.h"
#include "importers/gltf/gltf.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "picture/stored_metal_rough.h"
#include "picture/texel_samples.h"

namespace {

using namespace etendue;
using Json = nlohmann::ordered_json;
constexpr int bits = 8, top = 255;

struct Pairs {
  std::uint32_t width = 0, height = 0;
  std::vector<ColourPair> texels;
};

// Nothing where the pictures' sizes differ.
Pairs pairs_of(const Scene& scene, const Material& material) {
  const auto image_of = [&](const std::optional<Texture>& texture) -> DecodedImage {
    if (!texture) return {1, 1, {1, 1, 1, 1}};
    auto decoded = decode(scene.images[texture->image], texture->encoding);
    return decoded ? std::move(*decoded) : DecodedImage{};
  };
  const DecodedImage diffuse = image_of(material.base_colour_texture), specular = image_of(material.specular_gloss_texture);
  const auto& factors = std::get<SpecularGlossiness>(material.model);
  const std::size_t a = diffuse.rgba.size() / 4, b = specular.rgba.size() / 4;
  if (a == 0 || b == 0 || (a != 1 && b != 1 && a != b)) return {};
  Pairs out{a > 1 ? diffuse.width : specular.width, a > 1 ? diffuse.height : specular.height, {}};
  for (std::size_t i = 0; i < std::max(a, b); ++i) {
    const float* d = &diffuse.rgba[a == 1 ? 0 : 4 * i];
    const float* s = &specular.rgba[b == 1 ? 0 : 4 * i];
    const TwoColour two =
        two_colour_of(SpecularGlossiness{factors.diffuse * Rgb{d[0], d[1], d[2]}, factors.specular * Rgb{s[0], s[1], s[2]}, 1});
    out.texels.push_back({two.diffuse, two.f0});
  }
  return out;
}

// Codes: the best one, and the lowest and the highest of those that are as good.
struct Interval {
  int best = 0, low = 0, high = 0;
};

// What the conversion chooses from, with the weight that it finds; all texels of `pairs`, in their order.
std::vector<Interval> intervals_of(const Pairs& pairs, const Rgb& largest_k) {
  Samples samples(pairs.width, pairs.height);
  for (std::uint32_t y = 0; y < pairs.height; ++y)
    samples.add_row(y, [&](std::uint32_t x) { return pairs.texels[std::size_t{y} * pairs.width + x]; });
  StoredMetalRough stored(bits, largest_k);
  stored.fit(samples.pairs());
  std::map<std::array<double, 6>, Interval> known;
  std::vector<Interval> out;
  for (const ColourPair& pair : pairs.texels) {
    const Rgb &d = pair.diffuse, &f = pair.f0;
    const auto [place, is_new] = known.try_emplace({d.x, d.y, d.z, f.x, f.y, f.z});
    if (is_new) {
      std::vector<StoredMetalRough::Choice> choice;
      stored.best_of(std::span(&pair, 1), choice);
      const auto may_be = [&](int code) {
        return stored.towards(static_cast<std::uint16_t>(code), choice[0], pair)[StoredMetalRough::metal] == code;
      };
      Interval& found = place->second = {choice[0].codes[StoredMetalRough::metal], 0, top};
      while (!may_be(found.low)) ++found.low;
      while (!may_be(found.high)) --found.high;
    }
    out.push_back(place->second);
  }
  return out;
}

// Two neighbours differ by the gap between their intervals at least, whatever the others do.
Json measure(const Pairs& pairs, const std::vector<Interval>& texels) {
  std::uint64_t best = 0, least = 0, neighbours = 0;
  const auto add = [&](const Interval& a, const Interval& b) {
    best += static_cast<std::uint64_t>(std::abs(a.best - b.best));
    least += static_cast<std::uint64_t>(std::max({0, a.low - b.high, b.low - a.high}));
    ++neighbours;
  };
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (i % pairs.width > 0) add(texels[i], texels[i - 1]);
    if (i >= pairs.width) add(texels[i], texels[i - pairs.width]);
  }
  const auto mean = [&](std::uint64_t sum) {
    return neighbours > 0 ? static_cast<double>(sum) / static_cast<double>(neighbours) / top : 0.0;
  };
  const auto with_play = std::count_if(texels.begin(), texels.end(), [](const Interval& i) { return i.low < i.high; });
  return {{"best", mean(best)}, {"least", mean(least)}, {"with_play", static_cast<double>(with_play) / static_cast<double>(texels.size())}};
}

bool measure_file(const std::string& file, const std::string& folder) {
  ImportOptions reading;
  reading.tolerant = true;
  const Result<Imported> imported = make_gltf_importer()->read(file, reading);
  if (!imported) {
    std::cerr << to_string(to_diagnostic(imported.error())) << '\n';
    return false;
  }
  Scene converted = imported->scene;
  ConversionOptions writing;
  writing.folder = folder;
  const Result<MaterialConversion> done = convert_materials(converted, writing);
  if (!done) {
    std::cerr << to_string(to_diagnostic(done.error())) << '\n';
    return false;
  }
  for (const MaterialChange& change : done->changes) {
    const Material &before = imported->scene.materials[change.material], &after = converted.materials[change.material];
    const Pairs pairs = pairs_of(imported->scene, before);
    if (pairs.texels.size() < 2 || change.metal_variation_of_best == 0) continue;
    const Rgb largest_k = after.lobes.specular ? after.lobes.specular->colour * 0.04 : Rgb{0.04, 0.04, 0.04};
    Json row{{"file", file}, {"material", before.name}, {"stored", change.metal_variation}, {"told_best", change.metal_variation_of_best}};
    row.update(measure(pairs, intervals_of(pairs, largest_k)));
    std::cout << row << std::endl;
  }
  return true;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::cerr << "usage: material_mask_play FOLDER FILE...\n";
    return 2;
  }
  bool good = true;
  for (int i = 2; i < count; ++i) good = measure_file(words[i], words[1]) && good;
  return good ? 0 : 1;
}
