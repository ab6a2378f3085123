#include "etendue/unit_names.h"

#include "edit_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace etendue {
namespace {

// Factors are quotients of whole numbers, so that they and their products are exact. 1 ft = .3048 m and 1 in = .0254 m by definition.
constexpr double square_foot = 3048. * 3048;  // in 1e-8 m2
constexpr std::array<UnitSpelling, 26> spellings{{
    {"lm", "mkM", "lumen", {Dimension::luminous_flux}},
    {"cd", "mkM", "candela", {Dimension::luminous_intensity}},
    {"cd/m2", "mkMG", "candela/m2", {Dimension::luminance}},
    {"nit", "mkMG", "nits", {Dimension::luminance}},
    {"fL", "", "foot-lambert", {Dimension::luminance, 1e8, pi* square_foot}},
    {"lx", "mkM", "lumen/m2", {Dimension::illuminance}},
    {"lux", "mkM", "luxes", {Dimension::illuminance}},
    {"fc", "", "foot-candle", {Dimension::illuminance, 1e8, square_foot}},
    {"lm/m2", "k", "lumen/m2", {Dimension::luminous_exitance}},
    {"W", "umkM", "watt", {Dimension::radiant_flux}},
    {"W/sr", "umkM", "watt/sr", {Dimension::radiant_intensity}},
    {"W/m2/sr", "umkM", "watt/m2/sr", {Dimension::radiance}},
    {"W/m2", "umkM", "watt/m2", {Dimension::irradiance}},
    {"lm/W", "", "lumen/watt", {Dimension::efficacy}},
    {"m", "umck", "metre", {Dimension::length}},
    {"in", "", "inch", {Dimension::length, 254, 1e4}},
    {"ft", "", "foot", {Dimension::length, 3048, 1e4}},
    {"deg", "", "degree", {Dimension::angle, pi, 180}},
    {"rad", "um", "radian", {Dimension::angle}},
    {"sr", "um", "steradian", {Dimension::solid_angle}},
    {"K", "", "kelvin", {Dimension::temperature}},
    {"mired", "", "mireds", {Dimension::temperature, 1e6, 1, true}},
    {"s", "um", "second", {Dimension::duration}},
    {"EV", "", "EV100", {Dimension::exposure_value}},
    {"EV_S", "", "EVS", {Dimension::exposure_value_s}},
    {"stop", "", "stops", {Dimension::stop}},
}};

struct Factor {
  double times, over;
};
constexpr Factor factor_of_prefix(char prefix) {
  switch (prefix) {
    case 'u':
      return {1, 1e6};
    case 'm':
      return {1, 1e3};
    case 'c':
      return {1, 1e2};
    case 'k':
      return {1e3, 1};
    case 'M':
      return {1e6, 1};
    default:  // 'G'
      return {1e9, 1};
  }
}

// Every spelling, prefixes included, has at most eight bytes and so is a number of 64 bits. An open hash table of them, made when this is
// compiled.
constexpr std::size_t longest = 8, table_bits = 8, table_size = 1U << table_bits;
constexpr std::uint64_t packed(std::string_view text) {
  std::uint64_t key = 0;
  for (const char c : text) key = key << 8 | static_cast<unsigned char>(c);
  return key;
}
constexpr std::size_t slot_of(std::uint64_t key) { return key * 0x9E3779B97F4A7C15U >> (64 - table_bits); }  // Fibonacci hashing

struct Entry {
  std::uint64_t key = 0;  // 0: free
  NamedUnit unit{};
};
constexpr std::array<Entry, table_size> make_table() {
  std::array<Entry, table_size> table{};
  const auto insert = [&](std::uint64_t key, const NamedUnit& unit) {
    std::size_t slot = slot_of(key);
    while (table[slot].key != 0 && table[slot].key != key) slot = (slot + 1) % table_size;
    if (table[slot].key == 0) table[slot] = {key, unit};
  };
  // Symbols first: "cd" is no hundredth of anything, whatever may be added.
  for (const UnitSpelling& s : spellings) insert(packed(s.symbol), s.unit);
  for (const UnitSpelling& s : spellings)
    for (const char prefix : s.prefixes) {
      const Factor f = factor_of_prefix(prefix);
      NamedUnit unit = s.unit;
      unit.times *= f.times;
      unit.over *= f.over;
      insert(static_cast<std::uint64_t>(static_cast<unsigned char>(prefix)) << 8 * s.symbol.size() | packed(s.symbol), unit);
    }
  return table;
}
constexpr std::array<Entry, table_size> table = make_table();

std::vector<Candidate> candidates() {
  std::vector<Candidate> all;
  for (const UnitSpelling& s : spellings) {
    const std::string symbol(s.symbol);
    all.push_back({symbol, symbol});
    all.push_back({std::string(s.name), symbol});
    for (const char prefix : s.prefixes) all.push_back({prefix + symbol, prefix + symbol});
  }
  return all;
}

}  // namespace

std::span<const UnitSpelling> unit_spellings() { return spellings; }

const NamedUnit* find_unit(std::string_view spelling) {
  if (spelling.empty() || spelling.size() > longest) return nullptr;
  const std::uint64_t key = packed(spelling);
  for (std::size_t slot = slot_of(key); table[slot].key != 0; slot = (slot + 1) % table_size)
    if (table[slot].key == key) return &table[slot].unit;
  return nullptr;
}

Result<NamedUnit> unit_named(std::string_view spelling) {
  if (const NamedUnit* const unit = find_unit(spelling)) return *unit;
  return Error{"UNIT_UNKNOWN",
               fmt::format("\"{}\" is no unit", spelling),
               {},
               fmt::format("nearest: {}", fmt::join(nearest_candidates(spelling, candidates(), 3), ", ")),
               {}};
}

}  // namespace etendue
