// A light as another program states it.
#include <fmt/format.h>

#include "article.h"
#include "etendue/dialect.h"
#include "number_text.h"
#include "units.h"

namespace etendue::cli {
namespace {

using Given = Emission::Given;

// The light that was described: white, of the quantity and the shape.
Result<Light> light_of(const WrittenQuantity& w, const LightSetup& setup) {
  Light light;
  light.name = "given";
  light.shape = *setup.shape;
  light.two_sided = setup.conventions.two_sided;
  light.flux_convention = setup.conventions.spot_flux;
  const Dimension d = w.unit.dimension;
  light.emission.radiant = photometric_twin(d).has_value();
  light.emission.value = w.quantity().si;
  light.emission.efficacy_lm_W = w.efficacy_lm_W ? w.efficacy_lm_W : setup.efficacy_lm_W;
  light.emission.distance_m = w.distance_m ? w.distance_m : setup.given_distance_m;
  switch (photometric_twin(d).value_or(d)) {
    case Dimension::luminous_flux:
      light.emission.given = Given::flux;
      return light;
    case Dimension::luminous_intensity:
      light.emission.given = Given::intensity;
      return light;
    case Dimension::luminance:
      light.emission.given = Given::luminance;
      return light;
    case Dimension::illuminance:
      light.emission.given = Given::illuminance;
      return light;
    case Dimension::exposure_value:
      light.emission.given = Given::ev;
      return light;
    default:
      return Error{"DIMENSION_MISMATCH", fmt::format("expected a quantity of a light, found {}", with_article(name_of(d))), {}, {}, {}};
  }
}

DialectForm form_of(const UnitsOptions& options, std::string unit, std::optional<double> efficacy_lm_W) {
  DialectForm form;
  form.unit = std::move(unit);
  form.exposure_stop = options.exposure_stop;
  form.normalize = options.normalize;
  form.reflector = options.reflector;
  form.metres_per_unit = options.metres_per_unit;
  form.efficacy_lm_W = efficacy_lm_W;
  return form;
}

// "100 W", "8 unitless": a number in one of the program's units, which need not be one of ours.
Result<FromDialect> read_in_dialect(const std::string& text, const LightSetup& setup, const UnitsOptions& options) {
  const Result<DialectInfo> dialect = dialect_named(options.from);
  if (!dialect) return dialect.error();
  std::string_view rest = trimmed(text);
  double amount = 0;
  if (const char* const why = take_number(rest, amount))
    return Error{"NUMBER_INVALID", fmt::format("expected a number such as 1000 lm, found \"{}\": {}", text, why), {}, {}, {}};
  const std::string unit(trimmed(rest));
  if (unit.empty())
    return Error{"UNIT_MISSING",
                 fmt::format("expected a unit behind the number, found \"{}\"", text),
                 {},
                 fmt::format("{} has {}", dialect->program, fmt::join(units_of(dialect->dialect, *setup.shape), ", ")),
                 {}};
  StatedLight stated{*setup.shape, amount, form_of(options, unit, setup.efficacy_lm_W)};
  stated.two_sided = setup.conventions.two_sided;
  return from_dialect(dialect->dialect, stated);
}

Result<Light> read_light(const std::string& text, const LightSetup& setup) {
  const Result<Written> written = parse(text);
  if (!written) return written.error();
  const auto* const quantity = std::get_if<WrittenQuantity>(&*written);
  if (quantity == nullptr) return Error{"DIMENSION_MISMATCH", "--dialect states a quantity of a light", {}, "such as 1500 lm", {}};
  return light_of(*quantity, setup);
}

void tell(Session& session, const LossReport& losses, Json& json) {
  for (const Loss& loss : losses.losses) {
    session.diagnostics.warning("DIALECT_LOSS", fmt::format("{}: {}", loss.what, loss.effect));
    json.push_back({{"what", loss.what}, {"effect", loss.effect}});
  }
}

// What a light sends out, by the quantity that it emits by.
Result<WrittenQuantity> emitted_by(const Light& light, const LightSetup& setup) {
  const Result<Resolved> resolved = resolve(light, setup.mesh_area_m2.value_or(0));
  if (!resolved) return resolved.error();
  // Y of a white is the white itself, to the last bit.
  const Rgb& rgb = resolved->rgb;
  const double y = rgb.x == rgb.y && rgb.y == rgb.z ? rgb.y : luminance_of(rgb);
  switch (resolved->kind) {
    case Resolved::Kind::luminance:
      return WrittenQuantity{y, {Dimension::luminance}};
    case Resolved::Kind::illuminance:
      return WrittenQuantity{y, {Dimension::illuminance}};
    default:
      return WrittenQuantity{y, {Dimension::luminous_intensity}};
  }
}

}  // namespace

Status state_in_dialect(Session& session, const std::string& text, const std::optional<Target>& target, const LightSetup& setup,
                        const UnitsOptions& options, Json& results) {
  if (!setup.shape)
    return Error{"SHAPE_MISSING", fmt::format("--{} needs a --shape", options.from.empty() ? "dialect" : "from"), {}, {}, {}};
  Json losses = Json::array();
  Light light;
  if (options.from.empty()) {
    const Result<Light> ours = read_light(text, setup);
    if (!ours) return ours.error();
    light = *ours;
  } else {
    const Result<FromDialect> read = read_in_dialect(text, setup, options);
    if (!read) return read.error();
    light = read->light;
    light.name = "given";
    tell(session, read->losses, losses);
  }
  if (options.dialect.empty()) {
    const Result<WrittenQuantity> emitted = emitted_by(light, setup);
    if (!emitted) return emitted.error();
    LightSetup ours = setup;
    ours.shape = light.shape;
    ours.conventions.two_sided = light.two_sided;
    if (const Status said = say(session, text, *emitted, target, ours, options, results); !said) return said.error();
    results.back()["losses"] = losses;
    return Done{};
  }

  const Result<DialectInfo> dialect = dialect_named(options.dialect);
  if (!dialect) return dialect.error();
  const std::optional<double> efficacy = light.emission.efficacy_lm_W ? light.emission.efficacy_lm_W : setup.efficacy_lm_W;
  const Result<ToDialect> stated = to_dialect(dialect->dialect, light, form_of(options, options.to, efficacy));
  if (!stated) return stated.error();
  const StatedLight& s = stated->stated;
  const std::string amount = fmt::format("{} {}", s.amount, s.form.unit);
  session.print(amount);
  if (options.explain) session.print(fmt::format("  in {}: {}", dialect->program, dialect->source));
  tell(session, stated->losses, losses);
  results.push_back({{"value", s.amount}, {"unit", s.form.unit}, {"text", amount}, {"dialect", dialect->name}, {"losses", losses}});
  return Done{};
}

}  // namespace etendue::cli
