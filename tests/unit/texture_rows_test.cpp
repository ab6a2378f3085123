// Textures of different sizes and transforms as rows of one picture: however their texels are kept, what is looked up is the same.
#include "picture/texture_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "etendue/picture.h"
#include "gltf_builder.h"
#include "picture/png_rows.h"

namespace etendue {
namespace {

using test::Folder;

// Codes that tell every texel from its neighbours.
ImageRef picture(const Folder& folder, const std::string& name, std::uint32_t width, std::uint32_t height, int bits = 8) {
  const auto file = folder.path() / name;
  auto png = PngRows::open(file, width, height, 4, bits);
  EXPECT_TRUE(png);
  std::vector<std::uint16_t> codes;
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (std::uint32_t c = 0; c < 4; ++c)
        codes.push_back(static_cast<std::uint16_t>((x * 37 + y * 101 + c * 59) % (bits == 8 ? 256 : 65521)));
  EXPECT_TRUE(png->write(height, codes));
  EXPECT_TRUE(png->close());
  return {file.string(), {}, "", name};
}

// Every row of the second texture, in order.
std::vector<float> rows_of(const Scene& scene, const Texture& first, const Texture& second, const TextureSource::Settings& settings,
                           unsigned threads, bool survey) {
  auto rows = TextureRows::open(scene, {&first, &second, nullptr, nullptr}, settings);
  EXPECT_TRUE(rows);
  if (!rows) return {};
  std::vector<float> out(std::size_t{rows->width()} * rows->height() * 4, std::numeric_limits<float>::quiet_NaN());
  TextureRows::Work work;
  const auto keep = [&](const TextureRows::Row& row) {
    std::copy(row.rgba[1].begin(), row.rgba[1].end(), out.begin() + static_cast<std::ptrdiff_t>(row.y * row.rgba[1].size()));
  };
  work.row = keep;
  if (survey) work.survey = [](const TextureRows::Row&) {};
  EXPECT_TRUE(rows->for_each(threads, nullptr, "test", work));
  return out;
}

struct Lookup {
  const char* name;
  Wrap wrap;
  bool nearest;
  double transform[2][3];
};
class LookedUp : public testing::TestWithParam<Lookup> {};

// The definition is sample() at the middle of each texel of the common picture.
TEST_P(LookedUp, IsWhatSampleSays) {
  const Lookup& lookup = GetParam();
  const Folder folder;
  Scene scene;
  scene.images = {picture(folder, "large.png", 96, 150), picture(folder, "small.png", 40, 70)};
  Texture first{0, Encoding::srgb}, second{1, Encoding::srgb};
  second.wrap_u = second.wrap_v = lookup.wrap;
  second.nearest = lookup.nearest;
  std::copy(&lookup.transform[0][0], &lookup.transform[0][0] + 6, &second.uv_transform[0][0]);
  const auto whole = decode(scene.images[1], Encoding::srgb);
  ASSERT_TRUE(whole);
  for (const std::uint64_t held : {std::uint64_t{0}, std::uint64_t{1} << 20}) {
    TextureSource::Settings settings;
    settings.scratch = folder.path() / "scratch";
    settings.held_texels = held;
    const auto opened = TextureRows::open(scene, {&first, &second, nullptr, nullptr}, settings);
    ASSERT_TRUE(opened);
    const std::uint32_t width = opened->width(), height = opened->height();
    for (const unsigned threads : {1u, 3u}) {
      const std::vector<float> found = rows_of(scene, first, second, settings, threads, threads == 3);
      ASSERT_EQ(found.size(), std::size_t{width} * height * 4);
      double worst = 0;
      for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
          const Rgba at = sample(*whole, second, {(x + 0.5) / width, (y + 0.5) / height});
          const double rgba[4] = {at.r, at.g, at.b, at.a};
          for (std::size_t c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(static_cast<double>(found[(std::size_t{y} * width + x) * 4 + c]) - rgba[c]));
        }
      }
      // Both decode to float: sRGB tables differ from the function by a rounding of float.
      EXPECT_LT(worst, 3e-7) << held << " held, " << threads << " threads";
    }
  }
  EXPECT_TRUE(!std::filesystem::exists(folder.path() / "scratch") || std::filesystem::is_empty(folder.path() / "scratch"));
}

INSTANTIATE_TEST_SUITE_P(Textures, LookedUp,
                         testing::Values(Lookup{"as_it_lies", Wrap::repeat, false, {{1, 0, 0}, {0, 1, 0}}},
                                         Lookup{"nearest", Wrap::repeat, true, {{1, 0, 0}, {0, 1, 0}}},
                                         Lookup{"clamped", Wrap::clamp, false, {{1, 0, 0}, {0, 1, 0}}},
                                         Lookup{"clamped_and_moved", Wrap::clamp, false, {{1, 0, 0.3}, {0, 1, 0.4}}},
                                         Lookup{"mirrored", Wrap::mirror, false, {{1, 0, 0}, {0, 1, 0}}},
                                         Lookup{"mirrored_and_moved", Wrap::mirror, false, {{1, 0, 0.3}, {0, 1, 0.4}}},
                                         Lookup{"moved", Wrap::repeat, false, {{1, 0, -0.3}, {0, 1, 0.7}}},
                                         Lookup{"twice", Wrap::repeat, false, {{2, 0, 0}, {0, 2, 0.1}}},
                                         Lookup{"often", Wrap::repeat, false, {{1, 0, 0}, {0, 7, 0}}},
                                         Lookup{"sheared", Wrap::repeat, false, {{1, 0.4, 0}, {0, 1, 0}}},
                                         Lookup{"upside_down", Wrap::repeat, false, {{1, 0, 0}, {0, -1, 1}}},
                                         Lookup{"turned", Wrap::repeat, false, {{0.8, -0.6, 0.1}, {0.6, 0.8, 0.2}}}),
                         [](const auto& made) { return made.param.name; });

TEST(TextureRows, ATextureOfTheCommonSizeIsReadAsItIs) {
  const Folder folder;
  Scene scene;
  scene.images = {picture(folder, "a.png", 50, 77, 16), picture(folder, "b.png", 50, 77, 16)};
  const Texture first{0, Encoding::linear}, second{1, Encoding::linear};
  const auto whole = decode(scene.images[1], Encoding::linear);
  ASSERT_TRUE(whole);
  const auto found = rows_of(scene, first, second, {}, 2, true);
  ASSERT_EQ(found.size(), whole->rgba.size());
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], whole->rgba[i], 1e-7);
}

// A second pass needs no file where the first one has kept what it held: one that is read as it is, and one that is looked up.
TEST(TextureRows, WhatIsKeptIsReadOnce) {
  for (const std::uint64_t kept_bytes : {std::uint64_t{0}, std::uint64_t{50 * 77 * 4}}) {
    const Folder folder;
    Scene scene;
    scene.images = {picture(folder, "a.png", 50, 77), picture(folder, "b.png", 30, 40)};
    const Texture first{0, Encoding::srgb}, second{1, Encoding::srgb};
    TextureSource::Settings settings;
    settings.held_texels = 0;
    settings.kept_bytes = kept_bytes;
    auto rows = TextureRows::open(scene, {&first, &second, nullptr, nullptr}, settings);
    ASSERT_TRUE(rows);
    std::vector<float> found[2];
    const auto pass = [&](std::vector<float>& out) {
      out.assign(std::size_t{2} * 50 * 77 * 4, -1.0f);
      TextureRows::Work work;
      work.row = [&](const TextureRows::Row& row) {
        for (std::size_t i = 0; i < 2; ++i)
          std::copy(row.rgba[i].begin(), row.rgba[i].end(), out.begin() + static_cast<std::ptrdiff_t>((i * 77 + row.y) * 50 * 4));
      };
      return rows->for_each(2, nullptr, "test", work);
    };
    ASSERT_TRUE(pass(found[0]));
    std::filesystem::remove(folder.path() / "a.png");
    std::filesystem::remove(folder.path() / "b.png");
    const Status again = pass(found[1]);
    ASSERT_EQ(static_cast<bool>(again), kept_bytes > 0);
    if (again)
      EXPECT_EQ(found[0], found[1]);
    else
      EXPECT_EQ(again.error().code, "FILE_UNREADABLE");
  }
}

// Rows see their survey and that of the next band; writers see rows that are done, each band once and in order.
TEST(TextureRows, StagesFollowEachOther) {
  const Folder folder;
  Scene scene;
  scene.images = {picture(folder, "a.png", 8, 333)};
  const Texture first{0, Encoding::linear};
  auto rows = TextureRows::open(scene, {&first, nullptr, nullptr, nullptr}, {});
  ASSERT_TRUE(rows);
  std::mutex mutex;
  std::vector<int> surveyed(333, 0), done(333, 0);
  bool in_order = true;
  std::uint32_t next = 0;
  TextureRows::Work work;
  work.survey = [&](const TextureRows::Row& row) {
    const std::scoped_lock lock(mutex);
    ++surveyed[row.y];
  };
  work.row = [&](const TextureRows::Row& row) {
    const std::scoped_lock lock(mutex);
    for (const std::uint32_t y : {row.y > 0 ? row.y - 1 : 0, row.y, std::min(row.y + 1, 332u)}) in_order = in_order && surveyed[y] == 1;
    ++done[row.y];
  };
  work.writers = 1;
  work.write = [&](std::size_t, std::uint32_t begin, std::uint32_t count) {
    const std::scoped_lock lock(mutex);
    in_order = in_order && begin == next;
    for (std::uint32_t y = begin; y < begin + count; ++y) in_order = in_order && done[y] == 1;
    next = begin + count;
    return Status(Done{});
  };
  ASSERT_TRUE(rows->for_each(3, nullptr, "test", work));
  EXPECT_TRUE(in_order);
  EXPECT_EQ(next, 333u);
  EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](int n) { return n == 1; }));
}

TEST(TextureRows, AbsurdTransformsAreNamed) {
  const Folder folder;
  Scene scene;
  scene.images = {picture(folder, "a.png", 4, 4), picture(folder, "b.png", 8, 8)};
  const Texture plain{0, Encoding::linear};
  Texture flat{1, Encoding::linear}, infinite = flat, other_set = flat;
  flat.uv_transform[0][0] = flat.uv_transform[1][1] = 0;
  infinite.uv_transform[0][2] = std::numeric_limits<double>::infinity();
  other_set.uv_set = 1;
  for (const Texture* bad : {&flat, &infinite, &other_set}) {
    const auto rows = TextureRows::open(scene, {bad, &plain, nullptr, nullptr}, {});
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().code, "TEXTURES_UNRELATED");
    EXPECT_FALSE(rows.error().text.empty());
  }
}

TEST(TextureRows, AnErrorOfAWriterEndsTheWork) {
  const Folder folder;
  Scene scene;
  scene.images = {picture(folder, "a.png", 4, 400)};
  const Texture first{0, Encoding::linear};
  auto rows = TextureRows::open(scene, {&first, nullptr, nullptr, nullptr}, {});
  ASSERT_TRUE(rows);
  TextureRows::Work work;
  work.row = [](const TextureRows::Row&) {};
  work.writers = 1;
  std::size_t calls = 0;
  work.write = [&](std::size_t, std::uint32_t, std::uint32_t) {
    ++calls;
    return Status(Error{"FILE_UNWRITABLE", "the disk is full", {}, {}, {}});
  };
  const Status done = rows->for_each(2, nullptr, "test", work);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(calls, 1u);
}

}  // namespace
}  // namespace etendue
