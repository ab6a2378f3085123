// Scenes for the real Mitsuba, and its pictures of them.
#pragma once

#include "exporters/mitsuba/mitsuba.h"
#include "exporters/mitsuba/run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace etendue::testing {

// A folder of its own for each test program, removed when the program ends.
const std::filesystem::path& scratch();

// The Mitsuba that the tests use, found once; nullptr where there is none.
const Mitsuba* mitsuba();

// A light with a luminance of 1000 cd/m2, an illuminance of 1000 lx or an intensity of 1000 cd, whichever its shape takes.
Light light_of(Shape shape);
// Turned so that it emits along `direction` (+Y stays as near to up as can be), at `position`.
Transform aimed(const Vec3d& position, const Vec3d& direction);

// Exports as scratch()/NAME.xml. Fails the test where the exporter does.
Exported exported(const Scene& scene, const std::string& name, const ExportOptions& options = {});

// Renders with `seeds` seeds of `samples`. Fails the test where Mitsuba does.
std::vector<Picture> rendered(const std::vector<std::filesystem::path>& scenes, std::uint32_t samples, std::uint32_t seeds = 8);
Picture rendered(const Scene& scene, const std::string& name, std::uint32_t size, std::uint32_t samples, std::uint32_t seeds = 8);

// Mean over all pixels, and its standard error from the variance layer, of Y.
struct Mean {
  double value = 0, standard_error = 0;
};
Mean mean_luminance(const Picture& picture);
Rgb pixel(const Picture& picture, std::uint32_t x, std::uint32_t y);

}  // namespace etendue::testing

// Leaves the test, as skipped, where Mitsuba is not there.
#define ETENDUE_NEEDS_MITSUBA()                                                                 \
  do {                                                                                          \
    if (!etendue::testing::mitsuba()) GTEST_SKIP() << "no Mitsuba in .venv or ETENDUE_MITSUBA"; \
  } while (false)
