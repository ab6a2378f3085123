// Light quantities whose dimension and shape are known at run time only, as in a script or on a command line.
//   LightSetup bulb{.shape = SphereShape{.radius = 0.15}};
//   Result<double> nits = convert({Dimension::luminous_flux, 1500}, Dimension::luminance, bulb);   // 1688.69
// The same arithmetic as light_units.h; what that does not compile is an error here.
#pragma once

#include "etendue/light_units.h"
#include "etendue/unit_names.h"

namespace etendue {

// What is known of a light besides the quantity. What a conversion needs and does not find here is an error, never a default.
struct LightSetup {
  std::optional<Shape> shape;
  Conventions conventions;
  std::optional<double> given_distance_m;   // of a given illuminance: "15 klx @ 2 m"
  std::optional<double> wanted_distance_m;  // of a wanted one
  std::optional<double> efficacy_lm_W;      // between a photometric quantity and its radiometric twin
  std::optional<double> mesh_area_m2;       // MeshShape: area of one side
  std::optional<double> photometric_sr;     // PhotometricShape: the file's flux over its axial intensity
  double meter_k = 12.5;                    // L = 2^EV K / 100, cd s/m2
  double meter_c = 250;                     // E = 2^EV C / 100, lx s
};

// One conversion, prepared for any number of values: x -> ratio x, with an exponential before it where exposure values are given and a
// logarithm behind it where they are wanted. An exposure value is the luminance of a light with a surface; without a shape it is a meter's
// reading, of luminance (K) or, beside an illuminance, of illuminance (C).
class Conversion {
 public:
  // Errors: DIMENSION_MISMATCH (no light connects the two), SHAPE_MISSING, SIZE_MISSING, DISTANCE_MISSING, EFFICACY_MISSING,
  // SOLID_ANGLE_MISSING, UNIT_UNSUITABLE (the shape does not know one of the two), NUMBER_INVALID (a size, an angle, a distance, an
  // efficacy or a meter's constant out of range). They name the field, what was found and what is legal.
  static Result<Conversion> between(Dimension given, Dimension wanted, const LightSetup& setup);
  // Of numbers in these units: their factors and the ratio are one number of 106 bits, so that a product is rounded once (6 ft are 182.88
  // cm). Degrees and foot-lamberts have pi in theirs, which is rounded before.
  static Result<Conversion> between(const NamedUnit& given, const NamedUnit& wanted, const LightSetup& setup);

  // From the unit of one side to that of the other: of SI, or those that were named. NUMBER_INVALID: not finite, negative (exposure values
  // and what is no quantity of a light may be), or a result beyond a double; TEMPERATURE_OUT_OF_RANGE; LUMINANCE_NOT_POSITIVE,
  // ILLUMINANCE_NOT_POSITIVE: 0 has no exposure value.
  Result<double> operator()(double x) const;

  Dimension given() const { return given_.dimension; }
  Dimension wanted() const { return wanted_.dimension; }
  // The lm/W that the result depends on, if it does.
  std::optional<double> efficacy_lm_W() const { return efficacy_lm_W_; }

 private:
  bool by_way_of_si() const;

  NamedUnit given_{}, wanted_{};
  // What exposure values stand for on either side, over 2^EV; 0: the side is no exposure value.
  double given_per_ev_ = 0, wanted_per_ev_ = 0;
  // Their sum, unevaluated: of SI where one side is an exposure value or a reciprocal, else of the two units.
  double ratio_ = 1, ratio_rest_ = 0;
  std::optional<double> efficacy_lm_W_;
};

Result<double> convert(const AnyQuantity& given, Dimension wanted, const LightSetup& setup);

}  // namespace etendue
