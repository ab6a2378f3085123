// What `units` knows: its units, its formulas, and the tables of photographers.
#include <fmt/format.h>

#include "etendue/dialect.h"
#include "etendue/light_presets.h"
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

std::string range(double low, double high) { return low == high ? fmt::format("{:g}", low) : fmt::format("{:g} to {:g}", low, high); }

void print_temperatures(Session& session) {
  session.print(fmt::format("{:<28} {:<15} {}", "light", "K", "source"));
  for (const TemperaturePreset& p : temperature_presets()) {
    session.print(fmt::format("{:<28} {:<15} {}", p.name, range(p.low_K, p.high_K), p.source));
    session.result.push_back({{"name", p.name}, {"low_K", p.low_K}, {"high_K", p.high_K}, {"source", p.source}});
  }
}

void print_efficacies(Session& session) {
  session.print(fmt::format("{:<18} {:<15} {:<18} {}", "name", "lm/W", "of watts of", "source"));
  for (const EfficacyPreset& p : efficacy_presets()) {
    const char* const watts = p.watts == WattsOf::electricity ? "electricity" : "visible radiation";
    session.print(fmt::format("{:<18} {:<15} {:<18} {}", p.name, range(p.low_lm_W, p.high_lm_W), watts, p.source));
    session.result.push_back(
        {{"name", p.name}, {"low_lm_W", p.low_lm_W}, {"high_lm_W", p.high_lm_W}, {"watts_of", watts}, {"source", p.source}});
  }
}

void print_dialects(Session& session) {
  session.print(fmt::format("{:<12} {:<34} {}", "name", "program", "source"));
  for (const DialectInfo& d : dialects()) {
    session.print(fmt::format("{:<12} {:<34} {}", d.name, d.program, d.source));
    session.result.push_back({{"name", d.name}, {"program", d.program}, {"source", d.source}, {"unverified", d.unverified}});
  }
}

// What the same lumens become, typed into each program's spot of 60 degrees that is soft from its middle on.
void print_spread(Session& session) {
  session.print(
      fmt::format("1000 lm, spot of 60 degrees, inner angle 0\n{:<28} {:<12} {:<46} {:>8}", "program", "stated", "divides by", "cd"));
  const Result<std::vector<SpreadRow>> rows = interoperability_spread(1000, {0, pi / 6});
  for (const SpreadRow& row : *rows) {
    session.print(fmt::format("{:<28} {:<12} {:<46} {:>8.1f}", row.program, row.stated, row.divides_by, row.candela));
    session.result.push_back(
        {{"program", row.program}, {"stated", row.stated}, {"divides_by", row.divides_by}, {"intensity_cd", row.candela}});
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
  std::string names;
  for (const auto& [known, print] : {std::pair{"formulas", &print_formulas},
                                     {"ev", &print_ev},
                                     {"sunny16", &print_sunny_sixteen},
                                     {"calibrations", &print_calibrations},
                                     {"temperatures", &print_temperatures},
                                     {"efficacies", &print_efficacies},
                                     {"dialects", &print_dialects},
                                     {"spread", &print_spread}}) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", known);
    if (name != known) continue;
    print(session);
    return Done{};
  }
  return Error{"USAGE", fmt::format("--table: expected one of {}, found \"{}\"", names, name), {}, {}, {}};
}

}  // namespace etendue::cli
