// Prints one line a shape, position of the horizon, model, roughness, kind of view and rule: shape, above|across, model, roughness,
// any|grazing, rule, aggregate error in per cent, limit in per cent or -, evaluations on the mean. Argument: lights for each shape and side
// (1000).
#include "ratio_rules.h"

#include <fmt/core.h>

#include <cstdlib>
#include <map>
#include <string>

int main(int argc, char** argv) {
  using namespace etendue::eval;
  using namespace etendue::eval::protocol;
  const int lights = argc > 1 ? std::atoi(argv[1]) : 1000;
  for (const auto& [kind, shape] :
       {std::pair{Kind::rect, "rect"}, {Kind::sphere, "sphere"}, {Kind::disk, "disk"}, {Kind::capsule, "tube"}}) {
    for (const bool above : {true, false}) {
      const std::vector<DiffuseCase> cases = diffuse_cases(kind, above, lights, 2000);
      for (const DiffuseModel& model : diffuse_models) {
        for (const double roughness : roughnesses) {
          std::map<std::pair<bool, std::string_view>, Aggregate> errors;
          double evaluations = 0;
          for (const DiffuseCase& c : cases) {
            ShadingPoint point = c.point;
            point.brdf = model.of(roughness);
            const Emitter& emitter = c.placement.emitter;
            const double exact = reference(emitter, point, {1e-7, 1e-10}).value.x;
            const Estimate rule = *diffuse_luminance(emitter, point);
            evaluations += static_cast<double>(rule.evaluations);
            errors[{c.grazing, "ratio"}].add(rule.value.x, exact);
            for (const DiffuseRule& other : diffuse_rules())
              if (const auto value = other.luminance(emitter, point)) errors[{c.grazing, other.name}].add(value->x, exact);
          }
          for (const auto& [key, error] : errors) {
            const bool ours = key.second == "ratio";
            fmt::print("{} {} {} {} {} {} {:.4g} {} {:.3g}\n", shape, above ? "above" : "across", model.name, roughness,
                       key.first ? "grazing" : "any", key.second, 100 * error.share(),
                       ours ? fmt::format("{}", 100 * (above ? limit_above : limit_across)) : "-",
                       ours ? evaluations / static_cast<double>(cases.size()) : 1);
          }
        }
      }
    }
  }
}
