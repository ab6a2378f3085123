// Pairs of pictures for the acceptance of the comparison.
//   comparison_pairs synthetic N          N pairs of equal expectation and noise of seven kinds, in turn
//   comparison_pairs power                pictures with one known difference each
//   comparison_pairs real K FILE...       groups of 2 K OpenEXR pictures: the first K of each against the other K
// One line a result: "KIND TAB figure". Exit status 1 only where something could not be read or compared.
#include "unit/synthetic_pictures.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace etendue;
using namespace etendue::synthetic;

std::optional<Comparison> compared(const Picture& ours, const Result<Picture>& reference, double max_difference) {
  if (!reference) {
    fmt::print(stderr, "{}\n", reference.error().text);
    return std::nullopt;
  }
  CompareOptions options;
  options.max_difference = max_difference;
  options.samples = 1024;
  const Result<Comparison> result = compare(ours, *reference, options);
  if (result) return *result;
  fmt::print(stderr, "{}\n", result.error().text);
  return std::nullopt;
}

Picture beauty_only(const Picture& picture) {
  Picture result;
  result.width = picture.width;
  result.height = picture.height;
  result.add("", 3).pixels = picture.find("")->pixels;
  return result;
}

// max_difference 0: whatever is significant differs, the setting in which most false alarms are to be expected.
int synthetic_pairs(int pairs) {
  const std::vector<std::pair<std::string, Noise>> kinds{{"Gaussian, 30 %", gaussian(.3)},
                                                         {"gamma, shape 1", gamma_noise(1)},
                                                         {"gamma, shape .3", gamma_noise(.3)},
                                                         {"gamma, shape .1", gamma_noise(.1)},
                                                         {"fireflies, 1e-3 of 50 x", fireflies(.1, 1e-3, 50)},
                                                         {"fireflies, 5e-4 of 100 x", fireflies(.05, 5e-4, 100)},
                                                         {"fireflies, 1e-2 of 20 x", fireflies(.2, 1e-2, 20)}};
  constexpr int seed_counts[] = {5, 8, 16};
  const Picture truth = beauty_only(draw(rig(), View{64, 0, 0}));
  std::map<std::string, std::pair<int, int>> alarms;
  for (int pair = 0; pair < pairs; ++pair) {
    const auto& [name, noise] = kinds[static_cast<std::size_t>(pair) % kinds.size()];
    std::mt19937_64 random(static_cast<std::uint64_t>(pair) + 1);
    const int seeds = seed_counts[static_cast<std::size_t>(pair) / kinds.size() % 3];
    // Every other pair has noise in both pictures.
    const bool both = pair / static_cast<int>(kinds.size()) % 2 == 1;
    Picture ours = truth;
    if (both) {
      Result<Picture> noisy = pool(runs_of(truth, seeds, noise, random));
      if (noisy) ours = std::move(*noisy);
    }
    const std::optional<Comparison> c = compared(ours, pool(runs_of(truth, seeds, noise, random)), 0);
    if (!c) return 1;
    auto& [count, alarm] = alarms[name];
    ++count;
    if (c->verdict == Verdict::differs || !c->findings.empty()) ++alarm;
  }
  for (const auto& [name, counts] : alarms) fmt::print("{} ({} pairs)\t{}\n", name, counts.first, counts.second);
  return 0;
}

struct Case {
  std::string name, expected, light;
  Picture ours;
};

std::vector<Case> cases(const Picture& truth, const View& view) {
  const auto changed = [&](const auto& change) {
    Picture picture = truth;
    for (Layer& layer : picture.layers) {
      for (float& value : layer.pixels) value = static_cast<float>(change(value));
    }
    return picture;
  };
  const auto with = [&](std::size_t light, const auto& change) {
    std::vector<Lamp> lamps = rig();
    change(lamps[light]);
    return draw(lamps, view);
  };
  const auto in_beauty = [&](const Picture& beauty) {
    Picture picture = truth;
    picture.find("")->pixels = beauty.find("")->pixels;
    return picture;
  };
  const Picture turned_rectangle = with(0, [](Lamp&lamp) { lamp.tilt_deg += 2; }),
                turned_spot = with(2, [](Lamp&lamp) { lamp.tilt_deg += 2; });
  const Picture without = with(5, [](Lamp& lamp) { lamp.flux = 0; });
  // A Gaussian of standard deviation .5 pixels by its first two moments on a 3 x 3 grid: a = .125.
  Picture smooth = truth;
  for (Layer& layer : smooth.layers) {
    const auto size = static_cast<std::ptrdiff_t>(view.size);
    for (const std::ptrdiff_t step : {std::ptrdiff_t{3}, 3 * size}) {
      const std::vector<float> from = layer.pixels;
      for (std::ptrdiff_t i = step; i + step < static_cast<std::ptrdiff_t>(from.size()); ++i) {
        const auto at = [&](std::ptrdiff_t k) { return from[static_cast<std::size_t>(k)]; };
        layer.pixels[static_cast<std::size_t>(i)] = .75F * at(i) + .125F * (at(i - step) + at(i + step));
      }
    }
  }
  return {{"scaled by 1.005", "GLOBAL_SCALE", "", changed([](double v) { return 1.005 * v; })},
          {"rectangle turned by 2 deg", "LIGHT_TURNED", "key", turned_rectangle},
          {"rectangle turned by 2 deg, in the sum alone", "LIGHT_TURNED", "key", in_beauty(turned_rectangle)},
          {"spot turned by 2 deg", "LIGHT_TURNED", "spot", turned_spot},
          {"spot turned by 2 deg, in the sum alone", "LIGHT_TURNED", "spot", in_beauty(turned_spot)},
          {"1 % of the flux removed", "LIGHT_MISSING", "tiny", without},
          {"1 % of the flux removed, in the sum alone", "LIGHT_MISSING", "tiny", in_beauty(without)},
          {"pixel filter", "PIXEL_FILTER", "", smooth},
          {"shifted by half a pixel", "SHIFT", "", draw(rig(), View{view.size, .5, 0})},
          {"shifted by half a pixel both ways", "SHIFT", "", draw(rig(), View{view.size, -.5, .5})},
          {"gamma 1.02", "GAMMA", "", changed([](double v) { return std::pow(v, 1.02); })},
          {"gamma 1/2.2", "GAMMA", "", changed([](double v) { return std::pow(v, 1 / 2.2); })}};
}

int power() {
  const View view{128, 0, 0};
  const Picture truth = draw(rig(), view);
  std::mt19937_64 random(1);
  // 4 % a pixel of one light at 1024 samples, as Mitsuba's.
  const Result<Picture> reference = pool(runs_of(truth, 16, gaussian(.16), random));
  for (const Case& one : cases(truth, view)) {
    const std::optional<Comparison> c = compared(one.ours, reference, .002);
    if (!c) return 1;
    const bool named = c->verdict == Verdict::differs && !c->findings.empty() && c->findings[0].code == one.expected &&
                       (one.light.empty() || c->findings[0].text.find("'" + one.light + "'") != std::string::npos);
    fmt::print("{}\t{}\t{}\n", one.name, named ? "named" : "not named", findings_text(*c));
  }
  return 0;
}

int real_pairs(int seeds, const std::vector<std::string>& files) {
  const std::size_t group = 2 * static_cast<std::size_t>(seeds);
  for (std::size_t first = 0; first + group <= files.size(); first += group) {
    std::vector<Picture> runs;
    for (std::size_t i = first; i < first + group; ++i) {
      Result<Picture> picture = read_exr(files[i]);
      if (!picture) {
        fmt::print(stderr, "{}\n", picture.error().text);
        return 1;
      }
      runs.push_back(std::move(*picture));
    }
    const auto middle = runs.begin() + seeds;
    const Result<Picture> ours = pool({runs.begin(), middle});
    if (!ours) return 1;
    const std::optional<Comparison> c = compared(*ours, pool({middle, runs.end()}), 0);
    if (!c) return 1;
    const bool alarm = c->verdict == Verdict::differs || !c->findings.empty();
    fmt::print("{}\t{}\tchi2 {:.3f}\n", files[first], alarm ? "alarm" : "quiet", c->chi2_per_pixel);
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  if (words.size() == 2 && words[0] == "synthetic") return synthetic_pairs(std::atoi(words[1].c_str()));
  if (words.size() == 1 && words[0] == "power") return power();
  if (words.size() > 2 && words[0] == "real") return real_pairs(std::atoi(words[1].c_str()), {words.begin() + 2, words.end()});
  return 2;
}
