// Packed pixel formats: ours beside the double definition element by element, which is the error's reference: 0 codes differ.
#include "units_rows.h"

#include "etendue/pixel.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace etendue::bench {
namespace {

struct Pixels {
  std::vector<Vec3f> rgb;
  std::vector<float> grey, multiplied;
  std::vector<std::uint16_t> halves;
  std::vector<std::uint32_t> words;
  std::vector<Bytes4> bytes;
};
Pixels& pixels() {
  static Pixels all = [] {
    Pixels p;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const auto x = static_cast<float>(std::exp2(static_cast<double>(i % 25) - 12) * (1 + static_cast<double>(i) / batch_size));
      p.rgb.push_back({x, x * 0.7F, x * 0.3F});
      p.grey.push_back(x);
    }
    p.multiplied.resize(batch_size);
    p.halves.resize(batch_size);
    p.words.resize(batch_size);
    p.bytes.resize(batch_size);
    return p;
  }();
  return all;
}

// Both directions of a format: the span, and the definition called for each element. `all` packs `from` into `codes`.
template <class From, class Code, class PackAll, class PackOne, class UnpackAll>
void rows_of(Bench& bench, const char* format, std::vector<From>& from, std::vector<Code>& codes, PackAll pack_all, PackOne pack_one,
             UnpackAll unpack_all) {
  Pixels& p = pixels();
  static PackCounts counts;
  Task& packing = bench.task(fmt::format("pack {}", format), batch_size);
  add_bare_multiply(packing, p.grey, p.multiplied);
  pack_all();
  std::size_t different = 0;
  for (std::size_t i = 0; i < batch_size; ++i) different += codes[i] != pack_one(from[i], counts) ? 1 : 0;
  packing.contender("etendue, span", Kind::ours, fmt::format("{} codes differ", different), [&codes, pack_all] {
    pack_all();
    keep(codes.data());
  });
  packing.contender("etendue, definition in double", Kind::ours, "0", [&from, &codes, pack_one] {
    for (std::size_t i = 0; i < batch_size; ++i) codes[i] = pack_one(from[i], counts);
    keep(codes.data());
  });
  Task& unpacking = bench.task(fmt::format("unpack {}", format), batch_size);
  add_bare_multiply(unpacking, p.grey, p.multiplied);
  unpacking.contender("etendue, span", Kind::ours, "0", [unpack_all] { keep(unpack_all()); });
}

}  // namespace

void pixel_rows(Bench& bench) {
  Pixels& p = pixels();
  static std::vector<float> numbers(batch_size);
  static std::vector<Vec3f> colours(batch_size);
  static std::vector<std::uint32_t> r11(batch_size), rgb9e5(batch_size);
  rows_of(
      bench, "half", p.grey, p.halves, [&p] { (void)pack_half(p.grey, p.halves); },
      [](float x, PackCounts& n) { return pack_half(static_cast<double>(x), n); },
      [&p] { return (void)unpack_half(p.halves, numbers), numbers.data(); });
  rows_of(
      bench, "R11G11B10F", p.rgb, r11, [&p] { (void)pack_r11g11b10f(p.rgb, r11); },
      [](const Vec3f& c, PackCounts& n) { return pack_r11g11b10f(vec_cast<double>(c), n); },
      [] { return (void)unpack_r11g11b10f(r11, colours), colours.data(); });
  rows_of(
      bench, "RGB9E5", p.rgb, rgb9e5, [&p] { (void)pack_rgb9e5(p.rgb, rgb9e5); },
      [](const Vec3f& c, PackCounts& n) { return pack_rgb9e5(vec_cast<double>(c), n); },
      [] { return (void)unpack_rgb9e5(rgb9e5, colours), colours.data(); });
  rows_of(
      bench, "RGBE", p.rgb, p.bytes, [&p] { (void)pack_rgbe(p.rgb, p.bytes); },
      [](const Vec3f& c, PackCounts& n) { return pack_rgbe(vec_cast<double>(c), n); },
      [&p] { return (void)unpack_rgbe(p.bytes, colours), colours.data(); });
}

}  // namespace etendue::bench
