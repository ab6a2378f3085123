// Angles and candelas.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::ies {
namespace {

bool near(double a, double b) { return std::abs(a - b) <= 1e-6; }

}  // namespace

bool Reader::read_angles(std::vector<double>& angles, std::size_t count, const char* kind) {
  angles.resize(count);
  const char* const begin = numbers_.position();
  if (!numbers_.read(angles)) {
    const std::size_t at = numbers_.failed_at();
    return fail(numbers_.failure(reporter_, fmt::format("{} angle {} of {}", kind, at + 1, count)));
  }
  const auto bad = std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) { return !(a < b); });
  if (bad == angles.end()) return true;
  // Back to the number that is too small.
  photometric::NumberReader again(begin, numbers_.end(), photometric::Comma::separates);
  double skipped = 0;
  for (auto a = angles.begin(); a != bad + 2; ++a)
    if (!again.read(skipped)) break;
  return fail("ANGLES_NOT_INCREASING", fmt::format("expected {} angles that increase, found {} behind {}", kind, bad[1], bad[0]),
              again.token(), "a count or a number before may be missing, or the angles are out of order");
}

bool Reader::judge_vertical(const IntensityGrid& grid, const char* place) {
  const double first = grid.vertical_deg.front(), last = grid.vertical_deg.back();
  const bool c = grid.type == WebType::c;
  const double lowest = c ? 0 : grid.type == WebType::b ? -180 : -90, highest = grid.type == WebType::a ? 90 : 180;
  if (first < lowest || last > highest)
    return fail("ANGLES_RANGE", fmt::format("expected vertical angles within {}..{}, found {}..{}", lowest, highest, first, last), place,
                "a count or a number before may be missing");
  const bool usual = c ? (first == 0 || first == 90) && (last == 90 || last == 180) : (first == -90 || first == 0) && last == 90;
  return usual || repair("VERTICAL_RANGE", fmt::format("vertical angles {}..{} leave a part untabulated; it is dark", first, last), place);
}

bool Reader::judge_horizontal(IntensityGrid& grid, IesVersion version, const char* place) {
  if (grid.type == WebType::c) return judge_horizontal_c(grid, version, place);
  const double first = grid.horizontal_deg.front(), last = grid.horizontal_deg.back(), highest = grid.type == WebType::b ? 90 : 180;
  if (grid.horizontal_deg.size() < 2)
    return fail("COUNT_INVALID", "expected at least two horizontal angles in type A or B, found one", place, "a count may be wrong");
  if (first < -highest || last > highest)
    return fail("ANGLES_RANGE", fmt::format("expected horizontal angles within {}..{}, found {}..{}", -highest, highest, first, last),
                place, "a count or a number before may be missing");
  const bool lateral = first == 0, vertical = grid.vertical_deg.front() == 0;
  grid.symmetry = lateral && vertical ? WebSymmetry::lateral_and_vertical
                  : lateral           ? WebSymmetry::lateral
                  : vertical          ? WebSymmetry::vertical
                                      : WebSymmetry::none;
  if (vertical) reporter_.note("VERTICAL_MIRROR", "vertical angles begin at 0: the lower half mirrors the upper one", place);
  return ((first == -90 || first == 0) && last == 90) ||
         repair("HORIZONTAL_PART", fmt::format("horizontal angles {}..{} leave a part untabulated; it is dark", first, last), place);
}

bool Reader::judge_horizontal_c(IntensityGrid& grid, IesVersion version, const char* place) {
  const std::vector<double>& h = grid.horizontal_deg;
  const double first = h.front(), last = h.back(), range = last - first;
  if (first < -360 || last > 720 || range > 360 + 1e-6)
    return fail("ANGLES_RANGE", fmt::format("expected horizontal angles within one turn, found {}..{}", first, last), place,
                "a count or a number before may be missing");
  if (h.size() == 1) {
    grid.symmetry = WebSymmetry::rotational;
    return true;
  }
  const bool quarter_turn = std::fmod(first, 90) == 0;
  const bool standard = first == 0 || (first == 90 && last == 270 && version <= IesVersion::lm_63_1995);
  const auto as = [&](WebSymmetry symmetry) {
    grid.symmetry = symmetry;
    return standard ||
           repair("HORIZONTAL_START",
                  fmt::format("horizontal angles {}..{} are not those of this version; read as {}", first, last, name_of(symmetry)), place);
  };
  if (range == 360) return as(WebSymmetry::none);
  if (range == 180 && quarter_turn) return as(std::fmod(first, 180) == 0 ? WebSymmetry::about_0_180 : WebSymmetry::about_90_270);
  if (range == 90 && quarter_turn) return as(WebSymmetry::quadrant);
  const double gap = 360 - range;
  if (range > 180 && (near(gap, h[1] - h[0]) || near(gap, last - h[h.size() - 2]))) {
    grid.symmetry = WebSymmetry::none;
    return repair("PLANE_360_MISSING",
                  fmt::format("expected a last plane at {}, found {}; the first plane closes the circle", first + 360, last), place);
  }
  return fail("HORIZONTAL_RANGE", fmt::format("expected horizontal angles 0, 0..90, 0..180, 90..270 or 0..360, found {}..{}", first, last),
              place, "what lies between is not measured and cannot be made up: complete the file");
}

bool Reader::read_values(IntensityGrid& grid, const IesRecord& record) {
  const std::size_t verticals = grid.vertical_deg.size(), planes = grid.horizontal_deg.size();
  grid.values.resize(verticals * planes);
  numbers_.skip_separators();
  const char* const begin = numbers_.position();
  numbers_.move_to(begin);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    if (plane > 0 && !begin_record()) return false;
    if (!numbers_.read({&grid.values[plane * verticals], verticals})) {
      const std::size_t at = plane * verticals + numbers_.failed_at() + 1;
      return fail(numbers_.failure(reporter_, fmt::format("candela {} of {}", at, grid.values.size())));
    }
  }
  const auto [lowest, highest] = std::minmax_element(grid.values.begin(), grid.values.end());
  if (*lowest < 0 && !judge_negative(grid, begin)) return false;
  double factor = record.multiplier * record.ballast_factor;
  if (record.version <= IesVersion::lm_63_1991) factor *= record.third_factor;
  return *highest * std::max(1.0, factor) <= largest_candelas ||
         fail("NUMBER_RANGE", fmt::format("expected candelas of {:g} at most, found {} x {}", largest_candelas, *highest, factor),
              numbers_.token(), "check the multiplier");
}

// Noise of a subtraction is set to zero; light that is negative by more than a thousandth of the peak is no light.
bool Reader::judge_negative(IntensityGrid& grid, const char* begin) {
  const double highest = *std::max_element(grid.values.begin(), grid.values.end());
  photometric::NumberReader again(begin, numbers_.end(), photometric::Comma::separates);
  const char* first = nullptr;
  std::size_t count = 0;
  for (double& value : grid.values) {
    double read = 0;
    if (!again.read(read) || !(value < 0)) continue;
    if (value < -1e-3 * highest)
      return fail("CANDELA_NEGATIVE", fmt::format("expected candelas of 0 or more, found {}", value), again.token(),
                  "a number before may be missing");
    if (first == nullptr) first = again.token();
    ++count;
    value = 0;
  }
  return repair("CANDELA_NEGATIVE", fmt::format("{} candelas are negative by less than a thousandth of the peak; set to 0", count), first);
}

bool Reader::review_tail() {
  numbers_.skip_separators();
  const char* p = numbers_.position();
  while (p != numbers_.end() && (*p == '\x1a' || photometric::is_blank(*p) || photometric::is_eol(*p))) ++p;
  if (p == numbers_.end()) return true;
  const char* line = p;
  const std::string found = photometric::to_utf8(photometric::take_line(line, numbers_.end()).substr(0, 40));
  return repair("TRAILING_TEXT", fmt::format("expected the end of the file behind the last candela, found \"{}\"; ignored", found), p,
                "if these are candelas, a count is wrong");
}

}  // namespace etendue::ies
