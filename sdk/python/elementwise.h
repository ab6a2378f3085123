// Functions of numbers as Python has them: of numbers, and of contiguous arrays of double or float, element by element, without a copy of
// what comes in. Floats are computed in double and rounded once.
#pragma once

#include "errors.h"
#include "etendue/camera.h"
#include "etendue/colour.h"
#include "etendue/temperature.h"
#include "etendue/vec.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue::python {

namespace nb = nanobind;

template <class T>
using Array = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;
template <class T>
using NewArray = nb::ndarray<nb::numpy, T, nb::c_contig>;

// What a function returns, as numbers in a row.
inline std::array<double, 1> row_of(double x) { return {x}; }
inline std::array<double, 2> row_of(const Chromaticity& xy) { return {xy.x, xy.y}; }
inline std::array<double, 2> row_of(const ColourTemperature& t) { return {t.kelvin, t.duv}; }
inline std::array<double, 2> row_of(const ClampedTemperature& t) { return {t.kelvin, t.clamped ? 1.0 : 0.0}; }
inline std::array<double, 2> row_of(const Uv& uv) { return {uv.u, uv.v}; }
inline std::array<double, 2> row_of(const SensorExposure& e) { return {e.illuminance_lx, e.exposure_lx_s}; }
inline std::array<double, 3> row_of(const Rgb& rgb) { return {rgb.x, rgb.y, rgb.z}; }

template <class T>
Result<T> as_result(T value) {
  return value;
}
template <class T>
Result<T> as_result(Result<T> result) {
  return result;
}

inline double as_python(const std::array<double, 1>& row) { return row[0]; }
template <std::size_t N>
requires(N > 1) auto as_python(const std::array<double, N>& row) {
  return std::apply([](auto... x) { return std::make_tuple(x...); }, row);
}

using Extents = std::vector<std::size_t>;
template <class Any>
Extents extents_of(const Any& array, std::size_t dimensions) {
  Extents extents;
  for (std::size_t i = 0; i < dimensions; ++i) extents.push_back(array.shape(i));
  return extents;
}
inline Extents unravelled(std::size_t flat, const Extents& extents) {
  Extents index(extents.size());
  for (std::size_t i = extents.size(); i-- > 0; flat /= extents[i]) index[i] = flat % extents[i];
  return index;
}

// Rows of N numbers for `count` elements, in an array that Python owns: extents and, where N > 1, a last one of N.
template <class T, std::size_t N, class RowOfElement>
NewArray<T> filled(Extents extents, std::size_t count, const RowOfElement& row_of_element) {
  auto* values = new T[count * N + 1];  // one more: never empty
  nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  std::optional<Error> error;
  std::size_t i = 0;
  {
    const nb::gil_scoped_release others_may_run;
    for (; i < count; ++i) {
      const auto row = row_of_element(i);
      if (!row) {
        error = row.error();
        break;
      }
      for (std::size_t k = 0; k < N; ++k) values[i * N + k] = static_cast<T>((*row)[k]);
    }
  }
  if (error) raise(*error, unravelled(i, extents));
  if (N > 1) extents.push_back(N);
  return NewArray<T>(values, extents.size(), extents.data(), owner);
}

template <std::size_t>
using Double = double;
template <class T, std::size_t>
using ArrayAgain = Array<T>;

template <class... Extra, class F, std::size_t... I, std::size_t... J>
void def_elementwise(nb::module_& m, const char* name, F f, const std::array<const char*, sizeof...(I) + sizeof...(J)>& names,
                     std::index_sequence<I...>, std::index_sequence<J...>) {
  using Row = decltype(row_of(*as_result(f(Double<I>{}..., std::declval<const Extra&>()...))));
  const auto row = [f](Double<I>... x, const Extra&... extra) -> Result<Row> {
    const auto result = as_result(f(x..., extra...));
    if (!result) return result.error();
    return row_of(*result);
  };
  m.def(
      name, [row](Double<I>... x, const Extra&... extra) { return as_python(unwrap(row(x..., extra...))); }, nb::arg(names[I])...,
      nb::arg(names[sizeof...(I) + J])...);
  const auto def_arrays = [&]<class T>(T) {
    m.def(
        name,
        [row](const ArrayAgain<T, I>&... x, const Extra&... extra) {
          const auto& first = std::get<0>(std::tie(x...));
          return filled<T, std::tuple_size_v<Row>>(extents_of(first, first.ndim()), first.size(),
                                                   [&](std::size_t i) { return row(static_cast<double>(x.data()[i])..., extra...); });
        },
        nb::arg(names[I]).noconvert()..., nb::arg(names[sizeof...(I) + J])...);
  };
  def_arrays(double{});
  def_arrays(float{});
}
// f(double..., extra...) -> a number, a pair, a triple, or a Result of one: N numbers, or N arrays of the same extents, then what is the
// same for all elements.
template <std::size_t N, class... Extra, class F, class... Names>
void def_elementwise(nb::module_& m, const char* name, F f, Names... names) {
  static_assert(sizeof...(Names) == N + sizeof...(Extra), "a name for each argument");
  def_elementwise<Extra...>(m, name, f, std::array<const char*, sizeof...(Names)>{names...}, std::make_index_sequence<N>{},
                            std::make_index_sequence<sizeof...(Extra)>{});
}

// The same for a function of N numbers that lie beside each other in the last extent of one array: f(const double*).
template <std::size_t N, class F>
void def_rowwise(nb::module_& m, const char* name, F f, const char* argument) {
  using Row = decltype(row_of(*as_result(f(static_cast<const double*>(nullptr)))));
  const auto def_array = [&]<class T>(T) {
    m.def(
        name,
        [f](const Array<T>& rows) {
          const std::size_t count = rows.size() / N;
          return filled<T, std::tuple_size_v<Row>>(extents_of(rows, rows.ndim() - 1), count, [&](std::size_t i) -> Result<Row> {
            std::array<double, N> x;
            for (std::size_t k = 0; k < N; ++k) x[k] = static_cast<double>(rows.data()[i * N + k]);
            const auto result = as_result(f(x.data()));
            if (!result) return result.error();
            return row_of(*result);
          });
        },
        nb::arg(argument).noconvert());
  };
  def_array(double{});
  def_array(float{});
}

}  // namespace etendue::python
