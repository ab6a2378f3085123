#include "eulumdat.h"

#include <algorithm>
#include <cmath>

#include "etendue/photometric_transform.h"
#include "exporters/photometry/lines.h"
#include "exporters/photometry/scene.h"

namespace etendue {
namespace {

using photometric::eol;
using photometric::number;
using photometric::one_line;

int symmetry_code(WebSymmetry symmetry) {
  switch (symmetry) {
    case WebSymmetry::rotational:
      return 1;
    case WebSymmetry::about_0_180:
      return 2;
    case WebSymmetry::about_90_270:
      return 3;
    case WebSymmetry::quadrant:
      return 4;
    default:
      return 0;
  }
}

double common_step(const std::vector<double>& angles) {
  if (angles.size() < 2) return 0;
  const double step = angles[1] - angles[0];
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (std::abs(angles[i] - angles[i - 1] - step) > 1e-9) return 0;
  return step;
}

// cd per 1000 lm: value x factors x 1000 / flux. Counts the values that the division rounds.
std::size_t to_per_kilolumen(IntensityGrid& grid, double candelas_per_value, double flux_lm) {
  std::size_t inexact = 0;
  const double scale = candelas_per_value * 1000 / flux_lm;
  for (double& value : grid.values) {
    const double written = value * scale;
    if (std::fma(value, scale, -written) != 0 || scale * flux_lm != candelas_per_value * 1000) ++inexact;
    value = written;
  }
  return inexact;
}

// LM-63's length lies in the 0-180 plane, which the turn makes C90-C270, where EULUMDAT has its own.
void set_opening(EulumdatRecord& ldt, const IntensityDistribution& d, bool turn, LossReport& losses) {
  const LuminousOpening o = opening_of(d);
  const bool round = o.shape == OpeningShape::disk || o.shape == OpeningShape::vertical_cylinder || o.shape == OpeningShape::sphere;
  const bool flat = o.shape == OpeningShape::point || o.shape == OpeningShape::rectangle || o.shape == OpeningShape::box;
  if (!round && !flat) losses.add(fmt::format("luminous opening: {}", name_of(o.shape)), "the box around it is written");
  if (o.shape == OpeningShape::sphere) losses.add("luminous opening: sphere", "the cylinder around it is written");
  ldt.opening_length_mm = 1000 * (turn || round ? o.length_m : o.width_m);
  ldt.opening_width_mm = round ? 0 : 1000 * (turn ? o.width_m : o.length_m);
  ldt.opening_height_mm.fill(1000 * o.height_m);
  ldt.length_mm = ldt.opening_length_mm;
  ldt.width_mm = ldt.opening_width_mm;
  ldt.height_mm = ldt.opening_height_mm[0];
  losses.add("size of the luminaire", "not known from LM-63; that of the opening is written");
}

// The planes in [0, 360) that EULUMDAT lists even where it stores fewer.
Result<std::vector<double>> all_planes(const IntensityGrid& grid) {
  const Result<IntensityGrid> full = unfolded(grid);
  if (!full) return full.error();
  std::vector<double> planes = full->horizontal_deg;
  planes.pop_back();
  return planes;
}

// Symmetry 3 stores half of the listed planes from the one at three quarters on, which has to be C270.
bool counts_from_270(const std::vector<double>& planes) { return planes.size() % 4 == 0 && planes[3 * planes.size() / 4] == 270; }

// The listed planes and the symmetry's code; all planes where the format cannot count the mirrored half.
Status list_planes(IntensityDistribution& d, LossReport& losses) {
  auto& ldt = *std::get_if<EulumdatRecord>(&d.record);
  if (ldt.symmetry == symmetry_code(d.grid.symmetry) && !ldt.c_deg.empty()) return Done{};
  Result<std::vector<double>> planes = all_planes(d.grid);
  if (!planes) return planes.error();
  if (d.grid.symmetry == WebSymmetry::about_90_270 && !counts_from_270(*planes)) {
    Result<IntensityGrid> full = unfolded(d.grid);
    if (!full) return full.error();
    d.grid = std::move(*full);
    d.grid.horizontal_deg.pop_back();
    d.grid.values.resize(d.grid.values.size() - d.grid.vertical_deg.size());
    losses.add("symmetry about C90-C270", "the format cannot count these planes by half; all are written");
  }
  ldt.symmetry = symmetry_code(d.grid.symmetry);
  ldt.c_deg = std::move(*planes);
  ldt.c_step_deg = common_step(ldt.c_deg);
  return Done{};
}

Result<IntensityDistribution> from_ies(const IntensityDistribution& d, const PhotometricWriteOptions& options, LossReport& losses) {
  const auto& ies = *std::get_if<IesRecord>(&d.record);
  const Result<IntensityWeb> web = IntensityWeb::of(d);
  if (!web) return web.error();
  if (!(web->flux_lm() > 0))
    return Error{"WEB_INVALID", "expected light, found none: EULUMDAT states intensities per lumen", {d.file, 0, 0, {}}, {}, {}};
  Result<IntensityGrid> grid = turned(d.grid, options.turn ? 90 : 0);
  if (!grid) return grid.error();
  const std::size_t n = grid->vertical_deg.size();
  if (d.grid.symmetry == WebSymmetry::none) {  // EULUMDAT has no plane at 360
    const auto& v = d.grid.values;
    if (d.grid.horizontal_deg.back() - d.grid.horizontal_deg.front() == 360 &&
        !std::equal(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(n), v.end() - static_cast<std::ptrdiff_t>(n)))
      losses.add("a plane at 360 deg that differs from the one at 0", "the one at 0 is written for both");
    grid->horizontal_deg.pop_back();
    grid->values.resize(grid->values.size() - n);
  }
  EulumdatRecord ldt;
  ldt.company = keyword_of(d, "MANUFAC");
  ldt.luminaire_type = grid->symmetry == WebSymmetry::rotational ? 1 : opening_of(d).length_m > 2 * opening_of(d).width_m ? 2 : 3;
  ldt.report = keyword_of(d, "TEST");
  ldt.luminaire = keyword_of(d, "LUMINAIRE");
  ldt.number = keyword_of(d, "LUMCAT");
  ldt.date = keyword_of(d, "ISSUEDATE");
  const bool absolute = is_absolute(d);
  const double rated = rated_flux_lm(d).value_or(0), flux = absolute || !(rated > 0) ? web->flux_lm() : rated;
  ldt.lamp_sets.push_back({absolute || !(rated > 0) ? -1 : ies.lamps, keyword_of(d, "LAMP"), flux, keyword_of(d, "COLORTEMP"),
                           keyword_of(d, "CRI"), ies.watts});
  if (const std::size_t inexact = to_per_kilolumen(*grid, candelas_per_value(d), flux); inexact > 0)
    losses.add(fmt::format("{} of {} intensities", inexact, grid->values.size()),
               "rounded when divided by the flux, by at most 4 units in the last place");
  ldt.dff_percent = 100 * web->flux_between(0, 90) / web->flux_lm();
  ldt.lorl_percent = 100 * web->flux_lm() / flux;
  ldt.direct_ratios.emplace();  // their table is not published where it could be checked
  losses.add("direct ratios", "not computed; written as 0, as files do that do not know them");
  set_opening(ldt, d, options.turn, losses);
  if (ies.tilt) losses.add("tilt curve of the lamp", "EULUMDAT has no place for it");
  if (ies.ballast_factor != 1 || ies.multiplier != 1) losses.add("multiplier and ballast factor", "multiplied into the intensities");
  std::size_t dropped = 0;
  for (const Keyword& k : ies.keywords) {
    static constexpr std::string_view kept[] = {"MANUFAC", "LUMINAIRE", "LUMCAT", "TEST", "LAMP", "ISSUEDATE", "COLORTEMP", "CRI", "MORE"};
    if (std::find(std::begin(kept), std::end(kept), k.name) == std::end(kept)) ++dropped;
  }
  if (dropped > 0) losses.add(fmt::format("{} lines of the header", dropped), "EULUMDAT has no place for them");
  ldt.gamma_step_deg = common_step(grid->vertical_deg);
  return IntensityDistribution{d.file, std::move(*grid), ldt, 0};
}

std::string text_of(const IntensityDistribution& d) {
  const auto& r = *std::get_if<EulumdatRecord>(&d.record);
  std::string text;
  const auto line = [&](const std::string& field) { text += one_line(field) + eol; };
  line(r.company);
  line(std::to_string(r.luminaire_type));
  line(std::to_string(r.symmetry));
  line(std::to_string(r.c_deg.size()));
  line(number(r.c_step_deg));
  line(std::to_string(d.grid.vertical_deg.size()));
  line(number(r.gamma_step_deg));
  for (const std::string* field : {&r.report, &r.luminaire, &r.number, &r.file_name, &r.date}) line(*field);
  for (const double x : {r.length_mm, r.width_mm, r.height_mm, r.opening_length_mm, r.opening_width_mm}) line(number(x));
  for (const double x : r.opening_height_mm) line(number(x));
  for (const double x : {r.dff_percent, r.lorl_percent, r.conversion_factor, r.tilt_deg}) line(number(x));
  line(std::to_string(r.lamp_sets.size()));
  for (const LampSet& set : r.lamp_sets) {
    line(number(set.lamps));
    line(set.type);
    line(number(set.flux_lm));
    line(set.colour);
    line(set.rendering);
    line(number(set.watts));
  }
  for (std::size_t k = 0; k < 10; ++k) line(r.direct_ratios ? number((*r.direct_ratios)[k]) : "");
  for (const double x : r.c_deg) line(number(x));
  for (const double x : d.grid.vertical_deg) line(number(x));
  for (const double x : d.grid.values) line(number(x));
  return text;
}

}  // namespace

Result<PhotometricText> write_eulumdat(const IntensityDistribution& distribution, const PhotometricWriteOptions& options) {
  if (const Status valid = check(distribution); !valid) return valid.error();
  if (distribution.grid.type != WebType::c)
    return Error{"EXPORT_UNSUPPORTED",
                 fmt::format("EULUMDAT has webs of type C alone, this one is of type {}", name_of(distribution.grid.type)),
                 {distribution.file, 0, 0, {}},
                 "write .ies, which keeps the grid",
                 {}};
  PhotometricText out;
  Result<IntensityDistribution> d =
      std::holds_alternative<EulumdatRecord>(distribution.record) ? distribution : from_ies(distribution, options, out.losses);
  if (!d) return d.error();
  if (const Status listed = list_planes(*d, out.losses); !listed) return listed.error();
  out.text = text_of(*d);
  return out;
}

namespace {

class EulumdatExporter final : public Exporter {
 public:
  FormatInfo describe() const override {
    return {"eulumdat", "EULUMDAT", {".ldt"}, "Luminous intensity of one luminaire over direction per 1000 lm of its lamps"};
  }
  Result<Exported> write(const Scene& scene, const std::filesystem::path& file, const ExportOptions&) const override {
    return photometric::write_scene(scene, file, &write_eulumdat);
  }
};

}  // namespace

std::unique_ptr<Exporter> make_eulumdat_exporter() { return std::make_unique<EulumdatExporter>(); }

}  // namespace etendue
