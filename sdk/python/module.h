// One function for each C++ header that Python sees.
#pragma once

#include <nanobind/nanobind.h>

namespace etendue::python {

void bind_quantities(nanobind::module_& m);
void bind_conversion(nanobind::module_& m);
void bind_colour(nanobind::module_& m);
void bind_camera(nanobind::module_& m);
void bind_batch(nanobind::module_& m);
void bind_spectrum(nanobind::module_& m);
void bind_colour_space(nanobind::module_& m);
void bind_metering(nanobind::module_& m);
void bind_dialect(nanobind::module_& m);
void bind_pixel(nanobind::module_& m);
void bind_photometry(nanobind::module_& m);
void bind_hdri(nanobind::module_& m);
void bind_false_colour(nanobind::module_& m);
void bind_material_fit(nanobind::module_& m);
void bind_plausibility(nanobind::module_& m);
void bind_normal_filter(nanobind::module_& m);

}  // namespace etendue::python
