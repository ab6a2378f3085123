// Prints one line a method, shape and position of the horizon: name, shape, above|across, mean relative, mean absolute, 99th percentile of
// the relative, largest absolute error, and the same four as others measured them (- where they did not).
#include "published_figures.h"

#include <fmt/core.h>

int main() {
  using namespace etendue::eval;
  using namespace etendue::eval::protocol;
  for (const auto& [kind, shape] :
       {std::pair{Kind::rect, "rect"}, {Kind::sphere, "sphere"}, {Kind::disk, "disk"}, {Kind::capsule, "tube"}}) {
    for (const DiffuseMethod& method : diffuse_methods()) {
      const Placement& first = samples(kind, true)[0].placement;
      if (!method.illuminance(first.emitter, first.position, first.normal)) continue;
      for (const bool above : {true, false}) {
        const Errors e = errors_of(method, kind, above);
        const auto row = std::find_if(figures().begin(), figures().end(),
                                      [&, k = kind](const Row& r) { return r.name == method.name && r.kind == k && r.above == above; });
        const bool known = row != figures().end();
        fmt::print("{} {} {} {:.4g} {:.4g} {:.4g} {:.4g} {} {} {} {}\n", method.name, shape, above ? "above" : "across",
                   Errors::mean(e.relative).value, Errors::mean(e.absolute).value, e.p99(), e.absolute.back(),
                   known ? row->relative.text : "-", known ? row->absolute.text : "-", known ? row->p99.text : "-",
                   known ? row->highest.text : "-");
      }
    }
  }
}
