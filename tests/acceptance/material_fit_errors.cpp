// Excess of the rms of Disney parameters over the global optimum's, a line of JSON a row. Arguments: `floats` or `codes`, the number of
// random pairs of colours, then glTF files whose specular-glossiness texels are taken, each distinct pair once.
#include "etendue/material.h"
#include "etendue/material_codes.h"
#include "etendue/material_fit_batch.h"
#include "etendue/picture.h"
#include "importers/gltf/gltf.h"

#include "draws.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace etendue;
using Json = nlohmann::ordered_json;

struct Pairs {
  std::vector<Vec3f> diffuse, f0;
  std::vector<std::size_t> texels;  // that have these colours
  std::size_t size() const { return diffuse.size(); }
  ColourPair operator[](std::size_t i) const { return {vec_cast<double>(diffuse[i]), vec_cast<double>(f0[i])}; }
};

double rms(double residual) { return std::sqrt(residual / 6); }

// work(i) for every pair, on all cores.
template <class Work>
void each(std::size_t count, const Work& work) {
  const unsigned threads = std::max(std::thread::hardware_concurrency(), 1U);
  std::vector<std::thread> running;
  for (unsigned t = 0; t < threads; ++t)
    running.emplace_back([&, t] {
      for (std::size_t i = t; i < count; i += threads) work(i);
    });
  for (std::thread& thread : running) thread.join();
}

void measure_floats(const std::string& part, const Pairs& pairs, DielectricF0 dielectric, const std::vector<double>& least) {
  std::vector<Vec3f> base(pairs.size());
  std::vector<float> metal(pairs.size()), reflectance(pairs.size());
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    if (!fit_disney(pairs.diffuse, pairs.f0, {base, metal, reflectance}, dielectric)) std::exit(1);
    double worst = 0;
    std::size_t above = 0, texels = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double excess = rms(squared_difference({vec_cast<double>(base[i]), metal[i], reflectance[i]}, pairs[i])) - least[i];
      worst = std::max(worst, excess);
      if (excess > 1e-4) ++above, texels += pairs.texels[i];
    }
    std::cout << Json{{"part", part},
                      {"what", "float"},
                      {"f0", dielectric == DielectricF0::core ? "core" : "free"},
                      {"set", hwy::TargetName(target)},
                      {"pairs", pairs.size()},
                      {"worst", worst},
                      {"above", above},
                      {"texels", std::accumulate(pairs.texels.begin(), pairs.texels.end(), std::size_t{0})},
                      {"texels_above", texels}}
              << std::endl;
  }
  hwy::SetSupportedTargetsForTest(0);
}

void measure(const std::string& part, const Pairs& pairs) {
  for (const DielectricF0 dielectric : {DielectricF0::free, DielectricF0::core}) {
    std::vector<double> least(pairs.size());
    each(pairs.size(), [&](std::size_t i) { least[i] = rms(fit_disney(pairs[i], dielectric).residual); });
    measure_floats(part, pairs, dielectric, least);
  }
}

// RMSE over diffuse and f0 of the best 8-bit values and of the rounded optimum; and the greatest amount by which one is worse.
void measure_codes(const std::string& part, const Pairs& pairs) {
  for (const int bits : {8, 16}) {
    const MaterialFormat format{bits, DielectricCode::reflectance};
    std::vector<double> best(pairs.size()), plain(pairs.size());
    each(pairs.size(), [&](std::size_t i) {
      best[i] = fit_codes(pairs[i], format).residual;
      plain[i] = squared_difference(decoded(rounded(fit_disney(pairs[i]).value, format), format), pairs[i]);
    });
    double best_sum = 0, plain_sum = 0, worse = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) best_sum += best[i], plain_sum += plain[i], worse = std::max(worse, best[i] - plain[i]);
    const auto rmse = [&](double sum) { return rms(sum / static_cast<double>(pairs.size())); };
    std::cout << Json{{"part", part},          {"what", "codes"},        {"bits", bits},
                      {"pairs", pairs.size()}, {"best", rmse(best_sum)}, {"rounded", rmse(plain_sum)},
                      {"worse", worse}}
              << std::endl;
  }
}

// The texels of a material's two textures, or its factors; nothing where the sizes differ.
void add_texels(const Scene& scene, const Material& material, const SpecularGlossiness& factors, std::vector<std::array<float, 6>>& out) {
  const auto image_of = [&](const std::optional<Texture>& texture) -> DecodedImage {
    if (!texture) return {1, 1, {1, 1, 1, 1}};
    auto decoded = decode(scene.images[texture->image], texture->encoding);
    return decoded ? std::move(*decoded) : DecodedImage{};
  };
  const DecodedImage diffuse = image_of(material.base_colour_texture), specular = image_of(material.specular_gloss_texture);
  const std::size_t a = diffuse.rgba.size() / 4, b = specular.rgba.size() / 4;
  if (a == 0 || b == 0 || (a != 1 && b != 1 && a != b)) return;
  for (std::size_t i = 0; i < std::max(a, b); ++i) {
    const float* d = &diffuse.rgba[a == 1 ? 0 : 4 * i];
    const float* s = &specular.rgba[b == 1 ? 0 : 4 * i];
    const TwoColour two =
        two_colour_of(SpecularGlossiness{factors.diffuse * Rgb{d[0], d[1], d[2]}, factors.specular * Rgb{s[0], s[1], s[2]}, 1});
    const Vec3f x = vec_cast<float>(two.diffuse), y = vec_cast<float>(two.f0);
    out.push_back({x.x, x.y, x.z, y.x, y.y, y.z});
  }
}

Pairs pairs_of(const std::string& file) {
  ImportOptions options;
  options.tolerant = true;
  const auto importer = make_gltf_importer();
  const Result<Imported> imported = importer->read(file, options);
  if (!imported) {
    std::cerr << to_string(to_diagnostic(imported.error())) << '\n';
    return {};
  }
  std::vector<std::array<float, 6>> texels;
  for (const Material& material : imported->scene.materials)
    if (const auto* factors = std::get_if<SpecularGlossiness>(&material.model)) add_texels(imported->scene, material, *factors, texels);
  std::sort(texels.begin(), texels.end());
  Pairs pairs;
  for (std::size_t i = 0, next = 0; i < texels.size(); i = next) {
    while (next < texels.size() && texels[next] == texels[i]) ++next;
    const auto& t = texels[i];
    pairs.diffuse.push_back({t[0], t[1], t[2]}), pairs.f0.push_back({t[3], t[4], t[5]}), pairs.texels.push_back(next - i);
  }
  return pairs;
}

Pairs random_pairs(std::size_t count) {
  Draws draw(1);
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i)
    pairs.diffuse.push_back(vec_cast<float>(draw.rgb(0, 1))), pairs.f0.push_back(vec_cast<float>(draw.rgb(0, 1))),
        pairs.texels.push_back(1);
  return pairs;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto run = std::string(argv[1]) == "codes" ? measure_codes : measure;
  const std::size_t count = std::strtoull(argv[2], nullptr, 10);
  if (count > 0) run("random", random_pairs(count));
  for (int i = 3; i < argc; ++i)
    if (const Pairs pairs = pairs_of(argv[i]); pairs.size() > 0) run(argv[i], pairs);
}
