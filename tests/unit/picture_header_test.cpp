#include "picture_header.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

using namespace std::string_literals;

std::optional<PictureHeader> header_of(const std::string& bytes) { return picture_header(std::as_bytes(std::span(bytes))); }

void expect_size(const std::string& bytes, const std::string& format, std::uint32_t width, std::uint32_t height) {
  const auto header = header_of(bytes);
  ASSERT_TRUE(header.has_value()) << format;
  EXPECT_EQ(header->format, format);
  EXPECT_EQ(header->width, width) << format;
  EXPECT_EQ(header->height, height) << format;
}

// Headers written by hand from the formats' specifications.
TEST(PictureHeader, SizesOfEveryFormat) {
  expect_size("\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\x02\0\0\0\x01\x80"s, "png", 512, 384);
  // APP0 of 16 bytes, a fill byte, a quantisation table of 3, then a progressive frame of 300 x 200.
  expect_size("\xFF\xD8\xFF\xE0\0\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0\xFF\xFF\xDB\0\x03\0\xFF\xC2\0\x11\x08\0\xC8\x01\x2C\x03"s, "jpeg",
              300, 200);
  expect_size("RIFF\x1A\0\0\0WEBPVP8 \x0E\0\0\0\x10\0\0\x9D\x01\x2A\x40\x01\xF0\0"s, "webp", 320, 240);
  // Lossless: (320 - 1) | (240 - 1) << 14 = 0x3BC13F.
  expect_size("RIFF\x1A\0\0\0WEBPVP8L\x0E\0\0\0\x2F\x3F\xC1\x3B\0"s, "webp", 320, 240);
  expect_size("RIFF\x1A\0\0\0WEBPVP8X\x0A\0\0\0\0\0\0\0\x3F\x01\0\xEF\0\0"s, "webp", 320, 240);
  expect_size("\xABKTX 20\xBB\r\n\x1A\n\0\0\0\0\x01\0\0\0\0\x01\0\0\x80\0\0\0"s, "ktx2", 256, 128);
}

TEST(PictureHeader, WhatIsCutOffHasNoSize) {
  const auto header = header_of("\xFF\xD8\xFF\xE0\0\x10JFIF"s);
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->width, 0u);
  EXPECT_FALSE(header_of("").has_value());
  EXPECT_FALSE(header_of("glTF").has_value());
}

}  // namespace
}  // namespace etendue::test
