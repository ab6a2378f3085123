#include "ies.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "etendue/photometric_transform.h"
#include "exporters/photometry/lines.h"
#include "exporters/photometry/scene.h"

namespace etendue {
namespace {

using photometric::eol;
using photometric::one_line;

constexpr const char* tags[] = {"", "IESNA91", "IESNA:LM-63-1995", "IESNA:LM-63-2002", "IES:LM-63-2019"};

// ---- From EULUMDAT ----

std::vector<Keyword> keywords_from(const EulumdatRecord& ldt, const LampSet& set) {
  std::vector<Keyword> keywords;
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) keywords.push_back({name, text});
  };
  add("TEST", ldt.report);
  add("ISSUEDATE", ldt.date);
  add("MANUFAC", ldt.company);
  add("LUMCAT", ldt.number);
  add("LUMINAIRE", ldt.luminaire);
  add("LAMP", set.type);
  add("_COLOUR", set.colour);
  add("_RENDERING", set.rendering);
  return keywords;
}

// EULUMDAT's length lies along C90-C270, which the turn makes the 0-180 plane of LM-63.
void set_opening(IesRecord& ies, const EulumdatRecord& ldt, bool turn, LossReport& losses) {
  double length = ldt.opening_length_mm / 1000, width = ldt.opening_width_mm / 1000;
  const auto [lowest, highest] = std::minmax_element(ldt.opening_height_mm.begin(), ldt.opening_height_mm.end());
  if (*lowest != *highest) losses.add("luminous heights that differ by side", "the largest is written");
  ies.height = *highest / 1000;
  if (ldt.opening_width_mm == 0 && length > 0) {
    ies.width = ies.length = -length;
    return;
  }
  if (!turn) std::swap(length, width);
  ies.width = width;
  ies.length = length;
}

IntensityDistribution from_eulumdat(const IntensityDistribution& d, const PhotometricWriteOptions& options, LossReport& losses) {
  const auto& ldt = *std::get_if<EulumdatRecord>(&d.record);
  const LampSet& set = ldt.lamp_sets[d.lamp_set];
  IesRecord ies;
  ies.version = options.version >= IesVersion::lm_63_2002 ? options.version : IesVersion::lm_63_2002;  // whose shape table set_opening uses
  ies.keywords = keywords_from(ldt, set);
  ies.lamps = std::max(1.0, std::abs(set.lamps));
  ies.lumens_per_lamp = set.lamps < 0 ? -1 : set.flux_lm / ies.lamps;
  ies.multiplier = candelas_per_value(d);
  ies.third_factor = options.version == IesVersion::lm_63_2019 ? 1.00001 : 1;  // how the file was made is not known
  ies.watts = set.watts;
  set_opening(ies, ldt, options.turn, losses);
  if (ldt.lamp_sets.size() > 1) losses.add("alternative lamp sets", fmt::format("number {} alone is written", d.lamp_set + 1));
  if (ldt.tilt_deg != 0) losses.add("tilt during measurement", "LM-63 has no place for it");
  losses.add("size of the luminaire", "LM-63 has its opening alone");
  IntensityDistribution out{d.file, d.grid, ies, 0};
  if (Result<IntensityGrid> grid = turned(d.grid, options.turn ? -90 : 0)) out.grid = std::move(*grid);
  return out;
}

// ---- To another version ----

// The opening in the signs of another version; a shape that it does not know becomes the box around it.
void recode_opening(IesRecord& ies, const LuminousOpening& o, LossReport& losses) {
  const double w = o.width_m, l = o.length_m, h = o.height_m;
  const bool modern = ies.version >= IesVersion::lm_63_2002, middle = ies.version == IesVersion::lm_63_1995;
  ies.feet = false;
  const auto set = [&](double width, double length, double height) { ies.width = width, ies.length = length, ies.height = height; };
  switch (o.shape) {
    case OpeningShape::point:
    case OpeningShape::rectangle:
    case OpeningShape::box:
      return set(w, l, h);
    case OpeningShape::disk:
      return set(-w, modern ? -w : 0, 0);
    case OpeningShape::vertical_cylinder:
      return set(-w, modern ? -w : 0, h);
    case OpeningShape::sphere:
      if (modern) return set(-w, -w, -w);
      if (middle) return set(-w, 0, -w);
      break;
    case OpeningShape::ellipse:
      if (modern) return set(-w, -l, 0);
      if (!middle) return set(-w, l, 0);
      break;
    case OpeningShape::vertical_elliptical_cylinder:
      if (modern) return set(-w, -l, h);
      if (middle) return set(-w, l, h);
      break;
    case OpeningShape::ellipsoid:
      if (modern) return set(-w, -l, -h);
      return set(-w, l, middle ? -h : h);
    case OpeningShape::cylinder_along_length:
      if (modern) return set(-w, l, -h);
      if (middle) return set(0, l, -h);
      break;
    case OpeningShape::cylinder_along_width:
      if (modern) return set(w, -l, -h);
      if (middle) return set(w, 0, -h);
      break;
    case OpeningShape::vertical_disk:
      if (modern) return set(-w, 0, -h);
      break;
    case OpeningShape::unknown:
      break;
  }
  losses.add(fmt::format("luminous opening: {}", name_of(o.shape)), "this version has no code for it; the box around it is written");
  set(w, l, h);
}

bool same_opening(const LuminousOpening& a, const LuminousOpening& b) {
  return a.shape == b.shape && a.width_m == b.width_m && a.length_m == b.length_m && a.height_m == b.height_m;
}

Result<IntensityDistribution> as_version(IntensityDistribution d, IesVersion version, LossReport& losses) {
  auto& ies = *std::get_if<IesRecord>(&d.record);
  const IesVersion before = ies.version;
  if (before == version) return d;
  const LuminousOpening opening = opening_of(d);
  ies.version = version;
  if (!same_opening(opening, opening_of(d))) recode_opening(ies, opening, losses);
  if (before <= IesVersion::lm_63_1991 && version > IesVersion::lm_63_1991) {
    if (ies.third_factor != 1) losses.add(fmt::format("ballast-lamp factor {}", ies.third_factor), "multiplied into the ballast factor");
    ies.ballast_factor *= ies.third_factor;
    ies.third_factor = 1;
  }
  if (before == IesVersion::lm_63_2019)
    losses.add(fmt::format("file generation type {}", ies.third_factor), "this version has no place for it");
  ies.third_factor = version == IesVersion::lm_63_2019 ? 1.00001 : 1;
  if (version == IesVersion::lm_63_1986) {
    for (Keyword& k : ies.keywords)
      if (!k.name.empty()) k = {"", fmt::format("{}: {}", k.name, k.text)};
  }
  if (ies.tilt && !ies.tilt->file.empty() && version == IesVersion::lm_63_2019) {
    if (!ies.tilt->resolved)
      return Error{"EXPORT_UNSUPPORTED",
                   "LM-63-2019 allows no tilt file, and its content is not known",
                   {d.file, 0, 0, {}},
                   "write another version",
                   {}};
    ies.tilt->file.clear();
  }
  if (version >= IesVersion::lm_63_2002 && d.grid.symmetry == WebSymmetry::about_90_270) {
    Result<IntensityGrid> full = unfolded(d.grid);
    if (!full) return full.error();
    d.grid = std::move(*full);
    losses.add("symmetry about C90-C270", "this version has no code for it; all planes are written");
  }
  return d;
}

// What every LM-63 file must hold: C planes that begin at 0 and end at 0, 90, 180 or 360, or 90..270.
Result<IntensityGrid> standard_grid(const IntensityGrid& grid, IesVersion version) {
  if (grid.type != WebType::c) return grid;
  const double first = grid.horizontal_deg.front(), last = grid.horizontal_deg.back();
  if (grid.symmetry == WebSymmetry::none && first == 0 && last != 360) return unfolded(grid);
  if (grid.symmetry == WebSymmetry::about_90_270 && first == -90) {
    if (version >= IesVersion::lm_63_2002) return unfolded(grid);
    // C from -90 to 90 is 270 down to 90.
    IntensityGrid other{grid.type, grid.symmetry, grid.vertical_deg, {}, {}};
    const std::size_t n = grid.vertical_deg.size();
    for (std::size_t j = grid.horizontal_deg.size(); j-- > 0;) {
      other.horizontal_deg.push_back(180 - grid.horizontal_deg[j]);
      other.values.insert(other.values.end(), grid.values.begin() + static_cast<std::ptrdiff_t>(j * n),
                          grid.values.begin() + static_cast<std::ptrdiff_t>((j + 1) * n));
    }
    return other;
  }
  return grid;
}

void note_required(const IesRecord& ies, LossReport& losses) {
  if (ies.version < IesVersion::lm_63_2002) return;
  for (const char* name : {"TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"}) {
    if (std::none_of(ies.keywords.begin(), ies.keywords.end(), [&](const Keyword& k) { return k.name == name; }))
      losses.add(fmt::format("keyword [{}]", name), "required by this version, not known, not written");
  }
}

// At the beginning of a file this label would be taken for a version line, or lose a byte order mark.
bool must_not_be_first(const std::string& label) {
  constexpr const char* mark = "\xEF\xBB\xBF";
  std::string start;
  for (const char c : label)
    if (c != ' ' && c != '\t' && start.size() < 3) start += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return start == "IES" || start == mark;
}

std::string text_of(const IesRecord& ies, const IntensityGrid& grid) {
  std::string text;
  const std::string first = ies.keywords.empty() ? "" : one_line(ies.keywords.front().text);
  if (ies.version != IesVersion::lm_63_1986) {
    text += std::string(tags[static_cast<int>(ies.version)]) + eol;
  } else if (must_not_be_first(first)) {
    text += eol;  // 1986 has no version line: a blank one stands in its place
  }
  for (const Keyword& k : ies.keywords) text += one_line(k.name.empty() ? k.text : fmt::format("[{}] {}", k.name, k.text)) + eol;
  if (!ies.tilt) {
    text += std::string("TILT=NONE") + eol;
  } else if (!ies.tilt->file.empty()) {
    text += "TILT=" + one_line(ies.tilt->file) + eol;
  } else {
    text += std::string("TILT=INCLUDE") + eol + fmt::format("{}{}{}{}", ies.tilt->geometry, eol, ies.tilt->angles_deg.size(), eol);
    text += photometric::wrapped(ies.tilt->angles_deg) + photometric::wrapped(ies.tilt->factors);
  }
  const int type = grid.type == WebType::c ? 1 : grid.type == WebType::b ? 2 : 3;
  text += fmt::format("{} {} {} {} {} {} {} {} {} {}{}", ies.lamps, ies.lumens_per_lamp, ies.multiplier, grid.vertical_deg.size(),
                      grid.horizontal_deg.size(), type, ies.feet ? 1 : 2, ies.width, ies.length, ies.height, eol);
  text += fmt::format("{} {} {}{}", ies.ballast_factor, ies.third_factor, ies.watts, eol);
  text += photometric::wrapped(grid.vertical_deg) + photometric::wrapped(grid.horizontal_deg);
  const std::size_t n = grid.vertical_deg.size();
  for (std::size_t j = 0; j < grid.horizontal_deg.size(); ++j) text += photometric::wrapped(std::span(grid.values).subspan(j * n, n));
  return text;
}

}  // namespace

Result<PhotometricText> write_ies(const IntensityDistribution& distribution, const PhotometricWriteOptions& options) {
  if (const Status valid = check(distribution); !valid) return valid.error();
  PhotometricText out;
  const bool own = std::holds_alternative<IesRecord>(distribution.record);
  Result<IntensityDistribution> d =
      as_version(own ? distribution : from_eulumdat(distribution, options, out.losses), options.version, out.losses);
  if (!d) return d.error();
  const auto& ies = *std::get_if<IesRecord>(&d->record);
  const Result<IntensityGrid> grid = standard_grid(d->grid, options.version);
  if (!grid) return grid.error();
  note_required(ies, out.losses);
  out.text = text_of(ies, *grid);
  return out;
}

namespace {

class IesExporter final : public Exporter {
 public:
  FormatInfo describe() const override {
    return {"ies", "IES LM-63", {".ies"}, "Luminous intensity of one luminaire over direction, LM-63-2002 or the version it came in"};
  }
  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions&) const override {
    return photometric::write_scene(scene, file, &write_ies);
  }
};

}  // namespace

std::unique_ptr<Exporter> make_ies_exporter() { return std::make_unique<IesExporter>(); }

}  // namespace etendue
