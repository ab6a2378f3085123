// Units to what is emitted: what was given over what one unit of the light's own quantity would amount to (light_ratio.h).
#include "light_ratio.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue {
namespace {

using Given = Emission::Given;
using Kind = Resolved::Kind;

bool finite(const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

const char* name_of(Given given, bool radiant) {
  switch (given) {
    case Given::flux:
      return radiant ? "radiant_flux" : "flux";
    case Given::intensity:
      return radiant ? "radiant_intensity" : "intensity";
    case Given::luminance:
      return radiant ? "radiance" : "luminance";
    case Given::illuminance:
      return radiant ? "irradiance" : "illuminance";
    case Given::ev:
      return "ev";
    case Given::as_file:
      break;
  }
  return "emission of the file";
}

// A photometric value without colour, of white light.
struct White {
  Kind kind = Kind::luminance;
  double value = 0;
  double flux_lm = 0;
  double area_m2 = 0;
};

class Resolver {
 public:
  Resolver(const Light& light, double mesh_area_m2) : light_(light), e_(light.emission), mesh_area_m2_(mesh_area_m2) {}

  // Photometric value of what was given, EV apart.
  Result<double> photometric() const {
    if (!std::isfinite(e_.value) || (e_.given != Given::ev && e_.value < 0))
      return error("NUMBER_INVALID", fmt::format("expected a finite {} that is not negative, found {}", given(), e_.value));
    if (!e_.radiant) return e_.value;
    if (e_.given == Given::ev || e_.given == Given::as_file)
      return error("UNIT_UNSUITABLE", fmt::format("{} has no radiant twin", given()));
    if (!e_.efficacy_lm_W)
      return error("EFFICACY_MISSING", fmt::format("{} needs an efficacy in lm/W to become a photometric quantity", given()));
    if (!std::isfinite(*e_.efficacy_lm_W) || *e_.efficacy_lm_W <= 0)
      return error("NUMBER_INVALID", fmt::format("expected an efficacy greater than zero, found {} lm/W", *e_.efficacy_lm_W));
    return e_.value * *e_.efficacy_lm_W;
  }

  template <PunctualShape S>
  Result<White> operator()(const S& shape) const {
    return own(Kind::intensity, shape, 0);
  }
  Result<White> operator()(const LineShape& shape) const { return own(Kind::line, shape, 0); }
  template <FormedShape S>
  Result<White> operator()(const S& shape) const {
    const Result<double> area_m2 = emitting_area(light_);
    if (!area_m2) return area_m2.error();
    return own(Kind::luminance, shape, *area_m2);
  }
  Result<White> operator()(const MeshShape&) const { return own(Kind::luminance, SurfaceOfArea{mesh_area_m2_}, mesh_area_m2_); }

  // A true direction has no luminance.
  Result<White> operator()(const DistantShape& shape) const {
    if (e_.given == Given::illuminance && shape.diameter_rad == 0) return White{Kind::illuminance, v(), 0, 0};
    return own(Kind::luminance, shape, 0);
  }

  // The file's own candelas, times colour and filter; a flux is what the file is to be rescaled to.
  Result<White> operator()(const PhotometricShape&) const {
    if (e_.given == Given::as_file) return White{Kind::intensity, 1, 0, 0};
    if (e_.given == Given::flux) return White{Kind::intensity, 1, v(), 0};
    return unsuitable("its file gives the candelas; only flux rescales them");
  }

  Result<White> operator()(const EnvironmentShape& shape) const {
    if (e_.given != Given::as_file) return own(Kind::luminance, shape, 0);
    if (shape.image) return White{Kind::luminance, 1, 0, 0};
    return error("EMISSION_MISSING", "an environment without an image needs a luminance or an illuminance");
  }

  Error error(const char* code, const std::string& text) const {
    return {code, fmt::format("{} light \"{}\": {}", etendue::name_of(light_.shape), light_.name, text), {"", 0, 0, light_.source}, {}, {}};
  }

 private:
  const char* given() const { return name_of(e_.given, e_.radiant); }
  double v() const { return e_.radiant ? e_.value * *e_.efficacy_lm_W : e_.value; }
  Error unsuitable(const std::string& what_to_do) const {
    if (e_.given == Given::as_file) return error("EMISSION_MISSING", "expected an emission, found none");
    Error e = error("UNIT_UNSUITABLE", fmt::format("{} says nothing about this shape", given()));
    e.hint = what_to_do;
    return e;
  }

  Dimension dimension() const {
    switch (e_.given) {
      case Given::flux:
        return Dimension::luminous_flux;
      case Given::intensity:
        return Dimension::luminous_intensity;
      case Given::illuminance:
        return Dimension::illuminance;
      default:
        return Dimension::luminance;
    }
  }

  template <class S>
  Result<White> own(Kind kind, const S& shape, double side_m2) const {
    if (e_.given == Given::as_file) return unsuitable("");
    Conventions conventions{.two_sided = light_.two_sided, .spot_flux = light_.flux_convention};
    const Result<Wide> divisor = ratio_of(shape, dimension(), conventions, e_.distance_m);
    if (!divisor) return of_this_light(divisor.error());
    const double value(Wide(e_.given == Given::ev ? luminance_of_ev100(e_.value) : v()) / *divisor);
    // What is sent out is the integral over the falloff, whatever convention the flux was given in.
    conventions.spot_flux = FluxConvention::falloff;
    const Result<Wide> flux = ratio_of(shape, Dimension::luminous_flux, conventions, {});
    return White{kind, value, flux ? double(value * *flux) : 0, side_m2 * (emits_both_sides(light_) ? 2 : 1)};
  }
  Error of_this_light(const Error& found) const {
    if (found.code == "UNIT_UNSUITABLE") return unsuitable(found.text + "; " + found.hint);
    Error named = error(found.code.c_str(), found.code == "NUMBER_INVALID" ? found.text : fmt::format("{}: {}", given(), found.text));
    named.hint = found.hint;
    return named;
  }

  const Light& light_;
  const Emission& e_;
  double mesh_area_m2_;
};

}  // namespace

Result<Resolved> resolve(const Light& light, double mesh_area_m2) {
  const Resolver resolver(light, mesh_area_m2);
  if (const Result<double> value = resolver.photometric(); !value) return value.error();
  const Result<Rgb> colour = rgb_of(light.colour);
  if (!colour) return resolver.error(colour.error().code.c_str(), colour.error().text);
  const Rgb& filter = light.filter;
  if (!finite(filter) || filter.x < 0 || filter.y < 0 || filter.z < 0)
    return resolver.error("COLOUR_INVALID", fmt::format("expected a filter of finite numbers that are not negative, found {} {} {}",
                                                        filter.x, filter.y, filter.z));
  const Result<White> white = std::visit(resolver, light.shape);
  if (!white) return white.error();

  const Rgb filtered = *colour * filter;
  const Resolved resolved{white->kind, filtered * white->value, white->flux_lm * luminance_of(filtered), white->area_m2};
  if (!finite(resolved.rgb) || !std::isfinite(resolved.flux_lm))
    return resolver.error("NUMBER_INVALID", "the emission is beyond the range of a double for this size");
  return resolved;
}

}  // namespace etendue
