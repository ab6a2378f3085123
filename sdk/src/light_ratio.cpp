#include "light_ratio.h"

#include "article.h"
#include "light_illuminance.h"
#include "parameter_error.h"

#include <fmt/format.h>

namespace etendue {

namespace {

template <class S>
double nearest_of(const S& shape) {
  if constexpr (detail::one_of<S, SphereShape, TubeShape>) return shape.radius;
  return 0;
}

template <class S>
constexpr bool flat = detail::one_of<S, DiskShape, RectShape, PolygonShape, SurfaceOfArea>;

template <class S>
Result<double> checked_distance(const S& shape, std::optional<double> distance_m) {
  if (!distance_m) return parameter_error("distance", "DISTANCE_MISSING", "an illuminance needs the distance at which it is measured");
  const double nearest = nearest_of(shape);
  if (std::isfinite(*distance_m) && *distance_m > nearest) return *distance_m;
  return parameter_error("distance", "NUMBER_INVALID",
                         fmt::format("expected a distance greater than {} m, found {} m", nearest, *distance_m));
}

Error unsuitable(const char* text, const char* hint) { return parameter_error("shape", "UNIT_UNSUITABLE", text, hint); }

template <PunctualShape S>
Wide flux_ratio(const S& shape, const Conventions& conventions) {
  if constexpr (std::same_as<S, PointShape>)
    return 4 * wide_pi;
  else if constexpr (std::same_as<S, SpotShape>)
    return solid_angle_of(shape, conventions);
  else if constexpr (std::same_as<S, FrustumShape>)
    return solid_angle_of_frustum(shape);
  else
    return shape.flux_over_axial_sr;
}

// E = I / d^2.
template <PunctualShape S>
Result<Wide> unchecked_ratio(const S& shape, Dimension quantity, const Conventions& conventions, std::optional<double> distance_m) {
  switch (quantity) {
    case Dimension::luminous_intensity:
      return Wide(1);
    case Dimension::luminous_flux: {
      const Wide steradians = flux_ratio(shape, conventions);
      if (steradians.hi > 0) return steradians;
      return parameter_error("outer", "SIZE_MISSING",
                             "flux needs an opening angle greater than zero: within none the intensity is infinite");
    }
    case Dimension::illuminance: {
      const Result<double> distance = checked_distance(shape, distance_m);
      return distance ? Result<Wide>(1 / squared(*distance)) : distance.error();
    }
    default:
      return unsuitable("it has no surface", "give its flux or its intensity, or a shape with a size");
  }
}

// A uniform luminance L, the same in all directions (Lambert): flux pi L A, exitance pi L, intensity L times the area seen.
template <SurfaceShape S>
Result<Wide> unchecked_ratio(const S& shape, Dimension quantity, const Conventions& conventions, std::optional<double> distance_m) {
  const double sides = flat<S> && conventions.two_sided ? 2 : 1;
  switch (quantity) {
    case Dimension::luminance:
      return Wide(1);
    case Dimension::luminous_exitance:
      return wide_pi;
    case Dimension::luminous_flux:
      if constexpr (std::same_as<S, SurfaceOfArea>)
        return sides * wide_pi * shape.area_m2;
      else
        return sides * wide_pi * area_of(shape);
    case Dimension::luminous_intensity:
      if constexpr (std::same_as<S, SurfaceOfArea>)
        return unsuitable("it has no one direction", "give its flux or its luminance");
      else
        return face_of(shape);
    case Dimension::illuminance:
      if constexpr (std::same_as<S, SurfaceOfArea>) {
        return unsuitable("it has no one direction", "give its flux or its luminance");
      } else {
        const Result<double> distance = checked_distance(shape, distance_m);
        return distance ? Result<Wide>(facing_factor(shape, *distance)) : distance.error();
      }
    default:
      return unsuitable("this quantity says nothing about a light with a surface", "give its flux, luminance, intensity or illuminance");
  }
}

// I(theta) = I sin(theta) over the sphere: flux = 2 pi I integral of sin^2 = pi^2 I.
Result<Wide> unchecked_ratio(const LineShape& shape, Dimension quantity, const Conventions&, std::optional<double> distance_m) {
  switch (quantity) {
    case Dimension::luminous_intensity:
      return Wide(1);
    case Dimension::luminous_flux:
      return squared(wide_pi);
    case Dimension::illuminance: {
      const Result<double> distance = checked_distance(shape, distance_m);
      return distance ? Result<Wide>(facing_factor(shape, *distance)) : distance.error();
    }
    default:
      return unsuitable("a line has no surface", "give its flux, or make it a tube");
  }
}

// A disk of angular radius a around the normal gives E = L pi sin^2(a).
Result<Wide> unchecked_ratio(const DistantShape& shape, Dimension quantity, const Conventions&, std::optional<double>) {
  if (quantity != Dimension::luminance && quantity != Dimension::illuminance)
    return unsuitable("it is infinitely far away", "give its illuminance");
  if (shape.diameter_rad == 0)
    return parameter_error("angular_diameter", "SIZE_MISSING",
                           "a luminance needs an angular diameter greater than zero: that of a direction is infinite");
  return quantity == Dimension::luminance ? Wide(1) : wide_pi * squared(std::sin(shape.diameter_rad / 2));
}

// A plane under a uniform sky has E = pi L.
Result<Wide> unchecked_ratio(const EnvironmentShape&, Dimension quantity, const Conventions&, std::optional<double>) {
  switch (quantity) {
    case Dimension::luminance:
      return Wide(1);
    case Dimension::illuminance:
      return wide_pi;
    default:
      return unsuitable("it is infinitely far away", "give its luminance or its illuminance");
  }
}

// Luminance and exitance of a surface do not depend on its area.
template <class S>
bool needs_no_size(Dimension quantity) {
  return std::same_as<S, SurfaceOfArea> && (quantity == Dimension::luminance || quantity == Dimension::luminous_exitance);
}

}  // namespace

template <class S>
Result<Wide> ratio_of(const S& shape, Dimension quantity, const Conventions& conventions, std::optional<double> distance_m) {
  Result<Wide> ratio = unchecked_ratio(shape, quantity, conventions, distance_m);
  if (!ratio && ratio.error().code == "UNIT_UNSUITABLE") return ratio;
  if (!needs_no_size<S>(quantity))
    if (const Status sized = check_size(shape); !sized) return sized.error();
  if (ratio && !(ratio->hi > 0 && std::isfinite(ratio->hi)))
    return parameter_error("shape", "NUMBER_INVALID",
                           fmt::format("expected sizes whose areas are within the range of a double, found a factor of {}", ratio->hi));
  return ratio;
}

namespace detail {

template <class S>
Result<double> converted(const Known& from, const Known& wanted, const S& shape, const Conventions& conventions) {
  if (!(from.si >= 0 && std::isfinite(from.si)))
    return parameter_error("value", "NUMBER_INVALID",
                           fmt::format("expected {} that is finite and not negative, found {} {}", with_article(name_of(from.dimension)),
                                       from.si, si_unit_of(from.dimension)));
  if (from.dimension == wanted.dimension && from.distance_m == wanted.distance_m) return from.si;
  const Result<Wide> divisor = ratio_of(shape, from.dimension, conventions, from.distance_m);
  if (!divisor) return divisor.error();
  const Result<Wide> factor = ratio_of(shape, wanted.dimension, conventions, wanted.distance_m);
  if (!factor) return factor.error();
  const double result(from.si * (*factor / *divisor));
  if (std::isfinite(result)) return result;
  return parameter_error("value", "NUMBER_INVALID", fmt::format("the {} is beyond the range of a double", name_of(wanted.dimension)));
}

}  // namespace detail

#define ETENDUE_INSTANTIATE(S)                                                                    \
  template Result<Wide> ratio_of(const S&, Dimension, const Conventions&, std::optional<double>); \
  template Result<double> detail::converted(const detail::Known&, const detail::Known&, const S&, const Conventions&);
ETENDUE_INSTANTIATE(PointShape)
ETENDUE_INSTANTIATE(SpotShape)
ETENDUE_INSTANTIATE(FrustumShape)
ETENDUE_INSTANTIATE(BeamOfSolidAngle)
ETENDUE_INSTANTIATE(SphereShape)
ETENDUE_INSTANTIATE(DiskShape)
ETENDUE_INSTANTIATE(RectShape)
ETENDUE_INSTANTIATE(PolygonShape)
ETENDUE_INSTANTIATE(TubeShape)
ETENDUE_INSTANTIATE(SurfaceOfArea)
ETENDUE_INSTANTIATE(LineShape)
ETENDUE_INSTANTIATE(DistantShape)
ETENDUE_INSTANTIATE(EnvironmentShape)
#undef ETENDUE_INSTANTIATE

Result<SolidAngle> solid_angle(const SpotShape& spot, const Conventions& conventions) {
  if (const Status sized = check_size(spot); !sized) return sized.error();
  return steradians(double(solid_angle_of(spot, conventions)));
}
Result<SolidAngle> solid_angle(const FrustumShape& frustum) {
  if (const Status sized = check_size(frustum); !sized) return sized.error();
  return steradians(double(solid_angle_of_frustum(frustum)));
}
Result<SolidAngle> solid_angle_of_cone(Angle full_angle) {
  return solid_angle(SpotShape{full_angle.si / 2, full_angle.si / 2}, {.spot_flux = FluxConvention::cone});
}

namespace {
Status checked(double si, Efficacy efficacy) {
  if (!(si >= 0 && std::isfinite(si)))
    return parameter_error("value", "NUMBER_INVALID", fmt::format("expected a quantity that is finite and not negative, found {}", si));
  if (efficacy.si > 0 && std::isfinite(efficacy.si)) return Done{};
  return parameter_error("efficacy", "NUMBER_INVALID",
                         fmt::format("expected an efficacy above 0 lm/W and finite, found {} lm/W", efficacy.si));
}
Result<double> within_double(double x) {
  if (std::isfinite(x)) return x;
  return parameter_error("value", "NUMBER_INVALID", "the result is beyond the range of a double");
}
}  // namespace

Result<double> photometric_si(double radiant_si, Efficacy efficacy) {
  const Status possible = checked(radiant_si, efficacy);
  return possible ? within_double(radiant_si * efficacy.si) : possible.error();
}
Result<double> radiant_si(double photometric_si, Efficacy efficacy) {
  const Status possible = checked(photometric_si, efficacy);
  return possible ? within_double(photometric_si / efficacy.si) : possible.error();
}

}  // namespace etendue
