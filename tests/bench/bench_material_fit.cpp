// Disney parameters of two colours: ours in float and double beside CMinpack (where it is installed), a grid with golden section, and
// Khronos' closed form, over random colours. Ratios are to ours in float; the error is the excess of the rms over the global optimum's.
#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "bench.h"
#include "draws.h"
#include "etendue/material_fit_batch.h"
#include "material_fit_peers.h"

namespace etendue::bench {
namespace {

using Solver = std::function<DisneyColours(const ColourPair&)>;

constexpr std::size_t count = 512;

double rms(double residual) { return std::sqrt(residual / 6); }

class Rows {
 public:
  Rows() {
    Draws draw(1);
    for (std::size_t i = 0; i < count; ++i) {
      diffuse_.push_back(vec_cast<float>(draw.rgb(0, 1))), f0_.push_back(vec_cast<float>(draw.rgb(0, 1)));
      pairs_.push_back({vec_cast<double>(diffuse_[i]), vec_cast<double>(f0_[i])});
      least_.push_back(rms(fit_disney(pairs_[i]).residual));
    }
    base_.resize(count), metal_.resize(count), reflectance_.resize(count), answers_.resize(count);
  }

  void add(Task& task) {
    const auto in_floats = [this] { keep(fit_disney(diffuse_, f0_, {base_, metal_, reflectance_}).ok() ? base_.data() : nullptr); };
    in_floats();
    for (std::size_t i = 0; i < count; ++i) answers_[i] = {vec_cast<double>(base_[i]), metal_[i], reflectance_[i]};
    task.contender("etendue, float", Kind::ours, error(), in_floats);
    for (const int64_t target : hwy::SupportedAndGeneratedTargets())
      task.contender(fmt::format("  {}", hwy::TargetName(target)), Kind::ours, "", [in_floats, target] {
        hwy::SetSupportedTargetsForTest(target);
        in_floats();
        hwy::SetSupportedTargetsForTest(0);
      });
    const DisneyColours middle{{0.5, 0.5, 0.5}, 0.5, 0.5};
    add(task, "9-point grid and golden section, double", grid_and_golden_section);
#ifdef ETENDUE_CMINPACK
    for (const auto& [bounds, name] :
         {std::pair{Bounds::sine, "sine"}, {Bounds::clamped_inside, "clamped inside"}, {Bounds::clamped_behind, "clamped behind"}}) {
      const Bounds how = bounds;
      add(task, fmt::format("CMinpack, {}, from .5", name), [how, middle](const ColourPair& p) { return cminpack_fit(p, middle, how); });
      add(task, fmt::format("CMinpack, {}, from solveMetallic", name),
          [how](const ColourPair& p) { return cminpack_fit(p, solve_metallic(p), how); });
    }
#endif
    add(task, "solveMetallic", solve_metallic, "its f0 is .04: no optimum");
    add(task, "etendue, Levenberg-Marquardt from .5", [middle](const ColourPair& p) { return fit_disney_from(middle, p).value; });
    add(task, "etendue, double, with the interval", [](const ColourPair& p) { return fit_disney(p).value; });
  }

 private:
  void add(Task& task, std::string name, const Solver& solve, std::string note = "") {
    const auto run = [this, solve] {
      for (std::size_t i = 0; i < count; ++i) answers_[i] = solve(pairs_[i]);
      keep(answers_.data());
    };
    run();
    task.contender(std::move(name), Kind::peer, error(), run, std::move(note));
  }
  // Of the answers.
  std::string error() const {
    double worst = 0;
    std::size_t above = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double excess = rms(squared_difference(answers_[i], pairs_[i])) - least_[i];
      worst = std::max(worst, excess);
      above += excess > half_8_bit_step ? 1 : 0;
    }
    return fmt::format("worst {:.2g}, {:.2g} % above 1/510", worst, 100.0 * static_cast<double>(above) / count);
  }

  std::vector<Vec3f> diffuse_, f0_, base_;
  std::vector<float> metal_, reflectance_;
  std::vector<ColourPair> pairs_;
  std::vector<double> least_;
  std::vector<DisneyColours> answers_;
};

}  // namespace
}  // namespace etendue::bench

int main(int argc, char** argv) {
  etendue::bench::Bench bench;
  etendue::bench::Rows rows;
  rows.add(bench.task("two colours to Disney parameters", etendue::bench::count));
  return bench.run(argc, argv);
}
