#include "etendue/formulas.h"
#include "light_illuminance.h"
#include "light_ratio.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {
namespace {

std::string_view symbol_of(Dimension d) {
  switch (d) {
    case Dimension::luminous_flux:
      return "flux";
    case Dimension::luminous_intensity:
      return "intensity";
    case Dimension::luminance:
      return "luminance";
    case Dimension::illuminance:
      return "illuminance";
    case Dimension::luminous_exitance:
      return "exitance";
    case Dimension::radiant_flux:
      return "radiant_flux";
    case Dimension::radiant_intensity:
      return "radiant_intensity";
    case Dimension::radiance:
      return "radiance";
    case Dimension::irradiance:
      return "irradiance";
    case Dimension::exposure_value:
      return "ev";
    default:
      return "x";
  }
}

// Every symbol that a factor of the shape may contain.
struct SymbolsOf {
  const LightSetup& setup;
  std::optional<double> distance_m;
  using Symbols = std::vector<Symbol>;

  Symbols operator()(const PointShape&) const { return {}; }
  Symbols operator()(const SpotShape& s) const { return {{"inner", s.inner_rad, "rad"}, {"outer", s.outer_rad, "rad"}}; }
  Symbols operator()(const FrustumShape& s) const { return {{"width_angle", s.width_rad, "rad"}, {"height_angle", s.height_rad, "rad"}}; }
  Symbols operator()(const DistantShape& s) const { return {{"diameter", s.diameter_rad, "rad"}}; }
  Symbols operator()(const SphereShape& s) const { return {{"radius", s.radius, "m"}}; }
  Symbols operator()(const DiskShape& s) const { return {{"radius", s.radius, "m"}}; }
  Symbols operator()(const RectShape& s) const { return {{"width", s.width, "m"}, {"height", s.height, "m"}}; }
  Symbols operator()(const PolygonShape& s) const { return with_projected({{"area", double(area_of(s)), "m2"}}, s, 0); }
  Symbols operator()(const TubeShape& s) const {
    return with_projected({{"radius", s.radius, "m"}, {"length", s.length, "m"}}, s, s.radius);
  }
  Symbols operator()(const LineShape& s) const { return {{"length", s.length, "m"}}; }
  Symbols operator()(const MeshShape&) const { return {{"area", setup.mesh_area_m2.value_or(0), "m2"}}; }
  Symbols operator()(const PhotometricShape&) const { return {{"solid_angle", setup.photometric_sr.value_or(0), "sr"}}; }
  Symbols operator()(const EnvironmentShape&) const { return {}; }

 private:
  template <class S>
  Symbols with_projected(Symbols symbols, const S& shape, double nearest) const {
    if (distance_m && *distance_m > nearest) symbols.push_back({"projected", double(Wide(facing_factor(shape, *distance_m))), "sr"});
    return symbols;
  }
};

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
// Every whole word `from` becomes `to`.
std::string renamed(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t at = text.find(from, i);
    out += text.substr(i, at - i);
    if (at == std::string_view::npos) break;
    const bool whole = (at == 0 || !is_word(text[at - 1])) && (at + from.size() == text.size() || !is_word(text[at + from.size()]));
    out += whole ? to : from;
    i = at + from.size();
  }
  return out;
}
bool mentions(std::string_view text, std::string_view word) { return renamed(text, word, "") != text; }

std::string in_brackets(std::string_view text) { return fmt::format("({})", text); }

// Collects what is said about one conversion.
class Explainer {
 public:
  Explainer(Dimension given, Dimension wanted, const LightSetup& setup) : given_(given), wanted_(wanted), setup_(setup) {}

  Explanation operator()(const AnyQuantity& given) {
    const std::string name(symbol_of(given.dimension));
    add_symbol({name, given.si, si_unit_of(given.dimension)});
    std::string text = name;
    const Dimension from = plain(given_, wanted_), to = plain(wanted_, given_);
    const bool from_radiant = photometric_twin(given_).has_value(), to_radiant = photometric_twin(wanted_).has_value();
    if (given_ == Dimension::exposure_value) text = fmt::format("2^ev*{}/100", meter(from));
    if (from_radiant && !to_radiant) text = efficacy(text, '*');
    text = through_shape(text, from, to);
    if (to_radiant && !from_radiant) text = efficacy(text, '/');
    if (wanted_ == Dimension::exposure_value) text = fmt::format("log2(100*({})/{})", text, meter(to));
    explanation_.formula = fmt::format("{} = {}", symbol_of(wanted_), text);
    return explanation_;
  }

 private:
  Dimension plain(Dimension d, Dimension other) const {
    if (d == Dimension::exposure_value)
      return !setup_.shape && photometric_twin(other).value_or(other) == Dimension::illuminance ? Dimension::illuminance
                                                                                                : Dimension::luminance;
    return photometric_twin(d).value_or(d);
  }
  void add_symbol(Symbol symbol) {
    const auto same = [&](const Symbol& s) { return s.name == symbol.name; };
    if (std::none_of(explanation_.symbols.begin(), explanation_.symbols.end(), same)) explanation_.symbols.push_back(std::move(symbol));
  }
  void add_note(std::string note) {
    if (std::find(explanation_.notes.begin(), explanation_.notes.end(), note) == explanation_.notes.end())
      explanation_.notes.push_back(std::move(note));
  }

  std::string_view meter(Dimension plain) {
    const bool reflected = plain == Dimension::luminance;
    add_symbol(reflected ? Symbol{"K", setup_.meter_k, "cd s/m2"} : Symbol{"C", setup_.meter_c, "lx s"});
    add_note(reflected ? "EV is EV100: a reflected-light meter reads L = 2^EV K/100 (ISO 2720; Lagarde and de Rousiers 2014, eq 12)"
                       : "EV is EV100: an incident-light meter reads E = 2^EV C/100 (ISO 2720)");
    return reflected ? "K" : "C";
  }
  std::string efficacy(const std::string& text, char operation) {
    add_symbol({"efficacy", *setup_.efficacy_lm_W, "lm/W"});
    add_note("lumens are watts times the luminous efficacy that was given (Lagarde and de Rousiers 2014, eq 9)");
    return fmt::format("{}{}efficacy", text, operation);
  }

  std::string through_shape(const std::string& text, Dimension from, Dimension to) {
    if (from == to && (from != Dimension::illuminance || setup_.given_distance_m == setup_.wanted_distance_m)) return text;
    if (!setup_.shape) {
      add_note("a surface that emits equally in all directions: M = pi L (Lambert)");
      return to == Dimension::luminous_exitance ? text + "*pi" : text + "/pi";
    }
    std::string result = text;
    const std::string below = factor(from, setup_.given_distance_m, "given_distance");
    const std::string above = factor(to, setup_.wanted_distance_m, "distance");
    if (below.starts_with("1/"))
      result += "*" + below.substr(2);
    else if (below != "1")
      result += "/" + in_brackets(below);
    if (above.starts_with("1/"))
      result += above.substr(1);
    else if (above != "1")
      result += "*" + in_brackets(above);
    return result;
  }
  std::string factor(Dimension quantity, std::optional<double> distance_m, const char* distance_name) {
    const Formula* const formula = find_formula(*setup_.shape, setup_.conventions, quantity);
    if (formula == nullptr) return "1";  // its own quantity
    // Distances of both sides stand in one formula only if both sides are illuminances.
    const bool both = plain(given_, wanted_) == plain(wanted_, given_);
    const std::string_view distance = both ? distance_name : "distance",
                           projected = both && distance == "given_distance" ? "given_projected" : "projected";
    std::string text = renamed(renamed(formula->factor, "distance", distance), "projected", projected);
    std::vector<Symbol> symbols = std::visit(SymbolsOf{setup_, distance_m}, *setup_.shape);
    symbols.push_back({"distance", distance_m.value_or(0), "m"});
    symbols.push_back({"sides", setup_.conventions.two_sided ? 2.0 : 1.0, ""});
    for (Symbol& s : symbols) {
      if (!mentions(formula->factor, s.name)) continue;
      if (s.name == "distance") s.name = distance;
      if (s.name == "projected") s.name = projected;
      add_symbol(s);
    }
    add_note(fmt::format("{}{}{}: {} = {} x {}; {} ({})", formula->shape, formula->variant.empty() ? "" : ", ", formula->variant,
                         symbol_of(quantity), formula->factor, own_quantity_of(formula->shape), formula->why, formula->source));
    return text;
  }

  Dimension given_, wanted_;
  const LightSetup& setup_;
  Explanation explanation_;
};

}  // namespace

Result<Explanation> explain(const AnyQuantity& given, Dimension wanted, const LightSetup& setup) {
  if (const Result<double> result = convert(given, wanted, setup); !result) return result.error();
  return Explainer(given.dimension, wanted, setup)(given);
}

Result<Explanation> explain(const CameraSettings& camera) {
  const Result<double> t = shutter_time(camera);
  if (!t) return t.error();
  if (const Result<double> ev = camera.iso ? ev100(camera) : ev_s(camera); !ev) return ev.error();
  Explanation e;
  e.symbols = {{"N", camera.f_number ? *camera.f_number : *camera.t_stop, ""}, {"t", *t, "s"}};
  if (camera.t_stop) e.notes.emplace_back("a T-stop counts as the f-number");
  if (camera.shutter_angle_rad) {
    e.symbols = {e.symbols[0], {"angle", *camera.shutter_angle_rad, "rad"}, {"fps", *camera.frames_per_s, "1/s"}};
    e.notes.emplace_back("the shutter is open for its angle's part of a frame: t = angle/(2*pi*fps)");
  }
  const std::string_view open = camera.shutter_angle_rad ? "(angle/(2*pi*fps))" : "t";
  if (camera.iso) {
    e.formula = fmt::format("ev = log2(N^2/{})-log2(S/100)", open);
    e.symbols.push_back({"S", *camera.iso, ""});
    e.notes.emplace_back("EV is EV100, the exposure value at ISO 100 (Lagarde and de Rousiers 2014, eq 67)");
  } else {
    e.formula = fmt::format("ev_s = log2(N^2/{})", open);
    e.notes.emplace_back("without ISO only EV_S is known");
  }
  if (camera.nd_density != 0 || camera.compensation_stop != 0)
    e.notes.emplace_back("filters and compensation are no part of an exposure value");
  return e;
}

std::string to_string(const Explanation& explanation) {
  std::string text = explanation.formula;
  for (const Symbol& s : explanation.symbols) text += fmt::format("\n  {} = {}{}{}", s.name, s.value, s.unit.empty() ? "" : " ", s.unit);
  for (const std::string& note : explanation.notes) text += "\n  " + note;
  return text;
}

}  // namespace etendue
