#include "etendue/result.h"
#include "process.h"
#include "run.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>

#include "driver.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

// Dr.Jit works with LLVM 16 and later; 14 and 15 crash inside instruction selection on machines with AVX-512.
constexpr int oldest_llvm = 16;

bool is_there(const fs::path& path) {
  std::error_code ec;
  return fs::exists(path, ec);
}

bool starts_with(const std::string& text, std::string_view start) { return text.compare(0, start.size(), start) == 0; }
bool is_llvm_library(const fs::path& path) { return starts_with(path.filename().string(), "libLLVM"); }

// "libLLVM.so.19.1", "libLLVM-17.so.1": 19, 17; 0 where no version is in the name.
int llvm_version(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const std::string_view before : {"libLLVM.so.", "libLLVM-"}) {
    if (!starts_with(name, before)) continue;
    int version = 0;
    for (std::size_t i = before.size(); i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) && version < 1000; ++i) {
      version = version * 10 + (name[i] - '0');
    }
    return version;
  }
  return 0;
}

// Interpreters that a path may stand for: itself, the one of a virtual environment, the one beside a `mitsuba` command.
std::vector<fs::path> interpreters_of(const fs::path& given) {
  fs::path path = given;
  if (!path.has_parent_path()) {
    const std::optional<fs::path> found = find_program(path.string());
    if (!found) return is_there(path) ? interpreters_of(fs::path(".") / path) : std::vector<fs::path>{};
    path = *found;
  }
  std::error_code ec;
  std::vector<fs::path> result;
  const auto add_from = [&](const fs::path& folder) {
    for (const char* name : {"python3", "python", "python.exe"}) {
      if (is_there(folder / name)) result.push_back(folder / name);
    }
  };
  if (fs::is_directory(path, ec)) {
    add_from(path / "bin");
    add_from(path / "Scripts");
  } else if (starts_with(path.filename().string(), "mitsuba")) {
    // The command may be a link into the environment's folder.
    add_from(path.parent_path());
    if (const fs::path target = fs::canonical(path, ec); !ec && target.parent_path() != path.parent_path()) add_from(target.parent_path());
  } else if (is_there(path)) {
    result.push_back(path);
  }
  return result;
}

std::vector<fs::path> llvm_libraries(const std::vector<fs::path>& search) {
  std::vector<fs::path> found;
  for (const fs::path& path : search) {
    if (is_llvm_library(path) && is_there(path)) found.push_back(path);
  }
  const auto named = static_cast<std::ptrdiff_t>(found.size());
  std::set<fs::path> folders{"/usr/lib", "/usr/lib64", "/usr/local/lib"};
  std::error_code ec;
  for (const fs::path& base : {fs::path("/usr/lib"), fs::path("/usr/local/lib")}) {
    for (fs::directory_iterator it(base, ec), end; !ec && it != end; it.increment(ec)) {
      const std::string name = it->path().filename().string();
      if (name.find("-linux-") != std::string::npos) folders.insert(it->path());
      if (starts_with(name, "llvm")) folders.insert(it->path() / "lib");
    }
  }
  for (const fs::path& folder : folders) {
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
      if (is_llvm_library(it->path()) && llvm_version(it->path()) >= oldest_llvm) found.push_back(it->path());
    }
  }
  // 19 is the one that was tried; then the nearest to it.
  std::stable_sort(found.begin() + named, found.end(),
                   [](const fs::path& a, const fs::path& b) { return std::abs(llvm_version(a) - 19) < std::abs(llvm_version(b) - 19); });
  return found;
}

// The version that `python` reports after it has computed something in `variant`; "" if it cannot.
std::string probe(const fs::path& python, const std::string& variant, const std::optional<fs::path>& llvm) {
  const nlohmann::json request{{"probe", variant}};
  ProcessCall call;
  call.arguments = {python.string(), "-I", "-c", mitsuba::driver_script(), request.dump()};
  if (llvm) call.environment.emplace_back("DRJIT_LIBLLVM_PATH", llvm->string());
  std::string version;
  call.on_line = [&](std::string_view line) {
    const nlohmann::json message = mitsuba::driver_message(line);
    if (message.contains("version") && message["version"].is_string()) version = message["version"];
  };
  const Result<ProcessEnd> end = run_process(call);
  return end && end->exit_status == 0 ? version : std::string{};
}

Error missing(const std::string& tried) {
  Error error;
  error.code = "MITSUBA_MISSING";
  error.text = "expected Mitsuba 3 as a Python package, found none (tried: " + (tried.empty() ? std::string("nothing") : tried) + ")";
  error.hint = "python3 -m venv .venv && .venv/bin/pip install mitsuba numpy, then --mitsuba .venv; its fast variant also needs libllvm19";
  return error;
}

}  // namespace

Result<Mitsuba> find_mitsuba(const std::optional<fs::path>& hint, const std::vector<fs::path>& search) {
  std::vector<fs::path> places;
  if (hint) places.push_back(*hint);
  for (const fs::path& path : search) {
    if (!is_llvm_library(path)) places.push_back(path);
  }
  std::string tried;
  for (const fs::path& place : places) {
    tried += (tried.empty() ? "" : ", ") + place.string();
    for (const fs::path& python : interpreters_of(place)) {
      const std::string version = probe(python, "scalar_rgb", {});
      if (version.empty()) continue;
      for (const fs::path& llvm : llvm_libraries(search)) {
        if (!probe(python, "llvm_ad_rgb", llvm).empty()) return Mitsuba{python, version, "llvm_ad_rgb", llvm};
      }
      return Mitsuba{python, version, "scalar_rgb", {}};
    }
    if (hint && place == *hint) break;  // who names one wants that one
  }
  return missing(tried);
}

}  // namespace etendue
