// Lines 1 to 27: what comes before the angles.
#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::eulumdat {

bool Reader::read_header(EulumdatRecord& record, Table& table) {
  return text_line(record.company, "the company") && read_counts(record, table) && read_luminaire(record) && read_lamp_sets(record) &&
         read_direct_ratios(record);
}

bool Reader::read_counts(EulumdatRecord& record, Table& table) {
  std::size_t type = 0;
  if (!count_line(type, "the type of luminaire (Ityp)", 0, 3)) return false;
  double symmetry = 0;
  if (!number_line(symmetry, "the symmetry (Isym)")) return false;
  if (!(symmetry == 0 || symmetry == 1 || symmetry == 2 || symmetry == 3 || symmetry == 4))
    return fail("SYMMETRY_INVALID", fmt::format("expected a symmetry (Isym) of 0 to 4, found {}", symmetry), field_,
                "a line before may be missing or too many");
  const char* const symmetry_line = field_;
  record.luminaire_type = static_cast<int>(type);
  record.symmetry = table.symmetry = static_cast<int>(symmetry);
  if (type == 1 && symmetry != 1 && symmetry != 0)
    reporter_.note("TYPE_MISMATCH", fmt::format("Ityp 1 is a point source with symmetry about its axis, Isym is {}", symmetry),
                   symmetry_line);
  if (type >= 2 && symmetry == 1)
    reporter_.note("TYPE_MISMATCH", fmt::format("Isym 1 is symmetry about the axis, Ityp is {}", type), symmetry_line);

  const std::size_t room = numbers_.bytes_left() / 2 + 1;
  if (!count_line(table.planes, "the number of C planes (Mc)", 1, room)) return false;
  if (!find_stored_planes(table, field_) || !number_line(record.c_step_deg, "the step between C planes (Dc)", Blank::zero)) return false;
  if (!count_line(table.gammas, "the number of gamma angles (Ng)", 2, room)) return false;
  if (static_cast<double>(table.gammas) * static_cast<double>(table.stored) > static_cast<double>(room))
    return fail("COUNT_INVALID",
                fmt::format("expected {} x {} intensities, which the {} bytes that are left cannot hold", table.stored, table.gammas,
                            numbers_.bytes_left()),
                field_, "the counts are wrong or the file is truncated");
  return number_line(record.gamma_step_deg, "the step between gamma angles (Dg)", Blank::zero);
}

// Isym 1: one plane; 2: C0..C180; 3: C270 through C0 to C90; 4: C0..C90.
bool Reader::find_stored_planes(Table& table, const char* place) {
  const std::size_t m = table.planes;
  static constexpr std::size_t divisor[] = {1, 1, 2, 4, 4};
  const std::size_t needed = divisor[table.symmetry];
  if (m % needed != 0 || (needed > 1 && m < needed))
    return fail("COUNT_INVALID",
                fmt::format("expected a number of C planes that symmetry {} divides by {}, found {}", table.symmetry, needed, m), place,
                "the symmetry or the number of planes is wrong");
  table.first = table.symmetry == 3 ? 3 * m / 4 : 0;
  table.stored = table.symmetry == 0 ? m : table.symmetry == 1 ? 1 : table.symmetry == 4 ? m / 4 + 1 : m / 2 + 1;
  return true;
}

bool Reader::read_luminaire(EulumdatRecord& r) {
  return text_line(r.report, "the number of the report") && text_line(r.luminaire, "the name of the luminaire") &&
         text_line(r.number, "the number of the luminaire") && text_line(r.file_name, "the name of the file") &&
         text_line(r.date, "date and user") && number_line(r.length_mm, "the length of the luminaire (mm)", Blank::zero) &&
         number_line(r.width_mm, "the width of the luminaire (mm)", Blank::zero) &&
         number_line(r.height_mm, "the height of the luminaire (mm)", Blank::zero) &&
         number_line(r.opening_length_mm, "the length of the opening (mm)", Blank::zero) &&
         number_line(r.opening_width_mm, "the width of the opening (mm)", Blank::zero) &&
         number_line(r.opening_height_mm[0], "the height of the opening towards C0 (mm)", Blank::zero) &&
         number_line(r.opening_height_mm[1], "the height of the opening towards C90 (mm)", Blank::zero) &&
         number_line(r.opening_height_mm[2], "the height of the opening towards C180 (mm)", Blank::zero) &&
         number_line(r.opening_height_mm[3], "the height of the opening towards C270 (mm)", Blank::zero) &&
         number_line(r.dff_percent, "the downward flux fraction (%)", Blank::zero) &&
         number_line(r.lorl_percent, "the light output ratio (%)", Blank::zero) &&
         number_line(r.conversion_factor, "the conversion factor") &&
         (r.conversion_factor > 0 ||
          fail("FACTOR_INVALID", fmt::format("expected a conversion factor above 0, found {}", r.conversion_factor), field_,
               "1 changes nothing; a line before may be missing")) &&
         number_line(r.tilt_deg, "the tilt during measurement (deg)", Blank::zero);
}

bool Reader::read_lamp_sets(EulumdatRecord& record) {
  constexpr std::size_t most_sets = 64;  // the format allows 20
  std::size_t count = 0;
  if (!count_line(count, "the number of lamp sets", 1, most_sets)) return false;
  const char* const place = field_;
  record.lamp_sets.resize(count);
  for (LampSet& set : record.lamp_sets)
    if (!read_lamp_set(set)) return false;
  if (options_.lamp_set >= count)
    return fail("LAMP_SET_MISSING", fmt::format("expected lamp set {}, found {} of them", options_.lamp_set + 1, count), place,
                "lamp sets are alternatives, counted from 1");
  if (count > 1)
    reporter_.note("LAMP_SETS", fmt::format("{} lamp sets are alternatives; number {} is used", count, options_.lamp_set + 1), place);
  return true;
}

bool Reader::read_lamp_set(LampSet& set) {
  if (!number_line(set.lamps, "the number of lamps") || !text_line(set.type, "the type of lamps")) return false;
  if (!number_line(set.flux_lm, "the flux of all lamps of the set (lm)")) return false;
  if (!(set.flux_lm > 0))
    return fail("FLUX_MISSING", fmt::format("expected the flux of the lamp set above 0 lm, found {}", set.flux_lm), field_,
                "intensities are in cd per 1000 lm and mean nothing without it");
  return text_line(set.colour, "the colour of the lamps") && text_line(set.rendering, "the colour rendering of the lamps") &&
         number_line(set.watts, "the watts of the set", Blank::zero);
}

bool Reader::read_direct_ratios(EulumdatRecord& record) {
  std::array<double, 10> ratios{};
  bool blank = false;
  for (double& ratio : ratios) {
    const char* p = numbers_.position();
    const bool empty = p != numbers_.end() && photometric::trimmed(photometric::take_line(p, numbers_.end())).empty();
    if (empty) {
      if (!blank && !repair("FIELD_BLANK", "expected a direct ratio, found a blank line; none are kept", numbers_.position())) return false;
      blank = true;
      numbers_.move_to(p);
    } else if (!number_line(ratio, "a direct ratio")) {
      return false;
    }
  }
  if (!blank) record.direct_ratios = ratios;
  return true;
}

}  // namespace etendue::eulumdat
