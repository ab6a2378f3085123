#include "etendue/conversion_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "etendue/false_colour.h"
#include "etendue/material_conversion.h"
#include "nearest_lookup.h"
#include "texture_conversion.h"

namespace etendue {
namespace {

constexpr std::uint32_t region_side = 128, panel_side = 256, gap = 8;

struct Readings {
  ColourPair core, full;
};

// What both readers make of a material, texel by texel.
class Surface {
 public:
  static Result<Surface> of(const Scene& scene, const Material& material, std::uint64_t max_pixels) {
    if (!std::holds_alternative<SpecularGlossiness>(material.model) && !std::holds_alternative<MetalRough>(material.model))
      return Error{"MODEL_UNSUITABLE", "material '" + material.name + "': neither metallic-roughness nor specular-glossiness", {}, {}, {}};
    Surface surface(material);
    const Specular lobe = material.lobes.specular.value_or(Specular{});
    const std::array<const std::optional<Texture>*, 5> textures{&material.base_colour_texture, &material.metal_rough_texture,
                                                                &material.specular_gloss_texture, &lobe.colour_texture,
                                                                &lobe.factor_texture};
    for (std::size_t i = 0; i < textures.size(); ++i) {
      auto lookup = nearest_lookup_of(scene, *textures[i], max_pixels);
      if (!lookup) return lookup.error();
      surface.lookups_[i] = std::move(*lookup);
    }
    return surface;
  }
  std::uint32_t width() const { return largest(&DecodedImage::width); }
  std::uint32_t height() const { return largest(&DecodedImage::height); }

  Readings at(Vec2d uv) const {
    const auto look = [&](std::size_t i) { return lookups_[i] ? sample(lookups_[i]->image, lookups_[i]->texture, uv) : Rgba{1, 1, 1, 1}; };
    const auto times = [](const Rgba& a, const Rgb& b) { return Rgb{a.r * b.x, a.g * b.y, a.b * b.z}; };
    if (const auto* gloss = std::get_if<SpecularGlossiness>(&material_.model)) {
      const TwoColour two = two_colour_of(SpecularGlossiness{times(look(0), gloss->diffuse), times(look(2), gloss->specular), 1});
      return {{two.diffuse, two.f0}, {two.diffuse, two.f0}};
    }
    const auto& metal = std::get<MetalRough>(material_.model);
    MetalRough plain = metal;
    Material lit;
    Specular lobe = material_.lobes.specular.value_or(Specular{});
    lobe.colour = times(look(3), lobe.colour);
    lobe.factor *= look(4).a;
    lit.lobes.specular = lobe;
    const MetalRoughColours colours{times(look(0), metal.base_colour), metal.metallic * look(1).b, dielectric_f0_of(lit, plain)};
    return {in_core_reader(colours), in_full_reader(colours)};
  }

 private:
  explicit Surface(const Material& material) : material_(material) {}
  std::uint32_t largest(std::uint32_t DecodedImage::*side) const {
    std::uint32_t most = 1;
    for (const auto& lookup : lookups_)
      if (lookup) most = std::max(most, lookup->image.*side);
    return most;
  }
  Material material_;
  std::array<std::optional<NearestLookup>, 5> lookups_;
};

double squared(const ColourPair& a, const ColourPair& b) {
  const Rgb d = a.diffuse - b.diffuse, f = a.f0 - b.f0;
  return dot(d, d) + dot(f, f);
}

// Regions stand half their side apart.
WorstRegion worst_region(const std::vector<float>& errors, std::uint32_t width, std::uint32_t height, const char* reader) {
  WorstRegion worst;
  worst.reader = reader;
  worst.width = std::min(width, region_side);
  worst.height = std::min(height, region_side);
  double most = -1;
  for (std::uint32_t y = 0; y + worst.height <= height; y += std::max(worst.height / 2, 1u)) {
    for (std::uint32_t x = 0; x + worst.width <= width; x += std::max(worst.width / 2, 1u)) {
      double sum = 0, max = 0;
      for (std::uint32_t v = y; v < y + worst.height; ++v) {
        for (std::uint32_t u = x; u < x + worst.width; ++u) {
          const auto square = static_cast<double>(errors[std::size_t{v} * width + u]);
          sum += square;
          max = std::max(max, square);
        }
      }
      if (sum <= most) continue;
      most = sum;
      worst.x = x, worst.y = y, worst.max = std::sqrt(max / 6);
      worst.rms = std::sqrt(sum / (6.0 * worst.width * worst.height));
    }
  }
  return worst;
}

}  // namespace

Result<ConversionView> conversion_view(const Scene& before, const Material& was, const Scene& after, const Material& is,
                                       std::uint64_t max_pixels) {
  const auto old = Surface::of(before, was, max_pixels);
  if (!old) return old.error();
  const auto made = Surface::of(after, is, max_pixels);
  if (!made) return made.error();
  ConversionView view;
  const std::uint32_t width = view.width = std::max(old->width(), made->width());
  const std::uint32_t height = view.height = std::max(old->height(), made->height());
  const auto place = [&](std::uint32_t x, std::uint32_t y) { return Vec2d{(x + 0.5) / width, (y + 0.5) / height}; };

  std::array<std::vector<float>, 2> errors;  // squares, of core-only and full
  for (auto& map : errors) map.resize(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const Readings a = old->at(place(x, y)), b = made->at(place(x, y));
      errors[0][std::size_t{y} * width + x] = static_cast<float>(squared(b.core, a.full));
      errors[1][std::size_t{y} * width + x] = static_cast<float>(squared(b.full, a.full));
    }
  }
  view.regions = {worst_region(errors[0], width, height, "core"), worst_region(errors[1], width, height, "full")};

  view.picture.width = 5 * panel_side + 4 * gap;
  view.picture.height = 2 * panel_side + gap;
  Layer& layer = view.picture.add("", 3);
  for (std::size_t row = 0; row < 2; ++row) {
    const WorstRegion& region = view.regions[row];
    const std::uint32_t scale = std::max(panel_side / std::max(region.width, region.height), 1u);
    for (std::uint32_t y = 0; y < region.height * scale; ++y) {
      for (std::uint32_t x = 0; x < region.width * scale; ++x) {
        const std::uint32_t u = region.x + x / scale, v = region.y + y / scale;
        const Readings a = old->at(place(u, v)), b = made->at(place(u, v));
        const ColourPair& shown = row == 0 ? b.core : b.full;
        const double error = std::sqrt(static_cast<double>(errors[row][std::size_t{v} * width + u]) / 6);
        const std::array<Rgb, 5> panels{a.full.diffuse, shown.diffuse, a.full.f0, shown.f0,
                                        false_colour(region.max > 0 ? error / region.max : 0)};
        for (std::size_t panel = 0; panel < panels.size(); ++panel) {
          const std::size_t column = panel * (panel_side + gap) + x, line = row * (panel_side + gap) + y;
          for (int c = 0; c < 3; ++c)
            layer.pixels[3 * (line * view.picture.width + column) + static_cast<std::size_t>(c)] = static_cast<float>(panels[panel][c]);
        }
      }
    }
  }
  return view;
}

}  // namespace etendue
