#include "etendue/colour.h"
#include "etendue/temperature.h"

#include "elementwise.h"
#include "module.h"

namespace etendue::python {

void bind_colour(nb::module_& m) {
  def_elementwise<1>(m, "planckian", planckian, "kelvin");
  def_elementwise<1>(m, "daylight", daylight, "kelvin");
  def_elementwise<1>(m, "daylight_or_planckian", daylight_or_planckian, "kelvin");
  def_elementwise<2>(
      m, "to_chromaticity",
      [](double kelvin, double duv) {
        return to_chromaticity(ColourTemperature{kelvin, duv});
      },
      "kelvin", "duv");
  def_elementwise<1>(m, "clamped_temperature", clamped_temperature, "kelvin");
  def_elementwise<1>(m, "mired_of", mired_of, "kelvin");
  def_elementwise<2>(m, "shifted_by_mired", shifted_by_mired, "kelvin", "shift_mired");

  const auto xy = [](const double* p) { return Chromaticity{p[0], p[1]}; };
  const auto rgb = [](const double* p) { return Rgb{p[0], p[1], p[2]}; };
  def_rowwise<2>(
      m, "to_colour_temperature", [xy](const double* p) { return to_colour_temperature(xy(p)); }, "xy");
  def_rowwise<2>(
      m, "to_uv1960", [xy](const double* p) { return to_uv1960(xy(p)); }, "xy");
  def_rowwise<2>(
      m, "from_uv1960",
      [](const double* p) {
        return from_uv1960({p[0], p[1]});
      },
      "uv");
  def_rowwise<2>(
      m, "to_rgb", [xy](const double* p) { return to_rgb(xy(p)); }, "xy");
  def_rowwise<3>(
      m, "chromaticity_of_rgb", [rgb](const double* p) { return to_chromaticity(rgb(p)); }, "rgb");
  def_rowwise<3>(
      m, "luminance_of", [rgb](const double* p) { return luminance_of(rgb(p)); }, "rgb");
  def_rowwise<3>(
      m, "clipped_keeping_luminance", [rgb](const double* p) { return clipped_keeping_luminance(rgb(p)); }, "rgb");
}

}  // namespace etendue::python
