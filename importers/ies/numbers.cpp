// The two records of numbers: ten, then three.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::ies {
namespace {

// IES LM-63-2019's file generation types, as far as they are published: decimal-coded bits behind the point.
constexpr double generation_types[] = {1, 1.00001, 1.0001, 1.001, 1.01, 1.011, 1.1, 1.101, 1.11, 1.111};

std::optional<std::size_t> whole(double x, double most) {
  if (!(x >= 1 && x <= most) || x != std::floor(x)) return {};
  return static_cast<std::size_t>(x);
}

}  // namespace

bool Reader::read_first_record(IesRecord& record, IntensityGrid& grid, Counts& counts) {
  // The record's numbers, with where each stands.
  static constexpr const char* names[] = {"the number of lamps",
                                          "lumens per lamp",
                                          "the candela multiplier",
                                          "the number of vertical angles",
                                          "the number of horizontal angles",
                                          "the photometric type (1 = C, 2 = B, 3 = A)",
                                          "the units (1 = feet, 2 = metres)",
                                          "the width of the opening",
                                          "the length of the opening",
                                          "the height of the opening"};
  if (!begin_record()) return false;
  std::array<double, 10> x{};
  std::array<const char*, 10> at{};
  bool split = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    split = split || (i > 0 && numbers_.line_ends_here());
    if (!numbers_.read(x[i])) return fail(numbers_.failure(reporter_, fmt::format("{} as number {} of 10", names[i], i + 1)));
    at[i] = numbers_.token();
  }
  if (split && !repair("HEADER_RECORD_SPLIT", "expected the ten numbers on one line; read by their count", at[0])) return false;

  const double room = 1 + std::floor(static_cast<double>(numbers_.bytes_left()) / 2);
  for (const std::size_t i : {3u, 4u}) {
    if (!whole(x[i], room))
      return fail("COUNT_INVALID", fmt::format("expected {} as a whole number that the file can hold, found {}", names[i], x[i]), at[i],
                  "one of the ten numbers before may be missing");
  }
  counts = {static_cast<std::size_t>(x[3]), static_cast<std::size_t>(x[4])};
  if (counts.verticals < 2)
    return fail("COUNT_INVALID", "expected at least two vertical angles, found one", at[3], "one angle says nothing of a web");
  if (x[3] * x[4] > room)
    return fail("COUNT_INVALID",
                fmt::format("expected {} x {} candelas, which the {} bytes that are left cannot hold", x[3], x[4], numbers_.bytes_left()),
                at[3], "the counts are wrong or the file is truncated");
  if (!(x[5] == 1 || x[5] == 2 || x[5] == 3))
    return fail("PHOTOMETRIC_TYPE", fmt::format("expected a photometric type of 1 (C), 2 (B) or 3 (A), found {}", x[5]), at[5],
                "one of the numbers before may be missing");
  if (!(x[6] == 1 || x[6] == 2))
    return fail("UNITS_INVALID", fmt::format("expected units of 1 (feet) or 2 (metres), found {}", x[6]), at[6],
                "one of the numbers before may be missing");
  if (!(x[2] > 0))
    return fail("MULTIPLIER_INVALID", fmt::format("expected a candela multiplier above 0, found {}", x[2]), at[2], "1 changes nothing");
  grid.type = x[5] == 1 ? WebType::c : x[5] == 2 ? WebType::b : WebType::a;
  record.lamps = x[0];
  record.lumens_per_lamp = x[1];
  record.multiplier = x[2];
  record.feet = x[6] == 1;
  record.width = x[7];
  record.length = x[8];
  record.height = x[9];
  if (!whole(x[0], 1e9) && !repair("LAMP_COUNT", fmt::format("expected a whole number of lamps, found {}; kept", x[0]), at[0]))
    return false;
  if (x[1] == 0 && !repair("RATED_FLUX_ZERO", "the lamps are stated to emit 0 lm; candelas are kept", at[1])) return false;
  return !(x[1] < 0 && x[1] != -1) ||
         repair("RATED_FLUX_NEGATIVE", fmt::format("expected lumens or -1, found {}; read as absolute photometry", x[1]), at[1]);
}

bool Reader::read_second_record(IesRecord& record) {
  static constexpr const char* names[] = {"the ballast factor", "the ballast-lamp factor or file generation type", "the input watts"};
  if (!begin_record()) return false;
  std::array<double, 3> x{};
  std::array<const char*, 3> at{};
  bool split = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    split = split || (i > 0 && numbers_.line_ends_here());
    if (!numbers_.read(x[i])) return fail(numbers_.failure(reporter_, fmt::format("{} as number {} of 3", names[i], i + 1)));
    at[i] = numbers_.token();
  }
  // Angles begin at -90, 0 or 90; no ballast makes a lamp dark or ninety times as bright.
  if (x[0] <= 0 || x[0] == 90)
    return fail("BALLAST_RECORD_MISSING", fmt::format("expected the ballast factor, above 0, found {}", x[0]), at[0],
                "the record of ballast factor, future use and watts seems to be missing: these look like vertical angles");
  if (split && !repair("HEADER_RECORD_SPLIT", "expected the three numbers on one line; read by their count", at[0])) return false;
  record.ballast_factor = x[0];
  record.third_factor = x[1];
  record.watts = x[2];
  if (x[2] < 0 && !repair("WATTS_NEGATIVE", fmt::format("expected input watts of 0 or more, found {}; kept", x[2]), at[2])) return false;
  return review_factors(record, at[1]);
}

bool Reader::review_factors(const IesRecord& record, const char* third) {
  const double x = record.third_factor;
  if (record.version <= IesVersion::lm_63_1991)
    return x > 0 || fail("FACTOR_INVALID", fmt::format("expected a ballast-lamp factor above 0, found {}", x), third, "1 changes nothing");
  if (record.version == IesVersion::lm_63_2019) {
    const bool known =
        std::any_of(std::begin(generation_types), std::end(generation_types), [&](double t) { return std::abs(x - t) < 1e-9; });
    return known ||
           repair("GENERATION_UNKNOWN", fmt::format("{} is no file generation type of LM-63-2019; it multiplies nothing", x), third);
  }
  return x == 1 || repair("FUTURE_USE", fmt::format("expected 1, which is for future use, found {}; it multiplies nothing", x), third);
}

}  // namespace etendue::ies
