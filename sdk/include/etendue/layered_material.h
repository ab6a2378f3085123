// Materials over each other, each with its own tiling and a mask, baked to one set of textures that any renderer reads.
//   LayeredMaterial rusty{"rusty steel", {{steel, 4}, {rust, 2, mask}}};
//   auto baked = bake_layers(rusty, scene.images, {1024, 1024, "textures"});
#pragma once

#include "etendue/image.h"
#include "etendue/io.h"
#include "etendue/layered_surface.h"
#include "etendue/material.h"
#include "etendue/result.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

struct MaterialLayer {
  Material material;
  double uv_scale = 1;          // how often its textures repeat over [0, 1]: multiplies their coordinates, before their own transforms
  std::optional<Texture> mask;  // its red, over [0, 1]^2 of its own coordinates; none: everywhere. The lowest layer's has no effect
  double opacity = 1;           // times the mask, 0 to 1
};

// The lowest first.
struct LayeredMaterial {
  std::string name;
  std::vector<MaterialLayer> layers;
  NormalBlend normals = NormalBlend::replace;
  LayerBlend blend = LayerBlend::parameters;
};

struct BakeOptions {
  std::uint32_t width = 0, height = 0;  // of the baked textures
  std::filesystem::path folder;         // for them, as PNG
  int bits = 8;                         // 8 or 16
  unsigned threads = 0;                 // 0: as many as the machine has
  Progress* progress = nullptr;
};

struct BakedMaterial {
  // Metallic-roughness. `Texture::image` is the place in `images`. What all layers leave out has no texture.
  Material material;
  std::vector<ImageRef> images;
  int samples = 1;  // per texel and axis, at most 8: textures that are finer than the baked ones are averaged
  LossReport losses;
  std::uint64_t images_decoded = 0;
};
// base_colour.png (sRGB); surface.png: occlusion, roughness, metal; normal.png; specular.png (sRGB) where reflectances differ, the colour
// of KHR_materials_specular beside an index of 7/3, so that f0 = .16 times it; emissive.png (sRGB) with the brightest layer's as factor.
// Where several samples come together, parameters and normals are averaged, and the normals' spread becomes roughness (normal_filter.h).
// Errors: LAYERS_INVALID, CANCELLED, those of decode() and of writing.
Result<BakedMaterial> bake_layers(const LayeredMaterial& material, std::span<const ImageRef> images, const BakeOptions& options);

}  // namespace etendue
