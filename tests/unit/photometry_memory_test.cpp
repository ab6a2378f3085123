// What the readers take from the heap, counted: at most four times the file and 1 MB, and at most 1 MB for a file refused for its counts.
#include <gtest/gtest.h>

#include <string>

#include "counted_heap.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"

namespace etendue {
namespace {

constexpr std::size_t megabyte = 1'000'000;
using Read = Result<PhotometricFile>(std::span<const std::byte>, const std::string&, const PhotometricOptions&);

// Bytes that reading takes; whether it was read.
std::pair<std::size_t, bool> peak_of(Read* read, const std::string& text) {
  bool ok = false;
  const std::size_t bytes = test::peak_heap_of([&] { ok = read(std::as_bytes(std::span(text)), "lamp", {}).ok(); });
  return {bytes, ok};
}

std::string repeated(const std::string& what, std::size_t count) {
  std::string text;
  text.reserve(what.size() * count);
  for (std::size_t i = 0; i < count; ++i) text += what;
  return text;
}

std::string ies_of(const std::string& counts, const std::string& rest) {
  return "IESNA:LM-63-2002\n[TEST] 1\n[TESTLAB] b\n[ISSUEDATE] c\n[MANUFAC] d\nTILT=NONE\n1 -1 1 " + counts + " 1 2 0 0 0\n1 1 9\n" + rest;
}

TEST(PhotometryMemory, TheDensestFileTakesFourTimesItsSize) {
  std::string planes = "0";
  constexpr int angles = 91, count = 4001;
  for (int i = 1; i < count; ++i) planes += " " + std::to_string(i * 0.09);
  std::string gammas = "0";
  for (int i = 1; i < angles; ++i) gammas += " " + std::to_string(i * 2);
  const std::string text = ies_of(std::to_string(angles) + " " + std::to_string(count),
                                  gammas + "\n" + planes + "\n" + repeated(repeated("1 ", angles - 1) + "1\n", count));
  const auto [bytes, ok] = peak_of(&read_ies, text);
  EXPECT_TRUE(ok);
  EXPECT_LE(bytes, 4 * text.size() + megabyte);
}

TEST(PhotometryMemory, RefusedFilesTakeNothing) {
  const std::string filler = repeated("1 ", 2'000'000);
  for (const char* counts : {"1e30 1", "100000 100000", "1 1e30", "5000000 1"}) {
    const auto [bytes, ok] = peak_of(&read_ies, ies_of(counts, filler));
    EXPECT_FALSE(ok) << counts;
    EXPECT_LE(bytes, megabyte) << counts;
  }
  const auto [labels, read] = peak_of(&read_ies, repeated("\n", 4'000'000));
  EXPECT_FALSE(read);
  EXPECT_LE(labels, megabyte);
  const auto [ldt, ldt_read] = peak_of(&read_eulumdat, "a\n1\n0\n1e30\n5\n37\n5\n" + repeated("1\n", 2'000'000));
  EXPECT_FALSE(ldt_read);
  EXPECT_LE(ldt, megabyte);
}

}  // namespace
}  // namespace etendue
