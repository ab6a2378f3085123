#include "survey.h"
#include "hashing.h"

#include <algorithm>
#include <limits>

namespace etendue::rendering {
namespace {

constexpr int first_probes = 4, further_probes = 12;  // at random places, beside the corners and the centre

}  // namespace

Survey::Survey(const Stage& stage, const PinholeCamera& camera, const SurveyOptions& options)
    : stage_(stage),
      prober_(stage, camera),
      options_(options),
      keys_(std::size_t{options.width} * options.height),
      suspected_(keys_.size()),
      split_(keys_.size()),
      emitter_(keys_.size()),
      coloured_(keys_.size()),
      unevenness_(keys_.size()),
      regions_(keys_.size()),
      environment_(std::any_of(stage.lights().begin(), stage.lights().end(),
                               [](const StageLight& l) { return std::holds_alternative<eval::EnvironmentEmitter>(l.emitter.shape); })) {}

bool Survey::run(RowRunner& rows) {
  return rows.run([this](std::uint32_t row, RayCounts& counts) { look_first(row, counts); }) &&
         rows.run([this](std::uint32_t row, RayCounts& counts) { look_again(row, counts); });
}

bool Survey::is_emitter(const Probe& probe) const {
  if (probe.point) return stage_.thing(probe.point->thing).light.has_value();
  return environment_ || probe.key != nothing_key;
}

bool Survey::is_coloured(const Probe& probe) const {
  const Paint* paint = probe.point ? stage_.thing(probe.point->thing).paint : nullptr;
  return paint != nullptr && paint->coloured() && !std::holds_alternative<Lambert>(paint->material.model);
}

double Survey::uneven_between(const Probe& a, const Probe& b) const {
  if (a.key != b.key || !a.point || !b.point) return 0;
  const Paint* paint = stage_.thing(a.point->thing).paint;
  if (paint == nullptr) return 0;
  if (paint->textured() && !paint->coloured() && !std::holds_alternative<Lambert>(paint->material.model)) return infinite;
  if (a.point->flat && b.point->flat) return 0;
  return length(cross(a.point->normal, b.point->normal)) / lobe_width(paint->material.model);
}

void Survey::look_first(std::uint32_t row, RayCounts& counts) {
  const auto corners = [&](std::uint32_t y) {
    std::vector<Probe> line;
    line.reserve(options_.width + 1);
    for (std::uint32_t x = 0; x <= options_.width; ++x) line.push_back(prober_.look(x, y, counts));
    return line;
  };
  const std::vector<Probe> above = corners(row), below = corners(row + 1);
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = std::size_t{row} * options_.width + x;
    const Probe centre = prober_.look(x + 0.5, row + 0.5, counts);
    keys_[pixel] = centre.key;
    std::vector<Probe> probes{centre, above[x], above[x + 1], below[x], below[x + 1]};
    Random random(mixed(options_.seed) ^ pixel);
    for (int i = 0; i < first_probes; ++i) {
      const double u = random.next(), v = random.next();
      probes.push_back(prober_.look(x + u, row + v, counts));
    }
    double uneven = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (!same(centre, probes[i])) suspected_[pixel] = 1;
      if (is_emitter(probes[i])) emitter_[pixel] = 1;
      if (is_coloured(probes[i])) coloured_[pixel] = 1;
      for (std::size_t j = 0; j <= i; ++j) uneven = std::max(uneven, uneven_between(probes[i], probes[j]));
    }
    unevenness_[pixel] = static_cast<float>(uneven);
  }
}

bool Survey::any_around(const std::vector<std::uint8_t>& flags, std::uint32_t x, std::uint32_t y) const {
  for (std::uint32_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, options_.height - 1); ++j) {
    for (std::uint32_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, options_.width - 1); ++i) {
      if (flags[std::size_t{j} * options_.width + i] != 0) return true;
    }
  }
  return false;
}

bool Survey::touches_emitter(std::size_t pixel) const {
  return any_around(emitter_, static_cast<std::uint32_t>(pixel % options_.width), static_cast<std::uint32_t>(pixel / options_.width));
}

// Beside an edge a closer look: something narrow may have been missed between the first probes.
void Survey::look_again(std::uint32_t row, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = std::size_t{row} * options_.width + x;
    bool split = suspected_[pixel] != 0;
    if (!split && any_around(suspected_, x, row)) {
      const Probe centre = prober_.look(x + 0.5, row + 0.5, counts);
      Random random(mixed(options_.seed + 1) ^ pixel);
      for (int i = 0; i < further_probes && !split; ++i) {
        const double u = random.next(), v = random.next();
        const Probe other = prober_.look(x + u, row + v, counts);
        split = !same(centre, other);
        if (is_emitter(other)) emitter_[pixel] = 1;
      }
    }
    if (!split) continue;
    split_[pixel] = 1;
    if (coloured_[pixel] != 0) unevenness_[pixel] = std::numeric_limits<float>::infinity();
    const std::uint64_t seed = mixed(options_.seed + 2) ^ pixel;
    regions_[pixel] = std::make_unique<Regions>(regions_of(prober_, stage_, x, row, options_.area_tolerance, seed, counts));
  }
}

}  // namespace etendue::rendering
