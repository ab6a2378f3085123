#include "errors.h"

#include <nanobind/stl/string.h>

namespace etendue::python {

namespace nb = nanobind;

void raise(const Error& error, std::span<const std::size_t> index) {
  nb::list indices;
  for (const std::size_t i : index) indices.append(i);
  const nb::object type = nb::module_::import_("etendue.errors").attr("Error");
  const nb::object exception = type(error.code, error.text, nb::arg("hint") = error.hint, nb::arg("field") = error.where.pointer,
                                    nb::arg("index") = nb::tuple(indices));
  PyErr_SetObject(type.ptr(), exception.ptr());
  throw nb::python_error();
}

}  // namespace etendue::python
