#include "etendue/picture_write.h"
#include "folder.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

namespace etendue {
namespace {

Picture two_by_three() {
  Picture p;
  p.width = 2;
  p.height = 3;
  Layer& beauty = p.add("", 3);
  for (std::size_t i = 0; i < beauty.pixels.size(); ++i) beauty.pixels[i] = 0.1f * static_cast<float>(i) + 1e6f;
  Layer& light = p.add("light.key lamp", 3);
  for (std::size_t i = 0; i < light.pixels.size(); ++i) light.pixels[i] = -1.5f * static_cast<float>(i);
  Layer& object = p.add("object", 1);
  for (std::size_t i = 0; i < object.pixels.size(); ++i) object.pixels[i] = static_cast<float>(i);
  return p;
}

TEST(Exr, AllLayersAndAttributesComeBack) {
  Picture p = two_by_three();
  p.numbers = {{"expTime", 1.0 / 64}, {"aperture", 2.0}, {"isoSpeed", 400}, {"etendue:seeds", 16}, {"etendue:tenth", 0.1}};
  p.texts = {{"comments", "direct light"}, {"etendue:scene", "kitchen.rig.json"}};
  const test::Folder folder;
  const auto file = folder.path() / "layers.exr";
  const Status written = write_exr(p, file);
  ASSERT_TRUE(written.ok()) << written.error().text;
  const Result<Picture> back = read_exr(file);
  ASSERT_TRUE(back.ok()) << back.error().text;
  EXPECT_EQ(back->width, 2u);
  EXPECT_EQ(back->height, 3u);
  EXPECT_EQ(back->layers.size(), 3u);
  for (const Layer& layer : p.layers) {
    const Layer* found = back->find(layer.name);
    ASSERT_NE(found, nullptr) << layer.name;
    EXPECT_EQ(found->channels, layer.channels);
    EXPECT_EQ(found->pixels, layer.pixels);  // float32 is stored without loss
  }
  EXPECT_EQ(back->numbers.at("whiteLuminance"), 1.0);  // pixels are cd/m2
  EXPECT_EQ(back->numbers.at("expTime"), 1.0 / 64);
  EXPECT_EQ(back->numbers.at("aperture"), 2.0);
  EXPECT_EQ(back->numbers.at("isoSpeed"), 400.0);
  EXPECT_EQ(back->numbers.at("etendue:seeds"), 16.0);
  EXPECT_EQ(back->numbers.at("etendue:tenth"), 0.1);  // ours keep all digits
  EXPECT_EQ(back->texts.at("comments"), "direct light");
  EXPECT_EQ(back->texts.at("etendue:scene"), "kitchen.rig.json");
}

Picture level(std::uint32_t width, std::uint32_t height, float value) {
  Picture p;
  p.width = width, p.height = height;
  Layer& layer = p.add("roughness", 1);
  for (std::size_t i = 0; i < layer.pixels.size(); ++i) layer.pixels[i] = value + static_cast<float>(i);
  return p;
}

TEST(ExrLevels, EveryLevelIsThere) {
  const test::Folder folder;
  const auto file = folder.path() / "levels.exr";
  const std::vector<Picture> levels{level(70, 5, 0.25f), level(35, 2, 1000), level(17, 1, 2000), level(8, 1, 3000),
                                    level(4, 1, 4000),   level(2, 1, 5000),  level(1, 1, 6000)};
  const Status written = write_exr_levels(levels, file);
  ASSERT_TRUE(written.ok()) << written.error().text;
  const auto input = OIIO::ImageInput::open(file.string());
  ASSERT_TRUE(input) << OIIO::geterror();
  for (int i = 0; i < 7; ++i) {
    const Picture& expected = levels[static_cast<std::size_t>(i)];
    ASSERT_TRUE(input->seek_subimage(0, i)) << i;
    ASSERT_EQ(static_cast<std::uint32_t>(input->spec().width), expected.width);
    ASSERT_EQ(static_cast<std::uint32_t>(input->spec().height), expected.height);
    std::vector<float> pixels(expected.layers[0].pixels.size());
    ASSERT_TRUE(input->read_image(0, i, 0, 1, OIIO::TypeDesc::FLOAT, pixels.data())) << input->geterror();
    EXPECT_EQ(pixels, expected.layers[0].pixels) << i;
  }
  EXPECT_FALSE(input->seek_subimage(0, 7));
}

TEST(ExrLevels, RefusesWhatIsNoChain) {
  const test::Folder folder;
  const auto file = folder.path() / "no_levels.exr";
  const auto text = [&file](const std::vector<Picture>& levels) {
    const Status written = write_exr_levels(levels, file);
    return written ? std::string("written") : written.error().text;
  };
  EXPECT_EQ(text({}), "expected at least one level");
  EXPECT_EQ(text({level(4, 4, 0), level(2, 1, 0)}), "level 1: expected 2 x 2 pixels");
  EXPECT_EQ(text({level(4, 4, 0), level(2, 2, 0)}), "expected levels down to one pixel");
  Picture other = level(1, 1, 0);
  other.layers[0].name = "normal";
  EXPECT_EQ(text({level(2, 2, 0), other}), "level 1: expected the layers of level 0");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Exr, RefusesWhatIsNotAPicture) {
  const test::Folder folder;
  const auto file = folder.path() / "not.exr";
  std::ofstream(file) << "this is no picture at all";
  const Result<Picture> read = read_exr(file);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().code, "PICTURE_UNSUITABLE");
  EXPECT_EQ(read.error().where.file, file.string());
  EXPECT_EQ(read_exr(folder.path() / "absent.exr").error().code, "FILE_UNREADABLE");
}

TEST(Exr, RefusesATruncatedFile) {
  const test::Folder folder;
  const auto file = folder.path() / "truncated.exr";
  ASSERT_TRUE(write_exr(two_by_three(), file).ok());
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 20);
  EXPECT_FALSE(read_exr(file).ok());
}

// The data window of a small file, widened to 2^13 x 2^13: nothing of that length can hold as many pixels.
TEST(Exr, RefusesMorePixelsThanTheFileCanHold) {
  const test::Folder folder;
  const auto file = folder.path() / "widened.exr";
  ASSERT_TRUE(write_exr(two_by_three(), file).ok());
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  const std::string key("dataWindow\0box2i\0\x10\0\0\0", 21);
  const std::size_t window = bytes.find(key);
  ASSERT_NE(window, std::string::npos);
  const std::string far_corner("\xff\x1f\0\0\xff\x1f\0\0", 8);
  bytes.replace(window + key.size() + 8, 8, far_corner);
  std::ofstream(file, std::ios::binary) << bytes;
  const Result<Picture> read = read_exr(file);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().code, "PICTURE_UNSUITABLE");
  EXPECT_NE(read.error().text.find("8192 x 8192 pixels"), std::string::npos) << read.error().text;
}

TEST(Exr, RefusesMorePixelsThanAsked) {
  const test::Folder folder;
  const auto file = folder.path() / "six.exr";
  ASSERT_TRUE(write_exr(two_by_three(), file).ok());
  EXPECT_TRUE(read_exr(file, 6).ok());
  EXPECT_EQ(read_exr(file, 5).error().code, "PICTURE_UNSUITABLE");
}

// OpenEXR reads a box's sixteen bytes whatever length stands before them; what follows would be read otherwise than it was checked.
TEST(Exr, RefusesAnAttributeOfAnotherLengthThanItsType) {
  const test::Folder folder;
  const auto file = folder.path() / "length.exr";
  ASSERT_TRUE(write_exr(two_by_three(), file).ok());
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  const std::size_t length = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17;
  bytes[length] = 8;
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_NE(read_exr(file).error().text.find("box2i is 8 bytes"), std::string::npos);
}

// Deflate's best case must not be refused: one value throughout.
TEST(Exr, ReadsAPictureThatCompressesWell) {
  Picture flat;
  flat.width = flat.height = 2048;
  flat.add("", 3);
  const test::Folder folder;
  const auto file = folder.path() / "flat.exr";
  ASSERT_TRUE(write_exr(flat, file).ok());
  EXPECT_LT(std::filesystem::file_size(file), 2048u * 2048 * 12 / 200);
  EXPECT_TRUE(read_exr(file).ok());
}

TEST(Exr, WritesNothingWhenThePictureIsInconsistent) {
  Picture p = two_by_three();
  p.layers[1].pixels.pop_back();
  const test::Folder folder;
  const auto file = folder.path() / "never.exr";
  EXPECT_EQ(write_exr(p, file).error().code, "PICTURE_UNSUITABLE");
  EXPECT_FALSE(std::filesystem::exists(file));
  p = two_by_three();
  p.numbers["channels"] = 1;
  EXPECT_EQ(write_exr(p, file).error().code, "PICTURE_UNSUITABLE");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Layers, NamesThatWouldSplitAChannelAreMadeSafe) {
  EXPECT_EQ(layer_safe("key.001"), "key_001");
  EXPECT_EQ(layer_safe("a\nb\x7f"), "a_b_");
  EXPECT_EQ(layer_safe("K\xc3\xbc"
                       "che 2"),
            "K\xc3\xbc"
            "che 2");
}

// A picture in the portable pixmap format, 8 bits a channel.
ImageRef pixmap(const test::Folder& folder, int width, int height, const std::vector<unsigned char>& bytes) {
  const std::string header = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  return {folder.write("picture.ppm", header + std::string(bytes.begin(), bytes.end())).string(), nullptr, "", "picture"};
}

TEST(Decode, SrgbHasTheStandardsValues) {
  // IEC 61966-2-1: 0 and 1 are fixed points; 188 is near the middle, .5029; 10/255 lies on the straight part, 10/255/12.92.
  const test::Folder folder;
  const ImageRef image = pixmap(folder, 2, 2, {0, 255, 188, 10, 11, 128, 1, 2, 3, 4, 5, 6});
  const Result<DecodedImage> d = decode(image, Encoding::srgb);
  ASSERT_TRUE(d.ok()) << d.error().text;
  ASSERT_EQ(d->rgba.size(), 16u);
  EXPECT_EQ(d->rgba[0], 0.0f);
  EXPECT_EQ(d->rgba[1], 1.0f);
  EXPECT_NEAR(d->rgba[2], 0.5028865, 1e-6);
  EXPECT_EQ(d->rgba[3], 1.0f);  // no alpha in the file
  EXPECT_NEAR(d->rgba[4], 10 / 255.0 / 12.92, 1e-8);
  EXPECT_NEAR(d->rgba[5], 0.0033465, 1e-6);
  EXPECT_NEAR(d->rgba[6], 0.2158605, 1e-6);
  const Result<DecodedImage> raw = decode(image, Encoding::linear);
  ASSERT_TRUE(raw.ok());
  EXPECT_NEAR(raw->rgba[2], 188 / 255.0, 1e-7);
}

TEST(Decode, RefusesTooLargeAndUnknown) {
  const test::Folder folder;
  const ImageRef image = pixmap(folder, 2, 2, std::vector<unsigned char>(12));
  EXPECT_EQ(decode(image, Encoding::linear, 3).error().code, "PICTURE_UNSUITABLE");
  EXPECT_EQ(decode({"absent.png", nullptr, "", ""}, Encoding::linear).error().code, "FILE_UNREADABLE");
  const SharedBytes junk(std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_EQ(decode({"", junk, "image/png", "junk"}, Encoding::linear).error().code, "FILE_UNREADABLE");
}

// 150 rows are read as 64, 64 and 22.
TEST(Decode, RowsAreThePictureFromTheTop) {
  std::vector<unsigned char> bytes(std::size_t{5} * 150 * 3);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(7 * i + i / 450);
  const test::Folder folder;
  const ImageRef image = pixmap(folder, 5, 150, bytes);
  const Result<DecodedImage> whole = decode(image, Encoding::srgb);
  ASSERT_TRUE(whole.ok());
  std::vector<float> rows;
  std::uint32_t next = 0;
  const Status read = decode_rows(image, Encoding::srgb, [&](const ImageRow& row) {
    EXPECT_EQ(row.y, next++);
    EXPECT_EQ(row.width, 5u);
    EXPECT_EQ(row.height, 150u);
    rows.insert(rows.end(), row.rgba.begin(), row.rgba.end());
  });
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(rows, whole->rgba);
  const auto ignored = [](const ImageRow&) {};
  EXPECT_EQ(decode_rows(image, Encoding::linear, ignored, 700).error().code, "PICTURE_UNSUITABLE");
  EXPECT_EQ(decode_rows({"absent.png", nullptr, "", ""}, Encoding::linear, ignored).error().code, "FILE_UNREADABLE");
}

TEST(Decode, EmbeddedBytesKeepColoursUnderTransparentAlpha) {
  // A 1 x 1 PNG of 8-bit RGBA (200, 100, 50, 0): the colour must not be multiplied by alpha.
  const SharedBytes png(std::vector<std::uint8_t>{0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
                                                  0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00,
                                                  0x00, 0x1f, 0x15, 0xc4, 0x89, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x44, 0x41, 0x54, 0x78,
                                                  0x9c, 0x63, 0x38, 0x91, 0x62, 0xc4, 0x00, 0x00, 0x04, 0xb5, 0x01, 0x5f, 0xa0, 0x8d,
                                                  0x80, 0xd0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82});
  const Result<DecodedImage> d = decode({"", png, "image/png", "dot"}, Encoding::linear);
  ASSERT_TRUE(d.ok()) << d.error().text;
  EXPECT_NEAR(d->rgba[0], 200 / 255.0, 1e-6);
  EXPECT_NEAR(d->rgba[1], 100 / 255.0, 1e-6);
  EXPECT_NEAR(d->rgba[2], 50 / 255.0, 1e-6);
  EXPECT_EQ(d->rgba[3], 0.0f);
}

// Red is the column, green the row.
DecodedImage ramp() {
  DecodedImage d{4, 2, {}};
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) d.rgba.insert(d.rgba.end(), {static_cast<float>(x), static_cast<float>(y), 0.0f, 1.0f});
  }
  return d;
}

TEST(Sample, TexelCentresAndTheirMiddles) {
  const DecodedImage d = ramp();
  Texture t;
  t.wrap_u = t.wrap_v = Wrap::clamp;
  EXPECT_DOUBLE_EQ(sample(d, t, {0.5 / 4, 0.25}).r, 0);
  EXPECT_DOUBLE_EQ(sample(d, t, {1.5 / 4, 0.25}).r, 1);
  EXPECT_DOUBLE_EQ(sample(d, t, {2.0 / 4, 0.25}).r, 1.5);
  EXPECT_DOUBLE_EQ(sample(d, t, {0.5, 0.25}).g, 0);  // v = 0 is the first row
  EXPECT_DOUBLE_EQ(sample(d, t, {0.5, 0.75}).g, 1);
  EXPECT_DOUBLE_EQ(sample(d, t, {0.5, 0.5}).g, 0.5);
}

TEST(Sample, WrapModes) {
  const DecodedImage d = ramp();
  Texture t;
  t.wrap_v = Wrap::clamp;
  t.wrap_u = Wrap::clamp;
  EXPECT_DOUBLE_EQ(sample(d, t, {0, 0}).r, 0);
  EXPECT_DOUBLE_EQ(sample(d, t, {7.3, -5}).r, 3);
  t.wrap_u = Wrap::repeat;
  EXPECT_DOUBLE_EQ(sample(d, t, {0, 0}).r, 1.5);  // half of column 3, half of column 0
  EXPECT_DOUBLE_EQ(sample(d, t, {-1 + 1.5 / 4, 0}).r, 1);
  EXPECT_DOUBLE_EQ(sample(d, t, {3 + 2.5 / 4, 0}).r, 2);
  EXPECT_DOUBLE_EQ(sample(d, t, {65536 + 2.5 / 4, 0}).r, 2);
  t.wrap_u = Wrap::mirror;
  EXPECT_DOUBLE_EQ(sample(d, t, {0, 0}).r, 0);
  EXPECT_DOUBLE_EQ(sample(d, t, {1 + 0.5 / 4, 0}).r, 3);
  EXPECT_DOUBLE_EQ(sample(d, t, {-2.5 / 4, 0}).r, 2);
  EXPECT_DOUBLE_EQ(sample(d, t, {65537 + 0.5 / 4, 0}).r, 3);
}

TEST(Sample, CellsAreQuartersOfATexelWithTheValueOfTheirMiddle) {
  const DecodedImage d = ramp();
  Texture t;
  t.wrap_u = t.wrap_v = Wrap::clamp;
  ASSERT_EQ(cut_out_cells(d, t), 4u);
  // Between the centres of columns 1 and 2, red is 1 to 2: the four cells there have their middles at 1/8, 3/8, 5/8, 7/8.
  for (int cell = 0; cell < 4; ++cell) {
    for (const double within : {0.05, 0.5, 0.95}) {
      EXPECT_DOUBLE_EQ(sample_cell(d, t, {(1.5 + (cell + within) / 4) / 4, 0.25}).r, 1 + (2 * cell + 1) / 8.0) << cell << ' ' << within;
    }
  }
  t.uv_transform[0][2] = 0.25;  // one column further
  EXPECT_DOUBLE_EQ(sample_cell(d, t, {1.55 / 4, 0.25}).r, 2.125);
  t.nearest = true;
  EXPECT_EQ(cut_out_cells(d, t), 1u);
  EXPECT_EQ(sample_cell(d, t, {1.55 / 4, 0.25}).r, 2);
}

TEST(Sample, NearestTransformAndNonsense) {
  const DecodedImage d = ramp();
  Texture t;
  t.nearest = true;
  EXPECT_EQ(sample(d, t, {0.74, 0.4}).r, 2);
  EXPECT_EQ(sample(d, t, {0.76, 0.6}).r, 3);
  EXPECT_EQ(sample(d, t, {0.76, 0.6}).g, 1);
  t.uv_transform[0][0] = 0;
  t.uv_transform[0][1] = 1;  // u' = v + 1/4
  t.uv_transform[0][2] = 0.25;
  EXPECT_EQ(sample(d, t, {0, 0.3}).r, 2);
  const Rgba nonsense = sample(d, t, {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isfinite(nonsense.r));
  EXPECT_TRUE(std::isfinite(sample(d, t, {1e300, -1e300}).g));
}

}  // namespace
}  // namespace etendue
