// What `units` knows: its units, its formulas, and the tables of photographers.
#include <fmt/format.h>

#include "units.h"

namespace etendue::cli {
namespace {

void print_formulas(Session& session) {
  // Markdown, as it stands in sdk/docs/units.md.
  session.print("| shape | quantity | | why | source |\n|---|---|---|---|---|");
  for (const Formula& f : formulas()) {
    const std::string shape = f.variant.empty() ? std::string(f.shape) : fmt::format("{}, {}", f.shape, f.variant);
    session.print(
        fmt::format("| {} | {} | `{}` x {} | {} | {} |", shape, name_of(f.quantity), f.factor, own_quantity_of(f.shape), f.why, f.source));
    session.result.push_back({{"shape", f.shape},
                              {"variant", f.variant},
                              {"quantity", name_of(f.quantity)},
                              {"factor", f.factor},
                              {"of", own_quantity_of(f.shape)},
                              {"why", f.why},
                              {"source", f.source}});
  }
}

void print_ev(Session& session) {
  const Calibration meter = *calibration("frostbite");
  session.print(fmt::format("L = 2^EV K/100, K = {}; E = 2^EV C/100, C = {}\n{:>5}  {:>12}  {:>12}", meter.meter_k, meter.meter_c, "EV100",
                            "cd/m2", "lx"));
  for (int ev = -6; ev <= 20; ++ev) {
    const double nits = luminance_of_ev100(ev, meter), lux = illuminance_of_ev100(ev, meter);
    session.print(fmt::format("{:>5}  {:>12.6g}  {:>12.6g}", ev, nits, lux));
    session.result.push_back({{"ev100", ev}, {"luminance_cd_m2", nits}, {"illuminance_lx", lux}});
  }
}

void print_sunny_sixteen(Session& session) {
  session.print(fmt::format("t = 1/S; EV100 for 1/125 s at ISO 100\n{:<6} {:>6}  {:<24} {}", "f", "EV100", "sky", "shadows"));
  for (const SunnySixteen& row : sunny_sixteen()) {
    CameraSettings camera;
    camera.f_number = row.f_number;
    camera.shutter_s = 1.0 / 125;
    camera.iso = 100;
    const double ev = *ev100(camera);
    session.print(fmt::format("f/{:<4} {:>6.2f}  {:<24} {}", row.f_number, ev, row.sky, row.shadows));
    session.result.push_back({{"f_number", row.f_number}, {"ev100", ev}, {"sky", row.sky}, {"shadows", row.shadows}});
  }
}

void print_calibrations(Session& session) {
  session.print(fmt::format("{:<18} {:>5} {:>5} {:>7} {:>5}  {}", "name", "K", "C", "H S", "q", "source"));
  for (const Calibration& c : calibrations()) {
    session.print(fmt::format("{:<18} {:>5} {:>5} {:>7.5g} {:>5}  {}", c.name, c.meter_k, c.meter_c, c.sensor, c.lens_q, c.source));
    session.result.push_back({{"name", c.name},
                              {"meter_k", c.meter_k},
                              {"meter_c", c.meter_c},
                              {"sensor_lx_s", c.sensor},
                              {"lens_q", c.lens_q},
                              {"aperture_counts", c.aperture_counts},
                              {"source", c.source}});
  }
}

}  // namespace

void list_units(Session& session) {
  session.result = Json::array();
  session.print(fmt::format("{:<9} {:<9} {:<30} {}", "unit", "prefixes", "measures", "in SI"));
  for (const UnitSpelling& s : unit_spellings()) {
    const Dimension d = s.unit.dimension;
    const std::string in_si =
        s.unit.reciprocal ? fmt::format("{} / x {}", s.unit.times, si_unit_of(d)) : fmt::format("{} {}", s.unit.to_si(1), si_unit_of(d));
    session.print(fmt::format("{:<9} {:<9} {:<30} {}", s.symbol, s.prefixes, name_of(d), in_si));
    session.result.push_back({{"unit", s.symbol}, {"prefixes", s.prefixes}, {"measures", name_of(d)}, {"in_si", in_si}});
  }
  for (const auto& [name, what] :
       {std::pair{"rgb", "linear Rec.709 with Y = 1"}, {"xy", "CIE 1931 chromaticity"}, {"cct", "correlated colour temperature and Duv"}}) {
    session.print(fmt::format("{:<9} {:<9} {}", name, "", what));
    session.result.push_back({{"unit", name}, {"prefixes", ""}, {"measures", what}});
  }
}

Status print_table(Session& session, const std::string& name) {
  session.result = Json::array();
  for (const auto& [known, print] : {std::pair{"formulas", &print_formulas},
                                     {"ev", &print_ev},
                                     {"sunny16", &print_sunny_sixteen},
                                     {"calibrations", &print_calibrations}}) {
    if (name != known) continue;
    print(session);
    return Done{};
  }
  return Error{"USAGE", fmt::format("--table: expected formulas, ev, sunny16 or calibrations, found \"{}\"", name), {}, {}, {}};
}

}  // namespace etendue::cli
