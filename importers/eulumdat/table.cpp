// Lines 28 to 30: the angles and the intensities.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::eulumdat {

bool Reader::read_numbers(std::span<double> out, const char* what) {
  if (!numbers_.read(out)) return fail(numbers_.failure(reporter_, fmt::format("{} {} of {}", what, numbers_.failed_at() + 1, out.size())));
  if (!numbers_.comma_was_decimal()) return true;
  field_ = numbers_.token();
  return note_comma();
}

bool Reader::judge_angles(const std::vector<double>& angles, double highest, const char* what, const char* begin) {
  const auto bad = std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) { return !(a < b); });
  photometric::NumberReader again(begin, numbers_.end(), photometric::Comma::decimal);
  const auto place_of = [&](std::size_t index) {
    double skipped = 0;
    for (std::size_t i = 0; i <= index; ++i)
      if (!again.read(skipped)) break;
    return again.token();
  };
  if (bad != angles.end())
    return fail("ANGLES_NOT_INCREASING", fmt::format("expected {} angles that increase, found {} behind {}", what, bad[1], bad[0]),
                place_of(static_cast<std::size_t>(bad - angles.begin()) + 1), "a line before may be missing or too many");
  if (angles.front() < 0 || angles.back() > highest)
    return fail("ANGLES_RANGE", fmt::format("expected {} angles within 0..{}, found {}..{}", what, highest, angles.front(), angles.back()),
                place_of(0), "a line before may be missing or too many");
  return true;
}

bool Reader::judge_steps(const EulumdatRecord& record, const std::vector<double>& c_deg, const std::vector<double>& gamma_deg,
                         const char* place) {
  const auto differs = [](const std::vector<double>& angles, double step) {
    if (step == 0) return false;
    for (std::size_t i = 1; i < angles.size(); ++i)
      if (std::abs(angles[i] - angles[i - 1] - step) > 1e-3) return true;
    return false;
  };
  if (differs(c_deg, record.c_step_deg) &&
      !repair("C_STEP_MISMATCH", fmt::format("the C angles are not {} deg apart as Dc says; the angles are used", record.c_step_deg),
              place))
    return false;
  return !differs(gamma_deg, record.gamma_step_deg) ||
         repair("GAMMA_STEP_MISMATCH",
                fmt::format("the gamma angles are not {} deg apart as Dg says; the angles are used", record.gamma_step_deg), place);
}

bool Reader::choose_planes(const Table& table, const std::vector<double>& c, IntensityGrid& grid, const char* place) {
  for (std::size_t i = 0; i < table.stored; ++i) {
    const std::size_t plane = table.first + i;
    grid.horizontal_deg.push_back(table.symmetry != 3 ? c[plane] : plane < table.planes ? c[plane] - 360 : c[plane - table.planes]);
  }
  const std::vector<double>& h = grid.horizontal_deg;
  const auto expect = [&](double first, double last) {
    return (h.front() == first && h.back() == last) ||
           fail("HORIZONTAL_RANGE",
                fmt::format("expected the stored planes of symmetry {} to reach from C{} to C{}, found {}..{}", table.symmetry,
                            first < 0 ? first + 360 : first, last, h.front() < 0 ? h.front() + 360 : h.front(), h.back()),
                place, "the C angles or the symmetry are wrong");
  };
  switch (table.symmetry) {
    case 2:
      grid.symmetry = WebSymmetry::about_0_180;
      return expect(0, 180);
    case 3:
      grid.symmetry = WebSymmetry::about_90_270;
      return expect(-90, 90);
    case 4:
      grid.symmetry = WebSymmetry::quadrant;
      return expect(0, 90);
    default:
      grid.symmetry = table.stored == 1 ? WebSymmetry::rotational : WebSymmetry::none;
      return true;
  }
}

bool Reader::judge_values(IntensityGrid& grid, double factor, const char* begin) {
  const auto [lowest, highest] = std::minmax_element(grid.values.begin(), grid.values.end());
  if (!(*highest * std::max(1.0, factor) <= largest_candelas))
    return fail("NUMBER_RANGE", fmt::format("expected candelas of {:g} at most, found {} x {}", largest_candelas, *highest, factor),
                numbers_.token(), "check the conversion factor");
  if (*lowest >= 0) return true;
  photometric::NumberReader again(begin, numbers_.end(), photometric::Comma::decimal);
  const char* first = nullptr;
  std::size_t count = 0;
  const double tolerated = -1e-3 * *highest;
  for (double& value : grid.values) {
    double read = 0;
    if (!again.read(read) || value >= 0) continue;
    if (value < tolerated)
      return fail("CANDELA_NEGATIVE", fmt::format("expected intensities of 0 or more, found {}", value), again.token(),
                  "a line before may be missing");
    if (first == nullptr) first = again.token();
    ++count;
    value = 0;
  }
  return repair("CANDELA_NEGATIVE", fmt::format("{} intensities are negative by less than a thousandth of the peak; set to 0", count),
                first);
}

bool Reader::read_table(const EulumdatRecord& record, const Table& table, IntensityDistribution& out, std::vector<double>& c_deg) {
  IntensityGrid& grid = out.grid;
  grid.type = WebType::c;
  c_deg.resize(table.planes);
  grid.vertical_deg.resize(table.gammas);
  numbers_.skip_separators();
  const char* const c_begin = numbers_.position();
  if (!read_numbers(c_deg, "C angle") || !judge_angles(c_deg, 360, "C", c_begin)) return false;
  const char* const gamma_begin = numbers_.position();
  if (!read_numbers(grid.vertical_deg, "gamma angle") || !judge_angles(grid.vertical_deg, 180, "gamma", gamma_begin)) return false;
  if (!judge_steps(record, c_deg, grid.vertical_deg, c_begin) || !choose_planes(table, c_deg, grid, c_begin)) return false;
  const double first = grid.vertical_deg.front(), last = grid.vertical_deg.back();
  if (!((first == 0 || first == 90) && (last == 90 || last == 180)) &&
      !repair("VERTICAL_RANGE", fmt::format("gamma angles {}..{} leave a part untabulated; it is dark", first, last), gamma_begin))
    return false;

  numbers_.skip_separators();
  const char* const begin = numbers_.position();
  grid.values.resize(table.stored * table.gammas);
  const double factor = record.conversion_factor * record.lamp_sets[options_.lamp_set].flux_lm / 1000;
  return read_numbers(grid.values, "intensity") && judge_values(grid, factor, begin) && review_tail();
}

bool Reader::review_tail() {
  numbers_.skip_separators();
  const char* p = numbers_.position();
  while (p != numbers_.end() && *p == '\x1a') ++p;
  if (p == numbers_.end()) return true;
  const char* line = p;
  const std::string found = photometric::to_utf8(photometric::take_line(line, numbers_.end()).substr(0, 40));
  return repair("TRAILING_TEXT", fmt::format("expected the end of the file behind the last intensity, found \"{}\"; ignored", found), p,
                "if these are intensities, a count or the symmetry is wrong");
}

}  // namespace etendue::eulumdat
