#include "etendue/surface_presets.h"

#include "named_preset.h"

#include <array>

namespace etendue {
namespace {

constexpr F0Preset dielectric(std::string_view name, double n, std::string_view source) {
  const double root = (n - 1) / (n + 1), f0 = root * root;
  return {name, {f0, f0, f0}, false, n, f0 <= 0.16, source};
}
constexpr F0Preset metal(std::string_view name, double r, double g, double b, std::string_view source) {
  return {name, {r, g, b}, true, 0, false, source};
}

constexpr std::string_view handbook = "index at 589 nm, CRC Handbook of Chemistry and Physics";
constexpr std::string_view plastics = "index at 589 nm, as makers of optical plastics state it";
constexpr std::string_view notes = "Lagarde and de Rousiers 2014, 3.2.1: 8 % of ruby, 17 % of diamond";
constexpr std::string_view skin = "d'Eon and Luebke 2007, GPU Gems 3, chapter 14";
constexpr std::string_view charts = "Unity Shader Graph, node Metal Reflectance";
constexpr std::array presets{
    dielectric("ice", 1.309, handbook),
    dielectric("water", 1.333, handbook),
    dielectric("skin", 1.4, skin),
    dielectric("fused quartz", 1.4585, handbook),
    dielectric("acrylic", 1.49, plastics),
    dielectric("common dielectric", 1.5, "glTF 2.0, appendix B: f0 = .04"),
    dielectric("window glass", 1.52, handbook),
    dielectric("polycarbonate", 1.585, plastics),
    dielectric("ruby", 1.77, notes),
    dielectric("diamond", 2.417, notes),
    metal("silver", 0.972, 0.960, 0.915, charts),
    metal("aluminium", 0.913, 0.921, 0.925, charts),
    metal("gold", 1.000, 0.766, 0.336, charts),
    metal("copper", 0.955, 0.637, 0.538, charts),
    metal("iron", 0.560, 0.570, 0.580, charts),
    metal("chromium", 0.550, 0.556, 0.554, charts),
    metal("nickel", 0.660, 0.609, 0.526, charts),
    metal("titanium", 0.542, 0.497, 0.449, charts),
    metal("cobalt", 0.662, 0.655, 0.634, charts),
    metal("platinum", 0.672, 0.637, 0.585, charts),
};

}  // namespace

std::span<const F0Preset> f0_presets() { return presets; }
Result<F0Preset> f0_preset(std::string_view name) { return named_preset(f0_presets(), name, "material whose f0"); }

}  // namespace etendue
