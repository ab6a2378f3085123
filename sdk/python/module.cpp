// etendue._core: plain functions of numbers and arrays. Names, docstrings, text and broadcasting are the Python half's.
#include "module.h"

NB_MODULE(_core, m) {
  using namespace etendue::python;
  m.doc() =
      "The compiled half of etendue: functions of numbers in SI units and of contiguous arrays of them. Use the package's own functions.";
  bind_quantities(m);
  bind_conversion(m);
  bind_colour(m);
  bind_camera(m);
  bind_pixel(m);
  bind_metering(m);
  bind_colour_space(m);
  bind_spectrum(m);
  bind_batch(m);
  bind_dialect(m);
  bind_photometry(m);
  bind_hdri(m);
  bind_false_colour(m);
  bind_material_fit(m);
  bind_plausibility(m);
  bind_normal_filter(m);
}
