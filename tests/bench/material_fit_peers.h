// Other ways to Disney parameters: CMinpack's Levenberg-Marquardt with each way to keep the bounds, a grid with golden section, and
// Khronos' closed form.
#pragma once

#include "etendue/material_fit.h"

namespace etendue::bench {

// How CMinpack, which knows no bounds, is kept within [0, 1]: x = (1 + sin u) / 2; x clamped inside the function; free, and clamped behind.
enum class Bounds { sine, clamped_inside, clamped_behind };

#ifdef ETENDUE_CMINPACK
DisneyColours cminpack_fit(const ColourPair& pair, const DisneyColours& start, Bounds bounds);
#endif

// The residual at nine metal masks, the rest exact, then golden section between the neighbours of the best.
DisneyColours grid_and_golden_section(const ColourPair& pair);

// Khronos' solveMetallic (glTF's KHR_materials_pbrSpecularGlossiness converter): metal of perceived brightnesses, f0 of dielectrics .04,
// the base colour mixed of both by metal squared.
DisneyColours solve_metallic(const ColourPair& pair);

}  // namespace etendue::bench
