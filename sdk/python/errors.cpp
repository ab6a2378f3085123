#include "errors.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>

#include <string_view>

namespace etendue::python {

namespace nb = nanobind;

void raise(const Error& error, std::span<const std::size_t> index) {
  nb::list indices;
  for (const std::size_t i : index) indices.append(i);
  // "/radius": a parameter's name behind a slash.
  std::string_view field = error.where.pointer;
  if (field.starts_with('/')) field.remove_prefix(1);
  const nb::object type = nb::module_::import_("etendue.errors").attr("Error");
  const nb::object exception =
      type(error.code, error.text, nb::arg("hint") = error.hint, nb::arg("field") = field, nb::arg("index") = nb::tuple(indices));
  PyErr_SetObject(type.ptr(), exception.ptr());
  throw nb::python_error();
}

}  // namespace etendue::python
