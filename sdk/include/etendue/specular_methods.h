// Approximations of specular light from area lights, by name, to be measured against eval::reference.
//   const SpecularMethod* m = find_specular_method("ltc");
//   std::optional<Rgb> luminance = m->luminance(emitter, point);
#pragma once

#include "etendue/eval.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue::eval {

struct SpecularMethod {
  std::string_view name;    // lower case, words joined by hyphens
  std::string_view source;  // authors, year
  std::string_view note;    // what it approximates, where it breaks
  // Towards the view, cd/m2. Nothing if the method does not take the emitter or the BRDF: each takes height-correlated round GGX with
  // Schlick's Fresnel (GgxLobe, or such a SpecularLobe) and uniform area lights without a window.
  std::optional<Rgb> (*luminance)(const Emitter&, const ShadingPoint&) = nullptr;
};

std::span<const SpecularMethod> specular_methods();
// Null if no method has the name.
const SpecularMethod* find_specular_method(std::string_view name);

}  // namespace etendue::eval
