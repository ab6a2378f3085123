// Runs the real Mitsuba 3 (its Python wheel) on exported scenes, in one process for all scenes and seeds, and caches the pictures.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "etendue/io.h"
#include "etendue/picture.h"

namespace etendue {

// Where Mitsuba is: the Python interpreter that imports it, the variant that will be used, versions for reports.
struct Mitsuba {
  std::filesystem::path python;
  std::string version;                        // "3.9.1"
  std::string variant;                        // "llvm_ad_rgb", or "scalar_rgb" where there is no usable LLVM library
  std::optional<std::filesystem::path> llvm;  // for DRJIT_LIBLLVM_PATH
};

// Looks at `hint` (the mitsuba command, a Python interpreter, or a virtual environment's folder), then in `search` in order.
// Error MITSUBA_MISSING says what was tried and how to install it.
Result<Mitsuba> find_mitsuba(const std::optional<std::filesystem::path>& hint, const std::vector<std::filesystem::path>& search);

struct MitsubaJob {
  std::filesystem::path scene;  // XML
  std::string name;             // of the picture it makes, for progress
  std::uint32_t samples = 64;   // per seed
  std::uint32_t seeds = 16;
  std::uint32_t first_seed = 0;
};

// One picture a job, pooled over its seeds: layers "" (mean) and "variance" (of the mean), "etendue:seeds". `cache`: a folder, made if need
// be; a picture is taken from it when the XML, every file it names, the samples, seeds, variant, version and our plugins are the same.
// Errors: MITSUBA_FAILED with Mitsuba's own message, CANCELLED.
Result<std::vector<Picture>> run_mitsuba(const Mitsuba& mitsuba, const std::vector<MitsubaJob>& jobs,
                                         const std::optional<std::filesystem::path>& cache, Progress* progress = nullptr);

}  // namespace etendue
