#include "etendue/batch.h"

#include "elementwise.h"
#include "module.h"

#include <limits>
#include <span>

namespace etendue::python {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

template <class To, class T>
std::span<const To> span_of(const Array<T>& array) {
  return {reinterpret_cast<const To*>(array.data()), array.size() * sizeof(T) / sizeof(To)};
}

// batch(elements, results) -> Status or how many had none: of an array whose last extent holds one element of From, one of To.
template <class From, class To, class T, class... Extra, class Batch>
void def_batch(nb::module_& m, const char* name, Batch batch, const char* argument, [[maybe_unused]] const char* extra_name = "") {
  m.def(
      name,
      [batch](const Array<T>& from, const Extra&... extra) {
        constexpr std::size_t number = sizeof(T), in = sizeof(From) / number, out = sizeof(To) / number;
        const std::span<const From> elements = span_of<From>(from);
        auto* values = new T[elements.size() * out + 1];
        nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); });
        const auto outcome = [&] {
          const nb::gil_scoped_release others_may_run;
          return batch(elements, std::span(reinterpret_cast<To*>(values), elements.size()), extra...);
        }();
        Extents extents = extents_of(from, from.ndim() - (in > 1 ? 1 : 0));
        if (out > 1) extents.push_back(out);
        NewArray<T> results(values, extents.size(), extents.data(), owner);
        if constexpr (std::is_same_v<decltype(outcome), const Status>) {
          unwrap(outcome);
          return results;
        } else {
          return std::make_tuple(results, unwrap(outcome));
        }
      },
      nb::arg(argument).noconvert(), ((void)sizeof(Extra), nb::arg(extra_name))...);
}

}  // namespace

void bind_batch(nb::module_& m) {
  // K alone: of a calibration these look at nothing else.
  const auto with_k = [](double k) {
    Calibration c;
    c.meter_k = k;
    return c;
  };
  def_batch<float, float, float, double>(
      m, "batch_scaled", [](auto in, auto out, double factor) { return scaled(in, factor, out); }, "values", "factor");
  def_batch<float, float, float, double>(
      m, "batch_luminance_of_ev100", [with_k](auto in, auto out, double k) { return luminance_of_ev100(in, with_k(k), out, none); },
      "ev100", "meter_k");
  def_batch<float, float, float, double>(
      m, "batch_ev100_of_luminance", [with_k](auto in, auto out, double k) { return ev100_of_luminance(in, with_k(k), out, none); },
      "luminance_cd_m2", "meter_k");
  def_batch<float, Vec2f, float>(
      m, "batch_planckian",
      [](auto in, auto out) {
        return planckian(in, out, {none, none});
      },
      "kelvin");
  def_batch<float, Vec3f, float>(
      m, "batch_planckian_rgb",
      [](auto in, auto out) {
        return planckian_rgb(in, out, {none, none, none});
      },
      "kelvin");
  def_batch<Chromaticity, ColourTemperature, double>(
      m, "batch_to_colour_temperature",
      [](auto in, auto out) {
        return to_colour_temperature(in, out, {none, none});
      },
      "xy");
  def_batch<Vec2f, float, float>(
      m, "batch_fit_colour_temperature", [](auto in, auto out) { return fit_colour_temperature(in, out, none); }, "xy");
  def_batch<float, float, float>(
      m, "batch_srgb_to_linear", [](auto in, auto out) { return srgb_to_linear(in, out); }, "encoded");
  def_batch<float, float, float>(
      m, "batch_linear_to_srgb", [](auto in, auto out) { return linear_to_srgb(in, out); }, "linear");
}

}  // namespace etendue::python
