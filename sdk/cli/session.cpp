#include "session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "importers/eulumdat/eulumdat.h"
#include "importers/gltf/gltf.h"
#include "importers/ies/ies.h"
#include "importers/photometric_lights/photometric_lights.h"
#include "importers/rig/rig.h"

namespace etendue::cli {
namespace {

std::string joined_names(const Scene& scene) {
  std::string names;
  for (const Light& light : scene.lights) names += (names.empty() ? "" : ", ") + light.name;
  return names.empty() ? "none" : names;
}

}  // namespace

Bar::Bar(const Session& session) : session_(session), terminal_(isatty(STDERR_FILENO) == 1) {}

Bar::~Bar() { end_stage(); }

void Bar::end_stage() {
  if (stage_.empty() || session_.common().quiet) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  constexpr double worth_telling = 0.5;
  if (terminal_) fmt::print(stderr, "\r\x1b[K");
  if (seconds >= worth_telling) fmt::print(stderr, "{}  {:.1f} s\n", stage_, seconds);
  stage_.clear();
}

bool Bar::report(std::string_view what, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (what != stage_) {
    end_stage();
    stage_ = what;
    start_ = drawn_ = now;
  } else if (now - drawn_ < std::chrono::milliseconds(100)) {
    return !interrupted();
  }
  if (terminal_ && !session_.common().quiet) {
    constexpr int cells = 32;
    const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * cells);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left = fraction > 0.03 ? fmt::format("{:.0f} s left", elapsed * (1 - fraction) / fraction) : "";
    fmt::print(stderr, "\r\x1b[K{}  [{:=<{}}{:<{}}] {:3.0f} %  {}", stage_, "", full, "", cells - full, 100 * fraction, left);
    std::fflush(stderr);
    drawn_ = now;
  }
  return !interrupted();
}

const Registry& importers() {
  static const Registry* const built_in = [] {
    auto* const formats = new Registry;  // lives as long as the program
    formats->add(make_gltf_importer());
    formats->add(make_ies_importer());
    formats->add(make_eulumdat_importer());
    formats->add(make_rig_importer(*formats));
    return formats;
  }();
  return *built_in;
}

Result<Imported> read_asset(Session& session, const std::string& file, const ImportOptions& options) {
  const Result<const Importer*> importer = importers().importer_for(file);
  if (!importer) return importer.error();
  Result<Imported> imported = (*importer)->read(file, options);
  if (!imported) return imported;
  if (has(options.need, Need::lights)) imported->diagnostics.append(read_photometric_lights(imported->scene));
  session.diagnostics.append(imported->diagnostics);
  const auto add = [&](const char* key, std::uint64_t count) { session.stats[key] = session.stats.value(key, std::uint64_t{0}) + count; };
  add("bytes_read", imported->stats.bytes_read);
  add("skipped_bytes", imported->stats.skipped_bytes);
  add("images_decoded", imported->stats.images_decoded);
  add("skipped_meshes", imported->stats.skipped_meshes);
  add("skipped_images", imported->stats.skipped_images);
  return imported;
}

Result<Size> parse_size(const std::string& text) {
  Size size;
  const char* const end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  const bool separated = width_error == std::errc() && after_width != end && *after_width == 'x';
  const auto [after_height, height_error] =
      separated ? std::from_chars(after_width + 1, end, size.height) : std::from_chars(end, end, size.height);
  constexpr std::uint32_t largest = 16384;
  if (!separated || height_error != std::errc() || after_height != end || size.width == 0 || size.height == 0 || size.width > largest ||
      size.height > largest) {
    return Error{
        "USAGE", fmt::format("--size: expected WIDTHxHEIGHT, each 1 to {}, found '{}'", largest, text), {}, "as in --size 512x512", {}};
  }
  return size;
}

Result<std::vector<std::uint32_t>> lights_by_name(const Scene& scene, const std::string& list) {
  std::vector<std::uint32_t> found;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t comma = std::min(list.find(',', start), list.size());
    const std::string name = list.substr(start, comma - start);
    const auto light = std::find_if(scene.lights.begin(), scene.lights.end(), [&](const Light& l) { return l.name == name; });
    if (light == scene.lights.end()) {
      return Error{
          "USAGE", fmt::format("no light is called '{}'; there are: {}", name, joined_names(scene)), {scene.file, 0, 0, ""}, "", {}};
    }
    found.push_back(static_cast<std::uint32_t>(light - scene.lights.begin()));
    start = comma + 1;
  }
  return found;
}

Result<std::vector<std::uint32_t>> lit_lights(const Scene& scene, const std::string& lights, const std::string& mute) {
  std::vector<std::uint32_t> lit;
  if (lights.empty()) {
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) lit.push_back(i);
  } else {
    auto named = lights_by_name(scene, lights);
    if (!named) return named;
    lit = *named;
  }
  if (!mute.empty()) {
    auto muted = lights_by_name(scene, mute);
    if (!muted) return muted;
    std::erase_if(lit, [&](std::uint32_t i) { return std::find(muted->begin(), muted->end(), i) != muted->end(); });
  }
  if (lit.empty()) return Error{"LIGHT_MISSING", "the scene has no light that is lit", {scene.file, 0, 0, ""}, "", {}};
  std::sort(lit.begin(), lit.end());
  lit.erase(std::unique(lit.begin(), lit.end()), lit.end());
  return lit;
}

Result<std::uint32_t> choose_camera(Scene& scene, const std::string& name, double aspect) {
  if (name.empty() && !scene.cameras.empty()) return 0u;
  if (!name.empty() && name != "auto") {
    const auto camera = std::find_if(scene.cameras.begin(), scene.cameras.end(), [&](const Camera& c) { return c.name == name; });
    if (camera != scene.cameras.end()) return static_cast<std::uint32_t>(camera - scene.cameras.begin());
    std::string names = "auto";
    for (const Camera& c : scene.cameras) names += ", " + c.name;
    return Error{"USAGE", fmt::format("no camera is called '{}'; there are: {}", name, names), {scene.file, 0, 0, ""}, "", {}};
  }
  const Bounds bounds = bounds_of(scene);
  if (bounds.empty()) return Error{"CAMERA_MISSING", "the scene has no camera and nothing to frame", {scene.file, 0, 0, ""}, "", {}};
  scene.cameras.push_back(framing_camera(bounds, aspect));
  return static_cast<std::uint32_t>(scene.cameras.size() - 1);
}

}  // namespace etendue::cli
