// What was written, in the unit that is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "etendue/light_presets.h"
#include "units.h"

namespace etendue::cli {
namespace {

Error error(const char* code, std::string text, std::string hint = {}) { return {code, std::move(text), {}, std::move(hint), {}}; }

Answer number(double value, const std::string& unit) { return {{value}, unit, fmt::format("{} {}", value, unit), {}, {}, {}, {}, {}}; }

Error no_way(std::string_view given, const Target& target) {
  return error("DIMENSION_MISMATCH", fmt::format("{} has no {}", given, target.name));
}

// ---- Colours ----

constexpr const char* rgb_note =
    "linear Rec.709, D65 = (.3127, .3290), no adaptation, scaled to Y = .2126 R + .7152 G + .0722 B = 1 (ITU-R BT.709)";
constexpr const char* planck_note =
    "Planck's law with c2 = 1.438776877e-2 m K (SI 2019), CIE 1931 2 degree observer, summed from 360 nm to 830 nm at 1 nm";
constexpr const char* duv_note = "Duv along the normal of the Planckian locus in CIE 1960 (u, v); positive is greenish (ANSI C78.377)";

Result<Answer> colour_answer(const Chromaticity& xy, const Target& target, const UnitsOptions& options, Explanation why) {
  Answer a;
  a.unit = target.name;
  if (target.kind == Target::Kind::xy) {
    a.value = {xy.x, xy.y};
    a.text = fmt::format("xy {} {}", xy.x, xy.y);
  } else if (target.kind == Target::Kind::rgb) {
    Rgb rgb = to_rgb(xy);
    a.in_gamut = rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0;
    why.notes.emplace_back(rgb_note);
    if (options.normalise == "max") {
      rgb = rgb / std::max({rgb.x, rgb.y, rgb.z});
      why.notes.emplace_back("then divided by the largest channel");
    }
    a.value = {rgb.x, rgb.y, rgb.z};
    a.text = fmt::format("rgb {} {} {}", rgb.x, rgb.y, rgb.z);
  } else {
    const Result<ColourTemperature> cct = to_colour_temperature(xy);
    if (!cct) return cct.error();
    why.notes.emplace_back("nearest point of the Planckian locus in CIE 1960 (u, v) (CIE 015:2018)");
    why.notes.emplace_back(planck_note);
    a.value = {cct->kelvin};
    a.unit = "K";
    a.duv = cct->duv;
    a.text = fmt::format("{} K Duv {}", cct->kelvin, cct->duv);
  }
  if (options.explain) a.explanation = std::move(why);
  return a;
}

// ---- Units of one dimension ----

std::string in_si(const NamedUnit& unit) {
  const std::string_view si = si_unit_of(unit.dimension);
  return unit.reciprocal ? fmt::format("{}/x {}", unit.times, si) : fmt::format("{} {}", unit.to_si(1), si);
}
// Between units of one dimension there is a factor, or a reciprocal, and no light.
Explanation explain_units(const WrittenQuantity& w, const Target& target) {
  const NamedUnit &given = w.unit, &wanted = target.unit;
  Explanation why;
  if (given == wanted)
    why.formula = "y = x";
  else if (given.reciprocal || wanted.reciprocal)
    why.formula = fmt::format("y = {}/x", given.reciprocal ? given.times : wanted.times);
  else
    why.formula = fmt::format("y = x*{}/{}", given.times * wanted.over, given.over * wanted.times);
  why.symbols = {{"x", w.number, ""}};
  why.notes = {fmt::format("what was written is in units of {}, {} is {}", in_si(given), target.name, in_si(wanted))};
  return why;
}

// ---- Each kind of what is written ----

struct Answering {
  const Target& target;
  const LightSetup& setup;
  const UnitsOptions& options;

  Result<Answer> operator()(const WrittenQuantity& w) const {
    const AnyQuantity given = w.quantity();
    if (target.kind != Target::Kind::unit) {
      if (given.dimension != Dimension::temperature) return no_way(name_of(given.dimension), target);
      const Result<Chromaticity> xy = planckian(given.si);
      if (!xy) return xy.error();
      return colour_answer(*xy, target, options,
                           {fmt::format("{} of a Planckian radiator of {} K", target.name, given.si), {}, {planck_note}});
    }
    LightSetup light = setup;
    if (w.distance_m) light.given_distance_m = w.distance_m;
    if (w.distance_m && !light.wanted_distance_m) light.wanted_distance_m = w.distance_m;
    if (w.efficacy_lm_W && light.efficacy_lm_W && *w.efficacy_lm_W != *light.efficacy_lm_W)
      return error("EFFICACY_AMBIGUOUS",
                   fmt::format("expected one efficacy, found {} lm/W and --efficacy {}", *w.efficacy_lm_W, options.efficacy));
    if (w.efficacy_lm_W) light.efficacy_lm_W = w.efficacy_lm_W;

    const Result<Conversion> conversion = Conversion::between(w.unit, target.unit, light);
    if (!conversion) return conversion.error();
    const Result<double> value = (*conversion)(w.number);
    if (!value) return value.error();
    Answer a = number(*value, target.name);
    a.efficacy_lm_W = conversion->efficacy_lm_W();
    if (a.efficacy_lm_W) a.efficacy = w.efficacy_lm_W ? fmt::format("{} lm/W", *w.efficacy_lm_W) : options.efficacy;
    const bool same = given.dimension == target.unit.dimension && light.given_distance_m == light.wanted_distance_m;
    if (options.explain && same) {
      a.explanation = explain_units(w, target);
    } else if (options.explain) {
      const Result<Explanation> why = explain(given, target.unit.dimension, light);
      if (!why) return why.error();
      a.explanation = *why;
      if (const Result<EfficacyPolicy> policy = efficacy_policy(a.efficacy); a.efficacy_lm_W && policy && !policy->source.empty())
        a.explanation->notes.push_back(fmt::format("efficacy of {}: {} lm/W; {}", policy->name, policy->lm_W, policy->source));
    }
    return a;
  }

  Result<Answer> operator()(const CameraSettings& camera) const {
    if (target.kind != Target::Kind::unit) return no_way("a camera", target);
    Explanation why;
    const auto finished = [&](double si) -> Result<Answer> {
      Answer a = number(target.unit.from_si(si), target.name);
      if (options.explain) a.explanation = why;
      return a;
    };
    switch (target.unit.dimension) {
      case Dimension::duration: {
        const Result<double> t = shutter_time(camera);
        why.formula = "t = angle/(2*pi*fps), or as set";
        return t ? finished(*t) : t.error();
      }
      case Dimension::stop:
        why.formula = "stops = D log2(10) - EC";
        why.notes.emplace_back("by how much filters of density D and the compensation EC darken the picture");
        return finished(camera.nd_density * std::log2(10) - camera.compensation_stop);
      case Dimension::exposure_value_s: {
        CameraSettings without_iso = camera;
        without_iso.iso.reset();
        const Result<double> ev = ev_s(camera);
        if (!ev) return ev.error();
        why = *explain(without_iso);
        return finished(*ev);
      }
      case Dimension::exposure_value:
      case Dimension::luminance:
      case Dimension::illuminance: {
        const Result<double> ev = ev100(camera);
        if (!ev) return ev.error();
        why = *explain(camera);
        if (target.unit.dimension == Dimension::exposure_value) return finished(*ev);
        LightSetup meter;  // a meter's reading, whatever the light's shape
        meter.meter_k = setup.meter_k;
        meter.meter_c = setup.meter_c;
        const AnyQuantity reading{Dimension::exposure_value, *ev};
        const Result<double> si = convert(reading, target.unit.dimension, meter);
        if (!si) return si.error();
        const Explanation metered = *explain(reading, target.unit.dimension, meter);
        why.notes.push_back(metered.formula);
        why.notes.insert(why.notes.end(), metered.notes.begin(), metered.notes.end());
        return finished(*si);
      }
      default:
        return no_way("a camera", target);
    }
  }

  Result<Answer> operator()(const ColourTemperature& t) const {
    if (target.kind == Target::Kind::unit) {
      if (target.unit.dimension == Dimension::temperature && t.duv == 0)
        return (*this)(WrittenQuantity{t.kelvin, {Dimension::temperature}});
      return no_way("a temperature with Duv", target);
    }
    const Result<Chromaticity> xy = to_chromaticity(t);
    if (!xy) return xy.error();
    return colour_answer(*xy, target, options,
                         {fmt::format("{} of {} K at Duv {}", target.name, t.kelvin, t.duv), {}, {planck_note, duv_note}});
  }
  Result<Answer> operator()(const Chromaticity& xy) const {
    if (target.kind == Target::Kind::unit) return no_way("a chromaticity", target);
    return colour_answer(xy, target, options, {fmt::format("{} of xy {} {}", target.name, xy.x, xy.y), {}, {}});
  }
  Result<Answer> operator()(const Rgb& rgb) const {
    if (target.kind == Target::Kind::unit) return no_way("a colour", target);
    if (!(luminance_of(rgb) > 0)) return error("COLOUR_INVALID", "expected a colour with Y = .2126 R + .7152 G + .0722 B above 0");
    return colour_answer(to_chromaticity(rgb), target, options,
                         {fmt::format("{} of linear Rec.709 {} {} {}", target.name, rgb.x, rgb.y, rgb.z), {}, {}});
  }
};

}  // namespace

Result<Target> target_named(const std::string& name) {
  if (name == "rgb") return Target{Target::Kind::rgb, name, {}};
  if (name == "xy") return Target{Target::Kind::xy, name, {}};
  if (name == "cct") return Target{Target::Kind::cct, name, {}};
  const Result<NamedUnit> unit = unit_named(name);
  if (!unit) {
    Error e = unit.error();
    e.text = "--to: " + e.text;
    e.hint += "; or rgb, xy, cct";
    return e;
  }
  return Target{Target::Kind::unit, name, *unit};
}

Result<Written> read_quantity(std::string_view text, const UnitsOptions& options, Diagnostics& told) {
  return options.clamp ? parse(text, told) : parse(text);
}

Result<Answer> answer(const Written& given, const Target& target, const LightSetup& setup, const UnitsOptions& options) {
  return std::visit(Answering{target, setup, options}, given);
}

std::vector<Answer> every_answer(const Written& given, const LightSetup& setup, const UnitsOptions& options) {
  static constexpr std::array units{"lm", "cd", "nit", "lux", "lm/m2", "W",  "W/sr", "W/m2/sr", "W/m2",  "EV",  "EV_S", "stop",
                                    "s",  "m",  "ft",  "deg", "rad",   "sr", "lm/W", "K",       "mired", "cct", "xy",   "rgb"};
  std::vector<Answer> all;
  for (const char* const unit : units)
    if (Result<Answer> a = answer(given, *target_named(unit), setup, options)) all.push_back(std::move(*a));
  return all;
}

}  // namespace etendue::cli
