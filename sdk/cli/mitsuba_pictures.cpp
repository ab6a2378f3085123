#include "mitsuba_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "process.h"

namespace etendue::cli {
namespace {

namespace fs = std::filesystem;

MitsubaJob job_for(const LightFile& light, const Split& split) {
  return {light.scene, light.light, split.samples_per_seed, split.seeds, 0};
}

void add_into(Layer& sum, const Layer& part) {
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
}

}  // namespace

Split split_samples(std::uint32_t total, std::uint32_t seeds, std::size_t lights) {
  const std::uint32_t per_light = std::max<std::uint32_t>(5, total / static_cast<std::uint32_t>(std::max<std::size_t>(1, lights)));
  const std::uint32_t runs = std::clamp<std::uint32_t>(per_light / 4, 5, std::max<std::uint32_t>(5, seeds));
  return {std::max<std::uint32_t>(1, (per_light + runs / 2) / runs), runs};
}

Result<Picture> mitsuba_picture(const Mitsuba& mitsuba, const PictureRequest& request, Progress* progress) {
  std::vector<MitsubaJob> jobs;
  for (const LightFile& light : request.lights) jobs.push_back(job_for(light, request.split));
  Result<std::vector<Picture>> pictures = run_mitsuba(mitsuba, jobs, request.cache, progress);
  if (!pictures) return pictures.error();

  Picture sum;
  sum.width = request.width;
  sum.height = request.height;
  sum.numbers["etendue:seeds"] = request.split.seeds;
  sum.numbers["etendue:samples"] = static_cast<double>(request.split.per_light()) * static_cast<double>(jobs.size());
  sum.texts["etendue:renderer"] = fmt::format("Mitsuba {} ({})", mitsuba.version, mitsuba.variant);
  sum.add("", 3);
  sum.add("variance", 3);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::string name = layer_safe(jobs[i].name);
    Layer* const value = (*pictures)[i].find("");
    Layer* const variance = (*pictures)[i].find("variance");
    if (value == nullptr || variance == nullptr) return Error{"MITSUBA_FAILED", "a picture of Mitsuba lacks a layer", {}, "", {}};
    add_into(*sum.find(""), *value);
    add_into(*sum.find("variance"), *variance);
    sum.layers.push_back({"light." + name, 3, std::move(value->pixels)});
    sum.layers.push_back({"light_variance." + name, 3, std::move(variance->pixels)});
  }
  return sum;
}

Result<std::uint32_t> samples_in(const Mitsuba& mitsuba, const PictureRequest& request, double seconds) {
  // The first run pays for starting and compiling; the rate is that of the samples which a second one has more.
  const auto timed = [&](std::uint32_t samples) -> Result<double> {
    MitsubaJob trial = job_for(request.lights.front(), request.split);
    trial.samples = samples;
    trial.seeds = 5;
    const auto start = std::chrono::steady_clock::now();
    const auto pictures = run_mitsuba(mitsuba, {trial}, std::nullopt, nullptr);
    if (!pictures) return pictures.error();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const Result<double> few = timed(1);
  if (!few) return few.error();
  const Result<double> more = timed(5);
  if (!more) return more.error();
  const double each = std::max((*more - *few) / 20, 1e-3);  // seconds per sample per pixel
  const double fixed = *few * static_cast<double>(request.lights.size());
  return static_cast<std::uint32_t>(std::clamp((seconds - fixed) / each, 16.0 * static_cast<double>(request.lights.size()), 1e6));
}

Result<Mitsuba> locate_mitsuba(const std::string& hint) {
  std::vector<fs::path> search;
  if (const char* const named = std::getenv("ETENDUE_MITSUBA")) search.emplace_back(named);
  std::error_code ignored;
  for (fs::path folder = program_folder(); folder != folder.parent_path(); folder = folder.parent_path()) {
    search.push_back(folder / ".venv");
  }
  search.push_back(fs::current_path(ignored) / ".venv");
  const char* const path = std::getenv("PATH");
  for (std::string_view rest = path != nullptr ? path : ""; !rest.empty();) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    search.push_back(fs::path(rest.substr(0, colon)) / "mitsuba");
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  std::erase_if(search, [&](const fs::path& place) { return !fs::exists(place, ignored); });
  return find_mitsuba(hint.empty() ? std::nullopt : std::optional<fs::path>(hint), search);
}

}  // namespace etendue::cli
