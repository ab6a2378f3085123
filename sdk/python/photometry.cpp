// Photometric files: read, evaluated, integrated, sampled, written.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "elementwise.h"
#include "etendue/photometric_comparison.h"
#include "etendue/photometric_quantities.h"
#include "etendue/photometric_transform.h"
#include "etendue/web_sampler.h"
#include "exporters/eulumdat/eulumdat.h"
#include "exporters/ies/ies.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "module.h"
#include "shapes.h"

namespace etendue::python {
namespace {

constexpr std::array<std::pair<std::string_view, Interpolation>, 3> interpolations{
    {{"linear", Interpolation::linear}, {"cos", Interpolation::cosine}, {"cubic", Interpolation::cubic}}};
constexpr std::array<std::pair<std::string_view, PhotometricMode>, 3> modes{
    {{"strict", PhotometricMode::strict}, {"tolerant", PhotometricMode::tolerant}, {"header_only", PhotometricMode::header_only}}};
constexpr std::array<std::pair<std::string_view, IesVersion>, 5> years{{{"1986", IesVersion::lm_63_1986},
                                                                        {"1991", IesVersion::lm_63_1991},
                                                                        {"1995", IesVersion::lm_63_1995},
                                                                        {"2002", IesVersion::lm_63_2002},
                                                                        {"2019", IesVersion::lm_63_2019}}};
constexpr std::array<std::pair<std::string_view, WebType>, 3> types{{{"C", WebType::c}, {"B", WebType::b}, {"A", WebType::a}}};

// Severity, code, text, line, column, hint.
using Message = std::tuple<std::string_view, std::string, std::string, int, int, std::string>;
std::vector<Message> messages_of(const Diagnostics& diagnostics) {
  static constexpr std::string_view names[] = {"note", "warning", "error"};
  std::vector<Message> messages;
  for (const Diagnostic& d : diagnostics.all())
    messages.emplace_back(names[static_cast<int>(d.severity)], d.code, d.text, d.where.line, d.where.column, d.hint);
  return messages;
}

// What Python holds: nothing of it changes after it was made.
struct Distribution {
  IntensityDistribution value;
  Diagnostics diagnostics;
};
struct Web {
  IntensityDistribution distribution;
  IntensityWeb value;
};

// By content where no format is named. An error begins with its place.
Distribution read(const nb::bytes& data, const std::string& file, std::string_view format, std::string_view mode, std::size_t lamp_set) {
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(data.data()), data.size());
  const int ies = format.empty() ? make_ies_importer()->sniff(bytes) : format == "ies" ? 1 : 0;
  const int eulumdat = format.empty() ? make_eulumdat_importer()->sniff(bytes) : format == "eulumdat" ? 1 : 0;
  if (ies == 0 && eulumdat == 0) raise({"FORMAT_UNKNOWN", "expected IES LM-63 or EULUMDAT, found neither", {}, {}, {}});
  PhotometricOptions options;
  options.mode = named(mode, modes);
  options.lamp_set = lamp_set;
  Result<PhotometricFile> found = ies >= eulumdat ? read_ies(bytes, file, options) : read_eulumdat(bytes, file, options);
  if (!found) {
    Error error = found.error();
    if (error.where.line > 0) error.text = to_string(error.where) + ": " + error.text;
    raise(error);
  }
  return {std::move(found->distribution), std::move(found->diagnostics)};
}

std::vector<double> vector_of(const Array<double>& values) { return {values.data(), values.data() + values.size()}; }

NewArray<double> array_of(const std::vector<double>& values, std::vector<std::size_t> extents) {
  return filled<double, 1>(std::move(extents), values.size(),
                           [&](std::size_t i) { return Result<std::array<double, 1>>(std::array{values[i]}); });
}

// The record of a grid that is no file's: candelas as they are.
Distribution of_grid(std::string_view type, const Array<double>& vertical, const Array<double>& horizontal, const Array<double>& candelas) {
  IntensityDistribution d;
  d.grid.type = named(type, types);
  d.grid.vertical_deg = vector_of(vertical);
  d.grid.horizontal_deg = vector_of(horizontal);
  d.grid.values = vector_of(candelas);
  if (d.grid.type == WebType::c && d.grid.horizontal_deg.size() == 1) d.grid.symmetry = WebSymmetry::rotational;
  if (const Status valid = check(d); !valid) raise(valid.error());
  return {std::move(d), {}};
}

Web web_of(const Distribution& d, std::string_view interpolation, bool clockwise, double turn_deg) {
  return {d.value, unwrap(IntensityWeb::of(d.value, named(interpolation, interpolations), {clockwise, turn_deg}))};
}

PlanePair plane_of(int plane) { return plane == 90 ? PlanePair::c90_270 : PlanePair::c0_180; }

using SpreadRow = std::tuple<double, double, double, bool>;
std::optional<SpreadRow> row_of(const std::optional<Spread>& s) {
  if (!s) return {};
  return SpreadRow{s->full_deg, s->towards_c_deg, s->away_deg, s->ends_with_table};
}

Array<double> checked_rows(const Array<double>& rows, std::size_t width) {
  if (rows.ndim() < 1 || rows.shape(rows.ndim() - 1) != width)
    raise({"SHAPE_MISMATCH", "expected rows of " + std::to_string(width) + " numbers", {}, {}, {}});
  return rows;
}

void bind_distribution(nb::module_& m) {
  nb::class_<Distribution>(m, "PhotometricDistribution")
      .def_static("read", &read, nb::arg("data"), nb::arg("file"), nb::arg("format"), nb::arg("mode"), nb::arg("lamp_set"))
      .def_static("of_grid", &of_grid, nb::arg("type"), nb::arg("vertical_deg"), nb::arg("horizontal_deg"), nb::arg("candelas"))
      .def("messages", [](const Distribution& d) { return messages_of(d.diagnostics); })
      .def("review", [](const Distribution& d) { return messages_of(review(d.value, unwrap(IntensityWeb::of(d.value)))); })
      .def("format", [](const Distribution& d) { return std::holds_alternative<IesRecord>(d.value.record) ? "ies" : "eulumdat"; })
      .def("version",
           [](const Distribution& d) {
             const auto* const ies = std::get_if<IesRecord>(&d.value.record);
             return ies != nullptr ? name_of(ies->version) : std::string_view();
           })
      .def("type", [](const Distribution& d) { return name_of(d.value.grid.type); })
      .def("symmetry", [](const Distribution& d) { return name_of(d.value.grid.symmetry); })
      .def("vertical_deg", [](const Distribution& d) { return array_of(d.value.grid.vertical_deg, {d.value.grid.vertical_deg.size()}); })
      .def("horizontal_deg",
           [](const Distribution& d) { return array_of(d.value.grid.horizontal_deg, {d.value.grid.horizontal_deg.size()}); })
      .def("candelas",
           [](const Distribution& d) {
             std::vector<double> cd = d.value.grid.values;
             const double factor = candelas_per_value(d.value);
             for (double& value : cd) value *= factor;
             return array_of(cd, {d.value.grid.horizontal_deg.size(), d.value.grid.vertical_deg.size()});
           })
      .def("rated_lm", [](const Distribution& d) { return rated_flux_lm(d.value); })
      .def("watts", [](const Distribution& d) { return input_watts(d.value); })
      .def("absolute", [](const Distribution& d) { return is_absolute(d.value); })
      .def(
          "keyword", [](const Distribution& d, const std::string& name) { return keyword_of(d.value, name); }, nb::arg("name"))
      .def("opening",
           [](const Distribution& d) {
             const LuminousOpening o = opening_of(d.value);
             return std::make_tuple(name_of(o.shape), o.width_m, o.length_m, o.height_m);
           })
      .def(
          "scaled",
          [](const Distribution& d, double flux_lm) {
            return Distribution{unwrap(scaled_to_flux(d.value, flux_lm)), {}};
          },
          nb::arg("flux_lm"))
      .def(
          "turned",
          [](const Distribution& d, double turn_deg) {
            return Distribution{with_grid(d.value, unwrap(turned(d.value.grid, turn_deg))), {}};
          },
          nb::arg("turn_deg"))
      .def(
          "folded",
          [](const Distribution& d, double tolerance) {
            FoldedGrid f = folded(d.value.grid, tolerance);
            const double error = f.error * candelas_per_value(d.value);
            return std::make_pair(
                Distribution{f.grid.symmetry == d.value.grid.symmetry ? d.value : with_grid(d.value, std::move(f.grid)), {}}, error);
          },
          nb::arg("tolerance"))
      .def(
          "resampled",
          [](const Distribution& d, double vertical_step_deg, double horizontal_step_deg) {
            if (!(vertical_step_deg >= 0.01 && horizontal_step_deg >= 0.01))
              raise({"WEB_INVALID", "expected steps of .01 degrees or more", {}, {}, {}});
            ResampledGrid r = unwrap(resampled(d.value.grid, vertical_steps(d.value.grid, vertical_step_deg),
                                               horizontal_steps(d.value.grid, horizontal_step_deg)));
            const double error = r.error * candelas_per_value(d.value);
            return std::make_pair(Distribution{with_grid(d.value, std::move(r.grid)), {}}, error);
          },
          nb::arg("vertical_step_deg"), nb::arg("horizontal_step_deg"))
      .def(
          "written",
          [](const Distribution& d, const std::string& format, std::string_view year, bool turn) {
            const PhotometricWriteOptions options{named(year, years), turn};
            const PhotometricText out = unwrap(format == "eulumdat" ? write_eulumdat(d.value, options) : write_ies(d.value, options));
            std::vector<std::pair<std::string, std::string>> losses;
            for (const Loss& loss : out.losses.losses) losses.emplace_back(loss.what, loss.effect);
            return std::make_pair(nb::bytes(out.text.data(), out.text.size()), losses);
          },
          nb::arg("format"), nb::arg("year"), nb::arg("turn"))
      .def("web", &web_of, nb::arg("interpolation"), nb::arg("clockwise"), nb::arg("turn_deg"));
}

void bind_web(nb::module_& m) {
  nb::class_<Web>(m, "PhotometricWeb")
      .def(
          "at",
          [](const Web& w, const Array<double>& c_gamma) {
            const Array<double> rows = checked_rows(c_gamma, 2);
            return filled<double, 1>(extents_of(rows, rows.ndim() - 1), rows.size() / 2, [&](std::size_t i) {
              return Result<std::array<double, 1>>(std::array{w.value.at(rows.data()[2 * i], rows.data()[2 * i + 1])});
            });
          },
          nb::arg("c_gamma_deg"))
      .def(
          "towards",
          [](const Web& w, const Array<double>& directions) {
            const Array<double> rows = checked_rows(directions, 3);
            return filled<double, 1>(extents_of(rows, rows.ndim() - 1), rows.size() / 3, [&](std::size_t i) {
              const double* const u = rows.data() + 3 * i;
              return Result<std::array<double, 1>>(std::array{w.value.towards({u[0], u[1], u[2]})});
            });
          },
          nb::arg("directions"))
      .def("flux_lm", [](const Web& w) { return w.value.flux_lm(); })
      .def(
          "flux_between", [](const Web& w, double from_deg, double to_deg) { return w.value.flux_between(from_deg, to_deg); },
          nb::arg("from_gamma_deg"), nb::arg("to_gamma_deg"))
      .def("peak",
           [](const Web& w) {
             const Peak peak = peak_of(w.value);
             return std::make_tuple(peak.cd, peak.angles.vertical_deg, peak.angles.horizontal_deg);
           })
      .def(
          "spread_about_peak",
          [](const Web& w, int plane, double share) { return row_of(spread_about_peak(w.value, plane_of(plane), share)); },
          nb::arg("plane"), nb::arg("share"))
      .def(
          "spread_about_axis",
          [](const Web& w, int plane, double share) { return row_of(spread_about_axis(w.value, plane_of(plane), share)); },
          nb::arg("plane"), nb::arg("share"))
      .def("output",
           [](const Web& w) {
             const LightOutput o = light_output(w.distribution, w.value);
             return std::make_tuple(o.flux_lm, o.downward_lm, o.upward_lm, o.downward_share, o.lor, o.dlor, o.ulor, o.efficacy_lm_w);
           })
      .def("cie_cone_flux_lm",
           [](const Web& w) {
             const std::array<double, 4> flux = cie_cone_flux_lm(w.value);
             return std::make_tuple(flux[0], flux[1], flux[2], flux[3]);
           })
      .def(
          "luminance",
          [](const Web& w, double c_deg, double gamma_deg) {
            return opening_luminance(w.distribution, w.value, direction_of(WebType::c, {gamma_deg, c_deg}));
          },
          nb::arg("c_deg"), nb::arg("gamma_deg"))
      .def(
          "sample",
          [](const Web& w, const Array<double>& u) {
            const Array<double> rows = checked_rows(u, 2);
            std::vector<Vec2d> points(rows.size() / 2);
            for (std::size_t i = 0; i < points.size(); ++i) points[i] = {rows.data()[2 * i], rows.data()[2 * i + 1]};
            std::vector<WebSampler::Sample> samples(points.size());
            static_cast<void>(WebSampler(w.value).sample(points, samples));
            return filled<double, 5>(extents_of(rows, rows.ndim() - 1), samples.size(), [&](std::size_t i) {
              const WebSampler::Sample& s = samples[i];
              return Result<std::array<double, 5>>(std::array{s.direction.x, s.direction.y, s.direction.z, s.pdf, s.cd});
            });
          },
          nb::arg("u"))
      .def(
          "difference",
          [](const Web& first, const Web& second) {
            const WebDifference d = difference(first.value, second.value);
            return std::make_tuple(d.largest_cd, d.c_deg, d.gamma_deg, d.exact, d.mean_cd, d.mean_abs_cd, d.rms_cd, d.flux_lm);
          },
          nb::arg("second"));
}

}  // namespace

void bind_photometry(nb::module_& m) {
  bind_distribution(m);
  bind_web(m);
  m.def("nema_type", &nema_type, nb::arg("field_deg"));
}

}  // namespace etendue::python
