// Approximations of specular light from area lights, by name, to be measured against eval::reference.
//   const SpecularMethod* m = find_specular_method("ltc");
//   std::optional<Rgb> luminance = m->luminance(emitter, point);
#pragma once

#include "etendue/eval.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue::eval {

// Where a source is wrong the printed form keeps what is printed and another method, "NAME-mended", says what is right.
struct SpecularMethod {
  std::string_view name;    // lower case, words joined by hyphens
  std::string_view source;  // authors, year, equation or listing
  std::string_view note;    // what it approximates, where it breaks
  // Towards the view, cd/m2. Nothing if the method does not take the emitter or the BRDF: uniform area lights without a window, of the
  // shapes that it is published for, lines too by `moments` and most transformed cosines; a round lobe without compensation,
  // height-correlated GGX with Schlick's Fresnel (GgxLobe, or such a SpecularLobe) for transformed cosines and moments, GGX of any masking
  // and Fresnel term for the others, and any distribution for Drobot's and `punctual`. Dark from behind a flat light. Where a printed form
  // divides by zero or leaves the domain of its functions the answer is 0.
  std::optional<Rgb> (*luminance)(const Emitter&, const ShadingPoint&) = nullptr;
};

// Source by source.
std::span<const SpecularMethod> specular_methods();
// Null if no method has the name.
const SpecularMethod* find_specular_method(std::string_view name);

}  // namespace etendue::eval
