// Two kinds of lines. One a shape, position of the horizon, model, roughness, kind of view and rule: "error", shape, above|across, model,
// roughness, any|grazing, rule, aggregate error in per cent, limit in per cent or -. One a shape, position of the horizon and model:
// "cost", shape, above|across, model, evaluations of the ratio rule on the mean, answers in per cent that are further off than their own
// estimate, and how many times its time the reference to 1e-3 takes. Argument: lights for each shape and side of the horizon (1000).
#include "ratio_rules.h"

#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <string>

#include "stopwatch.h"

namespace {

using namespace etendue::eval;
using namespace etendue::eval::protocol;

struct Cost {
  double answers = 0, evaluations = 0, beyond = 0;
  Stopwatch rule, reference;
};

using Errors = std::map<std::pair<bool, std::string_view>, Aggregate>;  // by grazing views, rule

void measure(const DiffuseCase& c, const Brdf& brdf, Errors& errors, Cost& cost) {
  ShadingPoint point = c.point;
  point.brdf = brdf;
  const Emitter& emitter = c.placement.emitter;
  const Estimate rule = cost.rule([&] { return *diffuse_luminance(emitter, point); });
  cost.reference([&] { return reference(emitter, point, {1e-3, 1e-7}); });
  const Estimate exact = reference(emitter, point, {1e-7, 1e-10});
  ++cost.answers;
  cost.evaluations += static_cast<double>(rule.evaluations);
  cost.beyond += std::abs(rule.value.x - exact.value.x) > rule.error.x + exact.error.x ? 1 : 0;
  errors[{c.grazing, "ratio"}].add(rule.value.x, exact.value.x);
  for (const DiffuseRule& other : diffuse_rules())
    if (const auto value = other.luminance(emitter, point)) errors[{c.grazing, other.name}].add(value->x, exact.value.x);
}

}  // namespace

int main(int argc, char** argv) {
  const int lights = argc > 1 ? std::atoi(argv[1]) : 1000;
  for (const auto& [kind, shape] :
       {std::pair{Kind::rect, "rect"}, {Kind::sphere, "sphere"}, {Kind::disk, "disk"}, {Kind::capsule, "tube"}}) {
    for (const bool above : {true, false}) {
      const char* where = above ? "above" : "across";
      const std::vector<DiffuseCase> cases = diffuse_cases(kind, above, lights, 2000);
      for (const DiffuseModel& model : diffuse_models) {
        Cost cost;
        for (const double roughness : roughnesses) {
          Errors errors;
          for (const DiffuseCase& c : cases) measure(c, model.of(roughness), errors, cost);
          for (const auto& [key, error] : errors) {
            const std::string limit = key.second == "ratio" ? fmt::format("{}", 100 * (above ? limit_above : limit_across)) : "-";
            fmt::print("error {} {} {} {} {} {} {:.4g} {}\n", shape, where, model.name, roughness, key.first ? "grazing" : "any",
                       key.second, 100 * error.share(), limit);
          }
        }
        fmt::print("cost {} {} {} {:.3g} {:.3g} {:.3g}\n", shape, where, model.name, cost.evaluations / cost.answers,
                   100 * cost.beyond / cost.answers, cost.reference.seconds() / cost.rule.seconds());
      }
    }
  }
}
