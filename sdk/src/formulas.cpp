// The table. tests/unit/formulas_test.cpp evaluates every row and compares it with the conversion; sdk/docs/units.md is held to it too.
#include "etendue/formulas.h"

#include <algorithm>
#include <array>

namespace etendue {
namespace {

using D = Dimension;

constexpr std::string_view frostbite_13 = "Lagarde and de Rousiers 2014, eq 13";
constexpr std::string_view table_9 = "Lagarde and de Rousiers 2014, table 9";
constexpr std::string_view table_12 = "Lagarde and de Rousiers 2014, eq 33 and table 12";
constexpr std::string_view definition = "definition: I = L times the area seen (ISO 80000-7)";
constexpr std::string_view lambert = "Lambert 1760; M = pi L (ISO 80000-7)";
constexpr std::string_view contour = "Lambert 1760; Arvo 1995, eq 2";
constexpr std::string_view integral = "derived in sdk/docs/units.md, checked against quadrature";
constexpr std::string_view inverse_square = "the inverse square law";
constexpr std::string_view exitance_why = "cosine-weighted integral of an even luminance over a hemisphere";
constexpr std::string_view flux_why = "exitance pi L times the emitting area";

constexpr std::array all{
    Formula{"point", "", D::luminous_flux, "4*pi", "solid angle of the sphere", "Lagarde and de Rousiers 2014, eq 15 with its sine (E6)"},
    Formula{"point", "", D::illuminance, "1/distance^2", inverse_square, frostbite_13},

    Formula{"spot", "falloff squared", D::luminous_flux, "4*pi/3*(2*sin(inner/2)^2+sin(outer/2)^2)",
            "integral of s^2, s = (cos t - cos outer)/(cos inner - cos outer), over the cone", integral},
    Formula{"spot", "falloff smoothstep", D::luminous_flux, "2*pi*(sin(inner/2)^2+sin(outer/2)^2)",
            "integral of s^2 (3 - 2 s) over the cone", integral},
    Formula{"spot", "falloff hard", D::luminous_flux, "4*pi*sin(outer/2)^2", "solid angle of the cone, 2 pi (1 - cos outer)", table_9},
    Formula{"spot", "cone", D::luminous_flux, "4*pi*sin(outer/2)^2",
            "solid angle of the cone, 2 pi (1 - cos outer), as if it had no falloff", table_9},
    Formula{"spot", "frostbite_pi", D::luminous_flux, "pi", "Frostbite's masking reflector, independent of the angle",
            "Lagarde and de Rousiers 2014, eq 17"},
    Formula{"spot", "isotropic", D::luminous_flux, "4*pi", "as if the spot were a point that is masked",
            "Blender, Bevy, Unity without reflector"},
    Formula{"spot", "", D::illuminance, "1/distance^2", inverse_square, frostbite_13},

    Formula{"frustum", "", D::luminous_flux,
            "4*atan2(sin(width_angle/2)*sin(height_angle/2),hypot(cos(width_angle/2),sin(width_angle/2)*cos(height_angle/2)))",
            "solid angle of a rectangular pyramid, 4 asin(sin a/2 sin b/2), in a form that keeps its digits near 180 degrees", table_9},
    Formula{"frustum", "", D::illuminance, "1/distance^2", inverse_square, frostbite_13},

    Formula{"photometric", "", D::luminous_flux, "solid_angle", "flux over axial intensity of the file", "IES LM-63, EULUMDAT"},
    Formula{"photometric", "", D::illuminance, "1/distance^2", inverse_square, frostbite_13},

    Formula{"sphere", "", D::luminous_flux, "4*pi^2*radius^2", flux_why, table_12},
    Formula{"sphere", "", D::luminous_intensity, "pi*radius^2", "it is seen as a disk", definition},
    Formula{"sphere", "", D::luminous_exitance, "pi", exitance_why, lambert},
    Formula{"sphere", "", D::illuminance, "pi*(radius/distance)^2", "at every distance outside of it, near or far",
            "Lagarde and de Rousiers 2014, eq 38"},

    Formula{"disk", "", D::luminous_flux, "pi^2*radius^2*sides", flux_why, table_12},
    Formula{"disk", "", D::luminous_intensity, "pi*radius^2", "along its normal", definition},
    Formula{"disk", "", D::luminous_exitance, "pi", exitance_why, lambert},
    Formula{"disk", "", D::illuminance, "pi*radius^2/(radius^2+distance^2)", "on its axis: pi sin^2 of the angle of its rim", contour},

    Formula{"rect", "", D::luminous_flux, "pi*width*height*sides", flux_why, table_12},
    Formula{"rect", "", D::luminous_intensity, "width*height", "along its normal", definition},
    Formula{"rect", "", D::luminous_exitance, "pi", exitance_why, lambert},
    Formula{"rect", "", D::illuminance,
            "width/hypot(width/2,distance)*atan(height/2/hypot(width/2,distance))"
            "+height/hypot(height/2,distance)*atan(width/2/hypot(height/2,distance))",
            "before its middle: a term for each pair of edges", contour},

    Formula{"polygon", "", D::luminous_flux, "pi*area*sides", flux_why, "Lagarde and de Rousiers 2014, eq 33"},
    Formula{"polygon", "", D::luminous_intensity, "area", "along its normal", definition},
    Formula{"polygon", "", D::luminous_exitance, "pi", exitance_why, lambert},
    Formula{"polygon", "", D::illuminance, "projected",
            "projected solid angle: half the sum over the edges of angle times the normal's part", contour},

    Formula{"tube", "round", D::luminous_flux, "pi*(2*pi*radius*length+4*pi*radius^2)", flux_why, table_12},
    Formula{"tube", "flat", D::luminous_flux, "pi*(2*pi*radius*length+2*pi*radius^2)", flux_why, "Lagarde and de Rousiers 2014, eq 33"},
    Formula{"tube", "none", D::luminous_flux, "pi*2*pi*radius*length", flux_why, "Lagarde and de Rousiers 2014, eq 33"},
    Formula{"tube", "round", D::luminous_intensity, "2*radius*length+pi*radius^2", "across it is seen as a stadium", definition},
    Formula{"tube", "flat", D::luminous_intensity, "2*radius*length", "across it is seen as a rectangle", definition},
    Formula{"tube", "none", D::luminous_intensity, "2*radius*length", "across it is seen as a rectangle", definition},
    Formula{"tube", "", D::luminous_exitance, "pi", exitance_why, lambert},
    Formula{"tube", "", D::illuminance, "projected", "projected solid angle opposite its middle: the integral over its silhouette",
            contour},

    Formula{"line", "", D::luminous_flux, "pi^2", "I(t) = I sin t over the sphere: 2 pi times the integral of sin^2", integral},
    Formula{"line", "", D::illuminance, "(length/2/(distance^2+length^2/4)+atan(length/2/distance)/distance)/length", "opposite its middle",
            integral},

    Formula{"mesh", "", D::luminous_flux, "pi*area*sides", flux_why, "Lagarde and de Rousiers 2014, eq 33"},
    Formula{"mesh", "", D::luminous_exitance, "pi", exitance_why, lambert},

    Formula{"distant", "", D::illuminance, "pi*sin(diameter/2)^2", "a disk of that angular diameter around the normal", lambert},
    Formula{"environment", "", D::illuminance, "pi", "a plane under an even sky", lambert},
};

std::string_view variant_of(const SpotShape&, const Conventions& c) {
  switch (c.spot_flux) {
    case FluxConvention::cone:
      return "cone";
    case FluxConvention::frostbite_pi:
      return "frostbite_pi";
    case FluxConvention::isotropic:
      return "isotropic";
    case FluxConvention::falloff:
      break;
  }
  switch (c.spot_falloff) {
    case SpotFalloff::smoothstep:
      return "falloff smoothstep";
    case SpotFalloff::hard:
      return "falloff hard";
    case SpotFalloff::squared:
      break;
  }
  return "falloff squared";
}
std::string_view variant_of(const TubeShape& tube, const Conventions&) {
  return tube.caps == Caps::round ? "round" : tube.caps == Caps::flat ? "flat" : "none";
}
template <class Other>
std::string_view variant_of(const Other&, const Conventions&) {
  return "";
}

}  // namespace

std::span<const Formula> formulas() { return all; }

const Formula* find_formula(const Shape& shape, const Conventions& conventions, Dimension quantity) {
  const std::string_view name = name_of(shape);
  const std::string_view variant = std::visit([&](const auto& s) { return variant_of(s, conventions); }, shape);
  const auto found = std::find_if(all.begin(), all.end(), [&](const Formula& f) {
    return f.shape == name && f.quantity == quantity && (f.variant.empty() || f.variant == variant);
  });
  return found == all.end() ? nullptr : &*found;
}

std::string_view own_quantity_of(std::string_view shape) {
  for (const std::string_view by_intensity : {"point", "spot", "frustum", "photometric", "line"})
    if (shape == by_intensity) return "intensity";
  return "luminance";
}

}  // namespace etendue
