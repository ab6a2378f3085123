#include "etendue/metering.h"

#include "elementwise.h"
#include "module.h"

#include <cstdint>
#include <span>
#include <tuple>

namespace etendue::python {
namespace {

using Counts = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;
Counts numbers_of(const MeterCounts& c) { return {c.averaged, c.nan, c.infinite, c.negative}; }
std::span<const float> span_of(const Array<float>& values) { return {values.data(), values.size()}; }

}  // namespace

void bind_metering(nb::module_& m) {
  m.def(
      "log_average",
      [](const Array<float>& values, double least, double greatest) {
        const LogAverage found = unwrap(log_average(span_of(values), {least, greatest}));
        return std::make_tuple(found.mean, numbers_of(found.counts));
      },
      nb::arg("values").noconvert(), nb::arg("least"), nb::arg("greatest"));
  nb::class_<MeterHistogram>(m, "MeterHistogram", "Counts of values in bins of 1/128 of an octave.")
      .def(nb::init<>())
      .def(
          "add", [](MeterHistogram& h, const Array<float>& values) { h.add(span_of(values)); }, nb::arg("values").noconvert())
      .def(
          "add_rgb",
          [](MeterHistogram& h, const Array<float>& rgb) { h.add(std::span(reinterpret_cast<const Vec3f*>(rgb.data()), rgb.size() / 3)); },
          nb::arg("rgb").noconvert())
      .def(
          "mean",
          [](const MeterHistogram& h, double low, double high, double least, double greatest) {
            return unwrap(h.mean({low, high}, {least, greatest}));
          },
          nb::arg("low"), nb::arg("high"), nb::arg("least"), nb::arg("greatest"))
      .def(
          "percentile",
          [](const MeterHistogram& h, double share, double least, double greatest) {
            return unwrap(h.percentile(share, {least, greatest}));
          },
          nb::arg("share"), nb::arg("least"), nb::arg("greatest"))
      .def("counts", [](const MeterHistogram& h) { return numbers_of(h.counts()); });
  m.def(
      "adapted_ev100",
      [](double ev100, double target, double elapsed_s, double brighter_s, double darker_s) {
        return unwrap(adapted_ev100(ev100, target, elapsed_s, {brighter_s, darker_s}));
      },
      nb::arg("ev100"), nb::arg("target_ev100"), nb::arg("elapsed_s"), nb::arg("brighter_s"), nb::arg("darker_s"));
}

}  // namespace etendue::python
