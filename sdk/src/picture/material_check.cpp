#include "etendue/material_check.h"

#include "etendue/textured_surface.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "nearest_lookup.h"

namespace etendue {
namespace {

Rgba at(const std::optional<NearestLookup>& lookup, Vec2d uv) {
  return lookup ? sample(lookup->image, lookup->texture, uv) : Rgba{1, 1, 1, 1};
}

bool same_place(const std::optional<Texture>& a, const std::optional<Texture>& b) {
  return !a || !b || (a->uv_set == b->uv_set && std::equal(&a->uv_transform[0][0], &a->uv_transform[0][0] + 6, &b->uv_transform[0][0]));
}

// Neighbours are often equal, and few values are distinct: each is judged once.
struct TexelHash {
  std::size_t operator()(const std::array<double, 9>& values) const {
    std::size_t hash = 0;
    for (const double v : values) hash = (hash ^ std::hash<double>{}(v)) * 0x9e3779b97f4a7c15u;
    return hash;
  }
};
struct Judged {
  SurfaceColours colours;
  Doubts doubts;
};

}  // namespace

Result<MaterialCheck> check_material(const Scene& scene, const Material& material, const PlausibleRanges& ranges,
                                     std::uint64_t max_pixels) {
  const auto base = nearest_lookup_of(scene, material.base_colour_texture, max_pixels);
  if (!base) return base.error();
  const auto metal_rough = nearest_lookup_of(scene, material.metal_rough_texture, max_pixels);
  if (!metal_rough) return metal_rough.error();
  const auto specular = nearest_lookup_of(scene, material.specular_gloss_texture, max_pixels);
  if (!specular) return specular.error();

  MaterialCheck check;
  check.same_places = same_place(material.base_colour_texture, material.metal_rough_texture) &&
                      same_place(material.base_colour_texture, material.specular_gloss_texture);
  for (const auto* lookup : {&*base, &*metal_rough, &*specular}) {
    if (*lookup)
      check.width = std::max(check.width, (*lookup)->image.width), check.height = std::max(check.height, (*lookup)->image.height);
  }
  check.view.width = check.width, check.view.height = check.height;
  Layer& view = check.view.add("", 3);
  std::unordered_map<std::array<double, 9>, Judged, TexelHash> known;
  bool first = true;
  for (std::uint32_t y = 0; y < check.height; ++y) {
    for (std::uint32_t x = 0; x < check.width; ++x) {
      const Vec2d uv{(x + 0.5) / check.width, (y + 0.5) / check.height};
      const Rgba b = at(*base, uv), m = at(*metal_rough, uv), s = at(*specular, uv);
      const auto [found, is_new] = known.try_emplace({b.r, b.g, b.b, m.b, m.g, s.r, s.g, s.b, s.a});
      Judged& judged = found->second;
      if (is_new) {
        judged.colours = described(textured(material.model, {{b.r, b.g, b.b}, m.b, m.g, {s.r, s.g, s.b}, s.a}));
        judged.doubts = doubts_of(judged.colours, ranges);
        const auto& [diffuse, f0] = judged.colours.pair;
        if (first) check.albedo_least = check.albedo_greatest = diffuse, check.f0_least = check.f0_greatest = f0;
        first = false;
        for (int c = 0; c < 3; ++c) {
          check.albedo_least[c] = std::min(check.albedo_least[c], diffuse[c]);
          check.albedo_greatest[c] = std::max(check.albedo_greatest[c], diffuse[c]);
          check.f0_least[c] = std::min(check.f0_least[c], f0[c]);
          check.f0_greatest[c] = std::max(check.f0_greatest[c], f0[c]);
        }
      }
      for (const Doubt doubt : all_doubts) check.texels[static_cast<std::size_t>(doubt)] += judged.doubts.has(doubt) ? 1 : 0;
      check.doubtful += judged.doubts.none() ? 0 : 1;
      const Rgb sum = judged.colours.pair.diffuse + judged.colours.pair.f0;
      const auto worst = judged.doubts.worst();
      const Rgb colour = worst ? info_of(*worst).colour : Rgb{1, 1, 1} * (0.3 * (sum.x + sum.y + sum.z) / 3);
      for (int c = 0; c < 3; ++c)
        view.pixels[3 * (std::size_t{y} * check.width + x) + static_cast<std::size_t>(c)] = static_cast<float>(colour[c]);
    }
  }
  return check;
}

}  // namespace etendue
