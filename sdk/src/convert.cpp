#include "etendue/convert.h"

#include "article.h"
#include "etendue/temperature.h"
#include "light_ratio.h"
#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {
namespace {

bool is_ev(Dimension d) { return d == Dimension::exposure_value; }
bool is_light(Dimension d) {
  switch (d) {
    case Dimension::luminous_flux:
    case Dimension::luminous_intensity:
    case Dimension::luminance:
    case Dimension::illuminance:
    case Dimension::luminous_exitance:
      return true;
    default:
      return false;
  }
}

// A dimension without its efficacy or exponential: one of the five photometric ones.
Result<Dimension> plain(Dimension d, Dimension other, bool has_shape) {
  if (is_light(d)) return d;
  if (const auto twin = photometric_twin(d)) return *twin;
  if (is_ev(d)) {
    const Dimension beside = photometric_twin(other).value_or(other);
    return !has_shape && beside == Dimension::illuminance ? Dimension::illuminance : Dimension::luminance;
  }
  return parameter_error("to", "DIMENSION_MISMATCH", fmt::format("a {} is no quantity of a light that becomes another one", name_of(d)));
}

Result<double> positive(const char* parameter, const char* what, double value) {
  if (value > 0 && std::isfinite(value)) return value;
  return parameter_error(parameter, "NUMBER_INVALID", fmt::format("expected {} above 0 and finite, found {}", what, value));
}

// ratio_of() for a shape that is known at run time.
struct RatioOf {
  Dimension quantity;
  const LightSetup& setup;
  std::optional<double> distance_m;

  template <LightShape S>
  Result<Wide> operator()(const S& shape) const {
    return ratio_of(shape, quantity, setup.conventions, distance_m);
  }
  Result<Wide> operator()(const MeshShape&) const { return (*this)(SurfaceOfArea{setup.mesh_area_m2.value_or(0)}); }
  Result<Wide> operator()(const PhotometricShape&) const {
    if (setup.photometric_sr) return (*this)(BeamOfSolidAngle{*setup.photometric_sr});
    return parameter_error("flux_over_axial", "SOLID_ANGLE_MISSING", "needs the flux over the axial intensity of the photometric file");
  }
};

Result<Wide> ratio_between(Dimension given, Dimension wanted, const LightSetup& setup) {
  if (given == wanted && (given != Dimension::illuminance || setup.given_distance_m == setup.wanted_distance_m)) return Wide(1);
  if (!setup.shape) {
    // A surface that emits equally in all directions, of whatever size and form.
    if (given == Dimension::luminance && wanted == Dimension::luminous_exitance) return wide_pi;
    if (given == Dimension::luminous_exitance && wanted == Dimension::luminance) return 1 / wide_pi;
    return parameter_error("shape", "SHAPE_MISSING",
                           fmt::format("what {} {} makes depends on the light's shape", name_of(wanted), with_article(name_of(given))),
                           "say what the light is: a point, a spot, a sphere of some radius, ...");
  }
  const Result<Wide> divisor = std::visit(RatioOf{given, setup, setup.given_distance_m}, *setup.shape);
  const Result<Wide> factor = std::visit(RatioOf{wanted, setup, setup.wanted_distance_m}, *setup.shape);
  // What the shape cannot say at all is told before what is missing to say it.
  if (!factor && (divisor || factor.error().code == "UNIT_UNSUITABLE")) return factor.error();
  if (!divisor) return divisor.error();
  return *factor / *divisor;
}

Error of_shape(Error found, Dimension quantity, const LightSetup& setup) {
  if (found.code != "SHAPE_MISSING" && setup.shape)
    found.text = fmt::format("{} of {} light: {}", name_of(quantity), with_article(name_of(*setup.shape)), found.text);
  return found;
}

}  // namespace

Result<Conversion> Conversion::between(Dimension given, Dimension wanted, const LightSetup& setup) {
  Conversion c;
  c.given_.dimension = given;
  c.wanted_.dimension = wanted;
  if (given == wanted && given != Dimension::illuminance && given != Dimension::irradiance) return c;

  const Result<Dimension> from = plain(given, wanted, setup.shape.has_value()), to = plain(wanted, given, setup.shape.has_value());
  if (!from || !to)
    return parameter_error("to", "DIMENSION_MISMATCH",
                           fmt::format("{} (in {}) does not become {} (in {})", with_article(name_of(given)), si_unit_of(given),
                                       with_article(name_of(wanted)), si_unit_of(wanted)));
  Result<Wide> ratio = ratio_between(*from, *to, setup);
  if (!ratio) return of_shape(ratio.error(), wanted, setup);

  const bool from_radiant = photometric_twin(given).has_value(), to_radiant = photometric_twin(wanted).has_value();
  if (from_radiant != to_radiant) {
    if (!setup.efficacy_lm_W)
      return parameter_error(
          "efficacy", "EFFICACY_MISSING", "between watts and lumens stands an efficacy: expected one in lm/W, found none",
          "electrical watts: lumens per watt on the lamp's package, such as 15 lm/W; radiant watts: that of its spectrum");
    const Result<double> efficacy = positive("efficacy", "an efficacy in lm/W", *setup.efficacy_lm_W);
    if (!efficacy) return efficacy.error();
    ratio = from_radiant ? *ratio * *efficacy : *ratio / *efficacy;
    c.efficacy_lm_W_ = *efficacy;
  }
  const auto per_ev = [&](Dimension d) -> Result<double> {
    const Result<double> constant = d == Dimension::luminance ? positive("meter_k", "a meter constant K", setup.meter_k)
                                                              : positive("meter_c", "a meter constant C", setup.meter_c);
    return constant ? Result<double>(*constant / 100) : constant;
  };
  for (const auto& [dimension, side, over] : {std::tuple{given, *from, &c.given_per_ev_}, std::tuple{wanted, *to, &c.wanted_per_ev_}}) {
    if (!is_ev(dimension)) continue;
    const Result<double> per = per_ev(side);
    if (!per) return per.error();
    *over = *per;
  }
  c.ratio_ = ratio->hi;
  c.ratio_rest_ = ratio->lo;
  return c;
}

// An exposure value is a logarithm, a reciprocal unit a quotient: they go by way of SI.
Result<Conversion> Conversion::between(const NamedUnit& given, const NamedUnit& wanted, const LightSetup& setup) {
  Result<Conversion> made = between(given.dimension, wanted.dimension, setup);
  if (!made) return made;
  made->given_ = given;
  made->wanted_ = wanted;
  if (made->by_way_of_si()) return made;
  const Wide ratio = Wide(made->ratio_, made->ratio_rest_) * (Wide(given.times) * wanted.over) / (Wide(given.over) * wanted.times);
  made->ratio_ = ratio.hi;
  made->ratio_rest_ = ratio.lo;
  return made;
}

bool Conversion::by_way_of_si() const { return is_ev(given()) || is_ev(wanted()) || given_.reciprocal || wanted_.reciprocal; }

Result<double> Conversion::operator()(double x) const {
  const bool signed_quantity = !is_light(given()) && !photometric_twin(given());
  if (!std::isfinite(x) || (x < 0 && !signed_quantity))
    return parameter_error("value", "NUMBER_INVALID",
                           fmt::format("expected {} that is finite{}, found {} {}", with_article(name_of(given())),
                                       signed_quantity ? "" : " and not negative", given_.to_si(x), si_unit_of(given())));
  if (given() == Dimension::temperature)
    if (const Result<double> checked = checked_temperature(given_.to_si(x)); !checked) return about("value", checked.error());

  double result = 0;
  if (!by_way_of_si()) {
    result = double(x * Wide(ratio_, ratio_rest_));
  } else if (given_ == wanted_) {
    result = x;
  } else {
    const double si = given_.to_si(x);
    result = double((is_ev(given()) ? std::exp2(si) * given_per_ev_ : si) * Wide(ratio_, ratio_rest_));
    if (is_ev(wanted())) {
      if (!(result > 0))
        return parameter_error("value", given() == Dimension::illuminance ? "ILLUMINANCE_NOT_POSITIVE" : "LUMINANCE_NOT_POSITIVE",
                               fmt::format("expected {} above 0, found {} {}: it has no exposure value", with_article(name_of(given())), si,
                                           si_unit_of(given())));
      result = std::log2(result) - std::log2(wanted_per_ev_);
    }
    result = wanted_.from_si(result);
  }
  if (std::isfinite(result)) return result;
  return parameter_error("value", "NUMBER_INVALID", fmt::format("the {} is beyond the range of a double", name_of(wanted())));
}

Result<double> convert(const AnyQuantity& given, Dimension wanted, const LightSetup& setup) {
  const Result<Conversion> conversion = Conversion::between(given.dimension, wanted, setup);
  if (!conversion) return conversion.error();
  return (*conversion)(given.si);
}

}  // namespace etendue
