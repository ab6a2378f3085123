// Whole materials of a scene in the other of glTF's two models: metallic-roughness, or KHR_materials_pbrSpecularGlossiness.
//   auto changes = convert_materials(scene, {MaterialModel::metal_rough});
// Specular-glossiness has two colours (ColourPair), metallic-roughness one and a metal mask. What is lost depends on the reader: one that
// knows the core alone takes f0 = .04 for every dielectric, one that knows KHR_materials_specular takes what the file says. Both read the
// same base colour and metal mask; how these are chosen: sdk/docs/material-conversion.md.
#pragma once

#include "etendue/io.h"
#include "etendue/material_fit.h"
#include "etendue/result.h"
#include "etendue/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace etendue {

// glTF's metallic-roughness with the f0 of its dielectric part apart: .04 times KHR_materials_specular's colour, ior 1.5.
struct MetalRoughColours {
  Rgb base{0, 0, 0};
  double metal = 0;
  Rgb dielectric_f0{0.04, 0.04, 0.04};
};
// What a reader makes of them: diffuse = (1 - metal) base, f0 = (1 - metal) k + metal base, with k = .04 or the dielectric's f0.
ColourPair in_core_reader(const MetalRoughColours& colours);
ColourPair in_full_reader(const MetalRoughColours& colours);

// E_core + 1000 E_full, the sums of the six squared differences in both readers.
double metal_rough_cost(const MetalRoughColours& colours, const ColourPair& pair);

// Right in a full reader, and in a core-only one as close to its optimum (fit_disney with DielectricF0::core) as that allows: least
// metal_rough_cost() over the metal masks of the core's optimum, of the largest
// mask that leaves the full reader exact, 0 and 1. Among masks whose sums differ by less than 6e-8 (an rms of 1e-4) 0 comes first, then 1.
MetalRoughColours metal_rough_of(const ColourPair& pair);
// The best base colour and dielectric f0 for a metal mask that is given, in the same sense.
MetalRoughColours metal_rough_at(double metal, const ColourPair& pair);

enum class MaterialModel { metal_rough, spec_gloss };

// Differences of one colour, over the channels and texels.
struct Deviation {
  double rms = 0, max = 0;
};
struct ReaderDeviation {
  Deviation diffuse, f0;              // linear
  Deviation diffuse_steps, f0_steps;  // in steps of 8-bit sRGB
};

// One material that was converted: what readers of the values that are stored make of them, against what it said before.
struct MaterialChange {
  std::uint32_t material = 0;  // in Scene::materials
  std::uint64_t texels = 1;
  ReaderDeviation core, full;  // of specular-glossiness, which has one kind of reader: twice the same
};

struct ConversionOptions {
  MaterialModel to = MaterialModel::metal_rough;
  int bits = 8;                  // of new textures: 8 or 16
  std::filesystem::path folder;  // where new textures are written, as PNG; the scene refers to them there
  unsigned threads = 0;          // 0: as many as the machine has
  Progress* progress = nullptr;
};

struct MaterialConversion {
  std::vector<MaterialChange> changes;
  LossReport losses;  // an entry for each change, and for what the other model cannot say
  std::uint64_t images_decoded = 0, images_written = 0;
};

// Changes the scene's materials in place. Those that are in the other model already, or in none of the two, stay.
// Errors: those of decoding and of writing files; CANCELLED.
Result<MaterialConversion> convert_materials(Scene& scene, const ConversionOptions& options);

}  // namespace etendue
