// A light as another program states it.
#include <fmt/format.h>

#include "etendue/dialect.h"
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
  const Dimension d = w.quantity.dimension;
  light.emission.radiant = photometric_twin(d).has_value();
  light.emission.value = w.quantity.si;
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
      return Error{"DIMENSION_MISMATCH", fmt::format("expected a quantity of a light, found a {}", name_of(d)), {}, {}, {}};
  }
}

}  // namespace

Status state_in_dialect(Session& session, const std::string& text, const LightSetup& setup, const UnitsOptions& options, Json& results) {
  const Result<DialectInfo> dialect = dialect_named(options.dialect);
  if (!dialect) return dialect.error();
  const Result<Written> written = parse(text);
  if (!written) return written.error();
  const auto* const quantity = std::get_if<WrittenQuantity>(&*written);
  if (quantity == nullptr) return Error{"DIMENSION_MISMATCH", "--dialect states a quantity of a light", {}, "such as 1500 lm", {}};
  if (!setup.shape) return Error{"SHAPE_MISSING", "--dialect needs a --shape", {}, {}, {}};
  const Result<Light> light = light_of(*quantity, setup);
  if (!light) return light.error();
  DialectForm form;
  form.unit = options.to;
  form.efficacy_lm_W = light->emission.efficacy_lm_W;
  form.metres_per_unit = options.metres_per_unit;
  const Result<ToDialect> stated = to_dialect(dialect->dialect, *light, form);
  if (!stated) return stated.error();

  const StatedLight& s = stated->stated;
  const std::string amount = fmt::format("{} {}", s.amount, s.form.unit);
  session.print(amount);
  if (options.explain) session.print(fmt::format("  in {}: {}", dialect->program, dialect->source));
  Json json = {{"value", s.amount}, {"unit", s.form.unit}, {"text", amount}, {"dialect", dialect->name}, {"losses", Json::array()}};
  for (const Loss& loss : stated->losses.losses) {
    session.diagnostics.warning("DIALECT_LOSS", fmt::format("{}: {}", loss.what, loss.effect));
    json["losses"].push_back({{"what", loss.what}, {"effect", loss.effect}});
  }
  results.push_back(json);
  return Done{};
}

}  // namespace etendue::cli
