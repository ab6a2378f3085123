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

// Base colour and metal mask serve both readers, and what is best for one of them is not for the other. E_core and E_full are the sums of
// the six squared differences in each; `weight` says how many times as much E_full counts: E_core + weight E_full.
double metal_rough_cost(const MetalRoughColours& colours, const ColourPair& pair, double weight);

// Least metal_rough_cost() over all metal masks. Of 1000 random pairs at most 3 cost more than with the best of 4097 masks, by up to 15 %,
// and these with a weight of 100 and more, whose valleys are narrow. Among masks whose sums differ by less than 6e-8 (an rms of 1e-4) 0
// comes first, then 1. Inputs as in fit_disney().
MetalRoughColours metal_rough_of(const ColourPair& pair, double weight);
// The best base colour and dielectric f0 for a metal mask that is given, in the same sense: exact.
MetalRoughColours metal_rough_at(double metal, const ColourPair& pair, double weight);

// Whom the choice serves. `all`: a full reader sees the pair to an rms of full_reader_limit() over a material, and a core-only one what is
// nearest to it then. `core`: a core-only reader sees what is nearest to the pair, and a full one what KHR_materials_specular can mend.
enum class Readers { all, core };
// 1e-3 with 8 bits, half a step of which is 2e-3; 1e-4 with 16 and without textures.
double full_reader_limit(int bits);

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
  // Mean |difference| of the metal mask (0 to 1) between neighbouring texels: of the mask that is stored, and of the one that would be the
  // best for each texel on its own. 0 without a mask.
  double metal_variation = 0, metal_variation_of_best = 0;
};

struct ConversionOptions {
  MaterialModel to = MaterialModel::metal_rough;
  int bits = 8;                  // of new textures: 8 or 16
  std::filesystem::path folder;  // where new textures are written, as PNG; the scene refers to them there
  unsigned threads = 0;          // 0: as many as the machine has
  Progress* progress = nullptr;
  Readers readers = Readers::all;  // to metal_rough alone
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
