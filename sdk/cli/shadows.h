// --shadows, --shadow-samples: how pictures join exact light and sampled shadows.
#pragma once

#include <CLI/CLI.hpp>

#include "etendue/render.h"

namespace etendue::cli {

struct ShadowOptions {
  std::string form = "unbiased";
  std::uint32_t samples = 0;

  void apply(RenderOptions& to) const;
};
void add_shadows(CLI::App& verb, ShadowOptions& options);

}  // namespace etendue::cli
