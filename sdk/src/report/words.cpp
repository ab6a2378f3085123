#include "words.h"

#include "markup.h"

#include <fmt/core.h>

#include <cmath>

namespace etendue::report_detail {
namespace {

std::string on_average(const Comparison& c) {
  const std::string size = percent(std::abs(c.mean_rel));
  if (size[0] == '0' && size.size() < 6) return "On average the two pictures are equally bright.";
  return fmt::format("On average our picture is {} {} than Mitsuba\u2019s.", size, c.mean_rel < 0 ? "darker" : "brighter");
}

std::string about_noise(const Comparison& c) {
  std::string text = fmt::format("Single pixels differ by {} (rms); Mitsuba\u2019s noise alone would make that {}", percent(c.rms_rel),
                                 percent(c.noise_rms_rel));
  return text + (c.pixel_excess_z > c.threshold_z ? ", so there is more than noise." : ", so what you see in single pixels is noise.");
}

std::string thousands(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t i = digits.size(); i > 3;) digits.insert(i -= 3, "\u202f");
  return digits;
}

}  // namespace

Words in_words(const Comparison& c) {
  Words words;
  const std::string asked = percent(c.max_difference);
  switch (c.verdict) {
    case Verdict::same:
      words.headline = fmt::format("Our light and Mitsuba\u2019s agree within {}.", asked);
      break;
    case Verdict::differs:
      words.headline = fmt::format("Our light and Mitsuba\u2019s differ by more than {}.", asked);
      break;
    case Verdict::undecided:
      words.headline = fmt::format("Mitsuba\u2019s picture is too noisy to say whether the two agree within {}.", asked);
      break;
  }
  words.lines.push_back(on_average(c) + " " + about_noise(c));
  if (c.verdict == Verdict::undecided && c.samples_needed) {
    words.lines.push_back(fmt::format("About {} samples a pixel would tell.", thousands(*c.samples_needed)));
  }
  if (c.verdict == Verdict::same && !c.findings.empty()) {
    words.lines.push_back("A difference smaller than that is nevertheless real, not noise; it is named below.");
  }
  return words;
}

}  // namespace etendue::report_detail
