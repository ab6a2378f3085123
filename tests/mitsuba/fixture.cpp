#include "fixture.h"
#include "source_dir.h"

#include <cstdlib>

#include <unistd.h>

namespace etendue::testing {
namespace {

struct Scratch {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("etendue-test-" + std::to_string(::getpid()));
  Scratch() { std::filesystem::create_directories(path); }
  ~Scratch() {
    std::error_code ec;
    std::filesystem::remove_all(path, ec);
  }
};

}  // namespace

const std::filesystem::path& scratch() {
  static const Scratch folder;
  return folder.path;
}

const Mitsuba* mitsuba() {
  static const Result<Mitsuba> found = [] {
    std::vector<std::filesystem::path> search;
    if (const char* given = std::getenv("ETENDUE_MITSUBA")) search.emplace_back(given);
    search.push_back(source_dir() / ".venv");
    return find_mitsuba({}, search);
  }();
  return found ? &*found : nullptr;
}

Light light_of(Shape shape) {
  Light light;
  light.name = name_of(shape);
  light.shape = std::move(shape);
  light.emission.value = 1000;
  const bool punctual = std::holds_alternative<PointShape>(light.shape) || std::holds_alternative<SpotShape>(light.shape) ||
                        std::holds_alternative<FrustumShape>(light.shape) || std::holds_alternative<LineShape>(light.shape);
  light.emission.given = punctual                                            ? Emission::Given::intensity
                         : std::holds_alternative<DistantShape>(light.shape) ? Emission::Given::illuminance
                                                                             : Emission::Given::luminance;
  return light;
}

Transform aimed(const Vec3d& position, const Vec3d& direction) {
  const Vec3d z = -normalised(direction);
  const Vec3d up = std::abs(z.y) > 0.99 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d x = normalised(cross(up, z));
  return {{x, cross(z, x), z}, position};
}

Exported exported(const Scene& scene, const std::string& name, const ExportOptions& options) {
  Result<Exported> result = make_mitsuba_exporter()->write(scene, scratch() / (name + ".xml"), options);
  if (result) return std::move(*result);
  ADD_FAILURE() << name << ": " << to_string(to_diagnostic(result.error()));
  for (const Diagnostic& note : result.error().notes) ADD_FAILURE() << to_string(note);
  return {};
}

std::vector<Picture> rendered(const std::vector<std::filesystem::path>& scenes, std::uint32_t samples, std::uint32_t seeds) {
  std::vector<MitsubaJob> jobs;
  jobs.reserve(scenes.size());
  for (const std::filesystem::path& scene : scenes) jobs.push_back({scene, scene.stem().string(), samples, seeds, 1});
  Result<std::vector<Picture>> pictures = run_mitsuba(*mitsuba(), jobs, {});
  if (pictures) return std::move(*pictures);
  ADD_FAILURE() << to_string(to_diagnostic(pictures.error()));
  return {};
}

Picture rendered(const Scene& scene, const std::string& name, std::uint32_t size, std::uint32_t samples, std::uint32_t seeds) {
  ExportOptions options;
  options.width = options.height = size;
  exported(scene, name, options);
  std::vector<Picture> pictures = rendered({scratch() / (name + ".xml")}, samples, seeds);
  return pictures.empty() ? Picture{} : std::move(pictures[0]);
}

Mean mean_luminance(const Picture& picture) {
  const std::vector<float>& mean = picture.find("")->pixels;
  const std::vector<float>& variance = picture.find("variance")->pixels;
  double sum = 0, sum_of_variances = 0;
  for (std::size_t i = 0; i + 2 < mean.size(); i += 3) {
    sum += luminance_of({mean[i], mean[i + 1], mean[i + 2]});
    // The channels of one light move together: the standard deviation of Y is at most the weighted sum of theirs.
    const double sd = luminance_of({std::sqrt(variance[i]), std::sqrt(variance[i + 1]), std::sqrt(variance[i + 2])});
    sum_of_variances += sd * sd;
  }
  const double pixels = static_cast<double>(picture.width) * picture.height;
  return {sum / pixels, std::sqrt(sum_of_variances) / pixels};
}

Rgb pixel(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const float* p = &picture.find("")->pixels[(std::size_t{y} * picture.width + x) * 3];
  return {p[0], p[1], p[2]};
}

}  // namespace etendue::testing
