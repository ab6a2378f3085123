// One pair of colours for two readers, and whole materials with textures.
#include "etendue/material_conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "etendue/picture.h"
#include "gltf_builder.h"
#include "picture/png_rows.h"

namespace etendue {
namespace {

using test::Folder;

double squared(const ColourPair& a, const ColourPair& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += std::pow(a.diffuse[c] - b.diffuse[c], 2) + std::pow(a.f0[c] - b.f0[c], 2);
  return sum;
}
double rms(const ColourPair& a, const ColourPair& b) { return std::sqrt(squared(a, b) / 6); }

// Any pair that specular-glossiness can say: diffuse <= 1 - max f0.
ColourPair random_pair(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  ColourPair pair;
  for (int c = 0; c < 3; ++c) pair.f0[c] = std::pow(uniform(random), 3);
  const double left = 1 - std::max({pair.f0.x, pair.f0.y, pair.f0.z});
  for (int c = 0; c < 3; ++c) pair.diffuse[c] = left * uniform(random);
  return pair;
}

TEST(MetalRoughOf, WhatMetalRoughnessCanSayIsExactInBothReaders) {
  for (const double weight : {1e-3, 1.0, 1e3, 1e7}) {
    for (const double metal : {0.0, 1.0}) {
      const MetalRoughColours said{{0.8, 0.3, 0.1}, metal, {0.04, 0.04, 0.04}};
      const ColourPair pair = in_core_reader(said);
      const MetalRoughColours found = metal_rough_of(pair, weight);
      EXPECT_EQ(found.metal, metal);
      EXPECT_LT(rms(in_core_reader(found), pair), 1e-9);
      EXPECT_LT(rms(in_full_reader(found), pair), 1e-9);
    }
  }
}

// At m = 0 with k = f0 a full reader is exact for every pair: with the weight w its squares are at most 1 / w of what the core-only reader
// loses there, 3 x .96^2 at most, and a share that rounding takes.
TEST(MetalRoughOf, TheLargerTheWeightTheNearerAFullReader) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    for (int i = 0; i < 500; ++i) {
      const ColourPair pair = random_pair(random);
      for (const double weight : {1e1, 1e3, 1e5, 1e7})
        EXPECT_LE(squared(in_full_reader(metal_rough_of(pair, weight)), pair), (3 * 0.96 * 0.96 + 1e-7) / weight) << seed << ' ' << i;
    }
  }
}

// All masks of a grid, and the core's own optimum with the dielectric f0 that mends it most.
TEST(MetalRoughOf, NoMaskOfAFineGridIsBetter) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    int pairs = 0, missed = 0;
    for (; pairs < 300; ++pairs) {
      const ColourPair pair = random_pair(random);
      for (const double weight : {1e-3, 1.0, 30.0, 1e3, 1e7}) {
        const MetalRoughColours found = metal_rough_of(pair, weight);
        const double cost = metal_rough_cost(found, pair, weight);
        double least = metal_rough_cost(metal_rough_at(fit_disney(pair, DielectricF0::core).value.metal, pair, weight), pair, weight);
        for (int step = 0; step <= 4096; ++step) {
          const MetalRoughColours at = metal_rough_at(step / 4096.0, pair, weight);
          least = std::min(least, metal_rough_cost(at, pair, weight));
        }
        // 6e-8 is the tie-break's.
        if (weight < 100)
          EXPECT_LE(cost, least * (1 + 1e-6) + 6.1e-8) << "seed " << seed << ", pair " << pairs << ", weight " << weight;
        else
          missed += cost > least * (1 + 1e-6) + 6.1e-8;
        EXPECT_LE(cost, least * 1.15 + 6.1e-8) << "seed " << seed << ", pair " << pairs << ", weight " << weight;
        for (int c = 0; c < 3; ++c) {
          EXPECT_GE(found.base[c], 0);
          EXPECT_LE(found.base[c], 1);
          EXPECT_GE(found.dielectric_f0[c], 0);
          EXPECT_LE(found.dielectric_f0[c], 1);
        }
      }
    }
    EXPECT_LE(missed, 2) << seed;  // of 600, seldom: the narrow valleys of large weights
  }
}

// A channel's base colour in closed form against 2001 of them, each with the best dielectric f0 of as many.
TEST(MetalRoughAt, NoBaseColourOfAGridIsBetter) {
  std::mt19937 random(4);
  for (int i = 0; i < 40; ++i) {
    const ColourPair pair = random_pair(random);
    for (const double metal : {0.0, 0.03, 0.4, 0.9, 1.0}) {
      for (const double weight : {1e-3, 30.0, 1e5}) {
        const MetalRoughColours found = metal_rough_at(metal, pair, weight);
        const double cost = metal_rough_cost(found, pair, weight);
        for (int c = 0; c < 3; ++c) {
          for (int step = 0; step <= 2000; ++step) {
            MetalRoughColours other = found;
            other.base[c] = step / 2000.0;
            if (metal < 1) other.dielectric_f0[c] = std::clamp((pair.f0[c] - metal * other.base[c]) / (1 - metal), 0.0, 1.0);
            EXPECT_LE(cost, metal_rough_cost(other, pair, weight) * (1 + 1e-12)) << metal << ' ' << weight << ' ' << step;
          }
        }
      }
    }
  }
}

TEST(MetalRoughOf, AbsurdInputGivesFiniteNumbers) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {inf, -inf, nan, 1e300}) {
    const MetalRoughColours found = metal_rough_of({{x, 0, 1}, {0, x, x}}, 1000);
    EXPECT_TRUE(std::isfinite(metal_rough_cost(found, {{0, 0, 0}, {0, 0, 0}}, 1000)));
  }
}

// Codes of a picture, row by row.
std::string write_png(const Folder& folder, const std::string& name, std::uint32_t width, std::uint32_t height, int channels,
                      const std::function<std::uint16_t(std::uint32_t x, std::uint32_t y, int channel)>& code, int bits = 8) {
  const auto file = folder.path() / name;
  auto png = PngRows::open(file, width, height, channels, bits);
  EXPECT_TRUE(png);
  std::vector<std::uint16_t> codes;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) codes.push_back(code(x, y, c));
  EXPECT_TRUE(png->write(height, codes));
  EXPECT_TRUE(png->close());
  return file.string();
}

// A pair of pictures of random colours of dielectrics and metals.
Scene textured(const Folder& folder, std::uint32_t diffuse_side, std::uint32_t specular_side) {
  std::mt19937 random(7);
  const auto any = [&](int most) { return static_cast<std::uint16_t>(random() % static_cast<unsigned>(most)); };
  Scene scene;
  scene.images.push_back(
      {write_png(folder, "diffuse.png", diffuse_side, diffuse_side, 4, [&](auto, auto, int c) { return c == 3 ? any(256) : any(200); }),
       {},
       "",
       "d"});
  scene.images.push_back(
      {write_png(folder, "specular.png", specular_side, specular_side, 4,
                 [&](auto, auto, int c) -> std::uint16_t { return c == 3 ? any(256) : static_cast<std::uint16_t>(50 + any(30)); }),
       {},
       "",
       "s"});
  Material material;
  material.name = "thing";
  material.model = SpecularGlossiness{{0.9, 1, 0.8}, {1, 1, 0.9}, 0.7};
  material.base_colour_texture = Texture{0, Encoding::srgb};
  material.specular_gloss_texture = Texture{1, Encoding::srgb};
  material.base_alpha = 0.5;
  scene.materials.push_back(material);
  return scene;
}

// A dielectric and a metal that drift, with a step of noise: their metal masks have some play.
Scene drifting(const Folder& folder, std::uint32_t side) {
  std::mt19937 random(11);
  Scene scene = textured(folder, 4, 4);
  const auto noisy = [&random](double middle) {
    return static_cast<std::uint16_t>(std::lround(middle) + static_cast<long>(random() % 3) - 1);
  };
  const auto metal_at = [=](std::uint32_t x) { return 2 * x > side; };
  scene.images[0].file = write_png(folder, "drifting_diffuse.png", side, side, 3,
                                   [&](auto x, auto y, int c) { return noisy(metal_at(x) ? 20 + 0.2 * y : 90 + 30 * c + 0.5 * y); });
  scene.images[1].file = write_png(folder, "drifting_specular.png", side, side, 4, [&](auto x, auto y, int c) {
    return noisy(c == 3 ? 128 : metal_at(x) ? 160 + 20 * c + 0.3 * y : 56 + 0.1 * y);
  });
  scene.materials[0].model = SpecularGlossiness{{1, 1, 1}, {1, 1, 1}, 1};
  return scene;
}

struct Read {
  ColourPair core, full;
  double roughness, alpha;
};
Read read_metal_rough(const Scene& scene, const Material& m, Vec2d uv) {
  const auto at = [&](const std::optional<Texture>& texture) {
    return texture ? sample(*decode(scene.images[texture->image], texture->encoding), *texture, uv) : Rgba{1, 1, 1, 1};
  };
  const auto model = std::get<MetalRough>(m.model);
  const Rgba b = at(m.base_colour_texture), mr = at(m.metal_rough_texture), k = at(m.lobes.specular->colour_texture);
  const Rgb colour = m.lobes.specular->colour;
  const MetalRoughColours colours{{b.r * model.base_colour.x, b.g * model.base_colour.y, b.b * model.base_colour.z},
                                  mr.b * model.metallic,
                                  {0.04 * k.r * colour.x, 0.04 * k.g * colour.y, 0.04 * k.b * colour.z}};
  return {in_core_reader(colours), in_full_reader(colours), mr.g * model.roughness, b.a * m.base_alpha};
}

TEST(ConvertMaterials, TexturesSayWhatTheyDidInTheFullReader) {
  for (const int bits : {8, 16}) {
    const Folder folder;
    Scene scene = textured(folder, 16, 16);
    const Scene before = scene;
    const auto done = convert_materials(scene, {MaterialModel::metal_rough, bits, folder.path() / "new", 2, nullptr});
    ASSERT_TRUE(done) << done.error().text;
    ASSERT_EQ(done->changes.size(), 1u);
    // Steps of sRGB are at most .009 in linear light, and uniform errors of a step have an rms of step / sqrt 12: .0026. 16 bits hold the
    // limit, which is on both colours together, and can be in one of them.
    EXPECT_LT(done->changes[0].full.diffuse.rms, bits == 8 ? 2.6e-3 : std::sqrt(2) * full_reader_limit(16));
    EXPECT_LT(done->changes[0].full.f0.rms, bits == 8 ? 1e-3 : std::sqrt(2) * full_reader_limit(16));
    double diffuse = 0;
    for (std::uint32_t y = 0; y < 16; ++y) {
      for (std::uint32_t x = 0; x < 16; ++x) {
        const Vec2d uv{(x + 0.5) / 16, (y + 0.5) / 16};
        const Rgba d = sample(*decode(before.images[0], Encoding::srgb), *before.materials[0].base_colour_texture, uv);
        const Rgba s = sample(*decode(before.images[1], Encoding::srgb), *before.materials[0].specular_gloss_texture, uv);
        const TwoColour wanted = two_colour_of(SpecularGlossiness{{d.r * 0.9, d.g, d.b * 0.8}, {s.r, s.g, s.b * 0.9}, s.a * 0.7});
        const Read found = read_metal_rough(scene, scene.materials[0], uv);
        for (int c = 0; c < 3; ++c) diffuse += std::pow(found.full.diffuse[c] - wanted.diffuse[c], 2);
        EXPECT_NEAR(found.roughness, wanted.roughness, 0.51 / (bits == 8 ? 255 : 65535));
        EXPECT_NEAR(found.alpha, d.a * 0.5, 1e-6);
      }
    }
    // The report is of what the files hold.
    EXPECT_NEAR(std::sqrt(diffuse / (3 * 256)), done->changes[0].full.diffuse.rms, 1e-6);
  }
}

TEST(ConvertMaterials, ThreadsChangeNothing) {
  const Folder folder;
  Scene one = drifting(folder, 100), three = one;
  ASSERT_TRUE(convert_materials(one, {MaterialModel::metal_rough, 8, folder.path() / "one", 1, nullptr}));
  ASSERT_TRUE(convert_materials(three, {MaterialModel::metal_rough, 8, folder.path() / "three", 3, nullptr}));
  ASSERT_EQ(one.images.size(), three.images.size());
  for (std::size_t i = 2; i < one.images.size(); ++i) {
    const auto a = decode(one.images[i], Encoding::linear), b = decode(three.images[i], Encoding::linear);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->rgba, b->rgba);
  }
}

// Within what half a step of 8 bits is worth, h = 1/510: each reader's error is at most sqrt(r^2 + h^2), r that of the best masks.
TEST(ConvertMaterials, TheMetalMaskIsCalmAtNoPrice) {
  const Folder folder;
  Scene scene = drifting(folder, 96);
  const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 2, nullptr});
  ASSERT_TRUE(done);
  const MaterialChange& change = done->changes[0];
  EXPECT_GT(change.metal_variation_of_best, 0);
  // Little, as these colours are so bright that codes are searched for the full reader's limit: a twentieth of its square is left for this.
  EXPECT_LT(change.metal_variation, 0.95 * change.metal_variation_of_best);

  // 16 bits leave next to no play: they are the best masks.
  Scene exact = drifting(folder, 96);
  const auto best = convert_materials(exact, {MaterialModel::metal_rough, 16, folder.path() / "exact", 2, nullptr});
  ASSERT_TRUE(best);
  const auto rms = [](const ReaderDeviation& d) { return std::sqrt((d.diffuse.rms * d.diffuse.rms + d.f0.rms * d.f0.rms) / 2); };
  constexpr double h = 1.0 / 510;
  // Rounding to 8 bits on top: an rms of .0013 at most (steps of .0045 at the mean of these colours, over sqrt 12).
  EXPECT_LT(rms(change.core), std::hypot(std::hypot(rms(best->changes[0].core), h), 1.3e-3));
  EXPECT_LT(rms(change.full), std::hypot(std::hypot(rms(best->changes[0].full), h / std::sqrt(1000.0)), 1.3e-3));

  // The report is of what the file holds.
  const auto mask = decode(scene.images[scene.materials[0].metal_rough_texture->image], Encoding::linear);
  ASSERT_TRUE(mask);
  double sum = 0;
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return static_cast<double>(mask->rgba[(std::size_t{y} * 96 + x) * 4 + 2]); };
  for (std::uint32_t y = 0; y < 96; ++y)
    for (std::uint32_t x = 0; x < 96; ++x)
      sum += (x > 0 ? std::abs(at(x, y) - at(x - 1, y)) : 0) + (y > 0 ? std::abs(at(x, y) - at(x, y - 1)) : 0);
  EXPECT_NEAR(change.metal_variation, sum / (2 * 96 * 95), 1e-7);
}

TEST(ConvertMaterials, ASmallPictureIsLookedUpForALargeOne) {
  for (const std::uint32_t side : {1u, 5u}) {
    const Folder folder;
    Scene scene = textured(folder, 16, side);
    ASSERT_TRUE(convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr}));
    const auto base = decode(scene.images[scene.materials[0].base_colour_texture->image], Encoding::srgb);
    ASSERT_TRUE(base);
    EXPECT_EQ(base->width, 16u);
    EXPECT_EQ(base->height, 16u);
  }
}

TEST(ConvertMaterials, MaterialsWithTheSameTexturesShareTheNewOnes) {
  const Folder folder;
  Scene scene = textured(folder, 8, 8);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "other";
  const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
  ASSERT_TRUE(done);
  EXPECT_EQ(done->images_written, 3u);
  EXPECT_EQ(scene.materials[0].base_colour_texture, scene.materials[1].base_colour_texture);
}

TEST(ConvertMaterials, OneSpecularColourLeavesTheDiffusePicture) {
  const Folder folder;
  Scene scene = textured(folder, 8, 8);
  scene.materials[0].specular_gloss_texture.reset();
  scene.materials[0].model = SpecularGlossiness{{1, 1, 1}, {0.04, 0.04, 0.04}, 0.5};
  const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
  ASSERT_TRUE(done);
  EXPECT_EQ(done->images_written, 0u);
  EXPECT_EQ(scene.materials[0].base_colour_texture->image, 0u);
  EXPECT_NEAR(std::get<MetalRough>(scene.materials[0].model).base_colour.x, 0.96, 1e-12);
  EXPECT_FALSE(scene.materials[0].lobes.specular);
}

// There and back: each way rounds to 16 bits once, and the diffuse colour is divided by 1 - max f0 > .3.
TEST(ConvertMaterials, ThereAndBackIsTheSameMaterial) {
  const Folder folder;
  Scene scene = textured(folder, 16, 16);
  const Scene before = scene;
  ASSERT_TRUE(convert_materials(scene, {MaterialModel::metal_rough, 16, folder.path() / "there", 1, nullptr}));
  const auto back = convert_materials(scene, {MaterialModel::spec_gloss, 16, folder.path() / "back", 1, nullptr});
  ASSERT_TRUE(back);
  EXPECT_LT(back->changes[0].full.f0.rms, 1e-4);
  const Material& material = scene.materials[0];
  const auto model = std::get<SpecularGlossiness>(material.model);
  EXPECT_TRUE(material.fallback);
  const auto diffuse = decode(scene.images[material.base_colour_texture->image], Encoding::srgb);
  const auto old = decode(before.images[0], Encoding::srgb);
  ASSERT_TRUE(diffuse && old);
  const double factors[3] = {0.9, 1, 0.8};
  for (std::size_t i = 0; i < old->rgba.size(); ++i) {
    if (i % 4 == 3)
      EXPECT_NEAR(diffuse->rgba[i], old->rgba[i], 1e-6);
    else
      EXPECT_NEAR(diffuse->rgba[i] * model.diffuse[static_cast<int>(i % 4)], old->rgba[i] * factors[i % 4], 2e-3);
  }
}

TEST(ConvertMaterials, BadPicturesAreLocatedErrors) {
  const Folder folder;
  Scene scene = textured(folder, 8, 8);
  scene.images[1].file = (folder.path() / "missing.png").string();
  const auto missing = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, "FILE_UNREADABLE");
  EXPECT_NE(missing.error().where.file.find("missing.png"), std::string::npos);

  Picture picture;
  picture.width = picture.height = 8;
  picture.add("", 3).pixels[std::size_t{3} * (8 * 2 + 5)] = std::numeric_limits<float>::quiet_NaN();
  const auto exr = folder.path() / "nan.exr";
  ASSERT_TRUE(write_exr(picture, exr));
  scene.images[1].file = exr.string();
  for (const std::uint32_t side : {8u, 16u}) {
    Scene other = textured(folder, side, 8);
    other.images[1].file = exr.string();
    const auto found = convert_materials(other, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, "PICTURE_UNSUITABLE");
    EXPECT_NE(found.error().text.find("(5, 2)"), std::string::npos) << found.error().text;
  }
}

// One channel, two, three, four and five: grey stands for the colours, a second or fourth channel is alpha, further ones are not looked at.
TEST(ConvertMaterials, AnyNumberOfChannelsIsRead) {
  for (const int channels : {1, 2, 3, 4, 5}) {
    const Folder folder;
    Scene scene = textured(folder, 8, 8);
    const auto file = folder.path() / "channels.tif";
    const auto output = OIIO::ImageOutput::create("tif");
    ASSERT_TRUE(output && output->open(file.string(), OIIO::ImageSpec(8, 8, channels, OIIO::TypeDesc::UINT8)));
    std::vector<std::uint8_t> codes(std::size_t{64} * static_cast<std::size_t>(channels), 55);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, codes.data()) && output->close());
    scene.images[1].file = file.string();
    const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
    ASSERT_TRUE(done) << done.error().text;
    const Material& material = scene.materials[0];
    const double roughness = material.metal_rough_texture
                                 ? sample(*decode(scene.images[material.metal_rough_texture->image], Encoding::linear), {}, {0.5, 0.5}).g
                                 : std::get<MetalRough>(material.model).roughness;
    // Glossiness is alpha: 55/255 or 1, times .7.
    EXPECT_NEAR(roughness, 1 - 0.7 * (channels == 2 || channels >= 4 ? 55.0 / 255 : 1), 0.51 / 255) << channels;
  }
}

TEST(ConvertMaterials, OneTexelAndManyGiveTheFactorsOfOneTexel) {
  const Folder folder;
  Scene scene = textured(folder, 64, 1);
  const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 2, nullptr});
  ASSERT_TRUE(done);
  EXPECT_EQ(done->changes[0].texels, 64u * 64u);
  // One glossiness everywhere: at most the metal mask needs a picture.
  const auto& texture = scene.materials[0].metal_rough_texture;
  if (!texture) return;
  const auto picture = decode(scene.images[texture->image], Encoding::linear);
  ASSERT_TRUE(picture);
  for (std::size_t i = 0; i < picture->rgba.size(); i += 4) EXPECT_EQ(picture->rgba[i + 1], picture->rgba[1]);
}

// glTF's factors are 0 to 1; others are held to what can be stored, and the report says by how much they differ.
TEST(ConvertMaterials, AbsurdFactorsGiveFiniteResults) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double factor : {1e300, -5.0, inf, nan}) {
    const Folder folder;
    Scene scene = textured(folder, 8, 8);
    scene.materials[0].model = SpecularGlossiness{{factor, 1, 1}, {1, factor, 1}, factor};
    const auto done = convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr});
    ASSERT_TRUE(done) << done.error().text;
    const auto& model = std::get<MetalRough>(scene.materials[0].model);
    for (const double x : {model.base_colour.x, model.base_colour.y, model.metallic, model.roughness}) {
      EXPECT_GE(x, 0) << factor;
      EXPECT_LE(x, 1) << factor;
    }
    EXPECT_TRUE(std::isfinite(done->changes[0].full.diffuse.rms)) << factor;
    EXPECT_TRUE(std::isfinite(done->changes[0].metal_variation)) << factor;
  }
}

}  // namespace
}  // namespace etendue
