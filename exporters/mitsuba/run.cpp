#include "run.h"

#include "cache.h"
#include "driver.h"
#include "process.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace etendue {
namespace {

namespace fs = std::filesystem;
using mitsuba::PictureCache;

Error failed(std::string text, const fs::path& scene) { return {"MITSUBA_FAILED", std::move(text), {scene.string(), 0, 0, {}}, {}, {}}; }
Error cancelled() { return {"CANCELLED", "cancelled", {}, {}, {}}; }

// A folder that goes when this value goes.
class ScratchFolder {
 public:
  explicit ScratchFolder(fs::path path) : path_(std::move(path)) {}
  ~ScratchFolder() {
    std::error_code ec;
    fs::remove_all(path_, ec);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Result<fs::path> make_scratch() {
  static std::atomic<unsigned> count{0};
  std::error_code ec;
  const fs::path base = fs::temp_directory_path(ec);
  if (ec) return Error{"FILE_UNWRITABLE", "no folder for temporary files: " + ec.message(), {}, {}, {}};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const auto stamp = fs::file_time_type::clock::now().time_since_epoch().count();
    fs::path path = base / ("etendue-" + std::to_string(stamp) + "-" + std::to_string(count++));
    if (fs::create_directory(path, ec)) {
      fs::permissions(path, fs::perms::owner_all, ec);
      return path;
    }
  }
  return Error{"FILE_UNWRITABLE", "cannot make a folder for temporary files", {base.string(), 0, 0, {}}, {}, {}};
}

// Six little-endian floats a pixel: mean and variance of the mean.
Result<Picture> read_raw(const fs::path& file, std::uint32_t width, std::uint32_t height, const MitsubaJob& job) {
  const std::size_t pixels = std::size_t{width} * height;
  Result<std::vector<std::byte>> bytes = read_file(file, pixels * 24 + 1);
  if (!bytes) return bytes.error();
  if (bytes->size() != pixels * 24) return failed("expected a picture of " + std::to_string(pixels) + " pixels", job.scene);
  Picture picture;
  picture.width = width, picture.height = height;
  std::vector<float> mean = std::move(picture.add("", 3).pixels), variance = std::move(picture.add("variance", 3).pixels);
  for (std::size_t i = 0; i < pixels * 6; ++i) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 4; ++b) bits |= std::to_integer<std::uint32_t>((*bytes)[i * 4 + b]) << (8 * b);
    (i % 6 < 3 ? mean : variance)[i / 6 * 3 + i % 3] = std::bit_cast<float>(bits);
  }
  for (const float value : mean) {
    if (!std::isfinite(value)) return failed("the picture has pixels that are not finite numbers", job.scene);
  }
  picture.find("")->pixels = std::move(mean);
  picture.find("variance")->pixels = std::move(variance);
  picture.numbers["etendue:seeds"] = job.seeds;
  picture.numbers["etendue:samples"] = static_cast<double>(job.samples) * job.seeds;
  return picture;
}

// What the driver said so far.
struct Conversation {
  std::size_t jobs;
  std::string error;
  std::string last_lines;  // of Mitsuba itself
  double fraction = 0;
  std::size_t job = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;  // of the finished pictures, in order

  void hear(std::string_view line) {
    const nlohmann::json message = mitsuba::driver_message(line);
    if (message.empty()) {
      last_lines.append(line).push_back('\n');
      if (last_lines.size() > 8000) last_lines.erase(0, last_lines.size() - 4000);
    }
    if (message.contains("job")) job = std::min(message["job"].get<std::size_t>(), jobs - 1);
    if (message.contains("total")) fraction = message["done"].get<double>() / message["total"].get<double>();
    if (message.contains("finished")) sizes.emplace_back(message["width"], message["height"]);
    if (message.contains("error")) error = message["error"];
  }
};

struct KeyedJob {
  const MitsubaJob* job;
  std::string content, key;
};

// Seeds are numbered 4096 apart, one for each pass, from a start that the scene's content gives: pictures of different scenes (one light
// each) are independent of one another, and the same scene always gives the same picture.
std::uint32_t first_number(const KeyedJob& keyed) {
  const auto start = static_cast<std::uint32_t>(std::stoul(keyed.content.substr(0, 8), nullptr, 16));
  return start + (keyed.job->first_seed << 12);
}

nlohmann::json request_of(const Mitsuba& mitsuba, const std::vector<KeyedJob>& jobs, const fs::path& scratch) {
  nlohmann::json request{{"variant", mitsuba.variant}, {"jobs", nlohmann::json::array()}};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    request["jobs"].push_back({{"scene", fs::absolute(jobs[i].job->scene).string()},
                               {"samples", jobs[i].job->samples},
                               {"seeds", jobs[i].job->seeds},
                               {"first_seed", first_number(jobs[i])},
                               {"out", (scratch / (std::to_string(i) + ".raw")).string()}});
  }
  return request;
}

Result<std::vector<Picture>> render_all(const Mitsuba& mitsuba, const std::vector<KeyedJob>& jobs, Progress* progress) {
  Result<fs::path> folder = make_scratch();
  if (!folder) return folder.error();
  const ScratchFolder scratch(*folder);
  const std::string request = request_of(mitsuba, jobs, scratch.path()).dump();
  const fs::path request_file = scratch.path() / "request.json";
  if (Status s = write_file(request_file, std::as_bytes(std::span(request))); !s) return s.error();

  Conversation heard{jobs.size(), {}, {}, 0, 0, {}};
  ProcessCall call;
  call.arguments = {mitsuba.python.string(), "-I", "-c", mitsuba::driver_script(), request_file.string()};
  if (mitsuba.llvm) call.environment.emplace_back("DRJIT_LIBLLVM_PATH", mitsuba.llvm->string());
  call.on_line = [&](std::string_view line) { heard.hear(line); };
  call.keep_going = [&] { return !progress || progress->report("Mitsuba: " + jobs[heard.job].job->name, heard.fraction); };
  const Result<ProcessEnd> end = run_process(call);
  if (!end) return end.error();
  if (end->cancelled) return cancelled();
  if (end->exit_status != 0 || heard.sizes.size() != jobs.size()) {
    const std::string why = !heard.error.empty() ? heard.error : heard.last_lines;
    return failed("Mitsuba ended with status " + std::to_string(end->exit_status) + ": " + why, jobs[heard.job].job->scene);
  }
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    Result<Picture> picture =
        read_raw(scratch.path() / (std::to_string(i) + ".raw"), heard.sizes[i].first, heard.sizes[i].second, *jobs[i].job);
    if (!picture) return picture.error();
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

Status check(const MitsubaJob& job) {
  // Seeds of the passes are numbered 4096 apart in 32 bits.
  if (job.samples == 0 || job.seeds == 0 || std::uint64_t{job.first_seed} + job.seeds > (1u << 20)) {
    return failed("expected at least one sample and one seed, and seeds below 1048576", job.scene);
  }
  return Done{};
}

}  // namespace

Result<std::vector<Picture>> run_mitsuba(const Mitsuba& mitsuba, const std::vector<MitsubaJob>& jobs,
                                         const std::optional<fs::path>& cache_folder, Progress* progress) {
  std::vector<Picture> pictures(jobs.size());
  std::vector<KeyedJob> missing;
  const PictureCache cache(cache_folder);
  mitsuba::Digests digests;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (Status s = check(jobs[i]); !s) return s.error();
    Result<std::string> content = mitsuba::content_of(jobs[i].scene, digests);
    if (!content) return content.error();
    KeyedJob keyed{&jobs[i], *content, mitsuba::key_of(mitsuba, jobs[i], *content)};
    if (std::optional<Picture> known = cache.find(keyed.key)) {
      pictures[i] = std::move(*known);
    } else {
      missing.push_back(std::move(keyed));
    }
  }
  if (missing.empty()) return pictures;
  Result<std::vector<Picture>> rendered = render_all(mitsuba, missing, progress);
  if (!rendered) return rendered.error();
  for (std::size_t m = 0; m < missing.size(); ++m) {
    if (Status s = cache.keep(missing[m].key, (*rendered)[m]); !s) return s.error();
    pictures[static_cast<std::size_t>(missing[m].job - jobs.data())] = std::move((*rendered)[m]);
  }
  return pictures;
}

}  // namespace etendue
