// Colour textures in another space than sRGB or linear Rec.709, made into what glTF, Mitsuba and all else here take them for.
//   ColourStep step = *ColourConfig::from_environment()->to_linear_rec709("ACEScg");
//   LossReport losses = *convert_colour_textures(scene, step, {"new_textures"});
#pragma once

#include "etendue/colour_config.h"
#include "etendue/io.h"
#include "etendue/result.h"
#include "etendue/scene.h"

#include <cstdint>
#include <filesystem>

namespace etendue {

struct TextureSpaceOptions {
  std::filesystem::path folder;                       // of new pictures, to which the scene then refers; made if need be
  int bits = 16;                                      // of pictures of whole numbers: 8 or 16
  std::uint64_t max_pixels = std::uint64_t{1} << 32;  // of one picture
  Progress* progress = nullptr;
};

// Textures of colours (base colour, specular, emission, colours of lobes, of lights) are read as `to_linear_rec709` says, whatever their
// Encoding, and written anew, each once and a band at a time: pictures of whole numbers as PNG in sRGB, pictures of floating-point numbers
// as linear OpenEXR of 32 bits. Alpha stays. Data (normals, roughness, masks) and environments stay as they are.
// A PNG holds 0 to 1 of each channel: the report names each picture that had more, with how many texels and by how much.
// Errors: those of decoding and of writing files; CANCELLED.
Result<LossReport> convert_colour_textures(Scene& scene, const ColourStep& to_linear_rec709, const TextureSpaceOptions& options);

}  // namespace etendue
