// Writes a report of closed-form pictures: report_page same|differs FILE.html
#include "etendue/report.h"
#include "unit/synthetic_pictures.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

namespace {

using namespace etendue;

// Luminances of an interior: some tens of cd/m2.
void brighten(Picture& picture) {
  for (Layer& layer : picture.layers) {
    for (float& value : layer.pixels) value *= 1.5F;
  }
}

int write_page(const std::string& kind, const std::filesystem::path& file) {
  using namespace synthetic;
  const View view{256, 0, 0};
  Picture truth = draw(rig(), view);
  brighten(truth);
  std::vector<Lamp> lamps = rig();
  if (kind == "differs") lamps[2].tilt_deg += 2;
  Picture ours = draw(lamps, view);
  brighten(ours);
  std::mt19937_64 random(1);
  Result<Picture> reference = pool(runs_of(truth, 16, gaussian(.16), random));
  if (!reference) return 1;

  CompareOptions options;
  options.max_difference = .01;
  options.samples = 1024;
  Report report;
  report.title = "studio.rig.json";
  const Result<Comparison> comparison = compare(ours, *reference, options);
  if (!comparison) return 1;
  report.comparison = *comparison;
  for (const Lamp& lamp : lamps) {
    const Result<Comparison> light = compare(ours, *reference, options, {}, lamp.name);
    if (!light) return 1;
    report.lights.push_back(
        {lamp.name, fmt::format("{} at {:.2f} m, {:.0f} lm", lamp.cone_deg > 0 ? "spot" : "rectangle", lamp.height, 300 * lamp.flux),
         *light});
  }
  report.losses = {{"light 'fill': range 8 m", "Mitsuba has no range window: brighter beyond 4 m, by up to 6 % in this picture"}};
  report.authored = ours;
  for (float& value : report.authored->find("")->pixels) value = value > 0 ? 9 * std::pow(value / 9, 1.15F) : 0;
  report.diagnostics.warning("NODE_UNUSED", "node 'Camera.001' is not part of the scene", {"studio.gltf", 12, 5, "/nodes/4"});
  report.facts = {{"Mitsuba", "3.9.1, llvm_ad_rgb"},
                  {"Samples a pixel", "1024 = 16 \u00d7 64"},
                  {"Size", "256 \u00d7 256"},
                  {"Our picture", "0.8 s"},
                  {"Mitsuba\u2019s", "11 s"}};
  const std::string html = to_html(report, ours, *reference);
  return write_file(file, std::as_bytes(std::span(html))) ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  return write_page(arguments[1], arguments[2]);
}
