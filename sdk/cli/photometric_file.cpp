#include "photometric_file.h"

#include <fmt/format.h>

#include <cmath>

#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "importers/photometry/scene.h"

namespace etendue::cli {
namespace {

struct Zone {
  const char* name;
  double from, to;
};
constexpr Zone zones[] = {{"0-30", 0, 30}, {"0-40", 0, 40},     {"0-60", 0, 60},  {"60-90", 60, 90},
                          {"0-90", 0, 90}, {"90-180", 90, 180}, {"0-180", 0, 180}};

void put(Json& json, const char* key, const std::optional<double>& value) {
  if (value) json[key] = *value;
}

void put_spread(Json& json, const char* key, const IntensityWeb& web, double share, const auto& spread) {
  Json angles = Json::object();
  for (const auto& [name, plane] : {std::pair{"c0_180", PlanePair::c0_180}, std::pair{"c90_270", PlanePair::c90_270}}) {
    const std::optional<Spread> found = spread(web, plane, share);
    if (!found) continue;
    angles[name] = found->full_deg;
    if (found->ends_with_table) angles[std::string(name) + "_ends_with_table"] = true;
  }
  if (!angles.empty()) json[key] = angles;
}

void put_output(Json& json, const LightOutput& out) {
  put(json, "efficacy_lm_W", out.efficacy_lm_w);
  put(json, "light_output_ratio", out.lor);
  put(json, "downward_light_output_ratio", out.dlor);
  put(json, "upward_light_output_ratio", out.ulor);
  json["downward_flux_share"] = out.downward_share;
}

void put_cie_cones(Json& json, const IntensityWeb& web) {
  const std::array<double, 4> flux = cie_cone_flux_lm(web);
  Json cones = Json::object();
  for (std::size_t i = 0; i < flux.size(); ++i) cones[fmt::format("0-{:.4g}", cie_cone_deg[i])] = flux[i];
  json["cie_zonal_lm"] = cones;
}

// Of floodlights, whose webs are of type A or B: H is the plane of C90, V that of C0.
void put_nema(Json& json, const IntensityWeb& web) {
  if (web.type() == WebType::c) return;
  Json nema = Json::object();
  for (const auto& [name, plane] : {std::pair{"h", PlanePair::c90_270}, std::pair{"v", PlanePair::c0_180}}) {
    const std::optional<Spread> field = spread_about_peak(web, plane, field_share);
    const std::optional<int> type = field ? nema_type(field->full_deg) : std::nullopt;
    if (type) nema[name] = *type;
  }
  if (!nema.empty()) json["nema_type"] = nema;
}

// At the angles of glare tables.
void put_luminance(Json& json, const IntensityDistribution& d, const IntensityWeb& web) {
  Json rows = Json::array();
  for (const double gamma : {65.0, 75.0, 85.0})
    for (const double c : {0.0, 90.0, 180.0, 270.0})
      if (const std::optional<double> luminance = opening_luminance(d, web, direction_of(WebType::c, {gamma, c})))
        rows.push_back({{"c_deg", c}, {"gamma_deg", gamma}, {"luminance_cd_m2", *luminance}});
  if (!rows.empty()) json["luminance"] = rows;
}

Json angles_json(const std::vector<double>& angles) {
  Json list = Json::array();
  for (const double angle : angles) list.push_back(angle < 0 ? angle + 360 : angle);
  return list;
}

void put_grid(Json& json, const IntensityGrid& grid) {
  if (grid.type == WebType::c) {
    json["gamma_deg"] = grid.vertical_deg;
    json["c_deg"] = angles_json(grid.horizontal_deg);
  } else {
    json["v_deg"] = grid.vertical_deg;
    json["h_deg"] = grid.horizontal_deg;
  }
}

void put_tilt(Json& json, const IntensityDistribution& d) {
  if (const auto* ldt = std::get_if<EulumdatRecord>(&d.record)) {
    json["tilt_deg"] = ldt->tilt_deg;
    return;
  }
  const std::optional<LampTilt>& tilt = std::get_if<IesRecord>(&d.record)->tilt;
  json["tilt"] = !tilt ? "NONE" : tilt->file.empty() ? "INCLUDE" : tilt->file;
  if (tilt && tilt->resolved)
    json["tilt_curve"] = {{"geometry", tilt->geometry}, {"angle_deg", tilt->angles_deg}, {"factor", tilt->factors}};
}

void put_lamp_sets(Json& json, const EulumdatRecord& ldt, std::size_t chosen) {
  json["lamp_set"] = chosen + 1;
  json["lamp_sets"] = Json::array();
  for (const LampSet& set : ldt.lamp_sets)
    json["lamp_sets"].push_back({{"lamps", set.lamps},
                                 {"type", set.type},
                                 {"flux_lm", set.flux_lm},
                                 {"colour", set.colour},
                                 {"rendering", set.rendering},
                                 {"watts", set.watts}});
  json["stated"] = {{"dff_percent", ldt.dff_percent}, {"lorl_percent", ldt.lorl_percent}};
}

void put_keywords(Json& json, const IesRecord& ies) {
  json["keywords"] = Json::array();
  for (const Keyword& keyword : ies.keywords) json["keywords"].push_back({{"name", keyword.name}, {"text", keyword.text}});
}

}  // namespace

PhotometricReading read_photometric(const std::string& file, const PhotometricChoice& choice) {
  PhotometricReading reading;
  reading.file = file;
  const auto fail = [&](const Error& error) {
    reading.error = error;
    return std::move(reading);
  };
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;
  const Result<std::vector<std::byte>> bytes = read_file(file, most_bytes);
  if (!bytes) return fail(bytes.error());
  const Result<const Importer*> importer = importers().importer_for(file);
  if (!importer) return fail(importer.error());
  reading.format = (*importer)->describe().id;
  const bool ies = reading.format == "ies";
  if (!ies && reading.format != "eulumdat")
    return fail({"FORMAT_UNKNOWN",
                 fmt::format("expected a photometric file, found {}", (*importer)->describe().name),
                 {file, 0, 0, {}},
                 "known: .ies, .ldt",
                 {}});

  PhotometricOptions options = photometric::with_neighbours({}, file, most_bytes);
  options.mode = choice.strict ? PhotometricMode::strict : PhotometricMode::tolerant;
  options.lamp_set = choice.lamp_set;
  Result<PhotometricFile> read = ies ? read_ies(*bytes, file, options) : read_eulumdat(*bytes, file, options);
  if (!read) return fail(read.error());
  const Orientation own = ies ? Orientation::ies : Orientation::cie;
  const WebFrame frame{false, turn_between(own, choice.orientation.value_or(own))};
  Result<IntensityWeb> web = IntensityWeb::of(read->distribution, choice.interpolation, frame);
  const Result<IntensityWeb> zonal = IntensityWeb::of(read->distribution, Interpolation::cosine);
  if (!web || !zonal) return fail(!web ? web.error() : zonal.error());
  reading.distribution = std::move(read->distribution);
  reading.web = std::move(*web);
  reading.flux_zonal_lm = zonal->flux_lm();
  reading.diagnostics = std::move(read->diagnostics);
  const std::string name = std::filesystem::path(file).extension().string();
  if (name != (ies ? ".ies" : ".ldt") && name != (ies ? ".IES" : ".LDT") && !name.empty())
    reading.diagnostics.warning("EXTENSION_WRONG", fmt::format("the file is {}, its name ends in {}", ies ? "IES LM-63" : "EULUMDAT", name),
                                {file, 0, 0, {}});
  reading.diagnostics.append(review(reading.distribution, reading.web));
  return reading;
}

Json to_json(const PhotometricReading& r) {
  if (r.error) return {{"file", r.file}, {"error", r.error->text}, {"code", r.error->code}};
  const IntensityDistribution& d = r.distribution;
  const IntensityWeb& web = r.web;
  Json json = {{"file", r.file}, {"format", r.format}};
  const auto* ies = std::get_if<IesRecord>(&d.record);
  if (ies != nullptr) json["version"] = name_of(ies->version);
  json["photometric_type"] = name_of(d.grid.type);
  json["symmetry"] = name_of(d.grid.symmetry);
  json["absolute"] = is_absolute(d);
  put_grid(json, d.grid);
  const Peak peak = peak_of(web);
  json["max_cd"] = peak.cd;
  json["max_at_deg"] = {{"vertical", peak.angles.vertical_deg}, {"horizontal", peak.angles.horizontal_deg}};
  json["flux_lm"] = web.flux_lm();
  json["flux_zonal_lm"] = r.flux_zonal_lm;
  Json zonal = Json::object();
  for (const Zone& zone : zones) zonal[zone.name] = web.flux_between(zone.from, zone.to);
  json["zonal_lm"] = zonal;
  const std::optional<double> rated = rated_flux_lm(d);
  put(json, "rated_lm", rated);
  json["watts"] = input_watts(d);
  put_output(json, light_output(d, web));
  put_cie_cones(json, web);
  put_spread(json, "beam_deg", web, beam_share, spread_about_peak);
  put_spread(json, "field_deg", web, field_share, spread_about_peak);
  put_spread(json, "beam_cie_deg", web, beam_share, spread_about_axis);
  put_spread(json, "field_cie_deg", web, field_share, spread_about_axis);
  put_nema(json, web);
  put_tilt(json, d);
  const LuminousOpening opening = opening_of(d);
  json["opening"] = {
      {"shape", name_of(opening.shape)}, {"width_m", opening.width_m}, {"length_m", opening.length_m}, {"height_m", opening.height_m}};
  put_luminance(json, d, web);
  if (ies != nullptr) {
    put_keywords(json, *ies);
  } else {
    put_lamp_sets(json, *std::get_if<EulumdatRecord>(&d.record), d.lamp_set);
  }
  return json;
}

std::string csv_header() {
  std::string header = "file,format,version,photometric_type,symmetry,max_cd,flux_lm,flux_zonal_lm";
  for (const Zone& zone : zones) header += fmt::format(",lm_{}", zone.name);
  return header +
         ",rated_lm,watts,beam_c0_180_deg,beam_c90_270_deg,field_c0_180_deg,field_c90_270_deg,beam_cie_c0_180_deg,beam_cie_c90_270_deg,"
         "field_cie_c0_180_deg,field_cie_c90_270_deg,error";
}

std::string csv_row(const PhotometricReading& r) {
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  const auto cell = [](const std::optional<double>& x) { return x ? fmt::format(",{}", *x) : std::string(","); };
  if (r.error) return fmt::format("{}{:,>{}}{}", quoted(r.file), "", 25, quoted(r.error->text));
  const auto* ies = std::get_if<IesRecord>(&r.distribution.record);
  std::string row = fmt::format("{},{},{},{},{},{},{},{}", quoted(r.file), r.format, ies != nullptr ? name_of(ies->version) : "",
                                name_of(r.web.type()), name_of(r.web.symmetry()), r.web.max_cd(), r.web.flux_lm(), r.flux_zonal_lm);
  for (const Zone& zone : zones) row += cell(r.web.flux_between(zone.from, zone.to));
  row += cell(rated_flux_lm(r.distribution)) + cell(input_watts(r.distribution));
  for (const auto spread : {&spread_about_peak, &spread_about_axis})
    for (const double share : {beam_share, field_share})
      for (const PlanePair plane : {PlanePair::c0_180, PlanePair::c90_270}) {
        const std::optional<Spread> found = spread(r.web, plane, share);
        row += cell(found ? std::optional<double>(found->full_deg) : std::nullopt);
      }
  return row + ",";
}

// A cone from the light to a facing plane: both sides of the beam as CIE defines it, and I / d^2 at its centre.
ConeRow cone_at(const IntensityWeb& web, double distance_m) {
  ConeRow row{distance_m, 0, 0, web.at(0, 0) / (distance_m * distance_m), false};
  const auto diameter = [&](PlanePair plane) {
    const std::optional<Spread> beam = spread_about_axis(web, plane, beam_share);
    if (!beam || beam->towards_c_deg >= 90 || beam->away_deg <= -90) return 0.0;
    return distance_m * (std::tan(beam->towards_c_deg * pi / 180) - std::tan(beam->away_deg * pi / 180));
  };
  row.diameter_c0_m = diameter(PlanePair::c0_180);
  row.diameter_c90_m = diameter(PlanePair::c90_270);
  row.known = row.diameter_c0_m > 0 && row.diameter_c90_m > 0;
  return row;
}

}  // namespace etendue::cli
